//! Balls: chrome that rolls, spins and throws a shadow, and the streak behind a fast one.

use macroquad::math::{Vec2, Vec3, vec2};

use super::canvas::{LIGHT, smooth};
use super::palette::{ICE, NIGHT, shine, tint};
use super::scene::Stage;
use crate::view::BallView;

/// A ball faster than this draws a streak, m/s.
const STREAK_SPEED: f32 = 0.7;
/// A streak is as long as the way of a ball in this time, seconds.
const STREAK_TIME: f32 = 0.040;

/// How much larger a ball looks for each floor that it is nearer to the eye.
const NEARER: f32 = 1.08;
/// Floors above this one look no nearer.
const HIGHEST: u8 = 3;
/// How far a ball's shadow falls, in radii: of one on the board, and more for each floor above.
const SHADOW: (f64, f64) = (0.55, 1.1);

/// How dark the spots on a ball are, how large, in its radii, and at what speed they blur away, m/s.
const MARK: f32 = 0.85;
const MARK_RADIUS: f32 = 0.46;
const MARKS_GONE: f32 = 1.6;
/// On a smaller ball there is no room for them, pixels.
const SMALLEST_MARKED: f32 = 5.0;
/// Where they are on a ball that is not turned: at both ends of three axes at right angles, so that three are seen.
const MARKS: [Vec3; 6] = [
    Vec3::new(0.60, 0.48, 0.64),
    Vec3::new(-0.60, -0.48, -0.64),
    Vec3::new(-0.80, 0.36, 0.48),
    Vec3::new(0.80, -0.36, -0.48),
    Vec3::new(0.0, -0.80, 0.60),
    Vec3::new(0.0, 0.80, -0.60),
];

impl Stage<'_> {
    pub(super) fn ball_shadow(&mut self, ball: BallView) {
        let height = self.table.ball.radius * (SHADOW.0 + SHADOW.1 * f64::from(ball.floor.min(HIGHEST)));
        let at = self.layout.point(ball.position) - LIGHT * self.layout.length(height);
        self.batch.scaled(self.sprites.ball_shadow, at, nearness(ball));
    }

    pub(super) fn ball(&mut self, ball: BallView) {
        let at = self.layout.point(ball.position);
        let speed = ball.velocity.length();
        if speed > STREAK_SPEED {
            let way = ball.velocity * vec2(1.0, -1.0) * self.layout.scale;
            let width = self.layout.length(self.table.ball.radius * 2.0);
            let strength = ((speed - STREAK_SPEED) / 1.5).min(1.0) * 0.5;
            self.batch.bar(self.sprites.streak, at - way * STREAK_TIME, at, width, shine(ICE, strength));
        }
        self.batch.scaled(self.sprites.ball, at, nearness(ball));
        self.marks(ball, at, speed);
    }

    /// Worn spots by which a ball is seen to roll and to spin; on a fast one the eye could not follow them.
    fn marks(&mut self, ball: BallView, at: Vec2, speed: f32) {
        let strength = MARK * smooth(MARKS_GONE, MARKS_GONE * 0.4, speed);
        let radius = self.layout.length(self.table.ball.radius) * nearness(ball);
        if strength <= 0.0 || radius < SMALLEST_MARKED {
            return;
        }
        for mark in MARKS {
            let place = ball.orientation * mark;
            if place.z <= 0.0 {
                continue;
            }
            // Seen at a slant towards the rim, and fading there.
            let away = vec2(place.x, -place.y) * radius;
            let along = away.normalize_or(Vec2::X) * radius * MARK_RADIUS * place.z.max(0.25);
            let color = tint(NIGHT * 1.5, strength * smooth(0.0, 0.35, place.z));
            self.batch.bar(self.sprites.halo, at + away - along, at + away + along, radius * MARK_RADIUS * 2.0, color);
        }
    }
}

/// How large a ball looks beside one on the board.
fn nearness(ball: BallView) -> f32 {
    NEARER.powi(i32::from(ball.floor.min(HIGHEST)))
}
