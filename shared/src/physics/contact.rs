//! Contact: what an impact does to a ball, and what a ball lies on afterwards.

use glam::DVec2;

use super::ball::{Slide, Support};
use super::constants::{SLIDE_ROUNDING, SLIP_SHARE, SMOOTH_JOINT, SPHERE_INERTIA, WEDGE_SPEEDS};
use super::friction::{Friction, Rub};
use super::scene::{Collider, Material, Scene};
use super::shapes::{Shape, Side};
use super::two_body::after_impact;
use crate::math::tangent;

/// The surface that a ball meets, as it is at the moment and point of impact.
#[derive(Debug, Clone, Copy)]
pub struct Surface {
    /// Unit normal towards the ball.
    pub normal: DVec2,
    /// Velocity of the surface's point, m/s.
    pub velocity: DVec2,
    /// What it is made of.
    pub material: Material,
    /// How it gives way to a push.
    pub mobility: Mobility,
    /// Normal speed that it adds, m/s.
    pub kick: f64,
}

/// How the point of a surface gives way to a push: inverse masses, 1/kg, 0 if it cannot move.
#[derive(Debug, Clone, Copy, Default, PartialEq)]
pub struct Mobility {
    /// Along the normal, to a push along it.
    pub normal: f64,
    /// Along the surface, to a push along that.
    pub along: f64,
    /// Along the one, to a push along the other.
    pub coupling: f64,
}

impl Mobility {
    /// Of a body on an axis: lever arms of a push along the normal and along the surface, m, and its inertia, kg m^2.
    pub fn on_axis(normal: f64, along: f64, inertia: f64) -> Self {
        Self { normal: normal * normal / inertia, along: along * along / inertia, coupling: normal * along / inertia }
    }
}

/// What an impact did.
#[derive(Debug, Clone, Copy)]
pub struct Response {
    /// The ball's velocity after it, m/s.
    pub velocity: DVec2,
    /// The ball's spin after it, rad/s.
    pub spin: f64,
    /// Push on the ball along the normal, N s; the surface got the opposite.
    pub impulse: f64,
    /// Push on the ball along the surface ([`tangent`] of its normal), N s, likewise.
    pub drag: f64,
}

/// The impulse that ends an approach: restitution along the normal, Coulomb friction along the surface, up to the
/// point where the ball rolls (Cross 2002, "Grip-slip behavior of a bouncing ball"; a solid sphere).
pub fn respond(velocity: DVec2, spin: f64, radius: f64, mass: f64, surface: &Surface) -> Response {
    let along = tangent(surface.normal);
    let relative = velocity - surface.velocity;
    // Two surfaces that merely touch may seem to part by a rounding.
    let approach = -relative.dot(surface.normal);
    let approach = if approach > 0.0 { approach } else { 0.0 };
    let restitution = surface.material.restitution_at(approach);
    let slip = relative.dot(along) + spin * radius;
    let (impulse, drag) = if surface.mobility == Mobility::default() {
        let impulse = ((1.0 + restitution) * approach + surface.kick) * mass;
        let most = surface.material.friction * impulse;
        (impulse, -(SLIP_SHARE * slip * mass).clamp(-most, most))
    } else {
        let both = |restitution: f64| push_movable(approach, slip, mass, restitution, surface);
        let (impulse, drag, gained) = both(restitution);
        // Restitution by speed alone can make energy of friction (Kane 1984): then none of it is given back.
        if gained > 0.0 && surface.kick == 0.0 {
            let (impulse, drag, _) = both(0.0);
            (impulse, drag)
        } else {
            (impulse, drag)
        }
    };
    let (pushed, change) = (impulse / mass, drag / mass);
    let lost = (1.0 - surface.material.tangential) * relative.dot(along);
    let mut after = velocity + surface.normal * pushed + along * (change - lost);
    if restitution == 0.0 && surface.kick == 0.0 && surface.mobility == Mobility::default() {
        // Nothing is left of the approach, not even its rounding: that would be met again.
        after -= surface.normal * (after - surface.velocity).dot(surface.normal);
    }
    Response { velocity: after, spin: spin + change / (SPHERE_INERTIA * radius), impulse, drag }
}

