//! Ball save: for some time after the launch a ball that is lost is put into play again.

use serde::{Deserialize, Serialize};

use super::lights::Lights;
use crate::table::BallSaveRules;

/// As many as are lost in time.
const ANY: u8 = u8::MAX;

/// What is left of a ball save.
#[derive(Debug, Clone, Copy, Default, PartialEq, Eq, Serialize, Deserialize)]
pub struct BallSave {
    /// Ticks of play, those of the grace included, for which balls are still saved; 0: they are not.
    ticks: u32,
    /// How many are; 0 if none is.
    left: u8,
}

impl BallSave {
    /// Whether the next ball that is lost is saved.
    pub fn is_on(&self) -> bool {
        self.ticks > 0
    }

    /// The balls of a turn begin: what the table gives them all.
    pub(crate) fn begin(&mut self, rules: &BallSaveRules, lights: &mut Lights, dt: f64) {
        if rules.saves > 0 {
            self.start(rules, lights, rules.lasts, rules.saves, dt);
        }
    }

    /// A rule has balls saved for so many seconds from now on, as many as there are. What lasts longer is not cut short.
    pub(super) fn extend(&mut self, rules: &BallSaveRules, lights: &mut Lights, seconds: f64, dt: f64) {
        self.start(rules, lights, seconds, ANY, dt);
    }

    fn start(&mut self, rules: &BallSaveRules, lights: &mut Lights, seconds: f64, saves: u8, dt: f64) {
        self.ticks = self.ticks.max(ticks(seconds + rules.grace, dt));
        self.left = self.left.max(saves);
        lights.light(rules.light);
    }

    /// A ball is lost: whether it is saved.
    pub(crate) fn save(&mut self, rules: &BallSaveRules, lights: &mut Lights) -> bool {
        if !self.is_on() {
            return false;
        }
        if self.left < ANY {
            self.left = self.left.saturating_sub(1);
        }
        if self.left == 0 {
            self.end(rules, lights);
        }
        true
    }

    /// No ball is saved any more.
    pub(crate) fn end(&mut self, rules: &BallSaveRules, lights: &mut Lights) {
        lights.unlight(rules.light);
        *self = Self::default();
    }

    /// Ticks of play go by. Its light is out in the grace: a ball that was lost in time is still on its way down then.
    pub(crate) fn pass(&mut self, ticks: u32, rules: &BallSaveRules, lights: &mut Lights, dt: f64) {
        if !self.is_on() {
            return;
        }
        let before = self.ticks;
        self.ticks = before.saturating_sub(ticks);
        let grace = grace_ticks(rules, dt);
        if before > grace && self.ticks <= grace {
            lights.unlight(rules.light);
        }
        if self.ticks == 0 {
            *self = Self::default();
        }
    }

    /// Ticks of play until something about it changes.
    pub(crate) fn due_in(&self, rules: &BallSaveRules, dt: f64) -> Option<u32> {
        let grace = grace_ticks(rules, dt);
        match self.ticks {
            0 => None,
            ticks if ticks > grace => Some(ticks - grace),
            ticks => Some(ticks),
        }
    }

    /// Whether it is one that a table with that rule can have, whose timers count at most `most` ticks.
    pub(crate) fn fits(&self, rules: Option<&BallSaveRules>, most: u32) -> bool {
        self.ticks <= most && (self.ticks > 0) == (self.left > 0) && (rules.is_some() || !self.is_on())
    }
}

fn grace_ticks(rules: &BallSaveRules, dt: f64) -> u32 {
    // No grace has no tick.
    (rules.grace / dt + 0.5) as u32
}

/// So many seconds in ticks, at least one. Half a tick, because a quotient that should be whole may be a rounding below; a
/// cast saturates.
pub(super) fn ticks(seconds: f64, dt: f64) -> u32 {
    ((seconds / dt + 0.5) as u32).max(1)
}

/// Something in every field.
pub(super) fn sample() -> BallSave {
    BallSave { ticks: 9000, left: 1 }
}

#[cfg(test)]
mod tests {
    use super::*;

    const DT: f64 = 0.001;
    const RULES: BallSaveRules = BallSaveRules { lasts: 1.0, saves: 2, grace: 0.5, light: 4 };

    #[test]
    fn it_saves_so_many_balls_within_its_time_and_its_grace() {
        let (mut save, mut lights) = (BallSave::default(), Lights::default());
        assert!(!save.save(&RULES, &mut lights));
        save.begin(&RULES, &mut lights, DT);
        assert_eq!((lights.lit(), save.due_in(&RULES, DT)), (4, Some(1000)));
        assert!(save.save(&RULES, &mut lights));
        save.pass(1000, &RULES, &mut lights, DT);
        assert_eq!((lights.lit(), save.due_in(&RULES, DT)), (0, Some(500)), "its grace has no light");
        let mut late = save;
        assert!(save.save(&RULES, &mut lights) && !save.save(&RULES, &mut lights));
        late.pass(500, &RULES, &mut lights, DT);
        assert!(!late.save(&RULES, &mut lights));
        assert_eq!(late, BallSave::default());
    }

    #[test]
    fn a_rule_saves_as_many_as_there_are_and_cuts_nothing_short() {
        let (mut save, mut lights) = (BallSave::default(), Lights::default());
        save.begin(&RULES, &mut lights, DT);
        save.extend(&RULES, &mut lights, 0.2, DT);
        assert_eq!(save.due_in(&RULES, DT), Some(1000));
        save.extend(&RULES, &mut lights, 3.0, DT);
        assert!((0..300).all(|_| save.save(&RULES, &mut lights)));
        assert_eq!((lights.lit(), save.due_in(&RULES, DT)), (4, Some(3000)));
        save.end(&RULES, &mut lights);
        assert_eq!((lights.lit(), save.is_on()), (0, false));
    }
}
