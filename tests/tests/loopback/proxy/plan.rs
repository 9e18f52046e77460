//! What a proxy decides about one direction of one connection: a function of the seed alone, not of how the bytes come in.

use std::time::Duration;

use shared::math::Rng;

use super::{Path, Weather};

/// Bytes that share one decision. Their place in the stream numbers them, so that it does not matter in which pieces they come.
pub(super) const BLOCK: u64 = 256;

/// The decisions for one direction of one connection.
#[derive(Debug, Clone)]
pub(super) struct Plan {
    pub(super) path: Path,
    seed: u64,
    stall_rng: Rng,
}

impl Plan {
    /// To the server, and to the client.
    pub(super) fn of_connection(weather: &Weather, number: u64) -> [Self; 2] {
        // A word of its own for each direction of each connection.
        let mut rng = Rng::new(Rng::new(weather.seed).bits() ^ number);
        [weather.to_server, weather.to_client].map(|path| {
            let seed = rng.bits();
            Self { path, seed, stall_rng: Rng::new(seed) }
        })
    }

    /// How much later than they came the bytes of a block go on.
    pub(super) fn delay_of(&self, block: u64) -> Duration {
        let share = Rng::new(self.seed ^ Rng::new(block).bits()).unit();
        self.path.delay + self.path.jitter.mul_f64(share)
    }

    /// The next stall: how long after the end of the one before it begins, and how long it lasts.
    pub(super) fn next_stall(&mut self) -> Option<(Duration, Duration)> {
        let stalls = self.path.stalls?;
        let mut about = |time: Duration| time.mul_f64(self.stall_rng.between(0.5, 1.5));
        Some((about(stalls.every), about(stalls.lasts)))
    }
}
