//! What is known to be out of its range, and why.

const HOPS: &str = "A ball on a rising flipper hops, ever lower, until it is pushed. Whether a hop ends in this tick or the next, or the ball leaves \
    first, changes the shot by up to a degree: at 16 ticks a millisecond the jumps are gone.";
const RIGID: &str = "A flipper at its stop gives nothing way: a ball bounces off it as off a wall, and only in the few moments in which the flipper \
    comes back from its stop is it caught.";
const GRIPS_AT_ONCE: &str =
    "A ball that comes to lie on a surface with friction rolls from that moment on, however weakly it is pressed.";
const NO_SPIN_UP: &str = "What drives a ball outwards on a turning flipper moves its centre alone: the 2/7 that spin it up are not taken off.";

const DRAGGED: &str = "A moving flipper drags a ball along its surface by friction, and is not held back by it: that work comes from nowhere.";

/// Family, beginning of the figure's name, and the reason.
const KNOWN: &[(&str, &str, &str)] = &[
    ("aim", "from the cradle: places of", HOPS),
    ("aim", "from the cradle: worst jump", HOPS),
    ("aim", "from the inlane: places of", HOPS),
    ("aim", "from the inlane: worst jump", HOPS),
    ("live catch", "0.5 m/s: least left", RIGID),
    ("live catch", "0.5 m/s: window", RIGID),
    ("live catch", "1 m/s: window", RIGID),
    ("live catch", "2 m/s: least left", RIGID),
    ("live catch", "2 m/s: window", RIGID),
    ("slope", "thrown: slips for", GRIPS_AT_ONCE),
    ("ball on a turning arm", "rolls", NO_SPIN_UP),
    ("random shots", "energy beyond", DRAGGED),
];

/// Why a figure is known to be out of its range; `None`: it is not.
pub(super) fn why(family: &str, what: &str) -> Option<&'static str> {
    KNOWN.iter().find(|(name, begins, _)| *name == family && what.starts_with(begins)).map(|(.., why)| *why)
}
