//! The room: its games, everybody who plays or watches them, and the clock that drives them.
//!
//! [`Room::tick`] is the main flow. Nothing else changes a game, and everything that does is an input with a tick. The room is
//! a thread of its own: it sleeps until its next tick or the next command, and no crowd of sockets can hold it up.

mod controls;
mod hands;

use std::sync::Arc;
use std::sync::atomic::{AtomicU64, Ordering};
use std::sync::mpsc::RecvTimeoutError;
use std::time::{Duration, Instant};

use bytes::Bytes;
use shared::game::{Action, Game, GameEventKind, HOUSE, Input, Phase, Rescue, SEATS};
use shared::physics::PHYSICS_VERSION;
use shared::protocol::{
    BoardEvent, BoardInput, ClientMessage, Hello, Mode, REQUEST_SECONDS, Role, ServerMessage, Stream, Welcome,
    encode_greeting, framed,
};
use tokio::sync::oneshot;

use crate::account::Account;
use crate::broadcast::{NewsKind, Order, Orders};
use crate::commands::{Command, Heard};
use crate::config::Config;
use crate::lobby::{Deed, GameView, Lobby, News, Sitter};
use crate::pacing::Pacer;
use crate::session::{SessionState, is_legal};
use crate::streams::{Streams, wire};
use crate::transport::Outgoing;
use crate::votes::Votes;
use controls::Controls;
use hands::Hands;

/// How often the room wakes to step what is due: a fourth of a player's interval.
const WAKE_EVERY: Duration = Duration::from_millis(4);
/// Seconds without a game after which the bot begins one.
const BOT_PATIENCE: f64 = 3.0;
/// Seconds after a game until the next begins by itself, if somebody new came up for it.
const NEXT_GAME_PAUSE: f64 = 8.0;
/// Seconds between two rosters when only the number of spectators changed.
const COUNT_PAUSE: f64 = 1.0;
/// Seconds between two rosters, and between two tallies.
const NEWS_PAUSE: f64 = 0.25;

/// What a client is to the streams.
struct Follower {
    stream: Stream,
    /// The tick from which on another full snapshot is given on request.
    next_full: u64,
}

/// Games and everybody around them.
pub(crate) struct Room {
    config: Arc<Config>,
    games: Vec<Game>,
    lobby: Lobby,
    followers: std::collections::BTreeMap<u32, Follower>,
    streams: Streams,
    orders: Orders,
    votes: Votes,
    controls: Controls,
    hands: Hands,
    /// The tick for connections to read.
    shared_tick: Arc<AtomicU64>,
    welcome: Bytes,
    /// A game was on in the tick before.
    was_playing: bool,
    /// Ticks without a game.
    idle_ticks: u64,
    /// Ticks until the next game begins by itself; 0: it does not.
    next_game_in: u64,
    next_roster: u64,
    next_tally: u64,
    next_client: u32,
    account: Account,
}

impl Room {
    pub(crate) fn new(config: Arc<Config>, orders: Orders, shared_tick: Arc<AtomicU64>) -> Self {
        let boards = if config.mode == Mode::HeadToHead { config.places.clamp(1, SEATS) } else { 1 };
        let has_bot = config.attract;
        Self {
            games: (0..boards).map(|_| Game::new(Arc::clone(&config.table))).collect(),
            lobby: Lobby::new(config.mode, config.places, has_bot),
            followers: Default::default(),
            streams: Streams::new(config.room.clone(), orders.clone()),
            orders,
            votes: Votes::default(),
            controls: Controls::new(&config),
            hands: Hands::new(&config),
            shared_tick,
            welcome: welcome(&config),
            was_playing: false,
            idle_ticks: 0,
            next_game_in: 0,
            next_roster: 0,
            next_tally: 0,
            next_client: 1,
            account: Account::default(),
            config,
        }
    }

    /// Runs until it is told to stop; says goodbye to everybody.
    pub(crate) fn run(mut self, heard: &Heard) -> Account {
        let begin = Instant::now();
        let mut pacer = Pacer::new(1.0 / self.tick_seconds(), Duration::ZERO);
        let mut wake = WAKE_EVERY;
        loop {
            let now = begin.elapsed();
            match heard.queue.recv_timeout(wake.saturating_sub(now)) {
                Ok(Command::Stop) | Err(RecvTimeoutError::Disconnected) => break,
                Ok(command) => self.handle(command),
                Err(RecvTimeoutError::Timeout) => {}
            }
            let now = begin.elapsed();
            if now < wake {
                continue;
            }
            self.account.lateness.note(now - wake);
            let due = pacer.due(now);
            self.account.ticks_skipped += due.skipped;
            if due.skipped > 0 {
                tracing::warn!("the machine stalled: {} ticks given up", due.skipped);
            }
            for _ in 0..due.ticks {
                self.tick();
            }
            // A wake that was missed is not made up for: the next batch is the larger.
            wake += WAKE_EVERY;
            wake = wake.max(begin.elapsed());
        }
        self.order(Order::End { last: goodbye("the server ends".to_owned()) });
        self.account
    }

