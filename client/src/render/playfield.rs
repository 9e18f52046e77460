//! The painted board itself: all that is flat. What stands on it is in `furniture`.

use macroquad::math::{Rect, Vec2, Vec3, vec2};
use shared::table::TableFile;
use shared::table::format::{ElementFile, LightColor, LineFile, PlungerFile, Point};

use super::canvas::{Canvas, LIGHT, clouds, glow, hills, ink, noise, smooth};
use super::inserts::{arrow_ahead, insert_shape, metres, middle};
use super::layout::Layout;
use super::palette::{self, AMBER, DECOR, DUSK, NIGHT, STEEL, WOOD, WOOD_DARK};
use super::shape::{Shape, star};

/// Paints the board.
pub(super) fn paint(canvas: &mut Canvas, layout: &Layout, table: &TableFile) {
    let focus = focus(layout, table);
    ground(canvas, layout, focus);
    decor(canvas, layout, focus);
    for (center, seed) in pools(layout, focus).into_iter().zip(1..) {
        constellation(canvas, layout, center, seed);
    }
    planets(canvas, layout, focus);
    emblem(canvas, layout, table);
    for element in &table.elements {
        match element {
            ElementFile::Plunger(plunger) => shooter_lane(canvas, layout, table, plunger),
            ElementFile::Rollover(line) => rollover(canvas, layout, line),
            _ => {}
        }
    }
    for element in &table.elements {
        if let ElementFile::Light(light) = element {
            let color = palette::light(light.color);
            if let Some(ahead) = arrow_ahead(table, light).filter(|_| light.color == LightColor::Red) {
                chevrons(canvas, layout.written(light.center), ahead, layout.length(light.radius), color);
            }
            insert(canvas, layout, &insert_shape(layout, table, light), color);
        }
    }
}

/// Bumpers within this distance of one belong to its group, metres.
const GROUP: f64 = 0.25;

/// Where the eye should go first: the middle of the largest group of bumpers, or somewhat above the middle of the table.
fn focus(layout: &Layout, table: &TableFile) -> Vec2 {
    let bumper = |element: &ElementFile| match element {
        ElementFile::Bumper(bumper) => Some(bumper.center),
        _ => None,
    };
    let centers: Vec<Point> = table.elements.iter().filter_map(bumper).collect();
    let group = |around: Point| {
        let is_near = move |center: &&Point| metres(**center).distance(metres(around)) < GROUP as f32;
        centers.iter().filter(is_near).map(|center| layout.written(*center))
    };
    let Some(&best) = centers.iter().max_by_key(|center| group(**center).count()) else {
        return layout.written((table.size.0 / 2.0, table.size.1 * 0.65));
    };
    group(best).sum::<Vec2>() / group(best).count() as f32
}

/// The middles of further light and decor on a table so long that the focus is far from its ends.
fn pools(layout: &Layout, focus: Vec2) -> Vec<Vec2> {
    let field = layout.playfield();
    let lower = lower_light(layout);
    let between = |from: Vec2, to: Vec2| {
        // A cast saturates.
        let count = ((to.y - from.y) / (field.w * 1.1) - 0.5).max(0.0) as u8;
        (1..=count).map(move |place| from.lerp(to, f32::from(place) / f32::from(count + 1)))
    };
    let upper = vec2(field.center().x, field.y);
    between(upper, focus).chain(between(focus, lower)).collect()
}

/// The middle of the twilight at the lower end.
fn lower_light(layout: &Layout) -> Vec2 {
    let field = layout.playfield();
    vec2(field.center().x, field.bottom() - field.w * 0.58)
}

/// Dark blue, lit from the focus, with the lower end in twilight.
fn ground(canvas: &mut Canvas, layout: &Layout, focus: Vec2) {
    let field = layout.playfield();
    let unit = field.w;
    // Their middles, and how bright they are beside the focus.
    let mut dim: Vec<(Vec2, f32)> = pools(layout, focus).into_iter().map(|center| (center, 0.62)).collect();
    dim.push((lower_light(layout), 0.42));
    canvas.wash(field, |p| {
        let near = 1.0 - smooth(0.0, unit * 1.08, p.distance(focus));
        let low = |(center, strength): &(Vec2, f32)| {
            strength * (1.0 - smooth(0.0, unit * 0.71, ((p - *center) * vec2(1.0, 0.8)).length()))
        };
        let lit = (near * 0.85 + dim.iter().map(low).fold(0.0, f32::max)).min(1.0);
        // A hint of violet nebula, so that the blue is not flat.
        let cloud = clouds(p / (unit * 0.22));
        let violet = Vec3::new(0.10, 0.02, 0.13) * smooth(0.42, 0.8, cloud) * (0.35 + 0.65 * lit);
        ink(NIGHT.lerp(DUSK, lit * (0.75 + 0.25 * cloud)) + violet, 1.0)
    });
}

