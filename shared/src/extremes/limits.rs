//! Sizes, speeds, pulls, restitutions and masses far from those of a pinball table, each against its closed form.

use glam::DVec2;

use super::cases::{self, balls, is_finite};
use super::{Check, known};
use crate::physics::motion::Motion;
use crate::physics::scene::Scene;
use crate::physics::{Event, EventKind, World};

pub(super) const CHECKS: &[Check] = &[
    Check {
        name: "gravity 0: 100 s of bounces",
        unit: "m",
        goal: 1e-9,
        known: &known::late(0.12, 0.03),
        measure: weightless,
    },
    Check {
        name: "gravity 10,000 m/s^2: 2 s of bounces",
        unit: "m",
        goal: 1e-9,
        known: &known::tunnels_late_and_chord(0.1, 0.04),
        measure: heavy,
    },
    Check {
        name: "a ball of 10 um: 5 s of bounces",
        unit: "m",
        goal: 1e-9,
        known: &known::tunnels_or_late(6e-5),
        measure: tiny,
    },
    Check {
        name: "1,000 m/s: 1 s of bounces",
        unit: "m",
        goal: 1e-9,
        known: &known::tunnels_or_late(0.6),
        measure: fast,
    },
    Check { name: "restitution 0: at rest where it falls", unit: "m", goal: 1e-12, known: &[], measure: dead },
    Check {
        name: "restitution 1.1: speed after 50 bounces",
        unit: "of it",
        goal: 1e-12,
        known: &[known::tunnels(known::LOST)],
        measure: active,
    },
    Check { name: "restitution 10: impacts in a tick", unit: "", goal: 201.0, known: &[], measure: runaway },
    Check { name: "masses 1e-6 to 1e6: momentum and energy", unit: "of it", goal: 1e-12, known: &[], measure: masses },
    Check {
        name: "masses 1 and 1e6: 3,141 impacts, as pi has it",
        unit: "off",
        goal: 0.0,
        known: &known::late(500.0, 500.0),
        measure: digits_of_pi,
    },
];

/// The only ball's place; `None` if it is lost.
pub(super) fn place(world: &World) -> Option<DVec2> {
    balls(world).next().map(|(position, ..)| position)
}

/// Steps for so many seconds. An error if a number becomes NaN or infinite.
pub(super) fn play(scene: Scene, seconds: f64) -> Result<World, String> {
    let mut world = World::new(std::sync::Arc::new(scene));
    let ticks = (seconds / world.scene().tick_seconds).round() as u64;
    for _ in 0..ticks {
        world.step();
    }
    if is_finite(&world) { Ok(world) } else { Err("a number is not finite".to_owned()) }
}

/// Where something is that moves to and fro between two walls and would be at `x` without them.
pub(super) fn folded(x: f64, low: f64, high: f64) -> f64 {
    let width = high - low;
    let way = (x - low).rem_euclid(2.0 * width);
    low + if way > width { 2.0 * width - way } else { way }
}

/// How far a weightless ball in the ideal room is from its closed form after so many seconds; infinite if it is lost.
fn off_after(scene: Scene, seconds: f64) -> Result<f64, String> {
    let (start, radius) = (scene.start[0], scene.kinds[0].radius);
    let straight = start.position + start.velocity * seconds;
    let expected = DVec2::new(folded(straight.x, radius, 1.0 - radius), folded(straight.y, radius, 1.0 - radius));
    let world = play(scene, seconds)?;
    Ok(place(&world).map_or(f64::INFINITY, |place| (place - expected).length()))
}

fn weightless(motion: Motion) -> Result<f64, String> {
    off_after(cases::room(motion, 0.0, 1.0, "(position: (0.3, 0.4), velocity: (1.3, 0.7))", ""), 100.0)
}

fn tiny(motion: Motion) -> Result<f64, String> {
    let ball = "(position: (0.3, 0.4), velocity: (1.3, 0.7), radius: 1e-5)";
    off_after(Scene { pixel: 1e-5, ..cases::room(motion, 0.0, 1.0, ball, "") }, 5.0)
}

fn fast(motion: Motion) -> Result<f64, String> {
    off_after(cases::room(motion, 0.0, 1.0, "(position: (0.3, 0.4), velocity: (800.0, 600.0))", ""), 1.0)
}

fn heavy(motion: Motion) -> Result<f64, String> {
    let (pull, top, floor, seconds) = (1e4, 0.8, 0.0135, 2.0);
    let world = play(cases::room(motion, -pull, 1.0, "(position: (0.5, 0.8))", ""), seconds)?;
    let fall = (2.0 * (top - floor) / pull).sqrt();
    // From the middle of one hop to its end and back.
    let phase = folded(seconds, 0.0, fall);
    let expected = DVec2::new(0.5, top - 0.5 * pull * phase * phase);
    Ok(place(&world).map_or(f64::INFINITY, |place| (place - expected).length()))
}

