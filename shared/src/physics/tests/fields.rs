//! What pulls a ball besides the slope of the playfield: ramps with a gravity of their own, magnets, nudges.

use glam::DVec2;

use super::{at_rest, ball, launch, run};
use crate::physics::World;
use crate::physics::ball::Instant;
use crate::physics::happened::EventKind;
use crate::table::Table;

/// A ramp from y = 0.3 to y = 0.5 between two walls of its own, with a level floor behind its crest, over a wall of the
/// playfield.
fn ramp() -> World {
    let source = r#"Scene(gravity: (0.0, 0.0), floors: [(0.0, -3.0), (0.0, 0.0)], bounds: (0.0, 0.0, 1.0, 1.0),
        balls: [(position: (0.5, 0.2))], elements: [
            Wall(name: "under the ramp", points: [(0.3, 0.4), (0.7, 0.4)]),
            Wall(name: "left", points: [(0.4, 0.3), (0.4, 0.5)], floor: 1),
            Wall(name: "right", points: [(0.6, 0.3), (0.6, 0.5)], floor: 1),
            Edge(name: "foot", from: (0.4, 0.3), to: (0.6, 0.3), floors: (0, 1)),
            Edge(name: "crest", from: (0.4, 0.5), to: (0.6, 0.5), floors: (1, 2)),
        ])"#;
    World::new(Table::parse("ramp.ron", source).unwrap_or_else(|error| panic!("{error}")).scene)
}

fn roll(velocity: DVec2, ticks: u32) -> World {
    let mut world = ramp();
    let mut state = world.state().clone();
    state.balls[0].flight.velocity = velocity;
    world.restore(state).unwrap_or_else(|error| panic!("{error}"));
    run(&mut world, ticks);
    world
}

#[test]
fn a_slow_ball_rolls_back_down_a_ramp_as_fast_as_it_came() {
    let world = roll(DVec2::new(0.0, 0.8), 1000);
    let (position, velocity) = ball(&world, 0);
    assert_eq!(world.state.balls[0].floor, 0, "it is back on the playfield");
    assert!((velocity - DVec2::new(0.0, -0.8)).length() < 1e-14, "{velocity}");
    // 0.1 m to the foot, 2 v / g up and down, and the rest of the second back.
    let rest = 1.0 - 0.1 / 0.8 - 2.0 * 0.8 / 3.0;
    assert!((position.y - (0.3 - 0.8 * rest)).abs() < 1e-13, "{position}");
}

#[test]
fn a_fast_ball_rolls_over_the_crest_with_the_speed_that_is_left() {
    for speed in [1.2, 1.5, 3.0] {
        let mut world = roll(DVec2::new(0.0, speed), 0);
        while world.state.balls[0].floor < 2 {
            run(&mut world, 1);
        }
        let (_, velocity) = ball(&world, 0);
        let left = (speed * speed - 2.0 * 3.0 * 0.2_f64).sqrt();
        assert!((velocity - DVec2::new(0.0, left)).length() < 1e-13, "{velocity} instead of {left}");
    }
}

/// Broke: two balls met where one of them had just come on to a ramp. It was thrown back on the ramp's floor, and rolled on
/// there, under the playfield's walls and off the table.
#[test]
fn a_ball_that_is_thrown_back_as_it_crosses_an_edge_stays_on_its_floor() {
    let source = r#"Scene(gravity: (0.0, 0.0), floors: [(0.0, -3.0)], bounds: (0.0, 0.0, 1.0, 1.0),
        balls: [(position: (0.5, 0.2), velocity: (0.0, 1.0)), (position: (0.5, 0.8), mass: 0.8)],
        elements: [Edge(name: "foot", from: (0.4, 0.3), to: (0.6, 0.3), floors: (0, 1))])"#;
    let table = Table::parse("ramp.ron", source).unwrap_or_else(|error| panic!("{error}"));
    let mut world = World::new(table.scene);
    let mut state = world.state().clone();
    let other = &mut state.balls[1];
    other.floor = 1;
    // At the foot it is a millimetre too near for both.
    other.flight.position = DVec2::new(0.5, 0.511);
    other.flight.acceleration = DVec2::new(0.0, -3.0);
    other.flight.velocity = DVec2::new(0.0, -1.7);
    world.restore(state).unwrap_or_else(|error| panic!("{error}"));
    run(&mut world, 130);
    let (position, velocity) = ball(&world, 0);
    assert!(velocity.y < -1.0 && position.y < 0.3, "it is thrown back, {position} {velocity}");
    assert_eq!(world.state.balls[0].floor, 0, "as on the playfield");
}

