//! What a flight meets first: near which shapes it comes, and every root of its distance to those.

use glam::DVec2;
use shared::physics::scene::{Collider, Role, Scene};
use shared::physics::shapes::{Arc, Bounds, Segment, Shape, Side};

use super::super::polynomial::{Refinement, roots};
use super::super::real::{Real, Vector};
use super::{Flight, is_present};

/// What a flight meets.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub(super) enum Candidate {
    /// A static shape.
    Collider(usize),
    /// The scene's edge: it has escaped.
    Edge,
}

/// Pieces of a flight whose boxes say which shapes it may come near.
const PIECES: u32 = 64;
/// Share of the coordinates by which those boxes are larger: far more than the rounding of f64.
const MARGIN: f64 = 1e-9;
/// Roundings of the coordinates within which a ball touches a surface already.
const TOUCH: f64 = 1024.0;
/// The longest flight that is followed, seconds.
const LONGEST: f64 = 1e6;

/// The search for what a flight meets first.
pub(super) struct Search<'a, R> {
    pub(super) scene: &'a Scene,
    pub(super) flight: &'a Flight<R>,
    pub(super) radius: R,
    pub(super) floor: u8,
    /// What it has just met, and touches.
    pub(super) touching: Option<usize>,
    pub(super) standing: &'a [bool],
    pub(super) refinement: Refinement,
    /// Evaluations so far.
    pub(super) steps: u64,
}

