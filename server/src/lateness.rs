//! How late the room's batches of ticks are: the actual wake minus the scheduled one, counted in classes of one sixteenth.

use std::fmt;
use std::time::Duration;

/// Classes for each doubling.
const PARTS: u32 = 16;
/// Doublings that are told apart: up to a minute in microseconds.
const DOUBLINGS: u32 = 26;

/// A count of latenesses. Its size does not grow.
#[derive(Clone, PartialEq, Eq)]
pub struct Lateness {
    classes: Vec<u64>,
    count: u64,
    most: Duration,
}

impl Default for Lateness {
    fn default() -> Self {
        Self { classes: vec![0; (DOUBLINGS * PARTS) as usize], count: 0, most: Duration::ZERO }
    }
}

impl Lateness {
    /// Takes one in.
    pub(crate) fn note(&mut self, late: Duration) {
        let class = class_of(late.as_micros() as u64).min(self.classes.len() - 1);
        self.classes[class] += 1;
        self.count += 1;
        self.most = self.most.max(late);
    }

    /// Takes in every wake that was due up to `now`, from the one at `wake` on, and returns the next one. The schedule does not
    /// move: a wake that was slept or worked through was late, too.
    pub(crate) fn note_due(&mut self, mut wake: Duration, now: Duration, every: Duration) -> Duration {
        while wake <= now {
            self.note(now - wake);
            wake += every;
        }
        wake
    }

    /// The lateness that so large a share of all do not exceed, to a sixteenth.
    pub fn share(&self, share: f64) -> Duration {
        let wanted = (share * self.count as f64).ceil() as u64;
        let mut so_far = 0;
        for (class, count) in self.classes.iter().enumerate() {
            so_far += count;
            if so_far >= wanted && so_far > 0 {
                return Duration::from_micros(limit_of(class)).min(self.most);
            }
        }
        self.most
    }

    /// The largest.
    pub fn most(&self) -> Duration {
        self.most
    }
}

/// Below 16 each has its own; above, each doubling has sixteen.
fn class_of(micros: u64) -> usize {
    let doublings = micros.checked_ilog2().unwrap_or(0).saturating_sub(3);
    ((micros >> doublings) + u64::from(doublings) * u64::from(PARTS / 2)) as usize
}

/// The largest of a class.
fn limit_of(class: usize) -> u64 {
    let half = (PARTS / 2) as usize;
    let doublings = (class / half).saturating_sub(1);
    (((class - doublings * half + 1) as u64) << doublings) - 1
}

impl fmt::Debug for Lateness {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        write!(f, "{self}")
    }
}

impl fmt::Display for Lateness {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        let micros = |share| self.share(share).as_micros();
        write!(f, "p50 {} p99 {} max {}", micros(0.5), micros(0.99), self.most.as_micros())
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn a_class_holds_what_is_below_its_limit_to_a_sixteenth() {
        let mut last = 0;
        for micros in 0..200_000 {
            let class = class_of(micros);
            assert!(class >= last && class <= last + 1, "{micros}");
            last = class;
            let limit = limit_of(class);
            assert!(
                limit >= micros && limit as f64 <= micros as f64 * 1.125 + 1.0,
                "{micros} in a class up to {limit}"
            );
        }
    }

    /// The schedule moved along with whoever was late, and a stall counted once.
    #[test]
    fn wakes_that_were_missed_count_as_late() {
        let (mut lateness, millis) = (Lateness::default(), Duration::from_millis);
        assert_eq!(lateness.note_due(millis(4), millis(4), millis(4)), millis(8));
        assert_eq!(lateness.note_due(millis(8), millis(49), millis(4)), millis(52));
        assert_eq!((lateness.count, lateness.most()), (12, millis(41)));
        assert!(lateness.share(0.5) > millis(15), "{lateness}");
    }

    #[test]
    fn shares_are_of_what_was_noted() {
        let mut lateness = Lateness::default();
        for millis in 1..=100 {
            lateness.note(Duration::from_millis(millis));
        }
        let median = lateness.share(0.5).as_millis();
        assert!((50..=56).contains(&median), "{median}");
        assert_eq!(lateness.share(1.0), Duration::from_millis(100));
        assert_eq!(Lateness::default().share(0.99), Duration::ZERO);
    }
}
