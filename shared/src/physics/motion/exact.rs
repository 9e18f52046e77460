//! The exact model: a flight is a parabola, so the first root of each gap is the time of impact, to rounding.
//!
//! A flight is searched piece by piece, each about [`SEARCH_LENGTH`] of path long, as far as the world needs. The
//! pieces depend on the flight alone, so a search gives the same bits whenever and wherever it is repeated.

use super::super::ball::{Ball, Flight, Support};
use super::super::constants::{MOST_SEARCHES_PER_TICK, SEARCH_LENGTH};
use super::super::impact::{Search, TimeOfImpact, ball_shape, center_passes, leaves_segment};
use super::super::scene::{Collider, Role, Scene};
use super::super::shapes::{Bounds, Shape, Side};

/// What a flight meets next. Times are seconds since its start.
#[derive(Debug, Clone, Copy, PartialEq)]
pub enum Next {
    /// Nothing before that time; beyond it, ask again.
    ClearUntil(f64),
    /// An impact with that collider, or for a sensor its passing.
    Meets(f64, u16),
    /// The ball reaches the end of the straight surface that it lies on.
    LeavesSupport(f64),
}

impl Next {
    /// When.
    pub fn time(self) -> f64 {
        match self {
            Self::ClearUntil(t) | Self::Meets(t, _) | Self::LeavesSupport(t) => t,
        }
    }
}

/// Seconds of flight that one piece covers: a time in which neither the speed nor the acceleration carries the ball
/// farther than half the search length; a sixteenth of a tick at the least, so that no speed makes a tick endless.
fn piece(flight: &Flight, scene: &Scene) -> f64 {
    let half = 0.5 * SEARCH_LENGTH * scene.size.y;
    let by_speed = half / flight.velocity.length();
    let by_pull = (2.0 * half / flight.acceleration.length()).sqrt();
    let piece = if by_speed < by_pull { by_speed } else { by_pull };
    let least = scene.tick_seconds / MOST_SEARCHES_PER_TICK;
    if piece < least { least } else { piece }
}

/// The next event of `ball` among the colliders that are `present`, at `now` seconds since its flight's start or
/// later, searched to the end of the piece that contains `until`.
pub fn next_event(scene: &Scene, ball: &Ball, present: impl Fn(&Collider) -> bool, now: f64, until: f64) -> Next {
    let flight = &ball.flight;
    let piece = piece(flight, scene);
    if !piece.is_finite() {
        // At rest: pieces would be endless, and nothing comes to it that is not its own event.
        return match immediate(scene, ball, &present) {
            Some(next) => next,
            None => Next::ClearUntil(f64::INFINITY),
        };
    }
    let mut number = (now / piece).floor().max(0.0);
    loop {
        let (from, to) = (number * piece, (number + 1.0) * piece);
        if let Some(next) = first_within(scene, ball, &present, from, to) {
            return next;
        }
        if to > until {
            return Next::ClearUntil(to);
        }
        number += 1.0;
    }
}

/// A ball at rest can still touch something that was not there before.
fn immediate(scene: &Scene, ball: &Ball, present: &impl Fn(&Collider) -> bool) -> Option<Next> {
    first_within(scene, ball, present, 0.0, f64::MIN_POSITIVE)
}

fn first_within(scene: &Scene, ball: &Ball, present: &impl Fn(&Collider) -> bool, from: f64, to: f64) -> Option<Next> {
    let flight = &ball.flight;
    let (past, past_index) = ball.past.unwrap_or((f64::NEG_INFINITY, 0));
    let path = Bounds::of_flight(flight, from, to);
    let mut limit = to;
    let mut first = None;
    for (index, collider) in scene.colliders.iter().enumerate() {
        let index = index as u16;
        if !path.meets(&collider.bounds) || !present(collider) || is_part_of_support(scene, ball.support, index) {
            continue;
        }
        let search = Search { from, to, before: limit, after: past, strictly: index <= past_index };
        let outcome = match collider.role {
            Role::Sensor | Role::Drain => center_passes(flight, &collider.shape, &search),
            _ => ball_shape(flight, scene.ball_radius, &collider.shape, &search),
        };
        // `before` excludes later and equal times, so the lowest index wins a tie.
        match outcome {
            TimeOfImpact::Separated => {}
            TimeOfImpact::Impact(t) => (limit, first) = (t, Some(Next::Meets(t, index))),
            TimeOfImpact::Overlapping => (limit, first) = (0.0, Some(Next::Meets(0.0, index))),
        }
    }
    if let Support::Line(index) = ball.support
        && let Shape::Segment(segment) = &scene.colliders[usize::from(index)].shape
    {
        let search = Search { from, to, before: limit, after: f64::NEG_INFINITY, strictly: false };
        if let TimeOfImpact::Impact(t) = leaves_segment(flight, segment, &search) {
            first = Some(Next::LeavesSupport(t));
        }
    }
    first
}

/// Whether a collider is what the ball lies on, or the smooth end of it.
fn is_part_of_support(scene: &Scene, support: Support, collider: u16) -> bool {
    let shape = |i: u16| &scene.colliders[usize::from(i)].shape;
    match support {
        Support::Line(line) => {
            line == collider
                || matches!((shape(line), shape(collider)), (Shape::Segment(s), Shape::Arc(a)) if s.continues_into(a))
        }
        Support::Arc(arc) => {
            arc == collider
                || match (shape(arc), shape(collider)) {
                    (Shape::Arc(arc), Shape::Arc(point)) => arc.has_point(point),
                    // From a hollow the ball is handed over to the straight part when it has passed the arc's end.
                    (Shape::Arc(arc), Shape::Segment(s)) => arc.side == Side::Inside && s.continues_into(arc),
                    _ => false,
                }
        }
        Support::Wedge(a, b) => a == collider || b == collider,
        Support::None | Support::Stalled | Support::Flipper(_) | Support::Plunger(_) => false,
    }
}
