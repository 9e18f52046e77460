//! Where the items of a page stand, for drawing them and for telling which one a pointer is on. Pure arithmetic.

use macroquad::math::{Rect, Vec2, vec2};

use super::super::dot_matrix::{ADVANCE, ROWS, measure};
use super::cards::Cards;
use crate::menu::{Control, Item, MenuView, Page};

/// Glyphs in front of a label, where the ball marks the focus.
const CURSOR: f32 = 2.5;
/// Glyphs of a page at the least, and of a line of words at the most: longer ones are hard to read.
const LEAST_GLYPHS: f32 = 26.0;
const MOST_GLYPHS: f32 = 46.0;
/// Glyphs of the bar of a level.
const LEVEL: f32 = 10.0;
/// Dots between the edge of the plate and what is on it.
const MARGIN: f32 = 8.0;
/// The same in a panel, which is narrow.
const PANEL_MARGIN: f32 = 6.0;
/// Dots from a line of words to the next.
pub(super) const LINE: f32 = 11.0;
/// Dots of the row of an item that can have the focus, and above a heading.
const ITEM: f32 = 14.0;
const PANEL_ITEM: f32 = 12.0;
const ABOVE_HEADING: f32 = 6.0;

/// An item that is on the screen.
#[derive(Debug, Clone, PartialEq)]
pub(super) struct Row {
    /// Its place among the items of the page.
    pub(super) item: usize,
    /// All of it: what a pointer hits.
    pub(super) area: Rect,
    /// Its label, line by line.
    pub(super) lines: Vec<String>,
    /// Of a table: where its picture and its words stand.
    pub(super) picture: Rect,
    pub(super) words: Rect,
}

/// Where a page stands.
#[derive(Debug, Clone, PartialEq)]
pub(super) struct MenuLayout {
    /// What it is drawn on.
    pub(super) plate: Rect,
    /// The plate lies over the table, which is dimmed.
    pub(super) covers: bool,
    /// The heading, and the distance between its dots; 0 if there is none.
    pub(super) title: (Vec2, u16),
    /// Distance between dots of everything else, and of what is said about the item with the focus.
    pub(super) pitch: u16,
    pub(super) small: u16,
    /// Items from the top down.
    pub(super) rows: Vec<Row>,
    /// What is said about the item with the focus: where, and line by line.
    pub(super) note: (Vec2, Vec<String>),
    /// There is more above, and below.
    pub(super) more: [bool; 2],
}

/// The largest distance between dots in a window of a size: text that can be read from an arm's length, and so many times
/// larger.
pub(super) fn largest(size: Vec2, scale: f32) -> u16 {
    ((size.y / 210.0).min(size.x / 190.0) * scale).round().clamp(1.0, 8.0) as u16
}

impl MenuLayout {
    /// In a window of a size. `panel`: a place beside the table where a short page may stand, its own heading above it.
    /// `largest`: see there.
    pub(super) fn new(size: Vec2, largest: u16, panel: Rect, view: &MenuView) -> Self {
        let least = largest.min(2);
        if view.page == Page::Title && panel.w >= size.x * 0.2 {
            let fits = (least..=largest).rev().find_map(|pitch| Self::attempt(panel, pitch, view, Place::Panel));
            if let Some(layout) = fits {
                return layout;
            }
        }
        let whole = Rect::new(0.0, 0.0, size.x, size.y);
        let fits = (least..=largest).rev().find_map(|pitch| Self::attempt(whole, pitch, view, Place::Middle));
        fits.or_else(|| Self::attempt(whole, least, view, Place::Cut)).unwrap_or_else(|| Self::nothing(whole))
    }

    fn nothing(plate: Rect) -> Self {
        Self {
            plate,
            covers: true,
            title: (Vec2::ZERO, 0),
            pitch: 1,
            small: 1,
            rows: Vec::new(),
            note: (Vec2::ZERO, Vec::new()),
            more: [false; 2],
        }
    }

