//! One texture that holds every sprite, and the quads of a frame that are cut out of it. With everything in one
//! texture and one way of blending (premultiplied alpha), a frame is a handful of draw calls.

use macroquad::color::{Color, WHITE};
use macroquad::math::{Mat2, Rect, Vec2, vec2};
use macroquad::models::{Mesh, Vertex, draw_mesh};
use macroquad::texture::{FilterMode, Image, Texture2D};

/// A place in the atlas.
#[derive(Debug, Clone, Copy, PartialEq)]
pub(super) struct Sprite {
    /// In parts of the texture.
    uv: Rect,
    /// In pixels.
    pub(super) size: Vec2,
}

impl Sprite {
    /// The sprite without its outermost pixel on every side: its colours do not fade when it is stretched.
    pub(super) fn inner_part(self) -> Self {
        let pixel = vec2(self.uv.w, self.uv.h) / self.size;
        let Rect { x, y, w, h } = self.uv;
        let uv = Rect::new(x + pixel.x, y + pixel.y, w - 2.0 * pixel.x, h - 2.0 * pixel.y);
        Self { uv, size: self.size - 2.0 }
    }

    /// The right part of the sprite, `width` pixels of it.
    pub(super) fn right_part(self, width: f32) -> Self {
        let width = width.clamp(0.0, self.size.x);
        self.cut(Rect::new(self.size.x - width, 0.0, width, self.size.y))
    }

    /// A part of the sprite, in its own pixels.
    pub(super) fn cut(self, part: Rect) -> Self {
        let scale = vec2(self.uv.w, self.uv.h) / self.size;
        let (x, y) = (self.uv.x + part.x * scale.x, self.uv.y + part.y * scale.y);
        Self { uv: Rect::new(x, y, part.w * scale.x, part.h * scale.y), size: part.size() }
    }
}

/// Empty pixels around each sprite, so that none bleeds into its neighbour when it is turned or enlarged.
const GAP: usize = 2;

/// Narrowest atlas; wider ones are powers of two.
const NARROWEST: usize = 512;

/// Quads that are handed over at once: macroquad's buffers hold 10,000 vertices and 5,000 indices.
const QUADS_AT_ONCE: usize = 800;

/// Packs images into rows ("shelves") of one picture.
#[derive(Debug, Default)]
pub(super) struct Packer {
    images: Vec<Image>,
}

/// Names an image that was given to a [`Packer`].
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub(super) struct Ticket(usize);

impl Packer {
    /// Takes an image into the atlas.
    pub(super) fn add(&mut self, image: Image) -> Ticket {
        self.images.push(image);
        Ticket(self.images.len() - 1)
    }

    /// Makes the picture; the returned function turns tickets into sprites.
    pub(super) fn pack(self) -> (Image, impl Fn(Ticket) -> Sprite) {
        let side = |length: u16| usize::from(length) + GAP;
        let area: usize = self.images.iter().map(|image| side(image.width) * side(image.height)).sum();
        let widest = self.images.iter().map(|image| side(image.width) + GAP).max().unwrap_or(1);
        let width = ((area as f32 * 1.1).sqrt() as usize).max(widest).max(NARROWEST).next_power_of_two();
        let mut order: Vec<usize> = (0..self.images.len()).collect();
        order.sort_by_key(|&index| std::cmp::Reverse(self.images[index].height));

        let mut corners = vec![(0, 0); self.images.len()];
        let (mut x, mut y, mut shelf) = (GAP, GAP, 0);
        for index in order {
            let image = &self.images[index];
            if x + side(image.width) > width {
                (x, y, shelf) = (GAP, y + shelf, 0);
            }
            corners[index] = (x, y);
            x += side(image.width);
            shelf = shelf.max(side(image.height));
        }
        let height = y + shelf;

        let mut bytes = vec![0; width * height * 4];
        for (image, &(x, y)) in self.images.iter().zip(&corners) {
            let row_length = usize::from(image.width) * 4;
            for (row, pixels) in image.bytes.chunks_exact(row_length.max(1)).enumerate() {
                bytes[((y + row) * width + x) * 4..][..row_length].copy_from_slice(pixels);
            }
        }
        let picture = Image { width: width as u16, height: height as u16, bytes };
        let whole = vec2(width as f32, height as f32);
        let sprites: Vec<Sprite> = corners
            .iter()
            .zip(&self.images)
            .map(|(&(x, y), image)| {
                let size = vec2(f32::from(image.width), f32::from(image.height));
                let uv = Rect::new(x as f32 / whole.x, y as f32 / whole.y, size.x / whole.x, size.y / whole.y);
                Sprite { uv, size }
            })
            .collect();
        (picture, move |ticket| sprites[ticket.0])
    }
}

