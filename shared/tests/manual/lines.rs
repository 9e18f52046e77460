//! 4.1.2 Lines: what `Line2DTools` does, `math::line` does without a special case for vertical lines.

use glam::DVec2;
use shared::math::line::{Ends, Line, segment_distance, segments_intersect};

use crate::{assert_near, unit_at};

fn line(p: DVec2, q: DVec2) -> Line {
    Line::through(p, q).expect("different points")
}

/// `calculateLineEquation` as printed: [a, b, c] of a y + b x + c = 0.
fn printed_equation(p: DVec2, q: DVec2) -> [f64; 3] {
    if p.x == q.x {
        return [0.0, 1.0, p.x];
    }
    let m = (q.y - p.y) / (q.x - p.x);
    [1.0, -m, -(p.y - m * p.x)]
}

/// `calculateLineIntersect` as printed.
fn printed_intersection([a1, b1, c1]: [f64; 3], [a2, b2, c2]: [f64; 3]) -> DVec2 {
    let x = (c1 * a2 - c2 * a1) / (b2 * a1 - a2 * b1);
    DVec2::new(x, (-b2 / a2) * x - c2 / a2)
}

#[test]
fn equation_of_a_line_holds_at_both_points_at_every_angle() {
    let p = DVec2::new(0.3, -0.7);
    for degrees in 0..360 {
        let q = p + unit_at(degrees) * 2.0;
        let ours = line(p, q);
        assert!(ours.signed_distance(p).abs() < 1e-15 && ours.signed_distance(q).abs() < 1e-15);
        assert!((ours.normal.length() - 1.0).abs() < 1e-15);
        assert_near(ours.along(), unit_at(degrees), 1e-15);
        if degrees % 180 != 90 {
            // The same line as the manual's: its a, b, c in proportion to ours.
            let [a, b, c] = printed_equation(p, q);
            let scale = DVec2::new(b, a).length() * (ours.normal.y * a).signum();
            assert_near(DVec2::new(b, a) / scale, ours.normal, 1e-13);
            assert!((c / scale - ours.c).abs() < 1e-13);
        }
    }
}

#[test]
fn equation_through_coinciding_points_or_none_at_all_does_not_exist() {
    assert_eq!(Line::through(DVec2::ONE, DVec2::ONE), None);
    for beyond_numbers in [f64::NAN, f64::INFINITY, f64::MAX] {
        assert_eq!(Line::through(DVec2::ONE, DVec2::new(beyond_numbers, 0.0)), None);
    }
}

/// As printed, c = x: the line through (3, 0) and (3, 5) does not contain these points, and is met at x = -3.
#[test]
fn equation_of_a_vertical_line_as_printed_has_the_wrong_sign() {
    let (p, q) = (DVec2::new(3.0, 0.0), DVec2::new(3.0, 5.0));
    let [a, b, c] = printed_equation(p, q);
    assert_eq!(a * p.y + b * p.x + c, 6.0, "not 0");
    let level = [DVec2::new(0.0, 1.0), DVec2::new(1.0, 1.0)];
    assert_eq!(printed_intersection([a, b, c], printed_equation(level[0], level[1])), DVec2::new(-3.0, 1.0));

    assert_eq!(line(p, q).signed_distance(p), 0.0);
    assert_eq!(line(p, q).intersection(&line(level[0], level[1])), Some(DVec2::new(3.0, 1.0)));
}

#[test]
fn perpendicular_through_a_point() {
    let point = DVec2::new(-0.4, 0.9);
    for degrees in 0..360 {
        let given = line(DVec2::ZERO, unit_at(degrees));
        let perpendicular = given.perpendicular_through(point);
        assert!(perpendicular.signed_distance(point).abs() < 1e-15);
        assert!(perpendicular.normal.dot(given.normal).abs() < 1e-15);
        let foot = perpendicular.intersection(&given).expect("at right angles");
        assert_near(foot, given.nearest(point), 1e-15);
        if degrees % 90 != 0 {
            // The manual's affine form, y = m x + p with m = -1 / gradient.
            let m = -1.0 / libm::tan(f64::from(degrees).to_radians());
            let p = point.y - m * point.x;
            assert!((foot.y - (m * foot.x + p)).abs() < 1e-13);
        }
    }
}

/// In the manual's affine form the perpendicular to a level line has an infinite gradient.
#[test]
fn perpendicular_to_a_level_line_is_vertical() {
    let level = line(DVec2::ZERO, DVec2::X);
    assert!(!(-1.0_f64 / level.along().y).is_finite());
    let plumb = level.perpendicular_through(DVec2::new(2.0, 7.0));
    assert_eq!(plumb.signed_distance(DVec2::new(2.0, -100.0)), 0.0);
}

