//! What the models that only look now and then have in common: a test for overlap at each moment of a tick at which they
//! look, and the replacement of what overlaps.
//!
//! They look at the end of each part of a tick, after the ball has moved: the last time at the tick's own end, so that
//! what a tick leaves is corrected already. At its beginning they look only where a flight begins.

use glam::DVec2;

use super::super::impact::{Search, center_passes};
use super::super::shapes::{Bounds, Shape, Side};
use super::search::{is_part_of_support, support_ends};
use super::{Next, Pair, Query, Span};

/// What a ball overlaps: how deep, m, and where it has to be placed.
#[derive(Debug, Clone, Copy, PartialEq)]
struct Overlap {
    depth: f64,
    placed: DVec2,
}

/// The first of the moments between the tick's `parts` at which the ball overlaps something that it approaches, or the sensor
/// that it passes before.
pub(super) fn next_event(query: &mut Query<'_>, parts: u32) -> Next {
    let (scene, state, ball, tick) = (query.scene, query.state, query.ball, query.tick);
    let flight = &ball.flight;
    let (past, past_index) = ball.past.unwrap_or((f64::NEG_INFINITY, 0));
    let (mut limit, mut passed) = (tick.to, None);
    // 1. What the centre passes, and the end of what the ball lies on: these are no obstacles, and their times are known.
    if let Some(t) = support_ends(scene, ball).filter(|&t| t < tick.to) {
        limit = if t > tick.from { t } else { tick.from };
        passed = Some(Next::LeavesSupport(limit));
    }
    if scene.needs.sensors {
        let around = Bounds::of_flight(flight, tick.from, tick.to);
        each_near(query, &around, |index| {
            let collider = &scene.colliders[usize::from(index)];
            if collider.role.is_passed() && state.has(collider) && collider.floor == ball.floor {
                let search = Search { before: limit, after: past, strictly: index <= past_index };
                if let Some(time) = center_passes(flight, collider, &search).time() {
                    limit = time;
                    passed = Some(Next::Meets { time, collider: index, position: flight.position_at(time) });
                }
            }
        });
    }
    // 2. What the ball overlaps, one part after the other.
    let radius = scene.radius(ball.kind);
    let step = (tick.to - tick.from) / f64::from(parts);
    // At a tick's beginning it was looked at the end of the last one, unless the flight begins there.
    let first = u32::from(tick.from > 0.0);
    for moment in first..=parts {
        let t = moment_of(tick, moment, parts);
        if t >= limit && passed.is_some() {
            break;
        }
        if t < past {
            continue;
        }
        let (position, velocity) = (flight.position_at(t), flight.velocity_at(t));
        // A flight begins where the last impact left the ball: no side but that one is where it came from.
        let before = if t > step { flight.position_at(t - step) } else { flight.position };
        let mut deepest: Option<(f64, u16, DVec2)> = None;
        each_near(query, &Bounds { low: position, high: position }, |index| {
            let collider = &scene.colliders[usize::from(index)];
            if collider.role.is_passed()
                || collider.floor != ball.floor
                || !collider.bounds.contains(position)
                || !state.has(collider)
                || is_part_of_support(scene, ball.support, index)
                || (t == past && index <= past_index)
            {
                return;
            }
            if let Some(overlap) = overlap_at(&collider.shape, radius, before, position, velocity)
                && deepest
                    .is_none_or(|(depth, other, _)| overlap.depth > depth || (overlap.depth == depth && index < other))
            {
                deepest = Some((overlap.depth, index, overlap.placed));
            }
        });
        if let Some((_, collider, position)) = deepest {
            return Next::Meets { time: t, collider, position };
        }
    }
    passed.unwrap_or(Next::ClearUntil(tick.to))
}

/// The end of the tick's first `moment` of `parts` parts; of the last one, the tick's own.
fn moment_of(tick: Span, moment: u32, parts: u32) -> f64 {
    if moment == parts { tick.to } else { tick.from + (tick.to - tick.from) / f64::from(parts) * f64::from(moment) }
}

/// Every collider near a box, each once or more often.
fn each_near(query: &Query<'_>, around: &Bounds, mut visit: impl FnMut(u16)) {
    match &query.scene.grid {
        Some(grid) => grid.visit(around, visit),
        None => (0..query.scene.colliders.len() as u16).for_each(&mut visit),
    }
}

/// Whether a ball at `position` that was at `before` overlaps a shape and approaches it: replaced at the nearest point, on the
/// side that it came from.
fn overlap_at(shape: &Shape, radius: f64, before: DVec2, position: DVec2, velocity: DVec2) -> Option<Overlap> {
    let (normal, gap) = match shape {
        Shape::Segment(segment) => {
            let offset = position - segment.a;
            let along = segment.along.dot(offset);
            if along < 0.0 || along > segment.length {
                return None;
            }
            let was = segment.height(before);
            if segment.one_way && was > 0.0 {
                return None;
            }
            let normal = if was < 0.0 || segment.one_way { -segment.normal } else { segment.normal };
            let height = normal.dot(position - segment.middle);
            // Farther on the other side it no longer overlaps: it has passed.
            if height <= -radius {
                return None;
            }
            (normal, height - radius)
        }
        Shape::Arc(arc) => {
            let offset = position - arc.center;
            let (distance, was) = (offset.length(), (before - arc.center).length());
            // A ball is not inside what is smaller than itself.
            if arc.reach(radius) < 0.0 {
                return None;
            }
            let came_from_here = match arc.side {
                Side::Outside => was >= arc.radius,
                Side::Inside => was <= arc.radius && distance < arc.radius + radius,
            };
            if !came_from_here || !arc.spans(offset) {
                return None;
            }
            (shape.normal_at(position), arc.sign() * (distance - arc.reach(radius)))
        }
    };
    (gap < 0.0 && velocity.dot(normal) < 0.0).then(|| Overlap { depth: -gap, placed: position - normal * gap })
}

/// The first of the moments between the tick's `parts` at which two balls overlap and approach each other.
pub(super) fn next_meeting(pair: &Pair<'_>, parts: u32) -> Option<f64> {
    let ([one, other], tick) = (pair.flights, pair.tick);
    let reach = pair.radii[0] + pair.radii[1];
    (0..=parts).map(|moment| moment_of(tick, moment, parts)).find(|&t| {
        let apart = one.position_at(t) - other.position_at(t);
        let closing = apart.dot(one.velocity_at(t) - other.velocity_at(t));
        apart.length() < reach && closing < 0.0
    })
}
