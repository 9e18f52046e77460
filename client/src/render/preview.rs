//! Small pictures of whole tables, each painted once into a texture of its own.

use macroquad::camera::{Camera2D, set_camera, set_default_camera};
use macroquad::color::BLACK;
use macroquad::math::{Rect, vec2};
use macroquad::texture::{FilterMode, RenderTarget, render_target};
use macroquad::window::clear_background;
use shared::table::TableFile;

use super::layout::{Layout, PixelSize};
use super::minis::Minis;
use super::{Blending, Board};
use crate::view::View;

/// The part of a place that a table of a size in metres fills, in the middle of it.
pub(super) fn fitted(place: Rect, table: &TableFile) -> Rect {
    let outer = Layout::outer(vec2(table.size.0 as f32, table.size.1 as f32));
    let size = (outer * (place.size() / outer).min_element()).floor();
    let corner = (place.center() - size / 2.0).floor();
    Rect::new(corner.x, corner.y, size.x, size.y)
}

/// Paints a table as a view has it. The camera is the default one afterwards.
pub(super) fn paint(size: PixelSize, table: &TableFile, view: &View, blending: &Blending) -> RenderTarget {
    let whole = Rect::new(0.0, 0.0, f32::from(size.width), f32::from(size.height));
    let board = Board::paint(&Layout::of_table(size, vec2(table.size.0 as f32, table.size.1 as f32)), table);
    let mut minis = Minis::paint(whole, &board, view.marked_lights, table);
    let target = render_target(u32::from(size.width), u32::from(size.height));
    target.texture.set_filter(FilterMode::Nearest);
    let mut camera = Camera2D::from_display_rect(whole);
    camera.render_target = Some(target.clone());
    set_camera(&camera);
    clear_background(BLACK);
    minis.draw(whole, table, view, blending);
    set_default_camera();
    target
}
