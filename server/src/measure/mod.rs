//! `measure`: what a table's speed costs in accuracy, and its accuracy in speed.

pub mod contender;
pub mod polynomial;
pub mod real;
pub mod reference;
pub mod trajectory;
