//! A world runs, stores and sends what its scene needs, and nothing else.

use std::sync::Arc;

use glam::DVec2;

use super::classic;
use crate::math::{Digest, Rng, digest_of};
use crate::physics::ball::{Flight, Instant};
use crate::physics::happened::Event;
use crate::physics::motion::Motion;
use crate::physics::needs::Needs;
use crate::physics::scene::Scene;
use crate::physics::world::World;
use crate::physics::{WorldState, ball::Ball};
use crate::table::Table;

/// A scene of a ball and whatever is added to it.
fn scene(gravity: f64, balls: &str, elements: &str) -> Arc<Scene> {
    let text = format!(
        "Scene(gravity: (0.0, {gravity:?}), balls: [(position: (0.2, 0.3), velocity: (0.7, 0.4)), {balls}], elements: [
            Wall(points: [(0.0, 0.0), (0.5, 0.0), (0.5, 1.0), (0.0, 1.0), (0.0, 0.0)], restitution: 0.97), {elements}])"
    );
    match Table::parse("needs.ron", &text) {
        Ok(table) => table.scene,
        Err(error) => panic!("{error}"),
    }
}

fn names(scene: &Scene) -> Vec<&'static str> {
    scene.needs.names().collect()
}

#[test]
fn each_scene_needs_what_is_in_it() {
    assert_eq!(names(&scene(0.0, "", "")), [""; 0]);
    assert_eq!(names(&scene(-1.0, "", "")), ["gravity", "contact"]);
    assert_eq!(names(&scene(0.0, "", "Ring(center: (0.2, 0.3), radius: 0.1),")), ["contact"], "a hollow presses");
    assert_eq!(names(&scene(0.0, "(position: (0.4, 0.3)),", "")), ["ball-ball"]);
    assert_eq!(names(&scene(0.0, "(position: (0.4, 0.3), mass: 0.2),", "")), ["ball-ball", "kinds"]);
    let hole = "Hole(from: (0.1, 0.6), to: (0.2, 0.6), leads_to: 1),";
    assert_eq!(names(&scene(0.0, "", hole)), ["floors", "sensors"]);
    let posts: String = (0..16)
        .map(|place| format!("Post(center: ({:?}, 0.8), radius: 0.001),", 0.03 + 0.025 * f64::from(place)))
        .collect();
    assert_eq!(names(&scene(0.0, "", &posts)), ["broad phase"]);
}

#[test]
fn classic_needs_all_but_other_kinds_of_ball_and_magnets() {
    let expected: Vec<_> = Needs::NAMES.into_iter().filter(|name| !matches!(*name, "kinds" | "magnets")).collect();
    assert_eq!(names(&classic().scene), expected);
}

/// Bytes of a state as it is digested: every integer at its full length.
fn length(state: &WorldState) -> usize {
    let config = bincode::config::standard().with_fixed_int_encoding();
    bincode::serde::encode_to_vec(state, config).map_or(0, |bytes| bytes.len())
}

#[test]
fn what_is_not_needed_is_not_in_a_state() {
    // Needs, tick, balls served, count of balls; of each ball: id, age, support, a mark of what it has, one of which numbers are
    // zero, and position and velocity, of which none is.
    let bare = 2 + 8 + 4 + 8 + (4 + 8 + 4 + 1 + 2 + 32);
    let of = |scene: &Arc<Scene>| length(World::new(Arc::clone(scene)).state());
    let plain = scene(0.0, "", "");
    assert_eq!(of(&plain), bare);
    assert_eq!(of(&scene(-1.0, "", "")), bare + 8, "with gravity a ball can rest: it has an acceleration of its own");
    // Each part of a state is there for one need.
    for (place, name) in Needs::NAMES.into_iter().enumerate() {
        let mut flags = [false; Needs::COUNT];
        flags[place] = true;
        let forced = Arc::new((*plain).clone().with_needs(Needs::from_flags(flags)));
        let more = match name {
            "kinds" | "floors" => 1,
            "flippers" | "plungers" | "targets" | "hinges" | "magnets" => 8,
            // A cabinet that stands still is a mark.
            "nudge" => 2,
            _ => 0,
        };
        assert_eq!(of(&forced), bare + more, "{name}");
    }
}

