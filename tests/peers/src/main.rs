//! The engine beside its peers: `starball-peers [SCENE...] [--quick] [--svg FILE] [--json FILE]`, without scenes the twelve whose
//! solutions are known. Every scene is run at the same rates by the exact model and by each peer, against one reference, in
//! one run; what one costs and how far it is off is told as ratios to the exact model at the same rate.

use std::path::{Path, PathBuf};
use std::process::ExitCode;
use std::time::{Duration, Instant};

use clap::Parser;
use peers::{Entrant, PEERS};
use serde_json::{Value, json};
use shared::physics::motion::Motion;
use shared::table::Table;
use starball_server::measure::contender::{Contender, Setting};
use starball_server::measure::outcome::{BOUNCES, Effort, Outcome, Spread, measure};
use starball_server::measure::problem::Problem;
use starball_server::measure::reference::Extent;
use starball_server::measure::{plot, report};

/// Steps a second.
const RATES: [u32; 9] = [60, 120, 240, 480, 1000, 2000, 4000, 8000, 16_000];
const QUICK_RATES: [u32; 4] = [60, 480, 2000, 16_000];
/// A departure that nobody would see, m.
const TOLERANCE: f64 = 1e-4;
const EXTENT: Extent = Extent { seconds: 10.0, bounces: 40 };

/// Runs scenes by the engine and by other physics engines, against one reference.
#[derive(Debug, Parser)]
struct Arguments {
    /// Scene files; none: the twelve whose solutions are known.
    scenes: Vec<PathBuf>,
    /// Fewer rates and rounds.
    #[arg(long)]
    quick: bool,
    /// Draws cost against error, medians over the scenes.
    #[arg(long, value_name = "FILE")]
    svg: Option<PathBuf>,
    /// Writes everything as JSON.
    #[arg(long, value_name = "FILE")]
    json: Option<PathBuf>,
}

fn main() -> ExitCode {
    match run(&Arguments::parse()) {
        Ok(()) => ExitCode::SUCCESS,
        Err(problem) => {
            eprintln!("starball-peers: {problem}");
            ExitCode::FAILURE
        }
    }
}

fn run(arguments: &Arguments) -> Result<(), String> {
    for peer in PEERS {
        if let Some(caveat) = peer.caveat() {
            eprintln!("{}: {caveat}", peer.name());
        }
    }
    let second = Duration::from_secs(1);
    let (rates, rounds) = if arguments.quick { (&QUICK_RATES[..], 3) } else { (&RATES[..], 7) };
    let effort = Effort { rounds, patience: 60 * second, budget: 600 * second };
    let contenders = contenders(rates);
    let scenes = if arguments.scenes.is_empty() { known_scenes()? } else { arguments.scenes.clone() };
    let (mut all, mut told) = (Vec::new(), Vec::new());
    for path in &scenes {
        let (problem, outcomes) = run_scene(path, &contenders, effort)?;
        println!("{}", report::text(&problem, &outcomes));
        told.push(report::json(&problem, &outcomes));
        all.push(outcomes);
    }
    let ratios = ratios(&all, rates);
    print_ratios(&ratios, all.len());
    for peer in PEERS.into_iter().filter(|peer| peer.clock_reads() > 0) {
        println!(
            "\nIn each step {} reads the system's clock {} times, for a profile that cannot be switched off: {:.0} ns a step here, \
             which its costs contain.",
            peer.name(),
            peer.clock_reads(),
            f64::from(peer.clock_reads()) * clock_read_nanoseconds(),
        );
    }
    if let Some(path) = &arguments.json {
        let ratios: Vec<Value> = ratios.iter().map(Ratio::json).collect();
        write(path, &format!("{:#}\n", json!({ "scenes": told, "ratios": ratios })))?;
    }
    if let Some(path) = &arguments.svg {
        let title = format!("medians over {} scenes, 60 to 16000 steps a second", all.len());
        write(path, &plot::svg(&title, &merged(&all))?)?;
    }
    Ok(())
}

fn contenders(rates: &[u32]) -> Vec<Box<dyn Contender>> {
    let mut all: Vec<Box<dyn Contender>> = Vec::new();
    for motion in [Motion::Exact, Motion::Swept] {
        all.extend(
            rates.iter().map(|&tick_hz| Box::new(Setting { motion, tick_hz, pixel: None }) as Box<dyn Contender>),
        );
    }
    for peer in PEERS {
        all.extend(rates.iter().map(|&rate| Box::new(Entrant { peer, rate }) as Box<dyn Contender>));
    }
    all
}

fn known_scenes() -> Result<Vec<PathBuf>, String> {
    let folder = Path::new(env!("CARGO_MANIFEST_DIR")).join("../../shared/tests/truth/scenes");
    let entries = std::fs::read_dir(&folder).map_err(|error| format!("cannot read {}: {error}", folder.display()))?;
    let mut scenes: Vec<PathBuf> = entries.filter_map(|entry| Some(entry.ok()?.path())).collect();
    scenes.sort();
    Ok(scenes)
}

