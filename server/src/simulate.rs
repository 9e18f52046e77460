//! `simulate`: plays a table without network, as fast as the machine can.

use std::io::{self, Write};
use std::sync::Arc;
use std::time::Instant as Clock;

use serde_json::{Value, json};
use shared::game::replay::{Recorder, Replay};
use shared::game::{Action, Bot, Game, GameEventKind, Input};
use shared::physics::ball::Instant;
use shared::physics::{Event, EventKind};
use shared::table::Table;

use crate::picture::Recent;

/// What is simulated.
#[derive(Debug, Clone, PartialEq)]
pub struct Simulation {
    /// World time, seconds.
    pub seconds: f64,
    /// Who plays.
    pub player: Player,
    /// What the bot's habits follow from.
    pub seed: u64,
}

/// Who plays a simulated game.
#[derive(Debug, Clone, PartialEq)]
pub enum Player {
    /// Nobody.
    Nobody,
    /// The bot, game after game.
    Bot,
    /// Whoever's inputs these were.
    Inputs(Vec<Input>),
}

impl Simulation {
    /// Ticks of the whole of it.
    pub fn ticks(&self, table: &Table) -> u64 {
        // A cast saturates; `seconds` is checked by the command line.
        (self.seconds / table.scene.tick_seconds).round() as u64
    }
}

/// Whoever chooses the inputs of each tick.
pub(crate) struct Inputs<'a> {
    player: &'a Player,
    bot: Bot,
    /// Of a log: how many are past.
    past: usize,
}

impl<'a> Inputs<'a> {
    pub(crate) fn new(simulation: &'a Simulation) -> Self {
        Self { player: &simulation.player, bot: Bot::new(0, simulation.seed), past: 0 }
    }

    /// The inputs of the game's next tick.
    #[inline]
    pub(crate) fn choose(&mut self, game: &Game, inputs: &mut Vec<Input>) {
        inputs.clear();
        let tick = game.tick();
        match self.player {
            Player::Nobody => {}
            Player::Bot => {
                let mut act = |action| inputs.push(Input { tick, seat: 0, action });
                if !game.is_playing() {
                    if tick == 0 {
                        act(Action::Sit);
                    }
                    act(Action::Start);
                }
                self.bot.play(game, act);
            }
            Player::Inputs(log) => {
                if log.get(self.past).is_some_and(|input| input.tick == tick) {
                    let due = log[self.past..].iter().take_while(|input| input.tick == tick);
                    inputs.extend(due);
                    self.past += inputs.len();
                }
            }
        }
    }
}

/// Whoever looks on while a simulation runs.
#[derive(Default)]
pub struct Watchers<'a> {
    /// Gets a line of JSON for every impact, then one with the final state.
    pub trace: Option<&'a mut dyn Write>,
    /// Notes every tick.
    pub recorder: Option<&'a mut Recorder>,
    /// Notes the last way of each ball.
    pub recent: Option<&'a mut Recent>,
}

/// Plays, and tells the outcome as one line of JSON: `score` (points of all games together), `games` begun, `balls`
/// served, `rescued` (times that something was done about a stuck or escaped ball), `ticks`, and the final state's `digest`; of a bare
/// scene `events` (impacts and whatever else happened), `escaped` balls, `ticks` and `digest`. Table, seconds, seed and inputs
/// decide every bit of it.
///
/// `watchers` get what they are for.
///
/// # Errors
/// If the trace cannot be written.
pub fn run(table: &Arc<Table>, simulation: &Simulation, watchers: Watchers<'_>) -> io::Result<(Game, Value)> {
    let Watchers { mut trace, mut recorder, mut recent } = watchers;
    let mut game = Game::new(Arc::clone(table));
    let mut player = Inputs::new(simulation);
    let ticks = simulation.ticks(table);
    if let Some(recent) = &mut recent {
        recent.look(game.world());
    }
    let (mut score, mut games, mut balls, mut rescued) = (0_u64, 0_u64, 0_u64, 0_u64);
    let (mut happened, mut escaped) = (0_u64, 0_u64);
    let mut inputs = Vec::new();
    for _ in 0..ticks {
        player.choose(&game, &mut inputs);
        for event in game.step(&inputs) {
            match event.kind {
                GameEventKind::Points { points, .. } => score = score.saturating_add(points),
                GameEventKind::Started => games += 1,
                GameEventKind::Served { .. } => balls += 1,
                GameEventKind::Rescued { .. } => rescued += 1,
                _ => {}
            }
        }
        for event in game.world().events() {
            happened += 1;
            escaped += u64::from(event.kind == EventKind::Escaped);
        }
        if let Some(trace) = &mut trace {
            for event in game.world().events() {
                writeln!(trace, "{}", trace_line(table, event))?;
            }
        }
        if let Some(recorder) = &mut recorder {
            recorder.after_step(&game, &inputs);
        }
        if let Some(recent) = &mut recent {
            recent.look(game.world());
        }
    }
    let digest = format!("{:016x}", game.digest());
    if let Some(trace) = &mut trace {
        writeln!(trace, "{}", final_line(table, &game, &digest))?;
        trace.flush()?;
    }
    let told = if table.has_rules {
        json!({
            "score": score, "games": games, "balls": balls, "rescued": rescued, "ticks": ticks, "digest": digest,
        })
    } else {
        json!({ "events": happened, "escaped": escaped, "ticks": ticks, "digest": digest })
    };
    Ok((game, told))
}

