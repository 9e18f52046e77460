//! The golden runs as a WebAssembly module. [`play`] plays one and returns how long its line of `golden.txt` is, [`text`] says
//! where in memory that line begins.

use std::cell::RefCell;

thread_local! {
    static LINE: RefCell<String> = const { RefCell::new(String::new()) };
}

/// Plays the golden run at a place in the file. Returns the length of its line in bytes, 0 beyond the last run.
#[unsafe(no_mangle)]
pub extern "C" fn play(place: usize) -> usize {
    let line = shared::golden::line(place).unwrap_or_default();
    let length = line.len();
    LINE.set(line);
    length
}

/// Where the line of the last run begins.
#[unsafe(no_mangle)]
pub extern "C" fn text() -> *const u8 {
    LINE.with_borrow(|line| line.as_ptr())
}
