//! What a host decides.

use std::sync::Arc;
use std::time::Duration;

use shared::table::Table;

/// What a host decides about a server. [`Config::new`] gives the defaults.
#[derive(Debug, Clone)]
pub struct Config {
    /// The table that is played.
    pub table: Arc<Table>,
    /// The bot plays while nobody else does.
    pub attract: bool,
    /// What the bot's habits follow from.
    pub seed: u64,
    /// Most clients at once.
    pub most_connections: usize,
    /// How long a client may take to say hello.
    pub handshake_time: Duration,
    /// How long a client may say nothing; a client that is there pings.
    pub silent_time: Duration,
    /// Bytes that the system may hold for a client that takes nothing: beyond them it loses snapshots.
    pub send_buffer: usize,
    /// How long a client may take none of what is sent to it.
    pub write_time: Duration,
}

impl Config {
    /// The defaults, for `table`.
    pub fn new(table: Arc<Table>) -> Self {
        Self {
            table,
            attract: true,
            seed: 1,
            most_connections: 256,
            handshake_time: Duration::from_secs(5),
            silent_time: Duration::from_secs(15),
            send_buffer: 32 * 1024,
            write_time: Duration::from_secs(10),
        }
    }
}
