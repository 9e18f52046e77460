//! 3 Movement, run by the engine: the first version (`Motion::Discrete`) and its two problems, and the second, pixel by pixel
//! (`Motion::Pixel`). Here a tick is a second and a pixel a metre.

use glam::DVec2;
use shared::math::line::{Ends, Line, reflect};
use shared::physics::EventKind;
use shared::physics::motion::Motion;

use crate::swept_area::{RADIUS, area_meets};
use crate::{assert_near, ball_among, ball_of, unit_at, wall, world_of};

/// What a world's only ball touches in one step: elements, times within the step and where its centre is then.
fn touches(source: &str, motion: Motion) -> Vec<(u16, f64, DVec2)> {
    let mut world = world_of(source, motion);
    let events = world.step().iter().map(|event| match event.kind {
        EventKind::Touched { element, .. } => (element, event.at.offset, event.position),
        _ => panic!("{motion}: {event:?}"),
    });
    events.collect()
}

/// Where it is after that step.
fn after_a_step(source: &str, motion: Motion) -> DVec2 {
    let mut world = world_of(source, motion);
    world.step();
    ball_of(&world).0
}

/// `p = new Point2D (px+Xspeed, py+Yspeed+gravity)`: every move is the same, and a ball that is thrown up at more than
/// gravity never comes down. In all our models gravity changes the velocity, and that the moves.
#[test]
fn version_1_as_printed_never_accumulates_gravity_and_ours_does() {
    let (thrown, gravity) = (DVec2::new(2.0, 5.0), -1.0);
    let mut printed = DVec2::ZERO;
    for _ in 0..30 {
        printed = DVec2::new(printed.x + thrown.x, printed.y + thrown.y + gravity);
    }
    assert_eq!(printed, DVec2::new(60.0, 120.0));

    for motion in Motion::ALL {
        let mut world = world_of(&ball_among(1.0, thrown, gravity, ""), motion);
        let mut last = ball_of(&world).0;
        let mut moves = Vec::new();
        for _ in 0..30 {
            world.step();
            let (position, _) = ball_of(&world);
            moves.push(position - last);
            last = position;
        }
        assert!(moves.windows(2).all(|pair| pair[1] - pair[0] == DVec2::new(0.0, gravity)), "{motion}: {moves:?}");
        assert_eq!(ball_of(&world), (DVec2::new(60.0, 30.0 * 5.0 - 450.0), DVec2::new(2.0, 5.0 - 30.0)), "{motion}");
    }
}

/// Both positions are clear of the line between them, or of a wall that is thinner than the step is long.
#[test]
fn problem_1_figure_1_a_discrete_movement_passes_a_line_between_two_positions() {
    let line = "Wall(points: [(5.0, -9.0), (5.0, 20.0)])";
    let thin_wall = "Wall(points: [(4.8, -9.0), (5.2, -9.0), (5.2, 20.0), (4.8, 20.0), (4.8, -9.0)])";
    for obstacle in [line, thin_wall] {
        let source = ball_among(1.0, DVec2::new(10.0, 5.5), 0.0, obstacle);
        assert_eq!(touches(&source, Motion::Discrete), []);
        assert_eq!(after_a_step(&source, Motion::Discrete), DVec2::new(10.0, 5.5));
        // A step that is shorter than the ball is wide finds it.
        let source = source.replace("tick_hz: 1,", "tick_hz: 10,");
        let mut world = world_of(&source, Motion::Discrete);
        let touched: usize = (0..10).map(|_| world.step().len()).sum();
        assert_eq!(touched, 1, "{obstacle}");
        assert!(ball_of(&world).0.x < 4.0, "{obstacle}");
    }
}

/// Those that test the area on the way, or small parts of it, find it where it is.
#[test]
fn problem_1_figure_2_the_other_models_test_the_way_between() {
    let line = "Wall(points: [(5.0, -9.0), (5.0, 20.0)])";
    let thin_wall = "Wall(points: [(5.0, -9.0), (5.4, -9.0), (5.4, 20.0), (5.0, 20.0), (5.0, -9.0)])";
    for obstacle in [line, thin_wall] {
        let source = ball_among(1.0, DVec2::new(10.0, 5.5), 0.0, obstacle);
        for motion in [Motion::Pixel, Motion::Swept, Motion::Exact] {
            let touched = touches(&source, motion);
            let &[(0, offset, at)] = &touched[..] else { panic!("{motion}: {touched:?}") };
            // It has 4 m to go at 10 m/s. A pixel later at the most it is noticed, and put back.
            let latest = if motion == Motion::Pixel { 0.5 } else { 0.4 };
            assert!(offset > 0.4 - 1e-15 && offset < latest + 1e-15, "{motion}: {offset}");
            assert_near(at, DVec2::new(4.0, 5.5 * offset), 1e-14);
            assert!(after_a_step(&source, motion).x < 4.0, "{motion}");
        }
    }
}

