//! The ball: its flight, its spin and what it lies on.

use glam::DVec2;
use serde::{Deserialize, Serialize};

use super::scene::{Collider, Scene};

/// A moment of world time: a tick and the seconds since its start.
#[derive(Debug, Clone, Copy, PartialEq, Serialize, Deserialize)]
pub struct Instant {
    /// Ticks since the world began.
    pub tick: u64,
    /// Seconds since the start of that tick, from 0 to a tick's length.
    pub offset: f64,
}

impl Instant {
    /// The start of a tick.
    pub fn start_of(tick: u64) -> Self {
        Self { tick, offset: 0.0 }
    }

    /// The instant `seconds` later, which must not be negative.
    pub fn later_by(self, seconds: f64, tick_seconds: f64) -> Self {
        let offset = self.offset + seconds;
        // A cast saturates.
        let ticks = (offset / tick_seconds) as u64;
        let offset = offset - ticks as f64 * tick_seconds;
        Self { tick: self.tick.saturating_add(ticks), offset: if offset > 0.0 { offset } else { 0.0 } }
    }

    /// Seconds from `earlier` to this instant, at `tick_seconds` a tick.
    pub fn since(self, earlier: Self, tick_seconds: f64) -> f64 {
        let ticks = if self.tick >= earlier.tick {
            (self.tick - earlier.tick) as f64
        } else {
            -((earlier.tick - self.tick) as f64)
        };
        ticks * tick_seconds + (self.offset - earlier.offset)
    }
}

/// A parabola: the motion of a ball from one change of its motion to the next. A ball's position at any time is a view
/// of this; it is never sampled and restarted, because that would change bits.
#[derive(Debug, Clone, Copy, PartialEq, Serialize, Deserialize)]
pub struct Flight {
    /// When it began.
    pub start: Instant,
    /// Centre of the ball then, metres.
    pub position: DVec2,
    /// Velocity then, m/s.
    pub velocity: DVec2,
    /// Acceleration throughout, m/s^2.
    pub acceleration: DVec2,
}

impl Flight {
    /// Centre of the ball `t` seconds after the start.
    pub fn position_at(&self, t: f64) -> DVec2 {
        self.position + (self.velocity + self.acceleration * (0.5 * t)) * t
    }

    /// Velocity `t` seconds after the start.
    pub fn velocity_at(&self, t: f64) -> DVec2 {
        self.velocity + self.acceleration * t
    }

    /// Whether every number in it is finite.
    pub fn is_finite(&self) -> bool {
        self.start.offset.is_finite()
            && self.position.is_finite()
            && self.velocity.is_finite()
            && self.acceleration.is_finite()
    }
}

/// What a ball lies on, rolls along or is pushed by. Its flight's acceleration already accounts for it.
#[derive(Debug, Clone, Copy, PartialEq, Eq, Serialize, Deserialize)]
pub enum Support {
    /// Nothing: it flies.
    None,
    /// A straight surface, by its collider: the flight runs along it.
    Line(u16),
    /// A round surface, by its collider: the flight follows it for one tick at a time.
    Arc(u16),
    /// Nothing, but it met more surfaces within this tick than are worth following: it goes on with the next one.
    Stalled,
    /// Two surfaces between which it lies still.
    Wedge(u16, u16),
    /// A moving flipper, by its place in the scene: the flight follows it for one tick at a time.
    Flipper(u16),
    /// A moving plunger, likewise.
    Plunger(u16),
    /// It lies in a saucer, by its place in the scene, since the start of its flight.
    Held(u16),
    /// The same, and is thrown out with the next tick.
    Released(u16),
}

/// How a ball slides along what it lies on: its rim slips, and friction works on it.
#[derive(Debug, Clone, Copy, PartialEq, Serialize, Deserialize)]
pub struct Slide {
    /// Seconds after the start of its flight at which it grips and rolls; `None`: not before something else happens.
    pub until: Option<f64>,
    /// Rate at which friction changes its spin, rad/s^2.
    pub spin_rate: f64,
}

/// A ball in play.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct Ball {
    /// Given in order, from 0; not used again before 2^32 others.
    pub id: u32,
    /// Its size and mass, by their place among the scene's kinds of ball.
    pub kind: u8,
    /// The floor that it is on; 0 is the playfield.
    pub floor: u8,
    /// Where it is and how it moves.
    pub flight: Flight,
    /// About the playfield's normal at the start of its flight, rad/s, counter-clockwise.
    pub spin: f64,
    /// What it lies on.
    pub support: Support,
    /// How it slides on that; `None` if it rolls, or flies.
    pub slide: Option<Slide>,
    /// Events of this flight up to this time (seconds since its start) and collider are past.
    pub past: Option<(f64, u16)>,
}

impl Ball {
    /// The static surface that it lies on.
    pub(super) fn support_collider<'a>(&self, scene: &'a Scene) -> Option<&'a Collider> {
        match self.support {
            Support::Line(i) | Support::Arc(i) => scene.colliders.get(usize::from(i)),
            _ => None,
        }
    }

    /// The saucer that it lies in, by its place in the scene.
    pub fn saucer(&self) -> Option<u16> {
        match self.support {
            Support::Held(index) | Support::Released(index) => Some(index),
            _ => None,
        }
    }

    /// Centre and velocity at `instant`.
    pub fn at(&self, instant: Instant, tick_seconds: f64) -> (DVec2, DVec2) {
        let t = instant.since(self.flight.start, tick_seconds);
        (self.flight.position_at(t), self.flight.velocity_at(t))
    }
}
