//! Balls locked in saucers, balls that rules add, and the end of a turn with several of them; on a table of its own.

use std::sync::Arc;

use glam::DVec2;

use super::{Action, Game, GameEventKind, Input, Phase};
use crate::physics::ball::Support;
use crate::table::Table;

/// Two locks under a chute each, a spinner and a standing target beside them; a ball that is served falls past them all.
const TABLE: &str = r#"(
    format: 1, physics: 3, name: "Locks", size: (0.4, 0.8), gravity: (0.0, -0.793), rest_speed: 0.02,
    ball: (radius: 0.0135, mass: 0.08, start: (0.35, 0.7)),
    materials: { "wood": (restitution: 0.3, friction: 0.3) },
    elements: [
        Wall(name: "frame", material: "wood", points: [(0.0, 0.0), (0.0, 0.8), (0.4, 0.8), (0.4, 0.0), (0.0, 0.0)]),
        Saucer(name: "lock 1", center: (0.1, 0.4), radius: 0.012, capture: 1.0, kick: (0.4, 0.2)),
        Saucer(name: "lock 2", center: (0.2, 0.4), radius: 0.012, capture: 1.0, kick: (0.4, 0.2)),
        Spinner(name: "spinner", from: (0.0, 0.6), to: (0.05, 0.6), lever: 0.02, inertia: 2e-6, friction: 30.0,
            restitution: 0.3, lift: 1e-5),
        Target(name: "standup", material: "wood", from: (0.26, 0.5), to: (0.3, 0.5), threshold: 0.11),
        Drain(name: "drain", from: (0.0, 0.05), to: (0.4, 0.05)),
    ],
    groups: { "locks": ["lock 1", "lock 2"] },
    rules: (balls: 1, max_multiplier: 1, on: [
        (event: Hold("locks"), run: [Score(1000), Serve]),
        (event: AllHeld("locks"), run: [Score(50000), Kick("locks"), Message("MULTIBALL")]),
        (event: Spin("spinner"), run: [Score(10)]),
        (event: Pass("spinner"), run: [Score(1)]),
        (event: Hit("standup"), run: [Score(300)]),
    ]))"#;

fn game(source: &str) -> Game {
    match Table::parse("locks.ron", source) {
        Ok(table) => Game::new(Arc::new(table)),
        Err(error) => panic!("{error}"),
    }
}

/// With the first ball in play.
fn started(source: &str) -> Game {
    let mut game = game(source);
    for action in [Action::Sit, Action::Start] {
        game.step(&[Input { tick: game.tick(), seat: 0, action }]);
    }
    wait_until(&mut game, |game| game.world().state().balls.len() == 1);
    game
}

fn wait(game: &mut Game, ticks: u32) -> Vec<GameEventKind> {
    (0..ticks).flat_map(|_| game.step(&[]).iter().map(|event| event.kind).collect::<Vec<_>>()).collect()
}

fn wait_until(game: &mut Game, is_so: impl Fn(&Game) -> bool) -> Vec<GameEventKind> {
    let mut events = Vec::new();
    for _ in 0..20_000 {
        if is_so(game) {
            return events;
        }
        events.extend(wait(game, 1));
    }
    panic!("it never was: {:?}", game.state());
}

/// Puts the ball that was served last elsewhere.
fn place(game: &mut Game, position: (f64, f64), velocity: (f64, f64)) {
    let mut state = game.state();
    let gravity = game.table().scene.gravity;
    let tick = state.world.tick;
    let Some(ball) = state.world.balls.last_mut() else { panic!("no ball") };
    ball.flight.start = crate::physics::ball::Instant::start_of(tick);
    ball.flight.position = DVec2::from(position);
    ball.flight.velocity = DVec2::from(velocity);
    ball.flight.acceleration = gravity;
    (ball.support, ball.past, ball.spin) = (Support::None, None, 0.0);
    assert_eq!(game.restore(state), Ok(()));
}

fn points(game: &Game) -> u64 {
    game.seats()[0].score.points
}

fn count(events: &[GameEventKind], is_wanted: impl Fn(&GameEventKind) -> bool) -> usize {
    events.iter().filter(|event| is_wanted(event)).count()
}

