//! The authoritative server: steps the world at a fixed rate and streams it to players and spectators over TCP.
//!
//! [`run`] gets a bound listener, a configuration and a future that ends it; tests use port 0. Inside:
//! `listener` accepts, `connection` carries the frames of one client, `room` owns the game and everything that may
//! change it, `lobby` knows who sits where.

mod account;
mod config;
mod connection;
pub mod games;
mod listener;
mod lobby;
pub mod measure;
mod pacing;
pub mod picture;
mod room;
pub mod seeds;
mod session;
pub mod simulate;
mod tables;

use std::future::Future;
use std::sync::Arc;
use std::time::Duration;

use shared::table::Accuracy;
use thiserror::Error;
use tokio::net::TcpListener;
use tokio::sync::{broadcast, mpsc};
use tokio::task::JoinSet;

pub use account::Account;
pub use config::Config;
pub use session::{SessionState, is_legal};
pub use tables::{load_table, load_text, read_table};

/// Shared frames that a slow client may be behind before it loses some: one second's.
const FRAMES_BEHIND: usize = 64;
/// Commands that wait for the room's next tick; beyond it, connections wait.
const COMMANDS_WAITING: usize = 1024;
/// How long connections may take to say goodbye.
const GOODBYE_TIME: Duration = Duration::from_secs(2);

/// Why a server ended early.
#[derive(Debug, Error)]
pub enum ServerError {
    /// The room's task failed: a bug.
    #[error("the room ended unexpectedly: {0}")]
    Room(#[from] tokio::task::JoinError),
    /// The table still asks for an accuracy. Clients would refuse it: each might choose differently.
    #[error(
        "the table asks for {0}, and motion model and tick rate have not been chosen: it must be resolved to be served"
    )]
    Unresolved(Accuracy),
}

/// Serves until `shutdown` is ready, then tells the clients, and returns an account of what happened.
///
/// # Errors
/// If the table is not resolved, or the room's task fails.
pub async fn run(
    listener: TcpListener,
    config: Config,
    shutdown: impl Future<Output = ()> + Send + 'static,
) -> Result<Account, ServerError> {
    if let Some(asked) = config.table.accuracy {
        return Err(ServerError::Unresolved(asked));
    }
    let (frames, _) = broadcast::channel(FRAMES_BEHIND);
    let (commands, waiting) = mpsc::channel(COMMANDS_WAITING);
    let config = Arc::new(config);
    let (stop, stopped) = tokio::sync::oneshot::channel();
    let mut room = tokio::spawn(room::Room::new(Arc::clone(&config), frames.clone()).run(waiting, stopped));

    let mut connections = JoinSet::new();
    tokio::select! {
        () = listener::accept(&listener, &config, &frames, &commands, &mut connections) => {}
        () = shutdown => {}
        // Only if it fails: a server without a room must not go on.
        ended = &mut room => return Ok(ended?),
    }
    // The room says goodbye to all; with the last sender of frames gone, connections end by themselves.
    drop(stop);
    drop(commands);
    let account = room.await?;
    drop(frames);
    let all_ended = async { while connections.join_next().await.is_some() {} };
    if tokio::time::timeout(GOODBYE_TIME, all_ended).await.is_err() {
        tracing::warn!("some clients did not take the goodbye in time");
    }
    Ok(account)
}

#[cfg(test)]
mod tests {
    use std::future::pending;

    use shared::table::Table;

    use super::*;

    #[tokio::test]
    async fn a_table_that_is_not_resolved_is_not_served() {
        let classic = load_table("classic").expect("it is shipped");
        let source = classic.source.replacen("name:", "accuracy: (tolerance: 0.0001, horizon: Seconds(3.0)), name:", 1);
        let asking = Arc::new(Table::parse("asking.ron", &source).expect("it may ask"));
        let listener = TcpListener::bind("127.0.0.1:0").await.expect("a port is free");
        let refused = run(listener, Config::new(asking), pending()).await.expect_err("clients would refuse it");
        assert!(refused.to_string().contains("asks for 0.1 mm over 3 s"), "{refused}");
    }
}
