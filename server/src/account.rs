//! What a server did while it ran, in numbers.

use std::fmt;

/// What a server did while it ran.
#[derive(Debug, Clone, Default, PartialEq, Eq)]
pub struct Account {
    /// Ticks stepped.
    pub ticks: u64,
    /// Ticks given up because the machine stalled for too long.
    pub ticks_skipped: u64,
    /// Clients let in.
    pub clients: u64,
    /// Controls that players worked.
    pub controls: u64,
    /// Strokes of left and right flippers that came near their end.
    pub strokes: [u64; 2],
    /// Games begun.
    pub games: u64,
    /// Balls served.
    pub balls: u64,
    /// Times that a stuck or escaped ball was served again.
    pub rescued: u64,
    /// Snapshots made.
    pub snapshots: u64,
    /// Bytes of the largest of them.
    pub largest_snapshot: usize,
    /// Bytes of all of them.
    pub snapshot_bytes: u64,
    /// Sessions ended for something illegal.
    pub illegal: u64,
}

impl fmt::Display for Account {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        let mean = self.snapshot_bytes.checked_div(self.snapshots).unwrap_or(0);
        write!(
            f,
            "account: ticks {} skipped {} clients {} controls {} left-strokes {} right-strokes {} games {} balls {} \
             rescued {} snapshots {} mean-bytes {mean} largest-bytes {} illegal {}",
            self.ticks,
            self.ticks_skipped,
            self.clients,
            self.controls,
            self.strokes[0],
            self.strokes[1],
            self.games,
            self.balls,
            self.rescued,
            self.snapshots,
            self.largest_snapshot,
            self.illegal,
        )
    }
}
