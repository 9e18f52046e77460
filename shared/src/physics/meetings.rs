//! Ball against ball: for each ball the earliest meeting with another, kept as long as neither flight changes; and what a
//! meeting does.
//!
//! Which balls meet next is a pure function of their flights, so that a world without this memory finds the same.

use std::sync::Arc;

use glam::DVec2;

use super::ball::{Flight, Instant, Support};
use super::contact::{Body, respond_pair};
use super::happened::EventKind;
use super::motion::{Motion, Pair, Span};
use super::shapes::Bounds;
use super::ways::Ways;
use super::world::World;

/// What is known about the next meeting of a ball.
#[derive(Debug, Clone, Copy, PartialEq)]
enum Known {
    /// Nothing: a flight has changed.
    Nothing,
    /// It meets no other ball: ever, or in models that look ahead by a tick only, in this tick.
    NoMeeting,
    /// With another.
    Meeting { partner: usize, at: Instant },
}

impl Known {
    /// Whether a meeting with `partner` at `at` comes before this one. Equal moments are decided by place, so that it does
    /// not matter in which order they were found.
    fn is_after(self, at: Instant, partner: usize) -> bool {
        match self {
            Self::Nothing => false,
            Self::NoMeeting => true,
            Self::Meeting { partner: known, at: then } => {
                (at.tick, at.offset, partner) < (then.tick, then.offset, known)
            }
        }
    }
}

/// The meetings of all balls.
#[derive(Debug, Clone, Default)]
pub(super) struct Meetings {
    known: Vec<Known>,
    /// In models that look no farther than a tick.
    ways: Ways,
    /// Balls with a new flight, whose ways are not in there yet.
    outdated: Vec<usize>,
    /// Of one ball: whose ways come near its own.
    near: Vec<usize>,
}

impl Meetings {
    pub(super) fn with_capacity(balls: usize) -> Self {
        Self {
            known: Vec::with_capacity(balls),
            ways: Ways::with_capacity(balls),
            outdated: Vec::with_capacity(balls),
            // Each ball in reach, and each that has moved.
            near: Vec::with_capacity(2 * balls),
        }
    }

    /// Balls came or went, or a new tick began: nothing is known.
    pub(super) fn forget(&mut self, balls: usize) {
        self.known.clear();
        self.known.resize(balls, Known::Nothing);
        self.ways.forget();
        self.outdated.clear();
    }

    /// A ball has a new flight.
    pub(super) fn flight_changed(&mut self, ball: usize) {
        for (place, known) in self.known.iter_mut().enumerate() {
            let with = matches!(*known, Known::Meeting { partner, .. } if partner == ball);
            if place == ball || with {
                *known = Known::Nothing;
            }
        }
        if self.ways.is_known() && !self.outdated.contains(&ball) {
            self.outdated.push(ball);
        }
    }
}

impl World {
    /// A model that looks ahead by a tick only begins a new one.
    pub(super) fn forget_meetings_of_last_tick(&mut self) {
        if self.scene.motion != Motion::Exact {
            self.meetings.forget(self.state.balls.len());
        }
    }

    /// The first meeting of two balls within the offsets `clock..limit` of this tick; ties go to the lowest places.
    pub(super) fn next_meeting(&mut self, clock: f64, limit: f64) -> Option<(f64, usize, usize)> {
        let mut limit = limit;
        let mut first = None;
        for ball in 0..self.state.balls.len() {
            self.look_for_meeting(ball);
            if let Known::Meeting { partner, at } = self.meetings.known[ball]
                && at.tick <= self.state.tick
            {
                let offset = if at.tick == self.state.tick && at.offset > clock { at.offset } else { clock };
                if offset < limit {
                    limit = offset;
                    first = Some((offset, ball.min(partner), ball.max(partner)));
                }
            }
        }
        first
    }

    /// Two balls meet.
    pub(super) fn meet_balls(&mut self, one: usize, other: usize, offset: f64) {
        let scene = Arc::clone(&self.scene);
        let mut places = [one, other].map(|ball| self.ball_at(ball, offset).0);
        let velocities = [one, other].map(|ball| self.ball_at(ball, offset).1);
        let stalled = [one, other].map(|ball| self.state.balls[ball].support == Support::Stalled);
        for (ball, stalled) in [one, other].into_iter().zip(stalled) {
            self.impacts[ball] += u32::from(!stalled);
        }
        // A ball that is worn out can still be pushed by one that is not; so each push wears out one of them.
        if [one, other].into_iter().all(|ball| self.impacts[ball] > self.most_impacts) {
            for (ball, place) in [one, other].into_iter().zip(places) {
                self.stall(ball, offset, place);
            }
            return;
        }
        let apart = places[0] - places[1];
        let normal = apart.try_normalize().unwrap_or(DVec2::Y);
        let overlap = self.radius(one) + self.radius(other) - apart.length();
        // Models that notice an overlap only put the balls back where they touch.
        if scene.motion.looks_now_and_then() && overlap > 0.0 {
            places = [places[0] + normal * (0.5 * overlap), places[1] - normal * (0.5 * overlap)];
        }
        let mut material = scene.ball_material;
        if self.is_hammered(one) || self.is_hammered(other) {
            material.restitution = 0.0;
        }
        for (ball, (place, velocity)) in [one, other].into_iter().zip(places.into_iter().zip(velocities)) {
            self.refresh_spin(ball, offset, place, velocity);
        }
        let body = |ball: usize, velocity: DVec2| Body {
            velocity,
            spin: self.state.balls[ball].spin,
            radius: self.radius(ball),
            // One that waits for the next tick does not give way.
            mass: if self.state.balls[ball].support == Support::Stalled { f64::INFINITY } else { self.mass(ball) },
        };
        let speed = -(velocities[0] - velocities[1]).dot(normal);
        let pulls = [one, other].map(|ball| self.state.balls[ball].flight.acceleration);
        let pull = -(pulls[0] - pulls[1]).dot(normal);
        // One that lies on the other would meet it for ever: it hops instead, by an eighth of pull times tick squared.
        let hop = pull * scene.tick_seconds;
        let returned = material.restitution_at(if speed > 0.0 { speed } else { 0.0 }) * speed;
        let rests = pull > 0.0 && (speed <= scene.rest_speed || returned <= 0.5 * hop);
        let hop = rests.then_some(0.5 * hop);
        let after = respond_pair(&body(one, velocities[0]), &body(other, velocities[1]), normal, &material, hop);
        let ids = [one, other].map(|ball| self.state.balls[ball].id);
        for (place, (ball, (velocity, spin))) in [one, other].into_iter().zip(after).enumerate() {
            if !stalled[place] {
                self.state.balls[ball].spin = spin;
                let before = match self.state.balls[ball].support {
                    Support::Line(i) | Support::Arc(i) => Some(i),
                    _ => None,
                };
                self.start_flight(ball, offset, places[place], velocity, None, before);
            }
            if speed > scene.rest_speed && !rests {
                let velocity = self.state.balls[ball].flight.velocity;
                self.emit(ball, offset, places[place], velocity, EventKind::Met { other: ids[1 - place], speed });
            }
        }
    }

