//! Games on Classic: turns, seats, rules, the bot, and a copy of a game that goes on from its state.

use std::sync::Arc;

use glam::DVec2;

use super::{Action, Bot, Game, GameEventKind, Input, Phase, Rescue, SEATS};
use crate::physics::ball::Instant;
use crate::rules::BallSave;
use crate::table::{ElementFile, Table};

const RELAUNCH: GameEventKind = GameEventKind::Rescued { by: Rescue::Relaunch };

fn classic() -> Arc<Table> {
    match Table::shipped("classic") {
        Some(Ok(table)) => Arc::new(table),
        other => panic!("{other:?}"),
    }
}

/// A game with these seats taken and started.
fn started(seats: u8) -> Game {
    let mut game = Game::new(classic());
    for seat in 0..seats {
        act(&mut game, seat, Action::Sit);
    }
    act(&mut game, 0, Action::Start);
    game
}

/// One tick in which one seat does something; what happened in it.
fn act(game: &mut Game, seat: u8, action: Action) -> Vec<GameEventKind> {
    let input = Input { tick: game.tick(), seat, action };
    game.step(&[input]).iter().map(|event| event.kind).collect()
}

fn wait(game: &mut Game, ticks: u32) -> Vec<GameEventKind> {
    (0..ticks).flat_map(|_| game.step(&[]).iter().map(|event| event.kind).collect::<Vec<_>>()).collect()
}

/// Waits until a ball is in play, and returns whose and which.
fn wait_for_ball(game: &mut Game) -> (u8, u32) {
    for _ in 0..10_000 {
        if let Phase::Play { seat, ball, serve_in: 0, .. } = game.phase() {
            return (seat, ball);
        }
        game.step(&[]);
    }
    panic!("no ball: {:?}", game.phase())
}

fn element(game: &Game, name: &str) -> u16 {
    let place = game.table().file.elements.iter().position(|element| element.name() == name);
    place.unwrap_or_else(|| panic!("Classic has no {name}")) as u16
}

/// Puts the ball in play somewhere else, at some velocity: through the state, as a save that was edited. When it is lost then,
/// it is lost.
fn place_ball(game: &mut Game, position: DVec2, velocity: DVec2) {
    let mut state = game.state();
    let tick = state.world.tick;
    let ball = &mut state.world.balls[0];
    ball.flight.start = Instant::start_of(tick);
    (ball.flight.position, ball.flight.velocity) = (position, velocity);
    ball.flight.acceleration = game.table().scene.gravity;
    (ball.support, ball.past, ball.spin) = (crate::physics::ball::Support::None, None, 0.0);
    state.play.rules.save = BallSave::default();
    assert_eq!(game.restore(state), Ok(()));
}

/// Lets the ball fall between the flippers.
fn lose_ball(game: &mut Game) -> Vec<GameEventKind> {
    wait_for_ball(game);
    place_ball(game, DVec2::new(0.237, 0.1), DVec2::new(0.0, -1.0));
    wait(game, 100)
}

/// Sends the ball up through the middle of a rollover.
fn pass(game: &mut Game, name: &str) -> Vec<GameEventKind> {
    wait_for_ball(game);
    let ElementFile::Rollover(line) = &game.table().file.elements[usize::from(element(game, name))] else {
        panic!("{name} is no rollover")
    };
    let middle = 0.5 * (DVec2::from(line.from) + DVec2::from(line.to));
    place_ball(game, middle - DVec2::new(0.0, 0.001), DVec2::new(0.0, 0.5));
    wait(game, 4)
}

/// Sends the ball head-on into a drop target, fast.
fn hit_target(game: &mut Game, name: &str) -> Vec<GameEventKind> {
    wait_for_ball(game);
    let ElementFile::DropTarget(face) = &game.table().file.elements[usize::from(element(game, name))] else {
        panic!("{name} is no target")
    };
    let (from, to) = (DVec2::from(face.from), DVec2::from(face.to));
    let out = crate::math::tangent((to - from).normalize());
    place_ball(game, 0.5 * (from + to) + out * 0.015, -out);
    wait(game, 3)
}

