//! 4.2.1 First collision test algorithm: the area that a ball sweeps, built as the manual builds it, and what it cannot
//! say. Ordering by time of impact says it.

use glam::DVec2;
use shared::math::circle::{Circle, Crossing};
use shared::math::line::{Ends, Line, segments_intersect};
use shared::physics::ball::{Flight, Instant};
use shared::physics::impact::{Search, TimeOfImpact, ball_shape};
use shared::physics::shapes::{Segment, Shape};

use crate::{assert_near, unit_at};

pub(crate) const RADIUS: f64 = 0.1;
const FROM: DVec2 = DVec2::ZERO;
const TO: DVec2 = DVec2::new(1.3, 0.0);

/// Figure 2: an obstacle that goes up, down and up again across the ball's way, and on, beside it.
const OBSTACLE: [Ends; 4] = [
    [DVec2::new(0.4, -0.5), DVec2::new(0.6, 0.5)],
    [DVec2::new(0.6, 0.5), DVec2::new(0.7, -0.5)],
    [DVec2::new(0.7, -0.5), DVec2::new(0.9, 0.5)],
    [DVec2::new(0.9, 0.5), DVec2::new(2.0, 0.5)],
];

/// The long sides of the rectangle: perpendiculars to the way through the ball's centre, before and after it, meet the
/// ball's circle in the rectangle's corners.
fn swept_area(from: DVec2, to: DVec2) -> [Ends; 2] {
    let way = Line::through(from, to).expect("it moves");
    let corners = [from, to].map(|center| {
        let across = way.perpendicular_through(center);
        match (Circle { center, radius: RADIUS }).crossing(&across) {
            Crossing::Crosses(p, q) => [p, q],
            other => panic!("a line through the centre: {other:?}"),
        }
    });
    let [[p, q], [p_after, q_after]] = corners;
    [[p, p_after], [q, q_after]]
}

/// Whether one of the two lines meets the obstacle.
pub(crate) fn area_meets(from: DVec2, to: DVec2, obstacle: Ends) -> bool {
    swept_area(from, to).iter().any(|&side| segments_intersect(side, obstacle))
}

/// When a ball that moves from one position to the other in a second meets the segment.
fn time_of_impact(from: DVec2, to: DVec2, [a, b]: Ends) -> Option<f64> {
    let flight = Flight { start: Instant::start_of(0), position: from, velocity: to - from, acceleration: DVec2::ZERO };
    match ball_shape(&flight, RADIUS, &Shape::Segment(Segment::new(a, b)), &Search::up_to(1.0)) {
        TimeOfImpact::Impact(t) => Some(t),
        _ => None,
    }
}

/// Of the obstacle's parts, the one that is hit first.
fn first_hit(from: DVec2, to: DVec2) -> Option<usize> {
    let times = OBSTACLE.iter().enumerate().filter_map(|(part, &ends)| Some((part, time_of_impact(from, to, ends)?)));
    times.min_by(|(_, a), (_, b)| a.total_cmp(b)).map(|(part, _)| part)
}

#[test]
fn figure_1_between_two_positions_a_ball_passes_a_line_unseen() {
    let wall = [DVec2::new(0.6, -0.5), DVec2::new(0.6, 0.5)];
    for center in [FROM, TO] {
        assert!(!Circle { center, radius: RADIUS }.overlaps_segment(wall));
    }
    assert!(area_meets(FROM, TO, wall));
}

#[test]
fn rectangle_is_parallel_to_the_way_and_a_radius_off() {
    for degrees in (0..360).step_by(5) {
        let (from, to) = (DVec2::new(0.3, 0.2), DVec2::new(0.3, 0.2) + unit_at(degrees) * 0.8);
        let [left, right] = swept_area(from, to).map(|[start, end]| (start - from, end - start));
        assert_near(left.0, unit_at(degrees + 90) * RADIUS, 1e-15);
        assert_near(right.0, unit_at(degrees - 90) * RADIUS, 1e-15);
        assert_near(left.1, to - from, 1e-15);
        assert_near(right.1, to - from, 1e-15);
    }
}

#[test]
fn figure_2_three_parts_of_the_obstacle_are_hit() {
    assert_eq!(OBSTACLE.map(|part| area_meets(FROM, TO, part)), [true, true, true, false]);
}

/// The same area, swept in the other direction: all its answers are the same, but another part is hit first.
#[test]
fn the_area_cannot_say_which_part_was_hit_first_and_times_of_impact_can() {
    let forwards = OBSTACLE.map(|part| area_meets(FROM, TO, part));
    let backwards = OBSTACLE.map(|part| area_meets(TO, FROM, part));
    assert_eq!(forwards, backwards);
    assert_eq!(first_hit(FROM, TO), Some(0));
    assert_eq!(first_hit(TO, FROM), Some(2));
}

/// Two long sides are not an area: what lies wholly between them crosses neither, and the round front is not in it.
#[test]
fn two_lines_miss_what_lies_between_them_and_before_the_front() {
    let between = [DVec2::new(0.6, -0.05), DVec2::new(0.6, 0.05)];
    let before_the_front = [DVec2::new(1.35, -0.5), DVec2::new(1.35, 0.5)];
    for obstacle in [between, before_the_front] {
        assert!(!area_meets(FROM, TO, obstacle));
        assert!(time_of_impact(FROM, TO, obstacle).is_some());
    }
}
