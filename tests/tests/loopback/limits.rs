//! A host's limits: each is kept, and whoever goes beyond it is told.

use std::time::Duration;

use shared::protocol::{ClientMessage, Hello, Role, Stream, encode_greeting};
use tokio::io::AsyncWriteExt;

use crate::harness::{Client, Server, Wire, quiet};

fn hello(name: &str) -> Vec<u8> {
    encode_greeting(&Hello { name: name.to_owned(), role: Role::Watch, stream: Stream::SPECTATOR })
}

#[tokio::test]
async fn more_messages_than_allowed_end_the_session() {
    let mut config = quiet();
    config.most_messages = 50;
    let server = Server::start(config).await;
    let mut ann = Client::watch(&server, "Ann").await;
    let mut eve = Client::watch(&server, "Eve").await;
    // A burst of a hundred is allowed, and then fifty a second.
    for nonce in 0..60 {
        ann.say(ClientMessage::Ping { nonce }).await;
        eve.say(ClientMessage::Ping { nonce }).await;
        eve.say(ClientMessage::Ping { nonce }).await;
        eve.say(ClientMessage::Ping { nonce }).await;
    }
    assert_eq!(eve.wire.goodbye().await, "more than 50 messages a second");
    ann.snapshot().await;
    assert_eq!(server.stop().await.illegal, 1);
}

#[tokio::test]
async fn more_connections_from_one_address_than_allowed_are_refused() {
    let mut config = quiet();
    config.most_per_address = 2;
    let server = Server::start(config).await;
    let ann = Client::watch(&server, "Ann").await;
    let mut bob = Client::watch(&server, "Bob").await;
    let mut third = Wire::open(&server).await;
    assert!(third.refusal().await.contains("2 connections from your address"));
    drop(ann);
    bob.until("Ann is gone", |bob| bob.roster.spectators == 1).await;
    // Her place among the connections is free a moment after her place in the room.
    let mut wire = Wire::open(&server).await;
    for _ in 0..100 {
        if wire.stream.write_all(&shared::protocol::framed(&hello("Cid"))).await.is_ok()
            && wire.receive().await.is_some_and(|frame| {
                !matches!(
                    shared::protocol::decode_greeting(&frame),
                    Ok(shared::protocol::ServerMessage::Refused { .. })
                )
            })
        {
            server.stop().await;
            return;
        }
        tokio::time::sleep(Duration::from_millis(20)).await;
        wire = Wire::open(&server).await;
    }
    panic!("nobody is let in any more");
}

#[tokio::test]
async fn a_longer_name_than_the_host_allows_is_refused() {
    let mut config = quiet();
    config.most_name = 5;
    let server = Server::start(config).await;
    let mut wire = Wire::open(&server).await;
    wire.send(hello("Ann-Marie")).await;
    assert!(wire.refusal().await.contains("at most 5 characters"));
    server.stop().await;
}

#[tokio::test]
async fn a_larger_frame_than_the_host_allows_is_refused() {
    let mut config = quiet();
    config.most_frame = 64;
    let server = Server::start(config).await;
    let mut ann = Client::watch(&server, "Ann").await;
    ann.wire.send(vec![0; 65]).await;
    assert!(ann.wire.goodbye().await.contains("at most 64 would be right"));
    server.stop().await;
}

#[tokio::test]
async fn a_client_that_says_nothing_is_told_and_sent_away() {
    let mut config = quiet();
    config.silent_time = Duration::from_millis(300);
    let server = Server::start(config).await;
    let mut ann = Client::watch(&server, "Ann").await;
    assert_eq!(ann.wire.goodbye().await, "it said nothing for too long");
    assert!(ann.wire.receive().await.is_none());
    server.stop().await;
}
