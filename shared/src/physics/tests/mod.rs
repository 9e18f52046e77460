//! Tests of the world as a whole: small tables written in RON, and the one that comes with the game.

mod balls;
mod elements;
mod fields;
mod flippers;
mod hinges;
mod needs;
mod plunger;
mod restore;
mod saucers;
mod searches;
mod squeezes;
mod surfaces;
mod tunnelling;

use std::sync::Arc;

use glam::DVec2;

use super::ball::{Flight, Instant, Support};
use super::happened::EventKind;
use super::world::World;
use crate::extremes::overlap::deepest_overlap;
use crate::table::Table;

/// A world of these elements on a table of 1 m by 1 m, with gravity as given.
///
/// Materials: `ideal` bounces for ever, `slick` has no friction, `wood` is real, `dead` takes all of a bounce.
fn world_with(gravity: DVec2, elements: &str) -> World {
    let source = format!(
        r#"(format: 1, physics: 3, name: "test", size: (1.0, 1.0), gravity: ({:?}, {:?}), rest_speed: 0.02,
        ball: (radius: 0.0135, mass: 0.08, start: (0.985, 0.985)),
        materials: {{
            "ideal": (restitution: 1.0),
            "slick": (restitution: 0.5),
            "wood": (restitution: 0.3, friction: 0.3),
            "rubber": (restitution: 0.8, falloff: 0.3, friction: 0.6),
            "flipper rubber": (restitution: 0.8, falloff: 0.43, friction: 0.6),
            "dead": (restitution: 0.0, friction: 0.3),
        }},
        elements: [{elements} Drain(name: "drain", from: (0.0, 0.001), to: (1.0, 0.001))],
        rules: (balls: 3, max_multiplier: 6, on: []))"#,
        gravity.x, gravity.y
    );
    match Table::parse("test.ron", &source) {
        Ok(table) => World::new(table.scene),
        Err(error) => panic!("{error}"),
    }
}

/// The table that comes with the game.
fn classic() -> Arc<Table> {
    match Table::shipped("classic") {
        Some(Ok(table)) => Arc::new(table),
        other => panic!("{other:?}"),
    }
}

/// A ball on its way; its place among the balls.
fn launch(world: &mut World, position: DVec2, velocity: DVec2) -> usize {
    assert!(world.serve(position).is_some(), "no room for another ball");
    let ball = world.state.balls.len() - 1;
    world.state.balls[ball].flight.velocity = velocity;
    ball
}

/// Where a ball is between two ticks, and how fast.
fn ball(world: &World, index: usize) -> (DVec2, DVec2) {
    world.state.balls[index].at(Instant::start_of(world.state.tick), world.scene.tick_seconds)
}

/// Steps for so many ticks; what happened in them.
fn run(world: &mut World, ticks: u32) -> Vec<EventKind> {
    (0..ticks).flat_map(|_| world.step().iter().map(|event| event.kind).collect::<Vec<_>>()).collect()
}

fn at_rest(flight: &Flight) -> bool {
    flight.velocity == DVec2::ZERO && flight.acceleration == DVec2::ZERO
}

fn support(world: &World, index: usize) -> Support {
    world.state.balls[index].support
}
