//! Art around the table: the room, the two panels with their displays' glass, and the lettering of the name.

use macroquad::math::{Rect, Vec2, Vec3, vec2};

use super::canvas::{Canvas, LIGHT, glow, ink, noise, smooth};
use super::layout::Layout;
use super::palette::{AMBER, DECOR, GLASS, ICE, IVORY, NIGHT, PLASTIC, PRINT, STEEL};
use super::panels::Panels;
use super::shape::{Shape, star};

/// Paints every pixel of the picture with the room, and the panels over it.
pub(super) fn paint(canvas: &mut Canvas, layout: &Layout, panels: &Panels) {
    room(canvas, layout);
    for panel in [layout.main_panel, layout.side_panel] {
        if panel.w >= 40.0 && panel.h >= 40.0 {
            plate(canvas, panel, panels.padding);
        }
    }
    if panels.title.h >= 20.0 {
        title(canvas, panels.title);
    }
    for part in [panels.onlookers, panels.keys] {
        // A line that sets this part of the panel off from what is above it.
        let y = part.y - 1.2 * panels.padding;
        if part.h > panels.padding {
            track(canvas, vec2(part.x, y), vec2(part.right(), y));
        }
    }
    for display in panels.displays() {
        glass(canvas, display, panels.padding);
    }
}

/// The dark around the table, a little lighter near it.
pub(super) fn room(canvas: &mut Canvas, layout: &Layout) {
    let size = layout.size.to_vec();
    let middle = layout.cabinet.center();
    canvas.wash(Rect::new(0.0, 0.0, size.x, size.y), |p| {
        let near = 1.0 - smooth(0.0, size.max_element() * 0.7, p.distance(middle));
        let grain = noise(p.x as i32, p.y as i32) * 0.008;
        ink(Vec3::new(0.012, 0.014, 0.03).lerp(Vec3::new(0.035, 0.045, 0.10), near) + grain, 1.0)
    });
    canvas.shadow(&Shape::Plate { rect: layout.cabinet, corner: 4.0 }, layout.length(0.02), 0.8);
}

/// A panel of dark metal.
fn plate(canvas: &mut Canvas, panel: Rect, padding: f32) {
    let rect = Rect::new(panel.x + padding, panel.y + padding, panel.w - 2.0 * padding, panel.h - 2.0 * padding);
    let shape = Shape::Plate { rect, corner: padding * 1.5 };
    canvas.shadow(&shape, padding * 0.8, 0.6);
    canvas.fill(&shape, |p, _| {
        let down = (p.y - rect.y) / rect.h.max(1.0);
        let brushed = noise(p.y as i32, 3) * 0.012;
        ink(Vec3::new(0.075, 0.09, 0.19).lerp(Vec3::new(0.03, 0.035, 0.085), down) + brushed, 1.0)
    });
    canvas.bevel(&shape, (padding * 0.35).max(1.5), 0.4);
    canvas.outline(&shape, 1.0, ink(DECOR, 0.35));
}

/// The window of a display: black glass in a steel rim, sunk into the panel.
fn glass(canvas: &mut Canvas, rect: Rect, padding: f32) {
    if rect.w < 4.0 || rect.h < 4.0 {
        return;
    }
    let shape = Shape::Plate { rect, corner: padding * 0.5 };
    let rim = (padding * 0.22).max(1.0);
    canvas.fill(&shape, |p, distance| {
        let dark = GLASS * (1.0 - 0.6 * smooth(-rim * 5.0, -rim, distance));
        let is_rim = smooth(-rim - 0.5, -rim + 0.5, distance);
        if is_rim <= 0.0 {
            return ink(dark, 1.0);
        }
        let edge = shape.normal(p).dot(LIGHT);
        ink(dark.lerp(STEEL * (0.30 - 0.16 * edge), is_rim), 1.0)
    });
    // A reflection of the room in the upper part.
    let inner = Rect::new(rect.x + rim, rect.y + rim, rect.w - 2.0 * rim, rect.h - 2.0 * rim);
    canvas.wash(inner, |p| {
        glow(ICE, 0.022 * smooth(0.55, 0.0, (p.y - inner.y) / inner.h + (p.x - inner.x) / inner.w * 0.3))
    });
}

/// Strokes of a letter, in a square from (0, 0) at the upper left to (1, 1).
type Strokes = &'static [&'static [(f32, f32)]];