/// The pushes along the normal and along the surface between a ball and a surface that gives way, N s, and the energy that both
/// together gained by them, J. A push along one moves the surface along the other, too: grip asks for both at once.
fn push_movable(approach: f64, slip: f64, mass: f64, restitution: f64, surface: &Surface) -> (f64, f64, f64) {
    let Mobility { normal, along, coupling } = surface.mobility;
    let (normal, along) = (1.0 / mass + normal, 1.0 / (SLIP_SHARE * mass) + along);
    let wanted = (1.0 + restitution) * approach + surface.kick;
    let friction = surface.material.friction;
    let determinant = normal * along - coupling * coupling;
    let (mut impulse, mut drag) =
        ((wanted * along + coupling * slip) / determinant, -(slip * normal + coupling * wanted) / determinant);
    if impulse < 0.0 || drag.abs() > friction * impulse {
        // It slips all the way: friction against it, as strong as the load lets it be.
        // Without slip it is the push itself that would move the one along the other.
        let way = if slip == 0.0 { -drag } else { slip };
        let against = if way > 0.0 { -friction } else { friction };
        let slipping = normal + coupling * against;
        impulse = if slipping > 0.0 { wanted / slipping } else { wanted / normal };
        drag = against * impulse;
    }
    let (parted, slid) = (normal * impulse + coupling * drag, coupling * impulse + along * drag);
    (impulse, drag, impulse * (0.5 * parted - approach) + drag * (0.5 * slid + slip))
}

/// A ball that meets another.
#[derive(Debug, Clone, Copy)]
pub struct Body {
    /// m/s.
    pub velocity: DVec2,
    /// rad/s.
    pub spin: f64,
    /// m.
    pub radius: f64,
    /// kg.
    pub mass: f64,
}

/// The impulse between two balls: along `normal`, the unit vector from the second to the first, the manual's two-body
/// formula; along the surface Coulomb friction up to the point where they roll on each other. Velocity and spin of both.
/// With a `hop` they part at that speed, in m/s, whatever the material returns.
pub fn respond_pair(
    one: &Body,
    other: &Body,
    normal: DVec2,
    material: &Material,
    hop: Option<f64>,
) -> [(DVec2, f64); 2] {
    let along = tangent(normal);
    let relative = one.velocity - other.velocity;
    let approach = -relative.dot(normal);
    let approach = if approach > 0.0 { approach } else { 0.0 };
    let restitution = if hop.is_some() { 0.0 } else { material.restitution_at(approach) };
    let (mut after_one, mut after_other) = (one.velocity, other.velocity);
    if approach > 0.0 {
        (after_one, after_other) =
            after_impact(one.velocity, other.velocity, one.mass, other.mass, normal, restitution);
    }
    let parting = hop.unwrap_or(0.0);
    after_one += normal * (parting / (1.0 + one.mass / other.mass));
    after_other -= normal * (parting / (1.0 + other.mass / one.mass));

    let reduced_mass = 1.0 / (1.0 / one.mass + 1.0 / other.mass);
    let push = ((1.0 + restitution) * approach + parting) * reduced_mass;
    let slip = relative.dot(along) + (one.spin * one.radius + other.spin * other.radius);
    let most = material.friction * push;
    let drag = -(SLIP_SHARE * slip * reduced_mass).clamp(-most, most);
    let spun = |body: &Body| body.spin + drag / (SPHERE_INERTIA * body.mass * body.radius);
    [(after_one + along * (drag / one.mass), spun(one)), (after_other - along * (drag / other.mass), spun(other))]
}

/// A surface that a ball touches.
#[derive(Debug, Clone, Copy)]
struct Touch {
    collider: u16,
    normal: DVec2,
    /// Away from the centre of curvature when positive: 1 / radius of the path that the ball's centre would follow.
    curvature: f64,
    friction: f64,
    round: bool,
    /// Square of the normal speed, m^2/s^2 for each m/s^2 of press, whose hop is lost in the rounding of the coordinates.
    lost_hop: f64,
}

