//! Sound on macOS and Windows.

use std::sync::mpsc::sync_channel;

use cpal::traits::{DeviceTrait, HostTrait, StreamTrait};
use cpal::{Error, ErrorKind, OutputCallbackInfo, StreamConfig};

use super::super::engine::Engine;

/// Samples of a side that are mixed at once.
const BLOCK: usize = 240;

/// Plays until the program ends, or there is no device (any more).
pub(in super::super) fn play(engine: Engine) {
    if let Err(error) = play_on_default(engine) {
        tracing::warn!("no sound: {error}");
    }
}

fn play_on_default(mut engine: Engine) -> Result<(), Error> {
    let Some(device) = cpal::default_host().default_output_device() else {
        return Err(Error::new(ErrorKind::DeviceNotAvailable));
    };
    let config: StreamConfig = device.default_output_config()?.into();
    let (rate, channels) = (config.sample_rate, usize::from(config.channels));
    // Full as soon as there is a reason to end.
    let (end, ended) = sync_channel(1);
    let fail = end.clone();
    let fill = move |data: &mut [f32], _: &OutputCallbackInfo| {
        let mut block = [0.0; 2 * BLOCK];
        for frames in data.chunks_mut(BLOCK * channels) {
            let block = &mut block[..2 * (frames.len() / channels)];
            if !engine.fill(block, rate) {
                let _ = end.try_send(Ok(()));
            }
            for (frame, pair) in frames.chunks_exact_mut(channels).zip(block.chunks_exact(2)) {
                spread(pair, frame);
            }
        }
    };
    let heed = move |error: Error| {
        // A gap, or another device in the place of the old one, is no reason to end.
        if !matches!(error.kind(), ErrorKind::DeviceChanged | ErrorKind::Xrun | ErrorKind::RealtimeDenied) {
            let _ = fail.try_send(Err(error));
        }
    };
    let stream = device.build_output_stream(config, fill, heed, None)?;
    stream.play()?;
    ended.recv().unwrap_or(Ok(()))
}

/// Left and right on as many loudspeakers as there are.
fn spread(pair: &[f32], frame: &mut [f32]) {
    match frame {
        [one] => *one = 0.5 * (pair[0] + pair[1]),
        [left, right, others @ ..] => {
            (*left, *right) = (pair[0], pair[1]);
            others.fill(0.0);
        }
        [] => {}
    }
}
