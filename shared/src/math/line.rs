//! Straight lines and segments: equation, perpendicular, intersection, distance, reflection.
//!
//! A line is a x + b y + c = 0 with a unit vector (a, b), in which x and y have equal rights: a vertical line is a line
//! like any other. (A gradient has no value for it, and every formula with a gradient has a special case or a mistake.)
//! Lengths, dot products, rotations and quarter turns of vectors are glam's.

use glam::DVec2;

use super::tangent;

/// Sine of the angle below which two lines are parallel, no unit. Rounding two unit normals turns each by half of this
/// at the most. Smaller: lines that were made parallel meet, 10^16 times their size away. Larger: lines that do meet,
/// far away, are said not to.
const PARALLEL: f64 = 4.0 * f64::EPSILON;

/// The two ends of a segment, metres. They may coincide.
pub type Ends = [DVec2; 2];

/// A straight line: the points p with `normal . p + c = 0`.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct Line {
    /// Unit vector (a, b) across the line.
    pub normal: DVec2,
    /// Minus the signed distance of the line from the origin along `normal`, metres.
    pub c: f64,
}

impl Line {
    /// The line from `p` to `q`, its normal to the left; `None` if the points coincide. The line from `q` to `p` has the
    /// same three numbers with the opposite sign, bit for bit.
    pub fn through(p: DVec2, q: DVec2) -> Option<Self> {
        let length = (q - p).length();
        if !(length > 0.0 && length.is_finite()) {
            return None;
        }
        let normal = -tangent((q - p) / length);
        Some(Self { normal, c: -normal.dot((p + q) * 0.5) })
    }

    /// Unit vector along the line: from the first to the second of the points that it was made of.
    pub fn along(&self) -> DVec2 {
        tangent(self.normal)
    }

    /// Distance of `point`, metres: positive on the side where `normal` points. Its error is a rounding of the
    /// coordinates, not of the distance.
    pub fn signed_distance(&self, point: DVec2) -> f64 {
        self.normal.dot(point) + self.c
    }

    /// The point of the line that is nearest to `point`: the foot of the perpendicular.
    pub fn nearest(&self, point: DVec2) -> DVec2 {
        point - self.normal * self.signed_distance(point)
    }

    /// The perpendicular to this line through `point`.
    pub fn perpendicular_through(&self, point: DVec2) -> Self {
        let normal = self.along();
        Self { normal, c: -normal.dot(point) }
    }

    /// Where two lines meet (Cramer's rule); `None` if they are parallel or the same.
    pub fn intersection(&self, other: &Self) -> Option<DVec2> {
        let sine = self.normal.perp_dot(other.normal);
        if sine.abs() <= PARALLEL {
            return None;
        }
        let x = self.normal.y * other.c - other.normal.y * self.c;
        let y = other.normal.x * self.c - self.normal.x * other.c;
        Some(DVec2::new(x, y) / sine)
    }
}

/// The point of a segment that is nearest to `point`; beyond an end it is that end, bit for bit.
pub fn nearest_of_segment(point: DVec2, [a, b]: Ends) -> DVec2 {
    let span = b - a;
    let along = (point - a).dot(span);
    if along <= 0.0 {
        a
    } else if along >= span.length_squared() {
        b
    } else {
        a + span * (along / span.length_squared())
    }
}

/// Distance from `point` to the nearest point of a segment, metres.
pub fn segment_distance(point: DVec2, ends: Ends) -> f64 {
    (point - nearest_of_segment(point, ends)).length()
}

/// Whether two segments share a point. A touch counts, at an end as well; where it is one by less than a rounding of
/// the coordinates' products, the answer may be either.
pub fn segments_intersect([a, b]: Ends, [c, d]: Ends) -> bool {
    // Without the boxes, segments one behind the other on the same line would count.
    let boxes_meet = a.min(b).cmple(c.max(d)).all() && c.min(d).cmple(a.max(b)).all();
    boxes_meet && !on_one_side([a, b], [c, d]) && !on_one_side([c, d], [a, b])
}

/// Whether both points lie strictly on the same side of the line through the segment's ends.
fn on_one_side([a, b]: Ends, [p, q]: Ends) -> bool {
    let side_of_p = (b - a).perp_dot(p - a);
    let side_of_q = (b - a).perp_dot(q - a);
    (side_of_p > 0.0 && side_of_q > 0.0) || (side_of_p < 0.0 && side_of_q < 0.0)
}

