//! Holds a frame rate: graphics drivers do not do so reliably.

use std::time::Duration;

/// Seconds by which a frame may be early without a pause: the display's own pace then sets the rate.
const CLOSE_ENOUGH: f64 = 0.0005;

/// Says how long to pause after each frame.
#[derive(Debug, Clone)]
pub(crate) struct Limiter {
    /// Seconds a frame; `None`: as many frames as there can be.
    interval: Option<f64>,
    /// When the next frame is due.
    due: f64,
}

impl Limiter {
    /// Holds `fps` frames a second; 0: no limit.
    pub(crate) fn new(fps: u32) -> Self {
        Self { interval: (fps > 0).then(|| 1.0 / f64::from(fps)), due: 0.0 }
    }

    /// How long to sleep at `now`, the end of a frame's work. A frame that came late is not made up for by shorter ones
    /// after it: that would stutter twice.
    pub(crate) fn pause(&mut self, now: f64) -> Duration {
        let Some(interval) = self.interval else { return Duration::ZERO };
        let wait = self.due - now;
        self.due = if wait < 0.0 { now + interval } else { self.due + interval };
        if wait < CLOSE_ENOUGH { Duration::ZERO } else { Duration::from_secs_f64(wait.min(interval)) }
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    /// Runs frames that take `work(k)` seconds; returns the time at the end.
    fn run(fps: u32, frames: u32, work: impl Fn(u32) -> f64) -> f64 {
        let mut limiter = Limiter::new(fps);
        let mut now = 5.0;
        for k in 0..frames {
            now += work(k);
            now += limiter.pause(now).as_secs_f64();
        }
        now - 5.0
    }

    #[test]
    fn holds_its_rate() {
        let time = run(60, 600, |_| 0.004);
        assert!((9.98..10.02).contains(&time), "{time}");
    }

    #[test]
    fn a_late_frame_is_not_made_up_for() {
        let time = run(60, 600, |k| if k == 300 { 0.5 } else { 0.004 });
        assert!((10.4..10.5).contains(&time), "{time}");
    }

    #[test]
    fn no_limit_and_no_pause_when_too_slow() {
        assert!((run(0, 100, |_| 0.01) - 1.0).abs() < 1e-6);
        assert!((run(60, 100, |_| 0.02) - 2.0).abs() < 1e-6);
    }

    #[test]
    fn a_clock_that_jumps_back_cannot_stop_the_game() {
        let mut limiter = Limiter::new(60);
        limiter.pause(1000.0);
        assert!(limiter.pause(0.0).as_secs_f64() < 0.017);
    }
}