/// The lines of a figure of problem 2, and the order in which a ball that moves by 1 m to the right meets them.
struct DoubleCollision {
    lines: [Ends; 2],
    met: &'static [u16],
}

/// Parallel lines: at the nearer one, which is the second of the list, the ball turns round.
const FIGURE_3: DoubleCollision = DoubleCollision {
    lines: [[DVec2::new(0.7, -0.8), DVec2::new(0.8, 0.8)], [DVec2::new(0.4, -0.8), DVec2::new(0.5, 0.8)]],
    met: &[1],
};

/// A corner: the nearer line sends the ball up, where the other one lies across.
const FIGURE_4: DoubleCollision = DoubleCollision {
    lines: [[DVec2::new(0.75, 0.05), DVec2::new(0.1, 0.6)], [DVec2::new(0.2, -0.3), DVec2::new(0.6, 0.1)]],
    met: &[1, 0],
};

impl DoubleCollision {
    fn scene(&self, lines: &[Ends]) -> String {
        assert!(lines.len() <= self.lines.len());
        let lines: String = lines.iter().map(|&ends| wall(ends, 1.0)).collect();
        ball_among(RADIUS, DVec2::X, 0.0, &lines)
    }

    /// Times and places by hand: the way to a line is the distance less the radius, and it mirrors the velocity.
    fn expected(&self) -> Vec<(u16, f64, DVec2)> {
        let (mut time, mut at, mut velocity) = (0.0, DVec2::ZERO, DVec2::X);
        let met = self.met.iter().map(|&element| {
            let [a, b] = self.lines[usize::from(element)];
            let line = Line::through(a, b).expect("different points");
            let distance = line.signed_distance(at);
            let passing = (distance.abs() - RADIUS) / -(velocity.dot(line.normal) * distance.signum());
            assert!(passing > 0.0, "it approaches line {element}");
            (time, at) = (time + passing, at + velocity * passing);
            velocity = reflect(velocity, line.normal);
            (element, time, at)
        });
        met.collect()
    }

    /// Both models that know times of impact meet the right lines in the right order, at the right times.
    #[track_caller]
    fn check(&self) {
        for motion in [Motion::Swept, Motion::Exact] {
            let (found, expected) = (touches(&self.scene(&self.lines), motion), self.expected());
            let elements: Vec<u16> = found.iter().map(|&(element, ..)| element).collect();
            assert_eq!(elements, self.met, "{motion}");
            for ((_, time, at), (_, expected_time, expected_at)) in found.into_iter().zip(expected) {
                assert!((time - expected_time).abs() < 1e-15, "{motion}: {time} instead of {expected_time}");
                assert_near(at, expected_at, 1e-15);
            }
        }
    }
}

/// "The area the ball has when over collides with more than one object": the same answer in both figures.
#[test]
fn problem_2_the_area_collides_with_both_lines_in_both_figures() {
    for DoubleCollision { lines, .. } in [FIGURE_3, FIGURE_4] {
        assert!(lines.iter().all(|&line| area_meets(DVec2::ZERO, DVec2::X, line)));
    }
}

#[test]
fn problem_2_figure_3_only_the_nearest_line_counts() {
    FIGURE_3.check();
}

#[test]
fn problem_2_figure_4_both_lines_count() {
    FIGURE_4.check();
}

/// "Otherwise the ball will go through one": without the second line the ball ends where that would be behind it.
#[test]
fn problem_2_figure_4_with_one_line_alone_the_ball_goes_through_the_other() {
    let [a, b] = FIGURE_4.lines[0];
    let second = Line::through(a, b).expect("different points");
    let is_behind = |position: DVec2| second.signed_distance(position) * second.signed_distance(DVec2::ZERO) < 0.0;
    for motion in [Motion::Swept, Motion::Exact] {
        assert!(is_behind(after_a_step(&FIGURE_4.scene(&FIGURE_4.lines[1..]), motion)), "{motion}");
        assert!(!is_behind(after_a_step(&FIGURE_4.scene(&FIGURE_4.lines), motion)), "{motion}");
    }
}

