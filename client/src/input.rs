//! The window's input events, in order, as keys for the player's hands and wishes of the person.

use macroquad::input::KeyCode;
use macroquad::input::utils::{register_input_subscriber, repeat_all_miniquad_input};
use macroquad::miniquad::{EventHandler, KeyMods};

use crate::controls::Controls;

/// What somebody at the keyboard wants, beside playing.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub(crate) enum Wish {
    /// Enter: play, play again, try again.
    Go,
    /// Escape: leave the seat, or the game.
    Back,
    /// F11.
    FullScreen,
    /// F3.
    Statistics,
    /// F4.
    Overlay,
}

/// Where the window's events come in.
#[derive(Debug)]
pub(crate) struct Keyboard {
    subscriber: usize,
}

impl Keyboard {
    /// Needs macroquad's window; events from before are lost.
    pub(crate) fn new() -> Self {
        Self { subscriber: register_input_subscriber() }
    }

    /// Gives what happened since the last call to the controls and to `wish`.
    pub(crate) fn poll(&self, controls: &mut Controls, wish: impl FnMut(Wish)) {
        repeat_all_miniquad_input(&mut Sorter { controls, wish }, self.subscriber);
    }
}

/// Sorts events into controls and wishes.
struct Sorter<'a, W> {
    controls: &'a mut Controls,
    wish: W,
}

impl<W: FnMut(Wish)> EventHandler for Sorter<'_, W> {
    fn update(&mut self) {}

    fn draw(&mut self) {}

    fn key_down_event(&mut self, key: KeyCode, _modifiers: KeyMods, repeat: bool) {
        if repeat {
            return;
        }
        match key {
            KeyCode::Enter | KeyCode::KpEnter => (self.wish)(Wish::Go),
            KeyCode::Escape => (self.wish)(Wish::Back),
            KeyCode::F11 => (self.wish)(Wish::FullScreen),
            KeyCode::F3 => (self.wish)(Wish::Statistics),
            KeyCode::F4 => (self.wish)(Wish::Overlay),
            _ => self.controls.key_down(key),
        }
    }

    fn key_up_event(&mut self, key: KeyCode, _modifiers: KeyMods) {
        self.controls.key_up(key);
    }

    /// On X11 this is the loss of the keyboard's focus.
    fn window_minimized_event(&mut self) {
        self.controls.release_all();
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn keys_are_sorted_in_order_and_repeats_dropped() {
        let mut controls = Controls::default();
        let mut wishes = Vec::new();
        let mut sorter = Sorter { controls: &mut controls, wish: |wish| wishes.push(wish) };
        let none = KeyMods::default();
        sorter.key_down_event(KeyCode::Enter, none, false);
        sorter.key_down_event(KeyCode::Enter, none, true);
        sorter.key_down_event(KeyCode::A, none, false);
        sorter.key_down_event(KeyCode::F4, none, false);
        sorter.key_down_event(KeyCode::Escape, none, false);
        sorter.window_minimized_event();
        assert_eq!(wishes, [Wish::Go, Wish::Overlay, Wish::Back]);
        // Pressed and released before the turn began: nothing is held.
        controls.frame(0.0, 0, true, |tick, action| panic!("{action:?} at {tick}"));
    }
}
