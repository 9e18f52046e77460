//! The world: balls, flippers, plungers and targets, stepped one tick at a time.
//!
//! [`World::step`] is the main flow. Within a tick, everything that happens is processed in order of time; ties go to
//! the ball with the lowest place, then to static shapes before moving ones, then to the lowest index.

use std::sync::Arc;

use glam::DVec2;

use super::ball::{Ball, Flight, Instant, Support};
use super::constants::{
    CLEAR_OF_TARGET, LONGEST_FLIGHT, MOST_IMPACTS_PER_SECOND, MOST_IMPACTS_PER_TICK, MOST_SEARCHES_PER_TICK, MOST_SPEED,
};
use super::flipper::{FlipperMotion, FlipperRest, FlipperState};
use super::happened::{Event, EventKind};
use super::meetings::Meetings;
use super::motion::{Motion, Next, Query, Scratch, Span};
use super::movers::{MovingFlipper, MovingPlunger};
use super::plunger::PlungerMotion;
use super::scene::{Collider, Presence, Scene};
use super::shapes::Bounds;
use super::state::{MOST_BALLS, StateError, TargetState, WorldState};

/// Room for what happens in one tick: that many events, and that many for each ball of the start. A tick in which more happens
/// allocates, once.
const LEAST_EVENTS: usize = 256;
/// See [`LEAST_EVENTS`].
const EVENTS_PER_BALL: usize = 16;

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
    /// How many of them are worth following.
    pub(super) most_impacts: u32,
    /// For each ball, its next meeting with another. Can be recomputed to the same bits.
    pub(super) meetings: Meetings,
    scratch: Scratch,
    /// Acceleration of the table in the last tick, m/s^2.
    pub(super) before: DVec2,
    /// Before this tick nothing happens, unless somebody does something. Can be recomputed.
    pub(super) busy_from: u64,
    /// The same, or 0 while there is something to tell of the last tick: before it a step only counts.
    pub(super) quiet_until: u64,
    /// Meanwhile a flipper is held: its coil's time goes on.
    holds: bool,
    /// Meanwhile a flipper or a plunger is on its way, with no ball near it.
    moves: bool,
}

impl World {
    /// A world with the scene's balls at their start.
    pub fn new(scene: Arc<Scene>) -> Self {
        let per_tick = MOST_IMPACTS_PER_SECOND * scene.tick_seconds;
        let mut world = Self {
            next: Vec::with_capacity(MOST_BALLS),
            events: Vec::with_capacity(LEAST_EVENTS.max(EVENTS_PER_BALL * scene.start.len())),
            flipper_motions: vec![None; scene.flippers.len()],
            plunger_motions: vec![None; scene.plungers.len()],
            impacts: Vec::with_capacity(MOST_BALLS),
            // A cast saturates.
            most_impacts: (per_tick as u32).max(MOST_IMPACTS_PER_TICK),
            meetings: Meetings::with_capacity(MOST_BALLS),
            scratch: Scratch::new(scene.colliders.len()),
            before: DVec2::ZERO,
            busy_from: 0,
            quiet_until: 0,
            holds: false,
            moves: false,
            state: WorldState::new(&scene),
            scene,
        };
        for place in 0..world.scene.start.len() {
            let ball = world.scene.start[place];
            world.launch(ball.kind, ball.position, ball.velocity);
        }
        world
    }

    /// Advances the world by one tick and returns what happened in it.
    #[inline]
    pub fn step(&mut self) -> &[Event] {
        // Flights were solved when they began: until the next event, time just passes.
        if self.state.tick < self.quiet_until && self.passes_quietly() {
            return &[];
        }
        self.step_busy();
        &self.events
    }

    /// A tick in which nothing happens to any ball; `false`, and nothing has changed, if what moves comes to a stop in it.
    #[inline]
    fn passes_quietly(&mut self) -> bool {
        if self.moves && !self.move_alone() {
            return false;
        }
        self.state.tick += 1;
        if self.holds {
            self.run_coils();
        }
        true
    }

