//! Snapshots of a room: full ones, and what changed since the one before. A room has one board, or one for each player; all
//! of them are at the same tick.

use serde::{Deserialize, Serialize};

use super::frame::{FrameError, decode_fixed, encode_fixed};
use super::{VERSION, patch};
use crate::game::{Game, GameEvent, GameState, SEATS};
use crate::math::{bounded, digest_of};
use crate::physics::PHYSICS_VERSION;

/// Most events in one change; more are dropped, as they are only for show.
pub const MOST_EVENTS: usize = 256;

/// Most bytes of the state of a board as patches see it, and of a patch: a thousand balls.
const MOST_STATE: usize = 200_000;

/// The whole room at a tick: enough to go on from, bit for bit. It says what it is, so that a receiver who came in the middle
/// and cannot ask just waits for one.
#[derive(Debug, Clone, PartialEq, Serialize, Deserialize)]
pub struct Full {
    /// The room's name.
    pub room: String,
    /// Version of the protocol.
    pub protocol: u32,
    /// Version of the physics.
    pub physics: u32,
    /// Digest of the table's text.
    pub table_digest: u64,
    /// Of each board everything that changes. The next step of it plays `world.tick`.
    #[serde(deserialize_with = "bounded::list::<_, _, SEATS>")]
    pub boards: Vec<GameState>,
}

impl Full {
    /// Of a room with these games, none of them ahead of the others.
    pub fn of(room: &str, games: &[Game]) -> Self {
        Self {
            room: room.to_owned(),
            protocol: VERSION,
            physics: PHYSICS_VERSION,
            table_digest: games.first().map_or(0, |game| game.table().digest),
            boards: games.iter().map(Game::state).collect(),
        }
    }

    /// The tick that all boards are at; `None` if there are none, or they are not at one.
    pub fn tick(&self) -> Option<u64> {
        let tick = self.boards.first()?.world.tick;
        self.boards.iter().all(|board| board.world.tick == tick).then_some(tick)
    }
}

/// Something that happened on a board.
#[derive(Debug, Clone, Copy, PartialEq, Serialize, Deserialize)]
pub struct BoardEvent {
    /// The board, from 0.
    pub board: u8,
    /// What happened.
    pub event: GameEvent,
}

/// What changed of a room from one tick to another.
#[derive(Debug, Clone, PartialEq, Serialize, Deserialize)]
pub struct Change {
    /// The tick of the snapshot or change that this one applies to.
    pub from: u64,
    /// The tick that it leads to.
    pub to: u64,
    /// For each board the patch of its state.
    #[serde(deserialize_with = "bounded::list::<_, _, SEATS>")]
    pub boards: Vec<Patch>,
    /// What happened in between, for show.
    #[serde(deserialize_with = "bounded::list::<_, _, MOST_EVENTS>")]
    pub events: Vec<BoardEvent>,
}

/// The patch of a board's state.
#[derive(Debug, Clone, PartialEq, Eq, Serialize, Deserialize)]
pub struct Patch(#[serde(with = "bytes")] pub(super) Vec<u8>);

/// The states of a room's boards in the form that patches apply to.
#[derive(Debug, Clone, Default, PartialEq, Eq)]
pub struct Boards {
    tick: u64,
    bytes: Vec<Vec<u8>>,
}

impl Boards {
    /// Of these states, all at one tick.
    pub fn new(states: &[GameState]) -> Self {
        let tick = states.first().map_or(0, |state| state.world.tick);
        Self { tick, bytes: states.iter().map(encode_fixed).collect() }
    }

    /// The tick that they are at.
    pub fn tick(&self) -> u64 {
        self.tick
    }

    /// Makes these the states, and returns what that changes.
    pub fn change_to(&mut self, states: &[GameState], events: Vec<BoardEvent>) -> Change {
        let new = Self::new(states);
        let boards = self.bytes.iter().zip(&new.bytes).map(|(old, new)| Patch(patch::patch(old, new))).collect();
        let change = Change { from: self.tick, to: new.tick, boards, events };
        *self = new;
        change
    }

    /// Applies a change, and returns the new states.
    ///
    /// # Errors
    /// If it does not apply to these states. They are then unchanged.
    pub fn apply(&mut self, change: &Change) -> Result<Vec<GameState>, FrameError> {
        let problem = |what: &str| FrameError::Malformed { length: 0, problem: what.to_owned() };
        if change.from != self.tick || change.boards.len() != self.bytes.len() {
            return Err(problem("a change of another state"));
        }
        let patches = self.bytes.iter().zip(&change.boards);
        let bytes: Option<Vec<Vec<u8>>> =
            patches.map(|(old, Patch(patch))| patch::apply(old, patch, MOST_STATE)).collect();
        let bytes = bytes.ok_or_else(|| problem("a change that does not fit its state"))?;
        let states: Vec<GameState> = bytes.iter().map(|bytes| decode_fixed(bytes)).collect::<Result<_, _>>()?;
        if states.iter().any(|state| state.world.tick != change.to) {
            return Err(problem("a change that leads to another tick than it says"));
        }
        *self = Self { tick: change.to, bytes };
        Ok(states)
    }
}

/// The digest of a room: of its only board, or of its boards' digests.
pub fn digest_of_room(games: &[Game]) -> u64 {
    match games {
        [only] => only.digest(),
        games => digest_of(&games.iter().map(Game::digest).collect::<Vec<_>>()),
    }
}

/// Bytes as a length and themselves, bounded while they are read.
mod bytes {
    use core::fmt;

    use serde::de::{Error, Visitor};
    use serde::{Deserializer, Serializer};

    use super::MOST_STATE;

    pub(super) fn serialize<S: Serializer>(bytes: &[u8], serializer: S) -> Result<S::Ok, S::Error> {
        serializer.serialize_bytes(bytes)
    }

    pub(super) fn deserialize<'de, D: Deserializer<'de>>(deserializer: D) -> Result<Vec<u8>, D::Error> {
        struct Bytes;

        impl Visitor<'_> for Bytes {
            type Value = Vec<u8>;

            fn expecting(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
                write!(f, "at most {MOST_STATE} bytes")
            }

            fn visit_bytes<E: Error>(self, bytes: &[u8]) -> Result<Vec<u8>, E> {
                if bytes.len() > MOST_STATE {
                    return Err(E::invalid_length(bytes.len(), &self));
                }
                Ok(bytes.to_vec())
            }

            fn visit_byte_buf<E: Error>(self, bytes: Vec<u8>) -> Result<Vec<u8>, E> {
                self.visit_bytes(&bytes)
            }
        }

        deserializer.deserialize_byte_buf(Bytes)
    }
}
