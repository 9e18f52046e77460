//! The room's stream as a session follows it: from one stream to another, and on after something was wrong.
//!
//! After another stream was asked for, frames of the old one still come, and maybe one of its full snapshots. Until a frame
//! of the new one fits behind a full snapshot, each full snapshot is a beginning, and a gap means nothing.

use std::sync::Arc;

use shared::game::{Game, GameEvent};
use shared::protocol::{
    Change, ClientMessage, FollowError, Follower, Form, Full, Heard, Inputs, Mismatch, REQUEST_SECONDS, Stream,
};
use shared::table::Table;

use crate::budget::Budget;

/// Seconds of the game by which the copies may be behind what is known. Beyond that they jump to the next full snapshot: the
/// window was hidden for a while, or this machine is too slow for the table.
const MOST_BEHIND: f64 = 5.0;

/// How far the way to another stream has come.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
enum Switch {
    /// There is none under way.
    Done,
    /// It was asked for.
    Asked,
    /// A full snapshot has come since.
    Begun,
}

/// The room's games as they are sent.
#[derive(Debug)]
pub(super) struct Feed {
    follower: Follower,
    /// [`MOST_BEHIND`] in ticks.
    most_behind: u64,
    /// What was asked for last.
    stream: Stream,
    switch: Switch,
    /// Of what came last.
    form: Form,
    /// Something was wrong, and a full snapshot is needed.
    wanted: Option<Mismatch>,
    requested_at: Option<f64>,
    /// That one is probably on its way.
    is_coming: bool,
    mismatches: u64,
}

impl Feed {
    /// Waits for the first full snapshot of `stream`.
    pub(super) fn new(table: Arc<Table>, stream: Stream) -> Self {
        Self {
            // A cast saturates.
            most_behind: (MOST_BEHIND / table.scene.tick_seconds) as u64,
            follower: Follower::new(table),
            stream,
            switch: Switch::Begun,
            form: stream.form,
            wanted: None,
            requested_at: None,
            is_coming: false,
            mismatches: 0,
        }
    }

    /// The room's games, one a board.
    pub(super) fn games(&self) -> &[Game] {
        self.follower.games()
    }

    /// The tick up to which they can be stepped.
    pub(super) fn confirmed(&self) -> u64 {
        self.follower.confirmed()
    }

    /// The tick that they are at.
    pub(super) fn tick(&self) -> u64 {
        self.follower.tick()
    }

    /// What was asked for last.
    pub(super) fn stream(&self) -> Stream {
        self.stream
    }

    /// What comes just now, from the old stream or from the new one.
    pub(super) fn form(&self) -> Form {
        self.form
    }

    /// Whether frames of the stream that was asked for do not come yet.
    pub(super) fn is_switching(&self) -> bool {
        self.switch != Switch::Done
    }

    /// Whether the copies can go on only from a full snapshot.
    pub(super) fn is_lost(&self) -> bool {
        self.follower.waits()
    }

    /// How often the copies were not what the server has.
    pub(super) fn mismatches(&self) -> u64 {
        self.mismatches
    }

    /// Another stream; `true` if that is to be asked for.
    pub(super) fn switch(&mut self, stream: Stream) -> bool {
        if stream == self.stream {
            return false;
        }
        (self.stream, self.switch) = (stream, Switch::Asked);
        true
    }

    /// A full snapshot came.
    ///
    /// # Errors
    /// If no server would send it.
    pub(super) fn hear_full(&mut self, full: &Full) -> Result<Heard, FollowError> {
        // In one stream nothing goes back: an older one is the beginning of another stream.
        let is_older = full.tick().is_some_and(|tick| tick < self.confirmed());
        let is_far_behind = self.confirmed().saturating_sub(self.tick()) > self.most_behind;
        if self.is_switching() || is_older || is_far_behind {
            self.follower.expect_full();
        }
        let heard = self.follower.hear_full(full)?;
        if heard == Heard::Anew {
            self.wanted = None;
            if self.switch == Switch::Asked {
                self.switch = Switch::Begun;
                self.form = self.stream.form;
            }
        }
        Ok(heard)
    }

    /// What changed came.
    ///
    /// # Errors
    /// If no server would send it.
    pub(super) fn hear_change(&mut self, change: &Change) -> Result<Heard, FollowError> {
        let heard = self.follower.hear_change(change)?;
        Ok(self.note(Form::State, heard))
    }

    /// What was pressed came.
    ///
    /// # Errors
    /// If no server would send it.
    pub(super) fn hear_inputs(&mut self, inputs: &Inputs) -> Result<Heard, FollowError> {
        let heard = self.follower.hear_inputs(inputs)?;
        Ok(self.note(Form::Inputs, heard))
    }

    /// Steps the copies to `tick`, at most as far as everything is known and the budget lasts.
    pub(super) fn advance(&mut self, tick: u64, budget: &mut Budget, mut show: impl FnMut(u8, &GameEvent)) {
        loop {
            let before = self.tick();
            let goes_on = before < tick.min(self.confirmed()) && budget.take();
            // Also where they are there already: digests are compared.
            if let Err(mismatch) = self.follower.advance(before + u64::from(goes_on), &mut show) {
                return self.differ(mismatch);
            }
            if !goes_on || self.is_lost() {
                return;
            }
        }
    }

    /// What is to be sent because something was wrong: at most once a second, until a full snapshot comes.
    pub(super) fn request(&mut self, now: f64) -> Option<ClientMessage> {
        let Mismatch { tick, ours, .. } = self.wanted?;
        if std::mem::take(&mut self.is_coming) {
            self.requested_at = Some(now);
        }
        if self.requested_at.is_some_and(|at| now - at < REQUEST_SECONDS) {
            return None;
        }
        self.requested_at = Some(now);
        Some(ClientMessage::Differs { tick, digest: ours })
    }

    fn note(&mut self, form: Form, heard: Result<Heard, Mismatch>) -> Heard {
        match heard {
            Ok(heard) => {
                if heard == Heard::Further {
                    self.form = form;
                    if self.switch == Switch::Begun && form == self.stream.form {
                        self.switch = Switch::Done;
                    }
                }
                heard
            }
            Err(mismatch) => {
                if self.is_switching() {
                    // A full snapshot comes anyway; should it not, it is asked for in a second.
                    (self.wanted, self.is_coming) = (Some(mismatch), true);
                } else {
                    self.differ(mismatch);
                }
                Heard::Nothing
            }
        }
    }

    fn differ(&mut self, mismatch: Mismatch) {
        let Mismatch { tick, ours, theirs } = mismatch;
        self.mismatches += 1;
        tracing::warn!("at tick {tick} the game here is {ours:016x}, the server's {theirs:016x}");
        self.wanted = Some(mismatch);
    }
}
