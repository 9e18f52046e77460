//! The written form of a table: what a RON file says, before anything is checked. `check` turns it into a [`Table`].
//!
//! Lengths in metres, angles in degrees clockwise from +y (up the table), so that a left-hand and a right-hand
//! element of the same angle are exact mirror images. See `shared/tables/README.md` for a description by example.
//!
//! [`Table`]: super::Table

use std::collections::BTreeMap;

use serde::{Deserialize, Serialize};

use super::accuracy::Accuracy;
pub use super::format_crowd::{CrowdActionFile, CrowdFile};
pub use super::format_mechanisms::{EdgeFile, GateFile, MagnetFile, SaucerFile, SpinnerFile};
pub use super::format_rules::{ActionFile, BallSaveFile, ConditionFile, EventFile, RuleFile, RulesFile};
use super::unique;
use crate::physics::motion::Motion;

/// A point or vector as written: `(x, y)` in metres, x right and y up the table.
pub type Point = (f64, f64);

/// A whole table file.
#[derive(Debug, Clone, PartialEq, Serialize, Deserialize)]
#[serde(deny_unknown_fields, rename = "Table")]
pub struct TableFile {
    /// Version of this format; see [`super::FORMAT_VERSION`].
    pub format: u32,
    /// Version of the physics that the table was made for; see [`crate::physics::PHYSICS_VERSION`].
    pub physics: u32,
    /// Shown to players.
    pub name: String,
    /// Width and height of the playfield.
    pub size: Point,
    /// Asked for instead of a motion model and a tick rate.
    #[serde(default)]
    pub accuracy: Option<Accuracy>,
    /// World ticks a second.
    #[serde(default = "default_tick_hz")]
    pub tick_hz: u32,
    /// How the next impact of a ball is found.
    #[serde(default)]
    pub motion: Motion,
    /// The pixel model's step, m.
    #[serde(default = "default_pixel")]
    pub pixel: f64,
    /// Acceleration of a ball that rolls on the playfield, m/s^2.
    pub gravity: Point,
    /// The same on the floors above the playfield, from floor 1 on: a ramp is steeper. Left out: as on the playfield.
    #[serde(default)]
    pub floors: Vec<Point>,
    /// How the table moves when it is nudged. Left out: not at all.
    #[serde(default)]
    pub cabinet: Option<CabinetFile>,
    /// Normal speed after an impact below which the ball stays in contact, m/s.
    pub rest_speed: f64,
    /// The ball, and where one is served.
    pub ball: BallFile,
    /// Surfaces by name.
    #[serde(deserialize_with = "unique::map")]
    pub materials: BTreeMap<String, MaterialFile>,
    /// Everything on the playfield.
    pub elements: Vec<ElementFile>,
    /// Named sets of elements that rules speak of as one.
    #[serde(default, deserialize_with = "unique::map")]
    pub groups: BTreeMap<String, Vec<String>>,
    /// What happens when.
    pub rules: RulesFile,
}

pub(super) fn default_tick_hz() -> u32 {
    1000
}

pub(super) fn default_pixel() -> f64 {
    0.001
}

fn whole() -> f64 {
    1.0
}

/// The ball.
#[derive(Debug, Clone, Copy, PartialEq, Serialize, Deserialize)]
#[serde(deny_unknown_fields)]
pub struct BallFile {
    /// Metres.
    pub radius: f64,
    /// Kilograms.
    pub mass: f64,
    /// Where a ball is served, at rest.
    pub start: Point,
}

/// A cabinet on its legs, and the plumb bob in it. The defaults are those of a real machine.
#[derive(Debug, Clone, Copy, PartialEq, Serialize, Deserialize)]
#[serde(deny_unknown_fields, default)]
pub struct CabinetFile {
    /// Speed that a nudge gives the table, m/s.
    pub nudge: f64,
    /// At which the table swings along x and along y, Hz.
    pub frequency: Point,
    /// Shares of critical damping of that.
    pub damping: Point,
    /// Length of the plumb bob, m.
    pub bob_length: f64,
    /// Share of critical damping of its swing.
    pub bob_damping: f64,
    /// Angle at which it touches its ring, degrees.
    pub tilt: f64,
    /// How often it may touch during one ball before the game tilts.
    pub warnings: u8,
}

