//! What agrees to a tolerance: there and back again in time, turned, moved far away, at other tick rates.
//!
//! The figure of each check is the largest distance, m, between where a ball is and where it should be, over several throws.

use glam::DVec2;

use super::cases::{self, balls};
use super::transform::Similarity;
use super::{Check, known};
use crate::math::{Rng, direction};
use crate::physics::motion::Motion;
use crate::physics::scene::Scene;
use crate::physics::{EventKind, World};

pub(super) const CHECKS: &[Check] = &[
    Check {
        name: "five bounces and back in time",
        unit: "m",
        goal: 1e-9,
        known: &known::late_and_chord(0.6, 0.75, 2e-4),
        measure: reversed,
    },
    Check { name: "turned by an angle: bounce 5", unit: "m", goal: 1e-9, known: &[known::axes(0.4)], measure: turned },
    Check { name: "moved by 1,000 km: bounce 3", unit: "m", goal: 1e-6, known: &[], measure: moved },
    Check {
        name: "10 Hz to 100 kHz: bounce 5",
        unit: "m",
        goal: 1e-9,
        known: &known::tunnels_late_and_chord(0.75, 0.8),
        measure: rates,
    },
];

/// A throw in the room.
#[derive(Debug, Clone, Copy)]
struct Throw {
    position: DVec2,
    velocity: DVec2,
}

/// Throws from the free middle of the room.
fn throws() -> impl Iterator<Item = Throw> {
    let mut rng = Rng::new(17);
    (0..12).map(move |_| Throw {
        position: DVec2::new(rng.between(0.15, 0.55), rng.between(0.5, 0.9)),
        velocity: direction(rng.between(0.0, core::f64::consts::TAU)) * rng.between(0.5, 2.0),
    })
}

fn hall(motion: Motion, restitution: f64) -> Scene {
    let scene = cases::room(motion, -0.793, restitution, "(position: (0.5, 0.5))", &cases::furniture(restitution));
    // Balls are thrown in later.
    Scene { start: Vec::new(), ..scene }.built()
}

fn world_with(scene: &Scene, throw: Throw) -> World {
    let mut world = World::new(std::sync::Arc::new(scene.clone()));
    world.launch(0, throw.position, throw.velocity);
    world
}

/// Where the ball is at its impact of that number; `None` if it is lost or does not come so far within a minute.
fn place_of_bounce(world: &mut World, number: usize) -> Option<DVec2> {
    let mut bounces = 0;
    let ticks = (60.0 / world.scene().tick_seconds) as u64;
    for _ in 0..ticks {
        for event in world.step() {
            if let EventKind::Touched { .. } = event.kind {
                bounces += 1;
                if bounces == number {
                    return Some(event.position);
                }
            }
        }
        if world.state().balls.is_empty() {
            break;
        }
    }
    None
}

fn distance(one: Option<DVec2>, other: Option<DVec2>) -> f64 {
    match (one, other) {
        (Some(one), Some(other)) => (one - other).length(),
        _ => f64::INFINITY,
    }
}

fn largest(distances: impl Iterator<Item = f64>) -> f64 {
    distances.fold(0.0, |a, b| if b > a { b } else { a })
}

fn reversed(motion: Motion) -> Result<f64, String> {
    let scene = hall(motion, 1.0);
    let there_and_back = |throw: Throw| {
        let mut there = world_with(&scene, throw);
        place_of_bounce(&mut there, 5)?;
        let ticks = there.state().tick;
        let (position, velocity, _) = balls(&there).next()?;
        let mut back = world_with(&scene, Throw { position, velocity: -velocity });
        for _ in 0..ticks {
            back.step();
        }
        balls(&back).next().map(|(position, ..)| position)
    };
    Ok(largest(throws().map(|throw| distance(there_and_back(throw), Some(throw.position)))))
}

/// How far the bounce of that number is from where `map` says that it must be.
fn off(scene: &Scene, map: &Similarity, number: usize) -> f64 {
    let other = map.scene(scene);
    largest(throws().map(|throw| {
        let image = Throw { position: map.point(throw.position), velocity: map.vector(throw.velocity) };
        let expected = place_of_bounce(&mut world_with(scene, throw), number).map(|place| map.point(place));
        distance(place_of_bounce(&mut world_with(&other, image), number), expected)
    }))
}

fn turned(motion: Motion) -> Result<f64, String> {
    let scene = hall(motion, 0.9);
    Ok(largest([0.1, 0.7, 1.5, 2.9, 4.4].into_iter().map(|angle| off(&scene, &Similarity::turn(angle), 5))))
}

fn moved(motion: Motion) -> Result<f64, String> {
    let scene = hall(motion, 0.9);
    let shifts = [(1e6, 0.0), (0.0, -1e6), (-1e6, 1e6)];
    Ok(largest(shifts.into_iter().map(|shift| off(&scene, &Similarity::shift(DVec2::from(shift)), 3))))
}

fn rates(motion: Motion) -> Result<f64, String> {
    let scene = hall(motion, 0.9);
    let at_rate = |hertz: f64, throw: Throw| {
        let scene = Scene { tick_seconds: 1.0 / hertz, ..scene.clone() };
        place_of_bounce(&mut world_with(&scene, throw), 5)
    };
    let off = |throw: Throw| {
        let expected = at_rate(1e3, throw);
        largest([1e1, 1e2, 1e4, 1e5].into_iter().map(|hertz| distance(at_rate(hertz, throw), expected)))
    };
    Ok(largest(throws().map(off)))
}
