//! Saucers.

use glam::DVec2;

use super::{ball, launch, run, support, world_with};
use crate::math::digest_of;
use crate::physics::ball::Support;
use crate::physics::happened::EventKind;
use crate::physics::motion::Motion;
use crate::physics::world::World;

const DOWN: DVec2 = DVec2::new(0.0, -0.793);

/// A saucer in the middle that throws up and to the right.
fn saucer(hold: &str) -> String {
    format!("Saucer(name: \"s\", center: (0.5, 0.5), radius: 0.012, capture: 0.8, kick: (0.2, 1.3){hold}),")
}

fn with_motion(gravity: DVec2, elements: &str, motion: Motion) -> World {
    let mut world = world_with(gravity, elements);
    std::sync::Arc::make_mut(&mut world.scene).motion = motion;
    world
}

#[test]
fn a_slow_ball_is_caught_held_and_thrown_out_and_a_fast_one_passes_over() {
    for motion in Motion::ALL {
        let mut world = with_motion(DOWN, &saucer(", hold: 0.25"), motion);
        launch(&mut world, DVec2::new(0.495, 0.53), DVec2::new(0.0, -0.3));
        let mut caught = None;
        let mut out = None;
        for _ in 0..1000 {
            for event in world.step() {
                match event.kind {
                    EventKind::Held { element: 0 } => caught = Some(event.at),
                    EventKind::Ejected { element: 0 } => out = Some(event.at),
                    _ => {}
                }
            }
        }
        let (caught, out) = (caught.expect("it is caught"), out.expect("it comes out"));
        assert_eq!((out.tick - caught.tick, out.offset), (250, 0.0), "{motion}");

        let mut world = with_motion(DVec2::ZERO, &saucer(", hold: 0.25"), motion);
        launch(&mut world, DVec2::new(0.495, 0.55), DVec2::new(0.03, -0.81));
        assert_eq!(run(&mut world, 200), [], "{motion}");
        assert_eq!(ball(&world, 0).1, DVec2::new(0.03, -0.81), "{motion}: unharmed");
    }
}

#[test]
fn one_without_a_time_waits_for_a_kick() {
    for motion in Motion::ALL {
        let mut world = with_motion(DOWN, &saucer(""), motion);
        launch(&mut world, DVec2::new(0.5, 0.53), DVec2::ZERO);
        assert_eq!(run(&mut world, 20_000), [EventKind::Held { element: 0 }], "{motion}");
        assert_eq!((ball(&world, 0), support(&world, 0)), ((DVec2::new(0.5, 0.5), DVec2::ZERO), Support::Held(0)));
        assert!(world.waits_in_saucers() && world.held() == 1);
        world.kick(0);
        world.kick(0);
        assert_eq!((world.held(), support(&world, 0)), (0, Support::Released(0)));
        assert_eq!(run(&mut world, 1), [EventKind::Ejected { element: 0 }], "{motion}");
        // It flies up, falls back over the saucer's left, and is not caught before it has left.
        assert_eq!(run(&mut world, 100), [], "{motion}");
        assert!(ball(&world, 0).0.y > 0.55, "{motion}");
    }
}

/// A flipper that starts begins the flights of the balls near it anew: not that of a ball in a saucer, whose time it tells.
#[test]
fn a_flipper_beside_it_does_not_prolong_its_hold() {
    let flipper = "Flipper(name: \"f\", material: \"flipper rubber\", hand: Left, pivot: (0.42, 0.5), length: 0.0635, base_radius: 0.0111,
        tip_radius: 0.00635, rest: 120.5, raised: 70.0, inertia: 1.07e-4, torque: 0.58, ramp: 0.01, hold: 0.75, hold_within: 6.0,
        return_share: 0.041, stop_restitution: 0.2),";
    for motion in Motion::ALL {
        let mut world = with_motion(DOWN, &(saucer(", hold: 0.25") + flipper), motion);
        launch(&mut world, DVec2::new(0.5, 0.53), DVec2::ZERO);
        let mut times = Vec::new();
        for tick in 0..900 {
            world.press(false, tick / 40 % 2 == 0);
            let of_saucer = |kind: &EventKind| matches!(kind, EventKind::Held { .. } | EventKind::Ejected { .. });
            times.extend(world.step().iter().filter(|event| of_saucer(&event.kind)).map(|event| event.at.tick));
        }
        assert!(times.len() >= 2 && times[1] == times[0] + 250, "{motion}: {times:?}");
    }
}

#[test]
fn a_second_ball_passes_over_and_does_not_meet_the_first() {
    for motion in Motion::ALL {
        let mut world = with_motion(DVec2::ZERO, &saucer(""), motion);
        let scene = std::sync::Arc::make_mut(&mut world.scene);
        scene.multiball = true;
        let mut world = World::new(std::sync::Arc::new(scene.clone().built()));
        assert!(world.scene.needs.ball_ball);
        launch(&mut world, DVec2::new(0.5, 0.53), DVec2::new(0.0, -0.3));
        launch(&mut world, DVec2::new(0.5, 0.62), DVec2::new(0.0, -0.3));
        assert_eq!(run(&mut world, 500), [EventKind::Held { element: 0 }], "{motion}");
        assert_eq!(ball(&world, 1).1, DVec2::new(0.0, -0.3), "{motion}");
    }
}

#[test]
fn a_copy_restored_while_a_ball_is_held_goes_on_bit_for_bit() {
    for motion in Motion::ALL {
        for hold in ["", ", hold: 0.2"] {
            let mut world = with_motion(DOWN, &saucer(hold), motion);
            launch(&mut world, DVec2::new(0.495, 0.53), DVec2::new(0.01, -0.1));
            let (mut caught, mut out) = (0, 0);
            for tick in 0..1500 {
                if tick == 700 {
                    world.kick(0);
                }
                let mut copy = World::new(world.scene.clone());
                assert_eq!(copy.restore(world.state().clone()), Ok(()), "{motion}, tick {tick}");
                let events = world.step().to_vec();
                caught += events.iter().filter(|event| matches!(event.kind, EventKind::Held { .. })).count();
                out += events.iter().filter(|event| matches!(event.kind, EventKind::Ejected { .. })).count();
                assert_eq!(copy.step(), events, "{motion}, tick {tick}");
                assert_eq!(digest_of(&copy.state), digest_of(&world.state), "{motion}, tick {tick}");
            }
            assert!(caught >= 1 && out >= 1, "{motion}: {caught} {out}");
        }
    }
}

#[test]
fn a_state_with_a_ball_in_a_saucer_as_none_lies_is_refused() {
    let mut world = world_with(DOWN, &saucer(""));
    launch(&mut world, DVec2::new(0.5, 0.53), DVec2::ZERO);
    run(&mut world, 500);
    let good = world.state().clone();
    assert_eq!(good.balls[0].support, Support::Held(0));
    let spoil = |spoil: &dyn Fn(&mut crate::physics::WorldState)| {
        let mut state = good.clone();
        spoil(&mut state);
        state
    };
    let bad = [
        spoil(&|state| state.balls[0].support = Support::Held(1)),
        spoil(&|state| state.balls[0].support = Support::Released(64)),
        spoil(&|state| state.balls[0].flight.velocity.x = 0.1),
        spoil(&|state| state.balls[0].flight.position.x = 0.51),
        spoil(&|state| state.balls[0].flight.acceleration.y = -0.793),
        spoil(&|state| state.balls.push(state.balls[0])),
    ];
    for state in bad {
        assert!(world.restore(state.clone()).is_err(), "accepted {state:?}");
    }
    assert_eq!(world.restore(good), Ok(()));
}