impl<R: Real> Search<'_, R> {
    /// Seconds since the flight's start.
    pub(super) fn first(&mut self) -> Option<(R, Candidate)> {
        let edge = self.leaves();
        let leaves = edge.unwrap_or(R::of(LONGEST));
        let mut first = (leaves, Candidate::Edge);
        let mut looked_at = vec![false; self.scene.colliders.len()];
        let length = leaves.to_f64();
        for piece in 0..PIECES {
            let at = |place: u32| length * f64::from(place) / f64::from(PIECES);
            let (from, to) = (at(piece), at(piece + 1));
            if first.0.to_f64() < from {
                break;
            }
            let around = self.around(from, to);
            for (index, collider) in self.scene.colliders.iter().enumerate() {
                if looked_at[index] || !around.meets(&self.reach(collider)) {
                    continue;
                }
                looked_at[index] = true;
                if collider.floor != self.floor || !is_present(collider.presence, self.standing) {
                    continue;
                }
                if let Some(time) = self.meets(index, collider, leaves)
                    && time < first.0
                {
                    first = (time, Candidate::Collider(index));
                }
            }
        }
        (edge.is_some() || first.1 != Candidate::Edge).then_some(first)
    }

    /// When the ball leaves the scene; `None`: not while it is followed.
    fn leaves(&mut self) -> Option<R> {
        let Flight { position, velocity, gravity, .. } = *self.flight;
        let edge = self.scene.edge;
        let mut first: Option<R> = None;
        for (p, v, g, low, high) in [
            (position.x, velocity.x, gravity.x, edge.low.x, edge.high.x),
            (position.y, velocity.y, gravity.y, edge.low.y, edge.high.y),
        ] {
            for bound in [low, high] {
                let c = [p - R::of(bound), v, g * R::of(0.5)];
                for root in roots(&c, R::of(0.0), R::of(LONGEST), Refinement::FULL, &mut self.steps) {
                    if first.is_none_or(|first| root < first) {
                        first = Some(root);
                    }
                }
            }
        }
        first
    }

    /// The box around a piece of the flight.
    fn around(&self, from: f64, to: f64) -> Bounds {
        let (p, v, g) = (self.flight.position.to_f64(), self.flight.velocity.to_f64(), self.flight.gravity.to_f64());
        let at = |t: f64| p + (v + g * (0.5 * t)) * t;
        let (mut low, mut high) = (at(from).min(at(to)), at(from).max(at(to)));
        // A parabola bulges out of the box of its ends by at most an eighth of its acceleration times the time squared.
        let bulge = g.abs() * (0.125 * (to - from) * (to - from));
        let margin = DVec2::splat(MARGIN * (low.abs().max_element() + high.abs().max_element()));
        (low, high) = (low - bulge - margin, high + bulge + margin);
        Bounds { low, high }
    }

    /// The box in which the ball's centre is when it touches the collider.
    fn reach(&self, collider: &Collider) -> Bounds {
        let around = match collider.shape {
            Shape::Segment(Segment { a, b, .. }) => Bounds { low: a.min(b), high: a.max(b) },
            Shape::Arc(Arc { center, radius, .. }) => Bounds { low: center, high: center }.grown(radius),
        };
        around.grown(self.radius.to_f64() * (1.0 + MARGIN))
    }

    /// When the ball meets a collider, before `until`.
    fn meets(&mut self, index: usize, collider: &Collider, until: R) -> Option<R> {
        let touching = self.touching == Some(index);
        match &collider.shape {
            Shape::Segment(segment) if collider.role.is_passed() => self.passes(segment, touching, until),
            Shape::Segment(segment) => self.meets_segment(segment, touching, until),
            // A saucer ends the solution, if only by a ball's rim.
            Shape::Arc(arc) if !matches!(collider.role, Role::Drain | Role::Sensor | Role::Hole { .. }) => {
                self.meets_arc(arc, touching, until)
            }
            Shape::Arc(_) => None,
        }
    }

    /// The first root at which `rising` tells the sign of the slope. A ball that touches already, but for rounding, and
    /// approaches meets the surface at once. `touching`: 0 is a root by knowledge, and past.
    fn first_root(&mut self, c: &[R], rising: Option<bool>, touching: bool, scale: f64, until: R) -> Vec<R> {
        let zero = R::of(0.0);
        let slope = |t: R| c.iter().enumerate().skip(1).rev().fold(zero, |sum, (k, &c)| sum * t + c * R::of(k as f64));
        let fits = |t: R| rising.is_none_or(|rising| (slope(t) > zero) == rising);
        if touching {
            let mut found = roots(&c[1..], zero, until, self.refinement, &mut self.steps);
            found.retain(|&t| t > zero && fits(t));
            return found;
        }
        let mut found = roots(c, zero, until, self.refinement, &mut self.steps);
        found.retain(|&t| fits(t));
        let at_once = c[0].size().to_f64() <= TOUCH * R::ROUNDING * scale && slope(zero) != zero && fits(zero);
        if at_once && rising.is_some() {
            found.insert(0, zero);
        }
        found
    }

    /// The centre passes a line.
    fn passes(&mut self, segment: &Segment, touching: bool, until: R) -> Option<R> {
        let line = Line::<R>::of(segment);
        let c = line.height(self.flight, R::of(0.0));
        let found = self.first_root(&c, None, touching, 0.0, until);
        found.into_iter().find(|&t| line.spans(self.flight.position_after(t)))
    }

    fn meets_segment(&mut self, segment: &Segment, touching: bool, until: R) -> Option<R> {
        let line = Line::of(segment);
        let scale = coordinates(self.flight, self.radius);
        let side = line.side(self.flight.position);
        let mut first: Option<R> = None;
        for (above, radius) in [(true, self.radius), (false, -self.radius)] {
            if above && segment.one_way {
                continue;
            }
            let c = line.height(self.flight, radius);
            let here = touching && (side > R::of(0.0)) == above;
            let found = self.first_root(&c, Some(!above), here, scale, until);
            let meets = found.into_iter().find(|&t| line.spans(self.flight.position_after(t)));
            if let Some(t) = meets
                && first.is_none_or(|first| t < first)
            {
                first = Some(t);
            }
        }
        first
    }

    fn meets_arc(&mut self, arc: &Arc, touching: bool, until: R) -> Option<R> {
        let Flight { position, velocity, gravity, .. } = *self.flight;
        let center = Vector::of(arc.center);
        let outside = arc.side == Side::Outside;
        let reach = if outside { R::of(arc.radius) + self.radius } else { R::of(arc.radius) - self.radius };
        let zero = R::of(0.0);
        if reach < zero {
            return None;
        }
        let (offset, two) = (position - center, R::of(2.0));
        let half = gravity.times(R::of(0.5));
        let c = [
            offset.dot(offset) - reach * reach,
            two * offset.dot(velocity),
            velocity.dot(velocity) + two * offset.dot(half),
            two * velocity.dot(half),
            half.dot(half),
        ];
        let scale = coordinates(self.flight, reach);
        let found = self.first_root(&c, Some(!outside), touching, scale * reach.to_f64(), until);
        found.into_iter().find(|&t| {
            let offset = self.flight.position_after(t) - center;
            match arc.span {
                None => true,
                Some((middle, cosine)) => offset.dot(Vector::of(middle)) >= offset.length() * R::of(cosine),
            }
        })
    }
}

