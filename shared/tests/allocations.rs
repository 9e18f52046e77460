//! `Game::step` allocates nothing: what it needs is reserved when a game is built or restored.
//!
//! The counter counts what the calling thread allocates within the measured call, so that tests may run side by side.

use std::sync::Arc;

use allocation_counter::measure;
use shared::game::{Action, Bot, Game, GameEventKind, Input};
use shared::physics::EventKind;
use shared::physics::motion::Motion;
use shared::table::Table;

/// A box of 1 m with a post, an elastic one: nothing in it comes to rest.
fn scene(balls: &str) -> Table {
    let text = format!(
        "Scene(
            gravity: (0.0, -1.11),
            balls: [{balls}],
            elements: [
                Wall(points: [(0.0, 0.0), (1.0, 0.0), (1.0, 1.0), (0.0, 1.0), (0.0, 0.0)]),
                Post(center: (0.5, 0.1), radius: 0.03),
            ],
        )"
    );
    Table::parse("scene", &text).unwrap_or_else(|error| panic!("{error}"))
}

/// That many balls in rows, each with a velocity of its own.
fn rows(balls: usize) -> String {
    let ball = |i: usize| {
        let (column, row) = ((i % 20) as f64, (i / 20) as f64);
        let (x, y) = (0.05 + 0.045 * column, 0.2 + 0.045 * row);
        format!("(position: ({x}, {y}), velocity: ({}, {}), radius: 0.01)", 0.1 * column - 0.7, 0.3 - 0.1 * row)
    };
    (0..balls).map(ball).collect::<Vec<_>>().join(", ")
}

/// Allocations of that many steps without input, and the impacts in them.
fn allocations(game: &mut Game, ticks: u32) -> (u64, usize) {
    let (mut count, mut impacts) = (0, 0);
    for _ in 0..ticks {
        count += measure(|| {
            game.step(&[]);
        })
        .count_total;
        impacts += game.world().events().len();
    }
    (count, impacts)
}

#[test]
fn the_counter_counts() {
    assert_eq!(measure(|| drop(std::hint::black_box(vec![1_u8]))).count_total, 1);
    let mut growing = Vec::with_capacity(1);
    growing.push(1_u8);
    assert_eq!(measure(|| growing.push(2)).count_total, 1);
}

#[test]
fn a_bare_scene_allocates_nothing() {
    for motion in Motion::ALL {
        let table = scene("(position: (0.3, 0.7), velocity: (1.0, 0.5))").run_with(Some(motion), None);
        let table = table.unwrap_or_else(|error| panic!("{error}"));
        let (count, impacts) = allocations(&mut Game::new(Arc::new(table)), 20_000);
        assert_eq!(count, 0, "{motion}");
        assert!(impacts > 20, "{motion}: {impacts}");
    }
}

#[test]
fn many_balls_allocate_nothing() {
    for (balls, ticks) in [(12, 5000), (300, 300)] {
        for motion in Motion::ALL {
            let table = scene(&rows(balls)).run_with(Some(motion), None).unwrap_or_else(|error| panic!("{error}"));
            let mut game = Game::new(Arc::new(table));
            let (count, impacts) = allocations(&mut game, ticks);
            assert_eq!(count, 0, "{balls} balls, {motion}");
            assert!(impacts > 2 * balls, "{balls} balls, {motion}: {impacts}");
        }
    }
}

/// A tick of a whole second, in which thousands of impacts happen: the first such tick may allocate, no other one.
#[test]
fn a_long_tick_allocates_once_at_the_most() {
    let table = scene(&rows(100)).run_with(None, Some(1)).unwrap_or_else(|error| panic!("{error}"));
    let mut game = Game::new(Arc::new(table));
    let (_, impacts) = allocations(&mut game, 1);
    assert!(impacts > 256, "{impacts}");
    let again = game.state();
    assert_eq!(game.restore(again), Ok(()));
    let (count, _) = allocations(&mut game, 1);
    assert!(count <= 2, "{count}: the two lists of events");
}

