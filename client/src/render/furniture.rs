//! What stands on the board and never moves: frame, islands, rails, rubbers, posts, gates, apron. First all the
//! shadows, then the things themselves, so that no shadow falls on top of a neighbour.

use std::f32::consts::PI;

use macroquad::math::{Rect, Vec2, Vec3, vec2};
use shared::table::TableFile;
use shared::table::format::{BumperFile, ElementFile, Point, SlingshotFile, WallFile};

use super::canvas::{Canvas, LIGHT, ink, smooth};
use super::inserts::metres;
use super::layout::Layout;
use super::palette::{AMBER, ICE, IVORY, NIGHT, PLASTIC, PLASTIC_DEEP, PRINT, RED, RUBBER, STEEL};
use super::playfield::wood;
use super::ramps::floor_of;
use super::shape::{Shape, star};

/// How far things stand above the board, metres: it sets the length of shadows.
const HEIGHT: f64 = 0.0095;

/// How a piece is painted.
#[derive(Debug, Clone, Copy, PartialEq)]
enum Look {
    /// Raised printed plastic.
    Island,
    /// The lit triangle behind a slingshot's rubber.
    Slingshot,
    /// A metal rail or wire.
    Rail { radius: f32 },
    /// A rubber ring or band.
    Rubber { radius: f32 },
    /// The outer wood, where it reaches into the playfield.
    Frame,
    /// A round post with rubber.
    Post,
    /// What a bumper's cap stands on.
    BumperBase,
}

/// One thing that stands.
#[derive(Debug)]
struct Piece {
    shape: Shape,
    look: Look,
}

/// Paints everything that stands on the board.
pub(super) fn paint(canvas: &mut Canvas, layout: &Layout, table: &TableFile) {
    apron(canvas, layout, table);
    let on_board = table.elements.iter().filter(|element| floor_of(element) == 0);
    let pieces: Vec<Piece> = on_board.clone().flat_map(|element| pieces(layout, table, element)).collect();
    paint_pieces(canvas, layout, &pieces);
    for element in on_board {
        if let ElementFile::OneWay(gate) = element {
            gate_wire(canvas, layout, layout.written(gate.from), layout.written(gate.to));
        }
    }
    frame(canvas, layout);
}

/// Paints what stands on the floors above the board, but for their rails.
pub(super) fn paint_upper(canvas: &mut Canvas, layout: &Layout, table: &TableFile) {
    let above = table.elements.iter().filter(|element| floor_of(element) > 0);
    let is_rail =
        |element: &&ElementFile| matches!(element, ElementFile::Wall(_) | ElementFile::Arc(_) | ElementFile::Ring(_));
    let standing = above.clone().filter(|element| !is_rail(element));
    let pieces: Vec<Piece> = standing.flat_map(|element| pieces(layout, table, element)).collect();
    paint_pieces(canvas, layout, &pieces);
    for element in above {
        if let ElementFile::OneWay(gate) = element {
            gate_wire(canvas, layout, layout.written(gate.from), layout.written(gate.to));
        }
    }
}

fn paint_pieces(canvas: &mut Canvas, layout: &Layout, pieces: &[Piece]) {
    for piece in pieces {
        let height = layout.length(HEIGHT) * if matches!(piece.look, Look::Rail { .. }) { 0.7 } else { 1.0 };
        canvas.shadow(&piece.shape, height, 0.62);
    }
    for piece in pieces {
        paint_piece(canvas, layout, piece);
    }
}