    /// One tick of the room.
    fn tick(&mut self) {
        let tick = self.now();
        // 1. Who plays: the next in line, or the bot when nobody wants to; who leaves the controls alone loses the turn.
        self.fill_places();
        self.hurry_idlers();
        // 2. The bot's hands, and the crowd's.
        self.hands.play(&self.games, &self.lobby, &mut self.controls);
        self.count_votes();
        // 3. Each game plays the tick with the inputs that are due.
        let due = self.controls.take_due(tick);
        for (board, game) in (0_u8..).zip(&mut self.games) {
            let inputs: Vec<Input> = due.iter().filter(|due| due.board == board).map(|due| due.input).collect();
            game.step(&inputs);
        }
        self.streams.note_inputs(&due);
        self.account.ticks += 1;
        self.shared_tick.store(self.now(), Ordering::Relaxed);
        // 4. What happened: for the account, the log and whoever does not simulate.
        self.note_events();
        self.note_end_of_game();
        // 5. Every stream's frame that is due; and who is there, for whom that is news.
        self.streams.send_due(&self.games, &mut self.account);
        self.tell_news();
    }

    fn handle(&mut self, command: Command) {
        match command {
            Command::Join { hello, transport, ended, reply } => self.join(hello, transport, ended, reply),
            Command::Message { client, message } => self.hear(client, message),
            Command::Expel { client, reason } => self.expel(client, reason),
            Command::Left { client } => self.forget(client, Bytes::new()),
            // `run` ends at it.
            Command::Stop => {}
        }
    }

    fn join(
        &mut self,
        hello: Hello,
        mut transport: Box<dyn Outgoing>,
        ended: oneshot::Sender<String>,
        reply: oneshot::Sender<Option<u32>>,
    ) {
        if self.lobby.len() >= self.config.most_connections {
            let refusal = crate::connection::refusal("the server is full; try again later".to_owned());
            // One attempt: a new socket has room for a line. The connection may have ended while it waited.
            let _ = transport.try_write(&[std::io::IoSlice::new(&refusal)]);
            let _ = reply.send(None);
            return;
        }
        let client = self.next_client;
        self.next_client = self.next_client.wrapping_add(1);
        if reply.send(Some(client)).is_err() {
            return;
        }
        self.account.clients += 1;
        let Hello { name, role, stream } = hello;
        self.streams.follow(stream, &self.games);
        self.followers.insert(client, Follower { stream, next_full: 0 });
        self.order(Order::Add { client, transport, stream, greeting: self.welcome.clone(), ended });
        self.lobby.add(client, name);
        if role == Role::Play {
            let deeds = self.lobby.play(client, self.view());
            self.perform(&deeds);
        }
    }

    /// A client said something.
    fn hear(&mut self, client: u32, message: ClientMessage) {
        let Some((state, had_place)) = self.lobby.state(client) else { return };
        if !is_legal(self.config.mode, state, had_place, &message) {
            return self.expel(client, format!("{message:?} is not for a client that is {state:?}"));
        }
        match message {
            ClientMessage::Act { tick, action } => {
                if let SessionState::Seated(place) = state {
                    self.account.controls += u64::from(self.controls.act(self.now(), place, tick, action));
                }
            }
            ClientMessage::Play => {
                let deeds = self.lobby.play(client, self.view());
                self.perform(&deeds);
            }
            ClientMessage::Leave => {
                let deeds = self.lobby.leave(client, self.view());
                self.perform(&deeds);
            }
            // Connections answer themselves.
            ClientMessage::Ping { .. } => {}
            ClientMessage::Stream(stream) => self.switch(client, stream),
            ClientMessage::Differs { tick, digest } => self.hear_difference(client, tick, digest),
            ClientMessage::Vote { action } => self.hear_vote(client, state, action),
        }
    }

    fn switch(&mut self, client: u32, stream: Stream) {
        let Some(follower) = self.followers.get_mut(&client) else { return };
        let before = std::mem::replace(&mut follower.stream, stream);
        self.streams.follow(stream, &self.games);
        self.order(Order::Switch { client, stream });
        self.streams.unfollow(before);
    }

