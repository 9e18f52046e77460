//! A player made of code: seeded, and human. It sees 200 ms late, guesses where the ball is by now, and flips with a
//! timing error of 12 ms.

use glam::DVec2;

use super::Game;
use super::input::Action;
use super::state::Phase;
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
    /// What it saw within the last 200 ms, by tick modulo length.
    sights: Vec<Option<Sight>>,
    plans: [Plan; 2],
    plunge_at: Option<u64>,
    /// Not before this tick does it believe that the ball lies on the plunger: it has just seen it leave.
    plunger_quiet_until: u64,
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
        }
    }

    /// What it does in the tick that the game is about to play; `act` gets each action.
    pub fn play(&mut self, game: &Game, mut act: impl FnMut(Action)) {
        let tick = game.tick();
        let dt = game.table().scene.tick_seconds;
        let seen = self.look(game);
        if !matches!(game.phase(), Phase::Play { seat, serve_in: 0, .. } if seat == self.seat) {
            self.let_go(&mut act);
            return;
        }
        if tick.is_multiple_of(((THINK_EVERY / dt) as u64).max(1))
            && let Some(seen) = seen
        {
            self.think(game, seen, tick, &mut act);
        }
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

    /// Remembers what is to be seen now, and returns what was to be seen 200 ms ago.
    fn look(&mut self, game: &Game) -> Option<Sight> {
        let dt = game.table().scene.tick_seconds;
        let now = Instant::start_of(game.tick());
        let balls =
            game.world().state().balls.iter().filter(|ball| ball.saucer().is_none()).map(|ball| ball.at(now, dt));
        let lowest = balls.reduce(|a, b| if b.0.y < a.0.y { b } else { a });
        let ticks = ((LATENCY / dt) as usize).max(1);
        self.sights.resize(ticks, None);
        let place = (game.tick() % ticks as u64) as usize;
        let sight = lowest.map(|(position, velocity)| Sight { position, velocity });
        std::mem::replace(&mut self.sights[place], sight)
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
        for place in 0..scene.flippers.len() {
            let spec = &scene.flippers[place];
            let hand = usize::from(spec.right);
            if self.plans[hand].press_at.is_some() || self.plans[hand].release_at.is_some() {
                continue;
            }
            let target = spec.length * self.rng.between(0.55, 0.95);
            if let Some(arrival) = arrival(spec, scene.gravity, scene.radius(0), seen, target) {
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
fn arrival(spec: &FlipperSpec, gravity: DVec2, radius: f64, seen: Sight, target: f64) -> Option<f64> {
    let axis = spec.direction(0.0);
    let up = if axis.perp().y > 0.0 { axis.perp() } else { -axis.perp() };
    let place = |p: DVec2| ((p - spec.pivot).dot(axis), (p - spec.pivot).dot(up) - radius - spec.base_radius);
    let (along, above) = place(seen.position);
    let closing = -seen.velocity.dot(up);
    let rolls = above.abs() < 0.6 * radius && closing.abs() < 0.25 && along > -2.0 * spec.length;
    // The mind's picture of the ball, carried forward in steps of 2 ms.
    let pull = if rolls { axis * gravity.dot(axis) } else { gravity };
    let velocity = if rolls { axis * seen.velocity.dot(axis) } else { seen.velocity };
    let steps = ((LATENCY + FORESIGHT) / 0.002) as u32;
    for step in 0..steps {
        let t = f64::from(step) * 0.002;
        let position = seen.position + (velocity + pull * (0.5 * t)) * t;
        let speed = velocity + pull * t;
        let (along, above) = place(position);
        let reached = if rolls {
            along >= target && speed.dot(axis) > 0.0
        } else {
            above <= 0.5 * radius && above > -3.0 * radius && speed.y < 0.0 && along > 0.2 * spec.length
        };
        if reached && along < spec.length + 2.0 * radius {
            let from_now = t - LATENCY;
            return (from_now > -0.03).then_some(from_now);
        }
    }
    None
}
