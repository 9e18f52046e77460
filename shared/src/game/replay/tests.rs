//! Replays: the text and back, play bit for bit, whatever was changed is found, and nothing hostile gets far.

use std::sync::Arc;

use super::text::ReplayFile;
use super::{Checkpoint, FORMAT_VERSION, MOST_CHECKPOINTS, MOST_INPUTS, MOST_TEXT, MOST_TICKS};
use super::{Recorder, Replay, ReplayError};
use crate::game::{Action, Bot, Game, Input, Phase};
use crate::math::Rng;
use crate::physics::PHYSICS_VERSION;
use crate::table::Table;

pub(super) fn classic() -> Arc<Table> {
    match Table::shipped("classic") {
        Some(Ok(table)) => Arc::new(table),
        other => panic!("{other:?}"),
    }
}

/// A game of the bot with its replay, checkpoints every so many ticks; `each` sees the game after every step.
fn record(ticks: u64, every: u64, mut each: impl FnMut(&Game)) -> (Game, Replay) {
    let table = classic();
    let (mut game, mut bot) = (Game::new(Arc::clone(&table)), Bot::new(0, 1));
    let mut recorder = Recorder::new(&table, 1).every(every);
    let mut inputs = Vec::new();
    for tick in 0..ticks {
        inputs.clear();
        let mut act = |action| inputs.push(Input { tick, seat: 0, action });
        if tick == 0 {
            act(Action::Sit);
        }
        if !matches!(game.phase(), Phase::Play { .. }) {
            act(Action::Start);
        }
        bot.play(&game, act);
        game.step(&inputs);
        recorder.after_step(&game, &inputs);
        each(&game);
    }
    match recorder.finish(&game) {
        Ok(replay) => (game, replay),
        Err(error) => panic!("{error}"),
    }
}

fn read(text: &str) -> Replay {
    Replay::parse("game.ron", text).unwrap_or_else(|error| panic!("{error}"))
}

/// The line and the problem for which a text is refused.
fn refused(text: &str) -> (usize, String) {
    match Replay::parse("game.ron", text) {
        Err(ReplayError::Text { file, line, problem }) if file == "game.ron" => (line, problem),
        other => panic!("{other:?}"),
    }
}

/// A well-formed replay of nothing in particular.
fn made_up() -> Replay {
    let input = |tick, seat, action| Input { tick, seat, action };
    Replay(ReplayFile {
        format: FORMAT_VERSION,
        physics: 7,
        table: "A \"table\"".to_owned(),
        table_digest: 0xfedc_ba98_7654_3210,
        seed: u64::MAX,
        ticks: 250,
        checkpoints: vec![Checkpoint { tick: 100, digest: u64::MAX }, Checkpoint { tick: 250, digest: 5 }],
        inputs: vec![
            input(0, 1, Action::Sit),
            input(0, 1, Action::Start),
            input(17, 1, Action::Flipper { right: true, pressed: false }),
            input(17, 1, Action::Pull(65_535)),
            input(17, 1, Action::Forfeit),
            input(17, 255, Action::Crowd(3)),
            input(249, 255, Action::Release),
        ],
    })
}

const MADE_UP: &str = r#"(
    format: 1,
    physics: 7,
    table: "A \"table\"",
    table_digest: "fedcba9876543210",
    seed: 18446744073709551615,
    ticks: 250,
    checkpoints: [
        (tick: 100, digest: "ffffffffffffffff"),
        (tick: 250, digest: "0000000000000005"),
    ],
    inputs: [
        (tick: 0, seat: 1, action: Sit),
        (tick: 0, seat: 1, action: Start),
        (tick: 17, seat: 1, action: Flipper(right: true, pressed: false)),
        (tick: 17, seat: 1, action: Pull(65535)),
        (tick: 17, seat: 1, action: Forfeit),
        (tick: 17, seat: 255, action: Crowd(3)),
        (tick: 249, seat: 255, action: Release),
    ],
)
"#;