/// What an element looks like while it stands still. Things that move or change are sprites instead.
fn pieces(layout: &Layout, table: &TableFile, element: &ElementFile) -> Vec<Piece> {
    let rail = Look::Rail { radius: layout.length(0.0024).max(1.0) };
    let rubber = Look::Rubber { radius: layout.length(0.0030).max(1.0) };
    let bar = |shape: Shape, look: Look| Piece { shape, look };
    match element {
        ElementFile::Wall(wall) => wall_pieces(layout, table, wall),
        ElementFile::Arc(arc) => {
            let (center, radius) = (layout.written(arc.center), layout.length(arc.radius));
            let (from, to) = (radians(arc.from), radians(arc.to));
            let Look::Rail { radius: half_width } = rail else { return Vec::new() };
            let mut pieces = vec![bar(Shape::Arc { center, radius, from, to, half_width }, rail)];
            pieces.extend(corners_beyond(layout, center, radius, from, to).map(|shape| bar(shape, Look::Frame)));
            pieces.reverse();
            pieces
        }
        ElementFile::Post(post) => {
            vec![bar(Shape::circle(layout.written(post.center), layout.length(post.radius)), Look::Post)]
        }
        ElementFile::Ring(ring) => {
            let (center, radius) = (layout.written(ring.center), layout.length(ring.radius));
            let Look::Rail { radius: half_width } = rail else { return Vec::new() };
            vec![bar(Shape::Arc { center, radius, from: 0.0, to: 2.0 * PI, half_width }, rail)]
        }
        ElementFile::Bumper(bumper) => vec![bar(bumper_base(layout, bumper), Look::BumperBase)],
        ElementFile::Slingshot(sling) => {
            let Look::Rubber { radius } = rubber else { return Vec::new() };
            let ends = [layout.written(sling.from), layout.written(sling.to)];
            ends.map(|end| bar(Shape::circle(end, radius * 1.5), Look::Post)).into()
        }
        _ => Vec::new(),
    }
}

fn bumper_base(layout: &Layout, bumper: &BumperFile) -> Shape {
    Shape::circle(layout.written(bumper.center), layout.length(bumper.radius))
}

/// Degrees clockwise from +y, as in a table file, to radians clockwise from straight up.
fn radians(degrees: f64) -> f32 {
    (degrees as f32).to_radians()
}

/// A large arch closes the table: what lies beyond it, up to the upper corners, is frame.
fn corners_beyond(layout: &Layout, center: Vec2, radius: f32, from: f32, to: f32) -> Option<Shape> {
    let field = layout.playfield();
    let is_arch = from <= -PI / 3.0 && to >= PI / 3.0 && to - from <= 1.2 * PI && radius > field.w * 0.35;
    // Down to the lower of the arch's ends.
    let foot = center.y - radius * from.cos().min(to.cos());
    let rect = Rect::new(field.x, field.y, field.w, (foot - field.y).max(0.0));
    is_arch.then_some(Shape::Spandrel { rect, center, radius })
}

fn wall_pieces(layout: &Layout, table: &TableFile, wall: &WallFile) -> Vec<Piece> {
    let points: Vec<Vec2> = wall.points.iter().map(|point| layout.written(*point)).collect();
    let (Some(first), Some(last)) = (wall.points.first(), wall.points.last()) else { return Vec::new() };
    let rubber = layout.length(0.0030).max(1.0);
    let rail = layout.length(0.0022).max(1.0);
    let edge = |radius: f32, look: Look| Piece { shape: Shape::Path { points: points.clone(), radius }, look };
    let is_closed = first == last;
    // One around the place where balls begin is no island but the frame.
    let is_frame = is_closed && Shape::Polygon(points.clone()).distance(layout.written(table.ball.start)) < 0.0;
    if is_closed && !is_frame {
        return vec![Piece { shape: Shape::Polygon(points), look: Look::Island }];
    }
    if closed_by_slingshot(table, *first, *last).is_some() {
        let body = Piece { shape: Shape::Polygon(points.clone()), look: Look::Slingshot };
        return vec![body, edge(rubber * 0.8, Look::Rubber { radius: rubber * 0.8 })];
    }
    if !is_closed && wall.points.len() > 2 && leans_on_wall(table, wall, *first, *last) {
        let body = Piece { shape: Shape::Polygon(points.clone()), look: Look::Island };
        return vec![body, edge(rubber * 0.8, Look::Rubber { radius: rubber * 0.8 })];
    }
    if wall.material.contains("wood") {
        // The side of the cabinet: the frame itself is painted for it.
        return Vec::new();
    }
    if wall.material.contains("rubber") {
        return vec![edge(rubber, Look::Rubber { radius: rubber })];
    }
    vec![edge(rail, Look::Rail { radius: rail })]
}

/// The slingshot whose rubber joins the two ends of a wall.
fn closed_by_slingshot(table: &TableFile, first: Point, last: Point) -> Option<&SlingshotFile> {
    table.elements.iter().find_map(|element| match element {
        ElementFile::Slingshot(sling)
            if (sling.from, sling.to) == (first, last) || (sling.to, sling.from) == (first, last) =>
        {
            Some(sling)
        }
        _ => None,
    })
}

