//! The protocol against itself and against hostile bytes.

use super::version::{sample_change, sample_frames, sample_full};
use super::*;
use crate::game::{Action, Bot, Game, Input};
use crate::math::Rng;
use crate::table::Table;

#[test]
fn every_message_survives_the_wire() {
    for message in [ServerMessage::Full(Box::new(sample_full())), ServerMessage::Change(Box::new(sample_change()))] {
        assert_eq!(decode_from_server(&encode_from_server(&message)), Ok(message));
    }
    let act = ClientMessage::Act { tick: u64::MAX, action: Action::Pull(1) };
    assert_eq!(decode::<ClientMessage>(&encode(&act)), Ok(act));
}

#[test]
fn a_frame_must_be_one_message_to_the_last_byte() {
    let mut bytes = encode(&ClientMessage::Play);
    bytes.push(0);
    assert_eq!(decode::<ClientMessage>(&bytes), Err(FrameError::Trailing { length: 2, left: 1 }));
    assert!(matches!(decode::<ClientMessage>(&[]), Err(FrameError::Malformed { .. })));
    assert!(matches!(decode::<ClientMessage>(&[99]), Err(FrameError::Malformed { .. })));
}

#[test]
fn a_list_longer_than_its_bound_is_refused_before_it_is_read() {
    // A snapshot whose list of balls claims 2^32 items.
    let mut bytes = encode_from_server(&ServerMessage::Full(Box::new(sample_full())));
    let balls = bytes.iter().position(|&b| b == 9).expect("the count of balls: ..., needs, tick, served, count");
    bytes.splice(balls..=balls, [252, 255, 255, 255, 255]);
    let error = decode_from_server(&bytes).expect_err("must be refused");
    assert!(error.to_string().contains("at most 1000"), "{error}");
}

#[test]
fn other_protocols_are_refused_in_plain_words() {
    let hello = Hello { name: "x".to_owned(), role: Role::Watch, stream: Stream::SPECTATOR };
    let good = encode_greeting(&hello);
    assert_eq!(decode_greeting::<Hello>(&good), Ok(hello));

    let mut other_version = good.clone();
    other_version[8] = 77;
    let error = decode_greeting::<Hello>(&other_version).expect_err("another version");
    assert!(error.to_string().contains("protocol 77"), "{error}");

    let mut other_build = good.clone();
    other_build[12] ^= 1;
    let error = decode_greeting::<Hello>(&other_build).expect_err("another build");
    assert!(error.to_string().contains("builds differ"), "{error}");

    for foreign in [&b"GET / HTTP/1.1\r\n\r\n     "[..], b"", b"STARBALL"] {
        let error = decode_greeting::<Hello>(foreign).expect_err("not Starball");
        assert!(error.to_string().contains("does not speak"), "{error}");
    }
}

#[test]
fn mutated_frames_never_panic() {
    let mut rng = Rng::new(1);
    let frames = sample_frames();
    for round in 0..20_000 {
        let mut bytes = frames[round % frames.len()].clone();
        for _ in 0..=(rng.bits() % 4) {
            let at = (rng.bits() % bytes.len().max(1) as u64) as usize;
            match rng.bits() % 3 {
                0 => bytes[at] = rng.bits() as u8,
                1 => bytes.truncate(at.max(1)),
                _ => bytes.insert(at, rng.bits() as u8),
            }
        }
        let _ = decode_from_server(&bytes);
        let _ = decode::<ClientMessage>(&bytes);
        let _ = decode_greeting::<Hello>(&bytes);
    }
}

#[test]
fn names_with_control_characters_are_refused() {
    for good in ["Ann", "Jörg 2", "名前"] {
        assert_eq!(check_name(good), Ok(()), "{good}");
    }
    for bad in ["", " x", "a\u{1b}[31m", "a\nb", "a\u{202e}b", "0123456789012345678901234"] {
        assert!(check_name(bad).is_err(), "{bad:?}");
    }
}

#[test]
fn words_of_a_server_that_would_harm_a_terminal_are_refused() {
    let bye = |reason: &str| ServerMessage::Bye { reason: reason.to_owned() };
    let mut roster = Roster { line: vec!["Ann".to_owned()], ..Roster::default() };
    assert!(decode_from_server(&encode_from_server(&ServerMessage::Roster(roster.clone()))).is_ok());
    roster.line.push("a\u{1b}[2J".to_owned());
    for bad in [bye("x\ny"), bye(&"x".repeat(2000)), ServerMessage::Roster(roster)] {
        assert!(matches!(decode_from_server(&encode_from_server(&bad)), Err(FrameError::Malformed { .. })), "{bad:?}");
    }
    assert!(decode_welcome(&encode_greeting(&ServerMessage::Refused { reason: "\u{7}".to_owned() })).is_err());
    assert!(decode_from_server(&encode_from_server(&bye("the server ends"))).is_ok());
}

#[test]
fn a_snapshot_of_a_game_in_play_restores_bit_for_bit() {
    for (name, most) in [("classic", 512), ("lighthouse", 560)] {
        let largest = largest_snapshot(name);
        println!("{name}: {largest} bytes");
        assert!(largest <= most, "a full snapshot of {name} has {largest} bytes");
    }
}

/// The bytes of the largest snapshot in a game of the bot's, each restored into a copy that goes on as the game does.
fn largest_snapshot(name: &str) -> usize {
    let table = std::sync::Arc::new(Table::shipped(name).expect("shipped").expect("valid"));
    let mut game = Game::new(std::sync::Arc::clone(&table));
    let mut bot = Bot::new(0, 5);
    let mut copy = Game::new(table);
    let mut inputs = Vec::new();
    let mut largest = 0;
    for tick in 0..20_000 {
        inputs.clear();
        let mut act = |action| inputs.push(Input { tick, seat: 0, action });
        if tick == 0 {
            act(Action::Sit);
            act(Action::Start);
        }
        bot.play(&game, act);
        game.step(&inputs);
        if tick % 1777 == 0 {
            let full = Full::of("room", std::slice::from_ref(&game));
            let bytes = encode_from_server(&ServerMessage::Full(Box::new(full)));
            largest = largest.max(bytes.len());
            let Ok(ServerMessage::Full(mut full)) = decode_from_server(&bytes) else { panic!("own snapshot") };
            copy.restore(full.boards.remove(0)).expect("own state");
        } else {
            copy.step(&inputs);
        }
        assert_eq!(game.digest(), copy.digest(), "tick {tick}");
    }
    largest
}
