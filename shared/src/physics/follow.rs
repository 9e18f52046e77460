//! Balls that follow a curved or a moving surface, tick by tick, and what becomes of them when a moving surface comes
//! to rest or starts.
//!
//! Such a motion is no parabola. For the rest of a tick, or until the flipper that carries it has turned by
//! [`super::constants::PIECE_ANGLE`], it is taken for one, with the surface's curvature and acceleration in it, and is then put back on the
//! surface: an error that falls with the tick's length.

use glam::DVec2;

use super::ball::{Flight, Instant, Slide, Support};
use super::constants::{ARC_ANGLE, LOST_CONTACT, MOVER_PARTS, PIECE_ANGLE, SPHERE_INERTIA};
use super::flipper::Nearest;
use super::friction::{Friction, Rub};
use super::movers::{Mover, MovingFlipper, lever};
use super::scene::Presence;
use super::shapes::{Bounds, Shape};
use super::world::World;
use crate::math::tangent;

/// Where a body that comes to rest, or starts, can be touched.
#[derive(Debug, Clone, Copy)]
struct Disc {
    /// m.
    center: DVec2,
    /// From there to the centre of a ball that touches it, m, and more.
    radius: f64,
}

impl World {
    /// 2. Every ball that follows a surface begins a new piece of flight.
    pub(super) fn follow_surfaces(&mut self) {
        for ball in 0..self.state.balls.len() {
            self.follow_surface(ball, 0.0);
        }
    }

    /// Begins a new piece of flight for one ball that follows a surface.
    pub(super) fn follow_surface(&mut self, ball: usize, offset: f64) {
        match self.state.balls[ball].support {
            Support::None | Support::Line(_) | Support::Wedge(..) | Support::Held(_) | Support::Released(_) => {}
            Support::Stalled => {
                let (position, velocity) = self.ball_at(ball, offset);
                self.start_flight(ball, offset, position, velocity, None, None);
            }
            Support::Arc(index) => self.follow_arc(ball, index, offset, false),
            support @ (Support::Flipper(_) | Support::Plunger(_)) => {
                let rolls = self.state.balls[ball].slide.is_none();
                self.follow_mover(ball, support, offset, rolls);
            }
        }
    }

    /// A ball on a curved surface begins a new piece of flight along it: rolling if it `grips` now.
    pub(super) fn follow_arc(&mut self, ball: usize, index: u16, offset: f64, grips: bool) {
        let (position, velocity) = self.ball_at(ball, offset);
        let collider = self.scene.colliders[usize::from(index)];
        let Shape::Arc(arc) = &collider.shape else { return };
        let reach = arc.reach(self.radius(ball));
        let radial = position - arc.center;
        if !arc.spans(radial) {
            self.refresh_spin(ball, offset, position, velocity);
            self.start_flight(ball, offset, position, velocity, None, None);
            return;
        }
        // Back onto the surface, at the speed that it has there by its energy: the piece of parabola alone would gain
        // the square of the angle that it turned by.
        let outward = radial.try_normalize().unwrap_or(DVec2::Y);
        let along = tangent(outward * arc.sign());
        let place = arc.center + outward * reach;
        let subject = &self.state.balls[ball];
        let piece = &subject.flight;
        let way = place - piece.position;
        let worked = self.pull_of_flight(ball, piece.position + 0.5 * way).dot(way);
        let gained = match subject.slide {
            Some(Slide { spin_rate, .. }) => worked + spin_rate * SPHERE_INERTIA * self.radius(ball) * way.dot(along),
            None => collider.material.rolling_share() * worked,
        };
        let square = piece.velocity.length_squared() + 2.0 * gained;
        let estimate = velocity.dot(along);
        let speed = if square > 0.0 { square.sqrt().copysign(estimate) } else { estimate };
        self.refresh_spin(ball, offset, place, along * speed);
        if grips {
            let radius = self.radius(ball);
            let subject = &mut self.state.balls[ball];
            (subject.slide, subject.spin) = (None, -speed / radius);
        }
        self.start_flight(ball, offset, place, along * speed, Some(index), None);
    }

