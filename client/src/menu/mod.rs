//! The screens beside the game: pages of items, one of which has the focus. Knows neither window nor connection: inputs
//! come in, what is to be done goes out, and what is to be seen is a [`MenuView`].
//!
//! Items are made anew from what is the case ([`Facts`]) whenever they are needed (`pages`): a menu holds only what
//! nobody else knows, where the focus is and what was typed. Where items stand is the business of whoever draws them, who
//! says which one the pointer is on.

mod input;
mod item;
mod pages;
mod shelf;

use macroquad::input::KeyCode;
use shared::protocol::{MOST_NAME, Mode, Role, check_name};

pub(crate) use input::{MenuEvent, MenuSorter};
pub(crate) use item::{Control, Field, Item, Setting};
pub(crate) use pages::{Facts, Page, Room};
pub(crate) use shelf::Shelved;

use crate::settings::bindings::MOST_KEYS;
use crate::settings::keys::Key;
use crate::settings::{self, Bindings};

/// Characters that an address may have: a host name has up to 253, and a port.
const MOST_ADDRESS: usize = 260;

/// What somebody does.
#[derive(Debug, Clone, PartialEq)]
pub(crate) enum MenuInput {
    /// A key went down, or repeats.
    Key(KeyCode),
    /// A letter was typed.
    Char(char),
    /// A text was pasted.
    Paste(String),
    /// The pointer moved onto an item.
    Hover(usize),
    /// It was pressed there, at that share of the item's width.
    Press(usize, f32),
    /// A wheel was turned: so many items down.
    Wheel(i8),
}

/// What is to be done.
#[derive(Debug, Clone, PartialEq)]
pub(crate) enum MenuAct {
    /// Play on the table that is seen.
    Play,
    /// Watch the last game again.
    Film,
    /// Play on that table.
    PlayOn(Shelved),
    /// Take that table for what comes.
    Take(Shelved),
    /// Open a room for others on that table.
    Host(Mode),
    /// Join a room, to play or to watch.
    Join {
        /// Where it is.
        address: String,
        /// What to come for.
        role: Role,
    },
    /// Go on with what is behind the menu.
    Resume,
    /// A new game on one's own table.
    Restart,
    /// Give the seat or the place in the line back, and watch.
    LeaveSeat,
    /// Connect once more.
    TryAgain,
    /// Back to the title.
    LeaveToTitle,
    /// A choice that is remembered.
    Set(Setting, u8),
    /// What others are to call the player.
    Name(String),
    /// Which keys work what.
    Bind(Bindings),
    /// End the program.
    Quit,
}

/// What is to be seen.
#[derive(Debug, Clone, PartialEq)]
pub(crate) struct MenuView {
    /// The page.
    pub(crate) page: Page,
    /// Its heading.
    pub(crate) title: String,
    /// What it offers.
    pub(crate) items: Vec<Item>,
    /// The item that has the focus.
    pub(crate) focus: usize,
    /// What is wrong with what was typed, or empty.
    pub(crate) problem: String,
}

/// A page that is open.
#[derive(Debug, Clone, Copy)]
struct Open {
    page: Page,
    focus: usize,
}

/// The screens beside the game.
#[derive(Debug, Default)]
pub(crate) struct Menu {
    /// Each page was opened from the one before it. Empty: the game has the screen.
    stack: Vec<Open>,
    /// What was typed.
    drafts: Drafts,
    /// What is wrong with it.
    problem: String,
}

/// What was typed, and not yet taken.
#[derive(Debug, Default)]
pub(crate) struct Drafts {
    address: String,
    /// `None`: as it is.
    name: Option<String>,
    /// What the next key is for.
    keys_of: Option<settings::Control>,
}

impl Menu {
    /// Whether there is a page on the screen.
    pub(crate) fn is_open(&self) -> bool {
        !self.stack.is_empty()
    }

    /// The page on the screen.
    pub(crate) fn page(&self) -> Option<Page> {
        self.stack.last().map(|open| open.page)
    }

    /// Opens a page in the place of all others.
    pub(crate) fn show(&mut self, page: Page) {
        self.stack.clear();
        self.open(page);
    }

    /// Opens the title, unless it is there, if only below other pages.
    pub(crate) fn show_title(&mut self) {
        if self.stack.first().is_none_or(|open| open.page != Page::Title) {
            self.show(Page::Title);
        }
    }

    /// Gives the screen to the game.
    pub(crate) fn close(&mut self) {
        self.stack.clear();
    }

