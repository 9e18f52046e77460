//! A ball that rolls on wood: a rumble that grows and brightens with its speed.

use std::f32::consts::FRAC_PI_4;

use shared::math::Rng;

use super::faders::Roll;
use super::synth::smoothing;

/// How loud the fastest ball is. Noise in a narrow band keeps a fifth of it.
const LOUDEST: f32 = 0.5;
/// The band of a slow ball, and what the upper end is raised by for a fast one, hertz.
const LOW: f32 = 70.0;
const HIGH: f32 = 220.0;
const BRIGHTER: f32 = 1300.0;
/// Share of the way to another loudness that is gone with each block: no step is heard.
const APPROACH: f32 = 0.15;

/// The rumble, block by block.
pub(super) struct Rumble {
    rng: Rng,
    below_high: f32,
    below_low: f32,
    /// To the left and to the right.
    gains: [f32; 2],
    speed: f32,
}

impl Rumble {
    /// Nothing rolls yet.
    pub(super) fn new() -> Self {
        Self { rng: Rng::new(1), below_high: 0.0, below_low: 0.0, gains: [0.0; 2], speed: 0.0 }
    }

    /// Adds it to a block, left and right in turn, at that many samples a second.
    pub(super) fn add_to(&mut self, out: &mut [f32], roll: Roll, rate: u32) {
        let (right, left) = ((roll.pan + 1.0) * FRAC_PI_4).sin_cos();
        self.speed += APPROACH * (roll.speed - self.speed);
        for (gain, side) in self.gains.iter_mut().zip([left, right]) {
            *gain += APPROACH * (LOUDEST * roll.speed * side - *gain);
        }
        if self.gains[0] + self.gains[1] < 1e-4 {
            return;
        }
        let (slow, fast) = (smoothing(LOW, rate), smoothing(HIGH + BRIGHTER * self.speed, rate));
        for pair in out.chunks_exact_mut(2) {
            let white = self.rng.between(-1.0, 1.0) as f32;
            self.below_high += fast * (white - self.below_high);
            self.below_low += slow * (self.below_high - self.below_low);
            let sample = self.below_high - self.below_low;
            pair[0] += sample * self.gains[0];
            pair[1] += sample * self.gains[1];
        }
    }
}

#[cfg(test)]
mod tests {
    use super::super::synth::RATE;
    use super::*;

    /// Root mean squares of both sides after half a second.
    fn heard(rumble: &mut Rumble, roll: Roll) -> [f32; 2] {
        let mut block = [0.0; 480];
        (0..100).for_each(|_| rumble.add_to(&mut block, roll, RATE));
        block.fill(0.0);
        let mut squares = [0.0; 2];
        for _ in 0..20 {
            block.fill(0.0);
            rumble.add_to(&mut block, roll, RATE);
            block.chunks_exact(2).for_each(|pair| {
                squares[0] += pair[0] * pair[0];
                squares[1] += pair[1] * pair[1];
            });
        }
        squares.map(|square| (square / 4800.0).sqrt())
    }

    #[test]
    fn the_faster_the_louder_and_from_its_place() {
        let mut rumble = Rumble::new();
        assert_eq!(heard(&mut rumble, Roll::NONE), [0.0, 0.0]);
        let [slow, _] = heard(&mut rumble, Roll { speed: 0.2, pan: 0.0 });
        let [left, right] = heard(&mut rumble, Roll { speed: 0.8, pan: 0.0 });
        assert!(slow > 0.0005 && left > 3.0 * slow && left < 0.2 && (left / right - 1.0).abs() < 0.01, "{slow} {left}");
        let [far, near] = heard(&mut rumble, Roll { speed: 0.8, pan: 0.8 });
        assert!(near > 4.0 * far && far > 0.0);
        assert_eq!(heard(&mut rumble, Roll::NONE), [0.0, 0.0]);
    }
}