    /// A client's copy is not what the game is, which must never be, or it missed something. It gets a full snapshot.
    fn hear_difference(&mut self, client: u32, tick: u64, theirs: u64) {
        self.account.differing += 1;
        let now = self.now();
        let pause = self.ticks(REQUEST_SECONDS);
        let Some(follower) = self.followers.get_mut(&client) else { return };
        if now < follower.next_full {
            return;
        }
        follower.next_full = now + pause;
        let stream = follower.stream;
        match self.streams.digest_at(tick) {
            Some(ours) if theirs != 0 => {
                tracing::warn!(client, "differs at tick {tick}: {theirs:016x} there, {ours:016x} here");
            }
            _ => tracing::info!(client, "asks for a full snapshot at tick {tick}"),
        }
        self.order(Order::Switch { client, stream });
    }

    fn expel(&mut self, client: u32, reason: String) {
        if self.lobby.state(client).is_none() {
            return;
        }
        tracing::warn!(client, "expelled: {reason}");
        self.account.illegal += 1;
        self.forget(client, goodbye(reason));
    }

    /// A client's session is over, with that as the last word.
    fn forget(&mut self, client: u32, last: Bytes) {
        if let Some(follower) = self.followers.remove(&client) {
            self.order(Order::Remove { client, last });
            self.streams.unfollow(follower.stream);
        }
        self.votes.withdraw(client);
        let deeds = self.lobby.remove(client, self.view());
        self.perform(&deeds);
    }

    /// What the lobby decided, as inputs of the coming tick.
    fn perform(&mut self, deeds: &[Deed]) {
        for &(place, action) in deeds {
            self.controls.perform(self.now(), place, action);
        }
    }

    fn now(&self) -> u64 {
        self.games[0].tick()
    }

    fn tick_seconds(&self) -> f64 {
        self.config.table.scene.tick_seconds
    }

    fn ticks(&self, seconds: f64) -> u64 {
        (seconds / self.tick_seconds()) as u64
    }

    fn view(&self) -> GameView {
        let is_playing = self.is_playing();
        // Where each has a board of their own, nobody comes into a match that is on.
        let is_at_start = if self.games.len() > 1 { !is_playing } else { self.games[0].is_at_start() };
        GameView { is_at_start, is_playing }
    }

    fn is_playing(&self) -> bool {
        self.games.iter().any(|game| matches!(game.phase(), Phase::Play { .. }))
    }

    /// 1. Seats the next in line where the game lets them in; begins the next game when somebody new came up for it, or
    ///    somebody waits for one; after a while without a game, the bot plays.
    fn fill_places(&mut self) {
        let deeds = self.lobby.fill_places(self.view());
        self.perform(&deeds);
        if self.is_playing() {
            (self.idle_ticks, self.next_game_in) = (0, 0);
            return;
        }
        self.idle_ticks += 1;
        let waits_long = self.lobby.has_line() && self.idle_ticks > self.ticks(self.config.idle_time.as_secs_f64());
        if self.next_game_in == 1 || waits_long {
            let deeds = self.lobby.start_for_all();
            self.perform(&deeds);
            self.idle_ticks = 0;
        }
        self.next_game_in = self.next_game_in.saturating_sub(1);
        if self.config.attract && !self.lobby.has_people() && self.idle_ticks >= self.ticks(BOT_PATIENCE) {
            let mut deeds = self.lobby.attract();
            if deeds.is_empty() {
                deeds = self.lobby.start_for_all();
            }
            self.idle_ticks = 0;
            self.perform(&deeds);
        }
    }

    /// 1. Whoever has the turn and does nothing for too long loses it.
    fn hurry_idlers(&mut self) {
        let most = self.ticks(self.config.idle_time.as_secs_f64());
        for board in 0..self.games.len() {
            let Phase::Play { seat, serve_in: 0, .. } = self.games[board].phase() else { continue };
            let place = if self.games.len() > 1 { board as u8 } else { seat };
            if !matches!(self.lobby.sitter(place), Some(Sitter::Client(_))) {
                continue;
            }
            if self.controls.is_idle(board, &self.games[board], place, most) {
                tracing::info!("{} does nothing and loses the turn", self.lobby.name_of(place));
                self.account.forfeited += 1;
                self.controls.perform(self.now(), place, Action::Forfeit);
            }
        }
    }

    fn hear_vote(&mut self, client: u32, state: SessionState, action: u8) {
        let is_action = usize::from(action) < self.crowd_actions();
        if is_action && !matches!(state, SessionState::Seated(_)) && self.is_playing() {
            let closes = self.now() + self.ticks(self.config.vote_time.as_secs_f64());
            self.votes.cast(client, action, closes);
        }
    }

    /// 2. When the time to vote is up, the house does what most want.
    fn count_votes(&mut self) {
        let (tick, actions) = (self.now(), self.crowd_actions());
        let game = &self.games[0];
        if let Some(_action) = self.votes.count(tick, actions, |_action| game.tick() > 0) {
            let input = Input { tick, seat: HOUSE, action: Action::Forfeit };
            self.controls.push(BoardInput { board: 0, input });
        }
    }

