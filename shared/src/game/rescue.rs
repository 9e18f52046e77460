//! Rescue: a ball that lies still where nobody can move it, or to which nothing has happened for long, is served again.

use super::state::Phase;
use super::{Game, GameEventKind, QUIET_AFTER, STILL, STUCK_AFTER};
use crate::physics::ball::{Ball, Instant, Support};

/// How the balls in play lie.
#[derive(Debug, Clone, Copy, Default)]
pub(super) struct Look {
    /// All of them lie still, and no button is held: in a cradle a ball lies still, too.
    pub(super) is_still: bool,
    /// One of them waits at the plunger, or there is none.
    pub(super) is_ready: bool,
}

impl Look {
    pub(super) fn is_stuck(&self) -> bool {
        self.is_still && !self.is_ready
    }
}

impl Game {
    /// Serves a stuck ball again; how the balls lie.
    pub(super) fn free_stuck_ball(&mut self) -> Look {
        let look = self.look();
        let (still_limit, quiet_limit) = (self.ticks(STUCK_AFTER), self.ticks(QUIET_AFTER));
        if let Phase::Play { still, quiet, .. } = &mut self.play.phase {
            *still = if look.is_stuck() { still.saturating_add(1) } else { 0 };
            *quiet = if look.is_ready { 0 } else { quiet.saturating_add(1) };
            if *still >= still_limit || *quiet >= quiet_limit {
                self.serve_again();
            }
        }
        look
    }

    fn look(&self) -> Look {
        let state = self.world.state();
        let (now, scene) = (Instant::start_of(state.tick), &self.table.scene);
        let held = state.flippers.iter().any(|flipper| flipper.pressed);
        let mut look = Look { is_still: !held, is_ready: state.balls.is_empty() };
        for ball in &state.balls {
            let (position, velocity) = ball.at(now, scene.tick_seconds);
            look.is_ready |= matches!(ball.support, Support::Plunger(_))
                || scene.plungers.iter().any(|plunger| plunger.distance(0.0, position).abs() < self.ready_within());
            look.is_still &= velocity.length() < self.still_below();
        }
        look
    }

    /// Metres from a plunger at rest within which a ball waits at it.
    fn ready_within(&self) -> f64 {
        2.0 * self.table.scene.radius(0)
    }

    /// Metres a second.
    fn still_below(&self) -> f64 {
        STILL * self.table.scene.radius(0)
    }

    /// The tick up to whose start `look` holds, if nothing happens before: what moves is not still before it has lost
    /// its speed, and not at the plunger before it has gone all the way.
    pub(super) fn look_holds_until(&self, look: &Look) -> u64 {
        let state = self.world.state();
        let is_at_rest =
            |ball: &Ball| ball.flight.velocity == glam::DVec2::ZERO && ball.flight.acceleration == glam::DVec2::ZERO;
        // On a table where all lies still, nothing changes.
        if state.balls.iter().all(is_at_rest) {
            return u64::MAX;
        }
        if look.is_ready || look.is_still {
            return state.tick;
        }
        let (now, scene) = (Instant::start_of(state.tick), &self.table.scene);
        let held = state.flippers.iter().any(|flipper| flipper.pressed);
        let (mut moves_for, mut away_for) = (if held { f64::INFINITY } else { 0.0 }, f64::INFINITY);
        for ball in &state.balls {
            let (position, velocity) = ball.at(now, scene.tick_seconds);
            let (speed, pull) = (velocity.length(), ball.flight.acceleration.length());
            let moves = (speed - self.still_below()) / pull;
            moves_for = if moves > moves_for { moves } else { moves_for };
            for plunger in &scene.plungers {
                let way = plunger.way_to_strip(position) - self.ready_within();
                if way <= 0.0 {
                    return state.tick;
                }
                let away = 2.0 * way / (speed + (speed * speed + 2.0 * pull * way).sqrt());
                away_for = if away < away_for { away } else { away_for };
            }
        }
        let seconds = if moves_for < away_for { moves_for } else { away_for };
        // Less a hundredth, for roundings. A cast saturates, and makes 0 of what is no number.
        state.tick.saturating_add((0.99 * seconds / scene.tick_seconds) as u64)
    }

    /// The player gets the ball again that got lost through no fault of theirs.
    pub(super) fn serve_again(&mut self) {
        let Phase::Play { serve_in: 0, still, quiet, .. } = &mut self.play.phase else { return };
        (*still, *quiet) = (0, 0);
        self.world.clear_balls();
        self.world.serve(self.table.ball_start);
        self.emit(GameEventKind::Rescued);
    }
}
