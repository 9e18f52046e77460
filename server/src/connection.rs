//! One client's connection: handshake, then its messages to the room until either side ends it. What is said to it goes
//! through the broadcast, which gets the way out.

use std::net::SocketAddr;
use std::sync::Arc;
use std::sync::atomic::{AtomicU64, Ordering};
use std::time::Duration;

use bytes::Bytes;
use shared::protocol::{
    ClientMessage, Deframer, Hello, ServerMessage, check_name, decode, decode_greeting, encode_greeting, framed,
};
use socket2::SockRef;
use tokio::io::{AsyncReadExt as _, AsyncWriteExt as _};
use tokio::net::TcpStream;
use tokio::net::tcp::{OwnedReadHalf, OwnedWriteHalf};
use tokio::sync::oneshot;
use tokio::time::{Instant, timeout};

use crate::broadcast::{Order, Orders};
use crate::chatter::Chatter;
use crate::commands::{Command, Commands};
use crate::config::Config;
use crate::listener::Permit;
use crate::streams::wire;
use crate::transport::Tcp;

/// How long a connection that is over may still send, so that its last word arrives.
pub(crate) const LINGER_TIME: Duration = Duration::from_secs(1);

/// Pings that are answered in a second.
const MOST_PINGS: u32 = 20;

/// What every connection needs of the server.
#[derive(Clone)]
pub(crate) struct Surroundings {
    pub(crate) config: Arc<Config>,
    pub(crate) commands: Commands,
    pub(crate) orders: Orders,
    /// The tick that the room plays next.
    pub(crate) tick: Arc<AtomicU64>,
    pub(crate) chatter: Arc<Chatter>,
}

/// Serves one connection to its end.
pub(crate) async fn serve(stream: TcpStream, address: SocketAddr, around: Surroundings, permit: Permit) {
    let config = Arc::clone(&around.config);
    set_options(&stream, address, &config);
    let (read, write) = stream.into_split();
    let permit = Arc::new(permit);
    let mut reader = Reader { read, deframer: Deframer::new(config.most_frame) };

    let hello = tokio::select! {
        hello = greet(&mut reader, config.most_name) => hello,
        () = tokio::time::sleep(config.handshake_time) => Err("no hello came in time".to_owned()),
        () = around.commands.closed() => Err("the server ends".to_owned()),
    };
    let hello = match hello {
        Ok(hello) => hello,
        Err(reason) => return refuse(write, reader, &around, address, reason).await,
    };
    let name = hello.name.clone();
    let (reply, joined) = oneshot::channel();
    let (ended, end) = oneshot::channel();
    let transport = Box::new(Tcp { write, _permit: Arc::clone(&permit) });
    let join = Command::Join { hello, transport, ended, reply };
    around.commands.send(join).await;
    // Without an answer the room has ended; a room that is full has the way out and says so itself.
    let Ok(Some(client)) = joined.await else { return reader.linger().await };
    let departure = Departure { commands: around.commands.clone(), client };
    if around.chatter.may_speak() {
        tracing::info!(client, %address, name, "joined");
    }
    let reason = tokio::select! {
        reason = read_messages(&mut reader, &around, client) => reason,
        reason = end => reason.unwrap_or_else(|_| "the server ends".to_owned()),
    };
    if around.chatter.may_speak() {
        tracing::info!(client, name, "left: {reason}");
    }
    drop(departure);
    reader.linger().await;
}

/// Lets the room know that a client is gone when it is dropped: even if its connection's task panics, its place falls free.
struct Departure {
    commands: Commands,
    client: u32,
}

impl Drop for Departure {
    fn drop(&mut self) {
        self.commands.send_left(self.client);
    }
}

fn set_options(stream: &TcpStream, address: SocketAddr, config: &Config) {
    let socket = SockRef::from(stream);
    let options = [
        // Without this a small frame waits for the acknowledgement of the one before.
        ("TCP_NODELAY", stream.set_nodelay(true)),
        // With the system's own buffers a stalled client would fall minutes behind before anybody noticed.
        ("SO_SNDBUF", socket.set_send_buffer_size(config.send_buffer)),
        #[cfg(any(target_os = "linux", target_os = "android"))]
        // A peer whose machine is gone acknowledges nothing.
        ("TCP_USER_TIMEOUT", socket.set_tcp_user_timeout(Some(config.write_time))),
    ];
    for (name, outcome) in options {
        if let Err(error) = outcome {
            tracing::debug!(%address, "no {name}: {error}");
        }
    }
}

/// Frames that come in.
struct Reader {
    read: OwnedReadHalf,
    deframer: Deframer,
}

