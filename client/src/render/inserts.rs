//! Inserts: the lights in the playfield. Their form says what they are for: an arrow points at what it wants hit, a
//! star belongs to a set that is collected, a disc marks a lane.

use macroquad::math::{Vec2, vec2};
use shared::table::TableFile;
use shared::table::format::{ElementFile, LightColor, LightFile, Point};

use super::layout::Layout;
use super::shape::{Shape, star};

/// An arrow's aim is at most this far from it, metres.
const AIM_DISTANCE: f32 = 0.13;

/// The outline of an insert, in pixels.
pub(super) fn insert_shape(layout: &Layout, table: &TableFile, light: &LightFile) -> Shape {
    let center = layout.written(light.center);
    let radius = layout.length(light.radius);
    match arrow_ahead(table, light) {
        Some(ahead) => arrow(center, radius * 1.3, ahead),
        None if light.color == LightColor::White => star(center, 5, radius * 1.3, radius * 0.62, 0.0),
        None => Shape::circle(center, radius),
    }
}

/// A broad arrow head with a notch, as large as a disc of `radius`.
fn arrow(center: Vec2, radius: f32, ahead: Vec2) -> Shape {
    let side = ahead.perp();
    let corner = |along: f32, across: f32| center + (ahead * along + side * across) * radius;
    Shape::Polygon(vec![corner(1.0, 0.0), corner(-0.75, 0.85), corner(-0.4, 0.0), corner(-0.75, -0.85)])
}

/// The middle of what an arrow asks for: blue ones the nearest target, red ones the nearest thing that a ball passes.
fn aim(table: &TableFile, light: &LightFile) -> Option<Point> {
    let away = |point: &Point| metres(*point).distance(metres(light.center));
    let aims = table.elements.iter().filter_map(|element| match element {
        ElementFile::DropTarget(target) | ElementFile::Target(target) if light.color == LightColor::Blue => {
            Some(middle(target.from, target.to))
        }
        ElementFile::Rollover(line) if light.color == LightColor::Red => Some(middle(line.from, line.to)),
        ElementFile::Spinner(spinner) if light.color == LightColor::Red => Some(middle(spinner.from, spinner.to)),
        ElementFile::Saucer(saucer) if light.color == LightColor::Red => Some(saucer.center),
        _ => None,
    });
    aims.filter(|point| away(point) < AIM_DISTANCE).min_by(|a, b| away(a).total_cmp(&away(b)))
}

/// A point as written in a table file.
pub(super) fn metres((x, y): Point) -> Vec2 {
    vec2(x as f32, y as f32)
}

/// The way in which an insert points, if it is an arrow.
pub(super) fn arrow_ahead(table: &TableFile, light: &LightFile) -> Option<Vec2> {
    let is_arrow = matches!(light.color, LightColor::Red | LightColor::Blue);
    let target = is_arrow.then(|| aim(table, light)).flatten()?;
    // y runs down the window.
    Some(((metres(target) - metres(light.center)) * vec2(1.0, -1.0)).normalize_or_zero())
}

/// Half way between two points.
pub(super) fn middle(from: Point, to: Point) -> Point {
    ((from.0 + to.0) / 2.0, (from.1 + to.1) / 2.0)
}
