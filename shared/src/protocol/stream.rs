//! Which stream of a room a client is sent: in which form, and how often.

use serde::{Deserialize, Serialize};

use super::Role;

/// Frames a second that a client can ask for.
pub const RATES: [u8; 4] = [10, 20, 30, 60];

/// What the frames of a stream hold.
#[derive(Debug, Clone, Copy, PartialEq, Eq, PartialOrd, Ord, Serialize, Deserialize)]
pub enum Form {
    /// What changed of the state: for players, and for whoever does not simulate.
    State,
    /// What was pressed, and now and then the digest that this must lead to: for whoever steps a copy of the game.
    Inputs,
}

/// A stream of a room.
#[derive(Debug, Clone, Copy, PartialEq, Eq, PartialOrd, Ord, Serialize, Deserialize)]
pub struct Stream {
    /// What its frames hold.
    pub form: Form,
    /// Frames a second: one of [`RATES`].
    pub hz: u8,
}

impl Stream {
    /// What players are sent unless they ask for something else.
    pub const PLAYER: Self = Self { form: Form::State, hz: 60 };
    /// What spectators are sent unless they ask for something else.
    pub const SPECTATOR: Self = Self { form: Form::Inputs, hz: 10 };

    /// The default of a role.
    pub fn of(role: Role) -> Self {
        match role {
            Role::Play => Self::PLAYER,
            Role::Watch => Self::SPECTATOR,
        }
    }

    /// Whether there is such a stream.
    ///
    /// # Errors
    /// What would be right.
    pub fn check(self) -> Result<(), String> {
        if RATES.contains(&self.hz) {
            return Ok(());
        }
        let rates = RATES.map(|rate| rate.to_string()).join(", ");
        Err(format!("a stream has not {} frames a second: one of {rates} would be right", self.hz))
    }

    /// Whether a frame is due between the tick before and `tick`, for ticks of so many seconds.
    pub fn is_due(self, tick: u64, tick_seconds: f64) -> bool {
        let number = |tick: u64| (tick as f64 * tick_seconds * f64::from(self.hz)) as u64;
        tick > 0 && number(tick) != number(tick - 1)
    }
}
