//! When a flight is near a circle: within the square around it. Outside these times no root has to be looked for, and
//! within them a flight is nearly straight.

use glam::DVec2;

use crate::math::roots::quadratic;
use crate::physics::constants::{LONGEST_FLIGHT, NEAR_MARGIN};

/// Up to four spans of time, ascending; seconds.
#[derive(Debug, Clone, Copy, Default)]
pub(super) struct Spans {
    spans: [(f64, f64); 4],
    count: usize,
}

impl Spans {
    fn push(&mut self, from: f64, to: f64) {
        let from = if from > 0.0 { from } else { 0.0 };
        let to = if to < LONGEST_FLIGHT { to } else { LONGEST_FLIGHT };
        if from <= to && self.count < self.spans.len() {
            self.spans[self.count] = (from, to);
            self.count += 1;
        }
    }

    pub(super) fn as_slice(&self) -> &[(f64, f64)] {
        &self.spans[..self.count]
    }
}

/// The spans of time, from 0 on, in which both coordinates of a parabola that begins at `offset` are within `reach` of 0,
/// or beyond it by no more than rounding: `touch` is that of the coordinates.
pub(super) fn near_circle(offset: DVec2, velocity: DVec2, acceleration: DVec2, reach: f64, touch: f64) -> Spans {
    let reach = reach * (1.0 + NEAR_MARGIN) + touch;
    let across = near_zero(offset.x, velocity.x, acceleration.x, reach);
    let mut both = Spans::default();
    if across.count == 0 {
        return both;
    }
    let along = near_zero(offset.y, velocity.y, acceleration.y, reach);
    for &(a, b) in across.as_slice() {
        for &(c, d) in along.as_slice() {
            let (from, to) = (if a > c { a } else { c }, if b < d { b } else { d });
            both.push(from, to);
        }
    }
    both.spans[..both.count].sort_unstable_by(|a, b| a.0.total_cmp(&b.0));
    both
}

/// When `|offset + velocity t + acceleration t^2 / 2| <= reach`.
fn near_zero(offset: f64, velocity: f64, acceleration: f64, reach: f64) -> Spans {
    let mut spans = Spans::default();
    if acceleration == 0.0 {
        if velocity == 0.0 {
            if offset.abs() <= reach {
                spans.push(0.0, LONGEST_FLIGHT);
            }
            return spans;
        }
        // Seen so that it moves upwards.
        let (offset, velocity) = if velocity < 0.0 { (-offset, -velocity) } else { (offset, velocity) };
        spans.push((-reach - offset) / velocity, (reach - offset) / velocity);
        return spans;
    }
    // Seen so that the parabola opens upwards.
    let sign = if acceleration < 0.0 { -1.0 } else { 1.0 };
    let (offset, velocity, half) = (sign * offset, sign * velocity, 0.5 * sign * acceleration);
    let [enters, leaves] = *quadratic([offset - reach, velocity, half]).as_slice() else { return spans };
    match *quadratic([offset + reach, velocity, half]).as_slice() {
        // In between it is below.
        [under, over] if under < over => {
            spans.push(enters, under);
            spans.push(over, leaves);
        }
        _ => spans.push(enters, leaves),
    }
    spans
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn a_throw_passes_a_height_twice() {
        // Up at 3 m/s from 1 m below, at 1 m/s^2: within 0.1 of 0 on the way up and on the way down.
        let spans = near_zero(-1.0, 3.0, -1.0, 0.1);
        let [up, down] = *spans.as_slice() else { panic!("{spans:?}") };
        let at = |t: f64| -1.0 + 3.0 * t - 0.5 * t * t;
        for (t, expected) in [(up.0, -0.1), (up.1, 0.1), (down.0, 0.1), (down.1, -0.1)] {
            assert!((at(t) - expected).abs() < 1e-12, "{spans:?}");
        }
    }

    #[test]
    fn a_flight_beside_a_circle_is_never_near_it() {
        let beside = near_circle(DVec2::new(-1.0, 0.2), DVec2::new(1.0, 0.0), DVec2::ZERO, 0.1, 0.0);
        assert!(beside.as_slice().is_empty());
        let through = near_circle(DVec2::new(-1.0, 0.05), DVec2::new(1.0, 0.0), DVec2::ZERO, 0.1, 0.0);
        assert_eq!(through.as_slice().len(), 1);
    }

    #[test]
    fn a_ball_at_rest_is_near_for_ever_or_never() {
        let near = near_circle(DVec2::splat(0.01), DVec2::ZERO, DVec2::ZERO, 0.1, 0.0);
        assert_eq!(near.as_slice(), [(0.0, LONGEST_FLIGHT)]);
        assert!(near_circle(DVec2::splat(0.2), DVec2::ZERO, DVec2::ZERO, 0.1, 0.0).as_slice().is_empty());
    }
}
