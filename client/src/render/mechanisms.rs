//! Standing targets, spinners, gates, saucers, holes and magnets: what of them stands still is painted once, what moves is drawn from the
//! view with every frame.

use macroquad::color::Color;
use macroquad::math::{Rect, Vec2, Vec3};
use shared::table::TableFile;
use shared::table::format::{ElementFile, MagnetFile, Point, SaucerFile, TargetFile};

use super::canvas::{Canvas, LIGHT, ink, smooth};
use super::layout::Layout;
use super::palette::{AMBER, COPPER, DECOR, ICE, IVORY, NIGHT, RED, STEEL, shine, tint};
use super::ramps::floor_of;
use super::scene::Stage;
use super::shape::{Shape, direction};
use crate::view::{BallView, ElementView};

/// How far axles hang above the board, metres: it sets the length of shadows.
const AXLE_HEIGHT: f64 = 0.0095;
/// Windings of a magnet's coil that are seen.
const WINDINGS: f32 = 4.0;
/// Share of its line that a plate is wide; the rest is axle.
const PLATE: f32 = 0.74;

/// Paints what stands still, on the board or above it: coils of magnets, holes, cups of saucers, axles of spinners and gates.
pub(super) fn paint(canvas: &mut Canvas, layout: &Layout, table: &TableFile, above: bool) {
    for element in table.elements.iter().filter(|element| (floor_of(element) > 0) == above) {
        match element {
            ElementFile::Magnet(magnet) => coil(canvas, layout, magnet),
            ElementFile::Hole(hole) if !above => slot(canvas, layout, hole.from, hole.to),
            ElementFile::Saucer(saucer) => cup(canvas, layout, table, saucer),
            ElementFile::Spinner(spinner) => axle(canvas, layout, spinner.from, spinner.to),
            ElementFile::Gate(gate) => axle(canvas, layout, gate.from, gate.to),
            _ => {}
        }
    }
}

/// A recess as wide as a ball, or as the circle that catches one: dark towards the light, since its wall stands there in
/// its own shadow, and with a rim of steel.
fn cup(canvas: &mut Canvas, layout: &Layout, table: &TableFile, saucer: &SaucerFile) {
    let center = layout.written(saucer.center);
    let radius = layout.length(saucer.radius.max(table.ball.radius)) * 1.12;
    let rim = layout.length(0.0026).max(1.2);
    let hole = Shape::circle(center, radius);
    canvas.halo(&Shape::circle(center, radius + rim), radius * 0.5, DECOR, 0.18);
    canvas.fill(&Shape::circle(center, radius + rim), |p, _| {
        let tilt = (p - center).normalize_or_zero().dot(LIGHT);
        ink(STEEL * (0.62 + 0.38 * tilt), 1.0)
    });
    canvas.fill(&hole, |p, distance| {
        let away = (p - center) / radius;
        let lit = smooth(-0.9, 1.0, away.dot(-LIGHT));
        let wall = smooth(-radius * 0.42, 0.0, distance);
        let floor = NIGHT * 0.35;
        ink(floor.lerp(STEEL * 0.55, wall * lit * 0.9), 1.0)
    });
    canvas.outline(&hole, 1.0, ink(Vec3::ZERO, 0.8));
}

/// The windings of a coil, seen through the board, around its core; and how far it reaches, as a faint line.
fn coil(canvas: &mut Canvas, layout: &Layout, magnet: &MagnetFile) {
    let center = layout.written(magnet.center);
    let core = layout.length(magnet.core);
    let whole = coil_radius(layout, magnet);
    let winding = (whole - core).max(1.0) / WINDINGS;
    let disc = Shape::circle(center, whole);
    canvas.fill(&disc, |p, _| {
        let away = p.distance(center);
        let tilt = (p - center).normalize_or_zero().dot(LIGHT);
        if away < core {
            return ink(STEEL * (0.30 + 0.16 * tilt), 0.9);
        }
        // Each winding is a wire: bright on its crest.
        let crest = ((away - core) / winding).fract() - 0.5;
        ink(COPPER * (0.40 + 0.55 * (1.0 - 4.0 * crest * crest) + 0.15 * tilt), 0.8)
    });
    canvas.outline(&disc, 1.0, ink(Vec3::ZERO, 0.7));
    canvas.outline(&Shape::circle(center, core), 1.0, ink(Vec3::ZERO, 0.6));
    canvas.outline(&Shape::circle(center, layout.length(magnet.radius)), 1.0, ink(COPPER, 0.22));
}

