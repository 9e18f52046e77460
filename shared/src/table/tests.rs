//! Every kind of mistake in a table is refused, with the line, the element and the field to blame, and what would be
//! right. The mistakes are small edits of a good table.

use super::{MOST_TEXT, SHIPPED, Table, TableError};
use crate::physics::MOST_PARTS;

/// A good table with one of everything.
const GOOD: &str = r#"(
    format: 1,
    physics: 3,
    name: "Good",
    size: (0.5, 1.0),
    gravity: (0.0, -0.8),
    rest_speed: 0.02,
    materials: {
        "rubber": (restitution: 0.8, falloff: 0.3, friction: 0.6),
        "wood": (restitution: 0.3),
    },
    elements: [
        Wall(name: "wall", material: "wood", points: [
            (0.0, 0.0),
            (0.0, 0.5),
            (0.0, 1.0),
        ]),
        Arc(
            name: "arc", material: "wood",
            center: (0.25, 0.75), radius: 0.25,
            from: -90.0,
            to: 90.0,
        ),
        Post(name: "post", material: "rubber", center: (0.2, 0.6), radius: 0.01),
        OneWay(name: "gate", material: "wood", from: (0.3, 0.6), to: (0.35, 0.6)),
        Bumper(name: "bumper", material: "rubber", center: (0.2, 0.7), radius: 0.02, kick: 0.8, threshold: 0.05),
        Slingshot(name: "sling", material: "rubber", from: (0.1, 0.3), to: (0.1, 0.4), kick: 1.3, threshold: 0.1),
        DropTarget(name: "drop", material: "wood", from: (0.3, 0.5), to: (0.33, 0.5), threshold: 0.1),
        Rollover(name: "rollover", from: (0.1, 0.5), to: (0.15, 0.5)),
        Flipper(
            name: "flipper", material: "rubber", hand: Left, pivot: (0.15, 0.16),
            length: 0.06, base_radius: 0.011, tip_radius: 0.006, rest: 120.0,
            raised: 70.0,
            inertia: 1e-4, torque: 0.5, ramp: 0.01, hold: 0.75, hold_within: 6.0, return_share: 0.04,
            stop_restitution: 0.2,
        ),
        Plunger(
            name: "plunger", material: "wood", from: (0.45, 0.1), to: (0.49, 0.1),
            stroke: 0.06, mass: 0.06, force: 30.0, hand_speed: 0.15,
        ),
        Light(name: "light", center: (0.2, 0.2), radius: 0.01, color: Amber),
        Drain(name: "drain", from: (0.0, 0.05), to: (0.5, 0.05)),
    ],
    groups: {
        "all": ["post", "bumper"],
    },
    ball: (
        radius: 0.0135,
        mass: 0.08,
        start: (0.47, 0.12),
    ),
    rules: (
        balls: 3,
        max_multiplier: 6,
        on: [
            (event: BallStart, run: [Unlight("light"), Raise("drop")]),
            (
                event: Hit("all"),
                run: [
                    Score(100),
                    Light("light"),
                    Message("HIT"),
                ],
            ),
            (event: AllDown("drop"), run: [Bonus(5)]),
            (event: Pass("rollover"), run: [RaiseMultiplier]),
            (event: AllLit("light"), run: [Score(5)]),
            (event: BallEnd, run: [CollectBonus]),
        ],
        crowd: (
            energy_per_second: 0.5,
            most_energy: 30.0,
            points_per_ball: 20000,
            actions: [
                (
                    name: "FENCE", cost: 9.0, announce: 2.5, lasts: 6.5, cool_down: 15.0, points: 2000,
                    run: [Lower("drop")],
                    undo: [Message("GONE")],
                ),
                (name: "DARK", cost: 1.0, announce: 1.5, lasts: 3.5, dims: true),
            ],
        ),
    ),
)"#;

/// An edit of [`GOOD`] and the error that it must lead to.
struct Case {
    /// This, which is there once ...
    from: &'static str,
    /// ... becomes this.
    to: &'static str,
    /// The error's line is where this stands first, from the edit on; empty: no line is to blame.
    at: &'static str,
    element: Option<&'static str>,
    field: Option<&'static str>,
    /// Part of the problem's text.
    says: &'static str,
}

