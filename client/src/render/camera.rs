//! Which part of a table is seen that is taller than its opening: a camera that follows the ball. Pure arithmetic on a
//! [`View`]; time comes from the view's clock.
//!
//! The camera is drawn to its goal as by a critically damped spring: it arrives without swinging, however long frames take.

use crate::view::{BallView, View};

/// How fast the spring is, 1/s: nine tenths of a way are done in about half a second.
const SPRING: f32 = 7.5;
/// How far ahead of a ball the camera looks, seconds of its way, ...
const AHEAD: f32 = 0.16;
/// ... but no more than this share of what is seen.
const MOST_AHEAD: f32 = 0.25;
/// The ball is seen by this share of what is seen above the middle: what comes next is below it.
const ABOVE_MIDDLE: f32 = 0.07;
/// A goal nearer than this share of what is seen is no reason to move: bumpers would make the picture sway.
const IDLE: f32 = 0.06;
/// The lowest ball is never nearer to the edge than this share of what is seen, ...
const MARGIN: f32 = 0.10;
/// ... unless the camera would have to be faster than this, m/s: then a ball was put somewhere else.
const FASTEST: f32 = 7.0;
/// Seconds in which the picture goes up and down a table at which nobody plays.
const SWEEP: f32 = 26.0;
/// No frame counts for more, seconds: the window was hidden.
const LONGEST_FRAME: f32 = 0.25;

/// How much of a table is seen, metres along it, frame included.
#[derive(Debug, Clone, Copy, PartialEq)]
pub(super) struct Reach {
    /// At once.
    pub(super) seen: f32,
    /// Not at the same time; 0 if the whole table is seen.
    pub(super) hidden: f32,
    /// Of frame below the playfield.
    pub(super) frame: f32,
}

/// Follows the ball.
#[derive(Debug, Default)]
pub(super) struct Camera(Option<State>);

/// Where the camera is, and how fast.
#[derive(Debug, Clone, Copy)]
struct State {
    clock: f32,
    /// How far its lower edge is above the table's lower end, metres.
    bottom: f32,
    /// m/s.
    speed: f32,
}

impl Camera {
    /// How far the lower edge of what is seen is above the table's lower end, metres: 0 to what is hidden. The first view
    /// is seen as it should be at once.
    pub(super) fn follow(&mut self, view: &View, reach: Reach) -> f32 {
        if reach.hidden <= 0.0 {
            self.0 = None;
            return 0.0;
        }
        let goal = goal(view, reach);
        let next = match self.0 {
            None => State { clock: view.clock, bottom: goal, speed: 0.0 },
            Some(state) => state.followed(view, reach, goal),
        };
        let bottom = next.bottom.clamp(0.0, reach.hidden);
        // At an end it stands.
        let speed = if bottom == next.bottom { next.speed } else { 0.0 };
        self.0 = Some(State { bottom, speed, ..next });
        bottom
    }
}

impl State {
    fn followed(self, view: &View, reach: Reach, goal: f32) -> Self {
        // A film may go back as well.
        let seconds = (view.clock - self.clock).abs().min(LONGEST_FRAME);
        if seconds == 0.0 {
            return Self { clock: view.clock, ..self };
        }
        // 1. The spring, solved for the time that has gone by.
        let idle = IDLE * reach.seen;
        let way = goal - self.bottom;
        // The ends are always worth going to: a player wants to see all of the flippers.
        let is_end = goal <= 0.0 || goal >= reach.hidden;
        let goal = if is_end { goal } else { self.bottom + way - way.clamp(-idle, idle) };
        let decay = (-SPRING * seconds).exp();
        let away = self.bottom - goal;
        let pull = self.speed + SPRING * away;
        let mut bottom = goal + (away + pull * seconds) * decay;
        let mut speed = (self.speed - SPRING * pull * seconds) * decay;
        // 2. Whatever it does, the lowest ball stays in sight.
        if let Some(ball) = lowest(view) {
            let (least, most) = in_sight(ball, reach);
            let kept =
                bottom.clamp(least, most).clamp(self.bottom - FASTEST * seconds, self.bottom + FASTEST * seconds);
            if kept != bottom {
                (bottom, speed) = (kept, (kept - self.bottom) / seconds);
            }
        }
        Self { clock: view.clock, bottom, speed }
    }
}

