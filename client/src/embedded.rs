//! The server that the native game brings along: one table on this machine, for this machine or for others, too.

use std::net::{Ipv4Addr, SocketAddr, TcpListener};
use std::sync::Arc;
use std::thread::JoinHandle;

use shared::protocol::Mode;
use shared::table::Table;
use starball_server::{Account, Config, ServerError};
use thiserror::Error;
use tokio::sync::oneshot;

/// The port of a server that was not told another.
pub(crate) const USUAL_PORT: u16 = 7777;

/// Why there is no embedded server.
#[derive(Debug, Error)]
pub(crate) enum EmbeddedError {
    /// No socket, thread or runtime for it.
    #[error("the game's own server cannot be started: {0}")]
    Start(#[from] std::io::Error),
    /// It ended with an error.
    #[error("the game's own server failed: {0}")]
    Failed(#[from] ServerError),
}

/// A server on a thread of this process. Ends when it is dropped.
#[derive(Debug)]
pub(crate) struct Embedded {
    /// With the address of this machine, as it is reached from here.
    address: SocketAddr,
    /// As others would type it.
    address_for_others: String,
    stop: Option<oneshot::Sender<()>>,
    thread: Option<JoinHandle<Result<Account, ServerError>>>,
}

impl Embedded {
    /// Starts a server for `table`: without a mode on a free port that only this machine reaches, with one on
    /// [`USUAL_PORT`], if that is free, and for everybody.
    ///
    /// # Errors
    /// If there is no socket, thread or runtime for it.
    pub(crate) fn start(table: Arc<Table>, mode: Option<Mode>) -> Result<Self, EmbeddedError> {
        let (listener, config) = match mode {
            None => (TcpListener::bind((Ipv4Addr::LOCALHOST, 0))?, Config { pause: true, ..Config::new(table) }),
            Some(mode) => {
                let everywhere = |port| TcpListener::bind((Ipv4Addr::UNSPECIFIED, port));
                // On some systems both can be had: whoever listens for this machine alone would be reached instead.
                let usual = TcpListener::bind((Ipv4Addr::LOCALHOST, USUAL_PORT)).map(drop);
                (usual.and_then(|()| everywhere(USUAL_PORT)).or_else(|_| everywhere(0))?, Config::new(table).mode(mode))
            }
        };
        listener.set_nonblocking(true)?;
        let address = SocketAddr::from((Ipv4Addr::LOCALHOST, listener.local_addr()?.port()));
        // One worker: the window's thread and the network's thread want processors too.
        let runtime = tokio::runtime::Builder::new_multi_thread().worker_threads(1).enable_all().build()?;
        let (stop, stopped) = oneshot::channel();
        let listener = {
            let _within = runtime.enter();
            tokio::net::TcpListener::from_std(listener)?
        };
        let thread = std::thread::Builder::new().name("server".to_owned()).spawn(move || {
            // Told to stop, or dropped without a word: the same.
            let shutdown = async { drop(stopped.await) };
            runtime.block_on(starball_server::run(listener, config, shutdown))
        })?;
        let address_for_others = format!("{}:{}", own_address(), address.port());
        Ok(Self { address, address_for_others, stop: Some(stop), thread: Some(thread) })
    }

    /// Where it listens.
    pub(crate) fn address(&self) -> SocketAddr {
        self.address
    }

    /// Where others reach it, as they would type it.
    pub(crate) fn address_for_others(&self) -> &str {
        &self.address_for_others
    }

    /// Ends it without making anybody wait for that.
    pub(crate) fn retire(self) {
        std::thread::spawn(move || drop(self));
    }

    /// Whether it still runs.
    pub(crate) fn is_alive(&self) -> bool {
        self.thread.as_ref().is_some_and(|thread| !thread.is_finished())
    }
}

impl Drop for Embedded {
    fn drop(&mut self) {
        self.stop = None;
        match self.thread.take().map(JoinHandle::join) {
            Some(Ok(Ok(account))) => tracing::debug!("{account}"),
            Some(Ok(Err(error))) => tracing::warn!("{error}"),
            Some(Err(_)) => tracing::warn!("the server's thread failed"),
            None => {}
        }
    }
}

/// This machine's address as others see it, or a word that stands for it. Connecting a UDP socket sends nothing; it
/// only finds out which way out there is.
pub(crate) fn own_address() -> String {
    let address = std::net::UdpSocket::bind("0.0.0.0:0").and_then(|socket| {
        socket.connect("192.0.2.1:9")?;
        socket.local_addr()
    });
    address.map_or_else(|_| "HOST".to_owned(), |address| address.ip().to_string())
}

/// Serves `table` until Ctrl-C, with nobody but the bot at it; `ready` learns the address.
///
/// # Errors
/// If the server cannot be started, or fails.
pub(crate) fn serve_alone(table: Arc<Table>, ready: impl FnOnce(SocketAddr)) -> Result<Account, EmbeddedError> {
    let runtime = tokio::runtime::Runtime::new()?;
    runtime.block_on(async {
        let listener = tokio::net::TcpListener::bind((Ipv4Addr::LOCALHOST, 0)).await?;
        ready(listener.local_addr()?);
        let shutdown = async {
            // Without a handler the process simply ends at Ctrl-C.
            if tokio::signal::ctrl_c().await.is_err() {
                std::future::pending::<()>().await;
            }
        };
        Ok(starball_server::run(listener, Config::new(table), shutdown).await?)
    })
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn runs_until_dropped() {
        let table = Arc::new(Table::shipped("classic").unwrap().unwrap());
        let embedded = Embedded::start(table, None).unwrap();
        assert!(embedded.is_alive() && embedded.address().ip().is_loopback());
        let address = embedded.address();
        drop(std::net::TcpStream::connect(address).unwrap());
        drop(embedded);
        assert!(std::net::TcpStream::connect(address).is_err());
    }
}
