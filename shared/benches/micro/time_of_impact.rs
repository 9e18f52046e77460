//! The time of impact of a flight under gravity with one shape.
//!
//! Flights are aimed at random points of the box around the shape, since that is what the engine's broad phase lets
//! through: a `miss` comes through this box and yet does not touch the shape. What is met from inside has flights from
//! all over its inside.

use divan::{Bencher, black_box};
use glam::DVec2;
use shared::math::{Rng, direction};
use shared::physics::ball::{Flight, Instant};
use shared::physics::impact::{Search, TimeOfImpact, ball_ball, ball_shape};
use shared::physics::shapes::{Arc, Bounds, Segment, Shape, Side};

use super::inputs::{INPUTS, Round};

/// Of a ball, m.
const RADIUS: f64 = 0.0135;
/// Classic's.
const GRAVITY: DVec2 = DVec2::new(0.0, -0.793);
/// The corners of a playfield, m.
const FIELD: Bounds = Bounds { low: DVec2::ZERO, high: DVec2::new(0.514, 1.067) };
/// Of the balls, m/s.
const SPEEDS: (f64, f64) = (0.3, 4.0);
/// Calls in a sample: each input as often as any other.
const SAMPLE: u32 = 4 * INPUTS as u32;
/// Samples, of which the median counts.
const SAMPLES: u32 = 500;

fn place_in(rng: &mut Rng, bounds: Bounds) -> DVec2 {
    DVec2::new(rng.between(bounds.low.x, bounds.high.x), rng.between(bounds.low.y, bounds.high.y))
}

/// From somewhere in `field` outside of `bounds`, through a random point of `bounds`.
fn aimed(rng: &mut Rng, field: Bounds, bounds: Bounds, acceleration: DVec2) -> Flight {
    let position = loop {
        let place = place_in(rng, field);
        if !bounds.contains(place) {
            break place;
        }
    };
    let way = place_in(rng, bounds) - position;
    let time = way.length() / rng.between(SPEEDS.0, SPEEDS.1);
    let velocity = way / time - acceleration * (0.5 * time);
    Flight { start: Instant::start_of(0), position, velocity, acceleration }
}

/// From somewhere inside a circle, in any direction.
fn from_inside(rng: &mut Rng, arc: &Arc) -> Flight {
    let mut turned = |length: f64| direction(rng.between(0.0, core::f64::consts::TAU)) * length;
    let (place, heading) = (turned(arc.reach(RADIUS)), turned(1.0));
    let position = arc.center + place * rng.between(0.0, 0.95);
    let velocity = heading * rng.between(SPEEDS.0, SPEEDS.1);
    Flight { start: Instant::start_of(0), position, velocity, acceleration: GRAVITY }
}

/// Times searches that all end as wanted.
fn time(bencher: Bencher<'_, '_>, shape: Shape, hits: bool) {
    let search = Search::whole();
    let draw = |rng: &mut Rng| match &shape {
        Shape::Arc(arc) if arc.side == Side::Inside => from_inside(rng, arc),
        _ => aimed(rng, FIELD, shape.bounds(RADIUS), GRAVITY),
    };
    let is_wanted = |flight: &Flight| is_it(ball_shape(flight, RADIUS, &shape, &search), hits);
    let mut flights = Round::drawn(draw, is_wanted);
    bencher.bench_local(|| ball_shape(black_box(flights.next()), black_box(RADIUS), black_box(&shape), &search));
}

/// Whether an outcome is a hit later than at the flight's start, or a miss.
fn is_it(outcome: TimeOfImpact, hits: bool) -> bool {
    match outcome {
        TimeOfImpact::Impact(time) => hits && time > 0.0,
        TimeOfImpact::Separated => !hits,
        TimeOfImpact::Overlapping => false,
    }
}

fn outside(radius: f64) -> Shape {
    Shape::Arc(Arc { center: DVec2::new(0.25, 0.5), radius, side: Side::Outside, span: None })
}

/// As large as the arch at the top of Classic.
fn inside(span: Option<(DVec2, f64)>) -> Shape {
    Shape::Arc(Arc { center: DVec2::new(0.257, 0.81), radius: 0.257, side: Side::Inside, span })
}

/// What the loop itself costs, which all the others have on top.
#[divan::bench(sample_size = SAMPLE, sample_count = SAMPLES)]
fn nothing(bencher: Bencher<'_, '_>) {
    let mut flights = Round::drawn(|rng| aimed(rng, FIELD, outside(0.02).bounds(RADIUS), GRAVITY), |_| true);
    bencher.bench_local(|| black_box(flights.next()).position.x);
}

