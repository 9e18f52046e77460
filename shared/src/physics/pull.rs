//! What accelerates a ball that nothing holds.

use glam::DVec2;

use super::ball::Ball;
use super::world::World;

impl World {
    /// Acceleration of a ball from now on where nothing holds it, m/s^2, by its place.
    pub(super) fn pull_on(&self, ball: usize) -> DVec2 {
        self.pull_at(&self.state.balls[ball])
    }

    /// The same of any ball.
    pub(super) fn pull_at(&self, _ball: &Ball) -> DVec2 {
        self.scene.gravity
    }
}
