//! A player made of code: seeded, and human. It sees 200 ms late, guesses where the ball is by now, and flips with a
//! timing error of 12 ms.

use std::ops::Range;

use glam::DVec2;

use super::Game;
use super::input::Action;
use crate::math::Rng;
use crate::physics::ball::Instant;
use crate::physics::flipper::FlipperSpec;

/// Seconds by which the bot sees late: a person's choice reaction time.
const LATENCY: f64 = 0.2;
/// Standard deviation of its timing, seconds.
const TIMING_ERROR: f64 = 0.012;
/// Seconds that a flipper takes from the button to the ball: what a player has in the fingers.
const SWING_TIME: f64 = 0.012;
/// Seconds that it thinks ahead.
const FORESIGHT: f64 = 0.12;
/// Seconds between two thoughts.
const THINK_EVERY: f64 = 0.01;
/// Seconds from one point of its picture of the ball's way to the next.
const PICTURE_STEP: f64 = 0.002;
/// Speed, m/s, below which the ball is taken to come no nearer in its picture: it would take longer than it looks ahead.
const SLOWEST: f64 = 1e-3;
/// Seconds for which it holds a flipper, at the least and at the most.
const HOLD: (f64, f64) = (0.1, 0.25);
/// Seconds from pulling the plunger to letting go.
const PULL_TIME: (f64, f64) = (0.8, 1.2);

/// Seconds after a launch before it looks for a ball on the plunger again.
const PLUNGER_QUIET: f64 = 1.0;

/// What the bot saw at some tick: the lowest ball in no saucer.
#[derive(Debug, Clone, Copy)]
struct Sight {
    position: DVec2,
    velocity: DVec2,
}

/// What the bot is about to do with one flipper; ticks.
#[derive(Debug, Clone, Copy, Default)]
struct Plan {
    press_at: Option<u64>,
    release_at: Option<u64>,
}

/// A bot for one seat.
#[derive(Debug, Clone)]
pub struct Bot {
    seat: u8,
    rng: Rng,
    /// What it saw at the moments of which it will think 200 ms later, by the number of the thought modulo length.
    sights: Vec<Option<Sight>>,
    plans: [Plan; 2],
    plunge_at: Option<u64>,
    /// Not before this tick does it believe that the ball lies on the plunger: it has just seen it leave.
    plunger_quiet_until: u64,
    /// Whether it had a ball to play when it was last asked.
    had_ball: bool,
    /// Of each flipper: its angle at rest, and which way it points there.
    axes: Vec<(f64, DVec2)>,
    /// In these ticks it has nothing to do, nor to look at, unless it loses the ball or gets one.
    idle: Range<u64>,
}

impl Bot {
    /// A bot that plays from `seat`, with the habits that follow from `seed`.
    pub fn new(seat: u8, seed: u64) -> Self {
        Self {
            seat,
            rng: Rng::new(seed),
            sights: Vec::new(),
            plans: [Plan::default(); 2],
            plunge_at: None,
            plunger_quiet_until: 0,
            had_ball: false,
            axes: Vec::new(),
            idle: 0..0,
        }
    }

    /// What it does in the tick that the game is about to play; `act` gets each action. To be asked in every tick.
    #[inline]
    pub fn play(&mut self, game: &Game, act: impl FnMut(Action)) {
        let has_ball = game.is_ball_of(self.seat);
        if has_ball != self.had_ball || !self.idle.contains(&game.tick()) {
            self.play_now(game, has_ball, act);
        }
    }

