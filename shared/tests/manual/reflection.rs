//! 4.2.2 Collision result: reflection by angles as printed, against v - 2 (v . n) n.

use core::f64::consts::PI;

use glam::DVec2;
use shared::math::line::{Line, reflect};

use crate::{assert_near, unit_at};

/// `angleCalculation` as printed: the angle and the way of rotation.
fn printed_angle(v: DVec2, obstacle_gradient: f64) -> (f64, f64) {
    let (cosine, sine) = (v.x / v.length(), v.y / v.length());
    let alpha = libm::acos(cosine);
    let falls = obstacle_gradient < 0.0;
    if cosine > 0.0 && sine > 0.0 {
        if falls { (PI - alpha, -1.0) } else { (alpha, 1.0) }
    } else if cosine > 0.0 && sine < 0.0 {
        if falls { (PI + alpha, -1.0) } else { (-alpha, 1.0) }
    } else if cosine < 0.0 && sine > 0.0 {
        if falls { (PI - alpha, -1.0) } else { (alpha, 1.0) }
    } else if cosine < 0.0 && sine < 0.0 {
        (alpha, if obstacle_gradient <= 0.0 { -1.0 } else { 1.0 })
    } else if falls {
        (PI - alpha, -1.0)
    } else {
        (alpha, 1.0)
    }
}

/// `CollisionResult` as printed, but for its loss of speed.
pub(crate) fn printed_reflection(v: DVec2, p: DVec2, q: DVec2) -> DVec2 {
    // A vertical line gets a dummy.
    let gradient = if p.x == q.x { 0.0 } else { (q.y - p.y) / (q.x - p.x) };
    let (gamma, way) = printed_angle(v, gradient);
    let delta = libm::asin((q.y - p.y).abs() / (q - p).length());
    let beta = gamma - delta;
    let alpha = PI / 2.0 - beta;
    let theta = PI - 2.0 * alpha;
    DVec2::from_angle(-theta * way).rotate(v)
}

/// Every line and velocity on a grid of 5 degrees: the line's angle, the velocity's, and both results.
fn grid() -> impl Iterator<Item = (i32, i32, DVec2, DVec2)> {
    let lines = (0..180).step_by(5);
    lines.flat_map(|line| (0..360).step_by(5).map(move |velocity| (line, velocity))).map(|(line, velocity)| {
        let (p, v) = (DVec2::new(0.25, 0.5), unit_at(velocity) * 3.0);
        // Ends of equal x or y, bit for bit, where the line is vertical or level.
        let q = p + unit_at(line);
        let normal = Line::through(p, q).expect("different points").normal;
        (line, velocity, printed_reflection(v, p, q), reflect(v, normal))
    })
}

/// The velocity makes the angle `velocity` with +x and the line makes `line`; mirrored it makes 2 line - velocity.
#[test]
fn ours_is_right_at_every_angle() {
    let mut pairs = 0;
    for (line, velocity, _, ours) in grid() {
        assert_near(ours, unit_at(2 * line - velocity) * 3.0, 1e-14);
        pairs += 1;
    }
    assert_eq!(pairs, 2592);
}

/// The manual's is the same but for 289 pairs: those with vx < 0 and vy < 0 at a line of positive gradient, all of them.
#[test]
fn by_angles_as_printed_is_wrong_for_289_pairs_of_2592() {
    let mut wrong = 0;
    for (line, velocity, printed, ours) in grid() {
        let differs = (printed - ours).length() > 1e-9 * 3.0;
        let gradient_is_positive = line > 0 && line < 90;
        let velocity_is_negative = velocity > 180 && velocity < 270;
        assert_eq!(differs, gradient_is_positive && velocity_is_negative, "line {line}, velocity {velocity}");
        wrong += i32::from(differs);
    }
    assert_eq!(wrong, 289);
}

/// There it turns by 2 delta - 2 alpha where 2 delta + 2 alpha is right.
#[test]
fn by_angles_as_printed_turns_the_wrong_way_there() {
    for (line, velocity, printed, _) in grid() {
        if line > 0 && line < 90 && velocity > 180 && velocity < 270 {
            // arccos knows the angle of a velocity that points down only as that of one which points up.
            let alpha = 360 - velocity;
            assert_near(printed, unit_at(velocity + 2 * line - 2 * alpha) * 3.0, 1e-13);
            assert_near(unit_at(velocity + 2 * line + 2 * alpha), unit_at(2 * line - velocity), 1e-15);
        }
    }
}

/// The loss of energy "due to friction" is a factor on the whole velocity: along the surface as well as across it.
#[test]
fn loss_of_a_tenth_damps_both_components() {
    let mirrored = reflect(DVec2::new(2.0, -1.0), DVec2::Y) * 0.9;
    assert_near(mirrored, DVec2::new(0.9 * 2.0, 0.9 * 1.0), 1e-15);
}
