//! Nudges, warnings and the tilt.

use std::sync::Arc;

use super::*;
use crate::table::SHIPPED;

/// Classic with a cabinet that can be nudged, with a ball in play on its plunger.
fn started() -> Game {
    let source = SHIPPED[0].source;
    let source = if source.contains("cabinet:") {
        source.to_owned()
    } else {
        source.replacen("gravity:", "cabinet: (), gravity:", 1)
    };
    let mut game = Game::new(Arc::new(Table::parse("classic.ron", &source).unwrap_or_else(|error| panic!("{error}"))));
    act(&mut game, &[Action::Sit, Action::Start]);
    for _ in 0..1000 {
        game.step(&[]);
    }
    game
}

fn act(game: &mut Game, actions: &[Action]) -> Vec<GameEventKind> {
    let tick = game.tick();
    let inputs: Vec<_> = actions.iter().map(|&action| Input { tick, seat: 0, action }).collect();
    game.step(&inputs).iter().map(|event| event.kind).collect()
}

fn wait(game: &mut Game, ticks: u32) -> Vec<GameEventKind> {
    (0..ticks).flat_map(|_| game.step(&[]).iter().map(|event| event.kind).collect::<Vec<_>>()).collect()
}

#[test]
fn one_nudge_is_no_tilt_and_a_fit_of_them_is() {
    let mut game = started();
    let told = act(&mut game, &[Action::Nudge(Nudge::FromLeft)]);
    assert!(told.contains(&GameEventKind::Nudged { nudge: Nudge::FromLeft }));
    assert_eq!(wait(&mut game, 3000).iter().filter(|kind| matches!(kind, GameEventKind::Warned { .. })).count(), 0);
    let mut told = Vec::new();
    for _ in 0..60 {
        told.extend(act(&mut game, &[Action::Nudge(Nudge::Forward)]));
        told.extend(wait(&mut game, 170));
    }
    let warnings = told.iter().filter(|kind| matches!(kind, GameEventKind::Warned { .. })).count();
    assert_eq!(warnings, 2, "two warnings, and no third");
    assert!(told.contains(&GameEventKind::Tilted { seat: 0 }));
    assert!(game.tilt().tilted);
}

#[test]
fn a_tilted_game_hears_no_button_and_counts_nothing_until_the_next_ball() {
    let mut game = started();
    while !game.tilt().tilted {
        act(&mut game, &[Action::Nudge(Nudge::Forward)]);
        wait(&mut game, 170);
    }
    let points = game.seats()[0].score;
    assert_eq!((points.bonus, points.multiplier), (0, 1));
    act(&mut game, &[Action::Flipper { right: false, pressed: true }]);
    assert!(!game.world().state().flippers[0].pressed);
    wait(&mut game, 20_000);
    assert_eq!(game.seats()[0].score.points, points.points);
    // A turn that is over is another ball's, or another player's: everything works again.
    let seat = act(&mut game, &[Action::Stand, Action::Sit, Action::Start]);
    assert!(seat.contains(&GameEventKind::Started));
    assert!(!game.tilt().tilted);
}

/// The ball lay on the plunger when the game tilted, nothing could launch it, and the game never went on.
#[test]
fn a_ball_on_the_plunger_of_a_tilted_game_can_be_launched_and_lost() {
    let mut game = started();
    while !game.tilt().tilted {
        act(&mut game, &[Action::Nudge(Nudge::Forward)]);
        wait(&mut game, 170);
    }
    for _ in 0..10 {
        act(&mut game, &[Action::Pull(u16::MAX)]);
        wait(&mut game, 1500);
        act(&mut game, &[Action::Release]);
        if wait(&mut game, 20_000).contains(&GameEventKind::Lost { seat: 0 }) {
            assert!(!game.tilt().tilted, "the next ball is another one");
            return;
        }
    }
    panic!("the ball is still in play");
}

#[test]
fn a_replay_of_nudges_arrives_at_the_same_digest() {
    let play = || {
        let mut game = started();
        for nudge in [Nudge::FromLeft, Nudge::FromRight, Nudge::Forward] {
            act(&mut game, &[Action::Nudge(nudge)]);
            wait(&mut game, 333);
        }
        game.digest()
    };
    assert_eq!(play(), play());
}

/// Broke: a game that tilted with its ball on the plunger waited for ever, and the next player inherited a swinging bob.
#[test]
fn a_ball_on_the_plunger_can_be_launched_after_a_tilt_and_the_next_one_begins_with_a_still_bob() {
    let mut game = started();
    while !game.tilt().tilted {
        act(&mut game, &[Action::Nudge(Nudge::Forward)]);
        wait(&mut game, 170);
    }
    act(&mut game, &[Action::Pull(u16::MAX)]);
    wait(&mut game, 800);
    act(&mut game, &[Action::Release]);
    let told = wait(&mut game, 60_000);
    assert!(told.contains(&GameEventKind::Lost { seat: 0 }), "the ball came to its end: {told:?}");
    assert!(
        !told.iter().any(|kind| matches!(kind, GameEventKind::Points { .. } | GameEventKind::Warned { .. })),
        "{told:?}"
    );
    assert!(!game.tilt().tilted);
}

#[test]
fn a_magnet_lets_go_at_a_tilt_and_is_as_it_was_at_the_next_ball() {
    let magnet =
        "elements: [Magnet(name: \"m\", center: (0.237, 0.3), radius: 0.05, core: 0.01, strength: 5.0, on: true),";
    let source = SHIPPED[0].source.replacen("elements: [", magnet, 1);
    let mut game = Game::new(Arc::new(Table::parse("classic.ron", &source).unwrap_or_else(|error| panic!("{error}"))));
    act(&mut game, &[Action::Sit, Action::Start]);
    wait(&mut game, 1000);
    assert_eq!(game.world().state().magnets, [true]);
    while !game.tilt().tilted {
        act(&mut game, &[Action::Nudge(Nudge::Forward)]);
        wait(&mut game, 170);
    }
    assert_eq!(game.world().state().magnets, [false]);
    act(&mut game, &[Action::Stand, Action::Sit, Action::Start]);
    assert_eq!(game.world().state().magnets, [true]);
}
