//! The projector: it plays a film at any speed, step by step, and back. Going back is to begin at a state that was kept on
//! the way and to step on from there; what is kept is a cache, the film says everything.

use shared::game::{Game, GameEvent, GameState};

use super::Film;
use crate::budget::Budget;
use crate::moment::Moment;

/// How fast films can be played.
pub(crate) const SPEEDS: [f64; 8] = [0.125, 0.25, 0.5, 1.0, 2.0, 4.0, 8.0, 16.0];
/// Its place among them is the speed of the game.
const NORMAL: usize = 3;
/// Seconds of the game between two states that are kept. Less: more memory. More: a longer way after going back.
const KEEP_EVERY: f64 = 2.0;
/// States that are kept at the most, about: of long films fewer are.
const MOST_KEPT: u64 = 1024;
/// Seconds of a frame at the most: after a hitch a film does not hurry.
const MOST_FRAME: f64 = 0.1;

/// Where the inputs of a film lead to something else than was seen when it was made.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub(crate) struct Difference {
    /// The first checkpoint that differs.
    pub(crate) tick: u64,
    /// What the film says.
    pub(crate) expected: u64,
    /// What its inputs lead to.
    pub(crate) found: u64,
}

/// A state on the way.
#[derive(Debug)]
struct Keyframe {
    state: GameState,
    /// Inputs before it.
    inputs: usize,
}

/// A film that is played.
#[derive(Debug)]
pub(crate) struct Projector {
    film: Film,
    game: Game,
    /// Inputs that have acted.
    inputs: usize,
    /// Where the picture is, in ticks. The game follows, as fast as it can be computed.
    at: f64,
    /// What happens before this tick was seen before.
    seen_until: u64,
    keyframes: Vec<Keyframe>,
    keep_every: u64,
    /// Place among [`SPEEDS`].
    speed: usize,
    runs: bool,
    difference: Option<Difference>,
}

impl Projector {
    /// At the beginning of a film, running. `None`, if its beginning is no state of its table.
    pub(crate) fn new(film: Film) -> Option<Self> {
        let mut game = Game::new(film.table.clone());
        game.restore(film.start.clone()).ok()?;
        let (first, ticks) = (film.first(), film.last() - film.first());
        let every = (KEEP_EVERY / film.table.scene.tick_seconds) as u64;
        let keyframes = vec![Keyframe { state: film.start.clone(), inputs: 0 }];
        Some(Self {
            film,
            game,
            inputs: 0,
            at: first as f64,
            seen_until: first,
            keyframes,
            keep_every: every.max(ticks / MOST_KEPT).max(1),
            speed: NORMAL,
            runs: true,
            difference: None,
        })
    }

    /// Goes on for `seconds` of the local clock; `show` gets what happens and was not seen before.
    pub(crate) fn advance(&mut self, seconds: f64, budget: &mut Budget, mut show: impl FnMut(&GameEvent)) {
        if self.runs {
            self.at += seconds.clamp(0.0, MOST_FRAME) * SPEEDS[self.speed] / self.tick_seconds();
            if self.is_at_end() {
                (self.at, self.runs) = (self.film.last() as f64, false);
            }
        }
        while self.game.tick() < self.at as u64 && budget.take() {
            self.step(&mut show);
        }
        // What could not be computed in time is not skipped: then time passes slower.
        if self.runs {
            self.at = self.at.min(self.game.tick() as f64 + 1.0);
        }
    }

    fn step(&mut self, show: &mut impl FnMut(&GameEvent)) {
        let tick = self.game.tick();
        let later = &self.film.inputs[self.inputs..];
        let due = later.iter().take_while(|input| input.tick <= tick).count();
        self.game.step(&later[..due]);
        self.inputs += due;
        if tick >= self.seen_until {
            self.seen_until = tick + 1;
            self.game.events().iter().for_each(show);
        }
        let tick = self.game.tick();
        let kept = self.keyframes.last().map_or(0, |last| last.state.world.tick);
        if tick >= kept + self.keep_every {
            self.keyframes.push(Keyframe { state: self.game.state(), inputs: self.inputs });
        }
        let Ok(place) = self.film.checkpoints.binary_search_by_key(&tick, |checkpoint| checkpoint.tick) else { return };
        let (expected, found) = (self.film.checkpoints[place].digest, self.game.digest());
        if expected != found && self.difference.is_none() {
            tracing::warn!("at tick {tick} the game is {found:016x}, and when it was recorded it was {expected:016x}");
            self.difference = Some(Difference { tick, expected, found });
        }
    }

