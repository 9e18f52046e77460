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
    /// Extra balls that a player can get in a game.
    #[serde(default)]
    pub max_extra_balls: u8,
    /// How long after the launch a lost ball is put into play again. Left out: never.
    #[serde(default)]
    pub ball_save: Option<BallSaveFile>,
    /// In order: every rule whose event happened runs its actions.
    pub on: Vec<RuleFile>,
    /// What who watches may do against who plays. Left out: nothing.
    #[serde(default)]
    pub crowd: Option<CrowdFile>,
}

/// For how long after the launch of a turn's ball a lost one is put into play again.
#[derive(Debug, Clone, PartialEq, Serialize, Deserialize)]
#[serde(deny_unknown_fields)]
pub struct BallSaveFile {
    /// Seconds of play.
    pub lasts: f64,
    /// How many balls are saved in that time.
    #[serde(default = "one")]
    pub saves: u8,
    /// Seconds for which balls are saved after its light has gone out.
    #[serde(default)]
    pub grace: f64,
    /// The light, or the group of them, that tells of it.
    #[serde(default)]
    pub light: Option<String>,
}

fn one() -> u8 {
    1
}

/// One rule.
#[derive(Debug, Clone, PartialEq, Serialize, Deserialize)]
#[serde(deny_unknown_fields)]
pub struct RuleFile {
    /// When this happens ...
    pub event: EventFile,
    /// ... and all of this is so when it has happened, before any rule has acted on it (at `Out` the light is out; at `Hold` the
    /// ball is held, and counts as in play only if the saucer lets go by itself) ...
    #[serde(default)]
    pub when: Vec<ConditionFile>,
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
    /// Of several balls in play only one is left.
    MultiballEnd,
    /// A light that was lit for a time went out by itself.
    Out(String),
}

/// What must be so for a rule to run. Names are of an element or of a group.
#[derive(Debug, Clone, PartialEq, Eq, Serialize, Deserialize)]
pub enum ConditionFile {
    /// All of these lights are lit.
    Lit(String),
    /// One of these lights is lit, or more.
    AnyLit(String),
    /// None of these lights is lit.
    Unlit(String),
    /// All of these drop targets are down.
    Down(String),
    /// All of these drop targets stand.
    Up(String),
    /// One ball is in play, those that are locked not counted.
    OneBall,
    /// Two are, or more.
    Multiball,
}

/// What a rule does.
#[derive(Debug, Clone, PartialEq, Serialize, Deserialize)]
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
    /// A light, or a group of them, on for so many seconds of play.
    LightFor(String, f64),
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
    /// Every ball that is lost within so many seconds of play is put into play again.
    SaveBalls(f64),
    /// The player plays on with another ball when this one is lost.
    ExtraBall,
    /// A line on the display.
    Message(String),
}
