//! Pacing: how many ticks are due. World time follows the wall clock without drift, and a stall is not caught up in a
//! spiral: what is more than a quarter of a second late is given up.

use std::sync::atomic::{AtomicU64, Ordering};
use std::time::{Duration, Instant};

/// The most lateness that is caught up.
const MOST_DEBT: Duration = Duration::from_millis(250);

/// Counts ticks against a clock that the caller reads.
#[derive(Debug, Clone)]
pub(crate) struct Pacer {
    ticks_per_second: f64,
    /// Clock time at which tick 0 was due.
    origin: Duration,
    /// Ticks handed out, given-up ones included.
    done: u64,
}

/// What is due.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub(crate) struct Due {
    /// Ticks to step now.
    pub(crate) ticks: u64,
    /// Ticks given up.
    pub(crate) skipped: u64,
}

impl Pacer {
    /// A pacer whose first tick is due at `now`.
    pub(crate) fn new(ticks_per_second: f64, now: Duration) -> Self {
        Self { ticks_per_second, origin: now, done: 0 }
    }

    /// What is due at `now`.
    pub(crate) fn due(&mut self, now: Duration) -> Due {
        // From the origin each time, so that no rounding adds up.
        let elapsed = now.saturating_sub(self.origin).as_secs_f64();
        let due = ((elapsed * self.ticks_per_second) as u64).saturating_sub(self.done);
        let most = (MOST_DEBT.as_secs_f64() * self.ticks_per_second) as u64;
        let ticks = due.min(most);
        self.done += due;
        Due { ticks, skipped: due - ticks }
    }
}

/// When the room wants the processor next. Where it has to share a core with the fan-out, that makes way for it then: the
/// system alone would let whoever runs run on for some milliseconds.
#[derive(Debug)]
pub(crate) struct NextWake {
    epoch: Instant,
    /// Since then; `u64::MAX` while the room is awake.
    micros: AtomicU64,
}

impl Default for NextWake {
    fn default() -> Self {
        Self { epoch: Instant::now(), micros: AtomicU64::new(u64::MAX) }
    }
}

impl NextWake {
    /// The room sleeps until `at`.
    pub(crate) fn sleep_until(&self, at: Instant) {
        self.micros.store(at.saturating_duration_since(self.epoch).as_micros() as u64, Ordering::Relaxed);
    }

    /// The room is awake.
    pub(crate) fn wake(&self) {
        self.micros.store(u64::MAX, Ordering::Relaxed);
    }

    /// Lets the room have the core if it waits for it.
    pub(crate) fn make_way(&self) {
        if self.epoch.elapsed().as_micros() as u64 >= self.micros.load(Ordering::Relaxed) {
            std::thread::yield_now();
        }
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    fn milliseconds(n: u64) -> Duration {
        Duration::from_millis(n)
    }

    #[test]
    fn an_hour_of_uneven_wakes_has_an_hour_of_ticks() {
        let mut pacer = Pacer::new(1000.0, milliseconds(5));
        let mut now = 5;
        let mut ticks = 0;
        for wake in 0..900_000 {
            now += 1 + wake % 7;
            ticks += pacer.due(milliseconds(now)).ticks;
        }
        // At 1000 Hz a tick is due each millisecond, but the last may lack a rounding.
        assert!((now - 5).abs_diff(ticks) <= 1, "{ticks} ticks in {} ms", now - 5);
    }

    #[test]
    fn a_stall_is_not_caught_up_beyond_a_quarter_of_a_second() {
        let mut pacer = Pacer::new(1000.0, Duration::ZERO);
        assert_eq!(pacer.due(milliseconds(10_000)), Due { ticks: 250, skipped: 9_750 });
        assert_eq!(pacer.due(milliseconds(10_004)), Due { ticks: 4, skipped: 0 });
    }

    #[test]
    fn a_clock_that_stands_still_has_nothing_due() {
        let mut pacer = Pacer::new(1000.0, milliseconds(7));
        assert_eq!(pacer.due(milliseconds(7)), Due { ticks: 0, skipped: 0 });
        assert_eq!(pacer.due(milliseconds(3)), Due { ticks: 0, skipped: 0 });
    }
}
