//! Every message, and what it means.

use serde::{Deserialize, Serialize};

use super::inputs::Inputs;
use super::snapshot::{Change, Full};
use super::stream::Stream;
use crate::game::{Action, SEATS};
use crate::math::bounded;
use crate::table::MOST_CROWD_ACTIONS;

/// Longest name of a player, characters.
pub const MOST_NAME: usize = 24;
/// Longest reason that a server gives, characters.
const MOST_REASON: usize = 1000;
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
    /// What it wants to be sent.
    pub stream: Stream,
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
    /// From here on another stream. It begins with a full snapshot.
    Stream(Stream),
    /// What was sent does not lead to the digest that was sent, or has a gap: asks for a full snapshot. Heeded once a second.
    Differs {
        /// The first tick at which it differs.
        tick: u64,
        /// What the receiver's copy has there; 0 if it has nothing.
        digest: u64,
    },
    /// A spectator's vote for what the house does next. The last one counts.
    Vote {
        /// Its place among the table's actions of the crowd.
        action: u8,
    },
    /// Lets the room stand still, or go on, where players may do that. No tick passes meanwhile, so it is no input of the game: a
    /// replay knows nothing of it.
    Pause(bool),
}

/// How a room is played.
#[derive(Debug, Clone, Copy, PartialEq, Eq, Serialize, Deserialize)]
pub enum Mode {
    /// Up to four players alternate ball by ball on one board; the winner stays, the next in line comes up.
    Challenge,
    /// One player against the spectators, who vote for what the table does to the player.
    Crowd,
    /// Each player on a board of their own, at the same time.
    HeadToHead,
}

/// What a server tells a client that it lets in.
#[derive(Debug, Clone, PartialEq, Eq, Serialize, Deserialize)]
pub struct Welcome {
    /// The room's name.
    pub room: String,
    /// How it is played.
    pub mode: Mode,
    /// Places for players in it.
    pub places: u8,
    /// Version of the server's physics.
    pub physics: u32,
    /// Digest of the table's text.
    pub table_digest: u64,
    /// The table's text.
    pub table: String,
}

/// Who is there.
#[derive(Debug, Clone, Default, PartialEq, Eq, Serialize, Deserialize)]
pub struct Roster {
    /// Names by place: a seat on the one board, or the player of each board.
    pub places: [Option<String>; SEATS],
    /// Who waits for a place, first in line first; the first [`MOST_IN_LINE`] of them.
    #[serde(deserialize_with = "bounded::list::<_, _, MOST_IN_LINE>")]
    pub line: Vec<String>,
    /// How many wait.
    pub waiting: u32,
    /// How many are connected without a place.
    pub spectators: u32,
    /// Who won the last game and stayed: the place, and how many they have won in a row.
    pub champion: Option<(u8, u32)>,
}

/// What the crowd is voting for.
#[derive(Debug, Clone, Default, PartialEq, Eq, Serialize, Deserialize)]
pub struct Tally {
    /// Votes for each of the table's actions of the crowd.
    #[serde(deserialize_with = "bounded::list::<_, _, MOST_CROWD_ACTIONS>")]
    pub votes: Vec<u32>,
    /// The tick at which they are counted; `None` while nobody votes.
    pub closes: Option<u64>,
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
    /// The whole room at a tick: at the start of a stream, on request, and every ten seconds.
    Full(Box<Full>),
    /// What changed since the last full snapshot or change of this stream.
    Change(Box<Change>),
    /// Who is there, when that changes.
    Roster(Roster),
    /// What the crowd is voting for, when that changes.
    Tally(Tally),
    /// What the receiver is, whenever that changes.
    You {
        /// Number of this client among all that the server has seen.
        client: u32,
        /// The place that it has.
        place: Option<u8>,
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
    /// Whether the room stands still. Only where players may let it: at the beginning, and when it changes.
    Paused(bool),
    /// What was pressed since the frame before: a frame with a layout of its own.
    #[serde(skip)]
    Inputs(Inputs),
}

impl ServerMessage {
    /// Whether its words can be shown: names are names, and reasons are lines of text. A server is not to be trusted either.
    ///
    /// # Errors
    /// What is wrong.
    pub fn check(&self) -> Result<(), String> {
        match self {
            Self::Welcome(welcome) => check_name(&welcome.room),
            Self::Refused { reason } | Self::Bye { reason } => {
                if reason.chars().count() > MOST_REASON || reason.chars().any(|c| c.is_control() || is_invisible(c)) {
                    return Err(format!("a reason is one line of at most {MOST_REASON} characters"));
                }
                Ok(())
            }
            Self::Roster(roster) => {
                roster.places.iter().flatten().chain(&roster.line).try_for_each(|name| check_name(name))
            }
            _ => Ok(()),
        }
    }
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
