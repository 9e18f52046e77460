//! Static shapes, and the boxes that a ball must enter before it can touch them.

use glam::DVec2;

use super::ball::Flight;
use super::constants::{BOUNDS_MARGIN, BOUNDS_ROUNDING, JOINT_GAP};
use crate::math::tangent;

/// A straight piece of surface without its ends, which are points of their own.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct Segment {
    /// First end.
    pub a: DVec2,
    /// Second end.
    pub b: DVec2,
    /// Unit vector from the first end to the second.
    pub along: DVec2,
    /// Unit normal: to the left when looking from the first end to the second.
    pub normal: DVec2,
    /// Metres.
    pub length: f64,
    /// Halfway between the ends: where distances are measured from, so that neither end is preferred and the same segment
    /// from its other end has the same bits.
    pub middle: DVec2,
    /// Stops only balls that come from where `normal` does not point; others pass.
    pub one_way: bool,
}

impl Segment {
    /// The segment from `a` to `b`, which must differ.
    pub fn new(a: DVec2, b: DVec2) -> Self {
        let length = (b - a).length();
        let along = (b - a) / length;
        Self { a, b, along, normal: -tangent(along), length, middle: (a + b) * 0.5, one_way: false }
    }

    /// Distance of a point from the line, m: positive on the side where `normal` points.
    pub fn height(&self, point: DVec2) -> f64 {
        self.normal.dot(point - self.middle)
    }

    /// Whether the surface goes on smoothly from one of the segment's ends into `arc`: its end's point, or a circle
    /// that it is tangent to there. A ball that lies on the segment does not run into that.
    pub fn continues_into(&self, arc: &Arc) -> bool {
        let slack = JOINT_GAP * self.length;
        [self.a, self.b].iter().any(|&end| {
            let offset = end - arc.center;
            (offset.length() - arc.radius).abs() <= slack && offset.dot(self.along).abs() <= slack
        })
    }
}

/// Which face of an arc.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub enum Side {
    /// A ball outside meets it; a point is such an arc of radius 0.
    Outside,
    /// A ball inside meets it.
    Inside,
}

/// One face of a circular arc, without its ends.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct Arc {
    /// Of the circle.
    pub center: DVec2,
    /// Of the circle; 0 for a point.
    pub radius: f64,
    /// Which face.
    pub side: Side,
    /// Direction of its middle and cosine of half its sweep; `None` for a whole circle.
    pub span: Option<(DVec2, f64)>,
}

impl Arc {
    /// Whether the direction from the centre to `offset` lies within the span.
    pub fn spans(&self, offset: DVec2) -> bool {
        match self.span {
            None => true,
            Some((middle, cosine)) => offset.dot(middle) >= offset.length() * cosine,
        }
    }

    /// Whether `other` is a point of this circle: an end of the arc, which a ball that follows it does not run into.
    pub fn has_point(&self, other: &Self) -> bool {
        other.radius == 0.0 && ((other.center - self.center).length() - self.radius).abs() <= JOINT_GAP * self.radius
    }

    /// Distance from the centre at which a ball of `ball_radius` touches this face.
    pub fn reach(&self, ball_radius: f64) -> f64 {
        match self.side {
            Side::Outside => self.radius + ball_radius,
            Side::Inside => self.radius - ball_radius,
        }
    }

    /// 1 outside, -1 inside: the sign of (distance from the centre - reach) for a ball that is clear of it.
    pub fn sign(&self) -> f64 {
        match self.side {
            Side::Outside => 1.0,
            Side::Inside => -1.0,
        }
    }
}

/// A static shape.
#[derive(Debug, Clone, Copy, PartialEq)]
pub enum Shape {
    /// Straight.
    Segment(Segment),
    /// Round.
    Arc(Arc),
}

