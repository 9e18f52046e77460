//! The first frame of either side: see `starball_tests::fuzz::frame`.

#![no_main]

libfuzzer_sys::fuzz_target!(|data: &[u8]| starball_tests::fuzz::frame(data));
