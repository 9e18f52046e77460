//! Rescue: what is done about a ball that lies still where nobody can move it, or when nothing that counts has happened for
//! long. First all kickers are fired, as a real machine searches for its ball; if that has not helped after some seconds, the
//! ball is served again. Both follow from the state alone and are told as events: replays show them.

#[cfg(test)]
mod tests;

use glam::DVec2;

use super::events::Rescue;
use super::state::Phase;
use super::{Game, GameEventKind};
use crate::physics::ball::{Ball, Instant, Support};

/// Seconds for which a ball may lie still where no player holds it.
pub(super) const STUCK_AFTER: f64 = 8.0;
/// Seconds that may pass with a ball in play and without a control or anything that counts.
pub(super) const QUIET_AFTER: f64 = 60.0;
/// Seconds from firing the kickers until the ball is served again, if it has not come loose.
const SEARCH_TIME: f64 = 4.0;
/// How often in a turn the kickers are fired. More would keep a ball alive for ever that they send back to where it was.
const MOST_SEARCHES: u8 = 3;
/// Slower than this share of the ball's radius a second it lies still.
const STILL: f64 = 0.05;
/// How near to a plunger at rest a ball waits there, in radii of its.
const WAITS_WITHIN: f64 = 2.0;
/// How far beyond a flipper's tip its player can hold a ball, in radii of the ball: against a wall, or behind other balls.
const CRADLE: f64 = 6.0;

/// How the balls lie.
#[derive(Debug, Clone, Copy, Default)]
pub(super) struct Look {
    /// One that lies still where nobody holds it, by its id: the one that is watched already, if that still does.
    pub(super) stuck: Option<u32>,
    /// Not all of them wait at the plunger or in locks.
    pub(super) in_play: bool,
}

impl Game {
    /// After a tick: watches for a stuck ball, and rescues it. How the balls lie.
    pub(super) fn free_stuck_ball(&mut self) -> Look {
        let Phase::Play { watched: before, .. } = self.play.phase else { return Look::default() };
        let look = self.look(before);
        let (stuck_after, quiet_after) = (self.ticks(STUCK_AFTER), self.ticks(QUIET_AFTER));
        let search_time = self.ticks(SEARCH_TIME);
        let Phase::Play { still, watched, quiet, searches, .. } = &mut self.play.phase else { return look };
        *still = match look.stuck {
            Some(id) if id == *watched => still.saturating_add(1),
            Some(_) => 1,
            None => 0,
        };
        *watched = look.stuck.unwrap_or(*watched);
        *quiet = if look.in_play { quiet.saturating_add(1) } else { 0 };
        let (still, quiet) = (*still, *quiet);
        if (still == stuck_after || quiet == quiet_after) && *searches < MOST_SEARCHES {
            *searches += 1;
            self.world.fire_kickers();
            self.emit(GameEventKind::Rescued { by: Rescue::Kickers });
        }
        if still >= stuck_after.saturating_add(search_time) {
            self.serve_again(look.stuck);
        } else if quiet >= quiet_after.saturating_add(search_time) {
            let in_play = self.world.state().balls.iter().find(|ball| self.is_in_play(ball)).map(|ball| ball.id);
            self.serve_again(in_play);
        }
        look
    }

    /// In how many ticks at the earliest something is to be done about what has lasted for `ticks`, with its limit in seconds.
    pub(super) fn rescue_due_in(&self, ticks: u32, limit: f64) -> u32 {
        let first = self.ticks(limit);
        let due = if ticks < first { first } else { first.saturating_add(self.ticks(SEARCH_TIME)) };
        due.saturating_sub(ticks)
    }

    /// Whether a ball is in play that does not merely wait at the plunger or in a lock.
    pub(super) fn has_ball_in_play(&self) -> bool {
        matches!(self.play.phase, Phase::Play { serve_in: 0, .. })
            && self.world.state().balls.iter().any(|ball| self.is_in_play(ball))
    }

    /// Neither at the plunger nor locked: both wait for as long as the player likes.
    fn is_in_play(&self, ball: &Ball) -> bool {
        !self.waits(ball) && !self.world.is_locked(ball)
    }

