//! `measure`: what a table's speed costs in accuracy, and its accuracy in speed.
//!
//! 1. [`problem`](mod@problem): the table's balls, or shots on it, each with its [`reference`](mod@reference) of twice the digits of f64.
//! 2. [`contender`]: every motion model at a ladder of step sizes plays them, as may other engines.
//! 3. [`outcome`]: their errors at the reference's own moments, and what they cost, timed in turns.
//! 4. [`front`]: which of them are worth having, and the cheapest that keeps a tolerance.
//! 5. [`axes`], [`loses`] and [`statistics`]: root tolerance, f32 and snapshots; where exact loses; whole games.
//! 6. [`report`] and [`plot`]: as text, JSON and SVG.
//! 7. [`manual`]: the figures of the manual by every motion model, as a picture.

use std::time::Duration;

use serde_json::Value;
use shared::table::{Accuracy, Horizon, Table};

use contender::{Contender, Setting, ladder};
use outcome::{Effort, Outcome, measure};
use problem::Problem;
use reference::Extent;

pub mod axes;
pub mod contender;
pub mod front;
pub mod loses;
pub mod manual;
pub mod needs;
pub mod outcome;
pub mod plot;
pub mod polynomial;
pub mod problem;
pub mod real;
pub mod reference;
pub mod report;
pub mod statistics;
#[cfg(test)]
mod tests;
pub mod trajectory;

/// How much is measured.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct Plan {
    /// How far the reference goes.
    pub extent: Extent,
    /// What counts as a departure, m.
    pub tolerance: f64,
    /// Shots on a played table.
    pub shots: usize,
    /// Whole games of a played table, with each setting.
    pub games: usize,
    /// Of the timing.
    pub effort: Effort,
    /// Fewer settings.
    pub quick: bool,
}

/// A departure that nobody would see, m.
const TOLERANCE: f64 = 1e-4;
/// Impacts after which a reference ends: more than numbers of 53 bits can follow on most tables.
const MOST_BOUNCES: usize = 300;

impl Plan {
    /// A plan for a minute, or for as long as it takes.
    pub fn new(quick: bool, seconds: f64, asked: Option<Accuracy>) -> Self {
        let extent = match asked.map(|accuracy| accuracy.horizon) {
            // As many impacts as that takes, within reason.
            Some(Horizon::Seconds(horizon)) => Extent { seconds: seconds.max(horizon), bounces: 10 * MOST_BOUNCES },
            // As long as it takes to see so many.
            Some(Horizon::Bounces(bounces)) => {
                Extent { seconds: LONGEST, bounces: (bounces as usize).max(MOST_BOUNCES) }
            }
            None => Extent { seconds, bounces: MOST_BOUNCES },
        };
        let second = Duration::from_secs(1);
        let effort = if quick {
            Effort { rounds: 3, patience: second, budget: 15 * second }
        } else {
            Effort { rounds: 9, patience: 20 * second, budget: 300 * second }
        };
        let tolerance = asked.map_or(TOLERANCE, |accuracy| accuracy.tolerance);
        Self {
            extent,
            tolerance,
            shots: if quick { 12 } else { 40 },
            games: if quick { 20 } else { 200 },
            effort,
            quick,
        }
    }
}

/// Longest time for which a given number of impacts is waited for, seconds.
const LONGEST: f64 = 60.0;

/// What is to be measured of a table.
///
/// # Errors
/// If there is nothing in it to measure.
pub fn problem(table: &Table, plan: &Plan, say: &mut dyn FnMut(&str)) -> Result<Problem, String> {
    say(&format!("{}: the reference", table.name));
    Problem::of(table, plan.extent, plan.tolerance, plan.shots)
}

/// Measures a table: every setting of the ladder.
///
/// # Errors
/// If there is nothing in it to measure.
pub fn run(table: &Table, plan: &Plan, say: &mut dyn FnMut(&str)) -> Result<(Problem, Vec<Outcome>), String> {
    let problem = problem(table, plan, say)?;
    let settings = ladder(&table.scene, plan.quick);
    let contenders: Vec<Box<dyn Contender>> =
        settings.into_iter().map(|setting| Box::new(setting) as Box<dyn Contender>).collect();
    let outcomes = measure(&problem, &contenders, plan.effort, say);
    Ok((problem, outcomes))
}

/// The table with the cheapest motion model and tick rate that keep an accuracy as fields of its text, and a sentence that
/// says which.
///
/// # Errors
/// If none keeps it: what comes closest.
pub fn resolve(table: &Table, accuracy: &Accuracy) -> Result<(Table, String), String> {
    let plan = Plan::new(true, 1.0, Some(*accuracy));
    let problem = problem(table, &plan, &mut |_| ())?;
    // A table can name a model and a rate; its pixel is its own.
    let settings: Vec<Setting> =
        ladder(&table.scene, true).into_iter().filter(|setting| setting.pixel.is_none()).collect();
    let contenders: Vec<Box<dyn Contender>> =
        settings.iter().map(|&setting| Box::new(setting) as Box<dyn Contender>).collect();
    let outcomes = measure(&problem, &contenders, plan.effort, &mut |_| ());
    let chosen = settings[front::choose(&outcomes, &problem, accuracy)?];
    let resolved = table.resolved(chosen.motion, chosen.tick_hz).map_err(|error| error.to_string())?;
    Ok((resolved, front::sentence(&outcomes, &problem, accuracy)?))
}

/// What else there is to say: the arithmetic and the snapshots, where exact loses, and whole games of a played table. As text
/// and as JSON.
///
/// # Errors
/// If a scene of these cannot be read: a bug.
pub fn further(
    table: &Table,
    problem: &Problem,
    plan: &Plan,
    say: &mut dyn FnMut(&str),
) -> Result<(String, Value), String> {
    let rounds = plan.effort.rounds;
    let (arithmetic, snapshots) = (axes::arithmetic(problem, rounds, say), axes::snapshots(problem));
    let mut text = axes::text(&arithmetic, &snapshots);
    let mut told = axes::json(&arithmetic, &snapshots);
    let mut compared = loses::compare(rounds, plan.effort.patience, say)?;
    if table.has_rules {
        compared.extend(loses::flippers(table, rounds, say));
    }
    text += &format!("\n{}", loses::text(&compared));
    told["where_exact_loses"] = loses::json(&compared);
    if table.has_rules {
        let games = statistics::games(table, plan.games, say)?;
        text += &format!("\n{}", statistics::text(&games));
        told["games"] = statistics::json(&games);
    }
    Ok((text, told))
}
