//! The window's program: [`App::frame`] is the main flow, once a frame.

mod film;
mod menus;

use std::sync::Arc;
use std::time::Instant;

use macroquad::math::vec2;
use macroquad::texture::get_screen_data;
use macroquad::window::{screen_dpi_scale, screen_height, screen_width, set_fullscreen};
use shared::protocol::Hello;
use shared::table::Table;

use crate::arguments::{Goal, Options};
use crate::assemble;
use crate::audio::{Audio, Scene};
use crate::cinema::Cinema;
use crate::controls::Controls;
use crate::embedded::Embedded;
use crate::input::{Keyboard, Wish};
use crate::limiter::Limiter;
use crate::menu::{Menu, Page, Shelved};
use crate::net::{Connection, Incoming};
use crate::pictures::{self, Pictures};
use crate::pointer::Surface;
use crate::render::Renderer;
use crate::report::Report;
use crate::screens::{self, Words};
use crate::session::Session;
use crate::settings::Store;
use crate::view::View;

/// Whether there is a next frame.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub(crate) enum Step {
    /// There is.
    Continue,
    /// The program ends.
    Quit,
}

/// How the client stands to its server.
#[derive(Debug)]
enum State {
    /// No answer yet.
    Connecting(Connection),
    /// A game is to be seen.
    Live(Connection, Box<Session>),
    /// The connection has ended, or never stood.
    Lost { was_live: bool, reason: String },
}

/// Messages that one frame takes in at the most: four seconds' worth.
const MOST_HEARD: usize = 256;

/// The window's program.
pub(crate) struct App {
    options: Options,
    store: Store,
    /// What it is connected to, or to be.
    goal: Goal,
    /// The table that the title is shown over.
    home: Arc<Table>,
    /// All times are seconds since then.
    epoch: Instant,
    state: State,
    embedded: Option<Embedded>,
    /// A film that is watched instead of the game.
    cinema: Option<Cinema>,
    keyboard: Keyboard,
    controls: Controls,
    menu: Menu,
    /// The page of the last frame.
    last_page: Option<Page>,
    /// The tables to choose from, once somebody wants to.
    tables: Vec<Shelved>,
    /// When somebody chose to play who has no place yet.
    wants_place: Option<f64>,
    /// When the game at one's own table ended, if no other has begun.
    over_since: Option<f64>,
    renderer: Renderer,
    audio: Audio,
    /// The table that the renderer draws.
    table: Arc<Table>,
    /// The last frame: it stays on the screen when the connection is lost.
    view: View,
    limiter: Limiter,
    pictures: Pictures,
    wants_picture: bool,
    /// The window's size in the last frame.
    last_size: (f32, f32),
    shows_statistics: bool,
    shows_overlay: bool,
    report: Report,
}

impl App {
    /// Needs macroquad's window. `backdrop` is drawn until a server has sent its table.
    pub(crate) fn new(options: Options, store: Store, backdrop: Arc<Table>) -> Self {
        let mut app = Self {
            epoch: Instant::now(),
            state: State::Lost { was_live: false, reason: String::new() },
            embedded: None,
            cinema: None,
            keyboard: Keyboard::new(),
            controls: Controls::new(store.settings.keys.clone()),
            menu: Menu::default(),
            last_page: None,
            tables: Vec::new(),
            wants_place: None,
            over_since: None,
            goal: options.goal.clone(),
            home: Arc::clone(&backdrop),
            renderer: Renderer::new(&backdrop.file),
            audio: Audio::start(),
            view: View::default(),
            limiter: Limiter::new(options.fps),
            pictures: Pictures::new(options.settings.as_deref()),
            wants_picture: false,
            last_size: (0.0, 0.0),
            shows_statistics: false,
            shows_overlay: options.overlay,
            report: Report::default(),
            table: backdrop,
            store,
            options,
        };
        match &app.options.goal {
            Goal::Replay(film) => app.watch((**film).clone()),
            _ => app.connect(),
        }
        app
    }

