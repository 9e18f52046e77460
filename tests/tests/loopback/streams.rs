//! Streams: state or inputs, how often, from where, and what happens when a copy is wrong.

use std::time::{Duration, Instant};

use shared::game::{Action, Phase};
use shared::protocol::{ClientMessage, Form, RATES, Role, ServerMessage, Stream, digest_of_room};
use starball_server::Config;

use crate::harness::{Client, Server, Wire, classic, quiet};

fn plays(client: &Client) -> bool {
    matches!(client.game.phase(), Phase::Play { serve_in: 0, .. })
}

#[tokio::test]
async fn every_stream_leads_to_the_same_game_at_every_confirmed_tick() {
    let server = Server::start(Config::new(classic())).await;
    let mut truth = Client::watch(&server, "truth").await;
    truth.until("the bot plays", plays).await;
    for form in [Form::State, Form::Inputs] {
        for hz in RATES {
            let mut ann = Client::watch_stream(&server, "Ann", Stream { form, hz }).await;
            let mut compared = 0;
            while compared < 4 {
                let tick = ann.snapshot().await.tick;
                // At sixty a second there is a snapshot for every frame of any stream.
                while truth.game.tick() < tick {
                    truth.snapshot().await;
                }
                if truth.game.tick() == tick {
                    assert_eq!(ann.game.digest(), truth.game.digest(), "{form:?} at {hz} Hz, tick {tick}");
                    compared += 1;
                }
            }
            assert_eq!(ann.mismatches, 0);
        }
    }
    assert_eq!(server.stop().await.differing, 0);
}

#[tokio::test]
async fn a_stream_comes_as_often_as_it_was_asked_for() {
    let server = Server::start(quiet()).await;
    for hz in RATES {
        let mut ann = Client::watch_stream(&server, "Ann", Stream { form: Form::Inputs, hz }).await;
        let first = ann.snapshot().await.tick;
        let mut last = first;
        for _ in 0..5 {
            last = ann.snapshot().await.tick;
        }
        let expected = 5 * 1000 / u64::from(hz);
        assert!((last - first).abs_diff(expected) <= 1000 / u64::from(hz) + 1, "{hz} Hz: {} ticks", last - first);
    }
    server.stop().await;
}

#[tokio::test]
async fn the_first_picture_comes_with_the_welcome() {
    let server = Server::start(quiet()).await;
    let mut ann = Client::watch_stream(&server, "Ann", Stream::SPECTATOR).await;
    // Ten frames a second, but nobody waits for the first one: it is a full snapshot.
    let began = Instant::now();
    assert!(matches!(ann.hear().await, ServerMessage::Full(_)));
    assert!(began.elapsed() < Duration::from_secs(5));
    assert_eq!(ann.follower.games().len(), 1);
    server.stop().await;
}

#[tokio::test]
async fn a_client_can_change_its_stream_at_any_time() {
    let server = Server::start(Config::new(classic())).await;
    let mut truth = Client::watch(&server, "truth").await;
    truth.until("the bot plays", plays).await;
    let mut ann = Client::watch_stream(&server, "Ann", Stream::SPECTATOR).await;
    for stream in [Stream::PLAYER, Stream::SPECTATOR, Stream { form: Form::Inputs, hz: 60 }, Stream::PLAYER] {
        ann.say(ClientMessage::Stream(stream)).await;
        // What is still on its way of the old one is followed by a full snapshot.
        while !matches!(ann.hear().await, ServerMessage::Full(_)) {}
        for _ in 0..5 {
            match ann.hear().await {
                ServerMessage::Change(_) => assert_eq!(stream.form, Form::State),
                ServerMessage::Inputs(_) => assert_eq!(stream.form, Form::Inputs),
                _ => {}
            }
        }
        while truth.game.tick() < ann.game.tick() {
            truth.snapshot().await;
        }
        if truth.game.tick() == ann.game.tick() {
            assert_eq!(truth.game.digest(), ann.game.digest());
        }
    }
    assert_eq!((ann.mismatches, server.stop().await.illegal), (0, 0));
}

#[tokio::test]
async fn a_stream_that_there_is_none_of_ends_the_session() {
    let server = Server::start(quiet()).await;
    let mut ann = Client::watch(&server, "Ann").await;
    ann.say(ClientMessage::Stream(Stream { form: Form::Inputs, hz: 61 })).await;
    assert!(ann.wire.goodbye().await.contains("is not for a client"));
    let mut wire = Wire::open(&server).await;
    let stream = Stream { form: Form::State, hz: 0 };
    let hello = shared::protocol::Hello { name: "Bob".to_owned(), role: Role::Watch, stream };
    wire.send(shared::protocol::encode_greeting(&hello)).await;
    assert!(wire.refusal().await.contains("one of 10, 20, 30, 60 would be right"));
    server.stop().await;
}

/// A copy that went wrong is mended by a full snapshot, and both sides count it.
#[tokio::test]
async fn a_copy_that_differs_is_noticed_and_mended() {
    let server = Server::start(Config::new(classic())).await;
    let mut ann = Client::watch_stream(&server, "Ann", Stream::SPECTATOR).await;
    ann.until("the bot plays", plays).await;
    // A bit of her copy falls over: the server's next inputs lead her somewhere else.
    let mut state = ann.follower.games()[0].state();
    state.world.served ^= 1 << 20;
    let mut full = shared::protocol::Full::of("main", ann.follower.games());
    full.boards = vec![state];
    ann.follower.expect_full();
    ann.follower.hear_full(&full).expect("it fits the table");
    ann.until("she notices", |ann| ann.mismatches == 1).await;
    ann.until("a full snapshot comes", |ann| !ann.follower.waits()).await;
    for _ in 0..10 {
        ann.snapshot().await;
    }
    assert_eq!(ann.mismatches, 1);
    assert_eq!(server.stop().await.differing, 1);
}

#[tokio::test]
async fn a_spectator_that_joins_late_sees_what_the_player_sees() {
    let server = Server::start(quiet()).await;
    let mut ann = Client::play(&server, "Ann").await;
    ann.until("her ball is served", plays).await;
    let mut bob = Client::watch_stream(&server, "Bob", Stream { form: Form::Inputs, hz: 60 }).await;
    for n in 0..30_u32 {
        ann.act(Action::Flipper { right: n % 2 == 0, pressed: n % 4 < 2 }).await;
        ann.snapshot().await;
    }
    let mut compared = 0;
    while compared < 20 {
        if ann.game.tick() < bob.game.tick() {
            ann.snapshot().await;
        } else {
            bob.snapshot().await;
        }
        if ann.game.tick() == bob.game.tick() {
            assert_eq!(digest_of_room(ann.follower.games()), digest_of_room(bob.follower.games()));
            compared += 1;
        }
    }
    server.stop().await;
}
