//! Motion models: four answers to one question, "what does this ball meet next, and when?".
//!
//! They share flights (a ball in the air always follows its parabola), shapes, broad phase and contact response, and
//! differ only in how they find the next impact:
//!
//! | model | method | error |
//! |---|---|---|
//! | [`Motion::Discrete`] | looks once a tick, pushes out what overlaps | passes through what is thinner than a step |
//! | [`Motion::Pixel`] | looks after every pixel of way | up to a pixel |
//! | [`Motion::Swept`] | first impact along the straight chord of a tick | falls with the square of the tick |
//! | [`Motion::Exact`] | first root of the distance along the parabola | rounding |

mod clearance;
mod discrete;
mod exact;
mod pixel;
mod sampled;
mod search;
mod swept;

use core::fmt;
use core::str::FromStr;

use glam::DVec2;
use serde::{Deserialize, Serialize};

use super::ball::{Ball, Flight};
use super::scene::Scene;
use super::state::WorldState;
pub(super) use search::Scratch;

/// How the next impact of a ball is found.
#[derive(Debug, Clone, Copy, Default, PartialEq, Eq, Serialize, Deserialize)]
pub enum Motion {
    /// Looks once a tick whether the ball overlaps something: the manual's first, and everybody's.
    Discrete,
    /// Looks after every pixel of way: the manual's second.
    Pixel,
    /// Sweeps the ball along the chord of each tick.
    Swept,
    /// Solves for the time of impact along the flight itself.
    #[default]
    Exact,
}

impl Motion {
    /// All of them, the simplest first.
    pub const ALL: [Self; 4] = [Self::Discrete, Self::Pixel, Self::Swept, Self::Exact];

    /// As written in commands.
    pub fn name(self) -> &'static str {
        match self {
            Self::Discrete => "discrete",
            Self::Pixel => "pixel",
            Self::Swept => "swept",
            Self::Exact => "exact",
        }
    }

    /// Whether it notices an impact only by an overlap at the moments at which it looks.
    pub fn looks_now_and_then(self) -> bool {
        matches!(self, Self::Discrete | Self::Pixel)
    }

    pub(super) fn model(self) -> &'static dyn MotionModel {
        match self {
            Self::Discrete => &discrete::Discrete,
            Self::Pixel => &pixel::Pixel,
            Self::Swept => &swept::Swept,
            Self::Exact => &exact::Exact,
        }
    }
}

impl fmt::Display for Motion {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        f.write_str(self.name())
    }
}

impl FromStr for Motion {
    type Err = String;

    fn from_str(text: &str) -> Result<Self, String> {
        let named = |motion: &Self| motion.name().eq_ignore_ascii_case(text);
        Self::ALL
            .into_iter()
            .find(named)
            .ok_or_else(|| format!("{text:?} is no motion model; discrete, pixel, swept or exact would be right"))
    }
}

/// What a flight meets next. Times are seconds since its start.
#[derive(Debug, Clone, Copy, PartialEq)]
pub enum Next {
    /// Nothing before that time; beyond it, ask again.
    ClearUntil(f64),
    /// An impact, or for a sensor its passing.
    Meets {
        /// When.
        time: f64,
        /// With what.
        collider: u16,
        /// Where the ball's centre is then, m: on the surface, in the models that notice an overlap only.
        position: DVec2,
    },
    /// The ball reaches the end of the straight surface that it lies on.
    LeavesSupport(f64),
    /// The ball leaves the scene.
    Escapes(f64),
}

impl Next {
    /// When.
    pub fn time(self) -> f64 {
        match self {
            Self::ClearUntil(time) | Self::Meets { time, .. } | Self::LeavesSupport(time) | Self::Escapes(time) => time,
        }
    }
}

/// A part of a flight; seconds since its start.
#[derive(Debug, Clone, Copy, PartialEq)]
pub(super) struct Span {
    pub(super) from: f64,
    pub(super) to: f64,
}

/// Whose next event is asked for, and in which tick.
pub(super) struct Query<'a> {
    pub(super) scene: &'a Scene,
    /// Which shapes are there.
    pub(super) state: &'a WorldState,
    pub(super) ball: &'a Ball,
    /// What is left of the current tick, on the ball's flight.
    pub(super) tick: Span,
    pub(super) scratch: &'a mut Scratch,
}

/// Two balls, each with its flight from the same moment on.
pub(super) struct Pair<'a> {
    pub(super) scene: &'a Scene,
    pub(super) flights: [&'a Flight; 2],
    pub(super) radii: [f64; 2],
    /// What is left of the current tick since that moment.
    pub(super) tick: Span,
}

/// A way to find the next impact.
pub(super) trait MotionModel: Sync {
    /// What a ball meets next among the static shapes, at the tick's `from` or later, looked for at least up to its `to`.
    fn next_event(&self, query: &mut Query<'_>) -> Next;

    /// When two balls meet, likewise.
    fn next_meeting(&self, pair: &Pair<'_>) -> Option<f64>;

    /// Into how many parts a ball's tick is cut, at whose ends alone the model looks; `None`: it looks all the time.
    fn parts(&self, scene: &Scene, flight: &Flight, tick: Span) -> Option<u32>;
}
