//! One connection's game, from the welcome to the end: what the server said last, and what is to be seen of it now.
//!
//! Who has the turn sees a prediction; everybody else sees what the server sent, a little late.

use std::collections::VecDeque;
use std::sync::Arc;

use shared::game::{Phase, SEATS};
use shared::physics::{PHYSICS_VERSION, StateError};
use shared::protocol::{ClientMessage, Roster, SNAPSHOT_HZ, ServerMessage, Welcome};
use shared::table::{Table, TableError};
use thiserror::Error;

use crate::controls::Controls;
use crate::effects::Effects;
use crate::moment::Moment;
use crate::net::Connection;
use crate::prediction::{Prediction, Verdict};
use crate::snapshots::SnapshotBuffer;
use crate::timing::{Lead, ServerClock};

/// Seconds by which a spectator sees late: two snapshots, so that one may come late without being missed.
const DELAY: f64 = 2.0 / SNAPSHOT_HZ as f64;
/// Seconds by which an input should be early at the server: the server wakes every 4 ms, and messages wait for it.
const EARLY: f64 = 0.006;
/// Seconds by which the prediction is ahead beyond what the way takes: a frame, as its keys act from its beginning on,
/// and what they should be early.
const MARGIN: f64 = 1.0 / 60.0 + EARLY;
/// Seconds that the prediction is ahead at most. The server allows inputs 0.25 s ahead.
const MOST_LEAD: f64 = 0.2;
/// Seconds from the newest snapshot at which a prediction waits for the next one: the server has stalled.
const MOST_AHEAD: f64 = 0.3;
/// Seconds that a prediction may be ahead of where it should be; beyond that the server has lost time, and it begins anew.
const MOST_EXCESS: f64 = 0.05;
/// Seconds without a snapshot after which the person at the window is told.
const SILENCE: f64 = 1.0;
/// Seconds between two pings.
const PING_EVERY: f64 = 0.25;
/// Pings that may be unanswered; older ones are forgotten.
const MOST_PINGS: usize = 16;
/// Seconds by which the picture may wait for the estimated time after it fell back; beyond that it jumps back.
const MOST_WAIT: f64 = 0.5;

/// Why a session ended. For a person to read.
#[derive(Debug, Error)]
pub(crate) enum SessionError {
    /// The server's table cannot be read.
    #[error("the server's table cannot be read: {0}")]
    Table(#[from] TableError),
    /// The table is not what its digest says.
    #[error("the server's table does not have the digest that the server says")]
    Digest,
    /// The table asks for an accuracy, and the server has not said what that means.
    #[error(
        "the server's table still asks for an accuracy; a server resolves that into a motion model and a tick rate"
    )]
    Unresolved,
    /// The server would compute other trajectories.
    #[error("the server runs physics version {theirs}, this game {PHYSICS_VERSION}: use the same release on both")]
    Physics { theirs: u32 },
    /// A snapshot that fits no game on this table.
    #[error("the server sent a game that does not fit its table: {0}")]
    State(#[from] StateError),
    /// The server says goodbye.
    #[error("the server says goodbye: {0}")]
    Bye(String),
    /// A second welcome, or a refusal after the welcome.
    #[error("the server greets twice")]
    Greeting,
}

impl SessionError {
    /// In as many words as a banner has room for.
    pub(crate) fn headline(&self) -> &str {
        match self {
            Self::Table(_) | Self::Digest | Self::Unresolved => "UNREADABLE TABLE",
            Self::Physics { .. } => "ANOTHER RELEASE THERE",
            Self::State(_) | Self::Greeting => "GARBLED MESSAGES",
            Self::Bye(reason) => reason,
        }
    }
}

/// What was counted, for the end.
#[derive(Debug, Clone, Copy, Default)]
pub(crate) struct Counts {
    /// Snapshots received.
    pub(crate) snapshots: u64,
    /// Predictions that were right.
    pub(crate) right: u64,
    /// Predictions that were wrong.
    pub(crate) wrong: u64,
    /// The last lead, ticks.
    pub(crate) lead: f64,
}

