//! How much of the games may be computed for one picture: a server that tells more time than passes must not keep the
//! window from answering. What is left over is computed for the pictures that follow.

use std::time::{Duration, Instant};

/// Seconds of the game, on each board: a picture needs a sixtieth, and after a hitch this catches up fifteen times as fast
/// as time passes.
const MOST_SECONDS: f64 = 0.25;
/// Ticks of all boards together: a table may have a million of them a second.
const MOST_TICKS: u64 = 1 << 18;
/// Time that it may take, whatever a tick costs: twenty pictures a second are still drawn.
const MOST_TIME: Duration = Duration::from_millis(50);
/// Ticks between two looks at the clock.
const LOOK_EVERY: u64 = 32;

/// What is left for one picture.
#[derive(Debug)]
pub(crate) struct Budget {
    /// Ticks that all boards may be stepped by.
    ticks: u64,
    /// From the first tick on.
    until: Option<Instant>,
    /// Ticks until the next look at the clock.
    unseen: u64,
}

impl Budget {
    /// For a picture of so many boards, all of which are stepped together.
    pub(crate) fn of_picture(tick_seconds: f64, boards: usize) -> Self {
        // A cast saturates. The slowest tables must get on, too.
        let of_time = (MOST_SECONDS / tick_seconds).ceil() as u64;
        Self { ticks: of_time.min(MOST_TICKS / boards.max(1) as u64).max(1), until: None, unseen: 0 }
    }

    /// Takes one tick of it; `false` if there is none left.
    pub(crate) fn take(&mut self) -> bool {
        if self.ticks == 0 {
            return false;
        }
        if self.unseen == 0 {
            self.unseen = LOOK_EVERY;
            let now = Instant::now();
            if now > *self.until.get_or_insert(now + MOST_TIME) {
                self.ticks = 0;
                return false;
            }
        }
        self.unseen -= 1;
        self.ticks -= 1;
        true
    }

    /// One without an end, for tests that are not about it.
    #[cfg(test)]
    pub(crate) fn endless() -> Self {
        Self { ticks: u64::MAX, until: Some(Instant::now() + Duration::from_secs(3600)), unseen: 0 }
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    fn ticks(mut budget: Budget) -> u64 {
        (0..).take_while(|_| budget.take()).count() as u64
    }

    #[test]
    fn a_picture_gets_a_quarter_of_a_second_at_the_most() {
        assert_eq!(ticks(Budget::of_picture(0.001, 1)), 250);
        assert_eq!(ticks(Budget::of_picture(0.001, 4)), 250);
        assert_eq!(ticks(Budget::of_picture(1.0, 1)), 1, "the slowest tables go on too");
    }

    #[test]
    fn many_ticks_a_second_cost_no_more() {
        let budget = |boards| Budget::of_picture(1e-6, boards).ticks;
        assert_eq!([budget(1), budget(4)], [250_000, MOST_TICKS / 4]);
    }

    #[test]
    fn whatever_a_tick_costs_the_time_is_limited() {
        let mut budget = Budget { ticks: u64::MAX, until: Some(Instant::now()), unseen: 0 };
        while Instant::now() <= budget.until.unwrap() {}
        assert!(!budget.take());
        assert!(!budget.take(), "and stays so");
    }
}