/// Where the lower edge should be.
fn goal(view: &View, reach: Reach) -> f32 {
    let Some(ball) = lowest(view) else {
        if view.hud.ball > 0 {
            // The next ball comes to the plunger.
            return 0.0;
        }
        let turn = view.clock / SWEEP * std::f32::consts::TAU;
        return reach.hidden * (0.5 - 0.5 * turn.cos());
    };
    let most = MOST_AHEAD * reach.seen;
    let ahead = (ball.velocity.y * AHEAD).clamp(-most, most);
    // Others are seen as long as the lowest is.
    let highest = candidates(view).map(|other| other.position.y).fold(ball.position.y, f32::max);
    let others = ((highest - ball.position.y) / 2.0).min((0.5 - MARGIN) * reach.seen);
    let middle = ball.position.y + ahead + others - ABOVE_MIDDLE * reach.seen;
    let (least, most) = in_sight(ball, reach);
    (middle + reach.frame - reach.seen / 2.0).clamp(least, most).clamp(0.0, reach.hidden)
}

/// Between which places of the lower edge a ball is well in sight.
fn in_sight(ball: &BallView, reach: Reach) -> (f32, f32) {
    let place = ball.position.y + reach.frame;
    (place - (1.0 - MARGIN) * reach.seen, place - MARGIN * reach.seen)
}

fn lowest(view: &View) -> Option<&BallView> {
    candidates(view).min_by(|a, b| a.position.y.total_cmp(&b.position.y))
}

/// The balls that somebody must look after; those that lie in saucers only if there are no others.
fn candidates(view: &View) -> impl Iterator<Item = &BallView> {
    let are_all_held = view.balls.iter().all(|ball| ball.held);
    view.balls.iter().filter(move |ball| (are_all_held || !ball.held) && is_sound(ball))
}

fn is_sound(ball: &BallView) -> bool {
    ball.position.is_finite() && ball.velocity.is_finite()
}

#[cfg(test)]
mod tests {
    use macroquad::math::vec2;

    use super::*;

    const REACH: Reach = Reach { seen: 1.1, hidden: 0.84, frame: 0.02 };
    const LENGTH: f32 = 1.9;

    fn view(clock: f32, balls: &[(f32, f32)]) -> View {
        let ball = |&(y, speed): &(f32, f32)| BallView {
            position: vec2(0.2, y),
            velocity: vec2(0.0, speed),
            ..BallView::default()
        };
        let mut view = View { balls: balls.iter().map(ball).collect(), clock, ..View::default() };
        view.hud.ball = 1;
        view
    }

    /// A ball's way, frame by frame: where the camera was.
    fn followed(frame: f32, seconds: f32, ball: impl Fn(f32) -> (f32, f32)) -> Vec<f32> {
        let mut camera = Camera::default();
        let count = (seconds / frame) as u16;
        (0..count)
            .map(|place| {
                let clock = f32::from(place) * frame;
                camera.follow(&view(clock, &[ball(clock)]), REACH)
            })
            .collect()
    }

    #[test]
    fn a_table_that_is_seen_whole_never_scrolls() {
        let reach = Reach { seen: 1.9, hidden: 0.0, frame: 0.02 };
        assert_eq!(Camera::default().follow(&view(0.0, &[(1.7, 3.0)]), reach), 0.0);
    }

    #[test]
    fn it_never_goes_beyond_the_ends() {
        let wild = |clock: f32| (0.95 + 0.95 * (clock * 5.0).sin(), 4.75 * (clock * 5.0).cos());
        let places = followed(1.0 / 60.0, 20.0, wild);
        assert!(places.iter().all(|bottom| (0.0..=REACH.hidden).contains(bottom)));
        assert!(places.iter().any(|bottom| *bottom < 0.05) && places.iter().any(|bottom| *bottom > 0.79));
        let mut camera = Camera::default();
        for strange in [f32::NAN, f32::INFINITY, -1e30] {
            let bottom = camera.follow(&view(1.0, &[(strange, 0.0), (0.5, strange)]), REACH);
            assert!((0.0..=REACH.hidden).contains(&bottom), "{strange}: {bottom}");
        }
    }

