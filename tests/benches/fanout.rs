//! What the server's processor time is for a message to a spectator, beside that of a bare loop that writes the same bytes
//! to as many sockets: `cargo bench -p starball-tests --bench fanout`.
//!
//! Both are read by `starball-load`. Each runs on the first core, the reader on the second, in pairs that take turns; the median of the
//! pairs' ratios is what counts. The bare loop is this program again, started with `--bare`: no greetings, no game, no queues, frames
//! recorded from the server, and one `write` for each socket and frame, spread over the frame's interval in slices of a millisecond.
//! What the server does besides (steps the game, answers pings, keeps time) is in its figure.

use std::error::Error;
use std::fs;
use std::io::{BufRead, BufReader, ErrorKind, Read, Write};
use std::net::{SocketAddr, TcpListener, TcpStream};
use std::path::{Path, PathBuf};
use std::process::{Child, Command, ExitCode, Stdio};
use std::thread::sleep;
use std::time::{Duration, Instant};

use clap::Parser;
use serde_json::Value;
use shared::protocol::{
    Deframer, Form, Hello, MOST_FROM_SERVER, Role, ServerMessage, Stream, decode_from_server, encode_greeting, framed,
};

type Outcome<T> = Result<T, Box<dyn Error>>;

/// Seconds of frames that are recorded.
const RECORDED: f64 = 3.0;
/// A bare loop that nobody stops stops itself after so long.
const LONGEST: Duration = Duration::from_secs(300);
/// How long a process may take to end.
const END_TIME: Duration = Duration::from_secs(10);

#[derive(Debug, Parser)]
struct Arguments {
    /// Seconds of each measurement.
    #[arg(long, default_value_t = 5.0)]
    seconds: f64,
    /// Connections that watch.
    #[arg(long, default_value_t = 1000)]
    spectators: usize,
    /// Frames a second: 10, 20, 30 or 60.
    #[arg(long, default_value_t = 10)]
    hz: u8,
    /// Pairs of measurements.
    #[arg(long, default_value_t = 5)]
    pairs: usize,
    /// For correctness: one pair of a second with 100 spectators.
    #[arg(long)]
    quick: bool,
    /// Is the bare loop, with these frames.
    #[arg(long, hide = true)]
    bare: Option<PathBuf>,
    /// What `cargo bench` says to every benchmark.
    #[arg(long, hide = true)]
    bench: bool,
}

fn main() -> ExitCode {
    let mut arguments = Arguments::parse();
    if arguments.quick {
        (arguments.seconds, arguments.spectators, arguments.pairs) = (1.0, 100, 1);
    }
    let outcome = match &arguments.bare {
        Some(file) => bare_loop(file, arguments.spectators, arguments.hz),
        None => compare(&arguments),
    };
    match outcome {
        Ok(()) => ExitCode::SUCCESS,
        Err(problem) => {
            eprintln!("fanout: {problem}");
            ExitCode::FAILURE
        }
    }
}

