//! Starball: the game's window. Reads arguments, opens the window and runs [`app::App`] in it.
//!
//! `app` is the main flow. Below it: `net` (the connection), `session` (one connection's room), `streams` (what is asked for),
//! `timing`, `snapshots` and `prediction` (what is to be seen now), `controls`, `pointer` and `input` (hands), `settings`
//! (what they have chosen), `pictures` (what they keep), `menu`, `screens`, `effects`,
//! `overlay` and `assemble` (what goes into a `view`), `render` (draws it), `audio` (what is heard); `film` and `cinema` (games once more).

mod app;
mod arguments;
mod assemble;
mod audio;
mod budget;
mod cinema;
mod controls;
mod display;
mod effects;
mod embedded;
mod film;
mod input;
mod limiter;
mod menu;
mod moment;
mod net;
mod overlay;
mod pictures;
mod pointer;
mod prediction;
mod render;
mod report;
mod screens;
mod session;
mod settings;
mod snapshots;
mod stills;
mod streams;
mod timing;
mod view;

use std::cell::Cell;
use std::io::{IsTerminal, Write};
use std::path::PathBuf;
use std::process::ExitCode;
use std::rc::Rc;
use std::sync::Arc;

use clap::Parser;
use macroquad::input::{is_quit_requested, prevent_quit};
use macroquad::miniquad::conf::{Conf, Platform};
use macroquad::window::next_frame;
use shared::table::{SHIPPED, Table};
use tracing_subscriber::EnvFilter;

use app::{App, Step};
use arguments::{Arguments, Goal, Options, Screenshot};
use settings::Store;

fn main() -> ExitCode {
    match run() {
        Ok(()) => ExitCode::SUCCESS,
        Err(problem) => {
            eprintln!("starball: {problem}");
            ExitCode::FAILURE
        }
    }
}

fn run() -> Result<(), String> {
    let options = Arguments::parse().check()?;
    match (display::check(), &options.goal) {
        (Ok(()), _) => {
            // What the game's own server has to say is for a server's host, not for a player.
            log("warn,starball_server=error");
            match options.stills {
                Some(folder) => save_stills(folder),
                None => in_window(options),
            }
        }
        (Err(problem), Goal::Own(table)) if options.screenshot.is_none() && options.stills.is_none() => {
            log("info");
            without_window(&problem, Arc::clone(table))
        }
        (Err(problem), _) => Err(problem),
    }
}

/// Log lines go to the terminal; `level` holds unless RUST_LOG says otherwise.
fn log(level: &str) {
    let filter = EnvFilter::try_from_default_env().unwrap_or_else(|_| EnvFilter::new(level));
    tracing_subscriber::fmt()
        .with_env_filter(filter)
        .with_writer(std::io::stderr)
        .with_ansi(std::io::stderr().is_terminal())
        .with_target(false)
        .init();
}

/// Runs the program in a window until it is closed.
fn in_window(options: Options) -> Result<(), String> {
    options.screenshot.as_ref().map_or(Ok(()), Screenshot::reserve)?;
    let backdrop = match &options.goal {
        Goal::Own(table) | Goal::Hosted(table, _) => Arc::clone(table),
        Goal::Replay(film) => Arc::clone(film.table()),
        // Until the server has sent its own.
        Goal::Server { .. } => first_shipped()?,
    };
    let prints_report = options.stats;
    let report = Rc::new(Cell::new(None));
    let outcome = Rc::clone(&report);
    let store = Store::open(options.settings.clone());
    let (width, height) = store.settings.window;
    let conf = Conf {
        window_title: "Starball".to_owned(),
        window_width: width.into(),
        window_height: height.into(),
        fullscreen: store.settings.full_screen,
        high_dpi: true,
        window_resizable: true,
        platform: Platform { linux_wm_class: "starball", ..Platform::default() },
        ..Conf::default()
    };
    macroquad::Window::from_config(conf, async move {
        prevent_quit();
        let mut app = App::new(options, store, backdrop);
        while app.frame(is_quit_requested()) == Step::Continue {
            next_frame().await;
        }
        outcome.set(Some(app.end()));
    });
    if let (true, Some(report)) = (prints_report, report.take()) {
        say(&report);
    }
    Ok(())
}

/// Saves pictures of moments that are always the same.
fn save_stills(folder: PathBuf) -> Result<(), String> {
    let outcome = Rc::new(Cell::new(None));
    let told = Rc::clone(&outcome);
    let (width, height) = stills::SIZE;
    let conf = Conf { window_width: width.into(), window_height: height.into(), ..Conf::default() };
    macroquad::Window::from_config(conf, async move {
        told.set(Some(stills::save(&folder).await));
    });
    outcome.take().unwrap_or_else(|| Err("the window was closed before all pictures were saved".to_owned()))
}

fn first_shipped() -> Result<Arc<Table>, String> {
    let first = SHIPPED.first().ok_or("no table is shipped")?;
    Table::parse(first.name, first.source).map(Arc::new).map_err(|error| error.to_string())
}

/// Where there is no display, the bot plays for whoever watches from elsewhere.
fn without_window(problem: &str, table: Arc<Table>) -> Result<(), String> {
    let account = embedded::serve_alone(table, |address| {
        say(&format_args!(
            "{problem}: the bot plays at {address}, for this machine alone; to watch from another one, run \
             `cargo run --release -p starball-server -- --listen 0.0.0.0:7777` here and `cargo run --release -p \
             starball-client -- watch --connect {}:7777` there",
            embedded::own_address()
        ));
    });
    say(&account.map_err(|error| error.to_string())?);
    Ok(())
}

/// Prints a line. Whoever started the game may have closed its output; that is no reason to end.
fn say(line: &dyn std::fmt::Display) {
    let _ = writeln!(std::io::stdout(), "{line}");
}
