//! NaN and infinities: refused wherever a number comes in.
//!
//! The figure of each check is the number of places that let one in.

use glam::DVec2;

use super::Check;
use super::cases::{self, is_finite};
use crate::physics::motion::Motion;
use crate::physics::{World, WorldState};
use crate::table::Table;

const UNIT: &str = "let in";

pub(super) const CHECKS: &[Check] = &[
    Check {
        name: "NaN or infinity in a table or a scene: refused",
        unit: UNIT,
        goal: 0.0,
        known: &[],
        measure: tables,
    },
    Check { name: "NaN or infinity launched or pulled: refused", unit: UNIT, goal: 0.0, known: &[], measure: inputs },
    Check { name: "NaN or infinity in a state: refused", unit: UNIT, goal: 0.0, known: &[], measure: states },
];

/// How RON writes what is no number.
const WRITTEN: [&str; 3] = ["NaN", "inf", "-inf"];

/// One of everything that has numbers.
const TABLE: &str = r#"(format: 1, physics: 3, name: "all", size: (1.0, 1.0), tick_hz: 1000, pixel: 0.001, gravity: (0.0, -0.793),
    floors: [(0.0, -2.5)],
    cabinet: (nudge: 0.06, frequency: (9.3, 5.8), damping: (0.052, 0.055), bob_length: 0.1, bob_damping: 0.05, tilt: 1.0,
        warnings: 2),
    rest_speed: 0.02, ball: (radius: 0.0135, mass: 0.08, start: (0.5, 0.9)),
    materials: { "m": (restitution: 0.8, falloff: 0.3, friction: 0.6, tangential: 0.9) },
    elements: [
        Wall(name: "wall", material: "m", points: [(0.0, 0.7), (0.0, 0.1), (0.2, 0.05)]),
        Arc(name: "arc", material: "m", center: (0.5, 0.7), radius: 0.5, from: -90.0, to: 90.0),
        Post(name: "post", material: "m", center: (0.6, 0.4), radius: 0.01),
        Ring(name: "ring", material: "m", center: (0.5, 0.5), radius: 0.9),
        Target(name: "standing", material: "m", from: (0.8, 0.8), to: (0.85, 0.8), threshold: 0.11),
        Spinner(name: "spinner", from: (0.1, 0.6), to: (0.2, 0.6), lever: 0.02, inertia: 2e-6, friction: 30.0,
            restitution: 0.3, lift: 1e-5, floor: 0),
        Gate(name: "swing", from: (0.1, 0.65), to: (0.2, 0.65), lever: 0.02, inertia: 1e-6, restitution: 0.3, lift: 2e-4,
            one_way: false),
        Saucer(name: "saucer", center: (0.8, 0.3), radius: 0.012, capture: 0.8, kick: (0.3, -1.2), hold: 0.8),
        OneWay(name: "gate", material: "m", from: (0.47, 0.83), to: (0.71, 0.76)),
        Bumper(name: "bumper", material: "m", center: (0.35, 0.55), radius: 0.03, kick: 0.8, threshold: 0.05),
        Slingshot(name: "sling", material: "m", from: (0.1, 0.3), to: (0.25, 0.15), kick: 1.3, threshold: 0.1),
        DropTarget(name: "target", material: "m", from: (0.9, 0.55), to: (0.87, 0.61), threshold: 0.1),
        Rollover(name: "rollover", from: (0.3, 0.4), to: (0.7, 0.43)),
        Hole(name: "hole", from: (0.3, 0.8), to: (0.35, 0.8), floor: 0, leads_to: 1),
        Edge(name: "edge", from: (0.4, 0.8), to: (0.45, 0.8), floors: (0, 1)),
        Magnet(name: "magnet", center: (0.5, 0.7), radius: 0.06, core: 0.012, strength: 15.0, drag: 8.0, on: false, floor: 0),
        Light(name: "light", center: (0.3, 0.3), radius: 0.01, color: Amber),
        Flipper(name: "flipper", material: "m", hand: Left, pivot: (0.35, 0.2),
            length: 0.0635, base_radius: 0.0111, tip_radius: 0.00635, rest: 120.5, raised: 70.0,
            inertia: 1.07e-4, torque: 0.58, ramp: 0.01, hold: 0.75, hold_within: 6.0, return_share: 0.041,
            stop_restitution: 0.2),
        Plunger(name: "plunger", material: "m", from: (0.477, 0.1), to: (0.511, 0.1), stroke: 0.06, mass: 0.06,
            force: 30.0, hand_speed: 0.15),
        Drain(name: "drain", from: (0.0, 0.01), to: (1.0, 0.01)),
    ],
    rules: (balls: 3, max_multiplier: 6, on: []))"#;

