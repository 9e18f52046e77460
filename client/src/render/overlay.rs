//! Draws the overlay: thin lines over the table, words beside it. What they mean is the business of whoever made them.

use macroquad::color::Color;
use macroquad::math::{Rect, Vec2, Vec3, vec2};

use super::atlas::{Batch, Sprite};
use super::dot_matrix::{Fonts, ROWS, measure};
use super::layout::Layout;
use super::palette::{AMBER, ICE, IVORY, RED, tint};
use super::panels::Panels;
use super::sprites::Sprites;
use crate::view::{Mark, OverlayCircle, OverlayLabel, OverlayLine, OverlayView};

/// Corners of what is drawn for a circle.
const CORNERS: u8 = 28;
/// Pixels of a dash and of the gap after it.
const DASH: (f32, f32) = (7.0, 5.0);
/// How much the table is darkened, so that lines stand out.
const DIM: f32 = 0.62;

const GREEN: Vec3 = Vec3::new(0.35, 1.0, 0.50);
const ORANGE: Vec3 = Vec3::new(1.0, 0.55, 0.10);
const MAGENTA: Vec3 = Vec3::new(1.0, 0.45, 0.95);

/// What the overlay is drawn with.
pub(super) struct OverlayPainter<'a> {
    pub(super) layout: &'a Layout,
    pub(super) panels: &'a Panels,
    pub(super) sprites: &'a Sprites<Sprite>,
    pub(super) fonts: &'a Fonts,
    pub(super) batch: &'a mut Batch,
}

