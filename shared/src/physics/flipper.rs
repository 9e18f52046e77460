//! Flippers: bodies that a coil turns against a spring, between two end stops.

use glam::DVec2;
use serde::{Deserialize, Serialize};

use super::constants::FLIPPER_STOP_SPEED;
use super::numbers::Numbers;
use super::scene::Material;
use super::shapes::{Arc, Segment, Shape, Side};
use crate::math::{direction, tangent};

/// What is fixed about a flipper.
#[derive(Debug, Clone, PartialEq)]
pub struct FlipperSpec {
    /// The table's element.
    pub element: u16,
    /// Which button drives it: `false` left, `true` right. Also which way it points.
    pub right: bool,
    /// Axis, m.
    pub pivot: DVec2,
    /// From the pivot to the centre of the tip, m.
    pub length: f64,
    /// Radius at the pivot, m.
    pub base_radius: f64,
    /// Radius at the tip, m.
    pub tip_radius: f64,
    /// Angle from +y towards the own side at rest, radians.
    pub rest: f64,
    /// Angle by which it is raised at the end of its stroke, radians.
    pub stroke: f64,
    /// About the pivot, kg m^2.
    pub inertia: f64,
    /// Of the coil at full strength, N m.
    pub torque: f64,
    /// Seconds that the coil takes to full strength.
    pub ramp: f64,
    /// Share of the torque near the end of the stroke.
    pub hold: f64,
    /// How near, radians.
    pub hold_within: f64,
    /// Share of the torque with which the spring pulls back.
    pub return_share: f64,
    /// Share of its speed that it keeps at an end stop.
    pub stop_restitution: f64,
    /// Its rubber.
    pub material: Material,
}

/// Where a flipper is in its stroke.
#[derive(Debug, Clone, Copy, PartialEq, Eq, Serialize, Deserialize)]
pub enum FlipperRest {
    /// At the resting stop.
    AtRest,
    /// At the end of its stroke.
    Raised,
    /// Between the stops.
    Moving,
}

/// What changes about a flipper.
#[derive(Debug, Clone, Copy, PartialEq, Serialize, Deserialize)]
#[serde(from = "FlipperForm", into = "FlipperForm")]
pub struct FlipperState {
    /// Where in its stroke.
    pub rest: FlipperRest,
    /// Angle above the resting stop, radians.
    pub swing: f64,
    /// Its rate, rad/s.
    pub speed: f64,
    /// Whether the button is held.
    pub pressed: bool,
    /// Seconds since it was pressed.
    pub coil_time: f64,
}

impl Default for FlipperState {
    fn default() -> Self {
        Self { rest: FlipperRest::AtRest, swing: 0.0, speed: 0.0, pressed: false, coil_time: 0.0 }
    }
}

/// As it is written.
#[derive(Serialize, Deserialize)]
struct FlipperForm(FlipperRest, bool, Numbers<3>);

impl From<FlipperState> for FlipperForm {
    fn from(FlipperState { rest, swing, speed, pressed, coil_time }: FlipperState) -> Self {
        Self(rest, pressed, Numbers([coil_time, speed, swing]))
    }
}

impl From<FlipperForm> for FlipperState {
    fn from(FlipperForm(rest, pressed, Numbers([coil_time, speed, swing])): FlipperForm) -> Self {
        Self { rest, swing, speed, pressed, coil_time }
    }
}

/// A flipper's motion within a tick: constant angular acceleration from some moment of it on.
#[derive(Debug, Clone, Copy)]
pub struct FlipperMotion {
    /// Offset within the tick from which this holds, seconds.
    pub from: f64,
    /// Swing then, radians.
    pub swing: f64,
    /// Speed then, rad/s.
    pub speed: f64,
    /// Throughout, rad/s^2.
    pub acceleration: f64,
}

