//! The checks of the fuzz targets on seeded mutations of their corpus: so many inputs a target that each takes about two
//! seconds, and the same ones in every run. `tests/fuzz` looks further, with coverage to guide it.

#![forbid(unsafe_code)]

/// What is mutated: files, and fresh samples.
mod corpus;
/// One input from others.
mod mutate;
/// States that may be some.
mod states;

use std::panic::{AssertUnwindSafe, catch_unwind};
use std::path::Path;

use shared::math::Rng;
use shared::protocol::encode;
use starball_tests::{fuzz, samples};

use mutate::Kind;

/// Raise it to look at other inputs. `FUZZ_ROUNDS=50` runs so many times as many of them.
const SEED: u64 = 1;

fn check(target: &str, kind: Kind, count: u64, target_check: fn(&[u8])) {
    let corpus = corpus::of(target);
    for input in &corpus {
        must_pass(target, "a file or sample of the corpus", input, target_check);
    }
    each(count, |number, rng| {
        let input = mutate::input(rng, kind, &corpus);
        must_pass(target, &format!("seed {SEED}, input {number}"), &input, target_check);
    });
}

/// As many inputs as asked for, with a generator for each, so that one can be made again without those before it.
fn each(count: u64, mut one: impl FnMut(u64, &mut Rng)) {
    let rounds: u64 = std::env::var("FUZZ_ROUNDS").ok().and_then(|rounds| rounds.parse().ok()).unwrap_or(1);
    for number in 0..count * rounds {
        one(number, &mut Rng::new(SEED ^ Rng::new(number).bits()));
    }
}

fn must_pass(target: &str, which: &str, input: &[u8], check: fn(&[u8])) {
    if catch_unwind(AssertUnwindSafe(|| check(input))).is_ok() {
        return;
    }
    let file = Path::new(env!("CARGO_TARGET_TMPDIR")).join(format!("fuzz-{target}"));
    let saved = match std::fs::write(&file, input) {
        Ok(()) => format!("saved in {}", file.display()),
        Err(error) => format!("not saved: {error}"),
    };
    let shown = &input[..input.len().min(2000)];
    let shown = match str::from_utf8(shown) {
        Ok(text) => format!("{text:?}"),
        Err(_) => shown.iter().map(|byte| format!("{byte:02x}")).collect(),
    };
    panic!("{target}: {which} fails as said above, {} bytes, {saved}: {shown}", input.len());
}

#[test]
fn whatever_a_first_frame_holds() {
    check("frame", Kind::Bytes, 600_000, fuzz::frame);
}

#[test]
fn whatever_a_message_holds() {
    check("message", Kind::Bytes, 60_000, fuzz::message);
}

#[test]
fn whatever_a_table_says() {
    check("table", Kind::Text, 12_000, fuzz::table);
}

#[test]
fn whatever_a_replay_says() {
    check("replay", Kind::Text, 30_000, fuzz::replay);
}

#[test]
fn whatever_a_state_holds() {
    let states = samples::states();
    each(4_000, |number, rng| {
        let state = encode(&states::changed(rng, &states));
        must_pass("state", &format!("seed {SEED}, state {number}"), &state, fuzz::state);
    });
}