/// The largest coordinate involved, m.
fn coordinates<R: Real>(flight: &Flight<R>, radius: R) -> f64 {
    flight.position.to_f64().abs().max_element() + radius.to_f64().abs()
}

/// A segment with its directions to the last digit.
struct Line<R> {
    a: Vector<R>,
    normal: Vector<R>,
    along: Vector<R>,
    length: R,
}

impl<R: Real> Line<R> {
    fn of(segment: &Segment) -> Self {
        let a = Vector::of(segment.a);
        let offset = Vector::of(segment.b) - a;
        let length = offset.length();
        let along = offset.times(R::of(1.0) / length);
        Self { a, normal: along.turned(), along, length }
    }

    fn side(&self, point: Vector<R>) -> R {
        self.normal.dot(point - self.a)
    }

    fn spans(&self, point: Vector<R>) -> bool {
        let along = self.along.dot(point - self.a);
        along >= R::of(0.0) && along <= self.length
    }

    /// Height of a flight above the line less `radius`, as a polynomial in time.
    fn height(&self, flight: &Flight<R>, radius: R) -> [R; 3] {
        [
            self.side(flight.position) - radius,
            self.normal.dot(flight.velocity),
            self.normal.dot(flight.gravity) * R::of(0.5),
        ]
    }
}

/// The unit normal of a shape towards a ball that touches it.
pub(super) fn normal<R: Real>(shape: &Shape, position: Vector<R>) -> Vector<R> {
    match shape {
        Shape::Segment(segment) => {
            let line = Line::of(segment);
            if segment.one_way || line.side(position) < R::of(0.0) {
                line.normal.times(R::of(-1.0))
            } else {
                line.normal
            }
        }
        Shape::Arc(arc) => {
            let offset = position - Vector::of(arc.center);
            let sign = if arc.side == Side::Outside { 1.0 } else { -1.0 };
            offset.times(R::of(sign) / offset.length())
        }
    }
}

/// When two balls meet, seconds since the scene's start. Both are pulled alike, so that one flies straight as seen from the
/// other. `touching`: they have just met.
pub(super) fn meeting<R: Real>(one: (&Flight<R>, R), two: (&Flight<R>, R), touching: bool) -> Option<R> {
    let (a, b) = (one.0, two.0);
    let start = if a.start > b.start { a.start } else { b.start };
    let (s, t) = (start - a.start, start - b.start);
    let offset = a.position_after(s) - b.position_after(t);
    let velocity = a.velocity_after(s) - b.velocity_after(t);
    let approach = -offset.dot(velocity);
    // Those that have just met part.
    if touching || approach <= R::of(0.0) {
        return None;
    }
    let reach = one.1 + two.1;
    let gap = offset.dot(offset) - reach * reach;
    let speed = velocity.dot(velocity);
    let discriminant = approach * approach - speed * gap;
    if discriminant <= R::of(0.0) {
        return None;
    }
    // The smaller root, without cancellation; at once where they overlap by a rounding.
    let after = gap / (approach + discriminant.root());
    Some(if after > R::of(0.0) { start + after } else { start })
}
