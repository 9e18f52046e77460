//! Every message, and what it means.

use serde::{Deserialize, Serialize};

use crate::game::{Action, GameEvent, GameState, SEATS};
use crate::math::bounded;

/// Longest name of a player, characters.
const MOST_NAME: usize = 24;
/// Most events in one snapshot; more are dropped, as they are only for show.
pub const MOST_EVENTS: usize = 256;
/// Most names of a line that a roster tells.
pub const MOST_IN_LINE: usize = 32;

/// What a client comes for.
#[derive(Debug, Clone, Copy, PartialEq, Eq, Serialize, Deserialize)]
pub enum Role {
    /// A seat, now or when one falls free.
    Play,
    /// To watch. It can ask for a seat later.
    Watch,
}

/// The first message of a client.
#[derive(Debug, Clone, PartialEq, Eq, Serialize, Deserialize)]
pub struct Hello {
    /// What others see; see [`check_name`].
    pub name: String,
    /// What it comes for.
    pub role: Role,
}

/// What a client says after its hello.
#[derive(Debug, Clone, Copy, PartialEq, Eq, Serialize, Deserialize)]
pub enum ClientMessage {
    /// A seated player's control.
    Act {
        /// The tick in which it acts; a tick that is past means now.
        tick: u64,
        /// A flipper, the plunger or a nudge; a seat is asked for by the other messages.
        action: Action,
    },
    /// Asks for a seat, or, if seated, for the next game to start.
    Play,
    /// Gives the seat or the place in the line back, and watches.
    Leave,
    /// Asks for a [`ServerMessage::Pong`].
    Ping {
        /// Comes back as it is.
        nonce: u64,
    },
}

/// What a server tells a client that it lets in.
#[derive(Debug, Clone, PartialEq, Eq, Serialize, Deserialize)]
pub struct Welcome {
    /// Number of this client among all that the server has seen.
    pub client: u32,
    /// Version of the server's physics.
    pub physics: u32,
    /// Digest of the table's text.
    pub table_digest: u64,
    /// The table's text.
    pub table: String,
}

/// The game at a tick: enough to go on from, bit for bit.
#[derive(Debug, Clone, PartialEq, Serialize, Deserialize)]
pub struct Snapshot {
    /// Everything that changes. The next step of it plays `state.world.tick`.
    pub state: GameState,
    /// What happened since the snapshot before, for show.
    #[serde(deserialize_with = "bounded::list::<_, _, MOST_EVENTS>")]
    pub events: Vec<GameEvent>,
}

/// Who is there.
#[derive(Debug, Clone, Default, PartialEq, Eq, Serialize, Deserialize)]
pub struct Roster {
    /// Names by seat.
    pub seats: [Option<String>; SEATS],
    /// Who waits for a seat, first in line first.
    #[serde(deserialize_with = "bounded::list::<_, _, MOST_IN_LINE>")]
    pub line: Vec<String>,
    /// How many are connected without a seat.
    pub spectators: u32,
}

/// What a server says.
#[derive(Debug, Clone, PartialEq, Serialize, Deserialize)]
pub enum ServerMessage {
    /// The hello was good.
    Welcome(Welcome),
    /// It was not, or there is no room.
    Refused {
        /// For a person to read.
        reason: String,
    },
    /// The game as it is now, [`super::SNAPSHOT_HZ`] times a second.
    Snapshot(Box<Snapshot>),
    /// Who is there, whenever that changes.
    Roster(Roster),
    /// What the receiver is, whenever that changes.
    You {
        /// The seat that it has.
        seat: Option<u8>,
        /// Its place in the line, from 1.
        line: Option<u16>,
    },
    /// The answer to a ping.
    Pong {
        /// As it was sent.
        nonce: u64,
        /// The server's tick when it answered.
        tick: u64,
    },
    /// The server ends the connection.
    Bye {
        /// For a person to read.
        reason: String,
    },
}

/// Whether a name can be shown to others: 1 to 24 characters, none of them a control character (they reach logs and
/// terminals), no blanks at its ends.
///
/// # Errors
/// What is wrong, and what would be right.
pub fn check_name(name: &str) -> Result<(), String> {
    let length = name.chars().count();
    if length == 0 || length > MOST_NAME {
        return Err(format!("a name has 1 to {MOST_NAME} characters, not {length}"));
    }
    if name.chars().any(|c| c.is_control() || is_invisible(c)) {
        return Err("a name has no control characters".to_owned());
    }
    if name.trim() != name {
        return Err("a name has no blanks at its ends".to_owned());
    }
    Ok(())
}

/// Format characters that reorder or hide text on a terminal.
fn is_invisible(c: char) -> bool {
    matches!(c, '\u{ad}' | '\u{61c}' | '\u{200b}'..='\u{200f}' | '\u{2028}'..='\u{202e}' | '\u{2060}'..='\u{206f}' | '\u{feff}')
}
