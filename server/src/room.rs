//! The room: one game, everybody who plays or watches it, and the clock that drives it.
//!
//! [`Room::tick`] is the main flow. Nothing else changes the game, and everything that does is an input with a tick.

use std::sync::Arc;
use std::time::Duration;

use bytes::Bytes;
use shared::game::{Action, Bot, Game, GameEvent, GameEventKind, Input, Phase, Rescue, SEATS};
use shared::protocol::{
    ClientMessage, MOST_EVENTS, NUDGE_SECONDS, Role, SNAPSHOT_HZ, ServerMessage, Snapshot, TAP_TICKS,
};
use tokio::sync::{broadcast, mpsc, oneshot};
use tokio::time::{Instant, MissedTickBehavior};

use crate::account::Account;
use crate::config::Config;
use crate::connection::frame_of;
use crate::lobby::{Deed, GameView, Lobby};
use crate::pacing::Pacer;
use crate::session::{SessionState, is_legal};

/// How often the room wakes to step what is due: a fourth of a snapshot's interval.
const WAKE_EVERY: Duration = Duration::from_millis(4);
/// Commands that are heard at each wake, however late it is.
const COMMANDS_A_WAKE: usize = 256;
/// Seconds by which a player may stamp an input ahead.
const MOST_LEAD: f64 = 0.25;
/// Controls of one seat that may wait for their tick; more are dropped.
const MOST_PENDING: usize = 128;
/// Seconds without a game after which the bot begins one.
const BOT_PATIENCE: f64 = 3.0;
/// Things of a seat that a control works: two flippers, the plunger and the table itself.
const PARTS: usize = 4;

/// What connections ask of the room.
#[derive(Debug)]
pub(crate) enum Command {
    /// A client said hello.
    Join {
        /// Checked.
        name: String,
        /// What it comes for.
        role: Role,
        /// Frames for it alone.
        direct: mpsc::Sender<Bytes>,
        /// Who it is now, or why it is not let in.
        reply: oneshot::Sender<Result<u32, String>>,
    },
    /// A client said something.
    Message {
        /// Which.
        client: u32,
        /// What.
        message: ClientMessage,
    },
    /// A client said something that nobody understands.
    Expel {
        /// Which.
        client: u32,
        /// What it is told.
        reason: String,
    },
    /// A client is gone.
    Left {
        /// Which.
        client: u32,
    },
}

/// When a control was stamped, and when it acts.
#[derive(Debug, Clone, Copy, Default)]
struct Stamp {
    asked: u64,
    acts: u64,
}

/// A game and everybody around it.
pub(crate) struct Room {
    config: Arc<Config>,
    game: Game,
    lobby: Lobby,
    bot: Bot,
    frames: broadcast::Sender<Bytes>,
    /// Inputs for ticks to come.
    pending: Vec<Input>,
    /// For each seat and part, its last control.
    stamps: [[Stamp; PARTS]; SEATS],
    /// What happened since the last snapshot.
    events: Vec<GameEvent>,
    /// Ticks without a game.
    idle_ticks: u64,
    next_client: u32,
    /// Flippers in the upper part of a stroke that was counted, one bit each.
    raised: u64,
    account: Account,
}

impl Room {
    pub(crate) fn new(config: Arc<Config>, frames: broadcast::Sender<Bytes>) -> Self {
        Self {
            game: Game::new(Arc::clone(&config.table)),
            lobby: Lobby::default(),
            bot: Bot::new(0, config.seed),
            frames,
            pending: Vec::new(),
            stamps: Default::default(),
            events: Vec::new(),
            idle_ticks: 0,
            next_client: 1,
            raised: 0,
            account: Account::default(),
            config,
        }
    }

    /// Runs until `stopped` is dropped or ready; says goodbye to everybody.
    pub(crate) async fn run(
        mut self,
        mut commands: mpsc::Receiver<Command>,
        mut stopped: oneshot::Receiver<()>,
    ) -> Account {
        let begin = Instant::now();
        let mut pacer = Pacer::new(1.0 / self.game.table().scene.tick_seconds, Duration::ZERO);
        let mut wake = tokio::time::interval(WAKE_EVERY);
        wake.set_missed_tick_behavior(MissedTickBehavior::Delay);
        loop {
            tokio::select! {
                biased;
                _ = &mut stopped => break,
                _ = wake.tick() => {
                    let due = pacer.due(begin.elapsed());
                    self.account.ticks_skipped += due.skipped;
                    if due.skipped > 0 {
                        tracing::warn!("the machine stalled: {} ticks given up", due.skipped);
                    }
                    for _ in 0..due.ticks {
                        self.tick();
                    }
                    // On a machine that is always late the next wake is due already: nobody must wait for ever.
                    for _ in 0..COMMANDS_A_WAKE {
                        let Ok(command) = commands.try_recv() else { break };
                        self.handle(command);
                    }
                }
                Some(command) = commands.recv() => self.handle(command),
            }
        }
        self.lobby.tell_all(&ServerMessage::Bye { reason: "the server ends".to_owned() });
        self.account
    }

