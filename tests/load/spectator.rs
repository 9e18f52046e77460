//! Whoever watches: checks that the stream has no gap, and one in so many also that it leads to the server's bits.

use std::sync::Arc;

use shared::protocol::{ClientMessage, Follower, Heard, Mismatch, ServerMessage, encode, framed};
use shared::table::Table;

use crate::clock::Clock;
use crate::report::Counts;

/// A connection that watches.
#[derive(Debug, Default)]
pub(crate) struct Spectator {
    /// Everything is known up to this tick.
    last: Option<u64>,
    /// The games, if it steps them.
    copy: Option<Box<Follower>>,
}

impl Spectator {
    /// One that steps copies of the games on `table`.
    pub(crate) fn stepping(table: Arc<Table>) -> Self {
        Self { last: None, copy: Some(Box::new(Follower::new(table))) }
    }

    /// Whether its stream has begun.
    pub(crate) fn has_begun(&self) -> bool {
        self.last.is_some()
    }

    /// Takes in a message that came in a frame of `length` bytes at `now`; what is to be said goes to `replies`.
    ///
    /// # Errors
    /// If no server of ours would send that.
    pub(crate) fn hear(
        &mut self,
        message: &ServerMessage,
        (length, now): (usize, u64),
        (counts, clock): (&mut Counts, &mut Clock),
        replies: &mut Vec<u8>,
    ) -> Result<(), String> {
        let (from, to) = match message {
            ServerMessage::Full(full) => {
                counts.fulls += 1;
                counts.full_bytes += length as u64;
                let tick = full.tick().ok_or("a full snapshot whose boards are not at one tick")?;
                counts.jumps += u64::from(self.last.is_some_and(|last| tick > last));
                (None, tick)
            }
            ServerMessage::Change(change) => (Some(change.from), change.to),
            ServerMessage::Inputs(inputs) => (Some(inputs.from), inputs.to),
            _ => return Ok(()),
        };
        if let Some(from) = from {
            counts.snapshots += 1;
            if counts.is_counting {
                clock.hear_frame(now, to, self.last);
            }
            // Those that step find gaps themselves.
            if self.copy.is_none() && self.last.is_some_and(|last| last != from) {
                counts.missed += 1;
            }
        }
        self.last = Some(self.last.map_or(to, |last| last.max(to)));
        match self.step(message)? {
            Ok(()) => {}
            Err(Mismatch { tick, ours, theirs }) => {
                if ours == 0 {
                    counts.missed += 1;
                } else {
                    counts.digest_mismatches += 1;
                    if counts.digest_mismatches == 1 {
                        eprintln!("starball-load: at tick {tick} a copy has {ours:016x}, the server {theirs:016x}");
                    }
                }
                replies.extend(framed(&encode(&ClientMessage::Differs { tick, digest: ours })));
            }
        }
        Ok(())
    }

    /// Brings the copies up to date.
    fn step(&mut self, message: &ServerMessage) -> Result<Result<(), Mismatch>, String> {
        let Some(copy) = &mut self.copy else { return Ok(Ok(())) };
        match hear(copy, message)? {
            Ok(_) => Ok(copy.advance(u64::MAX, |_, _| {})),
            Err(gap) => Ok(Err(gap)),
        }
    }
}

/// Has a follower take in a message of its stream.
///
/// # Errors
/// If no server of ours would send that.
pub(crate) fn hear(copy: &mut Follower, message: &ServerMessage) -> Result<Result<Heard, Mismatch>, String> {
    let heard = match message {
        ServerMessage::Full(full) => copy.hear_full(full).map(Ok),
        ServerMessage::Change(change) => copy.hear_change(change),
        ServerMessage::Inputs(inputs) => copy.hear_inputs(inputs),
        _ => Ok(Ok(Heard::Nothing)),
    };
    heard.map_err(|error| error.to_string())
}
