//! How much is said about what clients can bring about as often as they like: a log that grows by a thousand lines a second is
//! no use to anybody, and fills a disk.

use std::sync::atomic::{AtomicU64, Ordering};
use std::time::Instant;

/// Lines about one subject in a second; what happens beyond is counted.
const MOST_A_SECOND: u64 = 50;

/// Counts lines about one subject. Shared by all who speak about it; races cost a line or two.
#[derive(Debug)]
pub(crate) struct Chatter {
    subject: &'static str,
    epoch: Instant,
    second: AtomicU64,
    wanted: AtomicU64,
}

impl Chatter {
    /// About that.
    pub(crate) fn new(subject: &'static str) -> Self {
        Self { subject, epoch: Instant::now(), second: AtomicU64::new(0), wanted: AtomicU64::new(0) }
    }

    /// Whether another line may be logged now. The first one after a noisy second tells how many were left out.
    pub(crate) fn may_speak(&self) -> bool {
        let (may_speak, left_out) = self.ask(self.epoch.elapsed().as_secs());
        if left_out > 0 {
            tracing::warn!("{left_out} more lines about {} within a second were left out", self.subject);
        }
        may_speak
    }

    fn ask(&self, second: u64) -> (bool, u64) {
        let left_out = if self.second.swap(second, Ordering::Relaxed) == second {
            0
        } else {
            self.wanted.swap(0, Ordering::Relaxed).saturating_sub(MOST_A_SECOND)
        };
        (self.wanted.fetch_add(1, Ordering::Relaxed) < MOST_A_SECOND, left_out)
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn a_noisy_second_is_cut_short_and_counted() {
        let chatter = Chatter::new("nothing");
        let said = (0..1000).filter(|_| chatter.ask(7).0).count() as u64;
        assert_eq!(said, MOST_A_SECOND);
        assert_eq!(chatter.ask(8), (true, 1000 - MOST_A_SECOND));
        assert_eq!(chatter.ask(9), (true, 0));
    }
}
