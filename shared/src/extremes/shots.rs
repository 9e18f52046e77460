//! Random shots on Classic with its flippers moving: no ball may get where no ball belongs.
//!
//! A ball that pushes a moving flipper follows it in pieces of a tick, in every model, and so sinks into it by an error of the
//! piece. The deepest of the exact model was 0.11 mm in a million shots of one ball, and 0.18 mm in a million with up to five. Half a
//! radius is where a ball would be taken to be on the flipper's other side.

use core::ops::Range;
use std::sync::Arc;

use glam::DVec2;

use super::account::Account;
use super::cases::{balls, classic};
use super::overlap::{Obstacles, deepest_overlap};
use super::{Check, known};
use crate::math::{Rng, direction};
use crate::physics::ball::Ball;
use crate::physics::constants::DEEPEST_OVERLAP;
use crate::physics::motion::Motion;
use crate::physics::needs::Needs;
use crate::physics::{EventKind, World};
use crate::table::Table;

/// Ticks for which a shot is followed.
const TICKS: u32 = 150;
/// Fastest shot, m/s.
pub const FASTEST: f64 = 100.0;
/// Energy that is rounding, J: a ball at 100 m/s has 400 J.
const MOST_EXCESS: f64 = 1e-9;
/// Balls of a shot at once, at the most.
pub const MOST_BALLS: u64 = 5;
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
    Check {
        name: "random shots with 1 to 5 balls: none lost",
        unit: "of 1000",
        goal: 0.0,
        known: &[known::tunnels(600.0)],
        measure: crowd_lost,
    },
    Check {
        name: "random shots with 1 to 5 balls: energy beyond what was given",
        unit: "J",
        goal: MOST_EXCESS,
        known: &[],
        measure: excess,
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
    /// The most energy at the end of any tick beyond what there was at the start and what coils, springs and kickers gave, J.
    pub excess: f64,
    /// The most that was won in any tick beyond what was given in it, J.
    pub won: f64,
    /// Number and tick of that.
    pub richest: (u64, u64),
    /// Number and tick of the first shot that was lost; if none was, of the deepest overlap.
    pub worst: (u64, u64),
}

impl Shots {
    /// Balls that got where no ball belongs.
    pub fn lost(&self) -> u64 {
        self.escaped + self.passed_through + self.not_finite
    }

    /// Whether none was lost, or nearly. Energy is told of and not promised: see what is known of `random shots` in [`crate::feel`].
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
        self.excess = if other.excess > self.excess { other.excess } else { self.excess };
        if other.won > self.won {
            (self.won, self.richest) = (other.won, other.richest);
        }
        self
    }
}

/// Which shots are played.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct Shooting {
    /// All of them follow from it.
    pub seed: u64,
    /// m/s.
    pub fastest: f64,
    /// From 1 to so many at once, which meet each other.
    pub most_balls: u64,
    /// How impacts are found.
    pub motion: Motion,
}

/// Plays those of all shots. Which ones are played together, or in which order, changes none.
pub fn shots(numbers: Range<u64>, shooting: &Shooting) -> Shots {
    let mut table = classic(shooting.motion);
    let obstacles = Obstacles::of(&table);
    if shooting.most_balls > 1 {
        let scene = (*table.scene).clone();
        let needs = Needs { ball_ball: true, ..scene.needs };
        table.scene = Arc::new(scene.with_needs(needs));
    }
    let nothing = Shots { deepest: f64::NEG_INFINITY, excess: f64::NEG_INFINITY, ..Shots::default() };
    numbers.fold(nothing, |sum, number| {
        let shot = Shot::new(&table, &obstacles, number, shooting);
        sum.joined(shot.play(&obstacles))
    })
}

/// A ball before a tick.
#[derive(Debug, Clone, Copy)]
struct Before {
    place: DVec2,
    floor: u8,
    /// It has been clear of the other balls since it came to its floor: one that drops may drop onto another.
    clear: bool,
}

struct Shot {
    number: u64,
    rng: Rng,
    world: World,
    /// Of each ball, by its id.
    before: Vec<Before>,
}

impl Shot {
    fn new(table: &Table, obstacles: &Obstacles, number: u64, shooting: &Shooting) -> Self {
        let mut rng = Rng::new(Rng::new(shooting.seed).bits().wrapping_add(Rng::new(number).bits()));
        let mut world = World::new(table.scene.clone());
        let balls = if shooting.most_balls > 1 { 1 + rng.bits() % shooting.most_balls } else { 1 };
        let mut before: Vec<Before> = Vec::new();
        for _ in 0..balls {
            let start = loop {
                let place = DVec2::new(rng.between(0.0, 0.514), rng.between(0.02, 1.067));
                let under_the_arch = place.y < 0.81 || (place - DVec2::new(0.257, 0.81)).length() < 0.24;
                let is_alone = before.iter().all(|other| (other.place - place).length() > 2.0 * table.scene.radius(0));
                let is_clear = deepest_overlap(&world, place, 0) < 0.0
                    && !obstacles.is_inside(place, 0)
                    && !obstacles.is_at_edge(place, table.scene.radius(0));
                if under_the_arch && is_alone && is_clear {
                    break place;
                }
            };
            let velocity = direction(rng.between(0.0, core::f64::consts::TAU)) * rng.between(0.0, shooting.fastest);
            world.launch(0, start, velocity);
            before.push(Before { place: start, floor: 0, clear: true });
            let mut state = world.state().clone();
            if let Some(ball) = state.balls.last_mut() {
                ball.spin = rng.between(-200.0, 200.0);
            }
            // A state that differs in a finite spin only is accepted.
            let _ = world.restore(state);
        }
        Self { number, rng, world, before }
    }

