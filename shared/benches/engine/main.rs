//! What the engine costs. `cargo bench -p starball-shared --bench engine [-- GROUP...] [--quick]` with groups of
//!
//! - `bare`: one ball among four walls, against the same loop written by hand
//! - `quiet`: a tick in which nothing happens
//! - `elements`: an event among 10 to 10,000 posts at constant density
//! - `balls`: 1 to 300 balls in one box, the exact model against the swept one
//! - `truth`: the twelve scenes of the tests of truth
//! - `needs`: what a scene would pay for what it does not need
//!
//! The numbers of one comparison come from one run: its cases take turns, round by round, so that a busy machine slows all of
//! them. A number is the median over the rounds, a ratio the median of each round's ratio.

mod balls;
mod bare;
mod by_hand;
mod elements;
mod needs;
mod quiet;
mod scenes;
mod timing;
mod truth;

use std::process::ExitCode;

use timing::Effort;

type Group = (&'static str, fn(Effort));

const GROUPS: [Group; 6] = [
    ("bare", bare::run),
    ("quiet", quiet::run),
    ("elements", elements::run),
    ("balls", balls::run),
    ("truth", truth::run),
    ("needs", needs::run),
];

fn main() -> ExitCode {
    let mut effort = Effort::Full;
    let mut wanted = Vec::new();
    for argument in std::env::args().skip(1) {
        match argument.as_str() {
            // Cargo's own.
            "--bench" => {}
            "--quick" => effort = Effort::Quick,
            name if GROUPS.iter().any(|(known, _)| *known == name) => wanted.push(argument),
            other => {
                let known = GROUPS.map(|(name, _)| name).join(", ");
                eprintln!("{other:?} is no group; {known} or --quick would be right");
                return ExitCode::FAILURE;
            }
        }
    }
    for (name, run) in GROUPS {
        if wanted.is_empty() || wanted.iter().any(|group| group == name) {
            println!("\n== {name}");
            run(effort);
        }
    }
    ExitCode::SUCCESS
}
