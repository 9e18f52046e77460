//! A server on a free port, and clients that speak to it.

use std::net::SocketAddr;
use std::sync::Arc;
use std::time::Duration;

use bytes::{Bytes, BytesMut};
use futures_util::{SinkExt, StreamExt};
use shared::game::{Action, Game};
use shared::protocol::{
    ClientMessage, Hello, MOST_FROM_SERVER, Role, Roster, ServerMessage, Snapshot, decode, decode_greeting, encode,
    encode_greeting,
};
use shared::table::Table;
use starball_server::{Account, Config};
use tokio::net::{TcpListener, TcpSocket, TcpStream};
use tokio::sync::oneshot;
use tokio::task::JoinHandle;
use tokio_util::codec::{Framed, LengthDelimitedCodec};

/// Long enough for a loaded machine; nothing here waits for it unless something is broken.
const PATIENCE: Duration = Duration::from_secs(20);

/// A running server.
pub(crate) struct Server {
    pub(crate) address: SocketAddr,
    stop: oneshot::Sender<()>,
    task: JoinHandle<Account>,
}

/// The classic table.
pub(crate) fn classic() -> Arc<Table> {
    Arc::new(Table::shipped("classic").expect("it is shipped").expect("it is valid"))
}

/// The classic table without a bot that plays while nobody else does.
pub(crate) fn quiet() -> Config {
    let mut config = Config::new(classic());
    config.attract = false;
    // These clients say nothing while they wait.
    config.silent_time = Duration::from_secs(120);
    config
}

impl Server {
    pub(crate) async fn start(config: Config) -> Self {
        let listener = TcpListener::bind("127.0.0.1:0").await.expect("a free port");
        let address = listener.local_addr().expect("bound");
        let (stop, stopped) = oneshot::channel();
        let shutdown = async {
            let _ = stopped.await;
        };
        let task = tokio::spawn(async move { starball_server::run(listener, config, shutdown).await.expect("no bug") });
        Self { address, stop, task }
    }

    /// Stops it and returns its account.
    pub(crate) async fn stop(self) -> Account {
        drop(self.stop);
        tokio::time::timeout(PATIENCE, self.task).await.expect("stops in time").expect("does not panic")
    }
}

/// A connection that has not said anything yet.
pub(crate) struct Wire(pub(crate) Framed<TcpStream, LengthDelimitedCodec>);

impl Wire {
    pub(crate) async fn open(server: &Server) -> Self {
        Self::over(TcpStream::connect(server.address).await.expect("connects"))
    }

    /// The same, with hardly any room for what is not read.
    pub(crate) async fn open_narrow(server: &Server) -> Self {
        let socket = TcpSocket::new_v4().expect("a socket");
        socket.set_recv_buffer_size(4096).expect("a TCP option");
        Self::over(socket.connect(server.address).await.expect("connects"))
    }

    fn over(stream: TcpStream) -> Self {
        stream.set_nodelay(true).expect("a TCP option");
        let codec = LengthDelimitedCodec::builder()
            .length_field_type::<u32>()
            .little_endian()
            .max_frame_length(MOST_FROM_SERVER)
            .new_codec();
        Self(Framed::new(stream, codec))
    }

    pub(crate) async fn send(&mut self, frame: Vec<u8>) {
        self.0.send(Bytes::from(frame)).await.expect("the server listens");
    }

    /// The next frame, or `None` once the server has closed the connection.
    pub(crate) async fn receive(&mut self) -> Option<BytesMut> {
        tokio::time::timeout(PATIENCE, self.0.next()).await.expect("a frame in time")?.ok()
    }

    /// The reason of the refusal that must come next.
    pub(crate) async fn refusal(&mut self) -> String {
        let frame = self.receive().await.expect("an answer");
        match decode_greeting(&frame) {
            Ok(ServerMessage::Refused { reason }) => reason,
            other => panic!("{other:?} instead of a refusal"),
        }
    }

    /// The reason of the goodbye that must come, whatever comes before it.
    pub(crate) async fn goodbye(&mut self) -> String {
        loop {
            let frame = self.receive().await.expect("a goodbye before the end");
            if let Ok(ServerMessage::Bye { reason }) = decode(&frame) {
                return reason;
            }
        }
    }
}

/// A client that was let in.
pub(crate) struct Client {
    pub(crate) wire: Wire,
    /// A copy of the game, restored from the snapshots that came.
    pub(crate) game: Game,
    /// Its seat, by the last `You`.
    pub(crate) seat: Option<u8>,
    /// Its place in the line, by the last `You`.
    pub(crate) line: Option<u16>,
    pub(crate) roster: Roster,
}

impl Client {
    pub(crate) async fn play(server: &Server, name: &str) -> Self {
        Self::join(Wire::open(server).await, name, Role::Play).await
    }

    pub(crate) async fn watch(server: &Server, name: &str) -> Self {
        Self::join(Wire::open(server).await, name, Role::Watch).await
    }

    pub(crate) async fn join(mut wire: Wire, name: &str, role: Role) -> Self {
        wire.send(encode_greeting(&Hello { name: name.to_owned(), role })).await;
        let frame = wire.receive().await.expect("a welcome");
        let welcome = match decode_greeting(&frame) {
            Ok(ServerMessage::Welcome(welcome)) => welcome,
            other => panic!("{other:?} instead of a welcome"),
        };
        let table = Table::parse("received", &welcome.table).expect("the server's table is valid");
        assert_eq!(table.digest, welcome.table_digest);
        let game = Game::new(Arc::new(table));
        Self { wire, game, seat: None, line: None, roster: Roster::default() }
    }

    pub(crate) async fn say(&mut self, message: ClientMessage) {
        self.wire.send(encode(&message)).await;
    }

    /// Works a control as soon as possible.
    pub(crate) async fn act(&mut self, action: Action) {
        self.say(ClientMessage::Act { tick: 0, action }).await;
    }

    /// The next message; its content is taken in.
    pub(crate) async fn hear(&mut self) -> ServerMessage {
        let frame = self.wire.receive().await.expect("the connection stays open");
        let message: ServerMessage = decode(&frame).expect("a message");
        match &message {
            ServerMessage::Snapshot(snapshot) => self.game.restore(snapshot.state.clone()).expect("a valid state"),
            ServerMessage::You { seat, line } => (self.seat, self.line) = (*seat, *line),
            ServerMessage::Roster(roster) => self.roster = roster.clone(),
            _ => {}
        }
        message
    }

    /// Takes in messages until `is_so` holds.
    pub(crate) async fn until(&mut self, what: &str, is_so: impl Fn(&Self) -> bool) {
        let wait = async {
            while !is_so(self) {
                self.hear().await;
            }
        };
        assert!(tokio::time::timeout(PATIENCE, wait).await.is_ok(), "waited in vain until {what}");
    }

    /// The next snapshot.
    pub(crate) async fn snapshot(&mut self) -> Snapshot {
        loop {
            if let ServerMessage::Snapshot(snapshot) = self.hear().await {
                return *snapshot;
            }
        }
    }
}
