//! What is counted, and the line of JSON that tells it.

use serde::Serialize;

use crate::clock::{Clock, Spread};
use crate::process::Usage;

/// Counted from the common start on, on the connections of spectators except where it says otherwise.
#[derive(Debug, Clone, Default)]
pub(crate) struct Counts {
    /// The common start is past.
    pub(crate) is_counting: bool,
    /// All frames.
    pub(crate) frames: u64,
    /// Bytes of all frames with their lengths, without full snapshots.
    pub(crate) bytes: u64,
    /// Frames of streams, without full snapshots.
    pub(crate) snapshots: u64,
    /// Full snapshots.
    pub(crate) fulls: u64,
    /// Bytes of full snapshots, with their lengths.
    pub(crate) full_bytes: u64,
    /// Full snapshots that lead further than what came before: the server left frames out.
    pub(crate) jumps: u64,
    /// Frames that do not go on from the one before.
    pub(crate) missed: u64,
    /// Copies that came to other bits than the server.
    pub(crate) digest_mismatches: u64,
    /// Connections opened and dropped.
    pub(crate) churned: u64,
    /// Malformed frames.
    pub(crate) malformed_sent: u64,
    /// Connections on which a malformed frame was sent, and which the server did not end within seconds.
    pub(crate) malformed_not_ended: u64,
    /// Connections that stalled and that the server ended. They are opened again.
    pub(crate) stalled_ended: u64,
    /// Messages that were valid and costly.
    pub(crate) flooded: u64,
    /// Hostile connections that could not be opened.
    pub(crate) not_opened: u64,
    /// Connections, of all kinds, that were refused.
    pub(crate) refused: u64,
    /// Connections that came to stay and were refused or ended.
    pub(crate) lost: u64,
}

impl Counts {
    /// Counts anew; what was refused and lost while joining stays.
    pub(crate) fn begin(&mut self) {
        *self = Self { is_counting: true, refused: self.refused, lost: self.lost, ..Self::default() };
    }
}

/// The line.
#[derive(Debug, Serialize)]
pub(crate) struct Report {
    spectators: u32,
    bots: u32,
    stalled: u32,
    /// In which it was counted.
    seconds: f64,
    /// In which all joined.
    join_seconds: f64,
    frames: u64,
    snapshots: u64,
    fulls: u64,
    jumps: u64,
    missed: u64,
    digest_mismatches: u64,
    bytes_per_spectator_second: f64,
    full_bytes: f64,
    latency_ms: Spread,
    behind_ms: Spread,
    ping_ms: Spread,
    lost: u64,
    refused: u64,
    churned: u64,
    malformed_sent: u64,
    malformed_not_ended: u64,
    stalled_ended: u64,
    flooded: u64,
    not_opened: u64,
    /// Of one core, what this process took: near 1 it is the load that is late.
    load_cpu: f64,
    process: Option<ProcessReport>,
}

/// What the process that was asked about took meanwhile.
#[derive(Debug, Serialize)]
struct ProcessReport {
    cpu_seconds: f64,
    /// For which its threads waited for a core: beside others, the machine is what was measured.
    waited_seconds: f64,
    /// Microseconds of processor for each frame that came to a spectator.
    cpu_us_per_frame: f64,
    memory_kib_at_start: u64,
    memory_kib_at_end: u64,
}

/// A measurement of both processes.
#[derive(Debug, Clone, Copy)]
pub(crate) struct Usages {
    /// This one.
    pub(crate) own: Option<Usage>,
    /// The one that was asked about.
    pub(crate) other: Option<Usage>,
}

impl Usages {
    /// Now.
    pub(crate) fn now(process: Option<u32>) -> Self {
        Self { own: Usage::of(None), other: process.and_then(|process| Usage::of(Some(process))) }
    }
}

/// Who there was, and for how long.
#[derive(Debug, Clone, Copy)]
pub(crate) struct Course {
    pub(crate) spectators: u32,
    pub(crate) bots: u32,
    pub(crate) stalled: u32,
    pub(crate) seconds: f64,
    pub(crate) join_seconds: f64,
}

impl Report {
    pub(crate) fn new(course: Course, counts: &Counts, clock: &Clock, (start, end): (Usages, Usages)) -> Self {
        let Course { spectators, bots, stalled, seconds, join_seconds } = course;
        let (latency_ms, behind_ms) = clock.spreads();
        let load_cpu = start.own.zip(end.own).map_or(0.0, |(start, end)| end.cpu_seconds - start.cpu_seconds);
        let process = start.other.zip(end.other).map(|(start, end)| {
            let cpu_seconds = end.cpu_seconds - start.cpu_seconds;
            ProcessReport {
                cpu_seconds: rounded(cpu_seconds),
                waited_seconds: rounded(end.waited_seconds - start.waited_seconds),
                cpu_us_per_frame: rounded(ratio(cpu_seconds * 1e6, counts.frames as f64)),
                memory_kib_at_start: start.memory_kib,
                memory_kib_at_end: end.memory_kib,
            }
        });
        Self {
            spectators,
            bots,
            stalled,
            seconds: rounded(seconds),
            join_seconds: rounded(join_seconds),
            frames: counts.frames,
            snapshots: counts.snapshots,
            fulls: counts.fulls,
            jumps: counts.jumps,
            missed: counts.missed,
            digest_mismatches: counts.digest_mismatches,
            bytes_per_spectator_second: rounded(ratio(counts.bytes as f64, f64::from(spectators) * seconds)),
            full_bytes: rounded(ratio(counts.full_bytes as f64, counts.fulls as f64)),
            latency_ms,
            behind_ms,
            ping_ms: clock.trips(),
            lost: counts.lost,
            refused: counts.refused,
            churned: counts.churned,
            malformed_sent: counts.malformed_sent,
            malformed_not_ended: counts.malformed_not_ended,
            stalled_ended: counts.stalled_ended,
            flooded: counts.flooded,
            not_opened: counts.not_opened,
            load_cpu: rounded(ratio(load_cpu, seconds)),
            process,
        }
    }
}

fn ratio(a: f64, b: f64) -> f64 {
    if b > 0.0 { a / b } else { 0.0 }
}

/// To thousandths: more digits would tell nothing.
fn rounded(number: f64) -> f64 {
    (number * 1000.0).round() / 1000.0
}
