//! How far behind the server's world a frame is when it comes, without a clock that both share.
//!
//! A pong says at which tick the server was when it answered. The moment `a` at which the pong arrives is therefore no
//! earlier than the one at which the world was at that tick, so tick 0 was at `a - tick * seconds_per_tick` or before: each pong
//! gives a bound, and the least of many is the tightest. It is too late by how long the luckiest pong was on its way back and by how
//! much of a tick had passed when it was written: tens of microseconds on one machine, and less than its round trip, whatever
//! held up the ping on its way there. By so much frames may have been later than is told.
//!
//! Bounds are taken from the pongs within a second of what they are applied to. So a clock that drifts does no harm; where the
//! server stalled and gave time up, frames of the second after are told to be later than they were.
//!
//! Frames are therefore noted by their own ticks, and only judged when all pongs are known.

/// Microseconds of a window in which frames share one bound.
const WINDOW: u64 = 100_000;
/// Pongs of so many windows before and after count.
const AROUND: usize = 10;
/// Frames are noted in units of so many microseconds.
const UNIT: f64 = 10.0;
/// Moments of a window that are noted at the most: a hundred times a window's share of 10,000 connections at 10 Hz would be more than memory is for.
const MOST_IN_WINDOW: usize = 100_000;

/// What came within a window.
#[derive(Debug, Default)]
struct Window {
    /// The least `arrival - tick * seconds_per_tick` of its pongs, microseconds.
    bound: Option<f64>,
    arrivals: Vec<i32>,
    moments_before: Vec<i32>,
}

/// Notes pongs and frames.
#[derive(Debug, Default)]
pub(crate) struct Clock {
    windows: Vec<Window>,
    tick_microseconds: f64,
    /// Numbers are small if they are noted relative to the first pong's bound.
    base: Option<f64>,
    /// Round trips.
    trips: Vec<i32>,
}

/// Milliseconds.
#[derive(Debug, Clone, Copy, Default, PartialEq, serde::Serialize)]
pub(crate) struct Spread {
    /// Half of them are below.
    pub(crate) p50: f64,
    /// One in a hundred is above.
    pub(crate) p99: f64,
    /// The largest.
    pub(crate) max: f64,
}

impl Clock {
    /// Ticks have so many seconds.
    pub(crate) fn set_tick_seconds(&mut self, seconds: f64) {
        self.tick_microseconds = seconds * 1e6;
    }

    /// Whether a pong came.
    pub(crate) fn is_set(&self) -> bool {
        self.base.is_some()
    }

    /// A pong with this tick came at `now`; its ping was sent at `sent`. Microseconds.
    pub(crate) fn hear_pong(&mut self, sent: u64, now: u64, tick: u64) {
        let bound = now as f64 - tick as f64 * self.tick_microseconds;
        self.trips.push((now.saturating_sub(sent) as f64 / UNIT) as i32);
        self.base.get_or_insert(bound);
        let window = self.window(now);
        window.bound = Some(window.bound.map_or(bound, |least| least.min(bound)));
    }

    /// A frame that leads to tick `to` came at `now`, and the one before led to `before`.
    pub(crate) fn hear_frame(&mut self, now: u64, to: u64, before: Option<u64>) {
        let Some(base) = self.base else { return };
        let tick_microseconds = self.tick_microseconds;
        let note = |tick: u64| ((now as f64 - tick as f64 * tick_microseconds - base) / UNIT) as i32;
        let window = self.window(now);
        if window.arrivals.len() < MOST_IN_WINDOW {
            window.arrivals.push(note(to));
            window.moments_before.extend(before.map(note));
        }
    }

    /// Round trips count from here on.
    pub(crate) fn begin(&mut self) {
        self.trips.clear();
    }

    /// How long pings were on their way there and back.
    pub(crate) fn trips(&self) -> Spread {
        spread(self.trips.clone())
    }

    fn window(&mut self, now: u64) -> &mut Window {
        let place = (now / WINDOW) as usize;
        if self.windows.len() <= place {
            self.windows.resize_with(place + 1, Window::default);
        }
        &mut self.windows[place]
    }

    /// How far behind frames were when they came, and just before the next one came.
    pub(crate) fn spreads(&self) -> (Spread, Spread) {
        let (mut arrivals, mut moments_before) = (Vec::new(), Vec::new());
        for (place, window) in self.windows.iter().enumerate().filter(|(_, window)| !window.arrivals.is_empty()) {
            let Some(origin) = self.origin(place) else { continue };
            let shift = ((origin - self.base.unwrap_or(0.0)) / UNIT) as i32;
            arrivals.extend(window.arrivals.iter().map(|noted| noted - shift));
            moments_before.extend(window.moments_before.iter().map(|noted| noted - shift));
        }
        (spread(arrivals), spread(moments_before))
    }

    /// The moment of tick 0, as pongs around a window have it; of the nearest one if there are none.
    fn origin(&self, place: usize) -> Option<f64> {
        let around = |reach: usize| {
            let near = &self.windows[place.saturating_sub(reach)..(place + reach + 1).min(self.windows.len())];
            near.iter().filter_map(|window| window.bound).reduce(f64::min)
        };
        (AROUND..self.windows.len() + AROUND).find_map(around)
    }
}

fn spread(mut noted: Vec<i32>) -> Spread {
    noted.sort_unstable();
    let at = |share: f64| {
        let place = (noted.len() as f64 * share) as usize;
        noted.get(place.min(noted.len().saturating_sub(1))).map_or(0.0, |&noted| f64::from(noted) * UNIT / 1000.0)
    };
    Spread { p50: at(0.5), p99: at(0.99), max: at(1.0) }
}

#[cfg(test)]
mod tests {
    use super::*;

    /// A server whose tick 0 was at 5 s, and whose pongs are on their way for 30 microseconds and more.
    fn asked(clock: &mut Clock, tick_zero: u64, until: u64) {
        clock.set_tick_seconds(0.001);
        for n in 0..200_u64 {
            let answered = until - 2_000_000 + n * 10_000 + n * 37 % 1000;
            let trip = 30 + n % 7 * 100;
            clock.hear_pong(answered - trip, answered + trip, (answered - tick_zero) / 1000);
        }
    }

    #[test]
    fn a_frame_is_as_late_as_it_is() {
        let mut clock = Clock::default();
        asked(&mut clock, 5_000_000, 10_000_000);
        for _ in 0..100 {
            clock.hear_frame(9_000_000, 3_997, Some(3_897));
        }
        let (late, behind) = clock.spreads();
        assert!((late.p50 - 3.0).abs() < 0.05, "{late:?}");
        assert!((behind.max - 103.0).abs() < 0.05, "{behind:?}");
    }

    #[test]
    fn time_that_was_given_up_is_known_a_second_later() {
        let mut clock = Clock::default();
        asked(&mut clock, 5_000_000, 10_000_000);
        asked(&mut clock, 5_300_000, 20_000_000);
        clock.hear_frame(9_000_000, 3_999, None);
        clock.hear_frame(19_000_000, 13_699, None);
        let (late, _) = clock.spreads();
        assert!((late.max - 1.0).abs() < 0.05, "{late:?}");
    }
}