#[test]
fn two_players_alternate_ball_by_ball_until_each_had_three() {
    let mut game = started(2);
    let mut turns = Vec::new();
    while matches!(game.phase(), Phase::Play { .. }) {
        turns.push(wait_for_ball(&mut game));
        let seat = turns[turns.len() - 1].0;
        assert!(lose_ball(&mut game).contains(&GameEventKind::Lost { seat }));
        assert!(turns.len() < 20, "{turns:?}");
    }
    assert_eq!(turns, [(0, 1), (1, 1), (0, 2), (1, 2), (0, 3), (1, 3)]);
    assert_eq!(game.phase(), Phase::Over);
    assert!(game.world().state().balls.is_empty());
    assert!(act(&mut game, 1, Action::Start).contains(&GameEventKind::Started), "whoever sits may start again");
    assert_eq!(wait_for_ball(&mut game), (0, 1));
}

#[test]
fn one_player_has_three_balls_and_a_new_game_starts_at_zero() {
    let mut game = started(1);
    for ball in 1..=3 {
        assert_eq!(wait_for_ball(&mut game), (0, ball));
        pass(&mut game, "left orbit");
        lose_ball(&mut game);
    }
    assert_eq!(game.phase(), Phase::Over);
    let points = game.seats()[0].score.points;
    assert!(points >= 3 * 600, "three passes of 500 and a bonus of 100 each, not {points}");
    act(&mut game, 0, Action::Start);
    assert_eq!(game.seats()[0].score.points, 0);
}

#[test]
fn only_the_player_whose_turn_it_is_moves_flippers_and_plunger() {
    let mut game = started(2);
    assert_eq!(wait_for_ball(&mut game), (0, 1));
    let press = Action::Flipper { right: false, pressed: true };
    assert_eq!(act(&mut game, 1, press), []);
    act(&mut game, 1, Action::Pull(u16::MAX));
    assert!(game.world().state().flippers.iter().all(|flipper| !flipper.pressed));
    assert_eq!(game.world().state().plungers[0].hand, None);
    assert_eq!(act(&mut game, 0, press), [GameEventKind::Flipped { right: false }]);
    act(&mut game, 0, Action::Pull(u16::MAX));
    assert!(game.world().state().flippers[0].pressed && !game.world().state().flippers[1].pressed);
    assert_eq!(game.world().state().plungers[0].hand, Some(1.0));
    act(&mut game, 9, press);
    assert_eq!(game.seats().len(), SEATS, "a seat that is not there does nothing");
}

#[test]
fn inputs_for_other_ticks_are_not_this_ticks() {
    let mut game = Game::new(classic());
    let early = Input { tick: game.tick() + 1, seat: 0, action: Action::Sit };
    game.step(&[early]);
    assert!(!game.seats()[0].taken);
    game.step(&[early]);
    assert!(game.seats()[0].taken);
}

#[test]
fn a_player_who_stands_up_in_mid_turn_loses_the_turn_and_the_game_goes_on() {
    let mut game = started(2);
    wait_for_ball(&mut game);
    act(&mut game, 0, Action::Flipper { right: true, pressed: true });
    assert!(act(&mut game, 0, Action::Stand).contains(&GameEventKind::StoodUp { seat: 0 }));
    assert!(game.world().state().balls.is_empty(), "the ball is taken out");
    assert!(game.world().state().flippers.iter().all(|flipper| !flipper.pressed), "no button stays pressed");
    for ball in 1..=3 {
        assert_eq!(wait_for_ball(&mut game), (1, ball));
        lose_ball(&mut game);
    }
    assert_eq!(game.phase(), Phase::Over);
}