impl Default for CabinetFile {
    fn default() -> Self {
        Self {
            nudge: 0.06,
            frequency: (9.3, 5.8),
            damping: (0.052, 0.055),
            bob_length: 0.1,
            bob_damping: 0.05,
            tilt: 1.0,
            warnings: 2,
        }
    }
}

/// A surface.
#[derive(Debug, Clone, Copy, PartialEq, Serialize, Deserialize)]
#[serde(deny_unknown_fields)]
pub struct MaterialFile {
    /// Share of the normal speed that an impact returns at vanishing speed.
    pub restitution: f64,
    /// The restitution falls with normal speed v: e / (1 + falloff v). Seconds per metre.
    #[serde(default)]
    pub falloff: f64,
    /// Coulomb coefficient.
    #[serde(default)]
    pub friction: f64,
    /// Share of the tangential speed that an impact leaves, apart from friction.
    #[serde(default = "whole")]
    pub tangential: f64,
}

/// Which side of the table a flipper belongs to.
#[derive(Debug, Clone, Copy, PartialEq, Eq, Hash, Serialize, Deserialize)]
pub enum Hand {
    /// Pivot at the left, tip to the right.
    Left,
    /// The mirror image.
    Right,
}

/// Colour of an insert. The client owns the exact shades.
#[derive(Debug, Clone, Copy, PartialEq, Eq, Serialize, Deserialize)]
pub enum LightColor {
    /// Warm yellow.
    Amber,
    /// Signal red.
    Red,
    /// Ice blue.
    Blue,
    /// Mint green.
    Green,
    /// White.
    White,
}

/// One thing on the playfield.
#[derive(Debug, Clone, PartialEq, Serialize, Deserialize)]
pub enum ElementFile {
    /// A polyline that stops a ball from both sides. First point = last point closes it into an island.
    Wall(WallFile),
    /// A curved wall.
    Arc(ArcFile),
    /// A round post.
    Post(PostFile),
    /// A round wall around a ball that is inside.
    Ring(PostFile),
    /// A line at which a ball drops, or climbs, to another floor.
    Hole(HoleFile),
    /// A line between two floors: the edge of a ramp, which a ball crosses either way.
    Edge(EdgeFile),
    /// A coil under the playfield that pulls balls towards it.
    Magnet(MagnetFile),
    /// A wall that a ball passes from one side only, untouched.
    OneWay(OneWayFile),
    /// A round kicker.
    Bumper(BumperFile),
    /// A straight kicker.
    Slingshot(SlingshotFile),
    /// A target that falls when hit and is raised again by a rule.
    DropTarget(TargetFile),
    /// A target that stands and notices when it is hit.
    Target(TargetFile),
    /// A plate on a hinge that a ball pushes through; it turns on.
    Spinner(SpinnerFile),
    /// A plate on a hinge that a ball pushes open; it falls shut behind it.
    Gate(GateFile),
    /// A hole that holds a ball until it is kicked out.
    Saucer(SaucerFile),
    /// A line that notices a ball passing.
    Rollover(LineFile),
    /// The line below which a ball is lost.
    Drain(LineFile),
    /// A bat driven by a coil.
    Flipper(FlipperFile),
    /// The spring that launches a ball.
    Plunger(PlungerFile),
    /// An insert that rules switch on and off.
    Light(LightFile),
}

/// See [`ElementFile::Wall`].
#[derive(Debug, Clone, PartialEq, Serialize, Deserialize)]
#[serde(deny_unknown_fields)]
pub struct WallFile {
    /// Unique in the table.
    pub name: String,
    /// A key of `materials`.
    pub material: String,
    /// Two or more.
    pub points: Vec<Point>,
    /// The floor that it stands on; 0 is the playfield.
    #[serde(default)]
    pub floor: u8,
}

