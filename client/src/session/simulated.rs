//! A session without sockets: it is fed with the frames of a room that is simulated, at times that a test decides.

use shared::game::{Action, Bot, GameEventKind, Input};
use shared::protocol::{BoardInput, Boards, Change, Full, Inputs, REQUEST_SECONDS, digest_of_room};

use super::*;
use crate::controls::Controls;

mod pause;

const DT: f64 = 0.001;
const STATE: Stream = Stream::PLAYER;
const INPUTS: Stream = Stream::SPECTATOR;

fn classic() -> Arc<Table> {
    Arc::new(Table::shipped("classic").unwrap().unwrap())
}

/// A server's room whose boards bots play, and one session that watches it or has a place.
struct Room {
    games: Vec<Game>,
    bots: Vec<Bot>,
    stream: Stream,
    boards: Boards,
    since: Vec<BoardInput>,
    from: u64,
    session: Session,
    controls: Controls,
    sent: Vec<ClientMessage>,
    /// Seconds that a frame takes.
    way: f64,
    /// Frames that are under way, and when they arrive.
    on_the_way: std::collections::VecDeque<(f64, ServerMessage)>,
    /// The next digest that is sent is a wrong one.
    lies: bool,
    /// Seconds for which it stood still.
    stood: f64,
}

impl Room {
    fn new(mode: Mode, boards: usize, choice: StreamChoice, role: Role) -> Self {
        let table = classic();
        let welcome = Welcome {
            room: "test".to_owned(),
            mode,
            places: boards.max(1) as u8,
            physics: PHYSICS_VERSION,
            table_digest: table.digest,
            table: table.source.clone(),
        };
        let mut room = Self {
            games: (0..boards).map(|_| Game::new(Arc::clone(&table))).collect(),
            bots: (0..boards).map(|board| Bot::new(0, board as u64)).collect(),
            stream: choice.stream(role),
            boards: Boards::default(),
            since: Vec::new(),
            from: 0,
            session: Session::new(&welcome, choice, role).unwrap(),
            controls: Controls::default(),
            sent: Vec::new(),
            way: 0.02,
            on_the_way: Default::default(),
            lies: false,
            stood: 0.0,
        };
        room.begin();
        room
    }

    fn now(&self) -> f64 {
        self.games[0].tick() as f64 * DT + self.stood
    }

    fn send(&mut self, message: ServerMessage) {
        self.on_the_way.push_back((self.now() + self.way, message));
    }

    /// A stream begins.
    fn begin(&mut self) {
        let full = Full::of("test", &self.games);
        self.boards = Boards::new(&full.boards);
        self.from = self.games[0].tick();
        self.since.clear();
        self.send(ServerMessage::Full(Box::new(full)));
    }

    fn frame(&mut self) -> ServerMessage {
        let (from, to) = (self.from, self.games[0].tick());
        self.from = to;
        let inputs = std::mem::take(&mut self.since);
        if self.stream.form == Form::State {
            let states: Vec<_> = self.games.iter().map(Game::state).collect();
            let change: Change = self.boards.change_to(&states, Vec::new());
            return ServerMessage::Change(Box::new(change));
        }
        let digest = if std::mem::take(&mut self.lies) { 1 } else { digest_of_room(&self.games) };
        ServerMessage::Inputs(Inputs { from, to, digest: Some(digest), inputs })
    }

    /// A millisecond of the server, and every sixtieth of a second a frame of the client.
    fn step(&mut self) {
        self.step_unseen();
        if STATE.is_due(self.games[0].tick(), DT) {
            self.draw();
        }
    }

    /// A millisecond of the server, and nothing is drawn.
    fn step_unseen(&mut self) {
        for (board, (game, bot)) in (0..).zip(self.games.iter_mut().zip(&mut self.bots)) {
            let tick = game.tick();
            let mut inputs = Vec::new();
            if !matches!(game.phase(), Phase::Play { .. }) {
                inputs.extend([Action::Sit, Action::Start].map(|action| Input { tick, seat: 0, action }));
            }
            bot.play(game, |action| inputs.push(Input { tick, seat: 0, action }));
            game.step(&inputs);
            self.since.extend(inputs.into_iter().map(|input| BoardInput { board, input }));
        }
        let tick = self.games[0].tick();
        if self.stream.is_due(tick, DT) {
            let frame = self.frame();
            self.send(frame);
        }
        self.deliver();
    }

