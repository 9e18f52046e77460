//! The receiver's end of a stream: it makes a room's games again of what was sent, in either form, and notices when that
//! is not what the server has.
//!
//! A stream of inputs tells up to which tick everything is known ([`Follower::confirmed`]); the copies are stepped as far
//! as the receiver likes ([`Follower::advance`]), and digests are compared on the way. A stream of changes puts the copies
//! where the server's games are at once.

use std::collections::VecDeque;
use std::sync::Arc;

use thiserror::Error;

use super::frame::FrameError;
use super::inputs::Inputs;
use super::snapshot::{Boards, Change, Full, digest_of_room};
use super::{BoardInput, VERSION};
use crate::game::{Game, GameEvent, Input};
use crate::physics::{PHYSICS_VERSION, StateError};
use crate::table::Table;

/// Seconds that one frame may tell: a server that stalls gives time up.
const MOST_SPAN_SECONDS: f64 = 2.0;
/// Ticks are exact as f64 up to here: 285,000 years of milliseconds.
const LAST_TICK: u64 = 1 << 53;
/// Inputs and digests that may wait to be stepped through. A receiver that falls further behind jumps.
const MOST_WAITING: usize = 8192;

/// What a frame meant for the copies.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub enum Heard {
    /// They can be stepped further, or are further.
    Further,
    /// They began anew from a full snapshot.
    Anew,
    /// It changed nothing: it was known, or the copies wait for a full snapshot.
    Nothing,
}

/// The copies are not what the server has. They wait for a full snapshot, which is to be asked for.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub struct Mismatch {
    /// Where it was noticed.
    pub tick: u64,
    /// The copies' digest, or 0 where something was missing.
    pub ours: u64,
    /// What the server says.
    pub theirs: u64,
}