impl Touch {
    fn new(scene: &Scene, radius: f64, collider: u16, position: DVec2) -> Self {
        let Collider { shape, material, .. } = &scene.colliders[usize::from(collider)];
        let (curvature, round) = match shape {
            Shape::Segment(_) => (0.0, false),
            Shape::Arc(arc) => {
                let path = arc.reach(radius);
                (if arc.side == Side::Outside { 1.0 / path } else { -1.0 / path }, true)
            }
        };
        Self {
            collider,
            normal: shape.normal_at(position),
            curvature,
            friction: material.friction,
            round,
            lost_hop: 2.0 * f64::EPSILON * (position.abs().max_element() + radius),
        }
    }

    /// Square of the normal speed, m^2/s^2, below which the ball stays: the table's, or that of a hop lost in rounding.
    fn rest_square(&self, scene: &Scene, pull: DVec2, velocity: DVec2) -> f64 {
        let press = self.press(pull, velocity);
        let lost = if press > 0.0 { self.lost_hop * press } else { 0.0 };
        let square = scene.rest_speed * scene.rest_speed;
        if square > lost { square } else { lost }
    }

    /// Acceleration with which a ball that moves along the surface is pressed against it; not positive: it lifts off.
    fn press(&self, pull: DVec2, velocity: DVec2) -> f64 {
        let speed = velocity.dot(tangent(self.normal));
        -pull.dot(self.normal) - self.curvature * speed * speed
    }

    /// How friction acts on a ball that moves along the surface.
    fn friction(&self, pull: DVec2, velocity: DVec2, spin: f64, radius: f64, ahead: f64) -> Friction {
        let along = tangent(self.normal);
        let (speed, pulled) = (velocity.dot(along), pull.dot(along));
        let rub = Rub { friction: self.friction, speed, spin, radius, pulled };
        let first = rub.against(self.press(pull, velocity));
        if self.curvature == 0.0 || ahead == 0.0 {
            return first;
        }
        // On a curved surface the load changes with the speed: as it is in the middle of the time that this is for.
        let later = velocity + along * ((pulled + first.along) * ahead);
        let press = self.press(pull, later);
        if press > 0.0 { rub.against(press) } else { first }
    }

    /// Acceleration of a ball that moves along the surface, with the friction's share along it.
    fn acceleration(&self, pull: DVec2, velocity: DVec2, friction: f64) -> DVec2 {
        let along = tangent(self.normal);
        let speed = velocity.dot(along);
        along * (pull.dot(along) + friction) - self.normal * (self.curvature * speed * speed)
    }

    /// Whether two surfaces meet smoothly here: the same normal, but for a thousandth of a radian.
    fn continues(&self, other: &Self) -> bool {
        self.normal.dot(other.normal) > 1.0 - SMOOTH_JOINT
    }

    fn support(&self) -> Support {
        if self.round { Support::Arc(self.collider) } else { Support::Line(self.collider) }
    }
}

/// How a ball goes on.
#[derive(Debug, Clone, Copy)]
pub struct Settled {
    /// Velocity, without what the support takes away.
    pub velocity: DVec2,
    /// Acceleration until the next change.
    pub acceleration: DVec2,
    /// Spin: that of rolling, where the ball rolls.
    pub spin: f64,
    /// How it slides, if it does.
    pub slide: Option<Slide>,
    /// What it lies on now.
    pub support: Support,
}

/// A ball at a moment at which its motion changes.
#[derive(Debug, Clone, Copy)]
pub struct Moment {
    /// m.
    pub radius: f64,
    /// Of its centre, m.
    pub position: DVec2,
    /// m/s.
    pub velocity: DVec2,
    /// rad/s.
    pub spin: f64,
    /// What accelerates it where nothing holds it, m/s^2.
    pub pull: DVec2,
    /// Half of the time, in seconds, for which a motion along a curve will be taken for a parabola.
    pub ahead: f64,
}

