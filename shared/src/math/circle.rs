//! Circles: whether their borders meet, where a line crosses one, and where a ball belongs that overlaps a surface.
//!
//! Placement goes straight along the line between the two centres, or to the nearest point of a segment. The drawn
//! construction with a compass (cross the line with the circle, put the ball's circle on the crossing, cross again)
//! ends at the same point, but loses its line when the centres coincide.

use glam::DVec2;

use super::line::{Ends, Line, nearest_of_segment, segment_distance, segments_intersect};
use super::tangent;

/// How near to a circle's border a line touches it, as a share of the coordinates involved: a few roundings of an f64.
/// Smaller: a tangent crosses the circle or misses it as rounding will have it. Larger: more short chords are taken for
/// a touch; with this one those below 1e-6 of a ball's radius, anywhere on a table.
const TOUCH: f64 = 8.0 * f64::EPSILON;

/// How near to a segment a ball's centre lies on it, as a share of the coordinates involved: a few roundings. Smaller:
/// the direction from the segment to the centre is that of the rounding.
const ON_SEGMENT: f64 = 8.0 * f64::EPSILON;

/// A circle: a ring, a post, or a ball.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct Circle {
    /// Metres.
    pub center: DVec2,
    /// Metres, not negative.
    pub radius: f64,
}

impl Circle {
    /// Whether this circle lies wholly within `outer`. One that touches it from inside does not.
    pub fn is_interior(&self, outer: &Self) -> bool {
        (self.center - outer.center).length() + self.radius < outer.radius
    }

    /// Whether the borders of two circles share a point: not if they are apart, nor if one lies within the other.
    /// A touch counts, from outside and from inside. Concentric circles share a border or nothing.
    pub fn border_meets(&self, other: &Self) -> bool {
        let apart = (self.center - other.center).length() > self.radius + other.radius;
        !apart && !self.is_interior(other) && !other.is_interior(self)
    }

    /// Where `line` meets the border.
    pub fn crossing(&self, line: &Line) -> Crossing {
        let distance = line.signed_distance(self.center);
        let middle = line.nearest(self.center);
        let touch = TOUCH * (self.center.abs().max_element() + line.c.abs() + self.radius);
        if distance.abs() > self.radius + touch {
            Crossing::None
        } else if distance.abs() >= self.radius - touch {
            Crossing::Touches(middle)
        } else {
            // The product of sum and difference keeps the digits that the difference of squares loses near a touch.
            let half = ((self.radius - distance) * (self.radius + distance)).sqrt();
            Crossing::Crosses(middle - line.along() * half, middle + line.along() * half)
        }
    }

    /// Where the centre of a ball that has come upon this circle from outside belongs: where it just touches, in the
    /// direction in which `ball` lies from the centre. A ball right in the centre goes up the table (+y).
    pub fn place_outside(&self, ball: &Self) -> DVec2 {
        self.center + self.direction_to(ball) * (self.radius + ball.radius)
    }

    /// Where the centre of a ball that has come upon this circle from inside belongs, likewise; `None` if it is too
    /// large to be inside. A ball right in the centre goes up the table (+y).
    pub fn place_inside(&self, ball: &Self) -> Option<DVec2> {
        let reach = self.radius - ball.radius;
        (reach >= 0.0).then(|| self.center + self.direction_to(ball) * reach)
    }

    /// Unit vector from the centre towards another circle's; +y if they coincide.
    fn direction_to(&self, other: &Self) -> DVec2 {
        (other.center - self.center).try_normalize().unwrap_or(DVec2::Y)
    }

    /// Whether this ball overlaps a segment. A touch does not count.
    pub fn overlaps_segment(&self, ends: Ends) -> bool {
        segment_distance(self.center, ends) < self.radius
    }

    /// Where the centre of this ball, which has come upon a segment, belongs: where it just touches the point of the
    /// segment that is nearest to it, which near an end is the end. `came_from` is where its centre was before: if it
    /// has passed the segment since, or lies on it, the ball goes back to that side.
    pub fn place_at_segment(&self, ends: Ends, came_from: DVec2) -> DVec2 {
        let nearest = nearest_of_segment(self.center, ends);
        let offset = self.center - nearest;
        let size = self.center.abs().max_element() + ends[0].abs().max_element() + ends[1].abs().max_element();
        let lies_on_it = offset.length() <= ON_SEGMENT * size;
        let away = if lies_on_it { None } else { offset.try_normalize() };
        let has_passed = lies_on_it || segments_intersect([came_from, self.center], ends);
        let normal = if has_passed { side_of(ends, came_from).or(away) } else { away };
        nearest + normal.unwrap_or_else(|| upward_normal(ends)) * self.radius
    }
}

