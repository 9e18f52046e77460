//! End stops: what meets them, and flippers that a ball drives off theirs.

use glam::DVec2;

use super::constants::{FLIPPER_STOP_SPEED, LOST_CONTACT};
use super::contact::{Mobility, Response, Surface};
use super::flipper::{FlipperMotion, FlipperRest};
use super::movers::{Mover, lever};
use super::scene::Presence;
use super::world::World;
use crate::math::tangent;

/// A flipper that can give way: it lies at a stop, and is pushed away from it.
#[derive(Debug, Clone, Copy)]
pub(super) struct GivesWay {
    /// Place in the scene.
    pub(super) flipper: usize,
    /// Of the push on the ball along the normal and along the surface, in the sense of the swing, m.
    levers: [f64; 2],
    /// kg m^2.
    inertia: f64,
    /// Sign of a speed away from the stop.
    away: f64,
}

impl GivesWay {
    /// The surface, as movable as the flipper is.
    pub(super) fn surface(&self, surface: Surface) -> Surface {
        Surface { mobility: Mobility::on_axis(self.levers[0], self.levers[1], self.inertia), ..surface }
    }

    /// The speed that an impact gives the flipper, rad/s; `None` if it is so slow that coil or spring just hold it.
    pub(super) fn speed_after(&self, after: &Response) -> Option<f64> {
        let speed = -(after.impulse * self.levers[0] + after.drag * self.levers[1]) / self.inertia;
        (speed * self.away >= FLIPPER_STOP_SPEED).then_some(speed)
    }
}

impl World {
    /// Whether a ball that meets a collider pushes a flipper off the stop that it lies at.
    pub(super) fn gives_way(
        &self,
        presence: Presence,
        position: DVec2,
        normal: DVec2,
        radius: f64,
    ) -> Option<GivesWay> {
        let (flipper, raised) = match presence {
            Presence::FlipperAtRest(i) => (usize::from(i), false),
            Presence::FlipperRaised(i) => (usize::from(i), true),
            _ => return None,
        };
        let spec = &self.scene.flippers[flipper];
        let levers = [normal, tangent(normal)].map(|push| lever(spec, position - normal * radius, push));
        // The flipper gets the opposite of the push on the ball: down from the upper stop, up from the lower one.
        (if raised { levers[0] > 0.0 } else { levers[0] < 0.0 }).then_some(GivesWay {
            flipper,
            levers,
            inertia: spec.inertia,
            away: if raised { -1.0 } else { 1.0 },
        })
    }

    /// A flipper leaves its stop at that speed, rad/s; coil or spring will bring it back.
    pub(super) fn leave_stop(&mut self, index: usize, offset: f64, speed: f64) {
        let flipper = &mut self.state.flippers[index];
        (flipper.rest, flipper.speed) = (FlipperRest::Moving, speed);
        self.flipper_changed(index, offset, true);
        let flipper = self.state.flippers[index];
        self.flipper_motions[index] = Some(self.flipper_motion(index, flipper, offset));
    }

    /// A ball at that place lies still for the rest of the tick, and with it whatever flipper presses it against something that
    /// does not give way.
    pub(super) fn hold_flippers_at(&mut self, position: DVec2, radius: f64, offset: f64) {
        for index in 0..self.flipper_motions.len() {
            let Some(flipper) = self.moving_flipper(index) else { continue };
            if flipper.nearest(offset, position).distance > radius * (1.0 + LOST_CONTACT) {
                continue;
            }
            let swing = flipper.motion.swing_at(offset);
            self.flipper_motions[index] = Some(FlipperMotion { from: offset, swing, speed: 0.0, acceleration: 0.0 });
            let flipper = &mut self.state.flippers[index];
            (flipper.swing, flipper.speed) = (swing, 0.0);
        }
    }

    /// A flipper meets an end stop: it bounces off, or stays.
    pub(super) fn stop_flipper(&mut self, index: usize, raised: bool, offset: f64) {
        let Some(mut motion) = self.flipper_motions[index] else { return };
        let spec = &self.scene.flippers[index];
        let (swing, speed, rest) = spec.at_stop(raised, motion.speed_at(offset));
        let flipper = &mut self.state.flippers[index];
        (flipper.swing, flipper.speed, flipper.rest) = (swing, speed, rest);
        if rest == FlipperRest::Moving {
            (motion.swing, motion.speed, motion.from) = (swing, speed, offset);
            self.flipper_motions[index] = Some(motion);
        } else {
            self.flipper_motions[index] = None;
        }
        self.flipper_changed(index, offset, false);
    }

    /// A plunger that was let go comes home.
    pub(super) fn stop_plunger(&mut self, index: usize, offset: f64) {
        let plunger = &mut self.state.plungers[index];
        (plunger.home, plunger.pull, plunger.speed) = (true, 0.0, 0.0);
        self.plunger_motions[index] = None;
        self.plunger_changed(index, offset, false);
    }
}
