//! Further axes of the trade, measured with the reference's own code: how exactly a root is found, how exactly a state is kept,
//! and how often a spectator hears of it.

use core::fmt::Write;
use std::time::Instant as Clock;

use serde_json::{Value, json};

use super::outcome::{Fidelity, Spread};
use super::polynomial::Refinement;
use super::problem::Problem;
use super::real::{Real, Wide};
use super::reference::{Arithmetic, Solution, solve};
use super::trajectory::{Piece, Trajectory};

/// A variation of the arithmetic.
#[derive(Debug, Clone, PartialEq)]
pub struct Variation {
    /// What it is.
    pub name: String,
    /// Evaluations of polynomials for each impact, to find all roots.
    pub steps: f64,
    /// Nanoseconds for each impact.
    pub nanoseconds: f64,
    /// Median error at the third bounce, m.
    pub third: Option<f64>,
    /// Median of the bounces kept.
    pub bounces: f64,
    /// Median of the seconds kept.
    pub seconds: f64,
}

/// Tolerances of the time of impact, seconds; 0: to the last digit.
const TOLERANCES: [f64; 6] = [1e-3, 1e-4, 1e-6, 1e-9, 1e-12, 0.0];

/// Solves the problem in f64 with each tolerance of its roots, and with its state kept as f32.
pub fn arithmetic(problem: &Problem, rounds: usize, say: &mut dyn FnMut(&str)) -> Vec<Variation> {
    let mut variations: Vec<(String, Arithmetic)> = TOLERANCES
        .into_iter()
        .map(|tolerance| {
            let name = if tolerance > 0.0 {
                format!("roots to {tolerance:.0e} s")
            } else {
                "roots to the last digit".to_owned()
            };
            (name, Arithmetic { refinement: Refinement { tolerance }, single: false })
        })
        .collect();
    variations.push(("state kept as f32".to_owned(), Arithmetic { single: true, ..Arithmetic::FULL }));
    variations
        .into_iter()
        .map(|(name, arithmetic)| {
            say(&format!("{}: {name}", problem.name));
            vary(problem, name, arithmetic, rounds)
        })
        .collect()
}

fn vary(problem: &Problem, name: String, arithmetic: Arithmetic, rounds: usize) -> Variation {
    let (mut fidelities, mut costs, mut steps, mut bounces) = (Vec::new(), Vec::new(), 0_u64, 0_usize);
    for round in 0..rounds.max(1) {
        let begun = Clock::now();
        let solutions: Vec<Solution<f64>> =
            problem.cases.iter().map(|case| solve(&case.scene, problem.extent, arithmetic, |value| value)).collect();
        let count: usize = solutions.iter().map(|solution| solution.bounces.len()).sum();
        costs.push(begun.elapsed().as_secs_f64() * 1e9 / count.max(1) as f64);
        if round == 0 {
            bounces = count;
            steps = solutions.iter().map(|solution| solution.steps).sum();
            let did = solutions.iter().zip(&problem.cases);
            fidelities =
                did.map(|(solution, case)| Fidelity::of(case, &trajectory(solution), problem.tolerance)).collect();
        }
    }
    Variation {
        name,
        steps: steps as f64 / bounces.max(1) as f64,
        nanoseconds: Spread::median(costs).unwrap_or(0.0),
        third: Spread::median(fidelities.iter().filter_map(|did| did.errors[1])),
        bounces: Spread::median(fidelities.iter().map(|did| did.bounces as f64)).unwrap_or(0.0),
        seconds: Spread::median(fidelities.iter().map(|did| did.seconds)).unwrap_or(0.0),
    }
}

fn trajectory(solution: &Solution<f64>) -> Trajectory {
    let piece = |flight: &super::reference::Flight<f64>| Piece {
        start: Wide::of(flight.start),
        position: flight.position.to_f64(),
        velocity: flight.velocity.to_f64(),
        acceleration: flight.gravity.to_f64(),
    };
    Trajectory {
        balls: solution.flights.iter().map(|flights| flights.iter().map(piece).collect()).collect(),
        lost: solution.lost.clone(),
        end: solution.end,
        ..Trajectory::default()
    }
}

/// What a spectator sees between snapshots.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct Between {
    /// Snapshots a second.
    pub hz: u32,
    /// Largest and mean distance from the truth, m, of a ball on the straight line between its places in two snapshots.
    pub straight: (f64, f64),
    /// Likewise of a ball on the flight of the earlier snapshot.
    pub flight: (f64, f64),
}

