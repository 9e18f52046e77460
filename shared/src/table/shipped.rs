//! The tables that come with the game. To add one: its file in `shared/tables`, and an entry here; every suite that runs over all
//! of them then runs it as well.

/// A table that comes with the game.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub struct Shipped {
    /// What it is asked for by, and its file is called.
    pub name: &'static str,
    /// What it is like, in a line for players: 1 to 60 printable characters.
    pub about: &'static str,
    /// Its text.
    pub source: &'static str,
}

/// All of them. The first is played when nothing else is asked for.
pub const SHIPPED: &[Shipped] = &[
    Shipped {
        name: "classic",
        about: "Bumpers, a bank, a ramp and two locks under the stars",
        source: include_str!("../../tables/classic.ron"),
    },
    Shipped {
        name: "lighthouse",
        about: "Two decks, four flippers, and a lamp to light in the storm",
        source: include_str!("../../tables/lighthouse.ron"),
    },
];
