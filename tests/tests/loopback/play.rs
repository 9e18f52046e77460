//! One player: from the first key to game over.

use shared::game::{Action, Input, Phase};
use shared::protocol::{ClientMessage, ServerMessage, TAP_TICKS};

use crate::harness::{Client, Server, quiet};

fn ball_is_served(client: &Client) -> bool {
    matches!(client.game.phase(), Phase::Play { serve_in: 0, .. })
}

#[tokio::test]
async fn a_player_gets_the_first_seat_and_a_ball_at_once() {
    let server = Server::start(quiet()).await;
    let mut ann = Client::play(&server, "Ann").await;
    ann.until("she is seated", |ann| ann.place == Some(0)).await;
    ann.until("the ball is served", ball_is_served).await;
    assert_eq!(ann.game.world().state().balls.len(), 1);
    let account = server.stop().await;
    assert_eq!((account.games, account.balls), (1, 1));
}

#[tokio::test]
async fn a_button_moves_its_flipper_and_only_that() {
    let server = Server::start(quiet()).await;
    let mut ann = Client::play(&server, "Ann").await;
    ann.until("the ball is served", ball_is_served).await;
    ann.act(Action::Flipper { right: false, pressed: true }).await;
    ann.until("the left flipper is up", |ann| ann.game.world().state().flippers[0].swing > 0.8).await;
    assert_eq!(ann.game.world().state().flippers[1].swing, 0.0, "the right one rests");
    ann.act(Action::Flipper { right: false, pressed: false }).await;
    ann.until("it is down again", |ann| ann.game.world().state().flippers[0].swing == 0.0).await;
    let account = server.stop().await;
    assert_eq!((account.strokes, account.controls), ([1, 0], 2));
}

#[tokio::test]
async fn the_plunger_launches_the_ball() {
    let server = Server::start(quiet()).await;
    let mut ann = Client::play(&server, "Ann").await;
    ann.until("the ball is served", ball_is_served).await;
    ann.act(Action::Pull(u16::MAX)).await;
    ann.until("the plunger is pulled", |ann| ann.game.world().state().plungers[0].pull > 0.055).await;
    ann.act(Action::Release).await;
    ann.until("the ball has left the lane", |ann| {
        ann.game.world().state().balls.first().is_some_and(|ball| ball.flight.position.x < 0.45)
    })
    .await;
    server.stop().await;
}

#[tokio::test]
async fn inputs_act_in_the_tick_they_are_stamped_with() {
    let server = Server::start(quiet()).await;
    let mut ann = Client::play(&server, "Ann").await;
    ann.until("the ball is served", ball_is_served).await;
    // An own copy of the game, stepped from this snapshot with the same input at the same tick, must stay equal.
    let start = ann.snapshot().await;
    let press = start.tick + 240;
    let action = Action::Flipper { right: true, pressed: true };
    ann.say(ClientMessage::Act { tick: press, action }).await;
    let mut copy = ann.game.clone();
    copy.restore(ann.game.state()).expect("a valid state");
    let mut compared = 0;
    while copy.tick() < press + 100 {
        copy.step(&[Input { tick: press, seat: 0, action }]);
        if copy.tick() % 50 == 0 {
            tokio::task::yield_now().await;
        }
        if ann.game.tick() < copy.tick() {
            ann.snapshot().await;
        }
        if ann.game.tick() == copy.tick() {
            assert_eq!(ann.game.digest(), copy.digest(), "tick {}", copy.tick());
            compared += 1;
        }
    }
    assert!(compared >= 10, "only {compared} snapshots were compared");
    assert!(copy.world().state().flippers[1].swing > 0.8, "the flipper did rise");
    server.stop().await;
}

/// Press and release both acted at once, in one tick, and the flipper did not move.
#[tokio::test]
async fn a_tap_that_comes_late_still_fires_the_flipper() {
    let server = Server::start(quiet()).await;
    let mut ann = Client::play(&server, "Ann").await;
    ann.until("the ball is served", ball_is_served).await;
    let past = ann.game.tick() - 100;
    for (tick, pressed) in [(past, true), (past + TAP_TICKS, false)] {
        ann.say(ClientMessage::Act { tick, action: Action::Flipper { right: true, pressed } }).await;
    }
    ann.until("the flipper has moved", |ann| ann.game.world().state().flippers[1].swing > 0.4).await;
    ann.until("it is down again", |ann| ann.game.world().state().flippers[1].swing == 0.0).await;
    server.stop().await;
}

#[tokio::test]
async fn pings_are_answered_with_the_tick() {
    let server = Server::start(quiet()).await;
    let mut ann = Client::watch(&server, "Ann").await;
    ann.say(ClientMessage::Ping { nonce: 42 }).await;
    loop {
        if let ServerMessage::Pong { nonce, .. } = ann.hear().await {
            assert_eq!(nonce, 42);
            break;
        }
    }
    server.stop().await;
}