/// A ball without bounce slides along the floor into the corner.
fn dead(motion: Motion) -> Result<f64, String> {
    let world = play(cases::room(motion, -0.793, 0.0, "(position: (0.5, 0.3), velocity: (0.3, 0.0))", ""), 5.0)?;
    let corner = DVec2::new(1.0 - 0.0135, 0.0135);
    let off = |(place, velocity, _): (DVec2, DVec2, f64)| (place - corner).length() + velocity.length();
    Ok(balls(&world).next().map_or(f64::INFINITY, off))
}

/// A ball that gains a tenth in every bounce, to and fro along the room.
fn active(motion: Motion) -> Result<f64, String> {
    let scene = cases::room(motion, 0.0, 1.1, "(position: (0.3, 0.4), velocity: (1.0, 0.0))", "");
    let mut world = World::new(std::sync::Arc::new(scene));
    let (mut bounces, mut expected) = (0, 1.0);
    for _ in 0..60_000 {
        for event in world.step() {
            if let EventKind::Touched { .. } = event.kind {
                bounces += 1;
                expected *= 1.1;
                if bounces == 50 {
                    return Ok((event.velocity.length() / expected - 1.0).abs());
                }
            }
        }
    }
    Ok(f64::INFINITY)
}

/// A ball that is ten times as fast after every bounce: most impacts in a tick, over a second. Beyond what is worth
/// following it lies still for the rest of the tick.
fn runaway(motion: Motion) -> Result<f64, String> {
    let scene = cases::room(motion, 0.0, 10.0, "(position: (0.3, 0.4), velocity: (1.0, 0.7))", "");
    let mut world = World::new(std::sync::Arc::new(scene));
    let mut most = 0;
    for _ in 0..1000 {
        most = most.max(world.step().len());
        if !is_finite(&world) {
            return Err("a number is not finite".to_owned());
        }
    }
    Ok(most as f64)
}

/// Two balls head on: what is off in momentum and energy, as a share of them.
fn masses(motion: Motion) -> Result<f64, String> {
    let mut worst = 0.0;
    for power in -6_i32..=6 {
        let mass = (0..power.abs()).fold(1.0, |mass, _| if power < 0 { mass / 10.0 } else { mass * 10.0 });
        let text = format!(
            "Scene(gravity: (0.0, 0.0), bounds: (-9.0, -9.0, 9.0, 9.0), balls: [
                (position: (0.0, 0.0), mass: 1.0, velocity: (0.5, 0.1)),
                (position: (0.3, 0.006), mass: {mass:?}, velocity: (-0.5, 0.0))])"
        );
        let scene = cases::scene(&text, motion);
        let sum = |balls: &mut dyn Iterator<Item = (DVec2, f64)>| {
            balls.fold((DVec2::ZERO, 0.0), |(momentum, energy), (velocity, mass)| {
                (momentum + velocity * mass, energy + 0.5 * mass * velocity.length_squared())
            })
        };
        let before = sum(&mut scene.start.iter().map(|ball| (ball.velocity, scene.mass(ball.kind))));
        let world = play(scene.clone(), 1.0)?;
        let kinds = world.state().balls.iter().map(|ball| scene.mass(ball.kind));
        let after = sum(&mut balls(&world).map(|(_, velocity, _)| velocity).zip(kinds));
        if world.state().balls.iter().any(|ball| ball.flight.start.tick == 0) {
            return Err("they did not meet".to_owned());
        }
        // Of the momentum that there is, whatever its direction.
        let scale = 0.5 * (1.0 + mass);
        let momentum = (after.0 - before.0).length() / scale;
        let energy = (after.1 - before.1).abs() / before.1;
        worst = [momentum, energy].into_iter().fold(worst, |a, b| if b > a { b } else { a });
    }
    Ok(worst)
}

/// Whether it is an impact, and not the other ball's view of one.
fn is_first_told(event: &Event) -> bool {
    match event.kind {
        EventKind::Touched { .. } => true,
        EventKind::Met { other, .. } => event.ball < other,
        _ => false,
    }
}

/// A light ball between a wall and a ball of a million times its mass, which comes slowly: all impacts together, with ball
/// and wall, are the first digits of pi (Galperin 2003).
fn digits_of_pi(motion: Motion) -> Result<f64, String> {
    let text = "Scene(gravity: (0.0, 0.0), bounds: (-1.0, -1.0, 9.0, 9.0), balls: [
            (position: (0.15, 0.5), mass: 1.0, radius: 0.0625),
            (position: (0.4, 0.5), mass: 1e6, radius: 0.0625, velocity: (-0.001, 0.0))],
        elements: [Wall(points: [(0.0, 0.0), (0.0, 1.0)])])";
    let mut world = World::new(std::sync::Arc::new(cases::scene(text, motion)));
    let mut impacts = 0;
    for _ in 0..400_000 {
        // A meeting is told of both balls.
        impacts += world.step().iter().filter(|event| is_first_told(event)).count();
    }
    Ok((impacts as f64 - 3141.0).abs())
}
