//! Draws menus over the picture: a plate of dark glass with dots on it, and a ball that marks the focus.

mod cards;
mod layout;

use macroquad::color::{Color, WHITE};
use macroquad::math::{Rect, Vec2, Vec3, vec2};
use macroquad::texture::{DrawTextureParams, Image, RenderTarget, draw_texture_ex};

use super::atlas::{Batch, Packer, Sprite};
use super::canvas::{Canvas, ink};
use super::dot_matrix::{FontTickets, Fonts, ROWS, cells, measure};
use super::layout::PixelSize;
use super::palette::{AMBER, AMBER_DIM, DECOR, DOT_OFF, ICE, IVORY, NIGHT, RED, tint};
use super::shape::Shape;
use super::{Blending, preview, sprites};
use crate::menu::{Control, Item, MenuView, Page, Shelved};
use layout::{MenuLayout, Row};

/// How dark the picture is behind a page that lies over it, and behind the title, where the bot plays.
const DIM: f32 = 0.62;
const TITLE_DIM: f32 = 0.25;
/// Seconds of a cursor's blinking.
const BLINK: f32 = 1.0;

/// What menus are drawn with, for one size of the window.
pub(super) struct MenuPainter {
    size: PixelSize,
    /// How much larger than usual text is, and what that comes to.
    scale: f32,
    largest: u16,
    batch: Batch,
    fonts: Fonts,
    dot: Sprite,
    ball: Sprite,
    plate: Sprite,
    /// Pixels of the plate's corners.
    corner: f32,
    previews: Vec<Preview>,
    /// What was drawn last, and where: what a pointer hits is what is seen.
    last: Option<(MenuView, Rect, MenuLayout)>,
}

/// A picture of a table.
struct Preview {
    digest: u64,
    size: PixelSize,
    target: RenderTarget,
}

impl MenuPainter {
    /// Paints the sprites for a size of the window, and text `scale` times as large as usual.
    pub(super) fn new(size: PixelSize, scale: f32) -> Self {
        let largest = layout::largest(size.to_vec(), scale);
        let corner = f32::from(largest) * 4.0;
        let mut packer = Packer::default();
        let fonts = FontTickets::paint(&mut packer, 1..=layout::largest_title(largest));
        let dot = packer.add(sprites::dot());
        let ball = packer.add(sprites::ball(f32::from(largest) * 4.0));
        let plate = packer.add(plate(corner));
        let (picture, sprite) = packer.pack();
        let (dot, ball, plate) = (sprite(dot).inner_part(), sprite(ball), sprite(plate));
        Self {
            size,
            scale,
            largest,
            batch: Batch::new(&picture),
            fonts: fonts.resolve(&sprite),
            dot,
            ball,
            plate,
            corner,
            previews: Vec::new(),
            last: None,
        }
    }

    /// Whether it is for that.
    pub(super) fn fits(&self, size: PixelSize, scale: f32) -> bool {
        self.size == size && self.scale == scale
    }

    /// The item at a point of the picture, as it was drawn last.
    pub(super) fn hit(&self, at: Vec2) -> Option<(usize, f32)> {
        self.last.as_ref().and_then(|(_, _, layout)| layout.hit(at))
    }

    /// Says where a page stands. `panel`: where a short one may stand beside the table.
    pub(super) fn lay_out(&mut self, view: &MenuView, panel: Rect) {
        let is_known = self.last.as_ref().is_some_and(|(last, place, _)| last == view && *place == panel);
        if !is_known {
            let layout = MenuLayout::new(self.size.to_vec(), self.largest, panel, view);
            self.last = Some((view.clone(), panel, layout));
        }
    }

    /// Paints the picture of a table that has none yet: one a frame, so that none takes long.
    pub(super) fn paint_preview(&mut self, view: &MenuView, blending: &Blending) {
        let Some((_, _, layout)) = &self.last else { return };
        for row in &layout.rows {
            if let Some(Control::Table(shelved)) = view.items.get(row.item).map(|item| &item.control) {
                let place = preview::fitted(row.picture, &shelved.table.file);
                let size = PixelSize { width: place.w.max(1.0) as u16, height: place.h.max(1.0) as u16 };
                let is_there = |known: &Preview| known.digest == shelved.table.digest && known.size == size;
                if !self.previews.iter().any(is_there) {
                    self.previews.retain(|known| known.digest != shelved.table.digest);
                    let target = preview::paint(size, &shelved.table.file, &shelved.view, blending);
                    self.previews.push(Preview { digest: shelved.table.digest, size, target });
                    return;
                }
            }
        }
    }