/// The quads of a frame. They are painted in the order in which they were placed.
#[derive(Debug)]
pub(super) struct Batch {
    atlas: Texture2D,
    vertices: Vec<Vertex>,
}

impl Batch {
    /// Of an atlas.
    pub(super) fn new(picture: &Image) -> Self {
        let atlas = Texture2D::from_image(picture);
        atlas.set_filter(FilterMode::Linear);
        Self { atlas, vertices: Vec::new() }
    }

    /// A sprite in its own size, its centre at a point. On whole pixels it is exactly as it was painted.
    pub(super) fn place(&mut self, sprite: Sprite, center: Vec2, tint: Color) {
        let corner = center - sprite.size / 2.0;
        self.stretch(sprite, Rect::new(corner.x, corner.y, sprite.size.x, sprite.size.y), tint);
    }

    /// The same, `scale` times as large. At 1 it is exactly as it was painted.
    pub(super) fn scaled(&mut self, sprite: Sprite, center: Vec2, scale: f32) {
        let size = sprite.size * scale;
        let corner = center - size / 2.0;
        self.stretch(sprite, Rect::new(corner.x, corner.y, size.x, size.y), WHITE);
    }

    /// A sprite that fills a rectangle.
    pub(super) fn stretch(&mut self, sprite: Sprite, area: Rect, tint: Color) {
        let (right, bottom) = (area.right(), area.bottom());
        let corners = [vec2(area.x, area.y), vec2(right, area.y), vec2(right, bottom), vec2(area.x, bottom)];
        self.quad(sprite, corners, tint);
    }

    /// A sprite turned clockwise by `angle` about its own point `pivot`, which comes to lie at `at`.
    pub(super) fn turned(&mut self, sprite: Sprite, pivot: Vec2, at: Vec2, angle: f32, tint: Color) {
        let turn = Mat2::from_angle(angle);
        let corner = |x: f32, y: f32| at + turn * (vec2(x, y) * sprite.size - pivot);
        self.quad(sprite, [corner(0.0, 0.0), corner(1.0, 0.0), corner(1.0, 1.0), corner(0.0, 1.0)], tint);
    }

    /// A sprite as a bar from point to point, `width` across.
    pub(super) fn bar(&mut self, sprite: Sprite, from: Vec2, to: Vec2, width: f32, tint: Color) {
        let side = (to - from).perp().normalize_or_zero() * width / 2.0;
        self.quad(sprite, [from - side, to - side, to + side, from + side], tint);
    }

    /// A sprite on any four corners, clockwise from its upper left one.
    fn quad(&mut self, sprite: Sprite, corners: [Vec2; 4], tint: Color) {
        let uv = sprite.uv;
        let marks = [(uv.x, uv.y), (uv.right(), uv.y), (uv.right(), uv.bottom()), (uv.x, uv.bottom())];
        for (corner, (u, v)) in corners.into_iter().zip(marks) {
            self.vertices.push(Vertex::new(corner.x, corner.y, 0.0, u, v, tint));
        }
    }

    /// Paints everything placed so far, and starts anew.
    pub(super) fn flush(&mut self) {
        for chunk in self.vertices.chunks(QUADS_AT_ONCE * 4) {
            let quads = (0..chunk.len() as u16 / 4).map(|quad| quad * 4);
            let indices = quads.flat_map(|first| [0, 1, 2, 0, 2, 3].map(|corner| first + corner)).collect();
            draw_mesh(&Mesh { vertices: chunk.to_vec(), indices, texture: Some(self.atlas.weak_clone()) });
        }
        self.vertices.clear();
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn sprites_are_packed_apart_and_unchanged() {
        let mut packer = Packer::default();
        let tickets: Vec<(Ticket, u8)> = (1..60_u8)
            .map(|value| {
                let (width, height) = (u16::from(value) * 3 % 41 + 1, u16::from(value) * 7 % 29 + 1);
                let bytes = vec![value; usize::from(width) * usize::from(height) * 4];
                (packer.add(Image { width, height, bytes }), value)
            })
            .collect();
        let (picture, sprite) = packer.pack();
        let mut covered = 0;
        for (ticket, value) in tickets {
            let Sprite { uv, size } = sprite(ticket);
            let corner = vec2(uv.x * f32::from(picture.width), uv.y * f32::from(picture.height)).round();
            for y in 0..size.y as usize {
                for x in 0..size.x as usize {
                    let index = (corner.y as usize + y) * usize::from(picture.width) + corner.x as usize + x;
                    assert_eq!(picture.bytes[index * 4..][..4], [value; 4]);
                    covered += 1;
                }
            }
        }
        let painted = picture.bytes.chunks_exact(4).filter(|pixel| pixel[0] != 0).count();
        assert_eq!(painted, covered);
    }
}
