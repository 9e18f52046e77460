//! A world as lines and points, for whoever draws what the physics sees: shapes with their normals here, the paths of
//! balls in [`track`], what each ball meets next in [`foresight`]. Plain data in the scene's coordinates, metres; nothing
//! in here acts on a world, and no colour or pixel is known.

pub mod foresight;
#[cfg(test)]
mod tests;
pub mod track;

use core::f64::consts::{PI, TAU};

use glam::DVec2;

use crate::math::direction;
use crate::physics::World;
use crate::physics::ball::Support;
use crate::physics::flipper::FlipperRest;
use crate::physics::scene::Role;
use crate::physics::shapes::{Arc, Segment, Shape, Side};

/// How far a line that stands for a curve may be off it, in radii of the largest ball.
const SLACK: f64 = 0.01;
/// Fewest and most pieces of a whole circle.
const PIECES: (f64, f64) = (24.0, 720.0);
/// From one normal to the next along an arc, in radii of the largest ball.
const NORMAL_EVERY: f64 = 6.0;
/// Fewest normals of a whole circle, and most.
const NORMALS: (f64, f64) = (6.0, 24.0);

/// What an outline belongs to, in the words of a ball's [`Support`].
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub enum Part {
    /// That collider of the scene.
    Collider(u16),
    /// That flipper, on its way between its stops.
    Flipper(u16),
    /// That plunger, away from home.
    Plunger(u16),
    /// That saucer.
    Saucer(u16),
}

impl Part {
    /// Whether a ball with that support lies on it.
    pub fn supports(self, support: Support) -> bool {
        match (self, support) {
            (Self::Collider(part), Support::Line(on) | Support::Arc(on)) => part == on,
            (Self::Collider(part), Support::Wedge(one, other)) => part == one || part == other,
            (Self::Flipper(part), Support::Flipper(on)) | (Self::Plunger(part), Support::Plunger(on)) => part == on,
            (Self::Saucer(part), Support::Held(on) | Support::Released(on)) => part == on,
            _ => false,
        }
    }
}

/// What a ball does that comes to an outline.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub enum Kind {
    /// It bounces.
    Solid,
    /// It bounces from one side and passes from the other.
    OneWay,
    /// It passes, and is noticed, moved or lost: sensors, holes, drains.
    Passed,
}

/// A shape that is there now.
#[derive(Debug, Clone, PartialEq)]
pub struct Outline {
    /// What it belongs to.
    pub part: Part,
    /// The table's element that this is a part of.
    pub element: u16,
    /// The floor that it stands on.
    pub floor: u8,
    /// What it does to a ball.
    pub kind: Kind,
    /// A line through these, m; a single one is a point.
    pub points: Vec<DVec2>,
    /// Towards the side from which a ball meets it; none where balls pass, or come from everywhere.
    pub normals: Vec<Normal>,
}

/// A normal of a surface.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct Normal {
    /// Its foot on the surface, m.
    pub at: DVec2,
    /// Unit vector.
    pub towards: DVec2,
}

/// Everything that a ball can meet or pass now: one outline for each collider that is there, in the scene's order, then
/// what moves.
pub fn outlines(world: &World) -> Vec<Outline> {
    let (scene, state) = (world.scene(), world.state());
    let radius = scene.largest_radius();
    let mut outlines = Vec::with_capacity(scene.colliders.len());
    for (index, collider) in (0..).zip(&scene.colliders) {
        if !state.has(collider) {
            continue;
        }
        let kind = match &collider.shape {
            _ if collider.role.is_passed() => Kind::Passed,
            Shape::Segment(segment) if segment.one_way => Kind::OneWay,
            _ => Kind::Solid,
        };
        let part = match collider.role {
            Role::Saucer { index } => Part::Saucer(index),
            _ => Part::Collider(index),
        };
        outlines.push(outline(part, collider.element, collider.floor, kind, &collider.shape, radius));
    }
    for (index, (spec, flipper)) in (0..).zip(scene.flippers.iter().zip(&state.flippers)) {
        if flipper.rest == FlipperRest::Moving {
            let shapes = spec.shapes(flipper.swing);
            let part = Part::Flipper(index);
            outlines.extend(shapes.iter().map(|shape| outline(part, spec.element, 0, Kind::Solid, shape, radius)));
        }
    }
    for (index, (spec, plunger)) in (0..).zip(scene.plungers.iter().zip(&state.plungers)) {
        if !plunger.home {
            let from = spec.from - spec.normal * plunger.pull;
            let to = from + spec.along * spec.width;
            let normals = vec![Normal { at: (from + to) * 0.5, towards: spec.normal }];
            let (part, points) = (Part::Plunger(index), vec![from, to]);
            outlines.push(Outline { part, element: spec.element, floor: 0, kind: Kind::Solid, points, normals });
        }
    }
    outlines
}

