//! How many bytes a game's state takes: it is sent again and again.

use std::sync::Arc;

use super::{Action, Bot, Game, HOUSE, Input, Nudge, Phase, SEATS};
use crate::protocol::encode;
use crate::table::Table;

/// What fits into one packet of every network with all that is around it.
const MOST_BYTES: usize = 460;

#[test]
fn the_state_of_four_players_with_two_balls_in_play_is_small() {
    let Some(Ok(table)) = Table::shipped("classic") else { panic!("Classic is shipped") };
    let table = Arc::new(table);
    // By the balls in play: the largest state.
    let mut largest = [0; 5];
    for seed in 0..8 {
        let mut game = Game::new(Arc::clone(&table));
        let mut bots: Vec<_> = (0..SEATS as u8).map(|seat| Bot::new(seat, seed + 100 * u64::from(seat))).collect();
        let mut inputs = Vec::new();
        while game.tick() < 900_000 {
            let tick = game.tick();
            inputs.clear();
            for (seat, bot) in (0..).zip(&mut bots) {
                if tick == 0 {
                    inputs.push(Input { tick, seat, action: Action::Sit });
                }
                bot.play(&game, |action| inputs.push(Input { tick, seat, action }));
            }
            match game.phase() {
                Phase::Play { seat, .. } if tick.is_multiple_of(9_001) => {
                    for nudge in [Nudge::FromLeft, Nudge::Forward] {
                        inputs.push(Input { tick, seat, action: Action::Nudge(nudge) });
                    }
                }
                Phase::Play { .. } => {}
                _ => inputs.push(Input { tick, seat: 0, action: Action::Start }),
            }
            if let Some(place) = (0..8).rev().find(|&place| game.can_crowd(place).is_ok()) {
                inputs.push(Input { tick, seat: HOUSE, action: Action::Crowd(place) });
            }
            game.step(&inputs);
            if tick.is_multiple_of(16) {
                let balls = game.world().state().balls.len().min(largest.len() - 1);
                largest[balls] = encode(&game.state()).len().max(largest[balls]);
            }
        }
    }
    println!("bytes of the largest state with 0, 1, 2, 3 and more balls in play: {largest:?}");
    assert!(largest[2] > 0, "there never were two");
    assert!(largest[..3].iter().all(|&bytes| bytes <= MOST_BYTES), "{largest:?}");
}