    fn draw(&mut self) {
        self.session.advance(self.now(), &mut self.controls);
        self.answer();
    }

    fn deliver(&mut self) {
        let now = self.now();
        while self.on_the_way.front().is_some_and(|(arrival, _)| *arrival <= now) {
            let (at, message) = self.on_the_way.pop_front().unwrap();
            self.session.hear(at, message).unwrap();
        }
    }

    /// Does what the client asks for.
    fn answer(&mut self) {
        let asked: Vec<ClientMessage> = self.session.take_outgoing().collect();
        for message in asked {
            match message {
                ClientMessage::Stream(stream) => {
                    self.stream = stream;
                    self.begin();
                }
                ClientMessage::Ping { nonce } => {
                    let tick = self.games[0].tick();
                    self.on_the_way.push_front((self.now(), ServerMessage::Pong { nonce, tick }));
                }
                _ => {}
            }
            self.sent.push(message);
        }
    }

    fn run(&mut self, seconds: f64) {
        let end = self.now() + seconds;
        while self.now() < end {
            self.step();
        }
    }

    fn asks(&self) -> usize {
        self.sent.iter().filter(|message| matches!(message, ClientMessage::Differs { .. })).count()
    }
}

#[test]
fn inputs_that_are_watched_are_stepped_to_the_same_bits_a_little_late() {
    let mut room = Room::new(Mode::HeadToHead, 2, StreamChoice::default(), Role::Watch);
    let mut truth = std::collections::BTreeMap::new();
    let mut compared = 0;
    for _ in 0..20_000 {
        room.step();
        truth.insert(room.games[0].tick(), digest_of_room(&room.games));
        let copies = room.session.feed.games();
        if let Some(tick) = copies.first().map(Game::tick).filter(|tick| *tick > 0) {
            assert_eq!(digest_of_room(copies), truth[&tick], "tick {tick}");
            assert!(tick <= room.session.feed.confirmed());
            let shown = room.session.moment(1).unwrap();
            assert!(shown.at.tick == tick || shown.at.tick == tick + 1, "{} {tick}", shown.at.tick);
            compared += 1;
        }
    }
    let counts = room.session.counts();
    assert!(compared > 19_000 && counts.mismatches == 0, "{compared}: {counts:?}");
    // An interval, the way, what is spared; and the 17 ms of the picture's own pace.
    assert!((0.12..0.15).contains(&(counts.behind.sum / counts.behind.count as f64)), "{:?}", counts.behind);
    assert!(counts.behind.most < 0.16, "{:?}", counts.behind);
    assert!(room.session.boards.iter().all(|board| board.events_shown > 19_000));
    assert_eq!(room.sent.iter().filter(|message| matches!(message, ClientMessage::Ping { .. })).count(), 4);
}

#[test]
fn state_that_is_watched_is_seen_on_every_board() {
    let choice = StreamChoice { form: Some(Form::State), hz: Some(60) };
    let mut room = Room::new(Mode::HeadToHead, 3, choice, Role::Watch);
    room.run(8.0);
    for board in 0..3 {
        let moment = room.session.moment(board).unwrap();
        assert!(room.now() - moment.at.tick as f64 * DT < 0.06);
        assert!(!moment.balls.is_empty(), "board {board}");
    }
    let counts = room.session.counts();
    assert!(counts.behind.most < 0.06 && counts.mismatches == 0 && counts.frames > 400, "{counts:?}");
    let all = room.session.contestants();
    assert_eq!((all.len(), all.iter().filter(|one| one.has_turn).count()), (3, 3));
    assert!(room.session.is_playing() && room.session.outcome().is_none());
    assert_eq!(room.session.main_board(), 0);
    room.session.look(-1);
    assert_eq!(room.session.main_board(), 2);
    room.session.look(1);
    assert_eq!(room.session.main_board(), 0);
}

