//! Ticks of worlds that have a moving body and hardly anything else. How a ball meets one is the engine's own business,
//! so whole ticks are timed: with an impact, in the tick before (the ball is near, the search comes to nothing), with a ball
//! far away, with one that a flipper carries, and without a ball.

use std::collections::VecDeque;

use divan::Bencher;
use glam::DVec2;
use shared::math::Rng;
use shared::physics::ball::Support;
use shared::physics::flipper::FlipperRest;
use shared::physics::{Event, EventKind, World, WorldState};

use super::inputs::{Round, table};
use super::moments::{SAMPLES, SLOTS, time_second_step};

/// Which tick is timed.
#[derive(Clone, Copy)]
enum Tick {
    WithImpact,
    BallNear,
    BallFar,
    NoBall,
}

/// Ticks after which a moving body has arrived.
const STROKE: u64 = 40;
/// Where a ball is far from everything, m.
const FAR: DVec2 = DVec2::new(0.9, 0.9);
/// Where balls are aimed at is on the body's way, m.
const AIM: f64 = 0.05;

fn world(element: &str) -> World {
    let text = format!(
        r#"(format: 1, physics: 3, name: "a moving body", size: (1.0, 1.0), gravity: (0.0, -0.793), rest_speed: 0.02,
        ball: (radius: 0.0135, mass: 0.08, start: (0.9, 0.9)),
        materials: {{ "rubber": (restitution: 0.8, falloff: 0.43, friction: 0.6) }},
        elements: [{element} Drain(name: "drain", from: (0.0, 0.001), to: (1.0, 0.001))],
        rules: (balls: 3, max_multiplier: 6, on: []))"#
    );
    World::new(table(&text).scene)
}

/// Times ticks of `start`, whose body has just begun to move, with balls that meet it on its way while `is_moving`.
fn time(bencher: Bencher<'_, '_>, start: &World, middle: DVec2, tick: Tick, is_moving: impl Fn(&WorldState) -> bool) {
    let draw = |rng: &mut Rng| {
        let target = middle + DVec2::new(rng.between(-AIM, AIM), rng.between(-AIM, AIM));
        let velocity = DVec2::new(rng.between(-1.0, 1.0), rng.between(-3.0, -0.3));
        let arrives = rng.between(0.003, 0.001 * STROKE as f64);
        let mut world = start.clone();
        world.launch(0, target - velocity * arrives, velocity)?;
        // The last states, oldest first: before each of the last three ticks.
        let mut states = VecDeque::new();
        for _ in 0..STROKE {
            states.push_back(world.state().clone());
            let was_moving = is_moving(world.state());
            match world.step() {
                [] => {}
                [Event { kind: EventKind::Touched { element: 0, .. }, .. }] if was_moving && states.len() == 3 => {
                    let is_flight = states.iter().all(|state| state.balls[0].support == Support::None);
                    let place = if matches!(tick, Tick::WithImpact) { 1 } else { 0 };
                    return is_flight.then(|| states.swap_remove_back(place)).flatten();
                }
                _ => return None,
            }
            if states.len() == 3 {
                states.pop_front();
            }
        }
        None
    };
    let states = Round::drawn(draw, Option::is_some);
    let mut states: Vec<_> = states.all().iter().flatten().cloned().collect();
    for state in &mut states {
        match tick {
            Tick::NoBall => state.balls.clear(),
            Tick::BallFar => {
                state.balls[0].flight.position = FAR;
                state.balls[0].flight.velocity = DVec2::ZERO;
            }
            Tick::WithImpact | Tick::BallNear => {}
        }
    }
    time_second_step(bencher, start, &states, usize::from(matches!(tick, Tick::WithImpact)));
}

#[divan::bench_group(sample_size = SLOTS, sample_count = SAMPLES)]
mod flipper {
    use super::*;