    /// A ball on a moving surface takes over its normal velocity and acceleration, as long as that presses it. One that
    /// `rolls` goes on rolling; one that has just landed slips first.
    pub(super) fn follow_mover(&mut self, ball: usize, support: Support, offset: f64, rolls: bool) {
        let radius = self.radius(ball);
        let (position, velocity) = self.ball_at(ball, offset);
        if self.state.balls[ball].slide.is_some() {
            self.refresh_spin(ball, offset, position, velocity);
        }
        let Some(Nearest { distance, normal, .. }) = self.mover_nearest(support, offset, position) else {
            self.start_flight(ball, offset, position, velocity, None, None);
            return;
        };
        let gap = distance - radius;
        // More than it could have left the surface by rounding and the tick's error: it has left.
        if gap > LOST_CONTACT * radius {
            self.start_flight(ball, offset, position, velocity, None, None);
            return;
        }
        let position = position - normal * gap;
        let surface = self.mover_velocity(support, offset, position - normal * radius);
        let leaving = (velocity - surface).dot(normal);
        let speed = (velocity - surface).dot(tangent(normal));
        let friction = self.mover_friction(support);
        if rolls && friction > 0.0 {
            self.state.balls[ball].spin = -speed / radius;
        }
        let pull = self.pull_on(ball, position, velocity, self.piece(support, offset));
        let push = self.mover_push(support, offset, position, velocity, radius);
        // Pressed on by less than nothing: it flies.
        let velocity = if leaving > self.scene.rest_speed {
            velocity
        } else {
            velocity + normal * self.share_contact(ball, support, offset, position - normal * radius, normal, leaving)
        };
        if leaving > self.scene.rest_speed || push <= pull.dot(normal) {
            self.start_flight(ball, offset, position, velocity, None, None);
            if let Support::Flipper(index) = support {
                self.reload_flipper(usize::from(index), offset);
            }
            return;
        }
        // As it is in the middle of this piece, if it is still pressed there: an error of third order in
        // its length.
        let half = 0.5 * self.piece(support, offset);
        let middle = position + velocity * half;
        let (normal, push) = self
            .mover_nearest(support, offset + half, middle)
            .map(|nearest| (nearest.normal, self.mover_push(support, offset + half, middle, velocity, radius)))
            .filter(|(normal, push)| *push > pull.dot(*normal))
            .unwrap_or((normal, push));
        let along = tangent(normal);
        let carried = self.mover_acceleration(support, offset + half, middle - normal * radius);
        let rub =
            Rub { friction, speed, spin: self.state.balls[ball].spin, radius, pulled: (pull - carried).dot(along) };
        let Friction { along: rubbed, slide } = rub.against(push - pull.dot(normal));
        let acceleration = normal * push + along * (pull.dot(along) + rubbed);
        let subject = &mut self.state.balls[ball];
        let start = Instant { tick: self.state.tick, offset };
        subject.flight = Flight { start, position, velocity, acceleration };
        subject.slide = slide;
        subject.past = None;
        self.flight_changed(ball);
    }

    /// What a ball's normal velocity changes by so that it neither leaves nor enters the moving surface that it lies on, which it
    /// does at `leaving` m/s; a flipper gets the opposite push.
    fn share_contact(
        &mut self,
        ball: usize,
        support: Support,
        offset: f64,
        contact: DVec2,
        normal: DVec2,
        leaving: f64,
    ) -> f64 {
        let Support::Flipper(index) = support else { return -leaving };
        let index = usize::from(index);
        let Some(mut motion) = self.flipper_motions[index] else { return -leaving };
        let (spec, mass) = (&self.scene.flippers[index], self.mass(ball));
        let lever = lever(spec, contact, normal);
        let push = -leaving / (1.0 / mass + lever * lever / spec.inertia);
        (motion.swing, motion.speed) = (motion.swing_at(offset), motion.speed_at(offset) - push * lever / spec.inertia);
        // Not into the stop that it has just left: that would hold it there.
        if (motion.swing <= 0.0 && motion.speed < 0.0) || (motion.swing >= spec.stroke && motion.speed > 0.0) {
            return -leaving;
        }
        motion.from = offset;
        self.flipper_motions[index] = Some(motion);
        let flipper = &mut self.state.flippers[index];
        (flipper.swing, flipper.speed) = (motion.swing, motion.speed);
        push / mass
    }

