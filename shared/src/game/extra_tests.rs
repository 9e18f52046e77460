//! Balls that are saved, extra balls, the end of a multiball, and the time for which lights are lit; on a table of its own.

use std::sync::Arc;

use glam::DVec2;

use super::{Action, Game, GameEventKind, Input, Nudge, Phase};
use crate::physics::ball::{Instant, Support};
use crate::table::Table;

/// A plunger at the right, a rollover in the middle, a lock and a standing target at the left; nothing else stops a ball.
/// Elements: 3 the lane, 4 the lock, 6 to 8 the lights.
const TABLE: &str = r#"(
    format: 1, physics: 3, name: "Balls", size: (0.4, 0.8), gravity: (0.0, -0.793), rest_speed: 0.02, cabinet: (tilt: 0.01),
    ball: (radius: 0.0135, mass: 0.08, start: (0.38, 0.1145)),
    materials: { "wood": (restitution: 0.3, friction: 0.3) },
    elements: [
        Wall(name: "frame", material: "wood", points: [(0.0, 0.0), (0.0, 0.8), (0.4, 0.8), (0.4, 0.0), (0.0, 0.0)]),
        Wall(name: "lane wall", material: "wood", points: [(0.36, 0.0), (0.36, 0.7)]),
        Plunger(name: "plunger", material: "wood", from: (0.363, 0.1), to: (0.397, 0.1), stroke: 0.06, mass: 0.06,
            force: 30.0, hand_speed: 0.15),
        Rollover(name: "lane", from: (0.15, 0.4), to: (0.25, 0.4)),
        Saucer(name: "lock", center: (0.05, 0.4), radius: 0.012, capture: 1.0, kick: (0.0, -0.3)),
        Target(name: "target", material: "wood", from: (0.08, 0.6), to: (0.12, 0.6), threshold: 0.11),
        Light(name: "save", center: (0.2, 0.2), radius: 0.01, color: Amber),
        Light(name: "skill", center: (0.2, 0.45), radius: 0.01, color: White),
        Light(name: "over", center: (0.2, 0.5), radius: 0.01, color: Red),
        Drain(name: "drain", from: (0.0, 0.05), to: (0.36, 0.05)),
    ],
    rules: (balls: 2, max_multiplier: 1, max_extra_balls: 2, ball_save: (lasts: 5.0, saves: 1, grace: 1.0, light: "save"), on: [
        (event: BallStart, run: [LightFor("skill", 4.0), Unlight("over")]),
        (event: Pass("lane"), when: [Lit("skill")], run: [Score(1000), Unlight("skill")]),
        (event: Out("skill"), run: [Score(1), Light("over")]),
        (event: Hit("target"), run: [ExtraBall]),
        (event: Hold("lock"), run: [Serve, Serve, SaveBalls(8.0)]),
        (event: MultiballEnd, run: [Score(20)]),
    ]))"#;
const SAVE: u64 = 0b001;
const SKILL: u64 = 0b010;
const OVER: u64 = 0b100;

/// With the first ball on the plunger of the first of so many players.
fn started(players: u8) -> Game {
    let table = Table::parse("balls.ron", TABLE).unwrap_or_else(|error| panic!("{error}"));
    let mut game = Game::new(Arc::new(table));
    for seat in 0..players {
        act(&mut game, seat, Action::Sit);
    }
    act(&mut game, 0, Action::Start);
    wait_until(&mut game, |game| game.world().state().balls.len() == 1);
    wait(&mut game, 100);
    game
}

fn act(game: &mut Game, seat: u8, action: Action) {
    game.step(&[Input { tick: game.tick(), seat, action }]);
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
    let (gravity, tick) = (game.table().scene.gravity, state.world.tick);
    let Some(ball) = state.world.balls.last_mut() else { panic!("no ball") };
    ball.flight.start = Instant::start_of(tick);
    ball.flight.position = DVec2::from(position);
    ball.flight.velocity = DVec2::from(velocity);
    ball.flight.acceleration = gravity;
    (ball.support, ball.past, ball.spin, ball.slide) = (Support::None, None, 0.0, None);
    assert_eq!(game.restore(state), Ok(()));
}

