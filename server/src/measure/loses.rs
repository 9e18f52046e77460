//! Where exact loses: scenes in which so much happens that it costs more than sweeping along the chord of a tick.

use core::fmt::Write;
use std::time::{Duration, Instant as Clock};

use glam::DVec2;
use serde_json::{Value, json};
use shared::math::Rng;
use shared::physics::World;
use shared::physics::motion::Motion;
use shared::physics::scene::Scene;
use shared::table::Table;

use super::contender::{Contender, Setting};
use super::outcome::Spread;

/// One comparison.
#[derive(Debug, Clone, PartialEq)]
pub struct Comparison {
    /// What was varied.
    pub axis: &'static str,
    /// To what.
    pub value: String,
    /// Nanoseconds for a simulated second.
    pub exact: f64,
    /// Of the swept model.
    pub swept: f64,
}

impl Comparison {
    /// Exact's cost over swept's.
    pub fn ratio(&self) -> f64 {
        self.exact / self.swept
    }
}

/// Compares the two along every axis.
///
/// # Errors
/// If a scene of these cannot be read: a bug.
pub fn compare(rounds: usize, patience: Duration, say: &mut dyn FnMut(&str)) -> Result<Vec<Comparison>, String> {
    let mut told = Vec::new();
    let mut add = |axis, value: String, text: &str, hz: u32, seconds: f64| {
        say(&format!("where exact loses: {axis} {value}"));
        let table = Table::parse("scene", text).map_err(|error| error.to_string())?;
        if let Some((exact, swept)) = cost(&table.scene, hz, seconds, rounds, patience) {
            told.push(Comparison { axis, value, exact, swept });
        }
        Ok::<(), String>(())
    };
    for count in [1, 3, 10, 30, 100, 200, 300] {
        add("balls in a box", count.to_string(), &balls(count), 1000, (2.0 / f64::from(count)).max(0.1))?;
    }
    for degrees in [90, 30, 10, 3] {
        add("a ball in a V of degrees", degrees.to_string(), &wedge(f64::from(degrees)), 1000, 2.0)?;
    }
    for count in [1, 3, 6] {
        add("balls in a pile at rest", count.to_string(), &pile(count), 1000, 0.3)?;
    }
    for hz in [10, 100, 1000, 10_000, 100_000] {
        add(
            "one ball in a box, ticks a second",
            hz.to_string(),
            &balls(1),
            hz,
            (200.0 / f64::from(hz)).clamp(2.0, 20.0),
        )?;
    }
    Ok(told)
}

/// Medians of both, timed in turns; `None` if either takes too long. The search for every ball's first impact is part of it.
fn cost(scene: &Scene, hz: u32, seconds: f64, rounds: usize, patience: Duration) -> Option<(f64, f64)> {
    let (mut exact, mut swept) = (Vec::new(), Vec::new());
    for _ in 0..rounds {
        for (motion, costs) in [(Motion::Exact, &mut exact), (Motion::Swept, &mut swept)] {
            let timed = Setting { motion, tick_hz: hz, pixel: None }.time(scene, seconds, patience).ok()?;
            costs.push(timed.nanoseconds / timed.seconds);
        }
    }
    Some((Spread::median(exact)?, Spread::median(swept)?))
}

/// Seconds of play with flippers.
const PLAYED: f64 = 20.0;
/// Seconds between a press and the release, and the next press.
const PRESSED: f64 = 0.1;

/// A ball among the table's flippers, at rest and beating all the time.
pub fn flippers(table: &Table, rounds: usize, say: &mut dyn FnMut(&str)) -> Vec<Comparison> {
    let mut told = Vec::new();
    for beating in [false, true] {
        let value = if beating { "beating" } else { "at rest" };
        say(&format!("where exact loses: flippers {value}"));
        let mut costs = [Vec::new(), Vec::new()];
        for _ in 0..rounds {
            for (motion, costs) in [Motion::Exact, Motion::Swept].into_iter().zip(&mut costs) {
                costs.push(play(table, motion, beating));
            }
        }
        let [exact, swept] = costs.map(|costs| Spread::median(costs).unwrap_or(f64::NAN));
        told.push(Comparison { axis: "flippers of the table", value: value.to_owned(), exact, swept });
    }
    told
}

