//! Everything about a game that changes.

use serde::{Deserialize, Serialize};

use super::crowd::{CrowdState, check_crowd, sample_crowd};
use super::input::SEATS;
use super::tilt::Tilt;
use crate::physics::{StateError, WorldState};
use crate::rules::{RuleState, Score};
use crate::table::Table;

/// The most balls that a table's rules may give a player.
pub(crate) const MOST_BALLS_A_GAME: u32 = 100;

/// The most balls that wait to be put into play: rules that ask for more get no more.
pub(super) const MOST_EXTRA: u32 = 16;

/// The most ticks of a pause: two seconds at the highest tick rate.
const MOST_PAUSE: u32 = 2_000_000;

/// A place at the table.
#[derive(Debug, Clone, Copy, Default, PartialEq, Eq, Serialize, Deserialize)]
#[serde(from = "SeatForm", into = "SeatForm")]
pub struct Seat {
    /// Somebody sits there.
    pub taken: bool,
    /// They are in the game that is being played.
    pub playing: bool,
    /// Extra balls that they have got in this game, at most [`MOST_EXTRA_BALLS`](crate::table::MOST_EXTRA_BALLS) ...
    pub extra_balls: u8,
    /// ... and those of them that they have still to play.
    pub extra_waiting: u8,
    /// Their points in this game, or in the last one.
    pub score: Score,
}

/// As it is written: who sits and who plays are two bits of one byte, and three each count extra balls.
#[derive(Serialize, Deserialize)]
struct SeatForm(u8, Score);

impl From<Seat> for SeatForm {
    fn from(Seat { taken, playing, extra_balls, extra_waiting, score }: Seat) -> Self {
        let counts = (extra_balls & 7) << 2 | (extra_waiting & 7) << 5;
        Self(u8::from(taken) | u8::from(playing) << 1 | counts, score)
    }
}

impl From<SeatForm> for Seat {
    fn from(SeatForm(bits, score): SeatForm) -> Self {
        let (extra_balls, extra_waiting) = (bits >> 2 & 7, bits >> 5);
        Self { taken: bits & 1 != 0, playing: bits & 2 != 0, extra_balls, extra_waiting, score }
    }
}

/// Where a game stands.
#[derive(Debug, Clone, Copy, Default, PartialEq, Eq, Serialize, Deserialize)]
pub enum Phase {
    /// No game was played yet.
    #[default]
    Idle,
    /// Somebody's turn.
    Play {
        /// Whose.
        seat: u8,
        /// Which ball, from 1.
        ball: u32,
        /// Ticks until it is served; 0: it is in play.
        serve_in: u32,
        /// Nothing that counts has happened to it.
        untouched: bool,
        /// Ticks for which the ball `watched` has lain still.
        still: u32,
        /// The ball that is thought to be stuck, by its id.
        watched: u32,
        /// Ticks since anything that counts has happened, or a control was worked, with a ball in play.
        quiet: u32,
        /// Balls that rules want to have put into play besides.
        extra: u32,
        /// How often all kickers were fired for a stuck ball in this turn.
        searches: u8,
    },
    /// A game has ended.
    Over,
}

impl Phase {
    /// Whether it is that seat's turn.
    pub fn has_turn(&self, seat: u8) -> bool {
        matches!(self, Self::Play { seat: turn, .. } if *turn == seat)
    }
}

/// The part of a game's state that is not the world's.
#[derive(Debug, Clone, Default, PartialEq, Serialize, Deserialize)]
pub struct Play {
    pub(super) phase: Phase,
    pub(super) seats: [Seat; SEATS],
    /// Lights, and what else the rules have changed.
    pub(super) rules: RuleState,
    /// How the player whose turn it is treats the table.
    pub(super) tilt: Tilt,
    /// What the crowd does, at a table that has one.
    pub(super) crowd: Option<CrowdState>,
}

impl Play {
    /// Of a table at which nothing has happened.
    pub(super) fn new(table: &Table) -> Self {
        let crowd = table.rules.crowd.as_ref().map(|_| CrowdState::default());
        let mut play = Self { crowd, ..Self::default() };
        play.rules.lights.reserve();
        play
    }

    /// Refuses a turn of a seat that does not exist, and a crowd that is not this table's.
    pub(super) fn check(&self, table: &Table) -> Result<(), StateError> {
        if !self.rules.fits(table) {
            return Err(StateError::Number { what: "lights", index: 0 });
        }
        let most = table.rules.max_extra_balls;
        if let Some(index) = self.seats.iter().position(|s| s.extra_balls > most || s.extra_waiting > s.extra_balls) {
            return Err(StateError::Number { what: "extra balls of seat", index });
        }
        match self.phase {
            Phase::Play { seat, .. } if usize::from(seat) >= SEATS => {
                Err(StateError::Count { what: "seats", found: usize::from(seat) + 1, expected: SEATS })
            }
            Phase::Play { ball, .. } if ball > MOST_BALLS_A_GAME => Err(StateError::Count {
                what: "balls played",
                found: ball as usize,
                expected: MOST_BALLS_A_GAME as usize,
            }),
            Phase::Play { extra, .. } if extra > MOST_EXTRA => Err(StateError::Count {
                what: "balls to be served",
                found: extra as usize,
                expected: MOST_EXTRA as usize,
            }),
            Phase::Play { serve_in, .. } if serve_in > MOST_PAUSE => {
                Err(StateError::Number { what: "pause", index: 0 })
            }
            _ if self.tilt.same_touch > MOST_PAUSE => Err(StateError::Number { what: "tilt", index: 0 }),
            phase => check_crowd(self.crowd, phase, table),
        }
    }
}

/// A state that has something in every field: one of the protocol's samples.
pub(crate) fn sample_play(phase: Phase) -> Play {
    let score = Score { points: 300, bonus: 70_000, multiplier: 2 };
    Play {
        phase,
        seats: [Seat { taken: true, playing: true, extra_balls: 3, extra_waiting: 1, score }; SEATS],
        rules: RuleState::sample(),
        tilt: Tilt { warnings: 1, same_touch: 300, tilted: true },
        crowd: Some(sample_crowd()),
    }
}

/// The state of a game: what is saved, sent and digested.
#[derive(Debug, Clone, PartialEq, Serialize, Deserialize)]
pub struct GameState {
    /// Balls, flippers, plungers, targets.
    pub world: WorldState,
    /// Turn, seats, lights.
    pub play: Play,
}
