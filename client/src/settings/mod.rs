//! What a player has chosen, and remembers from one start of the game to the next: [`Settings`] as such, [`Store`] with the
//! file that they are in.

pub(crate) mod bindings;
pub(crate) mod keys;
mod store;

use serde::{Deserialize, Deserializer, Serialize};
use shared::protocol::check_name;

pub(crate) use bindings::{Bindings, Control};
pub(crate) use store::{Store, usual_file};

/// What a player has chosen. What a file leaves out is as [`Settings::default`] has it; what it has too much is passed over, so
/// that files of older and newer games can be read; numbers are brought into their ranges.
#[derive(Debug, Clone, PartialEq, Serialize, Deserialize)]
#[serde(default)]
pub(crate) struct Settings {
    /// What others call the player, 1 to 24 characters; empty: by the user's name on this machine.
    #[serde(deserialize_with = "name")]
    pub(crate) name: String,
    /// Percent, 0 to 100.
    #[serde(deserialize_with = "volume")]
    pub(crate) volume: u8,
    /// Whether the window fills the screen.
    pub(crate) full_screen: bool,
    /// Width and height of the window while it does not fill the screen, in what the window system counts in.
    #[serde(deserialize_with = "window")]
    pub(crate) window: (u16, u16),
    /// Nothing flashes or shakes.
    pub(crate) reduced_flashing: bool,
    /// Lights differ by a mark as well, not only by colour.
    pub(crate) marked_lights: bool,
    /// How much larger than usual text is, 1.0 to 1.6.
    #[serde(deserialize_with = "text_scale")]
    pub(crate) text_scale: f32,
    /// Which keys work what.
    pub(crate) keys: Bindings,
}

/// The largest text, as a multiple of the usual one: panels have no room for more.
pub(crate) const LARGEST_TEXT: f32 = 1.6;
/// Sides of a window, least and most. Smaller ones show nothing; larger ones no screen has.
const SIDES: (i64, i64) = (240, 16_384);

impl Default for Settings {
    fn default() -> Self {
        Self {
            name: String::new(),
            volume: 80,
            full_screen: false,
            window: (1280, 720),
            reduced_flashing: false,
            marked_lights: false,
            text_scale: 1.0,
            keys: Bindings::default(),
        }
    }
}

impl Settings {
    /// What others call the player.
    pub(crate) fn player(&self) -> String {
        if !self.name.is_empty() {
            return self.name.clone();
        }
        // The user's name, if others can be shown it.
        let user = std::env::var("USER").ok();
        user.filter(|name| check_name(name).is_ok()).unwrap_or_else(|| "Player".to_owned())
    }

    /// Remembers the size of a window, in what the window system counts in.
    pub(crate) fn remember_window(&mut self, width: f32, height: f32) {
        // A cast saturates.
        self.window = (side(width as i64), side(height as i64));
    }
}

fn side(length: i64) -> u16 {
    u16::try_from(length.clamp(SIDES.0, SIDES.1)).unwrap_or(u16::MAX)
}

fn name<'de, D: Deserializer<'de>>(deserializer: D) -> Result<String, D::Error> {
    let name = String::deserialize(deserializer)?;
    if !name.is_empty() {
        check_name(&name).map_err(serde::de::Error::custom)?;
    }
    Ok(name)
}

fn volume<'de, D: Deserializer<'de>>(deserializer: D) -> Result<u8, D::Error> {
    let percent = i64::deserialize(deserializer)?;
    Ok(u8::try_from(percent.clamp(0, 100)).unwrap_or(100))
}

fn window<'de, D: Deserializer<'de>>(deserializer: D) -> Result<(u16, u16), D::Error> {
    let (width, height) = <(i64, i64)>::deserialize(deserializer)?;
    Ok((side(width), side(height)))
}

fn text_scale<'de, D: Deserializer<'de>>(deserializer: D) -> Result<f32, D::Error> {
    let scale = f32::deserialize(deserializer)?;
    Ok(if scale.is_nan() { 1.0 } else { scale.clamp(1.0, LARGEST_TEXT) })
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn numbers_are_brought_into_their_ranges() {
        let read = |text: &str| ron::from_str::<Settings>(text).unwrap();
        let wild = read("(volume: 1000, window: (-5, 999999), text_scale: inf)");
        assert_eq!((wild.volume, wild.window, wild.text_scale), (100, (240, 16_384), LARGEST_TEXT));
        let wild = read("(volume: -1, text_scale: NaN)");
        assert_eq!((wild.volume, wild.text_scale), (0, 1.0));
        let mut settings = Settings::default();
        settings.remember_window(f32::NAN, f32::INFINITY);
        assert_eq!(settings.window, (240, 16_384));
        settings.remember_window(1600.0, 900.4);
        assert_eq!(settings.window, (1600, 900));
    }

    #[test]
    fn what_is_left_out_is_usual_and_what_is_unknown_is_passed_over() {
        let settings: Settings = ron::from_str("(colour: Rgb(1, [2], {\"a\": 3}), volume: 7)").unwrap();
        assert_eq!(settings, Settings { volume: 7, ..Settings::default() });
        let some_keys: Settings = ron::from_str("(keys: (plunger: [\"O\"]))").unwrap();
        assert_eq!(some_keys.keys.labels(Control::Plunger, 4), "O");
        assert_eq!(some_keys.keys.labels(Control::NudgeLeft, 4), "Q");
    }

    #[test]
    fn the_player_has_a_name() {
        assert!(!Settings::default().player().is_empty());
        assert_eq!(Settings { name: "Ann".to_owned(), ..Settings::default() }.player(), "Ann");
        assert!(ron::from_str::<Settings>("(name: \" Ann\")").is_err());
    }
}
