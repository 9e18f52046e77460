//! What connections ask of the room, and the queue in which it waits. The room is a thread that sleeps until its next tick
//! or the next command, so the queue is the standard library's; a connection that finds it full waits a moment.

use std::sync::mpsc::{Receiver, SyncSender, TrySendError, sync_channel};
use std::time::Duration;

use shared::protocol::{ClientMessage, Hello};
use tokio::sync::{oneshot, watch};

use crate::transport::Outgoing;

/// Commands that may wait; beyond them connections do.
const MOST_WAITING: usize = 1024;
/// How long a connection waits before it tries again.
const PAUSE: Duration = Duration::from_millis(1);

/// What connections ask of the room.
pub(crate) enum Command {
    /// A client said hello.
    Join {
        /// Checked.
        hello: Hello,
        /// The way out to it.
        transport: Box<dyn Outgoing>,
        /// Told when nothing more is said to it, and why.
        ended: oneshot::Sender<String>,
        /// Who it is now; `None` if it is not let in, which it is told.
        reply: oneshot::Sender<Option<u32>>,
    },
    /// A client said something.
    Message {
        /// Which.
        client: u32,
        /// What.
        message: ClientMessage,
    },
    /// A client said something that nobody understands, or nothing.
    Expel {
        /// Which.
        client: u32,
        /// What it is told.
        reason: String,
    },
    /// A client is gone.
    Left {
        /// Which.
        client: u32,
    },
    /// The server ends.
    Stop,
}

/// The way to a room.
#[derive(Clone)]
pub(crate) struct Commands {
    queue: SyncSender<Command>,
    /// Whether the room still hears.
    open: watch::Receiver<()>,
}

/// The room's end of it: it closes when this is dropped.
pub(crate) struct Heard {
    pub(crate) queue: Receiver<Command>,
    _open: watch::Sender<()>,
}

/// A queue of commands.
pub(crate) fn queue() -> (Commands, Heard) {
    let ((sender, receiver), (open, watched)) = (sync_channel(MOST_WAITING), watch::channel(()));
    (Commands { queue: sender, open: watched }, Heard { queue: receiver, _open: open })
}

impl Commands {
    /// Hands a command over. If the room has ended, it is dropped: there is nobody whom it could matter to.
    pub(crate) async fn send(&self, mut command: Command) {
        while let Err(TrySendError::Full(same)) = self.queue.try_send(command) {
            command = same;
            tokio::time::sleep(PAUSE).await;
        }
    }

    /// Lets the room know that a client is gone, whatever its connection ended of: it may be unwinding.
    pub(crate) fn send_left(&self, client: u32) {
        if let Err(TrySendError::Full(left)) = self.queue.try_send(Command::Left { client }) {
            let commands = self.clone();
            tokio::spawn(async move { commands.send(left).await });
        }
    }

    /// Ready when the room has ended.
    pub(crate) async fn closed(&self) {
        let mut open = self.open.clone();
        // Nothing is ever sent: it changes when the sender is gone.
        while open.changed().await.is_ok() {}
    }
}
