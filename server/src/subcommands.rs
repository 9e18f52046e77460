//! What the subcommands do with files and standard output.

use std::fs::File;
use std::io::{self, BufWriter, Write};
use std::path::{Path, PathBuf};
use std::sync::Arc;
use std::time::Instant as Clock;

use shared::extremes::Report;
use shared::extremes::shots::{FASTEST, MOST_BALLS, Shooting, Shots, shots};
use shared::game::replay::{Recorder, Replay};
use shared::physics::motion::Motion;
use shared::table::{Accuracy, Horizon};
use starball_server::games;
use starball_server::measure::{self, Plan};
use starball_server::picture::{self, Recent};
use starball_server::seeds;
use starball_server::simulate::{self, Player, Simulation, Watchers};
use starball_server::{load_table, load_text, read_table};

use crate::{Games, Measure, Simulate};

/// `simulate`.
pub(crate) fn simulate(arguments: &Simulate) -> Result<(), String> {
    let table = load_table(&arguments.table)?.run_with(arguments.motion, arguments.tick_hz).map(Arc::new)?;
    if arguments.bot && !table.has_rules {
        return Err(format!("{:?} is a bare scene: there is nothing for a bot to play", arguments.table));
    }
    let mut simulation = Simulation { seconds: arguments.seconds, player: Player::Nobody, seed: arguments.seed };
    let replay = arguments.inputs.as_deref().map(read_replay).transpose()?;
    if let Some(replay) = &replay {
        simulate::replay(&table, replay)?;
        simulation.player = Player::Inputs(replay.inputs().to_vec());
        simulation.seconds = replay.ticks() as f64 * table.scene.tick_seconds;
    } else if arguments.bot {
        simulation.player = Player::Bot;
    }
    if let (Some(runs), Some(seeds)) = (arguments.bench, arguments.seeds) {
        return print(&seeds::bench(&table, &simulation, seeds, runs).to_string());
    }
    if let Some(runs) = arguments.bench {
        return print(&simulate::bench(&table, &simulation, runs).to_string());
    }
    let mut trace = arguments.trace.as_deref().map(create).transpose()?;
    let mut recorder = arguments.record.is_some().then(|| Recorder::new(&table, arguments.seed));
    // What cannot be written is told before anything is played.
    let mut drawing = arguments.svg.as_deref().map(create).transpose()?;
    let mut recent = drawing.is_some().then(|| Recent::new(&table, simulation.ticks(&table), arguments.svg_seconds));
    let watchers = Watchers {
        trace: trace.as_mut().map(|writer| writer.as_mut() as &mut dyn Write),
        recorder: recorder.as_mut(),
        recent: recent.as_mut(),
    };
    let (game, told) = match simulate::run(&table, &simulation, watchers) {
        // Whoever reads has enough.
        Err(error) if error.kind() == io::ErrorKind::BrokenPipe => return Ok(()),
        outcome => outcome.map_err(|error| format!("cannot write the trace: {error}"))?,
    };
    if let (Some(recorder), Some(path)) = (recorder, &arguments.record) {
        let replay = recorder.finish(&game).map_err(|error| error.to_string())?;
        std::fs::write(path, replay.to_text()).map_err(|error| format!("cannot write {}: {error}", path.display()))?;
    }
    if let (Some(drawing), Some(recent), Some(path)) = (&mut drawing, recent, &arguments.svg) {
        let text = picture::svg(&table, game.world(), &recent.finish(game.world()), arguments.svg_seconds);
        let written = drawing.write_all(text.as_bytes()).and_then(|()| drawing.flush());
        written.map_err(|error| format!("cannot write {}: {error}", path.display()))?;
    }
    let takes_output = |path: &Option<PathBuf>| path.as_deref() == Some(Path::new("-"));
    if takes_output(&arguments.trace) || takes_output(&arguments.svg) { Ok(()) } else { print(&told.to_string()) }
}

/// `games`.
pub(crate) fn games(arguments: &Games) -> Result<(), String> {
    let table = load_table(&arguments.table)?;
    if !table.has_rules {
        return Err(format!("{:?} is a bare scene: there is nothing for a bot to play", arguments.table));
    }
    let games = games::Games::play(&table, arguments.games, arguments.seed, arguments.threads);
    if arguments.json { print(&games.json().to_string()) } else { print(games.text().trim_end()) }
}

/// `extremes`.
pub(crate) fn extremes(shots: u64) -> Result<(), String> {
    let report = Report::of_all(|check| eprintln!("checked: {check}"));
    print(&report.to_string())?;
    if shots > 0 {
        random_shots(shots)?;
    }
    if report.is_as_expected() { Ok(()) } else { Err("an extreme is worse than stated: see the table".to_owned()) }
}

