//! A server on a free port, and clients that speak to it.

use std::net::SocketAddr;
use std::sync::Arc;
use std::time::Duration;

use shared::game::{Action, Game, GameEvent};
use shared::protocol::{
    ClientMessage, Deframer, Follower, Hello, MOST_FROM_SERVER, Role, Roster, ServerMessage, Stream, Tally, Welcome,
    decode_from_server, decode_greeting, encode, encode_greeting, framed,
};
use shared::table::Table;
use starball_server::{Account, Config};
use tokio::io::{AsyncReadExt, AsyncWriteExt};
use tokio::net::{TcpListener, TcpSocket, TcpStream};
use tokio::sync::oneshot;
use tokio::task::JoinHandle;

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
    // These clients say nothing while they wait, and some say a great deal.
    config.silent_time = Duration::from_secs(120);
    config.idle_time = Duration::from_secs(120);
    config.most_messages = 1_000_000;
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
pub(crate) struct Wire {
    pub(crate) stream: TcpStream,
    deframer: Deframer,
}

impl Wire {
    pub(crate) async fn open(server: &Server) -> Self {
        Self::open_at(server.address).await
    }

    /// The same by way of something else.
    pub(crate) async fn open_at(address: SocketAddr) -> Self {
        Self::over(TcpStream::connect(address).await.expect("connects"))
    }

    /// The same, with hardly any room for what is not read.
    pub(crate) async fn open_narrow(server: &Server) -> Self {
        let socket = TcpSocket::new_v4().expect("a socket");
        socket.set_recv_buffer_size(4096).expect("a TCP option");
        Self::over(socket.connect(server.address).await.expect("connects"))
    }

    fn over(stream: TcpStream) -> Self {
        stream.set_nodelay(true).expect("a TCP option");
        Self { stream, deframer: Deframer::new(MOST_FROM_SERVER) }
    }

    pub(crate) async fn send(&mut self, frame: Vec<u8>) {
        self.stream.write_all(&framed(&frame)).await.expect("the server listens");
    }

    /// The next frame, or `None` once the server has closed the connection.
    pub(crate) async fn receive(&mut self) -> Option<Vec<u8>> {
        loop {
            if let Some(frame) = self.deframer.next_frame().expect("a server's frames are in order") {
                return Some(frame.to_vec());
            }
            let read = tokio::time::timeout(PATIENCE, self.stream.read_buf(self.deframer.space())).await;
            // A server that hangs up on what it has not read resets the connection.
            if read.expect("a frame in time").unwrap_or(0) == 0 {
                return None;
            }
        }
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
            if let Ok(ServerMessage::Bye { reason }) = decode_from_server(&frame) {
                return reason;
            }
        }
    }
}

/// What one frame of the stream brought.
pub(crate) struct Snapshot {
    /// The tick that the client's copy is at.
    pub(crate) tick: u64,
    /// What happened on the first board since the frame before.
    pub(crate) events: Vec<GameEvent>,
}

/// A client that was let in, and follows its stream.
pub(crate) struct Client {
    pub(crate) wire: Wire,
    pub(crate) welcome: Welcome,
    pub(crate) follower: Follower,
    /// The game on the first board, as it was confirmed.
    pub(crate) game: Game,
    /// Its place, by the last `You`.
    pub(crate) place: Option<u8>,
    /// Its place in the line, by the last `You`.
    pub(crate) line: Option<u16>,
    pub(crate) roster: Roster,
    pub(crate) tally: Tally,
    /// Times that its copy was not what the server said, or something was missing.
    pub(crate) mismatches: u32,
}

impl Client {
    pub(crate) async fn play(server: &Server, name: &str) -> Self {
        Self::join(Wire::open(server).await, name, Role::Play, Stream::PLAYER).await
    }

    pub(crate) async fn watch(server: &Server, name: &str) -> Self {
        Self::watch_stream(server, name, Stream::PLAYER).await
    }

    pub(crate) async fn watch_stream(server: &Server, name: &str, stream: Stream) -> Self {
        Self::join(Wire::open(server).await, name, Role::Watch, stream).await
    }

    pub(crate) async fn join(mut wire: Wire, name: &str, role: Role, stream: Stream) -> Self {
        wire.send(encode_greeting(&Hello { name: name.to_owned(), role, stream })).await;
        let frame = wire.receive().await.expect("a welcome");
        let welcome = match decode_greeting(&frame) {
            Ok(ServerMessage::Welcome(welcome)) => welcome,
            other => panic!("{other:?} instead of a welcome"),
        };
        let table = Table::parse("received", &welcome.table).expect("the server's table is valid");
        assert_eq!(table.digest, welcome.table_digest);
        let table = Arc::new(table);
        Self {
            wire,
            welcome,
            follower: Follower::new(Arc::clone(&table)),
            game: Game::new(table),
            place: None,
            line: None,
            roster: Roster::default(),
            tally: Tally::default(),
            mismatches: 0,
        }
    }

    pub(crate) async fn say(&mut self, message: ClientMessage) {
        self.wire.send(encode(&message)).await;
    }

    /// Works a control as soon as possible.
    pub(crate) async fn act(&mut self, action: Action) {
        self.say(ClientMessage::Act { tick: 0, action }).await;
    }

    /// The next message; its content is taken in. What happened on the first board goes to `events`.
    async fn hear_with(&mut self, events: &mut Vec<GameEvent>) -> ServerMessage {
        let frame = self.wire.receive().await.expect("the connection stays open");
        let message = decode_from_server(&frame).expect("a message");
        let mut heard = Ok(());
        match &message {
            ServerMessage::Full(full) => {
                self.follower.hear_full(full).expect("a valid state");
            }
            ServerMessage::Change(change) => {
                heard = self.follower.hear_change(change).expect("a change of what there is").map(drop);
                events.extend(change.events.iter().filter(|event| event.board == 0).map(|event| event.event));
            }
            ServerMessage::Inputs(inputs) => {
                heard = self.follower.hear_inputs(inputs).expect("inputs of games that there are").map(drop);
            }
            ServerMessage::You { place, line, .. } => (self.place, self.line) = (*place, *line),
            ServerMessage::Roster(roster) => self.roster = roster.clone(),
            ServerMessage::Tally(tally) => self.tally = tally.clone(),
            _ => {}
        }
        let stepped = self.follower.advance(u64::MAX, |board, event| {
            if board == 0 {
                events.push(*event);
            }
        });
        if let Err(mismatch) = heard.and(stepped) {
            self.mismatches += 1;
            self.say(ClientMessage::Differs { tick: mismatch.tick, digest: mismatch.ours }).await;
        }
        if let Some(game) = self.follower.games().first() {
            self.game.clone_from(game);
        }
        message
    }

    /// The next message; its content is taken in.
    pub(crate) async fn hear(&mut self) -> ServerMessage {
        self.hear_with(&mut Vec::new()).await
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

    /// The next frame of the stream.
    pub(crate) async fn snapshot(&mut self) -> Snapshot {
        let mut events = Vec::new();
        loop {
            let message = self.hear_with(&mut events).await;
            if matches!(message, ServerMessage::Full(_) | ServerMessage::Change(_) | ServerMessage::Inputs(_)) {
                return Snapshot { tick: self.follower.tick(), events };
            }
        }
    }
}
