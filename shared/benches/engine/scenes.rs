//! Scenes to be timed, and worlds and games in them.

use std::fmt::Write;
use std::hint::black_box;
use std::sync::Arc;

use shared::game::Game;
use shared::math::Rng;
use shared::physics::World;
use shared::physics::scene::Scene;
use shared::table::Table;

/// A playfield's size, m.
pub(crate) const FIELD: (f64, f64) = (0.514, 1.067);
/// Of a ball, m.
pub(crate) const RADIUS: f64 = 0.0135;
/// On the slope, m/s^2; and without one.
pub(crate) const PULLS: [(&str, f64); 2] = [("no gravity", 0.0), ("gravity", -1.1101)];

pub(crate) fn table(text: &str) -> Arc<Table> {
    Arc::new(Table::parse("scene", text).unwrap_or_else(|error| panic!("{error}")))
}

/// An elastic box with these balls and other elements in it, as a scene file.
pub(crate) fn boxed((width, height): (f64, f64), pull: f64, tick_hz: u32, balls: &str, elements: &str) -> String {
    format!(
        "Scene(
            gravity: (0.0, {pull:?}), tick_hz: {tick_hz},
            balls: [{balls}],
            elements: [
                Wall(points: [(0.0, 0.0), ({width:?}, 0.0), ({width:?}, {height:?}), (0.0, {height:?}), (0.0, 0.0)]),
                {elements}
            ],
        )"
    )
}

/// One ball in a box of a playfield's size, and nothing else.
pub(crate) fn bare(pull: f64) -> Arc<Table> {
    let ball = format!("(position: (0.138, 0.99), velocity: (1.26, -2.32), radius: {RADIUS})");
    table(&boxed(FIELD, pull, 1000, &ball, ""))
}

/// A box so large that its ball meets nothing for hours.
pub(crate) fn empty(pull: f64) -> Arc<Table> {
    let ball = format!("(position: (5e8, 5e8), velocity: (0.26, -0.32), radius: {RADIUS})");
    table(&boxed((1e9, 1e9), pull, 1000, &ball, ""))
}

/// That many posts at random places, each in its own square of 6.5 cm, in a box that they fill.
pub(crate) fn posts(count: usize, pull: f64, tick_hz: u32) -> Arc<Table> {
    const SQUARE: f64 = 0.065;
    let mut rng = Rng::new(count as u64);
    let columns = (count as f64).sqrt().ceil() as usize;
    let rows = count.div_ceil(columns);
    let mut elements = String::new();
    for i in 0..count {
        let mut place = |i: usize| (i as f64 + 0.5) * SQUARE + rng.between(-0.011, 0.011);
        let (x, y) = (place(i % columns), place(i / columns));
        let _ = writeln!(elements, "Post(center: ({x:?}, {y:?}), radius: 0.006),");
    }
    // Between the squares.
    let middle = (columns / 2) as f64 * SQUARE;
    let ball = format!("(position: ({middle}, {}), velocity: (1.26, 1.63), radius: {RADIUS})", SQUARE * 1.0);
    table(&boxed((columns as f64 * SQUARE, rows as f64 * SQUARE), pull, tick_hz, &ball, &elements))
}

/// That many balls in rows in a box of a metre, each with a random velocity.
pub(crate) fn balls(count: usize, pull: f64) -> Arc<Table> {
    let mut rng = Rng::new(7);
    let mut text = String::new();
    for i in 0..count {
        let (x, y) = (0.05 + 0.05 * (i % 19) as f64, 0.05 + 0.05 * (i / 19) as f64);
        let (vx, vy) = (rng.between(-1.5, 1.5), rng.between(-1.5, 1.5));
        let _ = write!(text, "(position: ({x:?}, {y:?}), velocity: ({vx:?}, {vy:?}), radius: 0.01),");
    }
    table(&boxed((1.0, 1.0), pull, 1000, &text, ""))
}

/// Steps a world and returns how many events there were.
pub(crate) fn steps(world: &mut World, ticks: u64) -> u64 {
    let mut events = 0;
    for _ in 0..ticks {
        events += black_box(world.step()).len() as u64;
    }
    events
}

/// Steps a game and returns how many events its world had.
pub(crate) fn game_steps(game: &mut Game, ticks: u64) -> u64 {
    let mut events = 0;
    for _ in 0..ticks {
        events += black_box(game.step(&[])).len() as u64;
    }
    events
}

pub(crate) fn world(scene: &Arc<Scene>) -> World {
    World::new(Arc::clone(scene))
}

pub(crate) fn game(table: &Arc<Table>) -> Game {
    Game::new(Arc::clone(table))
}