impl FlipperMotion {
    /// Swing at an offset within the tick.
    pub fn swing_at(&self, offset: f64) -> f64 {
        let t = offset - self.from;
        self.swing + (self.speed + 0.5 * self.acceleration * t) * t
    }

    /// Speed at an offset within the tick.
    pub fn speed_at(&self, offset: f64) -> f64 {
        self.speed + self.acceleration * (offset - self.from)
    }
}

/// How a flipper carries a ball that lies on it.
#[derive(Debug, Clone, Copy)]
pub struct Carried {
    /// Unit normal towards the ball.
    pub normal: DVec2,
    /// Lever arm of a push along the normal, in the sense of the swing, m.
    pub lever: f64,
    /// Of the ball along the normal at a constant speed of the swing, m/s^2: centripetal and Coriolis.
    pub acceleration: f64,
}

/// The surface of a flipper nearest to a point.
#[derive(Debug, Clone, Copy)]
pub struct Nearest {
    /// From the point to the surface, m; negative inside.
    pub distance: f64,
    /// Unit normal towards the point.
    pub normal: DVec2,
    /// Of the surface there, m; infinite where it is flat.
    pub radius: f64,
}

impl FlipperSpec {
    /// From the pivot to the tip, at that swing.
    pub fn direction(&self, swing: f64) -> DVec2 {
        let angle = self.rest - swing;
        direction(if self.right { -angle } else { angle })
    }

    /// Rate of turn, counter-clockwise, of a flipper whose swing grows by `speed`.
    pub fn turn_rate(&self, speed: f64) -> f64 {
        if self.right { -speed } else { speed }
    }

    /// Farthest point of the flipper from its pivot.
    pub fn reach(&self) -> f64 {
        self.length + self.tip_radius + self.base_radius
    }

    /// Torque of coil or spring in the direction of the swing, averaged over a tick of `dt` seconds in which the swing
    /// becomes `until`, N m.
    pub fn drive(&self, state: &FlipperState, until: f64, dt: f64) -> f64 {
        if !state.pressed {
            return -self.return_share * self.torque;
        }
        let strength = if self.ramp > 0.0 { ((state.coil_time + 0.5 * dt) / self.ramp).min(1.0) } else { 1.0 };
        let edge = self.stroke - self.hold_within;
        let held = match (state.swing >= edge, until > edge) {
            (true, _) => 1.0,
            (false, true) => (until - edge) / (until - state.swing),
            (false, false) => 0.0,
        };
        self.torque * strength * (1.0 - held * (1.0 - self.hold))
    }

    /// The motion from `offset` on, for `span` seconds, of a flipper that carries nothing: with the acceleration that it has in the
    /// middle of it.
    pub fn free_motion(&self, state: &FlipperState, offset: f64, span: f64) -> FlipperMotion {
        let FlipperState { swing, speed, .. } = *state;
        let state = FlipperState { coil_time: state.coil_time + offset, ..*state };
        let acceleration = self.drive(&state, swing, span) / self.inertia;
        let guess = FlipperMotion { from: offset, swing, speed, acceleration };
        let drive = self.drive(&state, guess.swing_at(offset + span), span);
        FlipperMotion { acceleration: drive / self.inertia, ..guess }
    }

    /// Sine and cosine of the angle by which the faces' normals lean towards the tip: asin((base - tip) / length).
    fn lean(&self) -> (f64, f64) {
        let lean = (self.base_radius - self.tip_radius) / self.length;
        (lean, (1.0 - lean * lean).sqrt())
    }

    /// The surface nearest to `point` when the flipper points along `axis`: two circles and their common tangents.
    pub fn nearest(&self, axis: DVec2, point: DVec2) -> Nearest {
        let offset = point - self.pivot;
        let along = offset.dot(axis);
        let across = axis.perp_dot(offset);
        let side = if across < 0.0 { -1.0 } else { 1.0 };
        let (lean, upright) = self.lean();
        let place = along * upright - across.abs() * lean;
        if place <= 0.0 {
            round(offset, self.base_radius)
        } else if place >= self.length * upright {
            round(offset - axis * self.length, self.tip_radius)
        } else {
            let normal = axis * lean + axis.perp() * (upright * side);
            Nearest { distance: offset.dot(normal) - self.base_radius, normal, radius: f64::INFINITY }
        }
    }

