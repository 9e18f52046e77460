//! Everything about a world that changes: what is saved, sent and digested.

use serde::{Deserialize, Serialize};
use thiserror::Error;

use super::ball::{Ball, Instant, Support};
use super::cabinet::CabinetState;
use super::constants::MOST_SPEED;
use super::flipper::FlipperState;
use super::hinge::HingeState;
use super::needs::Needs;
use super::plunger::PlungerState;
use super::saucer::check_held;
use super::scene::{Collider, Presence, Scene};
use super::shapes::Shape;
use crate::physics::flipper::FlipperRest;

/// Most balls in play at once.
pub const MOST_BALLS: usize = 1000;
/// Balls for which there is room where balls do not meet.
const FEW_BALLS: usize = 16;
/// Most flippers, plungers or targets on a table.
pub const MOST_PARTS: usize = 64;

/// Most ticks of a world: beyond, the tick after a flight of the longest kind has no number. Moments are told apart by whole
/// ticks, so that nothing ends at the 2^53 ticks that an f64 can count.
const MOST_TICKS: u64 = 1 << 62;
/// Most ticks of one flight: 35 years at 1 kHz, with 13 bits left for a part of a tick.
const MOST_FLIGHT_TICKS: u64 = 1 << 40;

/// A target that can fall.
#[derive(Debug, Clone, Copy, PartialEq, Eq, Serialize, Deserialize)]
pub enum TargetState {
    /// Stands.
    Up,
    /// Has fallen.
    Down,
    /// Was told to rise, and does as soon as no ball is in its way.
    Rising,
}

/// The state of a world. Written, it holds what its scene needs and nothing else: see [`super::state_form`].
#[derive(Debug, Clone, PartialEq)]
pub struct WorldState {
    /// What the scene requires, and so what is written.
    pub needs: Needs,
    /// Ticks since the world began.
    pub tick: u64,
    /// Balls served so far: the next one's id.
    pub served: u32,
    /// Balls in play.
    pub balls: Vec<Ball>,
    /// In the scene's order.
    pub flippers: Vec<FlipperState>,
    /// In the scene's order.
    pub plungers: Vec<PlungerState>,
    /// In the scene's order.
    pub targets: Vec<TargetState>,
    /// In the scene's order.
    pub hinges: Vec<HingeState>,
    /// In the scene's order: whether it is on.
    pub magnets: Vec<bool>,
    /// The table's own motion.
    pub cabinet: CabinetState,
}

/// Why a state was refused.
#[derive(Debug, Clone, PartialEq, Eq, Error)]
pub enum StateError {
    /// A list has not the table's length.
    #[error("the state has {found} {what}, the table has {expected}")]
    Count {
        /// Flippers, plungers, targets or hinges.
        what: &'static str,
        /// In the state.
        found: usize,
        /// In the table.
        expected: usize,
    },
    /// It was written for another scene.
    #[error("the state holds what another scene needs ({found:014b}), this one needs {expected:014b}")]
    Needs {
        /// Of the state, one bit a need.
        found: u16,
        /// Of the scene.
        expected: u16,
    },
    /// NaN, an infinity, or a moment that is not within a tick.
    #[error("{what} {index} has a number that is not finite or out of range")]
    Number {
        /// Ball, flipper, plunger or hinge.
        what: &'static str,
        /// Its place in the state.
        index: usize,
    },
    /// A reference to something that the table has not.
    #[error("ball {index} lies on something that the table has not")]
    Support {
        /// The ball's place in the state.
        index: usize,
    },
}

impl WorldState {
    /// The state of a world in which nothing has happened.
    pub fn new(scene: &Scene) -> Self {
        let mut state = Self {
            needs: scene.needs,
            tick: 0,
            served: 0,
            balls: Vec::new(),
            flippers: vec![FlipperState::default(); scene.flippers.len()],
            plungers: vec![PlungerState::default(); scene.plungers.len()],
            targets: scene
                .targets_at_start()
                .map(|stands| if stands { TargetState::Up } else { TargetState::Down })
                .collect(),
            hinges: vec![HingeState::default(); scene.hinges.len()],
            magnets: scene.magnets.iter().map(|magnet| magnet.on).collect(),
            cabinet: CabinetState::default(),
        };
        state.reserve_balls();
        state
    }

    /// Makes room for as many balls as there may be in play.
    pub(super) fn reserve_balls(&mut self) {
        let room = if self.needs.ball_ball { MOST_BALLS } else { FEW_BALLS };
        self.balls.reserve(room.saturating_sub(self.balls.len()));
    }

    /// Whether a collider is there.
    pub fn has(&self, collider: &Collider) -> bool {
        match collider.presence {
            Presence::Always => true,
            Presence::TargetUp(i) => self.targets[usize::from(i)] == TargetState::Up,
            Presence::FlipperAtRest(i) => self.flippers[usize::from(i)].rest == FlipperRest::AtRest,
            Presence::FlipperRaised(i) => self.flippers[usize::from(i)].rest == FlipperRest::Raised,
            Presence::PlungerHome(i) => self.plungers[usize::from(i)].home,
        }
    }

