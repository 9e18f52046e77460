//! Where the parts of the two side panels stand, and how large their text is. Pure arithmetic on a [`Layout`].

use macroquad::math::Rect;

use super::dot_matrix::{ADVANCE, ROWS};
use super::layout::Layout;

/// Seats that the display of scores has rows for even while they are empty.
pub(super) const USUAL_SEATS: u16 = 4;

/// Places and sizes of the side panels' parts. A place that a small window has no room for is empty (0 by 0).
#[derive(Debug, Clone, PartialEq)]
pub(super) struct Panels {
    /// The lettering of the game's name.
    pub(super) title: Rect,
    /// Display with names and points.
    pub(super) scores: Rect,
    /// Display with the one line that matters most.
    pub(super) message: Rect,
    /// Displays with the ball, the multiplier and the bonus.
    pub(super) counters: [Rect; 3],
    /// Onlookers and the queue.
    pub(super) onlookers: Rect,
    /// What can be pressed.
    pub(super) keys: Rect,
    /// Distances between dots: labels, messages, the score of the seat that plays, the banner, points that float up.
    pub(super) small: u16,
    pub(super) medium: u16,
    pub(super) score: u16,
    pub(super) banner: u16,
    pub(super) popup: u16,
    /// Space inside a display's rim, and between parts.
    pub(super) padding: f32,
}

impl Panels {
    /// Divides the panels of a layout, for text that is so many times as large as usual.
    pub(super) fn new(layout: &Layout, text_scale: f32) -> Self {
        let narrow = layout.main_panel.w.min(layout.side_panel.w);
        let short = layout.main_panel.h.min(layout.side_panel.h);
        let padding = (narrow * 0.025).min(short * 0.03).round().clamp(2.0, 24.0);
        let main = inset(layout.main_panel, 2.0 * padding);
        let side = inset(layout.side_panel, 2.0 * padding);

        // Text of 5 by 7 pixels is hard to read: twice that wherever 16 letters fit.
        let roomy = (main.w.min(side.w) / 180.0).min(main.h / 100.0).floor();
        let readable = if main.w.min(side.w) >= 190.0 && main.h >= 90.0 { 2.0 } else { 1.0 };
        let usual = roomy.max(readable);
        // Fourteen letters beside each other, and four seats below each other, are the least that must fit.
        let most = (main.w.min(side.w) / f32::from(14 * ADVANCE)).min(main.h / f32::from(USUAL_SEATS * (ROWS + 4) * 2));
        let small = (usual * text_scale).round().min(most.floor()).max(usual) as u16;
        let medium = small + small.div_ceil(2);
        let row = |pitch: u16| f32::from(pitch * ROWS);

        // Main: message at the bottom, scores for as many seats as usual, and all the rest is the title's.
        let message_height = (row(medium) * 1.4 + 4.0 * padding).min(main.h / 3.0).round();
        let seats = f32::from(USUAL_SEATS) * seat_height(small, medium) + 2.0 * row(small) + 3.0 * padding;
        let spare = main.h - message_height - seats - 2.0 * padding;
        let title_height = if main.h >= 260.0 {
            let least = (main.w * 0.42).min(main.h * 0.25);
            spare.clamp(least, (main.w * 0.95).max(least)).round()
        } else {
            0.0
        };
        let message = Rect::new(main.x, main.bottom() - message_height, main.w, message_height);
        let scores_top = main.y + title_height + if title_height > 0.0 { padding } else { 0.0 };
        let scores_height = (message.y - padding - scores_top).max(0.0);
        let scores = Rect::new(main.x, scores_top, main.w, scores_height);
        // Eleven glyphs are 999,999,999, and the display should hold two such lines with their names; but it is no smaller
        // than the score of who waits: a line that is too long shrinks.
        let score = fitting(main.w - 4.0 * padding, 11).min((scores_height / 28.0) as u16).min(16).max(medium);

        // Side: counters, then onlookers, and keys at the bottom.
        let counters = counters(side, row(small), row(medium), padding);
        let rest_top = counters[2].bottom() + 2.5 * padding;
        let rest = (side.bottom() - rest_top).max(0.0);
        // Keys come first: six lines of them. Where they are too long for the panel's width they take two rows each.
        let wanted = if side.w < f32::from(small * ADVANCE) * 28.0 { 6.0 * 2.75 } else { 7.0 * 1.6 };
        let keys_height = (rest * 0.65).max(row(small) * 6.0 * 1.25).min(row(small) * wanted).min(rest).round();
        let keys = Rect::new(side.x, side.bottom() - keys_height, side.w, keys_height);
        let onlookers = Rect::new(side.x, rest_top, side.w, (keys.y - padding - rest_top).max(0.0));

        let banner = fitting(layout.playfield().w * 0.86, 9).clamp(1, 16);
        let popup = ((layout.scale / 330.0 * text_scale).round() as u16).clamp(1, 8);
        let title = Rect::new(main.x, main.y, main.w, title_height);
        Self { title, scores, message, counters, onlookers, keys, small, medium, score, banner, popup, padding }
    }

    /// All displays with glass in front of dots.
    pub(super) fn displays(&self) -> impl Iterator<Item = Rect> {
        [self.scores, self.message].into_iter().chain(self.counters)
    }

