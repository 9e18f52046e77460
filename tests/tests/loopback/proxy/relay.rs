//! One connection of a proxy: bytes from either side to the other, when and as far as the plans and the orders let them.

use std::io;
use std::time::Duration;

use tokio::io::{AsyncReadExt, AsyncWriteExt};
use tokio::net::TcpStream;
use tokio::net::tcp::{ReadHalf, WriteHalf};
use tokio::sync::{mpsc, watch};
use tokio::time::{Instant, sleep_until, timeout};

use super::Orders;
use super::plan::{BLOCK, Plan};

/// Pieces of at most a block that are under way in one direction: 16 kB. Nothing is read while there are so many.
const MOST_UNDER_WAY: u64 = 64;
/// How much a narrow path holds, seconds at its bandwidth: as much as a modem's queue.
const QUEUE_SECONDS: f64 = 0.5;

/// How long the two sides may take to close after a cut at a byte; what they sent is dropped meanwhile, because a socket
/// that is closed with something unread throws away what it has not sent.
const CLOSING_TIME: Duration = Duration::from_millis(250);

/// Bytes under way, and when they may go on.
struct Piece {
    due: Instant,
    bytes: Vec<u8>,
}

/// Why one direction ends while the other may go on.
enum End {
    /// Its sender closed it, and so did we.
    Closed,
    /// The byte was reached after which the connection ends.
    Cut,
}

/// Relays one connection to its end.
pub(super) async fn connection(
    mut client: TcpStream,
    mut server: TcpStream,
    plans: [Plan; 2],
    number: u64,
    mut orders: watch::Receiver<Orders>,
) {
    let mut stops = orders.clone();
    let stopped = async |orders: &mut watch::Receiver<Orders>, is_cut_only: bool| {
        // The sender lives as long as the proxy.
        let _ = orders
            .wait_for(|orders| number < orders.cut_below || (!is_cut_only && number < orders.half_open_below))
            .await;
    };
    let is_cut = tokio::select! {
        biased;
        () = stopped(&mut stops, false) => false,
        is_cut = both_ways(&mut client, &mut server, plans, &orders) => is_cut,
    };
    if number < stops.borrow().half_open_below {
        // Both sockets are open; nobody reads or writes them.
        stopped(&mut orders, true).await;
    } else if is_cut {
        let _ = timeout(CLOSING_TIME, close(&mut client, &mut server)).await;
    }
}

/// Whether it ended at a byte that the plan says.
async fn both_ways(
    client: &mut TcpStream,
    server: &mut TcpStream,
    [to_server, to_client]: [Plan; 2],
    orders: &watch::Receiver<Orders>,
) -> bool {
    let ((from_client, into_client), (from_server, into_server)) = (client.split(), server.split());
    let up = one_way(from_client, into_server, to_server, orders.clone());
    let down = one_way(from_server, into_client, to_client, orders.clone());
    tokio::pin!(up, down);
    let (first, up_is_first) = tokio::select! {
        end = &mut up => (end, true),
        end = &mut down => (end, false),
    };
    let is_cut = |end: &io::Result<End>| matches!(end, Ok(End::Cut));
    match first {
        // One side has said all; the other may still be speaking.
        Ok(End::Closed) => is_cut(&if up_is_first { down.await } else { up.await }),
        end => is_cut(&end),
    }
}

async fn one_way(
    mut from: ReadHalf<'_>,
    mut into: WriteHalf<'_>,
    plan: Plan,
    orders: watch::Receiver<Orders>,
) -> io::Result<End> {
    let pieces = plan.path.bandwidth.map(|bandwidth| (f64::from(bandwidth) * QUEUE_SECONDS) as u64 / BLOCK);
    let (sender, receiver) = mpsc::channel(pieces.unwrap_or(MOST_UNDER_WAY).clamp(1, MOST_UNDER_WAY) as usize);
    let (_, end) =
        tokio::try_join!(take_in(&mut from, &plan, sender), hand_on(&mut into, plan.clone(), receiver, orders))?;
    Ok(end)
}

/// Reads until the end, or until the byte at which the connection is to be cut.
async fn take_in(from: &mut ReadHalf<'_>, plan: &Plan, pieces: mpsc::Sender<Piece>) -> io::Result<()> {
    let mut taken = 0;
    let mut last_due = Instant::now();
    loop {
        // Room first, so that what cannot go on stays with its sender.
        let Ok(room) = pieces.reserve().await else { return Ok(()) };
        let left_of_block = BLOCK - taken % BLOCK;
        let left = plan.path.cut_after.map_or(left_of_block, |most| left_of_block.min(most - taken));
        if left == 0 {
            return Ok(());
        }
        let mut bytes = vec![0; left as usize];
        let length = from.read(&mut bytes).await?;
        if length == 0 {
            return Ok(());
        }
        bytes.truncate(length);
        last_due = last_due.max(Instant::now() + plan.delay_of(taken / BLOCK));
        taken += length as u64;
        room.send(Piece { due: last_due, bytes });
    }
}

/// Writes what is due, until the end.
async fn hand_on(
    into: &mut WriteHalf<'_>,
    mut plan: Plan,
    mut pieces: mpsc::Receiver<Piece>,
    mut orders: watch::Receiver<Orders>,
) -> io::Result<End> {
    let mut handed = 0;
    let mut free_at = Instant::now();
    let mut stall = plan.next_stall().map(|(after, lasts)| (free_at + after, lasts));
    while let Some(Piece { due, bytes }) = pieces.recv().await {
        sleep_until(due.max(free_at)).await;
        while let Some((begin, lasts)) = stall
            && begin <= Instant::now()
        {
            let end = begin + lasts;
            sleep_until(end).await;
            stall = plan.next_stall().map(|(after, lasts)| (end + after, lasts));
        }
        loop {
            let until = orders.borrow_and_update().stalled_until;
            if until <= Instant::now() {
                break;
            }
            sleep_until(until).await;
        }
        into.write_all(&bytes).await?;
        handed += bytes.len() as u64;
        if let Some(bandwidth) = plan.path.bandwidth {
            free_at = Instant::now() + Duration::from_secs_f64(bytes.len() as f64 / f64::from(bandwidth));
        }
        if plan.path.cut_after == Some(handed) {
            return Ok(End::Cut);
        }
    }
    into.shutdown().await?;
    Ok(End::Closed)
}

/// Says to both sides that nothing more comes, and waits until they have said so, too.
async fn close(client: &mut TcpStream, server: &mut TcpStream) {
    async fn end(stream: &mut TcpStream) {
        let _ = stream.shutdown().await;
        let _ = tokio::io::copy(stream, &mut tokio::io::sink()).await;
    }
    tokio::join!(end(client), end(server));
}
