//! One connection's room, from the welcome to the end: what the server said last, and what is to be seen of it now.
//!
//! Who has the turn sees a prediction of their board; everything else is seen a little late: as it was sent, or, in a stream
//! of inputs that is only watched, in copies of the games that are stepped along. What is to be sent waits in the session
//! until whoever has the connection takes it: a session knows no socket.

mod advance;
mod board;
mod contest;
pub(crate) mod counts;
mod error;
mod feed;
mod ghosts;
mod pause;
mod pings;
#[cfg(test)]
mod simulated;

use std::sync::Arc;

use shared::game::{Game, GameEvent, Phase, SEATS};
use shared::physics::PHYSICS_VERSION;
use shared::protocol::{ClientMessage, Form, Heard, Mode, Role, Roster, ServerMessage, Stream, Tally, Welcome};
use shared::table::Table;

use crate::budget::Budget;
use crate::effects::Effects;
use crate::film::{Camera, Film};
use crate::moment::Moment;
use crate::prediction::Prediction;
use crate::streams::StreamChoice;
use crate::timing::{Delay, Lead, ServerClock, TrueClock};
use board::Board;
use contest::Contest;
pub(crate) use contest::{Contestant, Outcome};
pub(crate) use counts::Counts;
pub(crate) use error::SessionError;
use feed::Feed;
use pause::GameTime;
use pings::Pings;

/// One connection's room.
#[derive(Debug)]
pub(crate) struct Session {
    table: Arc<Table>,
    mode: Mode,
    places: u8,
    choice: StreamChoice,
    feed: Feed,
    time: GameTime,
    clock: ServerClock,
    delay: Delay,
    truth: TrueClock,
    lead: Lead,
    pings: Pings,
    boards: Vec<Board>,
    /// The board that a spectator looks at.
    chosen: usize,
    prediction: Option<Prediction>,
    roster: Roster,
    tally: Tally,
    /// What the person at the window voted for.
    vote: Option<u8>,
    place: Option<u8>,
    line: Option<u16>,
    /// The place was given back, but the server has not said so yet. Until then nothing may be asked, and what it says
    /// about the place is old.
    is_leaving: bool,
    /// The stream that the clock and the delay know.
    known: Option<Stream>,
    /// When the last frame of the stream came.
    heard_at: f64,
    began_at: Option<f64>,
    contest: Contest,
    camera: Camera,
    /// What may still be computed for the next picture.
    budget: Budget,
    outbox: Vec<ClientMessage>,
    counts: Counts,
}