/// The ball that was served last is lost: what is told of it.
fn lose(game: &mut Game) -> Vec<GameEventKind> {
    place(game, (0.3, 0.08), (0.0, -1.0));
    wait(game, 60)
}

fn points(game: &Game) -> u64 {
    game.seats()[0].score.points
}

#[test]
fn a_ball_that_is_lost_early_is_saved_once() {
    let mut game = started(1);
    assert_eq!((game.lights(), game.saves_balls()), (SAVE | SKILL, true));
    let told = lose(&mut game);
    assert_eq!(told, [GameEventKind::Saved { seat: 0 }, GameEventKind::Added { seat: 0 }]);
    assert_eq!((game.lights() & SAVE, game.saves_balls(), game.world().state().balls.len()), (0, false, 1));
    assert!(matches!(game.phase(), Phase::Play { ball: 1, serve_in: 0, .. }), "the turn goes on");
    wait(&mut game, 100);
    assert!(lose(&mut game).contains(&GameEventKind::Lost { seat: 0 }));
    wait_until(&mut game, |game| game.saves_balls());
    assert!(matches!(game.phase(), Phase::Play { ball: 2, .. }), "the next ball is saved again");
}

#[test]
fn the_time_of_a_save_begins_with_the_launch_and_has_a_grace_without_light() {
    let mut game = started(1);
    wait(&mut game, 20_000);
    assert_eq!(game.lights(), SAVE | SKILL, "it waits at the plunger");
    // Thrown up again and again, it is in play for as long as we like.
    let play = |game: &mut Game, ticks| {
        for _ in 0..ticks / 100 {
            place(game, (0.3, 0.3), (0.0, 0.0));
            wait(game, 100);
        }
    };
    play(&mut game, 4900);
    assert_eq!((game.lights() & SAVE, game.saves_balls()), (SAVE, true));
    play(&mut game, 200);
    assert_eq!((game.lights() & SAVE, game.saves_balls()), (0, true));
    let mut late = game.clone();
    assert!(lose(&mut game).contains(&GameEventKind::Saved { seat: 0 }));
    play(&mut late, 1000);
    assert!(!late.saves_balls());
    assert!(lose(&mut late).contains(&GameEventKind::Lost { seat: 0 }));
}

#[test]
fn a_lit_lane_scores_only_so_long_after_the_launch() {
    for (ticks, expected) in [(3500, 1000), (4500, 1)] {
        let mut game = started(1);
        for _ in 0..ticks / 100 {
            place(&mut game, (0.3, 0.3), (0.0, 0.0));
            wait(&mut game, 100);
        }
        let lit = game.lights() & (SKILL | OVER);
        assert_eq!(lit, if expected == 1 { OVER } else { SKILL });
        place(&mut game, (0.2, 0.42), (0.0, -0.5));
        wait(&mut game, 100);
        assert_eq!((points(&game), game.lights() & SKILL), (expected, 0), "after {ticks} ms");
    }
}

#[test]
fn seconds_are_counted_in_calm_ticks_too() {
    let mut game = started(1);
    place(&mut game, (0.3, 0.7), (0.0, 0.5));
    let left = |game: &Game| game.light_time_left(1).unwrap_or_default();
    wait(&mut game, 1);
    assert!((left(&game) - 3.999).abs() < 1e-9, "{}", left(&game));
    wait(&mut game, 400);
    assert!((left(&game) - 3.599).abs() < 1e-9, "{}", left(&game));
    assert_eq!(game.light_time_left(0), None);
    let mut copy = Game::new(Arc::clone(game.table()));
    assert_eq!(copy.restore(game.state()), Ok(()));
    for _ in 0..5000 {
        game.step(&[]);
        copy.step(&[]);
        assert_eq!(copy.digest(), game.digest(), "tick {}", game.tick());
    }
}

#[test]
fn what_is_lit_for_a_time_is_out_when_the_turn_ends() {
    let mut game = started(2);
    lose(&mut game);
    wait(&mut game, 100);
    lose(&mut game);
    assert!(game.phase().has_turn(1) && game.lights() == 0, "{:b}", game.lights());
    assert_eq!(points(&game), 0, "that is no event");
}

