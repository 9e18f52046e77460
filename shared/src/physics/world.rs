//! The world: balls, flippers, plungers and targets, stepped one tick at a time.
//!
//! [`World::step`] is the main flow. Within a tick, everything that happens is processed in order of time; ties go to
//! the ball with the lowest place, then to static shapes before moving ones, then to the lowest index.

use std::sync::Arc;

use glam::DVec2;

use super::ball::{Ball, Flight, Instant, Support};
use super::constants::CLEAR_OF_TARGET;
use super::flipper::{FlipperMotion, FlipperRest};
use super::motion::{Next, next_event};
use super::movers::{MovingFlipper, MovingPlunger};
use super::plunger::PlungerMotion;
use super::scene::{Presence, Scene};
use super::shapes::Bounds;
use super::state::{MOST_BALLS, StateError, TargetState, WorldState};

/// Something that happened to a ball.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct Event {
    /// When.
    pub at: Instant,
    /// Which ball.
    pub ball: u32,
    /// Its centre then, m.
    pub position: DVec2,
    /// What.
    pub kind: EventKind,
}

/// What happened.
#[derive(Debug, Clone, Copy, PartialEq)]
pub enum EventKind {
    /// It met a surface of that element, at that normal speed in m/s.
    Touched {
        /// The table's element.
        element: u16,
        /// Of approach.
        speed: f64,
    },
    /// It was kicked by that element.
    Kicked {
        /// The table's element.
        element: u16,
        /// Of approach.
        speed: f64,
    },
    /// It made that target fall.
    Felled {
        /// The table's element.
        element: u16,
        /// Of approach.
        speed: f64,
    },
    /// It passed that sensor.
    Passed {
        /// The table's element.
        element: u16,
    },
    /// It is lost.
    Drained,
    /// It left the table where no ball should, and was taken out.
    Escaped,
}

/// A world: a scene and its state.
#[derive(Debug, Clone)]
pub struct World {
    pub(super) scene: Arc<Scene>,
    pub(super) state: WorldState,
    /// For each ball, its next event among the static shapes, if known. Can be recomputed to the same bits.
    pub(super) next: Vec<Option<Next>>,
    /// What happened in the last step.
    pub(super) events: Vec<Event>,
    /// Motions of flippers and plungers within the current tick; those at rest have none.
    pub(super) flipper_motions: Vec<Option<FlipperMotion>>,
    pub(super) plunger_motions: Vec<Option<PlungerMotion>>,
    /// Impacts of each ball within the current tick.
    pub(super) impacts: Vec<u32>,
    /// Before this tick nothing happens, unless somebody does something. Can be recomputed.
    quiet_until: u64,
}

impl World {
    /// A world without a ball.
    pub fn new(scene: Arc<Scene>) -> Self {
        let state = WorldState::new(&scene);
        Self {
            next: Vec::with_capacity(MOST_BALLS),
            events: Vec::with_capacity(64),
            flipper_motions: vec![None; scene.flippers.len()],
            plunger_motions: vec![None; scene.plungers.len()],
            impacts: Vec::with_capacity(MOST_BALLS),
            quiet_until: 0,
            scene,
            state,
        }
    }

    /// Advances the world by one tick and returns what happened in it.
    pub fn step(&mut self) -> &[Event] {
        self.events.clear();
        // 0. Flights were solved when they began: until the next event, time just passes.
        if self.state.tick < self.quiet_until {
            self.state.tick += 1;
            return &self.events;
        }
        self.impacts.clear();
        self.impacts.resize(self.state.balls.len(), 0);
        // 1. Flippers and plungers: which of them move in this tick, and how they are driven.
        self.drive_movers();
        // 2. Balls on a curved or moving surface begin a new piece of flight along it.
        self.follow_surfaces();
        // 3. Everything that happens, in order of time.
        self.run_events();
        // 4. Flippers and plungers as they are at the tick's end; targets that waited for a ball to clear;
        //    balls that left the table.
        self.settle_movers();
        self.state.tick += 1;
        self.raise_targets();
        self.take_out_escaped();
        self.quiet_until = self.next_busy_tick();
        &self.events
    }

