//! The exact model: a flight is a parabola, so the first root of each gap is the time of impact, to rounding.
//!
//! A flight is solved once, to its end: a tick without an event has nothing to do.

use glam::DVec2;

use super::super::ball::{Flight, Support};
use super::super::constants::LONGEST_FLIGHT;
use super::super::impact::{Search, ball_ball, ball_shape, center_passes};
use super::super::scene::Scene;
use super::super::shapes::Bounds;
use super::search::{Found, first_on_path, support_ends};
use super::{MotionModel, Next, Pair, Query, Span};
use crate::math::roots::quadratic;

pub(super) struct Exact;

impl MotionModel for Exact {
    fn next_event(&self, query: &mut Query<'_>) -> Next {
        let (scene, ball) = (query.scene, query.ball);
        let flight = &ball.flight;
        if flight.velocity == DVec2::ZERO && flight.acceleration == DVec2::ZERO {
            // At rest: nothing comes to it that is not its own event.
            return Next::ClearUntil(f64::INFINITY);
        }
        let to = match ball.support {
            Support::None | Support::Stalled | Support::Line(_) | Support::Wedge(..) => f64::INFINITY,
            Support::Held(_) | Support::Released(_) => f64::INFINITY,
            // The flight holds for this tick only.
            Support::Arc(_) | Support::Flipper(_) | Support::Plunger(_) => query.tick.to,
        };
        let past = ball.past.map_or(0.0, |(t, _)| t);
        let span = Span { from: if past > query.tick.from { past } else { query.tick.from }, to };
        let (radius, ends) = (scene.radius(ball.kind), support_ends(scene, ball));
        let is_short = to < f64::INFINITY && span.from < to;
        if is_short
            && let Some(grid) = &scene.grid
            && ends.is_none_or(|ends| ends > to)
            && scene.bounds.contains(flight.position_at(span.from))
            && query.scratch.clearance.is_clear(scene, grid, query.state, ball, span)
        {
            return Next::ClearUntil(to);
        }
        let (found, around) = first_on_path(query, flight, span, ball.past, ends, |_, collider, search| {
            if collider.role.is_passed() {
                center_passes(flight, collider, search)
            } else {
                ball_shape(flight, radius, &collider.shape, search)
            }
        });
        let until = found.time();
        let way = || Bounds::of_flight(flight, span.from, if until < LONGEST_FLIGHT { until } else { span.from });
        let way = around.unwrap_or_else(way);
        if !scene.edge.holds(&way)
            && let Some(t) = leaves(flight, &scene.edge, span.from)
            && t <= until
        {
            return Next::Escapes(t);
        }
        match found {
            Found::ClearUntil(t) => Next::ClearUntil(t),
            Found::Collider(time, collider) => Next::Meets { time, collider, position: flight.position_at(time) },
            Found::EndOfSupport(t) => Next::LeavesSupport(t),
        }
    }

    fn next_meeting(&self, pair: &Pair<'_>) -> Option<f64> {
        let [one, other] = pair.flights;
        ball_ball(one, pair.radii[0], other, pair.radii[1], &Search::whole()).time()
    }

    fn parts(&self, _scene: &Scene, _flight: &Flight, _tick: Span) -> Option<u32> {
        None
    }
}

/// When a flight leaves a box, at `from` or later, seconds since its start.
fn leaves(flight: &Flight, edge: &Bounds, from: f64) -> Option<f64> {
    let place = flight.position_at(from);
    if !edge.contains(place) {
        return Some(from);
    }
    let mut first: Option<f64> = None;
    // How far it is inside of each side, and how that changes.
    for (gap, rate, pull) in [
        (flight.position.x - edge.low.x, flight.velocity.x, flight.acceleration.x),
        (edge.high.x - flight.position.x, -flight.velocity.x, -flight.acceleration.x),
        (flight.position.y - edge.low.y, flight.velocity.y, flight.acceleration.y),
        (edge.high.y - flight.position.y, -flight.velocity.y, -flight.acceleration.y),
    ] {
        for &t in quadratic([gap, rate, 0.5 * pull]).as_slice() {
            if t >= from && rate + pull * t < 0.0 && first.is_none_or(|first| t < first) {
                first = Some(t);
            }
        }
    }
    first
}
