//! The headless server's command line: `starball-server` serves, its subcommands play without network.

#![forbid(unsafe_code)]

mod feel;
mod subcommands;

use std::io::{IsTerminal, Write};
use std::path::PathBuf;
use std::process::ExitCode;
use std::sync::Arc;
use std::time::Duration;

use clap::{Args, Parser, Subcommand, ValueEnum};
use shared::game::SEATS;
use shared::physics::motion::Motion;
use shared::protocol::{MOST_FROM_CLIENT, MOST_NAME, Mode};
use shared::table::{Horizon, Table};
use starball_server::{Config, load_table};
use tokio::net::TcpListener;
use tracing_subscriber::EnvFilter;

/// A pinball server: steps the table and streams it to players and spectators.
#[derive(Debug, Parser)]
#[command(version, args_conflicts_with_subcommands = true)]
struct Arguments {
    #[command(subcommand)]
    command: Option<Command>,
    #[command(flatten)]
    serve: Serve,
}

/// What would be right for `--listen`.
const LISTEN_HINT: &str = "127.0.0.1:7777 is for this machine, 0.0.0.0:7777 for all, port 0 takes a free one";

#[derive(Debug, Subcommand)]
enum Command {
    /// Plays a table without network, as fast as possible, and prints the outcome as one line of JSON.
    Simulate(Simulate),
    /// Has the bot play whole games, and tells how the table plays: how long balls live, how points spread, what is hit and
    /// what never.
    Games(Games),
    /// Checks the physics at its extremes with each motion model and prints what passes and what the limits are, as a table in
    /// Markdown. The exit status tells whether all is as stated.
    Extremes(Extremes),
    /// Plays the drills that players know, and motions that have a closed form, and prints how they come out and what a real
    /// machine sets for them, as a table in Markdown. The exit status tells whether all is as stated.
    Feel(Feel),
    /// Measures what each motion model and step size costs on a table, and how far off it is, against a reference with twice
    /// the digits of f64; tells which settings are worth having.
    Measure(Measure),
}

#[derive(Debug, Args)]
struct Serve {
    /// Address and port to listen on: 0.0.0.0 lets other machines in; port 0 takes any that is free.
    #[arg(long, default_value = "127.0.0.1:7777", value_name = "ADDRESS:PORT")]
    listen: String,
    /// A shipped table's name or a table file.
    #[arg(long, default_value = "classic", value_name = "NAME|FILE")]
    table: String,
    /// Leaves the table alone while nobody plays.
    #[arg(long)]
    no_bot: bool,
    /// What the bot's habits follow from.
    #[arg(long, default_value_t = 1)]
    seed: u64,
    /// How the room is played: players alternate on one table and the winner stays, or one plays against what the spectators
    /// vote for, or each has a table of their own at the same time.
    #[arg(long, value_enum, default_value_t = ModeName::Challenge)]
    mode: ModeName,
    /// Places for players. Left out: 4 in a challenge, 1 against the crowd, 2 head to head.
    #[arg(long, value_name = "N", value_parser = clap::value_parser!(u8).range(1..=SEATS as i64))]
    places: Option<u8>,
    #[command(flatten)]
    limits: Limits,
}

