//! A session against a real server on this machine, without a window.

use std::sync::Arc;
use std::time::{Duration, Instant};

use macroquad::input::KeyCode;
use shared::game::Phase;
use shared::protocol::{Hello, Role};
use shared::table::Table;

use super::*;
use crate::controls::Controls;
use crate::embedded::Embedded;
use crate::net::{Connection, Incoming};

/// A client without a window.
struct Client {
    epoch: Instant,
    connection: Connection,
    session: Session,
    controls: Controls,
}

impl Client {
    fn join(embedded: &Embedded, role: Role) -> Self {
        Self::join_for(embedded, role, StreamChoice::default())
    }

    fn join_for(embedded: &Embedded, role: Role, choice: StreamChoice) -> Self {
        let epoch = Instant::now();
        let hello = Hello { name: "test".to_owned(), role, stream: choice.stream(role) };
        let mut connection = Connection::open(embedded.address().to_string(), hello, epoch).unwrap();
        loop {
            match connection.poll() {
                Some(Incoming::Welcome(welcome)) => {
                    let session = Session::new(&welcome, choice, role).unwrap();
                    return Self { epoch, connection, session, controls: Controls::default() };
                }
                Some(other) => panic!("{other:?}"),
                None => std::thread::sleep(Duration::from_millis(1)),
            }
            assert!(epoch.elapsed() < Duration::from_secs(5));
        }
    }

    /// Frames, until `done` or ten seconds have passed; `false` if they have.
    fn run(&mut self, mut done: impl FnMut(&Session) -> bool) -> bool {
        let end = self.epoch.elapsed() + Duration::from_secs(10);
        while self.epoch.elapsed() < end {
            while let Some(incoming) = self.connection.poll() {
                let Incoming::Message { at, message } = incoming else { panic!("{incoming:?}") };
                self.session.hear(at, message).unwrap();
            }
            let now = self.epoch.elapsed().as_secs_f64();
            self.session.advance(now, &mut self.controls);
            self.session.take_outgoing().for_each(|message| self.connection.send(message));
            if done(&self.session) {
                return true;
            }
            std::thread::sleep(Duration::from_millis(16));
        }
        false
    }

    fn run_for(&mut self, seconds: f64) {
        let end = self.epoch.elapsed().as_secs_f64() + seconds;
        let epoch = self.epoch;
        assert!(self.run(|_| epoch.elapsed().as_secs_f64() >= end));
    }
}

fn embedded() -> Embedded {
    Embedded::start(Arc::new(Table::shipped("classic").unwrap().unwrap()), None).unwrap()
}

/// Whether what is to be seen is a game in which a ball is in play.
fn has_ball(session: &Session) -> bool {
    session.moment(0).is_some_and(|moment| !moment.balls.is_empty())
}

#[test]
fn a_player_sees_the_keys_at_once_and_predictions_are_right() {
    let embedded = embedded();
    let mut client = Client::join(&embedded, Role::Play);
    assert!(client.run(|session| session.place() == Some(0) && has_ball(session)), "no ball was served");
    client.run_for(0.3);

    // A key's frame already shows the flipper on its way.
    let swing = |session: &Session| session.moment(0).map_or(0.0, |moment| moment.flippers[0]);
    assert_eq!(swing(&client.session), 0.0);
    client.controls.key_down(KeyCode::LeftShift);
    std::thread::sleep(Duration::from_millis(16));
    client.run(|_| true);
    assert!(swing(&client.session) > 0.0, "the flipper waited for the server");
    client.run_for(0.2);
    client.controls.key_up(KeyCode::LeftShift);

    client.controls.key_down(KeyCode::Space);
    client.run_for(1.1);
    client.controls.key_up(KeyCode::Space);
    client.run_for(1.5);
    let flies = client.session.moment(0).is_some_and(|m| m.balls.iter().any(|ball| ball.position.y > 0.3));
    assert!(flies, "the plunger launched nothing");
    let counts = client.session.counts();
    // A busy machine may deliver an input late; it must stay the exception.
    assert!(counts.right > 50 && counts.wrong <= 3, "{counts:?}");

    // Who leaves watches, and may ask again only once the server has said so.
    assert!(client.session.leave());
    assert!(!client.session.leave());
    assert!(client.run(|session| !session.is_leaving));
    client.session.play();
    assert!(client.run(|session| session.place() == Some(0)));
}

