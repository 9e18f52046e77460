//! What happens within a tick, in order of time: impacts, sensors, ends of support, end stops.

use glam::DVec2;

use super::ball::{Flight, Instant, Support};
use super::constants::{MOST_SPEED, PLASTIC_SHARE};
use super::contact::{Mobility, Moment, Response, Settled, Surface, respond, settle};
use super::happened::{Event, EventKind};
use super::hinge::At;
use super::motion::{Next, Span};
use super::movers::{BallInTick, Moments, Mover, MoverImpact, first_impact, lever};
use super::scene::{Collider, Presence, Role};
use super::state::TargetState;
use super::world::World;
use crate::math::tangent;

/// One thing that happens within a tick.
#[derive(Debug, Clone, Copy)]
enum Happening {
    /// A ball's event among the static shapes.
    Static(usize, Next),
    /// A ball meets a moving flipper.
    Flipper(usize, usize, MoverImpact),
    /// A ball meets a moving plunger.
    Plunger(usize, usize, MoverImpact),
    /// Two balls meet, the one with the lower place first.
    Balls(usize, usize),
    /// A ball begins a new piece of flight along a curve, or on a flipper.
    Turned(usize),
    /// A flipper reaches an end stop, `true`: the upper one.
    FlipperStop(usize, bool),
    /// A plunger that was let go reaches home.
    PlungerHome(usize),
    /// A spinner has turned half round.
    HalfTurn(usize),
}

impl World {
    /// Everything that happens in this tick, in order of time.
    pub(super) fn run_events(&mut self) {
        let mut clock = 0.0;
        while let Some((offset, happening)) = self.earliest(clock) {
            clock = offset;
            match happening {
                Happening::Static(ball, next) => self.meet_static(ball, next, offset),
                Happening::Flipper(ball, flipper, impact) => self.meet_flipper(ball, flipper, impact),
                Happening::Plunger(ball, plunger, impact) => self.meet_plunger(ball, plunger, impact),
                Happening::Balls(one, other) => self.meet_balls(one, other, offset),
                Happening::Turned(ball) => self.begin_next_piece(ball, offset),
                Happening::FlipperStop(flipper, raised) => self.stop_flipper(flipper, raised, offset),
                Happening::PlungerHome(plunger) => self.stop_plunger(plunger, offset),
                Happening::HalfTurn(hinge) => self.turn_half(hinge, offset),
            }
        }
    }

    /// What happens next at or after `clock` in this tick.
    fn earliest(&mut self, clock: f64) -> Option<(f64, Happening)> {
        let end = self.scene.tick_seconds;
        // What happens at a tick's very end is the next tick's, unless a model looks just then whether anything has.
        let mut limit = if self.scene.motion.looks_now_and_then() { end.next_up() } else { end };
        let mut earliest = None;
        for ball in 0..self.state.balls.len() {
            if let Some((offset, next)) = self.next_static(ball)
                && offset < limit
            {
                limit = offset;
                earliest = Some((if offset > clock { offset } else { clock }, Happening::Static(ball, next)));
            }
            if let Some((offset, happening)) = self.next_mover(ball, clock, limit) {
                limit = offset;
                earliest = Some((offset, happening));
            }
            if let Some(offset) = self.next_piece(ball).filter(|&offset| offset < limit) {
                limit = offset;
                earliest = Some((if offset > clock { offset } else { clock }, Happening::Turned(ball)));
            }
        }
        if self.scene.needs.ball_ball
            && let Some((offset, one, other)) = self.next_meeting(clock, limit)
        {
            limit = offset;
            earliest = Some((offset, Happening::Balls(one, other)));
        }
        limit = if limit < end { limit } else { end };
        for index in 0..self.flipper_motions.len() {
            if let Some((offset, raised)) =
                self.moving_flipper(index).and_then(|flipper| flipper.meets_stop(clock, limit))
            {
                limit = offset;
                earliest = Some((offset, Happening::FlipperStop(index, raised)));
            }
        }
        for index in 0..self.plunger_motions.len() {
            if let Some(offset) = self.plunger_comes_home(index, clock, limit) {
                limit = offset;
                earliest = Some((offset, Happening::PlungerHome(index)));
            }
        }
        if self.scene.needs.hinges
            && let Some((offset, index)) = self.next_half_turn(clock, limit)
        {
            earliest = Some((offset, Happening::HalfTurn(index)));
        }
        earliest
    }

