//! The room: its games, everybody who plays or watches them, and the clock that drives them.
//!
//! [`Room::tick`] is the main flow. Nothing else changes a game, and everything that does is an input with a tick. The room is
//! a thread of its own: it sleeps until its next tick or the next command, and no crowd of sockets can hold it up.

mod clients;
mod controls;
mod hands;
mod pause;
mod turns;
mod wishes;

use std::collections::{BTreeMap, BTreeSet};
use std::sync::Arc;
use std::sync::atomic::{AtomicU64, Ordering};
use std::sync::mpsc::RecvTimeoutError;
use std::time::{Duration, Instant};

use bytes::Bytes;
use shared::game::{Game, GameEventKind, Input, Phase, Rescue, SEATS};
use shared::protocol::{BoardEvent, ClientMessage, Mode, ServerMessage};

use crate::account::Account;
use crate::broadcast::{NewsKind, Order, Orders};
use crate::chatter::Chatter;
use crate::commands::{Command, Heard};
use crate::config::Config;
use crate::lobby::{Deed, GameView, Lobby, News, Sitter};
use crate::pacing::{NextWake, Pacer};
use crate::streams::{Streams, wire};
use crate::votes::Votes;
use clients::{goodbye, welcome};
use controls::Controls;
use hands::Hands;
use wishes::Follower;

/// How often the room wakes to step what is due: a fourth of a player's interval.
const WAKE_EVERY: Duration = Duration::from_millis(4);
/// Seconds without a game after which the bot begins one.
const BOT_PATIENCE: f64 = 3.0;
/// Seconds after a game until the next begins by itself, if somebody new came up for it.
const NEXT_GAME_PAUSE: f64 = 6.0;
/// Seconds for which the result of a game stands before anybody makes room.
const RESULT_PAUSE: f64 = 2.0;
/// Seconds between two rosters when only the number of spectators changed.
const COUNT_PAUSE: f64 = 1.0;
/// Seconds between two rosters, between two tallies, and between two times that the line is told how it moves up.
const NEWS_PAUSE: f64 = 0.25;
/// Seconds after which a client may come and go again.
const WISH_PAUSE: f64 = 0.25;

/// How a game ended.
struct Outcome {
    /// The tick at which the losers make room for who waits.
    stands_until: u64,
    /// Places, who had them, and their points.
    scores: Vec<(u8, Sitter, u64)>,
    /// Whose place won, if there was somebody to win against.
    winner: Option<u8>,
    /// Somebody waited when it ended: whoever of them comes up meanwhile is to have a game.
    had_line: bool,
}

/// Games and everybody around them.
pub(crate) struct Room {
    config: Arc<Config>,
    games: Vec<Game>,
    lobby: Lobby,
    followers: BTreeMap<u32, Follower>,
    /// Who asked for something too soon.
    wishers: BTreeSet<u32>,
    streams: Streams,
    orders: Orders,
    votes: Votes,
    controls: Controls,
    hands: Hands,
    /// The tick for connections to read.
    shared_tick: Arc<AtomicU64>,
    welcome: Bytes,
    /// As many as have played in this game at the most.
    contestants: usize,
    /// A game was on in the tick before.
    was_playing: bool,
    /// Ticks without a game.
    idle_ticks: u64,
    /// Ticks until the next game begins by itself; 0: it does not.
    next_game_in: u64,
    /// How the last game ended, while that stands.
    result: Option<Outcome>,
    /// Who let the room stand still, while it does.
    paused_by: Option<u32>,
    next_roster: u64,
    next_moved: u64,
    next_tally: u64,
    next_client: u32,
    account: Account,
    chatter: Arc<Chatter>,
}

impl Room {
    pub(crate) fn new(config: Arc<Config>, orders: Orders, shared_tick: Arc<AtomicU64>) -> Self {
        let boards = if config.mode == Mode::HeadToHead { config.places.clamp(1, SEATS) } else { 1 };
        let has_bot = config.attract;
        let chatter = Arc::new(Chatter::new("the game"));
        Self {
            games: (0..boards).map(|_| Game::new(Arc::clone(&config.table))).collect(),
            lobby: Lobby::new(config.mode, config.places, has_bot, Arc::clone(&chatter)),
            followers: BTreeMap::new(),
            wishers: BTreeSet::new(),
            streams: Streams::new(config.room.clone(), orders.clone()),
            orders,
            votes: Votes::default(),
            controls: Controls::new(&config),
            hands: Hands::new(&config),
            shared_tick,
            welcome: welcome(&config),
            contestants: 0,
            was_playing: false,
            idle_ticks: 0,
            next_game_in: 0,
            result: None,
            paused_by: None,
            next_roster: 0,
            next_moved: 0,
            next_tally: 0,
            next_client: 1,
            account: Account::default(),
            chatter,
            config,
        }
    }