#[test]
fn a_player_stops_the_room_and_goes_on_where_it_was_and_has_a_film_of_it() {
    let embedded = embedded();
    // As the game asks for on a table of one's own.
    let choice = StreamChoice { form: Some(Form::Inputs), hz: Some(60) };
    let mut client = Client::join_for(&embedded, Role::Play, choice);
    assert!(client.run(|session| session.place() == Some(0) && has_ball(session)), "no ball was served");
    client.controls.key_down(KeyCode::Space);
    client.run_for(1.1);
    client.controls.key_up(KeyCode::Space);
    client.run_for(0.5);
    let before = client.session.counts();
    client.session.pause(true);
    assert!(client.run(Session::is_paused), "the server did not stop");
    let (tick, shown) = (client.session.newest().unwrap().tick(), client.session.boards[0].shown);
    client.controls.key_down(KeyCode::LeftShift);
    client.controls.key_up(KeyCode::LeftShift);
    client.run_for(1.5);
    assert!(client.session.is_paused() && !client.session.is_silent(client.epoch.elapsed().as_secs_f64()));
    // What was under way when it stopped may have come since.
    let stopped = client.session.newest().unwrap().tick();
    assert!((tick..tick + 20).contains(&stopped) && client.session.boards[0].shown == shown);
    client.session.pause(false);
    assert!(client.run(|session| !session.is_paused() && session.newest().unwrap().tick() > tick + 300));
    let counts = client.session.counts();
    assert!(counts.right > before.right + 10 && counts.wrong <= before.wrong + 1, "{before:?} {counts:?}");
    assert_eq!(counts.mismatches, 0);
    // Whoever leaves lets it go on.
    client.session.pause(true);
    assert!(client.run(Session::is_paused));
    client.session.leave();
    assert!(client.run(|session| !session.is_paused() && !session.can_pause()));
    assert!(client.run(|session| session.film().is_some()), "the game that was left has no film");
}

#[test]
fn a_nudge_is_seen_at_once_and_predicted_rightly() {
    let source = &Table::shipped("classic").unwrap().unwrap().source;
    let source = if source.contains("cabinet:") {
        source.clone()
    } else {
        source.replacen("gravity:", "cabinet: (), gravity:", 1)
    };
    let embedded = Embedded::start(Arc::new(Table::parse("classic.ron", &source).unwrap()), None).unwrap();
    let mut client = Client::join(&embedded, Role::Play);
    assert!(client.run(|session| session.place() == Some(0) && has_ball(session)), "no ball was served");
    client.run_for(0.3);
    let cabinet = |session: &Session| session.moment(0).map_or(0.0, |moment| moment.cabinet.x);
    assert_eq!(cabinet(&client.session), 0.0);
    client.controls.key_down(KeyCode::Q);
    std::thread::sleep(Duration::from_millis(16));
    client.run(|_| true);
    assert!(cabinet(&client.session) > 0.0, "the table waited for the server");
    // As fast as two hands can, so that the server has something to hold up.
    for _ in 0..12 {
        for key in [KeyCode::Q, KeyCode::E] {
            client.controls.key_up(key);
            client.controls.key_down(key);
            client.run_for(0.03);
        }
    }
    client.run_for(0.3);
    let counts = client.session.counts();
    assert!(counts.right > 30 && counts.wrong <= 3, "{counts:?}");
}

#[test]
fn a_spectator_sees_the_bot() {
    let embedded = embedded();
    let mut client = Client::join(&embedded, Role::Watch);
    assert!(client.run(|session| has_ball(session) && session.boards[0].events_shown > 0), "the bot did not play");
    let moment = client.session.moment(0).unwrap();
    assert!(matches!(moment.game.phase(), Phase::Play { .. }));
    assert_eq!(client.session.roster().places[0].as_deref(), Some("BOT"));
    assert_eq!((client.session.place(), client.session.roster().spectators), (None, 1));
    assert!(!client.session.leave(), "there is nothing to leave");
}

#[test]
fn a_strange_welcome_is_refused() {
    let table = Table::shipped("classic").unwrap().unwrap();
    let welcome = Welcome {
        room: "test".to_owned(),
        mode: Mode::Challenge,
        places: 4,
        physics: PHYSICS_VERSION,
        table_digest: table.digest,
        table: table.source.clone(),
    };
    let begin = |welcome: &Welcome| Session::new(welcome, StreamChoice::default(), Role::Watch);
    assert!(begin(&welcome).is_ok());
    let other = Welcome { physics: PHYSICS_VERSION + 1, ..welcome.clone() };
    assert!(matches!(begin(&other), Err(SessionError::Physics { .. })));
    let other = Welcome { table_digest: 5, ..welcome.clone() };
    assert!(matches!(begin(&other), Err(SessionError::Digest)));
    let asking = table.source.replacen("name:", "accuracy: (tolerance: 0.0001, horizon: Bounces(5)), name:", 1);
    let digest = Table::parse("asking.ron", &asking).unwrap().digest;
    let other = Welcome { table: asking, table_digest: digest, ..welcome.clone() };
    assert!(matches!(begin(&other), Err(SessionError::Unresolved)));
    let other = Welcome { table: "(".to_owned(), ..welcome };
    assert!(matches!(begin(&other), Err(SessionError::Table(_))));
}
