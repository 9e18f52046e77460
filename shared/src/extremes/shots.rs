//! Random shots on Classic with its flippers moving: no ball may get where no ball belongs.
//!
//! A ball that pushes a moving flipper follows it for one tick at a time, in every model, and so sinks into it by an error of
//! the tick. The deepest in a million shots of the exact model was 5.2 mm, two fifths of its radius: a ball at 100 m/s flies
//! 100 mm in a tick, and turns a flipper that was just pressed by most of its stroke. Up to 20 m/s it is below 0.2 mm. Half a
//! radius is where a ball would be taken to be on the flipper's other side.

use core::ops::Range;

use glam::DVec2;

use super::cases::classic;
use super::overlap::{Obstacles, deepest_overlap};
use super::{Check, known};
use crate::math::{Rng, direction};
use crate::physics::constants::DEEPEST_OVERLAP;
use crate::physics::motion::Motion;
use crate::physics::{EventKind, World};
use crate::table::Table;

/// Ticks for which a shot is followed.
const TICKS: u32 = 150;
/// Fastest shot, m/s.
pub const FASTEST: f64 = 100.0;
/// Deepest overlap with which a ball still finds back, m: half the radius of Classic's ball.
const DEEPEST: f64 = DEEPEST_OVERLAP * 0.0135;

pub(super) const CHECKS: &[Check] = &[
    Check {
        name: "random shots at up to 100 m/s: none lost",
        unit: "of 1000",
        goal: 0.0,
        known: &[known::tunnels(400.0)],
        measure: lost,
    },
    Check {
        name: "random shots: deepest overlap",
        unit: "m",
        goal: 1e-3,
        known: &[known::tunnels(0.03)],
        measure: deepest,
    },
];

/// What became of many shots.
#[derive(Debug, Clone, Copy, Default, PartialEq)]
pub struct Shots {
    /// How many.
    pub shots: u64,
    /// Impacts of all of them together.
    pub impacts: u64,
    /// Balls that drained.
    pub drained: u64,
    /// Balls that left the table.
    pub escaped: u64,
    /// Balls that came through a wall, or into an island.
    pub passed_through: u64,
    /// Balls with a number that is not finite.
    pub not_finite: u64,
    /// The deepest overlap at the end of any tick, m; negative infinity: nothing was near.
    pub deepest: f64,
    /// Number and tick of the first shot that was lost; if none was, of the deepest overlap.
    pub worst: (u64, u64),
}

impl Shots {
    /// Balls that got where no ball belongs.
    pub fn lost(&self) -> u64 {
        self.escaped + self.passed_through + self.not_finite
    }

    /// Whether none was lost, or nearly.
    pub fn is_as_promised(&self) -> bool {
        self.lost() == 0 && self.deepest < DEEPEST
    }

    /// Both together.
    #[must_use]
    pub fn joined(mut self, other: Self) -> Self {
        if (self.lost() == 0 && other.lost() > 0) || (other.lost() == self.lost() && other.deepest > self.deepest) {
            self.worst = other.worst;
        }
        self.shots += other.shots;
        self.impacts += other.impacts;
        self.drained += other.drained;
        self.escaped += other.escaped;
        self.passed_through += other.passed_through;
        self.not_finite += other.not_finite;
        self.deepest = if other.deepest > self.deepest { other.deepest } else { self.deepest };
        self
    }
}

/// Plays those shots of all that follow from `seed`, each at up to `fastest` m/s. Which ones are played together, or in
/// which order, changes none.
pub fn shots(numbers: Range<u64>, seed: u64, fastest: f64, motion: Motion) -> Shots {
    let table = classic(motion);
    let obstacles = Obstacles::of(&table);
    let mut sum = Shots { deepest: f64::NEG_INFINITY, ..Shots::default() };
    for number in numbers {
        let shot = Shot::new(&table, &obstacles, number, seed, fastest);
        sum = sum.joined(shot.play(&obstacles));
    }
    sum
}

struct Shot {
    number: u64,
    rng: Rng,
    world: World,
    start: DVec2,
}

impl Shot {
    fn new(table: &Table, obstacles: &Obstacles, number: u64, seed: u64, fastest: f64) -> Self {
        let mut rng = Rng::new(Rng::new(seed).bits().wrapping_add(Rng::new(number).bits()));
        let mut world = World::new(table.scene.clone());
        let start = loop {
            let place = DVec2::new(rng.between(0.0, 0.514), rng.between(0.02, 1.067));
            let under_the_arch = place.y < 0.81 || (place - DVec2::new(0.257, 0.81)).length() < 0.24;
            if under_the_arch && deepest_overlap(&world, place) < 0.0 && !obstacles.is_inside(place) {
                break place;
            }
        };
        let velocity = direction(rng.between(0.0, core::f64::consts::TAU)) * rng.between(0.0, fastest);
        world.launch(0, start, velocity);
        let mut state = world.state().clone();
        state.balls[0].spin = rng.between(-200.0, 200.0);
        // A state that differs in a finite spin only is accepted.
        let _ = world.restore(state);
        Self { number, rng, world, start }
    }

    fn play(mut self, obstacles: &Obstacles) -> Shots {
        let mut told = Shots { shots: 1, deepest: f64::NEG_INFINITY, ..Shots::default() };
        let mut before = self.start;
        for _ in 0..TICKS {
            if self.rng.unit() < 0.04 {
                let right = self.rng.unit() < 0.5;
                self.world.press(right, self.rng.unit() < 0.6);
            }
            for event in self.world.step() {
                match event.kind {
                    EventKind::Escaped => told.escaped += 1,
                    EventKind::Drained => told.drained += 1,
                    EventKind::Passed { .. } => {}
                    _ => told.impacts += 1,
                }
            }
            let Some((position, velocity, spin)) = super::cases::balls(&self.world).next() else { break };
            if !(position.is_finite() && velocity.is_finite() && spin.is_finite()) {
                told.not_finite = 1;
            } else if obstacles.is_inside(position) || obstacles.crossed(before, position).is_some() {
                told.passed_through = 1;
            }
            if told.lost() > 0 {
                break;
            }
            let overlap = deepest_overlap(&self.world, position);
            if overlap > told.deepest {
                told.deepest = overlap;
                told.worst = (self.number, self.world.state().tick);
            }
            before = position;
        }
        if told.lost() > 0 {
            told.worst = (self.number, self.world.state().tick);
        }
        told
    }
}

/// Shots that each model plays for its check: what is affordable in a test.
fn count(motion: Motion) -> u64 {
    match motion {
        Motion::Exact => 5000,
        Motion::Swept => 1000,
        Motion::Discrete | Motion::Pixel => 200,
    }
}

/// Balls lost, of a thousand.
fn lost(motion: Motion) -> Result<f64, String> {
    let told = shots(0..count(motion), 1, FASTEST, motion);
    if told.not_finite > 0 {
        return Err(format!("a number of shot {} is not finite", told.worst.0));
    }
    Ok(1000.0 * told.lost() as f64 / told.shots as f64)
}

fn deepest(motion: Motion) -> Result<f64, String> {
    Ok(shots(0..count(motion) / 5, 2, FASTEST, motion).deepest)
}
