//! The discrete model: once a tick, after the move, it looks whether the ball overlaps something. What is thinner than a step
//! it may miss: the manual's problem 1.

use super::super::ball::Flight;
use super::super::scene::Scene;
use super::{MotionModel, Next, Pair, Query, Span, sampled};

pub(super) struct Discrete;

impl MotionModel for Discrete {
    fn next_event(&self, query: &mut Query<'_>) -> Next {
        sampled::next_event(query, 1)
    }

    fn next_meeting(&self, pair: &Pair<'_>) -> Option<f64> {
        sampled::next_meeting(pair, 1)
    }

    fn parts(&self, _scene: &Scene, _flight: &Flight, _tick: Span) -> Option<u32> {
        Some(1)
    }
}
