//! Nudging: the table moves for everybody, and a fit of nudges tilts the game.

use std::sync::Arc;

use shared::game::replay::Recorder;
use shared::game::{Action, Game, GameEvent, GameEventKind, Input, Nudge, Phase};
use shared::protocol::ClientMessage;
use shared::table::Table;
use starball_server::Config;

use crate::harness::{Client, Server, classic, quiet};

/// Snapshots between two nudges of a fit: in time with the swing of the table, and of the bob in it.
const EVERY: usize = 10;

/// The classic table on legs.
fn on_legs() -> Config {
    let source = &classic().source;
    let source = if source.contains("cabinet:") {
        source.clone()
    } else {
        source.replacen("gravity:", "cabinet: (), gravity:", 1)
    };
    let table = Table::parse("classic.ron", &source).expect("a valid table");
    Config { table: Arc::new(table), ..quiet() }
}

fn ball_is_served(client: &Client) -> bool {
    matches!(client.game.phase(), Phase::Play { serve_in: 0, .. })
}

/// What the events of a game say that its players did, as inputs: enough to play it again.
fn inputs_of(events: &[GameEvent]) -> Vec<Input> {
    let input = |event: &GameEvent| {
        let (seat, action) = match event.kind {
            GameEventKind::SatDown { seat } => (seat, Action::Sit),
            GameEventKind::Started => (0, Action::Start),
            GameEventKind::Nudged { nudge } => (0, Action::Nudge(nudge)),
            _ => return None,
        };
        Some(Input { tick: event.tick, seat, action })
    };
    events.iter().filter_map(input).collect()
}

#[tokio::test]
async fn a_spectator_sees_the_table_move() {
    let server = Server::start(on_legs()).await;
    let mut bob = Client::watch(&server, "Bob").await;
    let mut ann = Client::play(&server, "Ann").await;
    ann.until("the ball is served", ball_is_served).await;
    bob.until("he sees it", ball_is_served).await;
    assert!(bob.game.world().state().cabinet.is_still());
    ann.act(Action::Nudge(Nudge::FromLeft)).await;
    bob.until("the table goes to the right", |bob| bob.game.world().state().cabinet.displacement.x > 2e-4).await;
    bob.until("it swings back", |bob| bob.game.world().state().cabinet.displacement.x < -2e-4).await;
    bob.until("it stands still", |bob| bob.game.world().state().cabinet.is_still()).await;
    assert_eq!(bob.game.tilt().warnings, 0);
    server.stop().await;
}

#[tokio::test]
async fn a_fit_of_nudges_tilts_the_game_for_both_and_its_replay_too() {
    let config = on_legs();
    let table = Arc::clone(&config.table);
    let server = Server::start(config).await;
    let mut bob = Client::watch(&server, "Bob").await;
    let mut events = bob.snapshot().await.events;
    let mut ann = Client::play(&server, "Ann").await;
    while !ball_is_served(&bob) {
        events.extend(bob.snapshot().await.events);
    }
    while !bob.game.tilt().tilted {
        ann.act(Action::Nudge(Nudge::Forward)).await;
        for _ in 0..EVERY {
            events.extend(bob.snapshot().await.events);
        }
    }
    let warnings = events.iter().filter(|event| matches!(event.kind, GameEventKind::Warned { .. })).count();
    assert_eq!(warnings, 2);
    assert!(events.iter().any(|event| event.kind == GameEventKind::Tilted { seat: 0 }));
    ann.until("she sees it as well", |ann| ann.game.tilt().tilted).await;
    // Her flippers are dead.
    ann.act(Action::Flipper { right: false, pressed: true }).await;
    for _ in 0..10 {
        bob.snapshot().await;
        assert_eq!(bob.game.world().state().flippers[0].swing, 0.0);
    }

    // What he saw is the whole game: played again it comes to the same state, and so does the replay of that.
    let inputs = inputs_of(&events);
    let mut game = Game::new(Arc::clone(&table));
    let mut recorder = Recorder::new(&table, 0);
    while game.tick() < bob.game.tick() {
        game.step(&inputs);
        recorder.after_step(&game, &inputs);
    }
    assert_eq!(game.digest(), bob.game.digest());
    let replay = recorder.finish(&game).expect("every step was recorded");
    let replayed = replay.play(table, |_| {}).expect("it arrives where it says");
    assert_eq!(replayed.digest(), bob.game.digest());
    server.stop().await;
}

/// Without a limit, all of them would push the table in one and the same tick.
#[tokio::test]
async fn a_flood_of_nudges_is_as_many_as_a_hand_can_give() {
    let server = Server::start(on_legs()).await;
    let mut bob = Client::watch(&server, "Bob").await;
    let mut eve = Client::play(&server, "Eve").await;
    eve.until("the ball is served", ball_is_served).await;
    bob.until("Bob sees it", ball_is_served).await;
    for _ in 0..2000 {
        eve.say(ClientMessage::Act { tick: 0, action: Action::Nudge(Nudge::FromLeft) }).await;
    }
    let mut nudges = Vec::new();
    for _ in 0..60 {
        let events = bob.snapshot().await.events;
        nudges.extend(events.iter().filter(|e| matches!(e.kind, GameEventKind::Nudged { .. })).map(|e| e.tick));
    }
    assert!((2..25).contains(&nudges.len()), "{nudges:?}");
    assert!(nudges.windows(2).all(|pair| pair[1] >= pair[0] + 50), "{nudges:?}");
    server.stop().await;
}
