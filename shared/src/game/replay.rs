//! Replays: the log of a game's inputs, and the digests that whoever plays it again must arrive at. A game is a
//! function of its table and its inputs, so a replay proves its score without stating it: there is none in it to edit.
//!
//! [`Recorder`] makes one beside a game, [`Replay::to_text`] writes it, [`Replay::parse`] reads it from whoever sends
//! it, and [`Replay::play`] plays and checks it.

mod record;
#[cfg(test)]
mod tests;
mod text;

use core::fmt;
use std::sync::Arc;

use serde::{Deserialize, Serialize};
use thiserror::Error;

pub use record::Recorder;

use super::{Game, Input};
use crate::physics::PHYSICS_VERSION;
use crate::table::Table;

/// Version of the written form. Raise it when a field comes, goes or changes its meaning.
pub const FORMAT_VERSION: u32 = 1;

/// The largest replay text that is read, bytes. The longest replay that the other limits allow fits.
pub const MOST_TEXT: usize = 16 * 1024 * 1024;

/// Most ticks of a replay: 28 hours at 1 kHz. The bot's game on Classic plays at 10 million ticks a second; one in which
/// the flippers never rest is slower. Larger: a text of some bytes can keep whoever checks it busy for longer.
pub const MOST_TICKS: u64 = 100_000_000;

/// Most inputs of a replay: a game of 28 hours in which something is pressed or released every 0.8 s.
pub const MOST_INPUTS: usize = 1 << 17;

/// Most checkpoints of a replay: a week, if there is one every 10 s.
pub const MOST_CHECKPOINTS: usize = 1 << 16;

/// What the game's digest was at some moment.
#[derive(Debug, Clone, Copy, PartialEq, Eq, Serialize, Deserialize)]
#[serde(deny_unknown_fields)]
pub struct Checkpoint {
    /// Ticks that had been played: what [`Game::tick`] said.
    pub tick: u64,
    /// What [`Game::digest`] said.
    #[serde(with = "text::hex")]
    pub digest: u64,
}

/// A game that can be played again, and checked. Every one there is holds what its written form must: inputs sorted by
/// tick and before the end, checkpoints in order, the last one at the end, all within the limits.
#[derive(Debug, Clone, PartialEq, Eq)]
pub struct Replay(text::ReplayFile);

/// Why a replay was refused.
#[derive(Debug, Clone, PartialEq, Eq, Error)]
pub enum ReplayError {
    /// Its text cannot be read, or contradicts itself.
    #[error("{}", Place { file, line: *line, problem })]
    Text {
        /// The file's name, as given by the caller.
        file: String,
        /// From 1; 0 where no line is to blame.
        line: usize,
        /// What is wrong, and what would be right.
        problem: String,
    },
    /// It holds more than a replay may.
    #[error("{found} {what} are more than the {most} that a replay may have")]
    TooLong {
        /// Ticks, inputs or checkpoints.
        what: &'static str,
        /// How many there are, at the least.
        found: u64,
        /// How many there may be.
        most: u64,
    },
    /// The recorder was not shown every step of the game.
    #[error("the game is at tick {found}, the recording at {expected}: it must be shown every step, from the first")]
    Missed {
        /// The tick that would be right.
        expected: u64,
        /// The game's.
        found: u64,
    },
    /// It was recorded under other physics.
    #[error("the replay was recorded with physics {found}: only a release with those can play it, this one has {ours}")]
    Physics {
        /// The replay's.
        found: u32,
        /// This build's.
        ours: u32,
    },
    /// It was recorded on another table, or on another version of this one.
    #[error(
        "the replay was recorded on table {:?} with digest {:016x}, and this is {:?} with digest {:016x}",
        expected.0, expected.1, found.0, found.1
    )]
    Table {
        /// Name and digest of the table that would be right.
        expected: (String, u64),
        /// Of the one that was given.
        found: (String, u64),
    },
    /// Its inputs do not lead to where it says.
    #[error(
        "at tick {tick} the replay says digest {expected:016x}, but its inputs lead to {found:016x}; {}",
        agreement(*agreed)
    )]
    Diverged {
        /// Of the first checkpoint that differs.
        tick: u64,
        /// The digest that the replay states there.
        expected: u64,
        /// The digest that its inputs lead to.
        found: u64,
        /// Tick of the last checkpoint that agreed, if one did: something between the two is not what was played.
        agreed: Option<u64>,
    },
}

