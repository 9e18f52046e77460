//! What tick it is on the server: an estimate from when frames arrive, how far behind it a spectator can see everything in
//! time, and how far ahead of it a player must act.
//!
//! Pure functions of injected times (seconds of one local clock); no clock is read here.

use std::collections::VecDeque;

/// Seconds for which an arrival counts. The least delayed one of them tells the server's tick: jitter only ever delays.
/// Longer: the estimate follows a server that lost time later. Shorter: jitter shows.
const WINDOW: f64 = 1.0;
/// By how much of elapsed time the estimate may run fast or slow while it is corrected: too little to be seen.
const SLEW: f64 = 0.05;
/// Seconds of error beyond which the estimate jumps: it would take longer to correct than anyone would wait.
const JUMP: f64 = 0.25;
/// Round trips that count: at four pings a second, the last two seconds.
const ROUND_TRIPS: usize = 8;

/// Seconds for which a late arrival makes the picture later.
const LATE_WINDOW: f64 = 5.0;
/// Share of the arrivals that, with one more, may come later than the picture allows for: each is a moment in which it stands
/// still. Smaller: whatever keeps this machine busy for a moment makes the picture late for seconds.
const TOO_LATE: f64 = 0.04;
/// Seconds by which frames should be earlier than the picture needs them: arrivals are seen once a frame, and the server wakes
/// every 4 ms.
const SPARE: f64 = 0.005;
/// Seconds of lateness that the picture allows for at the most.
const MOST_LATE: f64 = 0.5;
/// Answers to pings that count for the server's true tick.
const ANSWERS: usize = 4;

/// A number that follows another one without a visible jerk, unless it is far off.
#[derive(Debug, Clone, Copy, Default)]
struct Slewed {
    value: Option<f64>,
    advanced: f64,
}

impl Slewed {
    /// Moves towards `target` by what the time since the last call allows.
    fn advance(&mut self, target: f64, now: f64) -> f64 {
        let elapsed = (now - self.advanced).max(0.0);
        self.advanced = now;
        let value = match self.value {
            Some(value) if (target - value).abs() <= JUMP => {
                value + (target - value).clamp(-SLEW * elapsed, SLEW * elapsed)
            }
            _ => target,
        };
        self.value = Some(value);
        value
    }
}

/// The server's tick, as far as snapshots tell: behind the true one by the way that the fastest of them took.
#[derive(Debug, Clone)]
pub(crate) struct ServerClock {
    tick_seconds: f64,
    /// (Local time, server time minus local time) of the arrivals of the last second.
    arrivals: VecDeque<(f64, f64)>,
    offset: Slewed,
}

impl ServerClock {
    /// A clock that knows nothing yet.
    pub(crate) fn new(tick_seconds: f64) -> Self {
        Self { tick_seconds, arrivals: VecDeque::new(), offset: Slewed::default() }
    }

    /// The frame that leads to `tick` arrived; returns the server's time minus the local one by that frame alone, seconds.
    pub(crate) fn arrived(&mut self, tick: u64, at: f64) -> f64 {
        let offset = tick as f64 * self.tick_seconds - at;
        self.arrivals.push_back((at, offset));
        while self.arrivals.front().is_some_and(|(then, _)| at - then > WINDOW) {
            self.arrivals.pop_front();
        }
        offset
    }

    /// The server's time minus the local one as last used, seconds.
    pub(crate) fn offset(&self) -> f64 {
        self.offset.value.unwrap_or(0.0)
    }

    /// The tick, with its fraction, that the server plays at local time `now`; `None` before the first arrival.
    /// Never falls, as long as `now` doesn't, but for jumps.
    pub(crate) fn tick_at(&mut self, now: f64) -> Option<f64> {
        let target = self.arrivals.iter().map(|(_, offset)| *offset).reduce(f64::max)?;
        let offset = self.offset.advance(target, now);
        Some(((now + offset) / self.tick_seconds).max(0.0))
    }
}

