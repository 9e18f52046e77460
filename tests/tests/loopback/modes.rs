//! The three ways of playing against those who watch.

use std::sync::Arc;
use std::time::Duration;

use shared::game::{Action, GameEventKind, Phase};
use shared::protocol::{ClientMessage, Form, Mode, Role, Stream, digest_of_room};
use shared::table::Table;
use starball_server::Config;

use crate::harness::{Client, Server, Wire, classic, quiet};

fn mode(config: Config, mode: Mode) -> Config {
    config.mode(mode)
}

fn is_on(client: &Client, board: usize) -> bool {
    client.follower.games().get(board).is_some_and(|game| matches!(game.phase(), Phase::Play { .. }))
}

#[tokio::test]
async fn head_to_head_each_has_a_board_and_all_see_both() {
    let server = Server::start(mode(quiet(), Mode::HeadToHead)).await;
    let mut cid = Client::watch_stream(&server, "Cid", Stream { form: Form::Inputs, hz: 60 }).await;
    let mut ann = Client::play(&server, "Ann").await;
    assert_eq!((ann.welcome.mode, ann.welcome.places), (Mode::HeadToHead, 2));
    ann.until("she is at board one", |ann| ann.place == Some(0) && is_on(ann, 0)).await;
    ann.act(Action::Flipper { right: false, pressed: true }).await;
    cid.until("he sees her flipper", |cid| {
        cid.follower.games().first().is_some_and(|game| game.world().state().flippers[0].swing > 0.8)
    })
    .await;
    assert_eq!(cid.follower.games()[1].world().state().flippers[0].swing, 0.0, "and nothing on the other board");
    // Nobody comes into a match that is on.
    let mut bob = Client::play(&server, "Bob").await;
    bob.until("he waits", |bob| bob.line == Some(1)).await;
    ann.say(ClientMessage::Leave).await;
    bob.until("he plays", |bob| bob.place.is_some_and(|place| is_on(bob, usize::from(place)))).await;
    cid.snapshot().await;
    assert_eq!(cid.mismatches, 0);
    server.stop().await;
}

#[tokio::test]
async fn head_to_head_both_begin_in_the_same_tick() {
    let mut config = mode(quiet(), Mode::HeadToHead);
    config.attract = true;
    let server = Server::start(config).await;
    let mut bob = Client::watch(&server, "Bob").await;
    let mut ann = Client::play(&server, "Ann").await;
    ann.until("the bot plays against her", |ann| ann.roster.places[1].as_deref() == Some("BOT")).await;
    ann.until("both play", |ann| is_on(ann, 0) && is_on(ann, 1)).await;
    let served = |client: &Client, board: usize| client.follower.games()[board].phase();
    bob.until("he sees both", |bob| is_on(bob, 0) && is_on(bob, 1)).await;
    while digest_of_room(ann.follower.games()) != digest_of_room(bob.follower.games()) {
        if ann.follower.tick() < bob.follower.tick() {
            ann.snapshot().await;
        } else {
            bob.snapshot().await;
        }
    }
    assert_eq!(served(&ann, 0), served(&ann, 1), "their first balls come in the same tick");
    server.stop().await;
}

/// Classic with a crowd that is never short of energy, and does not wait.
fn eager_crowd() -> Arc<Table> {
    let source = classic().source.replace("energy_per_second: 1.0", "energy_per_second: 1000.0");
    assert!(source.contains("1000.0"), "the table's crowd is written otherwise");
    Arc::new(Table::parse("eager", &source).expect("valid"))
}

#[tokio::test]
async fn the_crowd_votes_and_the_house_announces_and_acts() {
    let mut config = mode(Config::new(eager_crowd()), Mode::Crowd);
    config.silent_time = Duration::from_secs(120);
    config.vote_time = Duration::from_millis(300);
    let server = Server::start(config).await;
    let mut ann = Client::watch_stream(&server, "Ann", Stream { form: Form::Inputs, hz: 60 }).await;
    let mut bob = Client::watch(&server, "Bob").await;
    let mut cid = Client::watch_stream(&server, "Cid", Stream::SPECTATOR).await;
    assert_eq!(ann.welcome.mode, Mode::Crowd);
    ann.until("the bot's ball is in play", |ann| ann.game.can_crowd(1).is_ok()).await;
    ann.say(ClientMessage::Vote { action: 0 }).await;
    bob.say(ClientMessage::Vote { action: 1 }).await;
    cid.say(ClientMessage::Vote { action: 1 }).await;
    ann.until("all votes are counted", |ann| ann.tally.votes.iter().sum::<u32>() == 3).await;
    assert_eq!((ann.tally.votes[0], ann.tally.votes[1]), (1, 2));
    assert!(ann.tally.closes.is_some());
    // What most want is announced, and then done.
    let (mut announced, mut acted) = (None, None);
    while acted.is_none() {
        for event in ann.snapshot().await.events {
            match event.kind {
                GameEventKind::Announced { action } => announced = Some((action, event.tick)),
                GameEventKind::Acted { action } => acted = Some((action, event.tick)),
                _ => {}
            }
        }
    }
    let ((first, at), (second, later)) = (announced.expect("it comes first"), acted.expect("it came"));
    assert_eq!((first, second), (1, 1));
    assert_eq!(later - at, 2000, "the player has two seconds");
    assert!(ann.game.crowd().is_some_and(|crowd| crowd.points() > 0));
    ann.until("the votes are gone", |ann| ann.tally.closes.is_none()).await;
    assert_eq!(ann.mismatches, 0);
    server.stop().await;
}

#[tokio::test]
async fn where_there_is_no_crowd_nobody_votes() {
    let server = Server::start(quiet()).await;
    let mut ann = Client::watch(&server, "Ann").await;
    ann.say(ClientMessage::Vote { action: 0 }).await;
    assert!(ann.wire.goodbye().await.contains("is not for a client"));
    server.stop().await;
}

#[tokio::test]
async fn who_idles_loses_the_turn_and_keeps_the_place() {
    let mut config = quiet();
    config.idle_time = Duration::from_millis(700);
    let server = Server::start(config).await;
    let mut ann = Client::play(&server, "Ann").await;
    ann.until("she is seated", |ann| ann.place == Some(0)).await;
    let mut bob = Client::play(&server, "Bob").await;
    bob.until("he is seated", |bob| bob.place == Some(1)).await;
    bob.until("her turn is over", |bob| bob.game.phase().has_turn(1)).await;
    bob.until("and his, and hers again", |bob| bob.game.phase().has_turn(0)).await;
    assert_eq!(bob.roster.places[0].as_deref(), Some("Ann"));
    bob.until("until the game is over", |bob| matches!(bob.game.phase(), Phase::Over)).await;
    assert_eq!((bob.place, server.stop().await.forfeited), (Some(1), 6));
}

#[tokio::test]
async fn a_room_with_one_place_has_a_line() {
    let mut config = quiet();
    config.places = 1;
    let server = Server::start(config).await;
    let mut ann = Client::play(&server, "Ann").await;
    ann.until("she is seated", |ann| ann.place == Some(0)).await;
    let mut bob = Client::join(Wire::open(&server).await, "Bob", Role::Play, Stream::SPECTATOR).await;
    bob.until("he is first in line", |bob| bob.line == Some(1) && bob.roster.waiting == 1).await;
    drop(ann);
    bob.until("he plays", |bob| bob.place == Some(0) && is_on(bob, 0)).await;
    server.stop().await;
}