/// Painted stars, joined by lines: for the parts of a long table that have no other decor.
fn constellation(canvas: &mut Canvas, layout: &Layout, center: Vec2, seed: i32) {
    let unit = layout.playfield().w;
    const STARS: u8 = 7;
    let star_at = |place: u8| {
        let chance = |of: i32| noise(seed * 16 + of, i32::from(place) + 3) - 0.5;
        let along = (f32::from(place) / f32::from(STARS - 1) - 0.5) * 0.62;
        center + vec2(along + 0.06 * chance(1), 0.34 * chance(2) - along * 0.35) * unit
    };
    for place in 1..STARS {
        let line = Shape::rod(star_at(place - 1), star_at(place), (unit * 0.0016).max(0.5));
        canvas.flat(&line, ink(DECOR, 0.30));
    }
    for place in 0..STARS {
        let size = unit * (0.016 + 0.012 * noise(seed, i32::from(place)));
        let sign = star(star_at(place), 5, size, size * 0.42, 0.0);
        canvas.halo(&sign, size * 1.6, DECOR, 0.30);
        canvas.flat(&sign, ink(AMBER.lerp(DECOR, 0.45), 0.55));
    }
}

/// A great star behind the bumpers, its rays, orbits around it and a sky of small stars. All fainter than anything
/// that a ball can hit.
fn decor(canvas: &mut Canvas, layout: &Layout, focus: Vec2) {
    let field = layout.playfield();
    let unit = field.w;

    // Sky: one star at most in each cell of a grid.
    let cell = unit * 0.035;
    canvas.wash(field, |p| {
        let place = (p / cell).floor();
        let (x, y) = (place.x as i32, place.y as i32);
        if noise(x * 3 + 1, y * 7) > 0.42 {
            return ink(Vec3::ZERO, 0.0);
        }
        let center = (place + 0.2 + 0.6 * vec2(noise(x, y), noise(y, x + 99))) * cell;
        let size = 0.35 + 0.9 * noise(x + 17, y).powi(3);
        let fade = (1.3 * size - p.distance(center)).clamp(0.0, 1.0);
        glow(Vec3::new(0.75, 0.82, 1.0), fade * (0.16 + 0.3 * noise(x, y + 5)))
    });

    // Rays.
    let reach = unit * 0.62;
    canvas.wash(Rect::new(focus.x - reach, focus.y - reach, 2.0 * reach, 2.0 * reach).clipped(field), |p| {
        let from = p - focus;
        let angle = from.x.atan2(-from.y);
        let ray = smooth(0.35, 0.8, (angle * 10.0).cos());
        let fade = smooth(reach, unit * 0.1, from.length());
        glow(DECOR, 0.11 * ray * fade)
    });

    // The star: each of its five points half bright, half dark, as if folded.
    let great = star(focus, 5, unit * 0.31, unit * 0.125, 0.0);
    canvas.halo(&great, unit * 0.05, DECOR, 0.10);
    canvas.fill(&great, |p, distance| {
        let from = p - focus;
        let angle = from.x.atan2(-from.y).rem_euclid(std::f32::consts::TAU / 5.0);
        let bright = angle < std::f32::consts::TAU / 10.0;
        let rim = smooth(-unit * 0.012, 0.0, distance);
        ink(DECOR, if bright { 0.20 } else { 0.09 } + 0.10 * rim)
    });
    canvas.outline(&great, (unit * 0.004).max(1.0), ink(DECOR, 0.35));

    for (radius, alpha) in [(0.36, 0.22), (0.385, 0.10)] {
        canvas.outline(&Shape::circle(focus, unit * radius), (unit * 0.003).max(1.0), ink(DECOR, alpha));
    }
}

