//! Ball against round surface (outside, inside, or a point): the squared distance from the centre is quartic in time.

use glam::DVec2;

use super::{Search, TimeOfImpact, touch_gap, without_rounding};
use crate::math::roots::sign_changes;
use crate::physics::ball::Flight;
use crate::physics::constants::DEEPEST_OVERLAP;
use crate::physics::shapes::Arc;

pub(super) fn first_impact(flight: &Flight, radius: f64, arc: &Arc, search: &Search) -> TimeOfImpact {
    let reach = arc.reach(radius);
    let sign = arc.sign();
    let offset = flight.position - arc.center;
    let distance = offset.length();
    let gap = sign * (distance - reach);
    // sign * (|offset + v t + a t^2 / 2|^2 - reach^2): positive while the ball is clear.
    let c = [
        gap * (distance + reach),
        2.0 * sign * offset.dot(flight.velocity),
        sign * (flight.velocity.length_squared() + offset.dot(flight.acceleration)),
        sign * flight.velocity.dot(flight.acceleration),
        sign * 0.25 * flight.acceleration.length_squared(),
    ];
    if gap <= touch_gap(flight, radius) && gap >= -DEEPEST_OVERLAP * radius && arc.spans(offset) {
        return from_contact(flight, arc, reach, search, c, distance);
    }
    first_approach(flight, arc, reach, search, sign_changes(c, search.from, search.to).as_slice())
}

/// In contact at the start: the constant term is zero by knowledge, so t = 0 is divided out.
fn from_contact(flight: &Flight, arc: &Arc, reach: f64, search: &Search, c: [f64; 5], distance: f64) -> TimeOfImpact {
    let speed = flight.velocity.length();
    let rate = without_rounding(c[1], 2.0 * distance * speed);
    let pull = without_rounding(c[2], speed * speed + distance * flight.acceleration.length());
    if rate < 0.0 || (rate == 0.0 && pull < 0.0) {
        return if search.accepts(0.0) { TimeOfImpact::Overlapping } else { TimeOfImpact::Separated };
    }
    let later = if rate == 0.0 {
        sign_changes([pull, c[3], c[4]], search.from, search.to)
    } else {
        sign_changes([rate, c[2], c[3], c[4]], search.from, search.to)
    };
    first_approach(flight, arc, reach, search, later.as_slice())
}

/// The first of `times` at which the ball comes closer to the surface, within the arc's span.
fn first_approach(flight: &Flight, arc: &Arc, reach: f64, search: &Search, times: &[f64]) -> TimeOfImpact {
    for &t in times {
        if t <= 0.0 || rate_at(flight, arc, t) >= 0.0 {
            continue;
        }
        let t = polish(flight, arc, reach, search, t);
        if search.accepts(t) && arc.spans(flight.position_at(t) - arc.center) {
            return TimeOfImpact::Impact(t);
        }
    }
    TimeOfImpact::Separated
}

/// Rate of the gap times the distance, m^2/s.
fn rate_at(flight: &Flight, arc: &Arc, t: f64) -> f64 {
    arc.sign() * (flight.position_at(t) - arc.center).dot(flight.velocity_at(t))
}

/// Two Newton steps on the distance itself, which has more digits left near its root than the squares.
fn polish(flight: &Flight, arc: &Arc, reach: f64, search: &Search, root: f64) -> f64 {
    let mut t = root;
    for _ in 0..2 {
        let offset: DVec2 = flight.position_at(t) - arc.center;
        let distance = offset.length();
        let rate = offset.dot(flight.velocity_at(t)) / distance;
        let next = t - (distance - reach) / rate;
        // A graze has no slope to follow; and the root stays in the part of the flight that was searched.
        let correction = (next - t).abs();
        let allowed = 1e-6 * (search.to - search.from);
        if correction.is_nan() || correction > allowed || next < search.from || next >= search.to {
            break;
        }
        t = next;
    }
    t
}
