//! 3 Movement, version 2: the pixel loop as the manual prints it, line of code against worked table.
//!
//! In exact numbers: a position is a pair of integers in units of 1/600 pixel, in which a sixth of a pixel is 100 and
//! 0.55 sixths are 55.

use glam::DVec2;

const PIXEL: i64 = 600;

/// Positions after every part of a movement of `speed` repetitions by (`x`, `y`), each in `parts` parts. As printed,
/// only x is divided by the parts.
fn positions(x: i64, y: i64, speed: i64, parts: i64, y_is_divided: bool) -> Vec<(i64, i64)> {
    let step = (x / parts, if y_is_divided { y / parts } else { y });
    let mut at = (0, 0);
    (0..speed * parts)
        .map(|_| {
            at = (at.0 + step.0, at.1 + step.1);
            at
        })
        .collect()
}

/// The parts of a repetition as printed: round(mov.y) + 1, without a sign.
fn printed_parts(mov_y: f64) -> i64 {
    (mov_y + 0.5).floor() as i64 + 1
}

#[test]
fn worked_table_ends_ten_right_and_five_and_a_half_on() {
    let table = positions(PIXEL, 330, 10, 6, true);
    assert_eq!(table[..6], [(100, 55), (200, 110), (300, 165), (400, 220), (500, 275), (600, 330)]);
    assert_eq!(table.last(), Some(&(10 * PIXEL, 5 * PIXEL + PIXEL / 2)));
}

#[test]
fn code_line_as_printed_does_not_divide_y_and_goes_six_times_too_far() {
    let printed = positions(PIXEL, 330, 10, 6, false);
    assert_eq!(printed.last(), Some(&(10 * PIXEL, 33 * PIXEL)));
}

#[test]
fn worked_example_goes_right_where_it_says_left() {
    let left = DVec2::new(-10.0, 5.5);
    assert_eq!(left / left.x.abs(), DVec2::new(-1.0, 0.55));
}

#[test]
fn worked_example_takes_more_parts_than_its_own_rule_and_ends_at_the_same_place() {
    assert_eq!(printed_parts(0.55), 2, "mov.y is 0.55; the example rounds 5.5");
    let by_the_rule = positions(PIXEL, 330, 10, 2, true);
    assert_eq!(by_the_rule.last(), positions(PIXEL, 330, 10, 6, true).last());
}

#[test]
fn by_the_rule_no_part_is_longer_than_a_pixel() {
    for hundredths in 0..2000 {
        let mov_y = f64::from(hundredths) / 100.0;
        let parts = printed_parts(mov_y);
        assert!(mov_y / parts as f64 <= 1.0, "{mov_y} in {parts} parts");
        if mov_y >= 0.5 && mov_y.fract() != 0.0 && mov_y.fract() < 0.5 {
            assert!(mov_y / (parts - 1) as f64 > 1.0, "one part fewer would do for {mov_y}");
        }
    }
}

/// The rule rounds mov.y with its sign, so that a steep movement towards smaller y has no parts at all.
#[test]
fn by_the_rule_as_printed_a_ball_that_goes_steeply_the_other_way_never_moves() {
    assert!(positions(PIXEL, -2 * PIXEL, 10, printed_parts(-2.0), true).is_empty());
    assert_eq!(printed_parts(f64::abs(-2.0)), 3, "of the absolute value it has three");
}

/// speed = |vx| repetitions are none; those of the larger component are as many as pixels.
#[test]
fn as_printed_a_ball_that_falls_straight_never_moves() {
    let falling = DVec2::new(0.0, 8.0);
    let repetitions = |speed: f64| positions(0, PIXEL, speed as i64, 1, true);
    assert!(repetitions(falling.x.abs()).is_empty());
    assert_eq!(repetitions(falling.abs().max_element()).last(), Some(&(0, 8 * PIXEL)));
}

#[test]
fn gravity_is_shared_out_over_all_parts() {
    let (gravity, speed, parts) = (0.3, 10, 6);
    let fallen: f64 = (0..speed * parts).map(|_| gravity / f64::from(speed) / f64::from(parts)).sum();
    assert!((fallen - gravity).abs() < 1e-15);
}
