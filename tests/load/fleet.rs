//! All connections, in one thread: whatever the system says is ready is served, and between that what is due is done.
//!
//! Frames count from a common start, after all have joined. Misbehaviour begins there too, but for the connections that
//! stall, which are opened with the others.

mod talk;

use std::cmp::Reverse;
use std::collections::BinaryHeap;
use std::io::ErrorKind;
use std::net::SocketAddr;
use std::time::{Duration, Instant};

use mio::event::Event;
use mio::{Events, Interest, Poll, Token};
use shared::math::Rng;

use crate::arguments::Arguments;
use crate::clock::Clock;
use crate::connection::{Connection, End, Kind, Shared, Stage};
use crate::hostile::{Pace, malformed};
use crate::report::{Counts, Course, Report, Usages};

/// Connections that may be on their way in at once: servers have a queue of those that they have not accepted.
const MOST_JOINING: usize = 200;
/// Without anybody coming further in for so long, those who have not joined never will.
const JOIN_PATIENCE: u64 = 30_000_000;
/// What comes with joining is over after so long.
const SETTLE: u64 = 1_000_000;
/// The system is asked at least so often.
const WAIT: Duration = Duration::from_millis(2);
/// How long a connection lives that is to be dropped, at the most, and one on which a malformed frame was sent, if the server does not
/// end it. Microseconds.
const CHURN_LIFE: u64 = 400_000;
const MALFORMED_LIFE: u64 = 3_000_000;
/// Bytes read at once.
const BUFFER: usize = 64 * 1024;

/// All connections and what is known of them.
pub(crate) struct Fleet {
    address: SocketAddr,
    arguments: Arguments,
    poll: Poll,
    events: Events,
    buffer: Vec<u8>,
    begin: Instant,
    connections: Vec<Option<Connection>>,
    free: Vec<usize>,
    serial: u64,
    shared: Shared,
    /// When hostile connections are to be dropped: deadline, place, serial.
    deadlines: BinaryHeap<Reverse<(u64, usize, u64)>>,
    /// Malformed frames whose connections are still open.
    malformed_open: u32,
    /// Connections that have been opened and have not begun.
    joining: usize,
    begun: u32,
    last_begun: u64,
    /// The bots and the one that asks for the time.
    quick: Vec<usize>,
    /// Those that flood.
    floods: Vec<usize>,
    ping_pace: [Pace; 3],
    pinged: usize,
    first_reason: Option<String>,
    rng: Rng,
}

impl Fleet {
    pub(crate) fn new(arguments: Arguments) -> std::io::Result<Self> {
        Ok(Self {
            address: arguments.connect,
            poll: Poll::new()?,
            events: Events::with_capacity(1024),
            buffer: vec![0; BUFFER],
            begin: Instant::now(),
            connections: Vec::new(),
            free: Vec::new(),
            serial: 0,
            shared: Shared {
                stream: arguments.stream(),
                raw: arguments.raw,
                table: None,
                counts: Counts::default(),
                clock: Clock::default(),
            },
            deadlines: BinaryHeap::new(),
            malformed_open: 0,
            joining: 0,
            begun: 0,
            last_begun: 0,
            quick: Vec::new(),
            floods: Vec::new(),
            ping_pace: talk::ping_paces(),
            pinged: 0,
            first_reason: None,
            rng: Rng::new(arguments.seed),
            arguments,
        })
    }

    /// Joins, counts, and tells.
    ///
    /// # Errors
    /// If nobody could join.
    pub(crate) fn run(&mut self) -> Result<Report, String> {
        self.join()?;
        let joined = self.now();
        while self.now() < joined + SETTLE {
            self.turn()?;
        }
        self.shared.counts.begin();
        self.shared.clock.begin();
        let start = self.now();
        let before = Usages::now(self.arguments.process);
        let mut churn = Pace::new(f64::from(self.arguments.churn), start);
        let mut malformed = Pace::new(f64::from(self.arguments.malformed), start);
        let mut flood = talk::flood_pace(self.arguments.floods, start);
        let end = start + (self.arguments.seconds * 1e6) as u64;
        while self.now() < end {
            let now = self.now();
            for _ in 0..churn.due(now) {
                let kind = Kind::Churn { greets: self.rng.bits().is_multiple_of(2) };
                let life = self.rng.bits() % CHURN_LIFE;
                self.open_hostile(kind, now + life);
            }
            for _ in 0..malformed.due(now) {
                // Not without end: a server that ends none of them has enough to do.
                if self.malformed_open < 2 * self.arguments.malformed {
                    let greets = self.rng.bits().is_multiple_of(2);
                    let bytes = self::malformed(&mut self.rng);
                    self.malformed_open += 1;
                    self.open_hostile(Kind::Malformed { greets, bytes }, now + MALFORMED_LIFE);
                }
            }
            self.flood(flood.due(now));
            self.drop_due(now);
            self.turn()?;
        }
        let seconds = (self.now() - start) as f64 / 1e6;
        let usages = (before, Usages::now(self.arguments.process));
        let Arguments { spectators, bots, stalled, .. } = self.arguments;
        let course = Course { spectators, bots, stalled, seconds, join_seconds: joined as f64 / 1e6 };
        Ok(Report::new(course, &self.shared.counts, &self.shared.clock, usages))
    }

