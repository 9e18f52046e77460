//! The keys that can be bound, by the names that the settings file has for them and the labels that the screen has.

use macroquad::input::KeyCode;
use serde::de::{Error, Unexpected};
use serde::{Deserialize, Deserializer, Serialize, Serializer};

/// A key that can be bound. What the game keeps for itself (Enter, Escape, Tab, P, R, the function keys) and what window systems
/// do (locks, Super, Print Screen) is none.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub(crate) struct Key(KeyCode);

impl Key {
    /// The key of a code, if it can be bound.
    pub(crate) fn of(code: KeyCode) -> Option<Self> {
        KEYS.iter().any(|(known, ..)| *known == code).then_some(Self(code))
    }

    /// Its code.
    pub(crate) fn code(self) -> KeyCode {
        self.0
    }

    /// Its name in the settings file: `LeftShift`.
    pub(crate) fn name(self) -> &'static str {
        self.row().1
    }

    /// Its label on the screen: `L SHIFT`.
    pub(crate) fn label(self) -> &'static str {
        self.row().2
    }

    fn row(self) -> (KeyCode, &'static str, &'static str) {
        KEYS.iter().find(|(code, ..)| *code == self.0).copied().unwrap_or((self.0, "?", "?"))
    }
}

impl Serialize for Key {
    fn serialize<S: Serializer>(&self, serializer: S) -> Result<S::Ok, S::Error> {
        serializer.serialize_str(self.name())
    }
}

impl<'de> Deserialize<'de> for Key {
    fn deserialize<D: Deserializer<'de>>(deserializer: D) -> Result<Self, D::Error> {
        let text = String::deserialize(deserializer)?;
        let row = KEYS.iter().find(|(_, name, _)| *name == text);
        row.map(|(code, ..)| Self(*code)).ok_or_else(|| D::Error::invalid_value(Unexpected::Str(&text), &RIGHT))
    }
}

/// What to say of a name that no key has.
const RIGHT: &str =
    "the name of a key that can be bound, such as \"LeftShift\", \"Z\", \"Slash\", \"Left\", \"Key1\" or \"Kp0\"";