#[test]
fn a_written_state_is_read_back_bit_for_bit_whatever_is_needed() {
    let mut rng = Rng::new(5);
    for _ in 0..200 {
        let needs = Needs::from_bits(rng.bits() as u16 & Needs::ALL.bits());
        let scene = Arc::new((*scene(-1.0, "", "")).clone().with_needs(needs));
        let mut world = World::new(scene);
        for _ in 0..700 {
            world.step();
        }
        let config = bincode::config::standard();
        let bytes = bincode::serde::encode_to_vec(world.state(), config).expect("derived forms do not fail");
        let (read, used): (WorldState, usize) =
            bincode::serde::decode_from_slice(&bytes, config).unwrap_or_else(|error| panic!("{needs:?}: {error}"));
        assert_eq!(used, bytes.len(), "{needs:?}");
        assert_eq!(digest_of(&read), digest_of(world.state()), "{needs:?}");
    }
}

#[test]
fn a_state_of_another_scene_s_needs_is_refused() {
    let (plain, heavy) = (scene(0.0, "", ""), scene(-1.0, "", ""));
    let mut world = World::new(plain);
    let error = world.restore(World::new(heavy).state().clone()).expect_err("it holds an acceleration");
    assert!(error.to_string().contains("another scene needs"), "{error}");
}

/// What happens in a world for some seconds, and where its balls are then.
fn course(scene: Scene, ticks: u32) -> (Vec<Event>, Vec<Flight>) {
    let mut world = World::new(Arc::new(scene));
    let mut events = Vec::new();
    for _ in 0..ticks {
        events.extend_from_slice(world.step());
    }
    (events, world.state().balls.iter().map(|ball: &Ball| ball.flight).collect())
}

#[test]
fn to_force_every_need_or_another_broad_phase_or_to_add_what_is_never_touched_changes_no_bit() {
    let posts: String = (0..60)
        .map(|place| {
            let (x, y) = (0.05 + 0.08 * f64::from(place % 6), 0.4 + 0.055 * f64::from(place / 6));
            format!("Post(center: ({x:?}, {y:?}), radius: 0.004, restitution: 0.9),")
        })
        .collect();
    let two = "(position: (0.35, 0.2), velocity: (-0.3, 0.1)),";
    for motion in Motion::ALL {
        for (balls, elements) in [("", ""), ("", posts.as_str()), (two, ""), (two, posts.as_str())] {
            let original = Scene { motion, ..(*scene(-1.0, balls, elements)).clone() };
            let (events, flights) = course(original.clone(), 5000);
            assert!(events.len() >= 8, "{motion}: {} events", events.len());
            let all = original.clone().with_needs(Needs::ALL);
            assert_eq!(course(all, 5000), (events.clone(), flights.clone()), "{motion}: all needs");
            let needs = Needs { broad_phase: !original.needs.broad_phase, ..original.needs };
            let other = original.clone().with_needs(needs);
            assert_eq!(course(other, 5000), (events.clone(), flights.clone()), "{motion}: another broad phase");
            let untouched =
                "Post(name: \"far\", center: (0.62, 0.5), radius: 0.01), Wall(points: [(-0.2, 0.1), (-0.2, 0.3)]),";
            let with = Scene { motion, ..(*scene(-1.0, balls, &(elements.to_owned() + untouched))).clone() };
            assert_eq!(course(with, 5000), (events, flights), "{motion}: untouched elements");
        }
    }
}

/// The same on a table with everything: a ball that the flippers never stop.
#[test]
fn classic_by_brute_force_is_classic() {
    let digest = |needs: Needs| {
        let mut world = World::new(Arc::new((*classic().scene).clone().with_needs(needs)));
        let mut digest = Digest::default();
        let mut rng = Rng::new(9);
        for tick in 0..30_000_u32 {
            if world.state().balls.is_empty() {
                let velocity = DVec2::new(rng.between(-3.0, 3.0), rng.between(-1.0, 4.0));
                world.launch(0, DVec2::new(0.24, 0.5), velocity);
            }
            if tick.is_multiple_of(150) {
                world.press(tick.is_multiple_of(300), rng.unit() < 0.5);
            }
            world.step();
            for ball in &world.state().balls {
                let (position, velocity) = ball.at(Instant::start_of(world.state().tick), world.scene().tick_seconds);
                for number in [position.x, position.y, velocity.x, velocity.y, ball.spin] {
                    digest.update(&number.to_bits().to_le_bytes());
                }
            }
        }
        digest.finish()
    };
    let needs = classic().scene.needs;
    assert_eq!(digest(needs), digest(Needs { broad_phase: false, ..needs }));
    assert_eq!(digest(needs), digest(Needs { floors: true, kinds: true, ..needs }));
}
