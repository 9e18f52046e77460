//! A room without sockets: what the modes do, tick by tick.

use super::*;
use crate::lobby::Sitter;
use crate::session::SessionState;
use crate::transport::Outgoing;
use shared::game::replay::Recorder;
use shared::game::{Action, Nudge};
use shared::protocol::{ClientMessage, Form, Hello, Inputs, Role, Roster, Stream, decode_from_server};
use shared::table::{SHIPPED, Table};
use tokio::sync::{mpsc, oneshot};

mod pause;

/// A room, and what it orders to be sent.
struct Stage {
    room: Room,
    orders: mpsc::UnboundedReceiver<Order>,
    inputs: Vec<Inputs>,
    roster: Roster,
}

struct Nowhere;

impl Outgoing for Nowhere {
    fn try_write(&mut self, bytes: &[std::io::IoSlice<'_>]) -> std::io::Result<usize> {
        Ok(bytes.iter().map(|slice| slice.len()).sum())
    }
}

impl Stage {
    fn new(config: Config) -> Self {
        let (sender, orders) = mpsc::unbounded_channel();
        let room = Room::new(Arc::new(config), sender, Arc::default());
        Self { room, orders, inputs: Vec::new(), roster: Roster::default() }
    }

    fn join(&mut self, name: &str, role: Role) -> u32 {
        let (ended, _) = oneshot::channel();
        let (reply, mut joined) = oneshot::channel();
        let hello = Hello { name: name.to_owned(), role, stream: Stream::SPECTATOR };
        self.room.handle(Command::Join { hello, transport: Box::new(Nowhere), ended, reply });
        joined.try_recv().expect("an answer").expect("there is room")
    }

    /// The place of that name in the last roster.
    fn roster_place(&self, name: &str) -> Option<usize> {
        self.roster.places.iter().position(|place| place.as_deref() == Some(name))
    }

    fn say(&mut self, client: u32, message: ClientMessage) {
        self.room.handle(Command::Message { client, message });
    }

    /// Ticks, and what they brought.
    fn run(&mut self, ticks: u64) {
        for _ in 0..ticks {
            self.room.tick();
            while let Ok(order) = self.orders.try_recv() {
                let frame = match order {
                    Order::Frame { frame, .. } | Order::News { frame, .. } => frame,
                    _ => continue,
                };
                // Behind the length, which is of one or two bytes.
                let body = if frame[0] & 0x80 == 0 { &frame[1..] } else { &frame[2..] };
                match decode_from_server(body) {
                    Ok(ServerMessage::Inputs(inputs)) => self.inputs.push(inputs),
                    Ok(ServerMessage::Roster(roster)) => self.roster = roster,
                    _ => {}
                }
            }
        }
    }

    fn run_until(&mut self, what: &str, is_so: impl Fn(&Self) -> bool) {
        for _ in 0..600_000 {
            if is_so(self) {
                return;
            }
            self.run(1);
        }
        panic!("ten minutes passed until {what}");
    }

