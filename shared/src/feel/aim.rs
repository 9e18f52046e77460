//! Aimed shots: where on the flipper the ball is when it is flipped decides where it goes.

use std::sync::Arc;

use super::stage::{Drill, LEFT, Start, classic, key, on_face};
use super::{Family, Figure};
use crate::extremes::transform::Similarity;
use crate::physics::ball::Flight;
use crate::physics::scene::Scene;

pub(super) const AIM: Family = Family {
    name: "aim",
    drill: "A ball rolls down the resting flipper from its pivot, where it lay still, or from the inlane, at 0.5 m/s there, and is \
        flipped where it is. Its direction 60 ms later is sampled every 0.1 mm from 15 to 62 mm along the flipper. The farther to the tip, the more to the \
        other side: strictly. Smooth: the jump between two samples is at most what the curve rises by on the millimetre around them \
        without that jump, scaled to a whole millimetre: 1 is the most that passes. The right flipper's shots are those of the mirrored table.",
    measure: aim,
};

/// A shot.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct Shot {
    /// Of the ball from the pivot along the flipper when it is flipped, mm.
    pub place: f64,
    /// In which the ball goes, degrees from up the table towards the flipper's other side.
    pub direction: f64,
    /// m/s.
    pub speed: f64,
    flight: Flight,
    spin: f64,
}

/// Between two shots, m.
const APART: f64 = 1e-4;
/// The first and the last place, in units of that: from where a ball is clear of the guide to where it leaves the flat.
const PLACES: core::ops::Range<u32> = 150..620;
/// Ticks from the button until the direction is read: the stroke is over, and nothing else was met.
const READ: u64 = 60;
/// Ticks for which the ball rolls before the button.
const ROLLS: u64 = 10;
/// Where a ball lies still that is let go, m from the pivot.
const CRADLE: f64 = 0.005;

/// How a ball gets to the flipper.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub enum From {
    /// It was held by the raised flipper.
    Cradle,
    /// It came down the inlane.
    Inlane,
}

impl From {
    /// Speed at the cradle's place, m/s.
    fn speed(self) -> f64 {
        match self {
            Self::Cradle => 0.0,
            Self::Inlane => 0.5,
        }
    }
}

/// All shots of one hand.
pub fn shots(from: From, right: bool) -> Vec<Shot> {
    shots_at(1000, from, right)
}

/// The same at so many ticks a second.
fn shots_at(tick_hz: u32, from: From, right: bool) -> Vec<Shot> {
    let left = classic(tick_hz);
    let scene = if right { Arc::new(Similarity::MIRROR.scene(&left)) } else { Arc::clone(&left) };
    PLACES.map(|place| shot(&left, &scene, from, f64::from(place) * APART, right)).collect()
}

/// The ball is put where it was some ticks before, so that it is flipped in that place: rolling from the cradle's on, it gained
/// 2 g 5/7 sin(slope) times the way as the square of its speed.
fn shot(left: &Scene, scene: &Arc<Scene>, from: From, place: f64, right: bool) -> Shot {
    let spec = &left.flippers[LEFT];
    let (_, normal) = on_face(spec, 0.0, place, left.radius(0));
    let pull = left.gravity.dot(crate::math::tangent(normal)) * crate::physics::constants::ROLLING_SHARE;
    let (before, way) = (ROLLS as f64 * 1e-3, place - CRADLE);
    let square = from.speed() * from.speed() + 2.0 * pull * way;
    let speed = square.sqrt() - pull * before;
    // It stood still at the cradle's place until then.
    let (speed, behind) = if speed > 0.0 { (speed, (speed + 0.5 * pull * before) * before) } else { (0.0, way) };
    let (position, _) = on_face(spec, 0.0, place - behind, left.radius(0));
    let start = Start::rolling(left, position, normal, speed);
    let map = if right { Similarity::MIRROR } else { Similarity::NONE };
    let start =
        Start { position: map.point(start.position), velocity: map.vector(start.velocity), spin: map.spin(start.spin) };
    let per_ms = (1e-3 / scene.tick_seconds).round() as u64;
    let mut drill = Drill::with_ball(scene, start, &[key(ROLLS * per_ms, right, true)]);
    drill.run_until(ROLLS * per_ms);
    let pivot = scene.flippers[LEFT].pivot;
    let axis = scene.flippers[LEFT].direction(0.0);
    let at = drill.ball().map_or(f64::NAN, |(position, _)| (position - pivot).dot(axis));
    drill.run_until((ROLLS + READ) * per_ms);
    let (_, velocity) = drill.ball().unwrap_or_default();
    let state = drill.world.state();
    Shot {
        place: at * 1e3,
        direction: libm::atan2(map.vector(velocity).x, velocity.y).to_degrees(),
        speed: velocity.length(),
        flight: state.balls[0].flight,
        spin: state.balls[0].spin,
    }
}

