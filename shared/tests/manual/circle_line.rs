//! 3 Collision test circle to line, and replacing the pinball during a collision circle to line.

use glam::DVec2;
use shared::math::circle::{Circle, Crossing};
use shared::math::line::{Ends, Line, segment_distance};

use crate::{assert_near, unit_at};

const RADIUS: f64 = 0.25;
const WALL: Ends = [DVec2::ZERO, DVec2::new(4.0, 0.0)];

fn ball(x: f64, y: f64) -> Circle {
    Circle { center: DVec2::new(x, y), radius: RADIUS }
}

#[test]
fn collision_test_is_a_distance_below_the_radius() {
    for (name, ball, expected) in [
        ("above", ball(2.0, 0.2), true),
        ("below", ball(2.0, -0.2), true),
        ("touches", ball(2.0, 0.25), false),
        ("clear", ball(2.0, 0.3), false),
        ("overlaps the end", ball(4.2, 0.1), true),
        ("over the line, but past its end", ball(4.3, 0.0), false),
        ("within both ranges, but past the corner", ball(4.2, 0.2), false),
    ] {
        assert_eq!(ball.overlaps_segment(WALL), expected, "{name}");
    }
}

/// Figures 1 to 3 with the middle of the chord given: the end of the compass's diameter that is nearest to the ball.
fn by_compass(ball: &Circle, middle: DVec2) -> Option<DVec2> {
    let base_line = Line::through(middle, ball.center)?;
    let compass = Circle { center: middle, radius: ball.radius };
    let Crossing::Crosses(p, q) = compass.crossing(&base_line) else { return None };
    Some(if (p - ball.center).length() < (q - ball.center).length() { p } else { q })
}

/// Figure 1: the chord that the ball's circle cuts from the whole line.
fn chord(ball: &Circle, [a, b]: Ends) -> (DVec2, DVec2) {
    let line = Line::through(a, b).expect("different points");
    match ball.crossing(&line) {
        Crossing::Crosses(p, q) => (p, q),
        other => panic!("{other:?}"),
    }
}

#[test]
fn figures_1_to_3_above_the_wall_are_where_the_compass_puts_the_ball() {
    for degrees in (0..360).step_by(5) {
        let along = unit_at(degrees);
        let wall = [DVec2::new(0.5, 0.25) - along, DVec2::new(0.5, 0.25) + along];
        for offset in [-0.24, -0.1, -0.001, 0.001, 0.1, 0.24] {
            let center = wall[0] + along * 0.7 + along.perp() * offset;
            let ball = Circle { center, radius: RADIUS };
            let (p, q) = chord(&ball, wall);
            let compass = by_compass(&ball, (p + q) * 0.5).expect("a base line");
            assert_near(ball.place_at_segment(wall, center + along.perp() * offset), compass, 1e-12);
        }
    }
}

#[test]
fn a_replaced_ball_just_touches() {
    assert_eq!(ball(2.0, 0.125).place_at_segment(WALL, DVec2::new(1.5, 1.0)), DVec2::new(2.0, 0.25));
    assert_eq!(ball(2.0, -0.125).place_at_segment(WALL, DVec2::new(1.5, -1.0)), DVec2::new(2.0, -0.25));
}

/// Past the end of a wall, the middle of the chord is not the point of the wall that the ball overlaps. If the chord is
/// that of the whole line, the ball is put clear of the wall; if it is cut off at the wall's end, it stays in the wall.
#[test]
fn at_the_end_of_a_wall_the_compass_misses_the_nearest_point() {
    let ball = ball(4.125, 0.125);
    let (p, q) = chord(&ball, WALL);
    let whole = by_compass(&ball, (p + q) * 0.5).expect("a base line");
    assert!(segment_distance(whole, WALL) > RADIUS + 0.02, "clear of the wall, not touching it");
    let cut_off = by_compass(&ball, (p + WALL[1]) * 0.5).expect("a base line");
    assert!(segment_distance(cut_off, WALL) < RADIUS - 0.02, "still in the wall");

    let ours = ball.place_at_segment(WALL, DVec2::new(5.0, 1.0));
    assert_near(ours, WALL[1] + unit_at(45) * RADIUS, 1e-15);
}

/// There the base line would have to go through one point. The ball goes back to where it came from.
#[test]
fn with_its_centre_on_the_line_the_compass_has_no_line() {
    let on_it = ball(2.0, 0.0);
    let (p, q) = chord(&on_it, WALL);
    assert_eq!(by_compass(&on_it, (p + q) * 0.5), None);
    assert_eq!(on_it.place_at_segment(WALL, DVec2::new(1.0, 0.5)), DVec2::new(2.0, 0.25));
    assert_eq!(on_it.place_at_segment(WALL, DVec2::new(1.0, -0.5)), DVec2::new(2.0, -0.25));
}

/// The same on walls whose points are rounded, where the centre is never quite on the line.
#[test]
fn with_its_centre_a_rounding_off_the_line_the_ball_goes_back_as_well() {
    for degrees in 0..360 {
        let along = unit_at(degrees);
        let wall = [DVec2::new(0.1, 0.7) - along, DVec2::new(0.1, 0.7) + along];
        let on_it = Circle { center: wall[0] + along * 0.3, radius: RADIUS };
        for side in [1.0, -1.0] {
            let came_from = on_it.center + (along.perp() * side - along) * 0.1;
            assert_near(on_it.place_at_segment(wall, came_from), on_it.center + along.perp() * (side * RADIUS), 1e-14);
        }
    }
}

/// "Thanks to pixel per pixel collision testing this last assumption is correct, otherwise you need to test where the
/// ball was before": the nearest end of the diameter is on the wrong side once the centre has passed the line.
#[test]
fn with_its_centre_past_the_line_the_ball_goes_back_to_where_it_was_before() {
    let past = ball(2.0, -0.125);
    let (p, q) = chord(&past, WALL);
    assert_near(by_compass(&past, (p + q) * 0.5).expect("a base line"), DVec2::new(2.0, -0.25), 1e-15);
    assert_eq!(past.place_at_segment(WALL, DVec2::new(2.0, 0.5)), DVec2::new(2.0, 0.25));
    assert_eq!(
        past.place_at_segment(WALL, DVec2::new(2.0, 0.0)),
        DVec2::new(2.0, -0.25),
        "where it was on the line before, its centre tells"
    );
    assert_eq!(
        ball(4.0, -0.125).place_at_segment(WALL, DVec2::new(4.5, 0.5)),
        DVec2::new(4.0, -0.25),
        "a ball that went round the end has not passed the line"
    );
}
