//! What was measured, as text and as JSON.

use core::fmt::Write;

use serde_json::{Value, json};
use shared::table::length_text;

use super::front::{dominated, front};
use super::outcome::{BOUNCES, Outcome, Spread};
use super::problem::Problem;
use super::reference::Ending;

/// The whole report: the problem, a line for each setting, and which ones are worth having.
pub fn text(problem: &Problem, outcomes: &[Outcome]) -> String {
    let mut out = problem_text(problem);
    out.push('\n');
    let (dominated, header) = (dominated(outcomes), header());
    out.push_str(&header);
    for (place, outcome) in outcomes.iter().enumerate() {
        let better = dominated[place].map(|other| format!("{} {}", outcomes[other].name, outcomes[other].setting));
        let verdict = match (&outcome.failed, better) {
            (Some(why), _) => format!("failed: {why}"),
            (None, Some(better)) => format!("dominated by {better}"),
            (None, None) if outcome.loses_balls() => "loses the ball".to_owned(),
            (None, None) => "on the front".to_owned(),
        };
        out.push_str(&line(outcome, &verdict));
    }
    out.push('\n');
    let front = front(outcomes);
    let _ = writeln!(out, "Pareto front, the cheapest first:");
    for &place in &front {
        let outcome = &outcomes[place];
        let _ = writeln!(
            out,
            "- {} at {}: {} ns for a simulated second; error at bounce 3 {} m; {} bounces or {:.2} s within {}",
            outcome.name,
            outcome.setting,
            outcome.cost.map_or_else(|| "?".to_owned(), |cost| format!("{:.0}", cost.median)),
            error(outcome.error(1)),
            outcome.bounces(),
            outcome.seconds(),
            length_text(problem.tolerance),
        );
    }
    let models: Vec<&str> = front.iter().map(|&place| outcomes[place].name.as_str()).collect();
    if let Some(only) = models.first().filter(|first| models.iter().all(|model| model == *first)) {
        let _ = writeln!(out, "There is no trade here: {only} is the cheapest and the most exact.");
    }
    out
}

fn problem_text(problem: &Problem) -> String {
    let cases = &problem.cases;
    let of = |values: Vec<f64>| Spread::median(values).unwrap_or(0.0);
    let mut out = format!("{}: ", problem.name);
    if problem.shots {
        let _ = write!(out, "{} shots from a game of the bot's, flippers at rest; medians", cases.len());
    } else {
        let _ = write!(out, "{} balls", cases[0].scene.start.len());
    }
    let _ = writeln!(
        out,
        ". The reference follows {:.2} s and {} bounces.",
        of(cases.iter().map(|case| case.truth.end).collect()),
        of(cases.iter().map(|case| case.truth.bounces.len() as f64).collect()),
    );
    let endings = [
        (Ending::Time, "at the time asked for"),
        (Ending::Bounces, "after as many bounces as asked for"),
        (Ending::Rest, "where a ball comes to rest or rolls"),
        (Ending::Gone, "where no ball is left"),
        (Ending::Digits, "where even its own digits do not suffice"),
    ];
    for (ending, what) in endings {
        let count = cases.iter().filter(|case| case.truth.ending == ending).count();
        if count > 0 {
            let _ = writeln!(
                out,
                "It ends {what}{}.",
                if cases.len() > 1 { format!(": {count} times") } else { String::new() }
            );
        }
    }
    let limit = |bits: &str, limits: Vec<(f64, usize)>| {
        format!(
            "Any arithmetic of {bits} bits departs by {} after {} bounces, at {:.2} s, or later.",
            length_text(problem.tolerance),
            of(limits.iter().map(|limit| limit.1 as f64).collect()),
            of(limits.iter().map(|limit| limit.0).collect()),
        )
    };
    let _ = writeln!(out, "{}", limit("53", cases.iter().map(|case| case.limit).collect()));
    let _ = writeln!(out, "{}", limit("24", cases.iter().map(|case| case.limit_of_singles).collect()));
    out
}

fn header() -> String {
    let errors = BOUNCES.map(|bounce| format!("error at {bounce} (m)")).join(" | ");
    format!(
        "| model | setting | ns for a simulated second | quartiles | {errors} | kept bounces | kept s | energy | escaped | passed through | verdict |\n\
         |---|---|---|---|---|---|---|---|---|---|---|---|---|\n"
    )
}

fn line(outcome: &Outcome, verdict: &str) -> String {
    let cost = outcome
        .cost
        .map_or_else(|| "? | ?".to_owned(), |cost| format!("{:.0} | {:.0} to {:.0}", cost.median, cost.low, cost.high));
    if outcome.cases.is_empty() {
        return format!("| {} | {} | {cost} | | | | | | | | | {verdict} |\n", outcome.name, outcome.setting);
    }
    let errors = [0, 1, 2].map(|place| error(outcome.error(place))).join(" | ");
    let energy = if outcome.finite() {
        outcome.energy().map_or("-".to_owned(), |energy| format!("{energy:.0e}"))
    } else {
        "not finite".to_owned()
    };
    format!(
        "| {} | {} | {cost} | {errors} | {} | {:.2} | {energy} | {} | {} | {verdict} |\n",
        outcome.name,
        outcome.setting,
        outcome.bounces(),
        outcome.seconds(),
        outcome.escaped(),
        outcome.passed(),
    )
}

fn error(error: Option<f64>) -> String {
    match error {
        None => "-".to_owned(),
        Some(error) if error.is_finite() => format!("{error:.1e}"),
        Some(_) => "lost".to_owned(),
    }
}

/// The same as JSON.
pub fn json(problem: &Problem, outcomes: &[Outcome]) -> Value {
    let (dominated, front) = (dominated(outcomes), front(outcomes));
    let told: Vec<Value> = outcomes
        .iter()
        .zip(&dominated)
        .map(|(outcome, dominated)| {
            json!({
                "model": outcome.name,
                "setting": outcome.setting,
                "hz": outcome.hz,
                "ns_per_simulated_second": outcome.cost.map(|cost| json!({
                    "median": cost.median, "low": cost.low, "high": cost.high,
                })),
                "error_at_bounce": {
                    "1": outcome.error(0), "3": outcome.error(1), "10": outcome.error(2),
                },
                "kept_bounces": outcome.bounces(),
                "kept_seconds": outcome.seconds(),
                "energy": outcome.energy(),
                "escaped": outcome.escaped(),
                "passed_through": outcome.passed(),
                "finite": outcome.finite(),
                "failed": outcome.failed,
                "dominated_by": dominated.map(|place| json!({
                    "model": outcomes[place].name, "setting": outcomes[place].setting,
                })),
            })
        })
        .collect();
    let cases: Vec<Value> = problem
        .cases
        .iter()
        .map(|case| {
            json!({
                "reference_seconds": case.truth.end,
                "reference_bounces": case.truth.bounces.len(),
                "f64_keeps": { "seconds": case.limit.0, "bounces": case.limit.1 },
                "f32_keeps": { "seconds": case.limit_of_singles.0, "bounces": case.limit_of_singles.1 },
            })
        })
        .collect();
    let names: Vec<String> =
        front.iter().map(|&place| format!("{} {}", outcomes[place].name, outcomes[place].setting)).collect();
    json!({
        "table": problem.name, "tolerance": problem.tolerance, "cases": cases, "settings": told, "front": names,
    })
}
