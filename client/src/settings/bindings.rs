//! Which keys work what: [`Bindings`], with one rule. A key works one thing at the most.

use macroquad::input::KeyCode;
use serde::{Deserialize, Serialize};
use thiserror::Error;

use super::keys::Key;

/// Something on the table that a player works.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub(crate) enum Control {
    /// The left flipper.
    LeftFlipper,
    /// The right flipper.
    RightFlipper,
    /// The plunger.
    Plunger,
    /// A slap from the left.
    NudgeLeft,
    /// A slap from the right.
    NudgeRight,
    /// A push forward.
    NudgeForward,
}

impl Control {
    /// All, in the order of a list of keys.
    pub(crate) const ALL: [Self; 6] =
        [Self::LeftFlipper, Self::RightFlipper, Self::Plunger, Self::NudgeLeft, Self::NudgeForward, Self::NudgeRight];

    /// Its name on the screen.
    pub(crate) fn label(self) -> &'static str {
        match self {
            Self::LeftFlipper => "LEFT FLIPPER",
            Self::RightFlipper => "RIGHT FLIPPER",
            Self::Plunger => "PLUNGER",
            Self::NudgeLeft => "NUDGE FROM LEFT",
            Self::NudgeRight => "NUDGE FROM RIGHT",
            Self::NudgeForward => "NUDGE FORWARD",
        }
    }
}

/// Keys that one control may have at the most: a screen has no room for more.
pub(crate) const MOST_KEYS: usize = 4;

/// Why keys cannot be bound so.
#[derive(Debug, Clone, Copy, PartialEq, Eq, Error)]
pub(crate) enum BindError {
    /// A key works one thing.
    #[error("{} is already a key of {}; another one would be right", key.name(), with.label())]
    Taken {
        /// The key.
        key: Key,
        /// What it works already.
        with: Control,
    },
    /// Too many keys for one control.
    #[error("{count} keys are too many for {}; at most {MOST_KEYS} would be right", control.label())]
    TooMany {
        /// What they were to work.
        control: Control,
        /// How many they were.
        count: usize,
    },
}

/// Which keys work what.
#[derive(Debug, Clone, PartialEq, Eq, Serialize, Deserialize)]
#[serde(try_from = "Written", into = "Written")]
pub(crate) struct Bindings {
    /// By [`Control`], as it counts them.
    keys: [Vec<Key>; Control::ALL.len()],
}

/// As it is written. What is left out is as it was.
#[derive(Debug, Clone, Serialize, Deserialize)]
#[serde(default)]
struct Written {
    left_flipper: Vec<Key>,
    right_flipper: Vec<Key>,
    plunger: Vec<Key>,
    nudge_left: Vec<Key>,
    nudge_right: Vec<Key>,
    nudge_forward: Vec<Key>,
}

impl Default for Written {
    fn default() -> Self {
        use KeyCode as K;
        let keys = |codes: &[KeyCode]| codes.iter().copied().filter_map(Key::of).collect();
        Self {
            left_flipper: keys(&[K::LeftShift, K::Z, K::Left, K::A]),
            right_flipper: keys(&[K::RightShift, K::Slash, K::Right, K::D]),
            plunger: keys(&[K::Space, K::Down]),
            nudge_left: keys(&[K::Q]),
            nudge_right: keys(&[K::E]),
            nudge_forward: keys(&[K::W, K::Up]),
        }
    }
}

impl Default for Bindings {
    fn default() -> Self {
        let Written { left_flipper, right_flipper, plunger, nudge_left, nudge_right, nudge_forward } =
            Written::default();
        Self { keys: [left_flipper, right_flipper, plunger, nudge_left, nudge_right, nudge_forward] }
    }
}

impl TryFrom<Written> for Bindings {
    type Error = BindError;

    fn try_from(written: Written) -> Result<Self, BindError> {
        let mut bindings = Self { keys: Default::default() };
        bindings.rebind(Control::LeftFlipper, written.left_flipper)?;
        bindings.rebind(Control::RightFlipper, written.right_flipper)?;
        bindings.rebind(Control::Plunger, written.plunger)?;
        bindings.rebind(Control::NudgeLeft, written.nudge_left)?;
        bindings.rebind(Control::NudgeRight, written.nudge_right)?;
        bindings.rebind(Control::NudgeForward, written.nudge_forward)?;
        Ok(bindings)
    }
}

