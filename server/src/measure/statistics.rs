//! Whether another motion model plays another game: statistics over many games of the bot's, where no single trajectory can be
//! compared.

use core::fmt::Write;
use std::sync::Arc;

use serde_json::{Value, json};
use shared::game::{Game, GameEventKind, Phase, Rescue};
use shared::physics::motion::Motion;
use shared::table::Table;

use crate::simulate::{Inputs, Player, Simulation};

/// Mean with its standard error.
#[derive(Debug, Clone, Copy, Default, PartialEq)]
pub struct Mean {
    /// The mean.
    pub mean: f64,
    /// Its standard error.
    pub error: f64,
}

impl Mean {
    /// Of no values: 0.
    fn of(values: &[f64]) -> Self {
        if values.is_empty() {
            return Self::default();
        }
        let count = values.len() as f64;
        let mean = values.iter().sum::<f64>() / count;
        let variance = values.iter().map(|value| (value - mean) * (value - mean)).sum::<f64>() / (count - 1.0).max(1.0);
        Self { mean, error: (variance / count).sqrt() }
    }

    /// How many standard errors of their difference two means are apart.
    fn apart(&self, other: &Self) -> f64 {
        let error = (self.error * self.error + other.error * other.error).sqrt();
        if error > 0.0 { (self.mean - other.mean).abs() / error } else { 0.0 }
    }
}

/// Many games with one setting.
#[derive(Debug, Clone, PartialEq)]
pub struct Games {
    /// The model.
    pub motion: Motion,
    /// Ticks a second.
    pub tick_hz: u32,
    /// How many ended within their time.
    pub games: usize,
    /// Points of a game.
    pub score: Mean,
    /// Seconds from a ball's serve to its loss.
    pub ball_seconds: Mean,
    /// Balls lost of those served: the rest of a game's are stuck or escaped, and served again.
    pub drains: f64,
    /// Balls served again, for each game.
    pub rescues: f64,
}

/// Longest game that is played, seconds.
const LONGEST: f64 = 900.0;

/// Plays games of the bot's with each model at the table's own rate, and exactly at other rates: the first is what the others
/// are compared with.
pub fn games(table: &Table, count: usize, say: &mut dyn FnMut(&str)) -> Result<Vec<Games>, String> {
    let own = (1.0 / table.scene.tick_seconds).round() as u32;
    let settings = [
        (Motion::Exact, own),
        (Motion::Exact, (own * 4).min(1_000_000)),
        (Motion::Exact, (own / 4).max(1)),
        (Motion::Swept, own),
        (Motion::Pixel, own),
        (Motion::Discrete, own),
    ];
    settings
        .into_iter()
        .map(|(motion, tick_hz)| {
            say(&format!("{}: {count} games with {motion} at {tick_hz} Hz", table.name));
            let table = Arc::new(table.run_with(Some(motion), Some(tick_hz))?);
            Ok(play(&table, motion, tick_hz, count))
        })
        .collect()
}

fn play(table: &Arc<Table>, motion: Motion, tick_hz: u32, count: usize) -> Games {
    let (mut scores, mut ball_times) = (Vec::new(), Vec::new());
    let (mut served, mut lost, mut rescued) = (0_u32, 0_u32, 0_u32);
    let dt = table.scene.tick_seconds;
    for seed in 0..count as u64 {
        let simulation = Simulation { seconds: LONGEST, player: Player::Bot, seed };
        let (mut game, mut player, mut inputs) = (Game::new(Arc::clone(table)), Inputs::new(&simulation), Vec::new());
        let (mut score, mut began) = (0_u64, None);
        for tick in 0..(LONGEST / dt) as u64 {
            player.choose(&game, &mut inputs);
            for event in game.step(&inputs) {
                match event.kind {
                    GameEventKind::Points { points, .. } => score += points,
                    GameEventKind::Served { .. } => {
                        served += 1;
                        began = Some(tick);
                    }
                    GameEventKind::Lost { .. } => {
                        lost += 1;
                        ball_times.extend(began.take().map(|began| (tick - began) as f64 * dt));
                    }
                    GameEventKind::Rescued { by: Rescue::Relaunch } => rescued += 1,
                    _ => {}
                }
            }
            if matches!(game.phase(), Phase::Over) {
                scores.push(score as f64);
                break;
            }
        }
    }
    Games {
        motion,
        tick_hz,
        games: scores.len(),
        score: Mean::of(&scores),
        ball_seconds: Mean::of(&ball_times),
        drains: f64::from(lost) / f64::from(served.max(1)),
        rescues: f64::from(rescued) / count.max(1) as f64,
    }
}

/// The table of them, with what differs by more than chance.
pub fn text(games: &[Games]) -> String {
    let mut out = String::from(
        "Whole games of the bot's (means, with standard errors; apart: from the first, in standard errors of the difference):\n\n\
         | model | Hz | games | score | apart | seconds a ball | apart | drained of served | served again a game |\n\
         |---|---|---|---|---|---|---|---|---|\n",
    );
    let Some(first) = games.first() else { return out };
    for told in games {
        let (score, seconds) = (told.score, told.ball_seconds);
        let _ = writeln!(
            out,
            "| {} | {} | {} | {:.0} +- {:.0} | {:.1} | {:.2} +- {:.2} | {:.1} | {:.3} | {:.3} |",
            told.motion,
            told.tick_hz,
            told.games,
            score.mean,
            score.error,
            score.apart(&first.score),
            seconds.mean,
            seconds.error,
            seconds.apart(&first.ball_seconds),
            told.drains,
            told.rescues,
        );
    }
    out
}

/// The same as JSON.
pub fn json(games: &[Games]) -> Value {
    let of = |mean: Mean| json!({ "mean": mean.mean, "standard_error": mean.error });
    games
        .iter()
        .map(|told| {
            json!({
                "model": told.motion.name(), "hz": told.tick_hz, "games": told.games, "score": of(told.score),
                "ball_seconds": of(told.ball_seconds), "drained_of_served": told.drains, "served_again_a_game": told.rescues,
            })
        })
        .collect()
}