    /// When in this tick a ball that a flipper carries, or that runs along a curve, begins its next piece of flight: the offset.
    pub(super) fn next_piece(&self, ball: usize) -> Option<f64> {
        let subject = &self.state.balls[ball];
        let start = subject.flight.start.offset;
        let offset = match subject.support {
            Support::Flipper(_) => start + self.piece(subject.support, start),
            Support::Arc(index) => start + self.piece_of_arc(index, ball, subject.flight.velocity, start),
            _ => return None,
        };
        (offset < self.scene.tick_seconds).then_some(offset)
    }

    /// Seconds from `offset` on for which a ball that runs along an arc at that velocity follows one parabola: until it has turned
    /// by [`ARC_ANGLE`].
    pub(super) fn piece_of_arc(&self, index: u16, ball: usize, velocity: DVec2, offset: f64) -> f64 {
        let dt = self.scene.tick_seconds;
        let Shape::Arc(arc) = &self.scene.colliders[usize::from(index)].shape else { return dt - offset };
        let turned = ARC_ANGLE * arc.reach(self.radius(ball)) / velocity.length();
        let (left, least) = (dt - offset, dt / f64::from(MOVER_PARTS));
        let turned = if turned > least { turned } else { least };
        if turned < left { turned } else { left }
    }

    /// Seconds for which a ball on a moving surface follows one parabola from `offset` on.
    fn piece(&self, support: Support, offset: f64) -> f64 {
        match support {
            Support::Flipper(index) => {
                let index = usize::from(index);
                let Some(motion) = self.flipper_motions[index] else { return self.scene.tick_seconds - offset };
                let piece = self.flipper_piece(index, motion.swing_at(offset), motion.speed_at(offset), offset);
                // From slow to fast within the piece: no farther than by that angle either.
                let turned = (2.0 * PIECE_ANGLE / motion.acceleration.abs()).sqrt();
                if turned < piece { turned } else { piece }
            }
            _ => self.scene.tick_seconds - offset,
        }
    }

    /// A ball has hit a flipper: it goes on otherwise, and so do the other balls on it.
    pub(super) fn shake_carried(&mut self, index: usize, hit_by: usize, offset: f64) {
        let support = Support::Flipper(index as u16);
        let is_carried = |&ball: &usize| ball != hit_by && self.state.balls[ball].support == support;
        if let Some(other) = (0..self.state.balls.len()).find(is_carried) {
            self.begin_next_piece(other, offset);
        }
    }

    /// A ball has turned so far along a curve that it begins a new piece of flight, or a flipper so far that it and the balls on it
    /// do.
    pub(super) fn begin_next_piece(&mut self, ball: usize, offset: f64) {
        let support @ Support::Flipper(index) = self.state.balls[ball].support else {
            self.follow_surface(ball, offset);
            return;
        };
        self.reload_flipper(usize::from(index), offset);
        for ball in 0..self.state.balls.len() {
            if self.state.balls[ball].support == support {
                self.follow_surface(ball, offset);
            }
        }
    }

    /// The moving surface that a ball lies on; `None` once it moves no more.
    pub(super) fn mover_nearest(&self, support: Support, offset: f64, point: DVec2) -> Option<Nearest> {
        let nearest = match support {
            Support::Flipper(i) => self.moving_flipper(usize::from(i))?.nearest(offset, point),
            Support::Plunger(i) => self.moving_plunger(usize::from(i))?.nearest(offset, point),
            _ => return None,
        };
        nearest.distance.is_finite().then_some(nearest)
    }

    /// Velocity of the moving surface's point at `contact`.
    pub(super) fn mover_velocity(&self, support: Support, offset: f64, contact: DVec2) -> DVec2 {
        match support {
            Support::Flipper(i) => self.moving_flipper(usize::from(i)).map(|m| m.velocity(offset, contact)),
            Support::Plunger(i) => self.moving_plunger(usize::from(i)).map(|m| m.velocity(offset, contact)),
            _ => None,
        }
        .unwrap_or(DVec2::ZERO)
    }

    /// Acceleration along the surface's normal of a ball that is carried by it.
    fn mover_push(&self, support: Support, offset: f64, center: DVec2, velocity: DVec2, radius: f64) -> f64 {
        match support {
            Support::Flipper(i) => {
                let Some(MovingFlipper { spec, motion }) = self.moving_flipper(usize::from(i)) else { return 0.0 };
                let (swing, speed) = (motion.swing_at(offset), motion.speed_at(offset));
                let carried = spec.carried(swing, speed, center, velocity, radius);
                carried.acceleration + carried.lever * motion.acceleration
            }
            Support::Plunger(i) => {
                self.moving_plunger(usize::from(i)).map_or(0.0, |plunger| -plunger.motion.acceleration)
            }
            _ => 0.0,
        }
    }

