//! The fan-out, through a transport that takes as much as a test wants.

use std::io::{self, ErrorKind, IoSlice};
use std::sync::Mutex;

use super::*;
use shared::protocol::Form;

const STREAM: Stream = Stream { form: Form::Inputs, hz: 10 };
const PLAYER: Stream = Stream { form: Form::State, hz: 60 };
const WRITE_TIME: Duration = Duration::from_secs(10);

/// A way out: what came through, and how much more may.
#[derive(Clone, Default)]
struct Pipe(Arc<Mutex<(Vec<u8>, usize)>>);

impl Pipe {
    fn with_room(room: usize) -> Self {
        Self(Arc::new(Mutex::new((Vec::new(), room))))
    }

    fn make_room(&self, room: usize) {
        self.0.lock().unwrap().1 = room;
    }

    fn take(&self) -> String {
        String::from_utf8(std::mem::take(&mut self.0.lock().unwrap().0)).unwrap()
    }
}

impl Outgoing for Pipe {
    fn try_write(&mut self, bytes: &[IoSlice<'_>]) -> io::Result<usize> {
        let (taken, room) = &mut *self.0.lock().unwrap();
        if *room == 0 {
            return Err(ErrorKind::WouldBlock.into());
        }
        let all: Vec<u8> = bytes.iter().flat_map(|slice| slice.iter().copied()).take(*room).collect();
        *room -= all.len();
        taken.extend_from_slice(&all);
        Ok(all.len())
    }
}

/// A broadcast whose time the test moves.
struct Stage {
    broadcast: Broadcast,
    now: Duration,
}

impl Stage {
    fn new() -> Self {
        let patience = Patience { write_time: WRITE_TIME, goodbye_time: Duration::from_secs(2) };
        let mut stage = Self { broadcast: Broadcast::new(patience, Arc::default()), now: Duration::ZERO };
        for stream in [STREAM, PLAYER] {
            stage.order(Order::Open { stream, full: Bytes::from_static(b"F0.") });
        }
        stage
    }

    /// With as many spectators as are served at once, who read nothing of interest.
    fn crowded() -> Self {
        let mut stage = Self::new();
        for client in 0..feed::AT_ONCE as u32 {
            stage.add(10_000 + client, &Pipe::with_room(1_000_000), STREAM);
        }
        stage
    }

    fn order(&mut self, order: Order) {
        self.broadcast.carry_out(order);
    }

    fn add(&mut self, client: u32, pipe: &Pipe, stream: Stream) -> oneshot::Receiver<String> {
        let (ended, end) = oneshot::channel();
        let (transport, greeting) = (Box::new(pipe.clone()), Bytes::from_static(b"W."));
        self.order(Order::Add { client, transport, stream, greeting, ended });
        end
    }

    fn frame(&mut self, stream: Stream, number: usize) {
        let [frame, full] = [format!("{number}."), format!("F{number}.")].map(Bytes::from);
        self.order(Order::Frame { stream, frame, full });
    }

    async fn pass(&mut self, time: Duration) {
        self.now += time;
        self.broadcast.serve_due(self.now).await;
    }

