//! How the tables of a page stand. Pure arithmetic.

use macroquad::math::{Rect, Vec2, vec2};

use super::layout::LINE;
use crate::menu::{Control, MenuView};

/// How the tables of a page stand: beside each other where the window is wide, their words below their pictures; else below
/// each other, their words beside their pictures. They come first on their page.
#[derive(Debug, Clone, Copy)]
pub(super) struct Cards {
    pub(super) count: usize,
    pub(super) is_beside: bool,
    /// Pixels of a picture's place.
    picture: Vec2,
    dots: f32,
}

impl Cards {
    /// In such a place, with text of such dots.
    pub(super) fn new(area: Rect, dots: f32, view: &MenuView) -> Self {
        let count = view.items.iter().filter(|item| matches!(item.control, Control::Table(_))).count();
        let is_beside = count > 0 && area.w > area.h * 1.1;
        let high = if is_beside { area.h * 0.52 } else { area.h * (0.56 / count.max(1) as f32).min(0.26) };
        let wide = if is_beside { high * 0.8 } else { high * 0.62 };
        Self { count, is_beside, picture: vec2(wide, high).floor(), dots }
    }

    /// Glyphs of all of them.
    pub(super) fn glyphs(&self) -> f32 {
        match self.count {
            0 => 0.0,
            count if self.is_beside => (count as f32 * 24.0).min(72.0),
            _ => 40.0,
        }
    }

    /// Pixels of the width of a card.
    fn cell(&self, width: f32) -> f32 {
        let gaps = (self.count.max(1) - 1) as f32 * 8.0 * self.dots;
        if self.is_beside { ((width - gaps) / self.count.max(1) as f32).floor() } else { width }
    }

    /// Pixels of the width of words.
    pub(super) fn words(&self, width: f32) -> f32 {
        let cell = self.cell(width);
        if self.is_beside { cell } else { cell - self.picture.x - 6.0 * self.dots }
    }

    /// Pixels of the height of a card with so many lines, the first of them its name.
    pub(super) fn height(&self, lines: usize, small: f32) -> f32 {
        let words = LINE * (self.dots + lines.saturating_sub(1) as f32 * small) + 2.0 * self.dots;
        let both = if self.is_beside { self.picture.y + 4.0 * self.dots + words } else { self.picture.y.max(words) };
        both + 5.0 * self.dots
    }

    /// What cards beside each other do not take of the sum of heights.
    pub(super) fn saved(&self, heights: &[f32]) -> f32 {
        if !self.is_beside {
            return 0.0;
        }
        let cards = &heights[..self.count];
        cards.iter().sum::<f32>() - cards.last().copied().unwrap_or(0.0)
    }

    /// All of a card, its picture, its words.
    pub(super) fn place(&self, place: usize, row: Rect) -> (Rect, Rect, Rect) {
        let cell = self.cell(row.w);
        let gap = 4.0 * self.dots;
        if self.is_beside {
            let x = (row.x + place as f32 * (cell + 8.0 * self.dots)).round();
            let picture = Rect::new(x, row.y, cell, self.picture.y);
            let words = Rect::new(x, picture.bottom() + gap, cell, row.h - picture.h - gap);
            return (Rect::new(x, row.y, cell, row.h), picture, words);
        }
        let picture = Rect::new(row.x, row.y, self.picture.x, self.picture.y);
        let words = Rect::new(picture.right() + 6.0 * self.dots, row.y + gap, self.words(row.w), row.h - gap);
        (row, picture, words)
    }
}
