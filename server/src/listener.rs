//! Accepts connections, up to the host's limits: in all, and from one address.

use std::collections::HashMap;
use std::net::IpAddr;
use std::sync::{Arc, Mutex, PoisonError};
use std::time::Duration;

use tokio::net::TcpListener;
use tokio::task::JoinSet;

use crate::connection::{self, Surroundings, refusal};

/// How long to wait when the system has no socket left.
const NO_SOCKET_PAUSE: Duration = Duration::from_millis(100);
/// Connections beyond the host's limit that may be in their handshake: the room tells them that it is full.
const HANDSHAKES: usize = 64;

/// Who is connected, by address.
#[derive(Debug, Default)]
struct Census {
    by_address: HashMap<IpAddr, usize>,
    all: usize,
}

/// A connection's place among those that are allowed. Dropping it makes room.
#[derive(Debug)]
pub(crate) struct Permit {
    census: Arc<Mutex<Census>>,
    address: IpAddr,
}

impl Permit {
    fn ask(census: &Arc<Mutex<Census>>, address: IpAddr, most: usize, most_each: usize) -> Result<Self, String> {
        // Nothing panics while it is held; and a count that is off by one is no reason to end.
        let mut counts = census.lock().unwrap_or_else(PoisonError::into_inner);
        if counts.all >= most {
            return Err("the server is full; try again later".to_owned());
        }
        let here = counts.by_address.entry(address).or_default();
        if *here >= most_each {
            return Err(format!("{most_each} connections from your address are as many as this server allows"));
        }
        *here += 1;
        counts.all += 1;
        drop(counts);
        Ok(Self { census: Arc::clone(census), address })
    }
}

impl Drop for Permit {
    fn drop(&mut self) {
        let mut counts = self.census.lock().unwrap_or_else(PoisonError::into_inner);
        counts.all -= 1;
        if let Some(here) = counts.by_address.get_mut(&self.address) {
            *here -= 1;
            if *here == 0 {
                counts.by_address.remove(&self.address);
            }
        }
    }
}

/// Accepts until it is dropped. Each connection becomes a task in `connections`.
pub(crate) async fn accept(listener: &TcpListener, around: &Surroundings, connections: &mut JoinSet<()>) {
    let census = Arc::new(Mutex::new(Census::default()));
    let config = &around.config;
    let most = config.most_connections.saturating_add(HANDSHAKES);
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
        match Permit::ask(&census, address.ip(), most, config.most_per_address) {
            Ok(permit) => {
                connections.spawn(connection::serve(stream, address, around.clone(), permit));
            }
            Err(reason) => {
                tracing::debug!(%address, "refused: {reason}");
                // One attempt, so that it costs nothing: a new socket has room for a line.
                let _ = stream.try_write(&refusal(reason));
            }
        }
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn places_are_counted_in_all_and_for_each_address_and_come_back() {
        let census = Arc::new(Mutex::new(Census::default()));
        let ask = |last| Permit::ask(&census, IpAddr::from([127, 0, 0, last]), 3, 2);
        let first = ask(1).expect("the first");
        let _second = ask(1).expect("the second");
        assert!(ask(1).expect_err("a third").contains("from your address"));
        let _other = ask(2).expect("another address");
        assert!(ask(3).expect_err("a fourth in all").contains("full"));
        drop(first);
        assert!(ask(1).is_ok());
        assert_eq!(census.lock().expect("no panic").by_address.len(), 2);
    }
}
