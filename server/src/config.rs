//! What a host decides.

use std::sync::Arc;
use std::time::Duration;

use shared::game::SEATS;
use shared::protocol::{MOST_FROM_CLIENT, MOST_NAME, Mode};
use shared::table::Table;

/// What a host decides about a server. [`Config::new`] gives the defaults.
#[derive(Debug, Clone)]
pub struct Config {
    /// The table that is played.
    pub table: Arc<Table>,
    /// The room's name.
    pub room: String,
    /// How it is played.
    pub mode: Mode,
    /// Places for players, 1 to [`SEATS`]: seats that alternate, or boards side by side.
    pub places: usize,
    /// The bot plays while nobody else does, and against whoever is alone in a room with a board for each.
    pub attract: bool,
    /// Players may let the room stand still, for everybody: for a table of one's own.
    pub pause: bool,
    /// What the bot's habits follow from.
    pub seed: u64,
    /// Most clients at once.
    pub most_connections: usize,
    /// Most connections from one address at once.
    pub most_per_address: usize,
    /// Most messages of one client in a second; twice as many may come in a burst.
    pub most_messages: u32,
    /// Largest frame of a client, bytes: at most [`MOST_FROM_CLIENT`].
    pub most_frame: usize,
    /// Longest name of a client, characters: at most what [`shared::protocol::check_name`] allows.
    pub most_name: usize,
    /// How long a client may take to say hello.
    pub handshake_time: Duration,
    /// How long a client may say nothing; a client that is there pings.
    pub silent_time: Duration,
    /// How long a player may leave the controls alone before the turn is lost.
    pub idle_time: Duration,
    /// How long votes of the crowd are collected.
    pub vote_time: Duration,
    /// Bytes that the system may hold for a client that takes nothing: beyond them it falls behind.
    pub send_buffer: usize,
    /// How long a client may take none of what is sent to it.
    pub write_time: Duration,
}

impl Config {
    /// The defaults, for `table`.
    pub fn new(table: Arc<Table>) -> Self {
        Self {
            table,
            room: "main".to_owned(),
            mode: Mode::Challenge,
            places: SEATS,
            attract: true,
            pause: false,
            seed: 1,
            most_connections: 256,
            most_per_address: 64,
            most_messages: 250,
            most_frame: MOST_FROM_CLIENT,
            most_name: MOST_NAME,
            handshake_time: Duration::from_secs(5),
            silent_time: Duration::from_secs(15),
            idle_time: Duration::from_secs(30),
            vote_time: Duration::from_secs(5),
            send_buffer: 32 * 1024,
            write_time: Duration::from_secs(10),
        }
    }

    /// With that mode, and the places that suit it: one against the crowd, two head to head.
    #[must_use]
    pub fn mode(mut self, mode: Mode) -> Self {
        self.mode = mode;
        self.places = match mode {
            Mode::Challenge => SEATS,
            Mode::Crowd => 1,
            Mode::HeadToHead => 2,
        };
        self
    }
}