    /// A tick in which something may happen, or the one after.
    #[inline(never)]
    fn step_busy(&mut self) {
        // 0. What happened in the last tick is told.
        self.events.clear();
        if self.state.tick < self.busy_from && self.passes_quietly() {
            self.quiet_until = self.busy_from;
            return;
        }
        let needs = self.scene.needs;
        self.impacts.clear();
        self.impacts.resize(self.state.balls.len(), 0);
        // 1. The table itself, where it was nudged. Flippers and plungers: which of them move in this tick, and how they are driven.
        if needs.nudge {
            self.before = self.state.cabinet.acceleration;
            if !self.state.cabinet.is_still() {
                self.move_cabinet();
            }
        }
        if needs.flippers || needs.plungers {
            self.drive_movers();
        }
        // 2. Balls on a curved or moving surface, or in a field, begin a new piece of flight.
        self.follow_surfaces();
        if needs.magnets {
            self.follow_fields();
        }
        if needs.saucers {
            self.throw_out();
        }
        // 3. Everything that happens, in order of time.
        if needs.ball_ball {
            self.forget_meetings_of_last_tick();
        }
        self.run_events();
        // 4. Flippers and plungers as they are at the tick's end; targets that waited for a ball to clear;
        //    balls that left the table.
        self.settle_movers();
        self.state.tick += 1;
        if needs.targets {
            self.raise_targets();
        }
        self.take_out_escaped();
        self.busy_from = self.next_busy_tick();
        self.quiet_until = if self.events.is_empty() { self.busy_from } else { 0 };
    }

    /// Somebody did something: the next tick may be a busy one.
    pub(super) fn wake(&mut self) {
        (self.quiet_until, self.busy_from) = (0, 0);
    }

    /// Before this tick nothing happens, unless somebody does something; 0 while there is something to tell.
    pub(crate) fn quiet_until(&self) -> u64 {
        self.quiet_until
    }

    /// What happened in the last step.
    pub fn events(&self) -> &[Event] {
        &self.events
    }

    /// How many events a step can report without allocating.
    pub(crate) fn room_for_events(&self) -> usize {
        self.events.capacity()
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
        // Room for the balls that will be served: a step allocates nothing.
        self.state.reserve_balls();
        self.meetings.forget(self.state.balls.len());
        self.scratch.forget();
        self.events.clear();
        self.before = DVec2::ZERO;
        self.wake();
        Ok(())
    }

    /// Puts a ball of the first kind into play, at rest; `None` if there are too many already.
    pub fn serve(&mut self, position: DVec2) -> Option<u32> {
        self.launch(0, position, DVec2::ZERO)
    }

    /// Puts a ball into play on the playfield: its id; `None` if there are too many already, the scene has no such kind, it
    /// would be outside of the scene, or a number is not finite or the speed beyond [`MOST_SPEED`].
    ///
    /// Balls meet each other only in a scene whose needs say so: see [`super::needs::Needs::ball_ball`].
    pub fn launch(&mut self, kind: u8, position: DVec2, velocity: DVec2) -> Option<u32> {
        let is_known = usize::from(kind) < self.scene.kinds.len();
        let is_possible = self.scene.is_inside(position) && velocity.length() <= MOST_SPEED;
        if self.state.balls.len() >= MOST_BALLS || !is_known || !is_possible {
            return None;
        }
        let id = self.state.served;
        self.state.served = id.wrapping_add(1);
        let start = Instant::start_of(self.state.tick);
        let flight = Flight { start, position, velocity, acceleration: self.scene.gravity };
        let ball = Ball { id, kind, floor: 0, flight, spin: 0.0, support: Support::None, slide: None, past: None };
        self.state.balls.push(ball);
        self.next.push(None);
        self.meetings.forget(self.state.balls.len());
        self.wake();
        Some(id)
    }

