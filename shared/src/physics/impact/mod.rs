//! Time of impact of a ball in flight with a static shape or another ball: one file a shape pair.
//!
//! All times are seconds since the flight's start. A time of impact is a pure function of the flight and the shape: it
//! has the same bits whoever asks, whenever, and whatever else stands on the table. So a restored world finds the
//! impacts of the original, and a broad phase or an element that is never touched changes nothing.

mod ball_arc;
mod ball_ball;
mod ball_segment;
mod near;

pub use ball_ball::ball_ball;
pub(crate) use ball_segment::leaves_segment;

use super::ball::Flight;
use super::constants::{GRAZE, TOUCH};
use super::scene::{Collider, Role};
use super::shapes::Shape;

/// The outcome of a search for an impact.
#[derive(Debug, Clone, Copy, PartialEq)]
pub enum TimeOfImpact {
    /// The surfaces meet, approaching each other, that many seconds after the flight's start.
    Impact(f64),
    /// They touch at the flight's start already, and approach each other.
    Overlapping,
    /// They do not meet within the time searched.
    Separated,
}

impl TimeOfImpact {
    /// Seconds after the flight's start, if they meet.
    pub fn time(self) -> Option<f64> {
        match self {
            Self::Impact(t) => Some(t),
            Self::Overlapping => Some(0.0),
            Self::Separated => None,
        }
    }
}

/// Which impacts are of interest. It selects among the impacts; it does not change their times.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct Search {
    /// Only an impact before this time.
    pub before: f64,
    /// Impacts before this time are past.
    pub after: f64,
    /// The one at `after` itself as well.
    pub strictly: bool,
}

impl Search {
    /// Everything from the start of the flight up to `to`.
    pub fn up_to(to: f64) -> Self {
        Self { before: to, after: 0.0, strictly: false }
    }

    /// The whole flight.
    pub fn whole() -> Self {
        Self::up_to(f64::INFINITY)
    }

    fn accepts(&self, t: f64) -> bool {
        t >= 0.0 && t < self.before && (t > self.after || (t == self.after && !self.strictly))
    }
}

/// The first impact of a ball of `radius` on `flight` with `shape`, within `search`.
pub fn ball_shape(flight: &Flight, radius: f64, shape: &Shape, search: &Search) -> TimeOfImpact {
    match shape {
        Shape::Segment(segment) => ball_segment::first_impact(flight, radius, segment, search),
        Shape::Arc(arc) => ball_arc::first_impact(flight, radius, arc, Rounding::of(flight, radius), search),
    }
}

/// The first time within `search` at which the ball's centre passes a sensor, plate, hole or drain, in either direction, or enters a
/// saucer.
pub fn center_passes(flight: &Flight, collider: &Collider, search: &Search) -> TimeOfImpact {
    match &collider.shape {
        Shape::Segment(segment) => {
            let begins = matches!(collider.role, Role::Hole { .. } | Role::Hinge { .. });
            ball_segment::first_pass(flight, segment, begins, search)
        }
        // A circle is passed where the centre enters it.
        Shape::Arc(arc) => ball_arc::first_impact(flight, 0.0, arc, Rounding::of(flight, 0.0), search),
    }
}

/// The gap below which a ball touches a surface, metres: a few roundings of the coordinates involved.
pub(crate) fn touch_gap(flight: &Flight, radius: f64) -> f64 {
    TOUCH * (flight.position.abs().max_element() + radius)
}

/// What may be only rounding where a ball touches something.
#[derive(Debug, Clone, Copy)]
struct Rounding {
    /// Of a gap, m.
    gap: f64,
    /// The speed whose rounding a rate may be, m/s: of the fastest of what moves.
    speed: f64,
}

impl Rounding {
    /// Of one ball's coordinates and speed.
    fn of(flight: &Flight, radius: f64) -> Self {
        Self { gap: touch_gap(flight, radius), speed: flight.velocity.length() }
    }

    /// Of two balls, seen from each other: that of their own numbers, not of their difference.
    fn of_both(self, other: Self) -> Self {
        let larger = |a: f64, b: f64| if a > b { a } else { b };
        Self { gap: larger(self.gap, other.gap), speed: larger(self.speed, other.speed) }
    }
}

/// `rate` without what is only rounding of `scale`.
fn without_rounding(rate: f64, scale: f64) -> f64 {
    if rate.abs() <= GRAZE * scale { 0.0 } else { rate }
}
