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
            "Skill shot: launch the ball into the third of the lanes on top; all four raise what the bonus is times",
            "Fell the fog bank, lock a ball in the right nook, and shoot the cave: a storm of three balls",
            "In the storm the beam and the stairs are jackpots",
            "Fell the boats: the night watch. Up the stairs, then from the tower into the beam, within its time",
            "All six rays on one ball, and the light shines: every bumper counts for ten",
        ],
        source: include_str!("../../tables/lighthouse.ron"),
    },
];
