//! Messages, and games that go on from a snapshot: see `starball_tests::fuzz::message`.

#![no_main]

libfuzzer_sys::fuzz_target!(|data: &[u8]| starball_tests::fuzz::message(data));
