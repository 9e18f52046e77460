//! What menus have to do with the rest of the program: what they are told, and what is done when something was chosen.

use std::sync::Arc;

use macroquad::window::set_fullscreen;
use shared::protocol::{Form, Role};
use shared::table::{SHIPPED, Shipped, Table};

use super::{App, State, send};
use crate::arguments::Goal;
use crate::assemble;
use crate::menu::{Facts, MenuAct, MenuEvent, MenuInput, Page, Room, Setting, Shelved};
use crate::screens::{self, Words};
use crate::streams::StreamChoice;
use crate::view::View;

/// Seconds for which a seat at one's own table is waited for.
const SEAT_WAIT: f64 = 3.0;
/// Seconds after the end of a game at one's own table until the bot plays again.
const OVER_WAIT: f64 = 30.0;

impl App {
    /// What the pages speak of.
    pub(super) fn facts(&self) -> Facts {
        let room = match (&self.goal, &self.embedded) {
            (Goal::Own(_) | Goal::Replay(_), _) => Room::Own,
            (Goal::Hosted(..), Some(embedded)) => Room::Hosted(embedded.address_for_others().to_owned()),
            (Goal::Hosted(..), None) => Room::Hosted(String::new()),
            (Goal::Server { address, .. }, _) => Room::Guest(address.clone()),
        };
        let has_place = match &self.state {
            State::Live(_, session) => session.place().is_some() || session.line().is_some(),
            _ => false,
        };
        let (was_live, reason) = match &self.state {
            State::Lost { was_live, reason } => (*was_live, reason.clone()),
            _ => (false, String::new()),
        };
        let keys = screens::playing_keys(&self.store.settings.keys, self.table.file.cabinet.is_some());
        let shipped = SHIPPED.iter().find(|shipped| shipped.source == self.table.source);
        let aims = shipped.map_or(&[] as &[&str], |shipped| shipped.aims);
        let aims = aims.iter().map(|&aim| aim.to_owned()).collect();
        let settings = self.store.settings.clone();
        let has_film = self.last_film().is_some();
        let tables = self.tables.clone();
        Facts {
            table: self.table.name.clone(),
            tables,
            aims,
            room,
            has_place,
            has_film,
            keys,
            settings,
            was_live,
            reason,
        }
    }

    /// Gives the menu what happened; `false` if the person wants to quit.
    pub(super) fn menu_input(&mut self, events: Vec<MenuEvent>) -> bool {
        let page = self.menu.page();
        for event in events {
            let input = match event {
                MenuEvent::Input(input) => Some(input),
                MenuEvent::Pointer { at, pressed } => {
                    let item = self.renderer.menu_hit(at);
                    item.map(
                        |(item, share)| {
                            if pressed { MenuInput::Press(item, share) } else { MenuInput::Hover(item) }
                        },
                    )
                }
            };
            let act = input.and_then(|input| self.menu.input(input, &self.facts()));
            if let Some(act) = act
                && !self.act(act)
            {
                return false;
            }
        }
        if self.menu.page() == Some(Page::Tables) && self.tables.is_empty() {
            self.tables = self.read_tables();
        }
        if matches!(page, Some(Page::Settings | Page::Keys)) && self.menu.page() != page {
            self.store.save();
        }
        true
    }

    /// What is on the screen is in the log, for whoever wants to know.
    pub(super) fn note_page(&mut self) {
        let page = self.menu.page();
        if page != self.last_page {
            tracing::debug!("page: {page:?}");
            self.last_page = page;
        }
    }

    /// Does what was chosen; `false` if that is to quit.
    fn act(&mut self, act: MenuAct) -> bool {
        match act {
            MenuAct::Play => {
                self.menu.close();
                self.wants_place = Some(self.now());
                if let State::Live(_, session) = &mut self.state {
                    session.play();
                }
            }
            MenuAct::PlayOn(shelved) => {
                self.take(shelved);
                self.play_here();
            }
            MenuAct::Take(shelved) => self.take(shelved),
            MenuAct::Host(mode) => self.go(Goal::Hosted(self.table.clone(), mode)),
            MenuAct::Join { address, role } => {
                self.go(Goal::Server { address, role, choice: StreamChoice::default() });
            }
            MenuAct::Resume => {
                self.menu.close();
                self.pause(false);
            }
            MenuAct::Restart => {
                self.go(Goal::Own(self.table.clone()));
                self.play_here();
            }
            MenuAct::LeaveSeat => {
                if let State::Live(_, session) = &mut self.state {
                    session.leave();
                }
                self.menu.close();
            }
            MenuAct::Film => self.watch_last(),
            MenuAct::TryAgain => self.connect(),
            MenuAct::LeaveToTitle => self.show_title(),
            MenuAct::Set(setting, value) => self.set(setting, value),
            MenuAct::Name(name) => self.store.settings.name = name,
            MenuAct::Bind(bindings) => {
                self.controls.bind(bindings.clone());
                self.store.settings.keys = bindings;
            }
            MenuAct::Quit => return false,
        }
        true
    }

