//! The camera: it makes films of what a client hears of a room whose stream tells what was pressed.

use std::sync::Arc;

use shared::game::replay::{Checkpoint, MOST_INPUTS};
use shared::game::{Game, GameEvent, GameEventKind, GameState, Phase};
use shared::protocol::{BoardInput, Inputs, Roster};
use shared::table::Table;

use super::Film;

/// Seconds of the game between two checkpoints. Less: more digests to make. More: a difference is found later.
const CHECKPOINT_EVERY: f64 = 1.0;

/// Films the games of a room, and keeps the last one.
#[derive(Debug)]
pub(crate) struct Camera {
    table: Arc<Table>,
    /// The boards when they were last looked at: where a film can begin.
    before: Vec<GameState>,
    /// What was pressed since, or since the beginning of the game that is filmed.
    inputs: Vec<BoardInput>,
    /// A game has begun since.
    begins: bool,
    reel: Option<Reel>,
    /// The last game, a film for each board; whether the person at the window played in it.
    films: Vec<Film>,
    is_own: bool,
}

/// A game that is being filmed.
#[derive(Debug)]
struct Reel {
    starts: Vec<GameState>,
    /// For each board.
    checkpoints: Vec<Vec<Checkpoint>>,
    is_own: bool,
}

impl Camera {
    /// One that has seen nothing.
    pub(crate) fn new(table: Arc<Table>) -> Self {
        let (before, inputs, films) = (Vec::new(), Vec::new(), Vec::new());
        Self { table, before, inputs, begins: false, reel: None, films, is_own: false }
    }

    /// Something was missed, or is not told: a game that was being filmed has no film.
    pub(crate) fn cut(&mut self) {
        self.before.clear();
        self.inputs.clear();
        (self.reel, self.begins) = (None, false);
    }

    /// The boards began anew from a full snapshot.
    pub(crate) fn begin(&mut self, games: &[Game]) {
        self.cut();
        self.before = games.iter().map(Game::state).collect();
    }

    /// What was pressed came, by which the room is known further than up to `known`.
    pub(crate) fn hear(&mut self, known: u64, inputs: &Inputs) {
        self.inputs.extend(inputs.inputs.iter().filter(|input| input.input.tick >= known));
        if self.inputs.len() > MOST_INPUTS {
            self.cut();
        }
    }

    /// Something happened on a board as it was stepped.
    pub(crate) fn see(&mut self, event: &GameEvent) {
        self.begins |= event.kind == GameEventKind::Started;
    }

    /// Looks at the boards, which were stepped further. `plays`: the person at the window has a place.
    pub(crate) fn look(&mut self, games: &[Game], roster: &Roster, plays: bool) {
        let is_known = !self.before.is_empty() && self.before.len() == games.len();
        if std::mem::take(&mut self.begins) && is_known {
            let starts = std::mem::take(&mut self.before);
            self.forget_before(&starts);
            let checkpoints = vec![Vec::new(); starts.len()];
            self.reel = Some(Reel { starts, checkpoints, is_own: false });
        }
        self.before = games.iter().map(Game::state).collect();
        let is_on = games.iter().any(|game| matches!(game.phase(), Phase::Play { .. }));
        match &mut self.reel {
            Some(reel) => {
                reel.is_own |= plays;
                reel.check(games, !is_on);
                if !is_on {
                    self.develop(roster);
                }
            }
            None => {
                let states = std::mem::take(&mut self.before);
                self.forget_before(&states);
                self.before = states;
            }
        }
    }

    /// The last game on a board, if there was one that could be filmed. One in which the person at the window played is
    /// kept until there is another such.
    pub(crate) fn film(&self, board: usize) -> Option<&Film> {
        self.films.get(board)
    }

    /// What was pressed before those states needs nobody any more.
    fn forget_before(&mut self, states: &[GameState]) {
        let tick = states.first().map_or(0, |state| state.world.tick);
        self.inputs.retain(|input| input.input.tick >= tick);
    }

    /// The game is over.
    fn develop(&mut self, roster: &Roster) {
        let Some(reel) = self.reel.take() else { return };
        if self.is_own && !reel.is_own {
            return;
        }
        self.is_own = reel.is_own;
        let single = reel.starts.len() == 1;
        let films = (0_u8..).zip(reel.starts.into_iter().zip(reel.checkpoints));
        let film = |(board, (start, checkpoints)): (u8, (GameState, Vec<Checkpoint>))| {
            let end = checkpoints.last().map_or(0, |last| last.tick);
            let of_board = self.inputs.iter().filter(|input| input.board == board && input.input.tick < end);
            let mut names = roster.places.clone();
            if !single {
                // There a place is a board, and its player has the first seat of it.
                names.swap(0, usize::from(board));
            }
            let inputs = of_board.map(|input| input.input).collect();
            Film { table: Arc::clone(&self.table), names, start, inputs, checkpoints }
        };
        self.films = films.map(film).collect();
    }
}

impl Reel {
    /// Notes what the boards are, if it is time or the end.
    fn check(&mut self, games: &[Game], is_end: bool) {
        for (game, checkpoints) in games.iter().zip(&mut self.checkpoints) {
            let every = CHECKPOINT_EVERY / game.table().scene.tick_seconds;
            let last = checkpoints.last().map_or(0, |last| last.tick);
            if game.tick() > last && (is_end || (game.tick() - last) as f64 >= every) {
                checkpoints.push(Checkpoint { tick: game.tick(), digest: game.digest() });
            }
        }
    }
}
