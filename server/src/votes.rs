//! What the crowd wants the house to do next: each spectator's last vote counts once, and when the time is up the action
//! with the most votes is done, if the game allows it.

use std::collections::BTreeMap;

use shared::protocol::Tally;

/// The votes of one round.
#[derive(Debug, Default)]
pub(crate) struct Votes {
    by_client: BTreeMap<u32, u8>,
    /// The tick at which they are counted.
    closes: Option<u64>,
    is_stale: bool,
}

impl Votes {
    /// A client votes; the first vote opens a round that closes at `closes`.
    pub(crate) fn cast(&mut self, client: u32, action: u8, closes: u64) {
        self.by_client.insert(client, action);
        self.closes.get_or_insert(closes);
        self.is_stale = true;
    }

    /// A client is gone, or plays now.
    pub(crate) fn withdraw(&mut self, client: u32) {
        self.is_stale |= self.by_client.remove(&client).is_some();
    }

    /// Forgets the round: the game that it was for is over.
    pub(crate) fn clear(&mut self) {
        self.is_stale |= self.closes.is_some();
        self.by_client.clear();
        self.closes = None;
    }

    /// If the round is over at `tick`: what got the most votes of that which is possible; the first one of equals.
    pub(crate) fn count(&mut self, tick: u64, actions: usize, is_possible: impl Fn(u8) -> bool) -> Option<u8> {
        if self.closes.is_none_or(|closes| tick < closes) {
            return None;
        }
        let votes = self.tally(actions).votes;
        self.clear();
        let wanted = (0_u8..).zip(votes).filter(|&(action, votes)| votes > 0 && is_possible(action));
        wanted.max_by_key(|&(action, votes)| (votes, u8::MAX - action)).map(|(action, _)| action)
    }

    /// How many votes each action has, if that changed since it was last taken.
    pub(crate) fn take_tally(&mut self, actions: usize) -> Option<Tally> {
        std::mem::take(&mut self.is_stale).then(|| self.tally(actions))
    }

    fn tally(&self, actions: usize) -> Tally {
        let mut votes = vec![0; actions];
        for &action in self.by_client.values() {
            if let Some(count) = votes.get_mut(usize::from(action)) {
                *count += 1;
            }
        }
        Tally { votes, closes: self.closes }
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn the_most_wanted_of_what_is_possible_is_done_when_the_time_is_up() {
        let mut votes = Votes::default();
        for (client, action) in [(1, 2), (2, 0), (3, 2), (4, 1), (5, 1)] {
            votes.cast(client, action, 100);
        }
        assert_eq!(votes.take_tally(3), Some(Tally { votes: vec![1, 2, 2], closes: Some(100) }));
        assert_eq!(votes.take_tally(3), None, "nothing new");
        assert_eq!(votes.count(99, 3, |_| true), None);
        assert_eq!(votes.count(100, 3, |_| true), Some(1), "the first of equals");
        assert_eq!(votes.take_tally(3), Some(Tally { votes: vec![0; 3], closes: None }));
        assert_eq!(votes.count(101, 3, |_| true), None);
    }

    #[test]
    fn what_is_not_possible_is_not_done() {
        let mut votes = Votes::default();
        votes.cast(1, 1, 5);
        votes.cast(2, 1, 5);
        votes.cast(3, 0, 5);
        assert_eq!(votes.count(5, 2, |action| action == 0), Some(0));
        votes.cast(1, 1, 9);
        assert_eq!(votes.count(9, 2, |_| false), None);
    }

    #[test]
    fn each_has_one_vote_and_takes_it_along() {
        let mut votes = Votes::default();
        votes.cast(1, 0, 5);
        votes.cast(1, 1, 9);
        votes.cast(2, 0, 9);
        assert_eq!(votes.take_tally(2), Some(Tally { votes: vec![1, 1], closes: Some(5) }));
        votes.withdraw(2);
        assert_eq!(votes.take_tally(2).map(|tally| tally.votes), Some(vec![0, 1]));
    }
}
