//! One client's connection: handshake, then frames both ways until either side ends it.

use std::net::SocketAddr;
use std::sync::Arc;

use bytes::Bytes;
use futures_util::{SinkExt, StreamExt};
use shared::physics::PHYSICS_VERSION;
use shared::protocol::{
    ClientMessage, Hello, MOST_FROM_CLIENT, ServerMessage, Welcome, check_name, decode, decode_greeting, encode,
    encode_greeting,
};
use socket2::SockRef;
use tokio::net::TcpStream;
use tokio::net::tcp::{OwnedReadHalf, OwnedWriteHalf};
use tokio::sync::{broadcast, mpsc, oneshot};
use tokio::time::timeout;
use tokio_util::codec::{FramedRead, FramedWrite, LengthDelimitedCodec};

use crate::config::Config;
use crate::room::Command;

/// Frames for one client alone that may wait to be written; what is sent beyond is lost or told later.
const DIRECT_WAITING: usize = 64;

type Reader = FramedRead<OwnedReadHalf, LengthDelimitedCodec>;
type Writer = FramedWrite<OwnedWriteHalf, LengthDelimitedCodec>;

/// The framing on TCP: four bytes of length, little-endian, then the frame; larger ones are refused unread.
fn codec(most: usize) -> LengthDelimitedCodec {
    LengthDelimitedCodec::builder().length_field_type::<u32>().little_endian().max_frame_length(most).new_codec()
}

/// Serves one connection to its end.
pub(crate) async fn serve(
    stream: TcpStream,
    address: SocketAddr,
    config: Arc<Config>,
    frames: broadcast::Sender<Bytes>,
    commands: mpsc::Sender<Command>,
) {
    // Without this a small frame waits for the acknowledgement of the one before.
    if let Err(error) = stream.set_nodelay(true) {
        tracing::debug!(%address, "no TCP_NODELAY: {error}");
    }
    // With the system's own buffers a stalled client would fall minutes behind before anybody noticed.
    if let Err(error) = SockRef::from(&stream).set_send_buffer_size(config.send_buffer) {
        tracing::debug!(%address, "no SO_SNDBUF: {error}");
    }
    let (read, write) = stream.into_split();
    let mut reader = FramedRead::new(read, codec(MOST_FROM_CLIENT));
    let mut writer = FramedWrite::new(write, codec(shared::protocol::MOST_FROM_SERVER));

    let hello = tokio::select! {
        hello = greet(&mut reader) => hello,
        () = tokio::time::sleep(config.handshake_time) => Err("no hello came in time".to_owned()),
        () = commands.closed() => Err("the server ends".to_owned()),
    };
    let hello = match hello {
        Ok(hello) => hello,
        Err(reason) => return refuse(&mut writer, &config, address, reason).await,
    };
    // Subscribed before the room knows of the client, so that it misses nothing that comes after.
    let shared_frames = frames.subscribe();
    drop(frames);
    let (direct, direct_frames) = mpsc::channel(DIRECT_WAITING);
    let (reply, joined) = oneshot::channel();
    let join = Command::Join { name: hello.name.clone(), role: hello.role, direct, reply };
    let _ = commands.send(join).await;
    // Without an answer the room has ended.
    let client = match joined.await.unwrap_or_else(|_| Err("the server ends".to_owned())) {
        Ok(client) => client,
        Err(reason) => return refuse(&mut writer, &config, address, reason).await,
    };
    tracing::info!(client, %address, name = hello.name, role = ?hello.role, "joined");

    let welcome = ServerMessage::Welcome(Welcome {
        client,
        physics: PHYSICS_VERSION,
        table_digest: config.table.digest,
        table: config.table.source.clone(),
    });
    let greeting = timeout(config.write_time, writer.send(Bytes::from(encode_greeting(&welcome)))).await;
    let reason = match greeting {
        Ok(Ok(())) => tokio::select! {
            reason = read_frames(&mut reader, &config, client, &commands) => reason,
            reason = write_frames(&mut writer, &config, shared_frames, direct_frames) => reason,
        },
        _ => "the welcome could not be sent".to_owned(),
    };
    tracing::info!(client, name = hello.name, "left: {reason}");
    // The room may have ended first: then there is nobody to tell.
    let _ = commands.send(Command::Left { client }).await;
}

/// Reads the hello. The error is what the client is told.
async fn greet(reader: &mut Reader) -> Result<Hello, String> {
    let frame = match reader.next().await {
        Some(Ok(frame)) => frame,
        Some(Err(error)) => return Err(format!("the first frame cannot be read: {error}")),
        None => return Err("the connection ended before a hello".to_owned()),
    };
    let hello: Hello = decode_greeting(&frame).map_err(|error| error.to_string())?;
    check_name(&hello.name)?;
    Ok(hello)
}

async fn refuse(writer: &mut Writer, config: &Config, address: SocketAddr, reason: String) {
    tracing::info!(%address, "refused: {reason}");
    let refusal = encode_greeting(&ServerMessage::Refused { reason });
    // Best effort: the client may be gone.
    let _ = timeout(config.write_time, writer.send(Bytes::from(refusal))).await;
}

/// Hands the client's messages to the room; returns why it ends.
async fn read_frames(reader: &mut Reader, config: &Config, client: u32, commands: &mpsc::Sender<Command>) -> String {
    loop {
        let frame = match timeout(config.silent_time, reader.next()).await {
            Ok(Some(frame)) => frame,
            Ok(None) => return "it closed the connection".to_owned(),
            Err(_) => return "it said nothing for too long".to_owned(),
        };
        let message = frame
            .map_err(|error| error.to_string())
            .and_then(|frame| decode::<ClientMessage>(&frame).map_err(|error| error.to_string()));
        match message {
            Ok(message) => {
                if commands.send(Command::Message { client, message }).await.is_err() {
                    return "the server ends".to_owned();
                }
            }
            Err(problem) => {
                let reason = format!("a frame cannot be read: {problem}");
                // The room sends the goodbye, and with that this connection ends.
                if commands.send(Command::Expel { client, reason: reason.clone() }).await.is_err() {
                    return reason;
                }
                // Nothing behind a broken frame can be trusted; wait for the goodbye to be written.
                std::future::pending::<()>().await;
            }
        }
    }
}

/// Writes what everybody gets and what this client alone gets; returns why it ends.
async fn write_frames(
    writer: &mut Writer,
    config: &Config,
    mut shared_frames: broadcast::Receiver<Bytes>,
    mut direct_frames: mpsc::Receiver<Bytes>,
) -> String {
    loop {
        let frame = tokio::select! {
            biased;
            frame = direct_frames.recv() => match frame {
                Some(frame) => frame,
                None => return close(writer, "its session is over").await,
            },
            frame = shared_frames.recv() => match frame {
                Ok(frame) => frame,
                // Every snapshot is complete: a slow client just loses some.
                Err(broadcast::error::RecvError::Lagged(_)) => continue,
                Err(broadcast::error::RecvError::Closed) => return close(writer, "the server ends").await,
            },
        };
        match timeout(config.write_time, writer.send(frame)).await {
            Ok(Ok(())) => {}
            Ok(Err(error)) => return format!("writing failed: {error}"),
            Err(_) => return "it took nothing for too long".to_owned(),
        }
    }
}

async fn close(writer: &mut Writer, reason: &str) -> String {
    // The peer may have closed first; it ends either way.
    let _ = SinkExt::<Bytes>::close(writer).await;
    reason.to_owned()
}

/// The shared form of a message.
pub(crate) fn frame_of(message: &ServerMessage) -> Bytes {
    encode(message).into()
}
