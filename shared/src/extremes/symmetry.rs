//! What changes no bit: mirror images, powers of two, saving, what is never touched, how the search is organised.
//!
//! The figure of each check is the number of runs that came out different.

use std::sync::Arc;

use glam::DVec2;

use super::Check;
use super::cases::{self, Case, Run, balls};
use super::transform::Similarity;
use crate::math::Rng;
use crate::physics::hinge::HingeState;
use crate::physics::motion::Motion;
use crate::physics::needs::Needs;
use crate::physics::scene::{Collider, Material, Presence, Role, Scene};
use crate::physics::shapes::{Arc as Circle, Bounds, Shape, Side};
use crate::physics::{World, WorldState};

const UNIT: &str = "runs differ";

pub(super) const CHECKS: &[Check] = &[
    Check { name: "mirrored: the same bits", unit: UNIT, goal: 0.0, known: &[], measure: mirrored },
    Check { name: "scaled by 2^-20 to 2^20: the same bits", unit: UNIT, goal: 0.0, known: &[], measure: scaled },
    Check { name: "run twice: the same bits", unit: UNIT, goal: 0.0, known: &[], measure: run_twice },
    Check {
        name: "saved and restored at any tick: the same bits",
        unit: UNIT,
        goal: 0.0,
        known: &[],
        measure: restored,
    },
    Check {
        name: "an element more that is never touched: the same bits",
        unit: UNIT,
        goal: 0.0,
        known: &[],
        measure: untouched,
    },
    Check { name: "grid or brute force: the same bits", unit: UNIT, goal: 0.0, known: &[], measure: grid },
    Check { name: "every need switched on: the same bits", unit: UNIT, goal: 0.0, known: &[], measure: needs },
];

/// How many of the cases come out differently when they are seen by `map`.
fn differing(motion: Motion, map: &Similarity) -> f64 {
    let differs = |case: &Case| {
        let other = case.mapped(map);
        let (mut run, mut mapped) = (case.run(), other.run());
        (0..case.ticks).any(|_| {
            run.step();
            mapped.step();
            !is_same(&run.world, &mapped.world, map)
        })
    };
    count(cases::all(motion).iter().filter(|case| differs(case)))
}

fn count<T>(items: impl Iterator<Item = T>) -> f64 {
    items.count() as f64
}

/// Whether `other` is what `map` makes of `world`, bit for bit.
fn is_same(world: &World, other: &World, map: &Similarity) -> bool {
    let (state, others) = (world.state(), other.state());
    let same_balls = state.balls.len() == others.balls.len()
        && state.balls.iter().zip(&others.balls).all(|(ball, other)| {
            map.flight(&ball.flight) == other.flight
                && map.spin(ball.spin) == other.spin
                && (ball.id, ball.floor, ball.support, ball.past) == (other.id, other.floor, other.support, other.past)
        });
    let same_plungers = state.plungers.iter().zip(&others.plungers).all(|(plunger, other)| {
        (map.length(plunger.pull), map.length(plunger.speed), plunger.home) == (other.pull, other.speed, other.home)
    });
    let same_events = world.events().len() == other.events().len()
        && world.events().iter().zip(other.events()).all(|(event, other)| {
            event.at == other.at && event.ball == other.ball && map.point(event.position) == other.position
        });
    // A mirror turns round the side to which angles grow, unless the side matters: then the ends change places.
    let same_hinges = state.hinges.iter().zip(&others.hinges).all(|(hinge, other)| {
        let turned = |hinge: &HingeState| (hinge.start, hinge.angle.abs(), hinge.speed.abs());
        turned(hinge) == turned(other)
    });
    same_balls
        && same_hinges
        && same_plungers
        && same_events
        && state.flippers == others.flippers
        && state.targets == others.targets
}

fn mirrored(motion: Motion) -> Result<f64, String> {
    Ok(differing(motion, &Similarity::MIRROR))
}

fn scaled(motion: Motion) -> Result<f64, String> {
    let power = |k: i32| libm::ldexp(1.0, k);
    Ok((-20..=20).map(|k| differing(motion, &Similarity::scaling(power(k)))).sum())
}

fn run_twice(motion: Motion) -> Result<f64, String> {
    Ok(differing(motion, &Similarity::NONE))
}

