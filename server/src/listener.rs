//! Accepts connections, up to the host's limits: in all, and from one address.

use std::collections::HashMap;
use std::io;
use std::net::{IpAddr, Ipv6Addr, Shutdown};
use std::sync::{Arc, Mutex, PoisonError};
use std::time::Duration;

use socket2::SockRef;
use tokio::io::AsyncReadExt as _;
use tokio::net::{TcpListener, TcpStream};
use tokio::sync::{OwnedSemaphorePermit, Semaphore};
use tokio::task::{JoinError, JoinSet};

use crate::connection::{self, LINGER_TIME, Surroundings, refusal};

/// How long to wait when the system has no socket left.
const NO_SOCKET_PAUSE: Duration = Duration::from_millis(100);
/// Connections beyond the host's limit that may be in their handshake: the room tells them that it is full.
const HANDSHAKES: usize = 64;
/// Refused connections that are seen out at the same time; others are cut off.
const REFUSALS: usize = 64;

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
        let address = subscriber_of(address);
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
    let refusals = Arc::new(Semaphore::new(REFUSALS));
    let config = &around.config;
    let most = config.most_connections.saturating_add(HANDSHAKES);
    loop {
        let (stream, address) = match listener.accept().await {
            Ok(accepted) => accepted,
            Err(error) if is_of_one_connection(&error) => {
                tracing::debug!("a connection was gone before it was accepted: {error}");
                continue;
            }
            Err(error) => {
                tracing::warn!("cannot accept a connection: {error}");
                tokio::time::sleep(NO_SOCKET_PAUSE).await;
                continue;
            }
        };
        while let Some(ended) = connections.try_join_next() {
            note_end(ended);
        }
        match Permit::ask(&census, address.ip(), most, config.most_per_address) {
            Ok(permit) => {
                connections.spawn(connection::serve(stream, address, around.clone(), permit));
            }
            Err(reason) => {
                tracing::debug!(%address, "refused: {reason}");
                // One attempt, straight to the system: a new socket has room for a line.
                let _ = SockRef::from(&stream).send(&refusal(reason));
                // Closed with a hello unread the refusal would be lost; but nobody can make the server keep many.
                if let Ok(slot) = Arc::clone(&refusals).try_acquire_owned() {
                    connections.spawn(see_out(stream, slot));
                }
            }
        }
    }
}

/// Reads what a refused client has sent, until it hangs up or a moment is over.
async fn see_out(mut stream: TcpStream, _slot: OwnedSemaphorePermit) {
    let _ = SockRef::from(&stream).shutdown(Shutdown::Write);
    let mut nothing = [0; 1024];
    let all = async { while matches!(stream.read(&mut nothing).await, Ok(1..)) {} };
    // Its end is as good as the time's.
    let _ = tokio::time::timeout(LINGER_TIME, all).await;
}

/// Whether only one connection is lost, and not the listener's means to accept others.
fn is_of_one_connection(error: &io::Error) -> bool {
    use io::ErrorKind::{
        ConnectionAborted, ConnectionRefused, ConnectionReset, HostUnreachable, Interrupted, NetworkDown,
        NetworkUnreachable, PermissionDenied, TimedOut,
    };
    matches!(
        error.kind(),
        ConnectionAborted
            | ConnectionRefused
            | ConnectionReset
            | HostUnreachable
            | Interrupted
            | NetworkDown
            | NetworkUnreachable
            | PermissionDenied
            | TimedOut
    )
}

/// A connection's task has ended; if by a panic, that is a bug which must not pass in silence.
pub(crate) fn note_end(ended: Result<(), JoinError>) {
    if let Err(error) = ended
        && error.is_panic()
    {
        tracing::error!("a connection's task failed: {error}");
    }
}

/// Whom an address belongs to, as far as one can tell: an IPv6 network of 64 bits is one subscriber's, who has as many
/// addresses in it as they like; an IPv4 address is itself, however it is written.
fn subscriber_of(address: IpAddr) -> IpAddr {
    match address.to_canonical() {
        IpAddr::V4(four) => IpAddr::V4(four),
        IpAddr::V6(six) => IpAddr::V6(Ipv6Addr::from_bits(six.to_bits() & (u128::MAX << 64))),
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

    #[test]
    fn an_address_is_counted_for_whoever_owns_it() {
        let same = |one: &str, other: &str| {
            let [one, other] = [one, other].map(|text| subscriber_of(text.parse().expect("an address")));
            one == other
        };
        assert!(same("2001:db8:1:2::1", "2001:db8:1:2:ffff::9"));
        assert!(!same("2001:db8:1:2::1", "2001:db8:1:3::1"));
        assert!(same("::ffff:192.0.2.7", "192.0.2.7"), "IPv4 through an IPv6 socket");
        assert!(!same("192.0.2.7", "192.0.2.8"));
    }

    #[test]
    fn only_a_lack_of_sockets_makes_the_listener_wait() {
        for kind in [io::ErrorKind::ConnectionAborted, io::ErrorKind::ConnectionReset] {
            assert!(is_of_one_connection(&kind.into()));
        }
        // No file descriptor left, in the process or in the system; no memory.
        for code in [24, 23, 12] {
            assert!(!is_of_one_connection(&io::Error::from_raw_os_error(code)), "{code}");
        }
    }
}
