//! Who is let in, and in which words others are not.

use shared::protocol::{Hello, Preamble, Role, Stream, encode_greeting};
use std::time::Duration;

use crate::harness::{Client, Server, Wire, quiet};

fn hello(name: &str) -> Vec<u8> {
    encode_greeting(&Hello { name: name.to_owned(), role: Role::Watch, stream: Stream::PLAYER })
}

#[tokio::test]
async fn a_welcome_brings_the_table_and_then_the_game() {
    let server = Server::start(quiet()).await;
    let mut client = Client::watch(&server, "Ann").await;
    assert_eq!(client.game.table().name, "Classic");
    let first = client.snapshot().await.tick;
    let second = client.snapshot().await.tick;
    assert!((16..=17).contains(&(second - first)), "60 snapshots a second, not one in {} ms", second - first);
    assert_eq!(server.stop().await.clients, 1);
}

#[tokio::test]
async fn another_protocol_is_refused_with_both_versions() {
    let server = Server::start(quiet()).await;
    let mut wire = Wire::open(&server).await;
    let mut frame = hello("Ann");
    let theirs = Preamble { version: 77, ..Preamble::ours() };
    frame[..20].copy_from_slice(&theirs.to_bytes());
    wire.send(frame).await;
    let reason = wire.refusal().await;
    assert!(reason.contains("protocol 77") && reason.contains("same release"), "{reason}");
    assert!(wire.receive().await.is_none(), "then the connection ends");

    let mut wire = Wire::open(&server).await;
    wire.send(b"GET / HTTP/1.1".to_vec()).await;
    assert!(wire.refusal().await.contains("does not speak"));
    server.stop().await;
}

#[tokio::test]
async fn names_that_could_harm_a_terminal_are_refused() {
    let server = Server::start(quiet()).await;
    for name in ["", "a\u{1b}[2J", "much too long to be anybody's name"] {
        let mut wire = Wire::open(&server).await;
        wire.send(hello(name)).await;
        assert!(wire.refusal().await.contains("a name has"), "{name:?}");
    }
    assert_eq!(server.stop().await.clients, 0);
}

#[tokio::test]
async fn a_silent_connection_is_ended() {
    let mut config = quiet();
    config.handshake_time = Duration::from_millis(100);
    let server = Server::start(config).await;
    let mut wire = Wire::open(&server).await;
    assert!(wire.refusal().await.contains("no hello"));
    assert!(wire.receive().await.is_none());
    server.stop().await;
}

#[tokio::test]
async fn a_full_server_says_so() {
    let mut config = quiet();
    config.most_connections = 1;
    let server = Server::start(config).await;
    let _first = Client::watch(&server, "Ann").await;
    let mut wire = Wire::open(&server).await;
    wire.send(hello("Bob")).await;
    assert!(wire.refusal().await.contains("full"));
    server.stop().await;
}