/// Whole games of the bot on Classic: flippers, plunger, targets, kickers, drains, serves, rules.
#[test]
fn games_on_classic_allocate_nothing() {
    let Some(Ok(table)) = Table::shipped("classic") else { panic!("it is shipped") };
    let mut game = Game::new(Arc::new(table));
    let mut bot = Bot::new(0, 3);
    let mut inputs = Vec::with_capacity(8);
    let (mut lost, mut felled, mut restored) = (0, 0, 0);
    for tick in 0..200_000 {
        inputs.clear();
        match tick {
            0 => inputs.push(Input { tick, seat: 0, action: Action::Sit }),
            _ if tick % 100_000 == 1 => inputs.push(Input { tick, seat: 0, action: Action::Start }),
            _ => {}
        }
        bot.play(&game, |action| inputs.push(Input { tick, seat: 0, action }));
        let count = measure(|| {
            game.step(&inputs);
        })
        .count_total;
        assert_eq!(count, 0, "tick {tick}: {:?}, {:?}", game.events(), game.world().events());
        lost += game.events().iter().filter(|event| matches!(event.kind, GameEventKind::Lost { .. })).count();
        felled += game.world().events().iter().filter(|event| matches!(event.kind, EventKind::Felled { .. })).count();
        // A game that goes on from a saved state, with and without a ball in play, allocates nothing either.
        if tick % 777 == 0 {
            let state = game.state();
            restored += usize::from(state.world.balls.is_empty());
            assert_eq!(game.restore(state), Ok(()));
        }
    }
    assert!(lost >= 2 && felled >= 1 && restored >= 1, "{lost} balls lost, {felled} targets felled, {restored}");
}

/// A spinner that spins, a gate, a saucer that catches and throws out, and rules that serve another ball each time.
#[test]
fn mechanisms_and_multiball_allocate_nothing() {
    let text = r#"(format: 1, physics: 3, name: "Locks", size: (0.4, 0.8), gravity: (0.0, -0.793), rest_speed: 0.02,
        ball: (radius: 0.0135, mass: 0.08, start: (0.2, 0.7)),
        materials: { "wood": (restitution: 0.3, friction: 0.3) },
        elements: [
            Wall(name: "frame", material: "wood", points: [(0.0, 0.0), (0.0, 0.8), (0.4, 0.8), (0.4, 0.0), (0.0, 0.0)]),
            Spinner(name: "spinner", from: (0.1, 0.6), to: (0.3, 0.6), lever: 0.02, inertia: 2e-6, friction: 30.0,
                restitution: 0.3, lift: 1e-5),
            Saucer(name: "lock", center: (0.2, 0.4), radius: 0.012, capture: 2.0, kick: (0.3, 1.2), hold: 0.2),
            Gate(name: "gate", from: (0.3, 0.3), to: (0.1, 0.3), lever: 0.02, inertia: 2e-6, restitution: 0.3, lift: 1e-5,
                one_way: false),
            Drain(name: "drain", from: (0.0, 0.05), to: (0.4, 0.05)),
        ],
        rules: (balls: 100, max_multiplier: 1, on: [
            (event: Hold("lock"), run: [Score(1), Serve]),
            (event: Spin("spinner"), run: [Score(1)]),
        ]))"#;
    let table = Table::parse("locks.ron", text).unwrap_or_else(|error| panic!("{error}"));
    let mut game = Game::new(Arc::new(table));
    let (mut spun, mut ejected, mut most) = (0, 0, 0);
    for tick in 0..60_000 {
        let action = if tick == 0 { Action::Sit } else { Action::Start };
        let input = [Input { tick, seat: 0, action }];
        let count = measure(|| {
            game.step(&input);
        })
        .count_total;
        assert_eq!(count, 0, "tick {tick}: {:?}", game.world().events());
        spun += game.world().events().iter().filter(|event| matches!(event.kind, EventKind::Spun { .. })).count();
        ejected += game.world().events().iter().filter(|event| matches!(event.kind, EventKind::Ejected { .. })).count();
        most = most.max(game.world().state().balls.len());
    }
    assert!(spun > 10 && ejected > 10 && most > 2, "{spun} half turns, {ejected} thrown out, {most} balls");
}
