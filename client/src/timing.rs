//! What tick it is on the server: an estimate from when snapshots arrive, and how far ahead of it a player must act.
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

    /// The state of `tick` arrived.
    pub(crate) fn arrived(&mut self, tick: u64, at: f64) {
        self.arrivals.push_back((at, tick as f64 * self.tick_seconds - at));
        while self.arrivals.front().is_some_and(|(then, _)| at - then > WINDOW) {
            self.arrivals.pop_front();
        }
    }

    /// The tick, with its fraction, that the server plays at local time `now`; `None` before the first arrival.
    /// Never falls, as long as `now` doesn't, but for jumps.
    pub(crate) fn tick_at(&mut self, now: f64) -> Option<f64> {
        let target = self.arrivals.iter().map(|(_, offset)| *offset).reduce(f64::max)?;
        let offset = self.offset.advance(target, now);
        Some(((now + offset) / self.tick_seconds).max(0.0))
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
