//! Pings: when the next one is due, and how long the way there and back takes.

use std::collections::VecDeque;

/// Seconds between two pings of whoever plays: the prediction's lead follows them.
const FAST: f64 = 0.25;
/// Seconds between two pings of everybody else; a server hangs up on who says nothing for longer.
const SLOW: f64 = 5.0;
/// Pings that may be unanswered; older ones are forgotten.
const MOST_WAITING: usize = 16;

/// The pings of a session.
#[derive(Debug, Default)]
pub(super) struct Pings {
    sent_at: Option<f64>,
    nonce: u64,
    /// Nonce, and when it was sent.
    waiting: VecDeque<(u64, f64)>,
}

impl Pings {
    /// The nonce of a ping that is to be sent now, if one is. `plays`: the person has a place.
    pub(super) fn due(&mut self, now: f64, plays: bool) -> Option<u64> {
        let pause = if plays { FAST } else { SLOW };
        if self.sent_at.is_some_and(|at| now - at < pause) {
            return None;
        }
        self.sent_at = Some(now);
        self.nonce += 1;
        if self.waiting.len() == MOST_WAITING {
            self.waiting.pop_front();
        }
        self.waiting.push_back((self.nonce, now));
        Some(self.nonce)
    }

    /// Seconds that a ping and its answer took; `None` if nobody waits for that answer.
    pub(super) fn answered(&mut self, nonce: u64, at: f64) -> Option<f64> {
        let place = self.waiting.iter().position(|(sent, _)| *sent == nonce)?;
        let seconds = at - self.waiting[place].1;
        self.waiting.drain(..=place);
        Some(seconds.max(0.0))
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn players_ping_fast_and_the_crowd_slowly() {
        let mut pings = Pings::default();
        let mut count = |from: u32, to: u32, plays| {
            (from..to).filter(|frame| pings.due(f64::from(*frame) / 60.0, plays).is_some()).count()
        };
        assert_eq!(count(0, 1200, false), 4, "in twenty seconds");
        assert_eq!(count(1200, 2400, true), 80);
        assert_eq!(count(2400, 3600, false), 4);
    }

    #[test]
    fn an_answer_is_heard_once_and_strangers_never() {
        let mut pings = Pings::default();
        let first = pings.due(1.0, true).unwrap();
        let second = pings.due(2.0, true).unwrap();
        assert_eq!(pings.answered(99, 2.5), None);
        assert_eq!(pings.answered(second, 2.5), Some(0.5));
        assert_eq!((pings.answered(second, 2.6), pings.answered(first, 2.6)), (None, None));
    }
}