impl OverlayPainter<'_> {
    /// Over the table as it is drawn. The words beside it are drawn by [`Self::words`].
    pub(super) fn draw(&mut self, overlay: &OverlayView) {
        self.batch.stretch(self.sprites.dot, self.layout.seen_playfield(), tint(Vec3::ZERO, DIM));
        for line in &overlay.lines {
            self.line(line);
        }
        for circle in &overlay.circles {
            self.circle(circle);
        }
        for label in &overlay.labels {
            self.label(label);
        }
    }

    /// Lines are at least a pixel wide, and a little wider in a large window.
    fn width(&self, mark: Mark) -> f32 {
        let unit = (self.layout.scale / 700.0).max(1.0);
        let width = match mark {
            Mark::Support => 3.6,
            Mark::Flight | Mark::Velocity | Mark::Impact | Mark::Ball => 2.4,
            Mark::Normal | Mark::OtherFloor => 1.4,
            Mark::Solid | Mark::OneWay | Mark::Passed | Mark::Moving => 1.9,
        };
        width * unit
    }

    fn line(&mut self, line: &OverlayLine) {
        let (width, color) = (self.width(line.mark), color(line.mark));
        let points: Vec<Vec2> = line.points.iter().map(|point| self.layout.point(*point)).collect();
        if matches!(line.mark, Mark::Flight | Mark::Passed) {
            return self.dashes(&points, width, color);
        }
        for ends in points.windows(2) {
            self.bar(ends[0], ends[1], width, color);
        }
    }

    /// Dashes of one length along a line, whatever its pieces.
    fn dashes(&mut self, points: &[Vec2], width: f32, color: Color) {
        let whole = DASH.0 + DASH.1;
        let mut way = 0.0;
        for ends in points.windows(2) {
            let (length, ahead) = (ends[0].distance(ends[1]), (ends[1] - ends[0]).normalize_or_zero());
            let mut from = 0.0;
            while from < length {
                let phase = (way + from) % whole;
                let until = (from + if phase < DASH.0 { DASH.0 - phase } else { whole - phase }).max(from + 0.01);
                if phase < DASH.0 {
                    self.bar(ends[0] + ahead * from, ends[0] + ahead * until.min(length), width, color);
                }
                from = until;
            }
            way += length;
        }
    }

    fn bar(&mut self, from: Vec2, to: Vec2, width: f32, color: Color) {
        self.batch.bar(self.sprites.bar, from, to, width, color);
    }

    /// A circle of radius 0 is a dot.
    fn circle(&mut self, circle: &OverlayCircle) {
        let (center, color) = (self.layout.point(circle.center), color(circle.mark));
        let radius = circle.radius * self.layout.scale;
        if radius <= 0.0 {
            let side = (self.width(circle.mark) * 1.3).round().max(2.0);
            let corner = (center - side / 2.0).round();
            return self.batch.stretch(self.sprites.dot, Rect::new(corner.x, corner.y, side, side), color);
        }
        let corner = |index: u8| {
            let turn = f32::from(index) / f32::from(CORNERS) * std::f32::consts::TAU;
            center + Vec2::from_angle(turn) * radius
        };
        let width = self.width(circle.mark);
        (0..CORNERS).for_each(|index| self.bar(corner(index), corner(index + 1), width, color));
    }

    /// Beside its place, on the side on which there is room, on a dark ground.
    fn label(&mut self, label: &OverlayLabel) {
        let pitch = self.pitch(self.panels.small / 2);
        let size = measure(&label.text, pitch);
        let field = self.layout.seen_playfield();
        let place = self.layout.point(label.place);
        if !field.contains(place) {
            return;
        }
        // A ball's own words stand above it, those of what it meets below.
        let gap = self.layout.length(0.020);
        let down = if label.mark == Mark::Impact { gap } else { -gap - size.y };
        let margin = f32::from(pitch) * 2.0;
        let mut corner = vec2(place.x + gap * 0.7, place.y + down);
        if corner.x + size.x + margin > field.right() {
            corner.x = place.x - gap * 0.7 - size.x;
        }
        corner = corner.clamp(
            vec2(field.x, field.y) + margin,
            (vec2(field.right(), field.bottom()) - size).max(vec2(field.x, field.y) + margin),
        );
        let ground = Rect::new(corner.x - margin, corner.y - margin, size.x + 2.0 * margin, size.y + 2.0 * margin);
        self.batch.stretch(self.sprites.dot, ground, tint(Vec3::ZERO, 0.75));
        self.fonts.line(self.batch, &label.text, corner, pitch, color(label.mark));
    }

    /// The largest distance between dots up to `wanted` that there is a font for; else the smallest.
    fn pitch(&self, wanted: u16) -> u16 {
        self.fonts.fitting("", wanted, f32::INFINITY)
    }

    /// In the side panel, where onlookers are listed otherwise.
    pub(super) fn words(&mut self, OverlayView { words, .. }: &OverlayView) {
        let area = self.panels.onlookers;
        let inset = (self.panels.padding * 1.2).round();
        let step = |pitch: u16| f32::from(ROWS * pitch) * 1.5;
        let widest = |pitch: u16| words.iter().map(|(_, text)| measure(text, pitch).x).fold(0.0, f32::max);
        let fits = |pitch: &u16| words.len() as f32 * step(*pitch) <= area.h && widest(*pitch) <= area.w - 2.0 * inset;
        let known = (1..=self.panels.small).rev().map(|pitch| self.pitch(pitch));
        let pitch = known.into_iter().find(fits).unwrap_or_else(|| self.pitch(1));
        // A cast saturates.
        let room = (area.h / step(pitch)) as usize;
        for ((mark, text), line) in words.iter().take(room).zip(0_u8..) {
            let corner = vec2(area.x + inset, area.y + f32::from(line) * step(pitch));
            self.fonts.line(self.batch, text, corner, pitch, color(*mark));
        }
    }
}

fn color(mark: Mark) -> Color {
    match mark {
        Mark::Solid => tint(IVORY, 1.0),
        Mark::OneWay | Mark::Moving => tint(ORANGE, 1.0),
        Mark::Passed => tint(GREEN, 0.9),
        Mark::OtherFloor => tint(ICE, 0.45),
        Mark::Normal => tint(ICE, 0.75),
        Mark::Support => tint(AMBER, 1.0),
        Mark::Ball => tint(Vec3::ONE, 1.0),
        Mark::Velocity => tint(GREEN.lerp(Vec3::ONE, 0.2), 1.0),
        Mark::Flight => tint(MAGENTA, 1.0),
        Mark::Impact => tint(RED.lerp(Vec3::ONE, 0.25), 1.0),
    }
}
