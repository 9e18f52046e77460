//! The physics: balls among static shapes, flippers and plungers. It emits events and takes commands; it knows no score.

mod alone;
pub mod ball;
pub mod broad_phase;
pub mod cabinet;
pub mod constants;
pub mod contact;
mod drive;
mod edges;
mod events;
pub mod flipper;
mod follow;
mod friction;
mod happened;
pub mod hinge;
pub mod impact;
mod kickers;
pub mod magnet;
mod meetings;
pub mod motion;
mod movers;
pub mod needs;
mod numbers;
pub mod plunger;
mod pull;
pub mod saucer;
pub mod scene;
pub mod shapes;
mod state;
pub mod state_form;
mod stops;
#[cfg(test)]
mod tests;
pub mod two_body;
mod ways;
mod world;

pub use constants::PHYSICS_VERSION;
pub use happened::{Event, EventKind, NO_BALL};
pub use state::{MOST_BALLS, MOST_PARTS, StateError, TargetState, WorldState};
pub use world::World;
