//! The twelve scenes of the tests of truth, each for as long as its solution is known.

use std::hint::black_box;

use super::scenes::{steps, table, world};
use super::timing::{Case, Effort, Times, median, nanoseconds};

macro_rules! scenes {
    ($($name:literal for $seconds:literal)*) => {
        [$(($name, include_str!(concat!("../../tests/truth/scenes/", $name, ".ron")), $seconds)),*]
    };
}

pub(crate) fn run(effort: Effort) {
    let scenes = scenes!(
        "p01_box_bumpers" for 8.0
        "p02_box_bumpers_e1" for 10.0
        "p03_pegs200" for 10.0
        "p04_graze_wall" for 4.0
        "p05_narrow_v" for 1.487
        "p06_fast_thin" for 0.5
        "p07_tiny_ball" for 6.0
        "p08_huge_offset" for 5.0
        "p09_zero_g" for 15.0
        "p10_strong_g" for 1.884
        "p11_inside_circle" for 20.0
        "p12_long_300" for 73.0
    );
    println!("{:20} {:>14} {:>15} {:>10}", "", "events/second", "ns/sim second", "ns/event");
    let mut all = Vec::new();
    for (name, text, seconds) in scenes {
        let table = table(text);
        let ticks = (seconds * 1000.0) as u64;
        let events = steps(&mut world(&table.scene), ticks);
        // Several times over, so that the clock's own cost is none.
        let repeats = effort.of(200_000) / ticks + 1;
        let mut cases: [Case<'_>; 1] = [Box::new(|| {
            let mut worlds: Vec<_> = (0..repeats).map(|_| world(&table.scene)).collect();
            nanoseconds(|| {
                for world in &mut worlds {
                    black_box(steps(world, ticks));
                }
            })
        })];
        let total = Times::measure(effort, &mut cases).median(0) / repeats as f64;
        all.push(total / seconds);
        println!("{name:20} {:14.1} {:15.0} {:10.0}", events as f64 / seconds, total / seconds, total / events as f64);
    }
    println!("{:20} {:14} {:15.0}", "median", "", median(all));
}
