//! Floors above the board: clear plastic between raised rails, and the edges at which balls come up. Painted once, into a
//! layer of its own that lies over the balls on the board.
//!
//! A table says only which walls stand on a floor. What they close off, together with edges and holes, is the lane.

use macroquad::math::{Rect, Vec2, Vec3, vec2};
use shared::table::TableFile;
use shared::table::format::{ArcFile, ElementFile, Point};

use super::canvas::{Canvas, LIGHT, ink, smooth};
use super::inserts::{metres, middle};
use super::layout::Layout;
use super::palette::{AMBER, ICE, STEEL};
use super::shape::{Shape, direction};
use super::{furniture, mechanisms};

/// How far a lane is above the board, metres: it sets the length of shadows.
const HEIGHT: f64 = 0.022;
/// Cells along the longer side of a floor's mask. Fewer: gaps as wide as a cell close, and outlines have steps.
const CELLS: f32 = 700.0;
/// Degrees of an arc that one straight piece stands for.
const PIECE: f64 = 4.0;
/// The rails that tell which side of an edge is up are within this distance, metres.
const NEAR: f32 = 0.2;

/// The floor that an element is on; an edge belongs to the upper one of its two.
pub(super) fn floor_of(element: &ElementFile) -> u8 {
    use ElementFile as E;
    match element {
        E::Wall(e) => e.floor,
        E::Arc(e) => e.floor,
        E::Post(e) | E::Ring(e) => e.floor,
        E::Hole(e) => e.floor,
        E::Edge(e) => e.floors.0.max(e.floors.1),
        E::Magnet(e) => e.floor,
        E::OneWay(e) => e.floor,
        E::Bumper(e) => e.floor,
        E::Slingshot(e) => e.floor,
        E::DropTarget(e) | E::Target(e) => e.floor,
        E::Spinner(e) => e.floor,
        E::Gate(e) => e.floor,
        E::Saucer(e) => e.floor,
        E::Rollover(e) | E::Drain(e) => e.floor,
        E::Flipper(_) | E::Plunger(_) | E::Light(_) => 0,
    }
}

/// What is painted above the board.
#[derive(Debug)]
pub(super) struct Ramps<'a> {
    layout: &'a Layout,
    table: &'a TableFile,
    /// From the lowest upward.
    floors: Vec<Floor>,
}

/// One floor's lanes.
#[derive(Debug)]
struct Floor {
    lane: Mask,
    rails: Shape,
    /// Where balls come up: both ends, and the way up.
    edges: Vec<(Vec2, Vec2, Vec2)>,
    /// Where they leave it.
    holes: Vec<(Vec2, Vec2)>,
}

impl<'a> Ramps<'a> {
    /// `None` for a table that has nothing above its board.
    pub(super) fn of(layout: &'a Layout, table: &'a TableFile) -> Option<Self> {
        let mut numbers: Vec<u8> = table.elements.iter().map(floor_of).filter(|&floor| floor > 0).collect();
        numbers.sort_unstable();
        numbers.dedup();
        let floors: Vec<Floor> = numbers.into_iter().map(|floor| Floor::new(layout, table, floor)).collect();
        (!floors.is_empty()).then_some(Self { layout, table, floors })
    }

    /// Paints all of it.
    pub(super) fn paint(&self, canvas: &mut Canvas) {
        for floor in &self.floors {
            floor.paint(canvas, self.layout);
        }
        furniture::paint_upper(canvas, self.layout, self.table);
        mechanisms::paint(canvas, self.layout, self.table, true);
    }
}

impl Floor {
    fn new(layout: &Layout, table: &TableFile, floor: u8) -> Self {
        let (mut walls, mut ends) = (Vec::new(), Vec::new());
        let (mut edges, mut holes) = (Vec::new(), Vec::new());
        for element in &table.elements {
            match element {
                ElementFile::Edge(edge) if edge.floors.0 == floor || edge.floors.1 == floor => {
                    ends.push(vec![edge.from, edge.to]);
                    if floor_of(element) == floor {
                        edges.push((edge.from, edge.to));
                    }
                }
                _ if floor_of(element) != floor => {}
                ElementFile::Wall(wall) => walls.push(wall.points.clone()),
                ElementFile::Arc(arc) => walls.push(points_of(arc)),
                ElementFile::Ring(ring) => walls.push(points_around(ring.center, ring.radius, 0.0, 360.0)),
                ElementFile::OneWay(wall) => ends.push(vec![wall.from, wall.to]),
                ElementFile::Hole(hole) => {
                    ends.push(vec![hole.from, hole.to]);
                    holes.push((layout.written(hole.from), layout.written(hole.to)));
                }
                _ => {}
            }
        }
        let edge = |(from, to)| (layout.written(from), layout.written(to), way_up(from, to, &walls));
        let edges = edges.into_iter().map(edge).collect();
        let line = |points: &Vec<Point>| points.iter().map(|point| layout.written(*point)).collect::<Vec<_>>();
        let rails: Vec<Vec<Vec2>> = walls.iter().map(line).collect();
        let lines: Vec<Vec<Vec2>> = rails.iter().cloned().chain(ends.iter().map(line)).collect();
        let radius = rail_radius(layout);
        let rails = Shape::Union(rails.into_iter().map(|points| Shape::Path { points, radius }).collect());
        Self { lane: Mask::inside(&lines), rails, edges, holes }
    }

