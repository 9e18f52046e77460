//! Catches: a ball that flies at a flipper is stopped by timing alone.

use std::sync::Arc;

use super::stage::{Drill, Key, LEFT, Start, classic, key, on_face, touches};
use super::{Family, Figure};
use crate::physics::flipper::FlipperRest;
use crate::physics::scene::Scene;

pub(super) const LIVE_CATCH: Family = Family {
    name: "live catch",
    drill: "A ball flies at the middle of the raised flipper's face, along its normal, at 0.5 m/s (it fell from the slingshots), 1 m/s (from \
        the top of the table) or 2 m/s (a shot comes back). The button is pressed so long before it would arrive there; the speed \
        left is read 80 ms after. Curve: from -10 to 30 ms by 0.5 ms. The best is no more than 8 ms after the end of the stroke and leaves \
        at most 0.3 of the speed; there is a window of at least 1 ms with at most 0.35 left.",
    measure: live_catch,
};

pub(super) const DROP_CATCH: Family = Family {
    name: "drop catch",
    drill: "The same ball flies at a held flipper, whose button is released so long before it arrives, 0 to 60 ms by 1 ms. Of the speed at which \
        it parts, the largest along the raised face's normal within 150 ms, at most half of what the held flipper returns is left, over a \
        window of at least 2 ms; at 0.5 m/s, where the flipper falls as fast as the ball, at most a fifth of the ball's speed.",
    measure: drop_catch,
};

/// Where on the face the ball arrives, m from the pivot.
const PLACE: f64 = 0.035;
/// At which it arrives, m/s.
pub const SPEEDS: [f64; 3] = [0.5, 1.0, 2.0];
/// Tick of the button.
const PRESS: u64 = 100;
/// Tick at which the ball of a drop catch would arrive at the held flipper.
const ARRIVES: u64 = 400;
/// From arrival until the speed is read, ticks.
const READ: u64 = 80;

/// The ball that would touch the raised face after so many seconds.
fn arriving(scene: &Scene, speed: f64, after: f64) -> Start {
    let spec = &scene.flippers[LEFT];
    let (place, normal) = on_face(spec, spec.stroke, PLACE, scene.radius(0));
    Start::flying(scene, place, normal * -speed, after)
}

/// Speed left of a ball that arrives at `speed` m/s so many ms after the button was pressed.
fn left(scene: &Arc<Scene>, speed: f64, timing: f64) -> f64 {
    let arrives = PRESS as f64 + timing;
    // The ball is put 60 to 61 ms before it arrives. A cast saturates.
    let put = arrives as u64 - 60;
    let mut drill = Drill::new(scene, &[key(PRESS, false, true)]);
    drill.run_until(put);
    drill.put(arriving(scene, speed, 1e-3 * (arrives - put as f64)));
    drill.run_until(arrives as u64 + READ);
    drill.speed()
}

/// Time from the button to the ball's arrival at the raised face, ms, and the speed left, m/s: the whole curve.
pub fn live_curve(speed: f64) -> Vec<(f64, f64)> {
    let scene = classic(1000);
    (-20..=60).map(|half_ms| 0.5 * f64::from(half_ms)).map(|timing| (timing, left(&scene, speed, timing))).collect()
}

/// From the button to the end of the stroke without a ball, ms.
pub fn stroke_ms() -> f64 {
    let scene = classic(16_000);
    let mut drill = Drill::new(&scene, &[key(0, false, true)]);
    loop {
        drill.step();
        let flipper = drill.world.state().flippers[LEFT];
        if flipper.rest == FlipperRest::Raised || flipper.speed < 0.0 || drill.world.state().tick > 16_000 {
            return drill.world.state().tick as f64 * scene.tick_seconds * 1e3;
        }
    }
}

/// The longest run of neighbours that pass, as a time: samples `apart` from each other.
pub(super) fn window(passes: impl Iterator<Item = bool>, apart: f64) -> f64 {
    let (mut longest, mut run) = (0_u32, 0_u32);
    for passes in passes {
        run = if passes { run + 1 } else { 0 };
        longest = longest.max(run);
    }
    apart * f64::from(longest.saturating_sub(1))
}

fn live_catch() -> Vec<Figure> {
    let stroke = stroke_ms();
    let mut figures = Vec::new();
    for speed in SPEEDS {
        let curve = live_curve(speed);
        let best = curve.iter().fold((0.0, f64::INFINITY), |best, &point| if point.1 < best.1 { point } else { best });
        let wide = window(curve.iter().map(|(_, left)| *left <= 0.35 * speed), 0.5);
        let held = left(&classic(1000), speed, 200.0);
        figures.extend([
            Figure::told(format!("{speed} m/s: left by a flipper that has long been up"), held / speed, "of the speed"),
            Figure::at_most(
                format!("{speed} m/s: least left, {} ms after the button", best.0),
                best.1 / speed,
                "of the speed",
                0.3,
            ),
            Figure::between(format!("{speed} m/s: best after the end of the stroke"), best.0 - stroke, "ms", 0.0, 8.0),
            Figure::at_least(format!("{speed} m/s: window with 0.35 or less"), wide, "ms", 1.0),
        ]);
    }
    figures
}

/// The fastest at which the ball parts from the flipper along the raised face's normal, once it has touched it, m/s. NaN if it
/// does not within 60 ms of arriving, or falls off the flipper.
fn parting(scene: &Arc<Scene>, speed: f64, keys: &[Key]) -> f64 {
    let spec = &scene.flippers[LEFT];
    let (_, normal) = on_face(spec, spec.stroke, PLACE, scene.radius(0));
    let mut drill = Drill::new(scene, keys);
    drill.run_until(ARRIVES - 50);
    drill.put(arriving(scene, speed, 0.05));
    let (mut fastest, mut touched) = (f64::NEG_INFINITY, false);
    while drill.world.state().tick < ARRIVES + 150 {
        touched |= drill.step().iter().any(|event| touches(scene, event, LEFT));
        let Some((place, velocity)) = drill.ball() else { return f64::NAN };
        let along = (place - spec.pivot).dot(spec.direction(0.0));
        if (!touched && drill.world.state().tick > ARRIVES + 60) || along > spec.length {
            return f64::NAN;
        }
        let parts = velocity.dot(normal);
        fastest = if touched && parts > fastest { parts } else { fastest };
    }
    fastest
}

fn drop_catch() -> Vec<Figure> {
    let scene = classic(1000);
    let mut figures = Vec::new();
    for speed in SPEEDS {
        let held = parting(&scene, speed, &[key(0, false, true)]);
        let dropped: Vec<f64> = (0..=60)
            .map(|before| parting(&scene, speed, &[key(0, false, true), key(ARRIVES - before, false, false)]))
            .collect();
        let most = if speed > SPEEDS[0] { 0.5 * held } else { 0.2 * speed };
        let (at, least) = (0..)
            .zip(&dropped)
            .fold((0, f64::INFINITY), |best, (at, &left)| if left < best.1 { (at, left) } else { best });
        figures.extend([
            Figure::told(format!("{speed} m/s: returned by the held flipper"), held / speed, "of the speed"),
            Figure::at_most(
                format!("{speed} m/s: least returned, dropped {at} ms before"),
                least / speed,
                "of the speed",
                most / speed,
            ),
            Figure::at_least(
                format!("{speed} m/s: window"),
                window(dropped.iter().map(|left| *left <= most), 1.0),
                "ms",
                2.0,
            ),
        ]);
    }
    figures
}
