//! Every mistake in a table's conditions, its ball save, its extra balls and its timed lights is refused, with rule, field and
//! what would be right.

use std::fmt::Write;

use super::{Table, TableError};

/// Good rules with one of each.
const GOOD: &str = r#"(
    format: 1, physics: 3, name: "Good", size: (0.5, 1.0), gravity: (0.0, -0.8), rest_speed: 0.02,
    ball: (radius: 0.0135, mass: 0.08, start: (0.4, 0.2)),
    materials: { "wood": (restitution: 0.3) },
    elements: [
        DropTarget(name: "drop", material: "wood", from: (0.3, 0.5), to: (0.33, 0.5), threshold: 0.1),
        Rollover(name: "lane", from: (0.1, 0.5), to: (0.15, 0.5)),
        Light(name: "light", center: (0.2, 0.2), radius: 0.01, color: Amber),
        Light(name: "again", center: (0.2, 0.3), radius: 0.01, color: Red),
        Drain(name: "drain", from: (0.0, 0.05), to: (0.5, 0.05)),
    ],
    rules: (balls: 3, max_multiplier: 6,
        max_extra_balls: 2,
        ball_save: (
            lasts: 10.0,
            saves: 3,
            grace: 1.5,
            light: "again",
        ),
        on: [
            (event: Pass("lane"), when: [
                Lit("light"),
                Up("drop"),
                OneBall,
            ], run: [
                LightFor("light", 20.0),
                SaveBalls(12.0),
                ExtraBall,
            ]),
            (event: Out("light"), run: [Score(1)]),
        ],
    ),
)"#;

fn refusal(from: &str, to: &str) -> TableError {
    assert_eq!(GOOD.matches(from).count(), 1, "{from:?} must be there once");
    match Table::parse("good.ron", &GOOD.replace(from, to)) {
        Ok(_) => panic!("accepted: {to}"),
        Err(error) => error,
    }
}

#[test]
fn good_rules_are_accepted() {
    let table = Table::parse("good.ron", GOOD).unwrap_or_else(|error| panic!("{error}"));
    let save = table.rules.ball_save.map(|save| (save.lasts, save.saves, save.grace, save.light));
    assert_eq!((save, table.rules.max_extra_balls), (Some((10.0, 3, 1.5, 0b10)), 2));
    assert!(Table::parse("good.ron", &GOOD.replace("            saves: 3,\n            grace: 1.5,\n", "")).is_ok());
    assert!(!table.scene.multiball, "one ball takes the place of another");
}

#[test]
fn every_mistake_is_refused_where_it_is() {
    for (from, to, element, field, says) in [
        ("lasts: 10.0", "lasts: 0.0", "ball save", "lasts", "10 s would be right"),
        ("lasts: 10.0", "lasts: NaN", "ball save", "lasts", "10 s would be right"),
        ("lasts: 10.0", "lasts: 601.0", "ball save", "lasts", "10 s would be right"),
        ("saves: 3", "saves: 101", "ball save", "saves", "1 would be right"),
        ("grace: 1.5", "grace: 11.0", "ball save", "grace", "2 s would be right"),
        ("light: \"again\"", "light: \"lane\"", "ball save", "light", "a Light would be right"),
        ("light: \"again\"", "light: \"nothing\"", "ball save", "light", "a Light would be right"),
        ("max_extra_balls: 2", "max_extra_balls: 8", "rules", "max_extra_balls", "1 would be right"),
        ("Lit(\"light\")", "Lit(\"drop\")", "rule 1", "when", "a Light would be right"),
        ("Up(\"drop\")", "Up(\"light\")", "rule 1", "when", "a DropTarget would be right"),
        ("Up(\"drop\")", "Unlit(\"nothing\")", "rule 1", "when", "neither an element nor a group"),
        ("\"light\", 20.0", "\"light\", 0.05", "rule 1", "run", "10 s would be right"),
        ("\"light\", 20.0", "\"light\", NaN", "rule 1", "run", "10 s would be right"),
        ("\"light\", 20.0", "\"lane\", 20.0", "rule 1", "run", "a Light would be right"),
        ("SaveBalls(12.0)", "SaveBalls(-1.0)", "rule 1", "run", "10 s would be right"),
        ("Out(\"light\")", "Out(\"drop\")", "rule 2", "event", "a Light would be right"),
    ] {
        let error = refusal(from, to);
        let line = GOOD[..GOOD.find(from).unwrap_or_default()].lines().count();
        assert_eq!((error.element.as_deref(), error.field.as_deref()), (Some(element), Some(field)), "{error}");
        assert_eq!(error.line, line, "{error}");
        assert!(error.problem.contains(says), "{to}: {error}");
    }
}

#[test]
fn what_could_never_act_is_refused() {
    let error = refusal("max_extra_balls: 2", "max_extra_balls: 0");
    assert!(error.problem.contains("`max_extra_balls` of 1 or more"), "{error}");
    let (start, end) = (GOOD.find("ball_save").unwrap_or_default(), GOOD.find("on: [").unwrap_or_default());
    let error = refusal(&GOOD[start..end], "");
    assert!(error.problem.contains("the rules have no `ball_save`"), "{error}");
}

#[test]
fn more_than_a_state_has_room_for_is_refused() {
    let error = refusal("OneBall,", &"OneBall,".repeat(15));
    assert!(error.problem.contains("17 conditions in one rule are more than 16"), "{error}");
    let (mut lights, mut names) = (String::new(), String::new());
    for place in 0..17 {
        let _ = write!(lights, "Light(name: \"l{place}\", center: (0.2, 0.2), radius: 0.01, color: Red),");
        let _ = write!(names, "\"l{place}\",");
    }
    let table = GOOD
        .replace("        Drain", &format!("{lights} Drain"))
        .replace("    rules:", &format!("groups: {{ \"many\": [{names}] }}, rules:"))
        .replace("LightFor(\"light\"", "LightFor(\"many\"");
    let error = Table::parse("good.ron", &table).expect_err("there are 17");
    assert!(error.problem.contains("17 lights that are lit for a time are more than 16"), "{error}");
}
