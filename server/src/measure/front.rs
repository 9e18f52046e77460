//! Which settings are worth having, and which one to take.

use shared::table::{Accuracy, Horizon};

use super::outcome::Outcome;
use super::problem::{Case, Problem};
use super::reference::Ending;

/// Errors below this are all rounding, m.
const ROUNDING: f64 = 1e-12;
/// Errors that differ by less than this factor are alike.
const ALIKE: f64 = 2.0;

/// Whether `one` is nowhere worse than `other`, and cheaper or somewhere better.
fn dominates(one: &Outcome, other: &Outcome) -> bool {
    let (Some(cost), Some(others)) = (one.cost, other.cost) else { return false };
    let no_worse = |a: f64, b: f64| a <= (ALIKE * b).max(ROUNDING);
    let better = |a: f64, b: f64| !no_worse(b, a);
    let errors = || (0..3).filter_map(|place| one.error(place).zip(other.error(place)));
    let is_no_worse = cost.median <= others.median
        && errors().all(|(a, b)| no_worse(a, b))
        && one.earned() >= other.earned()
        && !one.loses_balls();
    let is_better = cost.high < others.low || errors().any(|(a, b)| better(a, b)) || one.earned() > other.earned();
    is_no_worse && is_better
}

/// For each outcome, which other makes it pointless: cheaper, and nowhere worse.
pub fn dominated(outcomes: &[Outcome]) -> Vec<Option<usize>> {
    outcomes
        .iter()
        .map(|outcome| {
            let better = outcomes.iter().enumerate().filter(|(_, other)| dominates(other, outcome));
            let cost = |outcome: &Outcome| outcome.cost.map_or(f64::INFINITY, |cost| cost.median);
            better.min_by(|(_, a), (_, b)| cost(a).total_cmp(&cost(b))).map(|(place, _)| place)
        })
        .collect()
}

/// The settings that lose no ball and that nothing makes pointless, the cheapest first.
pub fn front(outcomes: &[Outcome]) -> Vec<usize> {
    let dominated = dominated(outcomes);
    let cost = |place: usize| outcomes[place].cost.map_or(f64::INFINITY, |cost| cost.median);
    let mut front: Vec<usize> =
        (0..outcomes.len()).filter(|&place| outcomes[place].cost.is_some() && dominated[place].is_none()).collect();
    front.retain(|&place| !outcomes[place].loses_balls());
    front.sort_by(|&a, &b| cost(a).total_cmp(&cost(b)));
    front
}

/// Whether a setting keeps an accuracy in every case: up to the horizon, or until its ball rests, rolls or is lost.
fn keeps(outcome: &Outcome, problem: &Problem, horizon: Horizon) -> bool {
    outcome.failed.is_none()
        && outcome.cases.iter().zip(&problem.cases).all(|(did, case)| {
            did.finite
                && ((did.to_the_end && matches!(case.truth.ending, Ending::Rest | Ending::Gone))
                    || match horizon {
                        Horizon::Seconds(seconds) => did.seconds >= seconds,
                        Horizon::Bounces(bounces) => did.bounces >= bounces as usize,
                    })
        })
}

/// Which setting is the cheapest that keeps the accuracy, in a sentence.
///
/// # Errors
/// If none does: what comes closest.
pub fn sentence(outcomes: &[Outcome], problem: &Problem, accuracy: &Accuracy) -> Result<String, String> {
    let chosen = &outcomes[choose(outcomes, problem, accuracy)?];
    let cost = chosen.cost.map_or(0.0, |cost| cost.median);
    let (name, setting) = (&chosen.name, &chosen.setting);
    let ends_before = |case: &&Case| match accuracy.horizon {
        Horizon::Seconds(seconds) => case.truth.end < seconds,
        Horizon::Bounces(bounces) => case.truth.bounces.len() < bounces as usize,
    };
    let (short, all) = (problem.cases.iter().filter(ends_before).count(), problem.cases.len());
    let note = match short {
        0 => String::new(),
        _ => format!(" In {short} of {all} cases a ball rests, rolls or is lost before that; up to there it is kept."),
    };
    Ok(format!("{name} at {setting} is the cheapest that keeps {accuracy}: {cost:.0} ns for a simulated second.{note}"))
}

/// The cheapest of the outcomes that keeps the accuracy which the problem was measured with.
///
/// # Errors
/// If none does: what comes closest.
pub fn choose(outcomes: &[Outcome], problem: &Problem, accuracy: &Accuracy) -> Result<usize, String> {
    let cost = |place: usize| outcomes[place].cost.map_or(f64::INFINITY, |cost| cost.median);
    let mut keeping: Vec<usize> =
        (0..outcomes.len()).filter(|&place| keeps(&outcomes[place], problem, accuracy.horizon)).collect();
    keeping.sort_by(|&a, &b| cost(a).total_cmp(&cost(b)));
    if let Some(&cheapest) = keeping.first() {
        return Ok(cheapest);
    }
    let kept = |outcome: &Outcome| {
        let seconds = outcome.cases.iter().map(|case| case.seconds).fold(f64::INFINITY, f64::min);
        let bounces = outcome.cases.iter().map(|case| case.bounces).min().unwrap_or(0);
        (seconds, bounces)
    };
    let measured = outcomes.iter().filter(|outcome| outcome.failed.is_none());
    let best = measured.max_by(|a, b| kept(a).0.total_cmp(&kept(b).0));
    let limit = problem.cases.iter().map(|case| case.limit).reduce(|a, b| if b.0 < a.0 { b } else { a });
    let (Some(best), Some(limit)) = (best, limit) else { return Err(format!("{accuracy}: nothing was measured")) };
    let (seconds, bounces) = kept(best);
    let followed = problem.cases.iter().map(|case| case.truth.end).fold(f64::INFINITY, f64::min);
    Err(format!(
        "{accuracy} cannot be reached on {}: the best is {} at {}, which keeps it for {seconds:.3} s or {bounces} bounces in the worst case; \
         numbers of 53 bits can for {:.3} s or {} bounces, \
         and the reference follows {followed:.3} s",
        problem.name, best.name, best.setting, limit.0, limit.1,
    ))
}
