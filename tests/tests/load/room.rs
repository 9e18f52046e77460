//! A room that sends frames to whoever connects, in one thread, and does wrong what it is told to.

use std::io::{ErrorKind, Read, Write};
use std::net::{SocketAddr, TcpListener, TcpStream};
use std::sync::Arc;
use std::sync::atomic::{AtomicBool, Ordering};
use std::thread::{JoinHandle, sleep, spawn};
use std::time::{Duration, Instant};

use shared::game::{Action, Bot, Game, Input, Phase};
use shared::physics::PHYSICS_VERSION;
use shared::protocol::{
    BoardInput, ClientMessage, Deframer, Full, Hello, Inputs, MOST_FROM_CLIENT, Mode, ServerMessage, Stream, Welcome,
    decode, decode_greeting, digest_of_room, encode_from_server, encode_greeting, framed,
};
use shared::table::Table;

/// What it does wrong.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub(crate) enum Fault {
    /// Nothing.
    None,
    /// One frame in thirty says that copies must be what they are not.
    Digest,
    /// One frame in thirty is left out.
    Gap,
}

/// A room in a thread of its own, until it is dropped.
pub(crate) struct Room {
    address: SocketAddr,
    stop: Arc<AtomicBool>,
    thread: Option<JoinHandle<()>>,
}

struct Guest {
    stream: TcpStream,
    deframer: Deframer,
    greeted: bool,
    /// A full snapshot is the next thing that it is sent.
    waits: bool,
}

impl Room {
    pub(crate) fn open(table: Arc<Table>, fault: Fault) -> Self {
        let listener = TcpListener::bind("127.0.0.1:0").expect("a free port");
        let address = listener.local_addr().expect("bound");
        listener.set_nonblocking(true).expect("an option");
        let stop = Arc::new(AtomicBool::new(false));
        let asked = Arc::clone(&stop);
        let thread = spawn(move || serve(&listener, &table, fault, &asked));
        Self { address, stop, thread: Some(thread) }
    }

    pub(crate) fn address(&self) -> SocketAddr {
        self.address
    }
}

impl Drop for Room {
    fn drop(&mut self) {
        self.stop.store(true, Ordering::Relaxed);
        if let Some(thread) = self.thread.take() {
            assert!(thread.join().is_ok(), "the room panicked");
        }
    }
}

fn serve(listener: &TcpListener, table: &Arc<Table>, fault: Fault, stop: &AtomicBool) {
    let (mut game, mut bot) = (Game::new(Arc::clone(table)), Bot::new(0, 1));
    let (mut guests, mut since, mut from, mut number) = (Vec::new(), Vec::new(), 0, 0_u32);
    let begin = Instant::now();
    while !stop.load(Ordering::Relaxed) {
        sleep(Duration::from_millis(1));
        while let Ok((stream, _)) = listener.accept() {
            stream.set_nonblocking(true).expect("an option");
            guests.push(Guest { stream, deframer: Deframer::new(MOST_FROM_CLIENT), greeted: false, waits: true });
        }
        while u128::from(game.tick()) < begin.elapsed().as_millis() {
            step(&mut game, &mut bot, &mut since);
            if !Stream::SPECTATOR.is_due(game.tick(), 0.001) {
                continue;
            }
            number += 1;
            let games = std::slice::from_ref(&game);
            let (to, wrong) = (game.tick(), number.is_multiple_of(30));
            let mut digest = digest_of_room(games);
            digest ^= u64::from(wrong && fault == Fault::Digest);
            let inputs = std::mem::take(&mut since);
            let frame = ServerMessage::Inputs(Inputs { from, to, digest: Some(digest), inputs });
            let full = ServerMessage::Full(Box::new(Full::of("room", games)));
            from = to;
            let [frame, full] = [frame, full].map(|message| framed(&encode_from_server(&message)));
            for guest in guests.iter_mut().filter(|guest: &&mut Guest| guest.greeted) {
                if std::mem::take(&mut guest.waits) {
                    let _ = guest.stream.write(&full);
                } else if !(wrong && fault == Fault::Gap) {
                    let _ = guest.stream.write(&frame);
                }
            }
        }
        let tick = game.tick();
        guests.retain_mut(|guest| listen(guest, table, tick));
    }
}

fn step(game: &mut Game, bot: &mut Bot, since: &mut Vec<BoardInput>) {
    let tick = game.tick();
    let mut inputs = Vec::new();
    if !matches!(game.phase(), Phase::Play { .. }) {
        inputs.extend([Action::Sit, Action::Start].map(|action| Input { tick, seat: 0, action }));
    }
    bot.play(game, |action| inputs.push(Input { tick, seat: 0, action }));
    game.step(&inputs);
    since.extend(inputs.into_iter().map(|input| BoardInput { board: 0, input }));
}

/// Whether the guest is still there.
fn listen(guest: &mut Guest, table: &Table, tick: u64) -> bool {
    let mut buffer = [0; 1024];
    loop {
        match guest.stream.read(&mut buffer) {
            Ok(0) => return false,
            Ok(length) => guest.deframer.space().extend_from_slice(&buffer[..length]),
            Err(error) if error.kind() == ErrorKind::WouldBlock => break,
            Err(_) => return false,
        }
    }
    let mut answers = Vec::new();
    while let Some(frame) = guest.deframer.next_frame().expect("a frame") {
        if !guest.greeted {
            decode_greeting::<Hello>(frame).expect("a greeting");
            guest.greeted = true;
            let welcome = Welcome {
                room: "room".to_owned(),
                mode: Mode::Challenge,
                places: 1,
                physics: PHYSICS_VERSION,
                table_digest: table.digest,
                table: table.source.clone(),
            };
            answers.extend(framed(&encode_greeting(&ServerMessage::Welcome(welcome))));
            continue;
        }
        match decode(frame).expect("a message") {
            ClientMessage::Ping { nonce } => {
                answers.extend(framed(&encode_from_server(&ServerMessage::Pong { nonce, tick })));
            }
            ClientMessage::Differs { .. } => guest.waits = true,
            other => panic!("{other:?} from a spectator"),
        }
    }
    guest.stream.write_all(&answers).is_ok()
}
