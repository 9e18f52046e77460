//! What must hold for whatever bytes come from outside. Each function panics when it does not; they are called by the fuzz
//! targets in `tests/fuzz` and, with seeded mutations, by `cargo test`.

use std::sync::Arc;
use std::time::{Duration, Instant};

use serde::Serialize;
use serde::de::DeserializeOwned;
use shared::game::replay::{Recorder, Replay};
use shared::game::{Action, Game, GameState, Input, Nudge};
use shared::protocol::{
    ClientMessage, Deframer, Follower, Full, Hello, MOST_FROM_CLIENT, PREAMBLE_LENGTH, Preamble, ServerMessage, decode,
    decode_from_server, decode_greeting, decode_welcome, encode, encode_from_server,
};
use shared::table::Table;

use crate::samples::{base, classic};

/// Ticks for which a game is stepped that came from outside.
const TICKS: u64 = 200;
/// Most ticks of a replay that is played: what is longer is only read and written.
const MOST_REPLAY_TICKS: u64 = 3000;
/// Most characters of a complaint.
const MOST_COMPLAINT: usize = 1000;
/// Longest time for one input: a bug if it takes longer, on any machine and with any sanitizer.
const MOST_TIME: Duration = Duration::from_secs(20);
/// Time after which a table is not stepped on: it may well ask for a million parts in a tick.
const TABLE_TIME: Duration = Duration::from_millis(500);

/// The first frame of either side, any frame as what it is not, and frames on a stream.
pub fn frame(data: &[u8]) {
    let whole = frames_of(data, data.len().max(1));
    assert_eq!(frames_of(data, 1), whole, "other frames when they come byte by byte");
    assert!(whole.iter().all(|frame| frame.len() <= MOST_FROM_CLIENT));
    if let Ok(preamble) = Preamble::from_bytes(data) {
        assert_eq!(preamble.to_bytes()[..], data[..PREAMBLE_LENGTH]);
    }
    let ours = [&Preamble::ours().to_bytes()[..], data].concat();
    for frame in [data, &ours] {
        if let Err(error) = decode_greeting::<Hello>(frame) {
            readable(&error.to_string());
        }
        if let Err(error) = decode_welcome(frame) {
            readable(&error.to_string());
        }
    }
    let whole = [&ours, &[0][..]].concat();
    assert!(
        decode_greeting::<Hello>(&ours).is_err() || decode_greeting::<Hello>(&whole).is_err(),
        "a byte behind a message is no part of it"
    );
}

/// The frames in a stream that comes in so many bytes at once, up to what is none.
fn frames_of(data: &[u8], at_once: usize) -> Vec<Vec<u8>> {
    let (mut deframer, mut frames) = (Deframer::new(MOST_FROM_CLIENT), Vec::new());
    for bytes in data.chunks(at_once) {
        deframer.space().extend_from_slice(bytes);
        loop {
            match deframer.next_frame() {
                Ok(Some(frame)) => frames.push(frame.to_vec()),
                Ok(None) => break,
                Err(error) => {
                    readable(&error.to_string());
                    return frames;
                }
            }
        }
    }
    frames
}

/// Frames after the first: a message that can be read is written and read again as the same, and a game goes on from what it
/// says.
pub fn message(data: &[u8]) {
    read_again::<ClientMessage>(data);
    read_again::<Hello>(data);
    let message = match decode_from_server(data) {
        Ok(message) => message,
        Err(error) => return readable(&error.to_string()),
    };
    let bytes = encode_from_server(&message);
    let again = decode_from_server(&bytes).expect("own bytes are a message");
    assert_eq!(encode_from_server(&again), bytes, "it is another message when it is read again");
    match message {
        ServerMessage::Full(full) => {
            follow(&ServerMessage::Full(full.clone()));
            full.boards.into_iter().for_each(go_on_from);
        }
        ServerMessage::Change(change) => {
            match base().apply(&change) {
                Ok(states) => states.into_iter().for_each(go_on_from),
                Err(error) => readable(&error.to_string()),
            }
            follow(&ServerMessage::Change(change));
        }
        other => follow(&other),
    }
}

/// A receiver in the middle of a stream takes it, or says in plain words why not, and stays what it was or waits.
fn follow(message: &ServerMessage) {
    let began = Instant::now();
    let mut follower = Follower::new(Arc::clone(classic()));
    let game = Game::new(Arc::clone(classic()));
    let first = follower.hear_full(&Full::of("main", std::slice::from_ref(&game)));
    first.expect("a full snapshot of a new game");
    let complaint = match message {
        ServerMessage::Full(full) => follower.hear_full(full).err(),
        ServerMessage::Change(change) => follower.hear_change(change).err(),
        ServerMessage::Inputs(inputs) => follower.hear_inputs(inputs).err(),
        _ => None,
    };
    if let Some(complaint) = complaint {
        readable(&complaint.to_string());
    }
    let tick = follower.tick();
    if follower.advance(tick.saturating_add(TICKS), |_, _| {}).is_err() {
        assert!(follower.waits(), "it goes on with a copy that differs");
    }
    in_time(began);
}

/// A game's state alone.
pub fn state(data: &[u8]) {
    if let Some(state) = read_again::<GameState>(data) {
        go_on_from(state);
    }
}

