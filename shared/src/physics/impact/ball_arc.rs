//! Ball against round surface (outside, inside, or a point): the squared distance from the centre is quartic in time.
//!
//! Where the ball is near the circle its squared distance is nearly always convex in time, and then Newton's method from
//! the proper end runs monotonically into the root. Elsewhere the roots are isolated by those of the derivatives.

use glam::DVec2;

use super::near::near_circle;
use super::{Rounding, Search, TimeOfImpact, without_rounding};
use crate::math::roots::{Roots, quadratic, sign_changes};
use crate::physics::ball::Flight;
use crate::physics::constants::{DEEPEST_OVERLAP, LONGEST_FLIGHT, MOST_NEWTON_STEPS, POLISH_STEP};
use crate::physics::shapes::{Arc, Bounds};

/// Share of a circle's radius by which a box is clear of it beyond any rounding.
const CLEARLY: f64 = 1e-6;

pub(super) fn first_impact(
    flight: &Flight,
    radius: f64,
    arc: &Arc,
    rounding: Rounding,
    search: &Search,
) -> TimeOfImpact {
    let (reach, touch) = (arc.reach(radius), rounding.gap);
    // A ball is not inside what is smaller than itself.
    if reach < 0.0 {
        return TimeOfImpact::Separated;
    }
    let offset = flight.position - arc.center;
    let gap = arc.sign() * (offset.length() - reach);
    let touches = gap <= touch && gap >= -DEEPEST_OVERLAP * radius && arc.spans(offset);
    if touches && approaches_from_contact(flight, arc, offset, rounding) {
        return if search.accepts(0.0) { TimeOfImpact::Overlapping } else { TimeOfImpact::Separated };
    }
    // Most searches go no farther than a short way, and that is clear of the arc all along.
    let after = if search.after > 0.0 { search.after } else { 0.0 };
    if !touches && search.before < LONGEST_FLIGHT && passes_by(flight, arc, reach, after, search.before) {
        return TimeOfImpact::Separated;
    }
    let crossing = first_crossing(flight, arc, reach, rounding, touches, search);
    if touches {
        return crossing;
    }
    match (crossing, enters_span(flight, radius, arc, touch, search)) {
        (TimeOfImpact::Impact(a), Some(b)) => TimeOfImpact::Impact(if a <= b { a } else { b }),
        (TimeOfImpact::Separated, Some(b)) => TimeOfImpact::Impact(b),
        (crossing, _) => crossing,
    }
}

/// Whether a ball that touches the surface is on its way into it, beyond what is only rounding.
fn approaches_from_contact(flight: &Flight, arc: &Arc, offset: DVec2, rounding: Rounding) -> bool {
    let (rate, pull) = contact_rates(flight, arc, offset, rounding);
    rate < 0.0 || (rate == 0.0 && pull < 0.0)
}

/// Rate of the gap and half its acceleration, times twice the distance, of a ball that touches: without rounding.
fn contact_rates(flight: &Flight, arc: &Arc, offset: DVec2, rounding: Rounding) -> (f64, f64) {
    let (distance, speed) = (offset.length(), rounding.speed);
    let rate = 2.0 * arc.sign() * offset.dot(flight.velocity);
    let pull = arc.sign() * (flight.velocity.length_squared() + offset.dot(flight.acceleration));
    (
        without_rounding(rate, 2.0 * distance * speed),
        without_rounding(pull, speed * speed + distance * flight.acceleration.length()),
    )
}

/// The first time at which the ball comes through the surface from its clear side, within the arc's span.
fn first_crossing(
    flight: &Flight,
    arc: &Arc,
    reach: f64,
    rounding: Rounding,
    touches: bool,
    search: &Search,
) -> TimeOfImpact {
    let offset = flight.position - arc.center;
    // A ball that sank into a hollow a little begins beyond its reach: it is near from the start all the same.
    let near = if touches && offset.length() > reach { offset.length() } else { reach };
    for &(from, to) in near_circle(offset, flight.velocity, flight.acceleration, near, rounding.gap).as_slice() {
        if from >= search.before {
            break;
        }
        let contact = touches && from == 0.0;
        let end = if to < search.before { to } else { search.before };
        if to < search.after || (!contact && passes_by(flight, arc, reach, from, end)) {
            continue;
        }
        for &s in crossings(flight, arc, reach, from, to - from, contact.then_some(rounding)).as_slice() {
            let t = polish(flight, arc, reach, from, to, from + s);
            if search.accepts(t) && (!contact || t > 0.0) && arc.spans(flight.position_at(t) - arc.center) {
                return TimeOfImpact::Impact(t);
            }
        }
    }
    TimeOfImpact::Separated
}

