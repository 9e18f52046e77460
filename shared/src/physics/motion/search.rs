//! The first event on a path among the static shapes: the way through the broad phase, common to the models that know
//! times of impact.

use super::super::ball::{Ball, Flight, Support};
use super::super::broad_phase::Grid;
use super::super::constants::MOST_PIECES;
use super::super::impact::{Search, TimeOfImpact, leaves_segment};
use super::super::scene::{Collider, Scene};
use super::super::shapes::{Bounds, Shape, Side};
use super::clearance::Clearance;
use super::{Query, Span};

/// Which shapes a search has looked at: a shape that spans several cells is looked at once, a circle once in each piece of
/// the way, and then only as far as that goes: a ball within a large circle is told to be clear of it more cheaply than
/// where it will leave it.
#[derive(Debug, Clone, Default)]
pub(in super::super) struct Scratch {
    /// Of the search's first piece.
    search: u32,
    piece: u32,
    looked_at: Vec<u32>,
    pub(super) clearance: Clearance,
}

impl Scratch {
    pub(in super::super) fn new(colliders: usize) -> Self {
        Self { search: 0, piece: 0, looked_at: vec![0; colliders], clearance: Clearance::default() }
    }

    /// The shapes have changed.
    pub(in super::super) fn forget(&mut self) {
        self.clearance.forget();
    }

    fn begin(&mut self) {
        if self.piece > u32::MAX / 2 {
            self.looked_at.fill(0);
            self.piece = 0;
        }
        self.search = self.piece + 1;
    }

    fn begin_piece(&mut self) {
        self.piece += 1;
    }

