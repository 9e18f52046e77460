//! What accelerates a ball that nothing holds: the slope of its floor, magnets, and the table's own motion.

use glam::DVec2;

use super::ball::Ball;
use super::world::World;

impl World {
    /// Acceleration where nothing holds it of a ball, by its place, that is at `position` with `velocity`, on average over the
    /// next `seconds`, m/s^2.
    pub(super) fn pull_on(&self, ball: usize, position: DVec2, velocity: DVec2, seconds: f64) -> DVec2 {
        self.pull_at(&self.state.balls[ball], position, velocity, seconds)
    }

    /// The same of any ball.
    pub(super) fn pull_at(&self, ball: &Ball, position: DVec2, velocity: DVec2, seconds: f64) -> DVec2 {
        let needs = self.scene.needs;
        let mut pull = self.scene.gravity_on(ball.floor);
        if needs.nudge {
            pull -= self.state.cabinet.acceleration;
        }
        if needs.magnets {
            // As it is in the middle of its way.
            let half = 0.5 * seconds;
            let here = self.magnetic_pull(ball.floor, position, velocity);
            let middle = position + (velocity + here * (0.5 * half)) * half;
            pull += self.magnetic_pull(ball.floor, middle, velocity + here * half);
        }
        pull
    }

    /// The pull that a ball's present flight was begun with, m/s^2, where no magnet is near.
    pub(super) fn pull_of_flight(&self, ball: usize) -> DVec2 {
        let subject = &self.state.balls[ball];
        let gravity = self.scene.gravity_on(subject.floor);
        if !self.scene.needs.nudge {
            return gravity;
        }
        let is_of_this_tick = subject.flight.start.tick == self.state.tick;
        gravity - if is_of_this_tick { self.state.cabinet.acceleration } else { self.before }
    }
}