    /// Draws a page where it was laid out.
    pub(super) fn draw(&mut self, view: &MenuView, clock: f32) {
        let Some((_, _, layout)) = self.last.clone() else { return };
        if layout.covers {
            let all = Rect::new(0.0, 0.0, f32::from(self.size.width), f32::from(self.size.height));
            let dim = if view.page == Page::Title { TITLE_DIM } else { DIM };
            self.batch.stretch(self.dot, all, tint(NIGHT * 0.4, dim));
        }
        self.plate(layout.plate);
        if !layout.covers {
            // Nothing shines through from the displays below.
            self.plate(layout.plate);
        }
        let (corner, pitch) = layout.title;
        if pitch > 0 {
            self.fonts.line(&mut self.batch, &view.title, corner, pitch, tint(AMBER, 1.0));
            let y = corner.y + f32::from(ROWS * pitch) + f32::from(layout.pitch) * 3.0;
            let line = Rect::new(
                layout.plate.x + self.corner,
                y,
                layout.plate.w - 2.0 * self.corner,
                f32::from(layout.pitch.div_ceil(2)),
            );
            self.batch.stretch(self.dot, line, tint(DECOR, 0.7));
        }
        for row in &layout.rows {
            if let Some(item) = view.items.get(row.item) {
                self.row(&layout, row, item, row.item == view.focus, clock);
            }
        }
        self.more(&layout);
        let step = f32::from(layout.small) * 11.0;
        let color = if view.problem.is_empty() { tint(ICE, 0.9) } else { tint(RED.lerp(Vec3::ONE, 0.3), 1.0) };
        for (line, place) in layout.note.1.iter().zip(0_u8..) {
            let corner = layout.note.0 + vec2(0.0, step * f32::from(place));
            self.fonts.line(&mut self.batch, line, corner, layout.small, color);
        }
        self.batch.flush();
        for row in &layout.rows {
            if let Some(Control::Table(shelved)) = view.items.get(row.item).map(|item| &item.control) {
                self.preview(row, shelved);
            }
        }
    }

    /// The picture of a table, if it is there already.
    fn preview(&self, row: &Row, shelved: &Shelved) {
        let Some(known) = self.previews.iter().find(|known| known.digest == shelved.table.digest) else { return };
        let place = preview::fitted(row.picture, &shelved.table.file);
        // A render target's first row is its lowest.
        let params = DrawTextureParams { dest_size: Some(place.size()), flip_y: true, ..DrawTextureParams::default() };
        draw_texture_ex(&known.target.texture, place.x, place.y, WHITE, params);
    }

