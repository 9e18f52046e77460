//! A relay between clients and a server that does to their bytes what networks do: it delays, squeezes, stalls and cuts
//! them, and goes silent. What it decides follows from its seed.
//!
//! It knows nothing of frames or messages. The decisions are in [`plan`], the relaying of one connection in [`relay`].

mod plan;
mod relay;
mod tests;

use std::net::SocketAddr;
use std::sync::Arc;
use std::time::Duration;

use tokio::net::{TcpListener, TcpSocket};
use tokio::sync::watch;
use tokio::task::{JoinHandle, JoinSet};
use tokio::time::Instant;

use plan::Plan;

/// Bytes that the system holds for a narrow path at each of the proxy's sockets: what is beyond stays with the sender.
const NARROW_BUFFER: u32 = 4096;

/// What happens to the bytes of one direction. The default is a clear path.
#[derive(Debug, Clone, Copy, Default)]
pub(crate) struct Path {
    /// How much later every byte arrives.
    pub(crate) delay: Duration,
    /// How much later still a byte may arrive: uniform from zero to this, in order as always on TCP.
    pub(crate) jitter: Duration,
    /// Bytes a second that pass at the most. The system's buffers are then small, so that the sender feels it.
    pub(crate) bandwidth: Option<u32>,
    /// Times at which nothing passes.
    pub(crate) stalls: Option<Stalls>,
    /// The connection ends when exactly so many bytes have passed.
    pub(crate) cut_after: Option<u64>,
}

/// Times at which nothing passes. Each length is uniform within half and one and a half of what is given.
#[derive(Debug, Clone, Copy)]
pub(crate) struct Stalls {
    /// From the end of one to the begin of the next.
    pub(crate) every: Duration,
    /// How long it lasts.
    pub(crate) lasts: Duration,
}

/// Both directions.
#[derive(Debug, Clone, Copy, Default)]
pub(crate) struct Weather {
    pub(crate) to_server: Path,
    pub(crate) to_client: Path,
    /// What the decisions follow from, and the number of the connection.
    pub(crate) seed: u64,
}

impl Weather {
    /// The same in both directions.
    pub(crate) fn both(path: Path, seed: u64) -> Self {
        Self { to_server: path, to_client: path, seed }
    }
}

/// What a test told the proxy so far.
#[derive(Debug, Clone, Copy)]
struct Orders {
    stalled_until: Instant,
    /// Connections below this number are cut.
    cut_below: u64,
    /// Connections below this number are half-open.
    half_open_below: u64,
    /// The next connection's number.
    connections: u64,
}

/// A running proxy; it ends with its connections when it is dropped.
pub(crate) struct Proxy {
    /// Where clients connect to.
    pub(crate) address: SocketAddr,
    orders: Arc<watch::Sender<Orders>>,
    task: JoinHandle<()>,
}

impl Proxy {
    /// Relays between whoever connects to its address, and `server`.
    pub(crate) async fn start(server: SocketAddr, weather: Weather) -> Self {
        let listener = listen(weather.to_server);
        let address = listener.local_addr().expect("bound");
        let orders = Orders { stalled_until: Instant::now(), cut_below: 0, half_open_below: 0, connections: 0 };
        let orders = Arc::new(watch::Sender::new(orders));
        let task = tokio::spawn(accept(listener, server, weather, Arc::clone(&orders)));
        Self { address, orders, task }
    }

    /// Nothing passes for so long from now, in either direction.
    pub(crate) fn stall(&self, time: Duration) {
        self.orders.send_modify(|orders| orders.stalled_until = Instant::now() + time);
    }

    /// Both sides of every connection are closed at once, and what was under way is lost. Later ones are relayed.
    pub(crate) fn cut(&self) {
        self.orders.send_modify(|orders| orders.cut_below = orders.connections);
    }

    /// Every connection stays open, but nothing more is read or written: a machine that went to sleep, a cable pulled out.
    /// The system goes on acknowledging until its buffers are full. Later connections are relayed.
    pub(crate) fn go_half_open(&self) {
        self.orders.send_modify(|orders| orders.half_open_below = orders.connections);
    }
}

impl Drop for Proxy {
    fn drop(&mut self) {
        self.task.abort();
    }
}

fn socket_for(incoming: Path) -> TcpSocket {
    let socket = TcpSocket::new_v4().expect("a socket");
    if incoming.bandwidth.is_some() {
        socket.set_recv_buffer_size(NARROW_BUFFER).expect("a TCP option");
    }
    socket
}

fn listen(incoming: Path) -> TcpListener {
    let socket = socket_for(incoming);
    socket.bind(SocketAddr::from(([127, 0, 0, 1], 0))).expect("a free port");
    socket.listen(64).expect("listens")
}

async fn accept(listener: TcpListener, server: SocketAddr, weather: Weather, orders: Arc<watch::Sender<Orders>>) {
    // Aborted with this task.
    let mut connections = JoinSet::new();
    loop {
        let client = tokio::select! {
            client = listener.accept() => client,
            Some(_) = connections.join_next() => continue,
        };
        let (Ok((client, _)), Ok(server)) = (client, socket_for(weather.to_client).connect(server).await) else {
            continue;
        };
        for stream in [&client, &server] {
            stream.set_nodelay(true).expect("a TCP option");
        }
        let mut number = 0;
        orders.send_modify(|orders| {
            number = orders.connections;
            orders.connections += 1;
        });
        let plans = Plan::of_connection(&weather, number);
        connections.spawn(relay::connection(client, server, plans, number, orders.subscribe()));
    }
}