    /// With text of a size; `None` if that has no room.
    fn attempt(area: Rect, pitch: u16, view: &MenuView, place: Place) -> Option<Self> {
        let dots = f32::from(pitch);
        let glyph = f32::from(ADVANCE) * dots;
        let small = (pitch - pitch / 3).max(pitch.min(2));
        let margin = dots * if place == Place::Panel { PANEL_MARGIN } else { MARGIN };
        let outer = if place == Place::Panel { 0.0 } else { (area.w.min(area.h) * 0.02).round() };
        let most = area.w - 2.0 * (outer + margin);

        // 1. How wide: the longest item, but words are broken.
        let title_pitch = if place == Place::Panel { 0 } else { title_pitch(&view.title, pitch, most) };
        let cards = Cards::new(area, dots, view);
        let wanted = view.items.iter().map(wanted_glyphs).fold(LEAST_GLYPHS.max(cards.glyphs()), f32::max);
        let least = view.items.iter().map(least_glyphs).fold(0.0, f32::max);
        if least * glyph > most && place != Place::Cut {
            return None;
        }
        let most_glyphs = MOST_GLYPHS.max(least).max(cards.glyphs());
        let width = if place == Place::Panel { most } else { (wanted.min(most_glyphs) * glyph).min(most) };
        let width = width.max(measure(&view.title, title_pitch).x.min(most));

        // 2. How high.
        let words = cards.words(width);
        let lines: Vec<Vec<String>> =
            view.items.iter().map(|item| lines_of(item, width, words, pitch, small)).collect();
        let is_card = |(item, _): &(&Item, &Vec<String>)| matches!(item.control, Control::Table(_));
        let card_lines = view.items.iter().zip(&lines).filter(is_card).map(|(_, lines)| lines.len()).max().unwrap_or(0);
        let heights: Vec<f32> = view
            .items
            .iter()
            .zip(&lines)
            .map(|(item, lines)| match item.control {
                Control::Table(_) => cards.height(card_lines, f32::from(small)),
                _ if place == Place::Panel => PANEL_ITEM * dots,
                _ => height(item, lines.len()) * dots,
            })
            .collect();
        let notes = view.items.iter().map(|item| &item.note).chain([&view.problem]);
        let note_lines = notes.map(|note| wrap(note, width, small).len()).max().unwrap_or(0) as f32;
        let note_height = if note_lines > 0.0 { note_lines * LINE * f32::from(small) + 4.0 * dots } else { 0.0 };
        let title_height = if title_pitch > 0 { f32::from(ROWS * title_pitch) + 9.0 * dots } else { 0.0 };
        let room = area.h - 2.0 * (outer + margin) - title_height - note_height;
        let needed: f32 = heights.iter().sum::<f32>() - cards.saved(&heights);
        if needed > room && place != Place::Cut {
            return None;
        }

        // 3. Which items, should there be no room for all: those around the focus.
        let shown = if cards.is_beside { 0..heights.len() } else { window(&heights, view.focus, room) };
        let height = heights[shown.clone()].iter().sum::<f32>() - cards.saved(&heights)
            + title_height
            + note_height
            + 2.0 * margin;
        let plate = match place {
            Place::Panel => area,
            Place::Middle | Place::Cut => {
                let (w, h) = ((width + 2.0 * margin).min(area.w), height.min(area.h));
                let corner = (area.center() - vec2(w, h) / 2.0).floor();
                Rect::new(corner.x, corner.y, w.ceil(), h.ceil())
            }
        };
        let (left, mut y) = (plate.x + margin, plate.y + margin);
        let title = (vec2((plate.center().x - measure(&view.title, title_pitch).x / 2.0).round(), y), title_pitch);
        y += title_height;
        // In a panel items are spread over its height.
        let spare = if place == Place::Panel { (room - needed) / (heights.len() + 1) as f32 } else { 0.0 };
        let spread = spare.clamp(0.0, 5.0 * dots).floor();
        let mut rows = Vec::new();
        for (item, lines) in lines.into_iter().enumerate().skip(shown.start).take(shown.len()) {
            let place = Rect::new(left, y.round(), width, heights[item]);
            let (area, picture, words) = match view.items[item].control {
                Control::Table(_) => cards.place(item, place),
                _ => (place, Rect::default(), Rect::default()),
            };
            rows.push(Row { item, area, lines, picture, words });
            // Cards beside each other are one row.
            if !cards.is_beside || item + 1 >= cards.count {
                y += heights[item] + spread;
            }
        }
        let about = view.items.get(view.focus).map_or("", |item| item.note.as_str());
        let text = if view.problem.is_empty() { about } else { &view.problem };
        let note = (vec2(left, plate.bottom() - margin - note_height + 4.0 * dots), wrap(text, width, small));
        let more = [shown.start > 0, shown.end < view.items.len()];
        Some(Self { plate, covers: place != Place::Panel, title, pitch, small, rows, note, more })
    }