    /// The same flipper as static shapes, for when it lies at a stop.
    pub fn shapes(&self, swing: f64) -> [Shape; 4] {
        let axis = self.direction(swing);
        let (lean, upright) = self.lean();
        let tip = self.pivot + axis * self.length;
        let face = |side: f64| {
            let normal = axis * lean + axis.perp() * (upright * side);
            Shape::Segment(Segment::new(self.pivot + normal * self.base_radius, tip + normal * self.tip_radius))
        };
        let circle = |center, radius| Shape::Arc(Arc { center, radius, side: Side::Outside, span: None });
        [face(1.0), face(-1.0), circle(tip, self.tip_radius), circle(self.pivot, self.base_radius)]
    }

    /// How a ball of `radius` with its centre there is carried along.
    pub fn carried(&self, swing: f64, speed: f64, center: DVec2, velocity: DVec2, radius: f64) -> Carried {
        let Nearest { normal, radius: curved, .. } = self.nearest(self.direction(swing), center);
        let (turn, arm) = (self.turn_rate(speed), center - self.pivot);
        let along = tangent(normal);
        // Of the ball's centre, seen from the flipper.
        let drift = (velocity - arm.perp() * turn).dot(along);
        let acceleration = (along.perp() * (2.0 * turn * drift) - arm * (turn * turn)).dot(normal);
        Carried {
            normal,
            lever: self.turn_rate(arm.perp_dot(normal)),
            acceleration: acceleration - drift * drift / (curved + radius),
        }
    }

    /// Seconds for which a ball of `radius` that rolls along the flipper follows one parabola: until it has turned by `angle`
    /// around one of the ends, or comes to the end of a straight face.
    pub fn rolls_for(&self, swing: f64, speed: f64, center: DVec2, velocity: DVec2, radius: f64, angle: f64) -> f64 {
        let axis = self.direction(swing);
        let Nearest { normal, radius: curved, .. } = self.nearest(axis, center);
        let along = tangent(normal);
        let drift = (velocity - self.surface_velocity(speed, center)).dot(along);
        if curved.is_finite() {
            return angle * (curved + radius) / drift.abs();
        }
        let (lean, upright) = self.lean();
        let offset = center - self.pivot;
        let place = offset.dot(axis) * upright - axis.perp_dot(offset).abs() * lean;
        // Outwards is where the tip is.
        let outwards = drift * along.dot(axis) > 0.0;
        let left = if outwards { self.length * upright - place } else { place };
        left / drift.abs()
    }

    /// Velocity of the point of the flipper at `point`.
    pub fn surface_velocity(&self, speed: f64, point: DVec2) -> DVec2 {
        (point - self.pivot).perp() * self.turn_rate(speed)
    }

    /// Swing and speed of a flipper that met a stop: it bounces, or stays if it is slow.
    pub fn at_stop(&self, raised: bool, speed: f64) -> (f64, f64, FlipperRest) {
        let swing = if raised { self.stroke } else { 0.0 };
        let rebound = -self.stop_restitution * speed;
        if rebound.abs() < FLIPPER_STOP_SPEED {
            (swing, 0.0, if raised { FlipperRest::Raised } else { FlipperRest::AtRest })
        } else {
            (swing, rebound, FlipperRest::Moving)
        }
    }
}

fn round(offset: DVec2, radius: f64) -> Nearest {
    let distance = offset.length();
    let normal = if distance > 0.0 { offset / distance } else { DVec2::Y };
    Nearest { distance: distance - radius, normal, radius }
}
