//! Films: games that can be watched again. A film holds how a board stood at its beginning and what was done since, and
//! now and then what that must lead to: games are stepped again, not drawn again.

mod camera;
mod file;
mod projector;

use std::sync::Arc;

use shared::game::replay::{Checkpoint, Replay, ReplayError};
use shared::game::{Game, GameState, Input, SEATS};
use shared::table::Table;

pub(crate) use camera::Camera;
pub(crate) use file::read;
pub(crate) use projector::Projector;

/// A game on one board, from before its start to its end.
#[derive(Debug, Clone)]
pub(crate) struct Film {
    table: Arc<Table>,
    /// Who had which seat, as far as that is known.
    names: [Option<String>; SEATS],
    start: GameState,
    /// Sorted by tick.
    inputs: Vec<Input>,
    /// In order; the last one is at the end.
    checkpoints: Vec<Checkpoint>,
}

impl Film {
    /// The whole of a replay.
    ///
    /// # Errors
    /// If physics or table are not those that it was recorded with.
    pub(crate) fn of_replay(replay: &Replay, table: Arc<Table>) -> Result<Self, ReplayError> {
        replay.fits(&table)?;
        let (inputs, checkpoints) = (replay.inputs().to_vec(), replay.checkpoints().to_vec());
        let start = Game::new(Arc::clone(&table)).state();
        Ok(Self { table, names: Default::default(), start, inputs, checkpoints })
    }

    /// The table that it was played on.
    pub(crate) fn table(&self) -> &Arc<Table> {
        &self.table
    }

    /// Who had a seat.
    pub(crate) fn name_of(&self, seat: usize) -> String {
        let name = self.names.get(seat).and_then(Option::as_ref);
        name.map_or_else(|| format!("PLAYER {}", seat + 1), |name| name.to_uppercase())
    }

    /// The tick at which it begins.
    pub(crate) fn first(&self) -> u64 {
        self.start.world.tick
    }

    /// The tick at which it ends.
    fn last(&self) -> u64 {
        self.checkpoints.last().map_or(self.first(), |last| last.tick)
    }
}

#[cfg(test)]
mod tests;
