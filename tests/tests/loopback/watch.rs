//! Watching, joining late, lagging behind.

use shared::game::{GameEventKind, Phase};
use shared::protocol::{Role, Stream};
use starball_server::Config;

use crate::harness::{Client, Server, Wire, classic, quiet};

#[tokio::test]
async fn spectators_see_the_same_game_bit_for_bit() {
    let server = Server::start(Config::new(classic())).await;
    let mut first = Client::watch(&server, "first").await;
    first.until("the bot plays", |c| matches!(c.game.phase(), Phase::Play { serve_in: 0, .. })).await;
    // The second one joins in mid-game and must see what the first one sees.
    let mut second = Client::watch(&server, "second").await;
    second.snapshot().await;
    let mut compared = 0;
    while compared < 30 {
        if first.game.tick() < second.game.tick() {
            first.snapshot().await;
        } else {
            second.snapshot().await;
        }
        if first.game.tick() == second.game.tick() {
            assert_eq!(first.game.digest(), second.game.digest());
            compared += 1;
        }
    }
    assert_eq!(first.roster.places[0].as_deref(), Some("BOT"));
    server.stop().await;
}

#[tokio::test]
async fn a_spectator_that_steps_its_own_copy_stays_right_between_snapshots() {
    let server = Server::start(quiet()).await;
    let mut ann = Client::play(&server, "Ann").await;
    ann.until("the ball is served", |c| matches!(c.game.phase(), Phase::Play { serve_in: 0, .. })).await;
    // Nobody presses anything, so the game is a function of the snapshot alone.
    ann.snapshot().await;
    let mut copy = ann.game.clone();
    copy.restore(ann.game.state()).expect("a valid state");
    for _ in 0..20 {
        ann.snapshot().await;
        while copy.tick() < ann.game.tick() {
            copy.step(&[]);
        }
        assert_eq!(copy.digest(), ann.game.digest());
    }
    server.stop().await;
}

#[tokio::test]
async fn a_slow_spectator_costs_the_others_nothing_and_catches_up() {
    let mut config = quiet();
    config.attract = true;
    config.send_buffer = 4096;
    let server = Server::start(config).await;
    let mut ann = Client::watch(&server, "Ann").await;
    ann.until("the bot plays", |ann| matches!(ann.game.phase(), Phase::Play { serve_in: 0, .. })).await;
    // These read nothing but their welcome, and there is hardly any room for what they do not read.
    let mut sleepers = Vec::new();
    for n in 0..20 {
        let wire = Wire::open_narrow(&server).await;
        sleepers.push(Client::join(wire, &format!("sleeper {n}"), Role::Watch, Stream::PLAYER).await);
    }
    // Meanwhile the others miss nothing: each snapshot is a sixtieth of a second after the one before. And what the
    // sleepers miss is not only snapshots: somebody sits down.
    let mut bob = None;
    let mut last = ann.snapshot().await.tick;
    for n in 0..240 {
        if n == 100 {
            bob = Some(Client::play(&server, "Bob").await);
        }
        let tick = ann.snapshot().await.tick;
        assert!((16..=17).contains(&(tick - last)), "{} ticks between two snapshots", tick - last);
        last = tick;
    }
    let mut sleeper = sleepers.remove(0);
    while sleeper.game.tick() < last {
        sleeper.snapshot().await;
    }
    assert_eq!(sleeper.mismatches, 0, "it got all, or jumped to a full snapshot");
    sleeper.until("it knows who plays", |c| c.roster.places[0].as_deref() == Some("Bob")).await;
    drop(bob);
    server.stop().await;
}

#[tokio::test]
async fn events_come_with_their_ticks() {
    let server = Server::start(Config::new(classic())).await;
    let mut ann = Client::watch(&server, "Ann").await;
    let mut last = 0;
    let mut served = false;
    while !served {
        let snapshot = ann.snapshot().await;
        for event in &snapshot.events {
            assert!(event.tick >= last && event.tick <= snapshot.tick);
            last = event.tick;
            served |= matches!(event.kind, GameEventKind::Served { seat: 0, ball: 1 });
        }
    }
    server.stop().await;
}