/// The limb of a planet that rises behind the flippers, and a small ringed one below the focus.
fn planets(canvas: &mut Canvas, layout: &Layout, focus: Vec2) {
    let field = layout.playfield();
    let unit = field.w;

    let center = vec2(field.center().x - unit * 0.03, field.bottom() + unit * 0.36);
    let radius = unit * 0.86;
    let globe = Shape::circle(center, radius);
    let air = unit * 0.09;
    let area = globe.bounds().grown(air).clipped(field);
    canvas.wash(area, |p| {
        let distance = globe.distance(p);
        let cover = (0.5 - distance).clamp(0.0, 1.0);
        if cover <= 0.0 {
            return ink(Vec3::ZERO, 0.0);
        }
        let continents = clouds((p - center) / (unit * 0.17));
        let land = DECOR.lerp(Vec3::new(0.35, 0.22, 0.62), smooth(0.44, 0.58, continents));
        // Lit from above: bright along the limb, night further in.
        let day = smooth(-unit * 0.30, 0.0, distance);
        ink(land * (0.08 + 0.34 * day), 0.9 * cover)
    });
    canvas.wash(area, |p| {
        let distance = globe.distance(p);
        let outside = 1.0 - (distance.max(0.0) / air).min(1.0);
        let inside = 1.0 - (-distance.min(0.0) / (air * 0.35)).min(1.0);
        let side = 1.0 - ((p.x - center.x) / (unit * 0.55)).abs().min(1.0);
        glow(Vec3::new(0.35, 0.62, 1.0), 0.42 * (outside * inside).powi(2) * side)
    });

    let center = focus + vec2(0.20, 0.347) * unit;
    let radius = unit * 0.058;
    canvas.halo(&Shape::circle(center, radius), radius * 1.4, DECOR, 0.10);
    canvas.fill(&Shape::circle(center, radius), |p, _| {
        let flat = (p - center) / radius;
        let day = smooth(-0.9, 1.0, flat.dot(LIGHT));
        let bands = 0.85 + 0.15 * ((flat.y + flat.x * 0.25) * 9.0).sin();
        ink(Vec3::new(0.40, 0.30, 0.66) * (0.16 + 0.80 * day) * bands, 1.0)
    });
    // The ring is a flattened circle; its far half is behind the planet.
    let tilt = vec2(0.966, -0.259);
    let reach = radius * 2.1;
    canvas.wash(Rect::new(center.x - reach, center.y - reach, 2.0 * reach, 2.0 * reach), |p| {
        let (along, across) = ((p - center).dot(tilt), (p - center).dot(tilt.perp()));
        let away = vec2(along, across * 4.2).length();
        let band = smooth(radius * 0.30, radius * 0.20, (away - radius * 1.65).abs());
        let behind = across < 0.0 && p.distance(center) < radius;
        ink(Vec3::new(0.62, 0.58, 0.85), if behind { 0.0 } else { 0.5 * band })
    });
}

/// A ring with a star on the open floor between the slingshots.
fn emblem(canvas: &mut Canvas, layout: &Layout, table: &TableFile) {
    let mut pivots: Vec<Vec2> = table
        .elements
        .iter()
        .filter_map(|element| match element {
            ElementFile::Flipper(flipper) => Some(layout.written(flipper.pivot)),
            _ => None,
        })
        .collect();
    // Those of the two lowest flippers: others stand higher up.
    pivots.sort_by(|a, b| b.y.total_cmp(&a.y));
    let [first, last, ..] = pivots.as_slice() else { return };
    let unit = layout.playfield().w;
    let center = (*first + *last) / 2.0 - vec2(0.0, unit * 0.33);
    let radius = unit * 0.13;
    for (share, alpha) in [(1.0, 0.45), (0.86, 0.20)] {
        canvas.outline(&Shape::circle(center, radius * share), (unit * 0.005).max(1.0), ink(DECOR, alpha));
    }
    canvas.halo(&Shape::circle(center, radius * 0.2), radius * 1.2, DECOR, 0.16);
    let sign = star(center, 5, radius * 0.72, radius * 0.29, 0.0);
    canvas.fill(&sign, |p, _| {
        let from = p - center;
        let angle = from.x.atan2(-from.y).rem_euclid(std::f32::consts::TAU / 5.0);
        ink(AMBER, if angle < std::f32::consts::TAU / 10.0 { 0.34 } else { 0.20 })
    });
    canvas.outline(&sign, 1.0, ink(AMBER, 0.4));
    // Small ticks around the ring, as on a compass.
    for tick in 0..24 {
        let ahead = super::shape::direction(tick as f32 * std::f32::consts::TAU / 24.0);
        let length = if tick % 6 == 0 { 1.22 } else { 1.1 };
        let line = Shape::rod(center + ahead * radius * 1.05, center + ahead * radius * length, unit * 0.0025);
        canvas.flat(&line, ink(DECOR, 0.4));
    }
}

/// Boards of wood with the grain along y; `p` in pixels.
pub(super) fn wood(p: Vec2, scale: f32) -> Vec3 {
    let grain = vec2(p.x * 420.0, p.y * 14.0) / scale;
    let bend = hills(p * 9.0 / scale) * 3.0;
    let rings = hills(grain + bend) * 0.7 + hills(grain * 2.7 + bend) * 0.3;
    WOOD_DARK.lerp(WOOD, 0.25 + 0.75 * rings)
}