#[test]
fn a_turn_that_is_given_up_pays_its_bonus_and_keeps_seat_and_score() {
    let mut game = started(2);
    assert_eq!(act(&mut game, 0, Action::Forfeit)[0], GameEventKind::Forfeited { seat: 0 }, "before it is served");
    assert_eq!(wait_for_ball(&mut game), (1, 1));
    assert_eq!(act(&mut game, 0, Action::Forfeit), [], "it is not theirs to give up");
    // From the plunger, and from the middle of the table.
    assert!(act(&mut game, 1, Action::Forfeit).contains(&GameEventKind::Forfeited { seat: 1 }));
    assert!(game.world().state().balls.is_empty() && game.seats()[1].playing);
    assert_eq!(wait_for_ball(&mut game), (0, 2));
    pass(&mut game, "left orbit");
    let score = game.seats()[0].score;
    let told = act(&mut game, 0, Action::Forfeit);
    let paid = GameEventKind::Points { seat: 0, points: score.bonus, place: None };
    assert!(score.bonus > 0 && told.contains(&paid), "{told:?}");
    assert_eq!(game.seats()[0].score, super::rules::Score { points: score.points + score.bonus, ..Default::default() });
    for turn in [(1, 2), (0, 3), (1, 3)] {
        assert_eq!(wait_for_ball(&mut game), turn);
        act(&mut game, turn.0, Action::Forfeit);
    }
    assert_eq!(game.phase(), Phase::Over);
    assert_eq!(act(&mut game, 1, Action::Forfeit), []);
    assert!(!Action::Forfeit.is_control());
}

#[test]
fn up_to_four_players_alternate() {
    let mut game = started(SEATS as u8);
    let mut turns = Vec::new();
    while matches!(game.phase(), Phase::Play { .. }) {
        turns.push(wait_for_ball(&mut game));
        lose_ball(&mut game);
    }
    let expected: Vec<_> = (1..=3).flat_map(|ball| (0..4).map(move |seat| (seat, ball))).collect();
    assert_eq!(turns, expected);
}

#[test]
fn a_player_who_stands_up_in_anothers_turn_is_left_out_from_then_on() {
    let mut game = started(2);
    wait_for_ball(&mut game);
    act(&mut game, 1, Action::Stand);
    for ball in 1..=3 {
        assert_eq!(wait_for_ball(&mut game), (0, ball), "the turn goes on undisturbed");
        lose_ball(&mut game);
    }
    assert_eq!(game.phase(), Phase::Over);
}

#[test]
fn the_game_is_over_when_the_last_player_stands_up() {
    let mut game = started(1);
    wait_for_ball(&mut game);
    assert!(act(&mut game, 0, Action::Stand).contains(&GameEventKind::Over));
    assert_eq!(game.phase(), Phase::Over);
    act(&mut game, 0, Action::Start);
    assert_eq!(game.phase(), Phase::Over, "nobody who stands can start");
}

#[test]
fn a_player_joins_only_before_anything_has_happened() {
    let mut game = started(1);
    wait_for_ball(&mut game);
    assert!(game.is_at_start());
    act(&mut game, 1, Action::Sit);
    assert!(game.seats()[1].playing, "the first ball lies on the plunger: there is time to join");

    let mut game = started(1);
    pass(&mut game, "left orbit");
    assert!(!game.is_at_start());
    act(&mut game, 1, Action::Sit);
    assert!(game.seats()[1].taken && !game.seats()[1].playing, "seated, but not in this game");
    lose_ball(&mut game);
    assert_eq!(wait_for_ball(&mut game), (0, 2));
    act(&mut game, 0, Action::Stand);
    act(&mut game, 1, Action::Start);
    assert_eq!(wait_for_ball(&mut game), (1, 1), "but in the next");
}

#[test]
fn a_seat_that_is_taken_cannot_be_taken_again() {
    let mut game = started(1);
    pass(&mut game, "left orbit");
    let before = game.seats()[0];
    assert_eq!(act(&mut game, 0, Action::Sit), []);
    assert_eq!(game.seats()[0], before);
}

