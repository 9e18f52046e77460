//! Nonsense, floods and silence: they cost their sender the connection and nobody else anything.

use std::time::{Duration, Instant};

use shared::game::{Action, Phase};
use shared::protocol::{ClientMessage, Form, Hello, Mode, Role, ServerMessage, Stream, encode, encode_greeting};
use tokio::io::AsyncWriteExt;

use crate::harness::{Client, Server, Wire, quiet};

async fn let_in(server: &Server) -> Wire {
    let mut wire = Wire::open(server).await;
    wire.send(encode_greeting(&Hello { name: "Eve".to_owned(), role: Role::Watch, stream: Stream::PLAYER })).await;
    wire.receive().await.expect("a welcome");
    wire
}

#[tokio::test]
async fn a_frame_of_nonsense_ends_the_session_with_a_reason() {
    let server = Server::start(quiet()).await;
    let mut ann = Client::watch(&server, "Ann").await;
    for nonsense in [vec![200, 1, 2, 3], Vec::new(), [encode(&ClientMessage::Leave), vec![0]].concat()] {
        let mut eve = let_in(&server).await;
        eve.send(nonsense).await;
        assert!(eve.goodbye().await.contains("cannot be read"));
        assert!(eve.receive().await.is_none(), "then the connection ends");
    }
    ann.snapshot().await;
    assert_eq!(server.stop().await.illegal, 3);
}

#[tokio::test]
async fn a_frame_larger_than_allowed_is_refused_unread() {
    let server = Server::start(quiet()).await;
    let mut eve = let_in(&server).await;
    // Only the length: two megabytes. The server must not wait for them, let alone make room.
    eve.stream.write_all(&[0xff, 0xff, 0x7f]).await.expect("sent");
    assert!(eve.goodbye().await.contains("frame size too big"));
    server.stop().await;
}

#[tokio::test]
async fn whoever_has_no_seat_works_no_controls() {
    let server = Server::start(quiet()).await;
    let flip = Action::Flipper { right: false, pressed: true };
    let mut eve = let_in(&server).await;
    eve.send(encode(&ClientMessage::Act { tick: 0, action: flip })).await;
    assert!(eve.goodbye().await.contains("not for a client"));

    let mut ann = Client::play(&server, "Ann").await;
    ann.until("she is seated", |ann| ann.place == Some(0)).await;
    ann.act(Action::Sit).await;
    assert!(ann.wire.goodbye().await.contains("not for a client"), "nor does a player seat anybody");
    server.stop().await;
}

#[tokio::test]
async fn a_flood_of_controls_is_bounded_and_hurts_nobody() {
    let server = Server::start(quiet()).await;
    let mut ann = Client::watch(&server, "Ann").await;
    let mut eve = Client::play(&server, "Eve").await;
    eve.until("she is seated", |eve| eve.place == Some(0)).await;
    let (began, before) = (Instant::now(), ann.snapshot().await.tick);
    for n in 0..20_000_u64 {
        let action = Action::Flipper { right: n % 3 == 0, pressed: n % 2 == 0 };
        eve.say(ClientMessage::Act { tick: u64::MAX - n, action }).await;
    }
    for _ in 0..30 {
        ann.snapshot().await;
    }
    // World time keeps up with the clock: what was given up for lateness would be missing.
    let (ticks, milliseconds) = (ann.game.tick() - before, began.elapsed().as_millis() as u64);
    assert!(ticks + 100 >= milliseconds / 2, "{ticks} ticks in {milliseconds} ms");
    let account = server.stop().await;
    assert!(account.controls < 10_000, "most were dropped: {account}");
}

#[tokio::test]
async fn a_flood_of_leaves_does_not_drown_the_others() {
    let server = Server::start(quiet()).await;
    let mut ann = Client::watch(&server, "Ann").await;
    let mut eve = Client::watch(&server, "Eve").await;
    ann.until("both are there", |ann| ann.roster.spectators == 2).await;
    for _ in 0..5_000 {
        eve.say(ClientMessage::Play).await;
        eve.say(ClientMessage::Leave).await;
    }
    let (mut rosters, mut snapshots) = (0, 0);
    while snapshots < 60 {
        match ann.hear().await {
            ServerMessage::Change(_) => snapshots += 1,
            ServerMessage::Roster(_) => rosters += 1,
            _ => {}
        }
    }
    assert!(rosters <= snapshots + 1, "{rosters} rosters with {snapshots} snapshots");
    server.stop().await;
}

