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
/// served, `rescued` (times that a stuck or escaped ball was served again), `ticks`, and the final state's `digest`. Table, seconds and seed decide every bit of it.
pub fn run(table: &Arc<Table>, simulation: Simulation) -> String {
    let mut game = Game::new(Arc::clone(table));
    let mut bot = Bot::new(0, simulation.seed);
    let ticks = (simulation.seconds / table.scene.tick_seconds).round() as u64;
    let (mut score, mut games, mut balls, mut rescued) = (0_u64, 0_u64, 0_u64, 0_u64);
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
                GameEventKind::Rescued => rescued += 1,
                _ => {}
            }
        }
    }
    let digest = format!("{:016x}", game.digest());
    let told = json!({
        "score": score, "games": games, "balls": balls, "rescued": rescued, "ticks": ticks, "digest": digest,
    });
    told.to_string()
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::load_table;

    #[test]
    fn the_same_table_time_and_seed_give_the_same_line() {
        let table = load_table("classic").expect("it is shipped");
        let line = |seed| run(&table, Simulation { seconds: 30.0, bot: true, seed });
        assert_eq!(line(1), line(1));
        assert_ne!(line(1), line(2));
        let told: serde_json::Value = serde_json::from_str(&line(1)).expect("JSON");
        assert_eq!(told["ticks"], 30_000);
        assert!(told["score"].as_u64().is_some_and(|score| score > 0), "{told}");
        assert!(told["digest"].as_str().is_some_and(|digest| digest.len() == 16), "{told}");
    }
}
