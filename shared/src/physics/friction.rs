//! Friction between a ball and what it lies on: it slides until its rim grips, then it rolls.

use glam::DVec2;

use super::ball::{Ball, Instant, Slide, Support};
use super::constants::{SLIDE_ROUNDING, SLIP_SHARE, SPHERE_INERTIA};
use super::scene::Scene;
use super::world::World;
use crate::math::tangent;

/// A ball that touches a surface for a while, seen along it.
#[derive(Debug, Clone, Copy)]
pub(super) struct Rub {
    /// Coulomb coefficient.
    pub(super) friction: f64,
    /// Of the ball's centre relative to the surface, m/s.
    pub(super) speed: f64,
    /// rad/s.
    pub(super) spin: f64,
    /// m.
    pub(super) radius: f64,
    /// Acceleration of that speed without friction, m/s^2.
    pub(super) pulled: f64,
}

/// What friction does to it.
#[derive(Debug, Clone, Copy, Default)]
pub(super) struct Friction {
    /// Its acceleration of the ball's centre along the surface, m/s^2.
    pub(super) along: f64,
    /// Set while the ball slides; otherwise it rolls, or there is no friction.
    pub(super) slide: Option<Slide>,
}

impl Rub {
    /// Coulomb's law with the true load: `press` is the acceleration that the surface gives the ball along its normal.
    /// While its rim slips, friction is the coefficient times the load; once it grips, a solid sphere needs 2/7 of the pull
    /// to go on rolling, and slips again if there is not so much.
    pub(super) fn against(&self, press: f64) -> Friction {
        let most = self.friction * press;
        if most.is_nan() || most <= 0.0 {
            return Friction::default();
        }
        let slip = self.speed + self.spin * self.radius;
        let rim = self.spin.abs() * self.radius;
        let is_rounding = slip.abs() <= SLIDE_ROUNDING * (self.speed.abs() + rim);
        if is_rounding && SLIP_SHARE * self.pulled.abs() <= most {
            return Friction { along: -SLIP_SHARE * self.pulled, slide: None };
        }
        let way = if is_rounding { self.pulled } else { slip };
        let along = if way > 0.0 { -most } else { most };
        let spin_rate = along / (SPHERE_INERTIA * self.radius);
        // The slip's own rate: that of the centre and that of the rim.
        let rate = self.pulled + along + spin_rate * self.radius;
        let until = (!is_rounding && rate * slip < 0.0).then(|| -slip / rate).filter(|until| until.is_finite());
        Friction { along, slide: Some(Slide { until, spin_rate }) }
    }
}

impl Ball {
    /// Its spin at `instant`, rad/s: the one kept with its flight is that of the flight's start.
    pub fn spin_at(&self, instant: Instant, scene: &Scene) -> f64 {
        if let Some(Slide { spin_rate, .. }) = self.slide {
            return self.spin + spin_rate * instant.since(self.flight.start, scene.tick_seconds);
        }
        match self.support_collider(scene) {
            Some(collider) if collider.material.friction > 0.0 => {
                let (position, velocity) = self.at(instant, scene.tick_seconds);
                -velocity.dot(tangent(collider.shape.normal_at(position))) / scene.radius(self.kind)
            }
            _ => self.spin,
        }
    }
}

impl World {
    /// The spin kept with a flight is that of its start: brings it up to `offset`, where the ball is at `position`.
    pub(super) fn refresh_spin(&mut self, ball: usize, offset: f64, position: DVec2, velocity: DVec2) {
        if !self.scene.needs.slides() {
            return;
        }
        let subject = &self.state.balls[ball];
        if let Some(Slide { until, spin_rate }) = subject.slide {
            let elapsed =
                Instant { tick: self.state.tick, offset }.since(subject.flight.start, self.scene.tick_seconds);
            let left = |until: f64| if until > elapsed { until - elapsed } else { 0.0 };
            let slide = Slide { until: until.map(left), spin_rate };
            let subject = &mut self.state.balls[ball];
            subject.spin += spin_rate * elapsed;
            // Whoever goes on with the flight as it is begins it anew from here.
            subject.slide = Some(slide);
            return;
        }
        if let Some(speed) = self.rolling_speed(ball, offset, position, velocity) {
            self.state.balls[ball].spin = -speed / self.radius(ball);
        }
    }

    /// The speed along what a ball lies on, if there is friction to make it roll.
    fn rolling_speed(&self, ball: usize, offset: f64, position: DVec2, velocity: DVec2) -> Option<f64> {
        let subject = &self.state.balls[ball];
        if let Some(collider) = subject.support_collider(&self.scene) {
            let has_friction = collider.material.friction > 0.0;
            return has_friction.then(|| velocity.dot(tangent(collider.shape.normal_at(position))));
        }
        let normal = self.mover_nearest(subject.support, offset, position)?.normal;
        let contact = position - normal * self.radius(ball);
        let has_friction = self.mover_friction(subject.support) > 0.0;
        has_friction.then(|| (velocity - self.mover_velocity(subject.support, offset, contact)).dot(tangent(normal)))
    }

    /// A ball that slid along what it lies on grips it: from now on it rolls.
    pub(super) fn grip(&mut self, ball: usize, offset: f64, position: DVec2, velocity: DVec2) {
        // Each counts as an impact, so that ever shorter slides between two surfaces come to an end.
        self.impacts[ball] += 1;
        if self.impacts[ball] > self.most_impacts {
            self.stall(ball, offset, position);
            return;
        }
        match self.state.balls[ball].support {
            // Back onto the curve, at the speed that the slide has left it.
            Support::Arc(index) => self.follow_arc(ball, index, offset, true),
            support => {
                self.state.balls[ball].slide = None;
                self.refresh_spin(ball, offset, position, velocity);
                match support {
                    Support::Line(index) => self.start_flight(ball, offset, position, velocity, Some(index), None),
                    _ => self.follow_surface(ball, offset),
                }
            }
        }
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    const SLIDES: Rub = Rub { friction: 0.3, speed: 2.0, spin: 0.0, radius: 0.0135, pulled: 0.0 };

    #[test]
    fn a_sliding_ball_grips_after_the_time_that_takes_two_sevenths_of_its_speed() {
        let Friction { along, slide } = SLIDES.against(10.0);
        let Some(Slide { until: Some(until), spin_rate }) = slide else { panic!("it slides") };
        assert_eq!(along, -3.0);
        assert!((along * until + 2.0 * SLIP_SHARE).abs() < 1e-15, "{until}");
        let slip = 2.0 + along * until + spin_rate * until * 0.0135;
        assert!(slip.abs() < 1e-15, "{slip}");
    }

    #[test]
    fn a_ball_without_load_is_free_and_one_pulled_too_hard_slips() {
        let free = SLIDES.against(-1.0);
        assert_eq!((free.along, free.slide), (0.0, None));
        let rolls = Rub { speed: 2.0, spin: -2.0 / 0.0135, pulled: 7.0, ..SLIDES };
        let held = rolls.against(10.0);
        assert_eq!((held.along, held.slide), (-2.0, None));
        let slips = rolls.against(5.0);
        assert_eq!(slips.along, -1.5);
        assert_eq!(slips.slide.map(|slide| slide.until), Some(None));
    }
}