/// A coil is somewhat larger than its core, but no larger than its field.
fn coil_radius(layout: &Layout, magnet: &MagnetFile) -> f32 {
    layout.length((magnet.core * 1.9).min(magnet.radius.max(magnet.core)))
}

/// A gap in the board, with its edge of steel: there a ball goes to another floor.
fn slot(canvas: &mut Canvas, layout: &Layout, from: Point, to: Point) {
    let radius = layout.length(0.0040).max(1.5);
    let gap = Shape::rod(layout.written(from), layout.written(to), radius);
    canvas.flat(&gap, ink(Vec3::ZERO, 0.85));
    canvas.outline(&gap, layout.length(0.0012).max(1.0), ink(STEEL, 0.7));
}

/// A wire between two brackets.
fn axle(canvas: &mut Canvas, layout: &Layout, from: Point, to: Point) {
    let (from, to) = (layout.written(from), layout.written(to));
    let radius = layout.length(0.0010).max(0.7);
    let wire = Shape::rod(from, to, radius);
    canvas.shadow(&wire, layout.length(AXLE_HEIGHT), 0.5);
    canvas.tube(&wire, radius, STEEL, 0.4);
    let bracket = layout.length(0.0034).max(1.5);
    for end in [from, to] {
        canvas.shadow(&Shape::circle(end, bracket), layout.length(AXLE_HEIGHT) * 0.6, 0.5);
        canvas.tube(&Shape::circle(end, bracket), bracket, STEEL * 0.75, 0.4);
    }
}

