//! What flies and floats over the table for a moment: sparks, the light of a nudge, a cheer, points, the word of a tilt.

use macroquad::color::Color;
use macroquad::math::{Rect, Vec2, Vec3, vec2};

use super::canvas::{noise, smooth};
use super::dot_matrix::measure;
use super::palette::{AMBER, ICE, IVORY, RED, shine, tint};
use super::popups::apart;
use super::scene::Stage;
use super::sparks::sparks;
use crate::view::{Burst, BurstKind, Popup, View};

/// Seconds in which the light of a hit fades, and how large it is, metres.
const HIT: f32 = 0.12;
const HIT_SIZE: f64 = 0.075;
/// Width of a spark, metres.
const SPARK: f64 = 0.0046;

/// When the rockets of a cheer burst, seconds; where, as shares of what is seen; and how much slower and wider they fly
/// than sparks.
const ROCKETS: [(f32, f32, f32); 6] = [
    (0.0, 0.50, 0.35),
    (0.25, 0.25, 0.55),
    (0.45, 0.75, 0.50),
    (0.75, 0.35, 0.30),
    (0.95, 0.68, 0.62),
    (1.2, 0.5, 0.42),
];
const ROCKET_SLOWER: f32 = 0.42;
const ROCKET_WIDER: f32 = 1.7;
/// Seconds that the glow of a cheer lasts.
const CHEER: f32 = 2.2;
/// More points at once nobody can read; the newest are seen.
const MOST_POINTS: usize = 6;
/// Seconds for which the word of a tilt stands over the table.
const TILT: f32 = 2.2;

