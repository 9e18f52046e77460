//! The moving picture over the static art: lights, targets, flippers, balls, points that float up. Drawn from the
//! [`View`] alone; nothing is remembered from frame to frame.

use macroquad::color::WHITE;
use macroquad::math::{Rect, Vec2, Vec3, vec2};
use shared::table::TableFile;
use shared::table::format::{ElementFile, FlipperFile, Hand, LineFile, PlungerFile, SlingshotFile, TargetFile};

use super::atlas::{Batch, Sprite};
use super::canvas::LIGHT;
use super::dot_matrix::{Fonts, measure};
use super::inserts::middle;
use super::layout::Layout;
use super::palette::{self, AMBER, ICE, IVORY, NIGHT, RED, RUBBER, STEEL, shine, tint};
use super::panels::Panels;
use super::ramps::floor_of;
use super::sprites::{Own, Pinned, Sprites};
use crate::view::{BallView, ElementView, Popup, View};

/// What the scene is drawn with.
pub(super) struct Stage<'a> {
    pub(super) layout: &'a Layout,
    pub(super) panels: &'a Panels,
    pub(super) table: &'a TableFile,
    pub(super) sprites: &'a Sprites<Sprite>,
    pub(super) fonts: &'a Fonts,
    pub(super) batch: &'a mut Batch,
}

/// A ball faster than this draws a streak, m/s.
const STREAK_SPEED: f32 = 0.7;
/// A streak is as long as the way of a ball in this time, seconds.
const STREAK_TIME: f32 = 0.040;

/// How much of the light is gone when somebody has dimmed it.
const DIMMED: f32 = 0.80;

/// How much larger a ball looks for each floor that it is nearer to the eye.
const NEARER: f32 = 1.08;
/// Floors above this one look no nearer.
const HIGHEST: u8 = 3;
/// How far a ball's shadow falls, in radii: of one on the board, and more for each floor above.
const SHADOW: (f64, f64) = (0.55, 1.1);

impl Stage<'_> {
    /// Draws everything on the table, from the board upwards; `draw_above` draws what stands still over the balls on it.
    pub(super) fn draw(&mut self, view: &View, draw_above: impl FnOnce()) {
        // 1. What is level with the board.
        for (index, (element, state)) in self.table.elements.iter().zip(&view.elements).enumerate() {
            match element {
                ElementFile::Light(light) if shows_lit(view, index, *state, light.center) => {
                    self.lit_insert(index, light.center, palette::light(light.color));
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
        if view.dimmed {
            self.batch.stretch(self.sprites.dot, self.layout.seen_playfield(), tint(Vec3::ZERO, DIMMED));
        }
        // 4. What floats above.
        self.slaps(view.slaps);
        for popup in &view.popups {
            self.popup(popup);
        }
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

    /// Light along the side of the table that a hand slaps: left, right, below.
    fn slaps(&mut self, [left, right, below]: [f32; 3]) {
        let field = self.layout.seen_playfield();
        let reach = field.w * 0.16;
        let tall = |x: f32| Rect::new(x - reach / 2.0, field.y + field.h * 0.45, reach, field.h * 0.5);
        let wide = Rect::new(field.x + field.w * 0.2, field.bottom() - reach / 2.0, field.w * 0.6, reach);
        for (area, strength) in [(tall(field.x), left), (tall(field.right()), right), (wide, below)] {
            if strength > 0.0 {
                self.batch.stretch(self.sprites.halo, area, shine(AMBER, 0.8 * strength));
            }
        }
    }

    fn lit_insert(&mut self, index: usize, center: (f64, f64), color: Vec3) {
        let Some(Own::Light(Pinned { sprite, pivot })) = self.sprites.own.get(index) else { return };
        let center = self.layout.written(center);
        let reach = sprite.size.max_element() * 2.3;
        self.glow(center, reach, color, 0.62);
        self.batch.turned(*sprite, *pivot, center, 0.0, WHITE);
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

    /// A standing target is a bright face with a dark back; a fallen one leaves a slot.
    fn drop_target(&mut self, target: &TargetFile, state: ElementView) {
        let (from, to) = (self.layout.written(target.from), self.layout.written(target.to));
        let width = self.layout.length(0.0060).max(3.0);
        let bar = self.sprites.bar;
        if state.down {
            self.batch.bar(bar, from, to, width * 0.8, tint(Vec3::ZERO, 0.85));
            self.batch.bar(bar, from, to, width * 0.25, tint(ICE * 0.35, 0.9));
        } else {
            let drop = -LIGHT * self.layout.length(0.0050);
            self.batch.bar(bar, from + drop, to + drop, width * 1.25, tint(Vec3::ZERO, 0.5));
            self.batch.bar(bar, from, to, width * 1.25, tint(NIGHT, 1.0));
            self.batch.bar(bar, from, to, width, tint(ICE.lerp(IVORY, 0.15 + 0.85 * state.flash), 1.0));
            let (a, b) = (from.lerp(to, 0.30), from.lerp(to, 0.70));
            self.batch.bar(bar, a, b, width * 0.55, tint(RED, 1.0));
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

    fn ball_shadow(&mut self, ball: BallView) {
        let height = self.table.ball.radius * (SHADOW.0 + SHADOW.1 * f64::from(ball.floor.min(HIGHEST)));
        let at = self.layout.point(ball.position) - LIGHT * self.layout.length(height);
        self.batch.scaled(self.sprites.ball_shadow, at, nearness(ball));
    }

    fn ball(&mut self, ball: BallView) {
        let at = self.layout.point(ball.position);
        let speed = ball.velocity.length();
        if speed > STREAK_SPEED {
            let way = ball.velocity * vec2(1.0, -1.0) * self.layout.scale;
            let width = self.layout.length(self.table.ball.radius * 2.0);
            let strength = ((speed - STREAK_SPEED) / 1.5).min(1.0) * 0.5;
            self.batch.bar(self.sprites.streak, at - way * STREAK_TIME, at, width, shine(ICE, strength));
        }
        self.batch.scaled(self.sprites.ball, at, nearness(ball));
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

    fn popup(&mut self, popup: &Popup) {
        let age = popup.age.clamp(0.0, 1.0);
        let pitch = self.panels.popup;
        let size = measure(&popup.text, pitch);
        let field = self.layout.seen_playfield();
        let rise = vec2(0.0, self.layout.length(0.026 + 0.05 * f64::from(age)));
        let mut corner = self.layout.point(popup.position) - rise - size / 2.0;
        corner.x = corner.x.clamp(field.x, (field.right() - size.x).max(field.x));
        let alpha = (1.6 * (1.0 - age)).min(1.0);
        let dark = vec2(f32::from(pitch) * 0.75, f32::from(pitch) * 0.75).ceil();
        self.fonts.line(self.batch, &popup.text, corner + dark, pitch, tint(Vec3::ZERO, alpha * 0.7));
        self.fonts.line(self.batch, &popup.text, corner, pitch, tint(AMBER.lerp(Vec3::ONE, 0.35), alpha));
    }
}

/// How large a ball looks beside one on the board.
fn nearness(ball: BallView) -> f32 {
    NEARER.powi(i32::from(ball.floor.min(HIGHEST)))
}

/// Whether an insert shines: as the rules say in a game, in waves that run up the table while nobody plays.
fn shows_lit(view: &View, index: usize, state: ElementView, center: (f64, f64)) -> bool {
    if view.hud.ball > 0 {
        return state.lit;
    }
    let wave = (view.clock * 2.6 - center.1 as f32 * 9.0 + (index % 3) as f32 * 0.4).sin();
    wave > 0.35
}
