//! What is drawn is what is there.

use std::sync::Arc as Shared;

use super::foresight::foresee;
use super::track::Tracks;
use super::*;
use crate::physics::EventKind;
use crate::physics::ball::Instant;
use crate::table::Table;

fn scene(text: &str) -> World {
    World::new(Shared::clone(&Table::parse("scene.ron", text).unwrap().scene))
}

fn bouncing_box() -> World {
    scene(include_str!("../../tables/scenes/box.ron"))
}

fn classic() -> World {
    World::new(Shared::clone(&Table::shipped("classic").unwrap().unwrap().scene))
}

fn now(world: &World) -> Instant {
    Instant::start_of(world.state().tick)
}

fn present(world: &World) -> usize {
    world.scene().colliders.iter().filter(|collider| world.state().has(collider)).count()
}

#[test]
fn there_is_an_outline_for_each_collider_that_is_there() {
    for world in [bouncing_box(), classic()] {
        assert_eq!(outlines(&world).len(), present(&world));
    }
}

#[test]
fn a_flipper_on_its_way_is_drawn_where_it_is() {
    let mut world = classic();
    world.press(false, true);
    for _ in 0..10 {
        world.step();
    }
    let swing = world.state().flippers[0].swing;
    assert!(swing > 0.0 && swing < world.scene().flippers[0].stroke, "it is on its way: {swing}");
    let outlines = outlines(&world);
    let of_flipper: Vec<_> = outlines.iter().filter(|outline| outline.part == Part::Flipper(0)).collect();
    assert_eq!((of_flipper.len(), outlines.len()), (4, present(&world) + 4));
    let spec = &world.scene().flippers[0];
    let axis = spec.direction(swing);
    for point in of_flipper.iter().flat_map(|outline| &outline.points) {
        assert!(spec.nearest(axis, *point).distance < 1e-12, "{point}");
    }
}

#[test]
fn a_pulled_plunger_is_drawn_where_it_is() {
    let mut world = classic();
    world.pull(Some(1.0));
    for _ in 0..100 {
        world.step();
    }
    let pull = world.state().plungers[0].pull;
    let outlines = outlines(&world);
    let head = outlines.iter().find(|outline| outline.part == Part::Plunger(0)).unwrap();
    let spec = &world.scene().plungers[0];
    assert!(pull > 0.01 && head.points.iter().all(|point| spec.distance(pull, *point).abs() < 1e-12));
}

#[test]
fn arcs_are_drawn_on_their_circle_and_normals_point_to_where_a_ball_is() {
    for world in [bouncing_box(), classic()] {
        let (scene, radius) = (world.scene(), world.scene().largest_radius());
        for outline in outlines(&world) {
            let index = match outline.part {
                Part::Collider(index) => index,
                Part::Saucer(_) => continue,
                part => panic!("nothing moves: {part:?}"),
            };
            let collider = &scene.colliders[usize::from(index)];
            for pair in outline.points.windows(2) {
                let off = collider.shape.distance((pair[0] + pair[1]) * 0.5);
                assert!(off < 1.1 * SLACK * radius, "{off} in {outline:?}");
            }
            for normal in &outline.normals {
                let ball = normal.at + normal.towards * radius;
                assert!((collider.shape.distance(ball) - radius).abs() < 1e-12);
                assert!((collider.shape.normal_at(ball) - normal.towards).length() < 1e-9, "{outline:?}");
            }
            let is_shown = !outline.normals.is_empty();
            assert_eq!(is_shown, outline.kind != Kind::Passed && outline.points.len() > 1);
        }
    }
}

#[test]
fn what_is_foreseen_happens_then_and_there() {
    let mut shot = classic();
    shot.launch(0, DVec2::new(0.2, 0.6), DVec2::new(0.4, 1.1)).unwrap();
    for mut world in [bouncing_box(), shot] {
        for _ in 0..20 {
            let foreseen = foresee(&world, now(&world), 10.0);
            // Until it is lost.
            let Some(foresight) = foreseen.first() else { break };
            let Some(impact) = foresight.impact else { break };
            let happened = loop {
                let told = world.step();
                if let Some(event) = told.iter().find(|event| !matches!(event.kind, EventKind::Passed { .. })) {
                    break *event;
                }
            };
            assert_eq!(impact.event, happened);
            assert_eq!(foresight.points.last(), Some(&happened.position));
            let normal = impact.normal.unwrap_or(DVec2::X);
            assert!((normal.length() - 1.0).abs() < 1e-12);
            assert!(happened.velocity.dot(normal) > -1e-9 || impact.normal.is_none(), "away from the surface");
        }
    }
}

