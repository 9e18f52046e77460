//! All kickers at once: how a real machine shakes a ball loose that it has lost sight of.

use super::ball::Instant;
use super::constants::KICKER_REACH;
use super::scene::Role;
use super::world::World;

impl World {
    /// Fires the coil of every bumper and slingshot, as if each had been hit: a ball that touches one, at whatever speed, is
    /// kicked off along its surface's normal; and saucers throw out what they hold. How many balls were kicked.
    ///
    /// It is no impact: nothing is told as [`super::EventKind::Kicked`], and nobody makes points of it.
    pub fn fire_kickers(&mut self) -> usize {
        let now = Instant::start_of(self.state.tick);
        let mut kicked = 0;
        for ball in 0..self.state.balls.len() {
            let subject = self.state.balls[ball];
            if let Some(saucer) = subject.saucer() {
                self.kick(saucer);
                kicked += 1;
                continue;
            }
            let (position, velocity) = subject.at(now, self.scene.tick_seconds);
            let within = self.radius(ball) * (1.0 + KICKER_REACH);
            let fired = self.scene.colliders.iter().fold(velocity, |velocity, collider| match collider.role {
                Role::Kicker { speed, .. }
                    if collider.floor == subject.floor
                        && self.state.has(collider)
                        && collider.shape.distance(position) <= within =>
                {
                    velocity + collider.shape.normal_at(position) * speed
                }
                _ => velocity,
            });
            if fired != velocity {
                kicked += 1;
                self.refresh_spin(ball, 0.0, position, velocity);
                self.start_flight(ball, 0.0, position, fired, None, None);
            }
        }
        self.wake();
        kicked
    }

    /// Takes the ball of that id out of play; whether there was one.
    pub fn take_back(&mut self, id: u32) -> bool {
        let Some(place) = self.state.balls.iter().position(|ball| ball.id == id) else { return false };
        self.remove(place);
        self.wake();
        true
    }
}