    /// Opens all that are to stay, no faster than asked for, and waits until their streams have begun.
    fn join(&mut self) -> Result<(), String> {
        let Arguments { spectators, bots, stalled, floods, step_one_in, seed, raw, .. } = self.arguments;
        let mut kinds = Vec::new();
        kinds.extend((!raw).then_some(Kind::Probe));
        kinds.extend((0..bots).map(|n| Kind::Bot { number: n + 1, seed: seed.wrapping_add(u64::from(n)) }));
        kinds.extend((0..spectators).map(|n| Kind::Spectator { number: n + 1, steps: n % step_one_in == 0 }));
        kinds.extend((0..stalled).map(|_| Kind::Stalled));
        kinds.extend((0..floods).map(|_| Kind::Flood));
        let all = kinds.len() as u64;
        let mut pace = Pace::new(f64::from(self.arguments.joins), self.now());
        let mut kinds = kinds.into_iter().peekable();
        loop {
            let now = self.now();
            for _ in 0..pace.due(now) {
                // The first one finds out whether there is a server.
                let alone = self.begun == 0 && self.joining > 0 && !raw;
                if (self.joining < MOST_JOINING || raw) && !alone {
                    let Some(kind) = kinds.next() else { break };
                    self.joining += 1;
                    self.open(kind);
                }
            }
            self.turn()?;
            let counts = &self.shared.counts;
            if u64::from(self.begun) + counts.lost >= all && (raw || self.shared.clock.is_set() || self.begun == 0) {
                break;
            }
            if self.begun == 0 && counts.lost > 0 {
                break;
            }
            if self.now() > self.last_begun + JOIN_PATIENCE {
                let missing = all - u64::from(self.begun) - counts.lost;
                self.lose(format!("{missing} connections did not get in within {} s", JOIN_PATIENCE / 1_000_000));
                self.shared.counts.lost += missing - 1;
                break;
            }
        }
        if self.begun > 0 || all == 0 {
            return Ok(());
        }
        let reason = self.first_reason.take().unwrap_or_default();
        Err(format!(
            "cannot join {}: {reason}; a server of the same release that listens there would be right, such as \
             `starball-server --listen {} --most-connections {} --most-per-address {}`",
            self.address,
            self.address,
            all + 100,
            all + 100,
        ))
    }

    /// Waits for the system, serves what is ready, and pings where that is due.
    fn turn(&mut self) -> Result<(), String> {
        // Taken out while it is gone through, since serving one connection may open another.
        let mut events = std::mem::replace(&mut self.events, Events::with_capacity(0));
        let mut buffer = std::mem::take(&mut self.buffer);
        match self.poll.poll(&mut events, Some(WAIT)) {
            Err(error) if error.kind() != ErrorKind::Interrupted => {
                return Err(format!("cannot wait for connections: {error}"));
            }
            _ => {}
        }
        for event in &events {
            self.serve(event, &mut buffer);
        }
        (self.events, self.buffer) = (events, buffer);
        self.ping_due();
        Ok(())
    }

    fn serve(&mut self, event: &Event, buffer: &mut [u8]) {
        let place = event.token().0;
        let Some(Some(connection)) = self.connections.get_mut(place) else { return };
        let before = connection.stage;
        let begin = self.begin;
        let mut outcome = Ok(());
        if before == Stage::Opening {
            outcome = connection.greet(&mut self.shared);
        }
        if event.is_readable() && outcome.is_ok() && connection.stage != Stage::Opening {
            let now = || begin.elapsed().as_micros() as u64;
            outcome = connection.read((buffer, event.is_read_closed()), now, &mut self.shared);
        }
        if before != Stage::Begun && connection.stage == Stage::Begun && is_awaited(&connection.kind) {
            self.joining = self.joining.saturating_sub(1);
            self.begun += 1;
            self.last_begun = self.now();
        }
        if let Err(end) = outcome {
            self.end(place, end);
        }
    }

