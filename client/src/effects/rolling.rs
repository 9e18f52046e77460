//! How balls are turned: they roll as they go, and spin. The physics knows only the spin about the playfield's normal; that
//! a ball rolls is to be seen, and changes nothing.

use macroquad::math::{Quat, Vec2, Vec3};

use crate::moment::Motion;

/// No frame counts for more, seconds.
const LONGEST_FRAME: f64 = 0.1;
/// A ball that is farther from where it was seen last was put there, metres.
const JUMP: f32 = 0.5;

/// How each ball is turned.
#[derive(Debug, Default)]
pub(super) struct Rolling {
    /// Its id, where it was seen last, and how it was turned.
    balls: Vec<(u32, Vec2, Quat)>,
    seen: f64,
}

impl Rolling {
    /// Balls of a radius in metres are seen there at `now`.
    pub(super) fn see(&mut self, balls: &[Motion], radius: f32, now: f64) {
        let seconds = (now - self.seen).clamp(0.0, LONGEST_FRAME) as f32;
        self.seen = now;
        let seen = |ball: &Motion| {
            let place = ball.position.as_vec2();
            let Some((_, from, before)) = self.balls.iter().find(|(id, ..)| *id == ball.id) else {
                return (ball.id, place, Quat::IDENTITY);
            };
            let way = place - *from;
            // The top of a ball that rolls goes ahead of it: it turns about what is across its way.
            let roll = if way.length() < JUMP { Vec3::new(-way.y, way.x, 0.0) / radius } else { Vec3::ZERO };
            let turn = roll + Vec3::Z * ball.spin as f32 * seconds;
            let orientation = (Quat::from_scaled_axis(turn) * *before).normalize();
            (ball.id, place, if orientation.is_finite() { orientation } else { Quat::IDENTITY })
        };
        self.balls = balls.iter().map(seen).collect();
    }

    /// How a ball is turned since it came into play.
    pub(super) fn orientation_of(&self, ball: u32) -> Quat {
        self.balls.iter().find(|(id, ..)| *id == ball).map_or(Quat::IDENTITY, |(.., turned)| *turned)
    }
}

#[cfg(test)]
mod tests {
    use macroquad::math::{DVec2, dvec2};

    use super::*;

    fn ball(id: u32, position: DVec2, spin: f64) -> Motion {
        Motion { id, position, velocity: DVec2::ZERO, spin, floor: 0, is_held: false }
    }

    #[test]
    fn the_top_of_a_ball_goes_ahead_of_it() {
        let mut rolling = Rolling::default();
        for step in 0..=10 {
            rolling.see(&[ball(3, dvec2(0.1, 0.2 + 0.0005 * f64::from(step)), 0.0)], 0.01, f64::from(step) * 0.01);
        }
        // 5 mm up the table, half a radius.
        let top = rolling.orientation_of(3) * Vec3::Z;
        assert!((top - Vec3::new(0.0, 0.5_f32.sin(), 0.5_f32.cos())).length() < 1e-3, "{top}");
    }

    #[test]
    fn a_ball_spins_on_and_a_new_one_begins_anew() {
        let mut rolling = Rolling::default();
        rolling.see(&[ball(3, DVec2::ZERO, 9.0)], 0.01, 10.0);
        rolling.see(&[ball(3, DVec2::ZERO, 10.0)], 0.01, 10.05);
        let right = rolling.orientation_of(3) * Vec3::X;
        assert!((right - Vec3::new(0.5_f32.cos(), 0.5_f32.sin(), 0.0)).length() < 1e-3, "{right}");
        rolling.see(&[ball(4, DVec2::ZERO, 10.0)], 0.01, 10.1);
        assert_eq!((rolling.orientation_of(3), rolling.orientation_of(4)), (Quat::IDENTITY, Quat::IDENTITY));
    }

    #[test]
    fn a_ball_that_is_put_somewhere_else_does_not_roll_there() {
        let mut rolling = Rolling::default();
        rolling.see(&[ball(3, DVec2::ZERO, 0.0)], 0.01, 0.0);
        rolling.see(&[ball(3, dvec2(0.3, 0.9), 0.0)], 0.01, 0.01);
        assert_eq!(rolling.orientation_of(3), Quat::IDENTITY);
    }
}
