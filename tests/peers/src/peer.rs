//! What a peer is: another physics engine that runs a scene.

use glam::DVec2;
use shared::physics::scene::Scene;

/// Where a ball is and how it moves, in the scene's coordinates, m and m/s.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct Moment {
    /// Its centre.
    pub position: DVec2,
    /// Its velocity.
    pub velocity: DVec2,
}

/// Another physics engine.
pub trait Peer: Sync {
    /// What to call it.
    fn name(&self) -> &'static str;

    /// What is to be known of how it was built, if that makes it slower than it could be.
    fn caveat(&self) -> Option<&'static str> {
        None
    }

    /// How many times each step reads the system's clock for statistics that cannot be switched off. What that costs is a
    /// machine's, not an engine's: 20 ns each, or 40.
    fn clock_reads(&self) -> u32 {
        0
    }

    /// A world of its own with the scene in it, to be stepped `hz` times a second.
    ///
    /// # Errors
    /// What of the scene it cannot do.
    fn world(&self, scene: &Scene, hz: u32) -> Result<Box<dyn PeerWorld>, String>;
}

/// A scene in a peer.
pub trait PeerWorld {
    /// One step.
    ///
    /// # Errors
    /// What the engine says that is wrong.
    fn step(&mut self) -> Result<(), String>;

    /// Replaces what is in `into` by the balls as they are now, in the order of the scene's `start`.
    ///
    /// # Errors
    /// What the engine says that is wrong.
    fn balls(&mut self, into: &mut Vec<Moment>) -> Result<(), String>;
}