/// Nanoseconds for a simulated second: a ball that is dropped from the middle whenever none is there.
fn play(table: &Table, motion: Motion, beating: bool) -> f64 {
    let setting = Setting { motion, tick_hz: (1.0 / table.scene.tick_seconds).round() as u32, pixel: None };
    let mut world = World::new(setting.scene(&table.scene));
    let (ticks, beat) = ((PLAYED / table.scene.tick_seconds) as u64, (PRESSED / table.scene.tick_seconds) as u64);
    let middle = 0.5 * (table.scene.bounds.low + table.scene.bounds.high);
    let begun = Clock::now();
    for tick in 0..ticks {
        if world.state().balls.is_empty() {
            world.launch(0, middle, DVec2::new(0.3, 0.5));
        }
        if beating && tick % beat.max(1) == 0 {
            let pressed = (tick / beat.max(1)) % 2 == 0;
            world.press(false, pressed);
            world.press(true, pressed);
        }
        std::hint::black_box(world.step());
    }
    begun.elapsed().as_secs_f64() * 1e9 / PLAYED
}

/// Balls on a grid of a playfield's box, each on its way.
fn balls(count: u32) -> String {
    let (mut rng, mut text) = (Rng::new(u64::from(count)), String::new());
    let columns = f64::from(count).sqrt().ceil() as u32;
    let spacing = 1.0 / f64::from(columns);
    for i in 0..count {
        let x = (f64::from(i % columns) + 0.5) * spacing;
        let y = (f64::from(i / columns) + 0.5) * spacing;
        let (vx, vy) = (rng.between(-2.0, 2.0), rng.between(-2.0, 2.0));
        let _ = writeln!(text, "(position: ({x:?}, {y:?}), velocity: ({vx:?}, {vy:?})),");
    }
    format!(
        "Scene(gravity: (0.0, -1.1), balls: [{text}], elements: [
            Wall(points: [(0.0, 0.0), (1.0, 0.0), (1.0, 1.0), (0.0, 1.0), (0.0, 0.0)])])"
    )
}

/// A V of that angle, in which a ball comes to rest.
fn wedge(degrees: f64) -> String {
    let half = 0.5 * degrees * core::f64::consts::PI / 180.0;
    let (sine, cosine) = (libm::sin(half), libm::cos(half));
    let (x, y) = (sine / cosine, 1.0);
    let start = 0.5 + 0.0135 / sine;
    format!(
        "Scene(gravity: (0.0, -1.1), bounds: (-9.0, -9.0, 9.0, 9.0), balls: [(position: (0.0, {start:?}))], elements: [
            Wall(points: [({:?}, {y:?}), (0.0, 0.0), ({x:?}, {y:?})], restitution: 0.5)])",
        -x
    )
}

/// Balls stacked in a column that is closed around them.
fn pile(count: u32) -> String {
    let mut text = String::new();
    for i in 0..count {
        // Alternating sides of a column one and a half balls wide.
        let x = if i % 2 == 0 { 0.0136 } else { 0.0269 };
        let y = 0.014 + 0.0245 * f64::from(i);
        let _ = writeln!(text, "(position: ({x:?}, {y:?})),");
    }
    format!(
        "Scene(gravity: (0.0, -1.1), ball_restitution: 0.2, balls: [{text}], elements: [
            Wall(points: [(0.0, 0.5), (0.0, 0.0), (0.0405, 0.0), (0.0405, 0.5)], restitution: 0.2)])"
    )
}

/// The table of them, and a sentence for each axis.
pub fn text(told: &[Comparison]) -> String {
    let mut out = String::from(
        "Where exact loses (swept at the same rate for comparison):\n\n\
         | scene | | exact, ns for a simulated second | swept | ratio |\n|---|---|---|---|---|\n",
    );
    for one in told {
        let (exact, swept, ratio) = (one.exact, one.swept, one.ratio());
        let _ = writeln!(out, "| {} | {} | {exact:.0} | {swept:.0} | {ratio:.3} |", one.axis, one.value);
    }
    out.push('\n');
    let mut axes: Vec<&str> = told.iter().map(|one| one.axis).collect();
    axes.dedup();
    for axis in axes {
        let lost: Vec<&str> =
            told.iter().filter(|one| one.axis == axis && one.ratio() > 1.0).map(|one| one.value.as_str()).collect();
        let _ = match lost.as_slice() {
            [] => writeln!(out, "- {axis}: exact wins at each."),
            lost => writeln!(out, "- {axis}: exact loses at {}.", lost.join(", ")),
        };
    }
    out
}

/// The same as JSON.
pub fn json(told: &[Comparison]) -> Value {
    told.iter()
        .map(|one| json!({ "scene": one.axis, "value": one.value, "exact_ns": one.exact, "swept_ns": one.swept }))
        .collect()
}
