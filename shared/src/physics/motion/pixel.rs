//! The pixel model: the manual's second. A tick is cut into parts in which the ball moves by at most one pixel, and after
//! each part it is tested against everything.
//!
//! The manual repeats its unit step `|vx|` times, which divides by zero when the ball falls straight down; here the
//! dominant axis counts. Gravity is shared out over the parts and stays in the velocity.

use super::super::ball::Flight;
use super::super::constants::MOST_PARTS_PER_TICK;
use super::super::scene::Scene;
use super::{MotionModel, Next, Pair, Query, Span, sampled};

pub(super) struct Pixel;

/// Parts of a tick in each of which no coordinate changes by more than a pixel.
fn parts(scene: &Scene, flight: &Flight, tick: Span) -> u32 {
    let (first, last) = (flight.velocity_at(tick.from).abs(), flight.velocity_at(tick.to).abs());
    let fastest = first.max(last).max_element();
    let pixels = (fastest * (tick.to - tick.from) / scene.pixel).ceil();
    // A cast saturates.
    (pixels as u32).clamp(1, MOST_PARTS_PER_TICK)
}

impl MotionModel for Pixel {
    fn next_event(&self, query: &mut Query<'_>) -> Next {
        let parts = parts(query.scene, &query.ball.flight, query.tick);
        sampled::next_event(query, parts)
    }

    fn next_meeting(&self, pair: &Pair<'_>) -> Option<f64> {
        let [one, other] = pair.flights.map(|flight| parts(pair.scene, flight, pair.tick));
        sampled::next_meeting(pair, one.max(other))
    }

    fn parts(&self, scene: &Scene, flight: &Flight, tick: Span) -> Option<u32> {
        Some(parts(scene, flight, tick))
    }
}
