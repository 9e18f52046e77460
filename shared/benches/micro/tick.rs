//! A tick in which nothing happens.

use std::sync::Arc;

use divan::Bencher;
use shared::game::{Action, Game, Input};
use shared::physics::World;

use super::classic;
use super::inputs::{INPUTS, table};
use super::moments::{SAMPLES, SLOTS, Stepped, time_second_step};

/// Calls in a sample where nothing has to be made ready for each.
const SAMPLE: u32 = 1000;
/// Samples of them: a million ticks together, 17 minutes, in which nothing may happen.
const SAMPLES_IN_A_ROW: u32 = 1000;

/// A ball flies in a box that it meets the sides of in hours.
#[divan::bench(sample_size = SAMPLE, sample_count = SAMPLES_IN_A_ROW)]
fn world_quiet(bencher: Bencher<'_, '_>) {
    let far = "Scene(
        gravity: (0.0, -1.1101),
        balls: [(position: (5e8, 5e8), velocity: (0.26, -0.32))],
        elements: [Wall(points: [(0.0, 0.0), (1e9, 0.0), (1e9, 1e9), (0.0, 1e9), (0.0, 0.0)])],
    )";
    let mut world = World::new(table(far).scene);
    // It solves the flight.
    assert_eq!(world.advance(), 0);
    bencher.bench_local(|| world.advance());
    assert!(world.state().tick > 1, "it was not stepped");
    assert_eq!(world.state().balls[0].flight.start.tick, 0, "something happened");
}

/// Classic, nobody plays.
#[divan::bench(sample_size = SAMPLE, sample_count = SAMPLES_IN_A_ROW)]
fn classic_idle(bencher: Bencher<'_, '_>) {
    let mut game = classic::game();
    bencher.bench_local(|| game.advance());
    assert!(game.tick() > 0 && game.world().state().balls.is_empty(), "somebody plays");
}

/// Classic, a ball lies on the plunger.
#[divan::bench(sample_size = SAMPLE, sample_count = SAMPLES_IN_A_ROW)]
fn classic_ball_on_plunger(bencher: Bencher<'_, '_>) {
    let mut game = classic::game();
    let act = |action| Input { tick: 0, seat: 0, action };
    game.step(&[act(Action::Sit), act(Action::Start)]);
    for _ in 0..3000 {
        game.step(&[]);
    }
    let lies = |game: &Game| {
        let [ball] = game.world().state().balls[..] else { panic!("one ball") };
        (ball.id, ball.flight.position, ball.flight.velocity)
    };
    let before = lies(&game);
    assert_eq!(before.2, glam::DVec2::ZERO, "it does not lie still");
    bencher.bench_local(|| game.advance());
    assert!(game.tick() > 3001, "it was not stepped");
    assert_eq!(lies(&game), before, "it did not lie still");
}

/// Classic, a ball in flight, everything else at rest.
#[divan::bench(sample_size = SLOTS, sample_count = SAMPLES)]
fn classic_ball_in_flight(bencher: Bencher<'_, '_>) {
    time_second_step(bencher, &classic::game(), &classic::flights(INPUTS, 0), 0);
}

/// The same, the world alone: the difference is what the rules cost.
#[divan::bench(sample_size = SLOTS, sample_count = SAMPLES)]
fn classic_ball_in_flight_world(bencher: Bencher<'_, '_>) {
    let states: Vec<_> = classic::flights(INPUTS, 0).into_iter().map(|state| state.world).collect();
    let world = World::new(Arc::clone(&classic::game().table().scene));
    time_second_step(bencher, &world, &states, 0);
}