    /// One frame. `wants_quit`: the window is being closed.
    pub(crate) fn frame(&mut self, wants_quit: bool) -> Step {
        let now = self.now();
        // 1. What the server said.
        self.hear();
        // 2. What the person at the window does.
        let goes_on = self.poll_input();
        // 3. The game as it is now: predicted for who plays, a little late for who watches.
        if let State::Live(connection, session) = &mut self.state {
            session.advance(now, &mut self.controls);
            send(connection, session);
        }
        self.advance_film(now);
        self.settle(now);
        self.let_hear();
        // 4. That as plain data.
        self.assemble(now);
        // 5. The picture.
        // A film has the screen for itself.
        let has_menu = self.menu.is_open() && self.cinema.is_none();
        let menu = has_menu.then(|| self.menu.view(&self.facts())).flatten();
        self.renderer.draw(&self.view, menu.as_ref());
        self.report.drawn(now);
        self.note_window();
        self.note_page();
        let is_pictured = self.take_picture(now);
        if wants_quit || !goes_on || is_pictured {
            return Step::Quit;
        }
        // 6. The rest of the frame's time.
        std::thread::sleep(self.limiter.pause(self.now()));
        Step::Continue
    }

    /// Ends the connection and the embedded server, and says what was counted.
    pub(crate) fn end(mut self) -> Report {
        if let State::Live(connection, session) = &mut self.state {
            session.leave();
            send(connection, session);
            self.report.add(&session.counts());
        }
        // A picture's run is not a player's.
        if self.options.screenshot.is_none() {
            self.store.save();
        }
        self.pictures.finish();
        self.report
    }

    fn now(&self) -> f64 {
        self.epoch.elapsed().as_secs_f64()
    }

    /// Connects, or tries again; a game's own server that has died is started anew.
    fn connect(&mut self) {
        let address = match &self.goal {
            Goal::Server { address, .. } => address.clone(),
            Goal::Replay(_) => return,
            Goal::Own(table) | Goal::Hosted(table, _) => {
                let mode = if let Goal::Hosted(_, mode) = self.goal { Some(mode) } else { None };
                let running = self.embedded.take().filter(Embedded::is_alive);
                match running.map_or_else(|| Embedded::start(Arc::clone(table), mode), Ok) {
                    Ok(embedded) => self.embedded.insert(embedded).address().to_string(),
                    Err(error) => return self.lose("NO SERVER HERE", &error),
                }
            }
        };
        let (role, choice) = self.role();
        let name = self.options.name.clone().unwrap_or_else(|| self.store.settings.player());
        let hello = Hello { name, role, stream: choice.stream(role) };
        match Connection::open(address, hello, self.epoch) {
            Ok(connection) => {
                self.state = State::Connecting(connection);
                match self.goal {
                    Goal::Own(_) => self.menu.show_title(),
                    Goal::Hosted(..) | Goal::Server { .. } => self.menu.show(Page::Connecting),
                    Goal::Replay(_) => {}
                }
            }
            Err(error) => self.lose(error.headline(), &error),
        }
    }

    /// The connection has ended: the screen says it in short, the terminal in full.
    fn lose(&mut self, headline: &str, error: &dyn std::error::Error) {
        let was_live = if let State::Live(_, session) = &self.state {
            self.report.add(&session.counts());
            true
        } else {
            false
        };
        tracing::warn!("{error}");
        let reason = match &self.goal {
            Goal::Server { address, .. } => format!("{headline}: {address}"),
            Goal::Own(_) | Goal::Hosted(..) | Goal::Replay(_) => headline.to_owned(),
        };
        self.state = State::Lost { was_live, reason };
        self.controls.release_all();
        self.menu.show(Page::Lost);
    }

