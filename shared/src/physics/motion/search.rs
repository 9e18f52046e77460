//! The first event on a path among the static shapes: the way through the broad phase, common to the models that know
//! times of impact.

use super::super::ball::{Ball, Flight, Support};
use super::super::constants::MOST_PIECES;
use super::super::impact::{Search, TimeOfImpact, leaves_segment};
use super::super::scene::{Collider, Scene};
use super::super::shapes::{Bounds, Shape, Side};
use super::{Query, Span};

/// Which shapes a search has looked at: a shape that spans several cells is looked at once.
#[derive(Debug, Clone, Default)]
pub(in super::super) struct Scratch {
    search: u32,
    looked_at: Vec<u32>,
}

impl Scratch {
    pub(in super::super) fn new(colliders: usize) -> Self {
        Self { search: 0, looked_at: vec![0; colliders] }
    }

    fn begin(&mut self) {
        self.search = self.search.wrapping_add(1);
        if self.search == 0 {
            self.looked_at.fill(0);
            self.search = 1;
        }
    }

    /// Whether it is the first look.
    fn looks_at(&mut self, index: u16) -> bool {
        let last = &mut self.looked_at[usize::from(index)];
        let first = *last != self.search;
        *last = self.search;
        first
    }
}

/// What a search found.
#[derive(Debug, Clone, Copy, PartialEq)]
pub(super) enum Found {
    /// Nothing before that time.
    ClearUntil(f64),
    /// That collider, at that time.
    Collider(f64, u16),
    /// The end of the support, at that time.
    EndOfSupport(f64),
}

/// The first event within `span` of `path`, or beyond it, whose colliders' times `time_of` tells. What happened up to `past`
/// is past, and at `support_ends` that of the ball does. Ties go to the collider of the lowest index.
pub(super) fn first_on_path(
    query: &mut Query<'_>,
    path: &Flight,
    span: Span,
    past: Option<(f64, u16)>,
    support_ends: Option<f64>,
    time_of: impl Fn(u16, &Collider, &Search) -> TimeOfImpact,
) -> Found {
    let (scene, state, ball) = (query.scene, query.state, query.ball);
    let scratch = &mut *query.scratch;
    scratch.begin();
    let (after, past_index) = past.unwrap_or((f64::NEG_INFINITY, 0));
    let mut found = Found::ClearUntil(f64::INFINITY);
    let (mut limit, mut limit_index) = (f64::INFINITY, u32::MAX);
    if let Some(t) = support_ends {
        let t = if t > span.from { t } else { span.from };
        (limit, found) = (t, Found::EndOfSupport(t));
    }
    let mut from = span.from;
    for _ in 0..MOST_PIECES {
        let to = from + piece(path, scene, from);
        let to = if to < span.to { to } else { span.to };
        let mut end = if to < limit { to } else { limit };
        let mut around = Bounds::of_flight(path, from, end);
        let reached = around;
        let mut look_at = |index: u16| {
            let collider = &scene.colliders[usize::from(index)];
            if !around.meets(&collider.bounds)
                || collider.floor != ball.floor
                || !scratch.looks_at(index)
                || !state.has(collider)
                || is_part_of_support(scene, ball.support, index)
            {
                return;
            }
            let search = Search { before: limit.next_up(), after, strictly: index <= past_index };
            if let Some(t) = time_of(index, collider, &search).time()
                && (t < limit || (t == limit && u32::from(index) < limit_index))
            {
                (limit, limit_index, found) = (t, u32::from(index), Found::Collider(t, index));
                if t < end {
                    end = if t > from { t } else { from };
                    around = Bounds::of_flight(path, from, end);
                }
            }
        };
        match &scene.grid {
            Some(grid) => grid.visit(&reached, &mut look_at),
            None => (0..scene.colliders.len() as u16).for_each(&mut look_at),
        }
        if limit <= to {
            return found;
        }
        if to >= span.to || !scene.bounds.meets(&reached) {
            return Found::ClearUntil(to);
        }
        from = to;
    }
    Found::ClearUntil(from)
}

/// When a ball reaches the end of the straight surface that it lies on, seconds since its flight's start.
pub(super) fn support_ends(scene: &Scene, ball: &Ball) -> Option<f64> {
    let Support::Line(index) = ball.support else { return None };
    let Shape::Segment(segment) = &scene.colliders[usize::from(index)].shape else { return None };
    leaves_segment(&ball.flight, segment, &Search::whole()).time()
}

/// Seconds from `from` on in which a path goes about as far as a cell of the grid is wide; without a grid, about as far as
/// the scene is.
fn piece(path: &Flight, scene: &Scene, from: f64) -> f64 {
    let length = scene.grid.as_ref().map_or_else(|| scene.bounds.extent(), super::super::broad_phase::Grid::cell);
    let (speed, pull) = (path.velocity_at(from).length(), path.acceleration.length());
    2.0 * length / (speed + (speed * speed + 2.0 * pull * length).sqrt())
}

/// Whether a collider is what the ball lies on, or the smooth end of it.
pub(super) fn is_part_of_support(scene: &Scene, support: Support, collider: u16) -> bool {
    let shape = |i: u16| &scene.colliders[usize::from(i)].shape;
    match support {
        Support::Line(line) => {
            line == collider
                || matches!((shape(line), shape(collider)), (Shape::Segment(s), Shape::Arc(a)) if s.continues_into(a))
        }
        Support::Arc(arc) => {
            arc == collider
                || match (shape(arc), shape(collider)) {
                    (Shape::Arc(arc), Shape::Arc(point)) => arc.has_point(point),
                    // From a hollow the ball is handed over to the straight part when it has passed the arc's end.
                    (Shape::Arc(arc), Shape::Segment(s)) => arc.side == Side::Inside && s.continues_into(arc),
                    _ => false,
                }
        }
        Support::Wedge(a, b) => a == collider || b == collider,
        Support::None | Support::Stalled | Support::Flipper(_) | Support::Plunger(_) => false,
    }
}
