//! Saucers: shallow holes that hold a ball for a while, or until they are told to throw it out.
//!
//! A ball whose centre enters the circle slower than the saucer's capture speed drops in and lies still in its centre, below the
//! playfield: it meets no other ball. A faster one, and any while a ball lies in it, passes over unharmed. Thrown out, a ball
//! begins in the circle, and only what enters it is caught: so it must have left before. That a ball lies in a saucer, and since
//! when, is said by the ball: its support, and the start of its flight.

use glam::DVec2;

use super::ball::{Ball, Flight, Instant, Support};
use super::happened::EventKind;
use super::state::StateError;
use super::world::World;

/// What is fixed about a saucer.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct SaucerSpec {
    /// The table's element.
    pub element: u16,
    /// Where a ball lies in it, m.
    pub center: DVec2,
    /// Speed from which on a ball passes over it, m/s.
    pub capture: f64,
    /// Velocity at which it throws a ball out, m/s.
    pub kick: DVec2,
    /// Seconds for which it holds a ball; `None`: until it is told to throw it out.
    pub hold: Option<f64>,
}

impl SaucerSpec {
    /// Ticks of `dt` seconds for which it holds a ball, at least one; `None`: until it is told.
    fn hold_ticks(&self, dt: f64) -> Option<u64> {
        // A cast saturates.
        self.hold.map(|hold| ((hold / dt).ceil() as u64).max(1))
    }

    /// Whether a ball lies in it as one does.
    fn holds(&self, ball: &Ball) -> bool {
        let Flight { position, velocity, acceleration, .. } = ball.flight;
        position == self.center && velocity == DVec2::ZERO && acceleration == DVec2::ZERO
    }
}

impl World {
    /// A ball's centre enters a saucer's circle, `time` seconds after its flight's start.
    pub(super) fn meet_saucer(&mut self, ball: usize, collider: u16, index: u16, offset: f64, time: f64) {
        let spec = self.scene.saucers[usize::from(index)];
        let speed = self.state.balls[ball].flight.velocity_at(time).length();
        let is_taken = self.state.balls.iter().any(|other| other.saucer() == Some(index));
        if speed >= spec.capture || is_taken {
            self.state.balls[ball].past = Some((time, collider));
            self.next[ball] = None;
            return;
        }
        let start = Instant { tick: self.state.tick, offset };
        let caught = &mut self.state.balls[ball];
        caught.flight = Flight { start, position: spec.center, velocity: DVec2::ZERO, acceleration: DVec2::ZERO };
        caught.spin = 0.0;
        (caught.support, caught.slide) = (Support::Held(index), None);
        caught.past = None;
        self.flight_changed(ball);
        self.emit(ball, offset, spec.center, DVec2::ZERO, EventKind::Held { element: spec.element });
    }

    /// The tick from whose start on a ball that lies in a saucer is in play again; `None`: it lies in none, or until it is told.
    pub(super) fn due_out(&self, ball: &Ball) -> Option<u64> {
        match ball.support {
            Support::Released(_) => Some(self.state.tick),
            Support::Held(index) => {
                let ticks = self.scene.saucers[usize::from(index)].hold_ticks(self.scene.tick_seconds)?;
                Some(ball.flight.start.tick.saturating_add(ticks))
            }
            _ => None,
        }
    }

    /// Throws out the balls that are due, at the start of a tick.
    pub(super) fn throw_out(&mut self) {
        for ball in 0..self.state.balls.len() {
            let subject = &self.state.balls[ball];
            let Some(index) = subject.saucer() else { continue };
            if self.due_out(subject).is_none_or(|due| due > self.state.tick) {
                continue;
            }
            let spec = self.scene.saucers[usize::from(index)];
            self.start_flight(ball, 0.0, spec.center, spec.kick, None, None);
            self.emit(ball, 0.0, spec.center, spec.kick, EventKind::Ejected { element: spec.element });
        }
    }

    /// Lets a saucer, by its place in the scene, throw out the ball that it holds, with the next tick. An empty one does nothing.
    pub fn kick(&mut self, saucer: u16) {
        for ball in &mut self.state.balls {
            if ball.support == Support::Held(saucer) {
                ball.support = Support::Released(saucer);
                (self.quiet_until, self.busy_from) = (0, 0);
            }
        }
    }

    /// The saucers that hold a ball and were not told to throw it out, one bit each in the scene's order.
    pub fn held(&self) -> u64 {
        self.state.balls.iter().fold(0, |bits, ball| match ball.support {
            Support::Held(index) => bits | 1_u64.checked_shl(u32::from(index)).unwrap_or(0),
            _ => bits,
        })
    }

    /// Whether a ball lies in a saucer that throws it out only when told.
    pub fn is_locked(&self, ball: &Ball) -> bool {
        ball.saucer().is_some() && self.due_out(ball).is_none()
    }

    /// The balls that are not locked.
    pub fn loose_balls(&self) -> usize {
        self.state.balls.iter().filter(|ball| !self.is_locked(ball)).count()
    }

    /// Whether every ball in play lies in a saucer, and none comes out unless told.
    pub fn waits_in_saucers(&self) -> bool {
        !self.state.balls.is_empty() && self.loose_balls() == 0
    }
}

/// Whether the balls in saucers lie there as balls do, each in one of its own.
pub(super) fn check_held(saucers: &[SaucerSpec], balls: &[Ball]) -> Result<(), StateError> {
    let mut taken = 0_u64;
    for (index, ball) in balls.iter().enumerate() {
        let Some(saucer) = ball.saucer() else { continue };
        let Some(spec) = saucers.get(usize::from(saucer)) else { return Err(StateError::Support { index }) };
        if !spec.holds(ball) {
            return Err(StateError::Number { what: "ball", index });
        }
        let bit = 1_u64.checked_shl(u32::from(saucer)).unwrap_or(0);
        if taken & bit != 0 {
            return Err(StateError::Support { index });
        }
        taken |= bit;
    }
    Ok(())
}
