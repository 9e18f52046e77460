//! Every number of targets, spinners, gates and saucers that is out of range is refused, with element, field and what would be
//! right; and so is every rule that speaks of them wrongly, and every plate that a ball could lie on.

use super::{Table, TableError};

/// A good table with one of each. Gravity presses balls on the gates' lines, and along that of the second spinner.
const GOOD: &str = r#"(
    format: 1, physics: 3, name: "Good", size: (0.5, 1.0), gravity: (0.0, -0.8), rest_speed: 0.02,
    ball: (radius: 0.0135, mass: 0.08, start: (0.4, 0.2)),
    materials: { "wood": (restitution: 0.3) },
    elements: [
        Target(name: "target", material: "wood", from: (0.1, 0.2), to: (0.15, 0.2), threshold: 0.11),
        Spinner(name: "spinner", from: (0.1, 0.3), to: (0.15, 0.3), lever: 0.021, inertia: 2e-6, friction: 30.0, restitution: 0.31, lift: 1e-5),
        Spinner(name: "upright", from: (0.1, 0.3), to: (0.1, 0.35), lever: 0.02, inertia: 2e-6, friction: 31.0, restitution: 0.3, lift: 0.5),
        Gate(name: "gate", from: (0.1, 0.4), to: (0.15, 0.4), lever: 0.022, inertia: 1e-6, restitution: 0.32, lift: 2e-5, one_way: true),
        Gate(name: "up gate", from: (0.15, 0.45), to: (0.1, 0.45), lever: 0.02, inertia: 1e-6, restitution: 0.3, lift: 0.25, one_way: true),
        Saucer(name: "saucer", center: (0.2, 0.2), radius: 0.012, capture: 0.8, kick: (0.3, -1.2), hold: 0.75),
        Saucer(name: "lock", center: (0.3, 0.2), radius: 0.013, capture: 0.7, kick: (0.0, 1.2)),
        Drain(name: "drain", from: (0.0, 0.05), to: (0.5, 0.05)),
    ],
    groups: { "locks": ["saucer", "lock"] },
    rules: (balls: 3, max_multiplier: 6, on: [
        (event: Hit("target"), run: [Score(1)]),
        (event: Spin("spinner"), run: [Score(2)]),
        (event: Hold("lock"), run: [Serve]),
        (event: AllHeld("locks"), run: [Kick("locks")]),
        (event: Pass("gate"), run: [Score(3)]),
    ]))"#;

fn refusal(from: &str, to: &str) -> TableError {
    assert_eq!(GOOD.matches(from).count(), 1, "{from:?} must be there once");
    match Table::parse("good.ron", &GOOD.replace(from, to)) {
        Ok(_) => panic!("accepted: {to}"),
        Err(error) => error,
    }
}

#[test]
fn a_good_table_is_accepted_and_its_rules_make_balls_meet() {
    match Table::parse("good.ron", GOOD) {
        Ok(table) => {
            assert!(table.scene.multiball && table.scene.needs.ball_ball);
            assert!(table.scene.needs.hinges && table.scene.needs.saucers);
            assert_eq!((table.scene.hinges.len(), table.scene.saucers.len()), (4, 2));
        }
        Err(error) => panic!("{error}"),
    }
}