    /// The item at a point, and the share of the width of its value at which.
    pub(super) fn hit(&self, at: Vec2) -> Option<(usize, f32)> {
        let row = self.rows.iter().find(|row| row.area.contains(at))?;
        let bar = self.bar(row);
        Some((row.item, (at.x - bar.x) / bar.w))
    }

    /// Where the value of a level stands.
    pub(super) fn bar(&self, row: &Row) -> Rect {
        let Rect { y, w, h, .. } = row.area;
        let width = LEVEL * f32::from(ADVANCE * self.pitch);
        let width = width.min(w / 2.0);
        Rect::new(row.area.right() - width, y, width, h)
    }
}

/// Where a page is to stand.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
enum Place {
    /// Beside the table.
    Panel,
    /// In the middle of the window.
    Middle,
    /// The same, as much of it as there is room for.
    Cut,
}

/// The largest distance between dots of a heading, where that of the rest is at the most so much.
pub(super) fn largest_title(largest: u16) -> u16 {
    (2 * largest).min(12)
}

/// A heading is twice as large as the rest, if there is room.
fn title_pitch(title: &str, pitch: u16, width: f32) -> u16 {
    (pitch + 1..=largest_title(pitch)).rev().find(|&larger| measure(title, larger).x <= width).unwrap_or(pitch)
}

/// Glyphs that an item would take in one line.
fn wanted_glyphs(item: &Item) -> f32 {
    let label = item.label.chars().count() as f32;
    match &item.control {
        Control::Words | Control::Heading => label,
        Control::Pair(value) => label + 2.0 + value.chars().count() as f32,
        // A long address is cut.
        Control::Field(_) | Control::Table(_) => LEAST_GLYPHS,
        Control::Level { .. } => CURSOR + label + 2.0 + LEVEL,
        Control::Switch { .. } => CURSOR + label + 2.0 + 3.0,
        Control::Keys { keys, .. } => CURSOR + label + 2.0 + (keys.chars().count() as f32).max(11.0),
        Control::Open(_) | Control::Back | Control::Act(_) | Control::Join(_) => CURSOR + label,
    }
}

/// Glyphs that it takes at the least: words are broken, and of keys as many are shown as there is room for.
fn least_glyphs(item: &Item) -> f32 {
    match item.control {
        Control::Words => 0.0,
        Control::Keys { .. } => CURSOR + item.label.chars().count() as f32 + 2.0 + 11.0,
        _ => wanted_glyphs(item),
    }
}

/// Dots that an item takes.
fn height(item: &Item, lines: usize) -> f32 {
    match item.control {
        Control::Words => LINE * lines as f32 + 3.0,
        Control::Heading => ABOVE_HEADING + LINE,
        Control::Pair(_) => LINE,
        // See `Cards`.
        Control::Table(_) => 0.0,
        Control::Field(_) => ITEM + 4.0,
        Control::Level { .. } | Control::Switch { .. } | Control::Keys { .. } => ITEM,
        Control::Open(_) | Control::Back | Control::Act(_) | Control::Join(_) => ITEM,
    }
}

/// `words`: the width of a table's.
fn lines_of(item: &Item, width: f32, words: f32, pitch: u16, small: u16) -> Vec<String> {
    match &item.control {
        Control::Words => wrap(&item.label, width, pitch),
        Control::Table(shelved) => {
            let name = wrap(&item.label, words, pitch).into_iter().take(1);
            name.chain(wrap(&shelved.about, words, small)).collect()
        }
        _ => vec![item.label.clone()],
    }
}

/// Breaks a text at blanks; a word that is longer than a line is broken where the line ends.
pub(super) fn wrap(text: &str, width: f32, pitch: u16) -> Vec<String> {
    let most = ((width + f32::from(pitch)) / f32::from(ADVANCE * pitch)).max(1.0) as usize;
    let mut lines: Vec<String> = Vec::new();
    for word in text.split_whitespace() {
        let letters: Vec<char> = word.chars().collect();
        for (place, piece) in letters.chunks(most).enumerate() {
            match lines.last_mut() {
                Some(line) if place == 0 && line.chars().count() + 1 + piece.len() <= most => {
                    line.push(' ');
                    line.extend(piece);
                }
                _ => lines.push(piece.iter().collect()),
            }
        }
    }
    lines
}