impl Reader {
    /// The next frame through `decode`; `None` at the end of the connection.
    async fn next<T>(&mut self, decode: impl Fn(&[u8]) -> Result<T, String>) -> Option<Result<T, String>> {
        loop {
            match self.deframer.next_frame() {
                Ok(Some(frame)) => return Some(decode(frame)),
                Ok(None) => {}
                Err(error) => return Some(Err(error.to_string())),
            }
            match self.read.read_buf(self.deframer.space()).await {
                // A connection that breaks is one that ends: that is no offence.
                Ok(0) | Err(_) => return None,
                Ok(_) => {}
            }
        }
    }
}

impl Reader {
    /// Reads to the end of the connection, for nothing.
    async fn discard(&mut self) {
        let mut nothing = [0; 1024];
        while matches!(self.read.read(&mut nothing).await, Ok(1..)) {}
    }

    /// Reads on for a moment. Closed with something unread, a last word would be lost on its way.
    async fn linger(&mut self) {
        // Its end is as good as the time's.
        let _ = timeout(LINGER_TIME, self.discard()).await;
    }
}

/// Reads the hello. The error is what the client is told.
async fn greet(reader: &mut Reader, most_name: usize) -> Result<Hello, String> {
    let hello = reader.next(|frame| decode_greeting::<Hello>(frame).map_err(|error| error.to_string())).await;
    let hello = match hello {
        Some(hello) => hello?,
        None => return Err("the connection ended before a hello".to_owned()),
    };
    check_name(&hello.name)?;
    if hello.name.chars().count() > most_name {
        return Err(format!("a name has at most {most_name} characters on this server"));
    }
    hello.stream.check()?;
    Ok(hello)
}

/// The bytes that refuse a client.
pub(crate) fn refusal(reason: String) -> Bytes {
    framed(&encode_greeting(&ServerMessage::Refused { reason })).into()
}

async fn refuse(
    mut write: OwnedWriteHalf,
    mut reader: Reader,
    around: &Surroundings,
    address: SocketAddr,
    reason: String,
) {
    if around.chatter.may_speak() {
        tracing::info!(%address, "refused: {reason}");
    }
    // Best effort: the client may be gone.
    let _ = timeout(around.config.write_time, write.write_all(&refusal(reason))).await;
    drop(write);
    reader.linger().await;
}

/// Hands the client's messages to the room; returns why it ends.
async fn read_messages(reader: &mut Reader, around: &Surroundings, client: u32) -> String {
    let mut allowance = Allowance::new(around.config.most_messages);
    let mut pings = Allowance::new(MOST_PINGS);
    loop {
        let message = timeout(
            around.config.silent_time,
            reader.next(|frame| {
                decode::<ClientMessage>(frame).map_err(|error| format!("a frame cannot be read: {error}"))
            }),
        );
        let message = match message.await {
            Ok(Some(message)) => message,
            Ok(None) => return "it closed the connection".to_owned(),
            Err(_) => Err("it said nothing for too long".to_owned()),
        };
        let message = message.and_then(|message| match allowance.take() {
            true => Ok(message),
            false => Err(format!("more than {} messages a second", around.config.most_messages)),
        });
        match message {
            // More of them are of no use to anybody.
            Ok(ClientMessage::Ping { .. }) if !pings.take() => {}
            // The room need not wake up for that.
            Ok(ClientMessage::Ping { nonce }) => {
                let pong = ServerMessage::Pong { nonce, tick: around.tick.load(Ordering::Relaxed) };
                // There may be nobody to carry it out any more: the server ends.
                let _ = around.orders.send(Order::Tell { client, frame: wire(&pong) });
            }
            Ok(message) => around.commands.send(Command::Message { client, message }).await,
            Err(reason) => {
                around.commands.send(Command::Expel { client, reason: reason.clone() }).await;
                // Nothing behind it is heard; once the goodbye is written the broadcast ends this.
                reader.discard().await;
                return reason;
            }
        }
    }
}

/// How many messages a client may still send: so many a second, and twice as many in a burst.
struct Allowance {
    most: f64,
    left: f64,
    at: Instant,
}

impl Allowance {
    fn new(a_second: u32) -> Self {
        let most = 2.0 * f64::from(a_second);
        Self { most, left: most, at: Instant::now() }
    }

    fn take(&mut self) -> bool {
        let elapsed = self.at.elapsed();
        if elapsed > Duration::from_millis(20) {
            self.at += elapsed;
            self.left = (self.left + elapsed.as_secs_f64() * self.most / 2.0).min(self.most);
        }
        self.left -= 1.0;
        self.left >= 0.0
    }
}
