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
            "Skill shot: launch the ball into the middle one of the lanes on top",
            "All three lanes raise what the bonus is times",
            "Fell the whole bank: a rush. Both orbits and the ramp in its time, then the kickout: super jackpot",
            "A ball in the lock and one in the kickout: multiball. Then the ramp is the jackpot",
            "Orbits, lanes, bank and inlanes light five stars: an extra ball waits on the ramp",
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
