//! The fan-out: one loop that writes to every client. A frame is encoded once and shared by all who follow its stream; a
//! client is a cursor into the stream's last frames.
//!
//! Players are served at once, and so are the first spectators of a stream; whoever comes later is served once an interval,
//! in one of its milliseconds, so that no burst holds up the machine. A client that lags gets all that it missed in one write; past the oldest frame that is kept it
//! jumps to the newest full snapshot; one that takes nothing for too long is disconnected.

mod feed;
mod subscriber;

use std::collections::{BTreeMap, HashMap};
use std::sync::Arc;
use std::time::Duration;

use bytes::Bytes;
use shared::protocol::Stream;
use tokio::sync::{mpsc, oneshot};
use tokio::time::{Instant, MissedTickBehavior};

use feed::{Feed, Terms};
pub(crate) use subscriber::Subscriber;

use crate::pacing::NextWake;
use crate::transport::Outgoing;

/// How long one slice of the fan-out may take at the most before others have their turn: the length of a slot.
const SLOT: Duration = Duration::from_millis(1);
/// Orders that are carried out before anything else has its turn.
const ORDERS_AT_ONCE: usize = 256;

/// What the room and the connections ask of the broadcast. Frames are as they go on the wire.
///
/// The queue of orders has no bound of its own: the room makes so many a second, connections at most one for each ping that
/// is answered, and all are carried out within a millisecond or so.
pub(crate) enum Order {
    /// A stream begins; this is its first full snapshot.
    Open { stream: Stream, full: Bytes },
    /// The next frame of a stream, and the full snapshot that it leads to.
    Frame { stream: Stream, frame: Bytes, full: Bytes },
    /// Nobody follows that stream any more.
    Close { stream: Stream },
    /// Something that everybody is to know, and who comes later too.
    News { kind: NewsKind, frame: Bytes },
    /// A client comes in: it is sent `greeting`, a full snapshot, the news, and then the stream.
    Add { client: u32, transport: Box<dyn Outgoing>, stream: Stream, greeting: Bytes, ended: oneshot::Sender<String> },
    /// It goes on with another stream, or from a full snapshot of the same one.
    Switch { client: u32, stream: Stream },
    /// It is served at once from now on, or in its turn.
    Hurry { client: u32, is_prompt: bool },
    /// Something for it alone.
    Tell { client: u32, frame: Bytes },
    /// Its session is over; what waits for it alone is still written, then the last word.
    Remove { client: u32, last: Bytes },
    /// All sessions are over.
    End { last: Bytes },
}

/// The news that are kept for who comes later: the last of each kind.
#[derive(Debug, Clone, Copy, PartialEq, Eq, PartialOrd, Ord)]
pub(crate) enum NewsKind {
    /// Who is there.
    Roster,
    /// What the crowd votes for.
    Tally,
    /// Whether the room stands still. Players' clocks stop with it, so whoever is served at once is told at once.
    Pause,
}

/// Where orders go.
pub(crate) type Orders = mpsc::UnboundedSender<Order>;

/// How patient the broadcast is.
#[derive(Debug, Clone, Copy)]
pub(crate) struct Patience {
    /// How long a client may take nothing of what waits for it.
    pub(crate) write_time: Duration,
    /// How long goodbyes may take when all sessions end.
    pub(crate) goodbye_time: Duration,
}

/// The fan-out.
pub(crate) struct Broadcast {
    patience: Patience,
    next_wake: Arc<NextWake>,
    feeds: BTreeMap<Stream, Feed>,
    /// Which stream a client follows, and in which slot.
    whereabouts: HashMap<u32, (Stream, usize)>,
    news: BTreeMap<NewsKind, Bytes>,
    /// The slots that were served so far.
    slots: u64,
    ends: bool,
}

impl Broadcast {
    /// With no stream yet; it makes way for the room when that wants to wake.
    pub(crate) fn new(patience: Patience, next_wake: Arc<NextWake>) -> Self {
        let (feeds, whereabouts, news) = (BTreeMap::new(), HashMap::new(), BTreeMap::new());
        Self { patience, next_wake, feeds, whereabouts, news, slots: 0, ends: false }
    }

    /// Runs until it is told to end, and everybody has got their goodbye or had time for it.
    pub(crate) async fn run(mut self, mut orders: mpsc::UnboundedReceiver<Order>) {
        let begin = Instant::now();
        let mut slot = tokio::time::interval(SLOT);
        slot.set_missed_tick_behavior(MissedTickBehavior::Skip);
        let mut ends_at = None;
        loop {
            tokio::select! {
                biased;
                order = orders.recv() => {
                    let Some(order) = order else { return };
                    self.carry_out(order);
                    for _ in 1..ORDERS_AT_ONCE {
                        let Ok(order) = orders.try_recv() else { break };
                        self.carry_out(order);
                    }
                    // Orders come first, but must not keep the slots waiting.
                    self.serve_due(begin.elapsed()).await;
                }
                _ = slot.tick() => self.serve_due(begin.elapsed()).await,
            }
            if self.ends {
                let ends_at = *ends_at.get_or_insert_with(|| Instant::now() + self.patience.goodbye_time);
                if self.whereabouts.is_empty() || Instant::now() >= ends_at {
                    return;
                }
            }
        }
    }