    /// Runs, or stands still. At its end it begins again.
    pub(crate) fn toggle(&mut self) {
        if self.is_at_end() {
            self.seek(self.film.first() as f64);
        }
        self.runs = !self.runs;
    }

    /// Back to the beginning.
    pub(crate) fn rewind(&mut self) {
        self.runs |= self.is_at_end();
        self.go_to(self.film.first() as f64);
    }

    /// Faster or slower by so many of [`SPEEDS`].
    pub(crate) fn change_speed(&mut self, by: isize) {
        self.speed = self.speed.saturating_add_signed(by).min(SPEEDS.len() - 1);
    }

    /// On by so many seconds of the game, or back.
    pub(crate) fn skip(&mut self, seconds: f64) {
        self.go_to(self.at + seconds / self.tick_seconds());
    }

    /// One step of so many ticks, or back, to a whole one; then it stands still.
    pub(crate) fn step_by(&mut self, ticks: f64) {
        self.runs = false;
        self.go_to((self.at + ticks).round());
    }

    fn go_to(&mut self, tick: f64) {
        let tick = tick.clamp(self.film.first() as f64, self.film.last() as f64);
        if (tick as u64) < self.game.tick() { self.seek(tick) } else { self.at = tick }
    }

    /// Back to a tick, from the last state before it that was kept.
    fn seek(&mut self, tick: f64) {
        let after = self.keyframes.partition_point(|keyframe| keyframe.state.world.tick <= tick as u64);
        let Some(keyframe) = self.keyframes.get(after.saturating_sub(1)) else { return };
        if self.game.restore(keyframe.state.clone()).is_ok() {
            (self.inputs, self.at) = (keyframe.inputs, tick);
            // From there on everything is seen again.
            self.seen_until = tick as u64;
        }
    }

    /// What is to be seen.
    pub(crate) fn moment(&self) -> Moment<'_> {
        Moment::of(&self.game, (self.at - self.game.tick() as f64).clamp(0.0, 1.0))
    }

    /// The film.
    pub(crate) fn film(&self) -> &Film {
        &self.film
    }

    /// Whether it runs.
    pub(crate) fn runs(&self) -> bool {
        self.runs
    }

    /// Whether it has come to its end.
    pub(crate) fn is_at_end(&self) -> bool {
        self.at >= self.film.last() as f64
    }

    /// How fast, beside the game.
    pub(crate) fn speed(&self) -> f64 {
        SPEEDS[self.speed]
    }

    /// Seconds of the game from its beginning to where the picture is, and to its end.
    pub(crate) fn progress(&self) -> (f64, f64) {
        let (first, dt) = (self.film.first(), self.tick_seconds());
        ((self.at - first as f64) * dt, (self.film.last() - first) as f64 * dt)
    }

    /// Where it differs from what it says, if it does.
    pub(crate) fn difference(&self) -> Option<Difference> {
        self.difference
    }

    /// The film's time, seconds from its beginning: the room may have run for days before.
    pub(crate) fn at_seconds(&self) -> f64 {
        (self.at - self.film.first() as f64) * self.tick_seconds()
    }

    /// Seconds from its beginning to a tick.
    pub(crate) fn seconds_to(&self, tick: u64) -> f64 {
        tick.saturating_sub(self.film.first()) as f64 * self.tick_seconds()
    }

    /// Ticks in so many seconds.
    pub(crate) fn ticks(&self, seconds: f64) -> f64 {
        seconds / self.tick_seconds()
    }

    fn tick_seconds(&self) -> f64 {
        self.film.table.scene.tick_seconds
    }
}