    /// One of Classic's.
    const FLIPPER: &str = r#"Flipper(
        name: "flipper", material: "rubber", hand: Left, pivot: (0.5, 0.5),
        length: 0.0635, base_radius: 0.0111, tip_radius: 0.00635, rest: 120.5, raised: 70.0,
        inertia: 1.07e-4, torque: 0.58, ramp: 0.01, hold: 0.75, hold_within: 6.0, return_share: 0.041,
        stop_restitution: 0.2,
    ),"#;

    fn is_moving(state: &WorldState) -> bool {
        state.flippers[0].rest == FlipperRest::Moving
    }

    /// Pressed at the start.
    fn time_flipper(bencher: Bencher<'_, '_>, tick: Tick) {
        let mut start = world(FLIPPER);
        start.press(false, true);
        time(bencher, &start, DVec2::new(0.55, 0.5), tick, is_moving);
    }

    #[divan::bench]
    fn impact(bencher: Bencher<'_, '_>) {
        time_flipper(bencher, Tick::WithImpact);
    }

    #[divan::bench]
    fn ball_near(bencher: Bencher<'_, '_>) {
        time_flipper(bencher, Tick::BallNear);
    }

    #[divan::bench]
    fn ball_far(bencher: Bencher<'_, '_>) {
        time_flipper(bencher, Tick::BallFar);
    }

    /// A ball that rolled along it when it was pressed.
    #[divan::bench]
    fn ball_on(bencher: Bencher<'_, '_>) {
        let start = world(FLIPPER);
        let spec = start.scene().flippers[0].clone();
        let carries =
            |state: &WorldState| is_moving(state) && state.balls.iter().any(|ball| ball.support == Support::Flipper(0));
        let draw = |rng: &mut Rng| {
            let mut world = start.clone();
            let axis = spec.direction(0.0);
            let height = spec.base_radius + world.scene().radius(0);
            world.launch(0, spec.pivot + axis * rng.between(0.01, 0.05) + axis.perp() * height, DVec2::ZERO)?;
            for _ in 0..20 {
                world.step();
            }
            world.press(false, true);
            let mut before: Option<WorldState> = None;
            for _ in 0..STROKE {
                let state = world.state().clone();
                let is_quiet = world.step().is_empty() && carries(&state) && carries(world.state());
                if is_quiet && before.is_some() {
                    return before;
                }
                before = is_quiet.then_some(state);
            }
            None
        };
        let states = Round::drawn(draw, Option::is_some);
        let states: Vec<_> = states.all().iter().flatten().cloned().collect();
        time_second_step(bencher, &start, &states, 0);
    }

    #[divan::bench]
    fn no_ball(bencher: Bencher<'_, '_>) {
        time_flipper(bencher, Tick::NoBall);
    }
}

#[divan::bench_group(sample_size = SLOTS, sample_count = SAMPLES)]
mod plunger {
    use super::*;

    /// Classic's, let go of at the start.
    fn time_plunger(bencher: Bencher<'_, '_>, tick: Tick) {
        let mut start = world(
            r#"Plunger(
                name: "plunger", material: "rubber", from: (0.45, 0.5), to: (0.55, 0.5),
                stroke: 0.06, mass: 0.06, force: 30.0, hand_speed: 0.15,
            ),"#,
        );
        start.pull(Some(1.0));
        for _ in 0..1000 {
            start.step();
        }
        start.pull(None);
        time(bencher, &start, DVec2::new(0.5, 0.48), tick, |state| state.plungers[0].speed != 0.0);
    }

    #[divan::bench]
    fn impact(bencher: Bencher<'_, '_>) {
        time_plunger(bencher, Tick::WithImpact);
    }

    #[divan::bench]
    fn ball_near(bencher: Bencher<'_, '_>) {
        time_plunger(bencher, Tick::BallNear);
    }

    #[divan::bench]
    fn ball_far(bencher: Bencher<'_, '_>) {
        time_plunger(bencher, Tick::BallFar);
    }

    #[divan::bench]
    fn no_ball(bencher: Bencher<'_, '_>) {
        time_plunger(bencher, Tick::NoBall);
    }
}
