//! Inputs: everything that alters a game from outside, stamped with the tick at which it acts. Table, seed and inputs
//! are all that a game is a function of.

use serde::{Deserialize, Serialize};

/// Seats at a table: players who alternate ball by ball.
pub const SEATS: usize = 4;

/// In the place of a seat: the inputs of who watches.
pub const HOUSE: u8 = u8::MAX;

/// Where a nudge comes from.
#[derive(Debug, Clone, Copy, PartialEq, Eq, Serialize, Deserialize)]
pub enum Nudge {
    /// A slap on the left side: the table goes to the right.
    FromLeft,
    /// A slap on the right side.
    FromRight,
    /// A push forward, up the table.
    Forward,
}

/// What somebody does.
#[derive(Debug, Clone, Copy, PartialEq, Eq, Serialize, Deserialize)]
#[serde(deny_unknown_fields)]
pub enum Action {
    /// Takes the seat.
    Sit,
    /// Leaves it. A turn that was theirs is over.
    Stand,
    /// Starts a game with everyone who is seated.
    Start,
    /// Presses or releases a flipper button.
    Flipper {
        /// The right one, else the left one.
        right: bool,
        /// Pressed, else released.
        pressed: bool,
    },
    /// Holds the plunger pulled by this share of its stroke, in 65535ths.
    Pull(u16),
    /// Lets go of it.
    Release,
    /// Nudges the table.
    Nudge(Nudge),
    /// Gives the ball up: whose turn it is loses the turn, and keeps the seat and the score. It is what is done about a player
    /// who does nothing, and no control.
    ///
    /// The bonus is collected as at a ball that is lost. On a real machine it is no different: it throws out a ball at last that
    /// nobody launches, nobody flips, and the bonus is counted when it drains. Only a tilt costs it.
    Forfeit,
    /// Of [`HOUSE`]: what the crowd does to the player, by its place among the actions of the table's crowd. What it may not do
    /// just now has no effect; see [`super::Game::can_crowd`].
    Crowd(u8),
}

impl Action {
    /// Whether it is a button or the plunger, which a seated player works directly.
    pub fn is_control(self) -> bool {
        matches!(self, Self::Flipper { .. } | Self::Pull(_) | Self::Release | Self::Nudge(_))
    }
}

/// An action of a seat at a tick.
#[derive(Debug, Clone, Copy, PartialEq, Eq, Serialize, Deserialize)]
#[serde(deny_unknown_fields)]
pub struct Input {
    /// The tick in which it acts.
    pub tick: u64,
    /// Whose it is.
    pub seat: u8,
    /// What it is.
    pub action: Action,
}