    /// One tick of the room.
    fn tick(&mut self) {
        let tick = self.game.tick();
        // 1. Who sits: the next in line, or the bot when nobody wants to.
        self.fill_seats();
        // 2. The bot's hands.
        if self.lobby.has_bot() {
            let pending = &mut self.pending;
            self.bot.play(&self.game, |action| pending.push(Input { tick, seat: 0, action }));
        }
        // 3. The game plays the tick with the inputs that are due.
        self.game.step(&self.pending);
        self.pending.retain(|input| input.tick > tick);
        self.account.ticks += 1;
        // 4. What happened: for the account, the log and the spectators.
        self.note_events();
        // 5. Sixty times a second: who is there, for whom that is news; and the game as it is now, for all.
        if self.is_snapshot_due() {
            self.lobby.tell_news();
            self.send_snapshot();
        }
    }

    fn handle(&mut self, command: Command) {
        match command {
            Command::Join { name, role, direct, reply } => {
                if self.lobby.len() >= self.config.most_connections {
                    // The connection may have ended while it waited.
                    let _ = reply.send(Err("the server is full; try again later".to_owned()));
                    return;
                }
                let client = self.next_client;
                self.next_client = self.next_client.wrapping_add(1);
                if reply.send(Ok(client)).is_err() {
                    return;
                }
                self.account.clients += 1;
                self.lobby.add(client, name, direct);
                if role == Role::Play {
                    let deeds = self.lobby.play(client, self.view());
                    self.perform(&deeds);
                }
            }
            Command::Message { client, message } => self.hear(client, message),
            Command::Expel { client, reason } => self.expel(client, reason),
            Command::Left { client } => {
                let deeds = self.lobby.remove(client, self.view());
                self.perform(&deeds);
            }
        }
    }

