//! The scene: what the physics needs to know of a table, checked and resolved to plain geometry.

use glam::DVec2;

use super::constants::ROLLING_SHARE;
use super::flipper::FlipperSpec;
use super::plunger::PlungerSpec;
use super::shapes::{Bounds, Shape};

/// A surface.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct Material {
    /// Share of the normal speed returned at vanishing speed.
    pub restitution: f64,
    /// Restitution at normal speed v is `restitution / (1 + falloff v)`; s/m.
    pub falloff: f64,
    /// Coulomb coefficient.
    pub friction: f64,
}

impl Material {
    /// Share of a pull along the surface that accelerates a ball on it: some goes into spin where there is friction.
    pub fn rolling_share(&self) -> f64 {
        if self.friction > 0.0 { ROLLING_SHARE } else { 1.0 }
    }

    /// Share of the normal speed returned at a normal speed of approach of `speed` m/s.
    pub fn restitution_at(&self, speed: f64) -> f64 {
        self.restitution / (1.0 + self.falloff * speed)
    }
}

/// What a collider does to a ball that meets it.
#[derive(Debug, Clone, Copy, PartialEq)]
pub enum Role {
    /// Stops it.
    Solid,
    /// Stops it and, above `threshold` m/s of approach, adds `speed` m/s along the normal.
    Kicker {
        /// Added, m/s.
        speed: f64,
        /// Of approach, m/s.
        threshold: f64,
    },
    /// Stops it and falls when hit at `threshold` m/s or faster.
    Target {
        /// Place among the scene's targets.
        index: u16,
        /// Of approach, m/s.
        threshold: f64,
    },
    /// Notices its centre passing.
    Sensor,
    /// Takes it out of play.
    Drain,
}

/// When a collider is there.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub enum Presence {
    /// Always.
    Always,
    /// While that target stands.
    TargetUp(u16),
    /// While that flipper lies at its resting stop.
    FlipperAtRest(u16),
    /// While that flipper lies at the end of its stroke.
    FlipperRaised(u16),
    /// While that plunger's head is at home.
    PlungerHome(u16),
}

/// A shape with all that an impact needs to know.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct Collider {
    /// Geometry.
    pub shape: Shape,
    /// What a ball's centre must enter before it can touch the shape.
    pub bounds: Bounds,
    /// Surface.
    pub material: Material,
    /// The table's element that it belongs to.
    pub element: u16,
    /// What it does.
    pub role: Role,
    /// When it is there.
    pub presence: Presence,
}

/// Everything that is fixed while a world runs.
#[derive(Debug, Clone, PartialEq)]
pub struct Scene {
    /// Length of a tick.
    pub tick_seconds: f64,
    /// Acceleration of a free ball, m/s^2.
    pub gravity: DVec2,
    /// Normal speed after an impact below which a ball stays in contact, m/s.
    pub rest_speed: f64,
    /// Radius of every ball, m.
    pub ball_radius: f64,
    /// Mass of every ball, kg.
    pub ball_mass: f64,
    /// Width and height of the playfield, m. A ball that leaves it by more than its radius has escaped.
    pub size: DVec2,
    /// Static shapes. Ties between simultaneous events go to the lowest index.
    pub colliders: Vec<Collider>,
    /// Flippers.
    pub flippers: Vec<FlipperSpec>,
    /// Plungers.
    pub plungers: Vec<PlungerSpec>,
    /// How many targets can fall.
    pub targets: u16,
}

impl Scene {
    /// Whether a ball's centre is on the table, or beside it by its radius at the most.
    pub fn is_inside(&self, position: DVec2) -> bool {
        Bounds { low: DVec2::ZERO, high: self.size }.grown(self.ball_radius).contains(position)
    }
}