/// The elements that a ball with that support lies on: none, one or two.
pub fn support_elements(world: &World, support: Support) -> Vec<u16> {
    let scene = world.scene();
    let of_collider = |index: u16| scene.colliders.get(usize::from(index)).map(|collider| collider.element);
    let found = match support {
        Support::None | Support::Stalled => [None, None],
        Support::Line(on) | Support::Arc(on) => [of_collider(on), None],
        Support::Wedge(one, other) => [of_collider(one), of_collider(other)],
        Support::Flipper(on) => [scene.flippers.get(usize::from(on)).map(|spec| spec.element), None],
        Support::Held(on) | Support::Released(on) => {
            [scene.saucers.get(usize::from(on)).map(|spec| spec.element), None]
        }
        Support::Plunger(on) => [scene.plungers.get(usize::from(on)).map(|spec| spec.element), None],
    };
    let mut elements: Vec<u16> = found.into_iter().flatten().collect();
    elements.dedup();
    elements
}

/// The outline of a shape; `radius` is the largest ball's.
fn outline(part: Part, element: u16, floor: u8, kind: Kind, shape: &Shape, radius: f64) -> Outline {
    let (points, mut normals) = match shape {
        Shape::Segment(segment) => (vec![segment.a, segment.b], normals_of_segment(segment)),
        Shape::Arc(arc) => arc_lines(arc, radius),
    };
    if kind == Kind::Passed {
        normals.clear();
    }
    Outline { part, element, floor, kind, points, normals }
}

fn normals_of_segment(segment: &Segment) -> Vec<Normal> {
    let normal = |towards| Normal { at: segment.middle, towards };
    if segment.one_way { vec![normal(-segment.normal)] } else { vec![normal(segment.normal), normal(-segment.normal)] }
}

/// Points and normals of an arc: equal pieces from end to end.
fn arc_lines(arc: &Arc, radius: f64) -> (Vec<DVec2>, Vec<Normal>) {
    // A point, or something as small as one; all sides of it are alike.
    if arc.radius <= 0.0 {
        return (vec![arc.center], Vec::new());
    }
    let (middle, half) = match arc.span {
        Some((middle, cosine)) => (middle, libm::acos(cosine.clamp(-1.0, 1.0))),
        None => (DVec2::Y, PI),
    };
    // The arrow of a chord of angle a on a circle of radius r is r a^2 / 8.
    let whole = (TAU / (8.0 * SLACK * radius / arc.radius).sqrt()).clamp(PIECES.0, PIECES.1);
    let pieces = (whole * half / PI).ceil().max(1.0);
    let towards = |turn: f64| {
        let turned = direction(turn);
        middle * turned.y - middle.perp() * turned.x
    };
    let place = |step: f64, steps: f64| towards(half * (2.0 * step / steps - 1.0));
    let points = (0..=pieces as u32).map(|step| arc.center + place(f64::from(step), pieces) * arc.radius).collect();
    let sign = if arc.side == Side::Outside { 1.0 } else { -1.0 };
    let whole = (TAU * arc.radius / (NORMAL_EVERY * radius)).clamp(NORMALS.0, NORMALS.1);
    let count = (whole * half / PI).floor().max(1.0);
    let normals = (0..count as u32).map(|step| {
        let outwards = place(f64::from(step) + 0.5, count);
        Normal { at: arc.center + outwards * arc.radius, towards: outwards * sign }
    });
    (points, normals.collect())
}
