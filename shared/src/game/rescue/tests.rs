//! Balls that get stuck: who is rescued, how, and who is not.

use std::sync::Arc;

use glam::DVec2;

use crate::game::replay::{Recorder, Replay};
use crate::game::{Action, Game, GameEventKind, Input, Rescue};
use crate::physics::ball::{Ball, Flight, Instant, Support};
use crate::table::Table;

const KICKERS: GameEventKind = GameEventKind::Rescued { by: Rescue::Kickers };
const RELAUNCH: GameEventKind = GameEventKind::Rescued { by: Rescue::Relaunch };

/// On the level shelf a ball lies for ever.
const SHELF: DVec2 = DVec2::new(0.1, 0.5135);
/// On the slingshot below, too, if it came slowly.
const SLING: DVec2 = DVec2::new(0.1, 0.3135);
/// Over the trampoline it bounces for ever.
const BOUNCE: DVec2 = DVec2::new(0.25, 0.4);
/// Right on top of the post: it rolls off neither side.
const ON_POST: DVec2 = DVec2::new(0.3, 0.65 + 0.005 + 0.0135);
/// Between the left side and the bumper.
const IN_NOOK: DVec2 = DVec2::new(0.0135, 0.211);
/// On the plunger.
const PLUNGER: DVec2 = DVec2::new(0.37, 0.1135);