/// The same of a bare scene.
const SCENE: &str = r#"Scene(name: "all", gravity: (0.0, -0.793), floors: [(0.0, -2.5)], tick_hz: 1000, pixel: 0.001, ball_restitution: 0.9,
    bounds: (0.0, 0.0, 1.0, 1.0),
    balls: [(position: (0.3, 0.3), velocity: (1.0, 0.5), radius: 0.01, mass: 0.05), (position: (0.5, 0.5))],
    elements: [
        Wall(points: [(0.0, 0.0), (1.0, 0.0), (1.0, 1.0)], restitution: 0.8, floor: 0),
        Post(center: (0.7, 0.5), radius: 0.05, restitution: 0.8),
        Ring(center: (0.5, 0.5), radius: 0.6, restitution: 0.8),
        Hole(from: (0.2, 0.2), to: (0.25, 0.2), floor: 0, leads_to: 1),
        Edge(from: (0.2, 0.3), to: (0.25, 0.3), floors: (0, 1)),
    ])"#;

/// Where numbers stand in a text: not in names, and not in strings.
fn numbers(text: &str) -> Vec<(usize, usize)> {
    let bytes = text.as_bytes();
    let is_part = |byte: u8| byte.is_ascii_alphanumeric() || matches!(byte, b'.' | b'-' | b'_' | b'+');
    let (mut found, mut at, mut in_string) = (Vec::new(), 0, false);
    while at < bytes.len() {
        if bytes[at] == b'"' {
            in_string = !in_string;
        }
        let start = at;
        at += 1;
        if !in_string && is_part(bytes[start]) {
            while at < bytes.len() && is_part(bytes[at]) {
                at += 1;
            }
            if bytes[start].is_ascii_digit() || bytes[start] == b'-' {
                found.push((start, at));
            }
        }
    }
    found
}

/// The text with each of its numbers, one after the other, as each of what is no number.
fn spoiled(text: &str) -> impl Iterator<Item = String> {
    numbers(text)
        .into_iter()
        .flat_map(move |(start, end)| WRITTEN.map(|no_number| format!("{}{no_number}{}", &text[..start], &text[end..])))
}

fn tables(_motion: Motion) -> Result<f64, String> {
    let mut let_in = 0.0;
    for text in [TABLE, SCENE] {
        if let Err(error) = Table::parse("all.ron", text) {
            return Err(error.to_string());
        }
        for spoiled in spoiled(text) {
            match Table::parse("all.ron", &spoiled) {
                Ok(_) => let_in += 1.0,
                // Clear is what names the line and what would be right, or what the parser waited for.
                Err(error) if error.line == 0 || error.problem.is_empty() => return Err(format!("unclear: {error}")),
                Err(_) => {}
            }
        }
    }
    Ok(let_in)
}

const NO_NUMBERS: [f64; 3] = [f64::NAN, f64::INFINITY, f64::NEG_INFINITY];

fn inputs(motion: Motion) -> Result<f64, String> {
    let scene = cases::classic(motion).scene;
    let mut let_in = 0.0;
    for no_number in NO_NUMBERS {
        let mut world = World::new(scene.clone());
        let good = DVec2::new(0.24, 0.5);
        for bad in [DVec2::new(no_number, 0.5), DVec2::new(0.24, no_number)] {
            for (position, velocity) in [(bad, DVec2::ZERO), (good, bad)] {
                let_in += f64::from(u8::from(world.launch(0, position, velocity).is_some()));
            }
        }
        world.launch(0, DVec2::new(0.494, 0.1145), DVec2::ZERO);
        world.pull(Some(no_number));
        for _ in 0..2000 {
            world.step();
            let moved =
                world.state().plungers.iter().any(|plunger| !(plunger.pull.is_finite() && plunger.speed.is_finite()));
            if moved || !is_finite(&world) {
                let_in += 1.0;
                break;
            }
        }
    }
    Ok(let_in)
}

fn states(motion: Motion) -> Result<f64, String> {
    let mut let_in = 0.0;
    for case in cases::all(motion) {
        let mut run = case.run();
        let mut world = run.world.clone();
        for tick in 0..case.ticks {
            run.step();
            if tick % 97 == 0 {
                let text = ron::to_string(run.world.state()).map_err(|error| error.to_string())?;
                let read = |text: &str| ron::from_str::<WorldState>(text);
                let good = read(&text).map_err(|error| format!("{error}: {text}"))?;
                world.restore(good).map_err(|error| error.to_string())?;
                for spoiled in spoiled(&text) {
                    if let Ok(state) = read(&spoiled)
                        && world.restore(state).is_ok()
                    {
                        let_in += 1.0;
                    }
                }
            }
        }
    }
    Ok(let_in)
}
