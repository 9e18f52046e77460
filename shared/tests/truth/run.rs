//! A scene played by the engine: its flights, one after the other.

use glam::DVec2;
use shared::game::Game;
use shared::physics::EventKind;
use shared::physics::motion::Motion;

use super::digits::{exact_f64, rounded};
use super::solution::{Problem, exact_place};

/// A flight from one impact to the next.
pub(crate) struct Stretch {
    /// When it began, in units of 1e-25 s.
    pub(crate) start: i128,
    /// Where, in the file's coordinates, in units of 1e-25 m.
    pub(crate) exact_position: [i128; 2],
    /// Where, in the scene's own coordinates, m.
    pub(crate) position: DVec2,
    /// m/s.
    velocity: DVec2,
    /// m/s^2.
    gravity: DVec2,
    /// The element that it began at; nothing for the first.
    pub(crate) element: String,
}

impl Stretch {
    /// How far the ball has come after `t` seconds, m.
    pub(crate) fn way(&self, t: f64) -> DVec2 {
        (self.velocity + self.gravity * (0.5 * t)) * t
    }

    pub(crate) fn position_at(&self, t: f64) -> DVec2 {
        self.position + self.way(t)
    }
}

/// What became of a scene.
pub(crate) struct Run {
    pub(crate) origin: DVec2,
    /// The first begins at the scene's start, each other one at an impact.
    pub(crate) flights: Vec<Stretch>,
    pub(crate) escaped: bool,
}

/// Seconds after the solution's end for which a run goes on: its last bounce may come late.
const BEYOND: f64 = 0.01;

/// Plays a scene to the end of its solution and a little more.
pub(crate) fn run(problem: &Problem, motion: Motion, tick_hz: u32) -> Run {
    let table = problem.table.run_with(Some(motion), Some(tick_hz)).unwrap_or_else(|error| panic!("{error}"));
    let names: Vec<String> = table.file.elements.iter().map(|element| element.name().to_owned()).collect();
    let mut game = Game::new(table.into());
    let scene = std::sync::Arc::clone(&game.table().scene);
    // A tick is the double next to 1 / tick_hz seconds long.
    let tick = exact_f64(scene.tick_seconds);
    let mut flights = Vec::new();
    let stretch = |start: i128, position: DVec2, velocity: DVec2, element: &str| Stretch {
        start,
        exact_position: exact_place(scene.origin, position),
        position,
        velocity,
        gravity: scene.gravity,
        element: element.to_owned(),
    };
    let start = &scene.start[0];
    flights.push(stretch(0, start.position, start.velocity, ""));
    let mut escaped = false;
    let end = problem.solution.end + BEYOND;
    let ticks = (end * f64::from(tick_hz)) as u64 + 1;
    for _ in 0..ticks {
        game.step(&[]);
        for event in game.world().events() {
            match event.kind {
                EventKind::Touched { element, .. } => {
                    let start = i128::from(event.at.tick) * tick + exact_f64(event.at.offset);
                    flights.push(stretch(start, event.position, event.velocity, &names[usize::from(element)]));
                }
                EventKind::Escaped => escaped = true,
                _ => {}
            }
        }
    }
    // With long ticks it has gone on for longer.
    flights.retain(|flight| flight.start <= exact_f64(end));
    Run { origin: scene.origin, flights, escaped }
}

impl Run {
    /// Whether the impacts of both runs are as many and the same, bit for bit, but for their moments.
    pub(crate) fn same_bits(&self, other: &Self) -> bool {
        let bits = |v: DVec2| [v.x.to_bits(), v.y.to_bits()];
        let same = |(a, b): (&Stretch, &Stretch)| {
            a.element == b.element && bits(a.position) == bits(b.position) && bits(a.velocity) == bits(b.velocity)
        };
        self.flights.iter().zip(&other.flights).all(same) && self.flights.len() == other.flights.len()
    }

    /// The highest speed at any impact, m/s.
    pub(crate) fn fastest(&self) -> f64 {
        self.flights.iter().map(|flight| flight.velocity.length()).fold(0.0, f64::max)
    }

    /// The largest difference of the moments of the same impact, seconds.
    pub(crate) fn later_by(&self, other: &Self) -> f64 {
        let apart = self.flights.iter().zip(&other.flights).map(|(a, b)| (a.start - b.start).abs());
        rounded(apart.max().unwrap_or(0))
    }

    /// How far this run and another are apart at that bounce of the other, m: at its time, as errors are measured.
    pub(crate) fn apart(&self, other: &Self, bounce: usize) -> f64 {
        let there = &other.flights[bounce];
        let here = self.flights.iter().rev().find(|flight| flight.start <= there.start);
        let here = here.unwrap_or_else(|| panic!("a run begins at 0"));
        (here.position_at(rounded(there.start - here.start)) - there.position).length()
    }
}
