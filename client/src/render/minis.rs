//! The other boards of a room, small: the same art, reduced, and the same moving things at another scale, with a name and points.

use macroquad::color::WHITE;
use macroquad::math::{Rect, Vec2, vec2};
use macroquad::texture::draw_texture;
use shared::table::TableFile;

use super::atlas::{Batch, Sprite};
use super::dot_matrix::Fonts;
use super::layout::{Layout, PixelSize};
use super::panels::Panels;
use super::scene::Stage;
use super::sprites::{self, Sprites};
use super::{Blending, Board};
use crate::view::View;

/// A lower table than this shows nothing, pixels.
const LEAST_HEIGHT: f32 = 90.0;

/// Where a small board stands, and the words about it.
#[derive(Debug, Clone, Copy, PartialEq)]
pub(super) struct Slot {
    pub(super) board: Rect,
    pub(super) words: Rect,
}

/// Places for `count` boards of a size in metres beside each other, with words of so many pixels of height below; of a
/// single one the words stand beside it. Nothing if there is no room.
pub(super) fn slots(area: Rect, count: usize, table: Vec2, words: f32, gap: f32) -> Vec<Slot> {
    let aspect = Layout::outer(table);
    let aspect = aspect.x / aspect.y;
    let is_single = count == 1;
    let most = if is_single { area.h } else { area.h - words - gap };
    // As wide as if there were at least two.
    let cell = (area.w - gap * (count.max(2) - 1) as f32) / count.max(2) as f32;
    let height = most.min(cell / aspect).floor();
    if height < LEAST_HEIGHT {
        return Vec::new();
    }
    let width = (height * aspect).round();
    let spread = (area.w - width * count as f32) / (count.max(2) - 1) as f32;
    (0..count)
        .map(|place| {
            let x = (area.x + place as f32 * (width + spread)).round();
            let board = Rect::new(x, area.y.round(), width, height);
            let words = if is_single {
                Rect::new(x + width + gap, area.y, area.w - width - gap, height)
            } else {
                let half = (spread / 2.0 - gap / 2.0).max(0.0);
                let left = if place == 0 { 0.0 } else { half };
                let right = if place + 1 == count { 0.0 } else { half };
                Rect::new(x - left, board.bottom() + gap, width + left + right, words)
            };
            Slot { board, words }
        })
        .collect()
}

/// What small boards are drawn with. All are of one table and one size.
pub(super) struct Minis {
    layout: Layout,
    panels: Panels,
    board: Board,
    sprites: Sprites<Sprite>,
    fonts: Fonts,
    batch: Batch,
}

impl Minis {
    /// The art for boards as large as `slot`, made of that of a large one.
    pub(super) fn paint(slot: Rect, large: &Board, marked_lights: bool, table: &TableFile) -> Self {
        let size = PixelSize { width: slot.w as u16, height: slot.h as u16 };
        let layout = Layout::of_table(size, vec2(table.size.0 as f32, table.size.1 as f32));
        let panels = Panels::new(&layout, 1.0);
        let board = large.reduced(size);
        let (batch, sprites, fonts) = sprites::build(&layout, &panels, marked_lights, table);
        Self { layout, panels, board, sprites, fonts, batch }
    }

    /// Whether the art fits a slot.
    pub(super) fn fits(&self, slot: Rect) -> bool {
        let size = self.layout.size;
        (size.width, size.height) == (slot.w as u16, slot.h as u16)
    }

    /// Draws a board in its slot.
    pub(super) fn draw(&mut self, slot: Rect, table: &TableFile, view: &View, blending: &Blending) {
        let Self { layout, panels, board, sprites, fonts, batch } = self;
        blending.layer();
        draw_texture(&board.still, slot.x, slot.y, WHITE);
        let layout = &layout.moved(vec2(slot.x, slot.y));
        let draw_above = || {
            if let Some((above, place)) = &board.above {
                draw_texture(above, slot.x + place.x, slot.y + place.y, WHITE);
            }
        };
        Stage { layout, panels, table, sprites, fonts, batch }.draw(view, draw_above);
        batch.flush();
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    const TABLE: Vec2 = Vec2::new(0.474, 1.067);

    #[test]
    fn slots_are_inside_and_apart() {
        for (width, height, count) in [(400.0, 300.0, 1), (400.0, 300.0, 2), (400.0, 300.0, 3), (150.0, 500.0, 3)] {
            let area = Rect::new(20.0, 30.0, width, height);
            let slots = slots(area, count, TABLE, 40.0, 8.0);
            assert!(slots.len() == count || height < LEAST_HEIGHT || width < 200.0, "{width} {height} {count}");
            for (place, slot) in slots.iter().enumerate() {
                for part in [slot.board, slot.words] {
                    let inside = part.x >= area.x - 1.0 && part.right() <= area.right() + 1.0;
                    assert!(inside && part.bottom() <= area.bottom() + 1.0, "{part:?}");
                    let others = slots[..place].iter().flat_map(|other| [other.board, other.words]);
                    for other in others {
                        assert!(part.intersect(other).is_none_or(|both| both.w < 1.0 || both.h < 1.0));
                    }
                }
            }
        }
        assert!(slots(Rect::new(0.0, 0.0, 400.0, 60.0), 1, TABLE, 40.0, 8.0).is_empty());
    }
}
