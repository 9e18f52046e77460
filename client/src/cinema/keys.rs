//! The keys that work a film.

use macroquad::input::KeyCode;
use macroquad::miniquad::{EventHandler, KeyMods};

use crate::input::{Wish, function_key};

/// What keys do with a film.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub(crate) enum FilmKey {
    /// Stands still, or goes on.
    Toggle,
    /// Half as fast.
    Slower,
    /// Twice as fast.
    Faster,
    /// On or back by some seconds.
    Skip { back: bool },
    /// On or back by a frame or a tick; then it stands still.
    Step { back: bool, whole_frame: bool },
    /// To the beginning.
    Rewind,
}

/// Sorts what happens at the keyboard while a film is on.
#[derive(Debug, Default)]
pub(crate) struct FilmKeys {
    /// For the film, in order.
    pub(crate) keys: Vec<FilmKey>,
    /// For the program, in order.
    pub(crate) wishes: Vec<Wish>,
}

impl EventHandler for FilmKeys {
    fn update(&mut self) {}

    fn draw(&mut self) {}

    /// A key that is held steps on and skips on.
    fn key_down_event(&mut self, key: KeyCode, modifiers: KeyMods, repeat: bool) {
        let whole_frame = !modifiers.shift;
        let film = match key {
            KeyCode::Period => FilmKey::Step { back: false, whole_frame },
            KeyCode::Comma => FilmKey::Step { back: true, whole_frame },
            KeyCode::Up => FilmKey::Skip { back: false },
            KeyCode::Down => FilmKey::Skip { back: true },
            _ if repeat => return,
            KeyCode::Space | KeyCode::P | KeyCode::Pause => FilmKey::Toggle,
            KeyCode::Left => FilmKey::Slower,
            KeyCode::Right => FilmKey::Faster,
            KeyCode::Home => FilmKey::Rewind,
            KeyCode::Escape | KeyCode::R => return self.wishes.push(Wish::Back),
            _ => return self.wishes.extend(function_key(key)),
        };
        self.keys.push(film);
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn keys_are_for_the_film_or_for_the_program() {
        let mut keys = FilmKeys::default();
        let shift = KeyMods { shift: true, ..KeyMods::default() };
        keys.key_down_event(KeyCode::Period, KeyMods::default(), false);
        keys.key_down_event(KeyCode::Comma, shift, true);
        keys.key_down_event(KeyCode::Space, KeyMods::default(), false);
        keys.key_down_event(KeyCode::Space, KeyMods::default(), true);
        keys.key_down_event(KeyCode::Z, KeyMods::default(), false);
        keys.key_down_event(KeyCode::F4, KeyMods::default(), false);
        keys.key_down_event(KeyCode::Escape, KeyMods::default(), false);
        let step = |back, whole_frame| FilmKey::Step { back, whole_frame };
        assert_eq!(keys.keys, [step(false, true), step(true, false), FilmKey::Toggle]);
        assert_eq!(keys.wishes, [Wish::Overlay, Wish::Back]);
    }
}
