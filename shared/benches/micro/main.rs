//! What the engine's parts cost, one by one. `cargo bench -p starball-shared --bench micro [-- FILTER]`
//!
//! - `time_of_impact`: one search for the impact of a ball with one shape, or with another ball
//! - `moving`: a tick in which a ball meets a moving flipper or plunger
//! - `tick`: a tick in which nothing happens
//! - `event`: a tick in which one ball bounces once
//! - `snapshot`: the game's state to and from the bytes of a frame
//!
//! Every number is the time of one call. Calls go through many different inputs in turn, so that the processor cannot
//! learn the branches of one of them, and each benchmark checks before it begins that all of its inputs are what its
//! name says. With `--test` each runs once: that is all of the checks and no measurement.

mod classic;
mod event;
mod inputs;
mod moments;
mod moving;
mod snapshot;
mod tick;
mod time_of_impact;

fn main() {
    divan::main();
}