/// Where a line meets a circle.
#[derive(Debug, Clone, Copy, PartialEq)]
pub enum Crossing {
    /// Nowhere.
    None,
    /// In one point, within a few roundings: the line is a tangent.
    Touches(DVec2),
    /// In two points, in the order in which they lie along the line.
    Crosses(DVec2, DVec2),
}

/// Unit normal of a segment, to the side where `point` is; `None` if it is on neither side, or the segment is a point.
fn side_of(ends: Ends, point: DVec2) -> Option<DVec2> {
    let line = Line::through(ends[0], ends[1])?;
    let distance = line.signed_distance(point);
    let rounding = ON_SEGMENT * (point.abs().max_element() + line.c.abs());
    (distance.abs() > rounding).then_some(if distance > 0.0 { line.normal } else { -line.normal })
}

/// Unit normal of a segment that points up the table: where nothing else says which side it should be.
fn upward_normal([a, b]: Ends) -> DVec2 {
    let normal = tangent(b - a).try_normalize().unwrap_or(DVec2::Y);
    if normal.y < 0.0 || (normal.y == 0.0 && normal.x < 0.0) { -normal } else { normal }
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::math::{Rng, direction};

    /// A tangent made by rounded arithmetic at any place and angle: neither a miss nor a chord.
    #[test]
    fn a_tangent_touches_whatever_rounding_says() {
        let mut rng = Rng::new(11);
        for _ in 0..10_000 {
            let center = DVec2::new(rng.between(-2.0, 2.0), rng.between(-2.0, 2.0));
            let circle = Circle { center, radius: rng.between(0.001, 0.5) };
            let out = direction(rng.between(0.0, core::f64::consts::TAU));
            let touched = center + out * circle.radius;
            let line = Line::through(touched, touched + tangent(out)).expect("a unit apart");
            match circle.crossing(&line) {
                Crossing::Touches(p) => assert!((p - touched).length() < 1e-14, "{p} instead of {touched}"),
                other => panic!("{other:?} of {circle:?} and {line:?}"),
            }
        }
    }

    #[test]
    fn both_points_of_a_chord_lie_on_the_border_and_on_the_line() {
        let mut rng = Rng::new(12);
        for _ in 0..10_000 {
            let circle = Circle { center: DVec2::new(0.3, -0.2), radius: 0.25 };
            let within = circle.center + direction(rng.between(0.0, 6.0)) * rng.between(0.0, 0.2499);
            let line = Line::through(within, within + direction(rng.between(0.0, 6.0))).expect("a unit apart");
            let Crossing::Crosses(p, q) = circle.crossing(&line) else { panic!("{line:?} has a point within") };
            for point in [p, q] {
                assert!(((point - circle.center).length() - circle.radius).abs() < 1e-15);
                assert!(line.signed_distance(point).abs() < 1e-15);
            }
            assert!((q - p).dot(line.along()) > 0.0);
        }
    }

    #[test]
    fn a_ball_placed_at_a_segment_just_touches_it() {
        let mut rng = Rng::new(13);
        let ends = [DVec2::new(0.1, 0.2), DVec2::new(0.4, 0.1)];
        for _ in 0..10_000 {
            let center = DVec2::new(rng.between(0.0, 0.5), rng.between(0.0, 0.3));
            let ball = Circle { center, radius: 0.0135 };
            let came_from = center + direction(rng.between(0.0, 6.0)) * 0.05;
            let placed = ball.place_at_segment(ends, came_from);
            let gap = segment_distance(placed, ends) - ball.radius;
            assert!(gap.abs() < 1e-15, "gap {gap}");
        }
    }

    #[test]
    fn where_nothing_tells_the_side_it_is_up_the_table() {
        let on_it = Circle { center: DVec2::new(0.2, 0.0), radius: 0.01 };
        let flat = [DVec2::ZERO, DVec2::new(0.5, 0.0)];
        for ends in [flat, [flat[1], flat[0]]] {
            assert_eq!(on_it.place_at_segment(ends, DVec2::new(0.1, 0.0)), DVec2::new(0.2, 0.01));
        }
        let point = Circle { center: DVec2::ZERO, radius: 0.01 };
        assert_eq!(point.place_at_segment([DVec2::ZERO; 2], DVec2::ZERO), DVec2::new(0.0, 0.01));
    }
}