    /// What happened in the last step.
    pub fn events(&self) -> &[Event] {
        &self.events
    }

    /// The state as it is between two ticks.
    pub fn state(&self) -> &WorldState {
        &self.state
    }

    /// The scene that it plays in.
    pub fn scene(&self) -> &Arc<Scene> {
        &self.scene
    }

    /// Goes on from a saved state.
    ///
    /// # Errors
    /// If the state does not fit the scene; the world is then unchanged.
    pub fn restore(&mut self, state: WorldState) -> Result<(), StateError> {
        state.check(&self.scene)?;
        self.next.clear();
        self.next.resize(state.balls.len(), None);
        self.state = state;
        self.events.clear();
        self.quiet_until = 0;
        Ok(())
    }

    /// Puts a ball into play, at rest; `None` if there are too many already.
    pub fn serve(&mut self, position: DVec2) -> Option<u32> {
        if self.state.balls.len() >= MOST_BALLS {
            return None;
        }
        let id = self.state.served;
        self.state.served = id.wrapping_add(1);
        let start = Instant::start_of(self.state.tick);
        let flight = Flight { start, position, velocity: DVec2::ZERO, acceleration: self.scene.gravity };
        self.state.balls.push(Ball { id, flight, spin: 0.0, support: Support::None, past: None });
        self.next.push(None);
        self.quiet_until = 0;
        Some(id)
    }

    /// Takes every ball out of play.
    pub fn clear_balls(&mut self) {
        self.state.balls.clear();
        self.next.clear();
        self.quiet_until = 0;
    }

    /// Presses or releases the button of all flippers of one hand.
    pub fn press(&mut self, right: bool, pressed: bool) {
        self.quiet_until = 0;
        for (spec, flipper) in self.scene.flippers.iter().zip(&mut self.state.flippers) {
            if spec.right == right && flipper.pressed != pressed {
                flipper.pressed = pressed;
                flipper.coil_time = 0.0;
            }
        }
    }

    /// Holds every plunger at that share of its stroke, or lets go of it. A share beyond 0 to 1 is cut to it.
    pub fn pull(&mut self, hand: Option<f64>) {
        self.quiet_until = 0;
        for plunger in &mut self.state.plungers {
            plunger.hand = hand.map(|share| if share > 0.0 { share.min(1.0) } else { 0.0 });
        }
    }

    /// Lets a fallen target rise, as soon as no ball is in its way.
    pub fn raise(&mut self, target: u16) {
        let target = &mut self.state.targets[usize::from(target)];
        if *target == TargetState::Down {
            *target = TargetState::Rising;
            self.quiet_until = 0;
        }
    }

    /// The first tick in which something may happen: a coil, a plunger or a target at work, a ball that follows a
    /// surface tick by tick, or a flight's next event.
    fn next_busy_tick(&self) -> u64 {
        let (state, dt) = (&self.state, self.scene.tick_seconds);
        let at_work = state.flippers.iter().any(|f| f.pressed || f.rest != FlipperRest::AtRest)
            || state.plungers.iter().any(|p| !p.home || !p.stays_home())
            || state.targets.contains(&TargetState::Rising);
        if at_work {
            return 0;
        }
        let now = Instant::start_of(state.tick);
        let mut busy = u64::MAX;
        for (ball, next) in state.balls.iter().zip(&self.next) {
            let (Support::None | Support::Line(_) | Support::Wedge(..), Some(next)) = (ball.support, next) else {
                return 0;
            };
            let (from, to) = (now.since(ball.flight.start, dt), next.time());
            // A ball that leaves the table has to be noticed in that very tick.
            let path = Bounds::of_flight(&ball.flight, from, if to < f64::MAX { to } else { from });
            if !(self.scene.is_inside(path.low) && self.scene.is_inside(path.high)) {
                return 0;
            }
            // A tick less, for the rounding of the division.
            let ticks = ((to - from) / dt) as u64;
            busy = busy.min(state.tick.saturating_add(ticks.saturating_sub(1)));
        }
        busy
    }

