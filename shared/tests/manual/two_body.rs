//! 3 Collision result circle to circle: two moving masses, and what the manual made of it for one.

use glam::DVec2;
use shared::math::Rng;
use shared::physics::two_body::after_impact;

use crate::{assert_near, unit_at};

/// Two balls that approach each other along an axis, at random.
struct Impact {
    v1: DVec2,
    v2: DVec2,
    axis: DVec2,
}

fn random_impacts() -> impl Iterator<Item = Impact> {
    let mut rng = Rng::new(17);
    (0..360).map(move |degrees| {
        let axis = unit_at(degrees);
        let mut velocity = |along: f64| axis * along + axis.perp() * rng.between(-5.0, 5.0);
        Impact { v1: velocity(3.0), v2: velocity(-2.0), axis }
    })
}

/// From a million times heavier to a million times lighter.
fn mass_ratios() -> impl Iterator<Item = f64> {
    [1e-6, 1e-3, 0.1, 0.5, 1.0, 2.0, 10.0, 1e3, 1e6].into_iter()
}

/// The site's code as printed.
fn printed(v1: DVec2, v2: DVec2, m1: f64, m2: f64, axis: DVec2, ed: f64) -> (DVec2, DVec2) {
    let (ax, ay) = (axis.x, axis.y);
    let (va1, vb1) = (v1.x * ax + v1.y * ay, -v1.x * ay + v1.y * ax);
    let (va2, vb2) = (v2.x * ax + v2.y * ay, -v2.x * ay + v2.y * ax);
    let va_p1 = va1 + (1.0 + ed) * (va2 - va1) / (1.0 + m1 / m2);
    let va_p2 = va2 + (1.0 + ed) * (va1 - va2) / (1.0 + m2 / m1);
    (DVec2::new(va_p1 * ax - vb1 * ay, va_p1 * ay + vb1 * ax), DVec2::new(va_p2 * ax - vb2 * ay, va_p2 * ay + vb2 * ax))
}

#[test]
fn code_as_printed_gives_the_same_for_any_masses_and_restitution() {
    for Impact { v1, v2, axis } in random_impacts() {
        for ratio in mass_ratios() {
            for ed in [0.0, 0.5, 1.0] {
                let (a, b) = after_impact(v1, v2, 0.08 * ratio, 0.08, axis, ed);
                let (printed_a, printed_b) = printed(v1, v2, 0.08 * ratio, 0.08, axis, ed);
                assert_near(a, printed_a, 1e-14);
                assert_near(b, printed_b, 1e-14);
            }
        }
    }
}

/// Step 3 of the site, for elastic balls: Vap2 = (m1 - m2)/(m1 + m2) Vap + 2 m2/(m1 + m2) Vbp.
#[test]
fn formula_of_the_elastic_impact_in_one_dimension() {
    let (m1, m2, va, vb) = (3.0, 1.0, 2.0, -4.0);
    let (a, b) = after_impact(DVec2::new(va, 0.0), DVec2::new(vb, 0.0), m1, m2, DVec2::X, 1.0);
    assert_near(a, DVec2::new((m1 - m2) / (m1 + m2) * va + 2.0 * m2 / (m1 + m2) * vb, 0.0), 1e-15);
    assert_near(b, DVec2::new(2.0 * m1 / (m1 + m2) * va + (m2 - m1) / (m1 + m2) * vb, 0.0), 1e-15);
}

#[test]
fn tangential_component_is_not_changed() {
    for Impact { v1, v2, axis } in random_impacts() {
        let (a, b) = after_impact(v1, v2, 0.03, 0.08, axis, 0.7);
        assert!((a - v1).dot(axis.perp()).abs() < 1e-15);
        assert!((b - v2).dot(axis.perp()).abs() < 1e-15);
    }
}

#[test]
fn balls_part_at_the_restitution_times_the_speed_of_approach() {
    for Impact { v1, v2, axis } in random_impacts() {
        for ratio in mass_ratios() {
            for ed in [0.0, 0.5, 1.0] {
                let (a, b) = after_impact(v1, v2, 0.08 * ratio, 0.08, axis, ed);
                assert!(((b - a).dot(axis) - 5.0 * ed).abs() < 1e-13);
            }
        }
    }
}