    #[test]
    fn a_ball_is_always_in_sight_and_the_picture_never_jumps() {
        // Up the table at 4 m/s, back under gravity, again and again.
        let ball = |clock: f32| {
            let t = clock % 1.0;
            let y = 0.05 + 7.2 * t - 7.2 * t * t;
            (y, 7.2 - 14.4 * t)
        };
        for frame in [1.0 / 144.0, 1.0 / 60.0, 1.0 / 25.0] {
            let places = followed(frame, 5.0, ball);
            for (place, bottom) in places.iter().enumerate() {
                let at = ball(place as f32 * frame).0 + REACH.frame - bottom;
                assert!((0.0..REACH.seen).contains(&at), "frame {place} of {frame}: {at}");
            }
            let fastest = places.windows(2).map(|pair| (pair[1] - pair[0]).abs() / frame).fold(0.0, f32::max);
            assert!(fastest <= FASTEST + 0.01, "{fastest}");
        }
    }

    /// It stood still, and the ball left the picture.
    #[test]
    fn a_film_that_goes_back_is_followed() {
        let mut camera = Camera::default();
        camera.follow(&view(60.0, &[(1.8, 0.0)]), REACH);
        let mut bottom = 1.0;
        for frame in 1..200_u16 {
            bottom = camera.follow(&view(60.0 - f32::from(frame) / 60.0, &[(0.1, 0.0)]), REACH);
        }
        assert!(bottom < 0.05, "{bottom}");
    }

    #[test]
    fn it_looks_ahead() {
        let up = Camera::default().follow(&view(0.0, &[(0.95, 2.0)]), REACH);
        let still = Camera::default().follow(&view(0.0, &[(0.95, 0.0)]), REACH);
        let down = Camera::default().follow(&view(0.0, &[(0.95, -2.0)]), REACH);
        assert!(up > still + 0.1 && still > down + 0.1, "{up} {still} {down}");
    }

    #[test]
    fn it_comes_to_rest_without_swinging_and_alike_at_any_rate() {
        let ball = |clock: f32| if clock < 0.1 { (0.1, 0.0) } else { (1.8, 0.0) };
        let ends: Vec<f32> = [1.0 / 30.0, 1.0 / 60.0, 1.0 / 240.0]
            .map(|frame| {
                let places = followed(frame, 2.0, ball);
                assert!(places.windows(2).all(|pair| pair[1] >= pair[0] - 1e-6), "it swings at {frame}");
                places[places.len() / 4]
            })
            .to_vec();
        assert!(ends.iter().all(|end| (end - ends[0]).abs() < 0.08), "{ends:?}");
        let last = *followed(1.0 / 60.0, 3.0, ball).last().unwrap();
        assert!((last - REACH.hidden).abs() < 0.01, "{last}");
    }

    #[test]
    fn the_lowest_of_several_balls_is_kept_and_others_if_there_is_room() {
        let mut camera = Camera::default();
        let bottom = camera.follow(&view(0.0, &[(1.8, 0.0), (0.9, 0.0)]), REACH);
        let place = |y: f32| y + REACH.frame - bottom;
        assert!(place(0.9) > 0.05 && place(0.9) < 1.05, "{bottom}");
        assert!(place(1.8) < REACH.seen, "{bottom}");
        let bottom = camera.follow(&view(60.0, &[(1.85, 0.0), (0.1, 0.0)]), REACH);
        let bottom = camera.follow(&view(61.0, &[(1.85, 0.0), (0.1, 0.0)]), REACH).min(bottom);
        assert!(0.12 - bottom > 0.0, "{bottom}");
    }

    #[test]
    fn a_held_ball_waits_for_the_others() {
        let mut both = view(0.0, &[(0.1, 0.0), (1.7, 0.0)]);
        both.balls[0].held = true;
        assert!(Camera::default().follow(&both, REACH) > 0.5);
        both.balls[1].held = true;
        assert_eq!(Camera::default().follow(&both, REACH), 0.0);
    }

    #[test]
    fn without_a_ball_it_waits_at_the_plunger_or_shows_the_table() {
        assert_eq!(Camera::default().follow(&view(13.0, &[]), REACH), 0.0);
        let mut idle = view(SWEEP / 2.0, &[]);
        idle.hud.ball = 0;
        assert!((Camera::default().follow(&idle, REACH) - REACH.hidden).abs() < 0.01);
    }

    #[test]
    fn bumpers_do_not_make_it_sway() {
        let places = followed(1.0 / 60.0, 4.0, |clock| {
            let t = clock * 24.0;
            (0.95 + 0.03 * t.sin(), 0.4 * t.cos())
        });
        let (least, most) = places[60..].iter().fold((LENGTH, 0.0_f32), |(a, b), c| (a.min(*c), b.max(*c)));
        assert!(most - least < 0.03, "{least} to {most}");
    }
}