/// A table's text: it is refused in plain words, or can be played on.
pub fn table(data: &[u8]) {
    let Ok(source) = str::from_utf8(data) else { return };
    let began = Instant::now();
    let table = match Table::parse("some.ron", source) {
        Ok(table) => table,
        Err(error) => {
            in_time(began);
            return readable(&error.to_string());
        }
    };
    assert!(
        Table::parse("some.ron", source).is_ok_and(|again| again.digest == table.digest),
        "refused the second time"
    );
    let mut game = Game::new(Arc::new(table));
    for _ in 0..TICKS {
        game.step(&hands(game.tick()));
        if began.elapsed() > TABLE_TIME {
            break;
        }
    }
    in_time(began);
}

/// A replay's text: it is refused in plain words, or it is written again as the same, and its inputs make a game whose
/// recording is a proof of itself.
pub fn replay(data: &[u8]) {
    let Ok(source) = str::from_utf8(data) else { return };
    let began = Instant::now();
    let replay = match Replay::parse("some.replay", source) {
        Ok(replay) => replay,
        Err(error) => {
            in_time(began);
            return readable(&error.to_string());
        }
    };
    let text = replay.to_text();
    assert_eq!(Replay::parse("own.replay", &text).as_ref(), Ok(&replay), "its own text is another replay");
    if replay.ticks() > MOST_REPLAY_TICKS {
        return;
    }
    if let Err(error) = replay.play(Arc::clone(classic()), |_| {}) {
        readable(&error.to_string());
    }
    // Whatever table, physics and digests it claims: its inputs alone are a game.
    let mut game = Game::new(Arc::clone(classic()));
    let mut recorder = Recorder::new(game.table(), replay.seed()).every(500);
    while game.tick() < replay.ticks() {
        let now: Vec<_> = replay.inputs().iter().filter(|input| input.tick == game.tick()).copied().collect();
        game.step(&now);
        recorder.after_step(&game, &now);
    }
    let recorded = recorder.finish(&game).expect("every step was recorded");
    assert_eq!(recorded.inputs(), replay.inputs());
    let again = recorded.play(Arc::clone(classic()), |_| {}).expect("a recording is true");
    assert_eq!(again.digest(), game.digest());
    in_time(began);
}

/// A message that can be read, and is the same when it is written and read again.
fn read_again<T: Serialize + DeserializeOwned>(data: &[u8]) -> Option<T> {
    match decode::<T>(data) {
        Ok(message) => {
            // Compared as bytes, since a number in it may be NaN.
            let bytes = encode(&message);
            let again: T = decode(&bytes).expect("own bytes are a message");
            assert_eq!(encode(&again), bytes, "it is another message when it is read again");
            Some(message)
        }
        Err(error) => {
            readable(&error.to_string());
            None
        }
    }
}

/// A state from outside is refused, or a game goes on from it; whoever joins it half-way sees the same game.
fn go_on_from(state: GameState) {
    let began = Instant::now();
    let mut game = Game::new(Arc::clone(classic()));
    let untouched = game.digest();
    if let Err(error) = game.restore(state) {
        assert_eq!(game.digest(), untouched, "it was refused, and yet changed the game");
        return readable(&error.to_string());
    }
    let mut late = game.clone();
    for step in 0..TICKS {
        if step % (TICKS / 4) == 0 {
            let sent = encode(&game.state());
            let state = decode::<GameState>(&sent).expect("own bytes are a state");
            late = Game::new(Arc::clone(classic()));
            late.restore(state).expect("a state that was arrived at is valid");
        }
        let hands = hands(game.tick());
        game.step(&hands);
        late.step(&hands);
    }
    assert_eq!(game.digest(), late.digest(), "who joined late sees another game");
    in_time(began);
}

/// What two players do at a tick to whatever game it is.
fn hands(tick: u64) -> Vec<Input> {
    let actions: &[Action] = match tick % 40 {
        0 => &[Action::Sit, Action::Start],
        5 => &[Action::Flipper { right: true, pressed: true }, Action::Pull(u16::MAX)],
        8 => &[Action::Flipper { right: false, pressed: true }],
        15 => &[Action::Nudge(Nudge::FromLeft)],
        25 => &[Action::Flipper { right: true, pressed: false }, Action::Release],
        30 => &[Action::Flipper { right: false, pressed: false }],
        _ => &[],
    };
    let of_seat = |seat| actions.iter().map(move |&action| Input { tick, seat, action });
    (0..2).flat_map(of_seat).collect()
}

/// A complaint fits a log and a terminal, whatever it quotes.
fn readable(complaint: &str) {
    let length = complaint.chars().count();
    assert!(length < MOST_COMPLAINT, "a complaint of {length} characters: {complaint:.200}...");
    let is_hidden = |c: char| c.is_control() || matches!(c, '\u{200b}'..='\u{200f}' | '\u{2028}'..='\u{202e}');
    assert!(!complaint.chars().any(is_hidden), "a complaint that a terminal would obey: {complaint:?}");
}

fn in_time(began: Instant) {
    let took = began.elapsed();
    assert!(took < MOST_TIME, "it took {took:?}");
}