/// See [`ElementFile::Hole`].
#[derive(Debug, Clone, PartialEq, Serialize, Deserialize)]
#[serde(deny_unknown_fields)]
pub struct HoleFile {
    /// Unique in the table.
    pub name: String,
    /// First end.
    pub from: Point,
    /// Second end.
    pub to: Point,
    /// The floor that it is on.
    #[serde(default)]
    pub floor: u8,
    /// The floor that it leads to.
    pub leads_to: u8,
}

/// See [`ElementFile::Arc`].
#[derive(Debug, Clone, PartialEq, Serialize, Deserialize)]
#[serde(deny_unknown_fields)]
pub struct ArcFile {
    /// Unique in the table.
    pub name: String,
    /// A key of `materials`.
    pub material: String,
    /// Of the circle.
    pub center: Point,
    /// Of the circle.
    pub radius: f64,
    /// First end, degrees clockwise from +y.
    pub from: f64,
    /// Second end, clockwise of the first, at most 360 further.
    pub to: f64,
    /// The floor that it stands on; 0 is the playfield.
    #[serde(default)]
    pub floor: u8,
}

/// See [`ElementFile::Post`] and [`ElementFile::Ring`].
#[derive(Debug, Clone, PartialEq, Serialize, Deserialize)]
#[serde(deny_unknown_fields)]
pub struct PostFile {
    /// Unique in the table.
    pub name: String,
    /// A key of `materials`.
    pub material: String,
    /// Centre.
    pub center: Point,
    /// Metres.
    pub radius: f64,
    /// The floor that it stands on; 0 is the playfield.
    #[serde(default)]
    pub floor: u8,
}

/// See [`ElementFile::OneWay`].
#[derive(Debug, Clone, PartialEq, Serialize, Deserialize)]
#[serde(deny_unknown_fields)]
pub struct OneWayFile {
    /// Unique in the table.
    pub name: String,
    /// A key of `materials`.
    pub material: String,
    /// First end.
    pub from: Point,
    /// Second end. Looking from the first to the second, a ball passes from left to right and is stopped from the right.
    pub to: Point,
    /// The floor that it stands on; 0 is the playfield.
    #[serde(default)]
    pub floor: u8,
}

/// See [`ElementFile::Bumper`].
#[derive(Debug, Clone, PartialEq, Serialize, Deserialize)]
#[serde(deny_unknown_fields)]
pub struct BumperFile {
    /// Unique in the table.
    pub name: String,
    /// A key of `materials`.
    pub material: String,
    /// Centre.
    pub center: Point,
    /// Metres.
    pub radius: f64,
    /// Normal speed that a kick adds, m/s.
    pub kick: f64,
    /// Normal speed of approach above which it kicks, m/s.
    pub threshold: f64,
    /// The floor that it stands on; 0 is the playfield.
    #[serde(default)]
    pub floor: u8,
}

/// See [`ElementFile::Slingshot`].
#[derive(Debug, Clone, PartialEq, Serialize, Deserialize)]
#[serde(deny_unknown_fields)]
pub struct SlingshotFile {
    /// Unique in the table.
    pub name: String,
    /// A key of `materials`.
    pub material: String,
    /// First end of the rubber.
    pub from: Point,
    /// Second end.
    pub to: Point,
    /// Normal speed that a kick adds, m/s.
    pub kick: f64,
    /// Normal speed of approach above which it kicks, m/s.
    pub threshold: f64,
    /// The floor that it stands on; 0 is the playfield.
    #[serde(default)]
    pub floor: u8,
}

/// See [`ElementFile::DropTarget`] and [`ElementFile::Target`].
#[derive(Debug, Clone, PartialEq, Serialize, Deserialize)]
#[serde(deny_unknown_fields)]
pub struct TargetFile {
    /// Unique in the table.
    pub name: String,
    /// A key of `materials`.
    pub material: String,
    /// First end of the face.
    pub from: Point,
    /// Second end.
    pub to: Point,
    /// Normal speed of approach from which on it falls, or notices the hit, m/s.
    pub threshold: f64,
    /// A drop target that is down until it is raised.
    #[serde(default)]
    pub down: bool,
    /// The floor that it stands on; 0 is the playfield.
    #[serde(default)]
    pub floor: u8,
}