    fn row(&mut self, layout: &MenuLayout, row: &Row, item: &Item, has_focus: bool, clock: f32) {
        let dots = f32::from(layout.pitch);
        let area = row.area;
        let text = f32::from(ROWS) * dots;
        let y = area.y + (area.h - text) / 2.0;
        if has_focus && row.picture.w == 0.0 {
            let bar = Rect::new(area.x - 3.0 * dots, area.y, area.w + 6.0 * dots, area.h);
            self.batch.stretch(self.dot, bar, tint(AMBER * 0.5, 0.30));
        }
        match &item.control {
            Control::Words => {
                for (line, place) in row.lines.iter().zip(0_u8..) {
                    let y = area.y + f32::from(place) * 11.0 * dots + 2.0 * dots;
                    self.text(line, vec2(area.x, y), layout.pitch, tint(IVORY, 0.85));
                }
            }
            Control::Heading => {
                self.text(&item.label, vec2(area.x, area.bottom() - text - 2.0 * dots), layout.pitch, tint(ICE, 1.0));
            }
            Control::Pair(value) => {
                self.text(&item.label, vec2(area.x, y), layout.pitch, tint(IVORY, 0.85));
                let x = area.right() - measure(value, layout.pitch).x;
                self.text(value, vec2(x, y), layout.pitch, tint(AMBER, 1.0));
            }
            Control::Field(_) => self.field(&item.label, area, layout.pitch, has_focus, clock),
            Control::Level { value, range: (least, most, step), .. } => {
                self.label(layout, row, item, has_focus);
                // What is never nothing has a step for its least, too.
                let first = u8::from(*least > 0);
                let steps = |value: u8| (value - least) / step + first;
                self.level(layout.bar(row), steps(*value), steps(*most), layout.pitch, has_focus);
            }
            Control::Switch { is_on, .. } => {
                self.label(layout, row, item, has_focus);
                self.value(layout, row, item, if *is_on { "ON" } else { "OFF" }, has_focus || *is_on);
            }
            Control::Keys { keys, waits, .. } => {
                self.label(layout, row, item, has_focus);
                let blank = *waits && clock % BLINK > BLINK * 0.6;
                let none = if blank { "" } else { "PRESS A KEY" };
                let text = if *waits {
                    none
                } else if keys.is_empty() {
                    "-"
                } else {
                    keys
                };
                self.value(layout, row, item, text, has_focus);
            }
            Control::Table(shelved) => self.card(layout, row, shelved, has_focus),
            Control::Open(_) | Control::Back | Control::Act(_) | Control::Join(_) => {
                self.label(layout, row, item, has_focus);
            }
        }
    }

    /// A table's name and what it is like, beside or below its picture; a frame around what has the focus.
    fn card(&mut self, layout: &MenuLayout, row: &Row, shelved: &Shelved, has_focus: bool) {
        let dots = f32::from(layout.pitch);
        let frame = preview::fitted(row.picture, &shelved.table.file);
        let rim = if has_focus { dots } else { (dots / 2.0).ceil() };
        let frame = Rect::new(frame.x - rim, frame.y - rim, frame.w + 2.0 * rim, frame.h + 2.0 * rim);
        self.batch.stretch(self.dot, frame, if has_focus { tint(AMBER, 1.0) } else { tint(DECOR, 0.5) });
        let (corner, mut y) = (row.words, row.words.y);
        for (line, place) in row.lines.iter().zip(0_u8..) {
            let (pitch, color) = match place {
                0 => (layout.pitch, shade(has_focus)),
                _ => (layout.small, tint(ICE, 0.85)),
            };
            self.text(line, vec2(corner.x, y), pitch, color);
            y += f32::from(pitch) * 11.0 + if place == 0 { 2.0 * dots } else { 0.0 };
        }
    }

    /// A label, with a ball in front of it if it has the focus.
    fn label(&mut self, layout: &MenuLayout, row: &Row, item: &Item, has_focus: bool) {
        let dots = f32::from(layout.pitch);
        let area = row.area;
        if has_focus {
            let side = (8.0 * dots).min(area.h);
            let ball = Rect::new(area.x + 1.0 * dots, area.center().y - side / 2.0, side, side);
            self.batch.stretch(self.ball, ball, WHITE);
        }
        let y = area.center().y - f32::from(ROWS) * dots / 2.0;
        self.text(&item.label, vec2(area.x + 15.0 * dots, y), layout.pitch, shade(has_focus));
    }

    /// What an item has at its right end; of a list as much as there is room for.
    fn value(&mut self, layout: &MenuLayout, row: &Row, item: &Item, text: &str, is_bright: bool) {
        let pitch = layout.pitch;
        let room = row.area.w - 15.0 * f32::from(pitch) - measure(&format!("{}  ", item.label), pitch).x;
        let mut text = text.to_owned();
        while measure(&text, pitch).x > room
            && let Some((rest, _)) = text.trim_end_matches(" +").rsplit_once(", ")
        {
            text = format!("{rest} +");
        }
        let y = row.area.center().y - f32::from(ROWS * pitch) / 2.0;
        self.text(&text, vec2(row.area.right() - measure(&text, pitch).x, y), pitch, shade(is_bright));
    }

