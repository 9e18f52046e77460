//! One connection: opened, greeted, and then whatever it is for.

use std::io::{ErrorKind, Read, Write};
use std::net::SocketAddr;
use std::sync::Arc;

use mio::net::TcpStream;
use shared::protocol::{
    Deframer, MOST_FROM_SERVER, Role, ServerMessage, Stream, Welcome, decode_from_server, decode_greeting,
};
use shared::table::Table;
use socket2::SockRef;

use crate::clock::Clock;
use crate::hostile::hello;
use crate::player::Player;
use crate::report::Counts;
use crate::spectator::Spectator;

/// Bytes that the system may hold for a connection that stalls: the server is to feel it soon.
const STALLED_BUFFER: usize = 4096;

/// What a connection is for.
#[derive(Debug, Clone)]
pub(crate) enum Kind {
    /// To watch.
    Spectator { number: u32, steps: bool },
    /// To play.
    Bot { number: u32, seed: u64 },
    /// To ask for the time.
    Probe,
    /// To read nothing.
    Stalled,
    /// To send what is valid and costly. What comes back is read and thrown away.
    Flood,
    /// To be dropped.
    Churn { greets: bool },
    /// To send this, which is no message.
    Malformed { greets: bool, bytes: Vec<u8> },
}

impl Kind {
    /// Whether it is to stay until the end.
    pub(crate) fn stays(&self) -> bool {
        matches!(self, Self::Spectator { .. } | Self::Bot { .. } | Self::Probe)
    }
}

/// How far a connection has come.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub(crate) enum Stage {
    /// It is being opened.
    Opening,
    /// It has said hello.
    Greeting,
    /// It was let in.
    In,
    /// Its stream has begun; or there is nothing that it waits for.
    Begun,
}

/// Why a connection is over.
#[derive(Debug, Clone, PartialEq, Eq)]
pub(crate) enum End {
    /// The server did not let it in, and says why.
    Refused(String),
    /// The server ended it, or the network.
    Ended(String),
}

/// What connections share.
#[derive(Debug)]
pub(crate) struct Shared {
    /// What spectators ask for.
    pub(crate) stream: Stream,
    /// Nobody greets.
    pub(crate) raw: bool,
    /// The table that is played, once a server has told it.
    pub(crate) table: Option<Arc<Table>>,
    pub(crate) counts: Counts,
    pub(crate) clock: Clock,
}

#[derive(Debug)]
enum Mind {
    None,
    Spectator(Spectator),
    Player(Box<Player>),
}

/// One connection.
#[derive(Debug)]
pub(crate) struct Connection {
    pub(crate) stream: TcpStream,
    pub(crate) kind: Kind,
    pub(crate) stage: Stage,
    /// Tells it from others that had its place before.
    pub(crate) serial: u64,
    deframer: Deframer,
    mind: Mind,
}

impl Connection {
    /// Begins to open one.
    pub(crate) fn open(address: SocketAddr, kind: Kind, serial: u64) -> std::io::Result<Self> {
        let stream = TcpStream::connect(address)?;
        if matches!(kind, Kind::Stalled) {
            SockRef::from(&stream).set_recv_buffer_size(STALLED_BUFFER)?;
        }
        let deframer = Deframer::new(MOST_FROM_SERVER);
        Ok(Self { stream, kind, stage: Stage::Opening, serial, deframer, mind: Mind::None })
    }

    /// It may be open by now: then it greets.
    pub(crate) fn greet(&mut self, shared: &mut Shared) -> Result<(), End> {
        let ended = |error: std::io::Error| End::Ended(format!("it could not be opened: {error}"));
        if let Some(error) = self.stream.take_error().map_err(ended)? {
            return Err(ended(error));
        }
        match self.stream.peer_addr() {
            Ok(_) => {}
            Err(error) if error.kind() == ErrorKind::NotConnected => return Ok(()),
            Err(error) => return Err(ended(error)),
        }
        self.stream.set_nodelay(true).map_err(ended)?;
        self.stage = Stage::Greeting;
        if shared.raw {
            self.mind = Mind::Spectator(Spectator::default());
            self.stage = Stage::In;
            return Ok(());
        }
        let (name, role, stream) = match &self.kind {
            Kind::Spectator { number, .. } => (format!("spectator {number}"), Role::Watch, shared.stream),
            Kind::Bot { number, .. } => (format!("bot {number}"), Role::Play, Stream::PLAYER),
            Kind::Probe => ("probe".to_owned(), Role::Watch, Stream::SPECTATOR),
            Kind::Stalled => ("stalled".to_owned(), Role::Watch, Stream::PLAYER),
            Kind::Flood => ("flood".to_owned(), Role::Watch, Stream::PLAYER),
            Kind::Churn { greets: true } | Kind::Malformed { greets: true, .. } => {
                ("passer-by".to_owned(), Role::Watch, Stream::SPECTATOR)
            }
            Kind::Churn { greets: false } => return Ok(()),
            Kind::Malformed { greets: false, .. } => return self.send_malformed(shared),
        };
        self.send(&hello(&name, role, stream))
    }

    /// Sends what is no message; it then waits for the server to end it.
    fn send_malformed(&mut self, shared: &mut Shared) -> Result<(), End> {
        if let Kind::Malformed { bytes, .. } = &mut self.kind {
            let bytes = std::mem::take(bytes);
            self.send(&bytes)?;
            shared.counts.malformed_sent += 1;
        }
        self.stage = Stage::Begun;
        Ok(())
    }

