//! The same scene elsewhere: mirrored, scaled, turned, moved. Whatever has a dimension changes with it, so that the physics
//! must not notice.
//!
//! Masses and times stay. What is measured in m^a then grows by scale^a: a length, a speed, an acceleration by the scale, an
//! inertia and a torque by its square, a falloff of restitution (s/m) by its inverse; a stiffness (N/m) not at all.

use glam::DVec2;

use crate::math::{direction, tangent};
use crate::physics::ball::{Flight, Instant};
use crate::physics::flipper::FlipperSpec;
use crate::physics::hinge::HingeSpec;
use crate::physics::plunger::PlungerSpec;
use crate::physics::scene::{Material, Role, Scene};
use crate::physics::shapes::{Arc, Bounds, Segment, Shape};

/// A mirror image, a scaling, a turn or a shift.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct Similarity {
    /// Where the unit vectors along x and y go; unit vectors themselves.
    axes: [DVec2; 2],
    /// Angle of the turn, radians counter-clockwise.
    angle: f64,
    /// Whether left becomes right.
    mirrors: bool,
    scale: f64,
    shift: DVec2,
}

impl Similarity {
    /// Nothing changes.
    pub const NONE: Self =
        Self { axes: [DVec2::X, DVec2::Y], angle: 0.0, mirrors: false, scale: 1.0, shift: DVec2::ZERO };

    /// x becomes -x.
    pub const MIRROR: Self = Self { axes: [DVec2::NEG_X, DVec2::Y], mirrors: true, ..Self::NONE };

    /// Larger by `scale`; by a power of two it rounds nothing.
    pub fn scaling(scale: f64) -> Self {
        Self { scale, ..Self::NONE }
    }

    /// Turned about (0, 0), radians counter-clockwise.
    pub fn turn(angle: f64) -> Self {
        let up = direction(-angle);
        Self { axes: [tangent(up), up], angle, ..Self::NONE }
    }

    /// Moved, m.
    pub fn shift(shift: DVec2) -> Self {
        Self { shift, ..Self::NONE }
    }

    /// Where a point goes.
    pub fn point(&self, point: DVec2) -> DVec2 {
        self.vector(point) + self.shift
    }

    /// What becomes of a way, a velocity or an acceleration.
    pub fn vector(&self, vector: DVec2) -> DVec2 {
        self.unit(vector) * self.scale
    }

    /// What becomes of a direction.
    pub fn unit(&self, unit: DVec2) -> DVec2 {
        self.axes[0] * unit.x + self.axes[1] * unit.y
    }

    /// What becomes of a length, a speed or an acceleration.
    pub fn length(&self, length: f64) -> f64 {
        length * self.scale
    }

    /// What becomes of a spin.
    pub fn spin(&self, spin: f64) -> f64 {
        if self.mirrors { -spin } else { spin }
    }

    /// Which hand's button a flipper now has.
    pub fn right(&self, right: bool) -> bool {
        right != self.mirrors
    }

    /// What becomes of a flight; it begins at the same moment.
    pub fn flight(&self, flight: &Flight) -> Flight {
        let start: Instant = flight.start;
        Flight {
            start,
            position: self.point(flight.position),
            velocity: self.vector(flight.velocity),
            acceleration: self.vector(flight.acceleration),
        }
    }

    /// The scene in which all of it happens.
    pub fn scene(&self, scene: &Scene) -> Scene {
        let mut other = scene.clone();
        other.pixel = self.length(scene.pixel);
        other.gravity = self.vector(scene.gravity);
        for gravity in &mut other.floors {
            *gravity = self.vector(*gravity);
        }
        other.rest_speed = self.length(scene.rest_speed);
        other.ball_material = self.material(&scene.ball_material);
        other.origin = self.point(scene.origin) - self.shift;
        other.bounds = self.bounds(scene.bounds);
        for kind in &mut other.kinds {
            kind.radius = self.length(kind.radius);
        }
        for ball in &mut other.start {
            (ball.position, ball.velocity) = (self.point(ball.position), self.vector(ball.velocity));
        }
        for collider in &mut other.colliders {
            collider.shape = self.shape(&collider.shape);
            collider.material = self.material(&collider.material);
            collider.role = self.role(collider.role);
        }
        for flipper in &mut other.flippers {
            *flipper = self.flipper(flipper);
        }
        for plunger in &mut other.plungers {
            *plunger = self.plunger(plunger);
        }
        for hinge in &mut other.hinges {
            *hinge = self.hinge(hinge);
        }
        for magnet in &mut other.magnets {
            magnet.center = self.point(magnet.center);
            magnet.reach = self.length(magnet.reach);
            magnet.core = self.length(magnet.core);
            magnet.strength = self.length(magnet.strength);
        }
        if let Some(cabinet) = &mut other.cabinet {
            cabinet.speed = self.length(cabinet.speed);
            cabinet.ring = self.length(cabinet.ring);
        }
        for saucer in &mut other.saucers {
            (saucer.center, saucer.kick) = (self.point(saucer.center), self.vector(saucer.kick));
            saucer.capture = self.length(saucer.capture);
        }
        other.built()
    }