impl From<Bindings> for Written {
    fn from(bindings: Bindings) -> Self {
        let [left_flipper, right_flipper, plunger, nudge_left, nudge_right, nudge_forward] = bindings.keys;
        Self { left_flipper, right_flipper, plunger, nudge_left, nudge_right, nudge_forward }
    }
}

impl Bindings {
    /// Gives a control these keys instead of its present ones.
    ///
    /// # Errors
    /// If one of them works something else, or they are too many; nothing has changed then.
    pub(crate) fn rebind(&mut self, control: Control, keys: Vec<Key>) -> Result<(), BindError> {
        if keys.len() > MOST_KEYS {
            return Err(BindError::TooMany { control, count: keys.len() });
        }
        for &key in &keys {
            if let Some(with) = self.control_of(key.code()).filter(|with| *with != control) {
                return Err(BindError::Taken { key, with });
            }
        }
        self.keys[control as usize] = keys;
        Ok(())
    }

    /// What a key works.
    pub(crate) fn control_of(&self, code: KeyCode) -> Option<Control> {
        let works = |control: &Control| self.keys(*control).iter().any(|key| key.code() == code);
        Control::ALL.into_iter().find(works)
    }

    /// The keys of a control, the most important first.
    pub(crate) fn keys(&self, control: Control) -> &[Key] {
        &self.keys[control as usize]
    }

    /// The labels of its first keys, such as `L SHIFT, Z`; empty if it has none.
    pub(crate) fn labels(&self, control: Control, most: usize) -> String {
        let labels: Vec<&str> = self.keys(control).iter().take(most).map(|key| key.label()).collect();
        labels.join(", ")
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    fn key(code: KeyCode) -> Key {
        Key::of(code).unwrap()
    }

    #[test]
    fn the_defaults_are_free_of_conflicts() {
        let defaults = Bindings::default();
        assert_eq!(Bindings::try_from(Written::from(defaults.clone())), Ok(defaults.clone()));
        assert_eq!(defaults.labels(Control::LeftFlipper, 2), "L SHIFT, Z");
        assert!(Control::ALL.into_iter().all(|control| !defaults.keys(control).is_empty()));
    }

    #[test]
    fn the_shift_keys_are_told_apart() {
        let defaults = Bindings::default();
        assert_eq!(defaults.control_of(KeyCode::LeftShift), Some(Control::LeftFlipper));
        assert_eq!(defaults.control_of(KeyCode::RightShift), Some(Control::RightFlipper));
    }

    #[test]
    fn a_key_works_one_thing() {
        let mut bindings = Bindings::default();
        let taken = bindings.rebind(Control::Plunger, vec![key(KeyCode::O), key(KeyCode::Z)]);
        assert_eq!(taken, Err(BindError::Taken { key: key(KeyCode::Z), with: Control::LeftFlipper }));
        assert_eq!(bindings, Bindings::default());
        // Its own keys in another order are no conflict.
        bindings.rebind(Control::LeftFlipper, vec![key(KeyCode::Z), key(KeyCode::LeftControl)]).unwrap();
        assert_eq!(bindings.labels(Control::LeftFlipper, 2), "Z, L CTRL");
        assert_eq!(bindings.control_of(KeyCode::LeftShift), None);
        bindings.rebind(Control::Plunger, vec![key(KeyCode::LeftShift)]).unwrap();
        assert_eq!(bindings.control_of(KeyCode::LeftShift), Some(Control::Plunger));
    }

    #[test]
    fn no_control_has_more_keys_than_a_screen_has_room_for() {
        let keys = [KeyCode::H, KeyCode::J, KeyCode::K, KeyCode::L, KeyCode::M].map(key);
        let too_many = Bindings::default().rebind(Control::Plunger, keys.to_vec());
        assert_eq!(too_many, Err(BindError::TooMany { control: Control::Plunger, count: 5 }));
    }
}
