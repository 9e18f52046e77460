//! What clients may ask for again and again, each time at the cost of a full snapshot or of everybody's attention: another
//! stream, a place, none. What comes too soon is remembered, the last of it, and done when it is due.

use shared::protocol::{REQUEST_SECONDS, Stream};

use super::{Room, WISH_PAUSE};
use crate::broadcast::Order;
use crate::session::SessionState;

/// What a client is to the streams, and what it may ask for when.
#[derive(Debug)]
pub(super) struct Follower {
    pub(super) stream: Stream,
    /// It is served at once.
    pub(super) is_prompt: bool,
    /// The tick from which on another full snapshot is given on request.
    next_full: u64,
    /// The stream that it asked for too soon.
    wanted: Option<Stream>,
    /// The tick from which on it may come and go again.
    next_move: u64,
    /// It asked too soon to play, or not to.
    moves: Option<bool>,
}

impl Follower {
    pub(super) fn new(stream: Stream) -> Self {
        Self { stream, is_prompt: false, next_full: 0, wanted: None, next_move: 0, moves: None }
    }
}

impl Room {
    /// A client wants another stream.
    pub(super) fn wish_stream(&mut self, client: u32, stream: Stream) {
        let Some(follower) = self.followers.get_mut(&client) else { return };
        follower.wanted = (stream != follower.stream).then_some(stream);
        self.wishers.insert(client);
        self.grant(client);
    }

    /// A client wants to play, or not to.
    pub(super) fn wish_place(&mut self, client: u32, plays: bool) {
        let Some(follower) = self.followers.get_mut(&client) else { return };
        follower.moves = Some(plays);
        self.wishers.insert(client);
        self.grant(client);
    }

    /// Whether a client may have a full snapshot now, which counts as given.
    pub(super) fn may_have_full(&mut self, client: u32) -> Option<Stream> {
        let (now, pause) = (self.now(), self.ticks(REQUEST_SECONDS));
        let follower = self.followers.get_mut(&client).filter(|follower| now >= follower.next_full)?;
        follower.next_full = now + pause;
        Some(follower.stream)
    }

    /// 1. Does what was asked for too soon and is due now.
    pub(super) fn grant_wishes(&mut self) {
        if self.wishers.is_empty() {
            return;
        }
        let wishers: Vec<u32> = self.wishers.iter().copied().collect();
        wishers.into_iter().for_each(|client| self.grant(client));
    }

    fn grant(&mut self, client: u32) {
        let now = self.now();
        let next_move = now + self.ticks(WISH_PAUSE);
        let Some(follower) = self.followers.get_mut(&client) else {
            self.wishers.remove(&client);
            return;
        };
        if now >= follower.next_move
            && let Some(plays) = follower.moves.take()
        {
            follower.next_move = next_move;
            self.change_place(client, plays);
        }
        let wanted = self.followers.get(&client).and_then(|follower| follower.wanted);
        if let Some(stream) = wanted
            && self.may_have_full(client).is_some()
        {
            self.switch(client, stream);
        }
        if self.followers.get(&client).is_none_or(|follower| follower.wanted.is_none() && follower.moves.is_none()) {
            self.wishers.remove(&client);
        }
    }

    fn change_place(&mut self, client: u32, plays: bool) {
        let Some((state, _)) = self.lobby.state(client) else { return };
        let deeds = match (plays, state) {
            // A loser must not begin the next game before those who wait have come up for it.
            (true, SessionState::Seated(_)) if self.result.is_some() => return,
            (true, _) => self.lobby.play(client, self.view()),
            (false, _) => self.lobby.leave(client, self.view()),
        };
        self.perform(&deeds);
    }

    fn switch(&mut self, client: u32, stream: Stream) {
        let Some(follower) = self.followers.get_mut(&client) else { return };
        follower.wanted = None;
        let before = std::mem::replace(&mut follower.stream, stream);
        self.streams.follow(stream, &self.games);
        self.order(Order::Switch { client, stream });
        self.streams.unfollow(before);
    }
}
