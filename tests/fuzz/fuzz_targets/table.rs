//! Texts of tables: see `starball_tests::fuzz::table`.

#![no_main]

libfuzzer_sys::fuzz_target!(|data: &[u8]| starball_tests::fuzz::table(data));
