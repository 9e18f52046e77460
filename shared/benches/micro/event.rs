//! A tick in which one ball bounces once and nothing else happens: the impact, the search for the next one, and the
//! tick around them (see `tick` for what that costs without).

use divan::Bencher;
use shared::physics::{EventKind, World, WorldState};

use super::classic;
use super::inputs::{INPUTS, table};
use super::moments::{SAMPLES, SLOTS, time_second_step};

/// Simulated at the most: where bounces lose energy, a ball comes to rest in a while.
const MOST_TICKS: u64 = 200_000;

/// States two ticks before the end of one with a single bounce, of a scene as it runs.
fn bounces(world: &mut World) -> Vec<WorldState> {
    let mut found = Vec::new();
    let (mut before, mut last) = (world.state().clone(), world.state().clone());
    let mut was_quiet = false;
    for _ in 0..MOST_TICKS {
        let events = world.step();
        if was_quiet && matches!(events, [event] if matches!(event.kind, EventKind::Touched { .. })) {
            found.push(before);
            if found.len() == INPUTS {
                break;
            }
        }
        was_quiet = events.is_empty();
        before = std::mem::replace(&mut last, world.state().clone());
    }
    found
}

fn time_bounces(bencher: Bencher<'_, '_>, text: &str) {
    let mut world = World::new(table(text).scene);
    let states = bounces(&mut world);
    time_second_step(bencher, &world, &states, 1);
}

/// One ball among four walls.
#[divan::bench(sample_size = SLOTS, sample_count = SAMPLES)]
fn bounce_in_box(bencher: Bencher<'_, '_>) {
    let text = "Scene(
        gravity: (0.0, -1.1101),
        balls: [(position: (0.138, 0.99), velocity: (1.26, -2.32))],
        elements: [Wall(points: [(0.0, 0.0), (0.514, 0.0), (0.514, 1.067), (0.0, 1.067), (0.0, 0.0)])],
    )";
    time_bounces(bencher, text);
}

/// One ball among 200 pegs, which a grid finds.
#[divan::bench(sample_size = SLOTS, sample_count = SAMPLES)]
fn bounce_among_pegs(bencher: Bencher<'_, '_>) {
    time_bounces(bencher, include_str!("../../tests/truth/scenes/p03_pegs200.ron"));
}

/// Of a game: bumpers, slingshots and their points included.
#[divan::bench(sample_size = SLOTS, sample_count = SAMPLES)]
fn bounce_on_classic(bencher: Bencher<'_, '_>) {
    time_second_step(bencher, &classic::game(), &classic::flights(INPUTS, 1), 1);
}
