//! Random shots with several balls: nothing is lost, and no energy comes from nowhere.

use super::{Family, Figure};
use crate::extremes::shots::{MOST_BALLS, Shooting, shots};
use crate::physics::motion::Motion;

pub(super) const SHOTS: Family = Family {
    name: "random shots",
    drill: "5,000 shots of 1 to 5 balls on Classic at up to 10 m/s, the fastest in play, flippers flipping at random for 150 ms. The energy of balls and flippers \
        is compared with that of the start and what was given since: coils and return springs by torque times angle, kickers by \
        m k (e v + k / 2). Over all, where losses make up for gains; and for each tick by itself, \
        at whose end a ball on an arc is seen as its piece of flight has it: with up to a thousandth more than it goes on with.",
    measure,
};

fn measure() -> Vec<Figure> {
    let told = shots(0..5000, &Shooting { seed: 5, fastest: 10.0, most_balls: MOST_BALLS, motion: Motion::Exact });
    vec![
        Figure::at_most("lost", told.lost() as f64, "", 0.0),
        Figure::at_most("deepest overlap", told.deepest, "m", 2e-4),
        Figure::at_most("energy beyond what was given since the start", told.excess, "J", 1e-9),
        Figure::at_most("energy beyond what was given in a tick", told.won, "J", 5e-3),
    ]
}