/// A table on which the ball is served at `start`.
fn table(start: DVec2) -> Arc<Table> {
    let text = format!(
        "(
            format: 1, physics: {}, name: \"Traps\", size: (0.4, 0.8), gravity: (0.0, -0.793), rest_speed: 0.02,
            ball: (radius: 0.0135, mass: 0.08, start: ({}, {})),
            materials: {{
                \"wood\": (restitution: 0.3, friction: 0.3), \"dead\": (restitution: 0.0, friction: 0.3),
                \"spring\": (restitution: 1.0, friction: 0.0),
            }},
            elements: [
                Wall(name: \"frame\", material: \"wood\", points: [(0.0, 0.0), (0.0, 0.8), (0.4, 0.8), (0.4, 0.0), (0.0, 0.0)]),
                Wall(name: \"shelf\", material: \"dead\", points: [(0.05, 0.5), (0.15, 0.5)]),
                Slingshot(name: \"sling\", material: \"dead\", from: (0.15, 0.3), to: (0.05, 0.3), kick: 0.5, threshold: 0.1),
                Post(name: \"post\", material: \"dead\", center: (0.3, 0.65), radius: 0.005),
                Bumper(name: \"bumper\", material: \"wood\", center: (0.05, 0.2), radius: 0.024, kick: 0.8, threshold: 0.3),
                Wall(name: \"trampoline\", material: \"spring\", points: [(0.2, 0.3), (0.3, 0.3)]),
                Plunger(
                    name: \"plunger\", material: \"wood\", from: (0.352, 0.1), to: (0.388, 0.1),
                    stroke: 0.06, mass: 0.06, force: 30.0, hand_speed: 0.15,
                ),
                Wall(name: \"lane\", material: \"wood\", points: [(0.345, 0.0), (0.345, 0.3)]),
                Drain(name: \"drain\", from: (0.0, 0.05), to: (0.345, 0.05)),
            ],
            rules: (balls: 3, max_multiplier: 1, on: [(event: Hit(\"sling\"), run: [Score(100)])]),
        )",
        crate::physics::PHYSICS_VERSION,
        start.x,
        start.y
    );
    Arc::new(Table::parse("traps.ron", &text).unwrap_or_else(|error| panic!("{error}")))
}

fn act(game: &mut Game, action: Action) {
    game.step(&[Input { tick: game.tick(), seat: 0, action }]);
}

/// A game on its first ball, with balls at rest in these places: their ids are 1, 2, ...
fn with_balls(table: Arc<Table>, places: &[DVec2]) -> Game {
    let mut game = Game::new(table);
    act(&mut game, Action::Sit);
    act(&mut game, Action::Start);
    while game.world().state().balls.is_empty() {
        game.step(&[]);
    }
    let mut state = game.state();
    let start = Instant::start_of(state.world.tick);
    let acceleration = game.table().scene.gravity;
    let ball = |(place, &position): (usize, &DVec2)| Ball {
        id: place as u32 + 1,
        kind: 0,
        floor: 0,
        flight: Flight { start, position, velocity: DVec2::ZERO, acceleration },
        spin: 0.0,
        support: Support::None,
        slide: None,
        past: None,
    };
    state.world.balls = places.iter().enumerate().map(ball).collect();
    state.world.served = places.len() as u32 + 1;
    assert_eq!(game.restore(state), Ok(()));
    game
}

/// What was done about stuck balls within so many seconds, and in which second.
fn rescues(game: &mut Game, seconds: u64) -> Vec<(u64, GameEventKind)> {
    let begin = game.tick();
    let mut found = Vec::new();
    while game.tick() < begin + 1000 * seconds {
        let told = game.step(&[]).iter().filter(|event| matches!(event.kind, GameEventKind::Rescued { .. }));
        found.extend(told.map(|event| ((event.tick + 1 - begin) / 1000, event.kind)));
    }
    found
}

fn ids(game: &Game) -> Vec<u32> {
    game.world().state().balls.iter().map(|ball| ball.id).collect()
}

#[test]
fn a_ball_on_a_level_wall_is_served_again_after_the_kickers_did_not_help() {
    let mut game = with_balls(table(PLUNGER), &[SHELF]);
    assert_eq!(rescues(&mut game, 20), [(8, KICKERS), (12, RELAUNCH)]);
    assert_eq!(ids(&game), [2], "it waits at the plunger");
    assert_eq!(rescues(&mut game, 100), [], "where it may wait for ever");
}

#[test]
fn a_ball_that_lies_on_a_slingshot_is_kicked_off_and_goes_on() {
    let mut game = with_balls(table(PLUNGER), &[SLING]);
    assert_eq!(rescues(&mut game, 7), []);
    let points = game.seats()[0].score.points;
    assert_eq!(rescues(&mut game, 2), [(1, KICKERS)]);
    assert_eq!(game.seats()[0].score.points, points, "a search makes no points");
    let (_, velocity) = game.world().state().balls[0].at(Instant::start_of(game.tick()), 0.001);
    assert!(velocity.length() > 0.1, "{velocity}");
    assert_eq!(ids(&game), [1], "the same ball");
}

#[test]
fn a_ball_on_top_of_a_post_is_served_again() {
    let mut game = with_balls(table(PLUNGER), &[ON_POST]);
    assert_eq!(rescues(&mut game, 20), [(8, KICKERS), (12, RELAUNCH)]);
    assert_eq!(ids(&game), [2]);
}

#[test]
fn a_ball_between_a_bumper_and_a_wall_is_kicked_out() {
    let mut game = with_balls(table(PLUNGER), &[IN_NOOK]);
    let found = rescues(&mut game, 40);
    assert!((8..10).contains(&found[0].0) && found[0].1 == KICKERS, "{found:?}");
    let (position, velocity) = game.world().state().balls[0].at(Instant::start_of(game.tick()), 0.001);
    assert!(
        (position - IN_NOOK).length() > 0.05 || velocity.length() > 0.1,
        "it is out: {position}, {velocity}, {found:?}"
    );
}

#[test]
fn of_two_balls_only_the_stuck_one_is_served_again() {
    let mut game = with_balls(table(PLUNGER), &[BOUNCE, SHELF]);
    assert_eq!(rescues(&mut game, 20), [(8, KICKERS), (12, RELAUNCH)]);
    assert_eq!(ids(&game), [1, 3], "the bouncing one is still there");
}

#[test]
fn a_ball_at_the_plunger_hides_no_stuck_one_which_waits_until_the_plunger_is_free() {
    let mut game = with_balls(table(PLUNGER), &[PLUNGER, SHELF]);
    assert_eq!(rescues(&mut game, 20), [(8, KICKERS)]);
    assert_eq!(ids(&game), [1, 2]);
    act(&mut game, Action::Pull(u16::MAX));
    assert_eq!(rescues(&mut game, 1), []);
    act(&mut game, Action::Release);
    let told = rescues(&mut game, 1);
    assert_eq!(told, [(0, RELAUNCH)]);
    assert!(ids(&game).contains(&3), "{:?}", ids(&game));
}

#[test]
fn a_ball_in_the_cradle_of_a_held_flipper_is_not_stuck_and_hides_no_other() {
    let Some(Ok(classic)) = Table::shipped("classic") else { panic!("it is shipped") };
    let mut game = with_balls(Arc::new(classic), &[DVec2::new(0.165, 0.205), DVec2::new(0.0135, 0.0135)]);
    act(&mut game, Action::Flipper { right: false, pressed: true });
    // The press was a tick, too.
    assert_eq!(rescues(&mut game, 20), [(7, KICKERS), (11, RELAUNCH)]);
    assert_eq!(ids(&game), [1, 3]);
    // The new one waits at the plunger; the player may keep theirs.
    assert_eq!(rescues(&mut game, 35), []);
    act(&mut game, Action::Flipper { right: true, pressed: true });
    assert_eq!(rescues(&mut game, 55), [], "somebody is there");
    assert_eq!(ids(&game), [1, 3]);
}

#[test]
fn a_ball_to_which_nothing_happens_though_it_moves_is_served_again() {
    let mut game = with_balls(table(PLUNGER), &[BOUNCE]);
    assert_eq!(rescues(&mut game, 80), [(60, KICKERS), (64, RELAUNCH)]);
}

#[test]
fn kickers_that_only_send_it_back_are_not_fired_for_ever() {
    // Dead, and without a kick that would be one: the ball is thrown up by 1 mm and lies there again.
    let table = table(SLING);
    let text = table.source.replace("kick: 0.5", "kick: 0.04");
    let table = Arc::new(Table::parse("traps.ron", &text).unwrap_or_else(|error| panic!("{error}")));
    let mut game = with_balls(table, &[SLING]);
    let told: Vec<_> = rescues(&mut game, 40).into_iter().map(|(_, kind)| kind).collect();
    assert_eq!(told, [KICKERS, KICKERS, KICKERS, RELAUNCH]);
}

#[test]
fn a_replay_and_a_restored_game_rescue_at_the_same_ticks() {
    // It is served onto the shelf, again and again.
    let table = table(SHELF + DVec2::new(0.0, 0.05));
    let mut game = Game::new(Arc::clone(&table));
    let mut recorder = Recorder::new(&table, 0);
    let mut copy = Game::new(Arc::clone(&table));
    let mut told = Vec::new();
    while game.tick() < 60_000 {
        let tick = game.tick();
        let actions = if tick == 0 { &[Action::Sit, Action::Start][..] } else { &[] };
        let inputs: Vec<_> = actions.iter().map(|&action| Input { tick, seat: 0, action }).collect();
        if tick.is_multiple_of(2_917) {
            assert_eq!(copy.restore(game.state()), Ok(()));
        }
        game.step(&inputs);
        copy.step(&inputs);
        recorder.after_step(&game, &inputs);
        assert_eq!(copy.events(), game.events(), "tick {tick}");
        told.extend(game.events().iter().filter(|event| matches!(event.kind, GameEventKind::Rescued { .. })).copied());
        if tick.is_multiple_of(101) {
            assert_eq!(copy.digest(), game.digest(), "tick {tick}");
        }
    }
    let kinds: Vec<_> = told.iter().map(|event| event.kind).collect();
    assert_eq!(kinds, [KICKERS, RELAUNCH, KICKERS, RELAUNCH, KICKERS, RELAUNCH, RELAUNCH]);
    let log = recorder.finish(&game).unwrap_or_else(|error| panic!("{error}"));
    let log = Replay::parse("game", &log.to_text()).unwrap_or_else(|error| panic!("{error}"));
    let mut again = Vec::new();
    let end = log.play(table, |game| {
        again.extend(game.events().iter().filter(|event| matches!(event.kind, GameEventKind::Rescued { .. })).copied());
    });
    assert_eq!(end.unwrap_or_else(|error| panic!("{error}")).digest(), game.digest());
    assert_eq!(again, told);
}
