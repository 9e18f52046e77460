//! The Starball v2 manual as tests: its table of contents, system by system, in the order in which it has them.
//!
//! Where the manual is right, ours agrees with it. Where it is wrong, its algorithm is written out here as printed, and
//! a test shows both. Only the public interface of the crate is used. A `figure_N` in a test's name is the manual's.
//! The manual's y axis points down the screen and ours up the table, which changes no formula in here.

// 2 File structure: the world, its floors and elements. 3 Algorithms and techniques: the game loop.
mod world;

// Movement: the first version and its two problems, and the second, pixel by pixel.
mod movement;
mod pixel_loop;

// Basic collision: what it does to a ball, and with the manual's own constants.
mod basic_collision;

// Collision tests, results and replacements, circle to circle and circle to line.
mod circle_circle;
mod circle_line;
mod replacement_at_circle;
mod two_body;

// 4.1 Mathematical tools.
mod lines;
mod vectors;

// 4.2 Application in the project: its first collision test, and the collision result.
mod reflection;
mod swept_area;

use glam::DVec2;
use shared::math::line::Ends;
use shared::physics::World;
use shared::physics::ball::Instant;
use shared::physics::motion::Motion;
use shared::table::Table;

/// The world of a table or scene, run by that model.
#[track_caller]
fn world_of(source: &str, motion: Motion) -> World {
    let table = Table::parse("test.ron", source).unwrap_or_else(|error| panic!("{error}"));
    World::new(table.run_with(Some(motion), None).expect("its own rate").scene)
}

/// A scene of one ball, in which a tick is a second and a pixel a metre: what the manual says of pixels and loops can be read
/// in metres and ticks.
fn ball_among(radius: f64, velocity: DVec2, gravity: f64, elements: &str) -> String {
    let DVec2 { x, y } = velocity;
    format!(
        "Scene(gravity: (0.0, {gravity:?}), tick_hz: 1, pixel: 1.0, bounds: (-1e3, -1e3, 1e3, 1e3),
        balls: [(position: (0.0, 0.0), velocity: ({x:?}, {y:?}), radius: {radius:?})], elements: [{elements}])"
    )
}

/// A line, as an element of a scene.
fn wall([a, b]: Ends, restitution: f64) -> String {
    format!("Wall(points: [({:?}, {:?}), ({:?}, {:?})], restitution: {restitution:?}), ", a.x, a.y, b.x, b.y)
}

/// Centre and velocity of a world's only ball, as anybody sees them between two steps.
#[track_caller]
fn ball_of(world: &World) -> (DVec2, DVec2) {
    let state = world.state();
    let [ball] = &state.balls[..] else { panic!("{} balls", state.balls.len()) };
    ball.at(Instant::start_of(state.tick), world.scene().tick_seconds)
}

/// Unit vector at `degrees` from +x, counter-clockwise; exact where it lies on an axis.
fn unit_at(degrees: i32) -> DVec2 {
    match degrees.rem_euclid(360) {
        0 => DVec2::X,
        90 => DVec2::Y,
        180 => DVec2::NEG_X,
        270 => DVec2::NEG_Y,
        other => DVec2::from_angle(shared::math::radians(f64::from(other))),
    }
}

#[track_caller]
fn assert_near(found: DVec2, expected: DVec2, tolerance: f64) {
    // Written so that NaN is not near to anything.
    let is_near = (found - expected).length() <= tolerance;
    assert!(is_near, "{found} instead of {expected}");
}