#[test]
fn balls_are_locked_until_all_locks_hold_one_and_then_all_of_them_are_in_play() {
    let mut game = started(TABLE);
    assert!(game.table().scene.needs.ball_ball, "rules that serve make balls meet");
    place(&mut game, (0.1, 0.45), (0.0, 0.0));
    let events = wait_until(&mut game, |game| game.world().state().balls.len() == 2);
    assert_eq!(count(&events, |event| matches!(event, GameEventKind::Held { element: 1 })), 1);
    assert_eq!((points(&game), game.world().held()), (1000, 1));
    assert_eq!(
        count(game.events().iter().map(|event| event.kind).collect::<Vec<_>>().as_slice(), |event| *event
            == GameEventKind::Added { seat: 0 }),
        1
    );
    // The second lock: both are thrown out, and a third ball is served.
    place(&mut game, (0.2, 0.45), (0.0, 0.0));
    let events = wait(&mut game, 600);
    assert_eq!(count(&events, |event| matches!(event, GameEventKind::Ejected { .. })), 2, "{events:?}");
    assert_eq!(count(&events, |event| matches!(event, GameEventKind::Message { .. })), 1);
    assert_eq!((points(&game), game.world().held(), game.world().state().balls.len()), (52_000, 0, 3));
    // The turn ends with the last of them.
    let events = wait_until(&mut game, |game| game.phase() == Phase::Over);
    assert_eq!(count(&events, |event| matches!(event, GameEventKind::Lost { .. })), 1, "{events:?}");
}

#[test]
fn a_turn_with_several_balls_is_given_up_with_all_of_them() {
    let mut game = started(TABLE);
    place(&mut game, (0.1, 0.45), (0.0, 0.0));
    wait_until(&mut game, |game| game.world().state().balls.len() == 2);
    let forfeit = Input { tick: game.tick(), seat: 0, action: Action::Forfeit };
    let told: Vec<_> = game.step(&[forfeit]).iter().map(|event| event.kind).collect();
    assert_eq!(told, [GameEventKind::Forfeited { seat: 0 }, GameEventKind::Over]);
    assert!(game.world().state().balls.is_empty());
    assert_eq!((game.phase(), points(&game)), (Phase::Over, 1000));
}

#[test]
fn a_ball_that_waits_for_what_can_no_longer_happen_is_thrown_out() {
    let mut game = started(TABLE);
    place(&mut game, (0.1, 0.45), (0.0, 0.0));
    wait_until(&mut game, |game| game.world().state().balls.len() == 2);
    // The second ball is lost; the first comes out and ends the turn in its time.
    place(&mut game, (0.3, 0.1), (0.0, -1.0));
    let events = wait_until(&mut game, |game| game.phase() == Phase::Over);
    assert_eq!(count(&events, |event| matches!(event, GameEventKind::Ejected { .. })), 1, "{events:?}");
    assert_eq!(count(&events, |event| matches!(event, GameEventKind::Rescued { .. })), 0);
    // Without a rule that serves it comes out at once.
    let mut game = started(&TABLE.replace(", Serve]", "]"));
    assert!(!game.table().scene.needs.ball_ball);
    place(&mut game, (0.1, 0.45), (0.0, 0.0));
    let events = wait_until(&mut game, |game| game.phase() == Phase::Over);
    assert_eq!(count(&events, |event| matches!(event, GameEventKind::Held { .. })), 1);
    assert_eq!(count(&events, |event| matches!(event, GameEventKind::Ejected { .. })), 1);
}

#[test]
fn spinners_and_standing_targets_score() {
    let mut game = started(TABLE);
    place(&mut game, (0.025, 0.55), (0.0, 0.9));
    let events = wait_until(&mut game, |game| game.phase() == Phase::Over);
    let spins = count(&events, |event| matches!(event, GameEventKind::Spun { element: 3 })) as u64;
    let passes = count(&events, |event| matches!(event, GameEventKind::Passed { element: 3 })) as u64;
    assert!(spins > 3 && passes >= 2, "up and down again: {events:?}");
    assert_eq!(points(&game), 10 * spins + passes);
    for (speed, scores) in [(-0.05, 0), (-0.5, 300)] {
        let mut game = started(TABLE);
        place(&mut game, (0.28, 0.5138), (0.0, speed));
        wait(&mut game, 5);
        assert_eq!(points(&game), scores, "{speed}");
    }
}

#[test]
fn a_game_with_locked_balls_and_balls_to_be_served_is_restored_bit_for_bit() {
    let mut game = started(TABLE);
    place(&mut game, (0.1, 0.45), (0.0, 0.0));
    for tick in 0..3000 {
        if tick == 800 {
            place(&mut game, (0.2, 0.45), (0.0, 0.0));
        }
        let mut copy = Game::new(Arc::clone(game.table()));
        assert_eq!(copy.restore(game.state()), Ok(()), "tick {tick}");
        let events = game.step(&[]).to_vec();
        assert_eq!(copy.step(&[]), events, "tick {tick}");
        assert_eq!(copy.digest(), game.digest(), "tick {tick}");
    }
}
