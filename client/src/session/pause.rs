//! Pauses: while the room stands still, so do the clocks by which its ticks are told. And silences, which are none.

use shared::protocol::ClientMessage;

use super::Session;

/// Seconds without a frame after which the person at the window is told.
const SILENCE: f64 = 1.0;

/// The local clock without the times for which the room stood still, seconds: what every estimate of the server's tick is
/// made of, so that none of them sees a pause.
#[derive(Debug, Default)]
pub(super) struct GameTime {
    /// The server has said that players may let the room stand still.
    can_stop: bool,
    /// Since when it does, by the local clock.
    stopped_at: Option<f64>,
    /// How long it has done so before.
    stood: f64,
}

impl GameTime {
    /// The room stands still, or goes on, since local time `at`.
    pub(super) fn hear(&mut self, at: f64, stands_still: bool) {
        self.can_stop = true;
        match self.stopped_at {
            None if stands_still => self.stopped_at = Some(at),
            Some(since) if !stands_still => {
                self.stood += (at - since).max(0.0);
                self.stopped_at = None;
            }
            _ => {}
        }
    }

    /// The game's time at a local time.
    pub(super) fn at(&self, local: f64) -> f64 {
        self.stopped_at.map_or(local, |since| local.min(since)) - self.stood
    }
}

impl Session {
    /// Lets the room stand still, or go on. Nothing, where it cannot be done.
    pub(crate) fn pause(&mut self, stands_still: bool) {
        if self.can_pause() && stands_still != self.is_paused() {
            self.outbox.push(ClientMessage::Pause(stands_still));
        }
    }

    /// Whether the person at the window may let the room stand still: with a place, on a table of their own.
    pub(crate) fn can_pause(&self) -> bool {
        self.time.can_stop && self.place.is_some() && !self.is_leaving
    }

    /// Whether the room stands still.
    pub(crate) fn is_paused(&self) -> bool {
        self.time.stopped_at.is_some()
    }

    /// Whether the server has said nothing for a while, and should have.
    pub(crate) fn is_silent(&self, now: f64) -> bool {
        !self.is_paused() && now - self.heard_at > SILENCE
    }

    /// The server says that the room stands still, or goes on.
    pub(super) fn hear_pause(&mut self, at: f64, stands_still: bool) {
        self.time.hear(at, stands_still);
        // No frame could come meanwhile.
        self.heard_at = at;
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn game_time_leaves_out_what_the_room_stood_still() {
        let mut time = GameTime::default();
        time.hear(0.0, false);
        assert_eq!((time.at(5.0), time.can_stop), (5.0, true));
        time.hear(10.0, true);
        time.hear(11.0, true);
        assert_eq!((time.at(9.0), time.at(10.5), time.at(100.0)), (9.0, 10.0, 10.0));
        time.hear(20.0, false);
        assert_eq!((time.at(20.0), time.at(21.5)), (10.0, 11.5));
        time.hear(30.0, true);
        time.hear(31.0, false);
        assert_eq!(time.at(40.0), 29.0);
    }
}
