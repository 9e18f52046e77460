//! Where everything stands in the window, and how metres on the table become pixels. Pure arithmetic.

use macroquad::math::{Rect, Vec2, vec2};

use super::camera::Reach;

/// Size of a picture in physical pixels; never 0 by 0.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub(super) struct PixelSize {
    pub(super) width: u16,
    pub(super) height: u16,
}

/// Wood around the playfield, metres.
const FRAME: f32 = 0.020;

/// How much more a nudged table moves in the picture than it does.
const SHAKE: f32 = 4.0;

/// The most that it moves in the picture, metres on the table: 8 pixels in a window of 1280 by 720.
const MOST_SHAKE: f32 = 0.012;

/// How far a table jumps at a tilt, metres on the table, how fast it swings then, 1/s, and how fast it comes to rest, 1/s.
const JOLT: f32 = 0.011;
const JOLT_SWING: f32 = 68.0;
const JOLT_DAMPING: f32 = 7.0;

/// Graphics cards of the oldest kind that macroquad runs on hold textures up to this size. A larger window is painted
/// at this size and enlarged.
const LARGEST: f32 = 4096.0;

/// The whole table is shown where a metre of it gets so many pixels (a ball is then 13 pixels across), ...
const LEAST_SCALE: f32 = 480.0;
/// ... and no more than so many metres are in the window's height: beyond that a ball is small in any window.
const LONGEST_SHOWN: f32 = 1.3;
/// Where a table scrolls, a metre of it gets at least so many pixels, ...
const SCROLLED_SCALE: f32 = 560.0;
/// ... and about so many metres are seen at once, as much as of a usual table.
const SCROLLED_LENGTH: f32 = 1.1;
/// Scrolling is worth it from so much enlargement on.
const WORTH_SCROLLING: f32 = 1.1;

/// A panel is at most this many times as wide as the table: on a very wide window, text stays beside the table.
const WIDEST_PANEL: f32 = 1.3;

impl PixelSize {
    /// The size of the picture for a window of so many physical pixels.
    pub(super) fn of_window(width: f32, height: f32) -> Self {
        let shrink = (LARGEST / width.max(height).max(1.0)).min(1.0);
        let side = |length: f32| (length * shrink).round().clamp(1.0, LARGEST) as u16;
        Self { width: side(width), height: side(height) }
    }

    /// As a vector.
    pub(super) fn to_vec(self) -> Vec2 {
        vec2(f32::from(self.width), f32::from(self.height))
    }
}

/// The largest place of a picture's shape in the middle of a window.
pub(super) fn letterbox(picture: PixelSize, window: Vec2) -> Rect {
    let size = picture.to_vec();
    let fitted = size * (window / size).min_element();
    let corner = (window - fitted) / 2.0;
    Rect::new(corner.x, corner.y, fitted.x, fitted.y)
}

/// Places of everything for one size of the window.
#[derive(Debug, Clone, PartialEq)]
pub(super) struct Layout {
    /// Of the whole picture.
    pub(super) size: PixelSize,
    /// The table with its wooden frame. One that scrolls is taller than its opening; here it is seen from its lower end.
    pub(super) cabinet: Rect,
    /// The part of the picture through which the table is seen.
    pub(super) opening: Rect,
    /// Pixels a metre.
    pub(super) scale: f32,
    /// Panel with title, scores and the message.
    pub(super) main_panel: Rect,
    /// Panel with ball, bonus, onlookers and keys.
    pub(super) side_panel: Rect,
    /// Size of the playfield, metres.
    table: Vec2,
}

