//! An item of a page.

use shared::protocol::Role;

use super::{MenuAct, Page};

/// An item of a page.
#[derive(Debug, Clone, PartialEq)]
pub(crate) struct Item {
    /// What it is called.
    pub(crate) label: String,
    /// What there is to say about it while it has the focus, or empty.
    pub(crate) note: String,
    /// What it is.
    pub(crate) control: Control,
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
    /// The address: its label is what was typed.
    Address,
    /// Joins the room at the address.
    Join(Role),
}

impl Item {
    /// An item.
    pub(super) fn new(label: &str, control: Control) -> Self {
        Self { label: label.to_owned(), note: String::new(), control }
    }

    /// The same with something to say about it.
    pub(super) fn about(mut self, note: &str) -> Self {
        note.clone_into(&mut self.note);
        self
    }

    /// Whether something can be done with it.
    pub(crate) fn can_have_focus(&self) -> bool {
        !matches!(self.control, Control::Heading | Control::Words | Control::Pair(_))
    }
}
