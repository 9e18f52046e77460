//! Turns: who starts, whose ball it is, and when that ends.

use super::state::Phase;
use super::tilt::Tilt;
use super::{Game, GameEventKind, SEATS, Seat};
use crate::rules::Occasion;

/// Seconds between a lost ball and the next.
const SERVE_PAUSE: f64 = 1.5;
/// Seconds between the start of a game and its first ball.
const START_PAUSE: f64 = 0.3;

impl Game {
    pub(super) fn start(&mut self) {
        for seat in &mut self.play.seats {
            *seat = Seat { taken: seat.taken, playing: seat.taken, ..Seat::default() };
        }
        self.restart_crowd();
        self.emit(GameEventKind::Started);
        if let Some(first) = self.play.seats.iter().position(|seat| seat.playing) {
            self.begin_turn(first as u8, 1, START_PAUSE);
        }
    }

    pub(super) fn stand(&mut self, seat: u8) {
        let had_turn = self.play.phase.has_turn(seat);
        let place = &mut self.play.seats[usize::from(seat)];
        (place.taken, place.playing) = (false, false);
        self.emit(GameEventKind::StoodUp { seat });
        if had_turn {
            self.world.clear_balls();
            self.next_turn();
        }
    }

    /// A turn is given up, and the extra balls that would follow. What has been served ends as a ball that is lost does.
    pub(super) fn forfeit(&mut self, seat: u8) {
        let was_served = self.is_ball_of(seat);
        self.world.clear_balls();
        self.emit(GameEventKind::Forfeited { seat });
        if was_served {
            self.occasion(Occasion::BallEnd, None);
        }
        self.play.seats[usize::from(seat)].extra_waiting = 0;
        self.next_turn();
    }

    /// The player whose turn it is gets a ball in a while.
    fn begin_turn(&mut self, seat: u8, ball: u32, pause: f64) {
        for right in [false, true] {
            self.world.press(right, false);
        }
        self.world.pull(None);
        self.world.clear_balls();
        self.play.tilt = Tilt::default();
        self.world.still_the_bob();
        for (place, magnet) in (0..).zip(&self.table.scene.magnets) {
            self.world.switch(place, magnet.on);
        }
        let serve_in = self.ticks(pause);
        self.play.phase = Phase::Play {
            seat,
            ball,
            serve_in,
            untouched: true,
            still: 0,
            watched: 0,
            quiet: 0,
            searches: 0,
            extra: 0,
        };
    }

    fn next_turn(&mut self) {
        self.end_crowd();
        self.play.rules.end_save(&self.table);
        self.play.rules.lights.end_timers();
        let Phase::Play { seat, ball, .. } = self.play.phase else { return };
        let place = &mut self.play.seats[usize::from(seat)];
        if place.playing && place.extra_waiting > 0 {
            place.extra_waiting -= 1;
            self.begin_turn(seat, ball, SERVE_PAUSE);
            return self.emit(GameEventKind::Again { seat });
        }
        let playing = |from: usize, to: usize| (from..to).find(|&i| self.play.seats[i].playing);
        let (next, ball) = match playing(usize::from(seat) + 1, SEATS) {
            Some(next) => (Some(next), ball),
            None => (playing(0, SEATS), ball + 1),
        };
        match next {
            Some(next) if ball <= self.table.rules.balls => self.begin_turn(next as u8, ball, SERVE_PAUSE),
            _ => {
                for right in [false, true] {
                    self.world.press(right, false);
                }
                self.world.pull(None);
                self.play.phase = Phase::Over;
                self.emit(GameEventKind::Over);
            }
        }
    }

    /// Serves the ball whose pause is over.
    pub(super) fn serve_due(&mut self) {
        let Phase::Play { seat, ball, serve_in, .. } = &mut self.play.phase else { return };
        match serve_in {
            0 => {}
            1 => {
                *serve_in = 0;
                let (seat, ball) = (*seat, *ball);
                self.world.serve(self.table.ball_start);
                self.emit(GameEventKind::Served { seat, ball });
                self.occasion(Occasion::BallStart, None);
                self.play.rules.begin_ball(&self.table);
            }
            _ => *serve_in -= 1,
        }
    }

    /// When no ball is left, nor to come, the turn is over.
    pub(super) fn end_turn_when_lost(&mut self) {
        if let Phase::Play { seat, serve_in: 0, extra: 0, .. } = self.play.phase
            && self.world.state().balls.is_empty()
        {
            self.emit(GameEventKind::Lost { seat });
            self.pay_crowd_for_ball();
            self.occasion(Occasion::BallEnd, None);
            self.next_turn();
        }
    }
}
