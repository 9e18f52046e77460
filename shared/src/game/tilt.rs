//! Nudges and the tilt: who nudges too hard is warned, and then loses the ball.

use glam::DVec2;
use serde::{Deserialize, Serialize};

use super::events::GameEventKind;
use super::state::Phase;
use super::{Game, input::Nudge};

/// Seconds after a touch of the plumb bob in which it is still the same one: the bob swings to and fro.
const SAME_TOUCH: f64 = 1.0;

/// How a player treats the table during a ball.
#[derive(Debug, Clone, Copy, Default, PartialEq, Eq, Serialize, Deserialize)]
pub struct Tilt {
    /// Warnings that were given.
    pub warnings: u8,
    /// Ticks until another touch of the plumb bob counts.
    pub same_touch: u32,
    /// The game has tilted: buttons are dead and nothing counts until the ball is lost.
    pub tilted: bool,
}

impl Nudge {
    /// Where the table goes.
    fn direction(self) -> DVec2 {
        match self {
            Self::FromLeft => DVec2::X,
            Self::FromRight => -DVec2::X,
            Self::Forward => DVec2::Y,
        }
    }
}

impl Game {
    /// A player nudges the table.
    pub(super) fn nudge(&mut self, nudge: Nudge) {
        if self.table.scene.cabinet.is_some() {
            self.world.nudge(nudge.direction());
            self.emit(GameEventKind::Nudged { nudge });
        }
    }

    /// Warns, or tilts, when the plumb bob touches its ring.
    pub(super) fn heed_the_bob(&mut self) {
        let Phase::Play { seat, serve_in: 0, .. } = self.play.phase else { return };
        let tilt = &mut self.play.tilt;
        tilt.same_touch = tilt.same_touch.saturating_sub(1);
        if tilt.tilted || tilt.same_touch > 0 || !self.world.bob_touches() {
            return;
        }
        let allowed = self.table.file.cabinet.map_or(0, |cabinet| cabinet.warnings);
        self.play.tilt.same_touch = self.ticks(SAME_TOUCH);
        if self.play.tilt.warnings < allowed {
            self.play.tilt.warnings += 1;
            self.emit(GameEventKind::Warned { seat });
            return;
        }
        self.play.tilt.tilted = true;
        let score = &mut self.play.seats[usize::from(seat)].score;
        (score.bonus, score.multiplier) = (0, 1);
        for right in [false, true] {
            self.world.press(right, false);
        }
        if let Phase::Play { extra, .. } = &mut self.play.phase {
            *extra = 0;
        }
        self.play.rules.end_save(&self.table);
        // What the crowd did is over, and what holds a ball lets go of it.
        self.end_crowd();
        for magnet in 0..self.table.scene.magnets.len() {
            self.world.switch(magnet as u16, false);
        }
        self.emit(GameEventKind::Tilted { seat });
    }
}
