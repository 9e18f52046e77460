//! The written form of a replay, in RON, read as if an enemy had written it.

use ron::Options;
use ron::ser::PrettyConfig;
use serde::de::Error;
use serde::{Deserialize, Deserializer, Serialize};

use super::{Checkpoint, FORMAT_VERSION, MOST_CHECKPOINTS, MOST_INPUTS, MOST_TEXT, MOST_TICKS, ReplayError};
use crate::game::Input;
use crate::math::bounded;
use crate::table::locate::{Step, line_of};
use crate::table::{is_printable, readable, unprintable};

/// Most characters of a complaint that are shown: it may quote the text.
const MOST_COMPLAINT: usize = 200;

/// A replay as written. The format comes first, so that no version of this reader trips over a later one's fields
/// before it knows that it is later.
#[derive(Debug, Clone, PartialEq, Eq, Serialize, Deserialize)]
#[serde(rename = "Replay", deny_unknown_fields)]
pub(super) struct ReplayFile {
    #[serde(deserialize_with = "known_format")]
    pub(super) format: u32,
    pub(super) physics: u32,
    pub(super) table: String,
    #[serde(with = "hex")]
    pub(super) table_digest: u64,
    pub(super) seed: u64,
    pub(super) ticks: u64,
    #[serde(deserialize_with = "bounded::list::<_, _, MOST_CHECKPOINTS>")]
    pub(super) checkpoints: Vec<Checkpoint>,
    #[serde(deserialize_with = "bounded::list::<_, _, MOST_INPUTS>")]
    pub(super) inputs: Vec<Input>,
}

/// What is wrong with a replay that could be read, and the way to it.
struct Fault {
    way: Vec<Step<'static>>,
    problem: String,
}

pub(super) fn parse(file: &str, source: &str) -> Result<ReplayFile, ReplayError> {
    let refuse = |line, problem| ReplayError::Text { file: file.to_owned(), line, problem };
    if source.len() > MOST_TEXT {
        let problem = format!("{} bytes are more than the {MOST_TEXT} that a replay may have", source.len());
        return Err(refuse(0, problem));
    }
    let replay: ReplayFile = Options::default()
        .from_str(source)
        .map_err(|error| refuse(error.span.start.line, readable(&error.code.to_string(), MOST_COMPLAINT)))?;
    replay.check().map_err(|fault| refuse(line_of(source, &fault.way), readable(&fault.problem, MOST_COMPLAINT)))?;
    Ok(replay)
}

/// One line for each input and each checkpoint.
pub(super) fn write(replay: &ReplayFile) -> String {
    // RON's own line break is the platform's.
    let config = PrettyConfig::new().new_line("\n").depth_limit(2);
    let mut text = ron::ser::to_string_pretty(replay, config).expect("derived Serialize does not fail");
    text.push('\n');
    text
}

impl ReplayFile {
    /// What no single field shows: limits and order.
    fn check(&self) -> Result<(), Fault> {
        if !is_printable(&self.table) {
            return Err(Fault { way: vec![Step::Field("table")], problem: unprintable(&self.table) });
        }
        if self.ticks > MOST_TICKS {
            let error = ReplayError::TooLong { what: "ticks", found: self.ticks, most: MOST_TICKS };
            return Err(Fault { way: vec![Step::Field("ticks")], problem: error.to_string() });
        }
        self.check_checkpoints()?;
        self.check_inputs()
    }

    fn check_checkpoints(&self) -> Result<(), Fault> {
        let ticks = self.checkpoints.iter().map(|checkpoint| checkpoint.tick);
        if let Some(place) = ticks.clone().zip(ticks.skip(1)).position(|(before, after)| after <= before) {
            let (before, after) = (self.checkpoints[place].tick, self.checkpoints[place + 1].tick);
            let problem = format!("a checkpoint at tick {after} after one at {before}: a later tick would be right");
            return Err(Fault { way: vec![Step::Field("checkpoints"), Step::Item(place + 1)], problem });
        }
        let way = vec![Step::Field("checkpoints"), Step::Item(self.checkpoints.len().saturating_sub(1))];
        match self.checkpoints.last() {
            Some(last) if last.tick == self.ticks => Ok(()),
            Some(last) => {
                let (tick, ticks) = (last.tick, self.ticks);
                let problem = format!("the last checkpoint is at tick {tick}: {ticks}, the end, would be right");
                Err(Fault { way, problem })
            }
            None => Err(Fault { way, problem: format!("no checkpoint: one at tick {} would be right", self.ticks) }),
        }
    }

    fn check_inputs(&self) -> Result<(), Fault> {
        let mut before = 0;
        for (place, &Input { tick, .. }) in self.inputs.iter().enumerate() {
            let problem = if tick < before {
                format!("an input at tick {tick} after one at {before}: sorted by tick would be right")
            } else if tick >= self.ticks {
                format!(
                    "an input at tick {tick} of a replay that ends at {}: an earlier tick would be right",
                    self.ticks
                )
            } else {
                before = tick;
                continue;
            };
            return Err(Fault { way: vec![Step::Field("inputs"), Step::Item(place)], problem });
        }
        Ok(())
    }
}

fn known_format<'de, D: Deserializer<'de>>(deserializer: D) -> Result<u32, D::Error> {
    match u32::deserialize(deserializer)? {
        FORMAT_VERSION => Ok(FORMAT_VERSION),
        other => Err(D::Error::custom(format!("replay format {other} is not known: {FORMAT_VERSION} would be right"))),
    }
}

/// A digest as a string of 16 lower-case hex digits: there is one way to write it, and no reader takes it for a float.
pub(super) mod hex {
    use core::fmt;

    use serde::de::{Error, Unexpected, Visitor};
    use serde::{Deserializer, Serializer};

    #[allow(clippy::trivially_copy_pass_by_ref)] // serde's signature
    pub(in super::super) fn serialize<S: Serializer>(digest: &u64, serializer: S) -> Result<S::Ok, S::Error> {
        serializer.collect_str(&format_args!("{digest:016x}"))
    }

    pub(in super::super) fn deserialize<'de, D: Deserializer<'de>>(deserializer: D) -> Result<u64, D::Error> {
        struct Digits;

        impl Visitor<'_> for Digits {
            type Value = u64;

            fn expecting(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
                f.write_str("a digest of 16 digits from 0 to 9 and a to f")
            }

            fn visit_str<E: Error>(self, text: &str) -> Result<u64, E> {
                // `from_str_radix` alone would also take a sign and capitals.
                let is_plain = text.len() == 16 && text.bytes().all(|byte| matches!(byte, b'0'..=b'9' | b'a'..=b'f'));
                match u64::from_str_radix(text, 16) {
                    Ok(digest) if is_plain => Ok(digest),
                    _ => Err(E::invalid_value(Unexpected::Str(text), &self)),
                }
            }
        }

        deserializer.deserialize_str(Digits)
    }
}
