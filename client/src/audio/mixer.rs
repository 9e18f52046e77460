//! Adds up what sounds at once: voices with a place between left and right, under a limit that bends instead of clipping.

use std::f32::consts::FRAC_PI_4;

use super::bank::{Bank, Sound};
use super::faders::Roll;
use super::rumble::Rumble;
use super::synth::RATE;

/// Sounds at once; a further one takes the place of the one of which least is left to be heard.
const MOST_VOICES: usize = 24;
/// Up to here a sum is left as it is; above, it bends towards 1.
const STRAIGHT: f32 = 0.6;

/// A sound that is to be heard.
#[derive(Debug, Clone, Copy, PartialEq)]
pub(crate) struct Cue {
    /// Which.
    pub(crate) sound: Sound,
    /// How loud, 0 to 1.
    pub(crate) gain: f32,
    /// Where: -1 is left, 1 right.
    pub(crate) pan: f32,
    /// How much faster, and so higher, than it was made.
    pub(crate) pitch: f32,
    /// Seconds until it begins.
    pub(crate) delay: f32,
}

struct Voice {
    sound: Sound,
    /// The next sample, with its fraction; below 0 while it waits.
    position: f32,
    pitch: f32,
    /// To the left and to the right.
    gains: [f32; 2],
}

/// The voices.
pub(super) struct Mixer {
    bank: Bank,
    voices: Vec<Voice>,
    rumble: Rumble,
}

impl Mixer {
    /// Nothing sounds yet.
    pub(super) fn new(bank: Bank) -> Self {
        Self { bank, voices: Vec::with_capacity(MOST_VOICES), rumble: Rumble::new() }
    }

    /// Begins a sound.
    pub(super) fn play(&mut self, cue: Cue) {
        let Cue { sound, gain, pan, pitch, delay } = cue;
        // The sum of the squares is the same wherever it is: so is the loudness.
        let (right, left) = ((pan.clamp(-1.0, 1.0) + 1.0) * FRAC_PI_4).sin_cos();
        let loud = sound.level() * gain.clamp(0.0, 1.0);
        let position = -delay.max(0.0) * RATE as f32;
        let voice = Voice { sound, position, pitch: pitch.clamp(0.25, 4.0), gains: [left * loud, right * loud] };
        if self.voices.len() < MOST_VOICES {
            return self.voices.push(voice);
        }
        let bank = &self.bank;
        let least = self.voices.iter_mut().min_by(|a, b| left_of(a, bank).total_cmp(&left_of(b, bank)));
        if let Some(least) = least {
            *least = voice;
        }
    }

    /// Fills `out`, left and right in turn, with what sounds next, at `rate` samples a second.
    pub(super) fn mix(&mut self, out: &mut [f32], gain: f32, roll: Roll, rate: u32) {
        out.fill(0.0);
        let (bank, step) = (&self.bank, RATE as f32 / rate as f32);
        self.voices.retain_mut(|voice| voice.add_to(out, bank.samples(voice.sound), step));
        self.rumble.add_to(out, roll, rate);
        out.iter_mut().for_each(|sample| *sample = limited(*sample * gain));
    }
}

impl Voice {
    /// Adds what it sounds next, `step` samples of its own to one of the output's; `false` if it has come to its end.
    fn add_to(&mut self, out: &mut [f32], samples: &[f32], step: f32) -> bool {
        let [left, right] = self.gains;
        for pair in out.chunks_exact_mut(2) {
            if self.position < 0.0 {
                self.position += step;
                continue;
            }
            let place = self.position as usize;
            let [Some(one), Some(next)] = [place, place + 1].map(|place| samples.get(place)) else { return false };
            let sample = one + (next - one) * (self.position - place as f32);
            pair[0] += sample * left;
            pair[1] += sample * right;
            self.position += self.pitch * step;
        }
        true
    }
}

/// What of a voice is still to be heard, roughly: its loudness times the rest of it.
fn left_of(voice: &Voice, bank: &Bank) -> f32 {
    let length = bank.samples(voice.sound).len() as f32;
    (voice.gains[0] + voice.gains[1]) * (1.0 - voice.position.max(0.0) / length)
}