    /// Serves every slot whose millisecond has come. After each, other tasks have their turn.
    async fn serve_due(&mut self, elapsed: Duration) {
        let due = elapsed.as_millis() as u64;
        // What is more than a second late is served by whatever slot comes next.
        self.slots = self.slots.max(due.saturating_sub(1000));
        while self.slots < due {
            self.slots += 1;
            let terms = terms(&self.news, self.patience, &self.next_wake);
            for feed in self.feeds.values_mut() {
                let mut from = Some(0);
                while let Some(first) = from {
                    let round = feed.serve_slot(self.slots, first, SLOT, &terms);
                    for client in round.gone {
                        self.whereabouts.remove(&client);
                    }
                    from = round.next;
                    if from.is_some() {
                        tokio::task::yield_now().await;
                    }
                }
            }
            if self.slots < due {
                tokio::task::yield_now().await;
            }
        }
    }

    fn carry_out(&mut self, order: Order) {
        match order {
            Order::Open { stream, full } => match self.feeds.get_mut(&stream) {
                Some(feed) => feed.reopen(full),
                None => {
                    self.feeds.insert(stream, Feed::new(stream, full));
                }
            },
            Order::Frame { stream, frame, full } => {
                let terms = terms(&self.news, self.patience, &self.next_wake);
                if let Some(feed) = self.feeds.get_mut(&stream) {
                    feed.push(frame, full);
                    for client in feed.serve_prompt(&terms) {
                        self.whereabouts.remove(&client);
                    }
                }
            }
            Order::Close { stream } => {
                // Who still follows it is about to be told something else.
                if self.feeds.get(&stream).is_some_and(Feed::is_empty) {
                    self.feeds.remove(&stream);
                }
            }
            Order::News { kind, frame } => {
                // Before anybody is served: who begins anew then is told this.
                self.news.insert(kind, frame.clone());
                let terms = terms(&self.news, self.patience, &self.next_wake);
                for feed in self.feeds.values_mut() {
                    feed.push_news(frame.clone());
                    if kind == NewsKind::Pause {
                        for client in feed.serve_prompt(&terms) {
                            self.whereabouts.remove(&client);
                        }
                    }
                }
            }
            Order::Add { client, transport, stream, greeting, ended } => {
                let mut subscriber = Subscriber::new(client, transport, ended);
                subscriber.tell(greeting);
                self.settle(subscriber, stream);
            }
            Order::Switch { client, stream } => {
                if let Some(subscriber) = self.take(client) {
                    self.settle(subscriber, stream);
                }
            }
            Order::Hurry { client, is_prompt } => {
                let Some(&(stream, _)) = self.whereabouts.get(&client) else { return };
                if let Some(mut subscriber) = self.take(client) {
                    subscriber.is_prompt = is_prompt;
                    self.place(subscriber, stream);
                }
            }
            Order::Tell { client, frame } => self.at_once(client, |subscriber| subscriber.tell(frame)),
            Order::Remove { client, last } => {
                let until = Instant::now() + self.patience.write_time;
                self.at_once(client, |subscriber| subscriber.end(last, until));
            }
            Order::End { last } => {
                self.ends = true;
                let clients: Vec<u32> = self.whereabouts.keys().copied().collect();
                let until = Instant::now() + self.patience.goodbye_time;
                for client in clients {
                    self.at_once(client, |subscriber| subscriber.end(last.clone(), until));
                }
            }
        }
    }

    /// Begins a stream for a client, with a full snapshot and the news.
    fn settle(&mut self, mut subscriber: Subscriber, stream: Stream) {
        let Some(feed) = self.feeds.get(&stream) else {
            return subscriber.drop_for("its stream has ended");
        };
        feed.begin(&mut subscriber, &self.news);
        let client = subscriber.client;
        self.place(subscriber, stream);
        self.at_once(client, |_| {});
    }

    fn place(&mut self, subscriber: Subscriber, stream: Stream) {
        let client = subscriber.client;
        if let Some(feed) = self.feeds.get_mut(&stream) {
            let slot = feed.place(subscriber);
            self.whereabouts.insert(client, (stream, slot));
        }
    }

    fn take(&mut self, client: u32) -> Option<Subscriber> {
        let (stream, slot) = self.whereabouts.remove(&client)?;
        self.feeds.get_mut(&stream)?.take(slot, client)
    }

    /// Does something to a client and writes to it without waiting for its turn.
    fn at_once(&mut self, client: u32, change: impl FnOnce(&mut Subscriber)) {
        let Some(&(stream, slot)) = self.whereabouts.get(&client) else { return };
        let terms = terms(&self.news, self.patience, &self.next_wake);
        let Some(feed) = self.feeds.get_mut(&stream) else { return };
        if feed.serve_one(slot, client, &terms, change) {
            self.whereabouts.remove(&client);
        }
    }
}

fn terms<'a>(news: &'a BTreeMap<NewsKind, Bytes>, patience: Patience, next_wake: &'a NextWake) -> Terms<'a> {
    Terms { news, write_time: patience.write_time, next_wake }
}

#[cfg(test)]
mod tests;
