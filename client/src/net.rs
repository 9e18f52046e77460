//! The connection to a server, on a thread of its own. The frame loop only puts messages into one queue and takes them
//! from another; it never waits for a socket. Nothing of tokio is to be seen from outside.

use std::thread::JoinHandle;
use std::time::{Duration, Instant};

use bytes::Bytes;
use futures_util::{SinkExt, StreamExt};
use shared::protocol::{
    ClientMessage, FrameError, Hello, MOST_FROM_SERVER, PreambleError, ServerMessage, Welcome, decode, decode_greeting,
    encode, encode_greeting,
};
use thiserror::Error;
use tokio::net::TcpStream;
use tokio::net::tcp::{OwnedReadHalf, OwnedWriteHalf};
use tokio::sync::mpsc::{self, error::TryRecvError};
use tokio::time::timeout;
use tokio_util::codec::{FramedRead, FramedWrite, LengthDelimitedCodec};

/// How long a server may take to be reached, and then to welcome us.
const CONNECT_TIME: Duration = Duration::from_secs(5);
/// How long a server that sends sixty snapshots a second may be silent: its machine, or the way to it, is gone.
const SILENT_TIME: Duration = Duration::from_secs(5);
/// How long the last words may take.
const GOODBYE_TIME: Duration = Duration::from_millis(500);
/// Messages that may wait for the frame loop: four seconds' worth. Beyond it the server is not read any further, and
/// leaves out what a slow client misses.
const MOST_INCOMING: usize = 256;
/// Messages that may wait to be sent; a player's hands make some sixty a second.
const MOST_OUTGOING: usize = 256;

type Reader = FramedRead<OwnedReadHalf, LengthDelimitedCodec>;
type Writer = FramedWrite<OwnedWriteHalf, LengthDelimitedCodec>;

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
            Self::Frame(_) => "GARBLED MESSAGES",
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
                let _ = timeout(GOODBYE_TIME, SinkExt::<Bytes>::close(&mut writer)).await;
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
    async fn exchange(&mut self, reader: Reader, writer: &mut Writer, welcome: Welcome) -> Result<(), NetError> {
        let Self { to_loop, from_loop, epoch } = self;
        let reads = async {
            let mut reader = reader;
            // If the frame loop has hung up, the other half ends this.
            let _ = to_loop.send(Incoming::Welcome(welcome)).await;
            while let Some(frame) = timeout(SILENT_TIME, reader.next()).await.map_err(|_| NetError::Silent)? {
                let message = decode(&frame?)?;
                let at = epoch.elapsed().as_secs_f64();
                let _ = to_loop.send(Incoming::Message { at, message }).await;
            }
            Err(NetError::Closed)
        };
        let writes = async {
            while let Some(message) = from_loop.recv().await {
                match timeout(CONNECT_TIME, writer.send(Bytes::from(encode(&message)))).await {
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
async fn connect(address: String, hello: Hello) -> Result<(Reader, Writer, Welcome), NetError> {
    let stream = match timeout(CONNECT_TIME, TcpStream::connect(&address)).await {
        Ok(Ok(stream)) => stream,
        Ok(Err(error)) => return Err(NetError::Connect { address, error }),
        Err(_) => return Err(NetError::Timeout { address }),
    };
    // Without this a key press waits for the acknowledgement of the one before.
    stream.set_nodelay(true)?;
    let codec = || {
        let mut builder = LengthDelimitedCodec::builder();
        builder.length_field_type::<u32>().little_endian().max_frame_length(MOST_FROM_SERVER).new_codec()
    };
    let (read, write) = stream.into_split();
    let mut reader = FramedRead::new(read, codec());
    let mut writer = FramedWrite::new(write, codec());
    let greeting = async {
        writer.send(Bytes::from(encode_greeting(&hello))).await?;
        let frame = reader.next().await.ok_or(NetError::Closed)??;
        match decode_greeting(&frame)? {
            ServerMessage::Welcome(welcome) => Ok(welcome),
            ServerMessage::Refused { reason } => Err(NetError::Refused(reason)),
            _ => Err(NetError::NoGreeting),
        }
    };
    match timeout(CONNECT_TIME, greeting).await {
        Ok(Ok(welcome)) => Ok((reader, writer, welcome)),
        Ok(Err(error)) => Err(error),
        Err(_) => Err(NetError::Timeout { address }),
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use shared::protocol::{PREAMBLE_LENGTH, Role};
    use std::io::{Read, Write};
    use std::net::TcpListener;

    /// Connects to a server that answers with `answer`, and returns why the connection ended.
    fn ending(answer: &[u8]) -> String {
        let listener = TcpListener::bind("127.0.0.1:0").unwrap();
        let address = listener.local_addr().unwrap().to_string();
        let hello = Hello { name: "test".to_owned(), role: Role::Watch };
        let mut connection = Connection::open(address, hello, Instant::now()).unwrap();
        let (mut stream, _) = listener.accept().unwrap();
        let mut length = [0; 4];
        stream.read_exact(&mut length).unwrap();
        assert_eq!(u32::from_le_bytes(length) as usize, PREAMBLE_LENGTH + 6);
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

    fn framed(body: &[u8]) -> Vec<u8> {
        [&(body.len() as u32).to_le_bytes(), body].concat()
    }

    #[test]
    fn strange_servers_are_told_apart() {
        let refusal = encode_greeting(&ServerMessage::Refused { reason: "full".to_owned() });
        assert_eq!(ending(&framed(&refusal)), "the server refuses: full");
        let pong = encode_greeting(&ServerMessage::Pong { nonce: 0, tick: 0 });
        assert_eq!(ending(&framed(&pong)), "the server did not greet");
        let mut other = refusal.clone();
        other[8] ^= 0x40;
        assert!(ending(&framed(&other)).contains("protocol 65"), "{}", ending(&framed(&other)));
        assert!(ending(&framed(&refusal[..PREAMBLE_LENGTH])).contains("no message"));
        assert!(ending(b"HTTP/1.1 400 Bad Request\r\n\r\n").starts_with("the connection broke"));
        // It may also be noticed as a reset.
        assert!(ending(b"").starts_with("the "));
        let welcome = Welcome { client: 1, physics: 1, table_digest: 1, table: String::new() };
        let welcome = encode_greeting(&ServerMessage::Welcome(welcome));
        let garbage = [framed(&welcome), framed(&[200, 1, 2])].concat();
        assert!(ending(&garbage).contains("no message"));
    }

    #[test]
    fn a_refused_connection_says_where() {
        let address = TcpListener::bind("127.0.0.1:0").unwrap().local_addr().unwrap().to_string();
        let hello = Hello { name: "test".to_owned(), role: Role::Watch };
        let mut connection = Connection::open(address.clone(), hello, Instant::now()).unwrap();
        assert!(wait_for_end(&mut connection).starts_with(&format!("cannot connect to {address}: ")));
    }

    #[test]
    fn hanging_up_does_not_wait_for_a_silent_server() {
        let listener = TcpListener::bind("127.0.0.1:0").unwrap();
        let address = listener.local_addr().unwrap().to_string();
        let hello = Hello { name: "test".to_owned(), role: Role::Watch };
        let connection = Connection::open(address, hello, Instant::now()).unwrap();
        let began = Instant::now();
        drop(connection);
        assert!(began.elapsed() < Duration::from_secs(2));
    }
}
