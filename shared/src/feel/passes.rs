//! Passes: a ball goes from one flipper to the other.

use std::sync::Arc;

use glam::DVec2;

use super::catches::{SPEEDS, window};
use super::stage::{Drill, LEFT, RIGHT, ROLL_INS, Start, classic, element, key, on_face, rolled_in, touches};
use super::{Family, Figure};
use crate::physics::EventKind;
use crate::physics::scene::Scene;

pub(super) const DEAD_BOUNCE: Family = Family {
    name: "dead bounce",
    drill: "A ball falls straight down on the resting left flipper, at 0.5, 1 or 2 m/s as for the catches, and nobody moves. It hops over the middle: the next \
        that it touches is the right flipper or the guide that leads to it. There is nothing to time, so it must do so wherever it falls on some 10 mm of the \
        flipper, of 15 to 55 mm from the pivot by 1 mm.",
    measure: dead_bounce,
};

pub(super) const POST_PASS: Family = Family {
    name: "post pass",
    drill: "A ball lies in the cradle of the left flipper, or rolls back down the held flipper, at 0.05 m/s (it had rolled up to 28 mm) or 0.1 m/s \
        (to 53 mm, nearly its tip) when it is 20 mm from the pivot. The button is let go after a time, by 1 ms, and pressed again 20 to 100 ms later, by 10 ms, so that the ball strikes the foot of the \
        slingshot on its own side; the next that it touches is the right flipper. From the cradle, the time is that until it is pressed again.",
    measure: post_pass,
};

pub(super) const TAP_PASS: Family = Family {
    name: "tap pass",
    drill: "A ball rolls on the left flipper: let go from the cradle, or out of the inlane at 0.25 m/s (from halfway up the guide) or 0.5 m/s (from its top). It is \
        tapped for 3 to 12 ms after a time, by 1 ms, with the right flipper held up from then on. It hops over the middle and lies \
        still on the right flipper within 3 s.",
    measure: tap_pass,
};

/// Ticks for which a ball may take to lie still.
const PATIENCE: u32 = 3000;

/// Whether the ball comes to lie still on that flipper.
fn is_trapped(drill: &mut Drill, flipper: usize) -> bool {
    for _ in 0..PATIENCE {
        drill.step();
        if drill.ball().is_none() {
            return false;
        }
        if drill.is_still() {
            return drill.is_at_flipper(flipper, 1e-4);
        }
    }
    false
}

/// Whether a ball that falls on the resting left flipper there hops to the right one.
fn hops(scene: &Arc<Scene>, speed: f64, place: f64) -> bool {
    let (place, _) = on_face(&scene.flippers[LEFT], 0.0, place, scene.radius(0));
    let mut drill = Drill::with_ball(scene, Start::flying(scene, place, DVec2::NEG_Y * speed, 0.05), &[]);
    let guide = element("right guide");
    let mut touched = false;
    for _ in 0..1500 {
        for event in drill.step() {
            match event.kind {
                EventKind::Touched { .. } if touches(scene, event, LEFT) => touched = true,
                EventKind::Touched { element, .. } => {
                    return touched && (element == guide || touches(scene, event, RIGHT));
                }
                EventKind::Passed { .. } => {}
                _ => return false,
            }
        }
    }
    false
}

fn dead_bounce() -> Vec<Figure> {
    let scene = classic(1000);
    let figure = |speed: f64| {
        let works = (15..=55).map(|mm| hops(&scene, speed, 1e-3 * f64::from(mm)));
        Figure::at_least(format!("{speed} m/s: length of the flipper that does it"), window(works, 1.0), "mm", 10.0)
    };
    SPEEDS.into_iter().map(figure).collect()
}

/// Calls `play` with the ball at every tick of its way down the flipper, from its arrival on; what it returned of each.
pub(super) fn at_each_tick<T>(arrival: f64, mut play: impl FnMut(Drill) -> T) -> Vec<T> {
    let mut rolling = rolled_in(&classic(1000), arrival);
    let mut all = Vec::new();
    let spec = rolling.world.scene().flippers[LEFT].clone();
    // Until it has left the flipper's tip.
    for _ in 0..2000 {
        let on_it = rolling.ball().is_some_and(|(place, _)| {
            (place - spec.pivot).length() < spec.length + spec.tip_radius + rolling.world.scene().radius(0)
        });
        if !on_it {
            break;
        }
        all.push(play(rolling.clone()));
        rolling.step();
    }
    all
}

fn post_pass() -> Vec<Figure> {
    let scene = classic(1000);
    let cradled = at_each_tick(0.0, |drill| post_passes(&scene, drill, 0));
    let mut figures = vec![Figure::at_least("from the cradle: window", window(cradled.into_iter(), 1.0), "ms", 2.0)];
    for speed in [0.05, 0.1] {
        let mut best = (0.0, 0);
        for down in (20..=100).step_by(10) {
            let works = rolling_back(&scene, speed).into_iter().map(|drill| post_passes(&scene, drill, down));
            let wide = window(works, 1.0);
            best = if wide > best.0 { (wide, down) } else { best };
        }
        figures.push(Figure::at_least(format!("{speed} m/s: window, let go for {} ms", best.1), best.0, "ms", 2.0));
    }
    figures
}

/// The ball at every tick of its way down the held left flipper, from 20 mm of the pivot on.
fn rolling_back(scene: &Arc<Scene>, speed: f64) -> Vec<Drill> {
    let spec = &scene.flippers[LEFT];
    let (place, normal) = on_face(spec, spec.stroke, 0.02, scene.radius(0));
    let mut drill = Drill::new(scene, &[key(0, false, true)]);
    drill.run_until(300);
    drill.put(Start::rolling(scene, place, normal, -speed));
    let each = |_| {
        let now = drill.clone();
        drill.step();
        now
    };
    (0..300).map(each).collect()
}

/// Whether a ball whose flipper is let go now, and flips it so many ticks later, strikes the foot of the left slingshot, and then
/// the right flipper.
fn post_passes(scene: &Scene, mut drill: Drill, down: u64) -> bool {
    let (post, guide) = (element("left sling body"), element("left guide"));
    if down > 0 {
        drill.press_after(0, false, false);
    }
    drill.press_after(down, false, true);
    drill.press_after(down + 60, false, false);
    let mut struck = false;
    for _ in 0..1500 {
        for event in drill.step() {
            match event.kind {
                EventKind::Touched { element, .. } if element == post => struck = true,
                EventKind::Touched { element, .. } if element == guide && !struck => {}
                EventKind::Touched { .. } if touches(scene, event, LEFT) && !struck => {}
                EventKind::Touched { .. } if touches(scene, event, RIGHT) => return struck,
                EventKind::Passed { .. } => {}
                _ => return false,
            }
        }
    }
    false
}

fn tap_pass() -> Vec<Figure> {
    let mut figures = Vec::new();
    for arrival in ROLL_INS {
        let mut best = (0.0, 0);
        for held in 3..=12 {
            let works = at_each_tick(arrival, |mut drill| {
                drill.press_after(0, false, true);
                drill.press_after(held, false, false);
                drill.press_after(0, true, true);
                is_trapped(&mut drill, RIGHT)
            });
            let wide = window(works.into_iter(), 1.0);
            best = if wide > best.0 { (wide, held) } else { best };
        }
        figures.push(Figure::at_least(
            format!("{arrival} m/s: window, with a tap of {} ms", best.1),
            best.0,
            "ms",
            2.0,
        ));
    }
    figures
}
