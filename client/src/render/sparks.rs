//! How sparks fly: the same for the same burst and age, whenever and wherever it is drawn. Pure arithmetic, in metres.

use macroquad::math::{Vec2, vec2};

use super::canvas::{noise, smooth};
use crate::view::Burst;

/// Sparks of the softest and of the hardest hit.
const COUNT: (f32, f32) = (5.0, 16.0);
/// Speed of the slowest spark of the softest hit and of the fastest one of the hardest, m/s.
const SPEED: (f32, f32) = (0.2, 1.3);
/// How fast they lose it, 1/s.
const DRAG: f32 = 5.0;
/// What draws them down the table, m/s^2.
const FALL: f32 = 0.5;
/// Seconds after which the first and the last are out.
const LIFE: (f32, f32) = (0.18, 0.5);
/// They fly to both sides of the burst's direction by up to so much, radians.
const SPREAD: f32 = 1.15;
/// A spark is seen as the way that it made in this time, seconds.
const TRAIL: f32 = 0.03;

/// A spark as it is seen.
#[derive(Debug, Clone, Copy, PartialEq)]
pub(super) struct Spark {
    /// Its tail.
    pub(super) from: Vec2,
    /// Its head.
    pub(super) to: Vec2,
    /// 1 when it is new, 0 when it is out.
    pub(super) glow: f32,
}

/// The sparks of a burst that are not out.
pub(super) fn sparks(burst: &Burst) -> impl Iterator<Item = Spark> + use<'_> {
    let strength = burst.strength.clamp(0.0, 1.0);
    let between = |(least, most): (f32, f32), share: f32| least + (most - least) * share;
    // A cast saturates.
    let count = between(COUNT, strength) as i32;
    (0..count).filter_map(move |place| {
        let chance = |of: i32| noise(burst.seed as i32, place * 8 + of);
        let life = between(LIFE, chance(0));
        if !(0.0..life).contains(&burst.age) {
            return None;
        }
        let turn = if burst.direction == Vec2::ZERO {
            chance(1) * std::f32::consts::TAU
        } else {
            burst.direction.to_angle() + (chance(1) - 0.5) * 2.0 * SPREAD
        };
        let speed = between(SPEED, strength * (0.35 + 0.65 * chance(2)));
        let at = |age: f32| {
            let way = speed * (1.0 - (-DRAG * age).exp()) / DRAG;
            burst.position + Vec2::from_angle(turn) * way - vec2(0.0, FALL * age * age / 2.0)
        };
        let glow = smooth(life, life * 0.3, burst.age);
        Some(Spark { from: at((burst.age - TRAIL).max(0.0)), to: at(burst.age), glow })
    })
}

#[cfg(test)]
mod tests {
    use super::*;

    fn burst(age: f32) -> Burst {
        let (position, direction) = (vec2(0.2, 0.5), vec2(0.0, 1.0));
        Burst { position, direction, strength: 0.8, age, seed: 7, ..Burst::default() }
    }

    #[test]
    fn the_same_burst_always_sparks_alike_and_another_one_otherwise() {
        let all = |burst: Burst| sparks(&burst).collect::<Vec<_>>();
        assert_eq!(all(burst(0.1)), all(burst(0.1)));
        assert_ne!(all(burst(0.1)), all(Burst { seed: 8, ..burst(0.1) }));
    }

    #[test]
    fn sparks_begin_where_the_hit_was_fly_away_from_it_and_go_out() {
        assert!(sparks(&burst(0.0)).all(|spark| spark.to == vec2(0.2, 0.5) && spark.glow == 1.0));
        let young: Vec<Spark> = sparks(&burst(0.1)).collect();
        assert_eq!(young.len(), 13);
        for spark in young {
            assert!(spark.to.y > 0.5 && spark.to.distance(vec2(0.2, 0.5)) < 0.13, "{spark:?}");
            assert!((spark.to - spark.from).y > 0.0 && (0.0..=1.0).contains(&spark.glow));
        }
        assert!(sparks(&burst(0.3)).count() < 13);
        assert_eq!(sparks(&burst(0.6)).count(), 0);
    }

    #[test]
    fn hard_hits_spark_more_and_without_a_direction_sparks_fly_everywhere() {
        let of = |strength| Burst { strength, direction: Vec2::ZERO, ..burst(0.05) };
        assert!(sparks(&of(1.0)).count() > sparks(&of(0.1)).count());
        let (left, right): (Vec<_>, Vec<_>) = sparks(&of(1.0)).partition(|spark| spark.to.x < 0.2);
        assert!(!left.is_empty() && !right.is_empty());
        assert_eq!(sparks(&of(f32::NAN)).count(), 0);
    }
}
