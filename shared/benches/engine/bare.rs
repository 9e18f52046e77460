//! One ball among four walls: what the engine costs beyond a loop written for that alone.

use std::hint::black_box;

use super::by_hand::ByHand;
use super::scenes::{PULLS, bare, game, game_steps, steps, world};
use super::timing::{Case, Effort, Times, nanoseconds};

/// Simulated.
const SECONDS: u64 = 200;

pub(crate) fn run(effort: Effort) {
    let seconds = effort.of(SECONDS);
    let ticks = seconds * 1000;
    for (name, pull) in PULLS {
        let table = bare(pull);
        let scene = &table.scene;
        // All three do the same.
        let (mut reference, mut by_hand) = (world(scene), ByHand::new(scene));
        let events = steps(&mut reference, ticks);
        let impacts: u64 = (0..ticks).map(|_| by_hand.step()).sum();
        assert_eq!(impacts, events);
        assert_eq!(by_hand.flight, reference.state().balls[0].flight, "not the same world");
        let mut cases: [Case<'_>; 3] = [
            Box::new(|| {
                let mut by_hand = ByHand::new(scene);
                nanoseconds(|| {
                    for _ in 0..ticks {
                        black_box(by_hand.step());
                    }
                })
            }),
            Box::new(|| {
                let mut world = world(scene);
                nanoseconds(|| {
                    black_box(steps(&mut world, ticks));
                })
            }),
            Box::new(|| {
                let mut game = game(&table);
                nanoseconds(|| {
                    black_box(game_steps(&mut game, ticks));
                })
            }),
        ];
        let times = Times::measure(effort, &mut cases);
        println!("{name}, {:.2} events a second", events as f64 / seconds as f64);
        println!("  {:12} {:>14} {:>9} {:>9} {:>8}", "", "ns/sim second", "ns/tick", "ns/event", "ratio");
        for (case, what) in ["by hand", "World::step", "Game::step"].into_iter().enumerate() {
            let total = times.median(case);
            println!(
                "  {what:12} {:14.0} {:9.2} {:9.0} {:8.3}",
                total / seconds as f64,
                total / ticks as f64,
                total / events as f64,
                times.ratio(case, 0),
            );
        }
    }
}
