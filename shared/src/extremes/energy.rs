//! Energy: without an active element it never grows, and a bounce that returns all of it loses none.

use super::cases::{self, Case, energy, is_finite};
use super::{Check, known};
use crate::math::direction;
use crate::physics::EventKind;
use crate::physics::motion::Motion;
use crate::physics::scene::{Scene, StartBall};
use glam::DVec2;

pub(super) const CHECKS: &[Check] = &[
    Check {
        name: "passive: energy gained in a bounce",
        unit: "of it",
        goal: 1e-14,
        known: &known::lifted(1e-3, 4e-4),
        measure: gained,
    },
    Check {
        name: "restitution 1: drift in 1,000 bounces",
        unit: "of it",
        goal: 1e-12,
        known: &known::late_and_chord(0.04, 0.02, 4e-5),
        measure: drift,
    },
    Check {
        name: "rolling in a bowl: drift in 10 s",
        unit: "of it",
        goal: 1e-12,
        known: &known::rolls(2e-6),
        measure: rolling,
    },
];

/// A ball slides to and fro in a bowl for 10 s: largest change of its energy.
fn rolling(motion: Motion) -> Result<f64, String> {
    let text = r#"(format: 1, physics: 3, name: "bowl", size: (1.0, 1.0), gravity: (0.0, -0.793), rest_speed: 0.02,
        ball: (radius: 0.0135, mass: 0.08, start: (0.5, 0.9)), materials: { "slick": (restitution: 0.5) },
        elements: [
            Arc(name: "bowl", material: "slick", center: (0.5, 0.7), radius: 0.3, from: 90.0, to: 270.0),
            Drain(name: "drain", from: (0.0, 0.01), to: (1.0, 0.01)),
        ],
        rules: (balls: 3, max_multiplier: 6, on: []))"#;
    let scene = cases::scene(text, motion);
    let position = DVec2::new(0.5, 0.7) + direction(2.2) * (0.3 - 0.0135);
    let start = vec![StartBall { kind: 0, position, velocity: DVec2::ZERO }];
    let case = Case { name: "bowl", scene: Scene { start, ..scene }.built(), script: Vec::new(), ticks: 10_000 };
    let mut run = case.run();
    let (start, mut worst) = (energy(&run.world), 0.0);
    for _ in 0..case.ticks {
        run.step();
        if run.world.state().balls.is_empty() {
            return Ok(f64::INFINITY);
        }
        let off = ((energy(&run.world) - start) / start).abs();
        worst = if off > worst { off } else { worst };
    }
    Ok(worst)
}

/// Passive cases: rooms of every restitution, with one ball and with two.
fn passive(motion: Motion) -> Vec<Case> {
    let one = "(position: (0.31, 0.71), velocity: (1.37, 0.43))";
    let two = "(position: (0.3, 0.7), velocity: (1.3, 0.4)), (position: (0.6, 0.8), velocity: (-0.9, -1.1), radius: 0.03, mass: 0.3)";
    let case = |balls: &str, restitution: f64| {
        let scene = cases::room(motion, -0.793, restitution, balls, &cases::furniture(restitution));
        Case { name: "room", scene, script: Vec::new(), ticks: 10_000 }
    };
    let mut cases: Vec<_> = [0.0, 0.3, 0.8, 1.0].into_iter().map(|restitution| case(one, restitution)).collect();
    cases.extend([0.5, 1.0].map(|restitution| case(two, restitution)));
    cases.extend([(0.1, 0.4), (0.9, -1.3), (-1.8, 0.2), (-0.7, -1.9)].map(|velocity| rough(motion, velocity)));
    cases
}

/// Rubber, wood and friction: a ball that spins, slips and rolls.
fn rough(motion: Motion, velocity: (f64, f64)) -> Case {
    let text = r#"(format: 1, physics: 3, name: "rough", size: (1.0, 1.0), gravity: (0.0, -0.793), rest_speed: 0.02,
        ball: (radius: 0.0135, mass: 0.08, start: (0.5, 0.9)),
        materials: {
            "wood": (restitution: 0.3, friction: 0.3),
            "rubber": (restitution: 0.8, falloff: 0.3, friction: 0.6),
            "bouncy": (restitution: 1.0, friction: 0.6),
        },
        elements: [
            Wall(name: "frame", material: "wood", points: [(0.0, 0.5), (0.0, 0.3), (0.3, 0.05), (0.7, 0.02), (1.0, 0.3), (1.0, 0.5)]),
            Arc(name: "arch", material: "bouncy", center: (0.5, 0.5), radius: 0.5, from: -90.0, to: 90.0),
            Post(name: "a", material: "bouncy", center: (0.35, 0.55), radius: 0.03),
            Post(name: "b", material: "rubber", center: (0.62, 0.62), radius: 0.03),
            Arc(name: "bowl", material: "rubber", center: (0.8, 0.3), radius: 0.15, from: 110.0, to: 230.0),
            Drain(name: "drain", from: (0.0, 0.01), to: (1.0, 0.01)),
        ],
        rules: (balls: 3, max_multiplier: 6, on: []))"#;
    let scene = cases::scene(text, motion);
    let velocity = DVec2::from(velocity);
    let start = vec![StartBall { kind: 0, position: DVec2::new(0.48, 0.8), velocity }];
    Case { name: "rough", scene: Scene { start, ..scene }.built(), script: Vec::new(), ticks: 10_000 }
}

fn is_bounce(kind: EventKind) -> bool {
    matches!(kind, EventKind::Touched { .. } | EventKind::Met { .. })
}

fn gained(motion: Motion) -> Result<f64, String> {
    let mut worst = 0.0;
    for case in passive(motion) {
        let mut run = case.run();
        // Of the fall through the room at least: what little is left at the end is not the measure.
        let scale = energy(&run.world);
        let mut before = scale;
        for _ in 0..case.ticks {
            run.step();
            if !is_finite(&run.world) {
                return Err("NaN".to_owned());
            }
            if run.world.state().balls.len() < case.scene.start.len() {
                return Ok(f64::INFINITY);
            }
            let now = energy(&run.world);
            let bounces = run.world.events().iter().filter(|event| is_bounce(event.kind)).count();
            let gain = (now - before) / scale / bounces.max(1) as f64;
            worst = if gain > worst { gain } else { worst };
            before = now;
        }
    }
    Ok(worst)
}

fn drift(motion: Motion) -> Result<f64, String> {
    let mut worst = 0.0;
    for case in passive(motion)
        .into_iter()
        .filter(|case| case.name == "room" && case.scene.colliders[0].material.restitution == 1.0)
    {
        let mut run = case.run();
        let start = energy(&run.world);
        let (mut bounces, mut ticks) = (0, 0);
        while bounces < 1000 {
            run.step();
            ticks += 1;
            bounces += run.world.events().iter().filter(|event| is_bounce(event.kind)).count();
            if run.world.state().balls.len() < case.scene.start.len() || ticks > 1_000_000 {
                return Ok(f64::INFINITY);
            }
            let off = ((energy(&run.world) - start) / start).abs();
            worst = if off > worst { off } else { worst };
        }
    }
    Ok(worst)
}
