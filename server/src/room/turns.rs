//! Whose turn it is to play: who is seated when, when a game begins, who idles, who stays after it; and what the crowd does.

use shared::game::{Action, Game, HOUSE, Input, Phase};
use shared::protocol::BoardInput;

use super::{BOT_PATIENCE, NEXT_GAME_PAUSE, Outcome, RESULT_PAUSE, Room};
use crate::lobby::Sitter;

impl Room {
    /// 1. Seats the next in line where the game lets them in; begins the next game when somebody new came up for it, or
    ///    somebody waits for one; after a while without a game, the bot plays.
    pub(super) fn fill_places(&mut self) {
        let deeds = self.lobby.fill_places(self.view());
        self.perform(&deeds);
        if self.is_playing() {
            (self.idle_ticks, self.next_game_in) = (0, 0);
            return;
        }
        self.idle_ticks += 1;
        let waits_long = self.lobby.has_line() && self.idle_ticks > self.ticks(self.config.idle_time.as_secs_f64());
        if self.next_game_in == 1 || waits_long {
            let deeds = self.lobby.start_for_all();
            self.perform(&deeds);
            self.idle_ticks = 0;
        }
        self.next_game_in = self.next_game_in.saturating_sub(1);
        if self.config.attract && !self.lobby.has_people() && self.idle_ticks >= self.ticks(BOT_PATIENCE) {
            let mut deeds = self.lobby.attract();
            if deeds.is_empty() {
                deeds = self.lobby.start_for_all();
            }
            self.idle_ticks = 0;
            self.perform(&deeds);
        }
    }

    /// 1. Whoever has the turn and does nothing for too long loses it.
    pub(super) fn hurry_idlers(&mut self) {
        let most = self.ticks(self.config.idle_time.as_secs_f64());
        for board in 0..self.games.len() {
            let Phase::Play { seat, serve_in: 0, .. } = self.games[board].phase() else { continue };
            let place = if self.games.len() > 1 { board as u8 } else { seat };
            if !matches!(self.lobby.sitter(place), Some(Sitter::Client(_))) {
                continue;
            }
            if self.controls.is_idle(board, &self.games[board], place, most) {
                if self.chatter.may_speak() {
                    tracing::info!("{} does nothing and loses the turn", self.lobby.name_of(place));
                }
                self.account.forfeited += 1;
                self.controls.perform(self.now(), place, Action::Forfeit);
            }
        }
    }

    /// 2. When the time to vote is up, the house does what most want.
    pub(super) fn count_votes(&mut self) {
        let (tick, actions) = (self.now(), self.crowd_actions());
        let game = &self.games[0];
        if let Some(action) = self.votes.count(tick, actions, |action| game.can_crowd(action).is_ok()) {
            let input = Input { tick, seat: HOUSE, action: Action::Crowd(action) };
            self.controls.push(BoardInput { board: 0, input });
        }
    }

    /// 4. A game began: whatever was left of the one before is of no interest any more.
    pub(super) fn begin_game(&mut self) {
        self.votes.clear();
        self.result = None;
        self.contestants = 0;
    }

    /// 4. After a game, and when its result has stood for a moment: who stays, who makes room.
    pub(super) fn note_end_of_game(&mut self) {
        let is_playing = self.is_playing();
        if is_playing {
            let playing = self.games.iter().flat_map(Game::seats).filter(|seat| seat.playing).count();
            self.contestants = self.contestants.max(playing);
        }
        if std::mem::replace(&mut self.was_playing, is_playing) && !is_playing {
            self.result = self.outcome();
            self.votes.clear();
        }
        let now = self.now();
        if let Some(result) = self.result.take_if(|result| now >= result.stands_until) {
            self.settle(result);
        }
    }

    /// How the game that has just ended came out; `None` if everybody left.
    fn outcome(&self) -> Option<Outcome> {
        let mut scores = Vec::new();
        for (board, game) in (0_u8..).zip(&self.games) {
            for (seat, seated) in (0_u8..).zip(game.seats()) {
                if seated.playing && matches!(game.phase(), Phase::Over) {
                    let (place, points) = (if self.games.len() > 1 { board } else { seat }, seated.score.points);
                    if self.chatter.may_speak() {
                        tracing::info!("game over: {} has {points} points", self.lobby.name_of(place));
                    }
                    scores.extend(self.lobby.sitter(place).map(|sitter| (place, sitter, points)));
                }
            }
        }
        // Whoever is left alone has won too; the first one of equals.
        let best = scores.iter().max_by_key(|&&(place, _, points)| (points, u8::MAX - place));
        let winner = best.filter(|_| self.contestants > 1).map(|&(place, ..)| place);
        let had_line = self.lobby.has_line();
        // Whoever has to make room sees the result first.
        let pause = if had_line { self.ticks(RESULT_PAUSE) } else { 0 };
        (!scores.is_empty()).then_some(Outcome { stands_until: self.now() + pause, scores, winner, had_line })
    }

    fn settle(&mut self, result: Outcome) {
        let stays = |place: u8, sitter| self.lobby.sitter(place) == Some(sitter);
        let stayed: Vec<_> = result.scores.into_iter().filter(|&(place, sitter, _)| stays(place, sitter)).collect();
        let winner = result.winner.filter(|winner| stayed.iter().any(|(place, ..)| place == winner));
        let scores: Vec<(u8, u64)> = stayed.iter().map(|&(place, _, points)| (place, points)).collect();
        let had_line = result.had_line || self.lobby.has_line();
        let deeds = self.lobby.make_room(&scores, winner);
        self.perform(&deeds);
        self.next_game_in = if had_line { self.ticks(NEXT_GAME_PAUSE) } else { 0 };
    }
}