    /// 1. Takes in everything that has come.
    fn hear(&mut self) {
        let (role, choice) = self.role();
        // A server that floods must not keep a frame from being drawn.
        for _ in 0..MOST_HEARD {
            let incoming = match &mut self.state {
                State::Connecting(connection) | State::Live(connection, _) => connection.poll(),
                State::Lost { .. } => None,
            };
            let Some(incoming) = incoming else { return };
            let heard = match (incoming, &mut self.state) {
                (Incoming::Welcome(welcome), State::Connecting(..)) => {
                    Session::new(&welcome, choice, role).map(|session| self.begin(session))
                }
                (Incoming::Message { at, message }, State::Live(_, session)) => session.hear(at, message),
                (Incoming::Ended(error), _) => return self.lose(error.headline(), &error),
                _ => Ok(()),
            };
            if let Err(error) = heard {
                return self.lose(error.headline(), &error);
            }
        }
    }

    fn begin(&mut self, session: Session) {
        if session.table().digest != self.table.digest {
            self.table = Arc::clone(session.table());
            self.renderer = Renderer::new(&self.table.file);
        }
        let before = std::mem::replace(&mut self.state, State::Lost { was_live: false, reason: String::new() });
        if let State::Connecting(connection) = before {
            let mut session = Box::new(session);
            match self.goal {
                Goal::Own(_) if self.wants_place.is_some() => session.play(),
                Goal::Own(_) | Goal::Replay(_) => {}
                Goal::Hosted(..) => self.menu.show(Page::Opened),
                Goal::Server { .. } => self.menu.close(),
            }
            self.state = State::Live(connection, session);
        }
    }

    /// 2. Handles input; `false` if the person wants to quit.
    fn poll_input(&mut self) -> bool {
        if self.cinema.is_some() {
            return self.poll_film();
        }
        let mut wishes = Vec::new();
        let mut events = Vec::new();
        if self.menu.is_open() {
            // A key that goes up in a menu must not be down in the next game.
            self.controls.release_all();
            self.keyboard.poll_menu(&mut events, |wish| wishes.push(wish));
        } else {
            let surface = self.surface();
            self.keyboard.poll(&mut self.controls, surface, |wish| wishes.push(wish));
        }
        for wish in wishes {
            match (wish, &mut self.state) {
                (Wish::Go, State::Live(_, session)) => session.play(),
                (Wish::Back, _) => self.open_pause(),
                (Wish::Pause, State::Live(_, session)) if session.can_pause() => self.open_pause(),
                (Wish::Film, _) => self.watch_last(),
                (Wish::FullScreen | Wish::Statistics | Wish::Overlay | Wish::Picture, _) => self.heed_everywhere(wish),
                (Wish::Vote(action), State::Live(_, session)) => session.vote(action),
                (Wish::Look(further), State::Live(_, session)) => session.look(further),
                (Wish::Go | Wish::Pause | Wish::Vote(_) | Wish::Look(_), _) => {}
            }
        }
        self.menu_input(events)
    }

    /// 3. What happened on the board that is seen large, to be heard.
    fn let_hear(&mut self) {
        self.audio.set_volume(self.options.volume.unwrap_or(self.store.settings.volume));
        let game = match &mut self.state {
            State::Live(_, session) => Some((session.take_fresh(), session)),
            _ => None,
        };
        if let Some(cinema) = &mut self.cinema {
            return cinema.let_hear(&mut self.audio);
        }
        let Some((events, session)) = game else { return self.audio.hush() };
        let (board, is_own) = (session.main_board(), matches!(self.goal, Goal::Own(_)));
        let Some(moment) = session.moment(board) else { return self.audio.hush() };
        let is_attract = is_own && session.place().is_none();
        self.audio.hear(&Scene { table: session.table(), board, moment: &moment, events: &events, is_attract });
    }

    /// What is under the player's pointers, while there is a game for them.
    fn surface(&self) -> Option<Surface> {
        let State::Live(_, session) = &self.state else { return None };
        session.place().filter(|_| !session.is_paused())?;
        let moment = session.moment(session.main_board());
        let size = vec2(screen_width(), screen_height()) * screen_dpi_scale();
        Some(Surface { size, ball_waits: moment.is_some_and(|moment| screens::is_on_plunger(moment.game)) })
    }

