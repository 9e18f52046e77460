//! How far a film has come: a bar at the lower end of the table, with the time and the speed above it.

use macroquad::color::WHITE;
use macroquad::math::Rect;

use super::atlas::Sprite;
use super::dot_matrix::measure;
use super::hud::{Align, Writer, rows};
use super::layout::Layout;
use super::palette::{AMBER, AMBER_DIM, IVORY, RED, tint};
use super::panels::Panels;
use crate::view::FilmView;

/// Where it stands: across the lower end of the table.
pub(super) fn film_area(layout: &Layout, panels: &Panels) -> Rect {
    let field = layout.seen_playfield();
    let height = (rows(panels.small) * 3.2).round();
    let width = (field.w * 0.94).round();
    Rect::new((field.center().x - width / 2.0).round(), field.bottom() - height, width, height)
}

impl Writer<'_> {
    /// The bar of a film, if one is on.
    pub(super) fn film(&mut self, film: Option<&FilmView>, plate: Sprite, dot: Sprite, area: Rect) {
        let Some(film) = film else { return };
        self.batch.stretch(plate, area, WHITE);
        let small = self.panels.small;
        let margin = (area.w * 0.04).round();
        let inner = Rect::new(area.x + margin, area.y, area.w - 2.0 * margin, area.h);
        let gap = ((area.h - 1.8 * rows(small)) / 3.0).max(0.0).round();
        self.line(inner, area.y + gap, &film.time, small, Align::Left, tint(IVORY, 1.0));
        let color = if film.is_wrong { RED } else { AMBER };
        let taken = measure(&film.time, small).x + self.gap();
        let rest = Rect { x: inner.x + taken, w: (inner.w - taken).max(0.0), ..inner };
        self.line(rest, area.y + gap, &film.state, small, Align::Right, tint(color, 1.0));
        let height = (rows(small) * 0.8).round();
        let bar = Rect::new(inner.x, area.bottom() - gap - height, inner.w, height);
        let dot = dot.inner_part();
        self.batch.stretch(dot, bar, tint(AMBER_DIM, 0.45));
        self.batch.stretch(dot, Rect { w: bar.w * film.share, ..bar }, tint(color, 1.0));
    }
}
