//! Which lights are lit, and for how long more those are that go out by themselves. That time goes by only while a ball is in
//! play: one that waits at the plunger costs nothing.

use serde::{Deserialize, Serialize};

use crate::math::bounded;

/// Most lights of a table that its rules light for a time: a state has room for so many.
pub const MOST_TIMED_LIGHTS: usize = 16;

/// The lights of a table.
#[derive(Debug, Clone, Default, PartialEq, Eq, Serialize, Deserialize)]
pub struct Lights {
    /// One bit a light.
    lit: u64,
    /// By light, each at most once.
    #[serde(deserialize_with = "bounded::list::<_, _, MOST_TIMED_LIGHTS>")]
    timers: Vec<Timer>,
}

/// A light that goes out by itself.
#[derive(Debug, Clone, Copy, PartialEq, Eq, Serialize, Deserialize)]
struct Timer {
    /// Its place among the table's lights.
    light: u8,
    /// Until then, 1 or more.
    ticks: u32,
}

impl Timer {
    fn bit(self) -> u64 {
        1_u64.checked_shl(u32::from(self.light)).unwrap_or(0)
    }
}

impl Lights {
    /// One bit for each light that is lit.
    pub fn lit(&self) -> u64 {
        self.lit
    }

    /// For how many ticks of play more that light is lit; `None`: until a rule puts it out, or not at all.
    pub fn ticks_left(&self, light: usize) -> Option<u32> {
        self.timers.iter().find(|timer| usize::from(timer.light) == light).map(|timer| timer.ticks)
    }

    /// Makes room for every timer that there may be: later none of these functions allocates, but in a clone.
    pub(crate) fn reserve(&mut self) {
        self.timers.reserve_exact(MOST_TIMED_LIGHTS.saturating_sub(self.timers.len()));
    }

    /// Lights a set until it is put out.
    pub(crate) fn light(&mut self, set: u64) {
        self.timers.retain(|timer| timer.bit() & set == 0);
        self.lit |= set;
    }

    /// Puts a set out.
    pub(crate) fn unlight(&mut self, set: u64) {
        self.timers.retain(|timer| timer.bit() & set == 0);
        self.lit &= !set;
    }

    /// Lights a set for so many ticks from now on.
    pub(crate) fn light_for(&mut self, set: u64, ticks: u32) {
        self.light(set);
        for light in (0..64_u8).filter(|light| set >> light & 1 == 1) {
            // The check of a table sees to it that there is room.
            if self.timers.len() < MOST_TIMED_LIGHTS {
                let place = self.timers.partition_point(|timer| timer.light < light);
                self.timers.insert(place, Timer { light, ticks: ticks.max(1) });
            }
        }
    }

    /// Ticks of play go by. The lights that go out.
    pub(crate) fn pass(&mut self, ticks: u32) -> u64 {
        let mut out = 0;
        self.timers.retain_mut(|timer| {
            timer.ticks = timer.ticks.saturating_sub(ticks);
            out |= if timer.ticks == 0 { timer.bit() } else { 0 };
            timer.ticks > 0
        });
        self.lit &= !out;
        out
    }

    /// Puts out everything that would go out by itself.
    pub(crate) fn end_timers(&mut self) {
        self.lit &= self.timers.drain(..).fold(!0, |kept, timer| kept & !timer.bit());
    }

    /// Ticks of play until the first one goes out.
    pub(crate) fn due_in(&self) -> Option<u32> {
        self.timers.iter().map(|timer| timer.ticks).min()
    }

    /// Whether a table of `count` lights, which are lit for at most `most` ticks, can have them like this.
    pub(crate) fn fit(&self, count: usize, most: u32) -> bool {
        let ascend = self.timers.windows(2).all(|pair| pair[0].light < pair[1].light);
        let fits = |timer: &Timer| {
            usize::from(timer.light) < count && self.lit & timer.bit() != 0 && (1..=most).contains(&timer.ticks)
        };
        ascend && self.timers.iter().all(fits)
    }
}

/// Something in every field.
pub(super) fn sample() -> Lights {
    Lights { lit: 5, timers: vec![Timer { light: 2, ticks: 900 }] }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn a_light_goes_out_after_its_time_unless_a_rule_says_otherwise_before() {
        let mut lights = Lights::default();
        lights.light_for(0b1011, 10);
        lights.light(0b0100);
        assert_eq!((lights.lit(), lights.due_in(), lights.ticks_left(3)), (0b1111, Some(10), Some(10)));
        lights.unlight(0b0001);
        lights.light(0b0010);
        assert_eq!((lights.pass(9), lights.lit()), (0, 0b1110));
        lights.light_for(0b1_0000, 5);
        assert_eq!((lights.pass(1), lights.lit(), lights.due_in()), (0b1000, 0b1_0110, Some(4)));
        lights.end_timers();
        assert_eq!((lights.lit(), lights.due_in()), (0b0110, None));
    }

    #[test]
    fn lit_again_it_has_its_time_from_then_on() {
        let mut lights = Lights::default();
        lights.light_for(1, 10);
        lights.pass(8);
        lights.light_for(1, 10);
        assert_eq!((lights.pass(9), lights.pass(1), lights.lit()), (0, 1, 0));
    }

    #[test]
    fn lights_that_no_table_can_have_do_not_fit() {
        let timer = |light, ticks| Timer { light, ticks };
        let fits = |lit, timers: &[Timer]| Lights { lit, timers: timers.to_vec() }.fit(4, 100);
        assert!(fits(0b1001, &[timer(0, 1), timer(3, 100)]));
        assert!(!fits(0b1001, &[timer(3, 1), timer(0, 1)]), "out of order");
        assert!(!fits(0b1000, &[timer(3, 1), timer(3, 1)]), "twice");
        assert!(!fits(0b0000, &[timer(3, 1)]), "not lit");
        assert!(!fits(1 << 4, &[timer(4, 1)]) && !fits(!0, &[timer(64, 1)]) && !fits(!0, &[timer(255, 1)]), "unknown");
        assert!(!fits(0b1000, &[timer(3, 0)]) && !fits(0b1000, &[timer(3, 101)]), "no time, or too much");
    }
}
