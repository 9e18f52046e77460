//! A flipper by itself: how long its stroke takes, how fast it is, and what taps of every length make of it.

use super::stage::{Drill, LEFT, classic, key};
use super::{Family, Figure};
use crate::physics::flipper::{FlipperRest, FlipperSpec};

pub(super) const STROKE: Family = Family {
    name: "stroke",
    drill: "A flipper of Classic is pressed, held and released. To the millisecond, as a real one is timed; the outermost point \
        is the far side of its tip, at its fastest.",
    measure: stroke,
};

pub(super) const TAPS: Family = Family {
    name: "tap",
    drill: "A button is held for so many ms. The stroke grows strictly with taps of 3 to 8 ms; from the first tap on that makes a \
        full stroke all longer ones do. Taps of 1 and 2 ms end within the coil's ramp: torque T t / ramp leaves a flipper of \
        inertia I at T t^3 / (6 ramp I) with the speed w = T t^2 / (2 ramp I), and the spring lets it rise by w^2 I / (2 share T) more: to 0.01 degrees, 12 um at the tip.",
    measure: taps,
};

/// Ticks a second that resolve a stroke.
const FINE: u32 = 16_000;

/// The first tick after `from` at whose end the flipper is like that, in ms after `from`.
fn ms_until(drill: &mut Drill, from: u64, is_there: impl Fn(f64, FlipperRest) -> bool) -> f64 {
    for _ in 0..FINE {
        drill.step();
        let flipper = drill.world.state().flippers[LEFT];
        if is_there(flipper.speed, flipper.rest) {
            return (drill.world.state().tick - from) as f64 * drill.world.scene().tick_seconds * 1e3;
        }
    }
    f64::NAN
}

fn stroke() -> Vec<Figure> {
    let scene = classic(FINE);
    let spec = &scene.flippers[LEFT];
    let second = u64::from(FINE);
    let mut drill = Drill::new(&scene, &[key(0, false, true), key(second, false, false)]);
    let mut fastest = 0.0;
    let mut up = f64::NAN;
    while drill.world.state().tick < second {
        drill.step();
        let flipper = drill.world.state().flippers[LEFT];
        fastest = if flipper.speed > fastest { flipper.speed } else { fastest };
        // At the end of its stroke it stops or turns round.
        if up.is_nan() && (flipper.speed <= 0.0 || flipper.rest == FlipperRest::Raised) {
            up = drill.world.state().tick as f64 * scene.tick_seconds * 1e3;
        }
    }
    let reaches = ms_until(&mut drill, second, |speed, rest| speed >= 0.0 || rest == FlipperRest::AtRest);
    let mut drill = Drill::new(&scene, &[key(0, false, true), key(second, false, false)]);
    drill.run_until(second);
    let settles = ms_until(&mut drill, second, |_, rest| rest == FlipperRest::AtRest);
    vec![
        Figure::between("coil to end of stroke", up, "ms", 19.0, 24.0),
        Figure::between("release to resting stop", reaches, "ms", 80.0, 95.0),
        Figure::told("release to lying still, after its bounces", settles, "ms"),
        Figure::between("outermost point", fastest * (spec.length + spec.tip_radius), "m/s", 6.0, 8.0),
    ]
}

/// Highest swing, radians, after a tap of so many ms, and whether it was the whole stroke.
fn tapped(ms: u64) -> (f64, bool) {
    let scene = classic(1000);
    let spec = &scene.flippers[LEFT];
    let spring = spec.return_share * spec.torque / spec.inertia;
    let mut drill = Drill::new(&scene, &[key(0, false, true), key(ms, false, false)]);
    let (mut highest, mut before, mut is_full) = (0.0, 0.0, false);
    for _ in 0..ms + 200 {
        drill.step();
        let flipper = drill.world.state().flippers[LEFT];
        // Of what it rises or has fallen between two ticks, by the spring alone.
        let top = flipper.swing + 0.5 * flipper.speed * flipper.speed / spring;
        let is_free = drill.world.state().tick > ms;
        highest = if is_free && top > highest { top } else { highest };
        // No spring turns it round within a tick: the stop has.
        let turned = before > 0.0 && flipper.speed <= 0.0 && before - flipper.speed > 2.0 * spring * scene.tick_seconds;
        is_full |= turned || flipper.rest == FlipperRest::Raised;
        before = flipper.speed;
    }
    (if highest < spec.stroke { highest } else { spec.stroke }, is_full)
}

/// The swing to which a tap of `t` seconds within the ramp takes a flipper, radians.
fn by_ramp(spec: &FlipperSpec, t: f64) -> f64 {
    let speed = spec.torque * t * t / (2.0 * spec.ramp * spec.inertia);
    speed * t / 3.0 + speed * speed * spec.inertia / (2.0 * spec.return_share * spec.torque)
}

fn taps() -> Vec<Figure> {
    let scene = classic(1000);
    let spec = &scene.flippers[LEFT];
    let strokes: Vec<(f64, bool)> = (1..=40).map(tapped).collect();
    let mut figures: Vec<Figure> = [1_u32, 2]
        .into_iter()
        .map(|ms| {
            let expected = by_ramp(spec, 1e-3 * f64::from(ms));
            let off = (strokes[ms as usize - 1].0 - expected).abs();
            let what = format!("{ms} ms: stroke off the ramp's {:.4} degrees", expected.to_degrees());
            Figure::at_most(what, off.to_degrees(), "degrees", 0.01)
        })
        .collect();
    let growth = strokes[2..8].windows(2).map(|pair| pair[1].0 - pair[0].0);
    let least = growth.fold(f64::INFINITY, |least, grown| if grown < least { grown } else { least });
    figures.push(Figure::at_least(
        "3 to 8 ms: least growth of the stroke for 1 ms more",
        least.to_degrees(),
        "degrees",
        0.1,
    ));
    for ms in [3, 8] {
        figures.push(Figure::told(format!("{ms} ms: stroke"), strokes[ms - 1].0.to_degrees(), "degrees"));
    }
    let full = strokes.iter().position(|(_, is_full)| *is_full);
    let first = full.map_or(f64::NAN, |place| place as f64 + 1.0);
    figures.push(Figure::between("shortest tap with a full stroke", first, "ms", 8.0, 13.0));
    let later = full.map_or(f64::NAN, |place| strokes[place..].iter().filter(|(_, is_full)| !is_full).count() as f64);
    figures.push(Figure::at_most("longer taps without a full stroke", later, "", 0.0));
    figures
}