/// Why a stream cannot be followed: no server of ours sends that.
#[derive(Debug, Clone, PartialEq, Eq, Error)]
pub enum FollowError {
    /// A state that does not fit the table.
    #[error("the server sent a game that does not fit its table: {0}")]
    State(#[from] StateError),
    /// A change that cannot be applied.
    #[error(transparent)]
    Frame(#[from] FrameError),
    /// Boards that are not all at one tick, or none.
    #[error("the server sent a room whose boards are not at one tick")]
    Boards,
    /// The snapshot is of another table or other versions than the welcome said.
    #[error("the server sent a snapshot of another table or release than it serves")]
    Foreign,
    /// One frame tells more time than any server would.
    #[error("the server sent a frame that tells {0} ticks at once")]
    Span(u64),
    /// A frame that ends before it begins.
    #[error("the server sent a frame that ends before it begins")]
    Backwards,
    /// No room runs that long.
    #[error("the server sent tick {0}; rooms end before {LAST_TICK}")]
    Tick(u64),
    /// An input on a board that there is none of.
    #[error("the server sent an input on board {0}, which there is none of")]
    Board(u8),
}

/// Copies of a room's games.
#[derive(Debug)]
pub struct Follower {
    table: Arc<Table>,
    games: Vec<Game>,
    boards: Boards,
    /// Everything is known up to this tick.
    confirmed: u64,
    /// Known and not yet stepped through, in order.
    inputs: VecDeque<BoardInput>,
    /// What the copies must be at ticks to come.
    digests: VecDeque<(u64, u64)>,
    /// The next full snapshot is where to begin.
    waits: bool,
    /// Of one step: kept for its memory.
    due: Vec<Input>,
}

impl Follower {
    /// One that waits for the first full snapshot of games on `table`.
    pub fn new(table: Arc<Table>) -> Self {
        Self {
            table,
            games: Vec::new(),
            boards: Boards::default(),
            confirmed: 0,
            inputs: VecDeque::new(),
            digests: VecDeque::new(),
            waits: true,
            due: Vec::new(),
        }
    }

    /// The copies, one a board, all at one tick. Empty before the first full snapshot.
    pub fn games(&self) -> &[Game] {
        &self.games
    }

    /// The tick that the copies are at.
    pub fn tick(&self) -> u64 {
        self.games.first().map_or(0, Game::tick)
    }

    /// The tick up to which they can be stepped.
    pub fn confirmed(&self) -> u64 {
        self.confirmed
    }

    /// Whether the next full snapshot is where the copies go on: nothing came yet, or something was wrong.
    pub fn waits(&self) -> bool {
        self.waits
    }

    /// From here on another stream comes: its first full snapshot is where the copies go on.
    pub fn expect_full(&mut self) {
        self.waits = true;
    }

    /// Takes in a full snapshot. One that comes in the middle of a stream without a gap is a check.
    ///
    /// # Errors
    /// If it does not fit the table.
    pub fn hear_full(&mut self, full: &Full) -> Result<Heard, FollowError> {
        let tick = full.tick().ok_or(FollowError::Boards)?;
        check_tick(tick)?;
        let says = (full.protocol, full.physics, full.table_digest);
        if says != (VERSION, PHYSICS_VERSION, self.table.digest) {
            return Err(FollowError::Foreign);
        }
        let is_known = !self.waits && full.boards.len() == self.games.len() && tick <= self.confirmed;
        let mut games = Vec::with_capacity(full.boards.len());
        for state in &full.boards {
            let mut game = Game::new(Arc::clone(&self.table));
            game.restore(state.clone())?;
            games.push(game);
        }
        self.boards = Boards::new(&full.boards);
        if is_known {
            // Of an earlier tick it is the start of another stream, whose frames soon tell more than is known.
            if tick == self.confirmed {
                self.expect(tick, digest_of_room(&games));
            }
            return Ok(Heard::Nothing);
        }
        self.games = games;
        self.confirmed = tick;
        self.waits = false;
        self.inputs.clear();
        self.digests.clear();
        Ok(Heard::Anew)
    }

    /// Takes in what changed. A gap before it makes the copies wait for a full snapshot.
    ///
    /// # Errors
    /// If it is no change of the state before.
    pub fn hear_change(&mut self, change: &Change) -> Result<Result<Heard, Mismatch>, FollowError> {
        if self.waits {
            return Ok(Ok(Heard::Nothing));
        }
        if change.from != self.boards.tick() {
            return Ok(Err(self.gap()));
        }
        check_tick(change.to)?;
        let states = self.boards.apply(change)?;
        if change.to <= self.confirmed {
            return Ok(Ok(Heard::Nothing));
        }
        for (game, state) in self.games.iter_mut().zip(states) {
            game.restore(state)?;
        }
        self.confirmed = change.to;
        // Of a stream of inputs that came before.
        self.inputs.clear();
        self.digests.clear();
        Ok(Ok(Heard::Further))
    }

    /// Takes in what was pressed. A gap before it makes the copies wait for a full snapshot.
    ///
    /// # Errors
    /// If no server would send it.
    pub fn hear_inputs(&mut self, inputs: &Inputs) -> Result<Result<Heard, Mismatch>, FollowError> {
        let span = inputs.to.checked_sub(inputs.from).ok_or(FollowError::Backwards)?;
        check_tick(inputs.to)?;
        if span as f64 * self.table.scene.tick_seconds > MOST_SPAN_SECONDS {
            return Err(FollowError::Span(span));
        }
        if self.waits || inputs.to <= self.confirmed {
            return Ok(Ok(Heard::Nothing));
        }
        if inputs.from > self.confirmed || self.inputs.len() + self.digests.len() > MOST_WAITING {
            return Ok(Err(self.gap()));
        }
        if let Some(stray) = inputs.inputs.iter().find(|input| usize::from(input.board) >= self.games.len()) {
            return Err(FollowError::Board(stray.board));
        }
        // After a change of streams the first frames may begin with what is known.
        let known = self.confirmed;
        self.inputs.extend(inputs.inputs.iter().filter(|input| input.input.tick >= known));
        if let Some(digest) = inputs.digest {
            self.expect(inputs.to, digest);
        }
        self.confirmed = inputs.to;
        Ok(Ok(Heard::Further))
    }

    /// Steps the copies to `tick`, at most to the last one that is confirmed; `show` gets what happens on each board.
    ///
    /// # Errors
    /// If they turn out not to be what the server has. They stay where that was noticed.
    pub fn advance(&mut self, tick: u64, mut show: impl FnMut(u8, &GameEvent)) -> Result<(), Mismatch> {
        if self.waits {
            return Ok(());
        }
        let tick = tick.min(self.confirmed);
        loop {
            let now = self.tick();
            while self.digests.front().is_some_and(|(expected, _)| *expected <= now) {
                if let Some((at, theirs)) = self.digests.pop_front()
                    && at == now
                {
                    let ours = digest_of_room(&self.games);
                    if ours != theirs {
                        self.waits = true;
                        return Err(Mismatch { tick: now, ours, theirs });
                    }
                }
            }
            if now >= tick {
                return Ok(());
            }
            let due = self.inputs.iter().take_while(|input| input.input.tick <= now).count();
            for (board, game) in (0_u8..).zip(&mut self.games) {
                self.due.clear();
                self.due.extend(self.inputs.iter().take(due).filter(|i| i.board == board).map(|i| i.input));
                for event in game.step(&self.due) {
                    show(board, event);
                }
            }
            self.inputs.drain(..due);
        }
    }

    /// What the copies must be at a tick that they can be stepped to, or are at.
    fn expect(&mut self, tick: u64, digest: u64) {
        self.digests.push_back((tick, digest));
    }

    fn gap(&mut self) -> Mismatch {
        self.waits = true;
        Mismatch { tick: self.confirmed, ours: 0, theirs: 0 }
    }
}

fn check_tick(tick: u64) -> Result<(), FollowError> {
    if tick < LAST_TICK { Ok(()) } else { Err(FollowError::Tick(tick)) }
}

#[cfg(test)]
mod tests {
    use super::super::{Form, Stream};
    use super::*;
    use crate::game::{Action, Bot, Phase};

    fn classic() -> Arc<Table> {
        Arc::new(Table::shipped("classic").unwrap().unwrap())
    }

    /// A server's room with two boards, each played by a bot, that sends frames to a follower.
    struct Room {
        games: Vec<Game>,
        bots: [Bot; 2],
        boards: Boards,
        since: Vec<BoardInput>,
        from: u64,
    }

    impl Room {
        fn new() -> Self {
            let games = vec![Game::new(classic()), Game::new(classic())];
            Self { games, bots: [Bot::new(0, 1), Bot::new(0, 2)], boards: Boards::default(), since: vec![], from: 0 }
        }

        fn step(&mut self) {
            for (board, (game, bot)) in (0..).zip(self.games.iter_mut().zip(&mut self.bots)) {
                let tick = game.tick();
                let mut inputs = Vec::new();
                if !matches!(game.phase(), Phase::Play { .. }) {
                    inputs.extend([Action::Sit, Action::Start].map(|action| Input { tick, seat: 0, action }));
                }
                bot.play(game, |action| inputs.push(Input { tick, seat: 0, action }));
                game.step(&inputs);
                self.since.extend(inputs.into_iter().map(|input| BoardInput { board, input }));
            }
        }

        fn full(&mut self) -> Full {
            let full = Full::of("test", &self.games);
            self.boards = Boards::new(&full.boards);
            self.begin();
            full
        }

        fn begin(&mut self) {
            self.from = self.games[0].tick();
            self.since.clear();
        }

        fn change(&mut self) -> Change {
            let states: Vec<_> = self.games.iter().map(Game::state).collect();
            self.boards.change_to(&states, Vec::new())
        }

        fn inputs(&mut self, with_digest: bool) -> Inputs {
            let (from, to) = (self.from, self.games[0].tick());
            let digest = with_digest.then(|| digest_of_room(&self.games));
            let inputs = Inputs { from, to, digest, inputs: std::mem::take(&mut self.since) };
            self.begin();
            inputs
        }

        fn run_to_frame(&mut self, stream: Stream) {
            self.step();
            while !stream.is_due(self.games[0].tick(), 0.001) {
                self.step();
            }
        }
    }

    #[test]
    fn changes_lead_to_the_same_bits() {
        let (mut room, mut follower) = (Room::new(), Follower::new(classic()));
        assert_eq!(follower.hear_full(&room.full()), Ok(Heard::Anew));
        let mut bytes = 0;
        for _ in 0..600 {
            room.run_to_frame(Stream { form: Form::State, hz: 60 });
            let change = room.change();
            bytes += super::super::encode(&change).len();
            assert_eq!(follower.hear_change(&change), Ok(Ok(Heard::Further)));
            assert_eq!(digest_of_room(follower.games()), digest_of_room(&room.games));
        }
        println!("{} bytes a change of two boards", bytes / 600);
    }

    #[test]
    fn inputs_lead_to_the_same_bits_however_they_are_stepped() {
        let (mut room, mut follower) = (Room::new(), Follower::new(classic()));
        assert_eq!(follower.hear_full(&room.full()), Ok(Heard::Anew));
        let mut events = 0;
        for frame in 0..200 {
            room.run_to_frame(Stream::SPECTATOR);
            assert_eq!(follower.hear_inputs(&room.inputs(frame % 2 == 0)), Ok(Ok(Heard::Further)));
            if frame % 100 == 50 {
                assert_eq!(follower.hear_full(&room.full()), Ok(Heard::Nothing), "a check");
            }
            let late = follower.confirmed() - 37;
            assert_eq!(follower.advance(late, |_, _| events += 1), Ok(()));
            assert_eq!(follower.tick(), late);
        }
        assert_eq!(follower.advance(u64::MAX, |_, _| {}), Ok(()));
        assert_eq!(digest_of_room(follower.games()), digest_of_room(&room.games));
        assert!(events > 50, "{events} events");
    }

    #[test]
    fn a_difference_is_noticed_and_a_full_snapshot_mends_it() {
        let (mut room, mut follower) = (Room::new(), Follower::new(classic()));
        follower.hear_full(&room.full()).unwrap();
        room.run_to_frame(Stream::SPECTATOR);
        let mut lie = room.inputs(true);
        lie.digest = Some(1);
        assert_eq!(follower.hear_inputs(&lie), Ok(Ok(Heard::Further)));
        let theirs = digest_of_room(&room.games);
        let noticed = follower.advance(u64::MAX, |_, _| {});
        assert_eq!(noticed, Err(Mismatch { tick: lie.to, ours: theirs, theirs: 1 }));
        room.run_to_frame(Stream::SPECTATOR);
        assert_eq!(follower.hear_inputs(&room.inputs(true)), Ok(Ok(Heard::Nothing)), "it waits");
        assert_eq!(follower.hear_full(&room.full()), Ok(Heard::Anew));
        assert_eq!(digest_of_room(follower.games()), digest_of_room(&room.games));
    }

    #[test]
    fn a_gap_is_noticed_in_either_form() {
        let (mut room, mut follower) = (Room::new(), Follower::new(classic()));
        follower.hear_full(&room.full()).unwrap();
        room.run_to_frame(Stream::SPECTATOR);
        room.inputs(false);
        room.run_to_frame(Stream::SPECTATOR);
        assert!(follower.hear_inputs(&room.inputs(false)).unwrap().is_err());
        assert!(follower.waits());
        follower.hear_full(&room.full()).unwrap();
        room.run_to_frame(Stream::PLAYER);
        room.change();
        room.run_to_frame(Stream::PLAYER);
        assert!(follower.hear_change(&room.change()).unwrap().is_err());
        // One that jumped to a newer full snapshot without being told of the gap goes on from there.
        follower.hear_full(&room.full()).unwrap();
        room.run_to_frame(Stream::PLAYER);
        assert_eq!(follower.hear_full(&room.full()), Ok(Heard::Anew));
    }

    /// The first full snapshot of another stream can be older than what is known, and its first frame begin before that.
    #[test]
    fn streams_can_be_changed_without_a_gap() {
        let (mut room, mut follower) = (Room::new(), Follower::new(classic()));
        follower.hear_full(&room.full()).unwrap();
        for round in 0..40 {
            // Inputs of the slow stream are told late: the fast one is ahead of them.
            let old = room.full();
            for _ in 0..3 {
                room.run_to_frame(Stream::PLAYER);
                assert!(follower.hear_change(&room.change()).unwrap().is_ok(), "round {round}");
            }
            assert_eq!(follower.hear_full(&old), Ok(Heard::Nothing));
            room.run_to_frame(Stream::SPECTATOR);
            assert_eq!(follower.hear_inputs(&room.inputs(true)), Ok(Ok(Heard::Further)));
            room.run_to_frame(Stream::SPECTATOR);
            assert_eq!(follower.hear_inputs(&room.inputs(true)), Ok(Ok(Heard::Further)));
            assert_eq!(follower.advance(u64::MAX - 1, |_, _| {}), Ok(()));
            assert_eq!(digest_of_room(follower.games()), digest_of_room(&room.games));
            let late = room.full();
            assert_eq!(follower.hear_full(&late), Ok(Heard::Nothing));
        }
    }

    #[test]
    fn a_hostile_stream_is_an_error() {
        let (mut room, mut follower) = (Room::new(), Follower::new(classic()));
        let full = room.full();
        assert_eq!(follower.hear_full(&Full { table_digest: 1, ..full.clone() }), Err(FollowError::Foreign));
        assert_eq!(follower.hear_full(&Full { boards: Vec::new(), ..full.clone() }), Err(FollowError::Boards));
        follower.hear_full(&full).unwrap();
        let forever = Inputs { from: 0, to: 1 << 40, digest: None, inputs: Vec::new() };
        assert_eq!(follower.hear_inputs(&forever), Err(FollowError::Span(1 << 40)));
        let backwards = Inputs { from: 9, to: 8, digest: None, inputs: Vec::new() };
        assert_eq!(follower.hear_inputs(&backwards), Err(FollowError::Backwards));
        let last = Inputs { from: u64::MAX - 9, to: u64::MAX, digest: None, inputs: Vec::new() };
        assert_eq!(follower.hear_inputs(&last), Err(FollowError::Tick(u64::MAX)));
        let mut late = full.clone();
        late.boards.iter_mut().for_each(|state| state.world.tick = u64::MAX);
        assert_eq!(follower.hear_full(&late), Err(FollowError::Tick(u64::MAX)));
        let input = Input { tick: 3, seat: 0, action: Action::Sit };
        let stray = Inputs { from: 0, to: 9, digest: None, inputs: vec![BoardInput { board: 2, input }] };
        assert_eq!(follower.hear_inputs(&stray), Err(FollowError::Board(2)));
    }
}
