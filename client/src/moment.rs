//! What is to be seen at one moment: the same form whether it was predicted or interpolated.

use macroquad::math::DVec2;
use shared::game::Game;
use shared::physics::ball::{Ball, Instant};

/// A ball at that moment.
#[derive(Debug, Clone, Copy, PartialEq)]
pub(crate) struct Motion {
    /// Which ball of the game.
    pub(crate) id: u32,
    /// Its centre, metres.
    pub(crate) position: DVec2,
    /// m/s.
    pub(crate) velocity: DVec2,
    /// About the playfield's normal, rad/s, counter-clockwise.
    pub(crate) spin: f64,
    /// 0 is the playfield.
    pub(crate) floor: u8,
    /// It lies in a saucer.
    pub(crate) is_held: bool,
}

impl Motion {
    /// A ball on its flight.
    pub(crate) fn of(ball: &Ball, at: Instant, tick_seconds: f64) -> Self {
        let (position, velocity) = ball.at(at, tick_seconds);
        let spin_rate = ball.slide.map_or(0.0, |slide| slide.spin_rate);
        let spin = ball.spin + spin_rate * at.since(ball.flight.start, tick_seconds);
        Self { id: ball.id, position, velocity, spin, floor: ball.floor, is_held: ball.saucer().is_some() }
    }
}

/// What is to be seen at one moment.
#[derive(Debug)]
pub(crate) struct Moment<'a> {
    /// Balls in play.
    pub(crate) balls: Vec<Motion>,
    /// For each flipper, how far it is raised, radians.
    pub(crate) flippers: Vec<f64>,
    /// For each plunger, how far it is pulled, metres.
    pub(crate) plungers: Vec<f64>,
    /// How far the table is from its place, metres.
    pub(crate) cabinet: DVec2,
    /// When.
    pub(crate) at: Instant,
    /// Everything that does not move: turn, points, lights, targets.
    pub(crate) game: &'a Game,
}

impl<'a> Moment<'a> {
    /// A game as it is, a fraction of a tick after its last one.
    pub(crate) fn of(game: &'a Game, fraction: f64) -> Self {
        let dt = game.table().scene.tick_seconds;
        let now = Instant { tick: game.tick(), offset: fraction * dt };
        let state = game.world().state();
        Self {
            balls: state.balls.iter().map(|ball| Motion::of(ball, now, dt)).collect(),
            flippers: state.flippers.iter().map(|flipper| flipper.swing).collect(),
            plungers: state.plungers.iter().map(|plunger| plunger.pull).collect(),
            cabinet: state.cabinet.displacement,
            at: now,
            game,
        }
    }
}

/// A tick with its fraction as an instant of the world.
pub(crate) fn instant(tick: f64, tick_seconds: f64) -> Instant {
    let whole = tick.max(0.0).floor();
    Instant { tick: whole as u64, offset: (tick.max(0.0) - whole) * tick_seconds }
}
