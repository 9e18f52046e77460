//! What the checks play: scenes, with a script of what is done when, and a run through them.

use std::sync::Arc;

use glam::DVec2;

use super::transform::Similarity;
use crate::physics::World;
use crate::physics::ball::Instant;
use crate::physics::motion::Motion;
use crate::physics::scene::Scene;
use crate::table::Table;

/// Something that is done to a world.
#[derive(Debug, Clone, Copy, PartialEq)]
pub(super) enum Act {
    /// A button.
    Press { right: bool, pressed: bool },
    /// The plunger, by a share of its stroke.
    Pull(Option<f64>),
    /// A fallen target rises.
    Raise(u16),
    /// A saucer throws its ball out.
    Kick(u16),
    /// A ball of the first kind.
    Launch { position: DVec2, velocity: DVec2 },
}

/// A scene and what is done in it, in order of ticks.
#[derive(Debug, Clone)]
pub(super) struct Case {
    pub(super) name: &'static str,
    pub(super) scene: Scene,
    pub(super) script: Vec<(u64, Act)>,
    pub(super) ticks: u64,
}

impl Case {
    /// The same as seen by `map`.
    pub(super) fn mapped(&self, map: &Similarity) -> Self {
        let act = |act: Act| match act {
            Act::Press { right, pressed } => Act::Press { right: map.right(right), pressed },
            Act::Launch { position, velocity } => {
                Act::Launch { position: map.point(position), velocity: map.vector(velocity) }
            }
            Act::Pull(_) | Act::Raise(_) | Act::Kick(_) => act,
        };
        let script = self.script.iter().map(|&(tick, what)| (tick, act(what))).collect();
        Self { scene: map.scene(&self.scene), script, ..*self }
    }

    /// The same in another scene.
    pub(super) fn in_scene(&self, scene: Scene) -> Self {
        Self { scene, ..self.clone() }
    }

    pub(super) fn run(&self) -> Run<'_> {
        Run { world: World::new(Arc::new(self.scene.clone())), script: &self.script }
    }
}

/// A case on its way.
#[derive(Debug, Clone)]
pub(super) struct Run<'a> {
    pub(super) world: World,
    script: &'a [(u64, Act)],
}

impl Run<'_> {
    /// Does what is due and steps.
    pub(super) fn step(&mut self) {
        while let Some(((tick, act), rest)) = self.script.split_first()
            && *tick <= self.world.state().tick
        {
            self.script = rest;
            match *act {
                Act::Press { right, pressed } => self.world.press(right, pressed),
                Act::Pull(hand) => self.world.pull(hand),
                Act::Raise(target) => self.world.raise(target),
                Act::Kick(saucer) => self.world.kick(saucer),
                Act::Launch { position, velocity } => {
                    self.world.launch(0, position, velocity);
                }
            }
        }
        self.world.step();
    }
}

/// Centre and velocity of every ball between two ticks, and how it spins.
pub(super) fn balls(world: &World) -> impl Iterator<Item = (DVec2, DVec2, f64)> {
    let (now, dt) = (Instant::start_of(world.state().tick), world.scene().tick_seconds);
    world.state().balls.iter().map(move |ball| {
        let (position, velocity) = ball.at(now, dt);
        (position, velocity, ball.spin_at(now, world.scene()))
    })
}

/// Whether every number of every ball is finite.
pub(super) fn is_finite(world: &World) -> bool {
    balls(world).all(|(position, velocity, spin)| position.is_finite() && velocity.is_finite() && spin.is_finite())
}

/// Energy of all balls, J, with the height of (0, 0) as that of no energy.
pub(super) fn energy(world: &World) -> f64 {
    let (scene, state) = (world.scene(), world.state());
    balls(world).zip(&state.balls).fold(0.0, |sum, ((position, velocity, spin), ball)| {
        let (radius, mass) = (scene.radius(ball.kind), scene.mass(ball.kind));
        let rim = spin * radius;
        sum + mass * (0.5 * velocity.length_squared() + 0.2 * rim * rim - scene.gravity.dot(position))
    })
}

/// A bare scene or a table, checked, with that model.
///
/// # Panics
/// If the text is wrong: it is one of this module's own.
pub(super) fn scene(text: &str, motion: Motion) -> Scene {
    match Table::parse("extremes.ron", text) {
        Ok(table) => Scene { motion, ..(*table.scene).clone() },
        Err(error) => panic!("{error}"),
    }
}