#[test]
fn all_three_lanes_raise_the_multiplier_up_to_six() {
    let mut game = started(1);
    for round in 1..=7_u32 {
        let lanes = ["lane 1", "lane 2", "lane 3"];
        for (place, lane) in lanes.into_iter().enumerate() {
            assert_eq!(game.seats()[0].score.multiplier, round.min(6), "before {lane}");
            let before = game.seats()[0].score.points;
            let events = pass(&mut game, lane);
            let last = place == 2;
            let most = if last && round > 5 { 10_000 } else { 0 };
            let expected = 250 + most + if last { 1000 } else { 0 };
            assert_eq!(game.seats()[0].score.points - before, expected, "{lane}: {events:?}");
            let text = if round > 5 { "LANES 10000".to_owned() } else { format!("BONUS X{}", round + 1) };
            let told = events.iter().any(|event| {
                matches!(event, GameEventKind::Message { place } if game.table().rules.messages[usize::from(*place)] == text)
            });
            assert_eq!(told, last, "{text}");
        }
    }
    assert_eq!(game.seats()[0].score.multiplier, 6);
}

#[test]
fn the_bonus_times_the_multiplier_is_paid_at_the_balls_end() {
    let mut game = started(1);
    for lane in ["lane 1", "lane 2", "lane 3"] {
        pass(&mut game, lane);
    }
    pass(&mut game, "left orbit");
    pass(&mut game, "right orbit");
    let score = game.seats()[0].score;
    assert_eq!((score.bonus, score.multiplier), (200, 2));
    let events = lose_ball(&mut game);
    let after = game.seats()[0].score;
    assert_eq!((after.points - score.points, after.bonus, after.multiplier), (400, 0, 1));
    assert!(events.contains(&GameEventKind::Points { seat: 0, points: 400, place: None }));
}

#[test]
fn a_bank_that_is_down_pays_and_rises() {
    let mut game = started(1);
    let bank = ["drop 3", "drop 1", "drop 4", "drop 2"];
    for (place, name) in bank.into_iter().enumerate() {
        let before = game.seats()[0].score;
        let events = hit_target(&mut game, name);
        let after = game.seats()[0].score;
        let felled = events.iter().any(|event| matches!(event, GameEventKind::Felled { .. }));
        assert!(felled, "{name}: {events:?}");
        let (points, bonus) = if place == 3 { (5300, 2100) } else { (300, 100) };
        assert_eq!((after.points - before.points, after.bonus - before.bonus), (points, bonus), "{name}");
    }
    wait(&mut game, 200);
    // What the crowd may raise stays down.
    let as_it_was = crate::physics::World::new(Arc::clone(&game.table().scene)).state().targets.clone();
    assert_eq!(game.world().state().targets, as_it_was);
}

#[test]
fn a_ball_that_lies_still_is_served_again() {
    let mut game = started(1);
    wait_for_ball(&mut game);
    assert!(!wait(&mut game, 20_000).contains(&RELAUNCH), "not from the plunger");
    // In the corner of the floor, under the drain.
    place_ball(&mut game, DVec2::new(0.0135, 0.0135), DVec2::ZERO);
    let events = wait(&mut game, 13_000);
    assert_eq!(events.iter().filter(|event| **event == RELAUNCH).count(), 1, "{events:?}");
    assert_eq!(wait_for_ball(&mut game), (0, 1), "the turn is still theirs");
}

/// Plays with the bot; `each` sees the game before every tick with the inputs of that tick.
fn play(seed: u64, ticks: u64, mut each: impl FnMut(&Game, &[Input])) -> Game {
    let mut game = Game::new(classic());
    let mut bot = Bot::new(0, seed);
    let mut inputs = Vec::new();
    while game.tick() < ticks {
        let tick = game.tick();
        inputs.clear();
        if tick == 0 {
            inputs.push(Input { tick, seat: 0, action: Action::Sit });
        }
        if !matches!(game.phase(), Phase::Play { .. }) {
            inputs.push(Input { tick, seat: 0, action: Action::Start });
        }
        bot.play(&game, |action| inputs.push(Input { tick, seat: 0, action }));
        each(&game, &inputs);
        game.step(&inputs);
    }
    game
}

