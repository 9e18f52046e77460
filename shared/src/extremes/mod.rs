//! The stability suite: what the physics promises at its extremes, as a list of named checks that are run for each motion
//! model. Each measures one figure, the smaller the better; at or below its goal the model passes.
//!
//! Where a model cannot reach a goal, the list says so: the figure that it keeps to instead, and why. An outcome that is
//! neither is a failure: the unit tests fail, and so does `starball-server extremes`.

mod account;
mod cases;
mod energy;
mod known;
mod limits;
pub mod overlap;
mod places;
mod refusals;
pub mod shots;
mod symmetry;
#[cfg(test)]
mod tests;
mod ticks;
mod tolerance;
pub mod transform;

use core::fmt;

use crate::physics::motion::Motion;

/// What a check came to.
#[derive(Debug, Clone, PartialEq)]
pub enum Outcome {
    /// The goal is reached.
    Passes {
        /// The figure, in the check's unit.
        measured: f64,
    },
    /// It is not, and that is known: the figure is within the one that is stated.
    Limit {
        /// The figure, in the check's unit.
        measured: f64,
        /// What about the model makes it so.
        why: &'static str,
    },
    /// Worse than what is stated, or nothing that can be measured.
    Fails {
        /// What happened instead.
        what: String,
    },
}

/// What a model is known not to reach.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct Known {
    /// Whose limit it is.
    pub motion: Motion,
    /// The figure that it keeps to. Infinite: it loses balls.
    pub within: f64,
    /// What about the model makes it so.
    pub why: &'static str,
}

/// One check.
#[derive(Debug, Clone, Copy)]
pub struct Check {
    /// What is promised.
    pub name: &'static str,
    /// What the figure counts.
    pub unit: &'static str,
    /// The largest figure that passes.
    pub goal: f64,
    /// The models that do not reach it.
    pub known: &'static [Known],
    /// Measures the figure, or says what must not happen whatever the model: NaN, work without bound.
    measure: fn(Motion) -> Result<f64, String>,
}

impl Check {
    /// Runs it for one model.
    pub fn run(&self, motion: Motion) -> Outcome {
        let known = self.known.iter().find(|known| known.motion == motion);
        match ((self.measure)(motion), known) {
            (Ok(measured), _) if measured <= self.goal => Outcome::Passes { measured },
            (Ok(measured), Some(known)) if measured <= known.within => Outcome::Limit { measured, why: known.why },
            (Ok(measured), known) => {
                let bound = known.map_or(self.goal, |known| known.within);
                Outcome::Fails { what: format!("{measured:.2e} {} instead of {bound:.2e} at the most", self.unit) }
            }
            (Err(what), _) => Outcome::Fails { what },
        }
    }
}

/// All checks, in the order in which they are printed.
pub fn checks() -> impl Iterator<Item = &'static Check> {
    [symmetry::CHECKS, tolerance::CHECKS, energy::CHECKS, limits::CHECKS, places::CHECKS, ticks::CHECKS, shots::CHECKS]
        .into_iter()
        .chain([refusals::CHECKS])
        .flatten()
}

/// Outcomes by check and model, as they are shown: a table in Markdown, and the reasons under it.
#[derive(Debug, Clone, Default)]
pub struct Report {
    rows: Vec<(&'static Check, Vec<Outcome>)>,
}

impl Report {
    /// Runs every check for every model; `after` is called after each with its name.
    pub fn of_all(mut after: impl FnMut(&'static str)) -> Self {
        let mut report = Self::default();
        for check in checks() {
            report.rows.push((check, Motion::ALL.iter().map(|&motion| check.run(motion)).collect()));
            after(check.name);
        }
        report
    }

    /// Whether every outcome is one that was expected.
    pub fn is_as_expected(&self) -> bool {
        self.rows.iter().flat_map(|(_, outcomes)| outcomes).all(|outcome| !matches!(outcome, Outcome::Fails { .. }))
    }
}

impl fmt::Display for Report {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        let mut reasons: Vec<&'static str> = Vec::new();
        let mut failures: Vec<String> = Vec::new();
        write!(f, "| what is checked | goal |")?;
        Motion::ALL.iter().try_for_each(|motion| write!(f, " {motion} |"))?;
        writeln!(f, "\n|---|---|{}", "---|".repeat(Motion::ALL.len()))?;
        for (check, outcomes) in &self.rows {
            write!(f, "| {} | {} |", check.name, Figure(check.goal, check.unit))?;
            for (motion, outcome) in Motion::ALL.iter().zip(outcomes) {
                match outcome {
                    Outcome::Passes { .. } => write!(f, " passes |")?,
                    Outcome::Limit { measured, why } => {
                        let place = reasons.iter().position(|known| known == why).unwrap_or_else(|| {
                            reasons.push(why);
                            reasons.len() - 1
                        });
                        write!(f, " {} [{}] |", Figure(*measured, check.unit), place + 1)?;
                    }
                    Outcome::Fails { what } => {
                        failures.push(format!("{}, {motion}: {what}", check.name));
                        write!(f, " **fails** |")?;
                    }
                }
            }
            writeln!(f)?;
        }
        if !reasons.is_empty() {
            writeln!(f)?;
        }
        for (number, why) in (1..).zip(&reasons) {
            writeln!(f, "{number}. {why}")?;
        }
        if !failures.is_empty() {
            writeln!(f, "\nWorse than expected:\n")?;
        }
        failures.iter().try_for_each(|failure| writeln!(f, "- {failure}"))
    }
}

/// A figure with its unit; counts without exponent.
struct Figure(f64, &'static str);

impl fmt::Display for Figure {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        let Self(value, unit) = *self;
        let unit = if unit.is_empty() { String::new() } else { format!(" {unit}") };
        if value == f64::INFINITY {
            write!(f, "loses the ball")
        } else if value == value.trunc() && value.abs() < 1e6 {
            write!(f, "{value:.0}{unit}")
        } else {
            write!(f, "{value:.0e}{unit}")
        }
    }
}
