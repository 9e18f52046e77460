//! What clients say to the room: that they come, what they want, that they go.

use bytes::Bytes;
use shared::game::SEATS;
use shared::physics::PHYSICS_VERSION;
use shared::protocol::{ClientMessage, Hello, Role, ServerMessage, Welcome, encode_greeting, framed};
use tokio::sync::oneshot;

use super::Room;
use super::wishes::Follower;
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
        self.account.clients += 1;
        let Hello { name, role, stream } = hello;
        self.streams.follow(stream, &self.games);
        self.followers.insert(client, Follower::new(stream));
        self.order(Order::Add { client, transport, stream, greeting: self.welcome.clone(), ended });
        self.lobby.add(client, name);
        if role == Role::Play {
            let deeds = self.lobby.play(client, self.view());
            self.perform(&deeds);
        }
        // Only now: what the connection says next must find it.
        if reply.send(Some(client)).is_err() {
            self.forget(client, Bytes::new());
        }
    }

    /// A client said something.
    pub(super) fn hear(&mut self, client: u32, message: ClientMessage) {
        let Some((state, had_place)) = self.lobby.state(client) else { return };
        if !is_legal(self.config.mode, self.config.pause, state, had_place, &message) {
            return self.expel(client, format!("{message:?} is not for a client that is {state:?}"));
        }
        match message {
            ClientMessage::Act { tick, action } => {
                if let SessionState::Seated(place) = state {
                    self.account.controls += u64::from(self.controls.act(self.now(), place, tick, action));
                }
            }
            ClientMessage::Play => self.wish_place(client, true),
            ClientMessage::Leave => {
                // A wish may have to wait for a tick.
                self.resume_for(client);
                self.wish_place(client, false);
            }
            // Connections answer themselves.
            ClientMessage::Ping { .. } => {}
            ClientMessage::Stream(stream) => self.wish_stream(client, stream),
            ClientMessage::Differs { tick, digest } => self.hear_difference(client, tick, digest),
            ClientMessage::Vote { action } => self.hear_vote(client, state, action),
            ClientMessage::Pause(stands_still) => self.hear_pause(client, state, stands_still),
        }
    }

    /// A client's copy is not what the game is, which must never be, or it missed something. It gets a full snapshot.
    fn hear_difference(&mut self, client: u32, tick: u64, theirs: u64) {
        if theirs == 0 {
            self.account.gaps += 1;
            tracing::debug!(client, "asks for a full snapshot at tick {tick}");
        } else {
            self.account.differing += 1;
            if self.chatter.may_speak() {
                let ours = self.streams.digest_at(tick);
                let ours = ours.map_or_else(|| "none remembered".to_owned(), |digest| format!("{digest:016x}"));
                tracing::warn!(client, "differs at tick {tick}: {theirs:016x} there, {ours} here");
            }
        }
        if let Some(stream) = self.may_have_full(client) {
            self.order(Order::Switch { client, stream });
        }
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
        self.resume_for(client);
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