/// What is written of a state, read again.
fn written(state: &WorldState) -> Result<WorldState, String> {
    let config = bincode::config::standard();
    let bytes = bincode::serde::encode_to_vec(state, config).map_err(|error| error.to_string())?;
    bincode::serde::decode_from_slice(&bytes, config).map(|(state, _)| state).map_err(|error| error.to_string())
}

/// A run that knows no more of it than what is saved.
fn again<'a>(run: &Run<'a>) -> Result<Run<'a>, String> {
    let mut copy = run.clone();
    copy.world = World::new(Arc::clone(run.world.scene()));
    copy.world.restore(written(run.world.state())?).map_err(|error| error.to_string())?;
    Ok(copy)
}

/// One copy is restored at every tick, others at one tick each.
fn restored(motion: Motion) -> Result<f64, String> {
    let mut different = 0.0;
    for case in cases::all(motion) {
        let mut run = case.run();
        let mut forgetful = case.run();
        let mut copies = Vec::new();
        for tick in 0..case.ticks {
            // A prime, so that no rhythm of the script is followed.
            if tick % 307 == 0 {
                copies.push(again(&run)?);
            }
            let state = written(forgetful.world.state())?;
            forgetful.world.restore(state).map_err(|error| error.to_string())?;
            run.step();
            forgetful.step();
            copies.iter_mut().for_each(Run::step);
            let differs = |copy: &World| copy.state() != run.world.state() || copy.events() != run.world.events();
            if differs(&forgetful.world) || copies.iter().any(|copy| differs(&copy.world)) {
                different += 1.0;
                break;
            }
        }
    }
    Ok(different)
}

/// How many cases come out differently in another form of their scene: where balls are, how fast, how they spin.
fn differing_as(motion: Motion, other: impl Fn(&Case) -> Scene) -> f64 {
    let differs = |case: &Case| {
        let other = case.in_scene(other(case));
        let (mut run, mut in_other) = (case.run(), other.run());
        (0..case.ticks).any(|_| {
            run.step();
            in_other.step();
            !balls(&run.world).eq(balls(&in_other.world))
        })
    };
    count(cases::all(motion).iter().filter(|case| differs(case)))
}

/// A post where no ball comes near, in front of everything else and behind it.
fn untouched(motion: Motion) -> Result<f64, String> {
    let more = |case: &Case| {
        let mut scene = case.scene.clone();
        let (radius, place) = (0.5 * scene.largest_radius(), free_place(case));
        let shape = Shape::Arc(Circle { center: place, radius, side: Side::Outside, span: None });
        let post = Collider {
            shape,
            bounds: Bounds { low: place, high: place },
            material: Material::bouncing(1.0),
            element: u16::MAX,
            role: Role::Solid,
            presence: Presence::Always,
            floor: 0,
        };
        scene.colliders.insert(0, post);
        scene.colliders.push(post);
        scene.built()
    };
    Ok(differing_as(motion, more))
}

/// A place that no ball comes near in that case.
fn free_place(case: &Case) -> DVec2 {
    let mut run = case.run();
    let mut visited = Vec::new();
    for _ in 0..case.ticks {
        run.step();
        visited.extend(balls(&run.world).map(|(position, ..)| position));
    }
    let Bounds { low, high } = case.scene.bounds;
    let mut rng = Rng::new(5);
    let places = (0..200).map(|_| DVec2::new(rng.between(low.x, high.x), rng.between(low.y, high.y)));
    let nearest = |place: DVec2| {
        visited.iter().map(|at| (*at - place).length_squared()).fold(f64::INFINITY, |a, b| if b < a { b } else { a })
    };
    let farthest = places.map(|place| (nearest(place), place)).reduce(|a, b| if b.0 > a.0 { b } else { a });
    farthest.map_or(low, |(_, place)| place)
}

fn grid(motion: Motion) -> Result<f64, String> {
    let other = |case: &Case| {
        let needs = case.scene.needs;
        case.scene.clone().with_needs(Needs { broad_phase: !needs.broad_phase, ..needs })
    };
    Ok(differing_as(motion, other))
}

/// Balls that do not meet in their scene still do not.
fn needs(motion: Motion) -> Result<f64, String> {
    let all = |case: &Case| {
        let ball_ball = case.scene.needs.ball_ball || case.name != "parts";
        case.scene.clone().with_needs(Needs { ball_ball, ..Needs::ALL })
    };
    Ok(differing_as(motion, all))
}