/// The lane from which the plunger launches: wood, up to where the wall beside it ends.
fn shooter_lane(canvas: &mut Canvas, layout: &Layout, table: &TableFile, plunger: &PlungerFile) {
    let near = |x: f64, edge: f64| (x - edge).abs() < 0.012;
    // The wall at the left of the lane ends somewhere; the lane's wood ends there, too.
    let wall_points = table.elements.iter().filter_map(|element| match element {
        ElementFile::Wall(wall) if wall.points.iter().all(|point| near(point.0, plunger.from.0)) => Some(&wall.points),
        _ => None,
    });
    let top = wall_points.flatten().map(|point| point.1).fold(plunger.from.1, f64::max);
    let corner = layout.written((plunger.from.0 - 0.003, top));
    let end = layout.written((plunger.to.0 + 0.003, 0.0));
    let lane = Rect::new(corner.x, corner.y, end.x - corner.x, end.y - corner.y);
    let middle = lane.center().x;
    // Rounded at its upper end; the lower one is below the frame.
    let groove = Shape::Plate { rect: Rect::new(lane.x, lane.y, lane.w, lane.h + lane.w), corner: lane.w / 2.0 };
    canvas.outline(&groove, layout.length(0.004), ink(Vec3::ZERO, 0.45));
    canvas.fill(&groove, |p, _| {
        // Hollow: darker at the sides, worn bright in the middle.
        let across = ((p.x - middle) / (lane.w / 2.0)).abs();
        ink(wood(p, layout.scale) * (1.15 - 0.6 * across * across), 1.0)
    });
    // Marks of strength beside the plunger's way.
    for step in 0..6_u8 {
        let y = layout.written((0.0, plunger.from.1 + 0.05 + 0.028 * f64::from(step))).y;
        let length = lane.w * if step % 5 == 0 { 0.34 } else { 0.2 };
        let line = Shape::rod(vec2(middle - length, y), vec2(middle + length, y), layout.length(0.0009));
        canvas.flat(&line, ink(AMBER, 0.35));
    }
}

/// A slot with a wire in it, along the way of the ball.
fn rollover(canvas: &mut Canvas, layout: &Layout, line: &LineFile) {
    let (from, to) = (layout.written(line.from), layout.written(line.to));
    let along = (to - from).perp().normalize_or_zero() * layout.length(0.011);
    let center = layout.written(middle(line.from, line.to));
    let slot = Shape::rod(center - along, center + along, layout.length(0.0030));
    canvas.flat(&slot, ink(Vec3::ZERO, 0.75));
    canvas.outline(&slot, 1.0, ink(DECOR, 0.5));
    let radius = layout.length(0.0014).max(0.8);
    canvas.tube(&Shape::rod(center - along * 0.8, center + along * 0.8, radius), radius, STEEL, 0.35);
}

/// Painted marks that lead up to an arrow, fainter the farther they are from it.
fn chevrons(canvas: &mut Canvas, center: Vec2, ahead: Vec2, radius: f32, color: Vec3) {
    let side = ahead.perp() * radius * 0.8;
    for (step, alpha) in [(2.2, 0.42), (3.4, 0.30), (4.6, 0.18)] {
        let tip = center - ahead * radius * step;
        let wings = [tip - ahead * radius * 0.6 - side, tip, tip - ahead * radius * 0.6 + side];
        canvas.flat(&Shape::Path { points: wings.to_vec(), radius: radius * 0.16 }, ink(color, alpha));
    }
}

/// An insert that is not lit: dark glass in a painted ring.
fn insert(canvas: &mut Canvas, layout: &Layout, shape: &Shape, color: Vec3) {
    let rim = layout.length(0.0018).max(1.0);
    canvas.wash(shape.bounds().grown(rim * 2.0), |p| {
        let distance = shape.distance(p);
        let cover = (rim + 0.5 - distance).clamp(0.0, 1.0);
        if cover <= 0.0 {
            return ink(Vec3::ZERO, 0.0);
        }
        let ring = Vec3::splat(0.72).lerp(color, 0.30) * (0.68 + 0.32 * shape.normal(p).dot(LIGHT));
        ink(ring, cover * 0.85)
    });
    let center = shape.bounds().center();
    let reach = shape.bounds().h / 2.0;
    canvas.fill(shape, |p, _| {
        let depth = smooth(-1.0, 1.0, (p - center).dot(-LIGHT) / reach);
        ink(color * (0.20 + 0.24 * depth), 1.0)
    });
}

/// Rectangles that the painter needs.
trait Area {
    /// Wider by `margin` on every side.
    fn grown(self, margin: f32) -> Rect;
    /// The part inside another; empty if there is none.
    fn clipped(self, other: Rect) -> Rect;
}

impl Area for Rect {
    fn grown(self, margin: f32) -> Rect {
        Rect::new(self.x - margin, self.y - margin, self.w + 2.0 * margin, self.h + 2.0 * margin)
    }

    fn clipped(self, other: Rect) -> Rect {
        self.intersect(other).unwrap_or_default()
    }
}
