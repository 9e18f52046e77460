//! A pause, where a host allows it: the room stands still for everybody, and goes on as if nothing had been.

use std::time::{Duration, Instant};

use shared::game::{Action, Phase};
use shared::protocol::{ClientMessage, Form, ServerMessage, Stream};
use starball_server::Config;

use crate::harness::{Client, Server, quiet};

fn pausing() -> Config {
    Config { pause: true, ..quiet() }
}

/// Hears until the room has been said to stand still, or to go on.
async fn hear_pause(client: &mut Client, stands_still: bool) {
    while client.hear().await != ServerMessage::Paused(stands_still) {}
}

/// The tick that the server says it is at.
async fn tick_of_server(client: &mut Client, nonce: u64) -> u64 {
    client.say(ClientMessage::Ping { nonce }).await;
    loop {
        if let ServerMessage::Pong { nonce: answered, tick } = client.hear().await
            && answered == nonce
        {
            return tick;
        }
    }
}

#[tokio::test]
async fn no_tick_passes_while_a_player_pauses_and_none_is_made_up_for() {
    let server = Server::start(pausing()).await;
    let mut ann = Client::play(&server, "Ann").await;
    let mut bob = Client::watch_stream(&server, "Bob", Stream { form: Form::Inputs, hz: 60 }).await;
    ann.until("the ball is served", |ann| matches!(ann.game.phase(), Phase::Play { serve_in: 0, .. })).await;
    ann.act(Action::Pull(u16::MAX)).await;
    ann.say(ClientMessage::Pause(true)).await;
    hear_pause(&mut ann, true).await;
    hear_pause(&mut bob, true).await;
    // Answers to pings go on, and say the same tick for as long as it lasts.
    let (tick, began) = (tick_of_server(&mut ann, 1).await, Instant::now());
    let mut nonce = 2;
    while began.elapsed() < Duration::from_millis(300) {
        assert_eq!(tick_of_server(&mut ann, nonce).await, tick);
        nonce += 1;
        // No more than twenty a second are answered.
        tokio::time::sleep(Duration::from_millis(50)).await;
    }
    // Who comes now sees the room as it stands, and hears that it does.
    let mut cid = Client::watch(&server, "Cid").await;
    hear_pause(&mut cid, true).await;
    assert_eq!(cid.game.tick(), tick);
    ann.say(ClientMessage::Pause(false)).await;
    hear_pause(&mut ann, false).await;
    let at_once = tick_of_server(&mut ann, 1).await;
    assert!(at_once - tick < 250, "{} ticks were made up for", at_once - tick);
    let goal = tick + 500;
    for client in [&mut ann, &mut bob, &mut cid] {
        client.until("the game has gone on", |client| client.game.tick() > goal).await;
        assert_eq!(client.mismatches, 0);
    }
    // Whoever stopped the room and is gone does not hold it.
    ann.say(ClientMessage::Pause(true)).await;
    hear_pause(&mut bob, true).await;
    drop(ann);
    hear_pause(&mut bob, false).await;
    let account = server.stop().await;
    assert_eq!((account.differing, account.gaps, account.illegal, account.ticks_skipped), (0, 0, 0, 0));
}

#[tokio::test]
async fn where_no_host_allows_it_a_pause_ends_the_session() {
    let server = Server::start(quiet()).await;
    let mut ann = Client::play(&server, "Ann").await;
    ann.until("she is seated", |ann| ann.place == Some(0)).await;
    ann.say(ClientMessage::Pause(true)).await;
    assert!(ann.wire.goodbye().await.contains("Pause"));
    server.stop().await;
}