    /// Takes every ball out of play.
    pub fn clear_balls(&mut self) {
        self.state.balls.clear();
        self.next.clear();
        self.meetings.forget(0);
        self.wake();
    }

    /// Takes one ball out of play.
    pub(super) fn remove(&mut self, ball: usize) {
        self.state.balls.remove(ball);
        self.next.remove(ball);
        self.meetings.forget(self.state.balls.len());
    }

    /// Radius of a ball, m.
    pub(super) fn radius(&self, ball: usize) -> f64 {
        self.scene.radius(self.state.balls[ball].kind)
    }

    /// Mass of a ball, kg.
    pub(super) fn mass(&self, ball: usize) -> f64 {
        self.scene.mass(self.state.balls[ball].kind)
    }

    /// Presses or releases the button of all flippers of one hand.
    pub fn press(&mut self, right: bool, pressed: bool) {
        self.wake();
        for (spec, flipper) in self.scene.flippers.iter().zip(&mut self.state.flippers) {
            if spec.right == right && flipper.pressed != pressed {
                flipper.pressed = pressed;
                flipper.coil_time = 0.0;
            }
        }
    }

    /// Holds every plunger at that share of its stroke, or lets go of it. A share beyond 0 to 1 is cut to it.
    pub fn pull(&mut self, hand: Option<f64>) {
        self.wake();
        for plunger in &mut self.state.plungers {
            plunger.hand = hand.map(|share| if share > 0.0 { share.min(1.0) } else { 0.0 });
        }
    }

    /// Lets a fallen target rise, as soon as no ball is in its way.
    pub fn raise(&mut self, target: u16) {
        let target = &mut self.state.targets[usize::from(target)];
        if *target == TargetState::Down {
            *target = TargetState::Rising;
            self.wake();
        }
    }

    /// Takes a target down that stands or is about to; what lay on it falls.
    pub fn lower(&mut self, target: u16) {
        let state = &mut self.state.targets[usize::from(target)];
        let stood = *state == TargetState::Up;
        if *state != TargetState::Down {
            *state = TargetState::Down;
            self.wake();
        }
        if stood {
            self.target_fell(target, 0.0);
        }
    }

    /// The first tick in which something may happen: a coil, a plunger or a target at work, a ball that follows a
    /// surface tick by tick, or a flight's next event.
    fn next_busy_tick(&mut self) -> u64 {
        if self.scene.motion != Motion::Exact {
            return 0;
        }
        let (state, dt) = (&self.state, self.scene.tick_seconds);
        // A flipper that is held at the end of its stroke lies as still as one at rest.
        let stays = |f: &FlipperState| f.rest == if f.pressed { FlipperRest::Raised } else { FlipperRest::AtRest };
        self.holds = state.flippers.iter().any(|f| f.pressed);
        self.moves = self.any_mover();
        let at_work = !state.flippers.iter().all(|f| f.rest == FlipperRest::Moving || stays(f))
            || state.plungers.iter().any(|p| p.home != p.stays_home())
            || state.targets.contains(&TargetState::Rising)
            || !state.cabinet.is_still()
            || (self.scene.needs.magnets && state.balls.iter().any(|ball| self.is_in_field(ball)));
        if at_work {
            return 0;
        }
        let now = Instant::start_of(state.tick);
        let mut busy = u64::MAX;
        for (ball, next) in state.balls.iter().zip(&self.next) {
            if ball.saucer().is_some() {
                busy = busy.min(self.due_out(ball).unwrap_or(u64::MAX));
                continue;
            }
            let (Support::None | Support::Line(_) | Support::Wedge(..), Some(next)) = (ball.support, next) else {
                return 0;
            };
            let (from, to) = (now.since(ball.flight.start, dt), next.time());
            // The division may be off by a rounding, but the end of a tick is what decides. A cast saturates.
            let mut tick = state.tick.saturating_add((((to - from) / dt) as u64).saturating_sub(1));
            while tick < busy && Instant::start_of(tick + 1).since(ball.flight.start, dt) <= to {
                tick += 1;
            }
            busy = busy.min(tick);
            if self.moves {
                busy = busy.min(self.may_meet_mover_in(ball));
            }
        }
        if self.scene.needs.hinges {
            // A tick less, for the rounding of the division.
            busy = busy.min(self.next_half_turn_tick().saturating_sub(1));
        }
        if self.scene.needs.ball_ball {
            // A tick less, for the rounding of the division.
            busy = busy.min(self.next_meeting_tick().saturating_sub(1));
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
            let in_play = self.state.balls.iter().filter(|ball| ball.saucer().is_none());
            let blocked = in_play.into_iter().any(|ball| {
                let (position, _) = ball.at(now, scene.tick_seconds);
                let is_there = |collider: &&Collider| collider.presence == presence && collider.floor == ball.floor;
                let clear = scene.radius(ball.kind) * CLEAR_OF_TARGET;
                scene.colliders.iter().filter(is_there).any(|collider| collider.shape.distance(position) <= clear)
            });
            if !blocked {
                self.state.targets[index] = TargetState::Up;
                self.forget_nexts(now, None);
            }
        }
    }