/// A soft limiter: straight where it can be, and never 1.
fn limited(sample: f32) -> f32 {
    let over = sample.abs() - STRAIGHT;
    if over <= 0.0 {
        return sample;
    }
    let room = 1.0 - STRAIGHT;
    // x / (1 + x) leaves along the same slope and comes near to 1, but not to it.
    (STRAIGHT + room * (over / (room + over))).min(0.999).copysign(sample)
}

#[cfg(test)]
mod tests {
    use super::*;

    fn cue(sound: Sound, gain: f32, pan: f32) -> Cue {
        Cue { sound, gain, pan, pitch: 1.0, delay: 0.0 }
    }

    /// Root mean squares of both sides, and the peak, of the first tenth of a second.
    fn heard(cues: &[Cue]) -> ([f32; 2], f32) {
        let mut mixer = Mixer::new(Bank::new());
        cues.iter().for_each(|&cue| mixer.play(cue));
        let mut out = vec![0.0; RATE as usize / 5];
        mixer.mix(&mut out, 1.0, Roll::NONE, RATE);
        let side = |side: usize| {
            let square: f32 = out.iter().skip(side).step_by(2).map(|sample| sample * sample).sum();
            (square / (out.len() / 2) as f32).sqrt()
        };
        ([side(0), side(1)], out.iter().fold(0.0, |most: f32, sample| most.max(sample.abs())))
    }

    #[test]
    fn a_sound_comes_from_its_place_as_loud_as_it_should() {
        let ([left, right], _) = heard(&[cue(Sound::Bumper, 0.5, 0.0)]);
        assert!((left / right - 1.0).abs() < 0.001 && left > 0.01, "{left} {right}");
        let ([far, near], _) = heard(&[cue(Sound::Bumper, 0.5, 1.0)]);
        assert!(far < 0.001 * near && (near / left - 2.0_f32.sqrt()).abs() < 0.01, "{far} {near}");
        let ([west, east], _) = heard(&[cue(Sound::Bumper, 0.5, -0.5)]);
        assert!(west > 2.0 * east && east > 0.0);
        let ([soft, _], _) = heard(&[cue(Sound::Bumper, 0.25, 0.0)]);
        assert!((left / soft - 2.0).abs() < 0.01, "{left} {soft}");
    }

    #[test]
    fn nothing_is_louder_than_full_scale() {
        let all: Vec<Cue> = Sound::ALL.into_iter().map(|sound| cue(sound, 1.0, 1.0)).collect();
        let (_, peak) = heard(&all);
        assert!((0.9..1.0).contains(&peak), "{peak}");
        assert_eq!((limited(0.5), limited(-0.6)), (0.5, -0.6));
        assert!(limited(-3.0) < -0.9 && limited(1e9) < 1.0 && limited(0.61) > limited(0.6));
    }

    #[test]
    fn the_voice_of_which_least_is_left_makes_room() {
        let mut mixer = Mixer::new(Bank::new());
        mixer.play(cue(Sound::Tilt, 1.0, 0.0));
        mixer.play(cue(Sound::Rubber, 0.1, 0.0));
        for _ in 0..MOST_VOICES {
            mixer.play(cue(Sound::Metal, 0.5, 0.0));
        }
        let count = |sound| mixer.voices.iter().filter(|voice| voice.sound == sound).count();
        assert_eq!((mixer.voices.len(), count(Sound::Tilt), count(Sound::Rubber)), (MOST_VOICES, 1, 0));
    }

    #[test]
    fn voices_wait_for_their_time_and_end() {
        let mut mixer = Mixer::new(Bank::new());
        mixer.play(Cue { delay: 0.01, pitch: 2.0, ..cue(Sound::Wood, 1.0, 0.0) });
        let mut out = vec![0.0; 2 * 480];
        mixer.mix(&mut out, 1.0, Roll::NONE, RATE);
        assert!(out.iter().all(|sample| *sample == 0.0));
        mixer.mix(&mut out, 1.0, Roll::NONE, RATE);
        assert!(out.iter().any(|sample| *sample != 0.0));
        // A tenth of a second, twice as fast.
        for _ in 0..4 {
            mixer.mix(&mut out, 1.0, Roll::NONE, RATE);
        }
        assert!(mixer.voices.is_empty());
    }
}
