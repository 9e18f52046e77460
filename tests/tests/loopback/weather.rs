//! Bad networks: what they do to one client, they do to nobody else.

use std::time::Duration;

use shared::game::{Action, Phase};
use shared::protocol::{ClientMessage, Hello, Role, Stream, encode_greeting};
use tokio::time::Instant;

use crate::harness::{Client, Server, Wire, quiet};
use crate::proxy::{Path, Proxy, Weather};

fn ball_is_served(client: &Client) -> bool {
    matches!(client.game.phase(), Phase::Play { serve_in: 0, .. })
}

async fn through(proxy: &Proxy, name: &str, role: Role) -> Client {
    Client::join(Wire::open_at(proxy.address).await, name, role, Stream::PLAYER).await
}

#[tokio::test]
async fn a_player_far_away_works_the_controls() {
    let server = Server::start(quiet()).await;
    let path = Path { delay: Duration::from_millis(80), jitter: Duration::from_millis(30), ..Path::default() };
    let proxy = Proxy::start(server.address, Weather::both(path, 1)).await;
    let mut ann = through(&proxy, "Ann", Role::Play).await;
    ann.until("the ball is served", ball_is_served).await;
    for right in [false, true] {
        let (side, pressed_at) = (usize::from(right), Instant::now());
        ann.act(Action::Flipper { right, pressed: true }).await;
        ann.until("the flipper is up", |ann| ann.game.world().state().flippers[side].swing > 0.8).await;
        assert!(pressed_at.elapsed() >= 2 * path.delay, "there and back");
        ann.act(Action::Flipper { right, pressed: false }).await;
        ann.until("it is down again", |ann| ann.game.world().state().flippers[side].swing == 0.0).await;
    }
    ann.act(Action::Pull(u16::MAX)).await;
    ann.until("the plunger is pulled", |ann| ann.game.world().state().plungers[0].pull > 0.055).await;
    ann.act(Action::Release).await;
    ann.until("the ball is on its way", |ann| {
        ann.game.world().state().balls.first().is_some_and(|ball| ball.flight.position.x < 0.45)
    })
    .await;
    let account = server.stop().await;
    assert_eq!((account.strokes, account.controls, account.illegal), ([1, 1], 6, 0));
}

#[tokio::test]
async fn the_first_picture_takes_one_round_trip() {
    let server = Server::start(quiet()).await;
    let path = Path { delay: Duration::from_millis(200), ..Path::default() };
    let proxy = Proxy::start(server.address, Weather::both(path, 1)).await;
    let began = Instant::now();
    let mut ann = Client::join(Wire::open_at(proxy.address).await, "Ann", Role::Watch, Stream::SPECTATOR).await;
    ann.snapshot().await;
    let took = began.elapsed();
    // A second one would make it four times the way.
    assert!((2 * path.delay..4 * path.delay).contains(&took), "{took:?}");
    assert_eq!(ann.follower.games().len(), 1);
    server.stop().await;
}

#[tokio::test]
async fn a_stall_holds_up_one_client_and_then_it_is_up_to_date() {
    let server = Server::start(quiet()).await;
    let proxy = Proxy::start(server.address, Weather::default()).await;
    let mut eve = through(&proxy, "Eve", Role::Watch).await;
    let mut ann = Client::watch(&server, "Ann").await;
    eve.snapshot().await;
    proxy.stall(Duration::from_millis(500));
    let mut last = ann.snapshot().await.tick;
    for _ in 0..20 {
        let tick = ann.snapshot().await.tick;
        assert!((16..=17).contains(&(tick - last)), "{} ticks between two snapshots", tick - last);
        last = tick;
    }
    eve.until("Eve has seen as much", |eve| eve.game.tick() >= last).await;
    server.stop().await;
}

