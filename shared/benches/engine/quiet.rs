//! A tick in which nothing happens.

use std::hint::black_box;
use std::sync::Arc;

use shared::game::{Action, Game, Input};
use shared::table::Table;

use super::by_hand::ByHand;
use super::scenes::{PULLS, empty, game, game_steps, steps, world};
use super::timing::{Case, Effort, Times, nanoseconds};

/// For ticks of about a nanosecond.
const TICKS: u64 = 2_000_000;
/// For Classic, where rules run in every tick.
const TICKS_OF_CLASSIC: u64 = 2000;

pub(crate) fn run(effort: Effort) {
    println!("ns/tick");
    for (name, pull) in PULLS {
        let table = empty(pull);
        let scene = &table.scene;
        let ticks = effort.of(TICKS);
        // The first step searches: it is not timed.
        let mut cases: [Case<'_>; 3] = [
            Box::new(|| {
                let mut by_hand = ByHand::new(scene);
                nanoseconds(|| {
                    for _ in 0..ticks {
                        assert_eq!(black_box(by_hand.step()), 0);
                    }
                })
            }),
            Box::new(|| {
                let mut world = world(scene);
                world.step();
                nanoseconds(|| assert_eq!(steps(&mut world, ticks), 0, "not quiet"))
            }),
            Box::new(|| {
                let mut game = game(&table);
                game.step(&[]);
                nanoseconds(|| assert_eq!(game_steps(&mut game, ticks), 0, "not quiet"))
            }),
        ];
        let times = Times::measure(effort, &mut cases);
        for (case, what) in ["by hand", "World::step", "Game::step"].into_iter().enumerate() {
            println!("  {:36} {:8.2}", format!("one ball, {name}, {what}"), times.median(case) / ticks as f64);
        }
    }
    classic(effort);
}

fn classic(effort: Effort) {
    let Some(Ok(table)) = Table::shipped("classic") else { panic!("it is shipped") };
    let table = Arc::new(table);
    let mut waiting = game(&table);
    // A ball that lies on the plunger.
    let mut playing = game(&table);
    for action in [Action::Sit, Action::Start] {
        let tick = playing.tick();
        playing.step(&[Input { tick, seat: 0, action }]);
    }
    game_steps(&mut playing, 3000);
    let ticks = TICKS_OF_CLASSIC;
    let timed = |start: &mut Game| {
        let mut game = start.clone();
        nanoseconds(|| {
            black_box(game_steps(&mut game, ticks));
        })
    };
    let mut cases: [Case<'_>; 2] = [Box::new(|| timed(&mut waiting)), Box::new(|| timed(&mut playing))];
    let times = Times::measure(effort, &mut cases);
    for (case, what) in ["nobody plays", "a ball on the plunger"].into_iter().enumerate() {
        println!("  {:36} {:8.2}", format!("Classic, {what}, Game::step"), times.median(case) / ticks as f64);
    }
}
