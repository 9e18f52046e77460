//! Two balls that meet: unequal, with friction and spin.

use std::sync::Arc;

use glam::DVec2;

use super::{Family, Figure};
use crate::math::{Rng, tangent};
use crate::physics::contact::Body;
use crate::physics::scene::{Material, Scene};
use crate::physics::{EventKind, World};
use crate::table::Table;

pub(super) const PAIR: Family = Family {
    name: "pair of balls",
    drill: "200 seeded pairs of balls of different size and mass, spinning, meet askew without gravity; half of them grip each other, half slip. \
        Off the closed form: the normal impulse is (1 + e) m v, m the reduced mass; the tangential one ends the slip at 2/7 m of \
        it, or is mu times the normal one. Momentum, angular momentum about (0, 0), and the energy, which loses (1 - e^2) m v^2 / 2 and, gripping, m s^2 / 7 by slip s.",
    measure: pair,
};

/// What all together have: momentum, kg m/s; angular momentum about (0, 0), kg m^2/s; energy, J.
fn totals(bodies: &[(Body, DVec2); 2]) -> (DVec2, f64, f64) {
    bodies.iter().fold((DVec2::ZERO, 0.0, 0.0), |(momentum, turn, energy), (body, place)| {
        let inertia = 0.4 * body.mass * body.radius * body.radius;
        let push = body.velocity * body.mass;
        let kinetic = 0.5 * (push.dot(body.velocity) + inertia * body.spin * body.spin);
        (momentum + push, turn + place.perp_dot(push) + inertia * body.spin, energy + kinetic)
    })
}

/// Bodies as they are at the moment of the only meeting, just before it.
fn before(rng: &mut Rng) -> [(Body, DVec2); 2] {
    let mut body = |radius: f64, mass: f64| Body {
        velocity: DVec2::new(rng.between(-3.0, 3.0), rng.between(-3.0, 3.0)),
        spin: rng.between(-150.0, 150.0),
        radius,
        mass,
    };
    let (one, other) = (body(0.0135, 0.08), body(0.02, 0.21));
    let normal = crate::math::direction(rng.between(0.0, core::f64::consts::TAU));
    let place = DVec2::new(0.3, 0.2);
    [(one, place + normal * (one.radius + other.radius)), (other, place)]
}

/// After the meeting, by the closed form; and the energy that it takes.
fn expected([(one, at), (other, place)]: &[(Body, DVec2); 2], material: &Material) -> ([Body; 2], f64) {
    let normal = (*at - *place).normalize();
    let along = tangent(normal);
    let reduced = one.mass * other.mass / (one.mass + other.mass);
    let relative = one.velocity - other.velocity;
    let approach = -relative.dot(normal);
    let push = (1.0 + material.restitution) * approach * reduced;
    // Of the surface of the first at the point of contact against that of the second.
    let slip = relative.dot(along) + one.spin * one.radius + other.spin * other.radius;
    let (grip, most) = (-slip * reduced * 2.0 / 7.0, material.friction * push);
    let drag = if grip.abs() < most { grip } else { most.copysign(grip) };
    let turned = |body: &Body, side: f64| Body {
        velocity: body.velocity + (normal * push + along * drag) * (side / body.mass),
        spin: body.spin + 2.5 * drag / (body.mass * body.radius),
        ..*body
    };
    let bounced = 0.5 * reduced * approach * approach * (1.0 - material.restitution * material.restitution);
    // Work of the drag: over the mean of the slips before and after.
    let slips_on = slip + 3.5 * drag / reduced;
    ([turned(one, 1.0), turned(other, -1.0)], bounced - 0.5 * drag * (slip + slips_on))
}

/// Lets the pair meet in a world; how they are just after.
fn met(bodies: &[(Body, DVec2); 2], material: Material) -> Option<[Body; 2]> {
    const BEFORE: f64 = 0.0105;
    let ball = |(body, place): &(Body, DVec2)| {
        let from = *place - body.velocity * BEFORE;
        let (velocity, radius, mass) = (body.velocity, body.radius, body.mass);
        format!(
            "(position: ({:?}, {:?}), velocity: ({:?}, {:?}), radius: {radius:?}, mass: {mass:?}),",
            from.x, from.y, velocity.x, velocity.y
        )
    };
    let text = format!(
        "Scene(gravity: (0.0, 0.0), bounds: (-9.0, -9.0, 9.0, 9.0), balls: [{} {}])",
        ball(&bodies[0]),
        ball(&bodies[1])
    );
    let scene = Table::parse("pair.ron", &text).ok()?.scene;
    let scene = Scene { ball_material: material, ..(*scene).clone() }.built();
    let mut world = World::new(Arc::new(scene));
    let mut state = world.state().clone();
    for (ball, (body, _)) in state.balls.iter_mut().zip(bodies) {
        ball.spin = body.spin;
    }
    world.restore(state).ok()?;
    for _ in 0..20 {
        if world.step().iter().any(|event| matches!(event.kind, EventKind::Met { .. })) {
            let after = |k: usize| Body {
                velocity: world.state().balls[k].flight.velocity,
                spin: world.state().balls[k].spin,
                ..bodies[k].0
            };
            return Some([after(0), after(1)]);
        }
    }
    None
}

fn pair() -> Vec<Figure> {
    let mut rng = Rng::new(11);
    let (mut off, mut momentum, mut turn, mut energy) = (0.0_f64, 0.0_f64, 0.0_f64, 0.0_f64);
    let (mut played, mut gripped) = (0, 0);
    let larger = |a: f64, b: f64| if b > a { b } else { a };
    while played < 200 {
        let bodies = before(&mut rng);
        let [(one, at), (other, place)] = &bodies;
        // They approach, and do not overlap a moment before.
        if (one.velocity - other.velocity).dot((*at - *place).normalize()) > -0.5 {
            continue;
        }
        played += 1;
        let material = Material { friction: if played % 2 == 0 { 5.0 } else { 0.05 }, ..Material::bouncing(0.8) };
        let (expected, loss) = expected(&bodies, &material);
        let Some(after) = met(&bodies, material) else {
            return vec![Figure::at_most("pairs that never met", 1.0, "", 0.0)];
        };
        let slip = |[a, b]: &[Body; 2]| {
            (a.velocity - b.velocity).dot(tangent((*at - *place).normalize())) + a.spin * a.radius + b.spin * b.radius
        };
        gripped += u32::from(slip(&expected).abs() < 1e-12);
        for (is, should) in after.iter().zip(&expected) {
            off = larger(off, (is.velocity - should.velocity).length() + (is.spin - should.spin).abs() * is.radius);
        }
        let (then, now) = (totals(&bodies), totals(&[(after[0], *at), (after[1], *place)]));
        momentum = larger(momentum, (now.0 - then.0).length());
        turn = larger(turn, (now.1 - then.1).abs());
        energy = larger(energy, ((now.2 - (then.2 - loss)) / then.2).abs());
    }
    vec![
        Figure::told("pairs that grip, of 200", f64::from(gripped), ""),
        Figure::at_most("speed and rim's speed off by", off, "m/s", 1e-9),
        Figure::at_most("momentum changed by", momentum, "kg m/s", 1e-12),
        Figure::at_most("angular momentum changed by", turn, "kg m^2/s", 1e-12),
        Figure::at_most("energy off its loss by", energy, "of it", 1e-9),
    ]
}
