//! Runs scenes in the peers: `starball-peers FILE... RATE...`. For each scene, peer and rate it prints what a second of the scene
//! takes, and where the first ball is at a few times. What cannot be run is said, and the rest goes on.

use std::process::ExitCode;
use std::time::Instant;

use peers::{PEERS, Peer};
use shared::physics::scene::Scene;
use shared::table::Table;

/// Seconds of the scene at which it is said where the ball is; the last is the length of a run.
const TIMES: [f64; 3] = [0.02, 0.2, 2.0];

/// Runs of which the median is taken.
const RUNS: usize = 5;

fn main() -> ExitCode {
    let mut files = Vec::new();
    let mut rates = Vec::new();
    for argument in std::env::args().skip(1) {
        match argument.parse::<u32>() {
            Ok(rate) if rate > 0 => rates.push(rate),
            _ => files.push(argument),
        }
    }
    if files.is_empty() || rates.is_empty() {
        eprintln!("usage: starball-peers FILE... RATE...");
        return ExitCode::FAILURE;
    }
    for peer in PEERS {
        if let Some(caveat) = peer.caveat() {
            eprintln!("{}: {caveat}", peer.name());
        }
    }
    let mut code = ExitCode::SUCCESS;
    for file in &files {
        println!("{file}");
        if let Err(error) = run_file(file, &rates) {
            eprintln!("{file}: {error}");
            code = ExitCode::FAILURE;
        }
    }
    code
}

fn run_file(file: &str, rates: &[u32]) -> Result<(), String> {
    let text = std::fs::read_to_string(file).map_err(|error| error.to_string())?;
    let table = Table::parse(file, &text).map_err(|error| error.to_string())?;
    for peer in PEERS {
        for &hz in rates {
            run(peer, &table.scene, hz).map_err(|error| format!("{}: {error}", peer.name()))?;
        }
    }
    Ok(())
}

fn run(peer: &dyn Peer, scene: &Scene, hz: u32) -> Result<(), String> {
    let mut took = Vec::new();
    for _ in 0..RUNS {
        let mut world = peer.world(scene, hz)?;
        let steps = steps(TIMES[TIMES.len() - 1], hz);
        let start = Instant::now();
        for _ in 0..steps {
            world.step()?;
        }
        took.push(start.elapsed().as_nanos() as f64 / f64::from(steps) * f64::from(hz));
    }
    took.sort_by(f64::total_cmp);
    print!("  {:6} {hz:7} Hz {:11.0} ns a second", peer.name(), took[RUNS / 2]);

    let mut world = peer.world(scene, hz)?;
    let (mut done, mut balls) = (0, Vec::new());
    for time in TIMES {
        while done < steps(time, hz) {
            world.step()?;
            done += 1;
        }
        world.balls(&mut balls)?;
        let at = f64::from(done) / f64::from(hz);
        if let Some(ball) = balls.first() {
            print!("  {at:.4} s ({:.6}, {:.6})", ball.position.x, ball.position.y);
        }
    }
    println!();
    Ok(())
}

/// Steps in so many seconds: one at the least.
fn steps(seconds: f64, hz: u32) -> u32 {
    // A cast saturates.
    ((seconds * f64::from(hz)).round() as u32).max(1)
}
