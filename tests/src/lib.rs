//! Tests over loopback live in `tests/`.
