//! What is known to be out of its range, and why.

const HOPS: &str = "A ball on a rising flipper hops, ever lower, until it is pushed. Whether a hop ends in this part of a tick or the next \
    changes the shot, by up to a quarter of a degree: at 16 ticks a millisecond no step goes back.";
const BRIEF: &str = "A ball is caught only in the millisecond or two in which the flipper comes back from its stop; what gives way for longer on a \
    real machine, rubber and linkage, is not there.";
const DRAGGED: &str = "A moving flipper drags a ball along its surface by friction, and is not held back by it: that work comes from nowhere.";

/// Family, beginning of the figure's name, and the reason.
const KNOWN: &[(&str, &str, &str)] = &[
    ("aim", "from the cradle: places of", HOPS),
    ("aim", "from the inlane: places of", HOPS),
    ("live catch", "0.5 m/s: least left", BRIEF),
    ("live catch", "0.5 m/s: window", BRIEF),
    ("live catch", "1 m/s: window", BRIEF),
    ("live catch", "2 m/s: least left", BRIEF),
    ("live catch", "2 m/s: window", BRIEF),
    ("random shots", "energy beyond", DRAGGED),
];

/// Why a figure is known to be out of its range; `None`: it is not.
pub(super) fn why(family: &str, what: &str) -> Option<&'static str> {
    KNOWN.iter().find(|(name, begins, _)| *name == family && what.starts_with(begins)).map(|(.., why)| *why)
}