/// Decides how a ball goes on that touches the collider `hit` and, until now, lay on `before`.
pub fn settle(scene: &Scene, ball: &Moment, hit: Option<u16>, before: Option<u16>) -> Settled {
    let Moment { radius, position, mut velocity, spin, pull, ahead } = *ball;
    let mut held: [Option<Touch>; 2] = [None, None];
    let mut still_square = 0.0;
    for (place, collider) in held.iter_mut().zip([hit, before]) {
        let Some(touch) = collider.map(|collider| Touch::new(scene, radius, collider, position)) else { continue };
        let speed = velocity.dot(touch.normal);
        // `hit` was just met, so it is not approached; `before` may be pressed into by the new velocity: then the next
        // search finds an impact with it.
        let rest_square = touch.rest_square(scene, pull, velocity);
        if speed * speed <= rest_square {
            velocity -= touch.normal * speed;
            *place = Some(touch);
            still_square = if rest_square > still_square { rest_square } else { still_square };
        }
    }
    let [first, second] = held;
    let mut pressed_by_any = false;
    // Between two surfaces a ball that hardly moves does not slide: it would climb them in turn, ever less, without end.
    let slow_square = WEDGE_SPEEDS * WEDGE_SPEEDS * still_square;
    let is_slow = velocity.length_squared() <= slow_square && (spin * radius) * (spin * radius) <= slow_square;
    let is_between = first.is_some() && second.is_some();
    for (touch, other) in [(first, second), (second, first)] {
        let Some(touch) = touch else { continue };
        if touch.press(pull, velocity) <= 0.0 {
            continue;
        }
        pressed_by_any = true;
        let along = tangent(touch.normal);
        let speed = velocity.dot(along);
        let slid = along * speed;
        let spin = if is_between && is_slow { -speed / radius } else { spin };
        let friction = touch.friction(pull, slid, spin, radius, ahead);
        let acceleration = touch.acceleration(pull, slid, friction.along);
        if other.is_none_or(|other| touch.continues(&other) || clears(&other, slid, acceleration, still_square)) {
            let rolls = touch.friction > 0.0 && friction.slide.is_none();
            let spin = if rolls { -speed / radius } else { spin };
            return Settled { velocity: slid, acceleration, spin, slide: friction.slide, support: touch.support() };
        }
    }
    match (first, second) {
        (Some(first), Some(second)) if pressed_by_any && velocity.length_squared() <= slow_square => {
            let still = Settled {
                velocity: DVec2::ZERO,
                acceleration: DVec2::ZERO,
                spin: 0.0,
                slide: None,
                support: Support::Wedge(first.collider, second.collider),
            };
            // Where a slope grows steeper, a ball that rolled up stops for a moment only: it rolls down the lower part.
            [(first, second), (second, first)]
                .into_iter()
                .filter(|(touch, _)| touch.press(pull, DVec2::ZERO) > 0.0)
                .map(|(touch, other)| {
                    let friction = touch.friction(pull, DVec2::ZERO, 0.0, radius, ahead);
                    (touch, other, friction.slide, touch.acceleration(pull, DVec2::ZERO, friction.along))
                })
                .find(|(_, other, _, acceleration)| clears(other, DVec2::ZERO, *acceleration, still_square))
                .map_or(still, |(touch, _, slide, acceleration)| Settled {
                    acceleration,
                    slide,
                    support: touch.support(),
                    ..still
                })
        }
        _ => Settled { velocity, acceleration: pull, spin, slide: None, support: Support::None },
    }
}

/// Whether a ball that slides with this velocity and acceleration does not run into `other`.
fn clears(other: &Touch, velocity: DVec2, acceleration: DVec2, rest_square: f64) -> bool {
    let speed = velocity.dot(other.normal);
    let pull = acceleration.dot(other.normal) + other.curvature * velocity.length_squared();
    (speed > 0.0 && speed * speed > rest_square)
        || (speed >= -SLIDE_ROUNDING * velocity.length() && pull >= -SLIDE_ROUNDING * acceleration.length())
}