#[test]
fn the_sides_of_a_ramp_hold_only_what_is_on_it() {
    // Up the ramp at a slant, it bounces off the ramp's own wall, and not off what is under the ramp.
    let world = roll(DVec2::new(0.6, 1.3), 250);
    assert_eq!(world.state.balls[0].floor, 1);
    let (position, velocity) = ball(&world, 0);
    assert!(velocity.x < 0.0 && position.x < 0.6 && position.y > 0.4, "{position} {velocity}");
}

const CORE: f64 = 0.012;
const STRENGTH: f64 = 20.0;

fn magnet(tick_hz: u32, drag: f64, on: bool) -> World {
    let source = format!(
        r#"(format: 1, physics: 3, name: "magnet", size: (1.0, 1.0), tick_hz: {tick_hz}, gravity: (0.0, 0.0), rest_speed: 0.02,
        ball: (radius: 0.0135, mass: 0.08, start: (0.9, 0.9)), materials: {{}}, elements: [
            Magnet(name: "m", center: (0.5, 0.5), radius: 0.1, core: {CORE}, strength: {STRENGTH:?}, drag: {drag:?}, on: {on}),
            Drain(name: "drain", from: (0.0, 0.001), to: (1.0, 0.001)),
        ], rules: (balls: 3, max_multiplier: 6, on: []))"#
    );
    World::new(Table::parse("magnet.ron", &source).unwrap_or_else(|error| panic!("{error}")).scene)
}

#[test]
fn a_magnet_that_is_off_changes_no_bit() {
    let mut world = magnet(1000, 0.0, false);
    launch(&mut world, DVec2::new(0.2, 0.52), DVec2::new(1.0, 0.0));
    let flight = world.state.balls[0].flight;
    run(&mut world, 600);
    assert_eq!(world.state.balls[0].flight, flight);
}

/// Energy in the field, J/kg.
fn energy(world: &World) -> f64 {
    let (position, velocity) = ball(world, 0);
    let distance = (position - DVec2::new(0.5, 0.5)).length();
    0.5 * velocity.length_squared() - STRENGTH * CORE * CORE / distance
}

#[test]
fn a_magnet_deflects_a_ball_and_its_energy_is_wrong_by_less_the_shorter_the_tick() {
    let error = |tick_hz: u32| {
        let mut world = magnet(tick_hz, 0.0, true);
        launch(&mut world, DVec2::new(0.38, 0.53), DVec2::new(0.6, 0.0));
        run(&mut world, 60 * tick_hz / 1000);
        let start = energy(&world);
        run(&mut world, 140 * tick_hz / 1000);
        let (_, velocity) = ball(&world, 0);
        assert!(velocity.y < -0.05, "it is pulled down: {velocity}");
        (energy(&world) - start).abs() / start.abs()
    };
    let errors = [1000, 2000, 4000].map(error);
    println!("energy of a flight by a magnet, error at 1, 2 and 4 kHz: {errors:?}");
    assert!(errors[0] < 1e-3 && errors[1] < 0.5 * errors[0] && errors[2] < 0.5 * errors[1], "{errors:?}");
}

#[test]
fn a_magnet_holds_a_ball_until_it_is_switched_off() {
    let mut world = magnet(1000, 12.0, true);
    launch(&mut world, DVec2::new(0.45, 0.5), DVec2::new(0.2, 0.05));
    run(&mut world, 4000);
    let (position, velocity) = ball(&world, 0);
    assert!((position - DVec2::new(0.5, 0.5)).length() < 1e-4 && velocity.length() < 1e-3, "{position} {velocity}");
    let state = world.state().clone();
    let mut other = magnet(1000, 12.0, true);
    other.restore(state).unwrap_or_else(|error| panic!("{error}"));
    for world in [&mut world, &mut other] {
        world.switch(0, false);
        run(world, 100);
    }
    assert_eq!(world.state(), other.state(), "a state is all that there is to know");
    assert_eq!(world.state.balls[0].flight.acceleration, DVec2::ZERO, "nothing pulls it any more");
}

