//! The window's input events, in order, as keys for the player's hands and wishes of the person.

use macroquad::input::utils::{register_input_subscriber, repeat_all_miniquad_input};
use macroquad::input::{KeyCode, MouseButton, simulate_mouse_with_touch};
use macroquad::math::vec2;
use macroquad::miniquad::{EventHandler, KeyMods, TouchPhase};

use crate::controls::Controls;
use crate::menu::{MenuEvent, MenuInput, MenuSorter};
use crate::pointer::{Pointer, Pointers, Surface};

/// What somebody at the keyboard wants, beside playing.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub(crate) enum Wish {
    /// Enter: play, play again, try again.
    Go,
    /// Escape: the menu.
    Back,
    /// P: let the game stand still.
    Pause,
    /// R: watch the last game again.
    Film,
    /// F11.
    FullScreen,
    /// F3.
    Statistics,
    /// F4.
    Overlay,
    /// F12.
    Picture,
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
    pointers: Pointers,
}

impl Keyboard {
    /// Needs macroquad's window; events from before are lost.
    pub(crate) fn new() -> Self {
        // Fingers come as fingers, not as a mouse as well.
        simulate_mouse_with_touch(false);
        Self { subscriber: register_input_subscriber(), pointers: Pointers::default() }
    }

    /// Gives what happened since the last call to somebody else.
    pub(crate) fn poll_with(&self, handler: &mut impl EventHandler) {
        repeat_all_miniquad_input(handler, self.subscriber);
    }

    /// Gives what happened since the last call to the controls and to `wish`. Without a surface, pointers work nothing.
    pub(crate) fn poll(&mut self, controls: &mut Controls, surface: Option<Surface>, wish: impl FnMut(Wish)) {
        let Self { subscriber, pointers } = self;
        repeat_all_miniquad_input(&mut Sorter { controls, pointers, surface, wish }, *subscriber);
    }

    /// The same while a menu is open: what is for it goes to `events`, and the function keys are wishes as ever.
    pub(crate) fn poll_menu(&mut self, events: &mut Vec<MenuEvent>, mut wish: impl FnMut(Wish)) {
        self.pointers.forget();
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
pub(crate) fn function_key(key: KeyCode) -> Option<Wish> {
    Some(match key {
        KeyCode::F11 => Wish::FullScreen,
        KeyCode::F3 => Wish::Statistics,
        KeyCode::F4 => Wish::Overlay,
        KeyCode::F12 => Wish::Picture,
        _ => return None,
    })
}

/// Sorts events into controls and wishes.
struct Sorter<'a, W> {
    controls: &'a mut Controls,
    pointers: &'a mut Pointers,
    surface: Option<Surface>,
    wish: W,
}

impl<W> Sorter<'_, W> {
    fn pressed(&mut self, pointer: Pointer, x: f32, y: f32) {
        if let Some(surface) = self.surface {
            self.pointers.down(self.controls, surface, pointer, vec2(x, y));
        }
    }

    fn moved(&mut self, pointer: Pointer, x: f32, y: f32) {
        if let Some(surface) = self.surface {
            self.pointers.moved(self.controls, surface, pointer, vec2(x, y));
        }
    }
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
            KeyCode::R => (self.wish)(Wish::Film),
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

    fn mouse_button_down_event(&mut self, button: MouseButton, x: f32, y: f32) {
        self.pressed(Pointer::Mouse(button), x, y);
    }

    fn mouse_motion_event(&mut self, x: f32, y: f32) {
        self.moved(Pointer::Mouse(MouseButton::Left), x, y);
    }

    fn mouse_button_up_event(&mut self, button: MouseButton, _x: f32, _y: f32) {
        self.pointers.up(self.controls, Pointer::Mouse(button));
    }

    fn touch_event(&mut self, phase: TouchPhase, id: u64, x: f32, y: f32) {
        match phase {
            TouchPhase::Started => self.pressed(Pointer::Finger(id), x, y),
            TouchPhase::Moved => self.moved(Pointer::Finger(id), x, y),
            TouchPhase::Ended | TouchPhase::Cancelled => self.pointers.up(self.controls, Pointer::Finger(id)),
        }
    }

    /// On X11 this is the loss of the keyboard's focus.
    fn window_minimized_event(&mut self) {
        self.controls.release_all();
        self.pointers.forget();
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn keys_are_sorted_in_order_and_repeats_dropped() {
        let mut controls = Controls::default();
        let mut wishes = Vec::new();
        let (pointers, surface) = (&mut Pointers::default(), None);
        let mut sorter = Sorter { controls: &mut controls, pointers, surface, wish: |wish| wishes.push(wish) };
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

    #[test]
    fn pointers_work_the_table_only_where_there_is_one() {
        let (mut controls, mut pointers) = (Controls::default(), Pointers::default());
        controls.frame(0.0, 0, true, |_, _| {});
        for surface in [None, Some(Surface { size: vec2(100.0, 100.0), ball_waits: false })] {
            let mut sorter = Sorter { controls: &mut controls, pointers: &mut pointers, surface, wish: |_| {} };
            sorter.touch_event(TouchPhase::Started, 1, 10.0, 10.0);
            sorter.mouse_button_down_event(MouseButton::Right, 10.0, 10.0);
            let mut count = 0;
            controls.frame(1.0, 100, true, |_, _| count += 1);
            assert_eq!(count, if surface.is_some() { 2 } else { 0 });
        }
        // What was pressed is let go wherever that happens.
        let mut sorter = Sorter { controls: &mut controls, pointers: &mut pointers, surface: None, wish: |_| {} };
        sorter.touch_event(TouchPhase::Cancelled, 1, 0.0, 0.0);
        sorter.mouse_button_up_event(MouseButton::Right, 0.0, 0.0);
        let mut count = 0;
        controls.frame(2.0, 200, true, |_, _| count += 1);
        assert_eq!(count, 2);
    }
}