    fn look(&self, watched: u32) -> Look {
        let mut look = Look::default();
        for ball in &self.world.state().balls {
            if !self.is_in_play(ball) {
                continue;
            }
            look.in_play = true;
            if (look.stuck.is_none() || ball.id == watched) && self.is_still(ball) && !self.is_held(ball) {
                look.stuck = Some(ball.id);
            }
        }
        look
    }

    fn now(&self) -> Instant {
        Instant::start_of(self.world.state().tick)
    }

    fn is_still(&self, ball: &Ball) -> bool {
        let (_, velocity) = ball.at(self.now(), self.table.scene.tick_seconds);
        velocity.length() < STILL * self.table.scene.radius(ball.kind)
    }

    /// Whether a ball waits at the plunger, for as long as its player likes.
    fn waits(&self, ball: &Ball) -> bool {
        let scene = &self.table.scene;
        let (position, _) = ball.at(self.now(), scene.tick_seconds);
        let within = WAITS_WITHIN * scene.radius(ball.kind);
        // One that falls after a plunger that is pulled back is on neither.
        let in_lane = |distance: f64, stroke: f64| distance < within && distance > -(stroke + within);
        // The lane is on the playfield: what is above it does not wait there.
        ball.floor == 0
            && (matches!(ball.support, Support::Plunger(_))
                || scene.plungers.iter().any(|plunger| in_lane(plunger.distance(0.0, position), plunger.stroke)))
    }

    /// Whether a player holds a ball, in the cradle of a flipper whose button is pressed, or a saucer does.
    fn is_held(&self, ball: &Ball) -> bool {
        if ball.saucer().is_some() {
            return true;
        }
        let scene = &self.table.scene;
        let (position, _) = ball.at(self.now(), scene.tick_seconds);
        let beyond = CRADLE * scene.radius(ball.kind);
        let flippers = scene.flippers.iter().zip(&self.world.state().flippers);
        flippers
            .filter(|(_, flipper)| flipper.pressed && ball.floor == 0)
            .any(|(spec, _)| (position - spec.pivot).length() <= spec.reach() + beyond)
    }

    /// The tick up to whose start the balls lie as they do, if nothing happens before: what moves is not still before it has
    /// lost its speed, and not at the plunger before it has gone all the way.
    pub(super) fn look_holds_until(&self) -> u64 {
        let (state, scene) = (self.world.state(), &self.table.scene);
        let mut least = f64::INFINITY;
        for ball in &state.balls {
            let pull = ball.flight.acceleration.length();
            if ball.flight.velocity == DVec2::ZERO && pull == 0.0 {
                continue;
            }
            let (position, velocity) = ball.at(self.now(), scene.tick_seconds);
            let (speed, radius) = (velocity.length(), scene.radius(ball.kind));
            let mut holds = (speed - STILL * radius) / pull;
            for plunger in &scene.plungers {
                let way = plunger.way_to_stroke(position) - WAITS_WITHIN * radius;
                let way = if way > 0.0 { way } else { 0.0 };
                let arrives = 2.0 * way / (speed + (speed * speed + 2.0 * pull * way).sqrt());
                holds = if arrives < holds { arrives } else { holds };
            }
            if holds.is_nan() || holds <= 0.0 {
                return state.tick;
            }
            least = if holds < least { holds } else { least };
        }
        // Less a hundredth, for roundings. A cast saturates.
        state.tick.saturating_add((0.99 * least / scene.tick_seconds) as u64)
    }

    /// The player gets a ball again that got lost through no fault of theirs: the one of that id, or one that is gone. It waits
    /// until the plunger is free.
    pub(super) fn serve_again(&mut self, id: Option<u32>) {
        let is_free = self.world.state().balls.iter().all(|ball| Some(ball.id) == id || !self.waits(ball));
        let Phase::Play { serve_in: 0, still, quiet, .. } = &mut self.play.phase else { return };
        if id.is_some() && !is_free {
            return;
        }
        (*still, *quiet) = (0, 0);
        if let Some(id) = id {
            self.world.take_back(id);
        }
        self.world.serve(self.table.ball_start);
        self.emit(GameEventKind::Rescued { by: Rescue::Relaunch });
    }
}
