//! Text: the displays of the side panels, and the banner over the playfield.

use macroquad::color::{Color, WHITE};
use macroquad::math::{Rect, Vec2, vec2};

use super::atlas::{Batch, Sprite};
use super::dot_matrix::{ADVANCE, Fonts, ROWS, cells, grouped, measure};
use super::minis::{Slot, slots};
use super::palette::{AMBER, AMBER_DIM, DOT_OFF, ICE, IVORY, tint};
use super::panels::{Panels, USUAL_SEATS, seat_height};
use crate::view::{Hud, OtherBoard, SeatView, View};

/// What the text is drawn with.
pub(super) struct Writer<'a> {
    pub(super) panels: &'a Panels,
    pub(super) fonts: &'a Fonts,
    pub(super) batch: &'a mut Batch,
}

/// Where a line stands between two edges.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub(super) enum Align {
    Left,
    Middle,
    Right,
}

impl Writer<'_> {
    /// Everything in the side panels; returns where other boards of a size in metres are to be drawn. The place of the
    /// onlookers may be needed for the overlay's words.
    pub(super) fn panels(&mut self, view: &View, table: Vec2) -> Vec<Slot> {
        let hud = &view.hud;
        self.scores(hud, view.clock);
        self.message(hud);
        self.counters(hud);
        self.keys(hud);
        if view.overlay.is_none() { self.onlookers(hud, &view.others, table) } else { Vec::new() }
    }

    /// Names and points of all seats: large for the one that plays, if there is room; then rows that wait for more.
    fn scores(&mut self, hud: &Hud, clock: f32) {
        let area = self.inside(self.panels.scores);
        let (small, medium, large) = (self.panels.small, self.panels.medium, self.panels.score);
        let lines = hud.seats.len() as f32;
        let pair = seat_height(small, medium);
        let roomy = lines * pair + rows(large) - rows(medium) <= area.h;
        // Without the room for a line of name and a line of points each, both share one line.
        let dense = lines * pair > area.h;
        let mut y = area.y;
        for seat in &hud.seats {
            let pitch = if dense {
                small
            } else if seat.active && roomy {
                large
            } else {
                medium
            };
            if y + rows(pitch) > area.bottom() + 1.0 {
                return;
            }
            let color = if seat.active || hud.crowd.is_some() { tint(AMBER, 1.0) } else { tint(AMBER_DIM, 1.0) };
            let name_color = if seat.you { tint(ICE, if seat.active { 1.0 } else { 0.75 }) } else { color };
            let score = grouped(seat.score);
            let room = if dense { area.w - measure(&score, pitch).x - 2.0 * self.gap() } else { area.w };
            let name_area = Rect::new(area.x, area.y, room.max(0.0), area.h);
            self.line(name_area, y, &seat_name(seat, clock), small, Align::Left, name_color);
            if dense {
                self.line(area, y, &score, pitch, Align::Right, color);
                y += rows(pitch) + self.gap();
            } else {
                y += rows(small) + self.gap();
                self.row(area, y, &score, pitch, Align::Right, color);
                y += rows(pitch) + self.gap() * 1.5;
            }
        }
        for place in hud.seats.len()..usize::from(USUAL_SEATS) {
            if dense || y + pair > area.bottom() + self.gap() * 1.5 {
                return;
            }
            if let (Some(crowd), true) = (&hud.crowd, place == hud.seats.len()) {
                self.energy(crowd.energy, area, y, clock);
                y += pair;
                continue;
            }
            let invitation = if place == 0 { "NO PLAYERS YET" } else { "" };
            self.line(area, y, invitation, small, Align::Left, tint(AMBER_DIM, 1.0));
            self.row(area, y + rows(small) + self.gap(), "", medium, Align::Right, WHITE);
            y += pair;
        }
    }

    fn message(&mut self, hud: &Hud) {
        let area = self.inside(self.panels.message);
        let wanted = (self.panels.medium + 1).min((area.h / f32::from(ROWS)) as u16);
        let pitch = self.fonts.fitting(&hud.message, wanted, area.w);
        let small = self.panels.small;
        let two_rows = 2.0 * rows(small) + self.gap();
        // A long message goes into two rows rather than into small print.
        let (lines, pitch) = match halves(&hud.message) {
            Some(halves) if pitch < small && two_rows <= area.h => (halves.to_vec(), small),
            _ => (vec![hud.message.as_str()], pitch),
        };
        let step = rows(pitch) + self.gap();
        let mut y = area.y + ((area.h - step * lines.len() as f32 + self.gap()) / 2.0).max(0.0);
        for line in lines {
            self.row(area, y, line, pitch, Align::Middle, tint(AMBER, 1.0));
            y += step;
        }
    }

    fn counters(&mut self, hud: &Hud) {
        let playing = hud.ball > 0;
        let ball = if playing { format!("{}/{}", hud.ball, hud.balls) } else { "-".to_owned() };
        let multiplier = format!("{}X", hud.multiplier.max(1));
        let bonus = grouped(hud.bonus);
        let (small, medium) = (self.panels.small, self.panels.medium);
        let texts = [("BALL", ball), ("BONUS X", multiplier), ("BONUS", bonus)];
        for (place, (label, value)) in self.panels.counters.into_iter().zip(texts) {
            let area = self.inside(place);
            let color = tint(if playing { AMBER } else { AMBER_DIM }, 1.0);
            if area.h < rows(small) + rows(medium) {
                // One line for both.
                let y = area.y + ((area.h - rows(small)) / 2.0).max(0.0);
                self.line(area, y, label, small, Align::Left, tint(AMBER_DIM, 1.0));
                self.line(area, y, &value, small, Align::Right, color);
            } else {
                self.line(area, area.y, label, small, Align::Left, tint(AMBER_DIM, 1.0));
                self.row(area, area.bottom() - rows(medium), &value, medium, Align::Right, color);
            }
        }
    }

    /// How the room is played, who watches and waits; below that what the crowd may do, or other boards, whose places are
    /// returned.
    fn onlookers(&mut self, hud: &Hud, others: &[OtherBoard], table: Vec2) -> Vec<Slot> {
        let area = self.panels.onlookers;
        let area = Rect::new(area.x + self.margin(), area.y, area.w - 2.0 * self.margin(), area.h);
        let small = self.panels.small;
        let step = rows(small) * 1.6;
        let is_short = hud.crowd.is_some() || !others.is_empty();
        let mut lines = Vec::new();
        if !hud.title.is_empty() {
            lines.push((hud.title.clone(), tint(IVORY, 1.0)));
        }
        if is_short {
            let watch = (hud.spectators > 0).then(|| format!("{} WATCHING", hud.spectators));
            let next = hud.queue.first().map(|name| format!("{name} NEXT"));
            let words: Vec<String> = watch.into_iter().chain(next).collect();
            lines.extend((!words.is_empty()).then(|| (words.join(", "), tint(ICE, 0.75))));
        } else {
            lines.extend(self.everybody(hud, area.h - step * lines.len() as f32));
        }
        // The last line needs no space below it.
        let room = ((area.h + step - rows(small)) / step) as usize;
        for ((text, color), line) in lines.iter().take(room).zip(0_u8..) {
            self.line(area, area.y + step * f32::from(line), text, small, Align::Left, *color);
        }
        let top = step * lines.len() as f32 + rows(small) * 0.4;
        let rest = Rect::new(area.x, area.y + top, area.w, (area.h - top - self.gap()).max(0.0));
        if let Some(crowd) = &hud.crowd {
            self.crowd(crowd, rest);
        }
        self.others(others, rest, table)
    }

    /// Names and points of other boards, and where those are to be drawn.
    fn others(&mut self, others: &[OtherBoard], area: Rect, table: Vec2) -> Vec<Slot> {
        if others.is_empty() {
            return Vec::new();
        }
        let small = self.panels.small;
        let step = rows(small) * 1.5;
        let slots = slots(area, others.len(), table, step * 3.0, self.gap());
        for (slot, other) in slots.iter().zip(others) {
            let lines = [
                (other.name.clone(), tint(AMBER, 1.0)),
                (grouped(other.score), tint(IVORY, 1.0)),
                (other.state.clone(), tint(AMBER_DIM, 1.0)),
            ];
            for ((text, color), line) in lines.iter().zip(0_u8..) {
                self.line(slot.words, slot.words.y + step * f32::from(line), text, small, Align::Left, *color);
            }
        }
        slots
    }

    /// The table, how many watch, who waits: as many lines as there is height for.
    fn everybody(&self, hud: &Hud, height: f32) -> Vec<(String, Color)> {
        let step = rows(self.panels.small) * 1.6;
        let mut lines = vec![(hud.table.clone(), tint(IVORY, 0.8))];
        if hud.spectators > 0 {
            lines.push((format!("{} WATCHING", hud.spectators), tint(ICE, 0.75)));
        }
        if !hud.queue.is_empty() {
            lines.push(("NEXT IN LINE".to_owned(), tint(AMBER_DIM, 1.0)));
        }
        let heading = lines.len();
        let waiting = hud.queue.iter().zip(1..).map(|(name, place)| (format!("{place} {name}"), tint(AMBER, 1.0)));
        lines.extend(waiting);
        // The last line needs no space below it.
        let room = ((height + step - rows(self.panels.small)).max(0.0) / step) as usize;
        if room == 1 && lines.len() > 1 {
            let text = format!("{} WATCHING, {} IN LINE", hud.spectators, hud.waiting);
            return vec![(text, tint(ICE, 0.75))];
        }
        let all_are_named = hud.queue.len() == hud.waiting as usize;
        if (lines.len() > room || !all_are_named) && room > 0 && !hud.queue.is_empty() {
            // The last line says how many of those in line have no room.
            lines.truncate(room - 1);
            let names = lines.len().saturating_sub(heading);
            if names == 0 {
                lines.truncate(heading - 1);
            }
            let plus = if names == 0 { "" } else { "+ " };
            lines.push((format!("{plus}{} IN LINE", hud.waiting as usize - names), tint(AMBER_DIM, 1.0)));
        }
        lines
    }

    /// Keys at the left, what they do at the right; in two rows each if they are too long for one.
    fn keys(&mut self, hud: &Hud) {
        let area = self.panels.keys;
        let area = Rect::new(area.x + self.margin(), area.y, area.w - 2.0 * self.margin(), area.h);
        let count = hud.keys.len().max(1) as f32;
        // As large as other text, or as there is height for. A cast saturates.
        let small = self.fonts.fitting("", self.panels.small.min((area.h / count / f32::from(ROWS)) as u16), area.w);
        let gap = self.gap();
        let room = |key: &str| (area.w - measure(key, small).x - gap).max(0.0);
        let is_long = |(key, does): &(String, String)| measure(does, small).x > room(key);
        let two_rows = hud.keys.iter().any(is_long) && area.h / count >= rows(small) * 2.3;
        let step = (area.h / count).min(rows(small) * if two_rows { 2.75 } else { 1.6 });
        if step < rows(small) {
            return;
        }
        // What is done goes in one size for all: that of the longest.
        let fitting = |(key, does): &(String, String)| self.fonts.fitting(does, small, room(key));
        let pitch = if two_rows { Some(small) } else { hud.keys.iter().map(fitting).min() }.unwrap_or(small);
        let top = area.bottom() - step * count;
        for ((key, does), place) in hud.keys.iter().zip(0_u8..) {
            let y = top + step * f32::from(place);
            self.line(area, y, key, small, Align::Left, tint(IVORY, 1.0));
            let (room, y) =
                if two_rows { (area.w, y + rows(small) * 1.2) } else { (room(key), y + rows(small - pitch) / 2.0) };
            let rest = Rect::new(area.right() - room, area.y, room, area.h);
            self.line(rest, y, does, pitch, Align::Right, tint(AMBER, 0.8));
        }
    }

    /// A big line over the playfield on its plate, and a smaller one below it.
    pub(super) fn banner(&mut self, hud: &Hud, plate: Sprite, area: Rect) {
        if hud.banner.is_empty() && hud.sub_banner.is_empty() {
            return;
        }
        self.batch.stretch(plate, area, WHITE);
        let inner = Rect::new(area.x + area.w * 0.04, area.y, area.w * 0.92, area.h);
        let pitch = self.fonts.fitting(&hud.banner, self.panels.banner, inner.w);
        let below = self.fonts.fitting(&hud.sub_banner, (pitch / 2).max(self.panels.small), inner.w);
        let gap = rows(pitch) * 0.6;
        let used = if hud.sub_banner.is_empty() { rows(pitch) } else { rows(pitch) + gap + rows(below) };
        let y = area.y + (area.h - used) / 2.0;
        self.line(inner, y, &hud.banner, pitch, Align::Middle, tint(AMBER, 1.0));
        self.line(inner, y + rows(pitch) + gap, &hud.sub_banner, below, Align::Middle, tint(IVORY, 0.9));
    }

    /// A line between the edges of `area`, smaller than `wanted` if it would not fit, cut if it never would.
    pub(super) fn line(&mut self, area: Rect, y: f32, text: &str, wanted: u16, align: Align, color: Color) {
        let pitch = self.fonts.fitting(text, wanted, area.w);
        let mut text = text.to_owned();
        while !text.is_empty() && measure(&text, pitch).x > area.w {
            text.pop();
        }
        let spare = area.w - measure(&text, pitch).x;
        let x = match align {
            Align::Left => area.x,
            Align::Middle => area.x + spare / 2.0,
            Align::Right => area.x + spare,
        };
        // Text that had to shrink stands on the middle of its row.
        let y = y + ((rows(wanted) - rows(pitch)) / 2.0).max(0.0);
        self.fonts.line(self.batch, &text, vec2(x, y), pitch, color);
    }

    /// A row of the display: unlit dots from edge to edge, and a text in them, dot upon dot.
    pub(super) fn row(&mut self, area: Rect, y: f32, text: &str, wanted: u16, align: Align, color: Color) {
        let pitch = self.fonts.fitting(text, wanted, area.w);
        let cells = cells(area.w, pitch);
        let text: String = text.chars().take(usize::from(cells)).collect();
        let free = cells.saturating_sub(u16::try_from(text.chars().count()).unwrap_or(cells));
        // Flush with the right edge.
        let left = (area.right() - f32::from(cells * ADVANCE * pitch) + f32::from(pitch)).round();
        let y = y + ((rows(wanted) - rows(pitch)) / 2.0).max(0.0);
        // In the middle, half a glyph is three dots: the text stays on the grid.
        let dots = match align {
            Align::Left => 0.0,
            Align::Middle => {
                (f32::from(free * ADVANCE) / 2.0 - (left - area.x) / f32::from(2 * pitch)).max(0.0).round()
            }
            Align::Right => f32::from(free * ADVANCE),
        };
        self.fonts.unlit(self.batch, vec2(left, y), cells, area.x, pitch, tint(DOT_OFF, 1.0));
        self.fonts.line(self.batch, &text, vec2(left + dots * f32::from(pitch), y), pitch, color);
    }

    pub(super) fn gap(&self) -> f32 {
        f32::from(self.panels.small * 4)
    }

    /// Between the edge of a display (or what stands in line with displays) and its text.
    fn margin(&self) -> f32 {
        (self.panels.padding * 1.2).round()
    }

    fn inside(&self, display: Rect) -> Rect {
        let margin = self.margin().min(display.w / 2.0).min(display.h / 2.0);
        Rect::new(display.x + margin, display.y + margin, display.w - 2.0 * margin, display.h - 2.0 * margin)
    }
}

/// A text in two, at the space nearest to its middle.
fn halves(text: &str) -> Option<[&str; 2]> {
    let middle = text.len() / 2;
    let space = text.match_indices(' ').map(|(place, _)| place).min_by_key(|place| place.abs_diff(middle))?;
    Some([&text[..space], &text[space + 1..]])
}

/// Height of a line.
pub(super) fn rows(pitch: u16) -> f32 {
    f32::from(ROWS * pitch)
}

/// A seat's line: an arrow that blinks at whose turn it is, and a mark at the person who looks.
fn seat_name(seat: &SeatView, clock: f32) -> String {
    let arrow = if seat.active && (clock * 2.0).fract() < 0.7 { "> " } else { "  " };
    let you = if seat.you { " (YOU)" } else { "" };
    let wins = if seat.wins > 0 { format!(" - {} WON", seat.wins) } else { String::new() };
    format!("{arrow}{}{you}{wins}", seat.name)
}
