//! The problems, and how a run is compared with the solution.

use glam::DVec2;
use serde::Deserialize;
use shared::physics::scene::Collider;
use shared::physics::shapes::Shape;
use shared::table::Table;

use super::digits::{exact, exact_f64, rounded};
use super::run::{Run, Stretch};

/// A solution as written.
#[derive(Deserialize)]
#[serde(deny_unknown_fields, rename = "Solution")]
pub(crate) struct Solution {
    /// Bounces that a start changed by 1e-16 keeps at the least; `None`: as many as there are.
    pub(crate) limit: Option<usize>,
    /// Where the solution ends, seconds.
    pub(crate) end: f64,
    /// Every impact.
    pub(crate) events: Vec<Impact>,
}

/// An impact: when, with what, and the ball's centre; `s3`: the side of wall 3, `p3a`: its first end.
#[derive(Deserialize)]
pub(crate) struct Impact(String, String, String, String);

impl Impact {
    /// The name of the scene's element: an end of a wall is its wall's.
    pub(crate) fn element(&self) -> &str {
        self.1.as_str()
    }

    fn time(&self) -> i128 {
        exact(&self.0)
    }
}

/// A scene and its solution.
pub(crate) struct Problem {
    pub(crate) name: &'static str,
    pub(crate) table: Table,
    pub(crate) solution: Solution,
}

macro_rules! texts {
    ($($name:literal)*) => {
        [$((
            $name,
            include_str!(concat!("scenes/", $name, ".ron")),
            include_str!(concat!("solutions/", $name, ".ron")),
        )),*]
    };
}

/// All twelve.
pub(crate) fn problems() -> Vec<Problem> {
    let texts = texts!(
        "p01_box_bumpers" "p02_box_bumpers_e1" "p03_pegs200" "p04_graze_wall" "p05_narrow_v" "p06_fast_thin"
        "p07_tiny_ball" "p08_huge_offset" "p09_zero_g" "p10_strong_g" "p11_inside_circle" "p12_long_300"
    );
    let read = |(name, scene, solution)| {
        let table = Table::parse(name, scene).unwrap_or_else(|error| panic!("{error}"));
        let mut solution: Solution = ron::from_str(solution).unwrap_or_else(|error| panic!("{name}: {error}"));
        for event in &mut solution.events {
            if let Some(end) = event.1.strip_prefix('p') {
                event.1 = format!("s{}", end.trim_end_matches(['a', 'b']));
            }
        }
        Problem { name, table, solution }
    };
    texts.into_iter().map(read).collect()
}

/// Points of each flight that are looked at.
const SAMPLES: u32 = 32;

impl Problem {
    /// Bounces that 53 bits can keep.
    pub(crate) fn limit(&self) -> usize {
        self.solution.limit.unwrap_or(self.solution.events.len())
    }

    /// The error of a run at each impact of the solution, m: the distance from the solution's centre to that of the engine at
    /// the solution's time.
    ///
    /// Times and places are subtracted exactly. What is left to f64 is the way from the start of a flight, and its rounding
    /// is that of a few bits of this way: below 1e-15 for ways of up to two metres, which no flight of these scenes exceeds.
    pub(crate) fn errors(&self, run: &Run) -> Vec<f64> {
        let mut flights = run.flights.iter().peekable();
        let mut current = flights.next();
        let error_at = |impact: &Impact| {
            let time = impact.time();
            while let Some(next) = flights.next_if(|next| next.start <= time) {
                current = Some(next);
            }
            current.map_or(f64::INFINITY, |flight| flight.distance_at(time, &impact.2, &impact.3))
        };
        self.solution.events.iter().map(error_at).collect()
    }

    /// How deep the ball was in anything, m, and which wall its centre passed, at any of many points of a run.
    pub(crate) fn deepest_and_crossed(&self, run: &Run) -> (f64, Option<usize>) {
        let scene = &self.table.scene;
        let (radius, origin) = (scene.largest_radius(), scene.origin);
        assert_eq!(origin, run.origin);
        let (mut deepest, mut crossed) = (0.0, None);
        let mut last = run.flights[0].position;
        for pair in run.flights.windows(2) {
            let length = rounded(pair[1].start - pair[0].start);
            for sample in 0..=SAMPLES {
                let place = pair[0].position_at(length * f64::from(sample) / f64::from(SAMPLES));
                for (index, collider) in scene.colliders.iter().enumerate() {
                    let depth = radius - collider.shape.distance(place);
                    deepest = if depth > deepest { depth } else { deepest };
                    if crosses(collider, last, place) {
                        crossed = Some(index);
                    }
                }
                last = place;
            }
        }
        (deepest, crossed)
    }
}

/// Whether the way from `from` to `to` leads through a wall.
fn crosses(collider: &Collider, from: DVec2, to: DVec2) -> bool {
    let Shape::Segment(wall) = &collider.shape else { return false };
    let side = |a: DVec2, b: DVec2, p: DVec2| (b - a).perp_dot(p - a) > 0.0;
    side(wall.a, wall.b, from) != side(wall.a, wall.b, to) && side(from, to, wall.a) != side(from, to, wall.b)
}

impl Stretch {
    /// Distance of the centre at `time` from a place given in digits, m.
    fn distance_at(&self, time: i128, x: &str, y: &str) -> f64 {
        let way = self.way(rounded(time - self.start));
        let start =
            [(x, self.exact_position[0]), (y, self.exact_position[1])].map(|(p, start)| rounded(exact(p) - start));
        (DVec2::from(start) - way).length()
    }
}

/// A place in the file's coordinates, exactly: `local` is in the scene's own.
pub(crate) fn exact_place(origin: DVec2, local: DVec2) -> [i128; 2] {
    [exact_f64(origin.x) + exact_f64(local.x), exact_f64(origin.y) + exact_f64(local.y)]
}
