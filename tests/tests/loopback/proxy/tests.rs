//! The proxy itself, between a client and a server that sends back what it gets.

use std::net::SocketAddr;
use std::time::Duration;

use shared::math::Rng;
use tokio::io::{AsyncReadExt, AsyncWriteExt};
use tokio::net::{TcpListener, TcpStream};
use tokio::time::{Instant, timeout};

use super::plan::{BLOCK, Plan};
use super::{Path, Proxy, Stalls, Weather};

const fn ms(milliseconds: u64) -> Duration {
    Duration::from_millis(milliseconds)
}

/// Long enough for a loaded machine.
const PATIENCE: Duration = Duration::from_secs(20);

/// Sends back what it gets, connection after connection. It ends with the test's runtime.
async fn echo() -> SocketAddr {
    let listener = TcpListener::bind("127.0.0.1:0").await.expect("a free port");
    let address = listener.local_addr().expect("bound");
    tokio::spawn(async move {
        while let Ok((mut stream, _)) = listener.accept().await {
            tokio::spawn(async move {
                let (mut read, mut write) = stream.split();
                let _ = tokio::io::copy(&mut read, &mut write).await;
                let _ = write.shutdown().await;
            });
        }
    });
    address
}

async fn through(weather: Weather) -> (Proxy, TcpStream) {
    let proxy = Proxy::start(echo().await, weather).await;
    let stream = TcpStream::connect(proxy.address).await.expect("connects");
    stream.set_nodelay(true).expect("a TCP option");
    (proxy, stream)
}

async fn there_and_back(stream: &mut TcpStream) -> Duration {
    let began = Instant::now();
    stream.write_all(b"ping").await.expect("sent");
    let mut answer = [0; 4];
    timeout(PATIENCE, stream.read_exact(&mut answer)).await.expect("in time").expect("an answer");
    assert_eq!(&answer, b"ping");
    began.elapsed()
}

fn noise(length: usize) -> Vec<u8> {
    let mut rng = Rng::new(length as u64);
    (0..length).map(|_| rng.bits() as u8).collect()
}

/// Sends it all, closes, and returns what came back before the other side closed.
async fn echoed(stream: TcpStream, sent: &[u8]) -> Vec<u8> {
    let (mut read, mut write) = stream.into_split();
    let send = async {
        // A cut may come before all is sent.
        let _ = write.write_all(sent).await;
        let _ = write.shutdown().await;
    };
    let mut received = Vec::new();
    let receive = async {
        // After a cut the end may be a reset.
        let _ = read.read_to_end(&mut received).await;
    };
    timeout(PATIENCE, async { tokio::join!(send, receive) }).await.expect("ends in time");
    received
}

#[tokio::test]
async fn a_delay_is_at_least_what_was_asked_for_in_each_direction() {
    let slow = Path { delay: ms(40), ..Path::default() };
    let (_proxy, mut stream) = through(Weather { to_server: slow, ..Weather::default() }).await;
    let up = there_and_back(&mut stream).await;
    assert!(up >= ms(40), "{up:?}");
    let (_proxy, mut stream) = through(Weather::both(slow, 1)).await;
    let both = there_and_back(&mut stream).await;
    assert!(both >= ms(80), "{both:?}");
    let (_proxy, mut stream) = through(Weather::default()).await;
    let none = there_and_back(&mut stream).await;
    assert!(none < ms(40), "{none:?}");
}

#[tokio::test]
async fn order_and_content_are_kept_under_jitter_and_little_bandwidth() {
    let path = Path { jitter: ms(20), bandwidth: Some(40_000), ..Path::default() };
    let (_proxy, stream) = through(Weather::both(path, 2)).await;
    let (sent, began) = (noise(20_000), Instant::now());
    assert!(echoed(stream, &sent).await == sent, "not what was sent");
    // The last piece has not to wait for what comes after it.
    let took = began.elapsed();
    assert!(took >= ms(490), "20 kB at 40 kB/s in {took:?}");
}

/// A megabyte that nobody reads must not end up in the proxy.
#[tokio::test]
async fn what_is_not_taken_stays_with_its_sender() {
    let listener = TcpListener::bind("127.0.0.1:0").await.expect("a free port");
    let narrow = Path { bandwidth: Some(10_000), ..Path::default() };
    let proxy = Proxy::start(listener.local_addr().expect("bound"), Weather::both(narrow, 3)).await;
    let mut stream = TcpStream::connect(proxy.address).await.expect("connects");
    let (_deaf, _) = listener.accept().await.expect("accepts");
    // What the sender's own system buffers, it also holds back.
    let sent = timeout(ms(300), stream.write_all(&noise(8_000_000))).await;
    assert!(sent.is_err(), "the proxy took it all");
}

