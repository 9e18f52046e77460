//! Plates on hinges: spinners, which turn through, and gates, which swing open and fall shut.
//!
//! A plate hangs over a line, from an axle above the ball. It gives way by about the ball's radius before it stops or lets
//! through, so that what counts is the moment at which the ball's *centre* reaches the line. That moment all motion models know
//! to rounding, and no ball is ever half through. At it, in the direction across the line:
//!
//! 1. ball and plate hit each other without a bounce: a plate of inertia I, pushed at a lever l, is as heavy as I / l^2 there;
//! 2. the ball goes through if their kinetic energy, and what gravity does for the ball on a way of the lever's length, is more
//!    than the work that lifts the plate; both are slowed down together by that work;
//! 3. otherwise the plate falls back, and throws the ball back by the plate's restitution. A ball that a spinner's plate meets
//!    with more momentum than its own is carried back by it.
//!
//! A spinner is always taken to hang in the way, however it is turned: its plate comes round while a ball is under it. Between
//! pushes it is a closed form like a flight: an angle, a speed, dry friction. A gate's plate is shut again once the ball is past;
//! its state says only how it was pushed last, for whoever draws it.

use core::f64::consts::PI;

use glam::DVec2;
use serde::{Deserialize, Serialize};

use super::ball::{Instant, Support};
use super::constants::{DEEPEST_OVERLAP, MOST_HINGE_SPEED};
use super::happened::{Event, EventKind, NO_BALL};
use super::numbers::Numbers;
use super::shapes::{Segment, Shape};
use super::world::World;

/// What is fixed about a plate.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct HingeSpec {
    /// The table's element.
    pub element: u16,
    /// Middle of its line, m.
    pub middle: DVec2,
    /// From the hinge down to where a ball pushes it, m.
    pub lever: f64,
    /// About the hinge, kg m^2.
    pub inertia: f64,
    /// Of a spinner: how fast it loses its spin, rad/s^2. A gate has none: it falls shut.
    pub friction: Option<f64>,
    /// Share of its normal speed at which a ball is thrown back.
    pub restitution: f64,
    /// Work that lifts the plate out of the way, J.
    pub lift: f64,
}

impl HingeSpec {
    /// The mass that the plate opposes to a push at its lever, kg: inertia / lever^2.
    pub fn mass(&self) -> f64 {
        self.inertia / (self.lever * self.lever)
    }
}

/// What changes about a plate: how it turned when that last changed. Angles grow towards where the line's normal points.
#[derive(Debug, Clone, Copy, PartialEq, Serialize, Deserialize)]
#[serde(from = "HingeForm", into = "HingeForm")]
pub struct HingeState {
    /// When it was pushed or had turned half round.
    pub start: Instant,
    /// Then, from hanging or from the last half turn, rad: from -pi to pi.
    pub angle: f64,
    /// Then, rad/s.
    pub speed: f64,
}

/// As it is written.
#[derive(Serialize, Deserialize)]
struct HingeForm(u64, Numbers<3>);

impl From<HingeState> for HingeForm {
    fn from(HingeState { start, angle, speed }: HingeState) -> Self {
        Self(start.tick, Numbers([angle, start.offset, speed]))
    }
}

impl From<HingeForm> for HingeState {
    fn from(HingeForm(tick, Numbers([angle, offset, speed])): HingeForm) -> Self {
        Self { start: Instant { tick, offset }, angle, speed }
    }
}

impl Default for HingeState {
    fn default() -> Self {
        Self { start: Instant::start_of(0), angle: 0.0, speed: 0.0 }
    }
}

impl HingeState {
    /// Angle, rad, and speed, rad/s, of a spinner with that friction `t` seconds after its start. When its spin has ended it
    /// hangs again.
    pub fn at(&self, t: f64, friction: f64) -> (f64, f64) {
        let left = self.speed.abs() - friction * t;
        if left <= 0.0 {
            return (0.0, 0.0);
        }
        let speed = left.copysign(self.speed);
        (self.angle + 0.5 * (self.speed + speed) * t, speed)
    }

    /// Seconds after its start at which a spinner has turned half round, and its speed then, rad/s; `None`: it does not get
    /// there.
    pub fn half_turn(&self, friction: f64) -> Option<(f64, f64)> {
        let way = if self.speed < 0.0 { PI + self.angle } else { PI - self.angle };
        let square = self.speed * self.speed - 2.0 * friction * way;
        if self.speed == 0.0 || square <= 0.0 {
            return None;
        }
        // The first root of way = speed t - friction t^2 / 2, without the difference of what is nearly the same.
        let after = square.sqrt();
        Some((2.0 * way / (self.speed.abs() + after), after.copysign(self.speed)))
    }