    fn game(&self) -> &Game {
        &self.room.games[0]
    }
}

/// Classic, but a served ball falls into the drain at once.
fn ball_eater() -> Arc<Table> {
    let source = SHIPPED[0].source.replace("start: (0.494, 0.1145)", "start: (0.237, 0.1)");
    Arc::new(Table::parse("eater", &source).expect("valid"))
}

fn classic() -> Arc<Table> {
    Arc::new(Table::shipped("classic").expect("it is shipped").expect("it is valid"))
}

fn quiet(table: Arc<Table>, mode: Mode) -> Config {
    let mut config = Config::new(table).mode(mode);
    config.attract = false;
    config
}

#[test]
fn who_idles_loses_the_turn_and_keeps_the_room() {
    let mut stage = Stage::new(quiet(classic(), Mode::Challenge));
    stage.join("Ann", Role::Play);
    let bob = stage.join("Bob", Role::Play);
    stage.run_until("Ann's ball is served", |stage| matches!(stage.game().phase(), Phase::Play { serve_in: 0, .. }));
    let begun = stage.game().tick();
    stage.run_until("it is Bob's turn", |stage| stage.game().phase().has_turn(1));
    let waited = stage.game().tick() - begun;
    assert!((30_000..30_010).contains(&waited), "{waited}");
    assert_eq!((stage.roster.places[0].as_deref(), stage.room.account.forfeited), (Some("Ann"), 1));
    // Who does something does not idle.
    stage.run_until("his ball is served", |stage| matches!(stage.game().phase(), Phase::Play { serve_in: 0, .. }));
    for _ in 0..6 {
        stage.run(8_000);
        stage.say(bob, ClientMessage::Act { tick: 0, action: Action::Nudge(Nudge::Forward) });
    }
    stage.run(1);
    assert_eq!(stage.room.account.forfeited, 1);
}

/// Bob tapped a flipper now and then, and Ann's turn never ended.
#[test]
fn nobody_keeps_the_turn_of_another_alive() {
    let mut stage = Stage::new(quiet(classic(), Mode::Challenge));
    stage.join("Ann", Role::Play);
    let bob = stage.join("Bob", Role::Play);
    stage.run_until("Ann's ball is served", |stage| matches!(stage.game().phase(), Phase::Play { serve_in: 0, .. }));
    for _ in 0..4 {
        stage.run(8_000);
        stage.say(bob, ClientMessage::Act { tick: 0, action: Action::Flipper { right: true, pressed: true } });
    }
    assert!(stage.game().phase().has_turn(1), "she has done nothing for 32 s");
}

/// Bob took the place of somebody who had done nothing for 29 s, and lost his ball after one.
#[test]
fn who_takes_a_place_has_all_the_time() {
    let mut stage = Stage::new(quiet(classic(), Mode::Challenge));
    let ann = stage.join("Ann", Role::Play);
    stage.run_until("Ann's ball is served", |stage| matches!(stage.game().phase(), Phase::Play { serve_in: 0, .. }));
    stage.run(29_000);
    let bob = stage.join("Bob", Role::Watch);
    stage.say(ann, ClientMessage::Leave);
    stage.say(bob, ClientMessage::Play);
    stage.run(25_000);
    assert_eq!(stage.room.account.forfeited, 0);
}

#[test]
fn the_winner_stays_the_next_comes_up_and_the_next_game_begins_by_itself() {
    let mut config = quiet(ball_eater(), Mode::Challenge);
    config.places = 2;
    let mut stage = Stage::new(config);
    let names = ["Ann", "Bob", "Cid"].map(|name| stage.join(name, Role::Play));
    stage.run_until("the game is over", |stage| matches!(stage.game().phase(), Phase::Over));
    stage.run(300);
    assert_eq!(stage.roster.places[1].as_deref(), Some("Bob"), "the result stands for a moment");
    stage.say(names[1], ClientMessage::Play);
    stage.run(1_999);
    // Nobody made a point: the first one counts as the winner.
    assert_eq!(stage.roster.places[0].as_deref(), Some("Ann"));
    assert_eq!(stage.roster.places[1].as_deref(), Some("Cid"));
    assert_eq!(stage.roster.champion, Some((0, 1)));
    assert_eq!(stage.room.lobby.state(names[1]), Some((SessionState::Watching, true)));
    // What Bob pressed before he heard of it is no offence.
    stage.say(names[1], ClientMessage::Act { tick: 0, action: Action::Release });
    assert!(stage.room.lobby.state(names[1]).is_some());
    stage.run_until("the next game", |stage| matches!(stage.game().phase(), Phase::Play { .. }));
    assert_eq!(stage.room.account.illegal, 0);
}

#[test]
fn head_to_head_two_boards_begin_in_the_same_tick_and_the_bot_stands_in() {
    let mut config = quiet(classic(), Mode::HeadToHead);
    config.attract = true;
    let mut stage = Stage::new(config);
    assert_eq!(stage.room.games.len(), 2);
    let ann = stage.join("Ann", Role::Play);
    stage.run(1);
    assert!(stage.room.games.iter().all(|game| matches!(game.phase(), Phase::Play { .. })), "both boards play");
    assert_eq!(stage.room.lobby.sitter(1), Some(Sitter::Bot));
    stage.run(5_000);
    stage.say(ann, ClientMessage::Act { tick: 0, action: Action::Flipper { right: false, pressed: true } });
    stage.run(100);
    let of = |board: u8| {
        let all = stage.inputs.iter().flat_map(|inputs| &inputs.inputs);
        all.filter(|input| input.board == board && input.input.action.is_control()).count()
    };
    assert_eq!(of(0), 1, "hers");
    assert!(of(1) > 0, "the bot's");
}

#[test]
fn every_game_is_a_function_of_what_was_sent() {
    let mut config = Config::new(classic()).mode(Mode::HeadToHead);
    config.seed = 3;
    let mut stage = Stage::new(config);
    stage.join("Ann", Role::Watch);
    let ann = stage.join("Bob", Role::Play);
    for n in 0..400_u64 {
        stage.say(
            ann,
            ClientMessage::Act { tick: 0, action: Action::Flipper { right: n % 4 < 2, pressed: n % 2 == 0 } },
        );
        stage.run(97);
    }
    // Until the next frame of the stream.
    stage.run_until("a frame", |stage| stage.inputs.last().is_some_and(|inputs| inputs.to == stage.game().tick()));
    for (board, game) in (0..).zip(&stage.room.games) {
        let sent = stage.inputs.iter().flat_map(|inputs| &inputs.inputs);
        let inputs: Vec<Input> = sent.filter(|input| input.board == board).map(|input| input.input).collect();
        let mut copy = Game::new(classic());
        let mut recorder = Recorder::new(&classic(), 3);
        while copy.tick() < game.tick() {
            let due = inputs.iter().filter(|input| input.tick == copy.tick()).copied().collect::<Vec<_>>();
            copy.step(&due);
            recorder.after_step(&copy, &due);
        }
        assert_eq!(copy.digest(), game.digest(), "board {board}");
        let replay = recorder.finish(&copy).expect("every step was recorded");
        let played = replay.play(classic(), |_| {}).expect("it arrives where it says");
        assert_eq!(played.digest(), game.digest());
    }
}

#[test]
fn a_request_for_a_full_snapshot_is_heeded_once_a_second() {
    let mut stage = Stage::new(quiet(classic(), Mode::Challenge));
    let ann = stage.join("Ann", Role::Watch);
    stage.run(2_000);
    let mut given = 0;
    for _ in 0..30 {
        while stage.orders.try_recv().is_ok() {}
        stage.say(ann, ClientMessage::Differs { tick: 1_000, digest: 5 });
        given += usize::from(matches!(stage.orders.try_recv(), Ok(Order::Switch { .. })));
        stage.run(100);
    }
    assert_eq!((given, stage.room.account.differing), (3, 30));
}

/// A flood of valid messages made the server send a full snapshot for each.
#[test]
fn a_flood_of_wishes_costs_one_full_snapshot_a_second_and_the_last_one_is_heeded() {
    let mut stage = Stage::new(quiet(classic(), Mode::Challenge));
    let ann = stage.join("Ann", Role::Watch);
    stage.run(1);
    while stage.orders.try_recv().is_ok() {}
    let mut switches = Vec::new();
    for n in 0..300_u64 {
        let hz = if n % 2 == 0 { 60 } else { 30 };
        stage.say(ann, ClientMessage::Stream(Stream { form: Form::State, hz }));
        stage.say(ann, ClientMessage::Differs { tick: 1, digest: 0 });
        for _ in 0..10 {
            stage.room.tick();
            while let Ok(order) = stage.orders.try_recv() {
                if let Order::Switch { stream, .. } = order {
                    switches.push(stream);
                }
            }
        }
    }
    assert!((3..=4).contains(&switches.len()), "in three seconds: {switches:?}");
    stage.say(ann, ClientMessage::Stream(Stream::SPECTATOR));
    stage.run(1_001);
    assert_eq!(stage.room.followers[&ann].stream, Stream::SPECTATOR);
    while stage.orders.try_recv().is_ok() {}
    stage.say(ann, ClientMessage::Stream(Stream::SPECTATOR));
    assert!(stage.orders.try_recv().is_err(), "what it has already is nothing new");
}

/// Whoever asked for a place and gave it back all the time had everybody in line told each time.
#[test]
fn coming_and_going_all_the_time_is_nobodys_business() {
    let mut stage = Stage::new(quiet(classic(), Mode::Challenge));
    stage.room.lobby = Lobby::new(Mode::Challenge, 1, false, Arc::new(Chatter::new("a test")));
    stage.join("Ann", Role::Play);
    let eve = stage.join("Eve", Role::Play);
    for n in 0..200 {
        stage.join(&format!("Bob {n}"), Role::Play);
    }
    stage.run(2_000);
    while stage.orders.try_recv().is_ok() {}
    let mut told = 0;
    for _ in 0..100 {
        stage.say(eve, ClientMessage::Leave);
        stage.say(eve, ClientMessage::Play);
        for _ in 0..10 {
            stage.room.tick();
            while let Ok(order) = stage.orders.try_recv() {
                told += usize::from(matches!(order, Order::Tell { .. } | Order::Hurry { .. }));
            }
        }
    }
    // She is at the end of the line after the first time; then everybody has moved up once, and that is all.
    assert!((200..220).contains(&told), "{told}");
}

#[test]
fn every_difference_is_counted_and_found_with_both_digests() {
    let mut stage = Stage::new(quiet(classic(), Mode::Challenge));
    let ann = stage.join("Ann", Role::Watch);
    stage.run(1_000);
    // At any tick that a frame led to, the ones of periodic full snapshots too.
    let tick = stage.game().tick();
    stage.run_until("a frame", |stage| stage.inputs.last().is_some_and(|inputs| inputs.to > tick));
    let with_digest = stage.inputs.iter().rev().find(|inputs| inputs.digest.is_some());
    let sent = with_digest.and_then(|inputs| Some((inputs.to, inputs.digest?))).expect("a digest");
    assert_eq!(stage.room.streams.digest_at(sent.0), Some(sent.1));
    for _ in 0..5 {
        stage.say(ann, ClientMessage::Differs { tick: sent.0, digest: 5 });
    }
    stage.say(ann, ClientMessage::Differs { tick: sent.0, digest: 0 });
    assert_eq!((stage.room.account.differing, stage.room.account.gaps), (5, 1));
}

/// Whoever had the last place in line came up while the result stood, and nobody began a game for the two.
#[test]
fn who_comes_up_while_the_result_stands_gets_a_game() {
    let mut config = quiet(ball_eater(), Mode::Challenge);
    config.places = 2;
    let mut stage = Stage::new(config);
    let ann = stage.join("Ann", Role::Play);
    stage.join("Bob", Role::Play);
    stage.run_until("a ball", |stage| !stage.game().is_at_start());
    stage.join("Cid", Role::Play);
    stage.run_until("the game is over", |stage| matches!(stage.game().phase(), Phase::Over));
    stage.say(ann, ClientMessage::Leave);
    stage.run(10);
    assert_eq!(stage.roster_place("Cid"), Some(0));
    stage.run_until("the next game", |stage| matches!(stage.game().phase(), Phase::Play { .. }));
}

/// Whoever was left when the others had gone made room as if they had played alone.
#[test]
fn who_wins_because_the_others_left_stays() {
    let mut config = quiet(ball_eater(), Mode::Challenge);
    config.places = 2;
    let mut stage = Stage::new(config);
    let ann = stage.join("Ann", Role::Play);
    stage.join("Bob", Role::Play);
    stage.run_until("a ball", |stage| !stage.game().is_at_start());
    stage.say(ann, ClientMessage::Leave);
    let names = ["Cid", "Dan"];
    for name in names {
        stage.join(name, Role::Play);
    }
    stage.run_until("the game is over", |stage| matches!(stage.game().phase(), Phase::Over));
    stage.run(2_500);
    assert_eq!((stage.roster_place("Bob"), stage.roster_place("Cid")), (Some(1), Some(0)));
    assert_eq!(stage.roster.champion, Some((1, 1)));
}

#[test]
fn who_comes_to_play_takes_no_vote_along() {
    let mut stage = Stage::new(quiet(classic(), Mode::Crowd));
    stage.join("Ann", Role::Play);
    let bob = stage.join("Bob", Role::Watch);
    stage.run(1_000);
    stage.say(bob, ClientMessage::Vote { action: 0 });
    assert!(stage.room.votes.take_tally(5).is_some_and(|tally| tally.votes[0] == 1));
    let ann = stage.room.lobby.sitter(0);
    if let Some(Sitter::Client(ann)) = ann {
        stage.say(bob, ClientMessage::Play);
        stage.say(ann, ClientMessage::Leave);
    }
    stage.run(1);
    assert_eq!(stage.room.lobby.sitter(0), Some(Sitter::Client(bob)));
    assert!(stage.room.votes.count(u64::MAX, 5, |_| true).is_none(), "nobody votes against themselves");
}

/// The last player left, the next one began within the same tick, and the votes against the one went on against the other.
#[test]
fn votes_end_with_the_game_that_they_were_for() {
    let mut stage = Stage::new(quiet(classic(), Mode::Crowd));
    let ann = stage.join("Ann", Role::Play);
    stage.join("Bob", Role::Play);
    let cid = stage.join("Cid", Role::Watch);
    stage.run(1_000);
    stage.say(cid, ClientMessage::Vote { action: 0 });
    stage.say(ann, ClientMessage::Leave);
    stage.run(1);
    assert_eq!((stage.room.account.games, stage.room.is_playing()), (2, true));
    assert!(stage.room.votes.count(u64::MAX, 5, |_| true).is_none());
}

/// A connection that ended while it waited to be let in kept its place for ever.
#[test]
fn who_is_gone_before_the_answer_is_forgotten() {
    let mut stage = Stage::new(quiet(classic(), Mode::Challenge));
    let (ended, _) = oneshot::channel();
    let (reply, joined) = oneshot::channel();
    drop(joined);
    let hello = Hello { name: "Ann".to_owned(), role: Role::Play, stream: Stream::SPECTATOR };
    stage.room.handle(Command::Join { hello, transport: Box::new(Nowhere), ended, reply });
    stage.run(1);
    assert_eq!((stage.room.lobby.len(), stage.room.followers.len(), stage.room.lobby.has_people()), (0, 0, false));
}