const S: Strokes = &[&[
    (0.90, 0.14),
    (0.76, 0.0),
    (0.24, 0.0),
    (0.08, 0.13),
    (0.08, 0.36),
    (0.24, 0.49),
    (0.76, 0.51),
    (0.92, 0.64),
    (0.92, 0.87),
    (0.76, 1.0),
    (0.22, 1.0),
    (0.08, 0.87),
]];
const T: Strokes = &[&[(0.02, 0.0), (0.98, 0.0)], &[(0.5, 0.0), (0.5, 1.0)]];
const A: Strokes = &[&[(0.02, 1.0), (0.5, 0.0), (0.98, 1.0)], &[(0.22, 0.68), (0.78, 0.68)]];
const R: Strokes = &[
    &[(0.08, 1.0), (0.08, 0.0), (0.74, 0.0), (0.92, 0.14), (0.92, 0.39), (0.74, 0.53), (0.08, 0.53)],
    &[(0.5, 0.53), (0.94, 1.0)],
];
const B: Strokes = &[
    &[(0.70, 0.48), (0.08, 0.48), (0.08, 0.0), (0.70, 0.0), (0.86, 0.12), (0.86, 0.36), (0.70, 0.48)],
    &[(0.70, 0.48), (0.93, 0.62), (0.93, 0.87), (0.76, 1.0), (0.08, 1.0), (0.08, 0.48)],
];
const L: Strokes = &[&[(0.08, 0.0), (0.08, 1.0), (0.92, 1.0)]];

/// The game's name, letter by letter.
const NAME: [Strokes; 8] = [S, T, A, R, B, A, L, L];

/// The name across a rectangle, a star behind it, a line like a ball's track below.
fn title(canvas: &mut Canvas, area: Rect) {
    let pitch = area.w / NAME.len() as f32;
    let height = (area.h * 0.46).min(pitch * 1.35);
    let width = pitch * 0.70;
    let stroke = (width * 0.115).max(1.0);
    let center = area.center();
    let reach = (area.h * 0.50).min(area.w * 0.40);
    let behind = star(center, 5, reach, reach * 0.40, 0.0);
    canvas.halo(&Shape::circle(center, reach * 0.2), reach * 1.05, PRINT, 0.16);
    // Two orbits, and the ball on one of them.
    for (share, alpha) in [(0.84, 0.5), (0.92, 0.2)] {
        canvas.outline(&Shape::circle(center, reach * share), 1.0, ink(DECOR, alpha));
    }
    let ball = Shape::circle(center + vec2(0.80, -0.61) * reach * 0.835, reach * 0.06);
    canvas.shadow(&ball, reach * 0.03, 0.6);
    canvas.fill(&behind, |p, _| {
        let from = p - center;
        let angle = from.x.atan2(-from.y).rem_euclid(std::f32::consts::TAU / 5.0);
        let bright = angle < std::f32::consts::TAU / 10.0;
        ink(if bright { PLASTIC.lerp(PRINT, 0.32) } else { PLASTIC * 0.9 }, 1.0)
    });
    canvas.bevel(&behind, reach * 0.04, 0.35);
    canvas.tube(&ball, reach * 0.06, STEEL, 0.45);

    let top = center.y - height / 2.0;
    for (place, strokes) in NAME.iter().enumerate() {
        let left = area.x + pitch * (place as f32 + 0.5) - width / 2.0;
        let at = |&(x, y): &(f32, f32)| vec2(left + x * width, top + y * height);
        let path =
            |points: &&[(f32, f32)], radius: f32| Shape::Path { points: points.iter().map(at).collect(), radius };
        let letter = |radius: f32| Shape::Union(strokes.iter().map(|points| path(points, radius)).collect());
        canvas.shadow(&letter(stroke * 1.7), stroke, 0.7);
        canvas.flat(&letter(stroke * 1.8), ink(NIGHT, 1.0));
        canvas.outline(&letter(stroke * 1.8), 1.0, ink(AMBER, 0.7));
        let face = letter(stroke);
        canvas.fill(&face, |p, distance| {
            let down = ((p.y - top) / height).clamp(0.0, 1.0);
            // A horizon in the middle, as chrome lettering has.
            let sky = ICE.lerp(IVORY, smooth(0.0, 0.5, down));
            let ground = AMBER.lerp(IVORY, smooth(0.5, 1.1, down) * 0.7);
            let color = if down < 0.52 { sky } else { ground };
            ink(color * (1.0 - 0.25 * smooth(-stroke * 0.5, 0.0, distance)), 1.0)
        });
    }
    track(canvas, vec2(area.x, area.bottom() - 1.0), vec2(area.right(), area.bottom() - 1.0));
}

/// A line that fades towards both ends.
fn track(canvas: &mut Canvas, from: Vec2, to: Vec2) {
    let middle = (from + to) / 2.0;
    canvas.wash(Rect::new(from.x, from.y - 1.0, to.x - from.x, 2.0), |p| {
        ink(AMBER, 0.6 * (1.0 - ((p.x - middle.x) / (to.x - middle.x)).abs()))
    });
}