/// How far behind a [`ServerClock`] the picture of a spectator must be, so that what it shows has nearly always come: until the
/// next frame, and as late as that may be.
#[derive(Debug, Clone, Default)]
pub(crate) struct Delay {
    /// (Local time, server time minus local time) of arrivals.
    arrivals: VecDeque<(f64, f64)>,
    delay: Slewed,
}

impl Delay {
    /// A frame arrived, by which the server's time minus the local one is `offset`.
    pub(crate) fn arrived(&mut self, at: f64, offset: f64) {
        self.arrivals.push_back((at, offset));
        while self.arrivals.front().is_some_and(|(then, _)| at - then > LATE_WINDOW) {
            self.arrivals.pop_front();
        }
    }

    /// Seconds to be behind at local time `now` a clock that is `offset` ahead of the local one, where a frame comes every
    /// `interval` seconds.
    pub(crate) fn at(&mut self, now: f64, interval: f64, offset: f64) -> f64 {
        // Against the clock as it is now: that may have believed an early frame for a while.
        let mut late: Vec<f64> = self.arrivals.iter().map(|(_, by_frame)| (offset - by_frame).max(0.0)).collect();
        late.sort_unstable_by(|a, b| b.total_cmp(a));
        let late = late.get((late.len() as f64 * TOO_LATE) as usize + 1).copied().unwrap_or(0.0);
        self.delay.advance(interval + late.min(MOST_LATE) + SPARE, now)
    }
}

/// The tick that the server really plays, from its answers to pings: for telling how far behind the picture is.
#[derive(Debug, Clone)]
pub(crate) struct TrueClock {
    tick_seconds: f64,
    /// Server time minus local time by the last answers, seconds.
    offsets: VecDeque<f64>,
}

impl TrueClock {
    /// A clock that knows nothing yet.
    pub(crate) fn new(tick_seconds: f64) -> Self {
        Self { tick_seconds, offsets: VecDeque::new() }
    }

    /// An answer came at local time `at` that took `trip` seconds there and back, and said that it was `tick`.
    pub(crate) fn answered(&mut self, tick: u64, at: f64, trip: f64) {
        if self.offsets.len() == ANSWERS {
            self.offsets.pop_front();
        }
        self.offsets.push_back(tick as f64 * self.tick_seconds + trip / 2.0 - at);
    }

    /// The tick at local time `now`. A server steps its ticks in batches, so that what it says may be old by one of them, but never
    /// too new: the largest counts.
    pub(crate) fn tick_at(&self, now: f64) -> Option<f64> {
        let offset = self.offsets.iter().copied().reduce(f64::max)?;
        Some((now + offset) / self.tick_seconds)
    }
}

/// How far ahead of a [`ServerClock`] a player's inputs must be stamped, so that they reach the server before it plays
/// their tick. The clock is behind by the way from the server, and an input still has the way to it: a round trip.
#[derive(Debug, Clone, Default)]
pub(crate) struct Lead {
    /// The last round trips, seconds.
    trips: VecDeque<f64>,
    lead: Slewed,
}

impl Lead {
    /// A round trip was measured.
    pub(crate) fn measured(&mut self, seconds: f64) {
        if self.trips.len() == ROUND_TRIPS {
            self.trips.pop_front();
        }
        self.trips.push_back(seconds.max(0.0));
    }