    /// The tables to choose from: those that come with the game, and one that was brought.
    fn read_tables(&self) -> Vec<Shelved> {
        let shelve = |table: Arc<Table>, about: &str| {
            // All lights take part, so that the picture shows them.
            let view = View { light_show: true, ..assemble::still_view(&table, Words::default(), 0.0) };
            Shelved { table, about: about.to_owned(), view: Arc::new(view) }
        };
        let read =
            |shipped: &Shipped| Table::shipped(shipped.name)?.ok().map(|table| shelve(table.into(), shipped.about));
        let mut tables: Vec<Shelved> = SHIPPED.iter().filter_map(read).collect();
        if tables.iter().all(|shelved| shelved.table.digest != self.home.digest) {
            tables.insert(0, shelve(Arc::clone(&self.home), "The table that you brought"));
        }
        tables
    }

    /// A game at the table that was just gone to, unless there is no server for it: the page that says so stays.
    fn play_here(&mut self) {
        if !matches!(self.state, State::Lost { .. }) {
            self.menu.close();
            self.wants_place = Some(self.now());
        }
    }

    /// Takes a table for what comes: the bot plays on it.
    fn take(&mut self, shelved: Shelved) {
        self.home = Arc::clone(&shelved.table);
        self.go(Goal::Own(shelved.table));
    }

    /// A choice acts at once, and is remembered.
    fn set(&mut self, setting: Setting, value: u8) {
        let settings = &mut self.store.settings;
        match setting {
            Setting::Volume => {
                settings.volume = value;
                // What was said at the start no longer holds.
                self.options.volume = None;
            }
            Setting::TextSize => settings.text_scale = f32::from(value) / 100.0,
            Setting::ReducedFlashing => settings.reduced_flashing = value > 0,
            Setting::MarkedLights => settings.marked_lights = value > 0,
            Setting::FullScreen => {
                settings.full_screen = value > 0;
                set_fullscreen(settings.full_screen);
            }
        }
    }

    /// Opens the page over a game, which stands still meanwhile if it is the person's own.
    pub(super) fn open_pause(&mut self) {
        self.controls.release_all();
        self.menu.show(Page::Pause);
        self.pause(true);
    }

    fn pause(&mut self, stands_still: bool) {
        if let State::Live(_, session) = &mut self.state {
            session.pause(stands_still);
        }
    }

    /// Back to the title, and to a table of one's own if the person is elsewhere.
    fn show_title(&mut self) {
        self.wants_place = None;
        self.pause(false);
        match (&self.goal, &mut self.state) {
            (Goal::Own(_), State::Live(_, session)) => {
                session.leave();
                self.menu.show(Page::Title);
            }
            _ => self.go(Goal::Own(self.home.clone())),
        }
    }

    /// Leaves what is there for something else.
    fn go(&mut self, goal: Goal) {
        if let State::Live(connection, session) = &mut self.state {
            session.leave();
            send(connection, session);
            self.report.add(&session.counts());
        }
        if let Some(embedded) = self.embedded.take() {
            embedded.retire();
        }
        self.state = State::Lost { was_live: false, reason: String::new() };
        self.wants_place = None;
        self.goal = goal;
        self.connect();
    }

    /// A table of one's own at which nobody plays any more shows the title.
    pub(super) fn settle(&mut self, now: f64) {
        let (Goal::Own(_), State::Live(_, session)) = (&self.goal, &self.state) else { return };
        let is_over = session.place().is_some() && !session.is_playing() && !self.menu.is_open();
        self.over_since = is_over.then(|| self.over_since.unwrap_or(now));
        if self.over_since.is_some_and(|since| now - since > OVER_WAIT) {
            self.show_title();
        } else if session.place().is_some() {
            self.wants_place = None;
        } else if !self.menu.is_open() && self.wants_place.is_none_or(|since| now - since > SEAT_WAIT) {
            self.wants_place = None;
            self.menu.show(Page::Title);
        }
    }

    /// What the program comes to a room for, and the streams that it wants.
    pub(super) fn role(&self) -> (Role, StreamChoice) {
        match self.goal {
            Goal::Server { role, choice, .. } => (role, choice),
            // It is all on this machine: as smooth as can be.
            // And what is pressed, so that a game can be watched again.
            Goal::Own(_) | Goal::Hosted(..) | Goal::Replay(_) => {
                (Role::Watch, StreamChoice { form: Some(Form::Inputs), hz: Some(60) })
            }
        }
    }
}
