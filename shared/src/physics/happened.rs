//! What happened in a step, as the world tells it: for rules, traces and pictures.

use glam::DVec2;

use super::ball::Instant;

/// The ball of an event that happens to no ball.
pub const NO_BALL: u32 = u32::MAX;

/// Something that happened, to a ball unless it says otherwise.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct Event {
    /// When.
    pub at: Instant,
    /// Which ball; [`NO_BALL`] where something happens to none.
    pub ball: u32,
    /// Its centre then, m.
    pub position: DVec2,
    /// Its velocity just after, m/s.
    pub velocity: DVec2,
    /// What.
    pub kind: EventKind,
}

/// What happened.
#[derive(Debug, Clone, Copy, PartialEq)]
pub enum EventKind {
    /// It met a surface of that element, at that normal speed in m/s.
    Touched {
        /// The table's element.
        element: u16,
        /// Of approach.
        speed: f64,
    },
    /// It was kicked by that element.
    Kicked {
        /// The table's element.
        element: u16,
        /// Of approach.
        speed: f64,
    },
    /// It made that target fall.
    Felled {
        /// The table's element.
        element: u16,
        /// Of approach.
        speed: f64,
    },
    /// It hit that standing target.
    Struck {
        /// The table's element.
        element: u16,
        /// Of approach.
        speed: f64,
    },
    /// That spinner turned half round: of no ball.
    Spun {
        /// The table's element.
        element: u16,
    },
    /// That saucer caught it.
    Held {
        /// The table's element.
        element: u16,
    },
    /// That saucer threw it out.
    Ejected {
        /// The table's element.
        element: u16,
    },
    /// It met another ball.
    Met {
        /// The other one's id.
        other: u32,
        /// Of approach, m/s.
        speed: f64,
    },
    /// It passed that sensor, or went through that plate.
    Passed {
        /// The table's element.
        element: u16,
    },
    /// It met more within a tick than is worth following, at that speed in m/s, and lies still for the rest of it.
    Stalled {
        /// That it lost.
        speed: f64,
    },
    /// It is lost.
    Drained,
    /// It left the table where no ball should, and was taken out.
    Escaped,
}
