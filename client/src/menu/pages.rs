//! What the pages offer.

use shared::protocol::{Mode, Role};

use super::{Control, Drafts, Field, Item, MenuAct, Setting, Shelved};
use crate::arguments::check_address;
use crate::embedded::USUAL_PORT;
use crate::settings::{self, LARGEST_TEXT, Settings};

/// A page.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub(crate) enum Page {
    /// What the game opens with.
    Title,
    /// How to play against those who watch.
    Against,
    /// Asks for the address of a room.
    Join(Role),
    /// The tables.
    Tables,
    /// What can be chosen and is remembered.
    Settings,
    /// Which keys work what.
    Keys,
    /// How it is played.
    HowTo,
    /// Over a game.
    Pause,
    /// A room for others has been opened.
    Opened,
    /// There is no answer yet.
    Connecting,
    /// A connection has ended, or never stood.
    Lost,
}

/// Where the person at the window is.
#[derive(Debug, Clone, Default, PartialEq, Eq)]
pub(crate) enum Room {
    /// At a table of their own.
    #[default]
    Own,
    /// In a room that they opened for others, who reach it there.
    Hosted(String),
    /// In somebody's room, which is there.
    Guest(String),
}

/// What is the case, as far as pages speak of it.
#[derive(Debug, Clone, Default, PartialEq)]
pub(crate) struct Facts {
    /// Name of the table.
    pub(crate) table: String,
    /// Those to choose from, once somebody wants to.
    pub(crate) tables: Vec<Shelved>,
    /// Where the person is.
    pub(crate) room: Room,
    /// They have a seat, or a place in the line.
    pub(crate) has_place: bool,
    /// Their last game can be watched again.
    pub(crate) has_film: bool,
    /// What works what on the table.
    pub(crate) keys: Vec<(String, String)>,
    /// What to shoot for on the table, sentence by sentence.
    pub(crate) aims: Vec<String>,
    /// What was chosen.
    pub(crate) settings: Settings,
    /// The connection has stood.
    pub(crate) was_live: bool,
    /// Why it does not, or empty.
    pub(crate) reason: String,
}

impl Page {
    /// The heading.
    pub(super) fn title(self, facts: &Facts) -> String {
        match self {
            Self::Title => "STARBALL",
            Self::Against => "AGAINST SPECTATORS",
            Self::Join(Role::Play) => "JOIN A ROOM",
            Self::Join(Role::Watch) => "WATCH A ROOM",
            Self::Tables => "TABLES",
            Self::Settings => "SETTINGS",
            Self::Keys => "KEYS",
            Self::HowTo => "HOW TO PLAY",
            Self::Pause if facts.room == Room::Own => "PAUSE",
            Self::Pause => "MENU",
            Self::Opened => "THE ROOM IS OPEN",
            Self::Connecting => "CONNECTING",
            Self::Lost if facts.was_live => "CONNECTION LOST",
            Self::Lost => "NO CONNECTION",
        }
        .to_owned()
    }

    /// What it offers.
    pub(super) fn items(self, facts: &Facts, drafts: &Drafts) -> Vec<Item> {
        match self {
            Self::Title => title(facts),
            Self::Against => against(facts),
            Self::Join(role) => join(role, &drafts.address),
            Self::Tables => tables(facts),
            Self::Settings => settings_page(facts, drafts),
            Self::Keys => keys(facts, drafts),
            Self::HowTo => how_to(facts),
            Self::Pause => pause(facts),
            Self::Opened => opened(facts),
            Self::Connecting => {
                let place = match &facts.room {
                    Room::Own => String::new(),
                    Room::Hosted(address) | Room::Guest(address) => address.clone(),
                };
                vec![Item::new(&place, Control::Words), act("BACK TO TITLE", MenuAct::LeaveToTitle)]
            }
            Self::Lost => vec![
                Item::new(&facts.reason, Control::Words),
                act("TRY AGAIN", MenuAct::TryAgain),
                act("BACK TO TITLE", MenuAct::LeaveToTitle),
                act("QUIT", MenuAct::Quit),
            ],
        }
    }
}