    /// What is to be seen; `None` if the game has the screen.
    pub(crate) fn view(&self, facts: &Facts) -> Option<MenuView> {
        let open = self.stack.last()?;
        let items = open.page.items(facts, &self.drafts);
        let focus = focused(&items, open.focus);
        Some(MenuView { page: open.page, title: open.page.title(facts), items, focus, problem: self.problem.clone() })
    }

    /// Takes an input in; returns what is to be done.
    pub(crate) fn input(&mut self, input: MenuInput, facts: &Facts) -> Option<MenuAct> {
        let open = *self.stack.last()?;
        let items = open.page.items(facts, &self.drafts);
        let focus = focused(&items, open.focus);
        let item = items.get(focus)?;
        if let Some(control) = self.drafts.keys_of {
            match input {
                MenuInput::Key(KeyCode::Escape) | MenuInput::Press(..) => self.drafts.keys_of = None,
                MenuInput::Key(key) => return self.bind(control, key, facts),
                _ => {}
            }
            return None;
        }
        match input {
            MenuInput::Hover(at) => self.focus(focused_at(&items, at)?),
            MenuInput::Press(at, share) => {
                let at = focused_at(&items, at)?;
                self.focus(at);
                return match items.get(at)?.control {
                    // On its name.
                    Control::Level { .. } if share < 0.0 => None,
                    Control::Level { setting, range: (least, most, step), .. } => {
                        // As many steps as are drawn: what is never nothing has one for its least, too. A cast saturates.
                        let first = u8::from(least > 0);
                        let steps = (most - least) / step + first;
                        let value = (share.clamp(0.0, 1.0) * f32::from(steps)).round() as u8;
                        Some(MenuAct::Set(setting, least + value.max(first).saturating_sub(first) * step))
                    }
                    _ => self.confirm(items.get(at)?, facts),
                };
            }
            MenuInput::Key(KeyCode::Left) if is_choice(item) => return changed(item, false),
            MenuInput::Key(KeyCode::Right) if is_choice(item) => return changed(item, true),
            MenuInput::Wheel(down) => self.focus(step(&items, focus, down, false)),
            MenuInput::Key(KeyCode::Up | KeyCode::Left) => self.focus(step(&items, focus, -1, true)),
            MenuInput::Key(KeyCode::Down | KeyCode::Right | KeyCode::Tab) => self.focus(step(&items, focus, 1, true)),
            MenuInput::Key(KeyCode::Enter | KeyCode::KpEnter) => return self.confirm(item, facts),
            MenuInput::Key(KeyCode::Space) if item.field().is_none() => return self.confirm(item, facts),
            MenuInput::Key(KeyCode::Escape) => return self.back(&items, focus),
            MenuInput::Key(KeyCode::Backspace) => {
                return self.edit(item.field()?, facts, |text| {
                    text.pop();
                });
            }
            MenuInput::Char(letter) => return self.edit(item.field()?, facts, |text| text.push(letter)),
            MenuInput::Paste(more) => return self.edit(item.field()?, facts, |text| text.push_str(more.trim())),
            MenuInput::Key(_) => {}
        }
        None
    }

    fn open(&mut self, page: Page) {
        self.problem.clear();
        (self.drafts.name, self.drafts.keys_of) = (None, None);
        self.stack.push(Open { page, focus: 0 });
    }

    fn focus(&mut self, at: usize) {
        if let Some(open) = self.stack.last_mut() {
            open.focus = at;
        }
    }

    /// Changes what was typed; what cannot be is not taken in.
    fn edit(&mut self, field: Field, facts: &Facts, change: impl FnOnce(&mut String)) -> Option<MenuAct> {
        self.problem.clear();
        match field {
            Field::Address => {
                change(&mut self.drafts.address);
                self.drafts.address.retain(|letter| letter.is_ascii_graphic());
                // All of it is ASCII.
                self.drafts.address.truncate(MOST_ADDRESS);
                None
            }
            Field::Name => {
                let name = self.drafts.name.get_or_insert_with(|| facts.settings.name.clone());
                change(name);
                *name = name.chars().filter(|letter| !letter.is_control()).take(MOST_NAME).collect();
                let whole = name.trim();
                match check_name(whole) {
                    Err(problem) if !whole.is_empty() => {
                        self.problem = problem;
                        None
                    }
                    _ => Some(MenuAct::Name(whole.to_owned())),
                }
            }
        }
    }

    /// A key for something on the table: one that it has is taken away, another one is given to it.
    fn bind(&mut self, control: settings::Control, key: KeyCode, facts: &Facts) -> Option<MenuAct> {
        let Some(key) = Key::of(key) else {
            self.problem = "The game needs that key itself; another one would be right".to_owned();
            return None;
        };
        let mut bindings = facts.settings.keys.clone();
        let mut keys = bindings.keys(control).to_vec();
        if keys.contains(&key) {
            keys.retain(|known| *known != key);
        } else {
            keys.insert(0, key);
            keys.truncate(MOST_KEYS);
        }
        match bindings.rebind(control, keys) {
            Ok(()) => {
                self.problem.clear();
                self.drafts.keys_of = None;
                Some(MenuAct::Bind(bindings))
            }
            Err(problem) => {
                self.problem = problem.to_string();
                None
            }
        }
    }