#[divan::bench_group(sample_size = SAMPLE, sample_count = SAMPLES)]
mod ball_segment {
    use super::*;

    fn slope() -> Shape {
        Shape::Segment(Segment::new(DVec2::new(0.2, 0.45), DVec2::new(0.32, 0.6)))
    }

    #[divan::bench]
    fn hit(bencher: Bencher<'_, '_>) {
        time(bencher, slope(), true);
    }

    #[divan::bench]
    fn miss(bencher: Bencher<'_, '_>) {
        time(bencher, slope(), false);
    }
}

#[divan::bench_group(sample_size = SAMPLE, sample_count = SAMPLES)]
mod ball_post {
    use super::*;

    #[divan::bench]
    fn hit(bencher: Bencher<'_, '_>) {
        time(bencher, outside(0.02), true);
    }

    #[divan::bench]
    fn miss(bencher: Bencher<'_, '_>) {
        time(bencher, outside(0.02), false);
    }
}

/// The end of a wall.
#[divan::bench_group(sample_size = SAMPLE, sample_count = SAMPLES)]
mod ball_point {
    use super::*;

    #[divan::bench]
    fn hit(bencher: Bencher<'_, '_>) {
        time(bencher, outside(0.0), true);
    }

    #[divan::bench]
    fn miss(bencher: Bencher<'_, '_>) {
        time(bencher, outside(0.0), false);
    }
}

/// From inside, a whole circle is always met.
#[divan::bench_group(sample_size = SAMPLE, sample_count = SAMPLES)]
mod ball_ring {
    use super::*;

    #[divan::bench]
    fn hit(bencher: Bencher<'_, '_>) {
        time(bencher, inside(None), true);
    }
}

/// The upper half of a circle, from inside: what misses it falls out through the lower half.
#[divan::bench_group(sample_size = SAMPLE, sample_count = SAMPLES)]
mod ball_arc {
    use super::*;

    const UPPER_HALF: Option<(DVec2, f64)> = Some((DVec2::Y, 0.0));

    #[divan::bench]
    fn hit(bencher: Bencher<'_, '_>) {
        time(bencher, inside(UPPER_HALF), true);
    }

    #[divan::bench]
    fn miss(bencher: Bencher<'_, '_>) {
        time(bencher, inside(UPPER_HALF), false);
    }
}

#[divan::bench_group(sample_size = SAMPLE, sample_count = SAMPLES)]
mod ball_ball {
    use super::*;

    /// Times pairs of a flying ball and another one that flies as well, or lies still: seen from each other, their way
    /// is straight in the first case and curved in the second.
    fn time_pairs(bencher: Bencher<'_, '_>, both_fly: bool, hits: bool) {
        let search = Search::whole();
        let reach = Bounds { low: DVec2::ZERO, high: DVec2::ZERO }.grown(2.0 * RADIUS);
        let around = Bounds { low: DVec2::splat(-0.3), high: DVec2::splat(0.3) };
        let draw = |rng: &mut Rng| {
            let other = if both_fly {
                aimed(rng, FIELD, outside(0.1).bounds(RADIUS), GRAVITY)
            } else {
                let (start, position) = (Instant::start_of(0), place_in(rng, FIELD));
                Flight { start, position, velocity: DVec2::ZERO, acceleration: DVec2::ZERO }
            };
            let seen = aimed(rng, around, reach, GRAVITY - other.acceleration);
            let one = Flight {
                position: other.position + seen.position,
                velocity: other.velocity + seen.velocity,
                acceleration: GRAVITY,
                ..other
            };
            (one, other)
        };
        let is_wanted =
            |(one, other): &(Flight, Flight)| is_it(super::ball_ball(one, RADIUS, other, RADIUS, &search), hits);
        let mut pairs = Round::drawn(draw, is_wanted);
        bencher.bench_local(|| {
            let (one, other) = black_box(pairs.next());
            super::ball_ball(one, black_box(RADIUS), other, black_box(RADIUS), &search)
        });
    }

    #[divan::bench]
    fn hit(bencher: Bencher<'_, '_>) {
        time_pairs(bencher, true, true);
    }

    #[divan::bench]
    fn miss(bencher: Bencher<'_, '_>) {
        time_pairs(bencher, true, false);
    }

    #[divan::bench]
    fn hit_at_rest(bencher: Bencher<'_, '_>) {
        time_pairs(bencher, false, true);
    }

    #[divan::bench]
    fn miss_at_rest(bencher: Bencher<'_, '_>) {
        time_pairs(bencher, false, false);
    }
}
