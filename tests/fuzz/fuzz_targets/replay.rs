//! Texts of replays: see `starball_tests::fuzz::replay`.

#![no_main]

libfuzzer_sys::fuzz_target!(|data: &[u8]| starball_tests::fuzz::replay(data));
