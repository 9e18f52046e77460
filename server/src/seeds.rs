//! `simulate --bench --seeds`: what a table costs over many seeds of the bot, and whether it was played at all meanwhile.

use std::sync::Arc;
use std::time::Instant as Clock;

use serde_json::{Value, json};
use shared::game::{Game, GameEventKind, Input};
use shared::math::digest_of;
use shared::physics::EventKind;
use shared::physics::ball::Support;
use shared::physics::scene::Presence;
use shared::table::Table;

use crate::simulate::{Inputs, Player, Simulation};

/// What happened in the runs of all seeds.
#[derive(Debug, Clone, Copy, Default)]
struct Happened {
    ticks: u64,
    /// With a ball on the table.
    with_ball: u64,
    /// With a ball that is not on the plunger.
    off_plunger: u64,
    flips: u64,
    /// With whatever takes part in the physics: not the passing of a rollover.
    impacts: u64,
    points: u64,
    balls: u64,
    rescued: u64,
    /// Of the final digests, in the order of the seeds.
    digest: u64,
}

/// Plays `seeds` seeds from the simulation's own on, each `runs` times with the bot and as often by the inputs that the bot
/// chose, all on this thread. One line of JSON tells what a simulated second cost in microseconds, each seed's by its median run
/// (`with_bot`, `by_inputs`: the median, least and most of the seeds, and the mean, which is the cost of all of it); the bot's
/// own share of that; the share of ticks with a ball on the table and with one that is not on the plunger; flips and
/// impacts in a simulated second; and, as a check that two builds play the same, points, balls, rescues and a digest.
///
/// # Panics
/// If `seeds` or `runs` is 0.
pub fn bench(table: &Arc<Table>, simulation: &Simulation, seeds: u32, runs: u32) -> Value {
    let ticks = simulation.ticks(table).max(1);
    let world_seconds = ticks as f64 * table.scene.tick_seconds;
    let mut happened = Happened::default();
    let (mut with_bot, mut by_inputs) = (Vec::new(), Vec::new());
    for seed in (simulation.seed..).take(seeds as usize) {
        let bot = Simulation { seed, player: Player::Bot, ..*simulation };
        let replayed = Simulation { player: Player::Inputs(watch(table, &bot, ticks, &mut happened)), ..bot };
        let cost =
            |simulation| median((0..runs).map(|_| time(table, simulation, ticks) * 1e6 / world_seconds).collect());
        with_bot.push(cost(&bot));
        by_inputs.push(cost(&replayed));
    }
    let mean = |costs: &[f64]| costs.iter().sum::<f64>() / costs.len() as f64;
    let bot_share = 1.0 - mean(&by_inputs) / mean(&with_bot);
    let (all_seconds, all_ticks) = (f64::from(seeds) * world_seconds, happened.ticks as f64);
    json!({
        "seeds": seeds,
        "seconds": world_seconds,
        "runs": runs,
        "us_per_simulated_second": { "with_bot": spread(&with_bot), "by_inputs": spread(&by_inputs), "bot_share": rounded(bot_share) },
        "with_ball_share": rounded(happened.with_ball as f64 / all_ticks),
        "off_plunger_share": rounded(happened.off_plunger as f64 / all_ticks),
        "flips_per_second": rounded(happened.flips as f64 / all_seconds),
        "impacts_per_second": rounded(happened.impacts as f64 / all_seconds),
        "points": happened.points,
        "balls": happened.balls,
        "rescued": happened.rescued,
        "digest": format!("{:016x}", happened.digest),
    })
}