    /// Steps of a level, lit up to its value.
    fn level(&mut self, bar: Rect, value: u8, steps: u8, pitch: u16, has_focus: bool) {
        let dots = f32::from(pitch);
        let width = bar.w / f32::from(steps.max(1));
        for step in 0..steps {
            let height = dots * (3.0 + 5.0 * f32::from(step + 1) / f32::from(steps));
            let bottom = bar.center().y + dots * 4.0;
            let area =
                Rect::new((bar.x + width * f32::from(step)).round(), bottom - height, (width - dots).round(), height);
            let color = if step < value { shade(has_focus) } else { tint(DOT_OFF, 1.0) };
            self.batch.stretch(self.dot, area, color);
        }
    }

    /// A row of the display in which somebody types: of a long text the end is seen.
    fn field(&mut self, text: &str, area: Rect, pitch: u16, has_focus: bool, clock: f32) {
        let dots = f32::from(pitch);
        let count = cells(area.w - 4.0 * dots, pitch);
        let y = (area.center().y - f32::from(ROWS) * dots / 2.0).round();
        let corner = vec2(area.x + 2.0 * dots, y);
        self.batch.stretch(self.dot, Rect::new(area.x, y - 3.0 * dots, area.w, 13.0 * dots), tint(Vec3::ZERO, 0.7));
        self.fonts.unlit(&mut self.batch, corner, count, area.x, pitch, tint(DOT_OFF, 1.0));
        let skip = (text.chars().count() + 1).saturating_sub(usize::from(count));
        let mut seen: String = text.chars().skip(skip).collect();
        if has_focus && clock % BLINK < BLINK * 0.6 {
            seen.push('_');
        }
        self.text(&seen, corner, pitch, tint(AMBER, 1.0));
    }

    /// Arrows where there is more than has room.
    fn more(&mut self, layout: &MenuLayout) {
        let x = layout.plate.right() - 7.0 * f32::from(layout.pitch);
        let text = f32::from(ROWS * layout.pitch);
        let ends = [layout.rows.first().map(|row| row.area.y), layout.rows.last().map(|row| row.area.bottom() - text)];
        for ((end, more), arrow) in ends.into_iter().zip(layout.more).zip(["^", "V"]) {
            if let (Some(y), true) = (end, more) {
                self.text(arrow, vec2(x, y), layout.pitch, tint(ICE, 1.0));
            }
        }
    }

    fn text(&mut self, text: &str, corner: Vec2, pitch: u16, color: Color) {
        self.fonts.line(&mut self.batch, text, corner, pitch, color);
    }

    /// The plate in nine parts: corners as they were painted, the rest stretched.
    fn plate(&mut self, area: Rect) {
        let side = self.plate.size.x;
        let corner = self.corner.min(area.w / 2.0).min(area.h / 2.0);
        let cuts = [(0.0, self.corner), (self.corner, side - 2.0 * self.corner), (side - self.corner, self.corner)];
        let columns = [(area.x, corner), (area.x + corner, area.w - 2.0 * corner), (area.right() - corner, corner)];
        let rows = [(area.y, corner), (area.y + corner, area.h - 2.0 * corner), (area.bottom() - corner, corner)];
        for ((x, w), (from_x, from_w)) in columns.into_iter().zip(cuts) {
            for ((y, h), (from_y, from_h)) in rows.into_iter().zip(cuts) {
                let part = self.plate.cut(Rect::new(from_x, from_y, from_w, from_h));
                self.batch.stretch(part, Rect::new(x, y, w, h), WHITE);
            }
        }
    }
}

/// Of the item that has the focus, and of the others.
fn shade(is_bright: bool) -> Color {
    tint(if is_bright { AMBER } else { AMBER.lerp(AMBER_DIM, 0.6) }, 1.0)
}

/// Dark glass with an amber rim, small: it is stretched in its middle.
fn plate(corner: f32) -> Image {
    let side = corner * 2.0 + 4.0;
    let mut canvas = Canvas::new(side as usize, side as usize);
    let shape = Shape::Plate { rect: Rect::new(1.0, 1.0, side - 2.0, side - 2.0), corner: corner * 0.8 };
    canvas.flat(&shape, ink(NIGHT * 0.55, 0.93));
    canvas.outline(&shape, (corner * 0.12).max(1.0), ink(AMBER, 0.75));
    canvas.into_image()
}