#[test]
fn every_number_out_of_range_is_refused() {
    let cases = [
        ("threshold: 0.11", ["-0.1", "101.0", "NaN"], "target", "a speed in m/s"),
        ("lever: 0.021", ["0.0", "-0.02", "inf"], "spinner", "a length in metres"),
        (
            "inertia: 2e-6, friction: 30.0",
            ["0.0, friction: 30.0", "-1.0, friction: 30.0", "NaN, friction: 30.0"],
            "spinner",
            "2e-6 kg m^2",
        ),
        ("friction: 30.0", ["0.0", "2e6", "NaN"], "spinner", "30 rad/s^2"),
        ("restitution: 0.31", ["0.0", "1.1", "NaN"], "spinner", "0.3 would be right"),
        ("lift: 1e-5", ["-1e-5", "2e3", "NaN"], "spinner", "0.0001 J"),
        ("lever: 0.022", ["0.0", "-0.02", "inf"], "gate", "a length in metres"),
        (
            "inertia: 1e-6, restitution: 0.32",
            ["0.0, restitution: 0.3", "1e9, restitution: 0.3", "NaN, restitution: 0.3"],
            "gate",
            "2e-6 kg m^2",
        ),
        ("restitution: 0.32", ["0.0", "1.1", "NaN"], "gate", "0.3 would be right"),
        ("lift: 2e-5", ["-1e-5", "2e3", "NaN"], "gate", "0.0001 J"),
        ("radius: 0.012", ["0.0", "-1.0", "inf"], "saucer", "a length in metres"),
        ("capture: 0.8", ["0.0", "101.0", "NaN"], "saucer", "0.8 m/s"),
        ("kick: (0.3, -1.2)", ["(0.0, 0.0)", "(1e3, 0.0)", "(0.0, NaN)"], "saucer", "(0.3, -1.2) would be right"),
        ("hold: 0.75", ["-0.1", "61.0", "NaN"], "saucer", "0.8 s"),
        ("center: (0.2, 0.2)", ["(2.0, 0.2)", "(0.2, NaN)", "(-inf, 0.2)"], "saucer", "not on the table"),
    ];
    for (from, values, element, says) in cases {
        let field = from.split(':').next().unwrap_or_default();
        for value in values {
            let error = refusal(from, &format!("{field}: {value}"));
            assert_eq!((error.element.as_deref(), error.field.as_deref()), (Some(element), Some(field)), "{error}");
            assert!(error.line > 0 && error.problem.contains(says), "{error}");
        }
    }
}

#[test]
fn a_target_that_always_stands_is_not_down() {
    let error = refusal("threshold: 0.11", "threshold: 0.11, down: true");
    assert_eq!((error.element.as_deref(), error.field.as_deref()), (Some("target"), Some("down")));
    assert!(error.problem.contains("a DropTarget would be right"), "{error}");
}

#[test]
fn a_plate_that_a_ball_could_lie_on_is_refused_with_the_lift_that_is_right() {
    // 0.9 of 0.08 kg x 0.8 m/s^2 x the lever.
    for (from, element, most) in
        [("lift: 1e-5", "spinner", 0.9 * 0.08 * 0.8 * 0.021), ("lift: 2e-5", "gate", 0.9 * 0.08 * 0.8 * 0.022)]
    {
        let error = refusal(from, &format!("lift: {:?}", 1.01 * most));
        assert_eq!((error.element.as_deref(), error.field.as_deref()), (Some(element), Some("lift")), "{error}");
        assert!(error.problem.contains(&format!("at most {most:.2e} J would be right")), "{error}");
        assert!(Table::parse("good.ron", &GOOD.replace(from, &format!("lift: {:?}", 0.99 * most))).is_ok());
    }
}

#[test]
fn rules_that_speak_of_the_wrong_kind_are_refused() {
    let cases = [
        ("Spin(\"spinner\")", "Spin(\"gate\")", "a Spinner would be right"),
        ("Hold(\"lock\")", "Hold(\"gate\")", "a Saucer would be right"),
        ("AllHeld(\"locks\")", "AllHeld(\"target\")", "a Saucer would be right"),
        ("Kick(\"locks\")", "Kick(\"gate\")", "a Saucer would be right"),
        ("Pass(\"gate\")", "Pass(\"target\")", "a Rollover, Gate, Spinner or Hole would be right"),
        ("Hit(\"target\")", "Hit(\"saucer\")", "something that a ball can hit"),
    ];
    for (from, to, says) in cases {
        let error = refusal(from, to);
        assert!(error.line > 0 && error.problem.contains(says), "{error}");
    }
}
