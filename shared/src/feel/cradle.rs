//! The cradle: a ball that is trapped on a held flipper lies still.

use super::stage::{Drill, LEFT, RIGHT, Start, classic, key, on_face};
use super::{Family, Figure};
use glam::DVec2;

pub(super) const CRADLE: Family = Family {
    name: "cradle",
    drill: "A ball is dropped on a held flipper, from 2, 5 and 10 mm above the middle of its face, or rolls down the inlane onto it, \
        from 10, 20 and 35 mm up the guide, of both hands (from farther up it rolls up the flipper and back for longer than that, or over its tip). Of the worst: how long it takes from the first touch until it lies still, \
        how far it moves in the minute after, and its spin then.",
    measure: cradle,
};

/// The flipper is up and still from then on, tick.
const UP: u64 = 300;

/// Balls that fall on the raised flipper, or roll towards it.
fn starts() -> Vec<(usize, Start)> {
    let scene = classic(1000);
    let radius = scene.radius(0);
    let mut starts = Vec::new();
    for (hand, sign) in [(LEFT, 1.0), (RIGHT, -1.0)] {
        let spec = &scene.flippers[hand];
        let (position, _) = on_face(spec, spec.stroke, 0.03, radius);
        for height in [0.002, 0.005, 0.01] {
            starts.push((hand, Start { position: position + DVec2::Y * height, velocity: DVec2::ZERO, spin: 0.0 }));
        }
        // Along the guide, which leads down to (0.146, 0.1822) from (0.041, 0.2552), or to the mirror image of that.
        let up = DVec2::new(-0.105 * sign, 0.073).normalize();
        let foot = DVec2::new(if sign > 0.0 { 0.146 } else { 0.328 }, 0.1822);
        let normal = DVec2::new(up.y * sign, -up.x * sign);
        for way in [0.01, 0.02, 0.035] {
            starts
                .push((hand, Start { position: foot + up * way + normal * radius, velocity: DVec2::ZERO, spin: 0.0 }));
        }
    }
    starts
}

fn cradle() -> Vec<Figure> {
    let scene = classic(1000);
    let (mut slowest, mut farthest, mut most_spin) = (0.0, 0.0, 0.0);
    for (hand, start) in starts() {
        let mut drill = Drill::new(&scene, &[key(0, hand == RIGHT, true)]);
        drill.run_until(UP);
        drill.put(start);
        let mut touched = None;
        while !drill.is_still() && drill.world.state().tick < UP + 10_000 {
            if touched.is_none() && drill.is_at_flipper(hand, 1e-4) {
                touched = Some(drill.world.state().tick);
            }
            drill.step();
        }
        let now = drill.world.state().tick;
        let settles =
            touched.filter(|_| drill.is_still()).map_or(f64::INFINITY, |touched| (now - touched) as f64 * 1e-3);
        slowest = if settles > slowest { settles } else { slowest };
        let place = drill.ball().map(|(position, _)| position);
        for _ in 0..60_000 {
            drill.step();
            let moved = match (place, drill.ball()) {
                (Some(place), Some((position, _))) => (position - place).length(),
                _ => f64::INFINITY,
            };
            farthest = if moved > farthest { moved } else { farthest };
        }
        let spin = drill.world.state().balls.first().map_or(f64::INFINITY, |ball| ball.spin.abs());
        most_spin = if spin > most_spin { spin } else { most_spin };
    }
    vec![
        Figure::at_most("from the first touch until it lies still", slowest, "s", 2.0),
        Figure::at_most("moves in a minute", farthest, "m", 1e-5),
        Figure::at_most("spin then", most_spin, "rad/s", 0.0),
    ]
}