    /// What can be wished for whatever is on the screen.
    fn heed_everywhere(&mut self, wish: Wish) {
        match wish {
            Wish::FullScreen => {
                let is_full = &mut self.store.settings.full_screen;
                *is_full = !*is_full;
                set_fullscreen(*is_full);
            }
            Wish::Statistics => self.shows_statistics = !self.shows_statistics,
            Wish::Overlay => self.shows_overlay = !self.shows_overlay,
            Wish::Picture => self.wants_picture = true,
            _ => {}
        }
    }

    /// 4. Puts the frame's view together.
    fn assemble(&mut self, now: f64) {
        if let Some(cinema) = &mut self.cinema {
            self.view = cinema.view(self.shows_overlay);
        } else {
            self.assemble_game(now);
        }
        let settings = &self.store.settings;
        (self.view.reduced_flashing, self.view.marked_lights) = (settings.reduced_flashing, settings.marked_lights);
        self.view.text_scale = settings.text_scale;
        if settings.reduced_flashing {
            self.view.elements.iter_mut().for_each(|element| element.lit |= element.winks);
        }
        if self.shows_statistics {
            self.view.hud.message = self.statistics();
        }
        if let Some(word) = self.pictures.word(now) {
            self.view.hud.message = word.to_owned();
        }
    }

    fn assemble_game(&mut self, now: f64) {
        self.view = match &mut self.state {
            State::Live(_, session) => {
                let words = screens::live(session, &self.store.settings.keys, now);
                assemble::view_of(session, words, now, self.shows_overlay)
            }
            State::Connecting(_) | State::Lost { .. } => {
                let message = if let State::Connecting(_) = self.state { "CONNECTING" } else { "NO CONNECTION" };
                let words = Words { message: message.to_owned(), ..Words::default() };
                // What was seen last stands still behind the menu.
                let last = std::mem::take(&mut self.view);
                assemble::over(last, &self.table, words, now)
            }
        };
        if self.menu.is_open() {
            let hud = &mut self.view.hud;
            (hud.banner, hud.sub_banner) = (String::new(), String::new());
            if self.menu.page() == Some(Page::Title) {
                hud.keys = screens::playing_keys(&self.store.settings.keys, self.table.file.cabinet.is_some());
            }
        }
        if !self.shows_overlay {
            // Of a game that was lost.
            self.view.overlay = None;
        }
    }

    /// The size of a window that does not fill the screen is remembered.
    fn note_window(&mut self) {
        let scale = if cfg!(target_os = "macos") { 1.0 } else { screen_dpi_scale() };
        let size = (screen_width() * scale, screen_height() * scale);
        if size != self.last_size && !self.store.settings.full_screen {
            self.store.settings.remember_window(size.0, size.1);
        }
        self.last_size = size;
    }

    /// What F3 puts on the display.
    fn statistics(&self) -> String {
        let counts = match &self.state {
            State::Live(_, session) => session.counts(),
            _ => Default::default(),
        };
        let fps = self.report.fps();
        match counts.behind.now {
            Some(behind) => format!("FPS {fps:.0} BEHIND {:.0} DIFFERS {}", behind * 1000.0, counts.mismatches),
            None => format!("FPS {fps:.0} LEAD {:.0} WRONG {}", counts.lead, counts.wrong),
        }
    }

    /// Takes the pictures that were asked for; `true` if it is the one to quit after.
    fn take_picture(&mut self, now: f64) -> bool {
        if std::mem::take(&mut self.wants_picture) {
            self.pictures.take(now);
        }
        let Some(last) = self.options.screenshot.as_ref().filter(|screenshot| now >= screenshot.after) else {
            return false;
        };
        if let Err(error) = pictures::save(get_screen_data(), &last.file) {
            tracing::error!("{error}");
        }
        true
    }
}

/// Sends what a session has to say.
fn send(connection: &Connection, session: &mut Session) {
    session.take_outgoing().for_each(|message| connection.send(message));
}