/// Whether both ends of a wall lie on one straight piece of another: it is a bump, and solid.
fn leans_on_wall(table: &TableFile, wall: &WallFile, first: Point, last: Point) -> bool {
    table.elements.iter().any(|element| match element {
        ElementFile::Wall(other) if other.name != wall.name => {
            other.points.windows(2).any(|ends| is_on(first, ends[0], ends[1]) && is_on(last, ends[0], ends[1]))
        }
        _ => false,
    })
}

/// Whether a point is on a straight line between two others, to half a millimetre.
fn is_on(point: Point, from: Point, to: Point) -> bool {
    Shape::rod(metres(from), metres(to), 0.0).distance(metres(point)) < 5e-4
}

fn paint_piece(canvas: &mut Canvas, layout: &Layout, Piece { shape, look }: &Piece) {
    match *look {
        Look::Island => island(canvas, layout, shape),
        Look::Slingshot => slingshot(canvas, layout, shape),
        Look::Rail { radius } => canvas.tube(shape, radius, STEEL * 0.9, 0.42),
        Look::Rubber { radius } => canvas.tube(shape, radius, RUBBER * 0.85, 0.12),
        Look::Frame => {
            canvas.fill(shape, |p, _| ink(wood(p, layout.scale) * 0.85, 1.0));
            canvas.bevel(shape, layout.length(0.004), 0.35);
        }
        Look::Post => {
            let reach = shape.bounds().w / 2.0;
            canvas.tube(shape, reach, RUBBER * 0.8, 0.1);
            canvas.tube(&Shape::circle(shape.bounds().center(), reach * 0.5), reach * 0.5, STEEL, 0.5);
        }
        Look::BumperBase => bumper(canvas, shape),
    }
}

/// Raised plastic: dark at the foot, printed on top with a line along its outline, its edge catching the light.
fn island(canvas: &mut Canvas, layout: &Layout, shape: &Shape) {
    let bounds = shape.bounds();
    let line = -layout.length(0.0055);
    canvas.fill(shape, |p, distance| {
        let down = (p.y - bounds.y) / bounds.h.max(1.0);
        let stripes = 0.05 * smooth(0.6, 0.75, ((p.x + p.y) / layout.length(0.012)).sin());
        let print = 1.0 - smooth(0.0, layout.length(0.0009).max(0.8), (distance - line).abs());
        let top = PLASTIC.lerp(PLASTIC_DEEP, down) + PRINT * stripes;
        ink(top.lerp(PRINT, 0.6 * print), 0.97)
    });
    canvas.bevel(shape, layout.length(0.0035).max(1.5), 0.55);
    canvas.outline(shape, 1.0, ink(ICE, 0.45));
}

/// The body of a slingshot: lit from inside, since it is a target.
fn slingshot(canvas: &mut Canvas, layout: &Layout, shape: &Shape) {
    let bounds = shape.bounds();
    let center = bounds.center();
    canvas.fill(shape, |p, distance| {
        let lit = 1.0 - smooth(0.0, bounds.h * 0.6, p.distance(center));
        let inner = smooth(-layout.length(0.004), -layout.length(0.0055), distance);
        let body = Vec3::new(0.32, 0.03, 0.05).lerp(RED * 0.8, lit);
        ink(body.lerp(body * 0.55, inner * (1.0 - lit)), 1.0)
    });
    canvas.bevel(shape, layout.length(0.003).max(1.5), 0.5);
}

/// The base of a bumper: a dark skirt, a steel ring and red plastic. The cap above it is a sprite.
fn bumper(canvas: &mut Canvas, shape: &Shape) {
    let Shape::Circle { center, radius } = *shape else { return };
    canvas.halo(shape, radius * 0.9, RED, 0.22);
    canvas.fill(shape, |p, _| {
        let tilt = (p - center).dot(LIGHT) / radius;
        ink(STEEL * (0.45 + 0.4 * tilt), 1.0)
    });
    canvas.flat(&Shape::circle(center, radius * 0.92), ink(NIGHT, 1.0));
    canvas.fill(&Shape::circle(center, radius * 0.88), |p, _| {
        let tilt = (p - center).dot(LIGHT) / radius;
        ink(RED * (0.6 + 0.35 * tilt), 1.0)
    });
}

