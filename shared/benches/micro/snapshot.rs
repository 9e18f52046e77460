//! Snapshots: the state of a game as the server sends it, to bytes and back. Each has its mean size in its name.

use std::fmt;
use std::fmt::Write;
use std::sync::Arc;

use divan::counter::BytesCount;
use divan::{Bencher, black_box};
use shared::game::{Game, GameState};
use shared::math::Rng;
use shared::physics::PHYSICS_VERSION;
use shared::protocol::{Full, ServerMessage, VERSION, decode_from_server, encode_from_server};

use super::classic;
use super::inputs::{INPUTS, Round, table};

/// Calls in a sample: each input as often as any other.
const SAMPLE: u32 = INPUTS as u32;
/// Samples, of which the median counts.
const SAMPLES: u32 = 100;

/// Messages with a snapshot each, of one scene.
struct Messages {
    scene: &'static str,
    messages: Vec<ServerMessage>,
    /// Mean size, bytes.
    bytes: usize,
}

impl Messages {
    fn new(scene: &'static str, messages: Vec<ServerMessage>) -> Self {
        let total: usize = messages.iter().map(|message| encode_from_server(message).len()).sum();
        Self { scene, bytes: total / messages.len(), messages }
    }

    fn all() -> [Self; 2] {
        [Self::of_classic(), Self::of_balls()]
    }

    /// In play, with one ball.
    fn of_classic() -> Self {
        let snapshots = classic::snapshots(INPUTS).into_iter();
        Self::new("classic, one ball", snapshots.map(full_of).collect())
    }

    /// A hundred balls that bounce in a box.
    fn of_balls() -> Self {
        let mut rng = Rng::new(7);
        let mut balls = String::new();
        for i in 0..100 {
            let (x, y) = (0.05 + 0.1 * f64::from(i % 10), 0.05 + 0.1 * f64::from(i / 10));
            let (vx, vy) = (rng.between(-1.5, 1.5), rng.between(-1.5, 1.5));
            let _ = write!(balls, "(position: ({x:?}, {y:?}), velocity: ({vx:?}, {vy:?}), radius: 0.01),");
        }
        let scene = table(&format!(
            "Scene(
                gravity: (0.0, -1.1101),
                balls: [{balls}],
                elements: [Wall(points: [(0.0, 0.0), (1.0, 0.0), (1.0, 1.0), (0.0, 1.0), (0.0, 0.0)])],
            )"
        ));
        let mut game = Game::new(Arc::new(scene));
        let messages = (0..INPUTS).map(|_| {
            for _ in 0..17 {
                game.step(&[]);
            }
            full_of(game.state())
        });
        Self::new("a hundred balls", messages.collect())
    }
}

fn full_of(state: GameState) -> ServerMessage {
    let room = "room".to_owned();
    ServerMessage::Full(Box::new(Full {
        room,
        protocol: VERSION,
        physics: PHYSICS_VERSION,
        table_digest: 1,
        boards: vec![state],
    }))
}

impl fmt::Display for Messages {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        write!(f, "{}: {} bytes", self.scene, self.bytes)
    }
}

#[divan::bench(args = Messages::all(), sample_size = SAMPLE, sample_count = SAMPLES)]
fn encoding(bencher: Bencher<'_, '_>, messages: &Messages) {
    let mut round = Round::new(messages.messages.clone());
    bencher.counter(BytesCount::new(messages.bytes)).bench_local(|| encode_from_server(black_box(round.next())));
}

#[divan::bench(args = Messages::all(), sample_size = SAMPLE, sample_count = SAMPLES)]
fn decoding(bencher: Bencher<'_, '_>, messages: &Messages) {
    let frames: Vec<_> = messages.messages.iter().map(encode_from_server).collect();
    for (frame, message) in frames.iter().zip(&messages.messages) {
        assert_eq!(decode_from_server(frame).as_ref(), Ok(message), "not what was sent");
    }
    let mut round = Round::new(frames);
    bencher.counter(BytesCount::new(messages.bytes)).bench_local(|| decode_from_server(black_box(round.next())));
}
