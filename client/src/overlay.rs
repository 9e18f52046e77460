//! What the physics sees, as plain data for the overlay: shapes with their normals, what balls lie on, their velocities,
//! and where each flies until it meets something. Assembled only while the overlay is on.

use std::borrow::Cow;

use macroquad::math::{DVec2, Vec2};
use shared::outline::foresight::{Foresight, foresee};
use shared::outline::{Kind, Outline, Part, outlines, support_elements};
use shared::physics::ball::{Ball, Instant};
use shared::physics::{EventKind, World};
use shared::table::Table;

use crate::moment::Moment;
use crate::view::{Mark, OverlayCircle, OverlayLabel, OverlayLine, OverlayView};

/// World time for which a ball's next impact is looked for, seconds.
const FORESIGHT: f64 = 1.0;
/// An arrow is the way of a ball in this time, seconds.
const ARROW: f64 = 0.05;
/// A world is brought from its snapshot to the moment that is shown, but no farther than this, seconds.
const MOST_BEHIND: f64 = 0.1;
/// Lengths of normals, of a surface and at an impact, and half the length of a cross's strokes, m.
const NORMAL: f64 = 0.006;
const IMPACT_NORMAL: f64 = 0.028;
const CROSS: f64 = 0.007;
/// What the colours mean.
const LEGEND: [(Mark, &str); 3] = [
    (Mark::OneWay, "ONE-WAY, OR MOVING"),
    (Mark::Passed, "PASSED: SENSOR, PLATE, HOLE"),
    (Mark::OtherFloor, "ANOTHER FLOOR"),
];
/// Balls that get lines of words of their own.
const MOST_WORDS: usize = 3;

/// The overlay of what is to be seen.
pub(crate) fn overlay_of(moment: &Moment<'_>) -> OverlayView {
    let table = moment.game.table();
    let world = brought_to(moment.game.world(), moment.at);
    // A world that could not be brought there shows its own time.
    let tick = world.state().tick;
    let at = if tick == moment.at.tick { moment.at } else { Instant::start_of(tick) };
    let mut overlay = Overlay { table, world: &world, at, view: OverlayView::default() };
    overlay.word(Mark::Ball, format!("TICK {tick}"));
    overlay.shapes();
    let flights = foresee(&world, at, FORESIGHT);
    for flight in &flights {
        overlay.flight(flight);
    }
    for (ball, place) in world.state().balls.iter().zip(0..) {
        overlay.ball(ball);
        if place < MOST_WORDS {
            overlay.words_of(ball, flights.iter().find(|flight| flight.ball == ball.id));
        }
    }
    overlay.word(Mark::Ball, String::new());
    for (mark, text) in LEGEND {
        overlay.word(mark, text.to_owned());
    }
    overlay.view
}

/// A spectator sees between two snapshots: the earlier one's world goes on by itself. Inputs between the two are not in it.
fn brought_to(world: &World, at: Instant) -> Cow<'_, World> {
    let behind = at.tick.saturating_sub(world.state().tick);
    if behind == 0 || behind as f64 * world.scene().tick_seconds > MOST_BEHIND {
        return Cow::Borrowed(world);
    }
    let mut world = world.clone();
    for _ in 0..behind {
        world.step();
    }
    Cow::Owned(world)
}

struct Overlay<'a> {
    table: &'a Table,
    world: &'a World,
    at: Instant,
    view: OverlayView,
}