/// A square room of 1 m in which things stand.
pub(super) fn room(motion: Motion, gravity: f64, restitution: f64, balls: &str, elements: &str) -> Scene {
    let text = format!(
        "Scene(gravity: (0.0, {gravity:?}), bounds: (0.0, 0.0, 1.0, 1.0), balls: [{balls}], elements: [
            Wall(name: \"room\", points: [(0.0, 0.0), (1.0, 0.0), (1.0, 1.0), (0.0, 1.0), (0.0, 0.0)], restitution: {restitution:?}),
            {elements}])"
    );
    scene(&text, motion)
}

/// Classic, run by that model.
pub(super) fn classic(motion: Motion) -> Table {
    match Table::shipped("classic").map(|table| table.map(|table| table.run_with(Some(motion), None))) {
        Some(Ok(Ok(table))) => table,
        other => panic!("{other:?}"),
    }
}

/// Posts, a ramp and a hollow for a ball to meet; all bounce by `restitution`.
pub(super) fn furniture(restitution: f64) -> String {
    format!(
        "Post(center: (0.42, 0.38), radius: 0.05, restitution: {restitution:?}),
         Post(center: (0.71, 0.62), radius: 0.08, restitution: {restitution:?}),
         Wall(points: [(0.1, 0.31), (0.29, 0.17)], restitution: {restitution:?}),
         Wall(points: [(0.62, 0.2), (0.83, 0.27), (0.9, 0.4)], restitution: {restitution:?}),"
    )
}

/// The cases that every symmetry is tried with.
pub(super) fn all(motion: Motion) -> Vec<Case> {
    vec![one_ball(motion), two_balls(motion), parts(motion), mechanisms(motion), flippers(motion), plunge(motion)]
}

/// One ball among walls and posts, until it nearly rests.
fn one_ball(motion: Motion) -> Case {
    let ball = "(position: (0.31, 0.71), velocity: (1.37, 0.43))";
    let scene = room(motion, -0.793, 0.8, ball, &furniture(0.9));
    Case { name: "one ball", scene, script: Vec::new(), ticks: 6000 }
}

/// Two balls of different size and mass.
fn two_balls(motion: Motion) -> Case {
    let balls = "(position: (0.3, 0.7), velocity: (1.3, 0.4)), (position: (0.6, 0.8), velocity: (-0.9, -1.1), radius: 0.03, mass: 0.3)";
    let ring = "Ring(center: (0.5, 0.5), radius: 0.49, restitution: 0.97),";
    let scene = room(motion, -0.793, 0.8, balls, &(furniture(0.95) + ring));
    Case { name: "two balls", scene, script: Vec::new(), ticks: 3000 }
}

/// A table with one of everything that stands still, and friction.
fn parts(motion: Motion) -> Case {
    let text = r#"(format: 1, physics: 3, name: "parts", size: (1.0, 1.0), gravity: (0.0, -0.793), rest_speed: 0.02,
        ball: (radius: 0.0135, mass: 0.08, start: (0.5, 0.9)),
        materials: {
            "wood": (restitution: 0.3, friction: 0.3),
            "rubber": (restitution: 0.8, falloff: 0.3, friction: 0.6),
        },
        elements: [
            Wall(name: "frame", material: "wood", points: [(0.0, 0.7), (0.0, 0.1), (0.2, 0.05), (0.8, 0.05), (1.0, 0.1), (1.0, 0.7)]),
            Arc(name: "arch", material: "wood", center: (0.5, 0.7), radius: 0.5, from: -90.0, to: 90.0),
            Bumper(name: "b", material: "rubber", center: (0.35, 0.55), radius: 0.03, kick: 0.8, threshold: 0.05),
            Bumper(name: "c", material: "rubber", center: (0.62, 0.62), radius: 0.03, kick: 0.8, threshold: 0.05),
            Bumper(name: "d", material: "rubber", center: (0.52, 0.2), radius: 0.05, kick: 1.8, threshold: 0.05),
            Slingshot(name: "s", material: "rubber", from: (0.1, 0.3), to: (0.25, 0.15), kick: 1.3, threshold: 0.1),
            Arc(name: "bowl", material: "rubber", center: (0.8, 0.3), radius: 0.15, from: 110.0, to: 230.0),
            OneWay(name: "g", material: "wood", from: (0.47, 0.83), to: (0.71, 0.76)),
            OneWay(name: "h", material: "wood", from: (0.23, 0.42), to: (0.13, 0.61)),
            DropTarget(name: "t", material: "wood", from: (0.9, 0.55), to: (0.87, 0.61), threshold: 0.1),
            Rollover(name: "r", from: (0.3, 0.4), to: (0.7, 0.43)),
            Drain(name: "drain", from: (0.0, 0.01), to: (1.0, 0.01)),
        ],
        rules: (balls: 3, max_multiplier: 6, on: []))"#;
    let launches = [(0, (0.5, 0.95), (0.9, 0.1)), (900, (0.93, 0.7), (0.2, -1.5)), (1700, (0.05, 0.6), (0.4, 1.8))];
    let mut script: Vec<_> = launches
        .into_iter()
        .map(|(tick, place, speed)| (tick, Act::Launch { position: DVec2::from(place), velocity: DVec2::from(speed) }))
        .collect();
    script.push((2000, Act::Raise(0)));
    Case { name: "parts", scene: scene(text, motion), script, ticks: 3000 }
}

