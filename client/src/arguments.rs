//! The command line: written form (what clap reads) -> checked form (what the program runs on).

use std::ffi::OsStr;
use std::path::PathBuf;
use std::sync::Arc;

use clap::{Parser, Subcommand};
use shared::protocol::{Form, Mode, RATES, Role, check_name};
use shared::table::Table;
use starball_server::load_table;

use crate::film::{self, Film};
use crate::settings;
use crate::streams::StreamChoice;

/// Pinball that many can watch and up to four can play. Without a command it opens a table of its own.
#[derive(Debug, Parser)]
#[command(name = "starball", version)]
pub(crate) struct Arguments {
    #[command(subcommand)]
    command: Option<Command>,
    /// What others call you; otherwise what the settings say, or your user name [1 to 24 characters].
    #[arg(long, global = true, value_parser = name)]
    name: Option<String>,
    /// A shipped table's name or a table file, for a table of your own.
    #[arg(long, value_name = "NAME|FILE")]
    table: Option<String>,
    /// Where your settings are kept; otherwise where this system keeps those of programs.
    #[arg(long, global = true, env = "STARBALL_SETTINGS", value_name = "FILE")]
    settings: Option<PathBuf>,
    /// Saves a picture of the window and quits.
    #[arg(long, global = true, value_name = "FILE.png", value_parser = png)]
    screenshot: Option<PathBuf>,
    /// Seconds to the picture.
    #[arg(long, global = true, value_name = "SECONDS", default_value_t = 3.0, requires = "screenshot", value_parser = seconds)]
    after: f64,
    /// Frames a second at most; 0: as many as there can be.
    #[arg(long, global = true, default_value_t = 60)]
    fps: u32,
    /// How loud the game is, in percent, whatever the settings say; 0: silent.
    #[arg(long, global = true, value_name = "0..100", value_parser = clap::value_parser!(u8).range(0..=100))]
    volume: Option<u8>,
    /// Shows what the physics sees: shapes, normals, velocities, the flights to come. F4 switches it.
    #[arg(long, global = true)]
    overlay: bool,
    /// Prints at the end what was drawn, received and predicted.
    #[arg(long, global = true)]
    stats: bool,
    /// Saves pictures of moments that are always the same, to be compared, and quits.
    #[arg(long, value_name = "FOLDER", hide = true)]
    stills: Option<PathBuf>,
}

#[derive(Debug, Subcommand)]
enum Command {
    /// Plays at somebody's server.
    Play(Connect),
    /// Watches at somebody's server.
    Watch(Connect),
    /// Watches a replay, as a server records one.
    Replay(ReplayFile),
}

#[derive(Debug, clap::Args)]
struct ReplayFile {
    /// The replay.
    #[arg(value_name = "FILE")]
    file: PathBuf,
    /// The table that it was recorded on, if that is none of those that are shipped.
    #[arg(long, value_name = "NAME|FILE")]
    table: Option<String>,
}

#[derive(Debug, clap::Args)]
struct Connect {
    /// Where the server listens.
    #[arg(long, value_name = "HOST:PORT", value_parser = check_address)]
    connect: String,
    /// What the server is to send: what changed, or what was pressed (much less). Left out: state while you play, inputs
    /// while you watch.
    #[arg(long, value_name = "state|inputs", value_parser = form)]
    stream: Option<Form>,
    /// How many frames of it a second: 10, 20, 30 or 60. Left out: 60 while you play, 10 while you watch.
    #[arg(long, value_name = "RATE", value_parser = rate)]
    hz: Option<u8>,
}

/// What to connect to.
#[derive(Debug, Clone)]
pub(crate) enum Goal {
    /// A table of one's own.
    Own(Arc<Table>),
    /// The same, open for others, in a mode; from the menu only.
    Hosted(Arc<Table>, Mode),
    /// A game that was recorded.
    Replay(Box<Film>),
    /// Somebody's server: to play there, or to watch.
    Server {
        /// Where it listens.
        address: String,
        /// What to come for.
        role: Role,
        /// What it is to send.
        choice: StreamChoice,
    },
}