    /// Whether it is the first look.
    fn looks_at(&mut self, index: u16, is_circle: bool) -> bool {
        let last = &mut self.looked_at[usize::from(index)];
        let first = *last < if is_circle { self.piece } else { self.search };
        *last = self.piece;
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

impl Found {
    /// When.
    pub(super) fn time(self) -> f64 {
        match self {
            Self::ClearUntil(t) | Self::Collider(t, _) | Self::EndOfSupport(t) => t,
        }
    }
}

/// The earliest event so far. Ties go to the collider of the lowest index.
struct Earliest {
    time: f64,
    index: u32,
    found: Found,
}

impl Earliest {
    /// Takes an impact that is earlier; whether it was.
    fn takes(&mut self, time: f64, index: u16) -> bool {
        let is_earlier = time < self.time || (time == self.time && u32::from(index) < self.index);
        if is_earlier {
            *self = Self { time, index: u32::from(index), found: Found::Collider(time, index) };
        }
        is_earlier
    }
}

/// The first event within `span` of `path`, or beyond it, whose colliders' times `time_of` tells. What happened up to `past`
/// is past, and at `support_ends` that of the ball does. With it the box around the way there, if it was needed.
pub(super) fn first_on_path(
    query: &mut Query<'_>,
    path: &Flight,
    span: Span,
    past: Option<(f64, u16)>,
    support_ends: Option<f64>,
    time_of: impl Fn(u16, &Collider, &Search) -> TimeOfImpact,
) -> (Found, Option<Bounds>) {
    let (scene, state, ball) = (query.scene, query.state, query.ball);
    let (after, past_index) = past.unwrap_or((f64::NEG_INFINITY, 0));
    let mut earliest = Earliest { time: f64::INFINITY, index: u32::MAX, found: Found::ClearUntil(f64::INFINITY) };
    if let Some(t) = support_ends {
        let time = if t > span.from { t } else { span.from };
        earliest = Earliest { time, found: Found::EndOfSupport(time), ..earliest };
    }
    // When a shape is met, if that is of interest: not after `end`.
    let look_at = |index: u16, collider: &Collider, end: f64| {
        let is_support = ball.support != Support::None && is_part_of_support(scene, ball.support, index);
        if is_support || collider.floor != ball.floor || !state.has(collider) {
            return None;
        }
        let search = Search { before: end.next_up(), after, strictly: index <= past_index };
        time_of(index, collider, &search).time()
    };
    match &scene.grid {
        Some(grid) => (along_cells(query.scratch, scene, grid, path, span, earliest, look_at), None),
        None => among_all(scene, path, span, earliest, look_at),
    }
}

/// Few shapes: one after the other, all the way.
fn among_all(
    scene: &Scene,
    path: &Flight,
    span: Span,
    mut earliest: Earliest,
    look_at: impl Fn(u16, &Collider, f64) -> Option<f64>,
) -> (Found, Option<Bounds>) {
    // The box around the way up to the earliest event, once there is an end to it.
    let way_until = |end: f64| Bounds::of_flight(path, span.from, if end > span.from { end } else { span.from });
    let mut around = (span.to < f64::INFINITY).then(|| way_until(span.to));
    for (index, collider) in (0..).zip(&scene.colliders) {
        if around.is_none_or(|around| around.meets(&collider.bounds))
            && let Some(time) = look_at(index, collider, earlier(earliest.time, span.to))
            && earliest.takes(time, index)
            && time < span.to
        {
            around = Some(way_until(time));
        }
    }
    if earliest.time <= span.to && earliest.time < f64::INFINITY {
        return (earliest.found, around);
    }
    // It meets nothing: it may leave the scene, and is asked for again on the way.
    let to = span.from + piece(path, span.from, scene.bounds.extent());
    (Found::ClearUntil(if to < span.to { to } else { span.to }), None)
}

/// Many shapes: those in the cells along the way, piece by piece.
fn along_cells(
    scratch: &mut Scratch,
    scene: &Scene,
    grid: &Grid,
    path: &Flight,
    span: Span,
    mut earliest: Earliest,
    look_at: impl Fn(u16, &Collider, f64) -> Option<f64>,
) -> Found {
    scratch.begin();
    let mut from = span.from;
    for _ in 0..MOST_PIECES {
        let to = from + piece(path, from, grid.cell());
        let to = if to < span.to { to } else { span.to };
        let mut end = if to < earliest.time { to } else { earliest.time };
        let mut around = Bounds::of_flight(path, from, end);
        let reached = around;
        scratch.begin_piece();
        grid.visit(&reached, |index| {
            let collider = &scene.colliders[usize::from(index)];
            let is_circle = matches!(collider.shape, Shape::Arc(arc) if arc.radius > 0.0);
            if around.meets(&collider.bounds)
                && scratch.looks_at(index, is_circle)
                && let Some(time) =
                    look_at(index, collider, earlier(earliest.time, if is_circle { to } else { span.to }))
                && earliest.takes(time, index)
                && time < end
            {
                end = if time > from { time } else { from };
                around = Bounds::of_flight(path, from, end);
            }
        });
        if earliest.time <= to {
            return earliest.found;
        }
        if to >= span.to || !scene.bounds.meets(&reached) {
            return Found::ClearUntil(to);
        }
        from = to;
    }
    Found::ClearUntil(from)
}

fn earlier(a: f64, b: f64) -> f64 {
    if a < b { a } else { b }
}

/// When a ball that lies on something reaches the end of it, or grips it after sliding; seconds since its flight's start.
pub(super) fn support_ends(scene: &Scene, ball: &Ball) -> Option<f64> {
    let grips = ball.slide.and_then(|slide| slide.until);
    let leaves = match (ball.support, ball.support_collider(scene).map(|collider| &collider.shape)) {
        (Support::Line(_), Some(Shape::Segment(segment))) => {
            leaves_segment(&ball.flight, segment, &Search::whole()).time()
        }
        _ => None,
    };
    match (grips, leaves) {
        (Some(a), Some(b)) => Some(earlier(a, b)),
        (one, None) | (None, one) => one,
    }
}

/// Seconds from `from` on in which a path goes about `length` metres.
fn piece(path: &Flight, from: f64, length: f64) -> f64 {
    let (speed, pull) = (path.velocity_at(from).length(), path.acceleration.length());
    2.0 * length / (speed + (speed * speed + 2.0 * pull * length).sqrt())
}

/// Whether a collider is what the ball lies on, the same surface again, or the smooth end of it.
pub(super) fn is_part_of_support(scene: &Scene, support: Support, collider: u16) -> bool {
    let shape = |i: u16| &scene.colliders[usize::from(i)].shape;
    let is_same = |i: u16| i == collider || shape(i) == shape(collider);
    match support {
        Support::Line(line) => {
            is_same(line)
                || matches!((shape(line), shape(collider)), (Shape::Segment(s), Shape::Arc(a)) if s.continues_into(a))
        }
        Support::Arc(arc) => {
            is_same(arc)
                || match (shape(arc), shape(collider)) {
                    (Shape::Arc(arc), Shape::Arc(point)) => arc.has_point(point),
                    // From a hollow the ball is handed over to the straight part when it has passed the arc's end.
                    (Shape::Arc(arc), Shape::Segment(s)) => arc.side == Side::Inside && s.continues_into(arc),
                    _ => false,
                }
        }
        Support::Wedge(a, b) => is_same(a) || is_same(b),
        Support::None | Support::Stalled | Support::Flipper(_) | Support::Plunger(_) => false,
        Support::Held(_) | Support::Released(_) => false,
    }
}
