//! Time of impact of a ball in flight with a static shape: one file a shape.
//!
//! All times are seconds since the flight's start. The search is a pure function of the flight and the shape: it gives
//! the same bits whenever it is asked, so that a restored world finds the impacts of the original.

mod ball_arc;
mod ball_segment;

pub(crate) use ball_segment::leaves_segment;

use super::ball::Flight;
use super::constants::{GRAZE, TOUCH};
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

/// The part of a flight that is searched.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct Search {
    /// Roots are isolated from this time on ...
    pub from: f64,
    /// ... to this one. Both depend on the flight alone, or the root's last bits would depend on who asks.
    pub to: f64,
    /// Only an impact before this time is of interest.
    pub before: f64,
    /// Impacts before this time are past.
    pub after: f64,
    /// The one at `after` itself as well.
    pub strictly: bool,
}

impl Search {
    /// Everything from the start of the flight up to `to`.
    pub fn up_to(to: f64) -> Self {
        Self { from: 0.0, to, before: to, after: 0.0, strictly: false }
    }

    fn accepts(&self, t: f64) -> bool {
        t >= self.from && t < self.before && (t > self.after || (t == self.after && !self.strictly))
    }
}

/// The first impact of a ball of `radius` on `flight` with `shape`, within `search`.
pub fn ball_shape(flight: &Flight, radius: f64, shape: &Shape, search: &Search) -> TimeOfImpact {
    match shape {
        Shape::Segment(segment) => ball_segment::first_impact(flight, radius, segment, search),
        Shape::Arc(arc) => ball_arc::first_impact(flight, radius, arc, search),
    }
}

/// The first time within `search` at which the ball's centre passes `shape`, in either direction.
pub fn center_passes(flight: &Flight, shape: &Shape, search: &Search) -> TimeOfImpact {
    match shape {
        Shape::Segment(segment) => ball_segment::first_pass(flight, segment, search),
        Shape::Arc(_) => TimeOfImpact::Separated,
    }
}

/// The gap below which a ball touches a surface, metres: a few roundings of the coordinates involved.
fn touch_gap(flight: &Flight, radius: f64) -> f64 {
    TOUCH * (flight.position.abs().max_element() + radius)
}

/// `rate` without what is only rounding of `scale`.
fn without_rounding(rate: f64, scale: f64) -> f64 {
    if rate.abs() <= GRAZE * scale { 0.0 } else { rate }
}
