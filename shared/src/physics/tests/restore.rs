//! A world is a function of its state: a copy that goes on from a saved state, with none of the original's caches,
//! stays equal to it bit for bit. And every run gives the same bits.

use glam::DVec2;

use super::{classic, run};
use crate::math::{Rng, digest_of};
use crate::physics::ball::Support;
use crate::physics::flipper::FlipperRest;
use crate::physics::world::World;

/// Random presses, pulls, serves and raised targets on Classic: a pure function of `rng`.
fn meddle(world: &mut World, rng: &mut Rng) {
    let tick = world.state.tick;
    if tick.is_multiple_of(16) {
        let dice = rng.unit();
        if dice < 0.1 {
            let right = rng.unit() < 0.5;
            world.press(right, rng.unit() < 0.5);
        } else if dice < 0.12 {
            world.pull(if rng.unit() < 0.5 { Some(rng.unit()) } else { None });
        } else if dice < 0.13 {
            let target = rng.bits() % world.state.targets.len() as u64;
            world.raise(target as u16);
        }
        if world.state.balls.len() < 3 && rng.unit() < 0.05 {
            // Onto the plunger, slowly onto a flipper, or anywhere.
            let (place, velocity) = match rng.bits() % 3 {
                0 => (DVec2::new(0.494, 0.1145), DVec2::ZERO),
                1 => {
                    let spec = &world.scene.flippers[0];
                    let axis = spec.direction(world.state.flippers[0].swing);
                    let near = spec.pivot + axis * (spec.length * rng.unit()) + axis.perp() * 0.03;
                    let nearest = spec.nearest(axis, near);
                    (near - nearest.normal * (nearest.distance - world.scene.radius(0)), DVec2::ZERO)
                }
                _ => {
                    let velocity = DVec2::new(rng.between(-3.0, 3.0), rng.between(-3.0, 5.0));
                    (DVec2::new(rng.between(0.2, 0.28), rng.between(0.5, 0.6)), velocity)
                }
            };
            let ball = super::launch(world, place, velocity);
            world.state.balls[ball].spin = rng.between(-50.0, 50.0);
        }
    }
}

#[test]
fn every_run_gives_the_same_bits() {
    let play = || {
        let mut world = World::new(classic().scene.clone());
        let mut rng = Rng::new(3);
        for _ in 0..20_000 {
            meddle(&mut world, &mut rng);
            run(&mut world, 1);
        }
        digest_of(&world.state)
    };
    assert_eq!(play(), play());
}

/// Nothing that is remembered from tick to tick, and no tick that is not played in full, changes a bit.
#[test]
fn a_world_goes_on_as_one_that_is_restored_in_every_tick() {
    let mut world = World::new(classic().scene.clone());
    let mut restored = world.clone();
    let (mut rng, mut same) = (Rng::new(5), Rng::new(5));
    for tick in 0..60_000 {
        meddle(&mut world, &mut rng);
        meddle(&mut restored, &mut same);
        let state = restored.state.clone();
        assert_eq!(restored.restore(state), Ok(()));
        run(&mut world, 1);
        run(&mut restored, 1);
        if tick % 16 == 0 {
            assert_eq!(digest_of(&world.state), digest_of(&restored.state), "after tick {tick}");
        }
    }
}

/// Where balls and flippers were when a state was saved.
#[derive(Debug, Default)]
struct Seen {
    flights: u32,
    lines: u32,
    arcs: u32,
    on_flipper: u32,
    on_plunger: u32,
    flipper_moving: u32,
    plunger_away: u32,
    target_down: u32,
}

impl Seen {
    fn note(&mut self, world: &World) {
        for ball in &world.state.balls {
            match ball.support {
                Support::None => self.flights += 1,
                Support::Line(_) => self.lines += 1,
                Support::Arc(_) => self.arcs += 1,
                Support::Flipper(_) => self.on_flipper += 1,
                Support::Plunger(_) => self.on_plunger += 1,
                Support::Wedge(..) | Support::Stalled | Support::Held(_) | Support::Released(_) => {}
            }
        }
        self.flipper_moving += u32::from(world.state.flippers.iter().any(|f| f.rest == FlipperRest::Moving));
        self.plunger_away += u32::from(world.state.plungers.iter().any(|p| !p.home));
        self.target_down += u32::from(world.state.targets.iter().any(|t| *t != crate::physics::TargetState::Up));
    }

    fn is_complete(&self) -> bool {
        let all = [
            self.flights,
            self.lines,
            self.arcs,
            self.on_flipper,
            self.on_plunger,
            self.flipper_moving,
            self.plunger_away,
            self.target_down,
        ];
        all.iter().all(|&count| count >= 20)
    }
}

