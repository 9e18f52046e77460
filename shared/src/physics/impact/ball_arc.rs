//! Ball against round surface (outside, inside, or a point): the squared distance from the centre is quartic in time.

use glam::DVec2;

use super::{Search, TimeOfImpact, touch_gap, without_rounding};
use crate::math::roots::{quadratic, sign_changes};
use crate::physics::ball::Flight;
use crate::physics::constants::{DEEPEST_OVERLAP, POLISH_STEP};
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
    let crossing = first_approach(flight, arc, reach, search, sign_changes(c, search.from, search.to).as_slice());
    match (crossing, enters_span(flight, radius, arc, search)) {
        (TimeOfImpact::Impact(a), Some(b)) => TimeOfImpact::Impact(if a <= b { a } else { b }),
        (TimeOfImpact::Separated, Some(b)) => TimeOfImpact::Impact(b),
        (crossing, _) => crossing,
    }
}

/// When a ball that slides along a straight wall passes on to an arc that the wall is tangent to. There the gap is zero
/// and does not change its sign: it was negative before, where the arc is not, and is negative after.
fn enters_span(flight: &Flight, radius: f64, arc: &Arc, search: &Search) -> Option<f64> {
    let (middle, cosine) = arc.span?;
    let sine = (1.0 - cosine * cosine).max(0.0).sqrt();
    let reach = arc.reach(radius);
    let offset = flight.position - arc.center;
    let touch = touch_gap(flight, radius);
    let mut first: Option<f64> = None;
    for side in [sine, -sine] {
        let end = middle * cosine + middle.perp() * side;
        let c = [end.perp_dot(offset), end.perp_dot(flight.velocity), 0.5 * end.perp_dot(flight.acceleration)];
        for &t in quadratic(c).as_slice() {
            let (place, velocity) = (flight.position_at(t) - arc.center, flight.velocity_at(t));
            let distance = place.length();
            let gap = arc.sign() * (distance - reach);
            if !search.accepts(t) || place.dot(end) <= 0.0 || gap.abs() > touch || first.is_some_and(|f| f <= t) {
                continue;
            }
            // Towards the span's middle, and the surface bends towards the ball.
            let inwards = end.perp_dot(velocity) * end.perp_dot(middle);
            let pull = arc.sign() * (velocity.length_squared() + place.dot(flight.acceleration));
            if inwards <= 0.0 || pull >= 0.0 {
                continue;
            }
            // A ball that parts by less than a rounding before the surface has bent back to it never seems to part.
            let rate = arc.sign() * place.dot(velocity);
            let rate = if rate > 0.0 { rate } else { 0.0 };
            let meets = t - 2.0 * rate / pull;
            if rate * rate <= -2.0 * pull * distance * touch && search.accepts(meets) {
                first = Some(meets);
            }
        }
    }
    first
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
        let allowed = POLISH_STEP * (search.to - search.from);
        if correction.is_nan() || correction > allowed || next < search.from || next >= search.to {
            break;
        }
        t = next;
    }
    t
}

#[cfg(test)]
mod tests {
    use glam::DVec2;

    use super::*;
    use crate::physics::ball::Instant;
    use crate::physics::shapes::Side;

    const RADIUS: f64 = 0.0135;

    fn flight(position: DVec2, velocity: DVec2) -> Flight {
        Flight { start: Instant::start_of(0), position, velocity, acceleration: DVec2::new(0.0, -0.793) }
    }

    /// The upper half of a circle of 0.257 m, from inside.
    fn arch() -> Arc {
        let span = Some((DVec2::Y, 0.0));
        Arc { center: DVec2::new(0.257, 0.81), radius: 0.257, side: Side::Inside, span }
    }

    #[test]
    fn a_post_is_met_head_on_at_the_time_of_the_closed_form() {
        let post = Arc { center: DVec2::ZERO, radius: 0.02, side: Side::Outside, span: None };
        let drop = flight(DVec2::new(0.0, 0.5), DVec2::ZERO);
        let expected = (2.0 * (0.5 - 0.0335) / 0.793_f64).sqrt();
        match first_impact(&drop, RADIUS, &post, &Search::up_to(10.0)) {
            TimeOfImpact::Impact(t) => assert!((t - expected).abs() < 1e-15, "{t} instead of {expected}"),
            other => panic!("{other:?}"),
        }
    }

    #[test]
    fn after_an_impact_the_same_post_is_not_met_again() {
        let post = Arc { center: DVec2::ZERO, radius: 0.02, side: Side::Outside, span: None };
        let place = DVec2::new(0.6, 0.8) * 0.0335;
        let away = flight(place, DVec2::new(0.3, 0.4));
        assert_eq!(first_impact(&away, RADIUS, &post, &Search::up_to(1.0)), TimeOfImpact::Separated);
        let towards = flight(place, DVec2::new(-0.3, -0.4));
        assert_eq!(first_impact(&towards, RADIUS, &post, &Search::up_to(1.0)), TimeOfImpact::Overlapping);
    }

    /// A ball flew up along the left wall, exactly tangent to the arch, and left the table through it.
    #[test]
    fn a_ball_that_slides_up_a_wall_meets_the_arch_that_begins_there() {
        let start = flight(DVec2::new(RADIUS, 0.71), DVec2::new(0.0, 2.0));
        let expected = (2.0 - (4.0 - 2.0 * 0.793 * 0.1_f64).sqrt()) / 0.793;
        match first_impact(&start, RADIUS, &arch(), &Search::up_to(1.0)) {
            TimeOfImpact::Impact(t) => assert!((t - expected).abs() < 1e-12, "{t} instead of {expected}"),
            other => panic!("{other:?}"),
        }
    }

    /// The same, but a touch of the wall's end had sent it away from the wall by less than a rounding.
    #[test]
    fn a_ball_that_parts_from_the_wall_by_a_rounding_still_meets_the_arch() {
        let start = flight(DVec2::new(RADIUS, 0.809_999_999_902), DVec2::new(5.87e-7, 81.27));
        assert!(matches!(first_impact(&start, RADIUS, &arch(), &Search::up_to(1e-3)), TimeOfImpact::Impact(_)));
    }
}
