//! Golden runs: worlds that are played the same way for ever, and the digests that they arrive at.
//!
//! Every machine, compiler and optimisation must arrive at the digests in `golden.txt`. Each run has two: the early one,
//! after a few impacts, tells whether the first of them went another way or only what follows from thousands.
//!
//! To write the file anew, after a change that is meant to alter them and has raised
//! [`PHYSICS_VERSION`]:
//!
//! ```sh
//! cargo run --release -p starball-shared --example golden > shared/src/golden.txt
//! ```

#[cfg(test)]
mod tests;

use std::sync::Arc;

use serde::Serialize;

use crate::game::{Action, Bot, Game, Input, Phase};
use crate::math::{Rng, digest_of};
use crate::physics::PHYSICS_VERSION;
use crate::physics::motion::Motion;
use crate::table::{SHIPPED, Table};

/// The scenes that are run besides the shipped tables: name, milliseconds up to the early digest (some five impacts), text.
pub const SCENES: &[(&str, u64, &str)] = &[
    ("box", 400, include_str!("../tables/scenes/box.ron")),
    ("gas", 100, include_str!("../tables/scenes/gas.ron")),
    ("hollow", 400, include_str!("../tables/scenes/hollow.ron")),
    ("two-floors", 3_000, include_str!("../tables/scenes/two-floors.ron")),
];

/// Seed of the bot, and of the numbers that the maths is tried with.
const SEED: u64 = 1;

/// Milliseconds up to the early digest of a table: the bot has just launched its first ball.
const TABLE_EARLY: u64 = 5_000;
/// Milliseconds up to the late digest of a table.
const TABLE_LATE: u64 = 60_000;
/// Milliseconds up to the late digest of a scene.
const SCENE_LATE: u64 = 20_000;
/// The early and the late digest of the maths are taken after so many numbers.
const MATHS_NUMBERS: (u64, u64) = (100, 100_000);

/// What a run arrived at.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub struct Golden {
    /// After a few impacts.
    pub early: u64,
    /// At the end.
    pub late: u64,
}

/// Plays a shipped table or one of [`SCENES`] with some motion model.
///
/// # Panics
/// If there is none of that name. That each of them can be read is tested.
pub fn run(name: &str, motion: Motion) -> Golden {
    let known = worlds().find(|(known, ..)| *known == name);
    let (_, early, source) = known.unwrap_or_else(|| panic!("there is no {name}"));
    let table = Table::parse(&format!("{name}.ron"), source).unwrap_or_else(|error| panic!("{error}"));
    let table = table.run_with(Some(motion), None).unwrap_or_else(|error| panic!("{error}"));
    play(&Arc::new(table), early)
}

/// The digests of everything that the world takes from `libm` or might, and of roundings, casts and the generator: when a
/// world goes another way on some machine and this does not, then it is not for its functions.
pub fn maths() -> Golden {
    let mut rng = Rng::new(SEED);
    let mut digest = 0;
    let mut early = 0;
    for number in 1..=MATHS_NUMBERS.1 {
        let [a, b] = [rng.between(-10.0, 10.0), rng.between(-1.0, 1.0)];
        // From 1e-13 to 1e13.
        let positive = libm::exp(3.0 * a);
        digest = digest_of(&(digest, functions(a, b, positive), rng.gaussian()));
        if number == MATHS_NUMBERS.0 {
            early = digest;
        }
    }
    Golden { early, late: digest }
}

/// Functions of any number, of one within -1 to 1, and of a positive one. None of the results is NaN, whose bits may differ.
fn functions(a: f64, b: f64, positive: f64) -> impl Serialize {
    let circular = (libm::sincos(a), libm::sin(a), libm::cos(a), libm::tan(a));
    let inverse = (libm::asin(b), libm::acos(b), libm::atan(a), libm::atan2(a, b));
    let powers = (libm::exp(a), libm::log(positive), libm::pow(positive, b), libm::cbrt(a), libm::hypot(a, b));
    let exact = (positive.sqrt(), libm::sqrt(positive), a / b, a.floor(), a.ceil(), a.round(), a % b);
    // Beyond what there is, a cast gives the largest or the smallest that there is.
    let casts = (a as i64, b as u32, positive as u32, positive as f32, (a * 1e9) as i32);
    (circular, inverse, powers, exact, casts)
}

/// The line of `golden.txt` that a run makes, by its place in there; `None` beyond the last.
pub fn line(place: usize) -> Option<String> {
    let motion = Motion::ALL[place % Motion::ALL.len()];
    let (name, model, Golden { early, late }) = match worlds().nth(place / Motion::ALL.len()) {
        Some((name, ..)) => (name, motion.name(), run(name, motion)),
        None if place == worlds().count() * Motion::ALL.len() => ("maths", "-", maths()),
        None => return None,
    };
    Some(format!("{name:<10} {model:<8} {early:016x} {late:016x}"))
}

/// What `golden.txt` should say, played anew.
pub fn file() -> String {
    let head = format!(
        "# Golden digests, early and late, of every run; src/golden.rs says what they are and writes this file.\n\
         physics {PHYSICS_VERSION}\n"
    );
    (0..).map_while(line).fold(head, |text, line| text + &line + "\n")
}

/// Tables and scenes in the order of the file, as in [`SCENES`].
fn worlds() -> impl Iterator<Item = (&'static str, u64, &'static str)> {
    let tables = SHIPPED.iter().map(|table| (table.name, TABLE_EARLY, table.source));
    tables.chain(SCENES.iter().copied())
}

/// Plays a table as the bot does from a fixed seed, or lets a scene go its way.
fn play(table: &Arc<Table>, early: u64) -> Golden {
    let late = if table.has_rules { TABLE_LATE } else { SCENE_LATE };
    let ticks = |milliseconds: u64| milliseconds * u64::from(table.file.tick_hz) / 1000;
    let mut game = Game::new(Arc::clone(table));
    let mut bot = Bot::new(0, SEED);
    let mut inputs = Vec::new();
    let mut play_until = |end: u64| {
        while game.tick() < end {
            let tick = game.tick();
            inputs.clear();
            if table.has_rules {
                let mut act = |action| inputs.push(Input { tick, seat: 0, action });
                if tick == 0 {
                    act(Action::Sit);
                }
                if !matches!(game.phase(), Phase::Play { .. }) {
                    act(Action::Start);
                }
                bot.play(&game, act);
            }
            game.step(&inputs);
        }
        game.digest()
    };
    Golden { early: play_until(ticks(early)), late: play_until(ticks(late)) }
}
