//! A ball on an arm that turns at a constant rate, whatever the ball does: a flipper of huge inertia without coil.
//!
//! With s the ball's place along the arm, h = base radius + ball's radius its height over the pivot, w the arm's rate: in the
//! arm's axes the acceleration along it is s'' - w^2 s, across it 2 w s' - w^2 h. Friction F along the arm gives m (s'' - w^2 s) = F
//! and (2/5) m r^2 W' = r F; a ball that does not slip spins by W = w - s'/r, so F = -(2/5) m s'' and s'' = (5/7) w^2 s.
//! Without friction s'' = w^2 s. Both are solved by cosh and sinh.

use glam::DVec2;

use super::stage::{Drill, Start, bare, on_face};
use super::{Family, Figure};
use crate::physics::ball::Support;
use crate::physics::constants::ROLLING_SHARE;
use crate::physics::flipper::{FlipperRest, FlipperState};
use crate::physics::scene::Material;

pub(super) const ARM: Family = Family {
    name: "ball on a turning arm",
    drill: "A flipper of 10^6 kg m^2 and 1 m turns at 8 rad/s with a ball on it that moves outwards at 1 m/s, 0.1 m from the pivot, without gravity. \
        After 0.2 s, when it is 0.45 m out: off s = s0 cosh(k t) + (s0'/k) sinh(k t), k^2 = 5/7 w^2 for a ball that rolls, w^2 for one that slides. \
        Halving the tick at least halves the error.",
    measure: arm,
};

/// Of the arm, rad/s.
const RATE: f64 = 8.0;
/// Of the ball along the arm at the beginning, m and m/s.
const PLACE: f64 = 0.1;
const SPEED: f64 = 1.0;
/// How long it is followed, s.
const SECONDS: f64 = 0.2;

/// How far the ball is from its place, m.
fn off(material: Material, tick_hz: u32) -> f64 {
    let flipper = r#"Flipper(name: "arm", material: "surface", hand: Left, pivot: (2.0, 2.0), length: 1.0, base_radius: 0.01,
        tip_radius: 0.01, rest: 180.0, raised: 1.0, inertia: 1e6, torque: 1e-9, ramp: 0.0, hold: 1.0, hold_within: 1.0,
        return_share: 1e-6, stop_restitution: 0.0),"#;
    let scene = bare(DVec2::ZERO, flipper, material, tick_hz);
    let (spec, radius) = (&scene.flippers[0], scene.radius(0));
    let swing = 0.3;
    let (position, normal) = on_face(spec, swing, PLACE, radius);
    let axis = spec.direction(swing);
    let height = spec.base_radius + radius;
    let velocity = axis * (SPEED - RATE * height) + normal * (RATE * PLACE);
    let rolls = material.friction > 0.0;
    let spin = if rolls { RATE - SPEED / radius } else { 0.0 };
    let mut drill = Drill::with_ball(&scene, Start { position, velocity, spin }, &[]);
    let mut state = drill.world.state().clone();
    state.balls[0].support = Support::Flipper(0);
    state.flippers[0] = FlipperState { rest: FlipperRest::Moving, swing, speed: RATE, ..FlipperState::default() };
    if drill.world.restore(state).is_err() {
        return f64::NAN;
    }
    // A cast saturates.
    drill.run_until((SECONDS * f64::from(tick_hz)).round() as u64);
    let rate = if rolls { RATE * ROLLING_SHARE.sqrt() } else { RATE };
    let place = PLACE * libm::cosh(rate * SECONDS) + SPEED / rate * libm::sinh(rate * SECONDS);
    let (expected, _) = on_face(spec, swing + RATE * SECONDS, place, radius);
    drill.ball().map_or(f64::INFINITY, |(position, _)| (position - expected).length())
}

fn arm() -> Vec<Figure> {
    let grips = Material { friction: 1e6, ..Material::bouncing(0.5) };
    let mut figures = Vec::new();
    for (material, name) in [(grips, "rolls"), (Material { friction: 0.0, ..grips }, "slides")] {
        let [coarse, fine] = [1000, 2000].map(|tick_hz| off(material, tick_hz));
        figures.push(Figure::at_most(format!("{name}: off by"), 1e3 * coarse, "mm", 1.0));
        figures.push(Figure::at_least(
            format!("{name}: error with the tick over error with half of it"),
            coarse / fine,
            "",
            2.0,
        ));
    }
    figures
}