fn run_scene(
    path: &Path,
    contenders: &[Box<dyn Contender>],
    effort: Effort,
) -> Result<(Problem, Vec<Outcome>), String> {
    let text = std::fs::read_to_string(path).map_err(|error| format!("cannot read {}: {error}", path.display()))?;
    let table = Table::parse(&path.display().to_string(), &text).map_err(|error| error.to_string())?;
    let problem = Problem::of(&table, EXTENT, TOLERANCE, 0)?;
    let outcomes = measure(&problem, contenders, effort, &mut |what| eprintln!("{what}"));
    Ok((problem, outcomes))
}

/// What a contender costs, and how far it is off, as multiples of the exact model at the same rate.
struct Ratio {
    name: String,
    hz: u32,
    /// Over the scenes.
    cost: Option<Spread>,
    /// At each of [`BOUNCES`]: median over the scenes of its error, and that of the exact model.
    errors: [Option<(f64, f64)>; 3],
}

impl Ratio {
    fn error(&self, place: usize) -> Option<f64> {
        self.errors[place].map(|(theirs, exact)| theirs / exact)
    }

    fn json(&self) -> Value {
        json!({
            "model": self.name, "hz": self.hz, "cost": self.cost.map(|cost| cost.median),
            "error_at_1": self.error(0), "error_at_3": self.error(1), "error_at_10": self.error(2),
        })
    }
}

fn ratios(scenes: &[Vec<Outcome>], rates: &[u32]) -> Vec<Ratio> {
    let mut names: Vec<&String> = scenes[0].iter().map(|outcome| &outcome.name).collect();
    names.dedup();
    let of = |scene: &[Outcome], name: &str, hz: u32| {
        scene.iter().find(|outcome| outcome.name == name && outcome.hz == hz).cloned()
    };
    let mut ratios = Vec::new();
    for name in names {
        for &hz in rates {
            let pairs: Vec<(Outcome, Outcome)> =
                scenes.iter().filter_map(|scene| Some((of(scene, name, hz)?, of(scene, "exact", hz)?))).collect();
            let costs = pairs.iter().filter_map(|(theirs, exact)| Some(theirs.cost?.median / exact.cost?.median));
            let error = |place: usize| {
                let median = |values: Vec<f64>| Spread::of(values).map(|spread| spread.median);
                let theirs = median(pairs.iter().filter_map(|(theirs, _)| theirs.error(place)).collect())?;
                Some((theirs, median(pairs.iter().filter_map(|(_, exact)| exact.error(place)).collect())?))
            };
            let errors = [error(0), error(1), error(2)];
            ratios.push(Ratio { name: name.clone(), hz, cost: Spread::of(costs.collect()), errors });
        }
    }
    ratios
}

fn print_ratios(ratios: &[Ratio], scenes: usize) {
    println!("Medians over {scenes} scenes; ratios to the exact model at the same rate:\n");
    let errors = BOUNCES.map(|bounce| format!("error at {bounce} (m) | ratio")).join(" | ");
    println!("| engine | Hz | cost ratio | quartiles | {errors} |\n|---|---|---|---|---|---|---|---|---|---|");
    for ratio in ratios {
        let cost = ratio.cost.map_or_else(
            || "? | ?".to_owned(),
            |cost| format!("{:.1} | {:.1} to {:.1}", cost.median, cost.low, cost.high),
        );
        let error = |place: usize| match ratio.errors[place] {
            Some((theirs, exact)) => format!("{theirs:.1e} | {:.0e}", theirs / exact),
            None => "- | -".to_owned(),
        };
        println!("| {} | {} | {cost} | {} | {} | {} |", ratio.name, ratio.hz, error(0), error(1), error(2));
    }
}

/// What one reading of the system's clock takes.
fn clock_read_nanoseconds() -> f64 {
    const READS: u32 = 100_000;
    let begun = Instant::now();
    for _ in 0..READS {
        std::hint::black_box(Instant::now());
    }
    begun.elapsed().as_secs_f64() * 1e9 / f64::from(READS)
}

/// Every contender over all scenes together: what the plot shows.
fn merged(scenes: &[Vec<Outcome>]) -> Vec<Outcome> {
    let mut merged = scenes[0].clone();
    for (place, outcome) in merged.iter_mut().enumerate() {
        let all = || scenes.iter().filter_map(move |scene| scene.get(place));
        outcome.cases = all().flat_map(|outcome| outcome.cases.clone()).collect();
        outcome.cost = Spread::of(all().filter_map(|outcome| Some(outcome.cost?.median)).collect());
    }
    merged
}

fn write(path: &Path, text: &str) -> Result<(), String> {
    std::fs::write(path, text).map_err(|error| format!("cannot write {}: {error}", path.display()))
}
