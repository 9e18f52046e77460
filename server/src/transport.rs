//! The way out to one client: whatever carries frames, the broadcast writes through this one interface.

use std::io::{self, IoSlice};

use tokio::net::tcp::OwnedWriteHalf;

/// A way out that never makes its writer wait.
pub(crate) trait Outgoing: Send {
    /// Takes as many of the bytes as it has room for, and says how many.
    ///
    /// # Errors
    /// `WouldBlock` if it has no room; anything else means that it is of no use any more.
    fn try_write(&mut self, bytes: &[IoSlice<'_>]) -> io::Result<usize>;
}

/// Plain TCP.
impl Outgoing for OwnedWriteHalf {
    fn try_write(&mut self, bytes: &[IoSlice<'_>]) -> io::Result<usize> {
        match bytes {
            // Most of the time; the system takes one row of bytes faster than a list of one.
            [one] => OwnedWriteHalf::try_write(self, one),
            more => self.try_write_vectored(more),
        }
    }
}
