//! The swept model: within a tick the ball moves along the straight chord of its flight, and the earliest impact on it
//! counts: the answer to the manual's problem 2, which of several obstacles came first. One search a tick, whatever happens.
//!
//! The chord is off the parabola by at most an eighth of acceleration times tick squared.

use glam::DVec2;

use super::super::ball::Flight;
use super::super::impact::{Search, TimeOfImpact, ball_ball, ball_shape, center_passes};
use super::super::scene::Scene;
use super::search::{Found, first_on_path, support_ends};
use super::{MotionModel, Next, Pair, Query, Span};

pub(super) struct Swept;

/// The straight way of a flight within a tick; its start is the tick's.
fn chord(flight: &Flight, tick: Span) -> Flight {
    let position = flight.position_at(tick.from);
    let velocity = (flight.position_at(tick.to) - position) / (tick.to - tick.from);
    Flight { start: flight.start, position, velocity, acceleration: DVec2::ZERO }
}

impl MotionModel for Swept {
    fn next_event(&self, query: &mut Query<'_>) -> Next {
        let (scene, ball, tick) = (query.scene, query.ball, query.tick);
        let flight = &ball.flight;
        if tick.from >= tick.to {
            return Next::ClearUntil(tick.to);
        }
        let chord = chord(flight, tick);
        if chord.velocity == DVec2::ZERO && flight.velocity == DVec2::ZERO && flight.acceleration == DVec2::ZERO {
            return Next::ClearUntil(tick.to);
        }
        let radius = scene.radius(ball.kind);
        let span = Span { from: 0.0, to: tick.to - tick.from };
        let ends = support_ends(scene, ball).map(|t| t - tick.from);
        let (found, _) = first_on_path(query, &chord, span, None, ends, |index, collider, search| {
            let outcome = if collider.role.is_passed() {
                center_passes(&chord, collider, search)
            } else {
                match ball_shape(&chord, radius, &collider.shape, search) {
                    // The ball leaves the surface and comes back to it within the tick: a hop that the chord does not see.
                    TimeOfImpact::Overlapping if tick.from == 0.0 => {
                        ball_shape(flight, radius, &collider.shape, search)
                    }
                    other => other,
                }
            };
            // A straight way meets each shape once: what is past does not hide a later impact.
            let is_past = |t: f64| ball.past.is_some_and(|past| (tick.from + t, index) <= past);
            if outcome.time().is_some_and(is_past) { TimeOfImpact::Separated } else { outcome }
        });
        match found {
            Found::Collider(time, collider) => {
                let hops = tick.from == 0.0 && time > 0.0 && is_touching(&chord, radius, scene, collider);
                let path = if hops { flight } else { &chord };
                Next::Meets { time: tick.from + time, collider, position: path.position_at(time) }
            }
            Found::EndOfSupport(t) if tick.from + t < tick.to => Next::LeavesSupport(tick.from + t),
            Found::EndOfSupport(_) | Found::ClearUntil(_) => Next::ClearUntil(tick.to),
        }
    }

    fn next_meeting(&self, pair: &Pair<'_>) -> Option<f64> {
        let tick = pair.tick;
        if tick.from >= tick.to {
            return None;
        }
        let [one, other] = pair.flights.map(|flight| chord(flight, tick));
        let search = Search::up_to(tick.to - tick.from);
        ball_ball(&one, pair.radii[0], &other, pair.radii[1], &search).time().map(|t| tick.from + t)
    }

    fn parts(&self, _scene: &Scene, _flight: &Flight, _tick: Span) -> Option<u32> {
        None
    }
}

/// Whether the ball touches that collider where the path begins.
fn is_touching(path: &Flight, radius: f64, scene: &Scene, collider: u16) -> bool {
    let shape = &scene.colliders[usize::from(collider)].shape;
    ball_shape(path, radius, shape, &Search::whole()) == TimeOfImpact::Overlapping
}