    /// The first impact of a ball with a moving flipper or plunger within the offsets `clock..limit`.
    fn next_mover(&self, ball: usize, clock: f64, limit: f64) -> Option<(f64, Happening)> {
        let dt = self.scene.tick_seconds;
        let subject = &self.state.balls[ball];
        // Flippers and plungers stand on the playfield.
        if subject.support == Support::Stalled || subject.saucer().is_some() || subject.floor > 0 {
            return None;
        }
        let elapsed = Instant::start_of(self.state.tick).since(subject.flight.start, dt);
        let radius = self.radius(ball);
        let in_tick = BallInTick { flight: &subject.flight, elapsed, radius };
        let begins = if elapsed < 0.0 { -elapsed } else { 0.0 };
        let span = Span { from: elapsed + begins, to: elapsed + dt };
        let parts = self.scene.motion.model().parts(&self.scene, &subject.flight, span);
        let moments = parts.map(|parts| Moments { first: begins, end: dt, parts });
        let mut limit = limit;
        let mut first = None;
        for index in 0..self.flipper_motions.len() {
            let Some(flipper) = self.moving_flipper(index) else { continue };
            let flight = &subject.flight;
            let travel = (flight.velocity_at(elapsed).length() + flight.acceleration.length() * dt) * dt;
            let distance = (subject.flight.position_at(elapsed) - flipper.spec.pivot).length();
            if subject.support == Support::Flipper(index as u16) || distance > flipper.spec.reach() + radius + travel {
                continue;
            }
            if let Some(impact) = first_impact(&in_tick, &flipper, moments, clock, limit, dt) {
                limit = impact.offset;
                first = Some((limit, Happening::Flipper(ball, index, impact)));
            }
        }
        for index in 0..self.plunger_motions.len() {
            let Some(plunger) = self.moving_plunger(index) else { continue };
            if subject.support == Support::Plunger(index as u16) {
                continue;
            }
            if let Some(impact) = first_impact(&in_tick, &plunger, moments, clock, limit, dt) {
                limit = impact.offset;
                first = Some((limit, Happening::Plunger(ball, index, impact)));
            }
        }
        first
    }

    pub(super) fn plunger_comes_home(&self, index: usize, clock: f64, limit: f64) -> Option<f64> {
        let motion = self.plunger_motions[index]?;
        if self.state.plungers[index].hand.is_some() {
            return None;
        }
        if motion.pull_at(clock) <= 0.0 {
            return (clock < limit).then_some(clock);
        }
        let roots = crate::math::roots::quadratic([motion.pull, motion.speed, 0.5 * motion.acceleration]);
        roots.as_slice().iter().map(|t| motion.from + t).find(|&offset| offset >= clock && offset < limit)
    }

    /// A ball's event among the static shapes.
    fn meet_static(&mut self, ball: usize, next: Next, offset: f64) {
        let t = next.time();
        let flight = self.state.balls[ball].flight;
        let position = match next {
            Next::Meets { position, .. } => position,
            Next::ClearUntil(_) | Next::LeavesSupport(_) | Next::Escapes(_) => flight.position_at(t),
        };
        let velocity = flight.velocity_at(t);
        if matches!(next, Next::Escapes(_)) || !self.scene.is_inside(position) {
            self.take_out(ball, offset, position, EventKind::Escaped);
            return;
        }
        match next {
            Next::ClearUntil(_) | Next::Escapes(_) => {}
            Next::LeavesSupport(_) => {
                let slide = self.state.balls[ball].slide;
                let grips = slide.and_then(|slide| slide.until).is_some_and(|until| until <= t);
                if grips {
                    self.grip(ball, offset, position, velocity);
                } else {
                    self.refresh_spin(ball, offset, position, velocity);
                    self.start_flight(ball, offset, position, velocity, None, None);
                }
            }
            Next::Meets { collider: index, .. } => {
                let Collider { role, element, .. } = self.scene.colliders[usize::from(index)];
                match role {
                    Role::Sensor => {
                        self.state.balls[ball].past = Some((t, index));
                        self.next[ball] = None;
                        self.emit(ball, offset, position, velocity, EventKind::Passed { element });
                    }
                    Role::Field { index: magnet } => self.enter_field(ball, index, magnet, offset, t),
                    Role::Hole { to } => {
                        self.impacts[ball] += 1;
                        if self.impacts[ball] > self.most_impacts {
                            self.stall(ball, offset, position);
                            return;
                        }
                        self.emit(ball, offset, position, velocity, EventKind::Passed { element });
                        self.refresh_spin(ball, offset, position, velocity);
                        self.state.balls[ball].floor = to;
                        self.start_flight(ball, offset, position, velocity, None, None);
                    }
                    Role::Drain => self.take_out(ball, offset, position, EventKind::Drained),
                    Role::Hinge { index: hinge } => {
                        self.meet_hinge(ball, hinge, At { collider: index, offset, time: t, position });
                    }
                    Role::Saucer { index: saucer } => self.meet_saucer(ball, index, saucer, offset, t),
                    Role::Solid | Role::Kicker { .. } | Role::Target { .. } | Role::Standing { .. } => {
                        self.bounce(ball, index, offset, position, velocity);
                    }
                }
            }
        }
    }

