//! The picture goes on: [`Session::advance`] is the flow of it, once a frame.

use shared::protocol::{ClientMessage, Form};

use super::Session;
use crate::budget::Budget;
use crate::controls::Controls;
use crate::prediction::{Prediction, Verdict};

/// Seconds by which an input should be early at the server: the server wakes every 4 ms, and messages wait for it.
const EARLY: f64 = 0.006;
/// Seconds by which the prediction is ahead beyond what the way takes: a frame, as its keys act from its beginning on,
/// and what they should be early.
const MARGIN: f64 = 1.0 / 60.0 + EARLY;
/// Seconds that the prediction is ahead at most. The server allows inputs 0.25 s ahead.
const MOST_LEAD: f64 = 0.2;
/// Seconds from the newest frame at which a prediction waits for the next one: the server has stalled.
const MOST_AHEAD: f64 = 0.3;
/// Seconds that a prediction may be ahead of where it should be; beyond that the server has lost time, and it begins anew.
const MOST_EXCESS: f64 = 0.05;
/// Seconds between two states that are kept of a stream of inputs.
const KEEP_EVERY: f64 = 1.0 / 60.0;
/// Seconds after the first frame in which it is not told how far behind the picture is: nobody knows the stream yet.
const WARM_UP: f64 = 2.0;

impl Session {
    /// Brings the picture to local time `now`: pings, plays the player's hands, predicts, lets events be seen.
    pub(crate) fn advance(&mut self, now: f64, controls: &mut Controls) {
        // 1. What is to be said.
        // While the room stands still, answers are all that comes.
        if let Some(nonce) = self.pings.due(now, self.place.is_some() || self.is_paused()) {
            self.outbox.push(ClientMessage::Ping { nonce });
        }
        self.outbox.extend(self.feed.request(now));
        let time = self.time.at(now);
        let Some(live) = self.clock.tick_at(time) else {
            return controls.frame(time, 0, false, |_, _| {});
        };
        // 2. The board of whoever has the turn, predicted.
        let turn = self.turn();
        match turn {
            Some((board, seat)) => self.predict(now, live, board, seat, controls),
            None => {
                self.prediction = None;
                controls.frame(time, 0, false, |_, _| {});
            }
        }
        // 3. Everything else, a little late.
        self.show_late(now, live, turn.map(|(board, _)| board));
        self.update_contest();
        if self.feed.form() == Form::Inputs {
            self.camera.look(self.feed.games(), &self.roster, self.place.is_some());
        }
        // 4. What comes until the next picture counts as part of that.
        self.budget = Budget::of_picture(self.table.scene.tick_seconds, self.boards.len());
    }

    /// What was sent is kept, for boards that are seen late while the copies are as new as can be.
    pub(super) fn keep_what_was_sent(&mut self) {
        let every = (KEEP_EVERY / self.table.scene.tick_seconds).max(1.0) as u64;
        let Self { feed, boards, budget, camera, .. } = self;
        loop {
            let (mut events, before) = (Vec::new(), feed.tick());
            // Also where the copies are there already: digests are compared.
            let next = if feed.form() == Form::Inputs { before + every } else { u64::MAX };
            feed.advance(next, budget, |board, event| {
                camera.see(event);
                events.push((board, *event));
            });
            for (place, (board, game)) in (0..).zip(boards.iter_mut().zip(feed.games())) {
                board.push(game, events.iter().filter(|(of, _)| *of == place).map(|(_, event)| *event));
            }
            // Where the budget is spent, the next picture goes on.
            if feed.tick() >= feed.confirmed() || feed.is_lost() || feed.tick() == before {
                return;
            }
        }
    }

    /// Board and seat of the person at the window, if it is their turn.
    fn turn(&self) -> Option<(usize, u8)> {
        let (board, seat) = self.board_and_seat(self.place?);
        let game = self.feed.games().get(board)?;
        // Until the stream of players comes, nobody knows how late the server is.
        (game.phase().has_turn(seat) && !self.feed.is_switching()).then_some((board, seat))
    }