/// Code, name, label. Names stay as they are: they are in people's files.
const KEYS: &[(KeyCode, &str, &str)] = &[
    (KeyCode::A, "A", "A"),
    (KeyCode::B, "B", "B"),
    (KeyCode::C, "C", "C"),
    (KeyCode::D, "D", "D"),
    (KeyCode::E, "E", "E"),
    (KeyCode::F, "F", "F"),
    (KeyCode::G, "G", "G"),
    (KeyCode::H, "H", "H"),
    (KeyCode::I, "I", "I"),
    (KeyCode::J, "J", "J"),
    (KeyCode::K, "K", "K"),
    (KeyCode::L, "L", "L"),
    (KeyCode::M, "M", "M"),
    (KeyCode::N, "N", "N"),
    (KeyCode::O, "O", "O"),
    (KeyCode::Q, "Q", "Q"),
    (KeyCode::S, "S", "S"),
    (KeyCode::T, "T", "T"),
    (KeyCode::U, "U", "U"),
    (KeyCode::V, "V", "V"),
    (KeyCode::W, "W", "W"),
    (KeyCode::X, "X", "X"),
    (KeyCode::Y, "Y", "Y"),
    (KeyCode::Z, "Z", "Z"),
    (KeyCode::Key0, "Key0", "0"),
    (KeyCode::Key1, "Key1", "1"),
    (KeyCode::Key2, "Key2", "2"),
    (KeyCode::Key3, "Key3", "3"),
    (KeyCode::Key4, "Key4", "4"),
    (KeyCode::Key5, "Key5", "5"),
    (KeyCode::Key6, "Key6", "6"),
    (KeyCode::Key7, "Key7", "7"),
    (KeyCode::Key8, "Key8", "8"),
    (KeyCode::Key9, "Key9", "9"),
    (KeyCode::LeftShift, "LeftShift", "L SHIFT"),
    (KeyCode::RightShift, "RightShift", "R SHIFT"),
    (KeyCode::LeftControl, "LeftControl", "L CTRL"),
    (KeyCode::RightControl, "RightControl", "R CTRL"),
    (KeyCode::LeftAlt, "LeftAlt", "L ALT"),
    (KeyCode::RightAlt, "RightAlt", "R ALT"),
    (KeyCode::Space, "Space", "SPACE"),
    (KeyCode::Left, "Left", "LEFT ARROW"),
    (KeyCode::Right, "Right", "RIGHT ARROW"),
    (KeyCode::Up, "Up", "UP ARROW"),
    (KeyCode::Down, "Down", "DOWN ARROW"),
    (KeyCode::Comma, "Comma", ","),
    (KeyCode::Period, "Period", "."),
    (KeyCode::Slash, "Slash", "/"),
    (KeyCode::Semicolon, "Semicolon", ";"),
    (KeyCode::Apostrophe, "Apostrophe", "'"),
    (KeyCode::LeftBracket, "LeftBracket", "["),
    (KeyCode::RightBracket, "RightBracket", "]"),
    (KeyCode::Backslash, "Backslash", "\\"),
    (KeyCode::Minus, "Minus", "-"),
    (KeyCode::Equal, "Equal", "="),
    (KeyCode::GraveAccent, "GraveAccent", "`"),
    (KeyCode::Backspace, "Backspace", "BACKSPACE"),
    (KeyCode::Insert, "Insert", "INSERT"),
    (KeyCode::Delete, "Delete", "DELETE"),
    (KeyCode::Home, "Home", "HOME"),
    (KeyCode::End, "End", "END"),
    (KeyCode::PageUp, "PageUp", "PAGE UP"),
    (KeyCode::PageDown, "PageDown", "PAGE DOWN"),
    (KeyCode::Kp0, "Kp0", "PAD 0"),
    (KeyCode::Kp1, "Kp1", "PAD 1"),
    (KeyCode::Kp2, "Kp2", "PAD 2"),
    (KeyCode::Kp3, "Kp3", "PAD 3"),
    (KeyCode::Kp4, "Kp4", "PAD 4"),
    (KeyCode::Kp5, "Kp5", "PAD 5"),
    (KeyCode::Kp6, "Kp6", "PAD 6"),
    (KeyCode::Kp7, "Kp7", "PAD 7"),
    (KeyCode::Kp8, "Kp8", "PAD 8"),
    (KeyCode::Kp9, "Kp9", "PAD 9"),
    (KeyCode::KpDecimal, "KpDecimal", "PAD ."),
    (KeyCode::KpDivide, "KpDivide", "PAD /"),
    (KeyCode::KpMultiply, "KpMultiply", "PAD *"),
    (KeyCode::KpSubtract, "KpSubtract", "PAD -"),
    (KeyCode::KpAdd, "KpAdd", "PAD +"),
];

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn codes_names_and_labels_are_each_one_keys() {
        for (place, row) in KEYS.iter().enumerate() {
            for other in &KEYS[..place] {
                assert!(row.0 != other.0 && row.1 != other.1 && row.2 != other.2, "{row:?} and {other:?}");
            }
        }
    }

    #[test]
    fn what_the_game_or_the_desktop_keeps_cannot_be_bound() {
        use KeyCode as K;
        for kept in
            [K::Enter, K::KpEnter, K::Escape, K::Tab, K::P, K::R, K::F1, K::F12, K::CapsLock, K::LeftSuper, K::Unknown]
        {
            assert_eq!(Key::of(kept), None);
        }
    }

    #[test]
    fn names_are_read_as_they_are_written() {
        for &(code, name, _) in KEYS {
            let text = ron::to_string(&Key(code)).unwrap();
            assert_eq!((text.as_str(), ron::from_str(&text)), (format!("{name:?}").as_str(), Ok(Key(code))));
        }
        for bad in ["\"leftshift\"", "\"Enter\"", "\"\""] {
            let problem = ron::from_str::<Key>(bad).unwrap_err().to_string();
            assert!(problem.contains("such as \"LeftShift\""), "{problem}");
        }
    }
}