/// The worst jump between neighbours against what a millimetre explains, and where it is, mm.
fn worst_jump(shots: &[Shot]) -> (f64, f64) {
    let mut worst = (0.0, 0.0);
    for around in shots.windows(11) {
        let rise = |from: usize, to: usize| (around[to].direction - around[from].direction).abs();
        let way = |from: usize, to: usize| around[to].place - around[from].place;
        let jump = rise(5, 6);
        let slope = (rise(0, 5) + rise(6, 10)) / (way(0, 5) + way(6, 10));
        if jump / slope > worst.0 {
            worst = (jump / slope, around[5].place);
        }
    }
    worst
}

fn aim() -> Vec<Figure> {
    let mut figures = Vec::new();
    let mut differing = 0.0;
    for (from, name) in [(From::Cradle, "from the cradle"), (From::Inlane, "from the inlane")] {
        let left = shots(from, false);
        let steps = || left.windows(2).map(|pair| (pair[1].direction - pair[0].direction, pair[0].place));
        let back = steps().filter(|(step, _)| !step.is_nan() && *step <= 0.0).count() as f64;
        let (least, least_at) =
            steps().fold((f64::INFINITY, 0.0), |least, step| if step.0 < least.0 { step } else { least });
        let (worst, worst_at) = worst_jump(&left);
        let (first, last) = (&left[0], &left[left.len() - 1]);
        figures.extend([
            Figure::told(format!("{name}: direction at {:.0} mm", first.place), first.direction, "degrees"),
            Figure::told(format!("{name}: direction at {:.0} mm", last.place), last.direction, "degrees"),
            Figure::at_most(format!("{name}: places of {} with a step back", left.len()), back, "", 0.0),
            Figure::told(format!("{name}: least step, at {least_at:.1} mm"), least, "degrees"),
            Figure::at_most(format!("{name}: worst jump, at {worst_at:.1} mm"), worst, "of a mm's rise", 1.0),
        ]);
        let map = Similarity::MIRROR;
        let is_mirrored =
            |(one, other): (&Shot, &Shot)| map.flight(&one.flight) == other.flight && map.spin(one.spin) == other.spin;
        let right = shots(from, true);
        differing += left.iter().zip(&right).filter(|pair| !is_mirrored(*pair)).count() as f64;
    }
    for (from, name) in [(From::Cradle, "from the cradle"), (From::Inlane, "from the inlane")] {
        let fine = shots_at(16_000, from, false);
        let back = fine.windows(2).filter(|pair| pair[1].direction <= pair[0].direction).count() as f64;
        figures.push(Figure::told(format!("{name}, 16 ticks a ms: places with a step back"), back, ""));
        figures.push(Figure::told(format!("{name}, 16 ticks a ms: worst jump"), worst_jump(&fine).0, "of a mm's rise"));
    }
    figures.push(Figure::at_most("shots of the right hand that are no mirror images, bit for bit", differing, "", 0.0));
    figures
}
