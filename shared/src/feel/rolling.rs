//! Rolling: down a slope, along the inside of an arc, over a crest. Gravity is that of the table, along its plane; a solid
//! sphere that rolls along something that stands on the table has 5/7 of the pull along it.

use std::sync::Arc;

use glam::DVec2;

use super::stage::{Drill, Start, bare};
use super::{Family, Figure};
use crate::math::{direction, tangent};
use crate::physics::ball::{Instant, Support};
use crate::physics::constants::ROLLING_SHARE;
use crate::physics::scene::{Material, Scene};

pub(super) const SLOPE: Family = Family {
    name: "slope",
    drill: "A ball lets itself roll, or slide, down a straight slope of 30 degrees, and one is sent up it first. Off the closed form s = v t + a t^2 / 2, \
        a = g sin (slope), times 5/7 where there is friction, at every tick of 1.5 s. One that is thrown along the slope without spin, \
        at 0.2 m/s, slips for v / (7/2 mu g cos (slope) - g sin (slope)), to 2 %.",
    measure: slope,
};

pub(super) const ARC: Family = Family {
    name: "arc",
    drill: "A ball rolls from rest down the inside of an arc of 1 m, through its lowest point and off its end. Exit speed by energy: \
        v^2 = 2 (5/7) g h. Place after 1 s against an integration of the pendulum's angle, (R - r) a'' = -(5/7) g sin a (Runge-Kutta, 50 us); \
        halving the tick at least halves that error.",
    measure: arc,
};

pub(super) const CREST: Family = Family {
    name: "crest",
    drill: "A ball comes to the top of a post of 0.5 m at v, 0.05 to 0.2 m/s in 64 steps, and leaves it where it is pressed no more: where the cosine of the angle \
        from the top is (10 + 7 v^2 / g (R + r)) / 17 for one that rolls and (2 + v^2 / g (R + r)) / 3 without friction. Mean error of the 64; halving the tick \
        halves it, to 5 %: where a ball leaves is known to the tick.",
    measure: crest,
};

/// Of Classic, m/s^2.
const GRAVITY: f64 = 0.793;
/// Rubber that never slips, and one without friction; a drop is not part of these drills.
const GRIPS: Material = Material { restitution: 0.3, falloff: 0.0, friction: 1e6, tangential: 1.0 };
const SLICK: Material = Material { friction: 0.0, ..GRIPS };

fn scene(element: &str, material: Material, tick_hz: u32) -> Arc<Scene> {
    bare(DVec2::new(0.0, -GRAVITY), element, material, tick_hz)
}

/// A slope down to the right, its middle, and its normal.
fn slope_at(material: Material) -> (Arc<Scene>, DVec2, DVec2) {
    let scene = scene(
        "Wall(name: \"slope\", material: \"surface\", points: [(0.2, 3.0), (3.6641016151377544, 1.0)]),",
        material,
        1000,
    );
    let middle = DVec2::new(0.5 * (0.2 + 3.664_101_615_137_754_4), 2.0);
    (scene, middle, DVec2::new(0.5, 0.75_f64.sqrt()))
}

/// The farthest that the ball is from its closed form within 1.5 s, m: from a place, at a speed down the slope.
fn off_slope(material: Material, speed: f64) -> f64 {
    let (scene, middle, normal) = slope_at(material);
    let along = tangent(normal);
    let from = middle + normal * scene.radius(0);
    let share = if material.friction > 0.0 { ROLLING_SHARE } else { 1.0 };
    let start = Start::rolling(&scene, from, normal, speed);
    let mut drill = Drill::with_ball(&scene, start, &[]);
    let mut worst = 0.0;
    for tick in 1..=1500_u32 {
        drill.step();
        let t = f64::from(tick) * 1e-3;
        let expected = from + along * ((speed + 0.5 * share * scene.gravity.dot(along) * t) * t);
        let off = drill.ball().map_or(f64::INFINITY, |(position, _)| (position - expected).length());
        worst = if off > worst { off } else { worst };
    }
    worst
}

