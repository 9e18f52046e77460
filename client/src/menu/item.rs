//! An item of a page.

use shared::protocol::Role;

use super::{MenuAct, Page, Shelved};
use crate::settings;

/// An item of a page.
#[derive(Debug, Clone, PartialEq)]
pub(crate) struct Item {
    /// What it is called.
    pub(crate) label: String,
    /// What there is to say about it while it has the focus, or empty.
    pub(crate) note: String,
    /// What it is.
    pub(crate) control: Control,
    /// It can have the focus although there is nothing to be done with it: a page that is only read is moved so.
    pub(crate) is_read: bool,
}

/// What an item is.
#[derive(Debug, Clone, PartialEq)]
pub(crate) enum Control {
    /// A heading above others.
    Heading,
    /// Words to read, as many lines as they take.
    Words,
    /// Words with others at the right.
    Pair(String),
    /// Opens a page.
    Open(Page),
    /// Goes a page back.
    Back,
    /// Has something done.
    Act(MenuAct),
    /// What is typed: its label is what there is of it.
    Field(Field),
    /// A number that can be more or less.
    Level {
        /// What it is.
        setting: Setting,
        /// How much.
        value: u8,
        /// The least, the most, and a step.
        range: (u8, u8, u8),
    },
    /// On or off.
    Switch {
        /// What it is.
        setting: Setting,
        /// Whether it is on.
        is_on: bool,
    },
    /// The keys of something on the table; `waits`: for one that is pressed now.
    Keys {
        /// What they work.
        control: settings::Control,
        /// Their labels.
        keys: String,
        /// The next key that is pressed is one of them, or no more.
        waits: bool,
    },
    /// A table, with its picture.
    Table(Shelved),
    /// Joins the room at the address.
    Join(Role),
}

/// What is typed.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub(crate) enum Field {
    /// Where a room is.
    Address,
    /// What others call the player.
    Name,
}

/// What can be set by a number: percent, or 0 and 1.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub(crate) enum Setting {
    /// Of the sound.
    Volume,
    /// Of the text.
    TextSize,
    /// The window fills the screen.
    FullScreen,
    /// Nothing flashes.
    ReducedFlashing,
    /// Lights have marks.
    MarkedLights,
}

impl Item {
    /// An item.
    pub(super) fn new(label: &str, control: Control) -> Self {
        Self { label: label.to_owned(), note: String::new(), control, is_read: false }
    }

    /// The same with something to say about it.
    pub(super) fn about(mut self, note: &str) -> Self {
        note.clone_into(&mut self.note);
        self
    }

    /// The same on a page that is only read.
    pub(super) fn read(mut self) -> Self {
        self.is_read = true;
        self
    }

    /// What is typed into it.
    pub(super) fn field(&self) -> Option<Field> {
        if let Control::Field(field) = self.control { Some(field) } else { None }
    }

    /// Whether the focus can be on it.
    pub(crate) fn can_have_focus(&self) -> bool {
        self.is_read || !matches!(self.control, Control::Heading | Control::Words | Control::Pair(_))
    }
}