#[tokio::test]
async fn a_spectator_through_a_straw_neither_dies_nor_slows_the_others() {
    let mut config = quiet();
    config.send_buffer = 4096;
    let server = Server::start(config).await;
    let straw = Path { bandwidth: Some(4000), ..Path::default() };
    let proxy = Proxy::start(server.address, Weather { to_client: straw, ..Weather::default() }).await;
    let mut ann = Client::play(&server, "Ann").await;
    let first = ann.snapshot().await.tick;
    // The welcome alone takes it seconds: there is a whole table in it.
    let watches = async {
        let mut eve = through(&proxy, "Eve", Role::Watch).await;
        let begin = eve.snapshot().await.tick;
        eve.until("it has seen some of the game", |eve| eve.game.tick() >= begin + 1500).await;
    };
    let plays = async {
        let mut last = first;
        loop {
            let tick = ann.snapshot().await.tick;
            assert!((16..=17).contains(&(tick - last)), "{} ticks between two snapshots", tick - last);
            last = tick;
        }
    };
    tokio::select! {
        () = watches => {}
        () = plays => unreachable!("it watches for ever"),
    };
    let now = ann.snapshot().await.tick;
    assert!(now - first > 4000, "its welcome came within {} ms: no straw", now - first);
    server.stop().await;
}

/// Three cuts one byte apart, so that whatever a frame has around it, not all of them fall between two frames.
#[tokio::test]
async fn a_cut_in_mid_frame_ends_that_session_and_frees_the_seat() {
    let server = Server::start(quiet()).await;
    let mut ann = Client::play(&server, "Ann").await;
    ann.until("she is seated", |ann| ann.place == Some(0)).await;
    let hello =
        encode_greeting(&Hello { name: "Eve".to_owned(), role: Role::Play, stream: Stream::PLAYER }).len() as u64;
    for beyond in 15..18 {
        let cut = Path { cut_after: Some(hello + beyond), ..Path::default() };
        let proxy = Proxy::start(server.address, Weather { to_server: cut, ..Weather::default() }).await;
        let mut eve = through(&proxy, "Eve", Role::Play).await;
        eve.until("she is seated", |eve| eve.place == Some(1)).await;
        for _ in 0..20 {
            eve.act(Action::Flipper { right: true, pressed: true }).await;
        }
        while eve.wire.receive().await.is_some() {}
        ann.until("her seat is free", |ann| ann.roster.places[1].is_none()).await;
    }
    // And what the server sends is cut somewhere.
    for beyond in 0..3 {
        let cut = Path { cut_after: Some(30_000 + beyond), ..Path::default() };
        let proxy = Proxy::start(server.address, Weather { to_client: cut, ..Weather::default() }).await;
        let mut eve = through(&proxy, "Eve", Role::Play).await;
        while eve.wire.receive().await.is_some() {}
        ann.until("her seat is free", |ann| ann.roster.places[1].is_none()).await;
    }
    let mut bob = Client::play(&server, "Bob").await;
    bob.until("he has the seat", |bob| bob.place == Some(1)).await;
    let last = ann.snapshot().await.tick;
    assert!((16..=17).contains(&(ann.snapshot().await.tick - last)));
    assert_eq!(server.stop().await.clients, 8);
}

#[tokio::test]
async fn a_half_open_player_loses_the_seat_and_the_next_plays() {
    let mut config = quiet();
    config.silent_time = Duration::from_millis(500);
    let server = Server::start(config).await;
    let proxy = Proxy::start(server.address, Weather::default()).await;
    let mut eve = through(&proxy, "Eve", Role::Play).await;
    eve.until("the ball is served", ball_is_served).await;
    proxy.go_half_open();
    // Whatever she does now, nobody hears it.
    eve.say(ClientMessage::Ping { nonce: 0 }).await;
    let mut ann = Client::watch(&server, "Ann").await;
    ann.until("Eve is there", |ann| ann.roster.places[0].as_deref() == Some("Eve")).await;
    while ann.roster.places[0].is_some() {
        ann.say(ClientMessage::Ping { nonce: 0 }).await;
        ann.snapshot().await;
    }
    ann.say(ClientMessage::Play).await;
    ann.until("she is seated", |ann| ann.place == Some(0)).await;
    ann.say(ClientMessage::Play).await;
    ann.until("her ball is served", ball_is_served).await;
    ann.act(Action::Flipper { right: false, pressed: true }).await;
    ann.until("her flipper is up", |ann| ann.game.world().state().flippers[0].swing > 0.8).await;
    server.stop().await;
}