#[test]
fn a_place_brings_the_stream_of_players_and_its_loss_that_of_spectators() {
    let mut room = Room::new(Mode::HeadToHead, 2, StreamChoice::default(), Role::Watch);
    room.run(3.0);
    for (place, stream) in [(Some(1), STATE), (None, INPUTS), (Some(0), STATE), (None, INPUTS)] {
        room.session.hear(room.now(), ServerMessage::You { client: 1, place, line: None }).unwrap();
        // A full snapshot of the old stream comes in between, as the server sends them now and then.
        room.run(0.005);
        let full = ServerMessage::Full(Box::new(Full::of("test", &room.games)));
        room.send(full);
        room.run(3.0);
        assert_eq!((room.session.feed.stream(), room.session.feed.is_switching()), (stream, false));
        assert_eq!(room.session.main_board(), place.map_or(0, usize::from));
        assert_eq!(room.session.prediction.is_some(), place.is_some());
    }
    let switches = room.sent.iter().filter(|message| matches!(message, ClientMessage::Stream(_))).count();
    assert_eq!((switches, room.asks(), room.session.counts().mismatches), (4, 0, 0));
    assert!(room.session.counts().right > 200, "{:?}", room.session.counts());
}

#[test]
fn what_was_predicted_wrongly_is_heard_once() {
    // The room's bot flips, of which the prediction knows nothing: it is wrong again and again.
    let mut room = Room::new(Mode::Challenge, 1, StreamChoice::default(), Role::Play);
    room.session.hear(0.0, ServerMessage::You { client: 1, place: Some(0), line: None }).unwrap();
    let (mut heard, mut truth) = (0_usize, 0);
    let is_kick = |event: &&GameEvent| matches!(event.kind, GameEventKind::Kicked { .. });
    for _ in 0..60_000 {
        room.step();
        truth += room.games[0].events().iter().filter(is_kick).count();
        heard += room.session.take_fresh().iter().filter(is_kick).count();
    }
    assert!(truth > 20 && room.session.counts().wrong > 20, "{truth} {:?}", room.session.counts());
    // Some are predicted that never come, and some come of which nobody knew.
    assert!(heard.abs_diff(truth) * 10 <= truth, "{heard} kicks were heard of {truth}");
}

#[test]
fn a_stream_that_was_chosen_stays() {
    let choice = StreamChoice { form: Some(Form::Inputs), hz: Some(20) };
    let mut room = Room::new(Mode::Challenge, 1, choice, Role::Play);
    room.session.hear(0.0, ServerMessage::You { client: 1, place: Some(0), line: None }).unwrap();
    room.run(6.0);
    room.session.hear(room.now(), ServerMessage::You { client: 1, place: None, line: None }).unwrap();
    room.run(2.0);
    assert!(!room.sent.iter().any(|message| matches!(message, ClientMessage::Stream(_))));
    let counts = room.session.counts();
    // What is sent are the bot's inputs, of which the prediction knows nothing; but nothing else is wrong.
    assert!(counts.right > 20 && counts.mismatches == 0, "{counts:?}");
}

#[test]
fn a_gap_while_streams_change_is_mended_quietly() {
    let choice = StreamChoice { form: Some(Form::Inputs), hz: None };
    let mut room = Room::new(Mode::Challenge, 1, choice, Role::Watch);
    room.run(2.0);
    room.session.hear(room.now(), ServerMessage::You { client: 1, place: Some(0), line: None }).unwrap();
    // The new stream of the same form begins with a full snapshot that is older than what is known.
    room.session.advance(room.now(), &mut room.controls);
    let old = Full::of("test", &room.games);
    room.run(0.25);
    room.answer();
    room.send(ServerMessage::Full(Box::new(old)));
    room.begin();
    room.run(2.0);
    assert_eq!((room.session.counts().mismatches, room.asks()), (0, 0));
    assert!(!room.session.feed.is_switching());
    assert!(room.now() - room.session.feed.confirmed() as f64 * DT < 0.1);
}

#[test]
fn a_difference_is_told_once_a_second_until_it_is_mended() {
    let mut room = Room::new(Mode::Challenge, 1, StreamChoice::default(), Role::Watch);
    room.run(2.0);
    room.lies = true;
    room.run(3.5);
    assert_eq!((room.session.counts().mismatches, room.asks()), (1, 4), "in {REQUEST_SECONDS} s steps");
    let shown = room.session.feed.tick();
    room.run(0.5);
    assert_eq!(room.session.feed.tick(), shown, "it waits");
    room.begin();
    room.run(1.0);
    assert_eq!((room.session.counts().mismatches, room.asks()), (1, 4));
    assert!(room.now() - room.session.feed.tick() as f64 * DT < 0.2);
    let Some(ClientMessage::Differs { tick, digest }) =
        room.sent.iter().find(|message| matches!(message, ClientMessage::Differs { .. }))
    else {
        panic!("it was asked for")
    };
    assert!(*tick > 1500 && *digest > 1);
}