struct Place<'a> {
    file: &'a str,
    line: usize,
    problem: &'a str,
}

impl fmt::Display for Place<'_> {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        match self.line {
            0 => write!(f, "{}: {}", self.file, self.problem),
            line => write!(f, "{}:{line}: {}", self.file, self.problem),
        }
    }
}

fn agreement(agreed: Option<u64>) -> String {
    match agreed {
        Some(tick) => format!("they agreed at tick {tick}"),
        None => "no checkpoint before it agreed".to_owned(),
    }
}

impl Replay {
    /// Reads a replay, from whoever it came. `file` is only for error messages. What it says is then well formed, but
    /// not yet proved: that takes [`Self::play`].
    ///
    /// # Errors
    /// [`ReplayError::Text`]: the first thing that is wrong with it.
    pub fn parse(file: &str, source: &str) -> Result<Self, ReplayError> {
        text::parse(file, source).map(Self)
    }

    /// Its written form: the same text for the same replay on every machine, one line for each input.
    ///
    /// # Panics
    /// If RON cannot write plain numbers and names, which it can.
    pub fn to_text(&self) -> String {
        text::write(&self.0)
    }

    /// Plays it from tick 0 to its end, and returns the game as it is then. `each` sees the game after every step.
    ///
    /// # Errors
    /// If physics or table are not those that it was recorded with, before a step is made; or at the first checkpoint
    /// whose digest is not the game's.
    pub fn play(&self, table: Arc<Table>, mut each: impl FnMut(&Game)) -> Result<Game, ReplayError> {
        self.0.fits(&table)?;
        let mut game = Game::new(table);
        let mut inputs = self.inputs();
        let mut agreed = None;
        for &Checkpoint { tick, digest: expected } in self.checkpoints() {
            while game.tick() < tick {
                let due = inputs.iter().take_while(|input| input.tick == game.tick()).count();
                let (now, later) = inputs.split_at(due);
                game.step(now);
                inputs = later;
                each(&game);
            }
            let found = game.digest();
            if found != expected {
                return Err(ReplayError::Diverged { tick, expected, found, agreed });
            }
            agreed = Some(tick);
        }
        Ok(game)
    }

    /// Whether this build can play it on this table.
    ///
    /// # Errors
    /// If physics or table are not those that it was recorded with.
    pub fn fits(&self, table: &Table) -> Result<(), ReplayError> {
        self.0.fits(table)
    }

    /// Version of the physics that it was recorded with.
    pub fn physics(&self) -> u32 {
        self.0.physics
    }

    /// Name of the table that it was recorded on, for people.
    pub fn table_name(&self) -> &str {
        &self.0.table
    }

    /// Digest of that table.
    pub fn table_digest(&self) -> u64 {
        self.0.table_digest
    }

    /// What the bot's habits followed from, if a bot played. Nothing checks it: a game follows from its inputs alone.
    pub fn seed(&self) -> u64 {
        self.0.seed
    }

    /// Its length.
    pub fn ticks(&self) -> u64 {
        self.0.ticks
    }

    /// What players did, sorted by tick.
    pub fn inputs(&self) -> &[Input] {
        &self.0.inputs
    }

    /// What the game must be, now and then and at the end.
    pub fn checkpoints(&self) -> &[Checkpoint] {
        &self.0.checkpoints
    }
}

impl text::ReplayFile {
    /// Whether this build can play it on this table.
    fn fits(&self, table: &Table) -> Result<(), ReplayError> {
        if self.physics != PHYSICS_VERSION {
            return Err(ReplayError::Physics { found: self.physics, ours: PHYSICS_VERSION });
        }
        // The name is part of the digested text: another one is a lie that people would believe.
        if (self.table_digest, self.table.as_str()) != (table.digest, table.name.as_str()) {
            return Err(ReplayError::Table {
                expected: (self.table.clone(), self.table_digest),
                found: (table.name.clone(), table.digest),
            });
        }
        Ok(())
    }
}