    /// The main panel without the game's name; empty where that has no room, either.
    pub(super) fn below_title(&self) -> Rect {
        let Rect { x, y, w, .. } = self.scores;
        if self.title.h > 0.0 { Rect::new(x, y, w, self.message.bottom() - y) } else { Rect::default() }
    }

    /// Every distance between dots that text may be set in; some smaller ones too, for text that is too long.
    pub(super) fn pitches(&self) -> impl Iterator<Item = u16> {
        let used = [self.small, self.medium, self.medium + 1, self.score, self.banner, self.popup];
        let smaller = [self.score - self.score / 4, self.banner.div_ceil(2), self.banner - self.banner / 4];
        used.into_iter().chain(smaller).chain((self.small / 2).max(1)..self.small)
    }
}

/// Height of a seat's name and points, each in its own line, and the space below.
pub(super) fn seat_height(small: u16, medium: u16) -> f32 {
    f32::from((small + medium) * ROWS) + f32::from(small) * 10.0
}

/// Ball and multiplier beside each other, the bonus below; or, where height is short, three lines.
fn counters(side: Rect, label: f32, value: f32, padding: f32) -> [Rect; 3] {
    if side.h < label * 24.0 {
        let height = (label + 2.5 * padding).min(side.h / 3.0).floor();
        return [0.0, 1.0, 2.0].map(|place| Rect::new(side.x, side.y + place * height, side.w, height));
    }
    let height = (label + value + 3.5 * padding).min(side.h / 3.5).round();
    let half = ((side.w - padding) / 2.0).floor().max(0.0);
    let second_row = side.y + height + padding;
    [
        Rect::new(side.x, side.y, half, height),
        Rect::new(side.x + half + padding, side.y, (side.w - half - padding).max(0.0), height),
        Rect::new(side.x, second_row, side.w, height),
    ]
}

/// The largest distance between dots at which so many glyphs are no wider than `width`.
fn fitting(width: f32, glyphs: u16) -> u16 {
    (width.max(0.0) / f32::from(glyphs * ADVANCE)) as u16
}

fn inset(rect: Rect, margin: f32) -> Rect {
    let margin = margin.min(rect.w / 2.0).min(rect.h / 2.0);
    Rect::new(rect.x + margin, rect.y + margin, rect.w - 2.0 * margin, rect.h - 2.0 * margin)
}

#[cfg(test)]
mod tests {
    use macroquad::math::vec2;

    use super::super::layout::PixelSize;
    use super::*;

    const SCALES: [f32; 3] = [1.0, 1.3, 1.6];

    #[test]
    fn text_grows_where_there_is_room_and_never_shrinks() {
        for (width, height) in [(500, 900), (800, 600), (1280, 400), (1280, 720), (1920, 1080), (3840, 2160)] {
            let layout = Layout::new(PixelSize { width, height }, vec2(0.514, 1.067));
            let [usual, _, largest] = SCALES.map(|scale| Panels::new(&layout, scale));
            assert!(largest.small >= usual.small && largest.popup >= usual.popup, "{width} x {height}");
            if width >= 1280 && height >= 720 {
                assert!(largest.small > usual.small && largest.popup > usual.popup, "{width} x {height}");
            }
        }
    }

    /// Name and points of each seat at least share a line, and no line is drawn over another: see the display of scores.
    #[test]
    fn the_scores_of_four_have_room_in_every_usual_window() {
        let sizes = [(640, 480), (800, 600), (1024, 768), (1280, 720), (1920, 1080), (3840, 2160), (900, 1400)];
        for ((width, height), text_scale) in sizes.into_iter().flat_map(|size| SCALES.map(|scale| (size, scale))) {
            let layout = Layout::new(PixelSize { width, height }, vec2(0.514, 1.067));
            let panels = Panels::new(&layout, text_scale);
            let lines = f32::from(USUAL_SEATS) * f32::from(panels.small * (ROWS + 4));
            let margin = (panels.padding * 1.2).round();
            let room = panels.scores.h - 2.0 * margin;
            assert!(lines <= room + f32::from(panels.small * 4) + 1.0, "{width} x {height}: {lines} in {room}");
        }
    }

    #[test]
    fn parts_are_inside_their_panels() {
        let sides = [1, 200, 480, 600, 720, 900, 1280, 1920, 4000];
        let sizes = sides.into_iter().flat_map(|width| sides.map(|height| (width, height)));
        for ((width, height), text_scale) in sizes.flat_map(|size| SCALES.map(|scale| (size, scale))) {
            let layout = Layout::new(PixelSize { width, height }, vec2(0.514, 1.067));
            let panels = Panels::new(&layout, text_scale);
            let mains = [panels.title, panels.scores, panels.message].map(|part| (part, layout.main_panel));
            let sides = [panels.onlookers, panels.keys].into_iter().chain(panels.counters);
            for (part, panel) in mains.into_iter().chain(sides.map(|part| (part, layout.side_panel))) {
                assert!(part.w >= 0.0 && part.h >= 0.0, "{width} x {height}: {part:?}");
                if part.w < 1.0 || part.h < 1.0 || panel.w < 40.0 || panel.h < 40.0 {
                    continue;
                }
                let inside = part.x >= panel.x && part.y >= panel.y;
                let inside = inside && part.right() <= panel.right() + 1.0 && part.bottom() <= panel.bottom() + 1.0;
                assert!(inside, "{width} x {height}: {part:?} in {panel:?}");
            }
            assert!(panels.pitches().all(|pitch| pitch >= 1));
        }
    }
}
