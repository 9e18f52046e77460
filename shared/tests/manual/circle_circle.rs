//! 3 Collision test circle to circle, and `isInterior` of `GraphicTools`.

use glam::DVec2;
use shared::math::circle::Circle;

use crate::unit_at;

fn circle(x: f64, y: f64, radius: f64) -> Circle {
    Circle { center: DVec2::new(x, y), radius }
}

/// Asks in both orders, which must not matter.
#[track_caller]
fn borders_meet(a: Circle, b: Circle) -> bool {
    assert_eq!(a.border_meets(&b), b.border_meets(&a));
    a.border_meets(&b)
}

#[test]
fn figure_1_apart_is_false() {
    assert!(!borders_meet(circle(0.0, 0.0, 1.0), circle(3.0, 0.0, 1.5)));
}

#[test]
fn figure_2_overlapping_is_true() {
    assert!(borders_meet(circle(0.0, 0.0, 1.0), circle(2.0, 0.0, 1.5)));
}

#[test]
fn figure_3_one_inside_the_other_is_false() {
    assert!(!borders_meet(circle(0.0, 0.0, 1.0), circle(0.25, 0.0, 1.5)));
}

/// The three figures in one sweep: the borders meet while the distance is from the difference of the radii to their sum.
#[test]
fn figures_1_to_3_by_distance_in_every_direction() {
    let ring = circle(0.5, -0.25, 1.0);
    for degrees in (0..360).step_by(5) {
        for (distance, expected) in [(0.0, false), (0.699, false), (0.701, true), (1.299, true), (1.301, false)] {
            let ball = Circle { center: ring.center + unit_at(degrees) * distance, radius: 0.3 };
            assert_eq!(borders_meet(ring, ball), expected, "{distance} at {degrees} degrees");
        }
    }
}

#[test]
fn touching_from_outside_is_true_and_a_rounding_further_is_false() {
    let ball = circle(0.0, 0.0, 0.5);
    assert!(borders_meet(ball, circle(0.75, 0.0, 0.25)));
    assert!(!borders_meet(ball, circle(0.75 + f64::EPSILON, 0.0, 0.25)));
}

#[test]
fn is_interior_is_strict_so_that_touching_from_inside_is_an_overlap() {
    let ring = circle(0.0, 0.0, 1.0);
    let touching = circle(0.0, 0.75, 0.25);
    assert!(!touching.is_interior(&ring));
    assert!(borders_meet(touching, ring));
    let clear = circle(0.0, 0.75 - f64::EPSILON, 0.25);
    assert!(clear.is_interior(&ring));
    assert!(!borders_meet(clear, ring));
}

#[test]
fn is_interior_says_which_of_both_is_inside() {
    let (small, large) = (circle(0.25, 0.0, 0.5), circle(0.0, 0.0, 1.0));
    assert!(small.is_interior(&large));
    assert!(!large.is_interior(&small));
}

#[test]
fn concentric_circles_share_their_border_or_nothing() {
    let ring = circle(0.25, 0.5, 1.0);
    assert!(borders_meet(ring, ring), "the same circle");
    assert!(!borders_meet(ring, circle(0.25, 0.5, 0.5)));
}
