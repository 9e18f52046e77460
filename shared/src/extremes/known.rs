//! What the motion models are known not to reach, and why: the reasons are shared by many checks.

use super::Known;
use crate::physics::motion::Motion;

/// It loses balls.
pub(super) const LOST: f64 = f64::INFINITY;

const LATE: &str = "Discrete and pixel notice an impact when they next look, and put the ball back by what it overlaps: every bounce is \
    late by up to a tick (discrete) or a pixel (pixel). From then on the ball is another one.";
const TUNNELS: &str =
    "Discrete looks once a tick: a ball that flies farther than its size in a tick comes through walls.";
const CHORD: &str = "Swept takes the chord of each tick for the flight, which is off by up to an eighth of acceleration times tick \
    squared (0.1 um at 1 kHz, 1 mm at 10 Hz, on a table): so are its impacts, and every bounce off something round multiplies it.";
const AXES: &str = "Pixel counts its steps along the axis along which a ball is faster: a scene that is turned is cut into other steps.";
const LIFTED: &str =
    "Discrete and pixel put a ball that overlaps back outside: where that is upwards, energy comes from nothing.";
const SAMPLED_REST: &str =
    "Discrete and pixel stay off the place of rest by what a ball sinks in within a tick before they look.";

const ROLLS: &str = "Every model follows a ball that rolls along an arc for one tick at a time, as a piece of parabola: an error that \
    falls with the tick, and is put right at the next one.";

const fn known(motion: Motion, within: f64, why: &'static str) -> Known {
    Known { motion, within, why }
}

/// Discrete and pixel bounce late.
pub(super) const fn late(discrete: f64, pixel: f64) -> [Known; 2] {
    [known(Motion::Discrete, discrete, LATE), known(Motion::Pixel, pixel, LATE)]
}

/// Discrete and pixel bounce late, swept follows chords.
pub(super) const fn late_and_chord(discrete: f64, pixel: f64, swept: f64) -> [Known; 3] {
    [known(Motion::Discrete, discrete, LATE), known(Motion::Pixel, pixel, LATE), known(Motion::Swept, swept, CHORD)]
}

/// Discrete loses the ball, pixel bounces late.
pub(super) const fn tunnels_or_late(pixel: f64) -> [Known; 2] {
    [tunnels(LOST), known(Motion::Pixel, pixel, LATE)]
}

/// Discrete loses the ball, pixel bounces late, swept follows chords.
pub(super) const fn tunnels_late_and_chord(pixel: f64, swept: f64) -> [Known; 3] {
    [tunnels(LOST), known(Motion::Pixel, pixel, LATE), known(Motion::Swept, swept, CHORD)]
}

/// Discrete loses balls.
pub(super) const fn tunnels(within: f64) -> Known {
    known(Motion::Discrete, within, TUNNELS)
}

/// Discrete and pixel gain energy.
pub(super) const fn lifted(discrete: f64, pixel: f64) -> [Known; 2] {
    [known(Motion::Discrete, discrete, LIFTED), known(Motion::Pixel, pixel, LIFTED)]
}

/// Discrete and pixel rest a little off.
pub(super) const fn sunk(discrete: f64, pixel: f64) -> [Known; 2] {
    [known(Motion::Discrete, discrete, SAMPLED_REST), known(Motion::Pixel, pixel, SAMPLED_REST)]
}

/// Discrete and pixel rest a little off, swept follows chords.
pub(super) const fn sunk_and_chord(discrete: f64, pixel: f64, swept: f64) -> [Known; 3] {
    [
        known(Motion::Discrete, discrete, SAMPLED_REST),
        known(Motion::Pixel, pixel, SAMPLED_REST),
        known(Motion::Swept, swept, CHORD),
    ]
}

/// All follow an arc tick by tick.
pub(super) const fn rolls(within: f64) -> [Known; 4] {
    [
        known(Motion::Discrete, within, ROLLS),
        known(Motion::Pixel, within, ROLLS),
        known(Motion::Swept, within, ROLLS),
        known(Motion::Exact, within, ROLLS),
    ]
}

/// Pixel is not the same in all directions.
pub(super) const fn axes(within: f64) -> Known {
    known(Motion::Pixel, within, AXES)
}
