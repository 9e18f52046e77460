//! The window's input events, in order, as keys for the player's hands and wishes of the person.

use macroquad::input::KeyCode;
use macroquad::input::utils::{register_input_subscriber, repeat_all_miniquad_input};
use macroquad::miniquad::{EventHandler, KeyMods};

use crate::controls::Controls;
use crate::menu::{MenuEvent, MenuInput, MenuSorter};

/// What somebody at the keyboard wants, beside playing.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub(crate) enum Wish {
    /// Enter: play, play again, try again.
    Go,
    /// Escape: the menu.
    Back,
    /// P: let the game stand still.
    Pause,
    /// F11.
    FullScreen,
    /// F3.
    Statistics,
    /// F4.
    Overlay,
    /// 1 to 9: a vote for what the crowd does, from 0.
    Vote(u8),
    /// Tab and the arrows: a look at another board, so many further on.
    Look(i8),
}

/// The keys that vote, in order.
const VOTES: [[KeyCode; 2]; 9] = [
    [KeyCode::Key1, KeyCode::Kp1],
    [KeyCode::Key2, KeyCode::Kp2],
    [KeyCode::Key3, KeyCode::Kp3],
    [KeyCode::Key4, KeyCode::Kp4],
    [KeyCode::Key5, KeyCode::Kp5],
    [KeyCode::Key6, KeyCode::Kp6],
    [KeyCode::Key7, KeyCode::Kp7],
    [KeyCode::Key8, KeyCode::Kp8],
    [KeyCode::Key9, KeyCode::Kp9],
];

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

    /// The same while a menu is open: what is for it goes to `events`, and the function keys are wishes as ever.
    pub(crate) fn poll_menu(&self, events: &mut Vec<MenuEvent>, mut wish: impl FnMut(Wish)) {
        let mut sorter = MenuSorter::default();
        repeat_all_miniquad_input(&mut sorter, self.subscriber);
        for event in sorter.0 {
            match event {
                MenuEvent::Input(MenuInput::Key(key)) => match function_key(key) {
                    Some(known) => wish(known),
                    None => events.push(event),
                },
                _ => events.push(event),
            }
        }
    }
}

/// What a function key is for, everywhere.
fn function_key(key: KeyCode) -> Option<Wish> {
    Some(match key {
        KeyCode::F11 => Wish::FullScreen,
        KeyCode::F3 => Wish::Statistics,
        KeyCode::F4 => Wish::Overlay,
        _ => return None,
    })
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
        if let Some(wish) = function_key(key) {
            return (self.wish)(wish);
        }
        match key {
            KeyCode::Enter | KeyCode::KpEnter => (self.wish)(Wish::Go),
            KeyCode::Escape => (self.wish)(Wish::Back),
            KeyCode::P | KeyCode::Pause => (self.wish)(Wish::Pause),
            KeyCode::Tab => (self.wish)(Wish::Look(1)),
            _ => {
                let vote = VOTES.iter().zip(0..).find(|(keys, _)| keys.contains(&key));
                if let Some((_, vote)) = vote {
                    (self.wish)(Wish::Vote(vote));
                }
                // Who plays has flippers on these.
                match key {
                    KeyCode::Left => (self.wish)(Wish::Look(-1)),
                    KeyCode::Right => (self.wish)(Wish::Look(1)),
                    _ => {}
                }
                self.controls.key_down(key);
            }
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
        sorter.key_down_event(KeyCode::Key3, none, false);
        sorter.key_down_event(KeyCode::Kp9, none, false);
        sorter.key_down_event(KeyCode::Left, none, false);
        sorter.key_down_event(KeyCode::Tab, none, false);
        sorter.key_down_event(KeyCode::Escape, none, false);
        sorter.window_minimized_event();
        assert_eq!(
            wishes,
            [Wish::Go, Wish::Overlay, Wish::Vote(2), Wish::Vote(8), Wish::Look(-1), Wish::Look(1), Wish::Back]
        );
        // Pressed and released before the turn began: nothing is held.
        controls.frame(0.0, 0, true, |tick, action| panic!("{action:?} at {tick}"));
    }
}
