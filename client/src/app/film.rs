//! Films in the window: the last game once more, or a replay from a file.

use shared::game::Phase;

use super::{App, State};
use crate::arguments::Goal;
use crate::cinema::{Cinema, FilmKeys};
use crate::film::Film;
use crate::input::Wish;

impl App {
    /// Whether the last game can be watched again: it was filmed, and nobody at this window is playing.
    pub(super) fn last_film(&self) -> Option<&Film> {
        let State::Live(_, session) = &self.state else { return None };
        session.film().filter(|_| session.place().is_none() || !session.is_playing())
    }

    /// Watches the last game again, if that can be done.
    pub(super) fn watch_last(&mut self) {
        if let Some(film) = self.last_film().cloned() {
            self.watch(film);
        }
    }

    /// Watches a film. The game goes on meanwhile, if there is one.
    pub(super) fn watch(&mut self, film: Film) {
        self.controls.release_all();
        self.cinema = Cinema::new(film);
    }

    /// 2. What the person does while a film is on; `false` if they want to quit.
    pub(super) fn poll_film(&mut self) -> bool {
        let mut keys = FilmKeys::default();
        self.keyboard.poll_with(&mut keys);
        if let Some(cinema) = &mut self.cinema {
            keys.keys.into_iter().for_each(|key| cinema.press(key));
        }
        for wish in keys.wishes {
            if wish != Wish::Back {
                self.heed_everywhere(wish);
                continue;
            }
            self.cinema = None;
            if let Goal::Replay(_) = self.goal {
                return false;
            }
        }
        true
    }

    /// 3. The film goes on, until it is the person's turn to play.
    pub(super) fn advance_film(&mut self, now: f64) {
        let is_turn = match &self.state {
            State::Live(_, session) => session.place().is_some_and(|place| {
                let (board, seat) = session.board_and_seat(place);
                let phase = session.moment(board).map_or(Phase::Idle, |moment| moment.game.phase());
                phase.has_turn(seat)
            }),
            _ => false,
        };
        if is_turn {
            self.cinema = None;
        }
        if let Some(cinema) = &mut self.cinema {
            cinema.advance(now);
        }
    }
}
