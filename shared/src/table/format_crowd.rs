//! The written form of what the crowd may do against the player: a part of [`super::format`].

use serde::{Deserialize, Serialize};

use super::format_rules::ActionFile;

/// The crowd: who watches may work against who plays.
#[derive(Debug, Clone, PartialEq, Serialize, Deserialize)]
#[serde(deny_unknown_fields)]
pub struct CrowdFile {
    /// How fast its energy grows while a ball is in play, 1/s.
    pub energy_per_second: f64,
    /// Its energy never grows beyond this.
    pub most_energy: f64,
    /// What it gets for each ball that a player loses.
    #[serde(default)]
    pub points_per_ball: u64,
    /// What it may do.
    pub actions: Vec<CrowdActionFile>,
}

/// One thing that the crowd may do.
#[derive(Debug, Clone, PartialEq, Serialize, Deserialize)]
#[serde(deny_unknown_fields)]
pub struct CrowdActionFile {
    /// What voters and players read.
    pub name: String,
    /// Energy that it takes.
    pub cost: f64,
    /// Seconds for which the player is warned before it acts.
    pub announce: f64,
    /// Seconds from then until it is undone; left out: it is done at once, and stays done.
    #[serde(default)]
    pub lasts: f64,
    /// Seconds after that until it can be had again.
    #[serde(default)]
    pub cool_down: f64,
    /// What the crowd gets when it acts.
    #[serde(default)]
    pub points: u64,
    /// Whether the lights are dimmed while it lasts.
    #[serde(default)]
    pub dims: bool,
    /// What is done when it acts ...
    #[serde(default)]
    pub run: Vec<ActionFile>,
    /// ... and when it is over.
    #[serde(default)]
    pub undo: Vec<ActionFile>,
}