#[test]
fn momentum_is_kept_for_any_ratio_of_masses() {
    for Impact { v1, v2, axis } in random_impacts() {
        for ratio in mass_ratios() {
            let (m1, m2) = (0.08 * ratio, 0.08);
            let (a, b) = after_impact(v1, v2, m1, m2, axis, 0.5);
            // Written as changes, so that a light ball's momentum is not lost in a heavy one's.
            let moved = m2 * (b - v2);
            let lost = (m1 * (a - v1) + moved).length();
            // A velocity is as good as its own rounding at the best.
            let rounding = 4.0 * f64::EPSILON * (m1 * v1.length() + m2 * v2.length() + moved.length());
            assert!(lost <= rounding, "{lost} kg m/s lost of {moved} at a ratio of {ratio}");
        }
    }
}

#[test]
fn energy_is_kept_at_ed_1_and_lost_by_the_formula_below() {
    for Impact { v1, v2, axis } in random_impacts() {
        for ratio in mass_ratios() {
            for ed in [0.0, 0.5, 1.0] {
                let (m1, m2) = (0.08 * ratio, 0.08);
                let energy = |v1: DVec2, v2: DVec2| 0.5 * (m1 * v1.length_squared() + m2 * v2.length_squared());
                let (a, b) = after_impact(v1, v2, m1, m2, axis, ed);
                // Of the motion towards each other, (1 - ed^2) is lost.
                let lost = 0.5 * (m1 * m2 / (m1 + m2)) * 25.0 * (1.0 - ed * ed);
                let found = energy(v1, v2) - energy(a, b);
                assert!((found - lost).abs() < 1e-14 * energy(v1, v2), "{found} J lost instead of {lost}");
            }
        }
    }
}

/// "How we used this", as printed, for a ball at `axis` from the centre of what it hits.
pub(crate) fn as_used(v: DVec2, axis: DVec2, ed: f64) -> DVec2 {
    let friction = 0.999;
    let mass_simulation = 0.3;
    let (ax, ay) = (axis.x, axis.y);
    let (va1, vb1) = (v.x * ax + v.y * ay, -v.x * ay + v.y * ax);
    let va_p1 = va1 + (1.0 + ed) * (0.0 - va1) / (1.0 + mass_simulation);
    DVec2::new(va_p1 * ax - vb1 * ay, va_p1 * ay + vb1 * ax) * friction
}

/// ed is 1 in the code and the object does not move, but the simulated mass takes its share: -2/1.3.
#[test]
fn own_constants_give_a_normal_restitution_of_0_538() {
    let after = as_used(DVec2::new(-1.0, 0.0), DVec2::X, 1.0);
    assert!((after.x / 0.999 - 0.538).abs() < 5e-4);
    let restitution = 2.0 / 1.3 - 1.0;
    for Impact { v1, axis, .. } in random_impacts() {
        let (wall, _) = after_impact(v1, DVec2::ZERO, 0.08, f64::INFINITY, axis, restitution);
        assert_near(as_used(v1, axis, 1.0), wall * 0.999, 1e-14);
        let (elastic, _) = after_impact(v1, DVec2::ZERO, 0.3, 1.0, axis, 1.0);
        assert_near(as_used(v1, axis, 1.0), elastic * 0.999, 1e-14);
    }
}

/// "leave at 0.5!!!!!" says the comment beside ed = 1. At 0.5 the ball would all but stick.
#[test]
fn own_constants_with_the_comments_ed_would_give_0_154() {
    let after = as_used(DVec2::new(-1.0, 0.0), DVec2::X, 0.5);
    assert!((after.x / 0.999 - 0.154).abs() < 5e-4);
}

#[test]
fn own_friction_scales_the_whole_velocity() {
    let along = as_used(DVec2::new(0.0, 2.0), DVec2::X, 1.0);
    assert_eq!(along, DVec2::new(0.0, 2.0 * 0.999));
}
