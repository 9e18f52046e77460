//! One board of a room as it is to be seen: what was sent of it lately, and what its events leave.

use std::sync::Arc;

use shared::game::{Game, GameEvent};
use shared::table::Table;

use super::ghosts::Ghosts;
use crate::effects::Effects;
use crate::snapshots::SnapshotBuffer;

/// Seconds by which the picture may wait for the estimated time after it fell back; beyond that it jumps back.
const MOST_WAIT: f64 = 0.5;

/// A board.
#[derive(Debug)]
pub(super) struct Board {
    pub(super) snapshots: SnapshotBuffer,
    pub(super) effects: Effects,
    /// The tick that is shown.
    pub(super) shown: f64,
    /// Events before this tick have been shown.
    pub(super) events_shown: u64,
    /// What was shown since somebody last took it, to be heard.
    pub(super) fresh: Vec<GameEvent>,
    /// What was predicted and shown, but has not happened yet.
    ghosts: Ghosts,
}

impl Board {
    pub(super) fn new(table: &Arc<Table>) -> Self {
        let snapshots = SnapshotBuffer::new(Arc::clone(table));
        let ghosts = Ghosts::new(table.scene.tick_seconds);
        Self { snapshots, effects: Effects::default(), shown: 0.0, events_shown: 0, fresh: Vec::new(), ghosts }
    }

    /// Goes on to `target`. A turn that ends takes the picture from ahead of the server to behind it: it waits instead of
    /// going back.
    pub(super) fn show(&mut self, target: f64, tick_seconds: f64) {
        let waits = self.shown > target && self.shown - target < MOST_WAIT / tick_seconds;
        if !waits {
            self.shown = target;
        }
    }

    /// Something happened that is to be seen now, unless it was seen before.
    pub(super) fn note(&mut self, event: &GameEvent, table: &Table, loose: usize, now: f64) {
        let was_shown = self.ghosts.lays(event);
        if event.tick >= self.events_shown && !was_shown {
            self.effects.note(event, table, loose, now);
            self.fresh.push(*event);
        }
    }

    /// Lets be seen what was sent of the time up to what is shown.
    pub(super) fn note_sent(&mut self, table: &Table, loose: usize, now: f64) {
        let mut events = Vec::new();
        self.snapshots.take_events(self.shown, |event| events.push(event));
        events.iter().for_each(|event| self.note(event, table, loose, now));
        self.seen_until(self.shown.max(0.0) as u64);
    }

    /// Everything before this tick has been seen.
    pub(super) fn seen_until(&mut self, tick: u64) {
        self.events_shown = self.events_shown.max(tick);
    }

    /// A prediction was wrong from `tick` on, and was made anew up to what has been seen: `events` are what happens instead.
    pub(super) fn correct(&mut self, tick: u64, events: &[GameEvent]) {
        self.ghosts.rise(tick, events);
    }

    /// Takes in a game as it was sent.
    pub(super) fn push(&mut self, game: &Game, events: impl IntoIterator<Item = GameEvent>) {
        self.snapshots.push(game.clone(), events);
    }
}

#[cfg(test)]
mod tests {
    use shared::game::GameEventKind;

    use super::*;

    #[test]
    fn what_comes_later_than_it_was_predicted_is_told_once() {
        let table = Arc::new(Table::shipped("classic").unwrap().unwrap());
        let mut board = Board::new(&table);
        let kicked = |tick| GameEvent { tick, kind: GameEventKind::Kicked { element: 3, speed: 1.0 } };
        let note = |board: &mut Board, tick| board.note(&kicked(tick), &table, 1, 0.0);
        note(&mut board, 100);
        board.seen_until(110);
        board.correct(90, &[]);
        note(&mut board, 112);
        assert_eq!(board.fresh, [kicked(100)]);
        note(&mut board, 150);
        note(&mut board, 105);
        assert_eq!(board.fresh, [kicked(100), kicked(150)]);
    }
}
