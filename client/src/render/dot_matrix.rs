//! The font of the dot-matrix display: five columns by seven rows of round dots. All text of the game is set in it.
//!
//! Dots are whole numbers of pixels apart, so that text is sharp at any size of the window.

use macroquad::color::Color;
use macroquad::math::{Rect, Vec2, Vec3, Vec4, vec2};
use macroquad::texture::Image;

use super::atlas::{Batch, Packer, Sprite, Ticket};
use super::canvas::{Canvas, ink};
use super::shape::Shape;

/// Columns of a glyph.
const COLUMNS: u16 = 5;
/// Rows of a glyph.
pub(super) const ROWS: u16 = 7;
/// Columns from one glyph to the next.
pub(super) const ADVANCE: u16 = COLUMNS + 1;

/// The first character of [`GLYPHS`]; the others follow in ASCII's order.
const FIRST: char = ' ';

/// A byte for each column from the left, the lowest bit on top: from the space to the underscore.
const GLYPHS: [[u8; COLUMNS as usize]; 64] = [
    [0x00, 0x00, 0x00, 0x00, 0x00], // space
    [0x00, 0x00, 0x5F, 0x00, 0x00], // !
    [0x00, 0x07, 0x00, 0x07, 0x00], // "
    [0x14, 0x7F, 0x14, 0x7F, 0x14], // #
    [0x24, 0x2A, 0x7F, 0x2A, 0x12], // $
    [0x23, 0x13, 0x08, 0x64, 0x62], // %
    [0x36, 0x49, 0x56, 0x20, 0x50], // &
    [0x00, 0x04, 0x03, 0x00, 0x00], // '
    [0x00, 0x1C, 0x22, 0x41, 0x00], // (
    [0x00, 0x41, 0x22, 0x1C, 0x00], // )
    [0x2A, 0x1C, 0x7F, 0x1C, 0x2A], // *
    [0x08, 0x08, 0x3E, 0x08, 0x08], // +
    [0x00, 0x50, 0x30, 0x00, 0x00], // ,
    [0x08, 0x08, 0x08, 0x08, 0x08], // -
    [0x00, 0x60, 0x60, 0x00, 0x00], // .
    [0x20, 0x10, 0x08, 0x04, 0x02], // /
    [0x3E, 0x51, 0x49, 0x45, 0x3E], // 0
    [0x00, 0x42, 0x7F, 0x40, 0x00], // 1
    [0x42, 0x61, 0x51, 0x49, 0x46], // 2
    [0x21, 0x41, 0x45, 0x4B, 0x31], // 3
    [0x18, 0x14, 0x12, 0x7F, 0x10], // 4
    [0x27, 0x45, 0x45, 0x45, 0x39], // 5
    [0x3C, 0x4A, 0x49, 0x49, 0x30], // 6
    [0x01, 0x71, 0x09, 0x05, 0x03], // 7
    [0x36, 0x49, 0x49, 0x49, 0x36], // 8
    [0x06, 0x49, 0x49, 0x29, 0x1E], // 9
    [0x00, 0x36, 0x36, 0x00, 0x00], // :
    [0x00, 0x56, 0x36, 0x00, 0x00], // ;
    [0x08, 0x14, 0x22, 0x41, 0x00], // <
    [0x14, 0x14, 0x14, 0x14, 0x14], // =
    [0x00, 0x41, 0x22, 0x14, 0x08], // >
    [0x02, 0x01, 0x51, 0x09, 0x06], // ?
    [0x3E, 0x41, 0x5D, 0x55, 0x5E], // @
    [0x7E, 0x11, 0x11, 0x11, 0x7E], // A
    [0x7F, 0x49, 0x49, 0x49, 0x36], // B
    [0x3E, 0x41, 0x41, 0x41, 0x22], // C
    [0x7F, 0x41, 0x41, 0x22, 0x1C], // D
    [0x7F, 0x49, 0x49, 0x49, 0x41], // E
    [0x7F, 0x09, 0x09, 0x09, 0x01], // F
    [0x3E, 0x41, 0x49, 0x49, 0x7A], // G
    [0x7F, 0x08, 0x08, 0x08, 0x7F], // H
    [0x00, 0x41, 0x7F, 0x41, 0x00], // I
    [0x20, 0x40, 0x41, 0x3F, 0x01], // J
    [0x7F, 0x08, 0x14, 0x22, 0x41], // K
    [0x7F, 0x40, 0x40, 0x40, 0x40], // L
    [0x7F, 0x02, 0x0C, 0x02, 0x7F], // M
    [0x7F, 0x04, 0x08, 0x10, 0x7F], // N
    [0x3E, 0x41, 0x41, 0x41, 0x3E], // O
    [0x7F, 0x09, 0x09, 0x09, 0x06], // P
    [0x3E, 0x41, 0x51, 0x21, 0x5E], // Q
    [0x7F, 0x09, 0x19, 0x29, 0x46], // R
    [0x46, 0x49, 0x49, 0x49, 0x31], // S
    [0x01, 0x01, 0x7F, 0x01, 0x01], // T
    [0x3F, 0x40, 0x40, 0x40, 0x3F], // U
    [0x1F, 0x20, 0x40, 0x20, 0x1F], // V
    [0x3F, 0x40, 0x38, 0x40, 0x3F], // W
    [0x63, 0x14, 0x08, 0x14, 0x63], // X
    [0x07, 0x08, 0x70, 0x08, 0x07], // Y
    [0x61, 0x51, 0x49, 0x45, 0x43], // Z
    [0x00, 0x7F, 0x41, 0x41, 0x00], // [
    [0x02, 0x04, 0x08, 0x10, 0x20], // \
    [0x00, 0x41, 0x41, 0x7F, 0x00], // ]
    [0x04, 0x02, 0x01, 0x02, 0x04], // ^
    [0x40, 0x40, 0x40, 0x40, 0x40], // _
];

