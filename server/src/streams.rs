//! The room's end of its streams: what happened since the last frame of each, and the next frame when it is due. A stream
//! that nobody follows is not made.

use std::collections::{BTreeMap, VecDeque};

use bytes::Bytes;
use shared::game::Game;
use shared::protocol::{
    BoardEvent, BoardInput, Boards, DIGEST_HZ, FULL_SECONDS, Form, Full, Inputs, MOST_EVENTS, MOST_INPUTS,
    ServerMessage, Stream, digest_of_room, encode_from_server, framed,
};

use crate::account::Account;
use crate::broadcast::{Order, Orders};

/// Digests that are remembered, to be logged beside those of a client that differs: some ten seconds' of frames.
const REMEMBERED: usize = 1024;

/// A stream that somebody follows.
struct Channel {
    followers: usize,
    /// The tick that the last frame led to.
    from: u64,
    /// What was pressed since.
    inputs: Vec<BoardInput>,
    /// What happened since.
    events: Vec<BoardEvent>,
    /// The states as the last frame left them.
    boards: Boards,
    /// Frames since the last digest.
    since_digest: u8,
    /// When the next full snapshot is due that nobody asked for.
    next_full: u64,
}

/// All streams of a room.
pub(crate) struct Streams {
    room: String,
    orders: Orders,
    channels: BTreeMap<Stream, Channel>,
    /// Ticks at which something was sent, ascending, and what the room's digest was there.
    digests: VecDeque<(u64, u64)>,
}

impl Streams {
    pub(crate) fn new(room: String, orders: Orders) -> Self {
        Self { room, orders, channels: BTreeMap::new(), digests: VecDeque::new() }
    }

    /// Somebody follows a stream; the first one opens it.
    pub(crate) fn follow(&mut self, stream: Stream, games: &[Game]) {
        if let Some(channel) = self.channels.get_mut(&stream) {
            channel.followers += 1;
            return;
        }
        let full = Full::of(&self.room, games);
        let from = full.tick().unwrap_or(0);
        let channel = Channel {
            followers: 1,
            from,
            inputs: Vec::new(),
            events: Vec::new(),
            boards: Boards::new(&full.boards),
            since_digest: 0,
            next_full: from + full_ticks(games),
        };
        self.channels.insert(stream, channel);
        self.order(Order::Open { stream, full: wire(&ServerMessage::Full(Box::new(full))) });
    }

    /// Somebody does not follow it any more; the last one closes it.
    pub(crate) fn unfollow(&mut self, stream: Stream) {
        let Some(channel) = self.channels.get_mut(&stream) else { return };
        channel.followers -= 1;
        if channel.followers == 0 {
            self.channels.remove(&stream);
            self.order(Order::Close { stream });
        }
    }

    /// Something was pressed in the tick that was just played.
    pub(crate) fn note_inputs(&mut self, inputs: &[BoardInput]) {
        if inputs.is_empty() {
            return;
        }
        for (stream, channel) in &mut self.channels {
            if stream.form == Form::Inputs {
                channel.inputs.extend_from_slice(inputs);
            }
        }
    }

    /// Something happened in it.
    pub(crate) fn note_event(&mut self, event: BoardEvent) {
        for (stream, channel) in &mut self.channels {
            if stream.form == Form::State && channel.events.len() < MOST_EVENTS {
                channel.events.push(event);
            }
        }
    }

    /// Sends the frames that are due after a tick.
    pub(crate) fn send_due(&mut self, games: &[Game], account: &mut Account) {
        let Some(game) = games.first() else { return };
        let (tick, dt) = (game.tick(), game.table().scene.tick_seconds);
        let mut full = None;
        for (&stream, channel) in &mut self.channels {
            if !stream.is_due(tick, dt) {
                continue;
            }
            let (state, full, digest) = full.get_or_insert_with(|| {
                let full = Full::of(&self.room, games);
                let state = full.boards.clone();
                (state, wire(&ServerMessage::Full(Box::new(full))), digest_of_room(games))
            });
            let message = match stream.form {
                Form::State => {
                    let events = std::mem::take(&mut channel.events);
                    Some(ServerMessage::Change(Box::new(channel.boards.change_to(state, events))))
                }
                Form::Inputs => channel.next_inputs(stream, tick, *digest).map(ServerMessage::Inputs),
            };
            channel.from = tick;
            // More was pressed than a frame holds: a full snapshot says it shorter.
            let (frame, is_full) = message.map_or_else(|| (full.clone(), true), |message| (wire(&message), false));
            account.sent(&frame, is_full);
            // There may be nobody to write it any more: the server ends.
            let _ = self.orders.send(Order::Frame { stream, frame, full: full.clone() });
            if tick >= channel.next_full {
                channel.next_full = tick + full_ticks(games);
                account.sent(full, true);
                let _ = self.orders.send(Order::Frame { stream, frame: full.clone(), full: full.clone() });
            }
        }
        if let Some((.., digest)) = full {
            if self.digests.len() == REMEMBERED {
                self.digests.pop_front();
            }
            self.digests.push_back((tick, digest));
        }
    }

    /// What the room's digest was at a tick, if a frame led to it and it is remembered.
    pub(crate) fn digest_at(&self, tick: u64) -> Option<u64> {
        let place = self.digests.binary_search_by_key(&tick, |&(at, _)| at).ok()?;
        self.digests.get(place).map(|&(_, digest)| digest)
    }

    fn order(&self, order: Order) {
        // There may be nobody to carry it out any more: the server ends.
        let _ = self.orders.send(order);
    }
}

impl Channel {
    /// What was pressed since the last frame; `None` if that is more than a frame holds.
    fn next_inputs(&mut self, stream: Stream, to: u64, digest: u64) -> Option<Inputs> {
        self.since_digest += 1;
        let digest = (self.since_digest >= (stream.hz / DIGEST_HZ).max(1)).then(|| {
            self.since_digest = 0;
            digest
        });
        let inputs = std::mem::take(&mut self.inputs);
        (inputs.len() <= MOST_INPUTS).then_some(Inputs { from: self.from, to, digest, inputs })
    }
}

fn full_ticks(games: &[Game]) -> u64 {
    games.first().map_or(1, |game| (FULL_SECONDS / game.table().scene.tick_seconds) as u64)
}

/// A message as it goes on the wire.
pub(crate) fn wire(message: &ServerMessage) -> Bytes {
    framed(&encode_from_server(message)).into()
}
