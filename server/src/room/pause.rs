//! Pauses, where the host allows them: the room wakes, but steps nothing.
//!
//! Time in the world is counted in ticks, so a pause is nothing that happens in it: it is no input, no replay has or needs
//! one, and whatever is counted in ticks (an idle player, a vote, a bot's patience) waits too. What lasts real time goes on:
//! connections are read, pings answered, silent clients thrown out.

use shared::protocol::ServerMessage;

use super::Room;
use crate::broadcast::{NewsKind, Order};
use crate::pacing::Due;
use crate::session::SessionState;
use crate::streams::wire;

impl Room {
    /// Plays the ticks that are due; none while the room stands still, and none later instead of them.
    pub(super) fn pass(&mut self, due: Due) {
        if self.paused_by.is_some() {
            // Who comes and goes is told all the same; once, as the time to the next telling stands still too.
            return self.tell_news();
        }
        self.account.ticks_skipped += due.skipped;
        if due.skipped > 0 {
            tracing::warn!("the machine stalled: {} ticks given up", due.skipped);
        }
        for _ in 0..due.ticks {
            self.tick();
        }
    }

    /// A player lets the room stand still, or go on: it is everybody's who has a place.
    pub(super) fn hear_pause(&mut self, client: u32, state: SessionState, stands_still: bool) {
        if matches!(state, SessionState::Seated(_)) && stands_still != self.paused_by.is_some() {
            self.paused_by = stands_still.then_some(client);
            self.tell_pause();
        }
    }

    /// Whoever let the room stand still leaves.
    pub(super) fn resume_for(&mut self, client: u32) {
        if self.paused_by.take_if(|by| *by == client).is_some() {
            self.tell_pause();
        }
    }

    /// Tells everybody whether the room stands still.
    pub(super) fn tell_pause(&self) {
        let frame = wire(&ServerMessage::Paused(self.paused_by.is_some()));
        self.order(Order::News { kind: NewsKind::Pause, frame });
    }
}
