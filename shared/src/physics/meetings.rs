//! Ball against ball: for each ball the earliest meeting with another, kept as long as neither flight changes.
//!
//! Which balls meet next is a pure function of their flights, so that a world without this memory finds the same.

use super::ball::{Flight, Instant};
use super::motion::{Motion, Pair, Span};
use super::shapes::Bounds;
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
    /// Boxes around the balls' ways in this tick, in models that look no farther.
    boxes: Vec<Option<Bounds>>,
}

impl Meetings {
    pub(super) fn with_capacity(balls: usize) -> Self {
        Self { known: Vec::with_capacity(balls), boxes: Vec::with_capacity(balls) }
    }

    /// Balls came or went, or a new tick began: nothing is known.
    pub(super) fn forget(&mut self, balls: usize) {
        self.known.clear();
        self.known.resize(balls, Known::Nothing);
        self.boxes.clear();
        self.boxes.resize(balls, None);
    }

    /// A ball has a new flight.
    pub(super) fn flight_changed(&mut self, ball: usize) {
        for (place, known) in self.known.iter_mut().enumerate() {
            let with = matches!(*known, Known::Meeting { partner, .. } if partner == ball);
            if place == ball || with {
                *known = Known::Nothing;
            }
        }
        if let Some(around) = self.boxes.get_mut(ball) {
            *around = None;
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
        let mut best = Known::NoMeeting;
        let own_box = self.way_in_tick(ball);
        for other in 0..self.state.balls.len() {
            if other == ball {
                continue;
            }
            if let Some(own) = own_box
                && let Some(others) = self.way_in_tick(other)
                && !own.meets(&others)
            {
                continue;
            }
            let Some(at) = self.meeting_of(ball.min(other), ball.max(other)) else { continue };
            if best.is_after(at, other) {
                best = Known::Meeting { partner: other, at };
            }
            if self.meetings.known[other].is_after(at, ball) {
                self.meetings.known[other] = Known::Meeting { partner: ball, at };
            }
        }
        self.meetings.known[ball] = best;
    }

    /// The box around a ball on its way through this tick, in models that look no farther.
    fn way_in_tick(&mut self, ball: usize) -> Option<Bounds> {
        if self.scene.motion == Motion::Exact {
            return None;
        }
        if self.meetings.boxes[ball].is_none() {
            let (dt, tick) = (self.scene.tick_seconds, self.state.tick);
            let subject = &self.state.balls[ball];
            let from = Instant::start_of(tick).since(subject.flight.start, dt);
            let to = Instant::start_of(tick + 1).since(subject.flight.start, dt);
            let around = Bounds::of_flight(&subject.flight, if from > 0.0 { from } else { 0.0 }, to);
            self.meetings.boxes[ball] = Some(around.grown(self.radius(ball)));
        }
        self.meetings.boxes[ball]
    }

    /// When two balls meet: ever, or in this tick in models that look no farther.
    fn meeting_of(&self, one: usize, other: usize) -> Option<Instant> {
        let (scene, dt) = (&self.scene, self.scene.tick_seconds);
        let balls = [&self.state.balls[one], &self.state.balls[other]];
        if balls[0].floor != balls[1].floor {
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
