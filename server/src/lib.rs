//! The authoritative server: steps the world at a fixed rate and streams it to players and spectators over TCP.
//!
//! [`run`] gets a bound listener, a configuration and a future that ends it; tests use port 0. Inside:
//! `listener` accepts, `connection` reads what one client says, `room` owns the games and everything that may change them
//! (`lobby` knows who sits where, `votes` what the crowd wants), `streams` makes frames of what happened, `broadcast` writes
//! them to everybody.

#![forbid(unsafe_code)]

mod account;
mod broadcast;
mod chatter;
mod commands;
mod config;
mod connection;
pub mod games;
mod lateness;
mod listener;
mod lobby;
pub mod measure;
mod pacing;
pub mod picture;
mod room;
pub mod seeds;
mod session;
pub mod simulate;
mod streams;
mod tables;
mod transport;
mod votes;

use std::future::Future;
use std::sync::Arc;
use std::sync::atomic::AtomicU64;
use std::time::Duration;

use shared::table::Accuracy;
use thiserror::Error;
use tokio::net::TcpListener;
use tokio::sync::mpsc;
use tokio::task::JoinSet;

pub use account::Account;
pub use config::Config;
pub use lateness::Lateness;
pub use session::{SessionState, is_legal};
pub use tables::{load_table, load_text, read_table};

use broadcast::{Broadcast, Patience};
use chatter::Chatter;
use commands::Command;
use connection::{LINGER_TIME, Surroundings};
use listener::note_end;
use pacing::NextWake;

/// How long connections may take to say goodbye.
const GOODBYE_TIME: Duration = Duration::from_secs(2);
/// What a busy machine may take besides to end them.
const SLACK: Duration = Duration::from_millis(500);

/// Why a server ended early.
#[derive(Debug, Error)]
pub enum ServerError {
    /// The room's task failed: a bug.
    #[error("the room ended unexpectedly: {0}")]
    Room(#[from] tokio::task::JoinError),
    /// The fan-out's task failed: a bug.
    #[error("the broadcast ended unexpectedly")]
    Broadcast,
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
    let config = Arc::new(config);
    let (commands, heard) = commands::queue();
    let (orders, ordered) = mpsc::unbounded_channel();
    let tick = Arc::new(AtomicU64::new(0));
    let next_wake = Arc::new(NextWake::default());
    let patience = Patience { write_time: config.write_time, goodbye_time: GOODBYE_TIME };
    let mut broadcast = tokio::spawn(Broadcast::new(patience, Arc::clone(&next_wake)).run(ordered));
    let room = room::Room::new(Arc::clone(&config), orders.clone(), Arc::clone(&tick));
    let mut room = tokio::task::spawn_blocking(move || room.run(&heard, &next_wake));
    let around = Surroundings { config, commands, orders, tick, chatter: Arc::new(Chatter::new("connections")) };

    let mut connections = JoinSet::new();
    tokio::select! {
        () = listener::accept(&listener, &around, &mut connections) => {}
        () = shutdown => {}
        // Only if it fails: a server without a room must not go on.
        ended = &mut room => return Ok(ended?),
        _ = &mut broadcast => return Err(ServerError::Broadcast),
    }
    // The room says goodbye to all; the broadcast writes that, and with it ends every connection.
    around.commands.send(Command::Stop).await;
    let account = room.await?;
    drop(around);
    let all_ended = async {
        while let Some(ended) = connections.join_next().await {
            note_end(ended);
        }
        // It has nobody left to write to.
        drop(broadcast.await);
    };
    if tokio::time::timeout(GOODBYE_TIME + LINGER_TIME + SLACK, all_ended).await.is_err() {
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
