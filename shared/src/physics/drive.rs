//! What drives flippers and plungers: coils, springs, hands, and the balls that lie on them.

use super::ball::{Instant, Support};
use super::flipper::{FlipperMotion, FlipperRest, FlipperState};
use super::world::World;

impl World {
    /// 1. Decides which flippers and plungers move in this tick.
    pub(super) fn drive_movers(&mut self) {
        let dt = self.scene.tick_seconds;
        for index in 0..self.state.flippers.len() {
            let flipper = self.state.flippers[index];
            let starts = match flipper.rest {
                FlipperRest::AtRest => flipper.pressed,
                FlipperRest::Raised => !flipper.pressed,
                FlipperRest::Moving => false,
            };
            if starts {
                self.state.flippers[index].rest = FlipperRest::Moving;
                self.flipper_changed(index, 0.0, true);
            }
            let flipper = self.state.flippers[index];
            self.flipper_motions[index] =
                (flipper.rest == FlipperRest::Moving).then(|| self.flipper_motion(index, flipper));
        }
        for index in 0..self.state.plungers.len() {
            let plunger = self.state.plungers[index];
            let home = plunger.stays_home();
            if home != plunger.home {
                self.state.plungers[index].home = home;
                self.plunger_changed(index, 0.0, !home);
            }
            self.plunger_motions[index] = (!home).then(|| {
                let load = self.plunger_load(index);
                self.scene.plungers[index].motion(&plunger, load, dt)
            });
        }
    }

    /// How a flipper moves in this tick: with the acceleration that it has in the middle of it.
    fn flipper_motion(&self, index: usize, flipper: FlipperState) -> FlipperMotion {
        let dt = self.scene.tick_seconds;
        let spec = &self.scene.flippers[index];
        let FlipperState { swing, speed, .. } = flipper;
        let acceleration = self.flipper_acceleration(index, &flipper, spec.drive(&flipper, swing, dt), 0.0);
        let guess = FlipperMotion { from: 0.0, swing, speed, acceleration };
        let half = 0.5 * dt;
        let middle = FlipperState { swing: guess.swing_at(half), speed: guess.speed_at(half), ..flipper };
        let drive = spec.drive(&flipper, guess.swing_at(dt), dt);
        FlipperMotion { acceleration: self.flipper_acceleration(index, &middle, drive, half), ..guess }
    }

    /// What the torque of coil or spring and the balls lying on it make of a flipper, `later` seconds into the tick.
    fn flipper_acceleration(&self, index: usize, flipper: &FlipperState, drive: f64, later: f64) -> f64 {
        let scene = &self.scene;
        let spec = &scene.flippers[index];
        let (mut torque, mut inertia) = (drive, spec.inertia);
        for ball in self.state.balls.iter().filter(|ball| ball.support == Support::Flipper(index as u16)) {
            let (position, velocity) = ball.at(Instant::start_of(self.state.tick), scene.tick_seconds);
            let center = position + velocity * later;
            let carried = spec.carried(flipper.swing, flipper.speed, center, velocity, scene.radius(ball.kind));
            let mass = scene.mass(ball.kind);
            // What the flipper must push the ball with, beyond the change of its own turn.
            let push = carried.acceleration - scene.gravity.dot(carried.normal);
            if carried.lever * drive / spec.inertia + push > 0.0 {
                torque -= mass * carried.lever * push;
                inertia += mass * carried.lever * carried.lever;
            }
        }
        torque / inertia
    }

    /// Mass of the balls lying on a plunger.
    fn plunger_load(&self, index: usize) -> f64 {
        let lying = self.state.balls.iter().filter(|ball| ball.support == Support::Plunger(index as u16));
        lying.fold(0.0, |sum, ball| sum + self.scene.mass(ball.kind))
    }

    /// 4. Carries flippers and plungers over to the next tick.
    pub(super) fn settle_movers(&mut self) {
        let dt = self.scene.tick_seconds;
        for (flipper, motion) in self.state.flippers.iter_mut().zip(&self.flipper_motions) {
            if flipper.pressed {
                flipper.coil_time += dt;
            }
            if let (Some(motion), FlipperRest::Moving) = (motion, flipper.rest) {
                flipper.swing = motion.swing_at(dt);
                flipper.speed = motion.speed_at(dt);
            }
        }
        for (plunger, motion) in self.state.plungers.iter_mut().zip(&self.plunger_motions) {
            if let (Some(motion), false) = (motion, plunger.home) {
                plunger.pull = motion.pull_at(dt);
                plunger.speed = if plunger.hand.is_some() { 0.0 } else { motion.speed_at(dt) };
            }
        }
    }
}
