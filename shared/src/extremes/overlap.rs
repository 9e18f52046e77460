//! How a ball's place is judged: how deep it overlaps what is there, whether it is where no ball belongs, and whether it came
//! through a wall.

use glam::DVec2;

use crate::physics::World;
use crate::physics::scene::Role;
use crate::physics::shapes::{Segment, Shape, Side};
use crate::table::{ElementFile, Table};

/// How deep a ball of the first kind with its centre there, on that floor, overlaps what is there, m; negative: how far the
/// nearest thing is, if it is as near as its radius.
pub fn deepest_overlap(world: &World, position: DVec2, floor: u8) -> f64 {
    let (scene, state) = (world.scene(), world.state());
    let mut deepest = f64::NEG_INFINITY;
    let mut note = |distance: f64| {
        let overlap = scene.radius(0) - distance;
        deepest = if overlap > deepest { overlap } else { deepest };
    };
    for collider in &scene.colliders {
        let one_way = matches!(collider.shape, Shape::Segment(segment) if segment.one_way);
        let passable = collider.role.is_passed() || one_way;
        if !passable && collider.floor == floor && collider.bounds.contains(position) && state.has(collider) {
            note(match &collider.shape {
                // A whole disc is solid.
                Shape::Arc(disc) if disc.side == Side::Outside && disc.span.is_none() => {
                    (position - disc.center).length() - disc.radius
                }
                shape => shape.distance(position),
            });
        }
    }
    let on_playfield = if floor == 0 { scene.flippers.as_slice() } else { &[] };
    for (spec, flipper) in on_playfield.iter().zip(&state.flippers) {
        note(spec.nearest(spec.direction(flipper.swing), position).distance);
    }
    deepest
}

/// The places of a table where no ball's centre belongs.
#[derive(Debug, Clone)]
pub struct Obstacles {
    /// Closed walls with their floors, the last corner as the first.
    islands: Vec<(u8, Vec<DVec2>)>,
    /// Long walls with theirs: on which side of them a ball is can be told from one tick to the next.
    walls: Vec<(u8, Segment)>,
    /// Lines at which a ball comes to another floor from the playfield.
    edges: Vec<Segment>,
}

impl Obstacles {
    /// Of a table whose parts are at rest.
    pub fn of(table: &Table) -> Self {
        let closed = table.file.elements.iter().filter_map(|element| match element {
            ElementFile::Wall(wall) if wall.points.len() > 3 && wall.points.first() == wall.points.last() => {
                Some((wall.floor, wall.points.iter().map(|&(x, y)| DVec2::new(x, y)).collect()))
            }
            _ => None,
        });
        let world = World::new(table.scene.clone());
        let solid = table.scene.colliders.iter().filter(|c| c.role == Role::Solid && world.state().has(c));
        let long = solid.filter_map(|c| match c.shape {
            Shape::Segment(segment) if segment.length > 0.07 && !segment.one_way => Some((c.floor, segment)),
            _ => None,
        });
        let edges = table.scene.colliders.iter().filter_map(|c| match (c.role, &c.shape) {
            (Role::Hole { .. }, Shape::Segment(line)) if c.floor == 0 => Some(*line),
            _ => None,
        });
        Self { islands: closed.collect(), walls: long.collect(), edges: edges.collect() }
    }

    /// Whether a point of the playfield is within a radius of where a ball comes to another floor: behind that line no ball
    /// belongs.
    pub fn is_at_edge(&self, point: DVec2, radius: f64) -> bool {
        self.edges.iter().any(|edge| Shape::Segment(*edge).distance(point) < radius)
    }

    /// Whether a point lies in an island of that floor.
    pub fn is_inside(&self, point: DVec2, floor: u8) -> bool {
        self.islands.iter().any(|(of, island)| *of == floor && is_inside(island, point))
    }

    /// The wall that a ball came through on that floor from one tick to the next.
    pub fn crossed(&self, before: DVec2, after: DVec2, floor: u8) -> Option<&Segment> {
        let walls = self.walls.iter().filter(|(of, _)| *of == floor).map(|(_, wall)| wall);
        walls
            .into_iter()
            .find(|wall| matches!((side_of(wall, before), side_of(wall, after)), (Some(was), Some(is)) if was != is))
    }
}

/// Whether a point lies in a polygon whose last corner is its first.
fn is_inside(polygon: &[DVec2], point: DVec2) -> bool {
    let crossed = polygon.windows(2).filter(|pair| {
        let (a, b) = (pair[0], pair[1]);
        (a.y > point.y) != (b.y > point.y) && point.x < a.x + (point.y - a.y) / (b.y - a.y) * (b.x - a.x)
    });
    crossed.count() % 2 == 1
}

/// The side of a wall on which a point is, if it is beside its middle part.
fn side_of(wall: &Segment, point: DVec2) -> Option<bool> {
    let along = wall.along.dot(point - wall.a);
    (along > 0.03 && along < wall.length - 0.03).then(|| wall.normal.dot(point - wall.a) > 0.0)
}
