//! States of games with some of their numbers changed, so that most of them are still states: what damaged bytes rarely are.

use shared::game::GameState;
use shared::math::Rng;
use shared::physics::ball::Support;
use shared::physics::flipper::FlipperRest;
use shared::physics::{TargetState, WorldState};

/// Most changes of one state.
const MOST_CHANGES: u64 = 4;

/// One of them, changed.
pub(crate) fn changed(rng: &mut Rng, states: &[GameState]) -> GameState {
    let mut state = pick(rng, states).clone();
    for _ in 0..=rng.bits() % MOST_CHANGES {
        let other = pick(rng, states);
        match rng.bits() % 8 {
            0..=4 => change_balls(rng, &mut state.world, &other.world),
            5 | 6 => change_parts(rng, &mut state.world),
            _ => state.play = other.play.clone(),
        }
    }
    state
}

fn pick<'a, T>(rng: &mut Rng, all: &'a [T]) -> &'a T {
    &all[(rng.bits() % all.len() as u64) as usize]
}

/// A little other, or much, or something at an end.
fn shake(rng: &mut Rng, number: &mut f64) {
    *number = match rng.bits() % 8 {
        0 => f64::from_bits(number.to_bits() ^ (1 << (rng.bits() % 64))),
        1 => 0.0,
        2 => -*number,
        3 => *pick(rng, &[-0.0, 1e-300, -1e-12, 1e4, -1e13, 1e13, 5e-324, f64::NAN, f64::INFINITY]),
        4 => *number * (1.0 + 1e-9 * rng.gaussian()),
        5 => *number + 1e-3 * rng.gaussian(),
        6 => *number + rng.gaussian(),
        _ => rng.gaussian(),
    };
}

fn change_balls(rng: &mut Rng, world: &mut WorldState, other: &WorldState) {
    if world.balls.is_empty() || rng.bits().is_multiple_of(8) {
        // More balls, also at one and the same place.
        let many = rng.bits() % 20;
        world.balls.extend(other.balls.iter().cycle().take(if other.balls.is_empty() { 0 } else { many as usize }));
        return;
    }
    let place = (rng.bits() % world.balls.len() as u64) as usize;
    let ball = &mut world.balls[place];
    match rng.bits() % 12 {
        0 => shake(rng, &mut ball.flight.position.x),
        1 => shake(rng, &mut ball.flight.position.y),
        2 => shake(rng, &mut ball.flight.velocity.x),
        3 => shake(rng, &mut ball.flight.velocity.y),
        4 => shake(rng, &mut ball.flight.acceleration.y),
        5 => shake(rng, &mut ball.spin),
        6 => ball.flight.start.tick = world.tick.saturating_sub(*pick(rng, &[0, 1, 1000, 1 << 39])),
        7 => shake(rng, &mut ball.flight.start.offset),
        8 => {
            let (one, other) = ((rng.bits() % 64) as u16, (rng.bits() % 64) as u16);
            let supports = [
                Support::None,
                Support::Line(one),
                Support::Arc(one),
                Support::Stalled,
                Support::Wedge(one, other),
                Support::Flipper(one % 2),
                Support::Plunger(0),
                Support::Held(0),
                Support::Released(0),
            ];
            ball.support = *pick(rng, &supports);
        }
        9 => ball.past = Some((rng.gaussian(), (rng.bits() % 64) as u16)),
        10 => ball.slide = other.balls.first().and_then(|ball| ball.slide),
        _ => {
            world.balls.remove(place);
        }
    }
}

fn change_parts(rng: &mut Rng, world: &mut WorldState) {
    let first_or_second = (rng.bits() % 2) as usize;
    match rng.bits() % 11 {
        0..=3 => {
            let Some(flipper) = world.flippers.get_mut(first_or_second) else { return };
            match rng.bits() % 4 {
                0 => shake(rng, &mut flipper.swing),
                1 => shake(rng, &mut flipper.speed),
                2 => shake(rng, &mut flipper.coil_time),
                _ => flipper.rest = *pick(rng, &[FlipperRest::AtRest, FlipperRest::Raised, FlipperRest::Moving]),
            }
        }
        4 | 5 => {
            let Some(plunger) = world.plungers.first_mut() else { return };
            match rng.bits() % 4 {
                0 => shake(rng, &mut plunger.pull),
                1 => shake(rng, &mut plunger.speed),
                2 => plunger.hand = Some(rng.unit()),
                _ => plunger.home = !plunger.home,
            }
        }
        6 => {
            for target in &mut world.targets {
                *target = *pick(rng, &[TargetState::Up, TargetState::Down, TargetState::Rising]);
            }
        }
        7 => {
            let Some(hinge) = world.hinges.first_mut() else { return };
            shake(rng, if first_or_second == 0 { &mut hinge.angle } else { &mut hinge.speed });
        }
        8 => shake(rng, &mut world.cabinet.velocity.x),
        9 => shake(rng, &mut world.cabinet.bob.y),
        _ => {
            // Another time: what has an age keeps it.
            let later = *pick(rng, &[1, 1 << 53, (1 << 62) - 100_000]);
            for ball in &mut world.balls {
                ball.flight.start.tick += later;
            }
            for hinge in &mut world.hinges {
                hinge.start.tick += later;
            }
            world.tick += later;
        }
    }
}