    /// 2. The player's own board, ahead of the server.
    fn predict(&mut self, now: f64, live: f64, place: usize, seat: u8, controls: &mut Controls) {
        let dt = self.table.scene.tick_seconds;
        let loose = self.loose_balls(place);
        let (time, is_paused) = (self.time.at(now), self.is_paused());
        let lead = self.lead.at(time, MARGIN, MOST_LEAD) / dt;
        let (Some(newest), Some(board)) = (self.feed.games().get(place), self.boards.get_mut(place)) else { return };
        let target = (live + lead).min(newest.tick() as f64 + MOST_AHEAD / dt);
        let prediction = match &mut self.prediction {
            Some(prediction) if prediction.seat() == seat && (prediction.tick() as f64) < target + MOST_EXCESS / dt => {
                let mut instead = Vec::new();
                match prediction.confirm(newest, &mut self.budget, |event| instead.push(*event)) {
                    Some(Verdict::Right) => self.counts.right += 1,
                    Some(Verdict::Wrong) => {
                        self.counts.wrong += 1;
                        board.correct(newest.tick(), &instead);
                    }
                    Some(Verdict::Unknown) | None => {}
                }
                prediction
            }
            other => {
                // What was shown beyond it happens now, or never.
                board.correct(newest.tick(), &[]);
                other.insert(Prediction::new(newest, seat))
            }
        };
        // After a frame that took long, its first tick is too early for an input to arrive in time.
        let earliest = (live + lead - (MARGIN - EARLY) / dt).max(0.0).ceil() as u64;
        if is_paused {
            controls.wait();
        } else {
            controls.frame(time, earliest.max(prediction.tick()), true, |tick, action| {
                let tick = prediction.act(tick, action);
                self.outbox.push(ClientMessage::Act { tick, action });
            });
        }
        let target_tick = target.max(0.0) as u64;
        prediction.advance(target_tick, &mut self.budget, |event| board.note(event, &self.table, loose, now));
        board.seen_until(prediction.tick());
        board.shown = target.max(prediction.tick() as f64);
        self.counts.lead = lead;
        // They were seen when they were predicted.
        board.snapshots.take_events(f64::INFINITY, |_| {});
    }

    /// 3. All boards but the one that is predicted.
    fn show_late(&mut self, now: f64, live: f64, predicted: Option<usize>) {
        let dt = self.table.scene.tick_seconds;
        let interval = 1.0 / f64::from(self.feed.stream().hz);
        let delay = self.delay.at(self.time.at(now), interval, self.clock.offset()) / dt;
        let is_stepped = self.is_stepped();
        if !is_stepped && self.feed.tick() < self.feed.confirmed() {
            // The person has just got a place.
            self.keep_what_was_sent();
        }
        let newest = if is_stepped { self.feed.confirmed() as f64 } else { f64::INFINITY };
        let target = (live - delay).min(newest);
        let loose: Vec<usize> = (0..self.boards.len()).map(|board| self.loose_balls(board)).collect();
        let Self { feed, boards, table, budget, camera, .. } = self;
        for (place, (board, &loose)) in boards.iter_mut().zip(&loose).enumerate() {
            if Some(place) == predicted {
                continue;
            }
            board.show(target, dt);
            if !is_stepped {
                board.note_sent(table, loose, now);
            }
        }
        if is_stepped {
            feed.advance(target.max(0.0) as u64, budget, |place, event| {
                camera.see(event);
                let place = usize::from(place);
                if let (Some(board), Some(&loose)) = (boards.get_mut(place), loose.get(place)) {
                    board.note(event, table, loose, now);
                }
            });
            for board in boards.iter_mut() {
                board.seen_until(feed.tick());
            }
        }
        self.note_behind(now, predicted);
    }

    /// How far behind the server the picture is, as far as anybody can tell from here.
    fn note_behind(&mut self, now: f64, predicted: Option<usize>) {
        let warm = now - *self.began_at.get_or_insert(now) > WARM_UP;
        let main = self.main_board();
        let shown = self.boards[main].shown;
        let seen = if self.is_stepped() { shown.min(self.feed.confirmed() as f64) } else { shown };
        let truth = self.truth.tick_at(self.time.at(now)).filter(|_| warm && predicted != Some(main));
        self.counts.behind.note(truth.map(|truth| (truth - seen) * self.table.scene.tick_seconds));
    }

    /// Balls of a board that no saucer holds, as it is seen.
    fn loose_balls(&self, board: usize) -> usize {
        self.moment(board).map_or(0, |moment| moment.balls.iter().filter(|ball| !ball.is_held).count())
    }
}
