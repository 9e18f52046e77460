//! Sparks where balls hit something: where they come from, which way they fly, and how hard the hit was. How each of
//! them flies is the picture's business.

use macroquad::math::{Vec2, vec2};
use shared::game::{GameEvent, GameEventKind};
use shared::table::Table;
use shared::table::format::{ElementFile, Point};

use crate::view::{Burst, BurstKind};

/// Speed of approach from which on a hit sparks, and at which it sparks most, m/s.
const SPEEDS: (f32, f32) = (0.5, 3.0);
/// What kicks, or is aimed at, sparks at least like this.
const LEAST: f32 = 0.4;
/// Seconds after which the last spark is out.
const SECONDS: f64 = 0.6;
/// Bursts at once; the oldest go first.
const MOST: usize = 16;
/// A ball farther from an element than so many metres was not the one that hit it: a frame's way, and its radius.
const NEAR: f32 = 0.09;

/// The bursts of a board.
#[derive(Debug, Default)]
pub(super) struct Bursts {
    /// Where balls were seen last.
    balls: Vec<Vec2>,
    /// When each began.
    bursts: Vec<(f64, Burst)>,
}

impl Bursts {
    /// Balls are seen there.
    pub(super) fn see(&mut self, balls: impl Iterator<Item = Vec2>) {
        self.balls.clear();
        self.balls.extend(balls);
    }

    /// Takes in what happened.
    pub(super) fn note(&mut self, event: &GameEvent, table: &Table, now: f64) {
        let (element, speed, kind) = match event.kind {
            GameEventKind::Kicked { element, speed } => (element, speed, BurstKind::Kicker),
            GameEventKind::Felled { element, speed } | GameEventKind::Struck { element, speed } => {
                (element, speed, BurstKind::Target)
            }
            GameEventKind::Touched { element, speed } => (element, speed, BurstKind::Solid),
            _ => return,
        };
        let hardness = ((speed - SPEEDS.0) / (SPEEDS.1 - SPEEDS.0)).min(1.0);
        let strength = if kind == BurstKind::Solid { hardness } else { hardness.max(LEAST) };
        let Some(file) = table.file.elements.get(usize::from(element)).filter(|_| strength > 0.0) else { return };
        let Some((position, direction)) = self.place(file) else { return };
        if self.bursts.len() == MOST {
            self.bursts.remove(0);
        }
        // A cast cuts off: any bits will do.
        let seed = (event.tick as u32).wrapping_mul(0x9E37_79B1) ^ u32::from(element);
        self.bursts.push((now, Burst { position, direction, strength, age: 0.0, kind, seed }));
    }

    /// What is to be seen now. Forgets what is out.
    pub(super) fn at(&mut self, now: f64) -> Vec<Burst> {
        self.bursts.retain(|(since, _)| now - since < SECONDS);
        self.bursts.iter().map(|(since, burst)| Burst { age: (now - since).max(0.0) as f32, ..*burst }).collect()
    }

    /// Where an element was hit by the ball that is nearest to it, and the way from there to the ball.
    fn place(&self, element: &ElementFile) -> Option<(Vec2, Vec2)> {
        let hit = |ball: &Vec2| surface(element, *ball).map(|point| (point, *ball));
        let hits = self.balls.iter().filter_map(hit).filter(|(point, ball)| point.distance(*ball) < NEAR);
        let (point, ball) = hits.min_by(|a, b| a.0.distance(a.1).total_cmp(&b.0.distance(b.1)))?;
        Some((point, (ball - point).normalize_or_zero()))
    }
}

/// The point of an element's surface that is nearest to a ball; `None` for what no ball hits.
fn surface(element: &ElementFile, ball: Vec2) -> Option<Vec2> {
    let on_circle = |center: Point, radius: f64| {
        let center = metres(center);
        center + (ball - center).normalize_or_zero() * radius as f32
    };
    let on_line = |from: Point, to: Point| {
        let (from, way) = (metres(from), metres(to) - metres(from));
        from + way * ((ball - from).dot(way) / way.length_squared().max(1e-12)).clamp(0.0, 1.0)
    };
    match element {
        ElementFile::Bumper(bumper) => Some(on_circle(bumper.center, bumper.radius)),
        ElementFile::Post(post) | ElementFile::Ring(post) => Some(on_circle(post.center, post.radius)),
        ElementFile::Arc(arc) => Some(on_circle(arc.center, arc.radius)),
        ElementFile::Slingshot(sling) => Some(on_line(sling.from, sling.to)),
        ElementFile::DropTarget(target) | ElementFile::Target(target) => Some(on_line(target.from, target.to)),
        ElementFile::Wall(wall) => {
            let points = wall.points.windows(2).map(|ends| on_line(ends[0], ends[1]));
            points.min_by(|a, b| a.distance_squared(ball).total_cmp(&b.distance_squared(ball)))
        }
        _ => None,
    }
}

fn metres((x, y): Point) -> Vec2 {
    vec2(x as f32, y as f32)
}

#[cfg(test)]
mod tests {
    use super::*;

    fn element(table: &Table, is_wanted: impl Fn(&ElementFile) -> bool) -> u16 {
        table.file.elements.iter().position(is_wanted).unwrap() as u16
    }

    #[test]
    fn sparks_come_from_where_the_ball_touched_and_fly_away_from_it() {
        let table = Table::shipped("classic").unwrap().unwrap();
        let place = element(&table, |element| matches!(element, ElementFile::Bumper(_)));
        let ElementFile::Bumper(bumper) = &table.file.elements[usize::from(place)] else { panic!() };
        let center = metres(bumper.center);
        let mut bursts = Bursts::default();
        bursts.see([center + vec2(0.05, 0.0), center + vec2(0.0, 0.3)].into_iter());
        let kind = GameEventKind::Kicked { element: place, speed: 1.0 };
        bursts.note(&GameEvent { tick: 7, kind }, &table, 5.0);
        let burst = bursts.at(5.25)[0];
        assert!((burst.position - center - vec2(bumper.radius as f32, 0.0)).length() < 1e-6);
        assert_eq!((burst.direction, burst.age, burst.kind), (vec2(1.0, 0.0), 0.25, BurstKind::Kicker));
        assert!(burst.strength >= LEAST);
        assert!(bursts.at(5.7).is_empty());
    }

    #[test]
    fn soft_hits_and_hits_by_nobody_do_not_spark() {
        let table = Table::shipped("classic").unwrap().unwrap();
        let wall = element(&table, |element| matches!(element, ElementFile::Wall(_)));
        let mut bursts = Bursts::default();
        let touch = |speed| GameEvent { tick: 1, kind: GameEventKind::Touched { element: wall, speed } };
        bursts.note(&touch(3.0), &table, 0.0);
        bursts.see([vec2(0.014, 0.4)].into_iter());
        bursts.note(&touch(0.3), &table, 0.0);
        assert!(bursts.at(0.0).is_empty());
        for _ in 0..40 {
            bursts.note(&touch(1.0), &table, 0.0);
        }
        assert_eq!((bursts.at(0.0).len(), bursts.at(0.0)[0].position), (MOST, vec2(0.0, 0.4)));
    }
}
