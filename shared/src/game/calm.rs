//! Calm: ticks in which nobody does anything and nothing happens. They only count, and the counts are made up for when
//! somebody asks: a state, a digest and a replay are the same as if every tick had been played in full.

use super::rescue::{Look, QUIET_AFTER, STUCK_AFTER};
use super::state::{Phase, Play};
use super::{Game, GameState};
use crate::math::digest_of;

/// What is known of the ticks to come, and what of those past is not yet counted. Never part of the state.
#[derive(Debug, Clone, Copy, Default)]
pub(super) struct Calm {
    /// Before this tick nothing happens, unless somebody does something.
    pub(super) until: u64,
    /// The tick up to which the counters of the phase have counted.
    pub(super) counted: u64,
    /// What they go by, up to [`Self::until`].
    pub(super) look: Look,
}

impl Calm {
    /// The phase as it is when `tick` is about to be played.
    fn count(&self, phase: Phase, tick: u64) -> Phase {
        let Phase::Play { seat, ball, serve_in, untouched, still, watched, quiet, searches, extra } = phase else {
            return phase;
        };
        // Calm ends before any of the counters is due.
        let ticks = (tick - self.counted) as u32;
        if ticks == 0 {
            return phase;
        }
        Phase::Play {
            seat,
            ball,
            serve_in: serve_in.saturating_sub(ticks),
            untouched,
            still: if self.look.stuck.is_some() { still.saturating_add(ticks) } else { 0 },
            watched,
            quiet: if self.look.in_play { quiet.saturating_add(ticks) } else { 0 },
            searches,
            extra,
        }
    }
}

impl Game {
    /// Whose turn it is.
    pub fn phase(&self) -> Phase {
        self.calm.count(self.play.phase, self.tick())
    }

    /// Whether it is anybody's turn.
    #[inline]
    pub fn is_playing(&self) -> bool {
        // No count makes another phase of one.
        matches!(self.play.phase, Phase::Play { .. })
    }

    /// Everything that changes: to be saved, sent or restored.
    pub fn state(&self) -> GameState {
        GameState { world: self.world.state().clone(), play: self.play_now() }
    }

    /// Digest of the whole state, bit for bit.
    pub fn digest(&self) -> u64 {
        digest_of(&(self.world.state(), &self.play_now()))
    }

    fn play_now(&self) -> Play {
        let mut play = Play { phase: self.phase(), crowd: self.crowd_now(), ..self.play.clone() };
        play.rules.pass(&self.table, self.ticks_uncounted());
        play
    }

    /// Calm ticks with a ball in play that are not counted yet. Calm ends before anything is due, and lasts for no more than a
    /// flight or a pause.
    fn ticks_uncounted(&self) -> u32 {
        if self.calm.look.in_play { (self.tick() - self.calm.counted) as u32 } else { 0 }
    }

    /// Seconds of play for which a light, by its place among the table's, is still lit; `None`: until a rule puts it out, or not
    /// at all.
    pub fn light_time_left(&self, light: usize) -> Option<f64> {
        let ticks = self.play.rules.lights.ticks_left(light)?.saturating_sub(self.ticks_uncounted());
        Some(f64::from(ticks) * self.table.scene.tick_seconds)
    }

    /// Makes up for the calm ticks: one is about to be played that may not be.
    pub(super) fn count_calm(&mut self) {
        self.play.rules.pass(&self.table, self.ticks_uncounted());
        (self.play.phase, self.play.crowd) = (self.phase(), self.crowd_now());
        self.calm.counted = self.tick();
    }

    /// After a tick: until when nothing will happen.
    pub(super) fn find_calm(&mut self, look: Look) {
        let tick = self.tick();
        let mut until = self.world.quiet_until();
        if until > tick
            && let Phase::Play { serve_in, still, quiet, extra, .. } = self.play.phase
        {
            // A ball that waits to be served, and a touch of the plumb bob that is not over yet, are looked after tick by tick.
            if extra > 0 || self.play.tilt.same_touch > 0 {
                until = tick;
            }
            // What is due is done in a tick that is played in full.
            let mut due_in = |ticks: u32| until = until.min(tick + u64::from(ticks.saturating_sub(1)));
            if serve_in > 0 {
                due_in(serve_in);
            }
            if look.stuck.is_some() {
                due_in(self.rescue_due_in(still, STUCK_AFTER));
            }
            if look.in_play {
                due_in(self.rescue_due_in(quiet, QUIET_AFTER));
            }
            if let Some(ticks) = self.crowd_due_in() {
                due_in(ticks);
            }
            if let (true, Some(ticks)) = (look.in_play, self.play.rules.due_in(&self.table)) {
                due_in(ticks);
            }
            if until > tick {
                until = until.min(self.look_holds_until());
            }
        }
        self.calm = Calm { until, counted: tick, look };
    }
}