#[test]
fn the_written_form_is_this() {
    assert_eq!(made_up().to_text(), MADE_UP);
    assert_eq!(read(MADE_UP), made_up());
    let replay = made_up();
    assert_eq!((replay.physics(), replay.table_name(), replay.seed()), (7, "A \"table\"", u64::MAX));
    assert_eq!((replay.table_digest(), replay.ticks()), (0xfedc_ba98_7654_3210, 250));
}

#[test]
fn a_game_of_minutes_is_played_again_bit_for_bit_from_its_text() {
    let mut digests = Vec::new();
    let mut points = 0;
    let (game, replay) = record(200_000, 10_000, |game| {
        digests.push(game.digest());
        points = game.seats()[0].score.points.max(points);
    });
    assert!(points > 0, "a game in which nothing happens shows nothing");
    assert_eq!(replay.checkpoints().len(), 20);
    let read = read(&replay.to_text());
    assert_eq!(read, replay);
    let mut recorded = digests.iter();
    let played = read.play(classic(), |game| {
        assert_eq!(Some(&game.digest()), recorded.next(), "tick {}", game.tick());
    });
    assert_eq!(played.map(|played| played.state()), Ok(game.state()));
    assert_eq!(recorded.next(), None, "every step was seen");
}

/// The bot holds a flipper for 100 ticks at the least: with a checkpoint every 50, the first one after the input that
/// was changed differs.
#[test]
fn an_input_that_was_changed_is_found_between_two_checkpoints() {
    let (_, replay) = record(120_000, 50, |_| ());
    let mut changed = 0;
    for place in 0..replay.inputs().len() {
        let mut other = replay.clone();
        let Input { tick, action: Action::Flipper { right, pressed: true }, .. } = &mut other.0.inputs[place] else {
            continue;
        };
        let tick = *tick;
        *right = !*right;
        changed += 1;
        match read(&other.to_text()).play(classic(), |_| ()) {
            Err(ReplayError::Diverged { tick: differs, agreed, expected, found }) => {
                let before = tick / 50 * 50;
                assert_eq!((agreed, differs), (Some(before), before + 50), "input {place} at tick {tick}");
                let stated = replay.checkpoints().iter().find(|checkpoint| checkpoint.tick == differs);
                assert_eq!(stated.map(|checkpoint| checkpoint.digest), Some(expected));
                assert_ne!(found, expected);
            }
            other => panic!("input {place} at tick {tick}: {:?}", other.map(|game| game.tick())),
        }
    }
    assert!(changed >= 5, "{changed} flips in two minutes");
}

#[test]
fn a_checkpoint_that_was_changed_is_the_first_that_differs() {
    let (_, replay) = record(1_000, 100, |_| ());
    for place in 0..10 {
        let mut other = replay.clone();
        let Checkpoint { tick, digest } = other.0.checkpoints[place];
        other.0.checkpoints[place].digest ^= 1;
        let agreed = tick.checked_sub(100).filter(|&before| before > 0);
        let expected = ReplayError::Diverged { tick, expected: digest ^ 1, found: digest, agreed };
        assert_eq!(other.play(classic(), |_| ()).err(), Some(expected));
    }
}

#[test]
fn another_table_is_refused_before_a_step_is_made() {
    let (_, replay) = record(100, 100, |_| ());
    let source = format!("{}\n// Another digest.\n", classic().source);
    let other = Table::parse("other.ron", &source).expect("a comment changes no table");
    let expected = (classic().name.clone(), classic().digest);
    let error = replay.play(Arc::new(other.clone()), |game| panic!("tick {}", game.tick())).err();
    let found = (other.name, other.digest);
    assert_eq!(error, Some(ReplayError::Table { expected: expected.clone(), found }));

    let mut renamed = replay;
    renamed.0.table = "Modern".to_owned();
    let error = renamed.play(classic(), |game| panic!("tick {}", game.tick())).err();
    let lie = ("Modern".to_owned(), expected.1);
    assert_eq!(error, Some(ReplayError::Table { expected: lie, found: expected }));
}