fn compare(arguments: &Arguments) -> Outcome<()> {
    let server = built_server()?;
    let own = std::env::current_exe()?;
    let file = Path::new(env!("CARGO_TARGET_TMPDIR")).join(format!("frames-{}", std::process::id()));
    let (spectators, hz) = (arguments.spectators, arguments.hz);
    let places = (spectators + 16).to_string();
    let listen = ["--listen", "127.0.0.1:0", "--most-connections", &places, "--most-per-address", &places];

    let recorded = Running::start(&server, &listen)?;
    let frames = record(recorded.address, hz, &file)?;
    drop(recorded);
    println!(
        "{spectators} spectators, inputs at {hz} Hz, {} s each; frames have {:.1} bytes with their lengths; {}",
        arguments.seconds,
        fs::metadata(&file)?.len() as f64 / frames as f64,
        if pins() { "server and loop on core 0, reader on core 1" } else { "nothing is pinned" },
    );
    println!("{:>4} {:>12} {:>12} {:>8} {:>10} {:>10}", "pair", "server us", "bare us", "ratio", "frames", "frames");
    let (mut servers, mut bares, mut ratios) = (Vec::new(), Vec::new(), Vec::new());
    for pair in 0..arguments.pairs {
        let (n, rate, path) = (spectators.to_string(), hz.to_string(), file.to_string_lossy().into_owned());
        let of_server = || measure(&Running::start(&server, &listen)?, arguments, false);
        let of_bare = || {
            let bare = ["--bare", &path, "--spectators", &n, "--hz", &rate];
            measure(&Running::start(&own, &bare)?, arguments, true)
        };
        // Whoever comes second finds a machine that is warm: that takes turns too.
        let (a, b) = if pair % 2 == 0 {
            let a = of_server()?;
            (a, of_bare()?)
        } else {
            let b = of_bare()?;
            (of_server()?, b)
        };
        let ratio = a.microseconds / b.microseconds;
        println!(
            "{:>4} {:>12.3} {:>12.3} {ratio:>8.3} {:>10} {:>10}",
            pair + 1,
            a.microseconds,
            b.microseconds,
            a.frames,
            b.frames
        );
        servers.push(a.microseconds);
        bares.push(b.microseconds);
        ratios.push(ratio);
    }
    fs::remove_file(&file)?;
    let [server, bare, ratio] = [servers, bares, ratios].map(median);
    println!("median: server {server:.3} us a message, bare loop {bare:.3} us, ratio {ratio:.3}");
    Ok(())
}

/// The server as this build has it.
fn built_server() -> Outcome<PathBuf> {
    let built =
        Command::new(env!("CARGO")).args(["build", "--quiet", "--release", "-p", "starball-server"]).status()?;
    if !built.success() {
        return Err("the server could not be built".into());
    }
    let own = std::env::current_exe()?;
    let folder = own.parent().and_then(Path::parent).ok_or("a benchmark stands in a folder of the target's")?;
    Ok(folder.join("starball-server"))
}

/// Whether there are two cores, and `taskset` to choose between them.
fn pins() -> bool {
    let cores = std::thread::available_parallelism().map_or(1, usize::from);
    cores >= 2 && Command::new("taskset").arg("--version").stdout(Stdio::null()).status().is_ok_and(|s| s.success())
}

fn pinned(program: &Path, core: &str) -> Command {
    if !pins() {
        return Command::new(program);
    }
    let mut command = Command::new("taskset");
    command.args(["--cpu-list", core]).arg(program);
    command
}

/// A process that listens; it is ended when this is dropped.
struct Running {
    child: Child,
    address: SocketAddr,
}

impl Running {
    fn start(program: &Path, arguments: &[&str]) -> Outcome<Self> {
        let mut command = pinned(program, "0");
        let child = command.args(arguments).env("RUST_LOG", "error").stdout(Stdio::piped()).spawn()?;
        let mut running = Self { child, address: SocketAddr::from(([127, 0, 0, 1], 0)) };
        let output = running.child.stdout.take().ok_or("its output is piped")?;
        let mut line = String::new();
        BufReader::new(output).read_line(&mut line)?;
        let address = line.trim().strip_prefix("listening on ").ok_or("it does not say where it listens")?;
        running.address = address.parse()?;
        Ok(running)
    }
}

impl Drop for Running {
    fn drop(&mut self) {
        // Asked first: a server that is killed leaves nothing to learn from.
        let _ = Command::new("kill").args(["-TERM", &self.child.id().to_string()]).status();
        let asked = Instant::now();
        while asked.elapsed() < END_TIME {
            if matches!(self.child.try_wait(), Ok(Some(_))) {
                return;
            }
            sleep(Duration::from_millis(20));
        }
        let _ = self.child.kill();
        let _ = self.child.wait();
    }
}

struct Cost {
    microseconds: f64,
    frames: u64,
}