#[cfg(test)]
mod tests {
    use super::*;

    const RUBBER: Material = Material { restitution: 0.8, falloff: 0.3, friction: 0.6, tangential: 1.0 };

    fn floor(material: Material) -> Surface {
        Surface { normal: DVec2::Y, velocity: DVec2::ZERO, material, mobility: Mobility::default(), kick: 0.0 }
    }

    #[test]
    fn restitution_falls_with_speed() {
        let surface = floor(Material { friction: 0.0, ..RUBBER });
        let after = respond(DVec2::new(1.0, -2.0), 0.0, 0.0135, 0.08, &surface);
        assert_eq!(after.velocity, DVec2::new(1.0, 2.0 * (0.8 / 1.6)));
        assert_eq!(after.spin, 0.0);
    }

    #[test]
    fn friction_ends_in_rolling_and_never_reverses_the_slip() {
        let after = respond(DVec2::new(0.5, -2.0), 0.0, 0.0135, 0.08, &floor(RUBBER));
        let slip = after.velocity.x + after.spin * 0.0135;
        assert!(slip.abs() < 1e-15, "slip {slip}");
        assert!((after.velocity.x - 0.5 * 5.0 / 7.0).abs() < 1e-15);
    }

    #[test]
    fn friction_is_bounded_by_the_push() {
        let after = respond(DVec2::new(50.0, -0.1), 0.0, 0.0135, 0.08, &floor(RUBBER));
        let pushed = 0.1 * (1.0 + RUBBER.restitution_at(0.1));
        assert!((50.0 - after.velocity.x - 0.6 * pushed).abs() < 1e-12);
    }

    #[test]
    fn a_movable_surface_shares_the_impulse() {
        let surface = Surface {
            mobility: Mobility { normal: 1.0 / 0.08, ..Mobility::default() },
            ..floor(Material::bouncing(1.0))
        };
        let after = respond(DVec2::new(0.0, -1.0), 0.0, 0.0135, 0.08, &surface);
        assert!(after.velocity.length() < 1e-15, "equal masses swap velocities");
    }

    /// Broke: a flipper felt nothing of the friction that dragged a ball along it, and the two won a quarter of what a coil gives.
    #[test]
    fn a_surface_on_an_axis_and_a_ball_together_never_gain_energy() {
        let mut rng = crate::math::Rng::new(9);
        let (radius, mass, inertia) = (0.0135, 0.08, 1.07e-4);
        for _ in 0..10_000 {
            let normal = crate::math::direction(rng.between(0.0, core::f64::consts::TAU));
            let arm = DVec2::new(rng.between(-0.07, 0.07), rng.between(-0.07, 0.07));
            let (velocity, spin) =
                (DVec2::new(rng.between(-5.0, 5.0), rng.between(-5.0, 5.0)), rng.between(-300.0, 300.0));
            let turn = rng.between(-100.0, 100.0);
            let levers = (arm.perp_dot(normal), arm.perp_dot(tangent(normal)));
            let surface = Surface {
                normal,
                velocity: arm.perp() * turn,
                material: RUBBER,
                mobility: Mobility::on_axis(levers.0, levers.1, inertia),
                kick: 0.0,
            };
            if (velocity - surface.velocity).dot(normal) >= 0.0 {
                continue;
            }
            let after = respond(velocity, spin, radius, mass, &surface);
            let turned = turn - (after.impulse * levers.0 + after.drag * levers.1) / inertia;
            let energy = |velocity: DVec2, spin: f64, turn: f64| {
                let rim = spin * radius;
                mass * (0.5 * velocity.length_squared() + 0.2 * rim * rim) + 0.5 * inertia * turn * turn
            };
            let (before, then) = (energy(velocity, spin, turn), energy(after.velocity, after.spin, turned));
            assert!(then <= before * (1.0 + 1e-13), "{before} J become {then} J");
        }
    }
}