const fn case(
    from: &'static str,
    to: &'static str,
    at: &'static str,
    (element, field): (&'static str, &'static str),
    says: &'static str,
) -> Case {
    const fn named(name: &'static str) -> Option<&'static str> {
        if name.is_empty() { None } else { Some(name) }
    }
    Case { from, to, at, element: named(element), field: named(field), says }
}

const CASES: &[Case] = &[
    // What the parser refuses.
    case("format: 1,", "format: 1,, ", ",,", ("", ""), "identifier"),
    case("stroke: 0.06,", "stroke: 0.06, colour: 3,", "stroke", ("plunger", "colour"), "expected one of `name`"),
    case("size: (0.5, 1.0),", "size: (0.5, 1.0), tilt: 3,", "size", ("", "tilt"), "expected one of `format`"),
    case("radius: 0.01, color: Amber", "color: Amber", "Light", ("light", "radius"), "missing field"),
    case("color: Amber", "color: Mauve", "Mauve", ("light", ""), "expected one of `Amber`"),
    case("        Post(", "        Blob(", "Blob", ("", ""), "expected one of `Wall`"),
    case("hand: Left", "hand: 3", "hand", ("flipper", ""), ""),
    case("radius: 0.02, kick", "radius: \"big\", kick", "Bumper", ("bumper", ""), "float"),
    case("radius: 0.02, kick", "radius: 0.02, radius: 0.03, kick", "Bumper", ("bumper", "radius"), "duplicate"),
    case("\"wood\": (", "\"rubber\": (", "\"rubber\"", ("", ""), "\"rubber\" is there twice; names must differ"),
    // Versions.
    case("format: 1", "format: 2", "format", ("", "format"), "this program knows version 1"),
    case("physics: 3", "physics: 7", "physics", ("", "physics"), "this program knows version 3"),
    // The table's own numbers. The ball comes after elements that have a radius, too.
    case("name: \"Good\"", "name: \"\"", "name", ("", "name"), "1 to 40 printable characters"),
    case("size: (0.5, 1.0)", "size: (0.5, 0.0)", "size", ("", "size"), "(0.514, 1.067) metres would be right"),
    case("rest_speed: 0.02", "rest_speed: 0.0", "rest_speed", ("", "rest_speed"), "0.02 m/s would be right"),
    case("gravity: (0.0, -0.8)", "gravity: (NaN, -0.8)", "gravity", ("", "gravity"), "m/s^2 would be right"),
    case("rest_speed: 0.02", "tick_hz: 0, rest_speed: 0.02", "tick_hz", ("", "tick_hz"), "1000 would be right"),
    case("radius: 0.0135", "radius: -0.0135", "radius", ("ball", "radius"), "0.0135 m would be right"),
    case("mass: 0.08", "mass: 0.0", "mass", ("ball", "mass"), "0.08 kg would be right"),
    case("start: (0.47, 0.12)", "start: (0.47, NaN)", "start", ("ball", "start"), "not on the table"),
    // Materials.
    case("(restitution: 0.3)", "(restitution: 1.5)", "restitution", ("wood", "restitution"), "0.8 would be right"),
    case("falloff: 0.3", "falloff: -inf", "falloff", ("rubber", "falloff"), "0.3 s/m would be right"),
    case("friction: 0.6", "friction: -1.0", "friction", ("rubber", "friction"), "0.6 would be right"),
    case("\"wood\": (", "\"wood\\u{7}\": (", "wood", ("wood\u{7}", ""), "printable characters"),
    // Elements.
    case(
        "\"post\", material: \"rubber\"",
        "\"post\", material: \"rubbr\"",
        "Post",
        ("post", "material"),
        "there are: rubber, wood",
    ),
    case(
        "center: (0.2, 0.6)",
        "center: (NaN, 0.6)",
        "center",
        ("post", "center"),
        "(x, y) within (0, 0) to (0.5, 1.0)",
    ),
    case("center: (0.2, 0.6)", "center: (0.2, 1.2)", "center", ("post", "center"), "not on the table"),
    case("            (0.0, 1.0),\n", "            (0.0, inf),\n", "inf", ("wall", "points"), "not on the table"),
    case(
        "            (0.0, 0.5),\n",
        "            (0.0, 0.0),\n",
        "(0.0, 0.0)",
        ("wall", "points"),
        "they must differ",
    ),
    case("from: (0.3, 0.6), to: (0.35, 0.6)", "from: (0.3, 0.6), to: (0.3, 0.6)", "to", ("gate", "to"), "differ"),
    case("from: (0.1, 0.5)", "from: (0.15, 0.5)", "from", ("rollover", "to"), "differ"),
    case("radius: 0.25,", "radius: -0.25,", "radius", ("arc", "radius"), "a length in metres"),
    case("radius: 0.02, kick", "radius: inf, kick", "radius", ("bumper", "radius"), "a length in metres"),
    case("from: -90.0", "from: NaN", "from", ("arc", "from"), "an angle in degrees such as -90"),
    case("to: 90.0", "to: -90.0", "to", ("arc", "to"), "an angle clockwise of `from`"),
    case("to: 90.0", "to: 271.0", "to", ("arc", "to"), "within -89.999 to 270"),
    case("kick: 1.3", "kick: -1.3", "kick", ("sling", "kick"), "a speed in m/s"),
    case("threshold: 0.05", "threshold: NaN", "threshold", ("bumper", "threshold"), "a speed in m/s"),
    case("raised: 70.0", "raised: 121.0", "raised", ("flipper", "raised"), "an angle below `rest`"),
    case("tip_radius: 0.006", "tip_radius: 0.012", "tip_radius", ("flipper", "base_radius"), "not within 0.012"),
    case("inertia: 1e-4", "inertia: 0.0", "inertia", ("flipper", "inertia"), "kg m^2 would be right"),
    case(
        "stop_restitution: 0.2",
        "stop_restitution: 1.0",
        "stop",
        ("flipper", "stop_restitution"),
        "0.2 would be right",
    ),
    case("pivot: (0.15, 0.16)", "pivot: (-1.0, 0.16)", "pivot", ("flipper", "pivot"), "not on the table"),
    case("force: 30.0", "force: 0.0", "force", ("plunger", "force"), "30 N would be right"),
    case("radius: 0.01, color", "radius: 0.0, color", "radius", ("light", "radius"), "a length in metres"),
    // Names.
    case("name: \"gate\"", "name: \"post\"", "OneWay", ("post", "name"), "element 3 of the list has this name, too"),
    case("name: \"gate\"", "name: \"\"", "OneWay", ("", "name"), "1 to 40 printable characters"),
    case(
        "name: \"gate\"",
        "name: \"a gate with a name that is too long to be shown\"",
        "OneWay",
        ("a gate with a name that is too long to be shown", "name"),
        "1 to 40 printable characters",
    ),
    case("name: \"gate\"", "name: \"ga\\nte\"", "OneWay", ("ga\nte", "name"), "\"ga\\nte\" is not 1 to 40 printable"),
    // The whole.
    case(
        "        Drain(name: \"drain\", from: (0.0, 0.05), to: (0.5, 0.05)),\n",
        "",
        "",
        ("", "elements"),
        "there is no Drain",
    ),
    // Groups.
    case("\"bumper\"],", "\n\"bumpr\"],", "\"bumpr\"", ("all", ""), "\"bumpr\" is no element"),
    case("\"bumper\"],", "\n\"post\"],", "\"post\"],", ("all", ""), "\"post\" is in the group twice"),
    case("\"all\": [", "\"drop\": [", "\"drop\"", ("drop", ""), "has the name of an element"),
    // Rules.
    case("balls: 3", "balls: 0", "balls", ("rules", "balls"), "3 would be right"),
    case("max_multiplier: 6", "max_multiplier: 0", "max", ("rules", "max_multiplier"), "6 would be right"),
    case("Hit(\"all\")", "Hit(\"al\")", "event", ("rule 2", "event"), "\"al\" is neither an element nor a group"),
    case(
        "Hit(\"all\")",
        "Hit(\"light\")",
        "event",
        ("rule 2", "event"),
        "something that a ball can hit would be right",
    ),
    case(
        "Pass(\"rollover\")",
        "Pass(\"drop\")",
        "Pass",
        ("rule 4", "event"),
        "a Rollover, Gate, Spinner or Hole would be right",
    ),
    case(
        "AllLit(\"light\")",
        "AllLit(\"all\")",
        "AllLit",
        ("rule 5", "event"),
        "\"post\" of the group \"all\" is of the wrong kind; a Light",
    ),
    case("AllDown(\"drop\")", "AllDown(\"post\")", "AllDown", ("rule 3", "event"), "a DropTarget would be right"),
    case("      Light(\"light\")", "      Light(\"drop\")", "Light", ("rule 2", "run"), "a Light would be right"),
    case("Raise(\"drop\")", "Raise(\"nobody\")", "Raise", ("rule 1", "run"), "a DropTarget would be right"),
    case("Score(100)", "Score(2000000000)", "Score", ("rule 2", "run"), "more than 1000000000"),
    case("Message(\"HIT\")", "Message(\"\")", "Message", ("rule 2", "run"), "1 to 40 printable characters"),
    // The crowd.
    case(
        "energy_per_second: 0.5",
        "energy_per_second: 0.0",
        "energy",
        ("crowd", "energy_per_second"),
        "1 would be right",
    ),
    case("energy_per_second: 0.5", "energy_per_second: NaN", "energy", ("crowd", "energy_per_second"), "NaN is not"),
    case("most_energy: 30.0", "most_energy: 1801.0", "most", ("crowd", "most_energy"), "0 to 1800; 20 would be right"),
    case("points_per_ball: 20000", "points_per_ball: 2000000000", "points", ("crowd", "points_per_ball"), "more than"),
    case("\"FENCE\"", "\"DARK\"", "(name: \"DARK\"", ("crowd action 2", "name"), "names must differ"),
    case("\"FENCE\"", "\"\"", "name", ("crowd action 1", "name"), "1 to 40 printable characters"),
    case("cost: 9.0", "cost: 31.0", "cost", ("crowd action 1", "cost"), "8, or a larger `most_energy`, would be right"),
    case("announce: 2.5", "announce: 0.0", "announce", ("crowd action 1", "announce"), "2 s would be right"),
    case("lasts: 6.5", "lasts: 61.0", "lasts", ("crowd action 1", "lasts"), "6 s would be right"),
    case(
        "(\n                    name: \"FENCE\", cost: 9.0, announce: 2.5, lasts: 6.5,",
        "(\n                    name: \"FENCE\", cost: 9.0, announce: 2.5,",
        "(",
        ("crowd action 1", "lasts"),
        "it would be over at once; 6 s would be right",
    ),
    case("lasts: 3.5, ", "", "(name", ("crowd action 2", "lasts"), "it would be over at once; 6 s would be right"),
    case("cool_down: 15.0", "cool_down: -1.0", "cool", ("crowd action 1", "cool_down"), "15 s would be right"),
    case("points: 2000,", "points: 2000000000,", "points", ("crowd action 1", "points"), "more than 1000000000"),
    case("Lower(\"drop\")", "Lower(\"light\")", "Lower", ("crowd action 1", "run"), "a DropTarget would be right"),
    case("Lower(\"drop\")", "Score(5)", "Score", ("crowd action 1", "run"), "Raise, Lower, Kick"),
    case("Message(\"GONE\")", "Serve", "Serve", ("crowd action 1", "undo"), "Raise, Lower, Kick"),
    case(", dims: true", "", "(name", ("crowd action 2", "run"), "`dims: true`, would be right"),
    case("dims: true", "dims: true, glow: 3", "(name", ("DARK", "glow"), "expected one of `name`"),
    case("Message(\"HIT\")", "Shout(\"HIT\")", "Shout", ("", ""), "expected one of `Score`"),
];

fn error_of(text: &str) -> TableError {
    match Table::parse("good.ron", text) {
        Ok(_) => panic!("accepted: {text}"),
        Err(error) => error,
    }
}

fn line_at(text: &str, position: usize) -> usize {
    1 + text[..position].matches('\n').count()
}

#[test]
fn a_good_table_and_every_shipped_one_are_accepted() {
    assert_eq!(Table::parse("good.ron", GOOD).map(|table| table.name), Ok("Good".to_owned()));
    for shipped in SHIPPED {
        if let Some(Err(error)) = Table::shipped(shipped.name) {
            panic!("{error}");
        }
        let can_be_shown =
            |text: &str, most| (1..=most).contains(&text.len()) && text.chars().all(|c| matches!(c, ' '..='~'));
        assert!(can_be_shown(shipped.about, 60), "{}", shipped.name);
        assert!(shipped.aims.iter().all(|aim| can_be_shown(aim, 120)), "{}", shipped.name);
    }
    assert_eq!(Table::shipped("no such table"), None);
}

#[test]
fn every_mistake_is_refused_with_place_and_remedy() {
    for case in CASES {
        assert_eq!(GOOD.matches(case.from).count(), 1, "{:?} must be in the good table once", case.from);
        let edit = GOOD.find(case.from).unwrap_or_default();
        let text = GOOD.replace(case.from, case.to);
        let error = error_of(&text);
        let line_start = text[..edit].rfind('\n').unwrap_or_default();
        let found = text[line_start..].find(case.at).map(|at| line_at(&text, line_start + at));
        let line = if case.at.is_empty() {
            line_at(&text, text.find("elements:").unwrap_or_default())
        } else {
            found.unwrap_or_default()
        };
        let what = format!("{:?} instead of {:?}: {error}", case.to, case.from);
        assert_eq!(error.file, "good.ron", "{what}");
        assert_eq!(error.line, line, "{what}");
        assert_eq!(error.element.as_deref(), case.element, "{what}");
        assert_eq!(error.field.as_deref(), case.field, "{what}");
        assert!(error.problem.contains(case.says), "{what}\n  does not say {:?}", case.says);
    }
}

#[test]
fn an_error_reads_as_one_line_with_its_place_first() {
    let error = error_of(&GOOD.replace("radius: 0.0135", "radius: NaN"));
    assert_eq!(
        error.to_string(),
        format!(
            "good.ron:{}: \"ball\": field `radius`: NaN is not within 0.00001 to 0.25; 0.0135 m would be right",
            line_at(GOOD, GOOD.find("radius: 0.0135").unwrap_or_default())
        )
    );
    let error = error_of(&GOOD.replace("name: \"gate\"", "name: \"ga\\nte\""));
    assert_eq!(error.to_string().lines().count(), 1, "{error}");
}

#[test]
fn too_many_lights_targets_elements_points_or_bytes_are_refused() {
    let more = |what: &str, of: &str| {
        GOOD.replace("        Drain(", &(what.to_owned() + "\n        Drain(")).replace("NAME", of)
    };
    let many = |count: usize, what: &str| {
        let all: String = (0..count).map(|place| what.replace("NAME", &format!("n{place}"))).collect();
        error_of(&more(&all, ""))
    };
    let light = "Light(name: \"NAME\", center: (0.1, 0.1), radius: 0.01, color: Red),";
    let target = "DropTarget(name: \"NAME\", material: \"wood\", from: (0.1, 0.5), to: (0.2, 0.5), threshold: 0.1),";
    let post = "Post(name: \"NAME\", material: \"wood\", center: (0.1, 0.5), radius: 0.01),";
    let line = line_at(GOOD, GOOD.find("elements:").unwrap_or_default());
    for (error, says) in [
        (many(MOST_PARTS, light), "65 elements of the kind Light are more than 64"),
        (many(MOST_PARTS, target), "65 elements of the kind DropTarget are more than 64"),
        (many(2000, post), "2012 elements are more than 2000"),
    ] {
        assert_eq!((error.line, error.problem.as_str()), (line, says));
    }
    let points: String = (0..501).map(|place| format!("({}, 0.5),", f64::from(place) * 1e-4)).collect();
    let error = error_of(&more(&format!("Wall(name: \"long\", material: \"wood\", points: [{points}]),"), ""));
    assert_eq!(error.problem, "501 points; 2 to 500 would be right");

    let error = error_of(&(GOOD.to_owned() + &" ".repeat(MOST_TEXT)));
    assert_eq!(error.line, 0);
    assert!(error.problem.contains("more than the 262144 that it may have"), "{error}");
}

#[test]
fn a_crowd_has_one_action_up_to_eight() {
    let line = line_at(GOOD, GOOD.find("actions: [").unwrap_or_default());
    let (before, rest) = GOOD.split_once("actions: [").unwrap_or_default();
    let (_, after) = rest.split_once("\n            ],").unwrap_or_default();
    let with = |count: usize| {
        let action = |place| format!("(name: \"{place}\", cost: 1.0, announce: 1.0, run: [Raise(\"drop\")]),");
        format!("{before}actions: [{}],{after}", (0..count).map(action).collect::<String>())
    };
    for count in [0, 9] {
        let error = error_of(&with(count));
        assert_eq!((error.line, error.field.as_deref()), (line, Some("actions")), "{error}");
        assert_eq!(error.problem, format!("{count} actions; 1 to 8 would be right"));
    }
    assert!(Table::parse("good.ron", &with(8)).is_ok());
}

#[test]
fn a_table_cut_off_or_mangled_anywhere_is_refused_without_a_panic() {
    for end in (0..GOOD.len()).filter(|&end| GOOD.is_char_boundary(end)) {
        let error = error_of(&GOOD[..end]);
        assert!(error.line <= line_at(GOOD, end), "{error}");
    }
    let mut rng = crate::math::Rng::new(1);
    for _ in 0..2000 {
        let mut bytes = GOOD.as_bytes().to_vec();
        for _ in 0..3 {
            let at = rng.bits() as usize % bytes.len();
            bytes[at] = b"()[]{}\",:/*#r09.-x\n"[rng.bits() as usize % 19];
        }
        if let Err(error) = Table::parse("mangled.ron", &String::from_utf8_lossy(&bytes)) {
            assert!(!error.problem.is_empty());
        }
    }
}

/// What a scene gets wrong is told like what a table does.
#[test]
fn mistakes_in_a_scene_are_refused_with_place_and_remedy() {
    let good = "Scene(\n gravity: (0.0, -1.0),\n balls: [(position: (0.5, 0.5)), (position: (0.2, 0.5))],\n elements: [\n  Wall(points: [(0.0, 0.0), (1.0, 0.0)]),\n  Post(center: (0.5, 0.2), radius: 0.1, restitution: 0.5),\n ],\n)";
    assert!(Table::parse("scene.ron", good).is_ok());
    for (from, to, line, says) in [
        ("-1.0)", "NaN)", 2, "m/s^2 would be right"),
        ("(0.2, 0.5)", "(0.51, 0.5)", 3, "it overlaps ball 1"),
        ("(0.2, 0.5)", "(0.2, inf)", 3, "is no place"),
        ("(0.2, 0.5))", "(0.2, 0.5), radius: 0.0)", 3, "0.0135 m would be right"),
        ("(0.2, 0.5))", "(0.2, 0.5), mass: NaN)", 3, "0.08 kg would be right"),
        ("(0.2, 0.5))", "(0.2, 0.5), velocity: (1e300, 0.0))", 3, "m/s would be right"),
        ("(0.2, 0.5))", "(0.2, 0.5), spin: 1.0)", 3, "Unexpected field"),
        ("(1.0, 0.0)]", "(1.0, 1e300)]", 5, "is no place"),
        ("(0.0, 0.0), (1.0, 0.0)", "(0.0, 0.0)", 5, "2 to 500 would be right"),
        ("radius: 0.1,", "radius: 0.35,", 3, "would overlap \"post 2\""),
        ("restitution: 0.5", "restitution: -0.5", 6, "0.8 would be right"),
        ("Post(", "Bumper(", 6, "expected one of `Wall`"),
        ("gravity: (0.0, -1.0)", "tick_hz: 0, gravity: (0.0, -1.0)", 2, "1000 would be right"),
        ("gravity: (0.0, -1.0)", "bounds: (1.0, 0.0, 0.0, 1.0), gravity: (0.0, -1.0)", 2, "would be right"),
        (
            "gravity: (0.0, -1.0)",
            "bounds: (0.0, 0.0, 0.1, 1.0), gravity: (0.0, -1.0)",
            3,
            "beyond the scene's `bounds`",
        ),
        ("gravity: (0.0, -1.0)", "motion: Fast, gravity: (0.0, -1.0)", 2, "expected one of"),
    ] {
        let error = Table::parse("scene.ron", &good.replacen(from, to, 1)).expect_err(to);
        assert_eq!(error.line, line, "{to}: {error}");
        assert!(error.to_string().contains(says), "{to}: {error}");
    }
}

/// A ball that was served within a bumper stayed there.
#[test]
fn a_ball_is_not_served_within_something() {
    let classic = SHIPPED[0].source;
    let text = classic.replace("start: (0.494, 0.1145)", "start: (0.19, 0.765)");
    let error = Table::parse("inside.ron", &text).expect_err("bumper 1 is there");
    assert_eq!(
        (error.line, error.field.as_deref()),
        (text[..text.find("start:").unwrap()].lines().count(), Some("start"))
    );
    assert!(error.problem.contains("bumper 1") && error.problem.contains("would be right"), "{error}");
}

/// Broke: of a coordinate and NaN the coordinate is the larger, so that a scene's wall went to nowhere, or a ball began there.
#[test]
fn a_point_with_one_coordinate_that_is_no_number_is_refused() {
    for (place, wall) in [("(NaN, 0.5)", "(0.0, 0.0)"), ("(0.5, NaN)", "(0.0, 0.0)"), ("(0.5, 0.5)", "(NaN, 0.0)")] {
        let text = format!(
            "Scene(gravity: (0.0, 0.0), balls: [(position: {place})], elements: [Wall(points: [{wall}, (0.3, 0.2)])])"
        );
        let error = Table::parse("scene.ron", &text).expect_err("it has no place");
        assert!(error.problem.contains("no place"), "{error}");
    }
}