#[test]
fn other_physics_are_refused_before_a_step_is_made() {
    let (_, replay) = record(100, 100, |_| ());
    let (ours, other) = (format!("physics: {PHYSICS_VERSION},"), format!("physics: {},", PHYSICS_VERSION + 1));
    let replay = read(&replay.to_text().replace(&ours, &other));
    let error = replay.play(classic(), |game| panic!("tick {}", game.tick())).err();
    assert_eq!(error, Some(ReplayError::Physics { found: PHYSICS_VERSION + 1, ours: PHYSICS_VERSION }));
}

#[test]
fn what_is_wrong_with_a_text_is_told_with_its_line() {
    let cases = [
        // A later format is known by its version, whatever else it has.
        ("format: 1,", "format: 2,\n    camera: 5,", 2, "replay format 2 is not known: 1 would be right"),
        // There is no place for a score.
        ("seed: ", "score: 1000000,\n    seed: ", 6, "score"),
        ("action: Start)", "action: Start, points: 5)", 14, "points"),
        ("pressed: false)", "pressed: false, force: 9)", 15, "force"),
        ("digest: \"ffff", "score: 5, digest: \"ffff", 9, "score"),
        ("action: Start)", "action: Win)", 14, "Win"),
        ("ffffffffffffffff", "fffffffffffffff", 9, "16 digits"),
        ("ffffffffffffffff", "FFFFFFFFFFFFFFFF", 9, "16 digits"),
        ("ffffffffffffffff", "+fffffffffffffff", 9, "16 digits"),
        ("\"ffffffffffffffff\"", "18446744073709551615", 9, "xpected string"),
        ("tick: 249", "tick: 16", 19, "an input at tick 16 after one at 17: sorted by tick would be right"),
        ("tick: 249", "tick: 250", 19, "an input at tick 250 of a replay that ends at 250"),
        ("tick: 100", "tick: 250", 10, "a checkpoint at tick 250 after one at 250"),
        ("tick: 250", "tick: 249", 10, "the last checkpoint is at tick 249: 250, the end, would be right"),
        ("ticks: 250", "ticks: 251", 10, "the last checkpoint is at tick 250: 251, the end, would be right"),
        ("ticks: 250", "ticks: 100000001", 7, "100000001 ticks are more than the 100000000 that a replay may have"),
        ("ticks: 250", "ticks: 18446744073709551616", 7, "out of bounds"),
        ("ticks: 250", "ticks: -1", 7, ""),
        ("    seed: 18446744073709551615,\n", "", 20, "seed"),
        ("seed: 1", "seed: 1, seed: 1", 6, "seed"),
        ("\n)\n", "\n)\n(", 21, "railing"),
    ];
    for (from, to, line, problem) in cases {
        let text = MADE_UP.replacen(from, to, 1);
        assert_ne!(text, MADE_UP, "{from}");
        let (found_line, found) = refused(&text);
        assert!(found_line == line && found.contains(problem), "{to}: line {found_line}: {found}");
    }
    let text = MADE_UP.replace("        (tick: 100, digest: \"ffffffffffffffff\"),\n", "");
    let text = text.replace("        (tick: 250, digest: \"0000000000000005\"),\n", "");
    assert_eq!(refused(&text), (8, "no checkpoint: one at tick 250 would be right".to_owned()));
    let error = Replay::parse("game.ron", &text).err().map(|error| error.to_string());
    assert_eq!(error.as_deref(), Some("game.ron:8: no checkpoint: one at tick 250 would be right"));
}