impl Stage<'_> {
    /// All of it, from the table upwards.
    pub(super) fn flashes(&mut self, view: &View) {
        self.slaps(view.slaps);
        for burst in &view.bursts {
            self.burst(burst, if view.reduced_flashing { 0.45 } else { 1.0 });
        }
        if let Some(seconds) = view.cheer.filter(|_| view.tilt.is_none()) {
            self.cheer(seconds, view.reduced_flashing);
        }
        self.popups(&view.popups);
        if let Some(seconds) = view.tilt.filter(|seconds| *seconds < TILT) {
            self.tilt_word(seconds);
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

    /// The light of a hit, and its sparks.
    fn burst(&mut self, burst: &Burst, strength: f32) {
        let color = match burst.kind {
            BurstKind::Solid => ICE.lerp(Vec3::ONE, 0.4),
            BurstKind::Kicker => AMBER.lerp(RED, 0.15),
            BurstKind::Target => ICE.lerp(AMBER, 0.5),
        };
        let fresh = 1.0 - burst.age / HIT;
        if fresh > 0.0 {
            let size = self.layout.length(HIT_SIZE) * (0.4 + 0.6 * burst.strength);
            self.glow(self.layout.point(burst.position), size, color, fresh * strength * (0.3 + 0.5 * burst.strength));
        }
        let width = self.layout.length(SPARK).max(2.0);
        for spark in sparks(burst) {
            let (from, to) = (self.layout.point(spark.from), self.layout.point(spark.to));
            let ahead = (to - from).normalize_or(Vec2::X) * width;
            let color = color.lerp(Vec3::ONE, 0.3 * spark.glow);
            self.batch.bar(self.sprites.streak, from - ahead, to + ahead, width, fire(color, spark.glow * strength));
        }
    }

    /// Something great: rockets burst over the table, and its sides glow. Where nothing may strobe they only glow.
    fn cheer(&mut self, seconds: f32, reduced_flashing: bool) {
        let field = self.layout.seen_playfield();
        let fade = smooth(CHEER, CHEER * 0.5, seconds);
        let pulse = if reduced_flashing {
            smooth(0.0, 0.7, seconds)
        } else {
            0.65 + 0.35 * (seconds * 4.0 * std::f32::consts::TAU).cos()
        };
        let reach = field.w * 0.3;
        for x in [field.x, field.right()] {
            let area = Rect::new(x - reach / 2.0, field.y - field.h * 0.1, reach, field.h * 1.2);
            self.batch.stretch(self.sprites.halo, area, shine(AMBER, 0.75 * fade * pulse));
        }
        if reduced_flashing {
            return;
        }
        let corner = self.layout.metres(vec2(field.x, field.bottom()));
        let size = field.size() / self.layout.scale;
        for (&(at, x, y), place) in ROCKETS.iter().zip(0_u32..) {
            let age = (seconds - at) * ROCKET_SLOWER;
            if age < 0.0 {
                continue;
            }
            let position = corner + size * vec2(x, 1.0 - y);
            let color = [AMBER, ICE, RED.lerp(IVORY, 0.3)][place as usize % 3];
            let center = self.layout.point(position);
            let width = self.layout.length(SPARK * 1.3).max(2.0);
            let burst = |seed| Burst { position, strength: 1.0, age, seed, ..Burst::default() };
            // Of two bursts, so that there are enough.
            let bursts = [burst(place), burst(place + 64)];
            for (spark, salt) in bursts.iter().flat_map(sparks).zip(0..) {
                let [from, to] =
                    [spark.from, spark.to].map(|end| self.layout.point(position + (end - position) * ROCKET_WIDER));
                let twinkle = 0.6 + 0.4 * noise(salt, (seconds * 20.0) as i32);
                let color = fire(color.lerp(Vec3::ONE, 0.25), spark.glow * twinkle);
                self.batch.bar(self.sprites.streak, from.lerp(center, 0.2), to, width, color);
            }
            let fresh = 1.0 - age / HIT;
            if fresh > 0.0 {
                self.glow(center, self.layout.length(0.16), color, fresh * 0.7);
            }
        }
    }

    /// Points float up from where they were made, none over another.
    fn popups(&mut self, popups: &[Popup]) {
        let popups = &popups[popups.len().saturating_sub(MOST_POINTS)..];
        let pitch = self.panels.popup;
        let field = self.layout.seen_playfield();
        let wanted = |popup: &Popup| {
            let size = measure(&popup.text, pitch);
            let rise = vec2(0.0, self.layout.length(0.026 + 0.05 * f64::from(popup.age.clamp(0.0, 1.0))));
            let corner = self.layout.point(popup.position) - rise - size / 2.0;
            Rect::new(corner.x, corner.y, size.x, size.y)
        };
        let wanted: Vec<Rect> = popups.iter().map(wanted).collect();
        let dark = vec2(f32::from(pitch) * 0.75, f32::from(pitch) * 0.75).ceil();
        for (popup, place) in popups.iter().zip(apart(&wanted, field, f32::from(2 * pitch))) {
            let Some(place) = place else { continue };
            let alpha = (1.6 * (1.0 - popup.age.clamp(0.0, 1.0))).min(1.0);
            let corner = place.point();
            self.fonts.line(self.batch, &popup.text, corner + dark, pitch, tint(Vec3::ZERO, alpha * 0.7));
            self.fonts.line(self.batch, &popup.text, corner, pitch, tint(AMBER.lerp(Vec3::ONE, 0.35), alpha));
        }
    }

    /// The word over the table: whoever plays must know at once why the buttons are dead.
    fn tilt_word(&mut self, seconds: f32) {
        const WORD: &str = "TILT";
        let field = self.layout.seen_playfield();
        let pitch = self.panels.banner;
        let size = measure(WORD, pitch);
        let corner = (field.center() - size / 2.0 - vec2(0.0, field.h * 0.12)).round();
        let alpha = smooth(TILT, TILT * 0.7, seconds);
        let margin = vec2(6.0, 4.0) * f32::from(pitch);
        let (from, whole) = (corner - margin, size + 2.0 * margin);
        let plate = Rect::new(from.x, from.y, whole.x, whole.y);
        self.batch.stretch(self.sprites.plate, plate, tint(Vec3::ONE, alpha));
        self.fonts.line(self.batch, WORD, corner, pitch, tint(RED.lerp(Vec3::ONE, 0.15), alpha));
    }
}

/// Tint of what is so bright that it both covers what lies below and lights it.
fn fire(color: Vec3, strength: f32) -> Color {
    Color { a: 0.55 * strength, ..shine(color, strength) }
}