impl Overlay<'_> {
    fn shapes(&mut self) {
        let balls = &self.world.state().balls;
        let in_play = |floor: u8| balls.iter().any(|ball| ball.floor == floor) || (balls.is_empty() && floor == 0);
        for Outline { part, floor, kind, points, normals, .. } in outlines(self.world) {
            let mark = match kind {
                _ if balls.iter().any(|ball| part.supports(ball.support)) => Mark::Support,
                _ if !in_play(floor) => Mark::OtherFloor,
                _ if matches!(part, Part::Flipper(_) | Part::Plunger(_)) => Mark::Moving,
                Kind::Passed => Mark::Passed,
                Kind::OneWay => Mark::OneWay,
                Kind::Solid => Mark::Solid,
            };
            if let [point] = points.as_slice() {
                self.view.circles.push(OverlayCircle { mark, center: point.as_vec2(), radius: 0.0 });
            } else {
                self.line(mark, &points);
            }
            if mark != Mark::OtherFloor {
                // The side matters most where the other one is open.
                let length = if kind == Kind::OneWay { 2.5 * NORMAL } else { NORMAL };
                for normal in normals {
                    self.line(Mark::Normal, &[normal.at, normal.at + normal.towards * length]);
                }
            }
        }
    }

    /// Where a ball goes, and what it meets there.
    fn flight(&mut self, flight: &Foresight) {
        self.line(Mark::Flight, &flight.points);
        let Some(impact) = flight.impact else { return };
        let place = impact.event.position;
        for across in [DVec2::new(CROSS, CROSS), DVec2::new(CROSS, -CROSS)] {
            self.line(Mark::Impact, &[place - across, place + across]);
        }
        if let Some(normal) = impact.normal {
            self.line(Mark::Impact, &[place, place + normal * IMPACT_NORMAL]);
        }
        self.label(Mark::Impact, place, self.what(impact.event.kind));
    }

    fn ball(&mut self, ball: &Ball) {
        let (place, velocity) = ball.at(self.at, self.world.scene().tick_seconds);
        let radius = self.world.scene().radius(ball.kind);
        self.view.circles.push(OverlayCircle { mark: Mark::Ball, center: place.as_vec2(), radius: radius as f32 });
        let way = velocity * ARROW;
        if let Some(ahead) = way.try_normalize() {
            let (tip, head) = (place + way, ahead * way.length().min(CROSS));
            let barb = |side: f64| tip - head + head.perp() * (0.6 * side);
            self.line(Mark::Velocity, &[place, tip]);
            self.line(Mark::Velocity, &[barb(1.0), tip, barb(-1.0)]);
        }
        self.label(Mark::Ball, place, format!("{:.2} M/S", velocity.length()));
    }

    /// What there is to say of a ball.
    fn words_of(&mut self, ball: &Ball, flight: Option<&Foresight>) {
        let (_, velocity) = ball.at(self.at, self.world.scene().tick_seconds);
        let on: Vec<&str> = support_elements(self.world, ball.support).iter().map(|on| self.name(*on)).collect();
        let lies = if on.is_empty() { "FLIES".to_owned() } else { format!("LIES ON {}", on.join(" AND ")) };
        self.word(Mark::Ball, format!("BALL {} ON FLOOR {}", ball.id, ball.floor));
        self.word(Mark::Velocity, format!("  {:.3} M/S", velocity.length()));
        self.word(Mark::Ball, format!("  SPIN {:.1} RAD/S", shown(ball.spin_at(self.at, self.world.scene()))));
        self.word(Mark::Support, format!("  {lies}"));
        if let Some(impact) = flight.and_then(|flight| flight.impact) {
            let wait = impact.event.at.since(self.at, self.world.scene().tick_seconds);
            self.word(Mark::Flight, format!("  IN {wait:.3} S {}", self.what(impact.event.kind)));
        }
    }

    fn word(&mut self, mark: Mark, text: String) {
        self.view.words.push((mark, text));
    }

    fn what(&self, kind: EventKind) -> String {
        match kind {
            EventKind::Touched { element, .. }
            | EventKind::Kicked { element, .. }
            | EventKind::Felled { element, .. }
            | EventKind::Struck { element, .. }
            | EventKind::Spun { element }
            | EventKind::Held { element }
            | EventKind::Passed { element } => self.name(element).to_owned(),
            EventKind::Ejected { element } => format!("OUT OF {}", self.name(element)),
            EventKind::Met { other, .. } => format!("BALL {other}"),
            EventKind::Stalled { .. } => "STALLS".to_owned(),
            EventKind::Drained => "DRAIN".to_owned(),
            EventKind::Escaped => "ESCAPES".to_owned(),
        }
    }

    fn name(&self, element: u16) -> &str {
        self.table.file.elements.get(usize::from(element)).map_or("?", |element| element.name())
    }

    fn line(&mut self, mark: Mark, points: &[DVec2]) {
        let points: Vec<Vec2> = points.iter().map(|point| point.as_vec2()).collect();
        self.view.lines.push(OverlayLine { mark, points });
    }

    fn label(&mut self, mark: Mark, place: DVec2, text: String) {
        self.view.labels.push(OverlayLabel { mark, place: place.as_vec2(), text });
    }
}

