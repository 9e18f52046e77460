//! The sound's thread: takes cues, mixes, and waits for the device.

use std::sync::Arc;
use std::sync::atomic::{AtomicU8, Ordering};
use std::sync::mpsc::{Receiver, TryRecvError};
use std::time::Instant;

use super::bank::Bank;
use super::mixer::{Cue, Mixer};
use super::output;

/// Share of the way to another volume that is gone with each block: no step is heard.
const APPROACH: f32 = 0.2;

/// What makes the sound, block by block.
pub(super) struct Engine {
    mixer: Mixer,
    cues: Receiver<Cue>,
    /// 0 to 100.
    volume: Arc<AtomicU8>,
    gain: f32,
}

/// Lets cues be heard until nobody can send any more, or no device takes them.
pub(super) fn run(cues: Receiver<Cue>, volume: Arc<AtomicU8>) {
    let start = Instant::now();
    let gain = gain_of(volume.load(Ordering::Relaxed));
    let engine = Engine { mixer: Mixer::new(Bank::new()), cues, volume, gain };
    tracing::debug!("sounds made in {:.1} ms", start.elapsed().as_secs_f64() * 1000.0);
    output::play(engine);
}

impl Engine {
    /// Fills a block, left and right in turn, at that many samples a second; `false` if the program has ended.
    pub(super) fn fill(&mut self, block: &mut [f32], rate: u32) -> bool {
        loop {
            match self.cues.try_recv() {
                Ok(cue) => self.mixer.play(cue),
                Err(TryRecvError::Empty) => break,
                Err(TryRecvError::Disconnected) => return false,
            }
        }
        self.gain += APPROACH * (gain_of(self.volume.load(Ordering::Relaxed)) - self.gain);
        self.mixer.mix(block, self.gain, rate);
        true
    }

    /// Forgets what has waited while the device stood still; `false` if the program has ended.
    pub(super) fn skip(&mut self) -> bool {
        loop {
            match self.cues.try_recv() {
                Ok(_) => {}
                Err(TryRecvError::Empty) => return true,
                Err(TryRecvError::Disconnected) => return false,
            }
        }
    }
}

/// Ears hear ratios: half the volume is a quarter of the amplitude.
fn gain_of(volume: u8) -> f32 {
    let share = f32::from(volume.min(100)) / 100.0;
    share * share
}

#[cfg(test)]
mod tests {
    use std::sync::mpsc::sync_channel;

    use super::super::bank::Sound;
    use super::super::synth::RATE;
    use super::*;

    fn peak(engine: &mut Engine) -> f32 {
        let mut block = [0.0; 960];
        assert!(engine.fill(&mut block, RATE));
        block.iter().fold(0.0, |most: f32, sample| most.max(sample.abs()))
    }

    #[test]
    fn plays_what_is_sent_as_loud_as_it_is_set_until_nobody_sends() {
        let (sender, cues) = sync_channel(8);
        let volume = Arc::new(AtomicU8::new(100));
        let mut engine =
            Engine { mixer: Mixer::new(Bank::new()), cues, volume: Arc::clone(&volume), gain: gain_of(100) };
        let cue = Cue { sound: Sound::Tilt, gain: 0.5, pan: 0.0, pitch: 1.0, delay: 0.0 };
        assert_eq!(peak(&mut engine), 0.0);
        sender.send(cue).unwrap();
        peak(&mut engine);
        assert!(peak(&mut engine) > 0.1);
        volume.store(0, Ordering::Relaxed);
        assert!(peak(&mut engine) > 0.1, "no jump");
        assert!((0..40).map(|_| peak(&mut engine)).last().unwrap() < 1e-3);
        sender.send(cue).unwrap();
        assert!(engine.skip());
        drop(sender);
        assert!(!engine.fill(&mut [0.0; 4], RATE) && !engine.skip());
    }
}