/// What the process takes for each frame that its reader gets.
fn measure(running: &Running, arguments: &Arguments, raw: bool) -> Outcome<Cost> {
    let mut command = pinned(Path::new(env!("CARGO_BIN_EXE_starball-load")), "1");
    command.args(["--connect", &running.address.to_string(), "--process", &running.child.id().to_string()]);
    command.args(["--spectators", &arguments.spectators.to_string(), "--seconds", &arguments.seconds.to_string()]);
    command.args(["--hz", &arguments.hz.to_string()]);
    if raw {
        command.arg("--raw");
    }
    let output = command.stderr(Stdio::inherit()).output()?;
    if !output.status.success() {
        return Err("the load failed".into());
    }
    let report: Value = serde_json::from_slice(&output.stdout)?;
    let number = |value: &Value| value.as_f64().ok_or("a figure is missing in the load's report");
    let frames = report["frames"].as_u64().ok_or("the load tells no frames")?;
    let wanted = (arguments.spectators as f64 * arguments.seconds * f64::from(arguments.hz)) as u64;
    if frames < wanted * 9 / 10 {
        return Err(format!("{frames} frames came of {wanted}: {report}").into());
    }
    Ok(Cost { microseconds: number(&report["process"]["cpu_us_per_frame"])?, frames })
}

/// Writes what a spectator is sent to a file, without full snapshots and what else is not a frame of the stream; returns how many frames
/// there are.
fn record(address: SocketAddr, hz: u8, file: &Path) -> Outcome<usize> {
    let mut stream = TcpStream::connect(address)?;
    stream.set_read_timeout(Some(END_TIME))?;
    let wanted = Stream { form: Form::Inputs, hz };
    let hello = Hello { name: "recorder".to_owned(), role: Role::Watch, stream: wanted };
    stream.write_all(&framed(&encode_greeting(&hello)))?;
    let (mut deframer, mut buffer, mut bytes) = (Deframer::new(MOST_FROM_SERVER), [0; 4096], Vec::new());
    let (mut greeted, mut frames) = (false, 0);
    while frames < (RECORDED * f64::from(hz)) as usize {
        let length = stream.read(&mut buffer)?;
        if length == 0 {
            return Err("the server closed the recorder's connection".into());
        }
        deframer.space().extend_from_slice(&buffer[..length]);
        while let Some(frame) = deframer.next_frame()? {
            if std::mem::replace(&mut greeted, true) && matches!(decode_from_server(frame)?, ServerMessage::Inputs(_)) {
                bytes.extend(framed(frame));
                frames += 1;
            }
        }
    }
    fs::write(file, bytes)?;
    Ok(frames)
}

/// Writes frames to `connections` sockets until one is closed.
fn bare_loop(file: &Path, connections: usize, hz: u8) -> Outcome<()> {
    let (mut deframer, mut frames) = (Deframer::new(MOST_FROM_SERVER), Vec::new());
    deframer.space().extend(fs::read(file)?);
    while let Some(frame) = deframer.next_frame()? {
        frames.push(framed(frame));
    }
    let listener = TcpListener::bind("127.0.0.1:0")?;
    println!("listening on {}", listener.local_addr()?);
    let mut sockets = Vec::with_capacity(connections);
    while sockets.len() < connections {
        let (socket, _) = listener.accept()?;
        socket.set_nodelay(true)?;
        socket.set_nonblocking(true)?;
        sockets.push(socket);
    }
    let (begin, mut done) = (Instant::now(), 0);
    while begin.elapsed() < LONGEST {
        let due = (begin.elapsed().as_secs_f64() * connections as f64 * f64::from(hz)) as usize;
        while done < due {
            match sockets[done % connections].write(&frames[done / connections % frames.len()]) {
                // A reader that is late would not get more from a second try.
                Ok(_) => {}
                Err(error) if error.kind() == ErrorKind::WouldBlock => {}
                Err(_) => return Ok(()),
            }
            done += 1;
        }
        sleep(Duration::from_millis(1));
    }
    Ok(())
}

fn median(mut numbers: Vec<f64>) -> f64 {
    numbers.sort_by(f64::total_cmp);
    numbers.get(numbers.len() / 2).copied().unwrap_or(f64::NAN)
}