    /// An impact with a static shape.
    fn bounce(&mut self, ball: usize, index: u16, offset: f64, position: DVec2, velocity: DVec2) {
        self.impacts[ball] += 1;
        if self.impacts[ball] > self.most_impacts {
            self.stall(ball, offset, position);
            return;
        }
        let Collider { ref shape, role, element, mut material, presence, .. } =
            self.scene.colliders[usize::from(index)];
        if self.is_hammered(ball) && self.scene.needs.flippers {
            // Between a flipper and a wall: it is pressed, not hammered.
            material.restitution = 0.0;
        }
        let (normal, rest_speed) = (shape.normal_at(position), self.scene.rest_speed);
        let speed = -velocity.dot(normal);
        let mut kick = 0.0;
        let mut kind = EventKind::Touched { element, speed };
        match role {
            Role::Kicker { speed: added, threshold } if speed >= threshold => {
                kick = added;
                kind = EventKind::Kicked { element, speed };
            }
            Role::Target { threshold, .. } if speed >= threshold => kind = EventKind::Felled { element, speed },
            Role::Standing { threshold } if speed >= threshold => kind = EventKind::Struck { element, speed },
            _ => {}
        }
        self.refresh_spin(ball, offset, position, velocity);
        let surface = Surface { normal, velocity: DVec2::ZERO, material, mobility: Mobility::default(), kick };
        let (radius, mass, spin) = (self.radius(ball), self.mass(ball), self.state.balls[ball].spin);
        if let Some(gives_way) = self.gives_way(presence, position, normal, radius) {
            let after = respond(velocity, spin, radius, mass, &gives_way.surface(surface));
            if let Some(flipper_speed) = gives_way.speed_after(&after) {
                self.state.balls[ball].spin = after.spin;
                self.start_flight(ball, offset, position, after.velocity, None, None);
                self.leave_stop(gives_way.flipper, offset, flipper_speed);
                let support = Support::Flipper(gives_way.flipper as u16);
                self.leave_mover(ball, offset, position, after.velocity, normal, support);
                self.shake_carried(gives_way.flipper, ball, offset);
                self.tell_touch(ball, offset, position, element, speed);
                return;
            }
        }
        let after = respond(velocity, spin, radius, mass, &surface);
        self.state.balls[ball].spin = after.spin;
        let before = match self.state.balls[ball].support {
            Support::Line(i) | Support::Arc(i) => Some(i),
            _ => None,
        };
        self.start_flight(ball, offset, position, after.velocity, Some(index), before);
        // Contact at rest is no news, but whatever acts always is.
        if speed > rest_speed || !matches!(kind, EventKind::Touched { .. }) {
            let velocity = self.state.balls[ball].flight.velocity;
            self.emit(ball, offset, position, velocity, kind);
        }
        if let (Role::Target { index: target, .. }, EventKind::Felled { .. }) = (role, kind) {
            self.state.targets[usize::from(target)] = TargetState::Down;
            self.target_fell(target, offset);
        }
    }

    /// A target is gone, and with it what balls lay on.
    pub(super) fn target_fell(&mut self, target: u16, offset: f64) {
        self.forget_nexts(Instant { tick: self.state.tick, offset }, None);
        let gone = Presence::TargetUp(target);
        for ball in 0..self.state.balls.len() {
            let is_gone = |i: u16| self.scene.colliders[usize::from(i)].presence == gone;
            let falls = match self.state.balls[ball].support {
                Support::Line(i) | Support::Arc(i) => is_gone(i),
                Support::Wedge(i, j) => is_gone(i) || is_gone(j),
                _ => false,
            };
            if falls {
                let (position, velocity) = self.ball_at(ball, offset);
                self.refresh_spin(ball, offset, position, velocity);
                self.start_flight(ball, offset, position, velocity, None, None);
            }
        }
    }