/// Without the sign of what is shown as 0.
fn shown(number: f64) -> f64 {
    if number.abs() < 0.05 { 0.0 } else { number }
}

#[cfg(test)]
mod tests {
    use std::sync::Arc;

    use shared::game::{Action, Game, Input};

    use super::*;

    /// A game whose ball has just been launched.
    fn launched() -> Game {
        let mut game = Game::new(Arc::new(Table::shipped("classic").unwrap().unwrap()));
        let act = |tick, action| Input { tick, seat: 0, action };
        for tick in 0..2200 {
            let inputs = match tick {
                0 => vec![act(tick, Action::Sit), act(tick, Action::Start)],
                500 => vec![act(tick, Action::Pull(60_000))],
                1500 => vec![act(tick, Action::Release)],
                _ => vec![],
            };
            game.step(&inputs);
        }
        game
    }

    fn count(view: &OverlayView, mark: Mark) -> usize {
        view.lines.iter().filter(|line| line.mark == mark).count()
    }

    #[test]
    fn a_ball_its_velocity_and_its_flight_are_in_it() {
        let game = launched();
        let view = overlay_of(&Moment::of(&game, 0.0));
        let balls: Vec<_> = view.circles.iter().filter(|circle| circle.mark == Mark::Ball).collect();
        let world = game.world();
        let (place, _) = world.state().balls[0].at(Instant::start_of(game.tick()), world.scene().tick_seconds);
        assert_eq!((balls.len(), balls[0].center), (1, place.as_vec2()));
        assert_eq!((count(&view, Mark::Velocity), count(&view, Mark::Flight)), (2, 1));
        assert!(count(&view, Mark::Normal) > 50);
        // The flight begins at the ball and ends at the cross.
        let flight = view.lines.iter().find(|line| line.mark == Mark::Flight).unwrap();
        assert_eq!(flight.points.first(), Some(&place.as_vec2()));
        assert_eq!(count(&view, Mark::Impact), 3);
        let label = view.labels.iter().find(|label| label.mark == Mark::Impact).unwrap();
        assert_eq!(flight.points.last(), Some(&label.place));
        assert!(!label.text.is_empty() && view.words[0].1 == format!("TICK {}", game.tick()));
    }

    #[test]
    fn every_collider_is_in_it() {
        let game = Game::new(Arc::new(Table::shipped("classic").unwrap().unwrap()));
        let view = overlay_of(&Moment::of(&game, 0.0));
        let (scene, state) = (game.world().scene(), game.world().state());
        let present = scene.colliders.iter().filter(|collider| state.has(collider)).count();
        assert_eq!(view.circles.len() + view.lines.len() - count(&view, Mark::Normal), present);
        assert!(count(&view, Mark::Passed) > 3 && count(&view, Mark::OneWay) > 0);
    }

    #[test]
    fn a_bare_scene_has_an_overlay_as_well() {
        let text = include_str!("../../shared/tables/scenes/box.ron");
        let game = Game::new(Arc::new(Table::parse("box.ron", text).unwrap()));
        let view = overlay_of(&Moment::of(&game, 0.0));
        assert_eq!((count(&view, Mark::Flight), count(&view, Mark::Impact)), (1, 3));
    }

    #[test]
    fn a_world_behind_what_is_shown_goes_on_to_there() {
        let game = launched();
        let later = Instant::start_of(game.tick() + 10);
        let moment = Moment { at: later, ..Moment::of(&game, 0.0) };
        let ball = overlay_of(&moment).circles.into_iter().find(|circle| circle.mark == Mark::Ball).unwrap();
        let mut world = game.world().clone();
        for _ in 0..10 {
            world.step();
        }
        let (place, _) = world.state().balls[0].at(later, world.scene().tick_seconds);
        assert_eq!(ball.center, place.as_vec2());
    }
}
