//! The connection to a server, on a thread of its own. The frame loop only puts messages into one queue and takes them
//! from another; it never waits for a socket. Nothing of tokio is to be seen from outside.

use std::thread::JoinHandle;
use std::time::{Duration, Instant};

use shared::protocol::{
    ClientMessage, Deframer, FrameError, FramingError, Hello, MOST_FROM_SERVER, PreambleError, ServerMessage, Welcome,
    decode_from_server, decode_welcome, encode, encode_greeting, framed,
};
use thiserror::Error;
use tokio::io::{AsyncReadExt, AsyncWriteExt};
use tokio::net::TcpStream;
use tokio::net::tcp::{OwnedReadHalf, OwnedWriteHalf};
use tokio::sync::mpsc::{self, error::TryRecvError};
use tokio::time::timeout;

/// How long a server may take to be reached, and then to welcome us.
const CONNECT_TIME: Duration = Duration::from_secs(5);
/// How long a server that sends ten frames a second or more may be silent: its machine, or the way to it, is gone.
const SILENT_TIME: Duration = Duration::from_secs(5);
/// How long the last words may take.
const GOODBYE_TIME: Duration = Duration::from_millis(500);
/// Messages that may wait for the frame loop: four seconds' worth of the fastest stream. Beyond it the server is not read any further, and
/// leaves out what a slow client misses.
const MOST_INCOMING: usize = 256;
/// Messages that may wait to be sent; a player's hands make some sixty a second.
const MOST_OUTGOING: usize = 256;

/// Bytes for which there is room whenever the socket is read.
const READ_AT_ONCE: usize = 4096;

/// The frames that come in.
struct Reader {
    socket: OwnedReadHalf,
    deframer: Deframer,
    /// Something has come at all.
    has_read: bool,
}

impl Reader {
    /// The next frame's message.
    async fn next<T>(&mut self, decode: impl FnOnce(&[u8]) -> Result<T, FrameError>) -> Result<T, NetError> {
        loop {
            if let Some(frame) = self.deframer.next_frame()? {
                return Ok(decode(frame)?);
            }
            let space = self.deframer.space();
            space.reserve(READ_AT_ONCE);
            if self.socket.read_buf(space).await? == 0 {
                return Err(NetError::Closed);
            }
            self.has_read = true;
        }
    }
}

