//! Ball against ball: the velocities after an impact of two bodies that are free to move.

use glam::DVec2;

/// Velocities (m/s) of two balls of masses `m1` and `m2` (kg) after an impact along the unit vector `axis` that joins
/// their centres: the components along it as in one dimension, with the restitution `ed`; those across it unchanged.
/// The balls must be approaching each other. A mass may be infinite: that ball keeps its velocity.
///
/// Each ball takes the share of the change that the other's mass has in the sum. Written so, swapping the balls swaps
/// the results bit for bit, and the momentum is kept to a rounding for any ratio of masses.
pub fn after_impact(v1: DVec2, v2: DVec2, m1: f64, m2: f64, axis: DVec2, ed: f64) -> (DVec2, DVec2) {
    let change = axis * ((1.0 + ed) * (v2 - v1).dot(axis));
    (v1 + change / (1.0 + m1 / m2), v2 - change / (1.0 + m2 / m1))
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::math::{Rng, direction};

    #[test]
    fn swapping_the_balls_swaps_the_results_bit_for_bit() {
        let mut rng = Rng::new(21);
        for _ in 0..1000 {
            let axis = direction(rng.between(0.0, 6.0));
            let v1 = direction(rng.between(0.0, 6.0)) * rng.between(0.0, 10.0);
            let v2 = direction(rng.between(0.0, 6.0)) * rng.between(0.0, 10.0);
            let (m1, m2, ed) = (rng.between(0.01, 0.1), rng.between(0.01, 0.1), rng.unit());
            let (a, b) = after_impact(v1, v2, m1, m2, axis, ed);
            assert_eq!(after_impact(v2, v1, m2, m1, -axis, ed), (b, a));
        }
    }

    #[test]
    fn equal_masses_swap_velocities_head_on() {
        let (a, b) = after_impact(DVec2::new(2.0, 0.5), DVec2::new(-1.0, 0.25), 0.08, 0.08, DVec2::X, 1.0);
        assert_eq!((a, b), (DVec2::new(-1.0, 0.5), DVec2::new(2.0, 0.25)));
    }

    #[test]
    fn an_infinite_mass_is_a_wall_that_may_move() {
        let flipper = DVec2::new(0.0, 3.0);
        let (ball, wall) = after_impact(DVec2::new(1.0, -2.0), flipper, 0.08, f64::INFINITY, DVec2::Y, 0.5);
        assert_eq!((ball, wall), (DVec2::new(1.0, 5.5), flipper));
    }
}