    /// A client said something.
    fn hear(&mut self, client: u32, message: ClientMessage) {
        let Some(state) = self.lobby.state(client) else { return };
        if !is_legal(state, &message) {
            self.expel(client, format!("{message:?} is not for a client that is {state:?}"));
            return;
        }
        match message {
            ClientMessage::Act { tick, action } => {
                if let SessionState::Seated(seat) = state {
                    self.act(seat, tick, action);
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
            ClientMessage::Ping { nonce } => {
                self.lobby.tell(client, &ServerMessage::Pong { nonce, tick: self.game.tick() });
            }
        }
    }

    fn expel(&mut self, client: u32, reason: String) {
        tracing::warn!(client, "expelled: {reason}");
        self.account.illegal += 1;
        self.lobby.tell(client, &ServerMessage::Bye { reason });
        // With its sender of direct frames gone, its connection ends once the goodbye is written.
        let deeds = self.lobby.remove(client, self.view());
        self.perform(&deeds);
    }

    /// A player's control: at the tick it is stamped with if that is near enough ahead, else as soon as possible. Two
    /// controls of one part that come late together keep their distance, up to a tap's: else a late tap would be none.
    /// Between two nudges is always a slap's time, and those that would wait for too long are dropped: else a flood of
    /// them, all in one tick, would hurl the table.
    fn act(&mut self, seat: u8, asked: u64, action: Action) {
        let now = self.game.tick();
        let latest = now + (MOST_LEAD / self.game.table().scene.tick_seconds) as u64;
        let of_seat = self.pending.iter().filter(|input| input.seat == seat).count();
        if of_seat >= MOST_PENDING {
            return;
        }
        let part = match action {
            Action::Flipper { right, .. } => usize::from(right),
            Action::Nudge(_) => PARTS - 1,
            _ => PARTS - 2,
        };
        let last = &mut self.stamps[usize::from(seat)][part];
        let is_nudge = matches!(action, Action::Nudge(_));
        let distance = match asked.saturating_sub(last.asked) {
            _ if is_nudge => (NUDGE_SECONDS / self.game.table().scene.tick_seconds) as u64,
            apart => apart.min(TAP_TICKS),
        };
        let tick = asked.clamp(now, latest).max(last.acts + distance);
        if is_nudge && tick > latest {
            return;
        }
        let tick = tick.min(latest);
        *last = Stamp { asked, acts: tick };
        self.account.controls += 1;
        self.pending.push(Input { tick, seat, action });
    }

    /// What the lobby decided, as inputs of the coming tick.
    fn perform(&mut self, deeds: &[Deed]) {
        let tick = self.game.tick();
        for &(seat, action) in deeds {
            // Whoever leaves takes waiting controls along.
            if action == Action::Stand {
                self.pending.retain(|input| input.seat != seat || !input.action.is_control());
            }
            self.pending.push(Input { tick, seat, action });
        }
    }

    fn view(&self) -> GameView {
        let is_playing = matches!(self.game.phase(), Phase::Play { .. });
        GameView { is_at_start: self.game.is_at_start(), is_playing }
    }

    /// 1. Seats the next in line where the game lets them in; after a while without a game, the bot plays.
    fn fill_seats(&mut self) {
        let deeds = self.lobby.fill_seats(self.view());
        self.perform(&deeds);
        if matches!(self.game.phase(), Phase::Play { .. }) {
            self.idle_ticks = 0;
            return;
        }
        self.idle_ticks += 1;
        let patience = (BOT_PATIENCE / self.game.table().scene.tick_seconds) as u64;
        if !self.config.attract || self.lobby.has_people() || self.idle_ticks < patience {
            return;
        }
        let deeds = if self.lobby.has_bot() { vec![(0, Action::Start)] } else { self.lobby.seat_bot() };
        if !deeds.is_empty() {
            self.bot = Bot::new(0, self.config.seed.wrapping_add(self.account.games));
            self.idle_ticks = 0;
        }
        self.perform(&deeds);
    }

    /// 4. Counts, logs and keeps what happened in the tick.
    fn note_events(&mut self) {
        self.count_strokes();
        for place in 0..self.game.events().len() {
            let event = self.game.events()[place];
            self.note_event(event.kind);
            if self.events.len() < MOST_EVENTS {
                self.events.push(event);
            }
        }
    }

    /// A stroke is one when the flipper comes near the upper stop, and over when it is half-way down again.
    fn count_strokes(&mut self) {
        let flippers = self.game.world().state().flippers.iter().zip(&self.game.table().scene.flippers);
        for (place, (flipper, spec)) in flippers.enumerate() {
            let bit = 1_u64 << (place % 64);
            if flipper.swing >= 0.95 * spec.stroke && self.raised & bit == 0 {
                self.raised |= bit;
                self.account.strokes[usize::from(spec.right)] += 1;
            } else if flipper.swing < 0.5 * spec.stroke {
                self.raised &= !bit;
            }
        }
    }

    fn note_event(&mut self, kind: GameEventKind) {
        let points = |seat: u8| self.game.seats()[usize::from(seat)].score.points;
        match kind {
            GameEventKind::Started => self.account.games += 1,
            GameEventKind::Served { .. } => self.account.balls += 1,
            GameEventKind::Rescued { by: Rescue::Kickers } => {
                tracing::warn!("tick {}: a ball is stuck, and all kickers are fired", self.game.tick());
            }
            GameEventKind::Rescued { by: Rescue::Relaunch } => {
                self.account.rescued += 1;
                tracing::warn!("tick {}: a ball was stuck and is served again", self.game.tick());
            }
            GameEventKind::Tilted { seat } => tracing::info!("{} tilts the game", self.lobby.name_of(seat)),
            GameEventKind::Lost { seat } => {
                tracing::info!("{} lost a ball at {} points", self.lobby.name_of(seat), points(seat));
            }
            // A game that ends because another one begins in the same tick was nobody's: the bot made room.
            GameEventKind::Over if matches!(self.game.phase(), Phase::Over) => {
                for seat in (0..SEATS as u8).filter(|&seat| self.game.seats()[usize::from(seat)].playing) {
                    tracing::info!("game over: {} has {} points", self.lobby.name_of(seat), points(seat));
                }
            }
            _ => {}
        }
    }

    fn is_snapshot_due(&self) -> bool {
        let per_second = 1.0 / self.game.table().scene.tick_seconds;
        let number = |tick: u64| (tick as f64 * f64::from(SNAPSHOT_HZ) / per_second) as u64;
        let tick = self.game.tick();
        number(tick) != number(tick - 1)
    }

    fn send_snapshot(&mut self) {
        let snapshot = Snapshot { state: self.game.state(), events: std::mem::take(&mut self.events) };
        let frame = frame_of(&ServerMessage::Snapshot(Box::new(snapshot)));
        self.account.snapshots += 1;
        self.account.snapshot_bytes += frame.len() as u64;
        self.account.largest_snapshot = self.account.largest_snapshot.max(frame.len());
        // Nobody may be listening; the game goes on.
        let _ = self.frames.send(frame);
    }
}
