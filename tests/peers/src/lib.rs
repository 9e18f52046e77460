//! Scenes run by other physics engines: Rapier and Box2D, each with the settings that serve it best.

mod box2d;
mod contender;
mod peer;
mod rapier;
mod stage;
#[cfg(test)]
mod tests;

pub use box2d::Box2d;
pub use contender::Entrant;
pub use peer::{Moment, Peer, PeerWorld};
pub use rapier::Rapier;

/// All of them.
pub const PEERS: [&dyn Peer; 2] = [&Rapier, &Box2d];
