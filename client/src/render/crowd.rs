//! The crowd's part of the side panel: what it may do, what that costs, how it stands and who wants it. And the plate that warns
//! the player.

use macroquad::color::{Color, WHITE};
use macroquad::math::{Rect, Vec3, vec2};

use super::atlas::Sprite;
use super::dot_matrix::measure;
use super::hud::{Align, Writer, rows};
use super::layout::Layout;
use super::palette::{AMBER, AMBER_DIM, ICE, IVORY, RED, tint};
use super::panels::Panels;
use crate::view::{CrowdActionState, CrowdActionView, CrowdView, Hud};

/// Glyphs of the column of votes, and of the one that says how an action stands.
const VOTES: f32 = 5.0;
const STATE: f32 = 7.0;

/// Where the warning stands: at the lower end of the table, where the player looks and no ball is played any more.
pub(super) fn alarm_area(layout: &Layout, panels: &Panels) -> Rect {
    let field = layout.seen_playfield();
    let height = (rows(panels.small) * 1.5 + rows(panels.medium) * 1.5).max(field.h * 0.055).round();
    Rect::new((field.x + field.w * 0.03).round(), field.bottom() - height, (field.w * 0.85).round(), height)
}

impl Writer<'_> {
    /// What the crowd may do, line by line.
    pub(super) fn crowd(&mut self, crowd: &CrowdView, area: Rect) {
        let small = self.panels.small;
        let step = (rows(small) * 1.6).min(area.h / (crowd.actions.len() + 1) as f32);
        if step < rows(small) {
            return;
        }
        let heading = match crowd.closes_in {
            Some(seconds) => format!("VOTED IN {:.0} S", seconds.ceil()),
            None if crowd.can_vote => "VOTE BY NUMBER".to_owned(),
            None => "THE CROWD MAY".to_owned(),
        };
        let heading_color = if crowd.closes_in.is_some() { IVORY } else { AMBER_DIM };
        let columns = self.columns(area);
        self.line(columns[0], area.y, &heading, small, Align::Left, tint(heading_color, 1.0));
        self.line(columns[1], area.y, "VOTES", small, Align::Right, tint(AMBER_DIM, 1.0));
        self.line(columns[2], area.y, "COST", small, Align::Right, tint(AMBER_DIM, 1.0));
        for (action, number) in crowd.actions.iter().zip(1_u8..) {
            let y = area.y + step * f32::from(number);
            self.action(columns, y, number, action);
        }
    }

    /// Of an action: its name, its votes, how it stands.
    fn columns(&self, area: Rect) -> [Rect; 3] {
        let glyph = measure("00", self.panels.small).x - measure("0", self.panels.small).x;
        let (votes, state) = (glyph * VOTES, glyph * STATE);
        let name = (area.w - votes - state).max(0.0);
        let column = |x: f32, w: f32| Rect::new(x, area.y, w, area.h);
        [column(area.x, name), column(area.x + name, votes), column(area.x + name + votes, state)]
    }

    fn action(&mut self, [name, votes, state]: [Rect; 3], y: f32, number: u8, action: &CrowdActionView) {
        let small = self.panels.small;
        let (word, color) = match action.state {
            CrowdActionState::Ready => (action.cost.to_string(), tint(AMBER, 1.0)),
            CrowdActionState::TooDear => (action.cost.to_string(), tint(AMBER_DIM, 1.0)),
            CrowdActionState::Announced(seconds) => (format!("IN {:.0} S", seconds.ceil()), tint(IVORY, 1.0)),
            CrowdActionState::AtWork(seconds) => (format!("ON {:.0} S", seconds.ceil()), tint(RED_BRIGHT, 1.0)),
            CrowdActionState::CoolsDown(seconds) => (format!("{:.0} S", seconds.ceil()), tint(AMBER_DIM, 0.7)),
        };
        let mark = if action.yours { '>' } else { ' ' };
        let label = format!("{number}{mark}{}", action.name);
        let label_color = if action.yours { tint(ICE, 1.0) } else { color };
        self.line(name, y, &label, small, Align::Left, label_color);
        if action.votes > 0 {
            self.line(votes, y, &action.votes.to_string(), small, Align::Right, tint(ICE, 1.0));
        }
        self.line(state, y, &word, small, Align::Right, color);
    }

    /// What the crowd has to spend, as a bar of the display.
    pub(super) fn energy(&mut self, (energy, most): (u32, u32), area: Rect, y: f32, clock: f32) {
        let (small, medium) = (self.panels.small, self.panels.medium);
        let is_full = energy >= most;
        let blinks = is_full && (clock * 2.0).fract() > 0.7;
        let color = if blinks { tint(AMBER_DIM, 1.0) } else { tint(ICE, 0.9) };
        let label = format!("  ENERGY {energy} OF {most}");
        self.line(area, y, &label, small, Align::Left, tint(ICE, 0.75));
        let room = f32::from(super::dot_matrix::cells(area.w, medium));
        let share = f64::from(energy) / f64::from(most.max(1));
        // A cast saturates.
        let lit = (f64::from(room) * share) as usize;
        self.row(area, y + rows(small) + self.gap(), &"=".repeat(lit), medium, Align::Left, color);
    }

    /// The warning, if there is one.
    pub(super) fn alarm(&mut self, hud: &Hud, plate: Sprite, dot: Sprite, area: Rect, clock: f32) {
        let Some([when, what]) = &hud.alarm else { return };
        self.batch.stretch(plate, area, WHITE);
        let is_bright = (clock * 4.0).fract() < 0.6;
        let rim = (area.h * 0.07).max(2.0);
        let color: Color = tint(RED, if is_bright { 1.0 } else { 0.35 });
        for y in [area.y, area.bottom() - rim] {
            self.batch.stretch(dot, Rect::new(area.x, y, area.w, rim), color);
        }
        let inner = Rect::new(area.x + rim * 2.0, area.y, area.w - rim * 4.0, area.h);
        let (small, medium) = (self.panels.small, self.panels.medium);
        let gap = ((area.h - rows(small) - rows(medium)) / 3.0).max(0.0);
        let corner = vec2(inner.x, inner.y + gap);
        self.line(inner, corner.y, when, small, Align::Middle, tint(IVORY, 1.0));
        self.line(inner, corner.y + rows(small) + gap, what, medium, Align::Middle, tint(AMBER, 1.0));
    }
}

/// Red that can be read on black.
const RED_BRIGHT: Vec3 = Vec3::new(1.0, 0.42, 0.36);