    /// Seconds to be ahead at local time `now`: the longest of the last round trips and `margin`, at most `most`.
    pub(crate) fn at(&mut self, now: f64, margin: f64, most: f64) -> f64 {
        let trip = self.trips.iter().copied().fold(0.0, f64::max);
        self.lead.advance((trip + margin).min(most), now)
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use shared::math::Rng;

    const DT: f64 = 0.001;
    const INTERVAL: f64 = 1.0 / 60.0;

    /// Snapshots at 60 Hz with `delay(k)` seconds on the way; returns the estimates' errors in ticks behind the true tick.
    fn errors(seconds: f64, rate: f64, mut delay: impl FnMut(u32) -> f64) -> Vec<f64> {
        let mut clock = ServerClock::new(DT);
        let count = (seconds / INTERVAL) as u32;
        let mut arrivals: Vec<(f64, u64)> = (0..count)
            .map(|k| {
                let sent = f64::from(k) * INTERVAL;
                (sent + delay(k), (sent * rate / DT) as u64)
            })
            .collect();
        // TCP keeps order: what overtook would wait.
        for k in 1..arrivals.len() {
            arrivals[k].0 = arrivals[k].0.max(arrivals[k - 1].0);
        }
        let mut errors = Vec::new();
        let mut next = 0;
        let mut last = 0.0;
        for frame in 0..(seconds / INTERVAL) as u32 {
            let now = f64::from(frame) * INTERVAL + 0.005;
            while next < arrivals.len() && arrivals[next].0 <= now {
                clock.arrived(arrivals[next].1, arrivals[next].0);
                next += 1;
            }
            if let Some(tick) = clock.tick_at(now) {
                assert!(tick >= last, "the clock fell from {last} to {tick}");
                last = tick;
                errors.push(now * rate / DT - tick);
            }
        }
        errors
    }

    #[test]
    fn jitter_leaves_the_least_delay() {
        let mut rng = Rng::new(1);
        let errors = errors(10.0, 1.0, |_| 0.02 + 0.03 * rng.between(0.0, 1.0));
        for error in &errors[120..] {
            assert!((19.0..25.0).contains(error), "{error} ticks behind, 20 would be right");
        }
    }

    #[test]
    fn a_stall_on_the_way_changes_nothing() {
        // The 300th to the 320th snapshot arrive together, a third of a second late.
        let errors = errors(10.0, 1.0, |k| if (300..320).contains(&k) { 0.35 } else { 0.02 });
        for error in &errors[60..] {
            assert!((19.0..22.0).contains(error), "{error} ticks behind, 20 would be right");
        }
    }

    #[test]
    fn a_server_that_runs_slow_is_followed() {
        let errors = errors(30.0, 0.999, |_| 0.01);
        for error in &errors[120..] {
            assert!((8.0..14.0).contains(error), "{error} ticks behind, 10 would be right");
        }
    }

    #[test]
    fn lost_time_is_slewed_and_much_of_it_jumped() {
        let mut clock = ServerClock::new(DT);
        clock.arrived(1000, 1.0);
        assert_eq!(clock.tick_at(1.0), Some(1000.0));
        // The server lost 100 ms, and the last arrival from before has just fallen out of the window.
        clock.arrived(2001, 2.101);
        let tick = clock.tick_at(2.101).unwrap();
        assert!((2101.0 - 0.051 * 1101.0..2101.0).contains(&tick), "{tick}");
        // It lost a second more.
        clock.arrived(2101, 3.201);
        assert_eq!(clock.tick_at(3.201), Some(2101.0));
    }

    /// A spectator's stream at `hz` with `wait(k)` seconds from the k-th frame to its arrival: how far behind the server the picture
    /// is, the first two seconds left out, at the most, seconds; and the share of pictures for which the frame had not come.
    fn watch(hz: f64, mut wait: impl FnMut(u32) -> f64) -> (f64, f64) {
        let (mut clock, mut delay) = (ServerClock::new(DT), Delay::default());
        let interval = 1.0 / hz;
        let mut arrivals: Vec<(f64, u64)> = Vec::new();
        for k in 1..(20.0 * hz) as u32 {
            let sent = f64::from(k) * interval;
            let before = arrivals.last().map_or(0.0, |last| last.0);
            arrivals.push(((sent + wait(k)).max(before), (sent / DT).round() as u64));
        }
        let (mut next, mut confirmed) = (0, 0);
        let (mut worst, mut missed, mut pictures) = (0.0_f64, 0_u32, 0_u32);
        for frame in 0..19 * 60_u32 {
            let now = f64::from(frame) / 60.0;
            while next < arrivals.len() && arrivals[next].0 <= now {
                let (at, tick) = arrivals[next];
                delay.arrived(at, clock.arrived(tick, at));
                (confirmed, next) = (tick, next + 1);
            }
            let Some(live) = clock.tick_at(now) else { continue };
            let target = live - delay.at(now, interval, clock.offset()) / DT;
            if now > 2.0 {
                pictures += 1;
                missed += u32::from(target > confirmed as f64);
                worst = worst.max(now - target.min(confirmed as f64) * DT);
            }
        }
        (worst, f64::from(missed) / f64::from(pictures))
    }

    #[test]
    fn a_spectator_is_not_far_behind_and_frames_are_nearly_always_there() {
        let mut rng = Rng::new(4);
        // Ten a second, in the last slot of the interval, with a jitter of ten milliseconds.
        let (behind, missed) = watch(10.0, |_| 0.099 + 0.010 * rng.between(0.0, 1.0));
        assert!(behind < 0.250 && missed < 0.01, "{behind} s behind, {missed} missed");
        // Sixty a second, in slots of 16 ms: how long a frame waits for its slot goes round.
        let (behind, missed) = watch(60.0, |k| (f64::from(k) * 0.016 / 24.0) % 0.016 + 0.001 * rng.between(0.0, 1.0));
        assert!(behind < 0.050 && missed < 0.03, "{behind} s behind, {missed} missed");
        // The first frame comes with the welcome's news, before its slot.
        let (behind, missed) = watch(10.0, |k| if k == 1 { 0.0 } else { 0.099 });
        assert!(behind < 0.210 && missed < 0.01, "{behind} s behind, {missed} missed");
        // Without jitter it is an interval and what is spared.
        let (behind, missed) = watch(10.0, |_| 0.0);
        assert!(behind < 0.107 && missed == 0.0, "{behind} s behind, {missed} missed");
    }

    #[test]
    fn jitter_makes_the_picture_later_and_is_forgotten() {
        let mut delay = Delay::default();
        assert_eq!(delay.at(0.0, 0.1, 0.0), 0.1 + SPARE);
        for k in 1..=50_u32 {
            delay.arrived(f64::from(k) * 0.1, if k % 10 == 0 { -0.08 } else { -0.01 });
        }
        // As slowly as the clock may run.
        let early = delay.at(0.5, 0.1, 0.0);
        assert!((early - 0.13).abs() < 1e-9, "{early}");
        assert!((delay.at(9.0, 0.1, 0.0) - 0.18 - SPARE).abs() < 1e-9);
        for k in 51..=110_u32 {
            delay.arrived(f64::from(k) * 0.1, 0.0);
        }
        assert!((delay.at(20.0, 0.1, 0.0) - 0.1 - SPARE).abs() < 1e-9);
        // One in a hundred does not count.
        delay.arrived(11.05, -0.4);
        assert!((delay.at(30.0, 0.1, 0.0) - 0.1 - SPARE).abs() < 1e-9);
    }

    #[test]
    fn the_true_tick_is_the_latest_that_an_answer_allows() {
        let mut clock = TrueClock::new(DT);
        assert_eq!(clock.tick_at(1.0), None);
        clock.answered(996, 1.05, 0.1);
        clock.answered(2000, 2.05, 0.1);
        assert_eq!(clock.tick_at(3.0), Some(3000.0));
        // A server that lost time is believed once nobody remembers better.
        for k in 3..3 + ANSWERS as u64 {
            clock.answered(k * 1000 - 500, k as f64, 0.0);
        }
        assert_eq!(clock.tick_at(10.0), Some(9500.0));
    }

    #[test]
    fn the_lead_is_the_longest_trip_and_a_margin() {
        let mut lead = Lead::default();
        for trip in [0.04, 0.09, 0.05] {
            lead.measured(trip);
        }
        assert!((lead.at(0.0, 0.016, 0.2) - 0.106).abs() < 1e-9);
        for _ in 0..ROUND_TRIPS {
            lead.measured(0.04);
        }
        // It shrinks as slowly as the clock may run.
        assert!((lead.at(0.1, 0.016, 0.2) - 0.101).abs() < 1e-9);
        assert!((lead.at(9.0, 0.016, 0.2) - 0.056).abs() < 1e-9);
        lead.measured(9.0);
        assert!((lead.at(99.0, 0.016, 0.2) - 0.2).abs() < 1e-9);
    }
}