#[test]
fn the_bot_scores_and_plays_the_same_from_the_same_seed() {
    let mut digests = Vec::new();
    for seed in 0..10 {
        let mut most = 0;
        let game = play(seed, 60_000, |game, _| most = game.seats()[0].score.points.max(most));
        assert!(most > 0, "seed {seed} scored nothing in a minute");
        digests.push(game.digest());
    }
    let first = play(0, 60_000, |_, _| ()).digest();
    assert_eq!(first, digests[0]);
    digests.sort_unstable();
    digests.dedup();
    assert_eq!(digests.len(), 10, "different seeds play differently");
}

/// The sync test: every so often a new copy is made from the state, and all copies must keep up with the original.
#[test]
fn a_game_restored_at_any_moment_goes_on_bit_for_bit() {
    const COPIES: usize = 5;
    for seed in 0..3 {
        let table = classic();
        let mut copies: Vec<Game> = Vec::new();
        play(seed, 40_000, |game, inputs| {
            let digest = game.digest();
            for copy in &copies {
                assert_eq!(copy.digest(), digest, "seed {seed}, tick {}", game.tick());
                assert_eq!(copy.events(), game.events(), "seed {seed}, tick {}", game.tick());
            }
            if game.tick().is_multiple_of(7) {
                let mut copy = Game::new(Arc::clone(&table));
                assert_eq!(copy.restore(game.state()), Ok(()));
                assert_eq!(copy.digest(), digest);
                // One of the copies is kept for a long time, the others are made anew in turn.
                if copies.len() < COPIES {
                    copies.push(copy);
                } else {
                    copies[1 + game.tick() as usize / 7 % (COPIES - 1)] = copy;
                }
            }
            for copy in &mut copies {
                copy.step(inputs);
            }
        });
    }
}

#[test]
fn a_state_with_a_turn_of_nobody_is_refused() {
    let mut game = started(1);
    let before = game.digest();
    let mut state = game.state();
    state.play = super::sample_play(Phase::Play {
        seat: 9,
        ball: 1,
        serve_in: 0,
        untouched: false,
        still: 0,
        watched: 0,
        quiet: 0,
        searches: 0,
        extra: 0,
    });
    assert!(game.restore(state).is_err());
    assert_eq!(game.digest(), before);
}

/// Whoever sat down before the seat whose turn it was got one ball fewer.
#[test]
fn nobody_joins_before_the_seat_whose_turn_it_is() {
    let mut game = started(2);
    wait_for_ball(&mut game);
    act(&mut game, 0, Action::Stand);
    assert!(game.phase().has_turn(1));
    act(&mut game, 0, Action::Sit);
    assert!(!game.seats()[0].playing, "the next game is theirs");
}

#[test]
fn events_bear_the_tick_that_was_played() {
    let mut game = started(1);
    wait_for_ball(&mut game);
    for _ in 0..500 {
        let tick = game.tick();
        let input = Input { tick, seat: 0, action: Action::Flipper { right: false, pressed: tick.is_multiple_of(2) } };
        assert!(game.step(&[input]).iter().all(|event| event.tick == tick), "tick {tick}");
    }
}

#[test]
fn a_ball_that_left_the_table_is_served_again() {
    let mut game = started(1);
    let turn = wait_for_ball(&mut game);
    // Too fast for anything to stop it within the tick that it has.
    place_ball(&mut game, DVec2::new(0.24, 1.079), DVec2::new(0.0, 90.0));
    let events = wait(&mut game, 5);
    assert!(events.contains(&RELAUNCH), "{events:?}");
    assert_eq!(wait_for_ball(&mut game), turn);
    assert_eq!(game.world().state().balls.len(), 1);
}

#[test]
fn a_ball_to_which_nothing_happens_for_a_minute_is_served_again() {
    let mut game = started(1);
    wait_for_ball(&mut game);
    act(&mut game, 0, Action::Flipper { right: false, pressed: true });
    // In a cradle: on the raised flipper, in the corner at its pivot. A player may keep it there, but not for ever.
    place_ball(&mut game, DVec2::new(0.165, 0.205), DVec2::ZERO);
    let events = wait(&mut game, 59_000);
    assert!(!events.contains(&RELAUNCH));
    assert!(wait(&mut game, 6_000).contains(&RELAUNCH));
}
