//! Seats, turns and the line.

use std::sync::Arc;

use shared::game::{Action, Phase};
use shared::protocol::ClientMessage;
use shared::table::{SHIPPED, Table};
use starball_server::Config;

use crate::harness::{Client, Server, quiet};

/// Classic, but a served ball falls into the drain at once.
fn ball_eater() -> Config {
    let source = SHIPPED[0].source.replace("start: (0.494, 0.1145)", "start: (0.237, 0.1)");
    let mut config = quiet();
    config.table = Arc::new(Table::parse("eater", &source).expect("valid"));
    config
}

#[tokio::test]
async fn two_players_alternate_ball_by_ball() {
    let server = Server::start(ball_eater()).await;
    let mut ann = Client::play(&server, "Ann").await;
    ann.until("she is seated", |ann| ann.place == Some(0)).await;
    let mut bob = Client::play(&server, "Bob").await;
    bob.until("he has seat two", |bob| bob.place == Some(1)).await;
    // Whose turn it is and with which ball, each time a ball is in play.
    let mut turns = Vec::new();
    while !matches!(bob.game.phase(), Phase::Over) {
        bob.snapshot().await;
        if let Phase::Play { seat, ball, .. } = bob.game.phase()
            && turns.last() != Some(&(seat, ball))
        {
            turns.push((seat, ball));
        }
    }
    assert_eq!(turns, [(0, 1), (1, 1), (0, 2), (1, 2), (0, 3), (1, 3)]);
    let account = server.stop().await;
    assert_eq!((account.games, account.balls), (1, 6));
}

#[tokio::test]
async fn only_whose_turn_it_is_moves_the_flippers() {
    let server = Server::start(quiet()).await;
    let mut ann = Client::play(&server, "Ann").await;
    ann.until("she is seated", |ann| ann.place == Some(0)).await;
    let mut bob = Client::watch(&server, "Bob").await;
    bob.say(ClientMessage::Play).await;
    bob.until("he has seat two", |bob| bob.place == Some(1)).await;
    bob.act(Action::Flipper { right: true, pressed: true }).await;
    ann.until("her ball is served", |ann| matches!(ann.game.phase(), Phase::Play { seat: 0, serve_in: 0, .. })).await;
    ann.act(Action::Flipper { right: false, pressed: true }).await;
    ann.until("her flipper is up", |ann| ann.game.world().state().flippers[0].swing > 0.8).await;
    assert_eq!(ann.game.world().state().flippers[1].swing, 0.0, "his button does nothing");
    assert_eq!(ann.roster.places, [Some("Ann".to_owned()), Some("Bob".to_owned()), None, None]);
    server.stop().await;
}

#[tokio::test]
async fn a_fifth_waits_in_line_and_gets_the_seat_of_who_leaves() {
    let server = Server::start(quiet()).await;
    let mut seated = Vec::new();
    for (seat, name) in (0..).zip(["Ann", "Bob", "Cid", "Dan"]) {
        let mut client = Client::play(&server, name).await;
        client.until("it is seated", |client| client.place == Some(seat)).await;
        seated.push(client);
    }
    let mut eve = Client::play(&server, "Eve").await;
    eve.until("she is first in line", |eve| eve.line == Some(1)).await;
    eve.until("all know", |eve| eve.roster.line == ["Eve"]).await;
    seated[1].say(ClientMessage::Leave).await;
    eve.until("she has the seat", |eve| eve.place == Some(1)).await;
    seated[1].until("he watches", |bob| bob.place.is_none()).await;
    server.stop().await;
}

#[tokio::test]
async fn a_player_whose_connection_breaks_loses_the_turn_not_the_room() {
    let server = Server::start(quiet()).await;
    let mut ann = Client::play(&server, "Ann").await;
    ann.until("she is seated", |ann| ann.place == Some(0)).await;
    let mut bob = Client::play(&server, "Bob").await;
    bob.until("he is seated", |bob| bob.place == Some(1)).await;
    bob.until("her ball is served", |bob| matches!(bob.game.phase(), Phase::Play { seat: 0, serve_in: 0, .. })).await;
    drop(ann);
    bob.until("it is his turn", |bob| bob.game.phase().has_turn(1)).await;
    bob.until("her seat is free", |bob| bob.roster.places[0].is_none()).await;
    bob.until("his ball is served", |bob| matches!(bob.game.phase(), Phase::Play { serve_in: 0, .. })).await;
    drop(bob);
    // Nobody is left: whoever comes next begins a new game.
    let mut cid = Client::play(&server, "Cid").await;
    cid.until("he is seated", |cid| cid.place == Some(0)).await;
    cid.until("with a new game", |cid| matches!(cid.game.phase(), Phase::Play { seat: 0, ball: 1, .. })).await;
    assert_eq!(server.stop().await.games, 2);
}

#[tokio::test]
async fn after_game_over_a_key_starts_the_next_game() {
    let server = Server::start(ball_eater()).await;
    let mut ann = Client::play(&server, "Ann").await;
    ann.until("the game is over", |ann| matches!(ann.game.phase(), Phase::Over)).await;
    ann.say(ClientMessage::Play).await;
    ann.until("the next one runs", |ann| matches!(ann.game.phase(), Phase::Play { ball: 1, .. })).await;
    assert_eq!(server.stop().await.games, 2);
}