    /// Whether a world may have it: see [`super::state::WorldState::check`].
    pub(super) fn is_possible(&self, spec: &HingeSpec, tick: u64, dt: f64) -> bool {
        let starts = self.start.tick <= tick && self.start.offset >= 0.0 && self.start.offset <= dt;
        let turns = (-PI..=PI).contains(&self.angle) && self.speed.abs() <= MOST_HINGE_SPEED;
        // No half turn is left behind: each of them happens in its tick, or by a rounding in the next.
        starts && turns && self.next_half_turn(spec, dt).is_none_or(|(at, _)| at.tick.saturating_add(1) >= tick)
    }

    /// The moment of the next half turn, and the speed then.
    fn next_half_turn(&self, spec: &HingeSpec, dt: f64) -> Option<(Instant, f64)> {
        let (t, speed) = self.half_turn(spec.friction?)?;
        let at = self.start.later_by(t, dt);
        // What rounding puts at a tick's end is the next one's start.
        Some((if at.offset < dt { at } else { Instant::start_of(at.tick.saturating_add(1)) }, speed))
    }
}

/// A ball at a plate: all along the ball's way across the line.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct Push {
    /// kg.
    pub ball_mass: f64,
    /// m/s, not negative.
    pub ball_speed: f64,
    /// See [`HingeSpec::mass`].
    pub plate_mass: f64,
    /// Of the plate at its lever, m/s.
    pub plate_speed: f64,
    /// What gravity does for the ball on a way of the lever's length, J.
    pub work: f64,
    /// See [`HingeSpec::lift`].
    pub lift: f64,
    /// See [`HingeSpec::restitution`].
    pub restitution: f64,
}

/// What became of it.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct Pushed {
    /// Whether the ball goes through.
    pub passes: bool,
    /// m/s; negative: it goes back.
    pub ball_speed: f64,
    /// Of the plate at its lever, m/s.
    pub plate_speed: f64,
}

impl Push {
    /// The rules of this module's head, 1 to 3.
    pub fn outcome(&self) -> Pushed {
        let both = self.ball_mass + self.plate_mass;
        let common = (self.ball_mass * self.ball_speed + self.plate_mass * self.plate_speed) / both;
        if common < 0.0 {
            return Pushed { passes: false, ball_speed: common, plate_speed: common };
        }
        if 0.5 * both * common * common + self.work > self.lift {
            let square = common * common - 2.0 * self.lift / both;
            // A ball that only gravity gets through begins at rest.
            let left = if square > 0.0 { square.sqrt() } else { 0.0 };
            return Pushed { passes: true, ball_speed: left, plate_speed: left };
        }
        Pushed { passes: false, ball_speed: -self.restitution * self.ball_speed, plate_speed: 0.0 }
    }
}

/// Where and when a ball's centre reaches a plate's line.
#[derive(Debug, Clone, Copy)]
pub(super) struct At {
    pub(super) collider: u16,
    /// Within the tick, s.
    pub(super) offset: f64,
    /// Since the start of the flight, s.
    pub(super) time: f64,
    /// Of the centre, as the motion model sees it: on the line, m.
    pub(super) position: DVec2,
}

impl World {
    /// A ball's centre reaches a plate's line.
    pub(super) fn meet_hinge(&mut self, ball: usize, index: u16, at: At) {
        let At { collider, offset, time, position } = at;
        let flight = self.state.balls[ball].flight;
        let velocity = flight.velocity_at(time);
        self.impacts[ball] += 1;
        if self.impacts[ball] > self.most_impacts {
            self.stall(ball, offset, position);
            return;
        }
        let Shape::Segment(segment) = self.scene.colliders[usize::from(collider)].shape else { return };
        let across = velocity.dot(segment.normal);
        let pull = flight.acceleration.dot(segment.normal);
        let sign = if across > 0.0 || (across == 0.0 && pull > 0.0) { 1.0 } else { -1.0 };
        if segment.one_way && sign > 0.0 {
            self.meet_closed_side(ball, index, at, &segment);
            return;
        }
        let spec = self.scene.hinges[usize::from(index)];
        let now = Instant { tick: self.state.tick, offset };
        let plate = self.state.hinges[usize::from(index)];
        let since = now.since(plate.start, self.scene.tick_seconds);
        let (angle, speed) = spec.friction.map_or((0.0, 0.0), |friction| plate.at(since, friction));
        let (mass, ahead) = (self.mass(ball), segment.normal * sign);
        let push = Push {
            ball_mass: mass,
            ball_speed: across.abs(),
            plate_mass: spec.mass(),
            plate_speed: sign * speed * spec.lever,
            work: mass * self.scene.gravity_on(self.state.balls[ball].floor).dot(ahead) * spec.lever,
            lift: spec.lift,
            restitution: spec.restitution,
        };
        let pushed = push.outcome();
        let speed = (sign * pushed.plate_speed / spec.lever).clamp(-MOST_HINGE_SPEED, MOST_HINGE_SPEED);
        // Right before a half turn the angle may be one by a rounding.
        let angle = if speed == 0.0 { 0.0 } else { angle.clamp(-PI, PI) };
        self.state.hinges[usize::from(index)] = HingeState { start: now, angle, speed };
        let after = velocity + ahead * (pushed.ball_speed - push.ball_speed);
        let place = if pushed.passes { position } else { beside(&segment, position, -sign) };
        self.leave_hinge(ball, offset, place, velocity, after);
        let kind = if pushed.passes {
            EventKind::Passed { element: spec.element }
        } else {
            EventKind::Touched { element: spec.element, speed: push.ball_speed - push.plate_speed }
        };
        if pushed.passes || push.ball_speed - push.plate_speed > self.scene.rest_speed {
            let velocity = self.state.balls[ball].flight.velocity;
            self.emit(ball, offset, place, velocity, kind);
        }
    }