    /// No ball should leave the table; one that does must not fly on for ever.
    fn take_out_escaped(&mut self) {
        let now = Instant::start_of(self.state.tick);
        for index in (0..self.state.balls.len()).rev() {
            let ball = &self.state.balls[index];
            // The exact model knows beforehand when a flight leaves the scene.
            let is_flight = matches!(ball.support, Support::None | Support::Line(_) | Support::Wedge(..));
            if is_flight && self.scene.motion == Motion::Exact {
                continue;
            }
            let (position, velocity) = ball.at(now, self.scene.tick_seconds);
            if !self.scene.is_inside(position) {
                self.events.push(Event { at: now, ball: ball.id, position, velocity, kind: EventKind::Escaped });
                self.remove(index);
            }
        }
    }

    /// The static shapes that the centre of a ball within `place` can touch, or any, changed at `now`: what balls meet next
    /// has to be found anew where they come there before, but nothing that is past.
    pub(super) fn forget_nexts(&mut self, now: Instant, place: Option<Bounds>) {
        let scene = &*self.scene;
        self.scratch.forget();
        let place = place.filter(|_| scene.motion == Motion::Exact);
        for (ball, next) in self.state.balls.iter_mut().zip(&mut self.next) {
            // What is near in time may be lost in the rounding of what is past.
            let stays = |next: &Next, place: &Bounds| {
                let (from, to) = (now.since(ball.flight.start, scene.tick_seconds), next.time());
                ball.support == Support::None
                    && to > from + scene.tick_seconds
                    && to < LONGEST_FLIGHT
                    && !Bounds::of_flight(&ball.flight, from, to).meets(place)
            };
            *next = next.filter(|next| place.is_some_and(|place| stays(next, &place)));
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
        let mut from = if elapsed > 0.0 { elapsed } else { 0.0 };
        let next = known.unwrap_or_else(|| {
            let (scene, state, model) = (&*self.scene, &self.state, self.scene.motion.model());
            // A search says how far it came; within the tick it is taken up there.
            for _ in 0..MOST_SEARCHES_PER_TICK {
                let tick = Span { from, to: end };
                match model.next_event(&mut Query { scene, state, ball, tick, scratch: &mut self.scratch }) {
                    Next::ClearUntil(t) if t < end && t > from => from = t,
                    next => return next,
                }
            }
            Next::ClearUntil(from)
        });
        self.next[index] = Some(next);
        let looks_at_the_end = self.scene.motion.looks_now_and_then();
        let is_later = if looks_at_the_end { next.time() > end } else { next.time() >= end };
        if matches!(next, Next::ClearUntil(_)) || is_later {
            return None;
        }
        let offset = next.time() - elapsed;
        let offset = if looks_at_the_end && offset > dt { dt } else { offset };
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
