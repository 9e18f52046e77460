//! What an impact does, in the reference's numbers.

use shared::physics::scene::{Collider, Material, Role};

use super::super::real::{Real, Vector};

/// Velocity and spin after an impact with a static surface: restitution that falls with speed along the normal, Coulomb
/// friction along the surface up to the point of rolling (Cross 2002, a solid sphere), a kicker's kick.
pub(super) fn bounce<R: Real>(
    velocity: Vector<R>,
    spin: R,
    radius: R,
    normal: Vector<R>,
    collider: &Collider,
) -> (Vector<R>, R) {
    let Material { restitution, falloff, friction, tangential } = collider.material;
    let (zero, one) = (R::of(0.0), R::of(1.0));
    let along = normal.turned();
    let approach = -velocity.dot(normal);
    let returned = approach * R::of(restitution) / (one + R::of(falloff) * approach);
    let kick = match collider.role {
        Role::Kicker { speed, threshold } if approach.to_f64() >= threshold => R::of(speed),
        _ => zero,
    };
    let push = approach + returned + kick;
    let speed = velocity.dot(along);
    // The speed with which the ball's rim slips along the surface; it grips where friction suffices.
    let rim = speed - spin * radius;
    let (most, grip) = (R::of(friction) * push, rim.size() * R::of(2.0) / R::of(7.0));
    let size = if grip < most { grip } else { most };
    let change = if rim < zero { size } else { -size };
    let lost = (one - R::of(tangential)) * speed;
    let after = velocity + normal.times(push) + along.times(change - lost);
    (after, spin - change * R::of(5.0) / (R::of(2.0) * radius))
}

/// Velocities of two balls after they met: momentum is kept, the speed along the line of centres returned as the material
/// says.
pub(super) fn collide<R: Real>(
    one: (Vector<R>, Vector<R>),
    two: (Vector<R>, Vector<R>),
    masses: (R, R),
    material: &Material,
) -> (Vector<R>, Vector<R>) {
    let offset = one.0 - two.0;
    let normal = offset.times(R::of(1.0) / offset.length());
    let approach = (two.1 - one.1).dot(normal);
    let restitution = R::of(material.restitution) / (R::of(1.0) + R::of(material.falloff) * approach);
    let parted = (R::of(1.0) + restitution) * approach / (masses.0 + masses.1);
    (one.1 + normal.times(parted * masses.1), two.1 - normal.times(parted * masses.0))
}