/// Only the limit stands against it: everything else about the text is as it should be.
#[test]
fn a_replay_of_many_years_is_not_even_read() {
    let text = MADE_UP.replace("250", &(1_u64 << 60).to_string());
    let (line, problem) = refused(&text);
    assert_eq!(line, 7);
    assert!(problem.contains("1152921504606846976 ticks are more than the 100000000"), "{problem}");
    let longest = MADE_UP.replace("250", &MOST_TICKS.to_string());
    assert_eq!(read(&longest).ticks(), MOST_TICKS);
}

#[test]
fn more_than_a_replay_may_have_is_refused() {
    let with_inputs = |count| {
        let inputs = "(tick:0,seat:0,action:Sit),".repeat(count);
        MADE_UP.replace("        (tick: 0, seat: 1, action: Sit),", &inputs)
    };
    assert_eq!(read(&with_inputs(MOST_INPUTS - 6)).inputs().len(), MOST_INPUTS);
    let (line, problem) = refused(&with_inputs(MOST_INPUTS - 5));
    assert!(line == 19 && problem.contains("at most 131072 items"), "{line}: {problem}");

    let checkpoint = "(tick:0,digest:\"0000000000000000\"),";
    let text = MADE_UP.replace("checkpoints: [", &format!("checkpoints: [{}", checkpoint.repeat(MOST_CHECKPOINTS)));
    let problem = refused(&text).1;
    assert!(problem.contains("at most 65536 items"), "{problem}");

    for name in [&*"A".repeat(5_000), "\\u{1b}[2J", ""] {
        let (line, problem) = refused(&MADE_UP.replace("A \\\"table\\\"", name));
        assert!(line == 4 && problem.len() < 300 && !problem.contains(char::is_control), "{line}: {problem}");
    }

    let (line, problem) = refused(&" ".repeat(MOST_TEXT + 1));
    assert!(line == 0 && problem.contains("more than the 16777216"), "{line}: {problem}");
}

#[test]
fn the_longest_replay_fits_into_the_longest_text() {
    let mut replay = made_up();
    let file = &mut replay.0;
    (file.physics, file.seed, file.ticks) = (u32::MAX, u64::MAX, MOST_TICKS);
    file.table = "\u{10ffff}".repeat(40);
    let action = Action::Flipper { right: false, pressed: false };
    file.inputs = vec![Input { tick: MOST_TICKS - 1, seat: u8::MAX, action }; MOST_INPUTS];
    let first = MOST_TICKS + 1 - MOST_CHECKPOINTS as u64;
    file.checkpoints = (first..=MOST_TICKS).map(|tick| Checkpoint { tick, digest: tick }).collect();
    let text = replay.to_text();
    assert!(text.len() <= MOST_TEXT, "{}", text.len());
    assert_eq!(read(&text), replay);
}

#[test]
fn nesting_and_quotes_without_end_are_refused_in_few_words() {
    for start in ["(", "[", "{", "/*", "/*/", "r#", "\"", "(a:", "Some(", "(inputs:[", "#![enable(unwrap_newtypes)]"] {
        refused(&start.repeat(MOST_TEXT / 16 / start.len()));
    }
    let (_, problem) = refused(&MADE_UP.replacen("seed", &"s".repeat(1_000_000), 1));
    assert!(problem.len() < 300, "{} bytes of complaint", problem.len());
    let (_, problem) = refused(&MADE_UP.replacen("fedcba98", "\\u{1b}[2J\u{1b}[2J\u{202e}", 1));
    assert!(problem.contains("16 digits") && !problem.contains(char::is_control), "{problem:?}");
}

