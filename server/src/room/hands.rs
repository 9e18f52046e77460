//! The bot's hands, at each place where it sits.

use shared::game::{Bot, Game, Input, Phase, SEATS};
use shared::protocol::BoardInput;

use super::controls::Controls;
use crate::config::Config;
use crate::lobby::{Lobby, Sitter};

/// A bot for each place.
pub(super) struct Hands {
    seed: u64,
    games: u64,
    /// Habits of this game, and whether it is on.
    bots: [Option<Bot>; SEATS],
}

impl Hands {
    pub(super) fn new(config: &Config) -> Self {
        Self { seed: config.seed, games: 0, bots: Default::default() }
    }

    /// Plays a tick wherever the bot sits. Each game finds it with other habits.
    pub(super) fn play(&mut self, games: &[Game], lobby: &Lobby, controls: &mut Controls) {
        for place in 0..SEATS as u8 {
            let bot = &mut self.bots[usize::from(place)];
            let (board, seat) = controls.board_and_seat(place);
            let Some(game) = games.get(usize::from(board)) else { continue };
            if lobby.sitter(place) != Some(Sitter::Bot) || !matches!(game.phase(), Phase::Play { .. }) {
                *bot = None;
                continue;
            }
            let bot = bot.get_or_insert_with(|| {
                self.games += 1;
                Bot::new(seat, self.seed.wrapping_add(self.games - 1))
            });
            let tick = game.tick();
            bot.play(game, |action| controls.push(BoardInput { board, input: Input { tick, seat, action } }));
        }
    }
}
