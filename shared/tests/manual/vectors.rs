//! 4.1.1 Vectors: what `Vector2D` does, glam does. Its formulas are tested against glam's.

use glam::DVec2;

use crate::{assert_near, unit_at};

#[test]
fn magnitude() {
    assert_eq!(DVec2::new(3.0, -4.0).length(), 5.0);
}

#[test]
fn dot_product() {
    assert_eq!(DVec2::new(2.0, 3.0).dot(DVec2::new(-5.0, 4.0)), 2.0);
}

/// The manual's angle: arccos of the dot product over the magnitudes.
fn printed_angle(v1: DVec2, v2: DVec2) -> f64 {
    libm::acos((v1.x * v2.x + v1.y * v2.y) / (v1.length() * v2.length()))
}

#[test]
fn angle_between_two_vectors_is_glams_without_its_sign() {
    for first in (0..360).step_by(15) {
        for turn in (5..180).step_by(5) {
            let (v1, v2) = (unit_at(first) * 2.0, unit_at(first + turn) * 0.3);
            let expected = f64::from(turn).to_radians();
            assert!((printed_angle(v1, v2) - expected).abs() < 1e-14);
            assert!((v1.angle_between(v2) - expected).abs() < 1e-14, "counter-clockwise is positive");
            assert!((v2.angle_between(v1) + expected).abs() < 1e-14, "clockwise is negative");
        }
    }
}

#[test]
fn angle_as_printed_is_not_a_number_where_rounding_makes_a_cosine_above_one() {
    let v = DVec2::new(0.1, 0.6);
    assert!(printed_angle(v, v).is_nan());
    assert_eq!(v.angle_between(v), 0.0);
}

#[test]
fn addition_of_two_vectors() {
    assert_eq!(DVec2::new(1.0, 2.0) + DVec2::new(-3.0, 0.5), DVec2::new(-2.0, 2.5));
}

#[test]
fn translation_of_a_point_there_and_back() {
    let (point, by) = (DVec2::new(0.25, 0.5), DVec2::new(-1.0, 2.0));
    assert_eq!(point + by, DVec2::new(-0.75, 2.5));
    assert_eq!(point + by - by, point);
}

#[test]
fn rotation_of_a_vector() {
    assert_eq!(unit_at(90).rotate(DVec2::new(3.0, 1.0)), DVec2::new(-1.0, 3.0), "counter-clockwise");
    let v = DVec2::new(1.5, -0.5);
    for degrees in (-360..=360).step_by(5) {
        let alpha = f64::from(degrees).to_radians();
        let (sin, cos) = libm::sincos(alpha);
        let printed = DVec2::new(v.x * cos - v.y * sin, v.x * sin + v.y * cos);
        assert_near(DVec2::from_angle(alpha).rotate(v), printed, 1e-15);
    }
}

#[test]
fn multiplication_with_a_scalar() {
    let v = DVec2::new(1.5, -0.5);
    assert_eq!(v * 3.0, DVec2::new(4.5, -1.5));
    assert_eq!(v * -1.0, -v, "the opposite vector");
}

/// The manual's "normalization": the unit is not of length but of x.
fn printed_normalize(v: DVec2) -> DVec2 {
    v / v.x.abs()
}

#[test]
fn normalization_by_x_keeps_the_direction_and_both_signs() {
    assert_eq!(printed_normalize(DVec2::new(4.0, -3.0)), DVec2::new(1.0, -0.75));
    assert_eq!(printed_normalize(DVec2::new(-4.0, -3.0)), DVec2::new(-1.0, -0.75));
}

/// A ball that falls straight down has no direction. By the larger of both components it has one, and no step along it
/// is longer than a pixel along either axis.
#[test]
fn normalization_by_x_divides_by_zero_where_x_is_zero() {
    let falling = DVec2::new(0.0, -2.0);
    assert!(!printed_normalize(falling).is_finite());
    let by_the_larger = |v: DVec2| v / v.abs().max_element();
    assert_eq!(by_the_larger(falling), DVec2::NEG_Y);
    for degrees in 0..360 {
        let step = by_the_larger(unit_at(degrees) * 7.0);
        assert_eq!(step.abs().max_element(), 1.0);
        assert!(step.perp_dot(unit_at(degrees)).abs() < 1e-15 && step.dot(unit_at(degrees)) > 0.0);
    }
}