/// One connection's game.
#[derive(Debug)]
pub(crate) struct Session {
    table: Arc<Table>,
    clock: ServerClock,
    lead: Lead,
    snapshots: SnapshotBuffer,
    prediction: Option<Prediction>,
    roster: Roster,
    seat: Option<u8>,
    line: Option<u16>,
    /// The seat was given back, but the server has not said so yet. Until then nothing may be asked, and what it says
    /// about the seat is old.
    is_leaving: bool,
    effects: Effects,
    /// The tick that is shown.
    shown: f64,
    /// Events before this tick have been shown.
    events_shown: u64,
    /// When the last snapshot came.
    heard_at: f64,
    next_ping: f64,
    nonce: u64,
    /// Pings that wait for an answer: nonce and when they were sent.
    pings: VecDeque<(u64, f64)>,
    counts: Counts,
}

impl Session {
    /// A session as a welcome begins it.
    ///
    /// # Errors
    /// If the table cannot be played here.
    pub(crate) fn new(welcome: &Welcome) -> Result<Self, SessionError> {
        if welcome.physics != PHYSICS_VERSION {
            return Err(SessionError::Physics { theirs: welcome.physics });
        }
        let table = Table::parse("the server's table", &welcome.table)?;
        if table.digest != welcome.table_digest {
            return Err(SessionError::Digest);
        }
        // Two machines would choose differently.
        if table.accuracy.is_some() {
            return Err(SessionError::Unresolved);
        }
        let table = Arc::new(table);
        Ok(Self {
            clock: ServerClock::new(table.scene.tick_seconds),
            lead: Lead::default(),
            snapshots: SnapshotBuffer::new(Arc::clone(&table)),
            prediction: None,
            roster: Roster::default(),
            seat: None,
            line: None,
            is_leaving: false,
            effects: Effects::default(),
            shown: 0.0,
            events_shown: 0,
            heard_at: 0.0,
            next_ping: 0.0,
            nonce: 0,
            pings: VecDeque::new(),
            counts: Counts::default(),
            table,
        })
    }

    /// The server said something, which came in at `at`.
    ///
    /// # Errors
    /// If that is the end.
    pub(crate) fn hear(&mut self, at: f64, message: ServerMessage) -> Result<(), SessionError> {
        match message {
            ServerMessage::Snapshot(snapshot) => {
                self.clock.arrived(snapshot.state.world.tick, at);
                self.snapshots.push(*snapshot)?;
                self.counts.snapshots += 1;
                self.heard_at = at;
            }
            ServerMessage::Roster(roster) => self.roster = roster,
            ServerMessage::You { seat, line } => {
                self.is_leaving &= seat.is_some() || line.is_some();
                if !self.is_leaving {
                    (self.seat, self.line) = (seat.filter(|&seat| usize::from(seat) < SEATS), line);
                }
            }
            ServerMessage::Pong { nonce, .. } => {
                if let Some(place) = self.pings.iter().position(|(sent, _)| *sent == nonce) {
                    self.lead.measured(at - self.pings[place].1);
                    self.pings.drain(..=place);
                }
            }
            ServerMessage::Bye { reason } => return Err(SessionError::Bye(reason)),
            ServerMessage::Welcome(_) | ServerMessage::Refused { .. } => return Err(SessionError::Greeting),
        }
        Ok(())
    }

    /// Asks for a seat, or for the next game.
    pub(crate) fn play(&self, connection: &Connection) {
        if !self.is_leaving && self.can_ask() {
            connection.send(ClientMessage::Play);
        }
    }

    /// Gives the seat or the place in the line back; `false` if there is none.
    pub(crate) fn leave(&mut self, connection: &Connection) -> bool {
        if self.seat.is_none() && self.line.is_none() {
            return false;
        }
        connection.send(ClientMessage::Leave);
        (self.seat, self.line, self.prediction) = (None, None, None);
        self.is_leaving = true;
        true
    }

