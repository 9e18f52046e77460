//! Geometry that goes wrong easily: no length, the same twice, circles in circles, corners with infinitely many bounces, piles.

use std::sync::Arc;

use glam::DVec2;

use super::cases::{self, balls, is_finite};
use super::limits::{folded, place, play};
use super::{Check, known};
use crate::physics::World;
use crate::physics::constants::MOST_IMPACTS_PER_TICK;
use crate::physics::motion::Motion;
use crate::physics::scene::Material;
use crate::physics::scene::Scene;

pub(super) const CHECKS: &[Check] = &[
    Check {
        name: "a wall of no length is a point",
        unit: "m",
        goal: 1e-12,
        known: &known::late(6e-4, 6e-4),
        measure: no_length,
    },
    Check { name: "everything twice: the same bits", unit: "runs differ", goal: 0.0, known: &[], measure: twice },
    Check {
        name: "between concentric circles: 20 s of bounces",
        unit: "m",
        goal: 1e-9,
        known: &known::late(0.1, 0.1),
        measure: concentric,
    },
    Check {
        name: "a gap 1 nm wider than the ball",
        unit: "m",
        goal: 1e-9,
        known: &known::late(3e-5, 3e-6),
        measure: tight,
    },
    Check {
        name: "a V: at rest where it must be",
        unit: "m",
        goal: 1e-9,
        known: &known::sunk_and_chord(2e-3, 2e-3, 1e-7),
        measure: rests_in_a_v,
    },
    Check { name: "a sharp V: in and out at the same speed", unit: "of it", goal: 1e-9, known: &[], measure: sharp_v },
    Check { name: "a V of 1 mrad: impacts in a tick", unit: "", goal: 201.0, known: &[], measure: sharpest_v },
    Check {
        name: "a pile of six balls at rest: deepest overlap",
        unit: "radii",
        goal: 1e-6,
        known: &known::sunk(5e-5, 5e-5),
        measure: pile,
    },
];

/// Head on against a point, that is part of a wall in one case, and back.
fn no_length(motion: Motion) -> Result<f64, String> {
    let points = ["(0.5, 0.4), (0.5, 0.4)", "(0.9, 0.4), (0.5, 0.4), (0.5, 0.4)"];
    let mut worst = 0.0;
    for points in points {
        let elements = format!("Wall(points: [{points}]),");
        let world =
            play(cases::room(motion, 0.0, 1.0, "(position: (0.3, 0.4), velocity: (1.0, 0.0))", &elements), 0.3)?;
        let expected = DVec2::new(2.0 * (0.5 - 0.0135) - 0.6, 0.4);
        let off = place(&world).map_or(f64::INFINITY, |place| (place - expected).length());
        worst = if off > worst { off } else { worst };
    }
    Ok(worst)
}

fn twice(motion: Motion) -> Result<f64, String> {
    let mut different = 0.0;
    for case in cases::all(motion) {
        let mut scene = case.scene.clone();
        scene.colliders.extend(case.scene.colliders.clone());
        let doubled = case.in_scene(scene.built());
        let (mut run, mut other) = (case.run(), doubled.run());
        let differs = (0..case.ticks).any(|_| {
            run.step();
            other.step();
            !balls(&run.world).eq(balls(&other.world))
        });
        different += f64::from(u8::from(differs));
    }
    Ok(different)
}

fn between_circles(motion: Motion, post: f64, ring: f64, velocity: (f64, f64)) -> Scene {
    let start = 0.5 + 0.5 * (post + ring);
    cases::room(
        motion,
        0.0,
        1.0,
        &format!("(position: ({start:?}, 0.5), velocity: {velocity:?})"),
        &format!("Post(center: (0.5, 0.5), radius: {post:?}), Ring(center: (0.5, 0.5), radius: {ring:?}),"),
    )
}

/// To and fro along a radius against the closed form; and askew, where speed and angular momentum stay.
fn concentric(motion: Motion) -> Result<f64, String> {
    let (radius, seconds) = (0.0135, 20.0);
    let world = play(between_circles(motion, 0.1, 0.3, (1.0, 0.0)), seconds)?;
    let expected = DVec2::new(folded(0.7 + seconds, 0.6 + radius, 0.8 - radius), 0.5);
    let along = place(&world).map_or(f64::INFINITY, |place| (place - expected).length());
    let velocity = DVec2::new(0.6, 0.8);
    let world = play(between_circles(motion, 0.1, 0.3, velocity.into()), seconds)?;
    let askew = balls(&world).next().map_or(f64::INFINITY, |(position, after, _)| {
        let turned = (position - DVec2::splat(0.5)).perp_dot(after) - 0.2 * velocity.y;
        turned.abs() + (after.length() - 1.0).abs()
    });
    Ok(if along > askew { along } else { askew })
}

/// A ball in a ring channel that leaves it a nanometre, fast around the post: how far it gets out of the channel.
fn tight(motion: Motion) -> Result<f64, String> {
    let scene = between_circles(motion, 0.2, 0.227_000_001, (0.0, 3.0));
    let middle = 0.5 * (0.2 + 0.227_000_001);
    let mut world = World::new(Arc::new(scene));
    let mut worst = 0.0;
    for _ in 0..1000 {
        world.step();
        let Some(place) = place(&world) else { return Ok(f64::INFINITY) };
        if !place.is_finite() {
            return Err("a number is not finite".to_owned());
        }
        let off = ((place - DVec2::splat(0.5)).length() - middle).abs() - 0.5e-9;
        worst = if off > worst { off } else { worst };
    }
    Ok(worst)
}