#[test]
fn nothing_is_foreseen_beyond_the_time_that_is_looked_for() {
    let balls = "balls: [(position: (0.0, 0.0), velocity: (1.0, 0.0))]";
    let world = scene(&format!("Scene(gravity: (0.0, 0.0), {balls}, bounds: (-9.0, -9.0, 9.0, 9.0))"));
    let foreseen = foresee(&world, now(&world), 0.5);
    assert_eq!(foreseen[0].impact, None);
    assert!((*foreseen[0].points.last().unwrap() - DVec2::new(0.5, 0.0)).length() < 1e-12);
}

#[test]
fn a_track_goes_through_every_impact_and_along_every_flight() {
    let mut world = bouncing_box();
    let mut tracks = Tracks::begin(&world, now(&world), false);
    let mut seen = vec![];
    let mut happened = vec![];
    for tick in 0..5000 {
        world.step();
        tracks.after_step(&world);
        happened.extend(world.events().iter().map(|event| event.position));
        if tick % 10 == 9 {
            seen.push(world.state().balls[0].at(now(&world), world.scene().tick_seconds).0);
        }
    }
    let tracks = tracks.finish(&world);
    let points = &tracks[0].points;
    assert!(happened.len() > 10 && happened.iter().all(|place| points.contains(place)));
    assert_eq!(tracks[0].impacts.len(), happened.len());
    let to_line = |place: DVec2, a: DVec2, b: DVec2| {
        let along = (place - a).dot(b - a) / (b - a).length_squared();
        (place - a - (b - a) * along.clamp(0.0, 1.0)).length()
    };
    for place in seen {
        let off = points.windows(2).map(|ends| to_line(place, ends[0], ends[1])).fold(f64::INFINITY, f64::min);
        assert!(off < 0.02 * world.scene().largest_radius(), "{off} at {place}");
    }
}

#[test]
fn a_ball_in_a_saucer_lies_there_and_is_thrown_out() {
    let source = crate::table::SHIPPED[0].source.replace(
        "        Drain(name: \"drain\"",
        "        Saucer(name: \"cup\", center: (0.237, 0.37), radius: 0.012, capture: 2.0, kick: (0.0, 1.0), hold: Some(0.5)),
        Drain(name: \"drain\"",
    );
    let table = Table::parse("table.ron", &source).unwrap();
    let mut world = World::new(Shared::clone(&table.scene));
    world.launch(0, DVec2::new(0.237, 0.39), DVec2::new(0.0, -0.2)).unwrap();
    let held = foresee(&world, now(&world), 1.0)[0].impact.unwrap();
    assert!(matches!(held.event.kind, EventKind::Held { .. }), "{held:?}");
    for _ in 0..300 {
        world.step();
    }
    let support = world.state().balls[0].support;
    let on = support_elements(&world, support);
    assert_eq!(table.file.elements[usize::from(on[0])].name(), "cup");
    assert!(outlines(&world).iter().any(|outline| outline.part.supports(support)));
    let out = foresee(&world, now(&world), 1.0)[0].impact.unwrap();
    assert!(matches!(out.event.kind, EventKind::Ejected { .. }), "{out:?}");
}

#[test]
fn both_balls_of_a_meeting_have_the_normal_between_them() {
    let mut world = scene(
        "Scene(gravity: (0.0, 0.0), balls: [(position: (0.0, 0.0), velocity: (1.0, 0.0)), (position: (0.3, 0.0))])",
    );
    let foreseen = foresee(&world, now(&world), 1.0);
    let normals: Vec<_> = foreseen.iter().map(|one| one.impact.unwrap().normal).collect();
    assert_eq!(normals, [Some(-DVec2::X), Some(DVec2::X)]);
    world.step();
    assert_eq!(support_elements(&world, Support::None), []);
}

#[test]
fn a_ball_at_rest_lies_on_an_element_that_is_named() {
    let table = Table::shipped("classic").unwrap().unwrap();
    let mut world = classic();
    world.serve(table.ball_start).unwrap();
    for _ in 0..3000 {
        world.step();
    }
    let support = world.state().balls[0].support;
    let names: Vec<_> =
        support_elements(&world, support).iter().map(|on| table.file.elements[usize::from(*on)].name()).collect();
    assert!(!names.is_empty(), "{support:?}");
    assert!(outlines(&world).iter().any(|outline| outline.part.supports(support)), "{support:?} lies on {names:?}");
}
