//! What the frame sets and the thread reads, at any time and without waiting: how loud everything is, and what rolls.

use std::sync::atomic::{AtomicU8, AtomicU32, Ordering};

/// Steps of a number from 0 to 1 in half a word.
const STEPS: f32 = u16::MAX as f32;

/// Everything starts at 0: silent.
#[derive(Debug, Default)]
pub(super) struct Faders {
    /// Percent.
    volume: AtomicU8,
    /// How fast, in the upper half; where, in the lower one.
    roll: AtomicU32,
}

/// What rolls.
#[derive(Debug, Clone, Copy, PartialEq)]
pub(super) struct Roll {
    /// How fast, 0 to 1: as fast as can be told apart.
    pub(super) speed: f32,
    /// Where: -1 is left, 1 right.
    pub(super) pan: f32,
}

impl Roll {
    /// Nothing does.
    pub(super) const NONE: Self = Self { speed: 0.0, pan: 0.0 };
}

impl Faders {
    /// How loud everything is, percent.
    pub(super) fn set_volume(&self, volume: u8) {
        self.volume.store(volume.min(100), Ordering::Relaxed);
    }

    /// The amplitude for that. Ears hear ratios: half the volume is a quarter of the amplitude.
    pub(super) fn gain(&self) -> f32 {
        let share = f32::from(self.volume.load(Ordering::Relaxed)) / 100.0;
        share * share
    }

    /// What rolls from now on.
    pub(super) fn set_roll(&self, roll: Roll) {
        // A cast saturates.
        let half = |share: f32| u32::from((share * STEPS) as u16);
        self.roll.store(half(roll.speed) << 16 | half(0.5 * (roll.pan + 1.0)), Ordering::Relaxed);
    }

    /// What rolls.
    pub(super) fn roll(&self) -> Roll {
        let word = self.roll.load(Ordering::Relaxed);
        let share = |half: u32| half as f32 / STEPS;
        Roll { speed: share(word >> 16), pan: 2.0 * share(word & 0xffff) - 1.0 }
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn what_is_set_is_read() {
        let faders = Faders::default();
        assert_eq!((faders.gain(), faders.roll().speed), (0.0, 0.0));
        faders.set_volume(50);
        assert_eq!(faders.gain(), 0.25);
        faders.set_volume(200);
        assert_eq!(faders.gain(), 1.0);
        for (speed, pan) in [(0.0, -1.0), (0.25, 0.4), (1.0, 1.0)] {
            faders.set_roll(Roll { speed, pan });
            let roll = faders.roll();
            assert!((roll.speed - speed).abs() < 1e-4 && (roll.pan - pan).abs() < 1e-4, "{roll:?}");
        }
        faders.set_roll(Roll { speed: f32::NAN, pan: 7.0 });
        assert_eq!(faders.roll(), Roll { speed: 0.0, pan: 1.0 });
    }
}