    /// The first tick in which two balls may meet.
    pub(super) fn next_meeting_tick(&mut self) -> u64 {
        let mut busy = u64::MAX;
        for ball in 0..self.state.balls.len() {
            self.look_for_meeting(ball);
            if let Known::Meeting { at, .. } = self.meetings.known[ball] {
                busy = busy.min(at.tick);
            }
        }
        busy
    }

    /// Makes known whom a ball meets next.
    fn look_for_meeting(&mut self, ball: usize) {
        if self.meetings.known[ball] != Known::Nothing {
            return;
        }
        self.meetings.known[ball] = Known::NoMeeting;
        let balls = self.state.balls.len();
        if self.scene.motion == Motion::Exact {
            for other in (0..balls).filter(|&other| other != ball) {
                self.look_at_pair(ball, other);
            }
            return;
        }
        if self.meetings.ways.is_known() {
            while let Some(other) = self.meetings.outdated.pop() {
                let way = self.way_in_tick(other);
                self.meetings.ways.change(other, way);
            }
        } else {
            let mut ways = core::mem::take(&mut self.meetings.ways);
            ways.learn((0..balls).map(|ball| self.way_in_tick(ball)));
            self.meetings.ways = ways;
        }
        let mut near = core::mem::take(&mut self.meetings.near);
        near.clear();
        self.meetings.ways.near(ball, |other| near.push(other));
        for &other in &near {
            self.look_at_pair(ball, other);
        }
        self.meetings.near = near;
    }

    /// Makes known to both when two balls meet, if it is sooner than what they know.
    fn look_at_pair(&mut self, ball: usize, other: usize) {
        let Some(at) = self.meeting_of(ball.min(other), ball.max(other)) else { return };
        for (one, partner) in [(ball, other), (other, ball)] {
            if self.meetings.known[one].is_after(at, partner) {
                self.meetings.known[one] = Known::Meeting { partner, at };
            }
        }
    }

    /// The box around a ball on its way through this tick.
    fn way_in_tick(&self, ball: usize) -> Bounds {
        let (dt, tick) = (self.scene.tick_seconds, self.state.tick);
        let subject = &self.state.balls[ball];
        let from = Instant::start_of(tick).since(subject.flight.start, dt);
        let to = Instant::start_of(tick + 1).since(subject.flight.start, dt);
        let around = Bounds::of_flight(&subject.flight, if from > 0.0 { from } else { 0.0 }, to);
        around.grown(self.radius(ball))
    }

    /// When two balls meet: ever, or in this tick in models that look no farther.
    fn meeting_of(&self, one: usize, other: usize) -> Option<Instant> {
        let (scene, dt) = (&self.scene, self.scene.tick_seconds);
        let balls = [&self.state.balls[one], &self.state.balls[other]];
        // A ball in a saucer lies below the others.
        if balls[0].floor != balls[1].floor || balls.iter().any(|ball| ball.saucer().is_some()) {
            return None;
        }
        let later = |a: Instant, b: Instant| if (a.tick, a.offset) > (b.tick, b.offset) { a } else { b };
        let mut since = later(balls[0].flight.start, balls[1].flight.start);
        if scene.motion != Motion::Exact {
            since = later(since, Instant::start_of(self.state.tick));
        }
        let from = |flight: &Flight| {
            let t = since.since(flight.start, dt);
            Flight { start: since, position: flight.position_at(t), velocity: flight.velocity_at(t), ..*flight }
        };
        let flights = [from(&balls[0].flight), from(&balls[1].flight)];
        let end = Instant::start_of(self.state.tick + 1).since(since, dt);
        let pair = Pair {
            scene,
            flights: [&flights[0], &flights[1]],
            radii: [scene.radius(balls[0].kind), scene.radius(balls[1].kind)],
            tick: Span { from: 0.0, to: end },
        };
        let time = scene.motion.model().next_meeting(&pair)?;
        if scene.motion.looks_now_and_then() {
            // The end of this tick is in this tick.
            let offset = since.offset + time;
            return Some(Instant { tick: since.tick, offset: if offset < dt { offset } else { dt } });
        }
        Some(since.later_by(time, dt))
    }
}
