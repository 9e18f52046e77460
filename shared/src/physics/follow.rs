//! Balls that follow a curved or a moving surface, tick by tick, and what becomes of them when a moving surface comes
//! to rest or starts.
//!
//! Such a motion is no parabola. For the rest of a tick it is taken for one, with the surface's curvature and
//! acceleration in it, and put back on the surface at the next tick: an error that falls with the tick's length.

use glam::DVec2;

use super::ball::{Flight, Instant, Support};
use super::constants::{LOST_CONTACT, ROLLING_SHARE};
use super::flipper::Nearest;
use super::movers::{Mover, MovingFlipper};
use super::scene::Presence;
use super::shapes::Shape;
use super::world::World;
use crate::math::tangent;

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
            Support::None | Support::Line(_) | Support::Wedge(..) => {}
            Support::Stalled => {
                let (position, velocity) = self.ball_at(ball, offset);
                self.start_flight(ball, offset, position, velocity, None, None);
            }
            Support::Arc(index) => self.follow_arc(ball, index, offset),
            support @ (Support::Flipper(_) | Support::Plunger(_)) => self.follow_mover(ball, support, offset),
        }
    }

    fn follow_arc(&mut self, ball: usize, index: u16, offset: f64) {
        let (position, velocity) = self.ball_at(ball, offset);
        let collider = self.scene.colliders[usize::from(index)];
        let Shape::Arc(arc) = &collider.shape else { return };
        let reach = arc.reach(self.radius(ball));
        let radial = position - arc.center;
        if !arc.spans(radial) {
            self.start_flight(ball, offset, position, velocity, None, None);
            return;
        }
        // Back onto the surface, at the speed that it has there by its energy: the piece of parabola alone would gain
        // the square of the angle that it turned by.
        let outward = radial.normalize();
        let along = tangent(outward);
        let place = arc.center + outward * reach;
        let piece = &self.state.balls[ball].flight;
        let share = collider.material.rolling_share();
        let fallen = self.scene.gravity.dot(place - piece.position);
        let square = piece.velocity.length_squared() + 2.0 * share * fallen;
        let estimate = velocity.dot(along);
        let speed = if square > 0.0 { square.sqrt().copysign(estimate) } else { estimate };
        self.refresh_spin(ball, place, along * speed);
        self.start_flight(ball, offset, place, along * speed, Some(index), None);
    }

    /// A ball on a moving surface takes over its normal velocity and acceleration, as long as that presses it.
    fn follow_mover(&mut self, ball: usize, support: Support, offset: f64) {
        let radius = self.radius(ball);
        let (position, velocity) = self.ball_at(ball, offset);
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
        let contact = position - normal * radius;
        let surface = self.mover_velocity(support, offset, contact);
        let leaving = (velocity - surface).dot(normal);
        let along = tangent(normal);
        let slide = (velocity - surface).dot(along);
        let pull = self.mover_pull(support, offset, position, velocity, radius);
        // Pressed on by less than nothing: it flies.
        if leaving > self.scene.rest_speed || pull <= self.scene.gravity.dot(normal) {
            self.start_flight(ball, offset, position, velocity, None, None);
            return;
        }
        let velocity = velocity - normal * leaving;
        // As it is in the middle of what is left of the tick, if it is still pressed there: an error of third order in
        // the tick's length.
        let half = 0.5 * (self.scene.tick_seconds - offset);
        let middle = position + velocity * half;
        let (normal, pull) = self
            .mover_nearest(support, offset + half, middle)
            .map(|nearest| (nearest.normal, self.mover_pull(support, offset + half, middle, velocity, radius)))
            .filter(|(normal, pull)| *pull > self.scene.gravity.dot(*normal))
            .unwrap_or((normal, pull));
        let along = tangent(normal);
        let acceleration = normal * pull + along * (self.scene.gravity.dot(along) * ROLLING_SHARE);
        let subject = &mut self.state.balls[ball];
        let start = Instant { tick: self.state.tick, offset };
        subject.flight = Flight { start, position, velocity, acceleration };
        subject.spin = -slide / radius;
        subject.past = None;
        self.flight_changed(ball);
    }

    /// The moving surface that a ball lies on; `None` once it moves no more.
    fn mover_nearest(&self, support: Support, offset: f64, point: DVec2) -> Option<Nearest> {
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
    fn mover_pull(&self, support: Support, offset: f64, center: DVec2, velocity: DVec2, radius: f64) -> f64 {
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

    /// A flipper started (`moves`), met a stop, or came to rest.
    pub(super) fn flipper_changed(&mut self, index: usize, offset: f64, moves: bool) {
        let scene = std::sync::Arc::clone(&self.scene);
        let spec = &scene.flippers[index];
        let support = Support::Flipper(index as u16);
        let own = [Presence::FlipperAtRest(index as u16), Presence::FlipperRaised(index as u16)];
        let reach = spec.reach() + 2.0 * scene.largest_radius();
        self.surface_changed(support, own, offset, moves, |position| (position - spec.pivot).length() <= reach);
    }

    /// A plunger started (`moves`) or came home.
    pub(super) fn plunger_changed(&mut self, index: usize, offset: f64, moves: bool) {
        let scene = std::sync::Arc::clone(&self.scene);
        let spec = &scene.plungers[index];
        let support = Support::Plunger(index as u16);
        let own = [Presence::PlungerHome(index as u16); 2];
        let reach = spec.width + spec.stroke + 2.0 * scene.largest_radius();
        self.surface_changed(support, own, offset, moves, |position| (position - spec.from).length() <= reach);
    }

    /// Balls on the surface now lie on its moving form (`moves`) or have to find out anew; balls near it begin a new
    /// flight, so that what they touch is known from its start; all search for their next event again.
    fn surface_changed(
        &mut self,
        support: Support,
        own: [Presence; 2],
        offset: f64,
        moves: bool,
        is_near: impl Fn(DVec2) -> bool,
    ) {
        self.forget_nexts(Instant { tick: self.state.tick, offset });
        for ball in 0..self.state.balls.len() {
            let is_own = |i: u16| own.contains(&self.scene.colliders[usize::from(i)].presence);
            let lies_on = match self.state.balls[ball].support {
                Support::Line(i) | Support::Arc(i) => is_own(i),
                Support::Wedge(i, j) => is_own(i) || is_own(j),
                other => other == support,
            };
            let (position, velocity) = self.ball_at(ball, offset);
            if lies_on || is_near(position) {
                self.refresh_spin(ball, position, velocity);
            }
            if lies_on {
                self.start_flight(ball, offset, position, velocity, None, None);
                if moves {
                    self.state.balls[ball].support = support;
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
