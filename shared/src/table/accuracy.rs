//! What a table may ask for instead of a motion model and a tick rate: an accuracy, and for how long.

use core::fmt;
use core::str::FromStr;

use serde::{Deserialize, Serialize};

/// An accuracy that a table, or whoever measures it, asks for.
#[derive(Debug, Clone, Copy, PartialEq, Serialize, Deserialize)]
#[serde(deny_unknown_fields)]
pub struct Accuracy {
    /// The most that a ball may be off its true place, m.
    pub tolerance: f64,
    /// For how long.
    pub horizon: Horizon,
}

/// For how long an accuracy is to be kept. Pinball is chaotic: every engine departs from the truth in the end.
#[derive(Debug, Clone, Copy, PartialEq, Serialize, Deserialize)]
pub enum Horizon {
    /// World time.
    Seconds(f64),
    /// Impacts.
    Bounces(u32),
}

/// Smallest and largest tolerance, m.
const TOLERANCES: (f64, f64) = (1e-15, 1.0);
/// Shortest and longest time, seconds.
const SECONDS: (f64, f64) = (0.001, 1000.0);
/// Most impacts.
const MOST_BOUNCES: u32 = 1000;

impl Accuracy {
    /// What is wrong with it, and what would be right.
    pub(super) fn problem(&self) -> Option<String> {
        tolerance_in_range(self.tolerance).and_then(|_| self.horizon.in_range()).err()
    }
}

impl Horizon {
    fn in_range(self) -> Result<Self, String> {
        let fits = match self {
            Self::Seconds(seconds) => (SECONDS.0..=SECONDS.1).contains(&seconds),
            Self::Bounces(bounces) => (1..=MOST_BOUNCES).contains(&bounces),
        };
        if fits {
            return Ok(self);
        }
        let (low, high) = SECONDS;
        Err(format!("a horizon of {self}; {low} to {high} s, or 1 to {MOST_BOUNCES} bounces, would be right"))
    }
}

fn tolerance_in_range(metres: f64) -> Result<f64, String> {
    let (low, high) = TOLERANCES;
    if (low..=high).contains(&metres) {
        return Ok(metres);
    }
    Err(format!("a tolerance of {metres} m; {low:e} to {high} m, such as 0.0001, would be right"))
}

/// A length as written in commands, such as `0.1mm`: in m, mm, um or nm; a plain number is in metres.
///
/// # Errors
/// If it is none, or not within 1e-15 to 1 m.
pub fn parse_tolerance(text: &str) -> Result<f64, String> {
    let units = [("mm", 1e-3), ("um", 1e-6), ("nm", 1e-9), ("m", 1.0), ("", 1.0)];
    let written = units.into_iter().find_map(|(unit, factor)| text.strip_suffix(unit).map(|number| (number, factor)));
    let (number, factor) = written.unwrap_or((text, 1.0));
    let number: f64 = number
        .trim()
        .parse()
        .map_err(|_| format!("{text:?} is no length; 0.1mm, 50um, 2nm or 0.0001m would be right"))?;
    tolerance_in_range(number * factor)
}

/// A length in metres as people say it, such as `0.1 mm`.
pub fn length_text(metres: f64) -> String {
    let (factor, unit) = match metres {
        length if length >= 1.0 => (1.0, "m"),
        length if length >= 1e-5 => (1e3, "mm"),
        length if length >= 1e-8 => (1e6, "um"),
        _ => (1e9, "nm"),
    };
    // Six decimals: the factor is rounded.
    format!("{} {unit}", (metres * factor * 1e6).round() / 1e6)
}

impl FromStr for Horizon {
    type Err = String;

    fn from_str(text: &str) -> Result<Self, String> {
        let wrong = || format!("{text:?} is no horizon; 3s or 10bounces would be right");
        let bounces = text.strip_suffix("bounces").or_else(|| text.strip_suffix("bounce"));
        let horizon = if let Some(count) = bounces {
            Self::Bounces(count.trim().parse().map_err(|_| wrong())?)
        } else {
            let seconds = text.strip_suffix('s').ok_or_else(wrong)?;
            Self::Seconds(seconds.trim().parse().map_err(|_| wrong())?)
        };
        horizon.in_range()
    }
}

impl fmt::Display for Horizon {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        match self {
            Self::Seconds(seconds) => write!(f, "{seconds} s"),
            Self::Bounces(1) => f.write_str("1 bounce"),
            Self::Bounces(bounces) => write!(f, "{bounces} bounces"),
        }
    }
}

impl fmt::Display for Accuracy {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        write!(f, "{} over {}", length_text(self.tolerance), self.horizon)
    }
}

