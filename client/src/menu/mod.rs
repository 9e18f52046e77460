//! The screens beside the game: pages of items, one of which has the focus. Knows neither window nor connection: inputs
//! come in, what is to be done goes out, and what is to be seen is a [`MenuView`].
//!
//! Items are made anew from what is the case ([`Facts`]) whenever they are needed (`pages`): a menu holds only what
//! nobody else knows, where the focus is and what was typed. Where items stand is the business of whoever draws them, who
//! says which one the pointer is on.

mod input;
mod item;
mod pages;

use macroquad::input::KeyCode;
use shared::protocol::{Mode, Role};

pub(crate) use input::{MenuEvent, MenuSorter};
pub(crate) use item::{Control, Item};
pub(crate) use pages::{Facts, Page, Room};

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
    /// It was pressed there.
    Press(usize),
    /// A wheel was turned: so many items down.
    Wheel(i8),
}

/// What is to be done.
#[derive(Debug, Clone, PartialEq)]
pub(crate) enum MenuAct {
    /// Play on the table that is seen.
    Play,
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
    /// The address that was typed.
    address: String,
    /// What is wrong with it.
    problem: String,
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

    /// Gives the screen to the game.
    pub(crate) fn close(&mut self) {
        self.stack.clear();
    }

    /// What is to be seen; `None` if the game has the screen.
    pub(crate) fn view(&self, facts: &Facts) -> Option<MenuView> {
        let open = self.stack.last()?;
        let items = open.page.items(facts, &self.address);
        let focus = focused(&items, open.focus);
        Some(MenuView { page: open.page, title: open.page.title(facts), items, focus, problem: self.problem.clone() })
    }

    /// Takes an input in; returns what is to be done.
    pub(crate) fn input(&mut self, input: MenuInput, facts: &Facts) -> Option<MenuAct> {
        let open = *self.stack.last()?;
        let items = open.page.items(facts, &self.address);
        let focus = focused(&items, open.focus);
        let item = items.get(focus)?;
        match input {
            MenuInput::Hover(at) => self.focus(focused_at(&items, at)?),
            MenuInput::Press(at) => {
                let at = focused_at(&items, at)?;
                self.focus(at);
                return self.confirm(items.get(at)?);
            }
            MenuInput::Wheel(down) => self.focus(step(&items, focus, down, false)),
            MenuInput::Key(KeyCode::Up | KeyCode::Left) => self.focus(step(&items, focus, -1, true)),
            MenuInput::Key(KeyCode::Down | KeyCode::Right | KeyCode::Tab) => self.focus(step(&items, focus, 1, true)),
            MenuInput::Key(KeyCode::Enter | KeyCode::KpEnter) => return self.confirm(item),
            MenuInput::Key(KeyCode::Space) if item.control != Control::Address => return self.confirm(item),
            MenuInput::Key(KeyCode::Escape) => return self.back(&items, focus),
            MenuInput::Key(KeyCode::Backspace) if item.control == Control::Address => {
                self.address.pop();
                self.problem.clear();
            }
            MenuInput::Char(letter) if item.control == Control::Address => self.type_in(&letter.to_string()),
            MenuInput::Paste(text) if item.control == Control::Address => self.type_in(text.trim()),
            MenuInput::Key(_) | MenuInput::Char(_) | MenuInput::Paste(_) => {}
        }
        None
    }

    fn open(&mut self, page: Page) {
        self.problem.clear();
        self.stack.push(Open { page, focus: 0 });
    }

    fn focus(&mut self, at: usize) {
        if let Some(open) = self.stack.last_mut() {
            open.focus = at;
        }
    }

    /// What an address cannot hold is not taken in.
    fn type_in(&mut self, text: &str) {
        let room = MOST_ADDRESS.saturating_sub(self.address.len());
        self.address.extend(text.chars().filter(char::is_ascii_graphic).take(room));
        self.problem.clear();
    }

    fn confirm(&mut self, item: &Item) -> Option<MenuAct> {
        match &item.control {
            Control::Open(page) => self.open(*page),
            Control::Back => {
                self.stack.pop();
            }
            Control::Act(act) => return Some(act.clone()),
            Control::Address | Control::Join(_) => {
                let Some(Page::Join(role)) = self.page() else { return None };
                match pages::address(&self.address) {
                    Ok(address) => return Some(MenuAct::Join { address, role }),
                    Err(problem) => self.problem = problem,
                }
            }
            Control::Heading | Control::Words | Control::Pair(_) => {}
        }
        None
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
            Page::Against | Page::Join(_) | Page::HowTo => {
                self.stack.pop();
                self.problem.clear();
                None
            }
        }
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