    /// Checks a state that came from outside against the scene that it is for.
    ///
    /// # Errors
    /// The first thing found wrong.
    pub fn check(&self, scene: &Scene) -> Result<(), StateError> {
        if self.needs != scene.needs {
            return Err(StateError::Needs { found: self.needs.bits(), expected: scene.needs.bits() });
        }
        if self.balls.len() > MOST_BALLS {
            return Err(StateError::Count { what: "balls", found: self.balls.len(), expected: MOST_BALLS });
        }
        let counts = [
            ("flippers", self.flippers.len(), scene.flippers.len()),
            ("plungers", self.plungers.len(), scene.plungers.len()),
            ("targets", self.targets.len(), usize::from(scene.targets)),
            ("hinges", self.hinges.len(), scene.hinges.len()),
            ("magnets", self.magnets.len(), scene.magnets.len()),
        ];
        for (what, found, expected) in counts {
            if found != expected {
                return Err(StateError::Count { what, found, expected });
            }
        }
        for (index, ball) in self.balls.iter().enumerate() {
            self.check_ball(scene, index, ball)?;
        }
        check_held(&scene.saucers, &self.balls)?;
        // A moment whose distance from another has no digits left for a part of a tick is no moment.
        if self.tick > MOST_TICKS {
            return Err(StateError::Number { what: "tick", index: 0 });
        }
        let is_slow = |speed: f64| speed.abs() <= MOST_SPEED;
        for (index, (flipper, spec)) in self.flippers.iter().zip(&scene.flippers).enumerate() {
            let in_stroke = (-spec.stroke..=2.0 * spec.stroke).contains(&flipper.swing);
            let coil_is_possible = (0.0..=MOST_TICKS as f64).contains(&flipper.coil_time);
            if !(in_stroke && coil_is_possible && is_slow(flipper.speed * spec.reach())) {
                return Err(StateError::Number { what: "flipper", index });
            }
        }
        if !self.cabinet.is_possible() {
            return Err(StateError::Number { what: "cabinet", index: 0 });
        }
        for (index, (plunger, spec)) in self.plungers.iter().zip(&scene.plungers).enumerate() {
            let in_stroke = (-spec.stroke..=2.0 * spec.stroke).contains(&plunger.pull);
            let hand = plunger.hand.unwrap_or(0.0);
            if !(in_stroke && is_slow(plunger.speed) && (0.0..=1.0).contains(&hand)) {
                return Err(StateError::Number { what: "plunger", index });
            }
        }
        for (index, (hinge, spec)) in self.hinges.iter().zip(&scene.hinges).enumerate() {
            if !hinge.is_possible(spec, self.tick, scene.tick_seconds) {
                return Err(StateError::Number { what: "hinge", index });
            }
        }
        Ok(())
    }

    fn check_ball(&self, scene: &Scene, index: usize, ball: &Ball) -> Result<(), StateError> {
        let number = StateError::Number { what: "ball", index };
        let start = ball.flight.start;
        let in_tick = start.tick <= self.tick && start.offset >= 0.0 && start.offset <= scene.tick_seconds;
        let past_is_a_number = ball.past.is_none_or(|(t, _)| t.is_finite());
        let dt = scene.tick_seconds;
        let slide_is_possible = ball.slide.is_none_or(|slide| {
            slide.spin_rate.is_finite() && slide.until.is_none_or(|until| until >= 0.0 && until.is_finite())
        });
        let is_slow =
            ball.flight.velocity.length() <= MOST_SPEED && ball.flight.acceleration.length() * dt <= MOST_SPEED;
        if usize::from(ball.kind) >= scene.kinds.len() {
            return Err(number);
        }
        let is_finite = ball.flight.is_finite() && ball.spin.is_finite();
        if !(is_finite && in_tick && past_is_a_number && slide_is_possible && is_slow) {
            return Err(number);
        }
        // No world has a ball beside its table, and none that has flown for years.
        let (position, _) = ball.at(Instant::start_of(self.tick), dt);
        if !scene.is_inside(position) || self.tick - start.tick > MOST_FLIGHT_TICKS {
            return Err(number);
        }
        // Only what stops a ball carries it, and only on its own floor.
        let carries = |collider: &&Collider| !collider.role.is_passed() && collider.floor == ball.floor;
        let collider = |i: u16| scene.colliders.get(usize::from(i)).filter(carries);
        let known = match ball.support {
            Support::None | Support::Stalled => true,
            Support::Line(i) => collider(i).is_some_and(|c| matches!(c.shape, Shape::Segment(_))),
            Support::Arc(i) => collider(i).is_some_and(|c| matches!(c.shape, Shape::Arc(_))),
            Support::Wedge(i, j) => collider(i).is_some() && collider(j).is_some(),
            Support::Flipper(i) => usize::from(i) < scene.flippers.len(),
            Support::Plunger(i) => usize::from(i) < scene.plungers.len(),
            Support::Held(i) | Support::Released(i) => usize::from(i) < scene.saucers.len(),
        };
        if known { Ok(()) } else { Err(StateError::Support { index }) }
    }
}
