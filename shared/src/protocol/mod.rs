//! The protocol between client and server: what a frame holds. Frames themselves are opaque bytes to whoever carries
//! them; on TCP, each has its length in front ([`Deframer`]).
//!
//! The first frame in either direction opens with a fixed [`Preamble`], so that both sides can tell each other apart
//! even when nothing else of their protocols agrees. After the welcome, a room's stream is a full snapshot and then, so
//! many times a second, what changed ([`Form::State`]) or what was pressed ([`Form::Inputs`]); a [`Follower`] makes games
//! of it again, bit for bit.

mod follower;
mod frame;
mod framing;
mod inputs;
mod message;
mod patch;
mod snapshot;
mod stream;
mod version;

pub use follower::{FollowError, Follower, Heard, Mismatch};
pub use frame::{
    FrameError, decode, decode_from_server, decode_greeting, decode_welcome, encode, encode_from_server,
    encode_greeting,
};
pub use framing::{Deframer, FramingError, framed, length_prefix};
pub use inputs::{BoardInput, Inputs, MOST_INPUTS};
pub use message::{
    ClientMessage, Hello, MOST_IN_LINE, MOST_NAME, Mode, Role, Roster, ServerMessage, Tally, Welcome, check_name,
};
pub use snapshot::{BoardEvent, Boards, Change, Full, MOST_EVENTS, Patch, digest_of_room};
pub use stream::{Form, RATES, Stream};
pub use version::{PREAMBLE_LENGTH, Preamble, PreambleError, VERSION};

/// The largest frame that a client may send, bytes.
pub const MOST_FROM_CLIENT: usize = 1024;

/// The largest frame that a server may send, bytes: a table's text and what is around it.
pub const MOST_FROM_SERVER: usize = crate::table::MOST_TEXT + 4096;

/// Seconds between two full snapshots of a stream that nobody asked for.
pub const FULL_SECONDS: f64 = 10.0;

/// The most digests a second in a stream of inputs.
pub const DIGEST_HZ: u8 = 5;

/// Seconds between two requests for a full snapshot that are heeded.
pub const REQUEST_SECONDS: f64 = 1.0;

/// Ticks that a tap lasts whose press and release came within one frame of a client.
pub const TAP_TICKS: u64 = 10;

/// Seconds from one nudge of a player to the next at the least: hands slap no faster.
pub const NUDGE_SECONDS: f64 = 0.05;

#[cfg(test)]
mod tests;
