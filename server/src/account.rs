//! What a server did while it ran, in numbers.

use std::fmt;

use shared::game::{Game, SEATS};

use crate::lateness::Lateness;

/// What a server did while it ran.
#[derive(Debug, Clone, Default, PartialEq, Eq)]
pub struct Account {
    /// Ticks stepped.
    pub ticks: u64,
    /// Ticks given up because the machine stalled for too long.
    pub ticks_skipped: u64,
    /// How late the batches of ticks were.
    pub lateness: Lateness,
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
    /// Turns that were lost because nobody worked the controls.
    pub forfeited: u64,
    /// Frames made, full snapshots apart. However many follow a stream, a frame of it is made once.
    pub frames: u64,
    /// Bytes of all of them.
    pub frame_bytes: u64,
    /// Full snapshots made, but for those that open a stream.
    pub fulls: u64,
    /// Bytes of the largest of them.
    pub largest_full: usize,
    /// Times that a client said that its copy differs.
    pub differing: u64,
    /// Times that a client said that it missed something.
    pub gaps: u64,
    /// Sessions ended for something illegal.
    pub illegal: u64,
    /// Flippers in the upper part of a stroke that was counted, one bit each, for each board.
    raised: [u64; SEATS],
}

impl Account {
    /// A stroke is one when the flipper comes near the upper stop, and over when it is half-way down again.
    pub(crate) fn count_strokes(&mut self, games: &[Game]) {
        for (game, raised) in games.iter().zip(&mut self.raised) {
            let flippers = game.world().state().flippers.iter().zip(&game.table().scene.flippers);
            for (place, (flipper, spec)) in flippers.enumerate() {
                let bit = 1_u64 << (place % 64);
                if flipper.swing >= 0.95 * spec.stroke && *raised & bit == 0 {
                    *raised |= bit;
                    self.strokes[usize::from(spec.right)] += 1;
                } else if flipper.swing < 0.5 * spec.stroke {
                    *raised &= !bit;
                }
            }
        }
    }

    /// A frame was made.
    pub(crate) fn sent(&mut self, frame: &[u8], is_full: bool) {
        if is_full {
            self.fulls += 1;
            self.largest_full = self.largest_full.max(frame.len());
        } else {
            self.frames += 1;
            self.frame_bytes += frame.len() as u64;
        }
    }
}

impl fmt::Display for Account {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        let mean = self.frame_bytes.checked_div(self.frames).unwrap_or(0);
        write!(
            f,
            "account: ticks {} skipped {} lateness-us {} clients {} controls {} left-strokes {} right-strokes {} games {} \
             balls {} rescued {} forfeited {} frames {} mean-bytes {mean} fulls {} largest-bytes {} differing {} gaps {} illegal {}",
            self.ticks,
            self.ticks_skipped,
            self.lateness,
            self.clients,
            self.controls,
            self.strokes[0],
            self.strokes[1],
            self.games,
            self.balls,
            self.rescued,
            self.forfeited,
            self.frames,
            self.fulls,
            self.largest_full,
            self.differing,
            self.gaps,
            self.illegal,
        )
    }
}
