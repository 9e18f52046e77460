//! No ball ever gets where no ball should be.

use glam::DVec2;

use super::{ball, classic, deepest_overlap, launch};
use crate::math::Rng;
use crate::physics::scene::Role;
use crate::physics::shapes::{Segment, Shape};
use crate::physics::world::{EventKind, World};
use crate::table::{ElementFile, Table};

/// Closed islands of the table: places where no ball's centre belongs.
fn islands(table: &Table) -> Vec<Vec<DVec2>> {
    let closed = table.file.elements.iter().filter_map(|element| match element {
        ElementFile::Wall(wall) if wall.points.len() > 3 && wall.points.first() == wall.points.last() => {
            Some(wall.points.iter().map(|&(x, y)| DVec2::new(x, y)).collect())
        }
        _ => None,
    });
    closed.collect()
}

/// Whether a point lies in a polygon whose last corner is its first.
fn is_inside(polygon: &[DVec2], point: DVec2) -> bool {
    let crossed = polygon.windows(2).filter(|pair| {
        let (a, b) = (pair[0], pair[1]);
        (a.y > point.y) != (b.y > point.y) && point.x < a.x + (point.y - a.y) / (b.y - a.y) * (b.x - a.x)
    });
    crossed.count() % 2 == 1
}

/// Long walls: on which side of them a ball is can be told from one tick to the next.
fn long_walls(world: &World) -> Vec<Segment> {
    let solid = world.scene.colliders.iter().filter(|c| c.role == Role::Solid && world.state.has(c));
    let segments = solid.filter_map(|c| match c.shape {
        Shape::Segment(segment) if segment.length > 0.07 && !segment.one_way => Some(segment),
        _ => None,
    });
    segments.collect()
}

/// The side of a wall on which a point is, if it is beside its middle part.
fn side_of(wall: &Segment, point: DVec2) -> Option<bool> {
    let along = wall.along.dot(point - wall.a);
    (along > 0.03 && along < wall.length - 0.03).then(|| wall.normal.dot(point - wall.a) > 0.0)
}

#[test]
fn no_shot_at_twenty_metres_a_second_passes_through_anything() {
    let table = classic();
    let islands = islands(&table);
    assert!(islands.len() >= 2, "Classic has islands");
    let mut rng = Rng::new(1);
    let (mut impacts, mut deepest, mut fastest, mut drained) = (0_u32, f64::NEG_INFINITY, 0.0_f64, 0);
    let mut deepest_of = String::new();
    for shot in 0..6000 {
        let mut world = World::new(table.scene.clone());
        let walls = long_walls(&world);
        let start = loop {
            let place = DVec2::new(rng.between(0.0, 0.514), rng.between(0.02, 1.067));
            let under_the_arch = place.y < 0.81 || (place - DVec2::new(0.257, 0.81)).length() < 0.24;
            let free = deepest_overlap(&world, place) < 0.0 && !islands.iter().any(|island| is_inside(island, place));
            if under_the_arch && free {
                break place;
            }
        };
        let velocity = crate::math::direction(rng.between(0.0, core::f64::consts::TAU)) * rng.between(0.0, 20.0);
        launch(&mut world, start, velocity);
        world.state.balls[0].spin = rng.between(-200.0, 200.0);
        let mut before = start;
        for _ in 0..150 {
            if rng.unit() < 0.04 {
                let right = rng.unit() < 0.5;
                world.press(right, rng.unit() < 0.6);
            }
            for event in world.step() {
                match event.kind {
                    EventKind::Escaped => {
                        panic!("shot {shot} from {start} at {velocity} escaped at {}", event.position)
                    }
                    EventKind::Drained => drained += 1,
                    EventKind::Passed { .. } => {}
                    _ => impacts += 1,
                }
            }
            if world.state.balls.is_empty() {
                break;
            }
            let (position, velocity_now) = ball(&world, 0);
            let what = || {
                format!(
                    "shot {shot} from {start} at {velocity}: {:?}, {:?}",
                    world.state.balls[0], world.state.flippers
                )
            };
            let spin = world.state.balls[0].spin;
            assert!(position.is_finite() && velocity_now.is_finite() && spin.is_finite(), "{}", what());
            assert!(!islands.iter().any(|island| is_inside(island, position)), "inside an island, {}", what());
            for wall in &walls {
                if let (Some(was), Some(is)) = (side_of(wall, before), side_of(wall, position)) {
                    assert_eq!(was, is, "through {wall:?}, {}", what());
                }
            }
            let overlap = deepest_overlap(&world, position);
            if overlap > deepest {
                deepest = overlap;
                deepest_of = what();
            }
            fastest = fastest.max(velocity_now.length());
            before = position;
        }
    }
    println!(
        "{impacts} impacts, {drained} balls drained, fastest {fastest:.1} m/s, deepest overlap {deepest:e} m, {deepest_of}"
    );
    assert!(impacts > 10_000, "only {impacts} impacts");
    assert!(deepest < 2e-4, "a ball was {deepest} m deep in something: {deepest_of}");
}