impl Layout {
    /// Divides a picture for a table of a size in metres.
    pub(super) fn new(size: PixelSize, table: Vec2) -> Self {
        let window = size.to_vec();
        let outer = Self::outer(table);
        let aspect = window.x / window.y;
        let scale_within = |room: Vec2| scale_within(room, outer);
        let (area, scale, main_panel, side_panel);
        if aspect >= 1.15 {
            // Wide: the table in the middle, a panel at either side.
            scale = scale_within(vec2(window.x * 0.6, window.y));
            let width = (outer.x * scale).min(window.x * 0.6).round();
            let panel = ((window.x - width) / 2.0).floor();
            let used = panel.min((width * WIDEST_PANEL).floor());
            area = Rect::new(panel, 0.0, width, window.y);
            main_panel = Rect::new(panel - used, 0.0, used, window.y);
            side_panel = Rect::new(panel + width, 0.0, used, window.y);
        } else if aspect >= 0.8 {
            // Nearly square: the table at the left, both panels stacked at its right.
            scale = scale_within(vec2(window.x * 0.6, window.y));
            let width = (outer.x * scale).min(window.x * 0.6).round();
            let upper = (window.y * 0.5).round();
            area = Rect::new(0.0, 0.0, width, window.y);
            main_panel = Rect::new(width, 0.0, window.x - width, upper);
            side_panel = Rect::new(width, upper, window.x - width, window.y - upper);
        } else {
            // Tall: the panels side by side above the table, in whatever height the table leaves, within reason.
            let spare = window.y - window.x * outer.y / outer.x;
            let upper = spare.clamp(window.y * 0.30, window.y * 0.4).round();
            let half = (window.x * 0.56).round();
            area = Rect::new(0.0, upper, window.x, window.y - upper);
            scale = scale_within(area.size());
            main_panel = Rect::new(0.0, 0.0, half, upper);
            side_panel = Rect::new(half, 0.0, window.x - half, upper);
        }
        let fitted = outer * scale;
        let corner = (area.center() - fitted / 2.0).round().max(vec2(0.0, area.y));
        let y = if fitted.y > area.h + 1.0 { (area.bottom() - fitted.y).round() } else { corner.y };
        let cabinet = Rect::new(corner.x, y, fitted.x, fitted.y);
        Self { size, cabinet, opening: area, scale, main_panel, side_panel, table }
    }

    /// A picture of the table alone, with its frame.
    pub(super) fn of_table(size: PixelSize, table: Vec2) -> Self {
        let (window, outer) = (size.to_vec(), Self::outer(table));
        let scale = (window / outer).min_element();
        let fitted = outer * scale;
        let corner = (window - fitted) / 2.0;
        let cabinet = Rect::new(corner.x, corner.y, fitted.x, fitted.y);
        let nothing = Rect::default();
        Self { size, cabinet, opening: cabinet, scale, main_panel: nothing, side_panel: nothing, table }
    }

    /// Size of a table with its frame, metres.
    pub(super) fn outer(table: Vec2) -> Vec2 {
        table + 2.0 * FRAME
    }

    /// The same somewhere else.
    pub(super) fn moved(&self, by: Vec2) -> Self {
        Self { cabinet: self.cabinet.offset(by), opening: self.opening.offset(by), ..self.clone() }
    }

    /// The table with its frame alone, all of it, in the upper left corner: for what is painted once.
    pub(super) fn of_board(&self) -> Self {
        let side = |length: f32| length.ceil().clamp(1.0, LARGEST) as u16;
        let size = PixelSize { width: side(self.cabinet.w), height: side(self.cabinet.h) };
        let cabinet = Rect::new(0.0, 0.0, self.cabinet.w, self.cabinet.h);
        Self { size, cabinet, opening: cabinet, ..self.clone() }
    }

    /// How much of the table is seen.
    pub(super) fn reach(&self) -> Reach {
        let seen = self.opening.h.min(self.cabinet.h);
        let hidden = self.cabinet.h - seen;
        // What is rounded is no reason to scroll.
        let hidden = if hidden < 2.0 { 0.0 } else { hidden };
        Reach { seen: seen / self.scale, hidden: hidden / self.scale, frame: FRAME }
    }

    /// The same with the table so many metres further down, so that its upper end is seen. Whole pixels keep it sharp.
    pub(super) fn scrolled(&self, metres: f32) -> Self {
        let down = vec2(0.0, (metres * self.scale).round());
        Self { cabinet: self.cabinet.offset(down), ..self.clone() }
    }

    /// The whole pixels of the picture that the table hides, frame included.
    pub(super) fn covered(&self) -> Rect {
        let Rect { x, y, w, h } =
            self.cabinet.intersect(Rect::new(0.0, 0.0, self.size.to_vec().x, self.size.to_vec().y)).unwrap_or_default();
        Rect::new(x, y, w.floor(), h.floor())
    }

    /// The part of the playfield that is seen.
    pub(super) fn seen_playfield(&self) -> Rect {
        self.playfield().intersect(self.opening).unwrap_or_default()
    }

    /// The same with the table off its place by so many metres. A real table moves by a millimetre: here it is more, so that
    /// it is seen, and whole pixels, so that everything on it stays sharp.
    pub(super) fn shaken(&self, metres: Vec2) -> Self {
        let away = (metres * SHAKE).clamp_length_max(MOST_SHAKE) * vec2(1.0, -1.0) * self.scale;
        let cabinet = self.cabinet.offset(away.round());
        Self { cabinet, ..self.clone() }
    }

