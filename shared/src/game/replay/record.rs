//! Records a game while somebody else plays it.

use super::text::ReplayFile;
use super::{Checkpoint, FORMAT_VERSION, MOST_CHECKPOINTS, MOST_INPUTS, MOST_TICKS, Replay, ReplayError};
use crate::game::{Game, Input};
use crate::physics::PHYSICS_VERSION;
use crate::table::Table;

/// Seconds of world time between two checkpoints. Less: more text and time for digests. More: a difference is located
/// less closely.
const CHECKPOINT_EVERY: f64 = 10.0;

/// Makes a [`Replay`] of a game. It is shown every step, from the first; what it holds is bounded.
#[derive(Debug, Clone)]
pub struct Recorder {
    file: ReplayFile,
    /// Ticks between two checkpoints.
    every: u64,
    /// Why there will be no replay.
    failed: Option<ReplayError>,
}

impl Recorder {
    /// For a new game on that table. `seed` is what the bot's habits follow from, and only noted.
    pub fn new(table: &Table, seed: u64) -> Self {
        let file = ReplayFile {
            format: FORMAT_VERSION,
            physics: PHYSICS_VERSION,
            table: table.name.clone(),
            table_digest: table.digest,
            seed,
            ticks: 0,
            checkpoints: Vec::new(),
            inputs: Vec::new(),
        };
        // Half a tick, because a quotient that should be whole may be a rounding below.
        let every = CHECKPOINT_EVERY / table.scene.tick_seconds + 0.5;
        Self { file, every: 1, failed: None }.every(every as u64)
    }

    /// With a checkpoint every so many ticks, at the least 1, instead of every 10 s.
    #[must_use]
    pub fn every(mut self, ticks: u64) -> Self {
        self.every = ticks.max(1);
        self
    }

    /// Takes in a step that the game has just made, with the inputs that it was given. Those for other ticks had no
    /// effect and are left out.
    ///
    /// What goes wrong is told by [`Self::finish`]; from then on nothing is recorded.
    pub fn after_step(&mut self, game: &Game, inputs: &[Input]) {
        if self.failed.is_none() {
            self.failed = self.take(game, inputs).err();
        }
    }

    fn take(&mut self, game: &Game, inputs: &[Input]) -> Result<(), ReplayError> {
        let played = self.file.ticks;
        expect_tick(game, played + 1)?;
        within("ticks", played, MOST_TICKS)?;
        for input in inputs.iter().filter(|input| input.tick == played) {
            within("inputs", self.file.inputs.len() as u64, MOST_INPUTS as u64)?;
            self.file.inputs.push(*input);
        }
        self.file.ticks += 1;
        if self.file.ticks.is_multiple_of(self.every) {
            self.check(game)?;
        }
        Ok(())
    }

    /// The replay of what was recorded: the whole game, up to now.
    ///
    /// # Errors
    /// If the game is not the one that was recorded (other table, steps missed), or too long for a replay.
    pub fn finish(mut self, game: &Game) -> Result<Replay, ReplayError> {
        if let Some(error) = self.failed {
            return Err(error);
        }
        self.file.fits(game.table())?;
        expect_tick(game, self.file.ticks)?;
        if self.file.checkpoints.last().is_none_or(|last| last.tick < self.file.ticks) {
            self.check(game)?;
        }
        Ok(Replay(self.file))
    }

    fn check(&mut self, game: &Game) -> Result<(), ReplayError> {
        within("checkpoints", self.file.checkpoints.len() as u64, MOST_CHECKPOINTS as u64)?;
        self.file.checkpoints.push(Checkpoint { tick: game.tick(), digest: game.digest() });
        Ok(())
    }
}

/// Whether one more is allowed.
fn within(what: &'static str, so_far: u64, most: u64) -> Result<(), ReplayError> {
    if so_far < most { Ok(()) } else { Err(ReplayError::TooLong { what, found: so_far + 1, most }) }
}

fn expect_tick(game: &Game, expected: u64) -> Result<(), ReplayError> {
    if game.tick() == expected { Ok(()) } else { Err(ReplayError::Missed { expected, found: game.tick() }) }
}

#[cfg(test)]
mod tests {
    use super::super::tests::classic;
    use super::*;
    use crate::game::Action;

    fn step(game: &mut Game, recorder: &mut Recorder, inputs: &[Input]) {
        game.step(inputs);
        recorder.after_step(game, inputs);
    }