    fn paint(&self, canvas: &mut Canvas, layout: &Layout) {
        let height = layout.length(HEIGHT);
        // 1. The shadow of the plastic, fainter than that of its rails.
        let offset = -LIGHT * height;
        let area = self.lane.area();
        canvas.wash(Rect::new(area.x + offset.x, area.y + offset.y, area.w, area.h), |p| {
            ink(Vec3::ZERO, 0.20 * self.lane.cover(p - offset))
        });
        canvas.shadow(&self.rails, height, 0.55);
        // 2. The plastic: clear in the middle, brighter where it bends up to the rails, with the lamps mirrored in it.
        let bend = layout.length(0.009);
        let stripe = layout.length(0.045);
        canvas.wash(area, |p| {
            let cover = self.lane.cover(p);
            if cover <= 0.0 {
                return ink(Vec3::ZERO, 0.0);
            }
            let rim = 1.0 - smooth(0.0, bend, self.rails.distance(p));
            let gleam = smooth(0.86, 0.97, ((p.x - p.y * 0.6) / stripe).sin());
            ink(ICE.lerp(Vec3::ONE, 0.35 * rim), cover * (0.18 + 0.22 * rim + 0.07 * gleam))
        });
        // 3. Where balls leave it, and where they come up.
        let width = layout.length(0.0011).max(0.8);
        for &(from, to) in &self.holes {
            canvas.flat(&Shape::rod(from, to, width * 2.0), ink(Vec3::ZERO, 0.75));
            canvas.flat(&Shape::rod(from, to, width * 0.6), ink(ICE, 0.8));
        }
        for &(from, to, ahead) in &self.edges {
            canvas.tube(&Shape::rod(from, to, width), width, STEEL, 0.5);
            arrow(canvas, (from + to) / 2.0, ahead, from.distance(to));
        }
        // 4. The rails.
        canvas.tube(&self.rails, rail_radius(layout), STEEL.lerp(ICE, 0.35), 0.55);
    }
}

fn rail_radius(layout: &Layout) -> f32 {
    layout.length(0.0021).max(1.0)
}

/// Two chevrons beyond an edge of that width, one behind the other: this way up.
fn arrow(canvas: &mut Canvas, center: Vec2, ahead: Vec2, width: f32) {
    let side = ahead.perp() * width * 0.20;
    for (step, alpha) in [(0.42, 0.75), (0.70, 0.5)] {
        let tip = center + ahead * width * step;
        let back = ahead * width * 0.18;
        let points = vec![tip - back - side, tip, tip - back + side];
        canvas.flat(&Shape::Path { points, radius: (width * 0.035).max(0.8) }, ink(AMBER, alpha));
    }
}

/// Square to an edge towards where the rails of its upper floor are; y runs down.
fn way_up(from: Point, to: Point, rails: &[Vec<Point>]) -> Vec2 {
    let center = metres(middle(from, to));
    let across = (metres(to) - metres(from)).perp();
    // Each straight piece by some of its points: a long one begins at the edge and ends far away.
    let pieces = rails.iter().flat_map(|rail| rail.windows(2));
    let points = pieces.flat_map(|ends| (0..=8_u8).map(|k| metres(ends[0]).lerp(metres(ends[1]), f32::from(k) / 8.0)));
    let beside = points.map(|point| point - center).filter(|away| away.length() < NEAR);
    let sum: f32 = beside.map(|away| away.dot(across)).sum();
    (across * vec2(1.0, -1.0)).normalize_or_zero() * if sum < 0.0 { -1.0 } else { 1.0 }
}

fn points_of(arc: &ArcFile) -> Vec<Point> {
    points_around(arc.center, arc.radius, arc.from, arc.to)
}

/// Points along a part of a circle; degrees clockwise from +y.
fn points_around(center: Point, radius: f64, from: f64, to: f64) -> Vec<Point> {
    let pieces = ((to - from) / PIECE).ceil().clamp(1.0, 90.0) as u8;
    let point = |piece: u8| {
        let angle = from + (to - from) * f64::from(piece) / f64::from(pieces);
        let ahead = direction((angle as f32).to_radians());
        (center.0 + radius * f64::from(ahead.x), center.1 - radius * f64::from(ahead.y))
    };
    (0..=pieces).map(point).collect()
}

/// Which places are within a floor's lanes, on a grid of square cells.
#[derive(Debug)]
struct Mask {
    corner: Vec2,
    cell: f32,
    columns: usize,
    rows: usize,
    inside: Vec<bool>,
}