/// Whether the ball surely does not come through the arc meanwhile: a box around its way is within the circle, beyond it, or
/// beside the span, by more than any rounding.
fn passes_by(flight: &Flight, arc: &Arc, reach: f64, from: f64, to: f64) -> bool {
    let way = Bounds::of_flight(flight, from, to);
    let (low, high) = (way.low - arc.center, way.high - arc.center);
    let (nearest, farthest) = (DVec2::ZERO.max(low).min(high).length(), low.abs().max(high.abs()).length());
    let margin = reach * CLEARLY;
    farthest < reach - margin
        || nearest > reach + margin
        || arc.span.is_some_and(|(middle, cosine)| {
            let most = (low * middle).max(high * middle);
            most.x + most.y < cosine * if cosine > 0.0 { nearest } else { farthest } - margin
        })
}

/// Crossings from the clear side within `length` seconds from `from` on, seconds since `from`.
///
/// The polynomial is `|offset + v s + a s^2 / 2|^2 - reach^2`; outside a ball comes through where it falls below 0, inside where
/// it rises above. In contact at the start its constant term is zero by knowledge, whatever rounding says.
fn crossings(flight: &Flight, arc: &Arc, reach: f64, from: f64, length: f64, contact: Option<Rounding>) -> Roots {
    let (offset, velocity) = (flight.position_at(from) - arc.center, flight.velocity_at(from));
    let (a, distance) = (flight.acceleration, offset.length());
    let mut c = [
        (distance - reach) * (distance + reach),
        2.0 * offset.dot(velocity),
        velocity.length_squared() + offset.dot(a),
        velocity.dot(a),
        0.25 * a.length_squared(),
    ];
    if let Some(rounding) = contact {
        c[0] = 0.0;
        let (rate, _) = contact_rates(flight, arc, offset, rounding);
        c[1] = arc.sign() * rate;
    }
    // Half the second derivative is c2 + 3 c3 s + 6 c4 s^2: convex where its least value is positive.
    let lowest = if c[4] > 0.0 { (-0.25 * c[3] / c[4]).clamp(0.0, length) } else { 0.0 };
    if c[2] + 3.0 * lowest * (c[3] + 2.0 * c[4] * lowest) > 0.0 {
        return if arc.sign() > 0.0 { descent(&c, length, from > 0.0) } else { ascent(&c, length) };
    }
    let roots = match (contact.is_some(), c[1] == 0.0) {
        (false, _) => sign_changes(c, 0.0, length),
        // In contact, s = 0 is divided out.
        (true, false) => sign_changes([c[1], c[2], c[3], c[4]], 0.0, length),
        (true, true) => sign_changes([c[2], c[3], c[4]], 0.0, length),
    };
    let slope = |s: f64| c[1] + s * (2.0 * c[2] + s * (3.0 * c[3] + s * 4.0 * c[4]));
    roots.filtered(|s| arc.sign() * slope(s) < 0.0)
}

/// The root at which a convex polynomial falls below 0 within `0..=length`: Newton's method from the left. Where the ball
/// `enters` the circle's neighbourhood it is clear of it, even if after a long flight rounding says that it is not.
fn descent(c: &[f64; 5], length: f64, enters: bool) -> Roots {
    if enters && c[0] <= 0.0 && c[1] < 0.0 {
        return Roots::one(0.0);
    }
    let mut s = 0.0;
    for _ in 0..MOST_NEWTON_STEPS {
        let (value, slope) = value_and_slope(c, s);
        if value <= 0.0 {
            // At the very start it is below already: it does not come from the clear side.
            return if s > 0.0 { Roots::one(s) } else { Roots::default() };
        }
        if slope >= 0.0 {
            return Roots::default();
        }
        let next = s - value / slope;
        if next > length {
            return Roots::default();
        }
        if next <= s {
            break;
        }
        s = next;
    }
    Roots::one(s)
}