fn title(facts: &Facts) -> Vec<Item> {
    let film =
        facts.has_film.then(|| act("LAST GAME AGAIN", MenuAct::Film).about("Watch it as a film, in slow motion too"));
    let play = act("PLAY", MenuAct::Play).about(&format!("ENTER: a game on {}", facts.table));
    let rest = [
        Item::new("AGAINST SPECTATORS", Control::Open(Page::Against)).about("Open a room for others, or join one"),
        Item::new("WATCH", Control::Open(Page::Join(Role::Watch))).about("See a game that is played elsewhere"),
        Item::new("TABLES", Control::Open(Page::Tables)).about("Choose another table to play on"),
        Item::new("SETTINGS", Control::Open(Page::Settings)).about("Keys, sound, screen, your name"),
        Item::new("HOW TO PLAY", Control::Open(Page::HowTo)).about("The keys, and what to shoot for"),
        act("QUIT", MenuAct::Quit).about("ENTER or ESC: leave Starball"),
    ];
    std::iter::once(play).chain(film).chain(rest).collect()
}

fn against(facts: &Facts) -> Vec<Item> {
    let host = |label: &str, mode, about: &str| act(label, MenuAct::Host(mode)).about(about);
    vec![
        Item::new("OPEN A ROOM", Control::Heading),
        host(
            "CHALLENGE",
            Mode::Challenge,
            "Up to four alternate ball by ball. The winner stays, the next in line comes up",
        ),
        host("CROWD", Mode::Crowd, "You alone: whoever watches votes for what the table does to you next"),
        host(
            "HEAD TO HEAD",
            Mode::HeadToHead,
            "Two tables side by side, from the same moment; against the bot until somebody comes",
        ),
        Item::new(&format!("TABLE: {}", facts.table), Control::Open(Page::Tables)).about("The table of that room"),
        Item::new("OR GO TO ONE", Control::Heading),
        Item::new("JOIN BY ADDRESS", Control::Open(Page::Join(Role::Play))).about("The host's screen says which"),
        Item::new("BACK", Control::Back),
    ]
}

fn join(role: Role, address: &str) -> Vec<Item> {
    let (word, about) = match role {
        Role::Play => ("JOIN", "You play as soon as there is a place; until then you watch"),
        Role::Watch => ("WATCH", "You can join from there, with ENTER"),
    };
    vec![
        Item::new("ADDRESS OF THE ROOM", Control::Heading),
        Item::new(address, Control::Field(Field::Address))
            .about("Type it as the host's screen shows it, such as 192.168.1.20:7777"),
        Item::new(word, Control::Join(role)).about(about),
        Item::new("BACK", Control::Back),
    ]
}

fn tables(facts: &Facts) -> Vec<Item> {
    let card = |shelved: &Shelved| Item::new(&shelved.table.name, Control::Table(shelved.clone()));
    let mut items: Vec<Item> = facts.tables.iter().map(card).collect();
    items.push(Item::new("BACK", Control::Back));
    items
}

fn settings_page(facts: &Facts, drafts: &Drafts) -> Vec<Item> {
    let Settings { name, volume, full_screen, reduced_flashing, marked_lights, text_scale, .. } = &facts.settings;
    let level = |label: &str, setting, value, range| Item::new(label, Control::Level { setting, value, range });
    let switch = |label: &str, setting, is_on: &bool| Item::new(label, Control::Switch { setting, is_on: *is_on });
    // Casts saturate.
    let (text, most_text) = ((text_scale * 100.0).round() as u8, (LARGEST_TEXT * 100.0).round() as u8);
    vec![
        Item::new("YOUR NAME", Control::Heading),
        Item::new(drafts.name.as_ref().unwrap_or(name), Control::Field(Field::Name))
            .about("What others call you in the next room. Empty: your user name"),
        level("VOLUME", Setting::Volume, *volume, (0, 100, 10)),
        switch("FULL SCREEN", Setting::FullScreen, full_screen).about("F11 does the same"),
        level("TEXT SIZE", Setting::TextSize, text, (100, most_text, 20)),
        switch("REDUCED FLASHING", Setting::ReducedFlashing, reduced_flashing).about("Nothing flashes or shakes"),
        switch("MARKED LIGHTS", Setting::MarkedLights, marked_lights)
            .about("For eyes that do not tell all colours apart: lights differ by a mark as well"),
        Item::new("KEYS", Control::Open(Page::Keys)).about("Which keys work what"),
        Item::new("BACK", Control::Back),
    ]
}

