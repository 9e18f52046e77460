//! Edges between floors, and a ball that is turned back on one.
//!
//! A flight that begins on an edge has crossed it, whatever rounding says. But on the floor to which it comes a ball may meet
//! another at that very instant, which was no obstacle to it before, and be thrown back: then it has not crossed after all.

use glam::DVec2;

use super::ball::{Flight, Instant};
use super::impact::touch_gap;
use super::scene::{Collider, Role};
use super::shapes::Shape;
use super::world::World;

impl World {
    /// A ball is about to leave `position` with another velocity. If it crossed an edge there in this very instant, and now heads
    /// back, it is on the floor that it came from.
    pub(super) fn turn_back_on_edge(&mut self, ball: usize, offset: f64, position: DVec2, velocity: DVec2) {
        let subject = &self.state.balls[ball];
        let before = subject.flight;
        let now = Instant { tick: self.state.tick, offset };
        if now.since(before.start, self.scene.tick_seconds) > 0.0 || before.position != position {
            return;
        }
        let back = self.scene.colliders.iter().find_map(|collider| {
            let Collider { shape: Shape::Segment(line), role: Role::Hole { to }, floor, .. } = collider else {
                return None;
            };
            let is_on_it = line.height(position).abs() <= touch_gap(&before, 0.0);
            let along = line.along.dot(position - line.a);
            let across = |flight: &Flight| {
                let speed = line.normal.dot(flight.velocity);
                if speed == 0.0 { line.normal.dot(flight.acceleration) } else { speed }
            };
            let turns = across(&before) * across(&Flight { velocity, ..before }) < 0.0;
            let is_back = *floor == subject.floor && is_on_it && along >= 0.0 && along <= line.length && turns;
            is_back.then_some(*to)
        });
        if let Some(floor) = back {
            self.state.balls[ball].floor = floor;
        }
    }
}