/// A picture to be taken.
#[derive(Debug, Clone)]
pub(crate) struct Screenshot {
    /// Where it goes.
    pub(crate) file: PathBuf,
    /// When, in seconds since the start.
    pub(crate) after: f64,
}

impl Screenshot {
    /// Makes sure, before anything is drawn, that the picture can be saved.
    ///
    /// # Errors
    /// One line that says why not.
    pub(crate) fn reserve(&self) -> Result<(), String> {
        let opened = std::fs::OpenOptions::new().append(true).create(true).open(&self.file);
        opened.map(drop).map_err(|error| format!("cannot write {}: {error}", self.file.display()))
    }
}

/// What the program runs on.
#[derive(Debug, Clone)]
pub(crate) struct Options {
    /// What to connect to.
    pub(crate) goal: Goal,
    /// Checked; `None`: as the settings say.
    pub(crate) name: Option<String>,
    /// Where settings are kept; `None`: nowhere.
    pub(crate) settings: Option<PathBuf>,
    /// A picture to be taken before quitting.
    pub(crate) screenshot: Option<Screenshot>,
    /// Frames a second, 0: no limit.
    pub(crate) fps: u32,
    /// How loud it is, 0 to 100, whatever the settings say.
    pub(crate) volume: Option<u8>,
    /// Whether the overlay is on from the start.
    pub(crate) overlay: bool,
    /// Whether to print statistics at the end.
    pub(crate) stats: bool,
    /// Where pictures to be compared go, if that is what is asked for.
    pub(crate) stills: Option<PathBuf>,
}

impl Arguments {
    /// Reads what has to be read, and checks the rest.
    ///
    /// # Errors
    /// One line that says what is wrong.
    pub(crate) fn check(self) -> Result<Options, String> {
        let goal = match (self.command, self.table) {
            (None, table) => Goal::Own(load_table(table.as_deref().unwrap_or("classic"))?),
            (Some(Command::Replay(replay)), table) => {
                let table = replay.table.or(table);
                Goal::Replay(Box::new(film::read(&replay.file, table.as_deref())?))
            }
            (Some(_), Some(_)) => {
                return Err(
                    "--table is for a table of your own: the server that you connect to has chosen its".to_owned()
                );
            }
            (Some(Command::Play(to)), None) => to.goal(Role::Play),
            (Some(Command::Watch(to)), None) => to.goal(Role::Watch),
        };
        let screenshot = self.screenshot.map(|file| Screenshot { file, after: self.after });
        let settings = self.settings.or_else(settings::usual_file);
        let Self { name, fps, volume, overlay, stats, stills, .. } = self;
        Ok(Options { goal, name, settings, screenshot, fps, volume, overlay, stats, stills })
    }
}

impl Connect {
    fn goal(self, role: Role) -> Goal {
        let choice = StreamChoice { form: self.stream, hz: self.hz };
        Goal::Server { address: self.connect, role, choice }
    }
}

fn name(text: &str) -> Result<String, String> {
    check_name(text).map(|()| text.to_owned())
}

fn form(text: &str) -> Result<Form, String> {
    match text {
        "state" => Ok(Form::State),
        "inputs" => Ok(Form::Inputs),
        _ => Err("state or inputs would be right".to_owned()),
    }
}

fn rate(text: &str) -> Result<u8, String> {
    let rate = text.parse().ok().filter(|rate| RATES.contains(rate));
    rate.ok_or_else(|| "10, 20, 30 or 60 would be right".to_owned())
}

fn seconds(text: &str) -> Result<f64, String> {
    match text.parse::<f64>() {
        Ok(seconds) if (0.0..=86_400.0).contains(&seconds) => Ok(seconds),
        _ => Err("a number of seconds from 0 to 86400 would be right".to_owned()),
    }
}

/// Checks `HOST:PORT`; whether the host exists is found out later.
///
/// # Errors
/// What would be right.
pub(crate) fn check_address(text: &str) -> Result<String, String> {
    let right = "HOST:PORT would be right, such as 192.168.1.20:7777 or [::1]:7777";
    let (host, port) = text.rsplit_once(':').ok_or(right)?;
    let bare = host.strip_prefix('[').and_then(|host| host.strip_suffix(']'));
    let is_host = match bare {
        Some(six) => six.parse::<std::net::Ipv6Addr>().is_ok(),
        None => !host.is_empty() && !host.contains(|c: char| c == ':' || c.is_whitespace() || c.is_control()),
    };
    match port.parse::<u16>() {
        Ok(1..) if is_host => Ok(text.to_owned()),
        _ => Err(right.to_owned()),
    }
}