    /// Too many impacts within one tick: the ball waits for the next one.
    pub(super) fn stall(&mut self, ball: usize, offset: f64, position: DVec2) {
        let (_, velocity) = self.ball_at(ball, offset);
        let speed = velocity.length();
        self.refresh_spin(ball, offset, position, velocity);
        if speed > self.scene.rest_speed {
            self.emit(ball, offset, position, DVec2::ZERO, EventKind::Stalled { speed });
        }
        let start = Instant { tick: self.state.tick, offset };
        let ball_state = &mut self.state.balls[ball];
        ball_state.flight = Flight { start, position, velocity: DVec2::ZERO, acceleration: DVec2::ZERO };
        (ball_state.support, ball_state.slide) = (Support::Stalled, None);
        ball_state.past = Some((0.0, u16::MAX));
        self.flight_changed(ball);
        self.next[ball] = Some(Next::ClearUntil(f64::INFINITY));
        if self.state.balls[ball].floor == 0 {
            self.hold_flippers_at(position, self.radius(ball), offset);
        }
    }

    fn meet_flipper(&mut self, ball: usize, index: usize, impact: MoverImpact) {
        let Some(flipper) = self.moving_flipper(index) else { return };
        let MoverImpact { offset, normal, position } = impact;
        let (_, velocity) = self.ball_at(ball, offset);
        if self.impacts[ball] >= self.most_impacts {
            self.stall(ball, offset, position);
            return;
        }
        let radius = self.radius(ball);
        let surface = flipper.surface(offset, position, normal, radius);
        let levers = [normal, tangent(normal)].map(|push| lever(flipper.spec, position - normal * radius, push));
        let (mut motion, element, inertia) = (flipper.motion, flipper.spec.element, flipper.spec.inertia);
        let speed = (surface.velocity - velocity).dot(normal);
        let after = self.push_by(ball, offset, position, velocity, &surface);
        motion.swing = motion.swing_at(offset);
        motion.speed = motion.speed_at(offset) - (after.impulse * levers[0] + after.drag * levers[1]) / inertia;
        motion.from = offset;
        self.flipper_motions[index] = Some(motion);
        let flipper = &mut self.state.flippers[index];
        (flipper.swing, flipper.speed) = (motion.swing, motion.speed);
        self.leave_mover(ball, offset, position, after.velocity, normal, Support::Flipper(index as u16));
        self.shake_carried(index, ball, offset);
        self.tell_touch(ball, offset, position, element, speed);
    }

    fn meet_plunger(&mut self, ball: usize, index: usize, impact: MoverImpact) {
        let Some(plunger) = self.moving_plunger(index) else { return };
        let MoverImpact { offset, normal, position } = impact;
        let (_, velocity) = self.ball_at(ball, offset);
        if self.impacts[ball] >= self.most_impacts {
            self.stall(ball, offset, position);
            return;
        }
        let surface = plunger.surface(offset, position, normal, self.radius(ball));
        let (mut motion, element, mass, held) = (plunger.motion, plunger.spec.element, plunger.spec.mass, plunger.held);
        let speed = (surface.velocity - velocity).dot(normal);
        let after = self.push_by(ball, offset, position, velocity, &surface);
        motion.pull = motion.pull_at(offset);
        motion.speed = motion.speed_at(offset) + if held { 0.0 } else { after.impulse / mass };
        motion.from = offset;
        self.plunger_motions[index] = Some(motion);
        self.leave_mover(ball, offset, position, after.velocity, normal, Support::Plunger(index as u16));
        self.tell_touch(ball, offset, position, element, speed);
    }

    /// Whether a ball has met so much within this tick that no bounce is left in what it meets.
    pub(super) fn is_hammered(&self, ball: usize) -> bool {
        self.impacts[ball] > self.most_impacts / PLASTIC_SHARE
    }

