//! What a run of the client was like, in numbers.

use std::fmt;

use crate::session::Counts;

/// Share by which each frame moves the shown frame rate: about the last half second counts.
const WEIGHT: f64 = 0.03;

/// What a run of the client was like.
#[derive(Debug, Clone, Default)]
pub(crate) struct Report {
    frames: u64,
    /// When the first and the last frame were drawn.
    span: Option<(f64, f64)>,
    /// Seconds a frame, lately.
    lately: f64,
    /// The longest frame, seconds.
    longest: f64,
    received: u64,
    right: u64,
    wrong: u64,
    mismatches: u64,
    /// Seconds that pictures of a spectator were behind: their sum, how many, the most.
    behind: (f64, u64, f64),
}

impl Report {
    /// A frame was drawn at `now`.
    pub(crate) fn drawn(&mut self, now: f64) {
        self.frames += 1;
        let (first, last) = self.span.unwrap_or((now, now));
        let seconds = now - last;
        self.lately += (seconds - self.lately) * WEIGHT;
        self.longest = self.longest.max(seconds);
        self.span = Some((first, now));
    }

    /// A session has ended.
    pub(crate) fn add(&mut self, counts: &Counts) {
        self.received += counts.frames;
        self.right += counts.right;
        self.wrong += counts.wrong;
        self.mismatches += counts.mismatches;
        let (sum, count, most) = self.behind;
        self.behind = (sum + counts.behind.sum, count + counts.behind.count, most.max(counts.behind.most));
    }

    /// Frames a second, lately.
    pub(crate) fn fps(&self) -> f64 {
        if self.lately > 0.0 { 1.0 / self.lately } else { 0.0 }
    }
}

impl fmt::Display for Report {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        let (first, last) = self.span.unwrap_or_default();
        let seconds = last - first;
        let fps = if seconds > 0.0 { (self.frames - 1) as f64 / seconds } else { 0.0 };
        let Self { frames, longest, received, right, wrong, mismatches, .. } = self;
        let longest = longest * 1000.0;
        let (sum, count, most) = self.behind;
        let (behind, most) = (if count > 0 { sum / count as f64 } else { 0.0 } * 1000.0, most * 1000.0);
        write!(
            f,
            "stats: frames {frames} seconds {seconds:.1} mean-fps {fps:.1} longest-frame-ms {longest:.1} \
             received {received} predictions-right {right} mispredictions {wrong} behind-live-ms {behind:.0} \
             most-behind-ms {most:.0} mismatches {mismatches}"
        )
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::session::counts::Behind;

    #[test]
    fn counts_frames() {
        let mut report = Report::default();
        for k in 0..601 {
            report.drawn(5.0 + f64::from(k) / 60.0);
        }
        let behind = Behind { now: None, sum: 0.4, count: 2, most: 0.3 };
        let counts = Counts { frames: 3, right: 2, wrong: 1, mismatches: 1, lead: 0.0, behind };
        report.add(&counts);
        report.add(&Counts { behind: Behind { most: 0.25, ..behind }, ..counts });
        assert!((59.0..61.0).contains(&report.fps()));
        let text = report.to_string();
        assert!(
            text.starts_with("stats: frames 601 seconds 10.0 mean-fps 60.0 longest-frame-ms 16.7 received 6 "),
            "{text}"
        );
        assert!(text.ends_with("mispredictions 2 behind-live-ms 200 most-behind-ms 300 mismatches 2"), "{text}");
        assert!(Report::default().to_string().contains("mean-fps 0.0"));
    }
}