/// Place of a character in [`GLYPHS`]: small letters are shown as capitals, what the font lacks as a question mark.
fn glyph_index(character: char) -> usize {
    let place = |c: char| (c as usize).checked_sub(FIRST as usize).filter(|place| *place < GLYPHS.len());
    place(character.to_ascii_uppercase()).unwrap_or('?' as usize - FIRST as usize)
}

/// Size in pixels of a line of text whose dots are `pitch` pixels apart.
pub(super) fn measure(text: &str, pitch: u16) -> Vec2 {
    let columns = (text.chars().count() as f32 * f32::from(ADVANCE) - 1.0).max(0.0);
    vec2(columns, f32::from(ROWS)) * f32::from(pitch)
}

/// How many glyphs fit beside each other.
pub(super) fn cells(width: f32, pitch: u16) -> u16 {
    ((width + f32::from(pitch)) / f32::from(ADVANCE * pitch)) as u16
}

/// A whole number with a comma between each three digits.
pub(crate) fn grouped(number: u64) -> String {
    let digits = number.to_string();
    let mut text = String::with_capacity(digits.len() * 4 / 3);
    for (index, digit) in digits.chars().enumerate() {
        if index > 0 && (digits.len() - index).is_multiple_of(3) {
            text.push(',');
        }
        text.push(digit);
    }
    text
}

/// Sprites of all glyphs, for one distance between dots.
#[derive(Debug)]
struct Font {
    pitch: u16,
    glyphs: Vec<Sprite>,
    /// All dots of a glyph and of the gap after it, for the display's dots that are not lit.
    unlit: Sprite,
}

/// The fonts of a layout, the smallest first.
#[derive(Debug)]
pub(super) struct Fonts(Vec<Font>);

/// Fonts whose sprites are not packed yet.
#[derive(Debug)]
pub(super) struct FontTickets(Vec<(u16, Vec<Ticket>, Ticket)>);

impl FontTickets {
    /// Paints the glyphs for all of these distances between dots.
    pub(super) fn paint(packer: &mut Packer, pitches: impl IntoIterator<Item = u16>) -> Self {
        let pitches: std::collections::BTreeSet<u16> = pitches.into_iter().collect();
        let mut paint = |pitch: u16| {
            let glyphs = GLYPHS.iter().map(|glyph| packer.add(paint_glyph(glyph, pitch))).collect();
            (pitch, glyphs, packer.add(paint_unlit(pitch)))
        };
        Self(pitches.into_iter().map(&mut paint).collect())
    }

    /// The fonts, once the sprites are packed.
    pub(super) fn resolve(self, sprite: impl Fn(Ticket) -> Sprite) -> Fonts {
        let font = |(pitch, glyphs, unlit): (u16, Vec<Ticket>, Ticket)| Font {
            pitch,
            glyphs: glyphs.into_iter().map(&sprite).collect(),
            unlit: sprite(unlit),
        };
        Fonts(self.0.into_iter().map(font).collect())
    }
}

impl Fonts {
    /// The largest distance between dots, up to `wanted`, at which a text is no wider than `width`; else the smallest.
    pub(super) fn fitting(&self, text: &str, wanted: u16, width: f32) -> u16 {
        let fits = |font: &&Font| font.pitch <= wanted && measure(text, font.pitch).x <= width;
        self.0.iter().rev().find(fits).or(self.0.first()).map_or(1, |font| font.pitch)
    }

    /// A line of text, its upper left dot at `corner`.
    pub(super) fn line(&self, batch: &mut Batch, text: &str, corner: Vec2, pitch: u16, tint: Color) {
        let Some(font) = self.font(pitch) else { return };
        let corner = corner.round() - margin(pitch);
        let advance = f32::from(ADVANCE * pitch);
        for (place, character) in text.chars().enumerate() {
            if character != ' '
                && let Some(glyph) = font.glyphs.get(glyph_index(character))
            {
                let area = Rect::new(corner.x + place as f32 * advance, corner.y, glyph.size.x, glyph.size.y);
                batch.stretch(*glyph, area, tint);
            }
        }
    }