/// Spinners, gates, saucers and standing targets, and a second ball that passes over a saucer that holds one.
fn mechanisms(motion: Motion) -> Case {
    let text = r#"(format: 1, physics: 3, name: "mechanisms", size: (1.0, 1.0), gravity: (0.0, -0.793), rest_speed: 0.02,
        ball: (radius: 0.0135, mass: 0.08, start: (0.5, 0.9)),
        materials: { "wood": (restitution: 0.3, friction: 0.3), "rubber": (restitution: 0.8, falloff: 0.3, friction: 0.6) },
        elements: [
            Wall(name: "frame", material: "wood", points: [(0.0, 0.0), (0.0, 1.0), (1.0, 1.0), (1.0, 0.0)]),
            Spinner(name: "s", from: (0.15, 0.71), to: (0.41, 0.77), lever: 0.02, inertia: 2e-6, friction: 30.0,
                restitution: 0.3, lift: 1e-5),
            Gate(name: "g", from: (0.2, 0.52), to: (0.37, 0.48), lever: 0.03, inertia: 3e-6, restitution: 0.4, lift: 2e-4,
                one_way: true),
            Gate(name: "h", from: (0.6, 0.71), to: (0.87, 0.65), lever: 0.02, inertia: 2e-6, restitution: 0.3, lift: 4e-4,
                one_way: false),
            Saucer(name: "hole", center: (0.32, 0.3), radius: 0.035, capture: 1.9, kick: (0.31, 1.7), hold: 0.37),
            Saucer(name: "lock", center: (0.72, 0.4), radius: 0.035, capture: 1.9, kick: (-0.31, 1.7)),
            Target(name: "t", material: "rubber", from: (0.45, 0.83), to: (0.55, 0.84), threshold: 0.11),
            Drain(name: "drain", from: (0.0, 0.01), to: (1.0, 0.01)),
        ],
        rules: (balls: 3, max_multiplier: 6, on: [(event: Hold("lock"), run: [Serve])]))"#;
    let launches = [(0, (0.29, 0.66), (0.07, 1.1)), (100, (0.71, 0.85), (0.0, -0.4)), (900, (0.73, 0.6), (0.0, 1.3))];
    let mut script: Vec<_> = launches
        .into_iter()
        .map(|(tick, place, speed)| (tick, Act::Launch { position: DVec2::from(place), velocity: DVec2::from(speed) }))
        .collect();
    script.push((2500, Act::Kick(1)));
    Case { name: "mechanisms", scene: scene(text, motion), script, ticks: 4000 }
}

/// Classic: a ball towards the flippers, which are pressed and released.
fn flippers(motion: Motion) -> Case {
    let mut script = vec![(0, Act::Launch { position: DVec2::new(0.2, 0.32), velocity: DVec2::new(0.13, -0.4) })];
    for round in 0..12 {
        let tick = 60 + 170 * round;
        script.push((tick, Act::Press { right: round % 3 == 1, pressed: true }));
        script.push((tick + 70, Act::Press { right: round % 3 != 2, pressed: true }));
        script.push((tick + 130, Act::Press { right: false, pressed: false }));
        script.push((tick + 140, Act::Press { right: true, pressed: false }));
    }
    Case { name: "classic, flippers", scene: (*classic(motion).scene).clone(), script, ticks: 2400 }
}

/// Classic: a ball is launched by the plunger.
fn plunge(motion: Motion) -> Case {
    let start = DVec2::new(0.494, 0.1145);
    let script = vec![
        (0, Act::Launch { position: start, velocity: DVec2::ZERO }),
        (10, Act::Pull(Some(0.85))),
        (700, Act::Pull(None)),
    ];
    Case { name: "classic, plunger", scene: (*classic(motion).scene).clone(), script, ticks: 2400 }
}
