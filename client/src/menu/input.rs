//! The window's events, in order, for a menu that is open.

use macroquad::input::{KeyCode, MouseButton};
use macroquad::math::{Vec2, vec2};
use macroquad::miniquad::{EventHandler, KeyMods, window};

use super::MenuInput;
use crate::input::function_key;

/// What happened.
#[derive(Debug, Clone, PartialEq)]
pub(crate) enum MenuEvent {
    /// To be given to the menu as it is.
    Input(MenuInput),
    /// The pointer moved to a point of the window, or was pressed there; in its pixels.
    Pointer {
        /// Where.
        at: Vec2,
        /// Whether it was pressed.
        pressed: bool,
    },
}

/// Collects what is for a menu. Fingers are pointers, as the trait has it.
#[derive(Debug, Default)]
pub(crate) struct MenuSorter(pub(crate) Vec<MenuEvent>);

impl EventHandler for MenuSorter {
    fn update(&mut self) {}

    fn draw(&mut self) {}

    fn key_down_event(&mut self, key: KeyCode, modifiers: KeyMods, repeat: bool) {
        // Held, these would choose what the next page has there.
        let is_once = matches!(key, KeyCode::Enter | KeyCode::KpEnter | KeyCode::Space | KeyCode::Escape);
        if repeat && (is_once || function_key(key).is_some()) {
            return;
        }
        if key == KeyCode::V && (modifiers.ctrl || modifiers.logo) {
            self.0.extend(window::clipboard_get().map(|text| MenuEvent::Input(MenuInput::Paste(text))));
        }
        self.0.push(MenuEvent::Input(MenuInput::Key(key)));
    }

    fn char_event(&mut self, character: char, modifiers: KeyMods, _repeat: bool) {
        if !modifiers.ctrl && !modifiers.logo {
            self.0.push(MenuEvent::Input(MenuInput::Char(character)));
        }
    }

    fn mouse_motion_event(&mut self, x: f32, y: f32) {
        self.0.push(MenuEvent::Pointer { at: vec2(x, y), pressed: false });
    }

    fn mouse_button_down_event(&mut self, button: MouseButton, x: f32, y: f32) {
        if button == MouseButton::Left {
            self.0.push(MenuEvent::Pointer { at: vec2(x, y), pressed: true });
        }
    }

    fn mouse_wheel_event(&mut self, _x: f32, y: f32) {
        if y != 0.0 {
            self.0.push(MenuEvent::Input(MenuInput::Wheel(if y < 0.0 { 1 } else { -1 })));
        }
    }
}
