//! The moving picture over the static art: lights, targets, slingshots, plungers, flippers, bumpers. Drawn from the
//! [`View`] alone; nothing is remembered from frame to frame. Balls are in `balls`, what flies above in `flashes`.

use macroquad::color::WHITE;
use macroquad::math::{Rect, Vec2, Vec3, vec2};
use shared::table::TableFile;
use shared::table::format::{ElementFile, FlipperFile, Hand, LineFile, PlungerFile, SlingshotFile, TargetFile};

use super::atlas::{Batch, Sprite};
use super::canvas::LIGHT;
use super::dot_matrix::Fonts;
use super::inserts::{metres, middle};
use super::layout::Layout;
use super::lights::{self, Insert};
use super::palette::{self, AMBER, ICE, IVORY, NIGHT, RED, RUBBER, STEEL, shine, tint};
use super::panels::Panels;
use super::ramps::floor_of;
use super::sprites::{Own, Pinned, Sprites};
use crate::view::{ElementView, View};

/// What the scene is drawn with.
pub(super) struct Stage<'a> {
    pub(super) layout: &'a Layout,
    pub(super) panels: &'a Panels,
    pub(super) table: &'a TableFile,
    pub(super) sprites: &'a Sprites<Sprite>,
    pub(super) fonts: &'a Fonts,
    pub(super) batch: &'a mut Batch,
}

/// How much of the light is gone when somebody has dimmed it, and when the lamps are out.
const DIMMED: f32 = 0.80;
const OUT: f32 = 0.58;

/// Share of its flash in which a target falls.
const FALL: f32 = 0.45;