/// A game in which every kind of input acts, short enough to be played thousands of times.
fn short_game() -> (Game, Replay) {
    let table = classic();
    let mut game = Game::new(Arc::clone(&table));
    let mut recorder = Recorder::new(&table, 5).every(100);
    for tick in 0..1_500 {
        let action = match tick {
            0 | 1 => Some(Action::Sit),
            2 => Some(Action::Start),
            450 => Some(Action::Pull(60_000)),
            800 => Some(Action::Release),
            _ if tick % 137 == 0 => Some(Action::Flipper { right: tick % 2 == 0, pressed: tick % 274 < 137 }),
            _ => None,
        };
        let input = action.map(|action| Input { tick, seat: u8::from(tick == 1), action });
        game.step(input.as_slice());
        recorder.after_step(&game, input.as_slice());
    }
    match recorder.finish(&game) {
        Ok(replay) => (game, replay),
        Err(error) => panic!("{error}"),
    }
}

/// What a replay's text is made of, and what could confuse a reader.
const LIKELY: &[u8] = b"0123456789abcdef()[]{},:\"\\/*#-+._ ";

/// Flips a bit, puts a likely byte, counts a digit up, or cuts, doubles or moves a piece or a whole line.
fn mutate(text: &mut Vec<u8>, rng: &mut Rng) {
    fn below(rng: &mut Rng, bound: usize) -> usize {
        (rng.bits() % bound.max(1) as u64) as usize
    }
    let at = below(rng, text.len());
    let by_line = rng.bits().is_multiple_of(2);
    let after_break = |from: usize| text[from..].iter().position(|&byte| byte == b'\n').map(|end| from + end + 1);
    let start = if by_line { after_break(at).unwrap_or(at) } else { at };
    let length = 1 + below(rng, 40);
    let end = if by_line { after_break(start) } else { None }.unwrap_or((start + length).min(text.len()));
    let to = below(rng, text.len());
    let to = if by_line { after_break(to).unwrap_or(to) } else { to };
    match rng.bits() % 6 {
        0 if at < text.len() => text[at] ^= 1 << (rng.bits() % 8),
        1 if at < text.len() => text[at] = LIKELY[below(rng, LIKELY.len())],
        2 => drop(text.drain(start..end)),
        3 => {
            let piece = text[start..end].to_vec();
            text.splice(to..to, piece);
        }
        4 => {
            let piece: Vec<u8> = text.drain(start..end).collect();
            let to = to.min(text.len());
            text.splice(to..to, piece);
        }
        _ => {
            let digit = text[at..].iter_mut().find(|byte| byte.is_ascii_digit());
            if let Some(digit) = digit {
                *digit = b'0' + (*digit - b'0' + 1 + (rng.bits() % 9) as u8) % 10;
            }
        }
    }
}

/// Whatever is done to a text: it is refused, or fails when it is played, or it is the same game after all (a space
/// more, another seed, an input that had no effect).
#[test]
fn a_text_that_was_tampered_with_never_passes_as_another_game() {
    let (game, replay) = short_game();
    let text = replay.to_text();
    let table = classic();
    let mut rng = Rng::new(20);
    let (mut unread, mut failed, mut same) = (0, 0, 0);
    for round in 0..6_000 {
        let mut bytes = text.clone().into_bytes();
        for _ in 0..1 + rng.bits() % 3 {
            mutate(&mut bytes, &mut rng);
        }
        let mutant = String::from_utf8_lossy(&bytes);
        let read = match Replay::parse("game.ron", &mutant) {
            Ok(read) => read,
            Err(error) => {
                assert!(error.to_string().starts_with("game.ron:"), "round {round}: {error}");
                unread += 1;
                continue;
            }
        };
        assert_eq!(self::read(&read.to_text()), read, "round {round}:\n{mutant}");
        match read.play(Arc::clone(&table), |_| ()) {
            Ok(played) => {
                assert_eq!(played.state(), game.state(), "round {round}:\n{mutant}");
                same += 1;
            }
            Err(error) => {
                assert!(!matches!(error, ReplayError::Text { .. }), "round {round}: {error}");
                assert_ne!(read, replay, "round {round}: {error}");
                failed += 1;
            }
        }
    }
    assert!(unread > 1_000 && failed > 100 && same > 10, "{unread} unread, {failed} failed, {same} the same");
}
