//! Where sounds are made: damped partials, glides, noise, bells and buzzers are added up to a waveform.

use std::f32::consts::TAU;

use shared::math::Rng;

/// Samples a second.
pub(super) const RATE: u32 = 48_000;
const RATE_F: f32 = RATE as f32;
/// What the loudest sample of a finished waveform is: a little below full scale.
const PEAK: f32 = 0.9;
/// Seconds in which a finished waveform rises from nothing and falls back to it: a jump would click.
const RISE: f32 = 0.0004;
const FALL: f32 = 0.006;
/// A bar of a chime, free at both ends: frequencies as multiples of the lowest, how loud each is, and how long it rings.
const BAR: [(f32, f32, f32); 3] = [(1.0, 1.0, 1.0), (2.756, 0.45, 0.4), (5.404, 0.2, 0.15)];

/// A sound that is being made. Times are seconds, frequencies hertz; a decay is the time in which a level falls to 1/e.
pub(super) struct Waveform {
    samples: Vec<f32>,
    rng: Rng,
}

impl Waveform {
    /// Silence. Its noise follows from `seed`.
    pub(super) fn new(seconds: f32, seed: u64) -> Self {
        Self { samples: vec![0.0; (seconds * RATE_F) as usize], rng: Rng::new(seed) }
    }

    /// A partial that rings from `at` on.
    pub(super) fn ring(mut self, at: f32, hertz: f32, decay: f32, level: f32) -> Self {
        // One rotation a sample, which also shrinks: no sine in the loop.
        let shrink = falls(decay);
        let (sin, cos) = (TAU * hertz / RATE_F).sin_cos();
        let (mut x, mut y) = (level, 0.0_f32);
        for sample in self.from(at) {
            *sample += y;
            (x, y) = (shrink * (x * cos - y * sin), shrink * (x * sin + y * cos));
        }
        self
    }

    /// A partial whose frequency goes from one to another within `seconds`, and stays there.
    pub(super) fn glide(mut self, at: f32, (from, to): (f32, f32), seconds: f32, decay: f32, level: f32) -> Self {
        let (shrink, step) = (falls(decay), 1.0 / (seconds * RATE_F));
        let (mut level, mut phase, mut share) = (level, 0.0_f32, 0.0_f32);
        for sample in self.from(at) {
            *sample += level * phase.sin();
            phase = (phase + TAU * (from + (to - from) * share) / RATE_F) % TAU;
            share = (share + step).min(1.0);
            level *= shrink;
        }
        self
    }

    /// A burst of noise between two frequencies.
    pub(super) fn noise(mut self, at: f32, (low, high): (f32, f32), decay: f32, level: f32) -> Self {
        let shrink = falls(decay);
        let mut rng = self.rng.clone();
        let (slow, fast) = (smoothing(low, RATE), smoothing(high, RATE));
        let (mut level, mut below_high, mut below_low) = (level, 0.0_f32, 0.0_f32);
        for sample in self.from(at) {
            let white = rng.between(-1.0, 1.0) as f32;
            below_high += fast * (white - below_high);
            below_low += slow * (below_high - below_low);
            *sample += level * (below_high - below_low);
            level *= shrink;
        }
        self.rng = rng;
        self
    }

    /// A bar of a chime that is struck.
    pub(super) fn bell(mut self, at: f32, hertz: f32, decay: f32, level: f32) -> Self {
        for (ratio, share, lasts) in BAR {
            self = self.ring(at, hertz * ratio, decay * lasts, level * share);
        }
        self.noise(at, (1500.0, 6000.0), 0.002, level * 0.3)
    }