    /// The same so many seconds after a tilt: the table jumps, and swings for half a second.
    pub(super) fn jolted(&self, seconds: f32) -> Self {
        // Long after it there is nothing to be seen, whenever it was.
        let seconds = seconds.clamp(0.0, 10.0);
        let swing = JOLT * (-JOLT_DAMPING * seconds).exp() * self.scale;
        let away = vec2((seconds * JOLT_SWING).cos(), 0.5 * (seconds * JOLT_SWING * 1.3).sin()) * swing;
        Self { cabinet: self.cabinet.offset(away.round()), ..self.clone() }
    }

    /// The pixel of a point on the table.
    pub(super) fn point(&self, metres: Vec2) -> Vec2 {
        let left = self.cabinet.x + FRAME * self.scale;
        let bottom = self.cabinet.y + (self.table.y + FRAME) * self.scale;
        vec2(left + metres.x * self.scale, bottom - metres.y * self.scale)
    }

    /// The point on the table of a pixel.
    pub(super) fn metres(&self, pixel: Vec2) -> Vec2 {
        (pixel - self.point(Vec2::ZERO)) * vec2(1.0, -1.0) / self.scale
    }

    /// The pixel of a point as written in a table file.
    pub(super) fn written(&self, (x, y): (f64, f64)) -> Vec2 {
        self.point(vec2(x as f32, y as f32))
    }

    /// Pixels of a length in metres.
    pub(super) fn length(&self, metres: f64) -> f32 {
        metres as f32 * self.scale
    }

    /// The playfield inside the frame.
    pub(super) fn playfield(&self) -> Rect {
        let corner = self.point(vec2(0.0, self.table.y));
        Rect::new(corner.x, corner.y, self.table.x * self.scale, self.table.y * self.scale)
    }
}

/// Pixels a metre for a table of a size in metres that may take so much room: the whole of it if that is of a decent size,
/// else as much as a player needs.
fn scale_within(room: Vec2, outer: Vec2) -> f32 {
    let whole = (room / outer).min_element();
    let is_decent = whole >= LEAST_SCALE.max(room.y / LONGEST_SHOWN);
    let wanted = SCROLLED_SCALE.max(room.y / SCROLLED_LENGTH).min(room.x / outer.x).min(LARGEST / outer.y);
    if is_decent || wanted < whole * WORTH_SCROLLING { whole } else { wanted }
}

#[cfg(test)]
mod tests {
    use super::*;

    const TABLE: Vec2 = Vec2::new(0.514, 1.067);

    fn inside(inner: Rect, outer: Vec2) -> bool {
        let slack = 0.51;
        inner.x >= -slack && inner.y >= -slack && inner.right() <= outer.x + slack && inner.bottom() <= outer.y + slack
    }

    fn sizes() -> impl Iterator<Item = PixelSize> {
        let sides = [200, 333, 600, 720, 900, 1080, 1280, 1920, 3000, 4000];
        sides.into_iter().flat_map(move |width| sides.into_iter().map(move |height| PixelSize { width, height }))
    }

    #[test]
    fn everything_is_inside_the_window_and_apart() {
        for size in sides_and_extremes() {
            let layout = Layout::new(size, TABLE);
            let window = size.to_vec();
            let seen = layout.cabinet.intersect(layout.opening).unwrap();
            for rect in [seen, layout.seen_playfield(), layout.main_panel, layout.side_panel] {
                assert!(inside(rect, window), "{size:?}: {rect:?}");
            }
            for panel in [layout.main_panel, layout.side_panel] {
                let shared = panel.intersect(seen);
                assert!(shared.is_none_or(|both| both.w < 1.0 || both.h < 1.0), "{size:?}: {panel:?} {shared:?}");
            }
            assert!(layout.main_panel.intersect(layout.side_panel).is_none_or(|both| both.w < 1.0 || both.h < 1.0));
        }
    }

    fn sides_and_extremes() -> impl Iterator<Item = PixelSize> {
        let extremes = [(4000, 200), (200, 3000), (1, 1), (1, 3000), (4000, 1)];
        sizes().chain(extremes.into_iter().map(|(width, height)| PixelSize { width, height }))
    }

    #[test]
    fn a_table_scrolls_where_it_would_be_too_small() {
        let hidden = |width, height, table| Layout::new(PixelSize { width, height }, table).reach().hidden;
        let tall = vec2(0.514, 1.9);
        for (width, height) in [(1280, 720), (1920, 1080), (800, 600), (500, 900), (3840, 2160)] {
            assert_eq!(hidden(width, height, TABLE), 0.0, "{width} x {height}");
            assert!((0.3..1.5).contains(&hidden(width, height, tall)), "{width} x {height}");
        }
        assert!((0.2..0.6).contains(&hidden(1280, 400, TABLE)));
    }