/// Snapshots a second.
const SNAPSHOTS: [u32; 7] = [5, 10, 20, 30, 60, 120, 240];
/// Moments between two snapshots.
const MOMENTS: u32 = 8;

/// The error between snapshots, at each rate.
pub fn snapshots(problem: &Problem) -> Vec<Between> {
    SNAPSHOTS.into_iter().map(|hz| between(problem, hz)).collect()
}

fn between(problem: &Problem, hz: u32) -> Between {
    let (mut straight, mut flight, mut count) = ((0.0_f64, 0.0_f64), (0.0_f64, 0.0_f64), 0.0);
    let interval = 1.0 / f64::from(hz);
    for case in &problem.cases {
        for ball in 0..case.truth.flights.len() {
            let at = |t: f64| case.truth.position(ball, Wide::of(t)).map(|position| position.to_f64());
            let flights = &case.truth.flights[ball];
            for snapshot in 0..(case.truth.end * f64::from(hz)) as u64 {
                let (from, to) = (snapshot as f64 * interval, (snapshot + 1) as f64 * interval);
                let (Some(a), Some(b)) = (at(from), at(to)) else { break };
                let place = flights.partition_point(|flight| flight.start.to_f64() <= from).max(1) - 1;
                for moment in 1..MOMENTS {
                    let share = f64::from(moment) / f64::from(MOMENTS);
                    let t = from + share * interval;
                    let Some(truth) = at(t) else { break };
                    let guess = flights[place].position_after(Wide::of(t) - flights[place].start).to_f64();
                    for (told, off) in [
                        (&mut straight, (a + (b - a) * share - truth).length()),
                        (&mut flight, (guess - truth).length()),
                    ] {
                        told.0 = told.0.max(off);
                        told.1 += off;
                    }
                    count += 1.0;
                }
            }
        }
    }
    let mean = |told: (f64, f64)| (told.0, if count > 0.0 { told.1 / count } else { 0.0 });
    Between { hz, straight: mean(straight), flight: mean(flight) }
}

/// Both as tables.
pub fn text(variations: &[Variation], snapshots: &[Between]) -> String {
    let mut out = String::from(
        "The arithmetic, varied in the reference's own solver (f64; the engine's own roots go to the last digit):\n\n\
         | variation | evaluations an impact | ns an impact | error at 3 (m) | kept bounces | kept s |\n|---|---|---|---|---|---|\n",
    );
    for one in variations {
        let third = one.third.map_or_else(|| "-".to_owned(), |third| format!("{third:.1e}"));
        let _ = writeln!(
            out,
            "| {} | {:.0} | {:.0} | {third} | {} | {:.2} |",
            one.name, one.steps, one.nanoseconds, one.bounces, one.seconds
        );
    }
    out.push_str(
        "\nWhat a spectator sees between two snapshots, mm off (one who steps a copy of the world is off by nothing):\n\n\
         | snapshots a second | straight line between them: largest | mean | the earlier one's flight: largest | mean |\n|---|---|---|---|---|\n",
    );
    for one in snapshots {
        let _ = writeln!(
            out,
            "| {} | {:.2} | {:.3} | {:.2} | {:.3} |",
            one.hz,
            one.straight.0 * 1e3,
            one.straight.1 * 1e3,
            one.flight.0 * 1e3,
            one.flight.1 * 1e3
        );
    }
    out
}

/// Both as JSON.
pub fn json(variations: &[Variation], snapshots: &[Between]) -> Value {
    let varied: Vec<Value> = variations
        .iter()
        .map(|one| {
            json!({
                "variation": one.name, "evaluations_an_impact": one.steps, "ns_an_impact": one.nanoseconds,
                "error_at_bounce_3": one.third, "kept_bounces": one.bounces, "kept_seconds": one.seconds,
            })
        })
        .collect();
    let seen: Vec<Value> = snapshots
        .iter()
        .map(|one| {
            json!({
                "hz": one.hz, "straight_most": one.straight.0, "straight_mean": one.straight.1,
                "flight_most": one.flight.0, "flight_mean": one.flight.1,
            })
        })
        .collect();
    json!({ "arithmetic": varied, "snapshots": seen })
}
