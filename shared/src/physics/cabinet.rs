//! The cabinet: a nudge moves the table, not the ball, and a plumb bob notices.
//!
//! Everything is seen from the table. While the table moves, each ball that nothing holds is accelerated the other way; walls,
//! flippers and whatever lies on them move with the table, so that a ball feels a nudge through what it touches. The table
//! swings on its legs, along x and along y, as a damped oscillator; the bob hangs in it as a damped pendulum. Both are carried
//! from tick to tick in closed form, with one acceleration of the table for each tick: that of its change of velocity.

use glam::DVec2;
use serde::{Deserialize, Serialize};

use super::ball::Support;
use super::constants::{MOST_SHAKE, STILL_BOB, STILL_TABLE};
use super::numbers::Numbers;
use super::world::World;

/// What is fixed about a cabinet.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct CabinetSpec {
    /// Speed that a nudge gives the table, m/s.
    pub speed: f64,
    /// The table on its legs, along x and along y.
    pub legs: [Oscillator; 2],
    /// The plumb bob in it.
    pub bob: Oscillator,
    /// Swing of the bob beyond which it touches its ring, m.
    pub ring: f64,
}

/// A damped oscillator's motion over one tick: what of a displacement and of a speed is left as displacement and as speed.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct Oscillator {
    /// Displacement after a tick for one of 1 m, and for a speed of 1 m/s, s.
    displacement: (f64, f64),
    /// Speed after a tick for a displacement of 1 m, 1/s, and for a speed of 1 m/s.
    speed: (f64, f64),
    /// Angular frequency without damping, rad/s.
    frequency: f64,
}

impl Oscillator {
    /// With that angular frequency, in rad/s, and that share of critical damping, below 1; over `dt` seconds.
    pub fn new(frequency: f64, damping: f64, dt: f64) -> Self {
        let decay = damping * frequency;
        let damped = frequency * (1.0 - damping * damping).sqrt();
        let (sine, cosine) = libm::sincos(damped * dt);
        let (left, sine) = (libm::exp(-decay * dt), sine / damped);
        Self {
            displacement: (left * (cosine + decay * sine), left * sine),
            speed: (-left * frequency * frequency * sine, left * (cosine - decay * sine)),
            frequency,
        }
    }

    /// Displacement and speed a tick later, while `pull` m/s^2 acts on it.
    fn advance(&self, displacement: f64, speed: f64, pull: f64) -> (f64, f64) {
        // About the place where the pull would hold it.
        let rest = pull / (self.frequency * self.frequency);
        let from = displacement - rest;
        let to = self.displacement.0 * from + self.displacement.1 * speed;
        (to + rest, self.speed.0 * from + self.speed.1 * speed)
    }
}

/// What changes about a cabinet, seen from the floor under it.
#[derive(Debug, Clone, Copy, Default, PartialEq, Serialize, Deserialize)]
#[serde(from = "Numbers<12>", into = "Numbers<12>")]
pub struct CabinetState {
    /// Of the table from its place, m.
    pub displacement: DVec2,
    /// Of the table, m/s.
    pub velocity: DVec2,
    /// What it was pushed by since the last tick, m/s.
    pub push: DVec2,
    /// Of the table in the last tick, m/s^2.
    pub acceleration: DVec2,
    /// Of the bob from the table's middle, m.
    pub bob: DVec2,
    /// Of the bob, seen from the table, m/s.
    pub bob_velocity: DVec2,
}

/// As it is written: what was pushed from the side swings sideways alone, and what is still takes no room.
impl From<CabinetState> for Numbers<12> {
    fn from(state: CabinetState) -> Self {
        let CabinetState { displacement, velocity, push, acceleration, bob, bob_velocity } = state;
        let across = [push, displacement, velocity, acceleration, bob, bob_velocity];
        let mut numbers = [0.0; 12];
        for (place, vector) in across.into_iter().enumerate() {
            (numbers[place], numbers[place + 6]) = (vector.x, vector.y);
        }
        Self(numbers)
    }
}

impl From<Numbers<12>> for CabinetState {
    fn from(Numbers(numbers): Numbers<12>) -> Self {
        let vector = |place: usize| DVec2::new(numbers[place], numbers[place + 6]);
        let [push, displacement, velocity, acceleration, bob, bob_velocity] = [0, 1, 2, 3, 4, 5].map(vector);
        Self { displacement, velocity, push, acceleration, bob, bob_velocity }
    }
}

impl CabinetState {
    /// Whether nothing of it moves.
    pub fn is_still(&self) -> bool {
        *self == Self::default()
    }

    /// Whether no number is beyond what any hand could do.
    pub(super) fn is_possible(&self) -> bool {
        let numbers = [self.displacement, self.velocity, self.push, self.bob, self.bob_velocity];
        numbers.into_iter().all(|number| number.length() <= MOST_SHAKE)
            && self.acceleration.length() <= MOST_SHAKE * MOST_SHAKE
    }

