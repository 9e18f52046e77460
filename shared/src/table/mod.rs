//! Tables: the written form ([`format`](mod@format)) becomes a checked [`Table`], with errors that name file, line,
//! element and field. After the check no function asks again.

mod accuracy;
mod check;
mod crowd;
#[cfg(test)]
mod description_tests;
mod error;
pub mod format;
mod format_crowd;
mod format_mechanisms;
mod format_rules;
pub(crate) mod locate;
mod mechanisms;
#[cfg(test)]
mod mechanisms_tests;
mod rule_names;
mod rulebook;
#[cfg(test)]
mod rules_tests;
mod scene_form;
mod shapes;
mod shipped;
#[cfg(test)]
mod tests;
mod unique;

use std::sync::Arc;

use glam::DVec2;

pub use accuracy::{Accuracy, Horizon, length_text, parse_tolerance};
pub(crate) use check::{is_printable, unprintable};
pub use crowd::{CrowdAction, CrowdRules, MOST_CROWD_ACTIONS};
pub use error::TableError;
pub(crate) use error::readable;
pub use format::{ElementFile, TableFile};
pub use rulebook::{BallSaveRules, Command, Condition, MOST_EXTRA_BALLS, MOST_SECONDS, Rule, RuleBook, Trigger};
pub use scene_form::{SceneBall, SceneElement, SceneFile};
pub use shipped::{SHIPPED, Shipped};

use crate::math::digest_of;
use crate::physics::motion::Motion;
use crate::physics::scene::Scene;

/// Version of the written form.
pub const FORMAT_VERSION: u32 = 1;

/// The largest table text that is read, bytes. A table from the network is held to it as well.
pub const MOST_TEXT: usize = 256 * 1024;

/// The largest scene text that is read, bytes. Scenes are not sent.
pub const MOST_SCENE_TEXT: usize = 16 * 1024 * 1024;

/// A table that has passed every check.
#[derive(Debug, Clone, PartialEq)]
pub struct Table {
    /// Shown to players.
    pub name: String,
    /// The text that it was read from: what a server sends to whoever joins.
    pub source: String,
    /// Digest of that text.
    pub digest: u64,
    /// What it asks for and has not got yet: its motion model and tick rate are still those of any table. Such a table is
    /// neither served nor joined; see [`Self::resolved`].
    pub accuracy: Option<Accuracy>,
    /// Whether it is played by rules; a bare scene has none.
    pub has_rules: bool,
    /// The written form, for drawing.
    pub file: TableFile,
    /// What the physics plays in.
    pub scene: Arc<Scene>,
    /// Where a ball is served.
    pub ball_start: DVec2,
    /// The rules, with names resolved.
    pub rules: RuleBook,
    /// For each element, whether it does something when hit hard enough: a mere touch of it is then no hit.
    pub acts: Vec<bool>,
    /// For each target of the scene, the element that it is.
    pub targets: Vec<u16>,
    /// For each light, the element that it is.
    pub lights: Vec<u16>,
}

impl Table {
    /// Reads and checks a table. `file` is only for error messages.
    ///
    /// # Errors
    /// The first thing that is wrong with it: where, and what would be right.
    pub fn parse(file: &str, source: &str) -> Result<Self, TableError> {
        check::parse(file, source).map_err(TableError::readable)
    }

    /// The same table run by another motion model or at another rate. Its digest then says so: it is another world.
    ///
    /// # Errors
    /// If the rate is not 1 to 1,000,000 ticks a second.
    pub fn run_with(&self, motion: Option<Motion>, tick_hz: Option<u32>) -> Result<Self, String> {
        let mut table = self.clone();
        let scene = Arc::make_mut(&mut table.scene);
        if let Some(motion) = motion {
            scene.motion = motion;
        }
        if let Some(tick_hz) = tick_hz {
            if !(1..=1_000_000).contains(&tick_hz) {
                return Err(format!("{tick_hz} ticks a second are not within 1 to 1000000; 1000 would be right"));
            }
            scene.tick_seconds = 1.0 / f64::from(tick_hz);
            scene.cabinet = self.file.cabinet.map(|cabinet| shapes::cabinet_spec(&cabinet, scene.tick_seconds));
        }
        if *scene != *self.scene {
            table.digest = digest_of(&(self.digest, scene.motion, scene.tick_seconds));
        }
        Ok(table)
    }

    /// The table with the motion model and the tick rate that give the accuracy it asks for, in the place of that: as fields of
    /// its text, and so in its digest. Whoever gets the text does not ask again, since another machine would choose otherwise.
    /// A table that asks for none is left as it is.
    ///
    /// # Errors
    /// If the rate is not 1 to 1,000,000 ticks a second.
    pub fn resolved(&self, motion: Motion, tick_hz: u32) -> Result<Self, TableError> {
        let range = self.accuracy.and_then(|_| locate::field_range(&self.source, "accuracy"));
        let Some(range) = range else { return Ok(self.clone()) };
        let mut source = self.source.clone();
        source.replace_range(range, &format!("motion: {motion:?}, tick_hz: {tick_hz}"));
        Self::parse(&self.name, &source)
    }

    /// A table that comes with the game; `None` if there is none of that name.
    ///
    /// # Errors
    /// None, as long as the tests of this crate pass.
    pub fn shipped(name: &str) -> Option<Result<Self, TableError>> {
        let shipped = SHIPPED.iter().find(|shipped| shipped.name == name)?;
        Some(Self::parse(&format!("{name}.ron"), shipped.source))
    }
}