impl Mask {
    /// All that is closed off by lines. What is open on a side is outside.
    fn inside(lines: &[Vec<Vec2>]) -> Self {
        let mut points = lines.iter().flatten().copied();
        let first = points.next().unwrap_or_default();
        let (low, high) = points.fold((first, first), |(low, high), point| (low.min(point), high.max(point)));
        let cell = ((high - low).max_element() / CELLS).max(1.0);
        // A margin from which the outside is reached all around.
        let corner = low - 2.5 * cell;
        let count = |length: f32| (length / cell).ceil() as usize + 5;
        let (columns, rows) = (count(high.x - low.x), count(high.y - low.y));
        let mut mask = Self { corner, cell, columns, rows, inside: vec![true; columns * rows] };
        let mut is_line = vec![false; columns * rows];
        for ends in lines.iter().flat_map(|line| line.windows(2)) {
            let steps = (ends[0].distance(ends[1]) / (0.4 * cell)).ceil().max(1.0);
            for step in 0..=steps as usize {
                if let Some(place) = mask.place(ends[0].lerp(ends[1], step as f32 / steps)) {
                    is_line[place] = true;
                }
            }
        }
        mask.flood_from_corner(&is_line);
        mask
    }

    fn place(&self, point: Vec2) -> Option<usize> {
        let at = (point - self.corner) / self.cell;
        let (column, row) = (at.x as usize, at.y as usize);
        (at.min_element() >= 0.0 && column < self.columns && row < self.rows).then_some(row * self.columns + column)
    }

    /// What is reached from a corner without crossing a line is outside.
    fn flood_from_corner(&mut self, is_line: &[bool]) {
        let mut reached = vec![0];
        self.inside[0] = false;
        while let Some(place) = reached.pop() {
            let (column, row) = (place % self.columns, place / self.columns);
            let beside = [
                (column > 0).then(|| place - 1),
                (column + 1 < self.columns).then_some(place + 1),
                (row > 0).then(|| place - self.columns),
                (row + 1 < self.rows).then_some(place + self.columns),
            ];
            for next in beside.into_iter().flatten() {
                if self.inside[next] && !is_line[next] {
                    self.inside[next] = false;
                    reached.push(next);
                }
            }
        }
    }

    fn area(&self) -> Rect {
        Rect::new(self.corner.x, self.corner.y, self.columns as f32 * self.cell, self.rows as f32 * self.cell)
    }

    /// How much of a place is inside, 0 to 1.
    fn cover(&self, point: Vec2) -> f32 {
        let at = (point - self.corner) / self.cell - 0.5;
        let (base, share) = (at.floor(), at - at.floor());
        let cell = |x: f32, y: f32| {
            let place = self.place(self.corner + (base + vec2(x, y) + 0.5) * self.cell);
            f32::from(u8::from(place.is_some_and(|place| self.inside[place])))
        };
        let row = |y: f32| cell(0.0, y) + (cell(1.0, y) - cell(0.0, y)) * share.x;
        row(0.0) + (row(1.0) - row(0.0)) * share.y
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn a_lane_is_what_its_lines_close_off() {
        let walls =
            vec![vec![vec2(10.0, 90.0), vec2(10.0, 10.0), vec2(40.0, 10.0)], vec![vec2(40.0, 10.0), vec2(40.0, 90.0)]];
        let open = Mask::inside(&walls);
        assert_eq!(open.cover(vec2(25.0, 50.0)), 0.0);
        let closed = Mask::inside(&[walls, vec![vec![vec2(10.0, 90.0), vec2(40.0, 90.0)]]].concat());
        assert_eq!(closed.cover(vec2(25.0, 50.0)), 1.0);
        assert_eq!((closed.cover(vec2(45.0, 50.0)), closed.cover(vec2(-900.0, 50.0))), (0.0, 0.0));
        // Nothing at all is no lane.
        assert_eq!(Mask::inside(&[]).cover(Vec2::ZERO), 0.0);
    }

    #[test]
    fn the_way_up_is_where_the_rails_are() {
        let rails = [vec![(0.1, 0.5), (0.1, 0.7)], vec![(0.2, 0.5), (0.2, 0.7)]];
        // Up the table is up the window.
        for (from, to) in [((0.1, 0.5), (0.2, 0.5)), ((0.2, 0.5), (0.1, 0.5))] {
            assert!((way_up(from, to, &rails) - vec2(0.0, -1.0)).length() < 1e-6);
        }
    }

    #[test]
    fn an_arc_goes_clockwise_from_up() {
        let points = points_around((1.0, 2.0), 0.5, 0.0, 90.0);
        let (first, last) = (points[0], points[points.len() - 1]);
        assert!((first.0 - 1.0).abs() < 1e-6 && (first.1 - 2.5).abs() < 1e-6, "{first:?}");
        assert!((last.0 - 1.5).abs() < 1e-6 && (last.1 - 2.0).abs() < 1e-6, "{last:?}");
    }
}
