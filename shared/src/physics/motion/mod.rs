//! Motion models: how the next event of a ball among the static shapes is found.
//!
//! A model answers one question: from this flight on, what does the ball meet next, and when? Shapes, contact response
//! and the order of events are the world's and common to all models.

mod exact;

pub use exact::{Next, next_event};