    fn confirm(&mut self, item: &Item, facts: &Facts) -> Option<MenuAct> {
        match &item.control {
            Control::Open(page) => self.open(*page),
            Control::Back => self.close_page(),
            Control::Act(act) => return Some(act.clone()),
            Control::Field(Field::Address) | Control::Join(_) => {
                let Some(Page::Join(role)) = self.page() else { return None };
                match pages::address(&self.drafts.address) {
                    Ok(address) => return Some(MenuAct::Join { address, role }),
                    Err(problem) => self.problem = problem,
                }
            }
            Control::Table(shelved) => {
                if !self.stack.iter().any(|open| open.page == Page::Against) {
                    return Some(MenuAct::PlayOn(shelved.clone()));
                }
                let shelved = shelved.clone();
                self.close_page();
                return Some(MenuAct::Take(shelved));
            }
            Control::Level { value, range: (_, most, _), setting } if value == most => {
                let Control::Level { range: (least, ..), .. } = &item.control else { return None };
                return Some(MenuAct::Set(*setting, *least));
            }
            Control::Level { .. } | Control::Switch { .. } => return changed(item, true),
            Control::Keys { control, .. } => {
                self.problem.clear();
                self.drafts.keys_of = Some(*control);
            }
            Control::Field(Field::Name) => self.focus(step(&self.items(facts), self.stack.last()?.focus, 1, true)),
            Control::Heading | Control::Words | Control::Pair(_) => {}
        }
        None
    }

    /// The page before, or none.
    fn close_page(&mut self) {
        self.stack.pop();
        self.problem.clear();
        (self.drafts.name, self.drafts.keys_of) = (None, None);
    }

    fn items(&self, facts: &Facts) -> Vec<Item> {
        self.page().map_or_else(Vec::new, |page| page.items(facts, &self.drafts))
    }

    /// A page back. From the title it takes two: nobody should quit by accident.
    fn back(&mut self, items: &[Item], focus: usize) -> Option<MenuAct> {
        match self.page()? {
            Page::Title => {
                let quit = items.iter().position(|item| item.control == Control::Act(MenuAct::Quit))?;
                if quit == focus {
                    return Some(MenuAct::Quit);
                }
                self.focus(quit);
                None
            }
            Page::Pause | Page::Opened => Some(MenuAct::Resume),
            Page::Connecting | Page::Lost => Some(MenuAct::LeaveToTitle),
            Page::Against | Page::Join(_) | Page::HowTo | Page::Tables | Page::Settings | Page::Keys => {
                self.close_page();
                None
            }
        }
    }
}

/// Whether left and right choose a value of it.
fn is_choice(item: &Item) -> bool {
    matches!(item.control, Control::Level { .. } | Control::Switch { .. })
}

/// More or less of it, on or off.
fn changed(item: &Item, more: bool) -> Option<MenuAct> {
    match item.control {
        Control::Level { setting, value, range: (least, most, step) } => {
            let value = if more { value.saturating_add(step) } else { value.saturating_sub(step) };
            Some(MenuAct::Set(setting, value.clamp(least, most)))
        }
        Control::Switch { setting, .. } => Some(MenuAct::Set(setting, u8::from(more))),
        _ => None,
    }
}

/// The item at a place, or the first one after it that can have the focus.
fn focused(items: &[Item], at: usize) -> usize {
    (at..items.len()).chain(0..at.min(items.len())).find(|&at| items[at].can_have_focus()).unwrap_or(0)
}

/// A place, if its item can have the focus.
fn focused_at(items: &[Item], at: usize) -> Option<usize> {
    items.get(at).filter(|item| item.can_have_focus()).map(|_| at)
}

/// The next item up or down that can have the focus; after the last one comes the first if it goes `round`.
fn step(items: &[Item], from: usize, by: i8, round: bool) -> usize {
    let can: Vec<usize> = (0..items.len()).filter(|&at| items[at].can_have_focus()).collect();
    let Some(place) = can.iter().position(|&at| at == from) else { return from };
    let place = place as i64 + i64::from(by);
    let place = if round { place.rem_euclid(can.len() as i64) } else { place.clamp(0, can.len() as i64 - 1) };
    can[place as usize]
}

#[cfg(test)]
mod tests;