#[test]
fn intersection_of_two_lines() {
    let first = [DVec2::new(0.0, 1.0), DVec2::new(4.0, 3.0)];
    let second = [DVec2::new(0.0, 7.0), DVec2::new(6.0, 1.0)];
    let printed = printed_intersection(printed_equation(first[0], first[1]), printed_equation(second[0], second[1]));
    assert_eq!(printed, DVec2::new(4.0, 3.0));
    let ours = line(first[0], first[1]).intersection(&line(second[0], second[1])).expect("not parallel");
    assert_near(ours, printed, 1e-14);
}

/// As printed, y is divided by a2, which a vertical line has none of.
#[test]
fn intersection_with_a_vertical_second_line_as_printed_divides_by_zero() {
    let first = [DVec2::new(0.0, 1.0), DVec2::new(4.0, 3.0)];
    let upright = [DVec2::new(2.0, -1.0), DVec2::new(2.0, 9.0)];
    let printed = printed_intersection(printed_equation(first[0], first[1]), printed_equation(upright[0], upright[1]));
    assert!(!printed.y.is_finite());
    let ours = line(first[0], first[1]).intersection(&line(upright[0], upright[1])).expect("not parallel");
    assert_near(ours, DVec2::new(2.0, 2.0), 1e-15);
}

#[test]
fn intersection_of_parallel_lines_does_not_exist() {
    let step = DVec2::new(0.0, 0.1);
    for degrees in (0..180).step_by(5).filter(|&degrees| degrees != 90) {
        let (p, q) = (DVec2::ZERO, unit_at(degrees));
        let given = line(p, q);
        assert_eq!(given.intersection(&line(p + step, q + step)), None, "{degrees} degrees");
        assert_eq!(given.intersection(&line(q, p)), None, "the same line, backwards");
    }
    let level = |y: f64| printed_equation(DVec2::new(0.0, y), DVec2::new(1.0, y));
    assert!(!printed_intersection(level(1.0), level(2.0)).is_finite());
}

#[test]
fn distance_to_a_line_has_a_sign() {
    let up = line(DVec2::new(1.0, 0.0), DVec2::new(1.0, 1.0));
    assert_eq!(up.signed_distance(DVec2::new(-1.0, 5.0)), 2.0, "on the left");
    assert_eq!(up.signed_distance(DVec2::new(4.0, 5.0)), -3.0, "on the right");
    assert_eq!(up.nearest(DVec2::new(4.0, 5.0)), DVec2::new(1.0, 5.0));
}

/// `Line2D.ptSegDist`.
#[test]
fn distance_to_a_segment_is_that_to_its_end_beyond_it() {
    let ends = [DVec2::ZERO, DVec2::new(4.0, 0.0)];
    for (point, expected) in [
        (DVec2::new(1.0, 2.0), 2.0),
        (DVec2::new(1.0, -2.0), 2.0),
        (DVec2::new(7.0, 4.0), 5.0),
        (DVec2::new(-3.0, -4.0), 5.0),
        (DVec2::new(6.0, 0.0), 2.0),
        (DVec2::new(3.0, 0.0), 0.0),
    ] {
        assert_eq!(segment_distance(point, ends), expected, "{point}");
    }
}

/// `Line2D.intersectsLine`.
#[test]
fn two_segments_intersect() {
    let at = |x: f64, y: f64| DVec2::new(x, y);
    let level: Ends = [at(0.0, 0.0), at(4.0, 0.0)];
    for (name, other, expected) in [
        ("crosses", [at(1.0, -1.0), at(2.0, 1.0)], true),
        ("crosses vertically", [at(1.0, -1.0), at(1.0, 1.0)], true),
        ("ends on it", [at(1.0, 0.0), at(2.0, 1.0)], true),
        ("shares an end", [at(4.0, 0.0), at(5.0, 1.0)], true),
        ("its line would cross, beyond the other's end", [at(5.0, -1.0), at(5.0, 1.0)], false),
        ("would cross if it were longer", [at(1.0, 2.0), at(1.0, 1.0)], false),
        ("boxes meet, segments don't", [at(3.0, -2.0), at(6.0, 1.0)], false),
        ("parallel", [at(0.0, 1.0), at(4.0, 1.0)], false),
        ("overlaps on the same line", [at(3.0, 0.0), at(9.0, 0.0)], true),
        ("apart on the same line", [at(5.0, 0.0), at(9.0, 0.0)], false),
    ] {
        let back = [other[1], other[0]];
        for (a, b) in [(level, other), (other, level), (level, back), (back, level)] {
            assert_eq!(segments_intersect(a, b), expected, "{name}");
        }
    }
}
