//! Whoever plays: a bot's hands at a copy of the game, a little ahead of the server.

use std::sync::Arc;

use shared::game::{Bot, Game, Input, Phase};
use shared::protocol::{ClientMessage, Follower, Heard, Mode, ServerMessage, encode, framed};
use shared::table::Table;

use crate::spectator;

/// Seconds by which it plays ahead of the last frame: a frame's interval, the way there, and some to spare.
const LEAD: f64 = 0.04;
/// Microseconds between two requests for a game.
const ASK_EVERY: u64 = 1_000_000;

/// A connection that plays.
#[derive(Debug)]
pub(crate) struct Player {
    follower: Follower,
    mode: Mode,
    place: Option<u8>,
    bot: Bot,
    seed: u64,
    /// What it did that the server has not confirmed.
    own: Vec<Input>,
    /// The first tick that the bot was not asked about.
    unasked: u64,
    may_ask: u64,
}

impl Player {
    /// One that has just been let in.
    pub(crate) fn new(table: Arc<Table>, mode: Mode, seed: u64) -> Self {
        Self {
            follower: Follower::new(table),
            mode,
            place: None,
            bot: Bot::new(0, seed),
            seed,
            own: Vec::new(),
            unasked: 0,
            may_ask: 0,
        }
    }

    /// Whether its stream has begun.
    pub(crate) fn has_begun(&self) -> bool {
        !self.follower.games().is_empty()
    }

    /// Takes in a message at `now`; what is to be said goes to `replies`.
    ///
    /// # Errors
    /// If no server of ours would send that.
    pub(crate) fn hear(&mut self, message: &ServerMessage, now: u64, replies: &mut Vec<u8>) -> Result<(), String> {
        if let ServerMessage::You { place, .. } = message {
            if *place != self.place {
                self.place = *place;
                self.bot = Bot::new(self.board_and_seat().1, self.seed);
                self.own.clear();
            }
            return Ok(());
        }
        let heard = spectator::hear(&mut self.follower, message)?;
        match heard.and_then(|heard| self.follower.advance(u64::MAX, |_, _| {}).map(|()| heard)) {
            Ok(Heard::Nothing) => {}
            Ok(Heard::Further | Heard::Anew) => self.play(now, replies),
            Err(mismatch) => {
                let differs = ClientMessage::Differs { tick: mismatch.tick, digest: mismatch.ours };
                replies.extend(framed(&encode(&differs)));
            }
        }
        Ok(())
    }

    /// Where its place is.
    fn board_and_seat(&self) -> (u8, u8) {
        match (self.mode, self.place.unwrap_or(0)) {
            (Mode::HeadToHead, place) => (place, 0),
            (Mode::Challenge | Mode::Crowd, place) => (0, place),
        }
    }

    /// Has the bot play the ticks that it can see now and could not before.
    fn play(&mut self, now: u64, replies: &mut Vec<u8>) {
        let (board, seat) = self.board_and_seat();
        let Some(game) = self.follower.games().get(usize::from(board)) else { return };
        if self.place.is_none() {
            return;
        }
        if !matches!(game.phase(), Phase::Play { .. }) {
            if now >= self.may_ask {
                self.may_ask = now + ASK_EVERY;
                replies.extend(framed(&encode(&ClientMessage::Play)));
            }
            return;
        }
        let mut ahead: Game = game.clone();
        let until = ahead.tick() + (LEAD / ahead.table().scene.tick_seconds) as u64;
        self.own.retain(|input| input.tick >= ahead.tick());
        while ahead.tick() < until {
            let tick = ahead.tick();
            if tick >= self.unasked {
                self.bot.play(&ahead, |action| {
                    self.own.push(Input { tick, seat, action });
                    replies.extend(framed(&encode(&ClientMessage::Act { tick, action })));
                });
                self.unasked = tick + 1;
            }
            ahead.step(&self.own);
        }
    }
}