/// As many items around the focus as there is room for.
fn window(heights: &[f32], focus: usize, room: f32) -> std::ops::Range<usize> {
    let (mut start, mut end) = (focus.min(heights.len()), (focus + 1).min(heights.len()));
    loop {
        let used: f32 = heights[start..end].iter().sum();
        let above = start.checked_sub(1).filter(|&at| used + heights[at] <= room);
        let below = Some(end).filter(|&at| at < heights.len() && used + heights[at] <= room);
        match (above, below) {
            // In turns, so that the focus stays about in the middle.
            (Some(at), _) if focus - start < end - focus => start = at,
            (_, Some(at)) => end = at + 1,
            (Some(at), None) => start = at,
            (None, None) => return start..end,
        }
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::menu::{Facts, Menu};

    const SIZES: [(f32, f32); 8] = [
        (1280.0, 720.0),
        (800.0, 600.0),
        (500.0, 900.0),
        (1920.0, 1080.0),
        (640.0, 480.0),
        (320.0, 240.0),
        (3840.0, 2160.0),
        (200.0, 200.0),
    ];

    fn facts() -> Facts {
        let keys = vec![("L SHIFT, Z".to_owned(), "LEFT FLIPPER".to_owned()); 6];
        let reason = "THE SERVER IS GONE: some-long-host-name-without-any-blank.example.org:7777".to_owned();
        Facts { table: "Classic".to_owned(), keys, reason, ..Facts::default() }
    }

    fn views() -> impl Iterator<Item = MenuView> {
        let pages = [
            Page::Title,
            Page::Against,
            Page::Join(shared::protocol::Role::Play),
            Page::HowTo,
            Page::Settings,
            Page::Keys,
            Page::Pause,
            Page::Lost,
        ];
        pages.into_iter().flat_map(|page| {
            let mut menu = Menu::default();
            menu.show(page);
            menu.view(&facts())
        })
    }

    #[test]
    fn items_are_on_the_plate_in_the_window_apart_and_hit_where_they_are() {
        let sizes = SIZES.into_iter().flat_map(|size| [(size, 1.0), (size, 1.6)]);
        for ((width, height), scale) in sizes {
            let size = vec2(width, height);
            let panel = Rect::new(10.0, height * 0.4, width * 0.33, height * 0.55);
            for view in views() {
                let layout = MenuLayout::new(size, largest(size, scale), panel, &view);
                let plate = layout.plate;
                assert!(plate.x >= 0.0 && plate.right() <= width && plate.y >= 0.0 && plate.bottom() <= height);
                assert!(layout.rows.iter().any(|row| row.item == view.focus), "{width} x {height}: no focus");
                for rows in layout.rows.windows(2) {
                    assert!(rows[0].area.bottom() <= rows[1].area.y + 1.0);
                }
                for row in &layout.rows {
                    let area = row.area;
                    assert_eq!(layout.hit(area.center()).map(|(item, _)| item), Some(row.item));
                    let inside = area.x >= plate.x && area.right() <= plate.right() + 1.0 && area.y >= plate.y;
                    let small = width < 600.0 || height < 400.0;
                    assert!(small || inside && area.bottom() <= plate.bottom() + 1.0, "{width} x {height}: {area:?}");
                }
                if width >= 640.0 && height >= 480.0 {
                    assert_eq!(layout.rows.len(), view.items.len(), "{width} x {height}: {:?} is cut", view.page);
                    assert!(layout.pitch >= 2, "{width} x {height}: too small to read");
                }
            }
        }
    }

    #[test]
    fn words_are_broken_at_blanks_or_where_the_line_ends() {
        assert_eq!(wrap("THE BALL  IS ROUND", 8.0 * 6.0, 1), ["THE BALL", "IS ROUND"]);
        assert_eq!(wrap("A HOST-OF-LONG-NAME B", 5.0 * 6.0, 1), ["A", "HOST-", "OF-LO", "NG-NA", "ME B"]);
        assert!(wrap(" ", 100.0, 1).is_empty() && !wrap("AB", 0.0, 3).is_empty());
    }

    #[test]
    fn what_has_no_room_is_cut_around_the_focus() {
        let heights = [10.0; 9];
        assert_eq!(window(&heights, 4, 30.0), 3..6);
        assert_eq!(window(&heights, 0, 30.0), 0..3);
        assert_eq!(window(&heights, 8, 30.0), 6..9);
        assert_eq!(window(&heights, 8, 1.0), 8..9);
        assert_eq!(window(&heights, 2, 1000.0), 0..9);
        assert_eq!(window(&[], 0, 10.0), 0..0);
    }
}
