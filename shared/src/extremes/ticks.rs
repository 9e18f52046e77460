//! Time: ticks of a microsecond and of a second, ten million of them, worlds of great age, speeds and pulls that are hardly
//! numbers.

use std::sync::Arc;

use glam::DVec2;

use super::cases::{self, balls, is_finite};
use super::limits::{folded, place, play};
use super::{Check, known};
use crate::physics::World;
use crate::physics::motion::Motion;
use crate::physics::scene::Scene;

pub(super) const CHECKS: &[Check] = &[
    Check {
        name: "ticks of 1 us: 0.2 s of bounces",
        unit: "m",
        goal: 1e-9,
        known: &known::late(6e-4, 6e-4),
        measure: short_ticks,
    },
    Check {
        name: "ticks of 1 s: 100 s of bounces",
        unit: "m",
        goal: 1e-9,
        known: &known::tunnels_or_late(0.5),
        measure: long_ticks,
    },
    Check {
        name: "10,000,000 ticks of bounces",
        unit: "m",
        goal: 1e-9,
        known: &known::late(2e-3, 2e-3),
        measure: many_ticks,
    },
    Check { name: "after 2^53 ticks: the same bits", unit: "runs differ", goal: 0.0, known: &[], measure: old_world },
    Check { name: "a subnormal speed: nothing moves", unit: "m", goal: 0.0, known: &[], measure: subnormal_speed },
    Check { name: "a subnormal gravity: as without", unit: "m", goal: 1e-9, known: &[], measure: subnormal_gravity },
];

/// How far a weightless ball that bounces to and fro along the room is from its closed form.
fn off(motion: Motion, tick_seconds: f64, speed: f64, seconds: f64) -> Result<f64, String> {
    let (x, radius) = (0.3, 0.0135);
    let scene = cases::room(motion, 0.0, 1.0, &format!("(position: ({x:?}, 0.4), velocity: ({speed:?}, 0.0))"), "");
    let world = play(Scene { tick_seconds, ..scene }, seconds)?;
    let expected = DVec2::new(folded(x + speed * seconds, radius, 1.0 - radius), 0.4);
    Ok(place(&world).map_or(f64::INFINITY, |place| (place - expected).length()))
}

fn short_ticks(motion: Motion) -> Result<f64, String> {
    off(motion, 1e-6, 50.0, 0.2)
}

fn long_ticks(motion: Motion) -> Result<f64, String> {
    off(motion, 1.0, 7.3, 100.0)
}

fn many_ticks(motion: Motion) -> Result<f64, String> {
    off(motion, 1e-3, 0.01, 1e4)
}

/// A world that is 2^53 ticks old, and comes to be, against one that has just begun.
fn old_world(motion: Motion) -> Result<f64, String> {
    let mut different = 0.0;
    for case in cases::all(motion) {
        let mut young = case.run();
        for _ in 0..300 {
            young.step();
        }
        let mut state = young.world.state().clone();
        let age = (1 << 53) - state.tick - 100;
        state.tick += age;
        for ball in &mut state.balls {
            ball.flight.start.tick += age;
        }
        for hinge in &mut state.hinges {
            hinge.start.tick += age;
        }
        let mut old = World::new(Arc::clone(young.world.scene()));
        old.restore(state).map_err(|error| format!("{}: {error}", case.name))?;
        let differs = (0..1000).any(|_| {
            young.world.step();
            old.step();
            !balls(&young.world).eq(balls(&old))
        });
        different += f64::from(u8::from(differs));
    }
    Ok(different)
}

/// Balls with the slowest speeds that there are, in the air and touching a wall: how far they get in 10 s.
fn subnormal_speed(motion: Motion) -> Result<f64, String> {
    let mut worst = 0.0;
    for x in [0.5, 0.0135] {
        for velocity in [(5e-324, 0.0), (-5e-324, -5e-324), (-1e-310, 3e-311)] {
            let ball = format!("(position: ({x:?}, 0.4), velocity: {velocity:?})");
            let world = play(cases::room(motion, 0.0, 1.0, &ball, &cases::furniture(1.0)), 10.0)?;
            let moved = place(&world).map_or(f64::INFINITY, |place| (place - DVec2::new(x, 0.4)).length());
            worst = if moved > worst { moved } else { worst };
        }
    }
    Ok(worst)
}

/// A pull that is hardly a number: ten seconds of bounces against those without it.
fn subnormal_gravity(motion: Motion) -> Result<f64, String> {
    let mut worst = 0.0;
    for velocity in ["(1.3, 0.7)", "(0.0, 0.0)", "(0.0, -1.0)"] {
        let after = |gravity: f64| {
            let ball = format!("(position: (0.3, 0.4), velocity: {velocity})");
            let world = play(cases::room(motion, gravity, 1.0, &ball, ""), 10.0)?;
            if is_finite(&world) { Ok(place(&world)) } else { Err("a number is not finite".to_owned()) }
        };
        for gravity in [-5e-324, 1e-310] {
            let off = match (after(gravity)?, after(0.0)?) {
                (Some(with), Some(without)) => (with - without).length(),
                _ => f64::INFINITY,
            };
            worst = if off > worst { off } else { worst };
        }
    }
    Ok(worst)
}
