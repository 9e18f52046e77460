//! Nonsense, floods and silence: they cost their sender the connection and nobody else anything.

use shared::game::Action;
use shared::protocol::{ClientMessage, Hello, Role, encode, encode_greeting};
use tokio::io::AsyncWriteExt;

use crate::harness::{Client, Server, Wire, quiet};

async fn let_in(server: &Server) -> Wire {
    let mut wire = Wire::open(server).await;
    wire.send(encode_greeting(&Hello { name: "Eve".to_owned(), role: Role::Watch })).await;
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
    // Only the length: four gigabytes. The server must not wait for them, let alone make room.
    eve.0.get_mut().write_all(&u32::MAX.to_le_bytes()).await.expect("sent");
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
    ann.until("she is seated", |ann| ann.seat == Some(0)).await;
    ann.act(Action::Sit).await;
    assert!(ann.wire.goodbye().await.contains("not for a client"), "nor does a player seat anybody");
    server.stop().await;
}

#[tokio::test]
async fn a_flood_of_controls_is_bounded_and_hurts_nobody() {
    let server = Server::start(quiet()).await;
    let mut ann = Client::watch(&server, "Ann").await;
    let mut eve = Client::play(&server, "Eve").await;
    eve.until("she is seated", |eve| eve.seat == Some(0)).await;
    for n in 0..5_000_u64 {
        let action = Action::Flipper { right: n % 3 == 0, pressed: n % 2 == 0 };
        eve.say(ClientMessage::Act { tick: u64::MAX - n, action }).await;
    }
    let before = ann.snapshot().await.state.world.tick;
    for _ in 0..30 {
        ann.snapshot().await;
    }
    assert!(ann.game.tick() >= before + 490, "the world went on");
    server.stop().await;
}

#[tokio::test]
async fn a_connection_that_ends_in_mid_frame_is_forgotten() {
    let server = Server::start(quiet()).await;
    let mut ann = Client::watch(&server, "Ann").await;
    let mut eve = let_in(&server).await;
    ann.until("both are there", |ann| ann.roster.spectators == 2).await;
    eve.0.get_mut().write_all(&[10, 0, 0, 0, 1, 2]).await.expect("sent");
    drop(eve);
    ann.until("Eve is gone", |ann| ann.roster.spectators == 1).await;
    server.stop().await;
}