/// "A ball moves 10 px to the left 5.5 down", in the table to the right and on.
const WORKED: DVec2 = DVec2::new(10.0, 5.5);

/// The table's rows of whole repetitions, found by standing a line in the way of each: the ball is noticed at a row and
/// put back straight from it.
#[test]
fn version_2_worked_table_is_walked_pixel_by_pixel() {
    for row in 1..=10 {
        let there = f64::from(row);
        // Nearer to the row than the ball is wide, and behind it: not yet noticed at the row before.
        let line = wall([DVec2::new(there - 0.05, -9.0), DVec2::new(there - 0.05, 20.0)], 1.0);
        let touched = touches(&ball_among(0.1, WORKED, 0.0, &line), Motion::Pixel);
        let &[(0, offset, at)] = &touched[..] else { panic!("row {row}: {touched:?}") };
        assert!((offset - 0.1 * there).abs() < 1e-15, "row {row} after {offset}");
        assert_near(at, DVec2::new(there - 0.15, 0.55 * there), 1e-14);
    }
}

#[test]
fn version_2_worked_table_ends_ten_right_and_five_and_a_half_on() {
    assert_eq!(after_a_step(&ball_among(0.1, WORKED, 0.0, ""), Motion::Pixel), WORKED);
}

/// mov.x is "either 1, 0 or -1": left is negative, which the worked example forgets.
#[test]
fn version_2_left_is_negative() {
    let left = DVec2::new(-10.0, 5.5);
    assert_eq!(after_a_step(&ball_among(0.1, left, 0.0, ""), Motion::Pixel), left);
    let line = wall([DVec2::new(-4.0, -9.0), DVec2::new(-4.0, 20.0)], 1.0);
    assert_eq!(touches(&ball_among(0.1, left, 0.0, &line), Motion::Pixel).len(), 1);
}

/// As printed, vx = 0 makes no repetition: see `pixel_loop`. Here the larger component counts.
#[test]
fn version_2_a_ball_that_falls_straight_moves_and_is_tested_at_every_pixel() {
    let falling = DVec2::new(0.0, -8.0);
    assert_eq!(after_a_step(&ball_among(0.1, falling, 0.0, ""), Motion::Pixel), falling);
    assert_eq!(
        after_a_step(&ball_among(0.1, DVec2::ZERO, -8.0, ""), Motion::Pixel),
        DVec2::new(0.0, -4.0),
        "from rest"
    );
    for row in 1..=8 {
        let there = -f64::from(row);
        let line = wall([DVec2::new(-9.0, there + 0.05), DVec2::new(9.0, there + 0.05)], 1.0);
        let touched = touches(&ball_among(0.1, falling, 0.0, &line), Motion::Pixel);
        assert_eq!(touched, [(0, f64::from(row) / 8.0, DVec2::new(0.0, there + 0.05 + 0.1))]);
    }
}

/// In every direction, and wherever the line is: it is noticed at most a pixel after the ball touched it.
#[test]
fn version_2_no_part_of_the_way_is_longer_than_a_pixel() {
    let radius = 0.6;
    for degrees in (0..360).step_by(5) {
        let velocity = unit_at(degrees) * 7.3;
        let axis = if velocity.x.abs() >= velocity.y.abs() { DVec2::X } else { DVec2::Y };
        let axis = axis * velocity.dot(axis).signum();
        let speed = velocity.dot(axis);
        let mut latest = 0.0_f64;
        for tenths in 7..45 {
            let distance = f64::from(tenths) / 10.0;
            let (middle, half) = (axis * distance, axis.perp() * 20.0);
            let touched =
                touches(&ball_among(radius, velocity, 0.0, &wall([middle - half, middle + half], 1.0)), Motion::Pixel);
            let &[(0, offset, _)] = &touched[..] else { panic!("{degrees} degrees, {distance} m: {touched:?}") };
            let past = speed * offset - (distance - radius);
            assert!(past > 0.0 && past <= 1.0 + 1e-14, "{degrees} degrees, {distance} m: {past} px late");
            latest = latest.max(past);
        }
        assert!(latest > 0.8, "{degrees} degrees: nor are they much shorter, {latest} px");
    }
}
