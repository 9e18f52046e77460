//! What a search for the next event may not miss: holes that are their own way back, the edge of the scene, ways longer than
//! one search.

use std::sync::Arc;

use glam::DVec2;

use super::{ball, run};
use crate::math::{Rng, direction};
use crate::physics::happened::{Event, EventKind};
use crate::physics::motion::Motion;
use crate::physics::scene::Scene;
use crate::physics::world::World;
use crate::table::Table;

fn scene(text: &str) -> Scene {
    match Table::parse("search.ron", text) {
        Ok(table) => (*table.scene).clone(),
        Err(error) => panic!("{error}"),
    }
}

/// Broke: a ball on the other floor passed the way back at the same place, and so on, for ever; or a wall that stands right
/// behind a hole was not there for it.
#[test]
fn a_hole_that_is_its_own_way_back_is_passed_once() {
    let mut rng = Rng::new(8);
    for round in 0..200 {
        let (low, high) = (DVec2::new(rng.between(0.2, 0.4), 0.1), DVec2::new(rng.between(0.45, 0.7), 0.9));
        let velocity = DVec2::new(rng.between(0.5, 4.0), rng.between(-0.5, 0.5));
        let hole = |floor: u8| {
            let (low, high) = ((low.x, low.y), (high.x, high.y));
            format!("Hole(from: {low:?}, to: {high:?}, floor: {floor}, leads_to: {}),", 1 - floor)
        };
        let velocity = (velocity.x, velocity.y);
        let text = format!(
            "Scene(gravity: (0.0, -0.8), bounds: (-9.0, -9.0, 9.0, 9.0), balls: [(position: (0.05, 0.5), velocity: {velocity:?}, radius: 0.001)], elements: [{}{}])",
            hole(0),
            hole(1)
        );
        for motion in Motion::ALL {
            let mut world = World::new(Arc::new(Scene { motion, ..scene(&text) }));
            let events = run(&mut world, (0.7 / velocity.0 * 1000.0) as u32);
            let passes = events.iter().filter(|event| matches!(event, EventKind::Passed { .. })).count();
            assert_eq!(passes, 1, "round {round}, {motion}: {events:?}");
            assert_eq!(world.state.balls[0].floor, 1, "round {round}, {motion}");
        }
    }
}

#[test]
fn a_wall_behind_a_hole_stops_a_ball_that_overlaps_it_there() {
    let text =
        "Scene(gravity: (0.0, 0.0), balls: [(position: (0.25, 0.5), velocity: (1.0, 0.0), radius: 0.1)], elements: [
        Hole(from: (0.5, 0.0), to: (0.5, 1.0), leads_to: 1), Wall(points: [(0.5625, 0.0), (0.5625, 1.0)], floor: 1)])";
    let mut world = World::new(Arc::new(scene(text)));
    run(&mut world, 300);
    assert!(ball(&world, 0).1.x < 0.0, "it is thrown back: {:?}", world.state.balls[0]);
}

/// What happens within so many seconds at that rate.
fn events(scene: &Scene, hertz: f64, seconds: f64) -> Vec<Event> {
    let mut world = World::new(Arc::new(Scene { tick_seconds: 1.0 / hertz, ..scene.clone() }));
    (0..(seconds * hertz) as u32).flat_map(|_| world.step().to_vec()).collect()
}

fn moment(event: &Event, hertz: f64) -> f64 {
    event.at.since(super::Instant::start_of(0), 1.0 / hertz)
}

/// Broke: whether and where a ball had left a scene was only looked at the end of a tick.
#[test]
fn a_ball_escapes_where_it_leaves_at_any_tick_rate() {
    let scene = scene(
        "Scene(gravity: (0.0, -40.0), balls: [(position: (0.5, 0.5), velocity: (0.0, 16.0))],
            elements: [Wall(points: [(0.0, 0.0), (1.0, 0.0)])])",
    );
    for hertz in [1.0, 1000.0] {
        let events = events(&scene, hertz, 2.0);
        assert_eq!(events.len(), 1, "{events:?}");
        assert_eq!(events[0].kind, EventKind::Escaped);
        assert!((events[0].position.y - scene.edge.high.y).abs() < 1e-12, "{events:?}");
        assert!((moment(&events[0], hertz) - 0.070_379_005_523).abs() < 1e-9, "{events:?}");
    }
}

/// Broke: an impact was lost when a search ended before it, in a tick that did not.
#[test]
fn a_way_longer_than_a_search_is_searched_to_its_end() {
    let posts: String = (0..200)
        .map(|place| {
            let at = direction(f64::from(place)) * 0.3 + DVec2::new(0.5, 0.5);
            format!("Post(center: ({:?}, {:?}), radius: 0.0001),", at.x, at.y)
        })
        .collect();
    let scene = scene(&format!(
        "Scene(gravity: (0.0, -2000.0), bounds: (-1e6, -1e6, 1e6, 1e6), balls: [(position: (0.05, 0.5), velocity: (0.0, 800.0), radius: 0.001)],
            elements: [Wall(points: [(-1.0, 0.0), (1.0, 0.0)]), {posts}])"
    ));
    let expected = events(&scene, 1000.0, 3.0);
    assert!(expected.len() >= 3, "{expected:?}");
    let found = events(&scene, 1.0, 3.0);
    assert_eq!(found.len(), expected.len());
    for (one, other) in found.iter().zip(&expected) {
        assert_eq!((one.position, one.kind), (other.position, other.kind));
    }
}

/// Broke: a ball that met more within a tick than is worth following lost its speed without a word.
#[test]
fn a_ball_that_meets_too_much_is_told_of() {
    let scene = scene(
        "Scene(gravity: (0.0, 0.0), balls: [(position: (0.0, 0.0), velocity: (250000.0, 0.0), radius: 0.01)],
            elements: [Wall(points: [(-0.5, -1.0), (-0.5, 1.0)]), Wall(points: [(0.5, -1.0), (0.5, 1.0)])])",
    );
    let told = events(&scene, 1000.0, 0.001);
    assert_eq!(told.len(), 201);
    assert_eq!(told[200].kind, EventKind::Stalled { speed: 250_000.0 });
}

/// Broke: after a flight of a kilometre rounding put a ball inside the post that it was about to meet.
#[test]
fn a_post_is_met_after_a_long_flight_at_any_speed() {
    let mut rng = Rng::new(4);
    for _ in 0..300 {
        let speed = rng.between(100.0, 30_000.0);
        let text = format!(
            "Scene(gravity: (0.0, -9.8), bounds: (-1e9, -1e9, 1e9, 1e9), balls: [(position: (0.0, 1.0), velocity: (0.0, {speed:?}))],
                elements: [Post(center: (0.0, 0.0), radius: 0.02)])"
        );
        let found = events(&scene(&text), 1.0, (2.0 * speed / 9.8).ceil() + 1.0);
        assert!(matches!(found[..], [Event { kind: EventKind::Touched { .. }, .. }, ..]), "at {speed} m/s: {found:?}");
    }
}
