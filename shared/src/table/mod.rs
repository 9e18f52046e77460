//! Tables: the written form ([`format`](mod@format)) becomes a checked [`Table`], with errors that name file, line,
//! element and field. After the check no function asks again.

mod check;
mod error;
pub mod format;
pub(crate) mod locate;
mod rulebook;
mod shapes;
#[cfg(test)]
mod tests;
mod unique;

use std::sync::Arc;

use glam::DVec2;

pub(crate) use check::{is_printable, unprintable};
pub use error::TableError;
pub use format::{ElementFile, TableFile};
pub use rulebook::{Command, Rule, RuleBook, Trigger};

use crate::physics::scene::Scene;

/// Version of the written form.
pub const FORMAT_VERSION: u32 = 1;

/// The largest table text that is read, bytes. A table from the network is held to it as well.
pub const MOST_TEXT: usize = 256 * 1024;

/// The tables that come with the game: name and text.
pub const SHIPPED: &[(&str, &str)] = &[("classic", include_str!("../../tables/classic.ron"))];

/// A table that has passed every check.
#[derive(Debug, Clone, PartialEq)]
pub struct Table {
    /// Shown to players.
    pub name: String,
    /// The text that it was read from: what a server sends to whoever joins.
    pub source: String,
    /// Digest of that text.
    pub digest: u64,
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
        check::parse(file, source)
    }

    /// A table that comes with the game; `None` if there is none of that name.
    ///
    /// # Errors
    /// None, as long as the tests of this crate pass.
    pub fn shipped(name: &str) -> Option<Result<Self, TableError>> {
        let (name, source) = SHIPPED.iter().find(|(known, _)| *known == name)?;
        Some(Self::parse(&format!("{name}.ron"), source))
    }
}
