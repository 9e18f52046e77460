//! Sound on Linux: through PulseAudio's library, which PipeWire answers as well, or else through ALSA's. Both are looked for
//! when the program runs; where there is neither, there is no sound.

use std::time::{Duration, Instant};

use thiserror::Error;

use super::super::engine::Engine;
use super::super::synth::RATE;
use super::libraries::{Alsa, Pulse};

/// Samples of a side that are mixed at once: 5 ms, the grain in which sounds begin.
const BLOCK: usize = 240;
/// Milliseconds that the device has in store. Less, and a busy machine makes gaps.
pub(super) const STORE_MS: u32 = 25;
/// How long a block is.
const BLOCK_TIME: Duration = Duration::from_micros(BLOCK as u64 * 1_000_000 / RATE as u64);
/// How far ahead of time a device may take blocks: more than any has in store.
const MOST_AHEAD: Duration = Duration::from_millis(500);
/// A device that took longer than this for a block has stood still: what was to be heard meanwhile is past.
const STOOD_STILL: Duration = Duration::from_millis(250);
/// Seconds until a device that has gone is looked for again, and again; then it is given up.
const RETRIES: [u64; 5] = [2, 4, 8, 16, 32];
/// How often, while it waits for that, the thread looks whether the program has ended.
const LOOK_EVERY: Duration = Duration::from_millis(100);

/// Why there is no sound.
#[derive(Debug, Error)]
pub(super) enum OutputError {
    /// The library is not installed, or is another one.
    #[error("{0}")]
    Library(#[from] libloading::Error),
    /// The library says so.
    #[error("{0}")]
    Device(String),
}

/// An open device.
enum Device {
    Pulse(Pulse),
    Alsa(Alsa),
}

impl Device {
    fn open() -> Result<Self, String> {
        let pulse = match Pulse::open(RATE) {
            Ok(pulse) => return Ok(Self::Pulse(pulse)),
            Err(error) => error,
        };
        match Alsa::open(RATE) {
            Ok(alsa) => Ok(Self::Alsa(alsa)),
            Err(alsa) => Err(format!("PulseAudio: {pulse}; ALSA: {alsa}")),
        }
    }

    fn name(&self) -> &'static str {
        match self {
            Self::Pulse(_) => "PulseAudio",
            Self::Alsa(_) => "ALSA",
        }
    }

    fn write(&mut self, samples: &[i16]) -> Result<(), OutputError> {
        match self {
            Self::Pulse(pulse) => pulse.write(samples),
            Self::Alsa(alsa) => alsa.write(samples),
        }
    }
}

/// Plays until the program ends, or there is no device (any more).
pub(in super::super) fn play(mut engine: Engine) {
    let mut device = match Device::open() {
        Ok(device) => device,
        Err(error) => return tracing::warn!("no sound: {error}"),
    };
    loop {
        tracing::debug!("sound through {}", device.name());
        let Err(error) = play_on(&mut device, &mut engine) else { return };
        tracing::warn!("the sound has stopped: {}: {error}", device.name());
        drop(device);
        match reopen(&mut engine) {
            Some(again) => device = again,
            None => return,
        }
    }
}

/// Plays until the program ends.
fn play_on(device: &mut Device, engine: &mut Engine) -> Result<(), OutputError> {
    let (mut block, mut samples) = ([0.0; 2 * BLOCK], [0; 2 * BLOCK]);
    let (begin, mut played) = (Instant::now(), Duration::ZERO);
    while engine.fill(&mut block, RATE) {
        for (sample, value) in samples.iter_mut().zip(block) {
            *sample = (value * f32::from(i16::MAX)) as i16;
        }
        let before = Instant::now();
        device.write(&samples)?;
        if before.elapsed() > STOOD_STILL && !engine.skip() {
            break;
        }
        // One that takes everything at once, as ALSA's null device does, sets no pace.
        played += BLOCK_TIME;
        let ahead = played.saturating_sub(begin.elapsed());
        if ahead > MOST_AHEAD {
            std::thread::sleep(ahead);
        }
    }
    Ok(())
}

/// Looks for a device again, now and then; `None` if the program ends or none is found.
fn reopen(engine: &mut Engine) -> Option<Device> {
    for seconds in RETRIES {
        let start = Instant::now();
        while start.elapsed() < Duration::from_secs(seconds) {
            if !engine.skip() {
                return None;
            }
            std::thread::sleep(LOOK_EVERY);
        }
        if let Ok(device) = Device::open() {
            return Some(device);
        }
    }
    None
}