    /// Runs until it is told to stop; says goodbye to everybody.
    pub(crate) fn run(mut self, heard: &Heard, next_wake: &NextWake) -> Account {
        if self.config.pause {
            self.tell_pause();
        }
        let begin = Instant::now();
        let mut pacer = Pacer::new(1.0 / self.tick_seconds(), Duration::ZERO);
        let mut wake = WAKE_EVERY;
        loop {
            let now = begin.elapsed();
            next_wake.sleep_until(begin + wake);
            match heard.queue.recv_timeout(wake.saturating_sub(now)) {
                Ok(Command::Stop) | Err(RecvTimeoutError::Disconnected) => break,
                Ok(command) => {
                    if matches!(command, Command::Message { message: ClientMessage::Pause(_), .. }) {
                        // A pause begins and ends when it is heard, not at the next wake.
                        self.pass(pacer.due(begin.elapsed()));
                    }
                    self.handle(command);
                }
                Err(RecvTimeoutError::Timeout) => {}
            }
            next_wake.wake();
            let now = begin.elapsed();
            if now < wake {
                continue;
            }
            wake = self.account.lateness.note_due(wake, now, WAKE_EVERY);
            self.pass(pacer.due(now));
        }
        self.order(Order::End { last: goodbye("the server ends".to_owned()) });
        self.account
    }

    /// One tick of the room.
    fn tick(&mut self) {
        let tick = self.now();
        // 1. Who plays: the next in line, or the bot when nobody wants to; who leaves the controls alone loses the turn.
        self.grant_wishes();
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

    fn crowd_actions(&self) -> usize {
        self.config.table.rules.crowd.as_ref().map_or(0, |crowd| crowd.actions.len())
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
            GameEventKind::Started => {
                self.account.games += 1;
                self.begin_game();
            }
            GameEventKind::Served { .. } => {
                self.account.balls += 1;
                self.controls.begin_ball(board);
            }
            GameEventKind::Rescued { by: Rescue::Kickers } => {
                tracing::warn!("tick {}: a ball is stuck, and all kickers are fired", game.tick());
            }
            GameEventKind::Rescued { by: Rescue::Relaunch } => {
                self.account.rescued += 1;
                tracing::warn!("tick {}: a ball was stuck and is served again", game.tick());
            }
            GameEventKind::Tilted { seat } if self.chatter.may_speak() => {
                tracing::info!("{} tilts the game", self.lobby.name_of(place(seat)));
            }
            GameEventKind::Lost { seat } if self.chatter.may_speak() => {
                tracing::info!("{} lost a ball at {} points", self.lobby.name_of(place(seat)), points(seat));
            }
            _ => {}
        }
    }

    /// 5. Tells everybody who is there and what the crowd wants, and each what they are, when that changed.
    fn tell_news(&mut self) {
        let tick = self.now();
        for (client, you) in self.lobby.take_told() {
            self.serve_as(client, matches!(you, ServerMessage::You { place: Some(_), .. }));
            self.tell(client, &you);
        }
        if tick >= self.next_moved {
            self.next_moved = tick + self.ticks(NEWS_PAUSE);
            for (client, you) in self.lobby.take_moved() {
                self.tell(client, &you);
            }
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

    /// Whoever has a place is served at once, and has no vote among those who watch.
    fn serve_as(&mut self, client: u32, is_player: bool) {
        if is_player {
            self.votes.withdraw(client);
        }
        let Some(follower) = self.followers.get_mut(&client) else { return };
        if std::mem::replace(&mut follower.is_prompt, is_player) != is_player {
            self.order(Order::Hurry { client, is_prompt: is_player });
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

#[cfg(test)]
mod tests;
