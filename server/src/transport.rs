//! The way out to one client: whatever carries frames, the broadcast writes through this one interface.

use std::io::{self, IoSlice};

use socket2::SockRef;
use tokio::net::tcp::OwnedWriteHalf;

/// A way out that never makes its writer wait.
pub(crate) trait Outgoing: Send {
    /// Takes as many of the bytes as it has room for, and says how many.
    ///
    /// # Errors
    /// `WouldBlock` if it has no room; anything else means that it is of no use any more.
    fn try_write(&mut self, bytes: &[IoSlice<'_>]) -> io::Result<usize>;
}

/// Plain TCP. Straight to the system: the runtime would look up first whether it has heard of room, which costs more than a
/// refusal now and then.
impl Outgoing for OwnedWriteHalf {
    fn try_write(&mut self, bytes: &[IoSlice<'_>]) -> io::Result<usize> {
        let socket = SockRef::from(self.as_ref());
        match bytes {
            // Most of the time; the system takes one row of bytes faster than a list of one.
            [one] => socket.send(one),
            more => socket.send_vectored(more),
        }
    }
}
