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
            let here = self.magnetic_pull(ball.floor, position, position, velocity, seconds);
            let middle = position + (velocity + here * (0.5 * half)) * half;
            pull += self.magnetic_pull(ball.floor, position, middle, velocity, seconds);
        }
        pull
    }

    /// The pull that a ball's present flight was begun with, m/s^2; that of magnets as it is at `middle`, halfway on its way.
    pub(super) fn pull_of_flight(&self, ball: usize, middle: DVec2) -> DVec2 {
        let needs = self.scene.needs;
        let subject = &self.state.balls[ball];
        let flight = &subject.flight;
        let mut pull = self.scene.gravity_on(subject.floor);
        if needs.nudge {
            let is_of_this_tick = flight.start.tick == self.state.tick;
            pull -= if is_of_this_tick { self.state.cabinet.acceleration } else { self.before };
        }
        if needs.magnets {
            let tick = self.scene.tick_seconds;
            pull += self.magnetic_pull(subject.floor, flight.position, middle, flight.velocity, tick);
        }
        pull
    }
}
