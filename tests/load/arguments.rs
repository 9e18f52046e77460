//! What is asked for on the command line, and what it takes of the system.

use std::net::{SocketAddr, ToSocketAddrs};
use std::path::Path;

use clap::{Parser, ValueEnum};
use shared::protocol::{Form, RATES, Stream};

/// Files that a process has open besides its connections, and a few to spare.
const OTHER_FILES: u64 = 64;

/// Opens many connections to a Starball server from one process, watches, plays and misbehaves, and ends with one line of
/// JSON about what came.
#[derive(Debug, Clone, Parser)]
#[command(version, name = "starball-load")]
pub(crate) struct Arguments {
    /// The server.
    #[arg(long, value_name = "HOST:PORT", value_parser = address)]
    pub(crate) connect: SocketAddr,
    /// Connections that watch.
    #[arg(long, default_value_t = 100, value_name = "N", value_parser = clap::value_parser!(u32).range(0..=100_000))]
    pub(crate) spectators: u32,
    /// Connections that play, each with a bot's hands.
    #[arg(long, default_value_t = 0, value_name = "M", value_parser = clap::value_parser!(u32).range(0..=1_000))]
    pub(crate) bots: u32,
    /// For how long it is counted, once all have joined.
    #[arg(long, default_value_t = 10.0, value_parser = seconds)]
    pub(crate) seconds: f64,
    /// Frames a second that spectators ask for: 10, 20, 30 or 60.
    #[arg(long, default_value_t = 10, value_parser = rate)]
    pub(crate) hz: u8,
    /// What spectators ask for.
    #[arg(long, value_enum, default_value_t = FormName::Inputs)]
    pub(crate) stream: FormName,
    /// One spectator in so many steps a copy of the games; of the others' frames only the continuity is checked.
    #[arg(long, default_value_t = 20, value_name = "N", value_parser = clap::value_parser!(u32).range(1..))]
    pub(crate) step_one_in: u32,
    /// Connections opened a second, while they join.
    #[arg(long, default_value_t = 500, value_name = "N", value_parser = clap::value_parser!(u32).range(1..=10_000))]
    pub(crate) joins: u32,
    /// Besides, connections that ask for the largest stream and never read it.
    #[arg(long, default_value_t = 0, value_name = "K", value_parser = clap::value_parser!(u32).range(0..=100_000))]
    pub(crate) stalled: u32,
    /// Besides, connections that are opened a second, half of them greeted, and soon dropped.
    #[arg(long, default_value_t = 0, value_name = "R", value_parser = clap::value_parser!(u32).range(0..=10_000))]
    pub(crate) churn: u32,
    /// Besides, malformed frames a second, each on a connection of its own.
    #[arg(long, default_value_t = 0, value_name = "R", value_parser = clap::value_parser!(u32).range(0..=10_000))]
    pub(crate) malformed: u32,
    /// Besides, connections that send what is valid and costly, each as many messages a second as servers let through:
    /// another stream, a full snapshot, a place and away, pings.
    #[arg(long, default_value_t = 0, value_name = "N", value_parser = clap::value_parser!(u32).range(0..=10_000))]
    pub(crate) floods: u32,
    /// What the bots' habits and the misbehaviour follow from.
    #[arg(long, default_value_t = 1)]
    pub(crate) seed: u64,
    /// Also tells what this process, the server, took of processor and memory meanwhile.
    #[arg(long, value_name = "PID")]
    pub(crate) process: Option<u32>,
    /// Speaks to something that only writes frames, without greetings: the other side of the benchmark `fanout`.
    #[arg(long, hide = true)]
    pub(crate) raw: bool,
}

/// What spectators ask for.
#[derive(Debug, Clone, Copy, PartialEq, Eq, ValueEnum)]
pub(crate) enum FormName {
    /// What changed of the state.
    State,
    /// What was pressed.
    Inputs,
}

impl Arguments {
    /// What spectators ask for.
    pub(crate) fn stream(&self) -> Stream {
        let form = match self.stream {
            FormName::State => Form::State,
            FormName::Inputs => Form::Inputs,
        };
        Stream { form, hz: self.hz }
    }

    /// Whether the system lets this process open as many files as it will need.
    ///
    /// # Errors
    /// How many it would have to be.
    pub(crate) fn check_open_files(&self) -> Result<(), String> {
        // Hostile connections live for a second or two at the most.
        let connections = [self.spectators, self.bots, self.stalled, self.floods, 2 * self.churn, 2 * self.malformed];
        let needed = connections.into_iter().map(u64::from).sum::<u64>() + OTHER_FILES;
        let allowed = std::fs::read_to_string(Path::new("/proc/self/limits")).ok().and_then(|limits| {
            let line = limits.lines().find_map(|line| line.strip_prefix("Max open files"))?;
            line.split_whitespace().next()?.parse::<u64>().ok()
        });
        match allowed {
            Some(allowed) if allowed < needed => Err(format!(
                "so many connections take {needed} open files and {allowed} are allowed; `ulimit -n {needed}` before it would be right"
            )),
            _ => Ok(()),
        }
    }
}

fn address(text: &str) -> Result<SocketAddr, String> {
    let hint = "an address and a port, such as 127.0.0.1:7777, would be right";
    let mut found = text.to_socket_addrs().map_err(|error| format!("{error}; {hint}"))?;
    found.next().ok_or_else(|| format!("it has no address; {hint}"))
}

fn rate(text: &str) -> Result<u8, String> {
    let rates = RATES.map(|rate| rate.to_string()).join(", ");
    text.parse().ok().filter(|rate| RATES.contains(rate)).ok_or_else(|| format!("one of {rates} would be right"))
}

fn seconds(text: &str) -> Result<f64, String> {
    match text.parse::<f64>() {
        Ok(seconds) if (0.1..=86_400.0).contains(&seconds) => Ok(seconds),
        _ => Err("a number of seconds from 0.1 to 86400 would be right".to_owned()),
    }
}
