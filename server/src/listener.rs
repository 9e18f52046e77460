//! Accepts connections, up to the host's limit.

use std::sync::Arc;
use std::time::Duration;

use bytes::Bytes;
use tokio::net::TcpListener;
use tokio::sync::{broadcast, mpsc};
use tokio::task::JoinSet;

use crate::config::Config;
use crate::connection;
use crate::room::Command;

/// How long to wait when the system has no socket left.
const NO_SOCKET_PAUSE: Duration = Duration::from_millis(100);

/// Accepts until it is dropped. Each connection becomes a task in `connections`.
pub(crate) async fn accept(
    listener: &TcpListener,
    config: &Arc<Config>,
    frames: &broadcast::Sender<Bytes>,
    commands: &mpsc::Sender<Command>,
    connections: &mut JoinSet<()>,
) {
    loop {
        let (stream, address) = match listener.accept().await {
            Ok(accepted) => accepted,
            Err(error) => {
                tracing::warn!("cannot accept a connection: {error}");
                tokio::time::sleep(NO_SOCKET_PAUSE).await;
                continue;
            }
        };
        while connections.try_join_next().is_some() {}
        // The room knows who is let in; but who has not said hello yet takes a socket too.
        if connections.len() < config.most_connections.saturating_mul(2) {
            let (config, frames, commands) = (Arc::clone(config), frames.clone(), commands.clone());
            connections.spawn(connection::serve(stream, address, config, frames, commands));
        }
    }
}
