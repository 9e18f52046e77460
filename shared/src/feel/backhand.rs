//! The backhand: a shot to the flipper's own side.

use super::catches::window;
use super::passes::at_each_tick;
use super::stage::{Drill, LEFT, ROLL_INS, touches};
use super::{Family, Figure};
use crate::physics::EventKind;

pub(super) const BACKHAND: Family = Family {
    name: "backhand",
    drill: "A ball rolls on the left flipper as for the tap pass and is flipped after a time, by 1 ms. It flies freely over the slingshots, y = 0.45 m, on \
        the flipper's own side of its pivot, at 1.2 m/s or more: enough for the top of the table.",
    measure: backhand,
};

/// Over the slingshots, m.
const OVER: f64 = 0.45;
/// m/s.
const FAST: f64 = 1.2;

fn is_backhanded(mut drill: Drill) -> bool {
    drill.press_after(0, false, true);
    let scene = std::sync::Arc::clone(drill.world.scene());
    let own_side = scene.flippers[LEFT].pivot.x;
    for _ in 0..600 {
        let is_free = |kind: EventKind| matches!(kind, EventKind::Passed { .. });
        if drill.step().iter().any(|event| !is_free(event.kind) && !touches(&scene, event, LEFT)) {
            return false;
        }
        let Some((place, velocity)) = drill.ball() else { return false };
        if place.y > OVER {
            return place.x < own_side && velocity.length() >= FAST;
        }
    }
    false
}

fn backhand() -> Vec<Figure> {
    let figure = |arrival: f64| {
        let works = at_each_tick(arrival, is_backhanded);
        Figure::at_least(format!("{arrival} m/s: window"), window(works.into_iter(), 1.0), "ms", 2.0)
    };
    ROLL_INS.into_iter().map(figure).collect()
}