/// A thin wire between two hinges.
fn gate_wire(canvas: &mut Canvas, layout: &Layout, from: Vec2, to: Vec2) {
    let radius = layout.length(0.0012).max(0.8);
    let wire = Shape::rod(from, to, radius);
    canvas.shadow(&wire, layout.length(HEIGHT), 0.5);
    canvas.tube(&wire, radius, STEEL, 0.4);
    for end in [from, to] {
        let hinge = layout.length(0.0034).max(1.5);
        canvas.tube(&Shape::circle(end, hinge), hinge, STEEL * 0.75, 0.4);
    }
}

/// The plate below the flippers, under which a ball is lost; and the dusk in front of it.
fn apron(canvas: &mut Canvas, layout: &Layout, table: &TableFile) {
    for element in &table.elements {
        let ElementFile::Drain(drain) = element else { continue };
        let (from, to) = (layout.written(drain.from), layout.written(drain.to));
        let (left, right) = (from.x.min(to.x), from.x.max(to.x));
        let top = from.y.min(to.y);
        let bottom = layout.playfield().bottom();
        let dusk = layout.length(0.07);
        canvas.wash(Rect::new(left, top - dusk, right - left, dusk), |p| {
            ink(Vec3::ZERO, 0.75 * smooth(0.0, 1.0, (p.y - top + dusk) / dusk))
        });
        let plate = Shape::Polygon(vec![vec2(left, top), vec2(right, top), vec2(right, bottom), vec2(left, bottom)]);
        canvas.fill(&plate, |p, _| {
            let down = (p.y - top) / (bottom - top).max(1.0);
            ink(PLASTIC_DEEP.lerp(NIGHT, down) * 1.1, 1.0)
        });
        canvas.bevel(&plate, layout.length(0.003).max(1.5), 0.4);
        let edge = Shape::rod(vec2(left, top), vec2(right, top), layout.length(0.0014).max(1.0));
        canvas.tube(&edge, layout.length(0.0014).max(1.0), STEEL * 0.8, 0.3);
        // A row of stars, the largest in the middle.
        let middle = vec2((left + right) / 2.0, (top + bottom) / 2.0);
        for (step, size) in [(-2.0, 0.2), (-1.0, 0.27), (0.0, 0.36), (1.0, 0.27), (2.0, 0.2)] {
            let size = size * (bottom - top);
            let center = middle + vec2(step * (right - left) * 0.13, 0.0);
            canvas.flat(&star(center, 5, size, size * 0.42, 0.0), ink(AMBER, 0.55));
        }
    }
}

/// The wooden frame around the playfield, its inner edge catching light or throwing shadow on the board.
fn frame(canvas: &mut Canvas, layout: &Layout) {
    let field = layout.playfield();
    let outer = layout.cabinet;
    let reach = layout.length(HEIGHT) * 1.6;
    // The shadow of the left and upper boards.
    canvas.wash(Rect::new(field.x, field.y, reach, field.h), |p| {
        ink(Vec3::ZERO, 0.5 * (1.0 - smooth(0.0, reach, p.x - field.x)))
    });
    let inside = Shape::Plate { rect: field, corner: 0.0 };
    let whole = Shape::Plate { rect: outer, corner: layout.length(0.008) };
    let rim = layout.length(0.0016).max(1.0);
    canvas.fill(&whole, |p, distance| {
        let hole = inside.distance(p);
        let cover = (hole + 0.5).clamp(0.0, 1.0);
        if cover <= 0.0 {
            return ink(Vec3::ZERO, 0.0);
        }
        // Side boards run up the table, the others across.
        let along = if p.x < field.x || p.x > field.right() { p } else { vec2(p.y, p.x) };
        let outer_edge = smooth(-layout.length(0.005), 0.0, distance) * whole.normal(p).dot(LIGHT);
        let shade = 0.9 + 0.55 * outer_edge;
        let steel = 1.0 - smooth(rim, rim + 1.0, hole);
        let color = (wood(along, layout.scale) * shade).lerp(STEEL * (0.5 - 0.3 * inside.normal(p).dot(LIGHT)), steel);
        ink(color, cover)
    });
    let screw = layout.length(0.0035).max(1.5);
    let inset = layout.length(0.010);
    for x in [outer.x + inset, outer.right() - inset] {
        for y in [outer.y + inset, outer.center().y, outer.bottom() - inset] {
            canvas.tube(&Shape::circle(vec2(x, y), screw), screw, IVORY * 0.55, 0.3);
        }
    }
}