/// What clients may do to the server. Whoever does more is refused or sent away with a reason.
#[derive(Debug, Args)]
struct Limits {
    /// Most clients at once.
    #[arg(long, default_value_t = 256, value_name = "N", value_parser = clap::value_parser!(u32).range(1..=100_000))]
    most_connections: u32,
    /// Most connections from one address at once.
    #[arg(long, default_value_t = 64, value_name = "N", value_parser = clap::value_parser!(u32).range(1..=100_000))]
    most_per_address: u32,
    /// Most messages of a client in a second; twice as many may come in a burst.
    #[arg(long, default_value_t = 250, value_name = "N", value_parser = clap::value_parser!(u32).range(10..=100_000))]
    most_messages: u32,
    /// Largest frame of a client, bytes.
    #[arg(long, default_value_t = MOST_FROM_CLIENT as u32, value_name = "BYTES", value_parser = clap::value_parser!(u32).range(64..=MOST_FROM_CLIENT as i64))]
    most_frame: u32,
    /// Longest name, characters.
    #[arg(long, default_value_t = MOST_NAME as u32, value_name = "N", value_parser = clap::value_parser!(u32).range(1..=MOST_NAME as i64))]
    most_name: u32,
    /// Seconds in which a client has to say hello.
    #[arg(long, default_value_t = 5, value_name = "SECONDS", value_parser = clap::value_parser!(u32).range(1..=3600))]
    handshake: u32,
    /// Seconds for which a client may say nothing at all.
    #[arg(long, default_value_t = 15, value_name = "SECONDS", value_parser = clap::value_parser!(u32).range(6..=86_400))]
    silence: u32,
    /// Seconds for which a player may leave the controls alone before the turn is lost.
    #[arg(long, default_value_t = 30, value_name = "SECONDS", value_parser = clap::value_parser!(u32).range(5..=86_400))]
    idle: u32,
    /// Seconds for which a client may take nothing of what is sent to it.
    #[arg(long, default_value_t = 10, value_name = "SECONDS", value_parser = clap::value_parser!(u32).range(1..=3600))]
    stall: u32,
}

/// The modes by the names that a host types.
#[derive(Debug, Clone, Copy, ValueEnum)]
enum ModeName {
    /// Players alternate ball by ball; the winner stays, the next in line comes up.
    Challenge,
    /// One player against the spectators.
    Crowd,
    /// Each player on a table of their own, at the same time.
    HeadToHead,
}

impl From<ModeName> for Mode {
    fn from(name: ModeName) -> Self {
        match name {
            ModeName::Challenge => Self::Challenge,
            ModeName::Crowd => Self::Crowd,
            ModeName::HeadToHead => Self::HeadToHead,
        }
    }
}

#[derive(Debug, Args)]
struct Games {
    /// A shipped table's name or a table file.
    table: String,
    /// How many.
    #[arg(long, default_value_t = 1000, value_name = "N", value_parser = clap::value_parser!(u32).range(1..=1_000_000))]
    games: u32,
    /// What the bot's habits in the first game follow from; the others count on.
    #[arg(long, default_value_t = 1)]
    seed: u64,
    /// Prints one JSON object instead of a table.
    #[arg(long)]
    json: bool,
    /// Games that are played at once; the outcome is the same.
    #[arg(long, default_value_t = 2, value_name = "N", value_parser = clap::value_parser!(u32).range(1..=256))]
    threads: u32,
}

#[derive(Debug, Args)]
struct Extremes {
    /// Plays so many random shots on Classic besides, exactly and with flippers moving, and as many of several balls: none may be lost.
    #[arg(long, default_value_t = 0, value_name = "N", value_parser = clap::value_parser!(u64).range(0..=1_000_000_000))]
    shots: u64,
}

#[derive(Debug, Args)]
struct Feel {
    /// Writes every figure as JSON.
    #[arg(long, value_name = "FILE")]
    json: Option<PathBuf>,
    /// Draws live-catch.svg and aim.svg into this folder.
    #[arg(long, value_name = "FOLDER")]
    svg: Option<PathBuf>,
}