impl Shape {
    /// Unit normal at the point nearest to a ball with its centre at `position`, towards the ball. A ball right in the
    /// centre of a circle gets +y.
    pub fn normal_at(&self, position: DVec2) -> DVec2 {
        match self {
            Self::Segment(segment) => {
                if segment.one_way || segment.height(position) < 0.0 {
                    -segment.normal
                } else {
                    segment.normal
                }
            }
            Self::Arc(arc) => (position - arc.center).try_normalize().unwrap_or(DVec2::Y) * arc.sign(),
        }
    }

    /// Distance from the nearest point of the shape to `position`, ends included.
    pub fn distance(&self, position: DVec2) -> f64 {
        match self {
            Self::Segment(segment) => {
                let offset = position - segment.a;
                let along = segment.along.dot(offset).clamp(0.0, segment.length);
                (offset - segment.along * along).length()
            }
            Self::Arc(arc) => {
                let offset = position - arc.center;
                if arc.spans(offset) { (offset.length() - arc.radius).abs() } else { f64::INFINITY }
            }
        }
    }

    /// Box around the positions at which a ball's centre touches the shape, and a little more than any rounding.
    pub fn bounds(&self, ball_radius: f64) -> Bounds {
        let reach = match self {
            Self::Segment(segment) => segment.a.abs().max_element() + segment.length,
            Self::Arc(arc) => arc.center.abs().max_element() + arc.radius,
        };
        let margin = ball_radius * (1.0 + BOUNDS_MARGIN) + BOUNDS_ROUNDING * reach;
        match self {
            Self::Segment(segment) => {
                Bounds { low: segment.a.min(segment.b), high: segment.a.max(segment.b) }.grown(margin)
            }
            Self::Arc(arc) => Bounds { low: arc.center, high: arc.center }.grown(arc.radius + margin),
        }
    }
}

/// An axis-aligned box.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct Bounds {
    /// Smallest coordinates.
    pub low: DVec2,
    /// Largest coordinates.
    pub high: DVec2,
}

impl Bounds {
    /// The box, larger by `margin` on every side.
    pub fn grown(self, margin: f64) -> Self {
        Self { low: self.low - DVec2::splat(margin), high: self.high + DVec2::splat(margin) }
    }

    /// The box around both.
    pub fn joined(self, other: Self) -> Self {
        Self { low: self.low.min(other.low), high: self.high.max(other.high) }
    }

    /// Width and height.
    pub fn size(&self) -> DVec2 {
        self.high - self.low
    }

    /// The longer side.
    pub fn extent(&self) -> f64 {
        self.size().max_element()
    }

    /// Whether two boxes share a point.
    pub fn meets(&self, other: &Self) -> bool {
        self.low.x <= other.high.x
            && other.low.x <= self.high.x
            && self.low.y <= other.high.y
            && other.low.y <= self.high.y
    }

    /// Whether the point lies in it.
    pub fn contains(&self, point: DVec2) -> bool {
        self.holds(&Self { low: point, high: point })
    }

    /// Whether the other box lies in it. One with NaN in it does not.
    pub fn holds(&self, other: &Self) -> bool {
        self.low.x <= other.low.x
            && other.high.x <= self.high.x
            && self.low.y <= other.low.y
            && other.high.y <= self.high.y
    }

    /// The box around a flight from `from` to `to` seconds after its start.
    pub fn of_flight(flight: &Flight, from: f64, to: f64) -> Self {
        let (a, b) = (flight.position_at(from), flight.position_at(to));
        let mut bounds = Self { low: a.min(b), high: a.max(b) };
        // The turning point of each coordinate, if it lies within.
        let turn = |velocity: f64, acceleration: f64| {
            if acceleration == 0.0 {
                return None;
            }
            let t = -velocity / acceleration;
            (t > from && t < to).then(|| flight.position_at(t))
        };
        if let Some(p) = turn(flight.velocity.x, flight.acceleration.x) {
            bounds.low.x = bounds.low.x.min(p.x);
            bounds.high.x = bounds.high.x.max(p.x);
        }
        if let Some(p) = turn(flight.velocity.y, flight.acceleration.y) {
            bounds.low.y = bounds.low.y.min(p.y);
            bounds.high.y = bounds.high.y.max(p.y);
        }
        bounds
    }
}
