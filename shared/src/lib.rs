//! The Starball world: everything that must be the same on every machine, bit for bit.
//!
//! Modules in the order in which they may use each other, left to right:
//! `math -> physics -> table -> rules -> game -> protocol`. There is no clock, file, socket or thread in here; callers
//! pass time and bytes. The one entry is [`game::Game::step`].

#![warn(missing_docs)]

pub mod game;
pub mod math;
pub mod physics;
pub mod protocol;
pub mod rules;
pub mod table;