#[cfg(test)]
mod tests {
    use super::super::Table;
    use super::*;
    use crate::physics::motion::Motion;

    const SCENE: &str = r#"// accuracy: (of a comment)
Scene(
    gravity: (0.0, -1.0), /* exact enough */ accuracy: (tolerance: 0.0001, horizon: Seconds(3.0)), // as asked
    balls: [(position: (0.1, 0.5))],
    elements: [Wall(name: "accuracy", points: [(0.0, 0.0), (1.0, 0.0)])],
)"#;

    fn parse(text: &str) -> Result<Table, String> {
        Table::parse("a.ron", text).map_err(|error| error.to_string())
    }

    #[test]
    fn lengths_and_times_are_read_as_people_write_them() {
        for (text, metres) in [("0.1mm", 1e-4), ("50um", 5e-5), ("2nm", 2e-9), ("0.001", 1e-3), ("0.5 m", 0.5)] {
            let read = parse_tolerance(text).unwrap_or_else(|error| panic!("{error}"));
            assert!((read - metres).abs() <= 1e-15 * metres, "{text}");
        }
        assert_eq!("3s".parse(), Ok(Horizon::Seconds(3.0)));
        assert_eq!("10bounces".parse(), Ok(Horizon::Bounces(10)));
        assert_eq!("1bounce".parse(), Ok(Horizon::Bounces(1)));
        for nonsense in ["", "mm", "-1mm", "NaN", "1e400m", "0", "3 parsecs", "infm"] {
            let error = parse_tolerance(nonsense).expect_err(nonsense);
            assert!(error.contains("would be right"), "{error}");
        }
        for nonsense in ["", "s", "3", "-1s", "NaNs", "0bounces", "1.5bounces", "1e9s", "99999999999bounces"] {
            let error = nonsense.parse::<Horizon>().expect_err(nonsense);
            assert!(error.contains("would be right"), "{error}");
        }
        let accuracy = Accuracy { tolerance: 1e-4, horizon: Horizon::Bounces(10) };
        assert_eq!(accuracy.to_string(), "0.1 mm over 10 bounces");
    }

    #[test]
    fn a_resolved_table_has_motion_and_rate_in_its_text_and_nothing_else_changed() {
        let table = parse(SCENE).unwrap_or_else(|error| panic!("{error}"));
        assert_eq!(table.accuracy, Some(Accuracy { tolerance: 1e-4, horizon: Horizon::Seconds(3.0) }));
        let resolved = table.resolved(Motion::Swept, 240).unwrap_or_else(|error| panic!("{error}"));
        let by_hand =
            SCENE.replace("accuracy: (tolerance: 0.0001, horizon: Seconds(3.0))", "motion: Swept, tick_hz: 240");
        assert_eq!(resolved.source, by_hand);
        assert_eq!(resolved.digest, parse(&by_hand).unwrap_or_else(|error| panic!("{error}")).digest);
        assert_eq!((resolved.accuracy, resolved.scene.motion), (None, Motion::Swept));
        assert_eq!(resolved.scene.tick_seconds, 1.0 / 240.0);
        assert_eq!(resolved.resolved(Motion::Exact, 1000).as_ref(), Ok(&resolved), "it is resolved once");
    }

    #[test]
    fn a_played_table_may_ask_as_well() {
        let classic = super::super::SHIPPED[0].source;
        let text = classic.replacen("rest_speed:", "accuracy: (tolerance: 0.001, horizon: Bounces(3)), rest_speed:", 1);
        let text: String =
            text.lines().filter(|line| !line.trim_start().starts_with("tick_hz:")).map(|l| format!("{l}\n")).collect();
        let table = parse(&text).unwrap_or_else(|error| panic!("{error}"));
        assert_eq!(table.accuracy.map(|accuracy| accuracy.horizon), Some(Horizon::Bounces(3)));
        assert!(
            table.resolved(Motion::Exact, 500).is_ok_and(|table| table.source.contains("motion: Exact, tick_hz: 500"))
        );
    }

    #[test]
    fn what_cannot_be_asked_for_is_refused_with_its_line() {
        for (what, instead) in [
            ("0.0001", "-1.0"),
            ("0.0001", "2.0"),
            ("Seconds(3.0)", "Seconds(0.0)"),
            ("Seconds(3.0)", "Bounces(0)"),
            ("Seconds(3.0))", "Seconds(3.0)), motion: Exact"),
            ("Seconds(3.0))", "Seconds(3.0)), tick_hz: 100"),
        ] {
            let error = parse(&SCENE.replacen(what, instead, 1)).expect_err(instead);
            assert!(error.starts_with("a.ron:3") && error.contains("would be right"), "{error}");
        }
    }
}