#[tokio::test]
async fn a_cut_after_so_many_bytes_delivers_exactly_those() {
    for most in [1, BLOCK - 1, BLOCK, 1000] {
        let cut = Path { cut_after: Some(most), jitter: ms(5), ..Path::default() };
        let (_proxy, stream) = through(Weather { to_client: cut, ..Weather::default() }).await;
        let sent = noise(5000);
        assert!(echoed(stream, &sent).await == sent[..most as usize], "cut after {most} to the client");
        // To a server that says nothing and reads to the end.
        let listener = TcpListener::bind("127.0.0.1:0").await.expect("a free port");
        let weather = Weather { to_server: cut, ..Weather::default() };
        let proxy = Proxy::start(listener.local_addr().expect("bound"), weather).await;
        let mut client = TcpStream::connect(proxy.address).await.expect("connects");
        let (mut server, _) = listener.accept().await.expect("accepts");
        client.write_all(&sent).await.expect("the system takes it");
        let mut received = Vec::new();
        timeout(PATIENCE, server.read_to_end(&mut received)).await.expect("ends in time").expect("a clean end");
        assert!(received == sent[..most as usize], "cut after {most} to the server");
    }
}

#[tokio::test]
async fn a_cut_on_command_ends_the_connection_and_spares_the_next() {
    let (proxy, mut stream) = through(Weather::default()).await;
    there_and_back(&mut stream).await;
    proxy.cut();
    let end = timeout(PATIENCE, stream.read(&mut [0; 8])).await.expect("in time");
    assert!(matches!(end, Ok(0) | Err(_)), "{end:?}");
    let mut next = TcpStream::connect(proxy.address).await.expect("connects");
    there_and_back(&mut next).await;
}

#[tokio::test]
async fn a_half_open_connection_delivers_nothing_and_stays_open() {
    let (proxy, mut stream) = through(Weather::default()).await;
    there_and_back(&mut stream).await;
    proxy.go_half_open();
    stream.write_all(b"ping").await.expect("the system takes it");
    assert!(timeout(ms(200), stream.read(&mut [0; 8])).await.is_err(), "neither bytes nor an end");
    let mut next = TcpStream::connect(proxy.address).await.expect("connects");
    there_and_back(&mut next).await;
    proxy.cut();
    let end = timeout(PATIENCE, stream.read(&mut [0; 8])).await.expect("in time");
    assert!(matches!(end, Ok(0) | Err(_)), "a cut ends it: {end:?}");
}

#[tokio::test]
async fn a_stall_holds_up_everything_and_loses_nothing() {
    let (proxy, mut stream) = through(Weather::default()).await;
    there_and_back(&mut stream).await;
    proxy.stall(ms(150));
    let held = there_and_back(&mut stream).await;
    assert!(held >= ms(140), "{held:?}");
    let stalls = Stalls { every: ms(20), lasts: ms(40) };
    let (_proxy, stream) = through(Weather::both(Path { stalls: Some(stalls), ..Path::default() }, 4)).await;
    let sent = noise(30_000);
    assert!(echoed(stream, &sent).await == sent, "not what was sent");
}

#[test]
fn the_same_seed_makes_the_same_decisions() {
    let path = Path {
        delay: ms(10),
        jitter: ms(30),
        stalls: Some(Stalls { every: ms(100), lasts: ms(10) }),
        ..Path::default()
    };
    let decided = |seed, number| {
        Plan::of_connection(&Weather::both(path, seed), number).map(|mut plan| {
            let delays: Vec<_> = (0..100).map(|block| plan.delay_of(block)).collect();
            let stalls: Vec<_> = (0..100).map(|_| plan.next_stall()).collect();
            (delays, stalls)
        })
    };
    assert_eq!(decided(7, 0), decided(7, 0));
    let all = [decided(7, 0), decided(7, 1), decided(8, 0)].concat();
    for (place, one) in all.iter().enumerate() {
        assert!(
            all[place + 1..].iter().all(|other| one.0 != other.0 && one.1 != other.1),
            "directions and seeds differ"
        );
        assert!(one.0.iter().all(|&delay| (ms(10)..=ms(40)).contains(&delay)));
        let within = |time: Duration, about: Duration| time >= about / 2 && time <= about * 3 / 2;
        assert!(one.1.iter().flatten().all(|&(every, lasts)| within(every, ms(100)) && within(lasts, ms(10))));
    }
}
