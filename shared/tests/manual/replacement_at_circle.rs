//! 3 Replacing the pinball during a collision circle to circle, and the line-circle intersection that it uses.

use glam::DVec2;
use shared::math::circle::{Circle, Crossing};
use shared::math::line::Line;

use crate::{assert_near, unit_at};

/// A level line at this height.
fn level(y: f64) -> Line {
    Line::through(DVec2::new(0.0, y), DVec2::new(1.0, y)).expect("different points")
}

const RING: Circle = Circle { center: DVec2::new(2.0, 1.0), radius: 0.5 };

#[test]
fn figure_4_a_line_that_misses_the_circle_is_null() {
    assert_eq!(RING.crossing(&level(1.5 + 1e-9)), Crossing::None);
    assert_eq!(RING.crossing(&level(0.5 - 1e-9)), Crossing::None);
}

#[test]
fn figure_5_a_tangent_is_one_point_twice() {
    assert_eq!(RING.crossing(&level(1.5)), Crossing::Touches(DVec2::new(2.0, 1.5)));
    assert_eq!(RING.crossing(&level(0.5)), Crossing::Touches(DVec2::new(2.0, 0.5)));
}

#[test]
fn figure_6_a_line_through_the_circle_is_two_points() {
    assert_eq!(RING.crossing(&level(1.0)), Crossing::Crosses(DVec2::new(1.5, 1.0), DVec2::new(2.5, 1.0)));
    let Crossing::Crosses(p, q) = RING.crossing(&level(1.3)) else { panic!("a chord") };
    assert_near(p, DVec2::new(1.6, 1.3), 1e-15);
    assert_near(q, DVec2::new(2.4, 1.3), 1e-15);
}

/// Figures 3 and 7: the two possible centres of `ball` at `ring`, by ruler and compass, the outer one first. Nothing if
/// there is no line through both centres.
fn by_compass(ball: &Circle, ring: &Circle) -> Option<(DVec2, DVec2)> {
    let center_line = Line::through(ring.center, ball.center)?;
    let Crossing::Crosses(p, q) = ring.crossing(&center_line) else { return None };
    let nearer = if (p - ball.center).length() < (q - ball.center).length() { p } else { q };
    let compass = Circle { center: nearer, radius: ball.radius };
    let Crossing::Crosses(p, q) = compass.crossing(&center_line) else { return None };
    let p_is_outer = (p - ring.center).length() > (q - ring.center).length();
    Some(if p_is_outer { (p, q) } else { (q, p) })
}

#[test]
fn figure_1_from_outside_and_figure_2_from_inside_are_where_the_compass_puts_them() {
    for degrees in 0..360 {
        for distance in [0.41, 0.49, 0.5, 0.53, 0.59] {
            let ball = Circle { center: RING.center + unit_at(degrees) * distance, radius: 0.1 };
            let (outside, inside) = by_compass(&ball, &RING).expect("two centres");
            assert_near(RING.place_outside(&ball), outside, 1e-14);
            assert_near(RING.place_inside(&ball).expect("it fits"), inside, 1e-14);
        }
    }
}

#[test]
fn a_replaced_ball_just_touches() {
    let ball = Circle { center: DVec2::new(2.5, 1.0), radius: 0.125 };
    assert_eq!(RING.place_outside(&ball), DVec2::new(2.625, 1.0));
    assert_eq!(RING.place_inside(&ball), Some(DVec2::new(2.375, 1.0)));
}

#[test]
fn a_ball_larger_than_the_ring_has_no_place_inside() {
    let ball = |radius| Circle { center: DVec2::new(2.1, 1.0), radius };
    assert_eq!(RING.place_inside(&ball(0.5)), Some(RING.center), "it just fits");
    assert_eq!(RING.place_inside(&ball(0.5 + 1e-9)), None);
}

/// With both centres in one point the unit vector as printed divides by zero, and the compass has no line.
#[test]
fn concentric_circles_have_no_line_and_are_given_one_up_the_table() {
    let ball = Circle { center: RING.center, radius: 0.125 };
    let d = ball.center - RING.center;
    assert!((d / d.length()).is_nan());
    assert_eq!(by_compass(&ball, &RING), None);
    assert_eq!(RING.place_outside(&ball), DVec2::new(2.0, 1.625));
    assert_eq!(RING.place_inside(&ball), Some(DVec2::new(2.0, 1.375)));
}