fn nudged(elements: &str) -> World {
    let source = format!(
        r#"(format: 1, physics: 3, name: "nudged", size: (1.0, 1.0), gravity: (0.0, -0.793), cabinet: (), rest_speed: 0.02,
        ball: (radius: 0.0135, mass: 0.08, start: (0.9, 0.9)), materials: {{ "wood": (restitution: 0.3, friction: 0.3) }},
        elements: [{elements} Drain(name: "drain", from: (0.0, 0.001), to: (1.0, 0.001))],
        rules: (balls: 3, max_multiplier: 6, on: []))"#
    );
    World::new(Table::parse("nudged.ron", &source).unwrap_or_else(|error| panic!("{error}")).scene)
}

/// It is the table that moves: seen from the floor of the hall, a ball in flight does not notice.
#[test]
fn a_nudge_moves_the_table_and_not_the_ball() {
    let mut world = nudged("");
    launch(&mut world, DVec2::new(0.3, 0.3), DVec2::new(0.1, 1.0));
    run(&mut world, 100);
    world.nudge(DVec2::X);
    run(&mut world, 20);
    world.nudge(DVec2::Y);
    let mut farthest = 0.0_f64;
    for tick in 121..=1200 {
        run(&mut world, 1);
        let t = f64::from(tick) * 1e-3;
        let free = DVec2::new(0.3, 0.3) + DVec2::new(0.1, 1.0 - 0.5 * 0.793 * t) * t;
        let moved = world.state().cabinet.displacement;
        farthest = farthest.max(moved.length());
        let (position, velocity) = ball(&world, 0);
        let off = (velocity + world.state().cabinet.velocity - DVec2::new(0.1, 1.0 - 0.793 * t)).length();
        assert!(off < 1e-13, "{off:e} m/s off after {t} s");
        // A push takes a tick: each leaves 0.03 mm.
        let off = (position + moved - free).length();
        assert!(off < 7e-5, "{off:e} m off after {t} s");
    }
    assert!((1e-3..3e-3).contains(&farthest), "the table moves by {farthest} m");
    run(&mut world, 15_000);
    assert!(world.state().cabinet.is_still(), "{:?}", world.state().cabinet);
}