    /// Tells of an impact with a moving surface, unless it was contact at rest.
    fn tell_touch(&mut self, ball: usize, offset: f64, position: DVec2, element: u16, speed: f64) {
        if speed > self.scene.rest_speed {
            let velocity = self.state.balls[ball].flight.velocity;
            self.emit(ball, offset, position, velocity, EventKind::Touched { element, speed });
        }
    }

    /// The impulse between a ball and a moving surface.
    fn push_by(&mut self, ball: usize, offset: f64, position: DVec2, velocity: DVec2, surface: &Surface) -> Response {
        self.impacts[ball] += 1;
        // Too many impacts within one tick: the rest of them takes all of the bounce.
        let mut surface = *surface;
        if self.is_hammered(ball) {
            surface.material.restitution = 0.0;
        }
        self.refresh_spin(ball, offset, position, velocity);
        let (radius, mass) = (self.radius(ball), self.mass(ball));
        let subject = &mut self.state.balls[ball];
        let after = respond(velocity, subject.spin, radius, mass, &surface);
        subject.spin = after.spin;
        after
    }

    /// After an impact with a moving surface: the ball flies off, or stays on it if it is slow.
    fn leave_mover(
        &mut self,
        ball: usize,
        offset: f64,
        position: DVec2,
        velocity: DVec2,
        normal: DVec2,
        support: Support,
    ) {
        self.start_flight(ball, offset, position, velocity, None, None);
        let contact = position - normal * self.radius(ball);
        let surface_velocity = self.mover_velocity(support, offset, contact);
        let leaving = (velocity - surface_velocity).dot(normal);
        let stuck = self.is_hammered(ball);
        if leaving <= self.scene.rest_speed || stuck {
            self.state.balls[ball].support = support;
            if let Support::Flipper(index) = support {
                self.reload_flipper(usize::from(index), offset);
            }
            self.follow_mover(ball, support, offset, false);
        }
    }

    /// Begins a new flight, along whatever the ball lies on after touching `hit` and lying on `before`.
    pub(super) fn start_flight(
        &mut self,
        ball: usize,
        offset: f64,
        position: DVec2,
        velocity: DVec2,
        hit: Option<u16>,
        before: Option<u16>,
    ) {
        if self.scene.needs.floors {
            self.turn_back_on_edge(ball, offset, position, velocity);
        }
        let is_possible = velocity.length_squared() <= MOST_SPEED * MOST_SPEED;
        let velocity = if is_possible { velocity } else { velocity * (MOST_SPEED / velocity.length()) };
        let left = match hit {
            Some(index) => self.piece_of_arc(index, ball, velocity, offset),
            None => self.scene.tick_seconds - offset,
        };
        let (spin, radius, pull) =
            (self.state.balls[ball].spin, self.radius(ball), self.pull_on(ball, position, velocity, left));
        let ahead = 0.5 * left;
        let settled = if self.scene.needs.contact {
            settle(&self.scene, &Moment { radius, position, velocity, spin, pull, ahead }, hit, before)
        } else {
            Settled { velocity, acceleration: pull, spin, slide: None, support: Support::None }
        };
        let start = Instant { tick: self.state.tick, offset };
        let subject = &mut self.state.balls[ball];
        subject.flight = Flight { start, position, velocity: settled.velocity, acceleration: settled.acceleration };
        subject.spin = settled.spin;
        subject.slide = settled.slide;
        subject.support = settled.support;
        subject.past = None;
        self.flight_changed(ball);
    }

    /// A ball has a new flight: what it would have met is void.
    pub(super) fn flight_changed(&mut self, ball: usize) {
        self.next[ball] = None;
        self.meetings.flight_changed(ball);
    }

    fn take_out(&mut self, ball: usize, offset: f64, position: DVec2, kind: EventKind) {
        let (_, velocity) = self.ball_at(ball, offset);
        self.emit(ball, offset, position, velocity, kind);
        self.remove(ball);
        self.impacts.remove(ball);
    }

    pub(super) fn emit(&mut self, ball: usize, offset: f64, position: DVec2, velocity: DVec2, kind: EventKind) {
        let at = Instant { tick: self.state.tick, offset };
        self.events.push(Event { at, ball: self.state.balls[ball].id, position, velocity, kind });
    }

    /// Centre and velocity of a ball at an offset within this tick.
    pub(super) fn ball_at(&self, ball: usize, offset: f64) -> (DVec2, DVec2) {
        self.state.balls[ball].at(Instant { tick: self.state.tick, offset }, self.scene.tick_seconds)
    }
}
