//! How the table feels to a player: the drills that players know and the motions that physics books solve, as named figures
//! with the range that a real machine, or a closed form, sets for each.
//!
//! `starball-server feel` prints them, and the unit tests hold them.

pub mod aim;
mod arm;
mod backhand;
pub mod catches;
mod cradle;
mod pair;
mod passes;
mod rolling;
mod shots;
mod stage;
mod stroke;
#[cfg(test)]
mod tests;

use core::fmt;

use serde::Serialize;

/// One thing that was measured, and where it should lie.
#[derive(Debug, Clone, PartialEq, Serialize)]
pub struct Figure {
    /// What was measured.
    pub what: String,
    /// In `unit`; NaN if the drill did not come to the point.
    pub measured: f64,
    /// Of `measured`, `low` and `high`.
    pub unit: &'static str,
    /// The least that passes.
    pub low: f64,
    /// The most that passes.
    pub high: f64,
}

impl Figure {
    fn between(what: impl Into<String>, measured: f64, unit: &'static str, low: f64, high: f64) -> Self {
        Self { what: what.into(), measured, unit, low, high }
    }

    fn at_most(what: impl Into<String>, measured: f64, unit: &'static str, high: f64) -> Self {
        Self::between(what, measured, unit, f64::NEG_INFINITY, high)
    }

    fn at_least(what: impl Into<String>, measured: f64, unit: &'static str, low: f64) -> Self {
        Self::between(what, measured, unit, low, f64::INFINITY)
    }

    /// Something worth knowing that has no range.
    fn told(what: impl Into<String>, measured: f64, unit: &'static str) -> Self {
        Self::between(what, measured, unit, f64::NEG_INFINITY, f64::INFINITY)
    }

    /// Whether it lies where it should. NaN lies nowhere.
    pub fn passes(&self) -> bool {
        (self.low..=self.high).contains(&self.measured)
    }

    /// Whether there is anything to pass.
    pub fn has_range(&self) -> bool {
        self.low.is_finite() || self.high.is_finite()
    }
}

/// Figures that belong together.
#[derive(Debug, Clone, Copy)]
pub struct Family {
    /// What they are about.
    pub name: &'static str,
    /// What is done, and what passes.
    pub drill: &'static str,
    measure: fn() -> Vec<Figure>,
}

impl Family {
    /// Plays the drills.
    pub fn measure(&self) -> Vec<Figure> {
        (self.measure)()
    }
}

/// All families, in the order in which they are printed.
pub const FAMILIES: &[Family] = &[
    stroke::STROKE,
    stroke::TAPS,
    aim::AIM,
    cradle::CRADLE,
    passes::DEAD_BOUNCE,
    catches::LIVE_CATCH,
    catches::DROP_CATCH,
    passes::POST_PASS,
    passes::TAP_PASS,
    backhand::BACKHAND,
    rolling::SLOPE,
    rolling::ARC,
    rolling::CREST,
    pair::PAIR,
    arm::ARM,
    shots::SHOTS,
];

/// A family with what was measured.
#[derive(Debug, Clone, PartialEq, Serialize)]
pub struct Row {
    /// See [`Family::name`].
    pub name: &'static str,
    /// See [`Family::drill`].
    pub drill: &'static str,
    /// In the order in which they were measured.
    pub figures: Vec<Figure>,
}

/// Everything that was measured; shown as a table in Markdown.
#[derive(Debug, Clone, Default, PartialEq, Serialize)]
pub struct Report {
    /// In the order of [`FAMILIES`].
    pub rows: Vec<Row>,
}

impl Report {
    /// Plays all drills; `after` is called after each family with its name.
    pub fn of_all(mut after: impl FnMut(&'static str)) -> Self {
        let mut report = Self::default();
        for family in FAMILIES {
            report.rows.push(Row { name: family.name, drill: family.drill, figures: family.measure() });
            after(family.name);
        }
        report
    }

    /// What is out of its range.
    pub fn failures(&self) -> Vec<String> {
        let figures = self.rows.iter().flat_map(|row| row.figures.iter().map(move |figure| (row.name, figure)));
        figures
            .filter(|(_, figure)| !figure.passes())
            .map(|(name, figure)| format!("{name}, {}: {} {}", figure.what, figure.measured, figure.unit))
            .collect()
    }
}

impl fmt::Display for Report {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        writeln!(f, "| what | figure | pass | measured | |\n|---|---|---|---|---|")?;
        for row in &self.rows {
            for (place, figure) in row.figures.iter().enumerate() {
                let name = if place == 0 { row.name } else { "" };
                let (range, value) = (Bounds(figure), Value(figure.measured, figure.unit));
                let verdict = match (figure.has_range(), figure.passes()) {
                    (false, _) => "",
                    (true, true) => " passes",
                    (true, false) => " **fails**",
                };
                writeln!(f, "| {name} | {} | {range} | {value} |{verdict} |", figure.what)?;
            }
        }
        writeln!(f, "\nThe drills:\n")?;
        self.rows.iter().try_for_each(|row| writeln!(f, "- {}: {}", row.name, row.drill))
    }
}

/// The range of a figure.
struct Bounds<'a>(&'a Figure);

impl fmt::Display for Bounds<'_> {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        let Figure { low, high, unit, .. } = *self.0;
        match (low.is_finite(), high.is_finite()) {
            (true, true) if low == high => write!(f, "{}", Value(low, unit)),
            (true, true) => write!(f, "{} to {}", Value(low, ""), Value(high, unit)),
            (true, false) => write!(f, "at least {}", Value(low, unit)),
            (false, true) => write!(f, "at most {}", Value(high, unit)),
            (false, false) => Ok(()),
        }
    }
}

/// A number with its unit: three digits, with an exponent where it is very small or large.
struct Value(f64, &'static str);

impl fmt::Display for Value {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        let Self(value, unit) = *self;
        let size = value.abs();
        if value.is_nan() {
            return write!(f, "never");
        } else if value == value.trunc() && size < 1e6 {
            write!(f, "{value:.0}")?;
        } else if !(1e-3..1e6).contains(&size) {
            write!(f, "{value:.1e}")?;
        } else {
            write!(
                f,
                "{value:.*}",
                if size < 1.0 {
                    4
                } else if size < 100.0 {
                    2
                } else {
                    1
                }
            )?;
        }
        if unit.is_empty() { Ok(()) } else { write!(f, " {unit}") }
    }
}