/// Seconds for which a ball that is thrown down the slope at `speed` without spin slips, and the closed form of them.
fn slips(speed: f64) -> (f64, f64) {
    let material = Material { friction: 0.3, ..GRIPS };
    let (scene, middle, normal) = slope_at(material);
    let along = tangent(normal);
    let radius = scene.radius(0);
    let start = Start { position: middle + normal * radius, velocity: along * speed, spin: 0.0 };
    let mut drill = Drill::with_ball(&scene, start, &[]);
    let (press, pull) = (-scene.gravity.dot(normal), scene.gravity.dot(along));
    // Friction brakes the centre by mu press and turns the rim by 5/2 of that: the slip falls by 7/2 mu press - pull.
    let expected = speed / (3.5 * material.friction * press - pull);
    // While it slips the centre has lost no more than friction takes: rolling begins where v is 5/7 of what it would be.
    for _ in 0..5000 {
        drill.step();
        let t = drill.world.state().tick as f64 * 1e-3;
        let (_, velocity) = drill.ball().unwrap_or_default();
        // Of a ball that rolls, whatever the way there (its angular momentum about the surface is that of the pull alone).
        let rolling = ROLLING_SHARE * (speed + pull * t);
        if velocity.dot(along) <= rolling * (1.0 + 1e-6) {
            return (t, expected);
        }
    }
    (f64::NAN, expected)
}

fn slope() -> Vec<Figure> {
    let mut figures = Vec::new();
    for (material, name) in [(GRIPS, "rolls"), (SLICK, "slides")] {
        for (speed, way) in [(0.0, "from rest"), (-0.3, "up and down")] {
            figures.push(Figure::at_most(format!("{name}, {way}: off by"), off_slope(material, speed), "m", 1e-9));
        }
    }
    let (measured, expected) = slips(0.2);
    figures.push(Figure::between("thrown: slips for", measured, "s", 0.98 * expected, 1.02 * expected));
    figures
}

/// Of the arc's circle.
const ARC_CENTER: DVec2 = DVec2::new(2.0, 2.0);
/// Where the ball starts and where the arc ends, degrees from the lowest point.
const STARTS: f64 = 60.0;
const ENDS: f64 = 30.0;

fn in_arc(tick_hz: u32) -> Drill {
    let element = "Arc(name: \"arc\", material: \"surface\", center: (2.0, 2.0), radius: 1.0, from: 100.0, to: 210.0),";
    let scene = scene(element, GRIPS, tick_hz);
    let reach = 1.0 - scene.radius(0);
    let position = ARC_CENTER + direction(crate::math::radians(180.0 - STARTS)) * reach;
    Drill::with_ball(&scene, Start { position, velocity: DVec2::ZERO, spin: 0.0 }, &[])
}

/// Share by which the speed at the arc's end is off.
fn off_at_exit(tick_hz: u32) -> f64 {
    let mut drill = in_arc(tick_hz);
    let reach = 1.0 - drill.world.scene().radius(0);
    let height = |degrees: f64| -reach * libm::cos(crate::math::radians(degrees));
    let expected = 2.0 * ROLLING_SHARE * GRAVITY * (height(STARTS) - height(ENDS));
    for _ in 0..4 * tick_hz {
        drill.step();
        let Some(ball) = drill.world.state().balls.first() else { break };
        if ball.support == Support::None && ball.flight.velocity.x < -0.1 {
            // Free from there on: what it has lost since by height is the whole of it.
            let risen = ball.flight.position.y - (ARC_CENTER.y + height(ENDS));
            let square = ball.flight.velocity.length_squared() + 2.0 * GRAVITY * risen;
            return (square / expected).sqrt() - 1.0;
        }
    }
    f64::NAN
}

