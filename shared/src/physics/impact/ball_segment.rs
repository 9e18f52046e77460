//! Ball against straight surface: the gap is quadratic in time.

use super::{Search, TimeOfImpact, touch_gap, without_rounding};
use crate::math::roots::quadratic;
use crate::physics::ball::Flight;
use crate::physics::constants::{DEEPEST_OVERLAP, END_SLACK, TOUCH};
use crate::physics::shapes::Segment;

pub(super) fn first_impact(flight: &Flight, radius: f64, segment: &Segment, search: &Search) -> TimeOfImpact {
    // A one-way surface stops balls on the side away from its normal.
    let sides: &[f64] = if segment.one_way { &[-1.0] } else { &[1.0, -1.0] };
    let mut first = TimeOfImpact::Separated;
    for &side in sides {
        let found = from_side(flight, radius, segment, side, search);
        first = match (first, found) {
            (TimeOfImpact::Overlapping, _) | (_, TimeOfImpact::Overlapping) => TimeOfImpact::Overlapping,
            (TimeOfImpact::Impact(a), TimeOfImpact::Impact(b)) => TimeOfImpact::Impact(if a <= b { a } else { b }),
            (TimeOfImpact::Separated, other) | (other, TimeOfImpact::Separated) => other,
        };
    }
    first
}

/// The first impact of a ball that is on the side where `side * normal` points.
fn from_side(flight: &Flight, radius: f64, segment: &Segment, side: f64, search: &Search) -> TimeOfImpact {
    let normal = segment.normal * side;
    let offset = flight.position - segment.a;
    let gap = side * segment.height(flight.position) - radius;
    let rate = normal.dot(flight.velocity);
    let half_pull = 0.5 * normal.dot(flight.acceleration);
    let touch = touch_gap(flight, radius);
    let deepest = if segment.one_way { touch } else { DEEPEST_OVERLAP * radius };
    let start = segment.along.dot(offset);
    let slack = END_SLACK * touch;

    let is_beside = start >= -slack && start <= segment.length + slack;
    if gap <= touch && gap >= -deepest && is_beside {
        // In contact at the start: the constant term is zero by knowledge, whatever rounding says.
        let rate = without_rounding(rate, flight.velocity.length());
        let half_pull = without_rounding(half_pull, flight.acceleration.length());
        if rate < 0.0 || (rate == 0.0 && half_pull < 0.0) {
            // At an end that it is leaving, a ball touches the end's point and no longer the segment.
            let touches = !is_leaving(flight, segment, start, slack) && search.accepts(0.0);
            return if touches { TimeOfImpact::Overlapping } else { TimeOfImpact::Separated };
        }
        if rate > 0.0 && half_pull < 0.0 {
            return accept(flight, segment, search, -rate / half_pull);
        }
        return TimeOfImpact::Separated;
    }
    for &t in quadratic([gap, rate, half_pull]).as_slice() {
        if rate + 2.0 * half_pull * t < 0.0 {
            let found = accept(flight, segment, search, t);
            if found != TimeOfImpact::Separated {
                return found;
            }
        }
    }
    TimeOfImpact::Separated
}

/// Whether a ball is at one end of a segment and on its way out.
fn is_leaving(flight: &Flight, segment: &Segment, start: f64, slack: f64) -> bool {
    let rate = segment.along.dot(flight.velocity);
    let direction = if rate == 0.0 { segment.along.dot(flight.acceleration) } else { rate };
    (start <= slack && direction < 0.0) || (start >= segment.length - slack && direction > 0.0)
}

fn accept(flight: &Flight, segment: &Segment, search: &Search, t: f64) -> TimeOfImpact {
    let along = segment.along.dot(flight.position_at(t) - segment.a);
    if search.accepts(t) && along >= 0.0 && along <= segment.length {
        TimeOfImpact::Impact(t)
    } else {
        TimeOfImpact::Separated
    }
}

/// When the ball's centre passes the segment. A flight that begins on a line where flights begin (`begins`: a hole) has passed
/// it, whatever rounding says: only its return counts.
pub(super) fn first_pass(flight: &Flight, segment: &Segment, begins: bool, search: &Search) -> TimeOfImpact {
    let gap = segment.height(flight.position);
    let rate = segment.normal.dot(flight.velocity);
    let half_pull = 0.5 * segment.normal.dot(flight.acceleration);
    if begins && gap.abs() <= touch_gap(flight, 0.0) {
        let returns = -rate / half_pull;
        return if returns > 0.0 { accept(flight, segment, search, returns) } else { TimeOfImpact::Separated };
    }
    for &t in quadratic([gap, rate, half_pull]).as_slice() {
        if t > 0.0 {
            let found = accept(flight, segment, search, t);
            if found != TimeOfImpact::Separated {
                return found;
            }
        }
    }
    TimeOfImpact::Separated
}

/// When a ball that lies on the segment reaches one of its ends, moving outwards.
pub(crate) fn leaves_segment(flight: &Flight, segment: &Segment, search: &Search) -> TimeOfImpact {
    let start = segment.along.dot(flight.position - segment.middle);
    let half = 0.5 * segment.length;
    let rate = segment.along.dot(flight.velocity);
    let half_pull = 0.5 * segment.along.dot(flight.acceleration);
    let slack = TOUCH * (flight.position.abs().max_element() + segment.length);
    let mut first = f64::INFINITY;
    for (gap, sign) in [(half + start, 1.0), (half - start, -1.0)] {
        let (rate, half_pull) = (sign * rate, sign * half_pull);
        if gap <= slack && (rate < 0.0 || (rate == 0.0 && half_pull < 0.0)) {
            first = 0.0;
            continue;
        }
        let gap = if gap <= slack { 0.0 } else { gap };
        for &t in quadratic([gap, rate, half_pull]).as_slice() {
            if rate + 2.0 * half_pull * t < 0.0 && t < first && search.accepts(t) {
                first = t;
            }
        }
    }
    if search.accepts(first) { TimeOfImpact::Impact(first) } else { TimeOfImpact::Separated }
}
