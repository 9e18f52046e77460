//! What clients say to the room: that they come, what they want, that they go.

use bytes::Bytes;
use shared::game::SEATS;
use shared::physics::PHYSICS_VERSION;
use shared::protocol::{
    ClientMessage, Hello, REQUEST_SECONDS, Role, ServerMessage, Stream, Welcome, encode_greeting, framed,
};
use tokio::sync::oneshot;

use super::{Follower, Room};
use crate::broadcast::Order;
use crate::config::Config;
use crate::session::{SessionState, is_legal};
use crate::streams::wire;
use crate::transport::Outgoing;

impl Room {
    pub(super) fn join(
        &mut self,
        hello: Hello,
        mut transport: Box<dyn Outgoing>,
        ended: oneshot::Sender<String>,
        reply: oneshot::Sender<Option<u32>>,
    ) {
        if self.lobby.len() >= self.config.most_connections {
            let refusal = crate::connection::refusal("the server is full; try again later".to_owned());
            // One attempt: a new socket has room for a line. The connection may have ended while it waited.
            let _ = transport.try_write(&[std::io::IoSlice::new(&refusal)]);
            let _ = reply.send(None);
            return;
        }
        let client = self.next_client;
        self.next_client = self.next_client.wrapping_add(1);
        if reply.send(Some(client)).is_err() {
            return;
        }
        self.account.clients += 1;
        let Hello { name, role, stream } = hello;
        self.streams.follow(stream, &self.games);
        self.followers.insert(client, Follower { stream, next_full: 0 });
        self.order(Order::Add { client, transport, stream, greeting: self.welcome.clone(), ended });
        self.lobby.add(client, name);
        if role == Role::Play {
            let deeds = self.lobby.play(client, self.view());
            self.perform(&deeds);
        }
    }

    /// A client said something.
    pub(super) fn hear(&mut self, client: u32, message: ClientMessage) {
        let Some((state, had_place)) = self.lobby.state(client) else { return };
        if !is_legal(self.config.mode, state, had_place, &message) {
            return self.expel(client, format!("{message:?} is not for a client that is {state:?}"));
        }
        match message {
            ClientMessage::Act { tick, action } => {
                if let SessionState::Seated(place) = state {
                    self.account.controls += u64::from(self.controls.act(self.now(), place, tick, action));
                }
            }
            // A loser must not begin the next game before those who wait have come up for it.
            ClientMessage::Play if self.result.is_some() && matches!(state, SessionState::Seated(_)) => {}
            ClientMessage::Play => {
                let deeds = self.lobby.play(client, self.view());
                self.perform(&deeds);
            }
            ClientMessage::Leave => {
                let deeds = self.lobby.leave(client, self.view());
                self.perform(&deeds);
            }
            // Connections answer themselves.
            ClientMessage::Ping { .. } => {}
            ClientMessage::Stream(stream) => self.switch(client, stream),
            ClientMessage::Differs { tick, digest } => self.hear_difference(client, tick, digest),
            ClientMessage::Vote { action } => self.hear_vote(client, state, action),
        }
    }

    fn switch(&mut self, client: u32, stream: Stream) {
        let Some(follower) = self.followers.get_mut(&client) else { return };
        let before = std::mem::replace(&mut follower.stream, stream);
        self.streams.follow(stream, &self.games);
        self.order(Order::Switch { client, stream });
        self.streams.unfollow(before);
    }

    /// A client's copy is not what the game is, which must never be, or it missed something. It gets a full snapshot.
    fn hear_difference(&mut self, client: u32, tick: u64, theirs: u64) {
        self.account.differing += 1;
        let now = self.now();
        let pause = self.ticks(REQUEST_SECONDS);
        let Some(follower) = self.followers.get_mut(&client) else { return };
        if now < follower.next_full {
            return;
        }
        follower.next_full = now + pause;
        let stream = follower.stream;
        match self.streams.digest_at(tick) {
            Some(ours) if theirs != 0 => {
                tracing::warn!(client, "differs at tick {tick}: {theirs:016x} there, {ours:016x} here");
            }
            _ => tracing::info!(client, "asks for a full snapshot at tick {tick}"),
        }
        self.order(Order::Switch { client, stream });
    }

    pub(super) fn expel(&mut self, client: u32, reason: String) {
        if self.lobby.state(client).is_none() {
            return;
        }
        // Its connection says so, as far as there is room in the log.
        tracing::debug!(client, "expelled: {reason}");
        self.account.illegal += 1;
        self.forget(client, goodbye(reason));
    }

    /// A client's session is over, with that as the last word.
    pub(super) fn forget(&mut self, client: u32, last: Bytes) {
        if let Some(follower) = self.followers.remove(&client) {
            self.order(Order::Remove { client, last });
            self.streams.unfollow(follower.stream);
        }
        self.votes.withdraw(client);
        let deeds = self.lobby.remove(client, self.view());
        self.perform(&deeds);
    }

    fn hear_vote(&mut self, client: u32, state: SessionState, action: u8) {
        let is_action = usize::from(action) < self.crowd_actions();
        if is_action && !matches!(state, SessionState::Seated(_)) && self.is_playing() {
            let closes = self.now() + self.ticks(self.config.vote_time.as_secs_f64());
            self.votes.cast(client, action, closes);
        }
    }
}

pub(super) fn goodbye(reason: String) -> Bytes {
    wire(&ServerMessage::Bye { reason })
}

/// The welcome as it goes on the wire: the same for all.
pub(super) fn welcome(config: &Config) -> Bytes {
    let welcome = Welcome {
        room: config.room.clone(),
        mode: config.mode,
        places: config.places.clamp(1, SEATS) as u8,
        physics: PHYSICS_VERSION,
        table_digest: config.table.digest,
        table: config.table.source.clone(),
    };
    framed(&encode_greeting(&ServerMessage::Welcome(welcome))).into()
}