/// The picture's form follows from its name.
fn png(text: &str) -> Result<PathBuf, String> {
    let file = PathBuf::from(text);
    let is_png = file.extension().and_then(OsStr::to_str).is_some_and(|end| end.eq_ignore_ascii_case("png"));
    if is_png { Ok(file) } else { Err("a name that ends in .png would be right".to_owned()) }
}

#[cfg(test)]
mod tests {
    use super::*;

    fn check(arguments: &[&str]) -> Result<Options, String> {
        let arguments = std::iter::once("starball").chain(arguments.iter().copied());
        Arguments::try_parse_from(arguments).map_err(|error| error.to_string())?.check()
    }

    #[test]
    fn addresses() {
        for good in ["127.0.0.1:7777", "localhost:1", "[::1]:7777", "a.example:65535"] {
            assert_eq!(check_address(good).as_deref(), Ok(good));
        }
        for bad in
            ["", "localhost", "localhost:", ":7777", "localhost:0", "localhost:65536", "::1:7777", "a b:1", "[x]:1"]
        {
            assert!(check_address(bad).is_err(), "{bad}");
        }
    }

    #[test]
    fn commands() {
        assert!(matches!(check(&[]).unwrap().goal, Goal::Own(table) if table.name == "Classic"));
        let options = check(&["play", "--connect", "localhost:7777", "--name", "Ann"]).unwrap();
        let Goal::Server { address, role, choice } = options.goal else { panic!("{:?}", options.goal) };
        assert_eq!((address.as_str(), role, choice), ("localhost:7777", Role::Play, StreamChoice::default()));
        assert_eq!((options.name.as_deref(), options.fps), (Some("Ann"), 60));
        let settings = check(&["--settings", "x.ron"]).unwrap().settings;
        assert_eq!(settings.as_deref(), Some(std::path::Path::new("x.ron")));
        let watch = check(&["watch", "--connect", "[::1]:1", "--stream", "state", "--hz", "20"]).unwrap();
        let Goal::Server { role, choice, .. } = watch.goal else { panic!("{:?}", watch.goal) };
        assert_eq!((role, choice), (Role::Watch, StreamChoice { form: Some(Form::State), hz: Some(20) }));
        for (option, bad, right) in [("--hz", "15", "10, 20, 30 or 60"), ("--stream", "x", "state or inputs")] {
            assert!(check(&["play", "--connect", "[::1]:1", option, bad]).unwrap_err().contains(right));
        }
        assert!(check(&["watch", "--connect", "[::1]:1", "--overlay"]).unwrap().overlay && !options.overlay);
        assert!(check(&["play"]).unwrap_err().contains("--connect"));
        assert!(check(&["--name", " Ann"]).unwrap_err().contains("blanks"));
        assert!(check(&["--table", "x", "play", "--connect", "localhost:1"]).unwrap_err().contains("of your own"));
    }

    #[test]
    fn tables_and_pictures() {
        assert!(check(&["--table", "no such"]).unwrap_err().contains("no shipped table (classic, lighthouse)"));
        let file = std::env::temp_dir().join(format!("starball-{}.ron", std::process::id()));
        std::fs::write(&file, "(\n    format: 1,\n    nonsense: 2,\n)").unwrap();
        let problem = check(&["--table", file.to_str().unwrap()]).unwrap_err();
        std::fs::remove_file(&file).unwrap();
        assert!(problem.starts_with(&format!("{}:3: ", file.display())), "{problem}");
        let screenshot = check(&["--screenshot", "/no/such/folder/x.png"]).unwrap().screenshot.unwrap();
        assert!(screenshot.reserve().unwrap_err().starts_with("cannot write /no/such"));
        assert!(check(&["--screenshot", "x.jpg"]).unwrap_err().contains(".png"));
        assert!(check(&["--screenshot", "x.png", "--after", "-1"]).is_err());
    }
}