impl Stage<'_> {
    /// An upright plate that stays: a coloured face towards the open table, a dark back behind it.
    pub(super) fn target(&mut self, target: &TargetFile, state: ElementView) {
        let (from, to) = (self.layout.written(target.from), self.layout.written(target.to));
        let (bar, center) = (self.sprites.bar, (from + to) / 2.0);
        let across = (to - from).perp().normalize_or_zero();
        let ahead = if across.dot(self.layout.playfield().center() - center) < 0.0 { -across } else { across };
        let depth = self.layout.length(0.0042).max(2.0);
        // A hit bends it back for a moment.
        let place = -ahead * depth * (0.5 + 0.8 * state.flash);
        let (from, to) = (from + place, to + place);
        let drop = -LIGHT * self.layout.length(0.0060);
        self.batch.bar(bar, from + drop, to + drop, depth * 1.8, tint(Vec3::ZERO, 0.5));
        let stem = center + place - ahead * depth * 1.6;
        self.batch.bar(bar, center + place, stem, depth * 1.6, tint(STEEL * 0.5, 1.0));
        self.batch.bar(bar, from, to, depth * 1.7, tint(NIGHT, 1.0));
        let face = ahead * depth * 0.3;
        let color = AMBER.lerp(IVORY, 0.9 * state.flash);
        self.batch.bar(bar, from + face, to + face, depth * 1.1, tint(color, 1.0));
        // A round mark, seen from above: a stripe.
        let (a, b) = (from.lerp(to, 0.36) + face, from.lerp(to, 0.64) + face);
        self.batch.bar(bar, a, b, depth * 1.1, tint(RED, 1.0));
        if state.flash > 0.0 {
            self.glow(center, self.layout.length(0.070), AMBER, state.flash * 0.9);
        }
    }

    /// A magnet that is on: its coil glows, and rings of light run into it.
    pub(super) fn magnet(&mut self, magnet: &MagnetFile, clock: f32) {
        let center = self.layout.written(magnet.center);
        let coil = coil_radius(self.layout, magnet);
        let reach = self.layout.length(magnet.radius);
        self.glow(center, coil * 3.4, ICE, 0.75);
        self.glow(center, coil * 1.5, IVORY, 0.45);
        let phase = (clock * 1.6).fract();
        for ring in 0..3_u8 {
            let share = 1.0 - (phase + f32::from(ring) / 3.0).fract();
            let radius = coil + (reach - coil) * share;
            let strength = 0.30 * (1.0 - share) * share * 4.0;
            self.ring(center, radius, shine(ICE, strength));
        }
    }

    /// A thin circle.
    fn ring(&mut self, center: Vec2, radius: f32, color: Color) {
        const SIDES: u8 = 40;
        let corner = |side: u8| center + direction(f32::from(side) / f32::from(SIDES) * std::f32::consts::TAU) * radius;
        let width = self.layout.length(0.0016).max(1.2);
        for side in 0..SIDES {
            self.batch.bar(self.sprites.bar, corner(side), corner(side + 1), width, color);
        }
    }

    /// A plate on its axle, seen from above: an edge while it hangs, its face or its back while it lies flat.
    pub(super) fn spinner(&mut self, (from, to): (Point, Point), lever: f64, state: ElementView) {
        let (from, to) = (self.layout.written(from), self.layout.written(to));
        let (sin, cos) = state.turn.sin_cos();
        let edge = self.layout.length(0.0022).max(2.0);
        let width = (2.0 * self.layout.length(lever) * sin.abs()).max(edge);
        let (a, b) = inner(from, to, PLATE);
        let drop = -LIGHT * self.layout.length(AXLE_HEIGHT) * 0.8;
        self.batch.bar(self.sprites.bar, a + drop, b + drop, width, tint(Vec3::ZERO, 0.42));
        // Bright when it faces the lamps above.
        let color = if sin >= 0.0 { RED } else { IVORY };
        let level = 0.55 + 0.45 * sin.abs();
        self.batch.bar(self.sprites.dot, a, b, width, tint(color * level, 1.0));
        if width > 2.0 * edge {
            let (c, d) = inner(a, b, 0.62);
            let mark = if sin >= 0.0 { IVORY } else { RED };
            self.batch.bar(self.sprites.dot, c, d, width * 0.42, tint(mark * level, 1.0));
        }
        // The lower edge is seen beside the axle, on the side to which the plate swings.
        let side = (to - from).perp().normalize_or_zero() * self.layout.length(lever) * sin * cos.signum();
        self.batch.bar(self.sprites.bar, a + side, b + side, edge * 0.6, tint(STEEL * 0.9, 1.0));
        self.batch.bar(self.sprites.rod, from, to, edge * 0.8, tint(STEEL, 1.0));
    }

    /// A wire that hangs from its axle, and swings up while a ball is under it.
    pub(super) fn gate(&mut self, (from, to): (Point, Point), lever: f64, state: ElementView) {
        let (from, to) = (self.layout.written(from), self.layout.written(to));
        let away = (to - from).perp().normalize_or_zero();
        let swing = away * self.layout.length(lever) * state.turn.sin();
        let width = self.layout.length(0.0020).max(1.8);
        let (a, b) = inner(from, to, 0.82);
        let (c, d) = (a + swing, b + swing);
        let drop = -LIGHT * self.layout.length(AXLE_HEIGHT) * 0.8;
        let shadow = tint(Vec3::ZERO, 0.42);
        self.batch.bar(self.sprites.bar, c + drop, d + drop, width * 1.4, shadow);
        for (one, other) in [(a, c), (b, d), (c, d)] {
            self.batch.bar(self.sprites.rod, one, other, width, tint(STEEL.lerp(ICE, 0.35), 1.0));
        }
    }

    /// A ball that lies in a saucer: deeper than the board, so a little smaller and in the shadow of the rim.
    pub(super) fn held_ball(&mut self, ball: BallView) {
        let at = self.layout.point(ball.position);
        let sprite = self.sprites.ball;
        let size = sprite.size * 0.92;
        let corner = at - size / 2.0;
        let dark = Vec3::splat(0.62);
        self.batch.stretch(sprite, Rect::new(corner.x, corner.y, size.x, size.y), tint(dark, 1.0));
    }
}

/// The middle part of a line.
fn inner(from: Vec2, to: Vec2, share: f32) -> (Vec2, Vec2) {
    (from.lerp(to, 0.5 - share / 2.0), from.lerp(to, 0.5 + share / 2.0))
}