    fn shape(&self, shape: &Shape) -> Shape {
        match shape {
            Shape::Segment(segment) => {
                // A one-way wall's ends change places: what is seen on the left must stay on the left.
                let ends =
                    if segment.one_way && self.mirrors { [segment.b, segment.a] } else { [segment.a, segment.b] };
                let [a, b] = ends.map(|end| self.point(end));
                Shape::Segment(Segment { one_way: segment.one_way, ..Segment::new(a, b) })
            }
            Shape::Arc(arc) => Shape::Arc(Arc {
                center: self.point(arc.center),
                radius: self.length(arc.radius),
                side: arc.side,
                span: arc.span.map(|(middle, cosine)| (self.unit(middle), cosine)),
            }),
        }
    }

    fn material(&self, material: &Material) -> Material {
        Material { falloff: material.falloff / self.scale, ..*material }
    }

    fn role(&self, role: Role) -> Role {
        match role {
            Role::Kicker { speed, threshold } => {
                Role::Kicker { speed: self.length(speed), threshold: self.length(threshold) }
            }
            Role::Target { index, threshold } => Role::Target { index, threshold: self.length(threshold) },
            Role::Standing { threshold } => Role::Standing { threshold: self.length(threshold) },
            Role::Hinge { .. } | Role::Saucer { .. } | Role::Field { .. } => role,
            Role::Solid | Role::Sensor | Role::Hole { .. } | Role::Drain => role,
        }
    }

    fn hinge(&self, hinge: &HingeSpec) -> HingeSpec {
        let square = self.scale * self.scale;
        HingeSpec {
            middle: self.point(hinge.middle),
            lever: self.length(hinge.lever),
            inertia: hinge.inertia * square,
            lift: hinge.lift * square,
            ..*hinge
        }
    }

    fn flipper(&self, flipper: &FlipperSpec) -> FlipperSpec {
        let square = self.scale * self.scale;
        // Angles are measured towards a flipper's own side.
        let turned = if flipper.right { self.angle } else { -self.angle };
        FlipperSpec {
            right: self.right(flipper.right),
            pivot: self.point(flipper.pivot),
            length: self.length(flipper.length),
            base_radius: self.length(flipper.base_radius),
            tip_radius: self.length(flipper.tip_radius),
            rest: flipper.rest + turned,
            inertia: flipper.inertia * square,
            torque: flipper.torque * square,
            material: self.material(&flipper.material),
            ..flipper.clone()
        }
    }

    fn plunger(&self, plunger: &PlungerSpec) -> PlungerSpec {
        PlungerSpec {
            from: self.point(plunger.from),
            along: self.unit(plunger.along),
            width: self.length(plunger.width),
            normal: self.unit(plunger.normal),
            stroke: self.length(plunger.stroke),
            hand_speed: self.length(plunger.hand_speed),
            material: self.material(&plunger.material),
            ..plunger.clone()
        }
    }

    /// The box around what becomes of a box.
    fn bounds(&self, bounds: Bounds) -> Bounds {
        let Bounds { low, high } = bounds;
        let corners =
            [low, high, DVec2::new(low.x, high.y), DVec2::new(high.x, low.y)].map(|corner| self.point(corner));
        let around = |corner: DVec2| Bounds { low: corner, high: corner };
        corners.into_iter().map(around).reduce(Bounds::joined).unwrap_or(bounds)
    }
}
