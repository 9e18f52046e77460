//! What the tests in `tests/` and the fuzz targets in `fuzz/` share. Tests over loopback have a harness of their own.

#![forbid(unsafe_code)]

pub mod fuzz;
pub mod samples;
