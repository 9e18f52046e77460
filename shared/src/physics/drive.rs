//! What drives flippers and plungers: coils, springs, hands, and the balls that lie on them.

use super::ball::{Ball, Instant, Support};
use super::constants::{MOVER_PARTS, PIECE_ANGLE};
use super::flipper::{FlipperMotion, FlipperRest, FlipperState};
use super::movers::lever;
use super::world::World;
use crate::math::tangent;

impl World {
    /// 1. Decides which flippers and plungers move in this tick.
    pub(super) fn drive_movers(&mut self) {
        let dt = self.scene.tick_seconds;
        // As they are now: what a change of one of them asks of another must not be answered from the last tick.
        for (motion, flipper) in self.flipper_motions.iter_mut().zip(&self.state.flippers) {
            let FlipperState { swing, speed, rest, .. } = *flipper;
            let now = FlipperMotion { from: 0.0, swing, speed, acceleration: 0.0 };
            *motion = (rest == FlipperRest::Moving).then_some(now);
        }
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
                (flipper.rest == FlipperRest::Moving).then(|| self.flipper_motion(index, flipper, 0.0));
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

    /// How a flipper moves from `offset` on: with the acceleration that it has in the middle of this tick's rest, or of the
    /// piece that balls on it follow.
    pub(super) fn flipper_motion(&self, index: usize, flipper: FlipperState, offset: f64) -> FlipperMotion {
        let spec = &self.scene.flippers[index];
        if self.on_flipper(index).next().is_none() {
            return spec.free_motion(&flipper, offset, self.scene.tick_seconds - offset);
        }
        let flipper = FlipperState { coil_time: flipper.coil_time + offset, ..flipper };
        let FlipperState { swing, speed, .. } = flipper;
        let span = self.flipper_piece(index, swing, speed, offset);
        let acceleration = self.flipper_acceleration(index, &flipper, spec.drive(&flipper, swing, span), offset);
        let guess = FlipperMotion { from: offset, swing, speed, acceleration };
        let middle = offset + 0.5 * span;
        let halfway = FlipperState { swing: guess.swing_at(middle), speed: guess.speed_at(middle), ..flipper };
        let drive = spec.drive(&flipper, guess.swing_at(offset + span), span);
        FlipperMotion { acceleration: self.flipper_acceleration(index, &halfway, drive, middle), ..guess }
    }

    /// The load on a flipper has changed: it goes on from `offset` with what follows from that.
    pub(super) fn reload_flipper(&mut self, index: usize, offset: f64) {
        let Some(motion) = self.flipper_motions[index] else { return };
        let flipper = &mut self.state.flippers[index];
        (flipper.swing, flipper.speed) = (motion.swing_at(offset), motion.speed_at(offset));
        let flipper = *flipper;
        self.flipper_motions[index] = Some(self.flipper_motion(index, flipper, offset));
    }

    /// Seconds from `offset` on for which balls on a flipper, which is at `swing` and turns at `speed`, follow one parabola: until
    /// it, or a ball around one of its ends, has turned by [`PIECE_ANGLE`], or a ball comes to such an end; without a ball all
    /// of the tick.
    pub(super) fn flipper_piece(&self, index: usize, swing: f64, speed: f64, offset: f64) -> f64 {
        let (spec, dt) = (&self.scene.flippers[index], self.scene.tick_seconds);
        let (mut piece, mut is_empty) = (PIECE_ANGLE / speed.abs(), true);
        for ball in self.on_flipper(index) {
            is_empty = false;
            let (center, velocity) = ball.at(Instant { tick: self.state.tick, offset }, dt);
            let rolls = spec.rolls_for(swing, speed, center, velocity, self.scene.radius(ball.kind), PIECE_ANGLE);
            piece = if rolls < piece { rolls } else { piece };
        }
        let (left, least) = (dt - offset, dt / f64::from(MOVER_PARTS));
        let piece = if piece > least { piece } else { least };
        if piece < left && !is_empty { piece } else { left }
    }

    /// The balls that a moving flipper carries.
    fn on_flipper(&self, index: usize) -> impl Iterator<Item = &Ball> {
        self.state.balls.iter().filter(move |ball| ball.support == Support::Flipper(index as u16))
    }

    /// What the torque of coil or spring and the balls lying on it make of a flipper, `offset` seconds into the tick.
    fn flipper_acceleration(&self, index: usize, flipper: &FlipperState, drive: f64, offset: f64) -> f64 {
        let scene = &self.scene;
        let spec = &scene.flippers[index];
        let (mut torque, mut inertia) = (drive, spec.inertia);
        for ball in self.on_flipper(index) {
            let (center, velocity) = ball.at(Instant { tick: self.state.tick, offset }, scene.tick_seconds);
            let carried = spec.carried(flipper.swing, flipper.speed, center, velocity, scene.radius(ball.kind));
            let mass = scene.mass(ball.kind);
            // What the flipper must push the ball with, beyond the change of its own turn.
            let pull = self.pull_at(ball, center, velocity, 0.0);
            let push = carried.acceleration - pull.dot(carried.normal);
            if carried.lever * drive / spec.inertia + push > 0.0 {
                torque -= mass * carried.lever * push;
                inertia += mass * carried.lever * carried.lever;
                // Friction, as it is in the ball's present piece of flight.
                let along = tangent(carried.normal);
                let rubbed = (ball.flight.acceleration - pull).dot(along);
                torque -= mass * rubbed * lever(spec, center - carried.normal * scene.radius(ball.kind), along);
            }
        }
        torque / inertia
    }

    /// Mass of the balls lying on a plunger.
    fn plunger_load(&self, index: usize) -> f64 {
        let lying = self.state.balls.iter().filter(|ball| ball.support == Support::Plunger(index as u16));
        lying.fold(0.0, |sum, ball| sum + self.scene.mass(ball.kind))
    }

    /// The coils of pressed flippers have been on for another tick.
    pub(super) fn run_coils(&mut self) {
        for flipper in self.state.flippers.iter_mut().filter(|flipper| flipper.pressed) {
            flipper.coil_time += self.scene.tick_seconds;
        }
    }

    /// 4. Carries flippers and plungers over to the next tick.
    pub(super) fn settle_movers(&mut self) {
        self.run_coils();
        self.settle_moved();
    }

    /// What has moved is where its motion ends.
    pub(super) fn settle_moved(&mut self) {
        let dt = self.scene.tick_seconds;
        for (flipper, motion) in self.state.flippers.iter_mut().zip(&self.flipper_motions) {
            if let (Some(motion), FlipperRest::Moving) = (motion, flipper.rest) {
                flipper.swing = motion.swing_at(dt);
                flipper.speed = motion.speed_at(dt);
            }
        }
        let plungers = self.state.plungers.iter_mut().zip(&self.scene.plungers);
        for ((plunger, spec), motion) in plungers.zip(&self.plunger_motions) {
            if let (Some(motion), false) = (motion, plunger.home) {
                plunger.pull = motion.pull_at(dt);
                plunger.speed = if plunger.hand.is_some() { 0.0 } else { motion.speed_at(dt) };
                // However hard a ball hits it, its rod is only so long.
                if plunger.pull > spec.stroke {
                    (plunger.pull, plunger.speed) = (spec.stroke, 0.0);
                }
            }
        }
    }
}
