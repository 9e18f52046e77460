//! The protocol between client and server: what a frame holds. Frames themselves are opaque bytes to whoever carries
//! them; on TCP, each has its length in front.
//!
//! The first frame in either direction opens with a fixed [`Preamble`], so that both sides can tell each other apart
//! even when nothing else of their protocols agrees.

mod frame;
mod message;
mod version;

pub use frame::{FrameError, decode, decode_greeting, encode, encode_greeting};
pub use message::{
    ClientMessage, Hello, MOST_EVENTS, MOST_IN_LINE, Role, Roster, ServerMessage, Snapshot, Welcome, check_name,
};
pub use version::{PREAMBLE_LENGTH, Preamble, PreambleError, VERSION};

/// The largest frame that a client may send, bytes.
pub const MOST_FROM_CLIENT: usize = 1024;

/// The largest frame that a server may send, bytes: a table's text and what is around it.
pub const MOST_FROM_SERVER: usize = crate::table::MOST_TEXT + 4096;

/// Snapshots a second.
pub const SNAPSHOT_HZ: u32 = 60;

/// Ticks that a tap lasts whose press and release came within one frame of a client.
pub const TAP_TICKS: u64 = 10;

/// Seconds from one nudge of a player to the next at the least: hands slap no faster.
pub const NUDGE_SECONDS: f64 = 0.05;

#[cfg(test)]
mod tests;
