//! The tables that come with the game. To add one: its file in `shared/tables`, and an entry here; every suite that runs over all
//! of them then runs it as well.

/// A table that comes with the game.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub struct Shipped {
    /// What it is asked for by, and its file is called.
    pub name: &'static str,
    /// What it is like, in a line for players: 1 to 60 printable characters.
    pub about: &'static str,
    /// What to shoot for, for players: sentences, the most important first, each of at most 120 printable characters.
    pub aims: &'static [&'static str],
    /// Its text.
    pub source: &'static str,
}

/// All of them. The first is played when nothing else is asked for.
pub const SHIPPED: &[Shipped] = &[
    Shipped {
        name: "classic",
        about: "Bumpers, a bank, a ramp and two locks under the stars",
        aims: &[
            "All three lanes at the top raise what the bonus is times",
            "Fell the whole bank, and a rush begins: orbits and ramp are worth a lot while its lights are lit",
            "A ball in the lock and one in the kickout: multiball, and the ramp is the jackpot",
            "Both orbits, lanes, bank and inlanes light the five stars: all of them on one ball are a feat",
        ],
        source: include_str!("../../tables/classic.ron"),
    },
    Shipped {
        name: "lighthouse",
        about: "Two decks, four flippers, and a lamp to light in the storm",
        aims: &[
            "Up to the tower: the stairs at the left, or either orbit all the way",
            "The four lanes on top light the lamp and raise what the bonus is times",
            "Fell the fog bank up there, and the boats in the harbour",
            "A ball in each nook of the tower: multiball",
            "Beam, fog, stairs, boats and lamp light the rays: all of them, and the light shines",
        ],
        source: include_str!("../../tables/lighthouse.ron"),
    },
];