    /// A tick in which there may be something to do.
    #[inline(never)]
    fn play_now(&mut self, game: &Game, has_ball: bool, mut act: impl FnMut(Action)) {
        let tick = game.tick();
        let dt = game.table().scene.tick_seconds;
        let (latency, every) = (((LATENCY / dt) as u64).max(1), ((THINK_EVERY / dt) as u64).max(1));
        self.had_ball = has_ball;
        // The thought that it is time for, and the one that what is to be seen now is for, by number: the last ones so far.
        let (thought, sight) = (tick / every, (tick + latency) / every);
        let seen = if tick == thought * every { self.sight_of(thought, latency / every) } else { None };
        if tick + latency == sight * every {
            self.look(game, sight, latency / every);
        }
        if has_ball {
            if let Some(seen) = seen {
                self.think(game, seen, tick, &mut act);
            }
            self.move_hands(tick, dt, &mut act);
        } else {
            self.let_go(&mut act);
        }
        // The next thought, the next look, or a hand that is due before.
        let (thought, look) = ((thought + 1) * every, (sight + 1) * every - latency);
        let hands = self.plans.iter().filter_map(|plan| plan.press_at.or(plan.release_at)).chain(self.plunge_at);
        self.idle = tick + 1..hands.fold(thought.min(look), u64::min);
    }

    /// Does what is due.
    fn move_hands(&mut self, tick: u64, dt: f64, act: &mut impl FnMut(Action)) {
        for (right, plan) in [false, true].into_iter().zip(&mut self.plans) {
            if plan.press_at.is_some_and(|at| at <= tick) {
                plan.press_at = None;
                act(Action::Flipper { right, pressed: true });
            }
            if plan.press_at.is_none() && plan.release_at.is_some_and(|at| at <= tick) {
                plan.release_at = None;
                act(Action::Flipper { right, pressed: false });
            }
        }
        if self.plunge_at.is_some_and(|at| at <= tick) {
            self.plunge_at = None;
            self.plunger_quiet_until = tick + (PLUNGER_QUIET / dt) as u64;
            act(Action::Release);
        }
    }

    /// What was to be seen for that thought; `ahead` thoughts are on their way.
    fn sight_of(&self, thought: u64, ahead: u64) -> Option<Sight> {
        self.sights.get((thought % (ahead + 1)) as usize).copied().flatten()
    }

    /// Remembers what is to be seen now, for that thought.
    fn look(&mut self, game: &Game, thought: u64, ahead: u64) {
        // Of one more than are on their way at once: the oldest is read before its place is taken.
        let length = ahead + 1;
        self.sights.resize(length as usize, None);
        let dt = game.table().scene.tick_seconds;
        let now = Instant::start_of(game.tick());
        let loose = game.world().state().balls.iter().filter(|ball| ball.saucer().is_none() && ball.floor == 0);
        let balls = loose.map(|ball| ball.at(now, dt));
        let lowest = balls.reduce(|a, b| if b.0.y < a.0.y { b } else { a });
        self.sights[(thought % length) as usize] = lowest.map(|(position, velocity)| Sight { position, velocity });
    }

    fn let_go(&mut self, act: &mut impl FnMut(Action)) {
        for (right, plan) in [false, true].into_iter().zip(&mut self.plans) {
            if plan.release_at.take().is_some() {
                act(Action::Flipper { right, pressed: false });
            }
            plan.press_at = None;
        }
        self.plunge_at = None;
    }

    /// Decides on the plunger and on each flipper.
    fn think(&mut self, game: &Game, seen: Sight, tick: u64, act: &mut impl FnMut(Action)) {
        let scene = &game.table().scene;
        let dt = scene.tick_seconds;
        let on_plunger = scene.plungers.iter().any(|p| p.distance(0.0, seen.position) < 1.5 * scene.radius(0));
        if on_plunger && seen.velocity.length() < 0.05 && self.plunge_at.is_none() && tick >= self.plunger_quiet_until {
            let pull = self.rng.between(0.7, 1.0);
            act(Action::Pull((pull * f64::from(u16::MAX)) as u16));
            self.plunge_at = Some(tick + (self.rng.between(PULL_TIME.0, PULL_TIME.1) / dt) as u64);
        }
        if !scene.flippers.iter().map(|spec| spec.rest).eq(self.axes.iter().map(|(rest, _)| *rest)) {
            self.axes = scene.flippers.iter().map(|spec| (spec.rest, spec.direction(0.0))).collect();
        }
        for place in 0..scene.flippers.len() {
            let spec = &scene.flippers[place];
            let hand = usize::from(spec.right);
            if self.plans[hand].press_at.is_some() || self.plans[hand].release_at.is_some() {
                continue;
            }
            let target = spec.length * self.rng.between(0.55, 0.95);
            if let Some(arrival) = arrival(spec, self.axes[place].1, scene.gravity, scene.radius(0), seen, target) {
                let press = arrival - SWING_TIME + self.rng.gaussian() * TIMING_ERROR;
                let press = if press > 0.0 { press } else { 0.0 };
                let hold = self.rng.between(HOLD.0, HOLD.1);
                let press_at = tick + (press / dt) as u64;
                self.plans[hand] =
                    Plan { press_at: Some(press_at), release_at: Some(press_at + (hold / dt) as u64 + 1) };
            }
        }
    }
}