    /// A connection is over that this side did not end.
    fn end(&mut self, place: usize, end: End) {
        let Some(connection) = self.remove(place) else { return };
        self.shared.counts.refused += u64::from(matches!(end, End::Refused(_)));
        let reason = match end {
            End::Refused(reason) => format!("refused: {reason}"),
            End::Ended(reason) => reason,
        };
        match connection.kind {
            Kind::Churn { .. } | Kind::Malformed { .. } if connection.stage == Stage::Opening => {
                self.shared.counts.not_opened += 1;
            }
            Kind::Churn { .. } => self.shared.counts.churned += 1,
            Kind::Malformed { .. } => {}
            Kind::Stalled if connection.stage == Stage::Begun => {
                self.shared.counts.stalled_ended += 1;
                self.begun -= 1;
                self.joining += 1;
                self.open(Kind::Stalled);
            }
            Kind::Spectator { .. } | Kind::Bot { .. } | Kind::Probe | Kind::Stalled | Kind::Flood => {
                if connection.stage == Stage::Begun {
                    self.begun -= 1;
                } else {
                    self.joining = self.joining.saturating_sub(1);
                }
                self.lose(reason);
            }
        }
    }

    /// One that was to stay is lost.
    fn lose(&mut self, reason: String) {
        self.shared.counts.lost += 1;
        if self.first_reason.is_none() {
            eprintln!("starball-load: the first connection that was lost: {reason}");
            self.first_reason = Some(reason);
        }
    }

    /// Begins to open a connection; returns its place.
    fn open(&mut self, kind: Kind) -> Option<usize> {
        let is_quick = matches!(kind, Kind::Probe | Kind::Bot { .. });
        let floods = matches!(kind, Kind::Flood);
        let stays = is_awaited(&kind);
        self.serial += 1;
        let place = self.free.pop().unwrap_or_else(|| {
            self.connections.push(None);
            self.connections.len() - 1
        });
        let opened = Connection::open(self.address, kind, self.serial).and_then(|mut connection| {
            let interest = Interest::READABLE | Interest::WRITABLE;
            self.poll.registry().register(&mut connection.stream, Token(place), interest)?;
            Ok(connection)
        });
        match opened {
            Ok(connection) => {
                self.connections[place] = Some(connection);
                if is_quick {
                    self.quick.push(place);
                }
                if floods {
                    self.floods.push(place);
                }
                Some(place)
            }
            Err(error) => {
                self.free.push(place);
                if stays {
                    self.joining = self.joining.saturating_sub(1);
                    self.lose(format!("it could not be opened: {error}"));
                } else {
                    self.shared.counts.not_opened += 1;
                }
                None
            }
        }
    }

    fn open_hostile(&mut self, kind: Kind, deadline: u64) {
        let is_malformed = matches!(kind, Kind::Malformed { .. });
        match self.open(kind) {
            Some(place) => self.deadlines.push(Reverse((deadline, place, self.serial))),
            None if is_malformed => self.malformed_open -= 1,
            None => {}
        }
    }

    /// Drops the hostile connections whose time is over.
    fn drop_due(&mut self, now: u64) {
        while let Some(&Reverse((deadline, place, serial))) = self.deadlines.peek()
            && deadline <= now
        {
            self.deadlines.pop();
            if !matches!(self.connections.get(place), Some(Some(there)) if there.serial == serial) {
                continue;
            }
            match self.remove(place).map(|connection| (connection.kind, connection.stage)) {
                Some((Kind::Churn { .. }, _)) => self.shared.counts.churned += 1,
                Some((Kind::Malformed { .. }, Stage::Begun)) => self.shared.counts.malformed_not_ended += 1,
                _ => self.shared.counts.not_opened += 1,
            }
        }
    }

    fn remove(&mut self, place: usize) -> Option<Connection> {
        let connection = self.connections.get_mut(place)?.take()?;
        self.free.push(place);
        self.quick.retain(|&other| other != place);
        self.floods.retain(|&other| other != place);
        if matches!(connection.kind, Kind::Malformed { .. }) {
            self.malformed_open -= 1;
        }
        Some(connection)
    }

    /// Microseconds since the beginning.
    fn now(&self) -> u64 {
        self.begin.elapsed().as_micros() as u64
    }
}

/// Whether the start waits for it.
fn is_awaited(kind: &Kind) -> bool {
    kind.stays() || matches!(kind, Kind::Stalled | Kind::Flood)
}