/// One impact: `t` in seconds since the start, `element` by name, `ball` by number, `pos` and `vel` just after.
fn trace_line(table: &Table, event: &Event) -> Value {
    let element_name = |element: u16| table.file.elements[usize::from(element)].name();
    let position = event.position + table.scene.origin;
    let mut line = json!({
        "t": event.at.since(Instant::start_of(0), table.scene.tick_seconds),
        "ball": event.ball,
        "pos": [position.x, position.y],
        "vel": [event.velocity.x, event.velocity.y],
    });
    match event.kind {
        EventKind::Touched { element, .. }
        | EventKind::Kicked { element, .. }
        | EventKind::Felled { element, .. }
        | EventKind::Struck { element, .. } => line["element"] = json!(element_name(element)),
        EventKind::Spun { element } => {
            line["element"] = json!(element_name(element));
            line["event"] = json!("spun");
            line["ball"] = Value::Null;
        }
        EventKind::Held { element } => {
            line["element"] = json!(element_name(element));
            line["event"] = json!("held");
        }
        EventKind::Ejected { element } => {
            line["element"] = json!(element_name(element));
            line["event"] = json!("ejected");
        }
        EventKind::Passed { element } => {
            line["element"] = json!(element_name(element));
            line["event"] = json!("passed");
        }
        EventKind::Met { other, .. } => {
            line["element"] = json!(format!("ball {other}"));
            line["event"] = json!("met");
        }
        EventKind::Stalled { .. } => line["event"] = json!("stalled"),
        EventKind::Drained => line["event"] = json!("drained"),
        EventKind::Escaped => line["event"] = json!("escaped"),
    }
    line
}

/// The state at the end: every ball's place and velocity, and the digest.
fn final_line(table: &Table, game: &Game, digest: &str) -> Value {
    let world = game.world();
    let (state, dt) = (world.state(), table.scene.tick_seconds);
    let now = Instant::start_of(state.tick);
    let balls: Vec<_> = state
        .balls
        .iter()
        .map(|ball| {
            let (position, velocity) = ball.at(now, dt);
            let position = position + table.scene.origin;
            json!({ "ball": ball.id, "pos": [position.x, position.y], "vel": [velocity.x, velocity.y] })
        })
        .collect();
    json!({
        "final": true,
        "t": now.since(Instant::start_of(0), dt),
        "ticks": state.tick,
        "balls": balls,
        "digest": digest,
    })
}

/// Plays `runs` times and tells what a simulated second, a tick and an event cost, as one line of JSON: medians in
/// nanoseconds, and the number of events. An event is whatever the world tells: an impact, a pass, a lost ball.
///
/// # Panics
/// If `runs` is 0.
pub fn bench(table: &Arc<Table>, simulation: &Simulation, runs: u32) -> Value {
    let ticks = simulation.ticks(table).max(1);
    let mut events = 0_u64;
    let mut seconds: Vec<f64> = (0..runs)
        .map(|_| {
            events = 0;
            let mut game = Game::new(Arc::clone(table));
            let mut player = Inputs::new(simulation);
            let mut inputs = Vec::new();
            let plays = simulation.player != Player::Nobody;
            let begun = Clock::now();
            for _ in 0..ticks {
                if plays {
                    player.choose(&game, &mut inputs);
                }
                game.step(&inputs);
                events += game.world().events().len() as u64;
            }
            begun.elapsed().as_secs_f64()
        })
        .collect();
    seconds.sort_by(f64::total_cmp);
    let nanoseconds = seconds[seconds.len() / 2] * 1e9;
    let world_seconds = ticks as f64 * table.scene.tick_seconds;
    json!({
        "ns_per_simulated_second": nanoseconds / world_seconds,
        "ns_per_tick": nanoseconds / ticks as f64,
        "ns_per_event": if events > 0 { json!(nanoseconds / events as f64) } else { Value::Null },
        "events": events,
    })
}