/// `measure`.
pub(crate) fn measure(arguments: &Measure) -> Result<(), String> {
    if let (Some(_), Some(path)) = (&arguments.scene, &arguments.svg) {
        return write(path, &measure::manual::picture()?);
    }
    let table = read_table(&arguments.table)?;
    let mut say = |what: &str| eprintln!("{what}");
    let given = arguments.tolerance.map(|tolerance| Accuracy {
        tolerance,
        horizon: arguments.horizon.unwrap_or(Horizon::Seconds(arguments.seconds)),
    });
    let asked = given.or(table.accuracy);
    let plan = Plan::new(arguments.quick, arguments.seconds, asked);
    if arguments.needs {
        let problem = measure::problem(&table, &plan, &mut say)?;
        return print(&measure::needs::text(&problem, plan.effort.rounds, &mut say));
    }
    let (problem, outcomes) = measure::run(&table, &plan, &mut say)?;
    print(&measure::report::text(&problem, &outcomes))?;
    if let Some(path) = &arguments.svg {
        write(path, &measure::plot::svg(&problem.name, &outcomes)?)?;
    }
    let mut told = measure::report::json(&problem, &outcomes);
    let mut write_json = |further: Option<serde_json::Value>| match &arguments.json {
        Some(path) => {
            told["further"] = further.unwrap_or_default();
            write(path, &format!("{told:#}\n"))
        }
        None => Ok(()),
    };
    // What is there is written before anything else can fail.
    write_json(None)?;
    if asked.is_none() {
        let (text, further) = measure::further(&table, &problem, &plan, &mut say)?;
        print(&text)?;
        write_json(Some(further))?;
    }
    let Some(accuracy) = asked else { return Ok(()) };
    print(&measure::front::sentence(&outcomes, &problem, &accuracy)?)
}

pub(crate) fn write(path: &Path, text: &str) -> Result<(), String> {
    std::fs::write(path, text).map_err(|error| format!("cannot write {}: {error}", path.display()))
}

/// Plays random shots on all cores, of one ball and then of several, and tells what became of them: an error if one was lost, or
/// nearly.
fn random_shots(count: u64) -> Result<(), String> {
    let cores = std::thread::available_parallelism().map_or(1, usize::from) as u64;
    let mut lost = Vec::new();
    for most_balls in [1, MOST_BALLS] {
        let begun = Clock::now();
        let shooting = Shooting { seed: SHOTS_SEED, fastest: FASTEST, most_balls, motion: Motion::Exact };
        let play = |core: u64| shots(count * core / cores..count * (core + 1) / cores, &shooting);
        let told = std::thread::scope(|scope| {
            let threads: Vec<_> = (0..cores).map(|core| scope.spawn(move || play(core))).collect();
            let join = |thread: std::thread::ScopedJoinHandle<'_, Shots>| thread.join().map_err(|_| "a thread failed");
            threads.into_iter().map(join).collect::<Result<Vec<_>, _>>()
        })?;
        let told = told.into_iter().reduce(Shots::joined).unwrap_or_default();
        let balls = if most_balls > 1 { format!("1 to {most_balls} balls") } else { "one ball".to_owned() };
        print(&format!(
            "{} random shots of {balls} up to {FASTEST} m/s on Classic, flippers moving: {} impacts, {} drained, {} escaped, {} through \
             something, {} not finite; deepest overlap {:.2e} m (shot {}, tick {}); energy beyond what was given {:.1e} J; {:.0} s",
            told.shots,
            told.impacts,
            told.drained,
            told.escaped,
            told.passed_through,
            told.not_finite,
            told.deepest,
            told.worst.0,
            told.worst.1,
            told.excess,
            begun.elapsed().as_secs_f64(),
        ))?;
        if !told.is_as_promised() {
            lost.push(format!(
                "{} of {count} shots of {balls} were lost, the deepest overlap was {:.2e} m",
                told.lost(),
                told.deepest
            ));
        }
    }
    if lost.is_empty() { Ok(()) } else { Err(lost.join("; ")) }
}

/// What the random shots follow from.
const SHOTS_SEED: u64 = 2026;

fn read_replay(path: &Path) -> Result<Replay, String> {
    let text = load_text(path, shared::game::replay::MOST_TEXT)
        .map_err(|error| format!("cannot read {}: {error}", path.display()))?;
    Replay::parse(&path.display().to_string(), &text).map_err(|error| error.to_string())
}

/// The file to write to; `-` is standard output.
fn create(path: &Path) -> Result<Box<dyn Write>, String> {
    if path == Path::new("-") {
        return Ok(Box::new(BufWriter::new(io::stdout())));
    }
    let file = File::create(path).map_err(|error| format!("cannot write {}: {error}", path.display()))?;
    Ok(Box::new(BufWriter::new(file)))
}

/// Prints a line.
pub(crate) fn print(line: &str) -> Result<(), String> {
    match writeln!(io::stdout(), "{line}") {
        // Whoever reads has enough.
        Err(error) if error.kind() == io::ErrorKind::BrokenPipe => Ok(()),
        written => written.map_err(|error| format!("cannot print the outcome: {error}")),
    }
}