/// `velocity` mirrored at a surface with the unit normal `normal`: v - 2 (v . n) n.
pub fn reflect(velocity: DVec2, normal: DVec2) -> DVec2 {
    velocity - normal * (2.0 * velocity.dot(normal))
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::math::Rng;

    fn random_point(rng: &mut Rng) -> DVec2 {
        DVec2::new(rng.between(-1.0, 1.0), rng.between(-1.0, 1.0))
    }

    fn line(p: DVec2, q: DVec2) -> Line {
        Line::through(p, q).expect("different points")
    }

    #[test]
    fn x_and_y_have_equal_rights_bit_for_bit() {
        let mut rng = Rng::new(3);
        for _ in 0..1000 {
            let [p, q, r, s] = [(); 4].map(|()| random_point(&mut rng));
            let swap = |v: DVec2| DVec2::new(v.y, v.x);
            let (given, swapped) = (line(p, q), line(swap(p), swap(q)));
            assert_eq!((swapped.normal, swapped.c), (-swap(given.normal), -given.c));
            let crossing = given.intersection(&line(r, s)).map(swap);
            assert_eq!(swapped.intersection(&line(swap(r), swap(s))), crossing);
        }
    }

    #[test]
    fn backwards_it_is_the_same_line_bit_for_bit() {
        let mut rng = Rng::new(4);
        for _ in 0..1000 {
            let (p, q) = (random_point(&mut rng), random_point(&mut rng));
            let (there, back) = (line(p, q), line(q, p));
            assert_eq!((back.normal, back.c), (-there.normal, -there.c));
        }
    }

    #[test]
    fn lines_made_parallel_never_meet() {
        let mut rng = Rng::new(5);
        for _ in 0..10_000 {
            let (p, q, step) = (random_point(&mut rng), random_point(&mut rng), random_point(&mut rng));
            let (first, third) = (line(p, q), line(p, q).perpendicular_through(step).perpendicular_through(p));
            assert_eq!(first.intersection(&third), None);
            // The same direction from another length rounds to another normal.
            let scaled = line(DVec2::ZERO, (q - p) * rng.between(0.1, 10.0));
            assert_eq!(first.intersection(&scaled), None);
        }
    }

    #[test]
    fn a_small_angle_is_not_parallel() {
        let flat = line(DVec2::ZERO, DVec2::X);
        let tilted = line(DVec2::new(0.0, 1e-6), DVec2::new(1.0, 0.0));
        let meeting = flat.intersection(&tilted).expect("not parallel");
        assert!((meeting - DVec2::X).length() < 1e-15, "{meeting}");
    }

    #[test]
    fn nothing_is_nearer_than_the_nearest_point_of_a_segment() {
        let mut rng = Rng::new(6);
        for _ in 0..200 {
            let [a, b, p] = [(); 3].map(|()| random_point(&mut rng));
            let distance = segment_distance(p, [a, b]);
            let sampled = (0..=1000)
                .map(|k| (a.lerp(b, f64::from(k) / 1000.0) - p).length())
                .fold(f64::INFINITY, |least, d| if d < least { d } else { least });
            assert!(distance <= sampled + 1e-15 && sampled <= distance + 2e-3, "{distance} and {sampled}");
        }
    }

    #[test]
    fn a_segment_of_no_length_is_a_point() {
        let end = DVec2::new(0.3, 0.4);
        assert_eq!(segment_distance(DVec2::ZERO, [end, end]), 0.5);
        assert!(segments_intersect([end, end], [DVec2::ZERO, DVec2::new(0.6, 0.8)]));
        assert!(!segments_intersect([end, end], [DVec2::ZERO, DVec2::new(0.6, 0.7)]));
    }

    #[test]
    fn a_reflection_keeps_the_speed_and_undoes_itself() {
        let normal = DVec2::new(0.6, 0.8);
        let v = DVec2::new(1.5, -2.0);
        let mirrored = reflect(v, normal);
        assert!((mirrored.dot(normal) + v.dot(normal)).abs() < 1e-15);
        assert!((mirrored.dot(tangent(normal)) - v.dot(tangent(normal))).abs() < 1e-15);
        assert!((reflect(mirrored, normal) - v).length() < 1e-15);
    }
}