    /// Brings the picture to local time `now`: pings, plays the player's hands, predicts, lets events be seen.
    pub(crate) fn advance(&mut self, now: f64, controls: &mut Controls, connection: &Connection) {
        self.ping(now, connection);
        let dt = self.table.scene.tick_seconds;
        let Some(live) = self.clock.tick_at(now) else { return };
        let loose = self.moment().map_or(0, |moment| moment.balls.iter().filter(|ball| !ball.is_held).count());
        let Some(newest) = self.snapshots.newest() else { return };
        let lead = self.lead.at(now, MARGIN, MOST_LEAD) / dt;
        let turn = self.seat.filter(|&seat| newest.phase().has_turn(seat));

        let Some(seat) = turn else {
            self.prediction = None;
            controls.frame(now, 0, false, |_, _| {});
            let target = live - DELAY / dt;
            // A turn that ends takes the picture from ahead of the server to behind it: it waits instead of going back.
            let waits = self.shown > target && self.shown - target < MOST_WAIT / dt;
            self.shown = if waits { self.shown } else { target };
            let (from, effects) = (self.events_shown, &mut self.effects);
            self.snapshots.take_events(self.shown, |event| {
                if event.tick >= from {
                    effects.note(&event, &self.table, loose, now);
                }
            });
            self.events_shown = from.max(self.shown.max(0.0) as u64);
            return;
        };

        let target = (live + lead).min(newest.tick() as f64 + MOST_AHEAD / dt);
        let prediction = match &mut self.prediction {
            Some(prediction) if prediction.seat() == seat && (prediction.tick() as f64) < target + MOST_EXCESS / dt => {
                match prediction.confirm(newest) {
                    Some(Verdict::Right) => self.counts.right += 1,
                    Some(Verdict::Wrong) => self.counts.wrong += 1,
                    Some(Verdict::Unknown) | None => {}
                }
                prediction
            }
            other => other.insert(Prediction::new(newest, seat)),
        };
        // After a frame that took long, its first tick is too early for an input to arrive in time.
        let earliest = (live + lead - (MARGIN - EARLY) / dt).max(0.0).ceil() as u64;
        controls.frame(now, earliest.max(prediction.tick()), true, |tick, action| {
            let tick = prediction.act(tick, action);
            connection.send(ClientMessage::Act { tick, action });
        });
        let (from, effects) = (self.events_shown, &mut self.effects);
        prediction.advance(target.max(0.0) as u64, |event| {
            if event.tick >= from {
                effects.note(event, &self.table, loose, now);
            }
        });
        self.events_shown = from.max(prediction.tick());
        self.shown = target.max(prediction.tick() as f64);
        self.counts.lead = lead;
        // They were seen when they were predicted.
        self.snapshots.take_events(f64::INFINITY, |_| {});
    }

    /// What is to be seen; `None` before the first snapshot.
    pub(crate) fn moment(&self) -> Option<Moment<'_>> {
        match &self.prediction {
            Some(prediction) => Some(prediction.now((self.shown - prediction.tick() as f64).clamp(0.0, 1.0))),
            None => self.snapshots.at(self.shown),
        }
    }

    /// Whether the server has said nothing for a while.
    pub(crate) fn is_silent(&self, now: f64) -> bool {
        now - self.heard_at > SILENCE
    }

    /// The table that is played.
    pub(crate) fn table(&self) -> &Arc<Table> {
        &self.table
    }

    /// Who is there.
    pub(crate) fn roster(&self) -> &Roster {
        &self.roster
    }

    /// The seat of the person at this window.
    pub(crate) fn seat(&self) -> Option<u8> {
        self.seat
    }

    /// Their place in the line, from 1.
    pub(crate) fn line(&self) -> Option<u16> {
        self.line
    }

    /// What past events have left to be seen.
    pub(crate) fn effects(&self) -> &Effects {
        &self.effects
    }

    /// The same, to let it fade.
    pub(crate) fn effects_mut(&mut self) -> &mut Effects {
        &mut self.effects
    }

    /// What was counted.
    pub(crate) fn counts(&self) -> Counts {
        self.counts
    }

    /// Whether there is something to ask for: a seat, a place in the line, the next game.
    fn can_ask(&self) -> bool {
        let is_playing = self.snapshots.newest().is_some_and(|game| matches!(game.phase(), Phase::Play { .. }));
        match self.seat {
            Some(_) => !is_playing,
            None => self.line.is_none(),
        }
    }

    fn ping(&mut self, now: f64, connection: &Connection) {
        if now < self.next_ping {
            return;
        }
        self.next_ping = now + PING_EVERY;
        self.nonce += 1;
        if self.pings.len() == MOST_PINGS {
            self.pings.pop_front();
        }
        self.pings.push_back((self.nonce, now));
        connection.send(ClientMessage::Ping { nonce: self.nonce });
    }
}

#[cfg(test)]
mod tests;
