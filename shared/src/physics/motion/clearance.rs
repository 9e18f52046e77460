//! A ball that follows a surface begins a new flight with every tick, and hardly ever meets anything in it: once it is known
//! how far the next shape is, its flights are clear of all of them until it has gone that far.

use glam::DVec2;

use super::super::ball::{Ball, Flight, Support};
use super::super::broad_phase::Grid;
use super::super::constants::DEEPEST_OVERLAP;
use super::super::impact::touch_gap;
use super::super::scene::Scene;
use super::super::shapes::{Bounds, Shape};
use super::super::state::WorldState;
use super::Span;
use super::search::is_part_of_support;

/// Of how many balls it is remembered at once.
const REMEMBERED: usize = 4;
/// Share of a way for which a ball is relied on to be clear: the rest is for rounding.
const RELIED_ON: f64 = 0.999;

/// Ball radii that a ball goes between two looks around.
const LOOKS_AGAIN: f64 = 0.25;

/// Around a place, where a ball was, it touches nothing but what it lies on.
#[derive(Debug, Clone, Copy)]
struct Clear {
    ball: u32,
    support: Support,
    floor: u8,
    place: DVec2,
    /// m.
    radius: f64,
}

/// What is known of some balls, as long as the shapes stay. Can be recomputed.
#[derive(Debug, Clone, Default)]
pub(super) struct Clearance {
    known: [Option<Clear>; REMEMBERED],
}

impl Clearance {
    /// The shapes have changed.
    pub(super) fn forget(&mut self) {
        self.known = [None; REMEMBERED];
    }

    /// Whether nothing but its support can be touched on a ball's flight within `span`.
    pub(super) fn is_clear(&mut self, scene: &Scene, grid: &Grid, state: &WorldState, ball: &Ball, span: Span) -> bool {
        let (from, length) = (ball.flight.position_at(span.from), longest_way(&ball.flight, span));
        let known = &mut self.known[ball.id as usize % REMEMBERED];
        let is_within = |clear: &Clear| (from - clear.place).length() + length < RELIED_ON * clear.radius;
        if let Some(clear) = known
            && (clear.ball, clear.support, clear.floor) == (ball.id, ball.support, ball.floor)
        {
            let is_known = is_within(clear);
            // Near a shape it is not worth another look before it has gone on a little.
            if is_known || (from - clear.place).length() < LOOKS_AGAIN * scene.radius(ball.kind) {
                return is_known;
            }
        }
        let clear = look_around(scene, grid, state, ball, from);
        *known = Some(clear);
        is_within(&clear)
    }
}

/// No less than the way of a flight within `span`, m.
fn longest_way(flight: &Flight, span: Span) -> f64 {
    let length = span.to - span.from;
    (flight.velocity_at(span.from).length() + flight.acceleration.length() * length) * length
}

/// How far a ball at `place` can go in any direction.
fn look_around(scene: &Scene, grid: &Grid, state: &WorldState, ball: &Ball, place: DVec2) -> Clear {
    let size = scene.radius(ball.kind);
    let mut radius = 0.5 * grid.cell();
    grid.visit(&Bounds { low: place, high: place }.grown(radius), |index| {
        let collider = &scene.colliders[usize::from(index)];
        if collider.floor != ball.floor || !state.has(collider) || is_part_of_support(scene, ball.support, index) {
            return;
        }
        let way = match collider.shape {
            // A piece of an arc counts as its whole circle.
            Shape::Arc(arc) if !collider.role.is_passed() => {
                let gap = arc.sign() * ((place - arc.center).length() - arc.reach(size));
                // From its other side it cannot be met before the ball has gone through it.
                if gap < -DEEPEST_OVERLAP * size { -gap - DEEPEST_OVERLAP * size } else { gap }
            }
            Shape::Arc(arc) => ((place - arc.center).length() - arc.radius).abs(),
            segment @ Shape::Segment(_) => segment.distance(place) - size,
        };
        radius = if way < radius { way } else { radius };
    });
    // What is as near as this is in touch already.
    let radius = radius - 2.0 * touch_gap(&ball.flight, size);
    Clear { ball: ball.id, support: ball.support, floor: ball.floor, place, radius }
}
