//! The written form of spinners, gates, saucers, ramps' edges and magnets: a part of [`super::format`].

use serde::{Deserialize, Serialize};

use super::format::Point;

/// See [`super::format::ElementFile::Spinner`].
#[derive(Debug, Clone, PartialEq, Serialize, Deserialize)]
#[serde(deny_unknown_fields)]
pub struct SpinnerFile {
    /// Unique in the table.
    pub name: String,
    /// First end.
    pub from: Point,
    /// Second end.
    pub to: Point,
    /// From the hinge down to where a ball pushes the plate, m.
    pub lever: f64,
    /// Of the plate about its hinge, kg m^2.
    pub inertia: f64,
    /// Dry friction: how fast the plate loses its spin, rad/s^2.
    pub friction: f64,
    /// Share of its normal speed at which a ball is thrown back that is too slow to pass.
    pub restitution: f64,
    /// Work that turns the plate over, J: a ball that cannot do it does not pass.
    pub lift: f64,
    /// The floor that it stands on; 0 is the playfield.
    #[serde(default)]
    pub floor: u8,
}

/// See [`super::format::ElementFile::Gate`].
#[derive(Debug, Clone, PartialEq, Serialize, Deserialize)]
#[serde(deny_unknown_fields)]
pub struct GateFile {
    /// Unique in the table.
    pub name: String,
    /// First end.
    pub from: Point,
    /// Second end. Looking from the first to the second, a ball passes a one-way gate from left to right.
    pub to: Point,
    /// From the hinge down to where a ball pushes the plate, m.
    pub lever: f64,
    /// Of the plate about its hinge, kg m^2.
    pub inertia: f64,
    /// Share of its normal speed at which a ball is thrown back that is too slow to pass, or comes from the closed side.
    pub restitution: f64,
    /// Work that opens the plate, J: a ball that cannot do it does not pass.
    pub lift: f64,
    /// Whether it opens to one side only.
    pub one_way: bool,
    /// The floor that it stands on; 0 is the playfield.
    #[serde(default)]
    pub floor: u8,
}

/// See [`super::format::ElementFile::Saucer`].
#[derive(Debug, Clone, PartialEq, Serialize, Deserialize)]
#[serde(deny_unknown_fields)]
pub struct SaucerFile {
    /// Unique in the table.
    pub name: String,
    /// Centre.
    pub center: Point,
    /// A ball whose centre comes within it is caught, m.
    pub radius: f64,
    /// Speed from which on a ball passes over it, m/s.
    pub capture: f64,
    /// Velocity at which it throws a ball out, m/s.
    pub kick: Point,
    /// Seconds for which it holds a ball; left out: until a rule kicks it out.
    #[serde(default)]
    pub hold: Option<f64>,
    /// The floor that it is on; 0 is the playfield.
    #[serde(default)]
    pub floor: u8,
}

/// See [`super::format::ElementFile::Edge`].
#[derive(Debug, Clone, PartialEq, Serialize, Deserialize)]
#[serde(deny_unknown_fields)]
pub struct EdgeFile {
    /// Unique in the table.
    pub name: String,
    /// First end.
    pub from: Point,
    /// Second end.
    pub to: Point,
    /// The two floors that meet there.
    pub floors: (u8, u8),
}

/// See [`super::format::ElementFile::Magnet`].
#[derive(Debug, Clone, PartialEq, Serialize, Deserialize)]
#[serde(deny_unknown_fields)]
pub struct MagnetFile {
    /// Unique in the table.
    pub name: String,
    /// Centre.
    pub center: Point,
    /// How far its field reaches, m.
    pub radius: f64,
    /// Radius of its core, m.
    pub core: f64,
    /// Pull at the rim of the core, m/s^2.
    pub strength: f64,
    /// Rate at which the core brakes a ball, 1/s.
    #[serde(default)]
    pub drag: f64,
    /// Whether it is on when nobody has switched it.
    #[serde(default)]
    pub on: bool,
    /// The floor that it acts on; 0 is the playfield.
    #[serde(default)]
    pub floor: u8,
}