    fn crowd_actions(&self) -> usize {
        0
    }

    /// 4. Counts and logs what happened in the tick.
    fn note_events(&mut self) {
        self.account.count_strokes(&self.games);
        for board in 0..self.games.len() {
            for place in 0..self.games[board].events().len() {
                let event = self.games[board].events()[place];
                self.note_event(board, event.kind);
                self.streams.note_event(BoardEvent { board: board as u8, event });
            }
        }
    }

    fn note_event(&mut self, board: usize, kind: GameEventKind) {
        let game = &self.games[board];
        let points = |seat: u8| game.seats()[usize::from(seat)].score.points;
        let place = |seat: u8| if self.games.len() > 1 { board as u8 } else { seat };
        match kind {
            GameEventKind::Started => self.account.games += 1,
            GameEventKind::Served { .. } => self.account.balls += 1,
            GameEventKind::Rescued { by: Rescue::Kickers } => {
                tracing::warn!("tick {}: a ball is stuck, and all kickers are fired", game.tick());
            }
            GameEventKind::Rescued { by: Rescue::Relaunch } => {
                self.account.rescued += 1;
                tracing::warn!("tick {}: a ball was stuck and is served again", game.tick());
            }
            GameEventKind::Tilted { seat } => tracing::info!("{} tilts the game", self.lobby.name_of(place(seat))),
            GameEventKind::Lost { seat } => {
                tracing::info!("{} lost a ball at {} points", self.lobby.name_of(place(seat)), points(seat));
            }
            _ => {}
        }
    }

    /// 4. After a game: who stays, who makes room.
    fn note_end_of_game(&mut self) {
        let is_playing = self.is_playing();
        if std::mem::replace(&mut self.was_playing, is_playing) && !is_playing {
            let mut scores = Vec::new();
            for (board, game) in (0_u8..).zip(&self.games) {
                for (seat, seated) in (0_u8..).zip(game.seats()) {
                    // A game that ended because everybody left was nobody's.
                    if seated.playing && matches!(game.phase(), Phase::Over) {
                        let place = if self.games.len() > 1 { board } else { seat };
                        tracing::info!("game over: {} has {} points", self.lobby.name_of(place), seated.score.points);
                        scores.push((place, seated.score.points));
                    }
                }
            }
            self.votes.clear();
            if scores.is_empty() {
                return;
            }
            let had_line = self.lobby.has_line();
            let deeds = self.lobby.make_room(&scores);
            self.perform(&deeds);
            self.next_game_in = if had_line { self.ticks(NEXT_GAME_PAUSE) } else { 0 };
        }
    }

    /// 5. Tells everybody who is there and what the crowd wants, and each what they are, when that changed.
    fn tell_news(&mut self) {
        let tick = self.now();
        for (client, you) in self.lobby.take_told() {
            let is_prompt = matches!(you, ServerMessage::You { place: Some(_), .. });
            self.order(Order::Hurry { client, is_prompt });
            self.tell(client, &you);
        }
        let due = match self.lobby.news() {
            News::None => false,
            News::Count => tick >= self.next_roster + self.ticks(COUNT_PAUSE - NEWS_PAUSE),
            News::Names => tick >= self.next_roster,
        };
        if due {
            self.next_roster = tick + self.ticks(NEWS_PAUSE);
            let roster = self.lobby.take_roster();
            self.order(Order::News { kind: NewsKind::Roster, frame: wire(&ServerMessage::Roster(roster)) });
        }
        if tick >= self.next_tally
            && let Some(tally) = self.votes.take_tally(self.crowd_actions())
        {
            self.next_tally = tick + self.ticks(NEWS_PAUSE);
            self.order(Order::News { kind: NewsKind::Tally, frame: wire(&ServerMessage::Tally(tally)) });
        }
    }

    fn tell(&self, client: u32, message: &ServerMessage) {
        self.order(Order::Tell { client, frame: wire(message) });
    }

    fn order(&self, order: Order) {
        // There may be nobody to carry it out any more: the server ends.
        let _ = self.orders.send(order);
    }
}

fn goodbye(reason: String) -> Bytes {
    wire(&ServerMessage::Bye { reason })
}

/// The welcome as it goes on the wire: the same for all.
fn welcome(config: &Config) -> Bytes {
    let welcome = Welcome {
        room: config.room.clone(),
        mode: config.mode,
        places: config.places.clamp(1, SEATS) as u8,
        physics: PHYSICS_VERSION,
        table_digest: config.table.digest,
        table: config.table.source.clone(),
    };
    framed(&encode_greeting(&ServerMessage::Welcome(welcome))).into()
}

#[cfg(test)]
mod tests;