#[test]
fn the_crowd_votes_where_it_plays_and_sees_its_vote_until_it_is_counted() {
    let votes = |room: &Room| room.sent.iter().filter(|message| matches!(message, ClientMessage::Vote { .. })).count();
    let mut room = Room::new(Mode::Crowd, 1, StreamChoice::default(), Role::Watch);
    room.session.vote(0);
    assert_eq!(room.session.voted(), None, "nobody plays yet");
    room.run(3.0);
    room.session.vote(99);
    room.session.vote(2);
    room.session.vote(1);
    room.run(0.1);
    assert_eq!((votes(&room), room.session.voted()), (2, Some(1)));
    let tally = |closes| ServerMessage::Tally(Tally { votes: vec![0, 1, 0, 0, 0], closes });
    room.session.hear(3.2, tally(Some(9000))).unwrap();
    assert_eq!(room.session.voted(), Some(1));
    room.session.hear(9.2, tally(None)).unwrap();
    assert_eq!(room.session.voted(), None);
    // Not in other modes, and not by who plays.
    room.session.hear(9.3, ServerMessage::You { client: 1, place: Some(0), line: None }).unwrap();
    room.session.vote(1);
    assert_eq!(room.session.voted(), None);
    let mut room = Room::new(Mode::Challenge, 1, StreamChoice::default(), Role::Watch);
    room.run(3.0);
    room.session.vote(1);
    assert_eq!((votes(&room), room.session.voted()), (0, None));
}

#[test]
fn a_server_that_tells_more_time_than_passes_holds_up_no_picture() {
    for (choice, place) in [(None, None), (Some(Form::Inputs), Some(0))] {
        let choice = StreamChoice { form: choice, hz: None };
        let mut room = Room::new(Mode::Challenge, 1, choice, Role::Watch);
        room.run(2.0);
        room.session.hear(room.now(), ServerMessage::You { client: 1, place, line: None }).unwrap();
        room.run(1.0);
        let mut from = room.session.feed.confirmed();
        for _ in 0..256 {
            let (to, digest, inputs) = (from + 2000, None, Vec::new());
            room.session.hear(room.now(), ServerMessage::Inputs(Inputs { from, to, digest, inputs })).unwrap();
            from = to;
        }
        for picture in 0..10 {
            let before = room.session.feed.tick();
            room.session.advance(room.now() + f64::from(picture) / 60.0, &mut room.controls);
            assert!(room.session.feed.tick() - before <= 250, "{place:?}: picture {picture}");
        }
        assert!(room.session.feed.confirmed() > 512_000);
    }
}

#[test]
fn after_a_while_in_which_nothing_was_drawn_the_next_full_snapshot_is_where_it_goes_on() {
    let mut room = Room::new(Mode::Challenge, 1, StreamChoice::default(), Role::Watch);
    room.run(2.0);
    // Frames come in, and nobody looks.
    let end = room.now() + 8.0;
    while room.now() < end {
        room.step_unseen();
    }
    assert!(room.session.feed.tick() as f64 * DT < 2.1);
    let full = ServerMessage::Full(Box::new(Full::of("test", &room.games)));
    room.send(full);
    room.run(1.0);
    assert!(room.now() - room.session.feed.tick() as f64 * DT < 0.2);
    assert_eq!((room.session.counts().mismatches, room.asks()), (0, 0));
}

/// They were kept for as long as the connection stood.
#[test]
fn what_happens_on_boards_that_are_not_heard_is_not_kept() {
    let mut room = Room::new(Mode::HeadToHead, 2, StreamChoice::default(), Role::Watch);
    let mut heard = 0;
    for _ in 0..80 {
        room.run(0.1);
        heard += room.session.take_fresh().len();
        assert!(room.session.boards.iter().all(|board| board.fresh.is_empty()));
    }
    assert!(heard > 10, "{heard}");
}
