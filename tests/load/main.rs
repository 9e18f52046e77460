//! `starball-load`: thousands of connections to a server from one thread. They watch and check what they are sent, play, or
//! misbehave; at the end stands one line of JSON.
//!
//! `arguments` says what can be asked for, `fleet` runs it all, `connection` is one of them, `spectator` and `player` are what it
//! does, `hostile` what it does wrong, `clock` judges how late frames are, and `report` tells.

#![forbid(unsafe_code)]

mod arguments;
mod clock;
mod connection;
mod fleet;
mod hostile;
mod player;
mod process;
mod report;
mod spectator;

use std::io::Write;
use std::process::ExitCode;

use clap::Parser;

use arguments::Arguments;
use fleet::Fleet;

fn main() -> ExitCode {
    match load(Arguments::parse()) {
        Ok(line) => {
            // Whoever started this may have closed its output.
            let _ = writeln!(std::io::stdout(), "{line}");
            ExitCode::SUCCESS
        }
        Err(problem) => {
            eprintln!("starball-load: {problem}");
            ExitCode::FAILURE
        }
    }
}

fn load(arguments: Arguments) -> Result<String, String> {
    arguments.check_open_files()?;
    let mut fleet = Fleet::new(arguments).map_err(|error| format!("cannot wait for connections: {error}"))?;
    let report = fleet.run()?;
    serde_json::to_string(&report).map_err(|error| error.to_string())
}