    #[test]
    fn a_checkpoint_is_taken_every_ten_seconds_and_at_the_end() {
        let mut game = Game::new(classic());
        let mut recorder = Recorder::new(&classic(), 1);
        let every = u64::from(game.table().file.tick_hz) * 10;
        let of = |replay: &Replay| replay.checkpoints().iter().map(|checkpoint| checkpoint.tick).collect::<Vec<_>>();
        assert_eq!(recorder.clone().finish(&game).map(|replay| of(&replay)), Ok(vec![0]), "before the first step");
        for _ in 0..2 * every {
            step(&mut game, &mut recorder, &[]);
        }
        assert_eq!(recorder.clone().finish(&game).map(|replay| of(&replay)), Ok(vec![every, 2 * every]));
        step(&mut game, &mut recorder, &[]);
        let replay = recorder.finish(&game);
        assert_eq!(replay.as_ref().map(of), Ok(vec![every, 2 * every, 2 * every + 1]));
        let played = replay.and_then(|replay| replay.play(classic(), |_| ()));
        assert_eq!(played.map(|played| played.digest()), Ok(game.digest()));
    }

    #[test]
    fn only_inputs_that_act_are_recorded() {
        let mut game = Game::new(classic());
        let mut recorder = Recorder::new(&classic(), 1);
        let input = |tick| Input { tick, seat: 0, action: Action::Sit };
        step(&mut game, &mut recorder, &[]);
        step(&mut game, &mut recorder, &[input(2), input(1), input(0)]);
        assert_eq!(recorder.finish(&game).map(|replay| replay.inputs().to_vec()), Ok(vec![input(1)]));
    }

    #[test]
    fn a_step_that_was_missed_is_told() {
        let mut game = Game::new(classic());
        game.step(&[]);
        let mut late = Recorder::new(&classic(), 1);
        step(&mut game, &mut late, &[]);
        assert_eq!(late.finish(&game), Err(ReplayError::Missed { expected: 1, found: 2 }));

        let mut game = Game::new(classic());
        let mut recorder = Recorder::new(&classic(), 1);
        step(&mut game, &mut recorder, &[]);
        let mut twice = recorder.clone();
        twice.after_step(&game, &[]);
        assert_eq!(twice.finish(&game), Err(ReplayError::Missed { expected: 2, found: 1 }));
        game.step(&[]);
        let missed = Err(ReplayError::Missed { expected: 1, found: 2 });
        assert_eq!(recorder.clone().finish(&game), missed);
        // Nor do two wrongs make a right.
        let mut late = Recorder::new(&classic(), 1);
        late.after_step(&game, &[]);
        late.after_step(&game, &[]);
        assert_eq!(late.finish(&game), missed);
    }

    #[test]
    fn a_game_on_another_table_is_told() {
        let source = format!("{}\n// Another digest.\n", classic().source);
        let other = Table::parse("other.ron", &source).expect("a comment changes no table");
        let found = (classic().name.clone(), classic().digest);
        let expected = (other.name.clone(), other.digest);
        let result = Recorder::new(&other, 1).finish(&Game::new(classic()));
        assert_eq!(result, Err(ReplayError::Table { expected, found }));
    }

    #[test]
    fn a_game_too_long_for_a_replay_is_told_and_what_is_held_stays_bounded() {
        let too_long = |what, most: u64| Err(ReplayError::TooLong { what, found: most + 1, most });
        let sit = [Input { tick: 0, seat: 0, action: Action::Sit }];

        let mut game = Game::new(classic());
        let mut recorder = Recorder::new(&classic(), 1);
        step(&mut game, &mut recorder, &sit.repeat(MOST_INPUTS));
        assert_eq!(recorder.finish(&game).map(|replay| replay.inputs().len()), Ok(MOST_INPUTS));
        let mut game = Game::new(classic());
        let mut recorder = Recorder::new(&classic(), 1);
        step(&mut game, &mut recorder, &sit.repeat(MOST_INPUTS + 9));
        assert_eq!(recorder.file.inputs.len(), MOST_INPUTS);
        step(&mut game, &mut recorder, &[]);
        assert_eq!(recorder.finish(&game), too_long("inputs", MOST_INPUTS as u64));

        let mut game = Game::new(classic());
        let mut recorder = Recorder::new(&classic(), 1).every(0);
        for _ in 0..MOST_CHECKPOINTS {
            step(&mut game, &mut recorder, &[]);
        }
        assert!(recorder.clone().finish(&game).is_ok());
        step(&mut game, &mut recorder, &[]);
        assert_eq!(recorder.finish(&game), too_long("checkpoints", MOST_CHECKPOINTS as u64));

        // As if everything before had been recorded.
        let mut game = Game::new(classic());
        let mut state = game.state();
        state.world.tick = MOST_TICKS - 1;
        assert_eq!(game.restore(state), Ok(()));
        let mut recorder = Recorder::new(&classic(), 1);
        recorder.file.ticks = MOST_TICKS - 1;
        step(&mut game, &mut recorder, &[]);
        assert_eq!(recorder.clone().finish(&game).map(|replay| replay.ticks()), Ok(MOST_TICKS));
        step(&mut game, &mut recorder, &[]);
        assert_eq!(recorder.finish(&game), too_long("ticks", MOST_TICKS));
    }
}