impl Stage<'_> {
    /// Draws everything on the table, from the board upwards; `draw_above` draws what stands still over the balls on it.
    pub(super) fn draw(&mut self, view: &View, draw_above: impl FnOnce()) {
        // 1. What is level with the board.
        for (index, (element, state)) in self.table.elements.iter().zip(&view.elements).enumerate() {
            match element {
                ElementFile::Light(light) => {
                    let insert = Insert { index, center: metres(light.center), table: metres(self.table.size) };
                    let brightness = lights::brightness(view, insert, *state);
                    self.lit_insert(index, light.center, palette::light(light.color), brightness);
                }
                ElementFile::Magnet(magnet) if state.lit => self.magnet(magnet, view.clock),
                ElementFile::Rollover(line) => self.rollover(line, state.flash),
                ElementFile::Saucer(saucer) if state.flash > 0.0 => {
                    self.glow(self.layout.written(saucer.center), self.layout.length(0.085), ICE, state.flash);
                }
                _ => {}
            }
        }
        for ball in view.balls.iter().filter(|ball| ball.held) {
            self.held_ball(*ball);
        }
        // 2. The board, its flippers and plungers, the balls on it.
        self.floor(view, false);
        // 3. The same above it, over the lanes there.
        self.batch.flush();
        draw_above();
        self.floor(view, true);
        let out = view.tilt.map_or(0.0, |seconds| OUT * lights::lamps_out(seconds, view.reduced_flashing));
        let dark = out.max(if view.dimmed { DIMMED } else { 0.0 });
        if dark > 0.0 {
            self.batch.stretch(self.sprites.dot, self.layout.seen_playfield(), tint(Vec3::ZERO, dark));
        }
        // 4. What flies and floats above.
        self.flashes(view);
    }

    /// What stands on the board, or above it, and the balls there.
    fn floor(&mut self, view: &View, above: bool) {
        let table = self.table;
        let states = || {
            let all = table.elements.iter().zip(&view.elements).enumerate();
            all.filter(move |(_, (element, _))| (floor_of(element) > 0) == above)
        };
        let balls = || view.balls.iter().filter(move |ball| !ball.held && (ball.floor > 0) == above);
        // 1. What stands lower than a ball's centre, and all shadows.
        let mut plungers = view.plungers.iter();
        for (_, (element, state)) in states() {
            match element {
                ElementFile::DropTarget(target) => self.drop_target(target, *state),
                ElementFile::Target(target) => self.target(target, *state),
                ElementFile::Slingshot(sling) => self.slingshot(sling, state.flash),
                ElementFile::Plunger(plunger) => self.plunger(plunger, plungers.next().copied().unwrap_or_default()),
                _ => {}
            }
        }
        let mut angles = view.flippers.iter().copied();
        let flippers: Vec<(usize, &FlipperFile, f32)> = states()
            .filter_map(|(index, (element, _))| match element {
                ElementFile::Flipper(flipper) => {
                    Some((index, flipper, angles.next().unwrap_or((flipper.rest as f32).to_radians())))
                }
                _ => None,
            })
            .collect();
        for (index, flipper, angle) in &flippers {
            self.flipper(*index, flipper, *angle, true);
        }
        for ball in balls() {
            self.ball_shadow(*ball);
        }
        // 2. Flippers, balls, what hangs over balls, caps.
        for (index, flipper, angle) in &flippers {
            self.flipper(*index, flipper, *angle, false);
        }
        for ball in balls() {
            self.ball(*ball);
        }
        for (index, (element, state)) in states() {
            match element {
                ElementFile::Bumper(bumper) => {
                    self.bumper(index, self.layout.written(bumper.center), state.flash);
                }
                ElementFile::Spinner(spinner) => self.spinner((spinner.from, spinner.to), spinner.lever, *state),
                ElementFile::Gate(gate) => self.gate((gate.from, gate.to), gate.lever, *state),
                _ => {}
            }
        }
    }

    fn lit_insert(&mut self, index: usize, center: (f64, f64), color: Vec3, brightness: f32) {
        if brightness <= 0.0 {
            return;
        }
        let Some(Own::Light(Pinned { sprite, pivot })) = self.sprites.own.get(index) else { return };
        let center = self.layout.written(center);
        let reach = sprite.size.max_element() * 2.3;
        self.glow(center, reach, color, 0.62 * brightness);
        self.batch.turned(*sprite, *pivot, center, 0.0, tint(Vec3::ONE, brightness));
    }

    /// Round light of a diameter.
    pub(super) fn glow(&mut self, center: Vec2, diameter: f32, color: Vec3, strength: f32) {
        let area = Rect::new(center.x - diameter / 2.0, center.y - diameter / 2.0, diameter, diameter);
        self.batch.stretch(self.sprites.halo, area, shine(color, strength));
    }

    fn rollover(&mut self, line: &LineFile, flash: f32) {
        if flash > 0.0 {
            let center = self.layout.written(middle(line.from, line.to));
            self.glow(center, self.layout.length(0.07), ICE, flash);
        }
    }

    /// A standing target is a bright face with a dark back; one that falls sinks into its slot and leaves it dark.
    fn drop_target(&mut self, target: &TargetFile, state: ElementView) {
        let (from, to) = (self.layout.written(target.from), self.layout.written(target.to));
        let width = self.layout.length(0.0060).max(3.0);
        let bar = self.sprites.bar;
        let sunk = if state.down { ((1.0 - state.flash) / FALL).clamp(0.0, 1.0) } else { 0.0 };
        if sunk > 0.0 {
            self.batch.bar(bar, from, to, width * 0.8, tint(Vec3::ZERO, 0.85));
            self.batch.bar(bar, from, to, width * 0.25, tint(ICE * 0.35, 0.9));
        }
        if sunk < 1.0 {
            let up = 1.0 - sunk;
            let drop = -LIGHT * self.layout.length(0.0050) * up;
            let width = width * (0.35 + 0.65 * up);
            self.batch.bar(bar, from + drop, to + drop, width * 1.25, tint(Vec3::ZERO, 0.5 * up));
            self.batch.bar(bar, from, to, width * 1.25, tint(NIGHT, 1.0));
            let face = ICE.lerp(IVORY, 0.15 + 0.85 * state.flash) * (0.4 + 0.6 * up);
            self.batch.bar(bar, from, to, width, tint(face, 1.0));
            let (a, b) = (from.lerp(to, 0.30), from.lerp(to, 0.70));
            self.batch.bar(bar, a, b, width * 0.55, tint(RED * (0.4 + 0.6 * up), 1.0));
        }
        if state.flash > 0.0 {
            let size = self.layout.length(0.075);
            self.glow((from + to) / 2.0, size, ICE, state.flash * 0.9);
        }
    }

    /// The rubber of a slingshot: straight at rest, thrown outwards and swinging back after a kick.
    fn slingshot(&mut self, sling: &SlingshotFile, flash: f32) {
        let (from, to) = (self.layout.written(sling.from), self.layout.written(sling.to));
        // A ball comes from the left of the way from the first end to the second, which is where the rubber goes.
        let away = self.outward(sling, from, to);
        let swing = flash * flash * (1.0 - 0.5 * (1.0 - flash) * (flash * 40.0).cos());
        let bulge = (from + to) / 2.0 + away * swing * self.layout.length(0.016);
        let width = self.layout.length(0.0066).max(3.0);
        if flash > 0.0 {
            let size = from.distance(to) * 1.3;
            self.glow((from + to) / 2.0 - away * size * 0.12, size, RED.lerp(AMBER, 0.4), flash);
        }
        const STEPS: u8 = 8;
        let control = bulge * 2.0 - (from + to) / 2.0;
        let point = |step: u8| {
            let t = f32::from(step) / f32::from(STEPS);
            from.lerp(control, t).lerp(control.lerp(to, t), t)
        };
        let color = RUBBER.lerp(Vec3::ONE, flash);
        let pieces: &[(u8, u8)] =
            if flash > 0.0 { &[(0, 1), (1, 2), (2, 3), (3, 4), (4, 5), (5, 6), (6, 7), (7, 8)] } else { &[(0, STEPS)] };
        for (first, second) in pieces {
            // A little longer than the way, so that no gap opens at the bends.
            let (a, b) = (point(*first), point(*second));
            let more = (b - a).normalize_or_zero() * width * 0.2;
            self.batch.bar(self.sprites.rod, a - more, b + more, width, tint(color, 1.0));
        }
    }

    /// Away from the middle of the body that the slingshot closes: towards the open table.
    fn outward(&self, sling: &SlingshotFile, from: Vec2, to: Vec2) -> Vec2 {
        let side = (to - from).perp().normalize_or_zero();
        let ends = [sling.from, sling.to];
        let body = self.table.elements.iter().find_map(|element| match element {
            ElementFile::Wall(wall) => match wall.points.as_slice() {
                [first, inner, .., last] if ends.contains(first) && ends.contains(last) => Some(*inner),
                _ => None,
            },
            _ => None,
        });
        match body {
            Some(inner) if side.dot(self.layout.written(inner) - from) > 0.0 => -side,
            _ => side,
        }
    }

    fn plunger(&mut self, plunger: &PlungerFile, pulled: f32) {
        let down = vec2(0.0, pulled * self.layout.scale);
        let (from, to) = (self.layout.written(plunger.from) + down, self.layout.written(plunger.to) + down);
        let center = (from + to) / 2.0;
        let bottom = vec2(center.x, self.layout.playfield().bottom());
        let head = self.layout.length(0.009);
        // Rod, then the spring as rings that close up when it is pressed, then the head.
        self.batch.bar(self.sprites.rod, bottom, center, self.layout.length(0.007), tint(STEEL * 0.8, 1.0));
        const RINGS: u8 = 9;
        for ring in 1..RINGS {
            let y = center.y + head + (bottom.y - center.y - head) * f32::from(ring) / f32::from(RINGS);
            let side = (to.x - from.x) * 0.27;
            let tilt = self.layout.length(0.0015);
            let (left, right) = (vec2(center.x - side, y + tilt), vec2(center.x + side, y - tilt));
            self.batch.bar(self.sprites.rod, left, right, self.layout.length(0.0032).max(2.0), tint(STEEL, 1.0));
        }
        let half = vec2(0.0, head / 2.0);
        let inward = vec2((to.x - from.x) * 0.12, 0.0);
        self.batch.bar(self.sprites.rod, from + half + inward, to + half - inward, head, tint(RED, 1.0));
    }

    fn flipper(&mut self, index: usize, flipper: &FlipperFile, angle: f32, shadow: bool) {
        let Some(Own::Flipper { body, shadow: below }) = self.sprites.own.get(index) else { return };
        // The sprite points right; the angle is counted from straight up towards the flipper's own side.
        let turn = match flipper.hand {
            Hand::Left => angle - std::f32::consts::FRAC_PI_2,
            Hand::Right => -angle - std::f32::consts::FRAC_PI_2,
        };
        let pivot = self.layout.written(flipper.pivot);
        if shadow {
            let at = pivot - LIGHT * self.layout.length(0.006);
            self.batch.turned(below.sprite, below.pivot, at, turn, WHITE);
        } else {
            self.batch.turned(body.sprite, body.pivot, pivot, turn, WHITE);
        }
    }

    fn bumper(&mut self, index: usize, center: Vec2, flash: f32) {
        let Some(Own::Bumper { cap, flare }) = self.sprites.own.get(index) else { return };
        if flash > 0.0 {
            self.batch.place(*flare, center, shine(Vec3::ONE, flash));
        }
        // The cap is pulled down by a kick: it looks smaller, then comes back.
        let size = cap.size * (1.0 - 0.12 * flash);
        let corner = center - size / 2.0;
        self.batch.stretch(*cap, Rect::new(corner.x, corner.y, size.x, size.y), WHITE);
        if flash > 0.0 {
            self.glow(center, cap.size.x * 1.5, AMBER, flash * 0.55);
        }
    }
}
