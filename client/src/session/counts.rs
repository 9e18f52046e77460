//! What a session counts.

/// What was counted, for the end.
#[derive(Debug, Clone, Copy, Default)]
pub(crate) struct Counts {
    /// Frames of the stream that were received.
    pub(crate) frames: u64,
    /// Predictions that were right.
    pub(crate) right: u64,
    /// Predictions that were wrong.
    pub(crate) wrong: u64,
    /// Times that a copy was not what the server has.
    pub(crate) mismatches: u64,
    /// The last lead, ticks.
    pub(crate) lead: f64,
    /// How far behind the server the picture of a spectator was.
    pub(crate) behind: Behind,
}

/// How far behind the server a picture was, seconds.
#[derive(Debug, Clone, Copy, Default)]
pub(crate) struct Behind {
    /// Just now; `None` while a prediction is seen, or nobody knows.
    pub(crate) now: Option<f64>,
    /// Of all pictures.
    pub(crate) sum: f64,
    /// Pictures.
    pub(crate) count: u64,
    /// At the most.
    pub(crate) most: f64,
}

impl Behind {
    pub(super) fn note(&mut self, seconds: Option<f64>) {
        self.now = seconds;
        if let Some(seconds) = seconds {
            self.sum += seconds;
            self.count += 1;
            self.most = self.most.max(seconds);
        }
    }
}