    /// The unlit dots of a row of the display, on the grid of a glyph whose upper left dot is at `corner`: `cells`
    /// glyphs to the right of it, and whole columns to the left as far as `left`.
    pub(super) fn unlit(&self, batch: &mut Batch, corner: Vec2, cells: u16, left: f32, pitch: u16, tint: Color) {
        let Some(font) = self.font(pitch) else { return };
        let corner = corner.round();
        for place in 0..cells {
            let x = corner.x + f32::from(place * ADVANCE * pitch);
            batch.stretch(font.unlit, Rect::new(x, corner.y, font.unlit.size.x, font.unlit.size.y), tint);
        }
        let columns = ((corner.x - left) / f32::from(pitch)).floor().clamp(0.0, f32::from(ADVANCE));
        let part = font.unlit.right_part(columns * f32::from(pitch));
        batch.stretch(part, Rect::new(corner.x - part.size.x, corner.y, part.size.x, part.size.y), tint);
    }

    fn font(&self, pitch: u16) -> Option<&Font> {
        self.0.iter().rev().find(|font| font.pitch <= pitch).or(self.0.first())
    }
}

/// Pixels around a glyph into which its dots glow.
fn margin(pitch: u16) -> f32 {
    f32::from(pitch.div_ceil(2))
}

/// The disc of a dot, by its column and row.
fn dot(column: u16, row: u16, pitch: u16) -> Shape {
    let center = (vec2(f32::from(column), f32::from(row)) + 0.5) * f32::from(pitch);
    // Small dots touch, or they would be too dim to read; larger ones leave a gap as the real display does.
    let radius = if pitch <= 2 { f32::from(pitch) * 0.5 + 0.3 } else { f32::from(pitch) * 0.45 };
    Shape::circle(center + margin(pitch), radius)
}

fn paint_glyph(glyph: &[u8; COLUMNS as usize], pitch: u16) -> Image {
    let side = |dots: u16| usize::from(dots * pitch) + 2 * margin(pitch) as usize;
    let mut canvas = Canvas::new(side(COLUMNS), side(ROWS));
    let lit = (0..COLUMNS).flat_map(|column| (0..ROWS).map(move |row| (column, row)));
    for (column, row) in lit.filter(|(column, row)| glyph[usize::from(*column)] >> row & 1 == 1) {
        let dot = dot(column, row, pitch);
        if pitch >= 3 {
            canvas.halo(&dot, f32::from(pitch) * 0.8, Vec3::ONE, 0.16);
        }
        canvas.flat(&dot, ink(Vec3::ONE, 1.0));
    }
    canvas.into_image()
}

fn paint_unlit(pitch: u16) -> Image {
    let mut canvas = Canvas::new(usize::from(ADVANCE * pitch), usize::from(ROWS * pitch));
    for column in 0..ADVANCE {
        for row in 0..ROWS {
            let Shape::Circle { center, radius } = dot(column, row, pitch) else { continue };
            let place = Shape::circle(center - margin(pitch), radius.min(f32::from(pitch) * 0.42));
            canvas.fill(&place, |_, distance| if distance < 0.5 { ink(Vec3::ONE, 1.0) } else { Vec4::ZERO });
        }
    }
    canvas.into_image()
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn every_character_has_a_glyph() {
        for text in ["AZ09", ".,:;!?+-*/%()'&#<>=", "az"] {
            for character in text.chars() {
                assert_ne!(GLYPHS[glyph_index(character)], [0; 5], "{character}");
            }
        }
        assert_eq!(GLYPHS[glyph_index(' ')], [0; 5]);
        assert_eq!(glyph_index('a'), glyph_index('A'));
        for strange in ['\u{e9}', '\n', '\u{1F3B1}', '\0', '~', '`'] {
            assert_eq!(glyph_index(strange), glyph_index('?'));
        }
    }

    #[test]
    fn glyphs_differ() {
        for (index, glyph) in GLYPHS.iter().enumerate() {
            assert!(GLYPHS[..index].iter().all(|other| other != glyph), "glyph {index}");
            assert!(glyph.iter().all(|column| *column < 0x80), "glyph {index} has an eighth row");
        }
    }

    #[test]
    fn text_is_as_wide_as_its_dots() {
        assert_eq!(measure("", 3), vec2(0.0, 21.0));
        assert_eq!(measure("A", 2), vec2(10.0, 14.0));
        assert_eq!(measure("AB\u{e9}", 2), vec2(34.0, 14.0));
    }

    #[test]
    fn digits_are_grouped_by_three() {
        let pairs = [(0, "0"), (999, "999"), (1_000, "1,000"), (1_234_567, "1,234,567")];
        for (number, text) in pairs {
            assert_eq!(grouped(number), text);
        }
    }
}
