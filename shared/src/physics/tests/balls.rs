//! Ball against ball.

use std::sync::Arc;

use glam::DVec2;

use super::{ball, run};
use crate::math::digest_of;
use crate::physics::contact::{Body, respond_pair};
use crate::physics::happened::EventKind;
use crate::physics::motion::Motion;
use crate::physics::scene::{Material, Scene};
use crate::physics::world::World;
use crate::table::Table;

const BOX: &str = "Wall(points: [(0.0, 0.0), (0.5, 0.0), (0.5, 0.5), (0.0, 0.5), (0.0, 0.0)]),";

fn world(motion: Motion, gravity: f64, balls: &str, elements: &str) -> World {
    let text = format!("Scene(gravity: (0.0, {gravity:?}), balls: [{balls}], elements: [{elements}])");
    match Table::parse("balls.ron", &text) {
        Ok(table) => World::new(Arc::new(Scene { motion, ..(*table.scene).clone() })),
        Err(error) => panic!("{error}"),
    }
}

/// A seeded gas of unequal balls in the box.
fn gas(motion: Motion, gravity: f64) -> World {
    let balls: String = (0..12_u32)
        .map(|place| {
            let (x, y) = (0.06 + 0.12 * f64::from(place % 4), 0.06 + 0.12 * f64::from(place / 4));
            let (vx, vy) = (f64::from(place * 7 % 5) - 2.0, f64::from(place * 11 % 7) - 3.0);
            let (radius, mass) = (0.01 + 0.002 * f64::from(place % 3), 0.05 + 0.03 * f64::from(place % 4));
            format!("(position: ({x:?}, {y:?}), velocity: ({vx:?}, {vy:?}), radius: {radius:?}, mass: {mass:?}),")
        })
        .collect();
    world(motion, gravity, &balls, BOX)
}

fn energy(world: &World) -> f64 {
    let of = |index: usize| {
        let (position, velocity) = ball(world, index);
        let mass = world.scene.mass(world.state.balls[index].kind);
        mass * (0.5 * velocity.length_squared() - world.scene.gravity.dot(position))
    };
    (0..world.state.balls.len()).map(of).sum()
}

#[test]
fn equal_balls_swap_their_velocities_head_on() {
    for motion in Motion::ALL {
        let balls = "(position: (0.1, 0.25), velocity: (1.0, 0.0)), (position: (0.3, 0.25)),";
        let mut world = world(motion, 0.0, balls, "");
        let events = run(&mut world, 300);
        assert_eq!(events.len(), 2, "{motion}: {events:?}");
        assert!(matches!(events[0], EventKind::Met { other: 1, speed: 1.0 }), "{motion}: {events:?}");
        assert_eq!((ball(&world, 0).1, ball(&world, 1).1), (DVec2::ZERO, DVec2::X), "{motion}");
    }
}

/// Three balls in a row that touch: the push goes through the middle one.
#[test]
fn a_row_of_balls_hands_the_push_on() {
    let balls =
        "(position: (0.1, 0.25), velocity: (1.0, 0.0), radius: 0.0125), (position: (0.25, 0.25), radius: 0.0125),
        (position: (0.275, 0.25), radius: 0.0125), (position: (0.3, 0.25), radius: 0.0125),";
    let mut world = world(Motion::Exact, 0.0, balls, "");
    run(&mut world, 200);
    let speeds: Vec<_> = (0..4).map(|index| ball(&world, index).1.x).collect();
    for (speed, expected) in speeds.iter().zip([0.0, 0.0, 0.0, 1.0]) {
        assert!((speed - expected).abs() < 1e-12, "{speeds:?}");
    }
}

#[test]
fn a_gas_keeps_its_energy_and_nobody_passes_through_anybody() {
    for (motion, most_drift, most_overlap) in
        [(Motion::Exact, 1e-13, 1e-14), (Motion::Swept, 1e-13, 1e-14), (Motion::Pixel, 1e-12, 2e-3)]
    {
        let mut world = gas(motion, 0.0);
        let start = energy(&world);
        let mut met = 0;
        let mut deepest = 0.0_f64;
        for _ in 0..3000 {
            met += run(&mut world, 1).iter().filter(|event| matches!(event, EventKind::Met { .. })).count();
            for one in 0..12 {
                for other in 0..one {
                    let apart = (ball(&world, one).0 - ball(&world, other).0).length();
                    let reach = world.radius(one) + world.radius(other);
                    deepest = deepest.max(reach - apart);
                }
            }
        }
        let drift = (energy(&world) - start).abs() / start;
        assert_eq!(world.state.balls.len(), 12, "{motion}: none escaped");
        assert!(met > 200, "{motion}: {met} meetings");
        assert!(drift < most_drift, "{motion}: energy drifts by {drift:e}");
        assert!(deepest < most_overlap, "{motion}: {deepest:e} m deep in each other");
    }
}

#[test]
fn a_gas_goes_on_from_any_save_bit_for_bit() {
    for motion in Motion::ALL {
        let mut original = gas(motion, -1.0);
        let mut copies: Vec<World> = Vec::new();
        for tick in 0..1500 {
            if tick % 50 == 0 {
                let mut copy = World::new(Arc::clone(original.scene()));
                assert_eq!(copy.restore(original.state().clone()), Ok(()), "{motion}");
                copies.push(copy);
            }
            let events = original.step().to_vec();
            for (place, copy) in copies.iter_mut().enumerate() {
                assert_eq!(copy.step(), events, "{motion}, saved at {}, tick {tick}", place * 50);
                assert_eq!(digest_of(&copy.state), digest_of(&original.state), "{motion}, tick {tick}");
            }
        }
    }
}

