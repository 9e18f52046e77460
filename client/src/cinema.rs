//! A film on the screen: the keys that work it, what its events leave to be seen, what the screen says.
//!
//! Everything that is to be seen goes by the time of the film, so that flashes and floating points are slow in slow motion
//! and stand still in a pause.

mod keys;

use shared::game::GameEvent;

use crate::assemble;
use crate::audio::{Audio, Scene};
use crate::budget::Budget;
use crate::effects::Effects;
use crate::film::{Film, Projector};
use crate::screens::Words;
use crate::view::{FilmView, View};
pub(crate) use keys::{FilmKey, FilmKeys};

/// Seconds of the film that are skipped at once.
const SKIP: f64 = 5.0;
/// The fastest at which a film is heard: beyond it everything would sound at once.
const MOST_HEARD: f64 = 2.0;
/// Seconds of a step: a frame.
const FRAME: f64 = 1.0 / 60.0;

/// A film that somebody watches.
#[derive(Debug)]
pub(crate) struct Cinema {
    projector: Projector,
    effects: Effects,
    /// What happened since the last frame.
    fresh: Vec<GameEvent>,
    /// Local time of the last frame.
    last: Option<f64>,
}

impl Cinema {
    /// At the beginning of a film. `None`, if it cannot be played.
    pub(crate) fn new(film: Film) -> Option<Self> {
        Some(Self { projector: Projector::new(film)?, effects: Effects::default(), fresh: Vec::new(), last: None })
    }

    /// Goes on to local time `now`.
    pub(crate) fn advance(&mut self, now: f64) {
        let elapsed = now - self.last.replace(now).unwrap_or(now);
        let Self { projector, effects, fresh, .. } = self;
        fresh.clear();
        let table = projector.film().table().clone();
        let loose = projector.moment().balls.iter().filter(|ball| !ball.is_held).count();
        let mut budget = Budget::of_picture(table.scene.tick_seconds, 1);
        let first = projector.film().first();
        projector.advance(elapsed, &mut budget, |event| {
            let at = event.tick.saturating_sub(first) as f64 * table.scene.tick_seconds;
            effects.note(event, &table, loose, at);
            fresh.push(*event);
        });
    }

    /// Lets be heard what happened in this frame, unless it goes too fast for that.
    pub(crate) fn let_hear(&self, audio: &mut Audio) {
        if self.projector.speed() <= MOST_HEARD {
            let (moment, table) = (self.projector.moment(), self.projector.film().table());
            audio.hear(&Scene { table, board: 0, moment: &moment, events: &self.fresh, is_attract: false });
        } else {
            audio.hush();
        }
    }

    /// Does what a key is for.
    pub(crate) fn press(&mut self, key: FilmKey) {
        let (before, _) = self.projector.progress();
        let tick = 1.0;
        let frame = self.projector.ticks(FRAME).max(tick);
        match key {
            FilmKey::Toggle => self.projector.toggle(),
            FilmKey::Slower => self.projector.change_speed(-1),
            FilmKey::Faster => self.projector.change_speed(1),
            FilmKey::Skip { back: true } => self.projector.skip(-SKIP),
            FilmKey::Skip { back: false } => self.projector.skip(SKIP),
            FilmKey::Step { back, whole_frame } => {
                let by = if whole_frame { frame } else { tick };
                self.projector.step_by(if back { -by } else { by });
            }
            FilmKey::Rewind => self.projector.rewind(),
        }
        let (after, _) = self.projector.progress();
        if after < before {
            // They have not happened yet.
            self.effects = Effects::default();
        }
    }

    /// What is to be seen.
    pub(crate) fn view(&mut self, with_overlay: bool) -> View {
        let words = self.words();
        let film = FilmView {
            share: self.share(),
            time: self.time(),
            state: self.state(),
            is_wrong: self.projector.difference().is_some(),
        };
        let mut view = assemble::film_view(&self.projector, &mut self.effects, words, with_overlay);
        view.film = Some(film);
        view
    }

    fn words(&self) -> Words {
        let at = self.projector.at_seconds();
        let message = match (self.projector.difference(), self.effects.message(at)) {
            (Some(_), _) => "NOT WHAT WAS RECORDED".to_owned(),
            (None, Some(message)) => message.to_owned(),
            (None, None) => "REPLAY".to_owned(),
        };
        let toggle = match (self.projector.runs(), self.projector.is_at_end()) {
            (true, _) => "PAUSE",
            (false, true) => "AGAIN",
            (false, false) => "GO ON",
        };
        let keys = [
            ("SPACE", toggle),
            ("LEFT, RIGHT", "SPEED"),
            ("UP, DOWN", "SKIP 5 S"),
            ("COMMA, DOT", "STEP"),
            ("HOME", "FROM THE START"),
            ("ESC", "LEAVE"),
        ];
        let keys = keys.map(|(key, does)| (key.to_owned(), does.to_owned())).to_vec();
        Words { message, keys, ..Words::default() }
    }

    /// How much of the film has been seen, 0 to 1.
    fn share(&self) -> f32 {
        let (at, all) = self.projector.progress();
        if all > 0.0 { (at / all).clamp(0.0, 1.0) as f32 } else { 1.0 }
    }

    fn time(&self) -> String {
        let (at, all) = self.projector.progress();
        format!("{} / {}", clock(at), clock(all))
    }

    /// Whether it runs, and how fast; or where it differs from what was recorded.
    fn state(&self) -> String {
        if let Some(difference) = self.projector.difference() {
            return format!("DIFFERS AT {}", clock(self.projector.seconds_to(difference.tick)));
        }
        let speed = self.projector.speed();
        let speed = if speed < 1.0 { format!("1/{:.0}X", 1.0 / speed) } else { format!("{speed:.0}X") };
        match (self.projector.runs(), self.projector.is_at_end()) {
            (true, _) => speed,
            (false, true) => "THE END".to_owned(),
            (false, false) => format!("PAUSED {speed}"),
        }
    }
}

/// Minutes and seconds.
fn clock(seconds: f64) -> String {
    // A cast saturates.
    let whole = seconds.max(0.0) as u64;
    format!("{}:{:02}", whole / 60, whole % 60)
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn a_clock_has_minutes_and_seconds() {
        assert_eq!([0.0, 9.99, 61.0, 3600.0, -1.0].map(clock), ["0:00", "0:09", "1:01", "60:00", "0:00"]);
    }
}