    /// A buzzer that sounds for `seconds` while its frequency goes from one to another.
    pub(super) fn buzz(mut self, at: f32, (from, to): (f32, f32), seconds: f32, level: f32) -> Self {
        let length = (seconds * RATE_F) as usize;
        let mut phase = 0.0_f32;
        for (place, sample) in self.from(at).iter_mut().take(length).enumerate() {
            let share = place as f32 / length as f32;
            // A square wave's first three partials: harsh, but no whistle.
            let wave = phase.sin() + (3.0 * phase).sin() / 3.0 + (5.0 * phase).sin() / 5.0;
            let edge = (share * 40.0).min((1.0 - share) * 12.0).min(1.0);
            *sample += level * edge * wave;
            phase = (phase + TAU * (from + (to - from) * share) / RATE_F) % TAU;
        }
        self
    }

    /// The finished sound: as loud as can be, from nothing and back to it.
    pub(super) fn finish(mut self) -> Box<[f32]> {
        let (rise, fall) = ((RISE * RATE_F) as usize, (FALL * RATE_F) as usize);
        for (place, sample) in self.samples.iter_mut().take(rise).enumerate() {
            *sample *= place as f32 / rise as f32;
        }
        for (place, sample) in self.samples.iter_mut().rev().take(fall).enumerate() {
            *sample *= place as f32 / fall as f32;
        }
        let loudest = self.samples.iter().fold(0.0_f32, |most, sample| most.max(sample.abs()));
        if loudest > 0.0 {
            self.samples.iter_mut().for_each(|sample| *sample *= PEAK / loudest);
        }
        self.samples.into_boxed_slice()
    }

    fn from(&mut self, at: f32) -> &mut [f32] {
        let start = ((at * RATE_F) as usize).min(self.samples.len());
        &mut self.samples[start..]
    }
}

/// What is left of a level after one sample.
fn falls(decay: f32) -> f32 {
    (-1.0 / (decay * RATE_F)).exp()
}

/// The share by which a low-pass of the first order follows with each of so many samples a second.
pub(super) fn smoothing(hertz: f32, rate: u32) -> f32 {
    1.0 - (-TAU * hertz / rate as f32).exp()
}

#[cfg(test)]
mod tests {
    use super::*;

    fn crossings(samples: &[f32]) -> usize {
        samples.windows(2).filter(|pair| (pair[0] < 0.0) != (pair[1] < 0.0)).count()
    }

    #[test]
    fn a_partial_has_its_frequency_and_its_decay() {
        let samples = Waveform::new(1.0, 1).ring(0.0, 440.0, 0.2, 0.5).samples;
        assert!((878..=881).contains(&crossings(&samples)), "{}", crossings(&samples));
        let loudest = |from: usize| samples[from..from + 480].iter().fold(0.0_f32, |most, x| most.max(x.abs()));
        let share = loudest(9_600) / loudest(0);
        assert!((0.36..0.38).contains(&share), "{share}");
    }

    #[test]
    fn noise_keeps_to_its_band() {
        let low = Waveform::new(0.5, 1).noise(0.0, (50.0, 400.0), 9.0, 1.0).samples;
        let high = Waveform::new(0.5, 1).noise(0.0, (5000.0, 12_000.0), 9.0, 1.0).samples;
        assert!(crossings(&high) > 4 * crossings(&low), "{} {}", crossings(&high), crossings(&low));
    }

    #[test]
    fn what_is_finished_has_no_edges_and_one_peak() {
        let samples = Waveform::new(0.1, 1).buzz(0.0, (300.0, 200.0), 0.1, 3.0).finish();
        let loudest = samples.iter().fold(0.0_f32, |most, sample| most.max(sample.abs()));
        assert!((loudest - PEAK).abs() < 1e-6 && samples[0] == 0.0 && samples[samples.len() - 1] == 0.0);
        assert!(Waveform::new(0.1, 1).finish().iter().all(|sample| *sample == 0.0));
    }

    #[test]
    fn nothing_begins_after_the_end() {
        assert_eq!(Waveform::new(0.1, 1).bell(0.2, 440.0, 0.1, 1.0).samples, vec![0.0; 4800]);
    }
}