/// In how many seconds from now the ball, seen 200 ms ago, will be worth a flip: when it falls onto the flipper, or
/// rolls along it (or along the lane that leads to it) to `target` metres from the pivot. `None` if it won't soon.
fn arrival(spec: &FlipperSpec, axis: DVec2, gravity: DVec2, radius: f64, seen: Sight, target: f64) -> Option<f64> {
    // Too far away to come near it in time, whatever it does.
    let comes = (seen.velocity.length() + 0.5 * gravity.length() * (LATENCY + FORESIGHT)) * (LATENCY + FORESIGHT);
    if (seen.position - spec.pivot).length() > 1.01 * (spec.length + spec.base_radius + 4.0 * radius + comes) {
        return None;
    }
    let up = if axis.perp().y > 0.0 { axis.perp() } else { -axis.perp() };
    let place = |p: DVec2| ((p - spec.pivot).dot(axis), (p - spec.pivot).dot(up) - radius - spec.base_radius);
    let (along, above) = place(seen.position);
    let closing = -seen.velocity.dot(up);
    let rolls = above.abs() < 0.6 * radius && closing.abs() < 0.25 && along > -2.0 * spec.length;
    // The mind's picture of the ball, carried forward in steps of 2 ms.
    let pull = if rolls { axis * gravity.dot(axis) } else { gravity };
    let velocity = if rolls { axis * seen.velocity.dot(axis) } else { seen.velocity };
    let (highest, lowest, end) = (0.5 * radius, -3.0 * radius, spec.length + 2.0 * radius);
    let steps = ((LATENCY + FORESIGHT) / PICTURE_STEP) as u32;
    // As far as it comes nearer in a step, at the most, to each of the places where it would be worth it: its speed along a line
    // is greatest at one end of the way.
    let speeds = |way: DVec2| {
        let (first, last) = (velocity.dot(way), velocity.dot(way) + pull.dot(way) * (LATENCY + FORESIGHT));
        if first < last { (first, last) } else { (last, first) }
    };
    let (outwards, upwards) = (speeds(axis), speeds(up));
    let closing =
        if rolls { [outwards.1, -outwards.0, 0.0, 0.0] } else { [-upwards.0, upwards.1, outwards.1, -outwards.0] };
    let strides = closing.map(|speed| PICTURE_STEP * if speed > SLOWEST { speed } else { SLOWEST });
    let mut step = 0;
    while step < steps {
        let t = f64::from(step) * PICTURE_STEP;
        let position = seen.position + (velocity + pull * (0.5 * t)) * t;
        let speed = velocity + pull * t;
        let (along, above) = place(position);
        let reached = if rolls {
            along >= target && speed.dot(axis) > 0.0
        } else {
            above <= highest && above > lowest && speed.y < 0.0 && along > 0.2 * spec.length
        };
        if reached && along < end {
            let from_now = t - LATENCY;
            return (from_now > -0.03).then_some(from_now);
        }
        // How far it is, at the least, from where it would be worth it: it need not be followed step by step up to there.
        let gaps = if rolls {
            [target - along, along - end, 0.0, 0.0]
        } else {
            [above - highest, lowest - above, 0.2 * spec.length - along, along - end]
        };
        let skipped = gaps.iter().zip(&strides).map(|(gap, stride)| gap / stride);
        let skipped = skipped.fold(0.0, |most, steps| if steps > most { steps } else { most });
        // A cast saturates, and makes 0 of what is no number.
        step = step.saturating_add((skipped as u32).max(1));
    }
    None
}