/// Angle from the lowest point after `t` seconds, radians (Runge and Kutta's fourth order).
fn pendulum(reach: f64, t: f64) -> f64 {
    let steps = (t / 5e-5).round();
    let (h, pull) = (t / steps, -ROLLING_SHARE * GRAVITY / reach);
    let rate = |(angle, speed): (f64, f64)| (speed, pull * libm::sin(angle));
    let plus = |(a, b): (f64, f64), (c, d): (f64, f64), h: f64| (a + c * h, b + d * h);
    let mut now = (crate::math::radians(STARTS), 0.0);
    // A cast saturates.
    for _ in 0..steps as u64 {
        let a = rate(now);
        let b = rate(plus(now, a, 0.5 * h));
        let c = rate(plus(now, b, 0.5 * h));
        let d = rate(plus(now, c, h));
        let mean = ((a.0 + 2.0 * (b.0 + c.0) + d.0) / 6.0, (a.1 + 2.0 * (b.1 + c.1) + d.1) / 6.0);
        now = plus(now, mean, h);
    }
    now.0
}

/// How far the ball is off its place in the arc after 1 s, m.
fn off_in_arc(tick_hz: u32) -> f64 {
    let mut drill = in_arc(tick_hz);
    drill.run_until(u64::from(tick_hz));
    let reach = 1.0 - drill.world.scene().radius(0);
    let expected = ARC_CENTER + direction(core::f64::consts::PI - pendulum(reach, 1.0)) * reach;
    drill.ball().map_or(f64::INFINITY, |(position, _)| (position - expected).length())
}

fn arc() -> Vec<Figure> {
    let [coarse, fine] = [1000, 2000].map(off_in_arc);
    vec![
        Figure::at_most("exit speed off by", 100.0 * off_at_exit(1000).abs(), "%", 1.0),
        Figure::at_most("place after 1 s off by", coarse, "m", 1e-3),
        Figure::at_least("error with the tick over error with half of it", coarse / fine, "", 2.0),
    ]
}

/// Mean distance of the cosine of the angle at which balls leave a post from the closed form.
fn off_at_crest(material: Material, tick_hz: u32) -> f64 {
    let element = "Post(name: \"post\", material: \"surface\", center: (2.0, 1.5), radius: 0.5),";
    let scene = scene(element, material, tick_hz);
    let (center, reach) = (DVec2::new(2.0, 1.5), 0.5 + scene.radius(0));
    let speeds = (1..=64).map(|k| 0.05 + 0.0025 * f64::from(k));
    let off = speeds.map(|speed| {
        let start = Start::rolling(&scene, center + DVec2::Y * reach, DVec2::Y, speed);
        let mut drill = Drill::with_ball(&scene, start, &[]);
        let kick = speed * speed / (GRAVITY * reach);
        let expected = if material.friction > 0.0 { (10.0 + 7.0 * kick) / 17.0 } else { (2.0 + kick) / 3.0 };
        for _ in 0..10 * tick_hz {
            drill.step();
            let Some(ball) = drill.world.state().balls.first() else { break };
            if ball.support == Support::None && ball.flight.start != Instant::start_of(0) {
                let cosine = (ball.flight.position.y - center.y) / (ball.flight.position - center).length();
                return (cosine - expected).abs();
            }
        }
        f64::INFINITY
    });
    off.sum::<f64>() / 64.0
}

fn crest() -> Vec<Figure> {
    let mut figures = Vec::new();
    for (material, name) in [(GRIPS, "rolls"), (SLICK, "slides")] {
        let [coarse, fine] = [1000, 2000].map(|tick_hz| off_at_crest(material, tick_hz));
        figures.push(Figure::at_most(format!("{name}: cosine off by"), coarse, "", 0.01));
        figures.push(Figure::at_least(
            format!("{name}: error with the tick over error with half of it"),
            coarse / fine,
            "",
            1.9,
        ));
    }
    figures
}