#[test]
fn an_extra_ball_follows_the_ball_on_which_it_was_won_and_there_are_only_so_many() {
    let mut game = started(2);
    let win = |game: &mut Game| {
        place(game, (0.1, 0.62), (0.0, -0.5));
        wait(game, 60)
    };
    assert!(win(&mut game).contains(&GameEventKind::ExtraBall { seat: 0 }));
    assert!(win(&mut game).contains(&GameEventKind::ExtraBall { seat: 0 }));
    assert!(!win(&mut game).contains(&GameEventKind::ExtraBall { seat: 0 }), "two in a game");
    for again in [true, true, false] {
        // The one that is saved, and the one that is not.
        lose(&mut game);
        wait(&mut game, 100);
        let told = lose(&mut game);
        assert!(told.contains(&GameEventKind::Lost { seat: 0 }));
        assert_eq!(told.contains(&GameEventKind::Again { seat: 0 }), again, "{told:?}");
        assert!(!game.is_at_start(), "nobody joins any more");
        wait_until(&mut game, |game| game.saves_balls());
        wait(&mut game, 100);
        assert!(matches!(game.phase(), Phase::Play { ball: 1, .. }) && game.phase().has_turn(u8::from(!again)));
    }
}

#[test]
fn a_turn_that_is_given_up_has_no_extra_ball() {
    let mut game = started(2);
    place(&mut game, (0.1, 0.62), (0.0, -0.5));
    wait(&mut game, 60);
    assert_eq!(game.seats()[0].extra_waiting, 1);
    act(&mut game, 0, Action::Forfeit);
    assert!(game.phase().has_turn(1) && game.seats()[0].extra_waiting == 0);
}

#[test]
fn a_tilt_ends_the_save_and_keeps_the_extra_ball() {
    let mut game = started(1);
    place(&mut game, (0.1, 0.62), (0.0, -0.5));
    wait(&mut game, 60);
    let mut saved = game.saves_balls();
    for tick in 0..4000 {
        if game.tilt().tilted {
            break;
        }
        saved = game.saves_balls();
        if tick % 600 == 0 {
            place(&mut game, (0.3, 0.3), (0.0, 0.0));
            act(&mut game, 0, Action::Nudge(Nudge::Forward));
            act(&mut game, 0, Action::Nudge(Nudge::FromLeft));
        }
        wait(&mut game, 1);
    }
    assert!(saved, "it would have gone on");
    assert!(game.tilt().tilted && !game.saves_balls() && game.lights() & SAVE == 0, "{:?}", game.tilt());
    assert!(lose(&mut game).contains(&GameEventKind::Again { seat: 0 }));
}

#[test]
fn in_a_multiball_every_ball_is_saved_and_its_end_is_an_event() {
    let mut game = started(1);
    // Locked: two more are served, and time stands still until the first is launched.
    place(&mut game, (0.05, 0.43), (0.0, -0.1));
    wait_until(&mut game, |game| game.world().state().balls.len() == 2);
    wait(&mut game, 500);
    assert_eq!(game.world().state().balls.len(), 2, "the third waits until the plunger is free");
    for saved in 0..6 {
        let told = lose(&mut game);
        assert!(told.contains(&GameEventKind::Saved { seat: 0 }), "{saved}: {told:?}");
        wait(&mut game, 100);
    }
    for _ in 0..90 {
        place(&mut game, (0.3, 0.3), (0.0, 0.0));
        wait(&mut game, 100);
    }
    assert!(!game.saves_balls());
    assert_eq!((game.world().state().balls.len(), game.world().held(), points(&game)), (3, 1, 1));
    // The one that is in play is lost: the one at the plunger is left.
    let mut state = game.state();
    state.world.balls.swap(1, 2);
    assert_eq!(game.restore(state), Ok(()));
    assert!(!lose(&mut game).contains(&GameEventKind::Lost { seat: 0 }));
    assert_eq!(points(&game), 21);
    // That one, too: the lock lets its ball go, and the turn ends with that.
    let mut told = lose(&mut game);
    told.extend(wait_until(&mut game, |game| matches!(game.phase(), Phase::Play { ball: 2, .. })));
    assert!(told.contains(&GameEventKind::Ejected { element: 4 }), "{told:?}");
    assert_eq!(points(&game), 21);
}