/// The root at which a convex polynomial rises above 0 within `0..=length`: Newton's method from the right.
fn ascent(c: &[f64; 5], length: f64) -> Roots {
    let mut s = length;
    let (value, slope) = value_and_slope(c, s);
    // Where it leaves the circle's neighbourhood it is beyond it, likewise.
    if value <= 0.0 && slope > 0.0 {
        return Roots::one(s);
    }
    for _ in 0..MOST_NEWTON_STEPS {
        let (value, slope) = value_and_slope(c, s);
        if value <= 0.0 {
            return if s < length { Roots::one(s) } else { Roots::default() };
        }
        if slope <= 0.0 {
            return Roots::default();
        }
        let next = s - value / slope;
        if next < 0.0 {
            return Roots::default();
        }
        if next >= s {
            break;
        }
        s = next;
    }
    Roots::one(s)
}

fn value_and_slope(c: &[f64; 5], s: f64) -> (f64, f64) {
    let value = c[0] + s * (c[1] + s * (c[2] + s * (c[3] + s * c[4])));
    let slope = c[1] + s * (2.0 * c[2] + s * (3.0 * c[3] + s * 4.0 * c[4]));
    (value, slope)
}

/// When a ball that slides along a straight wall passes on to an arc that the wall is tangent to. There the gap is zero
/// and does not change its sign: it was negative before, where the arc is not, and is negative after.
fn enters_span(flight: &Flight, radius: f64, arc: &Arc, touch: f64, search: &Search) -> Option<f64> {
    let (middle, cosine) = arc.span?;
    let sine = (1.0 - cosine * cosine).max(0.0).sqrt();
    let reach = arc.reach(radius);
    let offset = flight.position - arc.center;
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

/// Two Newton steps on the distance itself, which has more digits left near its root than the squares.
fn polish(flight: &Flight, arc: &Arc, reach: f64, from: f64, to: f64, root: f64) -> f64 {
    let mut t = root;
    for _ in 0..2 {
        let offset: DVec2 = flight.position_at(t) - arc.center;
        let distance = offset.length();
        let rate = offset.dot(flight.velocity_at(t)) / distance;
        let next = t - (distance - reach) / rate;
        // A graze has no slope to follow, a short hop no digits to gain.
        let correction = (next - t).abs();
        if correction.is_nan() || correction > POLISH_STEP * (t - from) || next < from || next > to {
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

    fn impact(flight: &Flight, arc: &Arc, to: f64) -> TimeOfImpact {
        first_impact(flight, RADIUS, arc, Rounding::of(flight, RADIUS), &Search::up_to(to))
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
        match impact(&drop, &post, 10.0) {
            TimeOfImpact::Impact(t) => assert!((t - expected).abs() < 1e-15, "{t} instead of {expected}"),
            other => panic!("{other:?}"),
        }
    }

    #[test]
    fn after_an_impact_the_same_post_is_not_met_again() {
        let post = Arc { center: DVec2::ZERO, radius: 0.02, side: Side::Outside, span: None };
        let place = DVec2::new(0.6, 0.8) * 0.0335;
        let away = flight(place, DVec2::new(0.3, 0.4));
        assert_eq!(impact(&away, &post, 1.0), TimeOfImpact::Separated);
        let towards = flight(place, DVec2::new(-0.3, -0.4));
        assert_eq!(impact(&towards, &post, 1.0), TimeOfImpact::Overlapping);
    }

    /// A ball flew up along the left wall, exactly tangent to the arch, and left the table through it.
    #[test]
    fn a_ball_that_slides_up_a_wall_meets_the_arch_that_begins_there() {
        let start = flight(DVec2::new(RADIUS, 0.71), DVec2::new(0.0, 2.0));
        let expected = (2.0 - (4.0 - 2.0 * 0.793 * 0.1_f64).sqrt()) / 0.793;
        match impact(&start, &arch(), 1.0) {
            TimeOfImpact::Impact(t) => assert!((t - expected).abs() < 1e-12, "{t} instead of {expected}"),
            other => panic!("{other:?}"),
        }
    }

    /// The same, but a touch of the wall's end had sent it away from the wall by less than a rounding.
    #[test]
    fn a_ball_that_parts_from_the_wall_by_a_rounding_still_meets_the_arch() {
        let start = flight(DVec2::new(RADIUS, 0.809_999_999_902), DVec2::new(5.87e-7, 81.27));
        assert!(matches!(impact(&start, &arch(), 1e-3), TimeOfImpact::Impact(_)));
    }
}