/// Why a connection ended, or never began. For a person to read.
#[derive(Debug, Error)]
pub(crate) enum NetError {
    /// No thread or runtime for it.
    #[error("the network cannot be started: {0}")]
    Start(std::io::Error),
    /// Nobody there.
    #[error("cannot connect to {address}: {error}")]
    Connect { address: String, error: std::io::Error },
    /// Nobody answers.
    #[error("{address} does not answer as a Starball server does")]
    Timeout { address: String },
    /// The connection broke.
    #[error("the connection broke: {0}")]
    Broken(#[from] std::io::Error),
    /// Nothing came for too long.
    #[error("the server has fallen silent")]
    Silent,
    /// The server ended it without a word.
    #[error("the server closed the connection")]
    Closed,
    /// A frame is none of ours.
    #[error(transparent)]
    Frame(#[from] FrameError),
    /// What comes is no frame at all.
    #[error(transparent)]
    Framing(#[from] FramingError),
    /// The first message is neither a welcome nor a refusal.
    #[error("the server did not greet")]
    NoGreeting,
    /// The server does not want us.
    #[error("the server refuses: {0}")]
    Refused(String),
}

impl NetError {
    /// In as many words as a banner has room for.
    pub(crate) fn headline(&self) -> &str {
        match self {
            Self::Start(_) => "NO NETWORK HERE",
            Self::Connect { error, .. } if error.kind() == std::io::ErrorKind::ConnectionRefused => "NO SERVER THERE",
            Self::Connect { .. } => "CANNOT BE REACHED",
            Self::Timeout { .. } | Self::Silent => "NO ANSWER",
            Self::Broken(_) | Self::Closed => "THE SERVER IS GONE",
            Self::Frame(FrameError::Preamble(PreambleError::Foreign)) | Self::NoGreeting => "NOT A STARBALL SERVER",
            Self::Frame(FrameError::Preamble(_)) => "ANOTHER RELEASE THERE",
            Self::Frame(_) | Self::Framing(_) => "GARBLED MESSAGES",
            Self::Refused(reason) => reason,
        }
    }
}

/// What came in.
#[derive(Debug)]
pub(crate) enum Incoming {
    /// The connection stands.
    Welcome(Welcome),
    /// A message, and when it came, in seconds since the connection's epoch.
    Message { at: f64, message: ServerMessage },
    /// The connection ended. Nothing comes after.
    Ended(NetError),
}

/// A connection, or an attempt at one. Dropping it says goodbye and waits for that at most half a second.
#[derive(Debug)]
pub(crate) struct Connection {
    incoming: mpsc::Receiver<Incoming>,
    /// `None` once goodbye was said.
    outgoing: Option<mpsc::Sender<ClientMessage>>,
    thread: Option<JoinHandle<()>>,
    ended: bool,
}

impl Connection {
    /// Connects to `address` in the background; times are counted from `epoch`.
    ///
    /// # Errors
    /// If there can be no thread.
    pub(crate) fn open(address: String, hello: Hello, epoch: Instant) -> Result<Self, NetError> {
        let (to_loop, incoming) = mpsc::channel(MOST_INCOMING);
        let (outgoing, from_loop) = mpsc::channel(MOST_OUTGOING);
        let runtime = tokio::runtime::Builder::new_current_thread().enable_all().build().map_err(NetError::Start)?;
        let task = async move {
            let wire = Wire { to_loop, from_loop, epoch };
            wire.run(address, hello).await;
        };
        let thread = std::thread::Builder::new().name("network".to_owned()).spawn(move || {
            runtime.block_on(task);
            // A name that is still being looked up must not hold up the end.
            runtime.shutdown_background();
        });
        let thread = thread.map_err(NetError::Start)?;
        Ok(Self { incoming, outgoing: Some(outgoing), thread: Some(thread), ended: false })
    }

    /// What came in next, if anything did.
    pub(crate) fn poll(&mut self) -> Option<Incoming> {
        match self.incoming.try_recv() {
            Ok(incoming) => {
                self.ended |= matches!(incoming, Incoming::Ended(_));
                Some(incoming)
            }
            Err(TryRecvError::Disconnected) if !self.ended => {
                self.ended = true;
                Some(Incoming::Ended(NetError::Closed))
            }
            Err(_) => None,
        }
    }

    /// Sends a message. If too many wait already, the connection is as good as dead: the message is dropped.
    pub(crate) fn send(&self, message: ClientMessage) {
        if let Some(outgoing) = &self.outgoing
            && let Err(error) = outgoing.try_send(message)
        {
            tracing::debug!("not sent: {error}");
        }
    }
}

impl Drop for Connection {
    fn drop(&mut self) {
        // The thread ends when there is nobody left to send for; it writes what waits first.
        self.outgoing = None;
        self.incoming.close();
        if let Some(thread) = self.thread.take()
            && thread.join().is_err()
        {
            tracing::warn!("the network's thread failed");
        }
    }
}

/// The thread's side of a connection.
struct Wire {
    to_loop: mpsc::Sender<Incoming>,
    from_loop: mpsc::Receiver<ClientMessage>,
    epoch: Instant,
}

impl Wire {
    async fn run(mut self, address: String, hello: Hello) {
        let connected = tokio::select! {
            connected = connect(address, hello) => connected,
            () = self.to_loop.closed() => return,
        };
        let ended = match connected {
            Ok((reader, mut writer, welcome)) => {
                let ended = self.exchange(reader, &mut writer, welcome).await;
                // The server may be gone already.
                let _ = timeout(GOODBYE_TIME, writer.shutdown()).await;
                ended
            }
            Err(error) => Err(error),
        };
        if let Err(error) = ended {
            // The frame loop may be gone already.
            let _ = self.to_loop.send(Incoming::Ended(error)).await;
        }
    }

    /// Carries messages both ways until either side ends it; `Ok` if ours did.
    async fn exchange(
        &mut self,
        mut reader: Reader,
        writer: &mut OwnedWriteHalf,
        welcome: Welcome,
    ) -> Result<(), NetError> {
        let Self { to_loop, from_loop, epoch } = self;
        let reads = async {
            // If the frame loop has hung up, the other half ends this.
            let _ = to_loop.send(Incoming::Welcome(welcome)).await;
            loop {
                let next = timeout(SILENT_TIME, reader.next(decode_from_server));
                let message = next.await.map_err(|_| NetError::Silent)??;
                let at = epoch.elapsed().as_secs_f64();
                let _ = to_loop.send(Incoming::Message { at, message }).await;
            }
        };
        let writes = async {
            while let Some(message) = from_loop.recv().await {
                match timeout(CONNECT_TIME, writer.write_all(&framed(&encode(&message)))).await {
                    Ok(sent) => sent?,
                    Err(_) => return Err(NetError::Closed),
                }
            }
            Ok(())
        };
        tokio::select! {
            ended = reads => ended,
            ended = writes => ended,
        }
    }
}

/// Connects and greets.
async fn connect(address: String, hello: Hello) -> Result<(Reader, OwnedWriteHalf, Welcome), NetError> {
    let stream = match timeout(CONNECT_TIME, TcpStream::connect(&address)).await {
        Ok(Ok(stream)) => stream,
        Ok(Err(error)) => return Err(NetError::Connect { address, error }),
        Err(_) => return Err(NetError::Timeout { address }),
    };
    // Without this a key press waits for the acknowledgement of the one before.
    stream.set_nodelay(true)?;
    let (socket, mut writer) = stream.into_split();
    let mut reader = Reader { socket, deframer: Deframer::new(MOST_FROM_SERVER), has_read: false };
    let greeting = async {
        writer.write_all(&framed(&encode_greeting(&hello))).await?;
        match reader.next(decode_welcome).await? {
            ServerMessage::Welcome(welcome) => Ok(welcome),
            ServerMessage::Refused { reason } => Err(NetError::Refused(reason)),
            _ => Err(NetError::NoGreeting),
        }
    };
    match timeout(CONNECT_TIME, greeting).await {
        Ok(Ok(welcome)) => Ok((reader, writer, welcome)),
        // It said something, but that was no frame.
        Ok(Err(NetError::Closed | NetError::Framing(_))) if reader.has_read => Err(NetError::NoGreeting),
        Ok(Err(error)) => Err(error),
        Err(_) => Err(NetError::Timeout { address }),
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use shared::protocol::{Mode, PREAMBLE_LENGTH, Role, Stream};
    use std::io::{Read, Write};
    use std::net::TcpListener;

    /// Connects to a server that answers with `answer`, and returns why the connection ended.
    fn ending(answer: &[u8]) -> String {
        let listener = TcpListener::bind("127.0.0.1:0").unwrap();
        let address = listener.local_addr().unwrap().to_string();
        let hello = Hello { name: "test".to_owned(), role: Role::Watch, stream: Stream::SPECTATOR };
        let mut connection = Connection::open(address, hello, Instant::now()).unwrap();
        let (mut stream, _) = listener.accept().unwrap();
        let mut length = [0; 1];
        stream.read_exact(&mut length).unwrap();
        let mut hello = vec![0; usize::from(length[0])];
        stream.read_exact(&mut hello).unwrap();
        assert_eq!(hello.len(), PREAMBLE_LENGTH + 8);
        stream.write_all(answer).unwrap();
        drop(stream);
        wait_for_end(&mut connection)
    }

    fn wait_for_end(connection: &mut Connection) -> String {
        let began = Instant::now();
        loop {
            match connection.poll() {
                Some(Incoming::Ended(error)) => return error.to_string(),
                Some(Incoming::Message { .. }) => panic!("a message before the welcome"),
                _ => std::thread::sleep(Duration::from_millis(1)),
            }
            assert!(began.elapsed() < Duration::from_secs(10));
        }
    }

    #[test]
    fn strange_servers_are_told_apart() {
        let refusal = encode_greeting(&ServerMessage::Refused { reason: "full".to_owned() });
        assert_eq!(ending(&framed(&refusal)), "the server refuses: full");
        let pong = encode_greeting(&ServerMessage::Pong { nonce: 0, tick: 0 });
        assert_eq!(ending(&framed(&pong)), "the server did not greet");
        let mut other = refusal.clone();
        other[8] ^= 0x40;
        assert!(ending(&framed(&other)).contains("protocol 66"), "{}", ending(&framed(&other)));
        assert!(ending(&framed(&refusal[..PREAMBLE_LENGTH])).contains("no message"));
        assert_eq!(ending(b"HTTP/1.1 400 Bad Request\r\n\r\n"), "the server did not greet");
        assert_eq!(ending(&[0xff; 8]), "the server did not greet");
        // It may also be noticed as a reset.
        assert!(ending(b"").starts_with("the "));
        let (room, table) = ("main".to_owned(), String::new());
        let welcome = Welcome { room, mode: Mode::Challenge, places: 4, physics: 1, table_digest: 1, table };
        let welcome = encode_greeting(&ServerMessage::Welcome(welcome));
        let garbage = [framed(&welcome), framed(&[100, 1, 2])].concat();
        assert!(ending(&garbage).contains("no message"));
        let endless = [&framed(&welcome)[..], &[0xff; 3]].concat();
        assert!(ending(&endless).contains("length"));
    }

    #[test]
    fn a_refused_connection_says_where() {
        let address = TcpListener::bind("127.0.0.1:0").unwrap().local_addr().unwrap().to_string();
        let hello = Hello { name: "test".to_owned(), role: Role::Watch, stream: Stream::SPECTATOR };
        let mut connection = Connection::open(address.clone(), hello, Instant::now()).unwrap();
        assert!(wait_for_end(&mut connection).starts_with(&format!("cannot connect to {address}: ")));
    }

    #[test]
    fn hanging_up_does_not_wait_for_a_silent_server() {
        let listener = TcpListener::bind("127.0.0.1:0").unwrap();
        let address = listener.local_addr().unwrap().to_string();
        let hello = Hello { name: "test".to_owned(), role: Role::Watch, stream: Stream::SPECTATOR };
        let connection = Connection::open(address, hello, Instant::now()).unwrap();
        let began = Instant::now();
        drop(connection);
        assert!(began.elapsed() < Duration::from_secs(2));
    }
}