#[derive(Debug, Args)]
struct Measure {
    /// A shipped table's name, or a file with a table or a bare scene.
    #[arg(required_unless_present = "scene", default_value = "", hide_default_value = true)]
    table: String,
    /// Draws a picture instead: figures 1, 3 and 4 of Starball's manual, run by every motion model.
    #[arg(long, value_name = "NAME", value_parser = ["manual"], requires = "svg", conflicts_with_all = ["table", "tolerance", "json", "needs"])]
    scene: Option<String>,
    /// Ends within a minute: fewer settings, shots and rounds.
    #[arg(long)]
    quick: bool,
    /// World time to follow, seconds.
    #[arg(long, default_value_t = 10.0, value_parser = measured_seconds, allow_negative_numbers = true)]
    seconds: f64,
    /// What counts as a departure: a length such as 0.1mm. Given, the cheapest setting that keeps it is named.
    #[arg(long, value_name = "LENGTH", value_parser = shared::table::parse_tolerance, allow_hyphen_values = true)]
    tolerance: Option<f64>,
    /// For how long the tolerance is to be kept: 3s, or 10bounces.
    #[arg(long, value_name = "TIME", requires = "tolerance", allow_hyphen_values = true)]
    horizon: Option<Horizon>,
    /// Tells what the table needs of the physics, and what each need costs, and nothing else.
    #[arg(long, conflicts_with_all = ["tolerance", "json", "svg"])]
    needs: bool,
    /// Writes everything as JSON.
    #[arg(long, value_name = "FILE")]
    json: Option<PathBuf>,
    /// Draws cost against error.
    #[arg(long, value_name = "FILE")]
    svg: Option<PathBuf>,
}

#[derive(Debug, Args)]
struct Simulate {
    /// A shipped table's name, or a file with a table or a bare scene.
    table: String,
    /// World time to play, seconds.
    #[arg(long, default_value_t = 60.0, value_parser = seconds, allow_negative_numbers = true)]
    seconds: f64,
    /// How the next impact of a ball is found: discrete, pixel, swept or exact. Left out: as the table says.
    #[arg(long, value_name = "MODEL")]
    motion: Option<Motion>,
    /// World ticks a second, 1 to 1000000. Left out: as the table says.
    #[arg(long, value_name = "N", value_parser = clap::value_parser!(u32).range(1..=1_000_000))]
    tick_hz: Option<u32>,
    /// What the bot's habits follow from.
    #[arg(long, default_value_t = 1)]
    seed: u64,
    /// Lets the bot play.
    #[arg(long, conflicts_with = "inputs")]
    bot: bool,
    /// Plays the inputs of this replay, and checks that it arrives where the replay says.
    #[arg(long, value_name = "FILE")]
    inputs: Option<PathBuf>,
    /// Writes a line of JSON for every impact, then one with the final state; `-` is standard output.
    #[arg(long, value_name = "FILE")]
    trace: Option<PathBuf>,
    /// Writes a replay of what was played.
    #[arg(long, value_name = "FILE")]
    record: Option<PathBuf>,
    /// Draws the table as it is at the end, with the last way of each ball and what it meets next; `-` is standard output.
    #[arg(long, value_name = "FILE")]
    svg: Option<PathBuf>,
    /// World time for which the picture shows where balls have been, seconds.
    #[arg(long, value_name = "SECONDS", default_value_t = 2.0, requires = "svg", value_parser = seconds, allow_negative_numbers = true)]
    svg_seconds: f64,
    /// Plays so many times and tells what it costs, as medians: one line of JSON.
    #[arg(long, value_name = "N", conflicts_with_all = ["trace", "record", "svg"], value_parser = clap::value_parser!(u32).range(1..=10_000))]
    bench: Option<u32>,
    /// Benches the bot over so many seeds, each with and without its thinking, and tells how busy the table was.
    #[arg(long, value_name = "N", requires_all = ["bench", "bot"], value_parser = clap::value_parser!(u32).range(1..=100_000))]
    seeds: Option<u32>,
}

fn seconds(text: &str) -> Result<f64, String> {
    match text.parse::<f64>() {
        Ok(seconds) if (0.0..=1e7).contains(&seconds) => Ok(seconds),
        _ => Err("a number of seconds from 0 to 10000000 would be right".to_owned()),
    }
}

fn measured_seconds(text: &str) -> Result<f64, String> {
    match text.parse::<f64>() {
        Ok(seconds) if (0.001..=1000.0).contains(&seconds) => Ok(seconds),
        _ => Err("a number of seconds from 0.001 to 1000 would be right".to_owned()),
    }
}

