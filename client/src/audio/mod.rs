//! What is heard of the game. The frame hands over what happened; everything else, from making the sounds to waiting for
//! the sound device, is done on a thread of its own, and nothing that the device does holds a frame up.
//!
//! `listener` turns events into cues, `machinery` what moves without an event; `synth` and `bank` make the sounds,
//! `rumble` that of a rolling ball, `mixer` adds them up; `engine` is the thread, `faders` what it is told, `output` the device.

mod bank;
mod engine;
mod faders;
mod listener;
mod machinery;
mod mixer;
mod output;
mod rumble;
mod synth;

use std::sync::Arc;
use std::sync::mpsc::{Receiver, RecvTimeoutError, SyncSender, sync_channel};
use std::time::Duration;

use shared::game::GameEvent;
use shared::table::Table;

use crate::moment::Moment;
use faders::{Faders, Roll};
use listener::Listener;
use machinery::Machinery;
use mixer::Cue;

/// Cues that wait for the thread at the most. It takes them every few milliseconds; if it does not, the device has stopped,
/// and what does not fit is not heard.
const MOST_WAITING: usize = 128;
/// How long the end of the program waits for the device at the most: a sound server may have stopped for good.
const FAREWELL: Duration = Duration::from_millis(300);
/// How loud a game is that plays itself while somebody looks at the title.
const ATTRACT_GAIN: f32 = 0.6;

/// What is to be heard of one picture.
#[derive(Debug)]
pub(crate) struct Scene<'a> {
    /// The table that is played.
    pub(crate) table: &'a Arc<Table>,
    /// The board that is seen large.
    pub(crate) board: usize,
    /// What is to be seen of it.
    pub(crate) moment: &'a Moment<'a>,
    /// What happened on it since the last picture.
    pub(crate) events: &'a [GameEvent],
    /// Nobody has come to play or to watch yet.
    pub(crate) is_attract: bool,
}

/// The sound. Ends when it is dropped.
#[derive(Debug)]
pub(crate) struct Audio {
    cues: Option<SyncSender<Cue>>,
    faders: Arc<Faders>,
    /// Says no more once the thread has ended.
    thread: Receiver<()>,
    /// Of the table whose game is heard.
    ears: Option<(Listener, Machinery)>,
}

impl Audio {
    /// Starts the thread; whether there is a device turns out there. Silent until a volume is set.
    pub(crate) fn start() -> Self {
        let (sender, cues) = sync_channel(MOST_WAITING);
        let (alive, thread) = sync_channel(0);
        let faders = Arc::new(Faders::default());
        let told = Arc::clone(&faders);
        let spawned = std::thread::Builder::new().name("sound".to_owned()).spawn(move || {
            let _alive: SyncSender<()> = alive;
            engine::run(cues, told);
        });
        if let Err(error) = &spawned {
            tracing::warn!("no sound: {error}");
        }
        Self { cues: spawned.ok().map(|_| sender), faders, thread, ears: None }
    }

    /// How loud everything is from now on, 0 to 100.
    pub(crate) fn set_volume(&self, volume: u8) {
        self.faders.set_volume(volume);
    }

    /// There is nothing to be heard: what sounds comes to its end.
    pub(crate) fn hush(&self) {
        self.faders.set_roll(Roll::NONE);
    }

    /// Lets be heard what happened since the last picture. Never waits.
    pub(crate) fn hear(&mut self, scene: &Scene<'_>) {
        let Some(cues) = &self.cues else { return };
        let ears = self.ears.take().filter(|(listener, _)| listener.is_of(scene.table, scene.board));
        let mut ears = ears.unwrap_or_else(|| (Listener::new(scene.table, scene.board), Machinery::default()));
        let gain = if scene.is_attract { ATTRACT_GAIN } else { 1.0 };
        let mut play = |cue: Cue| {
            // Nobody listens, or nobody takes it in time: it is not heard.
            let _ = cues.try_send(Cue { gain: cue.gain * gain, ..cue });
        };
        let (listener, machinery) = &mut ears;
        let roll = listener.roll(scene.moment);
        self.faders.set_roll(Roll { speed: roll.speed * gain, ..roll });
        machinery.observe(scene.moment, listener, &mut play);
        listener.hear(scene.moment, scene.events, &mut play);
        self.ears = Some(ears);
    }
}

impl Drop for Audio {
    fn drop(&mut self) {
        // The thread ends when nobody can send any more.
        self.cues = None;
        if self.thread.recv_timeout(FAREWELL) == Err(RecvTimeoutError::Timeout) {
            tracing::debug!("the sound server does not answer; it is left alone");
        }
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn a_thread_that_takes_nothing_holds_nobody_up() {
        let (sender, _cues) = sync_channel(2);
        let (_alive, thread) = sync_channel(0);
        let mut audio = Audio { cues: Some(sender), faders: Arc::default(), thread, ears: None };
        let table = Arc::new(Table::shipped("classic").unwrap().unwrap());
        let game = shared::game::Game::new(Arc::clone(&table));
        let moment = Moment::of(&game, 0.0);
        let kind = shared::game::GameEventKind::Started;
        let events: Vec<_> = (0..50).map(|k| GameEvent { tick: 1000 * k, kind }).collect();
        for event in &events {
            audio.hear(&Scene {
                table: &table,
                board: 0,
                moment: &moment,
                events: std::slice::from_ref(event),
                is_attract: false,
            });
        }
        // The thread is not there to end: dropping waits for it no longer than it says.
        drop(audio);
    }
}