impl Session {
    /// A session as a welcome begins it, after a hello for `role`.
    ///
    /// # Errors
    /// If the table cannot be played here.
    pub(crate) fn new(welcome: &Welcome, choice: StreamChoice, role: Role) -> Result<Self, SessionError> {
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
        let tick_seconds = table.scene.tick_seconds;
        Ok(Self {
            mode: welcome.mode,
            places: welcome.places,
            feed: Feed::new(Arc::clone(&table), choice.stream(role)),
            choice,
            time: GameTime::default(),
            clock: ServerClock::new(tick_seconds),
            delay: Delay::default(),
            truth: TrueClock::new(tick_seconds),
            lead: Lead::default(),
            pings: Pings::default(),
            boards: vec![Board::new(&table)],
            chosen: 0,
            prediction: None,
            roster: Roster::default(),
            tally: Tally::default(),
            vote: None,
            place: None,
            line: None,
            is_leaving: false,
            known: None,
            heard_at: 0.0,
            began_at: None,
            contest: Contest::default(),
            camera: Camera::new(Arc::clone(&table)),
            budget: Budget::of_picture(tick_seconds, 1),
            outbox: Vec::new(),
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
            ServerMessage::Full(full) => {
                let heard = self.feed.hear_full(&full)?;
                if heard == Heard::Anew {
                    self.camera.begin(self.feed.games());
                }
                self.boards.resize_with(self.feed.games().len().max(1), || Board::new(&self.table));
                self.note_frame(at, heard, None);
            }
            ServerMessage::Change(change) => {
                let heard = self.feed.hear_change(&change)?;
                // Nobody says what was pressed.
                self.camera.cut();
                for event in change.events.iter().filter(|_| heard == Heard::Further) {
                    if let Some(board) = self.boards.get_mut(usize::from(event.board)) {
                        board.snapshots.note(event.event);
                    }
                }
                self.note_frame(at, heard, Some(change.to));
            }
            ServerMessage::Inputs(inputs) => {
                let known = self.feed.confirmed();
                let heard = self.feed.hear_inputs(&inputs)?;
                if heard == Heard::Further {
                    self.camera.hear(known, &inputs);
                }
                self.note_frame(at, heard, Some(inputs.to));
            }
            ServerMessage::Roster(roster) => self.roster = roster,
            ServerMessage::Tally(tally) => {
                if self.tally.closes.is_some() && tally.closes != self.tally.closes {
                    self.vote = None;
                }
                self.tally = tally;
            }
            ServerMessage::You { place, line, .. } => self.hear_what_i_am(place, line),
            ServerMessage::Pong { nonce, tick } => {
                if let Some(trip) = self.pings.answered(nonce, at) {
                    self.lead.measured(trip);
                    self.truth.answered(tick, self.time.at(at), trip);
                }
            }
            ServerMessage::Paused(stands_still) => self.hear_pause(at, stands_still),
            ServerMessage::Bye { reason } => return Err(SessionError::Bye(reason)),
            ServerMessage::Welcome(_) | ServerMessage::Refused { .. } => return Err(SessionError::Greeting),
        }
        Ok(())
    }

    /// A frame of the stream came, which leads to a tick.
    fn note_frame(&mut self, at: f64, heard: Heard, to: Option<u64>) {
        self.heard_at = at;
        self.counts.frames += 1;
        if !self.feed.is_switching() && self.known != Some(self.feed.stream()) {
            // Another stream's frames wait longer or shorter at the server.
            self.known = Some(self.feed.stream());
            (self.clock, self.delay) = (ServerClock::new(self.table.scene.tick_seconds), Delay::default());
        }
        // When a full snapshot comes says little: the first one of a stream may be as old as a frame.
        if let (Heard::Further, Some(tick)) = (heard, to) {
            let at = self.time.at(at);
            self.delay.arrived(at, self.clock.arrived(tick, at));
        }
        if !self.is_stepped() {
            self.keep_what_was_sent();
        }
    }

    /// The place in the room, or in the line, as the server says; and the stream that goes with it.
    fn hear_what_i_am(&mut self, place: Option<u8>, line: Option<u16>) {
        self.is_leaving &= place.is_some() || line.is_some();
        let place = place.filter(|&place| usize::from(place) < SEATS);
        if !self.is_leaving {
            if place != self.place {
                self.prediction = None;
                tracing::debug!("place: {place:?}");
            }
            (self.place, self.line) = (place, line);
        }
        let role = if place.is_some() { Role::Play } else { Role::Watch };
        let stream = self.choice.stream(role);
        if self.feed.switch(stream) {
            self.outbox.push(ClientMessage::Stream(stream));
        }
    }

    /// Asks for a place, or for the next game.
    pub(crate) fn play(&mut self) {
        if !self.is_leaving && self.can_ask() {
            self.outbox.push(ClientMessage::Play);
        }
    }

    /// Gives the place in the room or in the line back; `false` if there is none.
    pub(crate) fn leave(&mut self) -> bool {
        if self.place.is_none() && self.line.is_none() {
            return false;
        }
        self.outbox.push(ClientMessage::Leave);
        (self.place, self.line, self.prediction) = (None, None, None);
        self.is_leaving = true;
        true
    }

    /// Votes for something that the crowd may do, by its place among those.
    pub(crate) fn vote(&mut self, action: u8) {
        let count = self.table.rules.crowd.as_ref().map_or(0, |crowd| crowd.actions.len());
        let is_playing = self.newest().is_some_and(|game| matches!(game.phase(), Phase::Play { .. }));
        if self.mode == Mode::Crowd && self.place.is_none() && is_playing && usize::from(action) < count {
            self.vote = Some(action);
            self.outbox.push(ClientMessage::Vote { action });
        }
    }

    /// Looks at another board, so many further on.
    pub(crate) fn look(&mut self, further: i8) {
        let count = self.boards.len() as i64;
        self.chosen = (self.main_board() as i64 + i64::from(further)).rem_euclid(count) as usize;
    }

    /// What is to be sent since the last call.
    pub(crate) fn take_outgoing(&mut self) -> std::vec::Drain<'_, ClientMessage> {
        self.outbox.drain(..)
    }

