//! One stream's last frames, and who follows it.

use std::collections::{BTreeMap, VecDeque};
use std::time::Duration;

use bytes::Bytes;
use shared::protocol::Stream;
use tokio::time::Instant;

use super::NewsKind;
use super::subscriber::{Served, Subscriber};
use crate::pacing::NextWake;

/// Seconds for which frames are kept: who lags by more begins anew from a full snapshot.
const KEPT_SECONDS: usize = 2;
/// News that may be kept besides.
const KEPT_NEWS: usize = 16;
/// Clients that are served before the room may have the core: a tenth of a millisecond.
const IN_A_ROW: usize = 16;
/// Spectators who are served as soon as there is a frame, as players are: so few take less than half a slot.
pub(super) const AT_ONCE: usize = 48;
/// The place of those who are served at once.
const PROMPT: usize = 0;

/// What holds for everybody who is served.
pub(super) struct Terms<'a> {
    /// What whoever begins anew is told besides.
    pub(super) news: &'a BTreeMap<NewsKind, Bytes>,
    /// How long a client may take nothing of what waits for it.
    pub(super) write_time: Duration,
    pub(super) next_wake: &'a NextWake,
}

/// The last frames of a stream.
pub(super) struct Ring {
    frames: VecDeque<Bytes>,
    /// How many came before the first that is kept.
    first: u64,
    most: usize,
    /// What the newest frame leads to.
    full: Bytes,
}

impl Ring {
    /// The number of the next frame.
    pub(super) fn end(&self) -> u64 {
        self.first + self.frames.len() as u64
    }

    /// The frames from that number on; `None` if some of them are not kept any more.
    pub(super) fn since(&self, number: u64) -> Option<impl Iterator<Item = &Bytes>> {
        let skip = usize::try_from(number.checked_sub(self.first)?).ok()?;
        Some(self.frames.iter().skip(skip))
    }

    fn push(&mut self, frame: Bytes) {
        if self.frames.len() == self.most {
            self.frames.pop_front();
            self.first += 1;
        }
        self.frames.push_back(frame);
    }
}

/// A stream and who follows it.
pub(super) struct Feed {
    ring: Ring,
    /// The first for those who are served at once, then one for each millisecond of the interval.
    slots: Vec<Vec<Subscriber>>,
}

/// What came of serving a slot.
pub(super) struct Round {
    /// Who is gone.
    pub(super) gone: Vec<u32>,
    /// Where to go on: its time was up.
    pub(super) next: Option<usize>,
}

impl Feed {
    pub(super) fn new(stream: Stream, full: Bytes) -> Self {
        let hz = usize::from(stream.hz);
        let ring = Ring { frames: VecDeque::new(), first: 0, most: KEPT_SECONDS * hz + KEPT_NEWS, full };
        let interval = 1000 / hz;
        Self { ring, slots: (0..=interval).map(|_| Vec::new()).collect() }
    }

    /// The stream begins again; whoever is still here is about to leave.
    pub(super) fn reopen(&mut self, full: Bytes) {
        self.ring.first = self.ring.end();
        self.ring.frames.clear();
        self.ring.full = full;
    }

    pub(super) fn push(&mut self, frame: Bytes, full: Bytes) {
        self.ring.push(frame);
        self.ring.full = full;
    }

    pub(super) fn push_news(&mut self, frame: Bytes) {
        self.ring.push(frame);
    }

    pub(super) fn is_empty(&self) -> bool {
        self.slots.iter().all(Vec::is_empty)
    }

    /// Lets a subscriber begin anew: a full snapshot and the news come next, then what follows them.
    pub(super) fn begin(&self, subscriber: &mut Subscriber, news: &BTreeMap<NewsKind, Bytes>) {
        begin(&self.ring, subscriber, news);
    }

    /// Takes a subscriber in, and says in which slot.
    pub(super) fn place(&mut self, subscriber: Subscriber) -> usize {
        let slot = if subscriber.is_prompt || self.slots[PROMPT].len() < AT_ONCE {
            PROMPT
        } else {
            // They fill up evenly, whoever leaves.
            let emptiest = (PROMPT + 1..self.slots.len()).min_by_key(|&slot| self.slots[slot].len());
            emptiest.unwrap_or(PROMPT)
        };
        self.slots[slot].push(subscriber);
        slot
    }

    pub(super) fn take(&mut self, slot: usize, client: u32) -> Option<Subscriber> {
        let subscribers = &mut self.slots[slot];
        let place = subscribers.iter().position(|subscriber| subscriber.client == client)?;
        Some(subscribers.swap_remove(place))
    }

    /// Serves those whose turn it is, from the `first` of them on, for `time` at the most.
    pub(super) fn serve_slot(&mut self, slot: u64, first: usize, time: Duration, terms: &Terms<'_>) -> Round {
        let intervals = (self.slots.len() - 1) as u64;
        let mut round = self.serve(1 + (slot % intervals) as usize, first, Some(time), terms);
        // What those who are served at once had no room for must not wait for a frame that may never come.
        if slot.is_multiple_of(intervals) && round.next.is_none() {
            round.gone.extend(self.serve(PROMPT, 0, None, terms).gone);
        }
        round
    }

    /// Serves those who are served at once; returns who is gone.
    pub(super) fn serve_prompt(&mut self, terms: &Terms<'_>) -> Vec<u32> {
        self.serve(PROMPT, 0, None, terms).gone
    }

    fn serve(&mut self, slot: usize, first: usize, time: Option<Duration>, terms: &Terms<'_>) -> Round {
        let mut gone = Vec::new();
        if self.slots[slot].is_empty() {
            return Round { gone, next: None };
        }
        let (ring, now) = (&self.ring, Instant::now());
        let mut place = first;
        let mut served = 0;
        while let Some(subscriber) = self.slots[slot].get_mut(place) {
            if served == IN_A_ROW {
                served = 0;
                terms.next_wake.make_way();
                if time.is_some_and(|time| now.elapsed() >= time) {
                    return Round { gone, next: Some(place) };
                }
            }
            served += 1;
            match serve(ring, subscriber, now, terms) {
                Served::Stays => place += 1,
                Served::Gone(reason) => {
                    let subscriber = self.slots[slot].swap_remove(place);
                    gone.push(subscriber.client);
                    subscriber.drop_for(&reason);
                }
            }
        }
        Round { gone, next: None }
    }

    /// Changes a subscriber and serves it; `true` if it is gone.
    pub(super) fn serve_one(
        &mut self,
        slot: usize,
        client: u32,
        terms: &Terms<'_>,
        change: impl FnOnce(&mut Subscriber),
    ) -> bool {
        let subscribers = &mut self.slots[slot];
        let Some(place) = subscribers.iter().position(|subscriber| subscriber.client == client) else { return true };
        change(&mut subscribers[place]);
        match serve(&self.ring, &mut subscribers[place], Instant::now(), terms) {
            Served::Stays => false,
            Served::Gone(reason) => {
                subscribers.swap_remove(place).drop_for(&reason);
                true
            }
        }
    }
}

fn begin(ring: &Ring, subscriber: &mut Subscriber, news: &BTreeMap<NewsKind, Bytes>) {
    subscriber.begin(ring.end(), std::iter::once(&ring.full).chain(news.values()));
}

fn serve(ring: &Ring, subscriber: &mut Subscriber, now: Instant, terms: &Terms<'_>) -> Served {
    if subscriber.is_past(ring) {
        begin(ring, subscriber, terms.news);
    }
    subscriber.serve(ring, now, terms.write_time)
}