fn keys(facts: &Facts, drafts: &Drafts) -> Vec<Item> {
    let bindings = &facts.settings.keys;
    let row = |control: settings::Control| {
        let waits = drafts.keys_of == Some(control);
        let keys = bindings.labels(control, settings::bindings::MOST_KEYS);
        let about = if waits {
            "Press a key: a new one is added, one that it has is taken away. ESC: neither"
        } else {
            "ENTER, and then a key to add or to take away"
        };
        Item::new(control.label(), Control::Keys { control, keys, waits }).about(about)
    };
    let mut items: Vec<Item> = settings::Control::ALL.into_iter().map(row).collect();
    items.push(act("THE USUAL KEYS", MenuAct::Bind(settings::Bindings::default())).about("As they were at first"));
    items.push(Item::new("BACK", Control::Back));
    items
}

fn how_to(facts: &Facts) -> Vec<Item> {
    let mut items =
        vec![Item::new("Keep the ball away from the drain with the flippers, and make points", Control::Words).read()];
    items.extend(facts.keys.iter().map(|(key, does)| Item::new(does, Control::Pair(key.clone())).read()));
    if !facts.aims.is_empty() {
        items.push(Item::new(&format!("ON {}", facts.table), Control::Heading));
        items.extend(facts.aims.iter().map(|aim| Item::new(&format!("* {aim}"), Control::Words).read()));
    }
    items.push(Item::new("OTHER KEYS", Control::Open(Page::Keys)).about("See them all, and choose others"));
    items.push(Item::new("BACK", Control::Back));
    items
}

fn pause(facts: &Facts) -> Vec<Item> {
    let mut items = Vec::new();
    match &facts.room {
        Room::Own => items.extend([act("RESUME", MenuAct::Resume), act("RESTART", MenuAct::Restart)]),
        Room::Hosted(address) => items.extend([
            Item::new("The game goes on meanwhile. Others find this room at", Control::Words),
            Item::new(address, Control::Heading),
            act("RESUME", MenuAct::Resume),
        ]),
        Room::Guest(_) => items.extend([
            Item::new("The game goes on meanwhile: it is not yours to stop.", Control::Words),
            act("RESUME", MenuAct::Resume),
        ]),
    }
    if facts.has_place && facts.room != Room::Own {
        items.push(act("GIVE UP THE SEAT", MenuAct::LeaveSeat).about("Others go on, and you watch"));
    }
    items.extend([
        Item::new("SETTINGS", Control::Open(Page::Settings)),
        Item::new("HOW TO PLAY", Control::Open(Page::HowTo)),
        act("LEAVE TO TITLE", MenuAct::LeaveToTitle),
        act("QUIT", MenuAct::Quit),
    ]);
    items
}

fn opened(facts: &Facts) -> Vec<Item> {
    let Room::Hosted(address) = &facts.room else { return pause(facts) };
    vec![
        Item::new("Others join or watch at", Control::Words),
        Item::new(address, Control::Heading),
        act("PLAY", MenuAct::Play).about("Take a seat now. Others can come while you play"),
        act("WATCH THE BOT", MenuAct::Resume).about("ENTER takes a seat at any time"),
        act("LEAVE TO TITLE", MenuAct::LeaveToTitle).about("Closes the room"),
    ]
}

fn act(label: &str, act: MenuAct) -> Item {
    Item::new(label, Control::Act(act))
}

/// An address as somebody types it: a port may be left out.
///
/// # Errors
/// What would be right.
pub(super) fn address(text: &str) -> Result<String, String> {
    let with_port = if text.contains(':') { text.to_owned() } else { format!("{text}:{USUAL_PORT}") };
    check_address(&with_port)
}
