//! What each ball will meet next: a copy of the world is stepped until it has happened.
//!
//! The world alone is asked. What somebody at the flippers will do, or the rules, it cannot know.

use glam::DVec2;

use super::track::{Impact, Track, Tracks};
use crate::physics::ball::Instant;
use crate::physics::{Event, EventKind, World};

/// A ball's way up to its next impact.
#[derive(Debug, Clone, PartialEq)]
pub struct Foresight {
    /// The ball's id.
    pub ball: u32,
    /// A line through these, m: from where the ball is now to where it meets something, or as far as was looked.
    pub points: Vec<DVec2>,
    /// What it passes on the way.
    pub passes: Vec<Event>,
    /// What ends it, if that was found.
    pub impact: Option<Impact>,
}

/// What the balls of a world meet next, from `from` on, which must be in the world's present tick; nothing is looked for
/// beyond `seconds` of world time. In the order of the balls' ids.
pub fn foresee(world: &World, from: Instant, seconds: f64) -> Vec<Foresight> {
    let mut tracks = Tracks::begin(world, from, true);
    let mut world = world.clone();
    // A cast saturates.
    for _ in 0..(seconds / world.scene().tick_seconds).ceil() as u64 {
        if tracks.are_closed() {
            break;
        }
        world.step();
        tracks.after_step(&world);
    }
    tracks.finish(&world).into_iter().map(Foresight::of).collect()
}

impl Foresight {
    fn of(track: Track) -> Self {
        let Track { ball, points, mut impacts, .. } = track;
        let is_pass = |impact: &Impact| matches!(impact.event.kind, EventKind::Passed { .. });
        let impact = impacts.pop_if(|impact| !is_pass(impact));
        Self { ball, points, passes: impacts.iter().map(|pass| pass.event).collect(), impact }
    }
}

/// The unit normal of what a ball met in the world's last step, towards the ball; `None` where it met nothing.
///
/// Events do not tell it, since no rule asks for it: it is worked out from where the ball was.
pub fn normal_of(world: &World, event: &Event) -> Option<DVec2> {
    let element = match event.kind {
        EventKind::Touched { element, .. }
        | EventKind::Kicked { element, .. }
        | EventKind::Felled { element, .. }
        | EventKind::Struck { element, .. } => element,
        EventKind::Met { other, .. } => {
            // The other one tells of the same meeting.
            let is_other = |told: &&Event| {
                let met = matches!(told.kind, EventKind::Met { other, .. } if other == event.ball);
                told.ball == other && told.at == event.at && met
            };
            let other = world.events().iter().find(is_other)?;
            return (event.position - other.position).try_normalize();
        }
        _ => return None,
    };
    let (scene, state) = (world.scene(), world.state());
    let ball = state.balls.iter().find(|ball| ball.id == event.ball);
    let radius = ball.map_or(scene.largest_radius(), |ball| scene.radius(ball.kind));
    let position = event.position;
    // Of all surfaces of the element, the one that the ball touched just then. A target that fell counts, too.
    let surfaces = scene.colliders.iter().filter(|collider| collider.element == element);
    let fixed = surfaces.map(|collider| (collider.shape.distance(position), collider.shape.normal_at(position)));
    let flippers = scene.flippers.iter().zip(&state.flippers).filter(|(spec, _)| spec.element == element);
    let flippers = flippers.map(|(spec, flipper)| {
        let nearest = spec.nearest(spec.direction(flipper.swing), position);
        (nearest.distance, nearest.normal)
    });
    let plungers = scene.plungers.iter().zip(&state.plungers).filter(|(spec, _)| spec.element == element);
    let plungers = plungers.map(|(spec, plunger)| (spec.distance(plunger.pull, position), spec.normal));
    let touching = fixed.chain(flippers).chain(plungers);
    let nearest = touching.min_by(|a, b| (a.0 - radius).abs().total_cmp(&(b.0 - radius).abs()));
    nearest.map(|(_, normal)| normal)
}
