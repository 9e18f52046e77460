//! `starball-load` against a room that can be told to be wrong, and against the real server.

#![forbid(unsafe_code)]

/// The real server.
mod real;
/// A room that sends frames, and lies or leaves some out if it is told to.
mod room;

use std::process::{Command, Output};
use std::sync::Arc;

use room::{Fault, Room};
use serde_json::Value;
use shared::table::Table;

fn classic() -> Arc<Table> {
    Arc::new(Table::shipped("classic").expect("it is shipped").expect("it is valid"))
}

fn run(arguments: &str) -> Output {
    Command::new(env!("CARGO_BIN_EXE_starball-load")).args(arguments.split(' ')).output().expect("it starts")
}

fn load(arguments: &str) -> Value {
    let output = run(arguments);
    let errors = String::from_utf8_lossy(&output.stderr).into_owned();
    assert!(output.status.success(), "{errors}");
    let text = String::from_utf8(output.stdout).expect("text");
    let report: Value = serde_json::from_str(text.trim()).expect("one line of JSON");
    println!("{report}\n{errors}");
    report
}

#[test]
fn what_a_room_does_wrong_is_counted() {
    // Ten frames a second to each of six: three step the game, three only look for gaps.
    let arguments = |room: &Room| format!("--connect {} --spectators 6 --step-one-in 2 --seconds 2", room.address());
    let room = Room::open(classic(), Fault::None);
    let right = load(&arguments(&room));
    drop(room);
    assert_eq!((&right["missed"], &right["digest_mismatches"], &right["lost"]), (&0.into(), &0.into(), &0.into()));
    let snapshots = right["snapshots"].as_u64().expect("a number");
    assert!((108..=132).contains(&snapshots), "{snapshots}");
    assert!(right["bytes_per_spectator_second"].as_f64().expect("a number") < 200.0);
    let (late, behind) = (&right["latency_ms"]["p50"], &right["behind_ms"]["p50"]);
    assert!((0.0..10.0).contains(&late.as_f64().expect("a number")), "{late}");
    assert!((95.0..115.0).contains(&behind.as_f64().expect("a number")), "{behind}");

    let room = Room::open(classic(), Fault::Digest);
    let wrong = load(&arguments(&room));
    drop(room);
    assert!(wrong["digest_mismatches"].as_u64() >= Some(3), "each of those that step");
    assert_eq!(wrong["missed"], 0);

    let room = Room::open(classic(), Fault::Gap);
    let gaps = load(&arguments(&room));
    drop(room);
    assert_eq!(gaps["digest_mismatches"], 0);
    assert!(gaps["missed"].as_u64() >= Some(6), "each of them");
}

#[test]
fn whoever_is_not_there_is_told_of_in_plain_words() {
    let free = std::net::TcpListener::bind("127.0.0.1:0").expect("a free port").local_addr().expect("bound");
    let output = run(&format!("--connect {free} --spectators 3 --seconds 1"));
    assert_eq!(output.status.code(), Some(1));
    let errors = String::from_utf8_lossy(&output.stderr);
    assert!(errors.contains(&format!("cannot join {free}")) && errors.contains("would be right"), "{errors}");
    let output = run(&format!("--connect {free} --spectators 100000"));
    let errors = String::from_utf8_lossy(&output.stderr);
    assert_eq!(output.status.code(), Some(1));
    assert!(errors.contains("ulimit -n") || errors.contains("cannot join"), "{errors}");
}