    async fn interval(&mut self) {
        self.pass(Duration::from_millis(100)).await;
    }
}

#[tokio::test(start_paused = true)]
async fn whoever_comes_gets_a_full_snapshot_at_once_and_then_frames_in_turn() {
    let (mut stage, pipe) = (Stage::crowded(), Pipe::with_room(1000));
    stage.frame(STREAM, 1);
    stage.order(Order::News { kind: NewsKind::Roster, frame: Bytes::from_static(b"R.") });
    let _end = stage.add(1, &pipe, STREAM);
    assert_eq!(pipe.take(), "W.F1.R.");
    stage.frame(STREAM, 2);
    assert_eq!(pipe.take(), "", "it waits for its turn");
    stage.interval().await;
    assert_eq!(pipe.take(), "2.");
    stage.interval().await;
    assert_eq!(pipe.take(), "", "nothing comes twice");
}

#[tokio::test(start_paused = true)]
async fn spectators_are_served_in_slots_and_players_at_once() {
    let mut stage = Stage::crowded();
    let pipes: Vec<Pipe> = (0..100).map(|_| Pipe::with_room(1000)).collect();
    let _ends: Vec<_> = (0..).zip(&pipes).map(|(n, pipe)| stage.add(n, pipe, STREAM)).collect();
    let player = Pipe::with_room(1000);
    let _end = stage.add(1000, &player, PLAYER);
    stage.order(Order::Hurry { client: 1000, is_prompt: true });
    pipes.iter().chain([&player]).for_each(|pipe| drop(pipe.take()));
    stage.frame(STREAM, 1);
    stage.frame(PLAYER, 1);
    assert_eq!(player.take(), "1.");
    for millisecond in 1..=100 {
        stage.pass(Duration::from_millis(1)).await;
        let served = pipes.iter().filter(|pipe| !pipe.0.lock().unwrap().0.is_empty()).count();
        assert_eq!(served, millisecond, "one each millisecond");
    }
}

/// A spectator among the first, who are served at once anyhow, got a place, and was put in a slot by the next full snapshot.
#[tokio::test(start_paused = true)]
async fn who_gets_a_place_is_served_at_once_from_then_on() {
    let (mut stage, pipe) = (Stage::new(), Pipe::with_room(1000));
    let _end = stage.add(1, &pipe, STREAM);
    stage.order(Order::Hurry { client: 1, is_prompt: true });
    for client in 0..feed::AT_ONCE as u32 {
        stage.add(10_000 + client, &Pipe::with_room(1_000_000), STREAM);
    }
    stage.order(Order::Switch { client: 1, stream: STREAM });
    pipe.take();
    stage.frame(STREAM, 1);
    assert_eq!(pipe.take(), "1.");
}

/// Whoever left made their slot smaller, and whoever came did not fill it.
#[tokio::test(start_paused = true)]
async fn slots_stay_even_whoever_comes_and_goes() {
    let mut stage = Stage::crowded();
    let pipe = Pipe::with_room(1_000_000);
    let mut ends: Vec<_> = (0..200).map(|n| stage.add(n, &pipe, STREAM)).collect();
    for round in 0..50 {
        // The same hundred slots lose theirs, again and again.
        for n in 0..100 {
            stage.order(Order::Remove { client: 1000 * round + n, last: Bytes::new() });
        }
        ends.extend((0..100).map(|n| stage.add(1000 * (round + 1) + n, &pipe, STREAM)));
    }
    for millisecond in 1..=100 {
        pipe.take();
        stage.frame(STREAM, millisecond);
        stage.pass(Duration::from_millis(1)).await;
        let bytes = pipe.take().len();
        assert!(bytes > 0, "nobody in slot {millisecond}");
    }
}

/// One slot of thousands held up everybody else for as long as it took.
#[tokio::test]
async fn a_slot_that_takes_longer_than_its_millisecond_is_served_in_pieces() {
    let mut stage = Stage::crowded();
    let pipe = Pipe::with_room(usize::MAX / 2);
    let _ends: Vec<_> = (0..4_000).map(|n| stage.add(n, &pipe, STREAM)).collect();
    stage.frame(STREAM, 1);
    let terms = terms(&stage.broadcast.news, stage.broadcast.patience, &stage.broadcast.next_wake);
    let feed = stage.broadcast.feeds.get_mut(&STREAM).unwrap();
    pipe.take();
    let (mut from, mut pieces) = (Some(0), 0);
    while let Some(first) = from {
        from = feed.serve_slot(1, first, Duration::ZERO, &terms).next;
        pieces += 1;
    }
    // Forty in it, sixteen in a row.
    assert_eq!((pieces, pipe.take().len()), (3, 40 * 2));
}

/// A client that is to go and takes a byte now and then kept its place among the connections for ever.
#[tokio::test(start_paused = true)]
async fn a_goodbye_in_drops_ends_when_its_time_is_up() {
    let (mut stage, pipe) = (Stage::new(), Pipe::with_room(3));
    let mut end = stage.add(1, &pipe, STREAM);
    stage.order(Order::Remove { client: 1, last: Bytes::from(vec![b'.'; 1000]) });
    for second in 0..10 {
        assert!(end.try_recv().is_err(), "{second}");
        pipe.make_room(1);
        tokio::time::advance(Duration::from_secs(1)).await;
        stage.interval().await;
    }
    assert!(end.try_recv().is_ok_and(|reason| reason.contains("too slowly")));
}

#[tokio::test(start_paused = true)]
async fn in_a_small_room_nobody_waits_for_a_turn() {
    let (mut stage, pipe) = (Stage::new(), Pipe::with_room(1000));
    let _end = stage.add(1, &pipe, STREAM);
    pipe.take();
    stage.frame(STREAM, 1);
    assert_eq!(pipe.take(), "1.");
}

#[tokio::test(start_paused = true)]
async fn who_lags_gets_all_that_it_missed_in_order_even_from_within_a_frame() {
    let (mut stage, pipe) = (Stage::new(), Pipe::with_room(6));
    let _end = stage.add(1, &pipe, STREAM);
    assert_eq!(pipe.take(), "W.F0.");
    for number in 11..=15 {
        stage.frame(STREAM, number);
        stage.interval().await;
    }
    assert_eq!(pipe.take(), "1");
    pipe.make_room(7);
    stage.interval().await;
    assert_eq!(pipe.take(), "1.12.13");
    pipe.make_room(100);
    stage.interval().await;
    assert_eq!(pipe.take(), ".14.15.");
}

#[tokio::test(start_paused = true)]
async fn who_lags_too_far_jumps_to_the_newest_full_snapshot() {
    let (mut stage, pipe) = (Stage::crowded(), Pipe::with_room(6));
    stage.order(Order::News { kind: NewsKind::Roster, frame: Bytes::from_static(b"R.") });
    let _end = stage.add(1, &pipe, STREAM);
    assert_eq!(pipe.take(), "W.F0.R");
    for number in 100..200 {
        stage.frame(STREAM, number);
        stage.pass(Duration::from_millis(10)).await;
    }
    pipe.make_room(1000);
    stage.interval().await;
    let taken = pipe.take();
    // It jumped when its next frame was no longer kept, and what came since is still there.
    assert_eq!(taken, format!(".F179.R.{}", (180..200).map(|number| format!("{number}.")).collect::<String>()));
    stage.frame(STREAM, 200);
    stage.interval().await;
    assert_eq!(pipe.take(), "200.");
}

#[tokio::test(start_paused = true)]
async fn who_takes_nothing_for_too_long_is_disconnected() {
    let (mut stage, pipe) = (Stage::new(), Pipe::with_room(5));
    let mut end = stage.add(1, &pipe, STREAM);
    for number in 0..99 {
        stage.frame(STREAM, number);
        tokio::time::advance(Duration::from_millis(100)).await;
        stage.interval().await;
    }
    assert!(end.try_recv().is_err(), "it has ten seconds");
    tokio::time::advance(Duration::from_millis(400)).await;
    stage.interval().await;
    assert_eq!(end.try_recv().as_deref(), Ok("it took nothing for too long"));
    assert!(stage.broadcast.whereabouts.is_empty());
}

#[tokio::test(start_paused = true)]
async fn who_asks_for_more_than_it_takes_is_disconnected() {
    let (mut stage, pipe) = (Stage::new(), Pipe::with_room(5));
    let mut end = stage.add(1, &pipe, STREAM);
    for _ in 0..100 {
        stage.order(Order::Tell { client: 1, frame: Bytes::from_static(b"P.") });
    }
    assert!(end.try_recv().is_ok_and(|reason| reason.contains("asks for")));
}

#[tokio::test(start_paused = true)]
async fn a_switch_begins_the_other_stream_with_a_full_snapshot() {
    let (mut stage, pipe) = (Stage::new(), Pipe::with_room(1000));
    let _end = stage.add(1, &pipe, STREAM);
    stage.frame(STREAM, 1);
    stage.frame(PLAYER, 7);
    pipe.take();
    stage.order(Order::Switch { client: 1, stream: PLAYER });
    assert_eq!(pipe.take(), "F7.");
    stage.order(Order::Close { stream: STREAM });
    stage.frame(PLAYER, 8);
    stage.interval().await;
    assert_eq!(pipe.take(), "8.");
    // And the closed one can begin anew.
    stage.order(Order::Open { stream: STREAM, full: Bytes::from_static(b"F9.") });
    stage.order(Order::Switch { client: 1, stream: STREAM });
    assert_eq!(pipe.take(), "F9.");
}

#[tokio::test(start_paused = true)]
async fn a_goodbye_is_the_last_thing_that_is_said() {
    let (mut stage, pipe) = (Stage::new(), Pipe::with_room(5));
    let mut end = stage.add(1, &pipe, STREAM);
    stage.frame(STREAM, 1);
    stage.order(Order::Remove { client: 1, last: Bytes::from_static(b"Bye.") });
    assert!(end.try_recv().is_err());
    pipe.make_room(1000);
    stage.interval().await;
    assert_eq!(pipe.take(), "W.F0.Bye.");
    assert_eq!(end.try_recv().as_deref(), Ok("its session is over"));
}
