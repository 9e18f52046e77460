//! `simulate`: plays a table without network, as fast as the machine can.

use std::sync::Arc;

use serde_json::json;
use shared::game::{Action, Bot, Game, GameEventKind, Input, Phase};
use shared::table::Table;

/// What is simulated.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct Simulation {
    /// World time, seconds.
    pub seconds: f64,
    /// The bot plays, game after game; else nobody does.
    pub bot: bool,
    /// What the bot's habits follow from.
    pub seed: u64,
}

/// Plays, and tells the outcome as one line of JSON: `score` (points of all games together), `games` begun, `balls`
/// served, `ticks`, and the final state's `digest`. Table, seconds and seed decide every bit of it.
pub fn run(table: &Arc<Table>, simulation: Simulation) -> String {
    let mut game = Game::new(Arc::clone(table));
    let mut bot = Bot::new(0, simulation.seed);
    let ticks = (simulation.seconds / table.scene.tick_seconds).round() as u64;
    let (mut score, mut games, mut balls) = (0_u64, 0_u64, 0_u64);
    let mut inputs = Vec::new();
    for tick in 0..ticks {
        inputs.clear();
        if simulation.bot {
            let mut act = |action| inputs.push(Input { tick, seat: 0, action });
            if tick == 0 {
                act(Action::Sit);
            }
            if !matches!(game.phase(), Phase::Play { .. }) {
                act(Action::Start);
            }
            bot.play(&game, act);
        }
        for event in game.step(&inputs) {
            match event.kind {
                GameEventKind::Points { points, .. } => score = score.saturating_add(points),
                GameEventKind::Started => games += 1,
                GameEventKind::Served { .. } => balls += 1,
                _ => {}
            }
        }
    }
    let digest = format!("{:016x}", game.digest());
    json!({ "score": score, "games": games, "balls": balls, "ticks": ticks, "digest": digest }).to_string()
}
