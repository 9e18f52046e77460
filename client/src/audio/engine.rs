//! The sound's thread: takes cues, mixes, and waits for the device.

use std::sync::Arc;
use std::sync::mpsc::{Receiver, TryRecvError};
use std::time::Instant;

use super::bank::Bank;
use super::faders::Faders;
use super::mixer::{Cue, Mixer};
use super::output;

/// Share of the way to another volume that is gone with each block: no step is heard.
const APPROACH: f32 = 0.2;

/// What makes the sound, block by block.
pub(super) struct Engine {
    mixer: Mixer,
    cues: Receiver<Cue>,
    faders: Arc<Faders>,
    gain: f32,
}

/// Lets cues be heard until nobody can send any more, or no device takes them.
pub(super) fn run(cues: Receiver<Cue>, faders: Arc<Faders>) {
    let start = Instant::now();
    let engine = Engine { mixer: Mixer::new(Bank::new()), cues, faders, gain: 0.0 };
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
        self.gain += APPROACH * (self.faders.gain() - self.gain);
        self.mixer.mix(block, self.gain, self.faders.roll(), rate);
        true
    }

    /// Forgets what has waited while the device stood still; `false` if the program has ended.
    #[cfg(any(test, target_os = "linux"))]
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
        let faders = Arc::new(Faders::default());
        faders.set_volume(100);
        let mut engine = Engine { mixer: Mixer::new(Bank::new()), cues, faders: Arc::clone(&faders), gain: 1.0 };
        let cue = Cue { sound: Sound::Tilt, gain: 0.5, pan: 0.0, pitch: 1.0, delay: 0.0 };
        assert_eq!(peak(&mut engine), 0.0);
        sender.send(cue).unwrap();
        peak(&mut engine);
        assert!(peak(&mut engine) > 0.1);
        faders.set_volume(0);
        assert!(peak(&mut engine) > 0.1, "no jump");
        assert!((0..40).map(|_| peak(&mut engine)).last().unwrap() < 1e-3);
        sender.send(cue).unwrap();
        assert!(engine.skip());
        drop(sender);
        assert!(!engine.fill(&mut [0.0; 4], RATE) && !engine.skip());
    }
}
