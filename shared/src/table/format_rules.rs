//! The written form of a table's rules: what happens when.

use serde::{Deserialize, Serialize};

use super::format_crowd::CrowdFile;

/// The rules: what happens when.
#[derive(Debug, Clone, PartialEq, Serialize, Deserialize)]
#[serde(deny_unknown_fields)]
pub struct RulesFile {
    /// Balls a player has in a game.
    pub balls: u32,
    /// The multiplier never grows beyond this.
    pub max_multiplier: u32,
    /// In order: every rule whose event happened runs its actions.
    pub on: Vec<RuleFile>,
    /// What who watches may do against who plays. Left out: nothing.
    #[serde(default)]
    pub crowd: Option<CrowdFile>,
}

/// One rule.
#[derive(Debug, Clone, PartialEq, Eq, Serialize, Deserialize)]
#[serde(deny_unknown_fields)]
pub struct RuleFile {
    /// When this happens ...
    pub event: EventFile,
    /// ... do these, in order.
    pub run: Vec<ActionFile>,
}

/// What a rule waits for. Names are of an element or of a group (then any of its members).
#[derive(Debug, Clone, PartialEq, Eq, Serialize, Deserialize)]
pub enum EventFile {
    /// A bumper or slingshot kicked, a drop target fell, a target was hit, a post, wall or plate was touched.
    Hit(String),
    /// A ball passed a rollover, or went through a gate or a spinner.
    Pass(String),
    /// A spinner turned half round.
    Spin(String),
    /// A saucer caught a ball.
    Hold(String),
    /// The last saucer of a group caught a ball: all of them hold one.
    AllHeld(String),
    /// The last light of a group was lit.
    AllLit(String),
    /// The last drop target of a group fell.
    AllDown(String),
    /// A ball was served.
    BallStart,
    /// The last ball was lost.
    BallEnd,
}

/// What a rule does.
#[derive(Debug, Clone, PartialEq, Eq, Serialize, Deserialize)]
pub enum ActionFile {
    /// Points.
    Score(u64),
    /// Points that are counted at the end of the ball, times the multiplier.
    Bonus(u64),
    /// One step up, to `max_multiplier` at the most.
    RaiseMultiplier,
    /// Pays the bonus times the multiplier, and sets both back.
    CollectBonus,
    /// A light, or a group of them, on.
    Light(String),
    /// A light, or a group of them, off.
    Unlight(String),
    /// A drop target, or a group of them, up again.
    Raise(String),
    /// A drop target, or a group of them, down.
    Lower(String),
    /// A saucer, or a group of them, throws out the ball that it holds.
    Kick(String),
    /// A magnet, or a group of them, on.
    Attract(String),
    /// A magnet, or a group of them, off.
    Release(String),
    /// Another ball is put into play where balls are served, as soon as no ball is there.
    Serve,
    /// A line on the display.
    Message(String),
}