    /// What is to be seen of a board; `None` before the first full snapshot.
    pub(crate) fn moment(&self, board: usize) -> Option<Moment<'_>> {
        let Board { snapshots, shown, .. } = self.boards.get(board)?;
        if let Some(prediction) = self.prediction.as_ref().filter(|_| self.own_board() == Some(board)) {
            return Some(prediction.now((shown - prediction.tick() as f64).clamp(0.0, 1.0)));
        }
        if self.is_stepped() {
            let game = self.feed.games().get(board)?;
            return Some(Moment::of(game, (shown - game.tick() as f64).clamp(0.0, 1.0)));
        }
        snapshots.at(*shown)
    }

    /// The table that is played.
    pub(crate) fn table(&self) -> &Arc<Table> {
        &self.table
    }

    /// How the room is played.
    pub(crate) fn mode(&self) -> Mode {
        self.mode
    }

    /// Who is there.
    pub(crate) fn roster(&self) -> &Roster {
        &self.roster
    }

    /// What the crowd is voting for.
    pub(crate) fn tally(&self) -> &Tally {
        &self.tally
    }

    /// What the person at this window voted for.
    pub(crate) fn voted(&self) -> Option<u8> {
        self.vote
    }

    /// The place of the person at this window.
    pub(crate) fn place(&self) -> Option<u8> {
        self.place
    }

    /// Their place in the line, from 1.
    pub(crate) fn line(&self) -> Option<u16> {
        self.line
    }

    /// How many places for players the room has.
    pub(crate) fn places(&self) -> usize {
        usize::from(self.places)
    }

    /// How many boards there are.
    pub(crate) fn board_count(&self) -> usize {
        self.boards.len()
    }

    /// The board that is seen large: one's own, or the one that a spectator chose.
    pub(crate) fn main_board(&self) -> usize {
        self.own_board().unwrap_or(self.chosen).min(self.boards.len() - 1)
    }

    /// Board and seat of a place.
    pub(crate) fn board_and_seat(&self, place: u8) -> (usize, u8) {
        match self.mode {
            Mode::HeadToHead => (usize::from(place), 0),
            Mode::Challenge | Mode::Crowd => (0, place),
        }
    }

    /// What past events on a board have left to be seen.
    pub(crate) fn effects(&self, board: usize) -> Option<&Effects> {
        self.boards.get(board).map(|board| &board.effects)
    }

    /// The same, to let it fade.
    pub(crate) fn effects_mut(&mut self, board: usize) -> Option<&mut Effects> {
        self.boards.get_mut(board).map(|board| &mut board.effects)
    }

    /// What was shown on the main board since the last call, to be heard.
    pub(crate) fn take_fresh(&mut self) -> Vec<GameEvent> {
        let main = self.main_board();
        // Of the others nothing is kept: they are not heard.
        let mut fresh: Vec<_> = self.boards.iter_mut().map(|board| std::mem::take(&mut board.fresh)).collect();
        fresh.swap_remove(main)
    }

    /// The last game on the board that is seen large, if it could be filmed.
    pub(crate) fn film(&self) -> Option<&Film> {
        self.camera.film(self.main_board())
    }

    /// What was counted.
    pub(crate) fn counts(&self) -> Counts {
        Counts { mismatches: self.feed.mismatches(), ..self.counts }
    }

    fn own_board(&self) -> Option<usize> {
        self.place.map(|place| self.board_and_seat(place).0)
    }

    /// The copies are stepped along with the picture. Whoever plays needs them as new as can be.
    fn is_stepped(&self) -> bool {
        self.place.is_none() && self.feed.form() == Form::Inputs
    }

    /// The newest state of the board that is seen large.
    fn newest(&self) -> Option<&Game> {
        self.feed.games().get(self.main_board())
    }

    /// Whether there is something to ask for: a place, a place in the line, the next game.
    fn can_ask(&self) -> bool {
        let is_playing = self.feed.games().iter().any(|game| matches!(game.phase(), Phase::Play { .. }));
        match self.place {
            Some(_) => !is_playing,
            None => self.line.is_none(),
        }
    }
}

#[cfg(test)]
mod tests;