/// A ball dropped onto another that lies on the floor: nothing sinks, and in the end all is at rest.
#[test]
fn a_pile_comes_to_rest_without_sinking() {
    let floor = "Wall(points: [(0.1, 0.5), (0.2, 0.1), (0.24, 0.1), (0.34, 0.5)], restitution: 0.3),";
    let balls = "(position: (0.22, 0.12)), (position: (0.21, 0.2)), (position: (0.23, 0.3)),";
    let mut world = world(Motion::Exact, -0.8, balls, floor);
    let mut scene = (*world.scene).clone();
    scene.ball_material = Material::bouncing(0.3);
    scene.rest_speed = 0.02;
    world = World::new(Arc::new(scene));
    run(&mut world, 8000);
    let before: Vec<_> = (0..3).map(|index| ball(&world, index).0).collect();
    run(&mut world, 2000);
    for (index, &was) in before.iter().enumerate() {
        let (position, velocity) = ball(&world, index);
        assert!((position - was).length() < 1e-4, "ball {index} creeps by {} m in 2 s", (position - was).length());
        assert!(velocity.length() < 0.02, "ball {index} at {velocity}");
        for other in 0..index {
            let overlap = 0.027 - (position - ball(&world, other).0).length();
            assert!(overlap < 1e-6, "balls {index} and {other} are {overlap:e} m deep in each other");
        }
    }
}

#[test]
fn friction_between_balls_keeps_momentum_and_ends_in_rolling() {
    let rubber = Material { friction: 0.6, ..Material::bouncing(0.8) };
    let one = Body { velocity: DVec2::new(0.3, -2.0), spin: 10.0, radius: 0.01, mass: 0.05 };
    let other = Body { velocity: DVec2::new(-0.1, 0.5), spin: -40.0, radius: 0.02, mass: 0.2 };
    let [(v1, w1), (v2, w2)] = respond_pair(&one, &other, DVec2::Y, &rubber, None);
    let momentum = (v1 - one.velocity) * one.mass + (v2 - other.velocity) * other.mass;
    assert!(momentum.length() < 1e-15, "{momentum}");
    let slip = (v1 - v2).x + w1 * one.radius + w2 * other.radius;
    assert!(slip.abs() < 1e-14, "they still slip by {slip}");
    // About the point where they touch each ball keeps its own angular momentum.
    for (body, velocity, spin) in [(&one, v1, w1), (&other, v2, w2)] {
        let along = if body.mass == one.mass { 1.0 } else { -1.0 };
        let turned = 0.4 * body.mass * body.radius * (spin - body.spin);
        let pushed = along * body.mass * (velocity - body.velocity).x;
        assert!((turned - pushed).abs() < 1e-15, "{turned} and {pushed}");
    }
}

/// Broke: a ball that had met too much within a tick waits for the next one; another that pressed on it met it again and
/// again, and the tick never ended.
#[test]
fn balls_that_lie_on_each_other_hold_up_no_tick() {
    let places = [(0.46, 0.36), (0.52, 0.36), (0.464, 0.41), (0.524, 0.41), (0.468, 0.46), (0.528, 0.46)];
    let balls: String = places.map(|place| format!("(position: {place:?}),")).concat();
    let hopper = "Wall(points: [(0.4, 0.9), (0.4, 0.3), (0.5, 0.25), (0.6, 0.3), (0.6, 0.9)], restitution: 0.5),";
    let scene = world(Motion::Exact, -0.793, &balls, hopper).scene;
    let mut world = World::new(Arc::new(Scene { ball_material: Material::bouncing(0.5), ..(*scene).clone() }));
    for _ in 0..1000 {
        // A meeting is told of both balls.
        assert!(world.step().len() <= 6 * 201);
    }
    for one in 0..6 {
        for other in 0..one {
            assert!((ball(&world, one).0 - ball(&world, other).0).length() > 0.027 * (1.0 - 1e-9));
        }
    }
}

/// Broke: balls without bounce met again and again for the rounding of their speeds, and stopped dead.
#[test]
fn balls_without_bounce_go_on_together_and_meet_once() {
    let mut rng = crate::math::Rng::new(6);
    for round in 0..200 {
        let mut any = || DVec2::new(rng.between(-4.0, 4.0), rng.between(-4.0, 4.0));
        let (one, other, from) = (any(), any(), any() * 0.01 + DVec2::new(0.1, 0.0));
        let meets = (one - other).normalize() * 0.1;
        let text = format!(
            "Scene(gravity: (0.0, 0.0), ball_restitution: 0.0, bounds: (-99.0, -99.0, 99.0, 99.0), balls: [
                (position: ({:?}, {:?}), velocity: ({:?}, {:?})), (position: ({:?}, {:?}), velocity: ({:?}, {:?}))])",
            from.x,
            from.y,
            one.x,
            one.y,
            from.x + meets.x,
            from.y + meets.y,
            other.x,
            other.y
        );
        let table = Table::parse("pair.ron", &text).unwrap_or_else(|error| panic!("{error}"));
        let mut world = World::new(table.scene);
        let events = run(&mut world, 1000);
        assert_eq!(events.len(), 2, "round {round}: {events:?}");
        let (a, b) = (ball(&world, 0).1, ball(&world, 1).1);
        assert!((a + b - one - other).length() < 1e-14, "round {round}: {a} and {b}");
    }
}