    /// Targets that were told to rise do so when no ball touches their place.
    fn raise_targets(&mut self) {
        if !self.state.targets.contains(&TargetState::Rising) {
            return;
        }
        let scene = Arc::clone(&self.scene);
        let now = Instant::start_of(self.state.tick);
        for index in 0..self.state.targets.len() {
            if self.state.targets[index] != TargetState::Rising {
                continue;
            }
            let presence = Presence::TargetUp(index as u16);
            let blocked = self.state.balls.iter().any(|ball| {
                let (position, _) = ball.at(now, scene.tick_seconds);
                let place = scene.colliders.iter().filter(|collider| collider.presence == presence);
                place
                    .into_iter()
                    .any(|collider| collider.shape.distance(position) <= scene.ball_radius * CLEAR_OF_TARGET)
            });
            if !blocked {
                self.state.targets[index] = TargetState::Up;
                self.forget_nexts(now);
            }
        }
    }

    /// No ball should leave the table; one that does must not fly on for ever.
    fn take_out_escaped(&mut self) {
        let now = Instant::start_of(self.state.tick);
        for index in (0..self.state.balls.len()).rev() {
            let ball = self.state.balls[index];
            let (position, _) = ball.at(now, self.scene.tick_seconds);
            if !self.scene.is_inside(position) {
                self.events.push(Event { at: now, ball: ball.id, position, kind: EventKind::Escaped });
                self.state.balls.remove(index);
                self.next.remove(index);
            }
        }
    }

    /// The static shapes changed at `now`: what balls meet next has to be found anew, but nothing that is past.
    pub(super) fn forget_nexts(&mut self, now: Instant) {
        for (ball, next) in self.state.balls.iter_mut().zip(&mut self.next) {
            *next = None;
            // What happens at `now` itself is not past: neither what a flight that begins right now touches, nor an
            // impact at the very instant of the change.
            let before = now.since(ball.flight.start, self.scene.tick_seconds).next_down();
            if before >= 0.0 && ball.past.is_none_or(|(past, _)| past < before) {
                ball.past = Some((before, u16::MAX));
            }
        }
    }

    /// The next event of a ball among the static shapes, as an offset within this tick; `None` beyond it.
    pub(super) fn next_static(&mut self, index: usize) -> Option<(f64, Next)> {
        let dt = self.scene.tick_seconds;
        let ball = &self.state.balls[index];
        let elapsed = Instant::start_of(self.state.tick).since(ball.flight.start, dt);
        let end = Instant::start_of(self.state.tick + 1).since(ball.flight.start, dt);
        let known = match self.next[index] {
            Some(Next::ClearUntil(t)) if t < end => None,
            known => known,
        };
        let next = known.unwrap_or_else(|| {
            let state = &self.state;
            let now = ball.past.map_or(0.0, |(t, _)| t);
            let now = if elapsed > now { elapsed } else { now };
            next_event(&self.scene, ball, |collider| state.has(collider), now, end)
        });
        self.next[index] = Some(next);
        if matches!(next, Next::ClearUntil(_)) || next.time() >= end {
            return None;
        }
        let offset = next.time() - elapsed;
        Some((if offset > 0.0 { offset } else { 0.0 }, next))
    }

    pub(super) fn moving_flipper(&self, index: usize) -> Option<MovingFlipper<'_>> {
        let motion = self.flipper_motions[index]?;
        Some(MovingFlipper { spec: &self.scene.flippers[index], motion })
    }

    pub(super) fn moving_plunger(&self, index: usize) -> Option<MovingPlunger<'_>> {
        let motion = self.plunger_motions[index]?;
        let held = self.state.plungers[index].hand.is_some();
        Some(MovingPlunger { spec: &self.scene.plungers[index], motion, held })
    }
}