/// Each of these is valid, and was heeded as often as it was said.
#[tokio::test]
async fn a_flood_of_valid_messages_is_answered_in_moderation() {
    let mut config = quiet();
    config.mode = Mode::Crowd;
    config.most_messages = 250;
    let server = Server::start(config).await;
    let mut ann = Client::watch(&server, "Ann").await;
    let _bob = Client::play(&server, "Bob").await;
    let mut eve = Client::watch(&server, "Eve").await;
    ann.until("all are there", |ann| ann.roster.spectators == 2).await;
    let before = ann.snapshot().await.tick;
    let began = Instant::now();
    let answers = tokio::spawn(async move {
        let (mut fulls, mut pongs, mut places) = (0, 0, 0);
        for n in 0..80_u64 {
            let stream = Stream { form: Form::State, hz: if n % 2 == 0 { 30 } else { 60 } };
            let flood = [
                ClientMessage::Stream(stream),
                ClientMessage::Differs { tick: n, digest: 0 },
                ClientMessage::Play,
                ClientMessage::Leave,
                ClientMessage::Vote { action: (n % 5) as u8 },
                ClientMessage::Ping { nonce: n },
            ];
            for message in flood {
                eve.say(message).await;
            }
            tokio::time::sleep(Duration::from_millis(25)).await;
            let mut count = |message| match message {
                ServerMessage::Full(_) => fulls += 1,
                ServerMessage::Pong { .. } => pongs += 1,
                ServerMessage::You { .. } => places += 1,
                _ => {}
            };
            while let Ok(message) = tokio::time::timeout(Duration::from_millis(1), eve.hear()).await {
                count(message);
            }
        }
        (fulls, pongs, places)
    });
    let (fulls, pongs, places) = answers.await.expect("she is not sent away");
    let seconds = began.elapsed().as_secs_f64();
    assert!(f64::from(fulls) <= 2.0 + seconds, "{fulls} full snapshots in {seconds} s");
    assert!(f64::from(pongs) <= 41.0 + 20.0 * seconds && pongs > 0, "{pongs} pongs in {seconds} s");
    assert!(f64::from(places) <= 4.0 + 4.0 * seconds, "{places} answers about places in {seconds} s");
    while ann.snapshot().await.tick < before + (seconds * 1000.0) as u64 {}
    assert_eq!((ann.mismatches, server.stop().await.illegal), (0, 0));
}

#[tokio::test]
async fn a_player_who_says_nothing_loses_the_seat() {
    let mut config = quiet();
    config.silent_time = Duration::from_millis(500);
    let server = Server::start(config).await;
    // Eve's machine sleeps with the connection open; Ann's pings, as every client does.
    let mut eve = Client::play(&server, "Eve").await;
    eve.until("she is seated", |eve| eve.place == Some(0)).await;
    let mut ann = Client::watch(&server, "Ann").await;
    ann.until("Eve is there", |ann| ann.roster.places[0].as_deref() == Some("Eve")).await;
    while ann.roster.places[0].is_some() {
        ann.say(ClientMessage::Ping { nonce: 0 }).await;
        ann.snapshot().await;
    }
    assert_eq!(ann.game.phase(), Phase::Over);
    server.stop().await;
}

#[tokio::test]
async fn a_connection_that_ends_in_mid_frame_is_forgotten() {
    let server = Server::start(quiet()).await;
    let mut ann = Client::watch(&server, "Ann").await;
    let mut eve = let_in(&server).await;
    ann.until("both are there", |ann| ann.roster.spectators == 2).await;
    eve.stream.write_all(&[10, 1, 2]).await.expect("sent");
    drop(eve);
    ann.until("Eve is gone", |ann| ann.roster.spectators == 1).await;
    server.stop().await;
}
