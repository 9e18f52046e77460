//! What an engine made of a scene: the flights of every ball.

use glam::DVec2;
use shared::physics::scene::{Collider, Role, Scene};
use shared::physics::shapes::Shape;

use super::polynomial::{Refinement, roots};
use super::real::{Real, Vector, Wide};
use super::reference::is_present;

/// A piece of a ball's way.
#[derive(Debug, Clone, Copy)]
pub struct Piece {
    /// Seconds since the scene's start.
    pub start: Wide,
    /// Centre of the ball then, m, in the scene's own coordinates.
    pub position: DVec2,
    /// m/s.
    pub velocity: DVec2,
    /// m/s^2.
    pub acceleration: DVec2,
}

impl Piece {
    /// The way of the ball from the start of the piece to that moment, seconds since the scene's start.
    pub(super) fn way(&self, time: Wide) -> DVec2 {
        let t = (time - self.start).to_f64();
        (self.velocity + self.acceleration * (0.5 * t)) * t
    }

    fn off(&self, time: Wide, place: Vector<Wide>) -> f64 {
        (Vector::of(self.position) + Vector::of(self.way(time)) - place).length().to_f64()
    }
}

/// What became of a scene.
#[derive(Debug, Clone, Default)]
pub struct Trajectory {
    /// Of each ball, in order of time; the first begins at the scene's start.
    pub balls: Vec<Vec<Piece>>,
    /// When each ball was lost, if it was, in seconds since the scene's start.
    pub lost: Vec<Option<f64>>,
    /// Seconds up to which it was played.
    pub end: f64,
    /// Which balls left the scene where none should.
    pub escaped: Vec<usize>,
    /// Whether the pieces are an engine's steps: an impact within one is not told. Then the way is looked at from both of a
    /// step's ends, and the better counts.
    pub steps: bool,
}

impl Trajectory {
    /// Distance of a ball from where it should be at that moment, m; infinite if it is not in play any more.
    pub fn error(&self, ball: usize, time: Wide, place: Vector<Wide>) -> f64 {
        if self.lost[ball].is_some_and(|lost| lost < time.to_f64()) {
            return f64::INFINITY;
        }
        let pieces = &self.balls[ball];
        let next = pieces.partition_point(|piece| piece.start <= time);
        let off = pieces[next.max(1) - 1].off(time, place);
        match pieces.get(next) {
            Some(later) if self.steps => off.min(later.off(time, place)),
            _ => off,
        }
    }

    /// Whether any number in it is not finite.
    pub fn is_finite(&self) -> bool {
        self.balls
            .iter()
            .flatten()
            .all(|piece| piece.position.is_finite() && piece.velocity.is_finite() && piece.acceleration.is_finite())
    }

    /// How many times the centre of a ball came through what stands still, in scenes of one floor.
    pub fn passed_through(&self, scene: &Scene) -> u32 {
        let solid = |collider: &&Collider| !collider.role.is_passed() && is_present(collider.presence, &[]);
        if scene.colliders.iter().any(|collider| collider.floor > 0) {
            return 0;
        }
        let solids: Vec<&Collider> = scene.colliders.iter().filter(|c| !is_target(c)).filter(solid).collect();
        let mut count = 0;
        for (pieces, lost) in self.balls.iter().zip(&self.lost) {
            let end = Wide::of(lost.unwrap_or(self.end));
            for (place, piece) in pieces.iter().enumerate() {
                let next = pieces.get(place + 1);
                let length = (next.map_or(end, |next| next.start) - piece.start).to_f64();
                let piece = match next {
                    // An impact within a step is not told: the straight line to its end is what is known.
                    Some(next) if self.steps => {
                        let velocity = (next.position - piece.position) / length;
                        Piece { velocity, acceleration: DVec2::ZERO, ..*piece }
                    }
                    None if self.steps => continue,
                    _ => *piece,
                };
                count += solids.iter().filter(|collider| crosses(&piece, length, &collider.shape)).count() as u32;
            }
        }
        count
    }

    /// Energy of all balls at the start, and the most that it is off it at the beginning of any piece: J. Only while all
    /// are in play.
    pub fn energy(&self, scene: &Scene) -> Energy {
        let of = |place: usize, piece: &Piece| {
            let mass = scene.mass(scene.start[place].kind);
            mass * (0.5 * piece.velocity.length_squared() - scene.gravity.dot(piece.position - scene.bounds.low))
        };
        let mut now: Vec<f64> =
            self.balls.iter().enumerate().map(|(place, pieces)| pieces.first().map_or(0.0, |p| of(place, p))).collect();
        let start: f64 = now.iter().sum();
        let scale = start.abs().max(self.balls.iter().enumerate().fold(0.0, |most, (place, pieces)| {
            let kinetic = |p: &Piece| 0.5 * scene.mass(scene.start[place].kind) * p.velocity.length_squared();
            pieces.iter().map(kinetic).fold(most, f64::max)
        }));
        // Impacts of two balls are at the same moment: they are taken together.
        let mut order: Vec<(Wide, usize, usize)> = Vec::new();
        for (ball, pieces) in self.balls.iter().enumerate() {
            order.extend(pieces.iter().enumerate().skip(1).map(|(place, piece)| (piece.start, ball, place)));
        }
        order.sort_by(|a, b| a.0.to_f64().total_cmp(&b.0.to_f64()));
        let (mut drift, mut gained, mut total) = (0.0_f64, 0.0_f64, start);
        let mut place = 0;
        while place < order.len() {
            let time = order[place].0;
            while place < order.len() && (order[place].0 - time).to_f64() < SAME_MOMENT {
                let (_, ball, piece) = order[place];
                now[ball] = of(ball, &self.balls[ball][piece]);
                place += 1;
            }
            let after: f64 = now.iter().sum();
            gained = gained.max((after - total) / scale);
            drift = drift.max((after - start).abs() / scale);
            total = after;
        }
        Energy { drift, gained }
    }
}

/// Impacts closer than this are one, seconds.
const SAME_MOMENT: f64 = 1e-12;

/// What became of the energy, as shares of the largest.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct Energy {
    /// The most that it was off what it was at the start.
    pub drift: f64,
    /// The most that an impact added.
    pub gained: f64,
}

fn is_target(collider: &Collider) -> bool {
    matches!(collider.role, Role::Target { .. })
}

/// Whether a ball's centre comes through the shape within the piece's first `length` seconds: a ball that bounces stays off it
/// by its radius.
pub(super) fn crosses(piece: &Piece, length: f64, shape: &Shape) -> bool {
    let at = |t: f64| piece.position + (piece.velocity + piece.acceleration * (0.5 * t)) * t;
    match shape {
        Shape::Segment(segment) if !segment.one_way => {
            let c = [
                segment.height(piece.position),
                segment.normal.dot(piece.velocity),
                0.5 * segment.normal.dot(piece.acceleration),
            ];
            roots(&c, 0.0, length, Refinement::FULL, &mut 0).into_iter().any(|t| {
                let along = segment.along.dot(at(t) - segment.a);
                along > 0.0 && along < segment.length
            })
        }
        Shape::Arc(arc) if arc.radius > 0.0 && arc.span.is_none() => {
            let outside = |p: DVec2| (p - arc.center).length() > arc.radius;
            outside(at(0.0)) != outside(at(length))
        }
        _ => false,
    }
}