/// Plays once untimed, adds up what happened, and returns the inputs.
fn watch(table: &Arc<Table>, simulation: &Simulation, ticks: u64, happened: &mut Happened) -> Vec<Input> {
    let mut game = Game::new(Arc::clone(table));
    let mut player = Inputs::new(simulation);
    let (mut log, mut inputs) = (Vec::new(), Vec::new());
    for _ in 0..ticks {
        player.choose(&game, &mut inputs);
        log.extend_from_slice(&inputs);
        for event in game.step(&inputs) {
            match event.kind {
                GameEventKind::Points { points, .. } => happened.points = happened.points.saturating_add(points),
                GameEventKind::Flipped { .. } => happened.flips += 1,
                GameEventKind::Served { .. } => happened.balls += 1,
                GameEventKind::Rescued { .. } => happened.rescued += 1,
                _ => {}
            }
        }
        let world = game.world();
        happened.impacts += world.events().iter().filter(|event| is_impact(event.kind)).count() as u64;
        let balls = &world.state().balls;
        let lies_ready = |support| match support {
            Support::Plunger(_) => true,
            // A plunger at rest is a wall.
            Support::Line(i) => matches!(table.scene.colliders[usize::from(i)].presence, Presence::PlungerHome(_)),
            _ => false,
        };
        happened.with_ball += u64::from(!balls.is_empty());
        happened.off_plunger += u64::from(balls.iter().any(|ball| !lies_ready(ball.support)));
    }
    happened.ticks += ticks;
    happened.digest = digest_of(&(happened.digest, game.digest()));
    log
}

/// Whether a ball met something solid.
fn is_impact(kind: EventKind) -> bool {
    matches!(
        kind,
        EventKind::Touched { .. } | EventKind::Kicked { .. } | EventKind::Felled { .. } | EventKind::Met { .. }
    )
}

/// Seconds that one run takes.
fn time(table: &Arc<Table>, simulation: &Simulation, ticks: u64) -> f64 {
    let mut game = Game::new(Arc::clone(table));
    let mut player = Inputs::new(simulation);
    let mut inputs = Vec::new();
    let begun = Clock::now();
    for _ in 0..ticks {
        player.choose(&game, &mut inputs);
        game.step(&inputs);
    }
    begun.elapsed().as_secs_f64()
}

fn median(mut costs: Vec<f64>) -> f64 {
    costs.sort_by(f64::total_cmp);
    costs[costs.len() / 2]
}

fn spread(costs: &[f64]) -> Value {
    let mut sorted = costs.to_vec();
    sorted.sort_by(f64::total_cmp);
    json!({
        "median": rounded(sorted[sorted.len() / 2]),
        "least": rounded(sorted[0]),
        "most": rounded(sorted[sorted.len() - 1]),
        "mean": rounded(sorted.iter().sum::<f64>() / sorted.len() as f64),
    })
}

/// To three digits behind the point.
fn rounded(number: f64) -> f64 {
    (number * 1e3).round() / 1e3
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::load_table;

    #[test]
    fn a_bench_over_seeds_plays_the_same_whatever_the_runs() {
        let table = load_table("classic").expect("it is shipped");
        let simulation = Simulation { seconds: 10.0, player: Player::Bot, seed: 1 };
        let told = [1, 2].map(|runs| bench(&table, &simulation, 3, runs));
        for field in ["with_ball_share", "off_plunger_share", "flips_per_second", "impacts_per_second", "digest"] {
            assert_eq!(told[0][field], told[1][field], "{field}");
        }
        let number = |value: &Value| value.as_f64().expect("a number");
        for who in ["with_bot", "by_inputs"] {
            assert!(number(&told[0]["us_per_simulated_second"][who]["median"]) > 0.0, "{}", told[0]);
        }
        assert!(number(&told[0]["off_plunger_share"]) < number(&told[0]["with_ball_share"]), "{}", told[0]);
        assert!(number(&told[0]["impacts_per_second"]) > 0.0 && told[0]["balls"].as_u64() >= Some(3), "{}", told[0]);
    }

    #[test]
    fn the_inputs_of_a_run_arrive_where_the_bot_did() {
        let table = load_table("classic").expect("it is shipped");
        let simulation = Simulation { seconds: 20.0, player: Player::Bot, seed: 5 };
        let mut happened = [Happened::default(); 2];
        let log = watch(&table, &simulation, 20_000, &mut happened[0]);
        let replayed = Simulation { player: Player::Inputs(log.clone()), ..simulation };
        assert_eq!(watch(&table, &replayed, 20_000, &mut happened[1]), log);
        assert_eq!(happened[0].digest, happened[1].digest);
    }
}