    fn play(mut self, obstacles: &Obstacles) -> Shots {
        let nothing = Shots { deepest: f64::NEG_INFINITY, excess: f64::NEG_INFINITY, ..Shots::default() };
        let mut told = Shots { shots: 1, ..nothing };
        let mut account = Account::new(&self.world);
        for _ in 0..TICKS {
            if self.rng.unit() < 0.04 {
                let right = self.rng.unit() < 0.5;
                self.world.press(right, self.rng.unit() < 0.6);
            }
            account.open(&self.world);
            for event in self.world.step() {
                match event.kind {
                    EventKind::Escaped => told.escaped += 1,
                    EventKind::Drained => told.drained += 1,
                    EventKind::Passed { .. } => {}
                    _ => told.impacts += 1,
                }
            }
            account.close(&self.world);
            self.judge(obstacles, &account, &mut told);
            if told.lost() > 0 || self.world.state().balls.is_empty() {
                break;
            }
        }
        if told.lost() > 0 {
            told.worst = (self.number, self.world.state().tick);
        }
        told
    }

    /// Where the balls are after a tick.
    fn judge(&mut self, obstacles: &Obstacles, account: &Account, told: &mut Shots) {
        let (scene, states) = (self.world.scene(), &self.world.state().balls);
        let now: Vec<_> = balls(&self.world).zip(states).collect();
        for (place, &((position, velocity, spin), ball)) in now.iter().enumerate() {
            let before = self.before[ball.id as usize];
            // On its way to another floor it may pass above or below any wall.
            let crossed = before.floor == ball.floor && obstacles.crossed(before.place, position, ball.floor).is_some();
            if !(position.is_finite() && velocity.is_finite() && spin.is_finite()) {
                told.not_finite = 1;
            } else if obstacles.is_inside(position, ball.floor) || crossed {
                told.passed_through = 1;
            }
            // Balls on different floors do not meet, and one in a saucer meets none.
            let meets = |other: &Ball| {
                other.id != ball.id && other.floor == ball.floor && ball.saucer().is_none() && other.saucer().is_none()
            };
            let others = now.iter().filter(|(_, other)| meets(other));
            let overlaps =
                others.map(|((at, ..), other)| (other.id, 2.0 * scene.radius(0) - (*at - position).length()));
            let overlaps: Vec<_> = overlaps.collect();
            let clear =
                before.clear && before.floor == ball.floor || overlaps.iter().all(|(_, overlap)| *overlap <= 0.0);
            self.before[ball.id as usize] = Before { place: position, floor: ball.floor, clear };
            let judged = overlaps.iter().filter(|(id, _)| {
                let is_earlier = now[..place].iter().any(|(_, other)| other.id == *id);
                is_earlier && clear && self.before[*id as usize].clear
            });
            let between = judged.map(|(_, overlap)| *overlap);
            for overlap in between.chain([deepest_overlap(&self.world, position, ball.floor)]) {
                if overlap > told.deepest {
                    told.deepest = overlap;
                    told.worst = (self.number, self.world.state().tick);
                }
            }
        }
        let excess = account.excess(&self.world);
        told.excess = if excess > told.excess { excess } else { told.excess };
        let won = account.won(&self.world);
        if won > told.won {
            told.won = won;
            told.richest = (self.number, self.world.state().tick);
        }
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
    let told = shots(0..count(motion), &Shooting { seed: 1, fastest: FASTEST, most_balls: 1, motion });
    if told.not_finite > 0 {
        return Err(format!("a number of shot {} is not finite", told.worst.0));
    }
    Ok(1000.0 * told.lost() as f64 / told.shots as f64)
}

/// Shots of up to 5 balls.
fn crowds(motion: Motion) -> Shots {
    shots(0..count(motion), &Shooting { seed: 3, fastest: FASTEST, most_balls: MOST_BALLS, motion })
}

/// Shots of which a ball is lost, of a thousand.
fn crowd_lost(motion: Motion) -> Result<f64, String> {
    let told = crowds(motion);
    if told.not_finite > 0 {
        return Err(format!("a number of shot {} is not finite", told.worst.0));
    }
    Ok(1000.0 * told.lost() as f64 / told.shots as f64)
}

fn excess(motion: Motion) -> Result<f64, String> {
    Ok(crowds(motion).excess)
}

fn deepest(motion: Motion) -> Result<f64, String> {
    Ok(shots(0..count(motion) / 5, &Shooting { seed: 2, fastest: FASTEST, most_balls: 1, motion }).deepest)
}