/// A V with its corner at (0.5, 0.3).
fn v(motion: Motion, gravity: f64, restitution: f64, half_angle: f64, ball: &str) -> Scene {
    let up = DVec2::new(libm::sin(half_angle), libm::cos(half_angle)) * 0.6;
    let (left, right) = ((0.5 - up.x, 0.3 + up.y), (0.5 + up.x, 0.3 + up.y));
    let elements = format!("Wall(points: [{left:?}, (0.5, 0.3), {right:?}], restitution: {restitution:?}),");
    cases::room(motion, gravity, restitution, ball, &elements)
}

/// Speed and distance from the place of rest after a minute, whatever the bounces: there are infinitely many of them.
fn rests_in_a_v(motion: Motion) -> Result<f64, String> {
    let mut worst = 0.0;
    for (half_angle, restitution) in [(0.3, 0.8), (0.7, 0.5), (1.2, 0.9), (0.7, 0.0)] {
        for rest_speed in [0.0, 0.02] {
            let ball = "(position: (0.51, 0.7), velocity: (0.03, 0.0))";
            let scene = v(motion, -0.793, restitution, half_angle, ball);
            let world = play(Scene { rest_speed, ..scene }, 60.0)?;
            let expected = DVec2::new(0.5, 0.3 + 0.0135 / libm::sin(half_angle));
            let off = balls(&world)
                .next()
                .map_or(f64::INFINITY, |(position, velocity, _)| (position - expected).length() + velocity.length());
            worst = if off > worst { off } else { worst };
        }
    }
    Ok(worst)
}

/// 157 bounces between the walls of a V of 20 mrad: without gravity the ball comes out as fast as it went in.
fn sharp_v(motion: Motion) -> Result<f64, String> {
    let mut worst = 0.0;
    for beside in [1e-2, 1e-3, 1e-5] {
        // Its centre moves in a V of the same angle, whose corner is 1.35 m above that of the walls.
        let scene = wide_v(motion, 0.01, beside);
        let world = play(scene, 6.0)?;
        let off = balls(&world).next().map_or(f64::INFINITY, |(_, velocity, _)| (velocity.length() - 1.0).abs());
        worst = if off > worst { off } else { worst };
    }
    Ok(worst)
}

/// A V that is long enough for its angle, with a ball that falls into it beside its middle, at 1 m/s.
fn wide_v(motion: Motion, half_angle: f64, beside: f64) -> Scene {
    let radius = 1e-3;
    let reach = 4.0 * radius / libm::sin(half_angle);
    let (x, y) = (reach * libm::sin(half_angle), reach * libm::cos(half_angle));
    let corner = radius / libm::sin(half_angle);
    let text = format!(
        "Scene(gravity: (0.0, 0.0), bounds: (-99.0, -99.0, 99.0, 99.0),
            balls: [(position: ({:?}, {:?}), velocity: (0.0, -1.0), radius: {radius:?})],
            elements: [Wall(points: [({:?}, {y:?}), (0.0, 0.0), ({x:?}, {y:?})])])",
        beside * radius,
        corner + 1.0,
        -x
    );
    Scene { pixel: 1e-4, ..cases::scene(&text, motion) }
}

/// 1,571 bounces within a fraction of a tick are more than are worth following: the work stays bounded.
fn sharpest_v(motion: Motion) -> Result<f64, String> {
    let mut world = World::new(Arc::new(wide_v(motion, 0.001, 1e-3)));
    let mut most = 0;
    for _ in 0..3000 {
        most = most.max(world.step().len());
        if !is_finite(&world) {
            return Err("a number is not finite".to_owned());
        }
    }
    Ok(most as f64)
}

/// Ticks after which a pile without friction has come to rest.
const SETTLED: u32 = 6000;

/// Six balls fall into a hopper and come to lie still: how deep they then overlap, in radii. A ball that lies on another meets
/// it without end; each may have as many impacts in a tick as are worth following, and one more.
fn pile(motion: Motion) -> Result<f64, String> {
    let places = (0..6).map(|k| {
        let (row, column) = (f64::from(k / 2), f64::from(k % 2));
        format!("(position: ({:?}, {:?})),", 0.46 + 0.06 * column + 0.004 * row, 0.36 + 0.05 * row)
    });
    let places: String = places.collect();
    let hopper = "Wall(points: [(0.4, 0.9), (0.4, 0.3), (0.5, 0.25), (0.6, 0.3), (0.6, 0.9)], restitution: 0.5),";
    let scene = cases::room(motion, -0.793, 0.5, &places, hopper);
    let scene = Scene { ball_material: Material::bouncing(0.5), rest_speed: 0.02, ..scene };
    let (balls_in_all, radius) = (scene.start.len(), scene.kinds[0].radius);
    let mut world = World::new(Arc::new(scene));
    let mut deepest = 0.0;
    for tick in 0..SETTLED + 500 {
        let impacts = world.step().len();
        if impacts > balls_in_all * (MOST_IMPACTS_PER_TICK as usize + 1) {
            return Err(format!("{impacts} impacts in a tick"));
        }
        if !is_finite(&world) {
            return Err("a number is not finite".to_owned());
        }
        let places: Vec<_> = balls(&world).map(|(position, ..)| position).collect();
        if places.len() < balls_in_all {
            return Ok(f64::INFINITY);
        }
        for (index, one) in places.iter().enumerate().filter(|_| tick >= SETTLED) {
            for other in &places[..index] {
                let overlap = (2.0 * radius - (*one - *other).length()) / radius;
                deepest = if overlap > deepest { overlap } else { deepest };
            }
        }
    }
    match balls(&world).find(|(_, velocity, _)| velocity.length() > 0.01) {
        Some((_, velocity, _)) => Err(format!("one still moves at {} m/s", velocity.length())),
        None => Ok(deepest),
    }
}
