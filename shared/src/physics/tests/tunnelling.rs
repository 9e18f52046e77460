//! No ball ever gets where no ball should be.

use crate::extremes::shots::{Shooting, shots};
use crate::physics::motion::Motion;

#[test]
fn no_shot_at_twenty_metres_a_second_passes_through_anything() {
    let told = shots(0..6000, &Shooting { seed: 1, fastest: 20.0, most_balls: 1, motion: Motion::Exact });
    println!("{told:?}");
    assert_eq!(told.lost(), 0, "{told:?}");
    assert!(told.impacts > 10_000, "{told:?}");
    assert!(told.deepest < 2e-4, "{told:?}");
}
