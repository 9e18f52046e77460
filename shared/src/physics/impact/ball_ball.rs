//! Ball against ball: one of them, seen from the other, flies past a disc.

use glam::DVec2;

use super::{Rounding, Search, TimeOfImpact, ball_arc};
use crate::physics::ball::Flight;
use crate::physics::constants::NEAR_MARGIN;
use crate::physics::shapes::{Arc, Side};

/// The first impact of two balls within `search`. Both flights must begin at the same moment; times are seconds since
/// then.
pub fn ball_ball(one: &Flight, one_radius: f64, other: &Flight, other_radius: f64, search: &Search) -> TimeOfImpact {
    let seen = Flight {
        start: one.start,
        position: one.position - other.position,
        velocity: one.velocity - other.velocity,
        acceleration: one.acceleration - other.acceleration,
    };
    if misses(&seen, one_radius + other_radius) {
        return TimeOfImpact::Separated;
    }
    let disc = Arc { center: DVec2::ZERO, radius: other_radius, side: Side::Outside, span: None };
    // What they may be off each other by rounding is that of their coordinates, not of their distance.
    let rounding = Rounding::of(one, one_radius).of_both(Rounding::of(other, other_radius));
    ball_arc::first_impact(&seen, one_radius, &disc, rounding, search)
}

/// Whether a straight way clearly parts from (0, 0) or passes it by more than `reach`: most pairs of balls do.
fn misses(seen: &Flight, reach: f64) -> bool {
    let (offset, velocity) = (seen.position, seen.velocity);
    let (distance, speed) = (offset.length_squared(), velocity.length_squared());
    let closest = offset.perp_dot(velocity);
    let (clear, square) = (1.0 + NEAR_MARGIN, reach * reach);
    seen.acceleration == DVec2::ZERO
        && distance > square * clear * clear
        && (offset.dot(velocity) >= 0.0 || closest * closest > square * speed * clear * clear)
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::physics::ball::Instant;

    fn flight(position: DVec2, velocity: DVec2) -> Flight {
        Flight { start: Instant::start_of(0), position, velocity, acceleration: DVec2::new(0.0, -0.8) }
    }

    #[test]
    fn two_balls_that_fall_together_meet_as_if_they_did_not_fall() {
        let (a, b) = (flight(DVec2::ZERO, DVec2::X), flight(DVec2::new(1.0, 0.0), -DVec2::X));
        assert_eq!(ball_ball(&a, 0.1, &b, 0.2, &Search::whole()), TimeOfImpact::Impact(0.35));
        assert_eq!(ball_ball(&b, 0.2, &a, 0.1, &Search::whole()), TimeOfImpact::Impact(0.35));
    }

    #[test]
    fn balls_that_part_do_not_meet() {
        let (a, b) = (flight(DVec2::ZERO, -DVec2::X), flight(DVec2::new(0.3, 0.0), DVec2::ZERO));
        assert_eq!(ball_ball(&a, 0.1, &b, 0.2, &Search::whole()), TimeOfImpact::Separated);
    }
}