    /// Acceleration of the moving surface's point at `contact`.
    fn mover_acceleration(&self, support: Support, offset: f64, contact: DVec2) -> DVec2 {
        match support {
            Support::Flipper(i) => {
                self.moving_flipper(usize::from(i)).map_or(DVec2::ZERO, |MovingFlipper { spec, motion }| {
                    let (arm, turn) = (contact - spec.pivot, motion.speed_at(offset));
                    arm.perp() * spec.turn_rate(motion.acceleration) - arm * (turn * turn)
                })
            }
            Support::Plunger(i) => self
                .moving_plunger(usize::from(i))
                .map_or(DVec2::ZERO, |plunger| -plunger.spec.normal * plunger.motion.acceleration),
            _ => DVec2::ZERO,
        }
    }

    /// Coulomb coefficient of a moving surface.
    pub(super) fn mover_friction(&self, support: Support) -> f64 {
        match support {
            Support::Flipper(i) => self.scene.flippers[usize::from(i)].material.friction,
            Support::Plunger(i) => self.scene.plungers[usize::from(i)].material.friction,
            _ => 0.0,
        }
    }

    /// A flipper started (`moves`), met a stop, or came to rest.
    pub(super) fn flipper_changed(&mut self, index: usize, offset: f64, moves: bool) {
        let scene = std::sync::Arc::clone(&self.scene);
        let spec = &scene.flippers[index];
        let support = Support::Flipper(index as u16);
        let own = [Presence::FlipperAtRest(index as u16), Presence::FlipperRaised(index as u16)];
        let reach = spec.reach() + 2.0 * scene.largest_radius();
        self.surface_changed(support, own, offset, moves, Disc { center: spec.pivot, radius: reach });
    }

    /// A plunger started (`moves`) or came home.
    pub(super) fn plunger_changed(&mut self, index: usize, offset: f64, moves: bool) {
        let scene = std::sync::Arc::clone(&self.scene);
        let spec = &scene.plungers[index];
        let support = Support::Plunger(index as u16);
        let own = [Presence::PlungerHome(index as u16); 2];
        let reach = spec.width + spec.stroke + 2.0 * scene.largest_radius();
        self.surface_changed(support, own, offset, moves, Disc { center: spec.from, radius: reach });
    }

    /// Balls on the surface now lie on its moving form (`moves`) or have to find out anew; balls near it begin a new
    /// flight, so that what they touch is known from its start; all that come near search for their next event again.
    fn surface_changed(&mut self, support: Support, own: [Presence; 2], offset: f64, moves: bool, place: Disc) {
        let Disc { center, radius } = place;
        let is_near = |position: DVec2| (position - center).length() <= radius;
        self.forget_nexts(
            Instant { tick: self.state.tick, offset },
            Some(Bounds { low: center, high: center }.grown(radius)),
        );
        for ball in 0..self.state.balls.len() {
            if self.state.balls[ball].saucer().is_some() {
                continue;
            }
            if self.state.balls[ball].floor > 0 {
                continue;
            }
            let is_own = |i: u16| own.contains(&self.scene.colliders[usize::from(i)].presence);
            let lies_on = match self.state.balls[ball].support {
                Support::Line(i) | Support::Arc(i) => is_own(i),
                Support::Wedge(i, j) => is_own(i) || is_own(j),
                other => other == support,
            };
            let (position, velocity) = self.ball_at(ball, offset);
            if lies_on || is_near(position) {
                self.refresh_spin(ball, offset, position, velocity);
            }
            if lies_on {
                let slide = self.state.balls[ball].slide;
                self.start_flight(ball, offset, position, velocity, None, None);
                if moves {
                    (self.state.balls[ball].support, self.state.balls[ball].slide) = (support, slide);
                }
            } else if is_near(position) {
                let subject = &mut self.state.balls[ball];
                let start = Instant { tick: self.state.tick, offset };
                subject.flight = Flight { start, position, velocity, ..subject.flight };
                subject.past = None;
                self.meetings.flight_changed(ball);
            }
        }
    }
}
