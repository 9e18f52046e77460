//! The way out to one client: whatever carries frames, the broadcast writes through this one interface.

use std::io::{self, IoSlice};
use std::sync::Arc;

use socket2::SockRef;
use tokio::net::tcp::OwnedWriteHalf;

use crate::listener::Permit;

/// A way out that never makes its writer wait.
pub(crate) trait Outgoing: Send {
    /// Takes as many of the bytes as it has room for, and says how many.
    ///
    /// # Errors
    /// `WouldBlock` if it has no room; anything else means that it is of no use any more.
    fn try_write(&mut self, bytes: &[IoSlice<'_>]) -> io::Result<usize>;
}

/// Plain TCP. Its place among the connections that are allowed is taken for as long as there is a way out.
pub(crate) struct Tcp {
    pub(crate) write: OwnedWriteHalf,
    pub(crate) _permit: Arc<Permit>,
}

/// Straight to the system: the runtime would look up first whether it has heard of room, which costs more than a refusal now
/// and then.
impl Outgoing for Tcp {
    fn try_write(&mut self, bytes: &[IoSlice<'_>]) -> io::Result<usize> {
        let socket = SockRef::from(self.write.as_ref());
        match bytes {
            // Most of the time; the system takes one row of bytes faster than a list of one.
            [one] => socket.send(one),
            more => socket.send_vectored(more),
        }
    }
}