    /// Sends bytes. There is always room for the little that a client says, unless the server does not read it.
    pub(crate) fn send(&mut self, bytes: &[u8]) -> Result<(), End> {
        match self.stream.write(bytes) {
            Ok(sent) if sent == bytes.len() => Ok(()),
            Ok(_) => Err(End::Ended("the server does not read".to_owned())),
            Err(error) if error.kind() == ErrorKind::WouldBlock => {
                Err(End::Ended("the server does not read".to_owned()))
            }
            Err(error) => Err(End::Ended(format!("writing failed: {error}"))),
        }
    }

    /// Reads what there is, or all there will be; `now` tells the time in microseconds.
    pub(crate) fn read(
        &mut self,
        (buffer, to_the_end): (&mut [u8], bool),
        now: impl Fn() -> u64,
        shared: &mut Shared,
    ) -> Result<(), End> {
        loop {
            if matches!(self.kind, Kind::Stalled) && self.stage == Stage::Begun {
                return Ok(());
            }
            match self.stream.read(buffer) {
                Ok(0) => return Err(End::Ended("the server closed the connection".to_owned())),
                Ok(length) => {
                    self.hear(&buffer[..length], now(), shared)?;
                    // The system tells when more comes.
                    if length < buffer.len() && !to_the_end {
                        return Ok(());
                    }
                }
                Err(error) if error.kind() == ErrorKind::WouldBlock => return Ok(()),
                Err(error) if error.kind() == ErrorKind::Interrupted => {}
                Err(error) => return Err(End::Ended(format!("reading failed: {error}"))),
            }
        }
    }

    /// Takes in bytes that came at `now`.
    fn hear(&mut self, bytes: &[u8], now: u64, shared: &mut Shared) -> Result<(), End> {
        let unreadable = |problem: String| End::Ended(format!("the server sent what cannot be read: {problem}"));
        // Only to be dropped or refused: what else comes does not matter.
        let heeds = self.kind.stays() || self.stage == Stage::Greeting;
        if !heeds {
            return Ok(());
        }
        self.deframer.space().extend_from_slice(bytes);
        let mut replies = Vec::new();
        loop {
            let frame = self.deframer.next_frame().map_err(|error| unreadable(error.to_string()))?;
            let Some(frame) = frame else { break };
            if self.stage == Stage::Greeting {
                let message = decode_greeting(frame).map_err(|error| unreadable(error.to_string()))?;
                self.enter(message, shared)?;
                // A welcome is long, and thousands of them would be held.
                self.deframer.space().shrink_to_fit();
                continue;
            }
            let message = decode_from_server(frame).map_err(|error| unreadable(error.to_string()))?;
            let length = frame.len() + prefix(frame.len());
            match (&message, &self.kind) {
                (ServerMessage::Bye { reason }, _) => return Err(End::Ended(reason.clone())),
                (ServerMessage::Pong { nonce, tick }, Kind::Probe | Kind::Bot { .. }) => {
                    shared.clock.hear_pong(*nonce, now, *tick);
                }
                _ => {}
            }
            let is_full = matches!(message, ServerMessage::Full(_));
            match &mut self.mind {
                Mind::None => {}
                Mind::Spectator(spectator) => {
                    shared.counts.frames += 1;
                    shared.counts.bytes += if is_full { 0 } else { length as u64 };
                    let notes = (&mut shared.counts, &mut shared.clock);
                    spectator.hear(&message, (length, now), notes, &mut replies).map_err(unreadable)?;
                }
                Mind::Player(player) => player.hear(&message, now, &mut replies).map_err(unreadable)?,
            }
            if self.stage == Stage::In && self.has_begun(is_full) {
                self.stage = Stage::Begun;
            }
        }
        if replies.is_empty() { Ok(()) } else { self.send(&replies) }
    }

    fn has_begun(&self, is_full: bool) -> bool {
        match &self.mind {
            Mind::None => is_full,
            Mind::Spectator(spectator) => spectator.has_begun(),
            Mind::Player(player) => player.has_begun(),
        }
    }

    /// The server's first answer.
    fn enter(&mut self, message: ServerMessage, shared: &mut Shared) -> Result<(), End> {
        let welcome = match message {
            ServerMessage::Welcome(welcome) => welcome,
            ServerMessage::Refused { reason } => return Err(End::Refused(reason)),
            _ => return Err(End::Ended("the server began with something else than a welcome".to_owned())),
        };
        self.stage = Stage::In;
        match self.kind {
            Kind::Spectator { steps: true, .. } => {
                self.mind = Mind::Spectator(Spectator::stepping(table_of(&welcome, shared)?));
            }
            Kind::Spectator { .. } => self.mind = Mind::Spectator(Spectator::default()),
            Kind::Bot { seed, .. } => {
                self.mind = Mind::Player(Box::new(Player::new(table_of(&welcome, shared)?, welcome.mode, seed)));
            }
            Kind::Probe => {
                table_of(&welcome, shared)?;
            }
            Kind::Stalled | Kind::Flood | Kind::Churn { .. } => self.stage = Stage::Begun,
            Kind::Malformed { .. } => self.send_malformed(shared)?,
        }
        Ok(())
    }
}

/// The table of a welcome, read once for all connections.
fn table_of(welcome: &Welcome, shared: &mut Shared) -> Result<Arc<Table>, End> {
    if let Some(table) = &shared.table
        && table.digest == welcome.table_digest
    {
        return Ok(Arc::clone(table));
    }
    let table = Table::parse("the server's table", &welcome.table).map_err(|error| End::Ended(error.to_string()))?;
    if table.digest != welcome.table_digest {
        return Err(End::Ended("the server's table has another digest than the server says".to_owned()));
    }
    shared.clock.set_tick_seconds(table.scene.tick_seconds);
    let table = Arc::new(table);
    shared.table = Some(Arc::clone(&table));
    Ok(table)
}

/// Bytes of the length in front of a frame.
fn prefix(length: usize) -> usize {
    1 + usize::from(length >= 1 << 7) + usize::from(length >= 1 << 14)
}