#[test]
fn what_lies_on_the_table_moves_with_it() {
    let mut world = nudged(r#"Wall(name: "v", material: "wood", points: [(0.3, 0.5), (0.5, 0.3), (0.7, 0.5)]),"#);
    launch(&mut world, DVec2::new(0.5, 0.3 + 0.0135 * 2.0_f64.sqrt()), DVec2::ZERO);
    run(&mut world, 2000);
    assert!(at_rest(&world.state.balls[0].flight), "{:?}", world.state.balls[0]);
    let place = ball(&world, 0).0;
    world.nudge(DVec2::Y);
    run(&mut world, 3);
    assert!(!at_rest(&world.state.balls[0].flight) || world.state().cabinet.velocity != DVec2::ZERO);
    run(&mut world, 8000);
    assert!(at_rest(&world.state.balls[0].flight), "it lies still again: {:?}", world.state.balls[0]);
    assert!((ball(&world, 0).0 - place).length() < 1e-9);
}

#[test]
fn a_ball_at_a_wall_is_thrown_off_by_a_nudge_from_behind_the_wall() {
    let mut world = nudged(r#"Wall(name: "wall", material: "wood", points: [(0.3, 0.1), (0.3, 0.9)]),"#);
    launch(&mut world, DVec2::new(0.3137, 0.6), DVec2::ZERO);
    run(&mut world, 20);
    // The table comes towards it by a millimetre or two.
    world.nudge(DVec2::X);
    let touched = run(&mut world, 60).iter().any(|kind| matches!(kind, EventKind::Touched { element: 0, .. }));
    let (_, velocity) = ball(&world, 0);
    assert!(touched && velocity.x > 0.01, "{velocity}");
}

#[test]
fn a_world_restored_in_the_middle_of_a_nudge_goes_on_bit_for_bit() {
    let wall = r#"Arc(name: "bowl", material: "wood", center: (0.5, 0.6), radius: 0.3, from: 100.0, to: 260.0),"#;
    let mut world = nudged(wall);
    launch(&mut world, DVec2::new(0.3, 0.5), DVec2::new(0.4, 0.0));
    run(&mut world, 700);
    world.nudge(DVec2::new(0.6, 0.8));
    for ticks in [0, 1, 7, 150] {
        run(&mut world, ticks);
        let mut other = nudged(wall);
        other.restore(world.state().clone()).unwrap_or_else(|error| panic!("{error}"));
        for _ in 0..400 {
            run(&mut world, 1);
            run(&mut other, 1);
            assert_eq!(world.state(), other.state(), "at {:?}", Instant::start_of(world.state().tick));
        }
        world.nudge(DVec2::X);
    }
}

/// Broke: a flipper that moved hit what was on the ramp above it.
#[test]
fn a_flipper_does_not_reach_a_ball_on_a_ramp_above_it() {
    let mut world = crate::physics::World::new(super::classic().scene.clone());
    launch(&mut world, DVec2::new(0.19, 0.2), DVec2::ZERO);
    world.state.balls[0].floor = 1;
    let flight = world.state.balls[0].flight;
    world.press(false, true);
    run(&mut world, 60);
    assert_eq!(world.state.balls[0].flight, flight);
}

/// Broke: a ball that had left a field within the tick in which its magnet was switched off was pulled on for ever.
#[test]
fn a_magnet_that_is_switched_off_pulls_nothing_any_more() {
    let mut world = magnet(1000, 0.0, true);
    launch(&mut world, DVec2::new(0.4475, 0.55), DVec2::new(5.0, 0.0));
    while (ball(&world, 0).0 - DVec2::new(0.5, 0.5)).length() < 0.1 {
        run(&mut world, 1);
    }
    assert_ne!(world.state.balls[0].flight.acceleration, DVec2::ZERO, "its flight began in the field");
    world.switch(0, false);
    assert_eq!(world.state.balls[0].flight.acceleration, DVec2::ZERO);
}

/// Broke: with long ticks a strong brake threw a ball back, ever faster.
#[test]
fn a_magnet_brakes_a_ball_whatever_the_tick() {
    for tick_hz in [10, 100, 1000] {
        let source = format!(
            r#"(format: 1, physics: 3, name: "magnet", size: (1.0, 1.0), tick_hz: {tick_hz}, gravity: (0.0, 0.0), rest_speed: 0.02,
            ball: (radius: 0.0135, mass: 0.08, start: (0.9, 0.9)), materials: {{}}, elements: [
                Magnet(name: "m", center: (0.5, 0.5), radius: 0.2, core: 0.2, strength: 0.1, drag: 100.0, on: true),
                Drain(name: "drain", from: (0.0, 0.001), to: (1.0, 0.001)),
            ], rules: (balls: 3, max_multiplier: 6, on: []))"#
        );
        let mut world = World::new(Table::parse("magnet.ron", &source).unwrap_or_else(|error| panic!("{error}")).scene);
        launch(&mut world, DVec2::new(0.55, 0.5), DVec2::new(0.3, 0.0));
        run(&mut world, 2 * tick_hz);
        let (_, velocity) = ball(&world, 0);
        assert!(velocity.length() < 0.05, "{velocity} at {tick_hz} ticks a second");
    }
}

/// Broke: a ball went through an edge with the spin that its flight had begun with.
#[test]
fn a_ball_that_rolls_over_an_edge_keeps_its_spin() {
    let mut world = super::world_with(
        DVec2::new(0.0, -0.793),
        r#"Wall(name: "slope", material: "wood", points: [(0.1, 0.6), (0.9, 0.3)]),
        Edge(name: "edge", from: (0.5, 0.4), to: (0.5, 0.6), floors: (0, 1)),"#,
    );
    launch(&mut world, DVec2::new(0.2, 0.578), DVec2::ZERO);
    while world.state.balls[0].floor == 0 {
        run(&mut world, 1);
    }
    let spin = world.state.balls[0].spin;
    let (_, velocity) = ball(&world, 0);
    assert!((spin * 0.0135 + velocity.length()).abs() < 0.02, "spin {spin} at {velocity}");
}