    /// A tick later.
    fn advanced(mut self, spec: &CabinetSpec, dt: f64) -> Self {
        let before = self.velocity;
        self.velocity += core::mem::take(&mut self.push);
        (self.displacement.x, self.velocity.x) = spec.legs[0].advance(self.displacement.x, self.velocity.x, 0.0);
        (self.displacement.y, self.velocity.y) = spec.legs[1].advance(self.displacement.y, self.velocity.y, 0.0);
        let frequency = DVec2::new(spec.legs[0].frequency, spec.legs[1].frequency);
        // What is left of a nudge after some seconds moves no ball: the table stands still.
        if self.velocity.length() + (self.displacement * frequency).length() < STILL_TABLE {
            (self.displacement, self.velocity) = (DVec2::ZERO, DVec2::ZERO);
        }
        self.acceleration = (self.velocity - before) / dt;
        (self.bob.x, self.bob_velocity.x) = spec.bob.advance(self.bob.x, self.bob_velocity.x, -self.acceleration.x);
        (self.bob.y, self.bob_velocity.y) = spec.bob.advance(self.bob.y, self.bob_velocity.y, -self.acceleration.y);
        let swings = self.bob.length() + self.bob_velocity.length() / spec.bob.frequency;
        if self.acceleration == DVec2::ZERO && self.velocity == DVec2::ZERO && swings < STILL_BOB * spec.ring {
            (self.bob, self.bob_velocity) = (DVec2::ZERO, DVec2::ZERO);
        }
        // What no state may hold, none becomes: else nobody could go on from it.
        if self.is_possible() { self } else { Self::default() }
    }
}

impl World {
    /// A push on the cabinet along that direction of length 1 at the most: it acts from the next step on. A table that cannot be
    /// nudged, or a direction that is no number, changes nothing.
    pub fn nudge(&mut self, direction: DVec2) {
        if let Some(spec) = self.scene.cabinet
            && direction.length_squared() <= 1.0
        {
            self.state.cabinet.push += direction * spec.speed;
            self.wake();
        }
    }

    /// Whether the plumb bob touches its ring.
    pub fn bob_touches(&self) -> bool {
        self.scene.cabinet.is_some_and(|spec| self.state.cabinet.bob.length() > spec.ring)
    }

    /// Somebody stops the plumb bob: the next player begins with one that hangs still.
    pub fn still_the_bob(&mut self) {
        (self.state.cabinet.bob, self.state.cabinet.bob_velocity) = (DVec2::ZERO, DVec2::ZERO);
    }

    /// The table moves on by a tick; every ball that it takes along, or leaves behind, begins a new flight.
    pub(super) fn move_cabinet(&mut self) {
        let Some(spec) = self.scene.cabinet else { return };
        self.state.cabinet = self.state.cabinet.advanced(&spec, self.scene.tick_seconds);
        if self.state.cabinet.acceleration == DVec2::ZERO && self.before == DVec2::ZERO {
            return;
        }
        for ball in 0..self.state.balls.len() {
            self.renew_flight(ball);
        }
    }

    /// A ball begins a new flight with the tick, because what pulls it has changed. Balls that follow a surface tick by tick
    /// do so anyway.
    pub(super) fn renew_flight(&mut self, ball: usize) {
        let (hit, before) = match self.state.balls[ball].support {
            Support::None => (None, None),
            Support::Line(index) => (Some(index), None),
            Support::Wedge(one, other) => (Some(one), Some(other)),
            _ => return,
        };
        let (position, velocity) = self.ball_at(ball, 0.0);
        self.refresh_spin(ball, 0.0, position, velocity);
        self.start_flight(ball, 0.0, position, velocity, hit, before);
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    const DT: f64 = 1e-3;

    #[test]
    fn an_oscillator_swings_and_decays_as_the_closed_form_says() {
        let (frequency, damping) = (2.0 * core::f64::consts::PI * 9.3, 0.052);
        let oscillator = Oscillator::new(frequency, damping, DT);
        let (mut displacement, mut speed) = (0.0, 0.06);
        for tick in 1..=2000 {
            (displacement, speed) = oscillator.advance(displacement, speed, 0.0);
            let t = f64::from(tick) * DT;
            let damped = frequency * (1.0_f64 - damping * damping).sqrt();
            let expected = 0.06 / damped * libm::exp(-damping * frequency * t) * libm::sin(damped * t);
            assert!((displacement - expected).abs() < 1e-15, "{displacement} after {tick} ticks");
        }
        assert!(speed.abs() < 0.06 * 0.003);
    }

    /// Broke: a state at the limits was accepted, and refused a tick later.
    #[test]
    fn a_shake_at_the_limits_stays_within_them() {
        let leg = Oscillator::new(50.0, 0.05, DT);
        let spec = CabinetSpec { speed: 0.06, legs: [leg; 2], bob: Oscillator::new(10.0, 0.05, DT), ring: 2e-3 };
        let most = DVec2::new(0.0, MOST_SHAKE);
        let mut state =
            CabinetState { displacement: -most, velocity: most, push: most, bob: most, ..Default::default() };
        for tick in 0..100 {
            assert!(state.is_possible(), "tick {tick}: {state:?}");
            state = state.advanced(&spec, DT);
        }
    }

    #[test]
    fn a_steady_pull_holds_an_oscillator_off_its_place() {
        let oscillator = Oscillator::new(10.0, 0.5, DT);
        let (mut displacement, mut speed) = (0.0, 0.0);
        for _ in 0..20_000 {
            (displacement, speed) = oscillator.advance(displacement, speed, 3.0);
        }
        assert!((displacement - 0.03).abs() < 1e-14 && speed.abs() < 1e-14, "{displacement} {speed}");
    }
}