#[test]
fn a_copy_restored_at_any_tick_goes_on_bit_for_bit() {
    const COPIES: usize = 6;
    let scene = classic().scene.clone();
    let mut seen = Seen::default();
    for seed in 0..4 {
        let mut world = World::new(scene.clone());
        let mut rng = Rng::new(seed);
        let mut copies: Vec<(World, Rng, u64)> = Vec::new();
        for tick in 0..12_000_u64 {
            // One copy is made anew every other tick, so that each tick is a save tick in one of the runs, and each
            // copy lives long enough to meet what it did not know when it was made.
            if (tick + seed).is_multiple_of(2) {
                let mut copy = World::new(scene.clone());
                assert_eq!(copy.restore(world.state().clone()), Ok(()));
                seen.note(&world);
                if copies.len() < COPIES {
                    copies.push((copy, rng.clone(), tick));
                } else {
                    // The first half of the copies live long, the others briefly.
                    let long = tick.is_multiple_of(200);
                    let place = tick as usize / 2 % (COPIES / 2) + if long { 0 } else { COPIES / 2 };
                    copies[place] = (copy, rng.clone(), tick);
                }
            }
            meddle(&mut world, &mut rng);
            let events = world.step().to_vec();
            let digest = digest_of(&world.state);
            for (copy, rng, saved) in &mut copies {
                meddle(copy, rng);
                assert_eq!(copy.step(), events, "saved at {saved}, seed {seed}, tick {tick}");
                assert_eq!(
                    digest_of(&copy.state),
                    digest,
                    "saved at {saved}, seed {seed}, tick {tick}: {:?} became {:?}",
                    world.state,
                    copy.state
                );
            }
        }
    }
    println!("{seen:?}");
    assert!(seen.is_complete(), "{seen:?}");
}

#[test]
fn a_state_that_does_not_fit_is_refused_and_changes_nothing() {
    let mut world = World::new(classic().scene.clone());
    super::launch(&mut world, DVec2::new(0.24, 0.5), DVec2::ZERO);
    run(&mut world, 10);
    let before = digest_of(&world.state);
    let good = world.state().clone();
    let mut bad = Vec::new();
    let mut spoil = |spoil: &dyn Fn(&mut crate::physics::WorldState)| {
        let mut state = good.clone();
        spoil(&mut state);
        bad.push(state);
    };
    spoil(&|state| state.flippers.clear());
    spoil(&|state| state.targets.push(crate::physics::TargetState::Up));
    spoil(&|state| state.plungers.clear());
    spoil(&|state| state.balls[0].flight.position.x = f64::NAN);
    spoil(&|state| state.balls[0].flight.velocity.y = f64::INFINITY);
    // Broke: the search for the impacts of such a ball never ended.
    spoil(&|state| state.balls[0].flight.velocity.y = 1e300);
    spoil(&|state| state.balls[0].flight.acceleration.x = -1e300);
    spoil(&|state| state.balls[0].spin = f64::NAN);
    spoil(&|state| state.balls[0].flight.start.tick = 11);
    spoil(&|state| state.balls[0].flight.start.offset = -1.0);
    spoil(&|state| state.balls[0].support = Support::Line(60_000));
    spoil(&|state| state.balls[0].support = Support::Flipper(2));
    // Broke: nothing lies before such a moment, or everything.
    spoil(&|state| state.balls[0].past = Some((f64::INFINITY, 0)));
    spoil(&|state| state.balls[0].past = Some((f64::NEG_INFINITY, 0)));
    spoil(&|state| state.flippers[0].swing = f64::NAN);
    // Broke: flippers and plungers that throw a ball at such speeds.
    spoil(&|state| state.flippers[0].swing = 1e300);
    spoil(&|state| state.flippers[0].speed = -1e300);
    spoil(&|state| state.flippers[0].coil_time = -1e300);
    spoil(&|state| state.plungers[0].pull = 1e300);
    spoil(&|state| state.plungers[0].speed = -1e300);
    spoil(&|state| state.balls[0].flight.position.y = 1e6);
    // Broke: ticks so far apart that a part of one has no digits left.
    spoil(&|state| state.tick = u64::MAX);
    spoil(&|state| state.tick = 1 << 50);
    spoil(&|state| state.plungers[0].hand = Some(2.0));
    for state in bad {
        assert!(world.restore(state.clone()).is_err(), "accepted {state:?}");
        assert_eq!(digest_of(&world.state), before);
    }
    assert_eq!(world.restore(good), Ok(()));
}

/// The fastest ball that a state may have must not keep a step busy.
#[test]
fn the_fastest_state_that_is_accepted_is_stepped() {
    let mut world = World::new(classic().scene.clone());
    super::launch(&mut world, DVec2::new(0.24, 0.5), DVec2::new(3e4, -7e4));
    let mut state = world.state().clone();
    state.flippers[0].pressed = true;
    assert_eq!(world.restore(state), Ok(()));
    run(&mut world, 1000);
    assert!(world.state().balls.iter().all(|ball| ball.flight.is_finite()));
}

/// A world skips the ticks in which nothing can happen; one that was just restored does not know yet which these are.
#[test]
fn ticks_that_are_skipped_change_no_bit() {
    for seed in 0..20 {
        let mut rng = Rng::new(seed);
        let mut skipping = World::new(classic().scene.clone());
        let velocity = DVec2::new(rng.between(-3.0, 3.0), rng.between(-3.0, 3.0));
        super::launch(&mut skipping, DVec2::new(0.24, 0.5), velocity);
        let mut careful = skipping.clone();
        for tick in 0..4000 {
            assert_eq!(careful.restore(careful.state().clone()), Ok(()));
            let happens = skipping.step().to_vec();
            assert_eq!(careful.step(), happens, "seed {seed}, tick {tick}");
            assert_eq!(digest_of(&skipping.state), digest_of(&careful.state), "seed {seed}, tick {tick}");
        }
    }
}