    /// A ball's centre reaches the line of a one-way gate from its closed side. There a wall stops its rim; so either it has
    /// not been past by half a radius and falls back under the plate that still lies on it, or a model that looks now and then
    /// did not see the wall.
    fn meet_closed_side(&mut self, ball: usize, index: u16, at: At, segment: &Segment) {
        let At { collider, offset, time, position } = at;
        let flight = self.state.balls[ball].flight;
        let radius = self.radius(ball);
        if segment.height(flight.position) >= -DEEPEST_OVERLAP * radius {
            self.state.balls[ball].past = Some((time, collider));
            self.next[ball] = None;
            return;
        }
        let spec = self.scene.hinges[usize::from(index)];
        let velocity = flight.velocity_at(time);
        let speed = velocity.dot(segment.normal);
        let place = position - segment.normal * radius;
        self.leave_hinge(ball, offset, place, velocity, velocity - segment.normal * ((1.0 + spec.restitution) * speed));
        let velocity = self.state.balls[ball].flight.velocity;
        self.emit(ball, offset, place, velocity, EventKind::Touched { element: spec.element, speed });
    }

    /// The ball goes on, along what it lay on if it still does.
    fn leave_hinge(&mut self, ball: usize, offset: f64, place: DVec2, before: DVec2, after: DVec2) {
        self.refresh_spin(ball, offset, place, before);
        let support = match self.state.balls[ball].support {
            Support::Line(i) | Support::Arc(i) => Some(i),
            _ => None,
        };
        self.start_flight(ball, offset, place, after, None, support);
    }

    /// The first spinner that has turned half round within the offsets `clock..limit` of this tick.
    pub(super) fn next_half_turn(&self, clock: f64, limit: f64) -> Option<(f64, usize)> {
        let mut limit = limit;
        let mut first = None;
        for (index, (state, spec)) in self.state.hinges.iter().zip(&self.scene.hinges).enumerate() {
            if let Some((at, _)) = state.next_half_turn(spec, self.scene.tick_seconds)
                && at.tick <= self.state.tick
            {
                let offset = if at.tick == self.state.tick && at.offset > clock { at.offset } else { clock };
                if offset < limit {
                    limit = offset;
                    first = Some((offset, index));
                }
            }
        }
        first
    }

    /// A spinner has turned half round.
    pub(super) fn turn_half(&mut self, index: usize, offset: f64) {
        let spec = self.scene.hinges[index];
        let Some((start, speed)) = self.state.hinges[index].next_half_turn(&spec, self.scene.tick_seconds) else {
            return;
        };
        self.state.hinges[index] = HingeState { start, angle: 0.0, speed };
        let at = Instant { tick: self.state.tick, offset };
        let kind = EventKind::Spun { element: spec.element };
        self.events.push(Event { at, ball: NO_BALL, position: spec.middle, velocity: DVec2::ZERO, kind });
    }

    /// The first tick in which a spinner may have turned half round.
    pub(super) fn next_half_turn_tick(&self) -> u64 {
        let ticks = self.state.hinges.iter().zip(&self.scene.hinges).map(|(state, spec)| {
            let next = state.next_half_turn(spec, self.scene.tick_seconds);
            next.map_or(u64::MAX, |(at, _)| at.tick)
        });
        ticks.fold(u64::MAX, u64::min)
    }
}

/// The place on a line, by half of what counts as touching it on that side: a ball that is thrown back is on its own side for
/// the models that ask where it was, too.
fn beside(segment: &Segment, position: DVec2, side: f64) -> DVec2 {
    let wanted = side * 0.5 * super::constants::TOUCH * position.abs().max_element();
    position + segment.normal * (wanted - segment.height(position))
}
