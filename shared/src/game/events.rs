//! What happened in a game, for whoever shows, sounds or counts it. It is derived from the state and never feeds back.

use serde::{Deserialize, Serialize};

use super::input::Nudge;
use crate::physics::{Event, EventKind};

/// Speed from which it is told that two balls met, m/s. A ball that lies on another hops on it all the time, far more slowly.
const HEARD: f64 = 0.1;

/// Something that happened.
#[derive(Debug, Clone, Copy, PartialEq, Serialize, Deserialize)]
pub struct GameEvent {
    /// When.
    pub tick: u64,
    /// What.
    pub kind: GameEventKind,
}

/// What happened. Elements are places in the table's file.
#[derive(Debug, Clone, Copy, PartialEq, Serialize, Deserialize)]
pub enum GameEventKind {
    /// A ball met an element, at that normal speed in m/s.
    Touched {
        /// The element.
        element: u16,
        /// Of approach.
        speed: f32,
    },
    /// An element kicked a ball.
    Kicked {
        /// The element.
        element: u16,
        /// Of approach.
        speed: f32,
    },
    /// A target fell.
    Felled {
        /// The element.
        element: u16,
        /// Of approach.
        speed: f32,
    },
    /// A ball passed a rollover, or went through a plate.
    Passed {
        /// The element.
        element: u16,
    },
    /// A standing target was hit.
    Struck {
        /// The element.
        element: u16,
        /// Of approach.
        speed: f32,
    },
    /// A spinner turned half round.
    Spun {
        /// The element.
        element: u16,
    },
    /// A saucer caught a ball.
    Held {
        /// The element.
        element: u16,
    },
    /// A saucer threw a ball out.
    Ejected {
        /// The element.
        element: u16,
    },
    /// A player made points.
    Points {
        /// Whose.
        seat: u8,
        /// How many.
        points: u64,
        /// Where on the table, if anywhere.
        place: Option<(f32, f32)>,
    },
    /// A line for the display, by its place in the table's messages.
    Message {
        /// Its place.
        place: u16,
    },
    /// A flipper button was pressed.
    Flipped {
        /// The right one.
        right: bool,
    },
    /// A seat was taken.
    SatDown {
        /// Which.
        seat: u8,
    },
    /// A seat fell free.
    StoodUp {
        /// Which.
        seat: u8,
    },
    /// A game began.
    Started,
    /// A ball was served.
    Served {
        /// To whom.
        seat: u8,
        /// Which, from 1.
        ball: u32,
    },
    /// A rule put another ball into play.
    Added {
        /// To whom.
        seat: u8,
    },
    /// A ball was lost, and is put into play again.
    Saved {
        /// Whose.
        seat: u8,
    },
    /// A rule gave an extra ball.
    ExtraBall {
        /// To whom.
        seat: u8,
    },
    /// The player of the turn that has ended plays on with an extra ball.
    Again {
        /// Who.
        seat: u8,
    },
    /// The last ball was lost, and with it the turn.
    Lost {
        /// Whose.
        seat: u8,
    },
    /// A turn was given up: what was in play is gone.
    Forfeited {
        /// Whose.
        seat: u8,
    },
    /// The crowd is going to do something, by its place in the table's crowd.
    Announced {
        /// Its place.
        action: u8,
    },
    /// It does it.
    Acted {
        /// Its place.
        action: u8,
    },
    /// What it did and what lasted is over.
    Undone {
        /// Its place.
        action: u8,
    },
    /// Something was done about a stuck or escaped ball.
    Rescued {
        /// What.
        by: Rescue,
    },
    /// The game is over.
    Over,
    /// The table was nudged.
    Nudged {
        /// From where.
        nudge: Nudge,
    },
    /// The plumb bob touched its ring: another time, and the game tilts.
    Warned {
        /// Whose turn it is.
        seat: u8,
    },
    /// It touched once too often: the buttons are dead until the ball is lost.
    Tilted {
        /// Whose turn it is.
        seat: u8,
    },
    /// Two balls met, hard enough to be heard.
    Met {
        /// Of approach, m/s.
        speed: f32,
        /// Where on the table, m.
        place: (f32, f32),
    },
}

/// What is done about a ball that is stuck.
#[derive(Debug, Clone, Copy, PartialEq, Eq, Serialize, Deserialize)]
pub enum Rescue {
    /// Every kicker was fired: it may come loose.
    Kickers,
    /// It was served again.
    Relaunch,
}

impl GameEventKind {
    /// The part of a physics event that is shown.
    pub(super) fn of_physics(event: &Event) -> Option<Self> {
        match event.kind {
            EventKind::Touched { element, speed } => Some(Self::Touched { element, speed: speed as f32 }),
            EventKind::Kicked { element, speed } => Some(Self::Kicked { element, speed: speed as f32 }),
            EventKind::Felled { element, speed } => Some(Self::Felled { element, speed: speed as f32 }),
            EventKind::Passed { element } => Some(Self::Passed { element }),
            EventKind::Struck { element, speed } => Some(Self::Struck { element, speed: speed as f32 }),
            EventKind::Spun { element } => Some(Self::Spun { element }),
            EventKind::Held { element } => Some(Self::Held { element }),
            EventKind::Ejected { element } => Some(Self::Ejected { element }),
            EventKind::Met { speed, .. } if speed >= HEARD => {
                let place = (event.position.x as f32, event.position.y as f32);
                Some(Self::Met { speed: speed as f32, place })
            }
            EventKind::Met { .. } | EventKind::Stalled { .. } | EventKind::Drained | EventKind::Escaped => None,
        }
    }
}