    #[test]
    fn both_ends_of_a_table_that_scrolls_come_into_sight() {
        let layout = Layout::new(PixelSize { width: 1280, height: 400 }, TABLE);
        let (opening, hidden) = (layout.opening, layout.reach().hidden);
        assert!((layout.cabinet.bottom() - opening.bottom()).abs() <= 1.0);
        let upper = layout.scrolled(hidden).cabinet;
        assert!((upper.y - opening.y).abs() <= 1.0, "{upper:?}");
        let board = layout.of_board();
        assert_eq!(board.scale, layout.scale);
        assert!(f32::from(board.size.height) >= layout.cabinet.h);
    }

    #[test]
    fn what_the_table_covers_is_whole_pixels_in_the_picture() {
        for (width, height) in [(1280, 720), (1280, 400), (500, 900), (800, 600)] {
            let layout = Layout::new(PixelSize { width, height }, TABLE);
            for layout in [layout.clone(), layout.scrolled(0.1), layout.jolted(0.0), layout.shaken(vec2(9.0, -9.0))] {
                let covered = layout.covered();
                assert!(inside(covered, layout.size.to_vec()), "{covered:?}");
                for side in [covered.x, covered.y, covered.w, covered.h] {
                    assert!(side == side.round() && side >= 0.0, "{covered:?}");
                }
            }
        }
    }

    #[test]
    fn the_aspect_of_the_table_is_kept() {
        for size in sizes() {
            let playfield = Layout::new(size, TABLE).playfield();
            let stretch = playfield.w / playfield.h / (TABLE.x / TABLE.y);
            assert!((stretch - 1.0).abs() < 1e-3, "{size:?}: {stretch}");
        }
    }

    #[test]
    fn y_runs_up_the_table_and_down_the_window() {
        let layout = Layout::new(PixelSize { width: 1280, height: 720 }, TABLE);
        let (low, high) = (layout.point(vec2(0.1, 0.0)), layout.point(vec2(0.1, 1.0)));
        assert!(high.y < low.y && (low.y - high.y - layout.length(1.0)).abs() < 1e-3);
        assert!((layout.point(Vec2::ZERO) - vec2(layout.playfield().x, layout.playfield().bottom())).length() < 1e-3);
    }

    #[test]
    fn a_nudged_table_moves_by_some_pixels_and_takes_its_points_along() {
        let layout = Layout::new(PixelSize { width: 1280, height: 720 }, TABLE);
        let shaken = layout.shaken(vec2(0.001, 0.0015));
        let away = shaken.point(vec2(0.1, 0.2)) - layout.point(vec2(0.1, 0.2));
        assert_eq!(away, vec2(3.0, -4.0));
        assert_eq!((shaken.main_panel, shaken.side_panel), (layout.main_panel, layout.side_panel));
        let most = layout.shaken(vec2(9.0, 0.0)).point(Vec2::ZERO) - layout.point(Vec2::ZERO);
        assert!(most.x > 5.0 && most.x < 10.0, "{most}");
        assert_eq!(layout.shaken(Vec2::ZERO), layout);
    }

    #[test]
    fn a_tilt_jolts_the_table_for_a_moment() {
        let layout = Layout::new(PixelSize { width: 1280, height: 720 }, TABLE);
        assert!(layout.jolted(0.0).point(Vec2::ZERO).distance(layout.point(Vec2::ZERO)) > 5.0);
        for seconds in [1.0, 60.0, f32::INFINITY] {
            assert_eq!(layout.jolted(seconds), layout, "{seconds}");
        }
    }

    #[test]
    fn pixels_and_metres_belong_together() {
        let layout = Layout::new(PixelSize { width: 800, height: 600 }, TABLE).scrolled(0.1);
        let place = vec2(0.123, 0.456);
        assert!(layout.metres(layout.point(place)).distance(place) < 1e-5);
    }

    #[test]
    fn a_huge_window_is_painted_smaller_in_the_same_shape() {
        assert_eq!(PixelSize::of_window(8192.0, 4096.0), PixelSize { width: 4096, height: 2048 });
        assert_eq!(PixelSize::of_window(0.0, 0.0), PixelSize { width: 1, height: 1 });
        assert_eq!(PixelSize::of_window(1280.0, 720.0), PixelSize { width: 1280, height: 720 });
    }

    #[test]
    fn a_letterbox_touches_two_sides_and_keeps_the_shape() {
        let place = letterbox(PixelSize { width: 200, height: 100 }, vec2(300.0, 300.0));
        assert_eq!((place.x, place.y, place.w, place.h), (0.0, 75.0, 300.0, 150.0));
    }
}
