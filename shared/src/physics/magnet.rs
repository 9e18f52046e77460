//! Magnets under the playfield: they pull a ball towards their core, and hold it there.
//!
//! A flight in a field is no parabola. It is followed in pieces of a tick, each with the field in its middle: an error that
//! falls with the tick.

use glam::DVec2;

use super::ball::{Ball, Instant, Support};
use super::world::World;

/// Share of its reach by which a field is wider for a ball that has just been found on its rim: rounding.
const RIM: f64 = 1e-9;

/// What is fixed about a magnet.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct MagnetSpec {
    /// The table's element.
    pub element: u16,
    /// m.
    pub center: DVec2,
    /// How far its field reaches, m.
    pub reach: f64,
    /// Radius of its core, m.
    pub core: f64,
    /// Pull at the rim of the core, m/s^2. It falls with the square of the distance outside, and linearly to the centre inside.
    pub strength: f64,
    /// Rate at which the core brakes a ball, 1/s.
    pub drag: f64,
    /// Whether it is on when nobody has switched it.
    pub on: bool,
    /// The floor that it acts on.
    pub floor: u8,
}

impl MagnetSpec {
    /// Whether a place is within the field, or on its rim.
    pub fn reaches(&self, place: DVec2) -> bool {
        let reach = self.reach * (1.0 + RIM);
        (place - self.center).length_squared() <= reach * reach
    }

    /// Acceleration of a ball there with that velocity, on average over `seconds`, m/s^2.
    pub fn pull(&self, place: DVec2, velocity: DVec2, seconds: f64) -> DVec2 {
        let offset = place - self.center;
        let distance = offset.length();
        if distance > self.core {
            let share = self.core / distance;
            return offset * (-self.strength * share * share / distance);
        }
        // What the drag leaves of a speed, in closed form: strong brakes and long ticks stop a ball, and do not throw it back.
        let braked = if seconds > 0.0 { -libm::expm1(-self.drag * seconds) / seconds } else { self.drag };
        offset * (-self.strength / self.core) - velocity * braked
    }
}

impl World {
    /// Switches a magnet, by its place in the scene, on or off: what it pulls is pulled otherwise from the next tick on.
    pub fn switch(&mut self, magnet: u16, on: bool) {
        let Some(spec) = self.scene.magnets.get(usize::from(magnet)).copied() else { return };
        if self.state.magnets[usize::from(magnet)] == on {
            return;
        }
        self.state.magnets[usize::from(magnet)] = on;
        self.wake();
        for ball in 0..self.state.balls.len() {
            if self.is_within(&spec, &self.state.balls[ball]) {
                self.renew_flight(ball);
            }
        }
    }

    /// The pull at `place` of all magnets whose field a ball was in at `from`, on average over `seconds`, m/s^2.
    pub(super) fn magnetic_pull(&self, floor: u8, from: DVec2, place: DVec2, velocity: DVec2, seconds: f64) -> DVec2 {
        let working = self.scene.magnets.iter().zip(&self.state.magnets);
        let working =
            working.filter(|(spec, on)| **on && spec.floor == floor && spec.reaches(from) && spec.reaches(place));
        working.fold(DVec2::ZERO, |sum, (spec, _)| sum + spec.pull(place, velocity, seconds))
    }

    /// Whether a ball is in the field of a magnet: now, or at the start of its flight.
    fn is_within(&self, spec: &MagnetSpec, ball: &Ball) -> bool {
        let (place, _) = ball.at(Instant::start_of(self.state.tick), self.scene.tick_seconds);
        spec.floor == ball.floor && (spec.reaches(place) || spec.reaches(ball.flight.position))
    }

    /// Whether a magnet pulls a ball.
    pub(super) fn is_in_field(&self, ball: &Ball) -> bool {
        let working = self.scene.magnets.iter().zip(&self.state.magnets);
        working.filter(|(_, on)| **on).any(|(spec, _)| self.is_within(spec, ball))
    }

    /// Balls in a field begin a new piece of flight with the tick.
    pub(super) fn follow_fields(&mut self) {
        for ball in 0..self.state.balls.len() {
            if self.is_in_field(&self.state.balls[ball]) {
                self.renew_flight(ball);
            }
        }
    }

    /// A ball's centre enters the field of a magnet.
    pub(super) fn enter_field(&mut self, ball: usize, collider: u16, index: u16, offset: f64, time: f64) {
        let mut since = time;
        if self.state.magnets[usize::from(index)] {
            let (position, velocity) = self.ball_at(ball, offset);
            let support = match self.state.balls[ball].support {
                Support::Line(i) | Support::Arc(i) => Some(i),
                _ => None,
            };
            self.refresh_spin(ball, offset, position, velocity);
            self.start_flight(ball, offset, position, velocity, support, None);
            since = 0.0;
        }
        self.state.balls[ball].past = Some((since, collider));
        self.next[ball] = None;
    }
}