/// Plays a replay on its table and tells the outcome like [`run`]: its own checkpoints must agree.
///
/// # Errors
/// If the replay is of another table or physics, or does not arrive where it says.
pub fn replay(table: &Arc<Table>, replay: &Replay) -> Result<(), String> {
    replay.play(Arc::clone(table), |_| ()).map(|_| ()).map_err(|error| error.to_string())
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::load_table;

    fn classic(seed: u64) -> (Arc<Table>, Simulation) {
        let table = load_table("classic").expect("it is shipped");
        (table, Simulation { seconds: 30.0, player: Player::Bot, seed })
    }

    #[test]
    fn the_same_table_time_and_seed_give_the_same_line() {
        let line = |seed| {
            let (table, simulation) = classic(seed);
            run(&table, &simulation, Watchers::default()).expect("nothing is written").1
        };
        assert_eq!(line(1), line(1));
        assert_ne!(line(1), line(2));
        let told = line(1);
        assert_eq!(told["ticks"], 30_000);
        assert!(told["score"].as_u64().is_some_and(|score| score > 0), "{told}");
        assert!(told["digest"].as_str().is_some_and(|digest| digest.len() == 16), "{told}");
    }

    fn scene(text: &str) -> Arc<Table> {
        Arc::new(Table::parse("scene.ron", text).unwrap_or_else(|error| panic!("{error}")))
    }

    fn traced(table: &Arc<Table>, seconds: f64) -> Vec<Value> {
        let mut bytes = Vec::new();
        let simulation = Simulation { seconds, player: Player::Nobody, seed: 0 };
        run(table, &simulation, Watchers { trace: Some(&mut bytes), ..Watchers::default() })
            .expect("a list takes everything");
        let text = String::from_utf8(bytes).expect("JSON is text");
        text.lines().map(|line| serde_json::from_str(line).expect("a line of JSON")).collect()
    }

    /// A ball falls half a metre onto a floor far from (0, 0), and bounces.
    #[test]
    fn a_trace_tells_each_impact_at_its_exact_time_in_the_files_coordinates() {
        let table = scene(
            "Scene(gravity: (0.0, -1.0), balls: [(position: (1000000.5, 0.75), radius: 0.25)], elements: [
                Wall(name: \"floor\", points: [(1000000.0, 0.0), (1000001.0, 0.0)], restitution: 0.5)])",
        );
        let lines = traced(&table, 1.5);
        assert_eq!(lines.len(), 2, "{lines:?}");
        let impact = &lines[0];
        assert_eq!((impact["element"].as_str(), impact["ball"].as_u64()), (Some("floor"), Some(0)));
        let number = |value: &Value| value.as_f64().expect("a number");
        assert!((number(&impact["t"]) - 1.0).abs() < 1e-15, "{impact}");
        assert_eq!(impact["pos"], json!([1_000_000.5, 0.25]));
        assert_eq!(impact["vel"], json!([0.0, 0.5]));
        let end = &lines[1];
        assert_eq!((end["final"].as_bool(), end["ticks"].as_u64()), (Some(true), Some(1500)));
        assert!((number(&end["balls"][0]["pos"][1]) - 0.375).abs() < 1e-14, "{end}");
        assert!(end["digest"].is_string());
    }

    #[test]
    fn a_trace_tells_of_both_balls_that_meet_and_of_one_that_escapes() {
        let balls = "balls: [(position: (0.0, 0.0), velocity: (1.0, 0.0)), (position: (0.3, 0.0))]";
        let table = scene(&format!("Scene(gravity: (0.0, 0.0), {balls}, bounds: (-1.0, -1.0, 1.0, 1.0))"));
        let lines = traced(&table, 3.0);
        let told = |place: usize| (lines[place]["event"].as_str(), lines[place]["ball"].as_u64());
        assert_eq!(
            (told(0), told(1), told(2)),
            ((Some("met"), Some(0)), (Some("met"), Some(1)), (Some("escaped"), Some(1)))
        );
        assert_eq!(lines[0]["element"], "ball 1");
        assert_eq!(lines.len(), 4);
    }

    #[test]
    fn a_bench_counts_the_events_of_one_run() {
        let table = scene(
            "Scene(gravity: (0.0, 0.0), balls: [(position: (0.5, 0.5), velocity: (1.0, 0.0))], elements: [
                Wall(points: [(0.0, 0.0), (1.0, 0.0), (1.0, 1.0), (0.0, 1.0), (0.0, 0.0)])])",
        );
        let told = bench(&table, &Simulation { seconds: 10.0, player: Player::Nobody, seed: 0 }, 3);
        assert_eq!(told["events"], 10, "one bounce for each 0.973 m");
        for field in ["ns_per_simulated_second", "ns_per_tick", "ns_per_event"] {
            assert!(told[field].as_f64().is_some_and(|cost| cost > 0.0), "{told}");
        }
    }

    #[test]
    fn a_recorded_game_is_played_again_by_its_inputs() {
        let (table, simulation) = classic(7);
        let mut recorder = Recorder::new(&table, 7);
        let (game, told) = run(&table, &simulation, Watchers { recorder: Some(&mut recorder), ..Watchers::default() })
            .expect("nothing is written");
        let log = recorder.finish(&game).expect("it is short");
        let read = Replay::parse("game", &log.to_text()).expect("it was just written");
        assert_eq!(replay(&table, &read), Ok(()));
        let again = Simulation { player: Player::Inputs(read.inputs().to_vec()), ..simulation };
        assert_eq!(run(&table, &again, Watchers::default()).expect("nothing is written").1, told);
    }
}