/// See [`ElementFile::Rollover`] and [`ElementFile::Drain`].
#[derive(Debug, Clone, PartialEq, Serialize, Deserialize)]
#[serde(deny_unknown_fields)]
pub struct LineFile {
    /// Unique in the table.
    pub name: String,
    /// First end.
    pub from: Point,
    /// Second end.
    pub to: Point,
    /// The floor that it stands on; 0 is the playfield.
    #[serde(default)]
    pub floor: u8,
}

/// See [`ElementFile::Flipper`].
#[derive(Debug, Clone, PartialEq, Serialize, Deserialize)]
#[serde(deny_unknown_fields)]
pub struct FlipperFile {
    /// Unique in the table.
    pub name: String,
    /// A key of `materials`.
    pub material: String,
    /// Which button drives it, and which way it points.
    pub hand: Hand,
    /// Axis of rotation.
    pub pivot: Point,
    /// From the pivot to the centre of the tip.
    pub length: f64,
    /// Radius at the pivot.
    pub base_radius: f64,
    /// Radius at the tip.
    pub tip_radius: f64,
    /// Angle from +y towards the flipper's own side at rest, degrees.
    pub rest: f64,
    /// The same at the end of the stroke; smaller than `rest`.
    pub raised: f64,
    /// About the pivot, kg m^2.
    pub inertia: f64,
    /// Of the coil at full strength, N m.
    pub torque: f64,
    /// Seconds that the coil takes to full strength.
    pub ramp: f64,
    /// Share of the torque that holds the flipper near the end of its stroke.
    pub hold: f64,
    /// How near, degrees.
    pub hold_within: f64,
    /// Share of the torque with which the spring pulls it back.
    pub return_share: f64,
    /// Share of its speed that a flipper keeps when it bounces off an end stop.
    pub stop_restitution: f64,
}

/// See [`ElementFile::Plunger`].
#[derive(Debug, Clone, PartialEq, Serialize, Deserialize)]
#[serde(deny_unknown_fields)]
pub struct PlungerFile {
    /// Unique in the table.
    pub name: String,
    /// A key of `materials`.
    pub material: String,
    /// Left end of the head's face when nothing pulls it.
    pub from: Point,
    /// Right end.
    pub to: Point,
    /// How far it can be pulled, metres.
    pub stroke: f64,
    /// Of rod and head, kg.
    pub mass: f64,
    /// Force at full pull, N; it grows linearly with the pull, so the energy is bounded.
    pub force: f64,
    /// How fast a hand moves it, m/s.
    pub hand_speed: f64,
}

/// See [`ElementFile::Light`].
#[derive(Debug, Clone, PartialEq, Serialize, Deserialize)]
#[serde(deny_unknown_fields)]
pub struct LightFile {
    /// Unique in the table.
    pub name: String,
    /// Centre of the insert.
    pub center: Point,
    /// Metres.
    pub radius: f64,
    /// When lit.
    pub color: LightColor,
}

impl ElementFile {
    /// The element's name.
    pub fn name(&self) -> &str {
        match self {
            Self::Wall(e) => &e.name,
            Self::Arc(e) => &e.name,
            Self::Post(e) | Self::Ring(e) => &e.name,
            Self::Hole(e) => &e.name,
            Self::Edge(e) => &e.name,
            Self::Magnet(e) => &e.name,
            Self::OneWay(e) => &e.name,
            Self::Bumper(e) => &e.name,
            Self::Slingshot(e) => &e.name,
            Self::DropTarget(e) | Self::Target(e) => &e.name,
            Self::Spinner(e) => &e.name,
            Self::Gate(e) => &e.name,
            Self::Saucer(e) => &e.name,
            Self::Rollover(e) | Self::Drain(e) => &e.name,
            Self::Flipper(e) => &e.name,
            Self::Plunger(e) => &e.name,
            Self::Light(e) => &e.name,
        }
    }
}
