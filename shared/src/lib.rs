//! The Starball world: everything that must be the same on every machine, bit for bit.
//!
//! Modules in the order in which they may use each other, left to right:
//! `math -> physics -> table -> rules -> game -> protocol`; `golden` plays games to see whether they are the same everywhere,
//! `outline` turns a world of `physics` into lines for pictures,
//! `extremes` tries what the physics promises, `feel` how it plays.
//! There is no clock, file, socket or thread in here; callers pass time and bytes. The one entry is [`game::Game::step`].

#![forbid(unsafe_code)]
#![warn(missing_docs)]

pub mod extremes;
pub mod feel;
pub mod game;
pub mod golden;
pub mod math;
pub mod outline;
pub mod physics;
pub mod protocol;
pub mod rules;
pub mod table;