fn main() -> ExitCode {
    let arguments = Arguments::parse();
    let outcome = match arguments.command {
        Some(Command::Simulate(arguments)) => subcommands::simulate(&arguments),
        Some(Command::Games(arguments)) => subcommands::games(&arguments),
        Some(Command::Extremes(arguments)) => subcommands::extremes(arguments.shots),
        Some(Command::Feel(arguments)) => feel::feel(&arguments),
        Some(Command::Measure(arguments)) => subcommands::measure(&arguments),
        None => serve(&arguments.serve),
    };
    match outcome {
        Ok(()) => ExitCode::SUCCESS,
        Err(problem) => {
            eprintln!("starball-server: {problem}");
            ExitCode::FAILURE
        }
    }
}

fn serve(arguments: &Serve) -> Result<(), String> {
    let filter = EnvFilter::try_from_default_env().unwrap_or_else(|_| EnvFilter::new("info"));
    // Lines that nobody takes are dropped: the room waits for no terminal.
    let (writer, _flushes_when_dropped) = tracing_appender::non_blocking(std::io::stderr());
    tracing_subscriber::fmt()
        .with_env_filter(filter)
        .with_writer(writer)
        .with_ansi(std::io::stderr().is_terminal())
        .with_target(false)
        .init();
    let table = load_table(&arguments.table)?;
    if !table.has_rules {
        return Err(format!(
            "{:?} is a bare scene, which has no rules to play by; `starball-server simulate {}` runs it",
            arguments.table, arguments.table
        ));
    }
    let config = config_of(arguments, table);
    let runtime = tokio::runtime::Runtime::new().map_err(|error| format!("cannot start the runtime: {error}"))?;
    runtime.block_on(async {
        let listener = TcpListener::bind(&arguments.listen)
            .await
            .map_err(|error| format!("cannot listen on {:?}: {error}; {LISTEN_HINT}", arguments.listen))?;
        let address = listener.local_addr().map_err(|error| format!("cannot tell the address: {error}"))?;
        let shutdown = shutdown_signal().map_err(|error| format!("cannot listen for signals: {error}"))?;
        say(&format_args!("listening on {address}"));
        let account = starball_server::run(listener, config, shutdown).await.map_err(|error| error.to_string())?;
        say(&account);
        Ok(())
    })
}

fn config_of(arguments: &Serve, table: Arc<Table>) -> Config {
    let seconds = |seconds: u32| Duration::from_secs(u64::from(seconds));
    let limits = &arguments.limits;
    let mut config = Config::new(table).mode(arguments.mode.into());
    config.places = arguments.places.map_or(config.places, usize::from);
    config.attract = !arguments.no_bot;
    config.seed = arguments.seed;
    config.most_connections = limits.most_connections as usize;
    config.most_per_address = limits.most_per_address as usize;
    config.most_messages = limits.most_messages;
    config.most_frame = limits.most_frame as usize;
    config.most_name = limits.most_name as usize;
    config.handshake_time = seconds(limits.handshake);
    config.silent_time = seconds(limits.silence);
    config.idle_time = seconds(limits.idle);
    config.write_time = seconds(limits.stall);
    config
}

/// Ready at Ctrl-C or SIGTERM.
#[cfg(unix)]
fn shutdown_signal() -> std::io::Result<impl Future<Output = ()>> {
    use tokio::signal::unix::{SignalKind, signal};
    let (mut interrupt, mut terminate) = (signal(SignalKind::interrupt())?, signal(SignalKind::terminate())?);
    Ok(async move {
        tokio::select! {
            _ = interrupt.recv() => {}
            _ = terminate.recv() => {}
        }
    })
}

/// Ready at Ctrl-C.
#[cfg(not(unix))]
fn shutdown_signal() -> std::io::Result<impl Future<Output = ()>> {
    Ok(async {
        // Without a handler the process simply ends at Ctrl-C.
        if tokio::signal::ctrl_c().await.is_err() {
            std::future::pending::<()>().await;
        }
    })
}

/// Prints a line. Whoever started the server may have closed its output; that is no reason to end.
fn say(line: &dyn std::fmt::Display) {
    let _ = writeln!(std::io::stdout(), "{line}");
}
