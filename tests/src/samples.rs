//! Good messages, tables and replays: what fuzzing starts from.

use std::path::Path;
use std::sync::{Arc, OnceLock};

use shared::game::replay::Recorder;
use shared::game::{Action, Bot, Game, GameState, Input, Nudge, SEATS};
use shared::physics::PHYSICS_VERSION;
use shared::protocol::{
    BoardEvent, BoardInput, Boards, ClientMessage, Full, Hello, Inputs, Mode, Role, Roster, ServerMessage, Stream,
    Tally, Welcome, encode, encode_from_server, encode_greeting, framed,
};
use shared::table::{SHIPPED, Table};

/// The classic table.
///
/// # Panics
/// If it is not shipped, or not valid.
pub fn classic() -> &'static Arc<Table> {
    static CLASSIC: OnceLock<Arc<Table>> = OnceLock::new();
    CLASSIC.get_or_init(|| Arc::new(Table::shipped("classic").expect("it is shipped").expect("it is valid")))
}

/// First frames of either side.
pub fn frames() -> Vec<Vec<u8>> {
    let hellos = [("Ann", Role::Play), ("名前", Role::Watch)]
        .map(|(name, role)| encode_greeting(&Hello { name: name.to_owned(), role, stream: Stream::of(role) }));
    let refused = encode_greeting(&ServerMessage::Refused { reason: "full".to_owned() });
    let welcome = Welcome {
        room: "main".to_owned(),
        mode: Mode::Crowd,
        places: 1,
        physics: PHYSICS_VERSION,
        table_digest: 3,
        table: "(format: 1)".to_owned(),
    };
    let welcome = encode_greeting(&ServerMessage::Welcome(welcome));
    let foreign = b"GET / HTTP/1.1\r\nHost: localhost\r\n\r\n".to_vec();
    let mut frames = [&hellos[..], &[refused, welcome, foreign, Vec::new()]].concat();
    frames.extend(messages().into_iter().filter(|message| message.len() < 200));
    // As they stand on a stream, some in a row.
    let row: Vec<u8> = frames.iter().take(6).flat_map(|frame| framed(frame)).collect();
    frames.push(row);
    frames
}

/// Every message of a client, and of a server in a game that is played.
pub fn messages() -> Vec<Vec<u8>> {
    let actions = [
        Action::Flipper { right: true, pressed: true },
        Action::Pull(300),
        Action::Release,
        Action::Nudge(Nudge::Forward),
        Action::Sit,
        Action::Forfeit,
        Action::Crowd(3),
    ];
    let acts = actions.map(|action| encode(&ClientMessage::Act { tick: 70_000, action }));
    let others = [
        ClientMessage::Play,
        ClientMessage::Leave,
        ClientMessage::Ping { nonce: u64::MAX },
        ClientMessage::Stream(Stream::PLAYER),
        ClientMessage::Differs { tick: 70_000, digest: u64::MAX },
        ClientMessage::Vote { action: 1 },
        ClientMessage::Pause(true),
    ];
    let mut places = <[Option<String>; SEATS]>::default();
    places[1] = Some("a".to_owned());
    let roster = Roster { places, line: vec!["b".to_owned()], waiting: 1, spectators: 3, champion: Some((1, 2)) };
    let from_server = [
        ServerMessage::Roster(roster),
        ServerMessage::Tally(Tally { votes: vec![1, 70_000], closes: Some(9) }),
        ServerMessage::You { client: 70_000, place: Some(1), line: Some(2) },
        ServerMessage::Pong { nonce: 1, tick: 2 },
        ServerMessage::Bye { reason: "end".to_owned() },
        ServerMessage::Paused(false),
    ];
    let mut messages = acts.to_vec();
    messages.extend(others.iter().map(encode));
    messages.extend(from_server.iter().map(encode_from_server));
    messages.extend(streams().iter().map(encode_from_server));
    messages
}

/// Frames of both forms of a game's stream: the ball on the plunger, in flight, on a flipper, between two balls.
pub fn streams() -> Vec<ServerMessage> {
    let (mut frames, mut events, mut inputs) = (Vec::new(), Vec::new(), Vec::new());
    let (mut boards, mut from) = (base(), 0);
    play(5, 12_000, |game, pressed| {
        events.extend(game.events().iter().map(|&event| BoardEvent { board: 0, event }));
        inputs.extend(pressed.iter().map(|&input| BoardInput { board: 0, input }));
        if game.tick().is_multiple_of(997) {
            let state = [game.state()];
            frames.push(ServerMessage::Full(Box::new(Full::of("main", std::slice::from_ref(game)))));
            let change = boards.change_to(&state, std::mem::take(&mut events));
            frames.push(ServerMessage::Change(Box::new(change)));
            let (digest, inputs) = (Some(game.digest()), std::mem::take(&mut inputs));
            frames.push(ServerMessage::Inputs(Inputs { from, to: game.tick(), digest, inputs }));
            from = game.tick();
        }
    });
    frames
}

/// The states that the first change of [`streams`] applies to.
pub fn base() -> Boards {
    Boards::new(&[Game::new(Arc::clone(classic())).state()])
}

/// A game's moments.
pub fn states() -> Vec<GameState> {
    let mut states = Vec::new();
    play(6, 30_000, |game, _| {
        if game.tick() % 499 == 0 {
            states.push(game.state());
        }
    });
    states
}

/// Texts of tables and scenes: what is shipped, and what the tests play.
///
/// # Panics
/// If the scenes are not where they belong.
pub fn tables() -> Vec<String> {
    let mut tables: Vec<_> = SHIPPED.iter().map(|shipped| shipped.source.to_owned()).collect();
    let shared = Path::new(env!("CARGO_MANIFEST_DIR")).join("../shared");
    for folder in ["tables/scenes", "tests/truth/scenes"] {
        let files = std::fs::read_dir(shared.join(folder)).expect("there are scenes");
        let mut paths: Vec<_> = files.map(|file| file.expect("a file").path()).collect();
        paths.sort();
        tables.extend(paths.iter().map(|path| std::fs::read_to_string(path).expect("a text")));
    }
    tables
}

/// Texts of replays: seconds of the bot's games.
///
/// # Panics
/// If a game cannot be recorded.
pub fn replays() -> Vec<String> {
    (1..=10)
        .map(|seed| {
            let mut recorder = Recorder::new(classic(), seed).every(200);
            let game = play(seed, 220 * seed, |game, inputs| recorder.after_step(game, inputs));
            recorder.finish(&game).expect("every step was recorded").to_text()
        })
        .collect()
}

/// A game of the bot and somebody who nudges now and then.
fn play(seed: u64, ticks: u64, mut each: impl FnMut(&Game, &[Input])) -> Game {
    let mut game = Game::new(Arc::clone(classic()));
    let mut bot = Bot::new(0, seed);
    while game.tick() < ticks {
        let tick = game.tick();
        let mut inputs = Vec::new();
        let mut act = |action| inputs.push(Input { tick, seat: 0, action });
        match tick {
            0 => [Action::Sit, Action::Start].map(&mut act),
            _ if tick.is_multiple_of(1501) => {
                [Action::Nudge(Nudge::FromLeft), Action::Nudge(Nudge::Forward)].map(&mut act)
            }
            _ => [(), ()],
        };
        bot.play(&game, act);
        game.step(&inputs);
        each(&game, &inputs);
    }
    game
}
