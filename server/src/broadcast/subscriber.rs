//! One client of the broadcast: a cursor into its stream, and what waits for it alone.

use std::collections::VecDeque;
use std::io::{ErrorKind, IoSlice};
use std::time::Duration;

use bytes::{Buf, Bytes};
use tokio::sync::oneshot;
use tokio::time::Instant;

use super::feed::Ring;
use crate::transport::Outgoing;

/// Frames for one client alone that may wait; one that lets more pile up is disconnected.
const MOST_OWN: usize = 64;
/// Frames in one write.
const AT_ONCE: usize = 64;

/// Whether a client is still there after it was served.
pub(super) enum Served {
    /// It is.
    Stays,
    /// It is not, for that reason.
    Gone(String),
}

/// A client that is written to.
pub(crate) struct Subscriber {
    pub(super) client: u32,
    /// It is served as soon as there is something.
    pub(super) is_prompt: bool,
    transport: Box<dyn Outgoing>,
    queue: Queue,
    /// Since when it takes nothing of what waits; `None` while it takes all.
    waits_since: Option<Instant>,
    ended: oneshot::Sender<String>,
}

/// What waits to be written, in this order.
struct Queue {
    /// What is left of a frame that was begun: nothing else may come before it.
    begun: Bytes,
    /// Frames for it alone.
    own: VecDeque<Bytes>,
    /// What its stream begins with, here: a full snapshot and the news.
    start: VecDeque<Bytes>,
    /// The number of the next frame of its stream.
    cursor: u64,
    /// After what waits comes nothing more, and whoever takes that only in drops loses it when its time is up.
    ends: Option<Instant>,
}

impl Subscriber {
    pub(super) fn new(client: u32, transport: Box<dyn Outgoing>, ended: oneshot::Sender<String>) -> Self {
        let (own, start) = (VecDeque::new(), VecDeque::new());
        let queue = Queue { begun: Bytes::new(), own, start, cursor: 0, ends: None };
        Self { client, is_prompt: false, transport, queue, waits_since: None, ended }
    }

    /// Something for it alone.
    pub(super) fn tell(&mut self, frame: Bytes) {
        if self.queue.ends.is_none() {
            self.queue.own.push_back(frame);
        }
    }

    /// Nothing more is said to it after what waits for it alone and the last word, which may be none; and not even that
    /// for longer than `until`.
    pub(super) fn end(&mut self, last: Bytes, until: Instant) {
        if !last.is_empty() {
            self.tell(last);
        }
        self.queue.ends.get_or_insert(until);
    }

    /// Goes on from the frame of that number once it has taken `frames`: a full snapshot and the news. Older ones that it has
    /// not taken yet are nothing to it any more.
    pub(super) fn begin<'a>(&mut self, cursor: u64, frames: impl Iterator<Item = &'a Bytes>) {
        self.queue.cursor = cursor;
        self.queue.start.clear();
        self.queue.start.extend(frames.cloned());
    }

    /// Its connection learns why it ends.
    pub(super) fn drop_for(self, reason: &str) {
        // The connection may have ended by itself.
        let _ = self.ended.send(reason.to_owned());
    }

    /// Whether frames that it has not got yet are not kept any more.
    pub(super) fn is_past(&self, ring: &Ring) -> bool {
        ring.since(self.queue.cursor).is_none()
    }

    /// Writes what waits, as far as there is room.
    pub(super) fn serve(&mut self, ring: &Ring, now: Instant, write_time: Duration) -> Served {
        if self.queue.own.len() > MOST_OWN {
            return Served::Gone("it takes too little of what it asks for".to_owned());
        }
        if self.queue.ends.is_some_and(|until| now >= until) {
            return Served::Gone("it took its goodbye too slowly".to_owned());
        }
        while !self.queue.is_empty(ring) {
            let (wanted, outcome) = if let Some(frame) = self.queue.only(ring) {
                // Nearly always.
                (frame.len(), self.transport.try_write(&[IoSlice::new(frame)]))
            } else {
                let mut waiting = [IoSlice::new(&[]); AT_ONCE];
                let count = self.queue.gather(ring, &mut waiting);
                let wanted = waiting[..count].iter().map(|slice| slice.len()).sum();
                (wanted, self.transport.try_write(&waiting[..count]))
            };
            match outcome {
                Ok(written) => {
                    self.waits_since = None;
                    self.queue.consume(ring, written);
                    if written < wanted {
                        return Served::Stays;
                    }
                }
                Err(error) if error.kind() == ErrorKind::WouldBlock => {
                    let since = *self.waits_since.get_or_insert(now);
                    return if now.saturating_duration_since(since) > write_time {
                        Served::Gone("it took nothing for too long".to_owned())
                    } else {
                        Served::Stays
                    };
                }
                Err(error) if error.kind() == ErrorKind::Interrupted => {}
                Err(error) => return Served::Gone(format!("writing failed: {error}")),
            }
        }
        self.waits_since = None;
        if self.queue.ends.is_some() { Served::Gone("its session is over".to_owned()) } else { Served::Stays }
    }
}

impl Queue {
    fn is_empty(&self, ring: &Ring) -> bool {
        let has_own = !self.begun.is_empty() || !self.own.is_empty();
        // After a goodbye nobody listens any more.
        !has_own && (self.ends.is_some() || self.start.is_empty() && self.cursor >= ring.end())
    }

    /// The next frame of the stream, if nothing else waits.
    fn only<'a>(&self, ring: &'a Ring) -> Option<&'a Bytes> {
        let waits = !self.begun.is_empty() || !self.own.is_empty() || !self.start.is_empty();
        if waits || self.ends.is_some() || self.cursor + 1 != ring.end() {
            return None;
        }
        ring.since(self.cursor)?.next()
    }

    /// What is to be written next; returns how many rows of bytes that are.
    fn gather<'a>(&'a self, ring: &'a Ring, waiting: &mut [IoSlice<'a>; AT_ONCE]) -> usize {
        let begun = std::iter::once(&self.begun).filter(|begun| !begun.is_empty());
        let shared = if self.ends.is_some() { None } else { ring.since(self.cursor) };
        let shared = self.start.iter().chain(shared.into_iter().flatten()).filter(|_| self.ends.is_none());
        let mut count = 0;
        for (slot, frame) in waiting.iter_mut().zip(begun.chain(&self.own).chain(shared)) {
            *slot = IoSlice::new(frame);
            count += 1;
        }
        count
    }

    /// Takes note that so many bytes of what waits were written.
    fn consume(&mut self, ring: &Ring, mut written: usize) {
        let begun = written.min(self.begun.len());
        self.begun.advance(begun);
        written -= begun;
        while written > 0 {
            let frame = if let Some(frame) = self.own.pop_front().or_else(|| self.start.pop_front()) {
                frame
            } else if let Some(frame) = ring.since(self.cursor).and_then(|mut frames| frames.next()) {
                self.cursor += 1;
                frame.clone()
            } else {
                // Nothing more was offered than what is there.
                return;
            };
            let taken = written.min(frame.len());
            written -= taken;
            if taken < frame.len() {
                self.begun = frame.slice(taken..);
            }
        }
    }
}
