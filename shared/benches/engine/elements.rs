//! The cost of an event among ever more elements, at the same density: it should grow no faster than their logarithm.

use std::hint::black_box;

use super::scenes::{PULLS, posts, steps, world};
use super::timing::{Case, Effort, Times, nanoseconds};

const COUNTS: [usize; 7] = [10, 30, 100, 300, 1000, 3000, 10_000];
/// Long ticks, with several events each: what a quiet tick costs is not the question.
const TICK_HZ: u32 = 10;
const TICKS: u64 = 2000;

pub(crate) fn run(effort: Effort) {
    for (name, pull) in PULLS {
        let ticks = effort.of(TICKS);
        let tables = COUNTS.map(|count| posts(count, pull, TICK_HZ));
        let events = tables.each_ref().map(|table| steps(&mut world(&table.scene), ticks));
        let case = |place: usize| -> Case<'_> {
            let table = &tables[place];
            Box::new(move || {
                let mut world = world(&table.scene);
                nanoseconds(|| {
                    black_box(steps(&mut world, ticks));
                })
            })
        };
        let mut cases: Vec<Case<'_>> = (0..COUNTS.len()).map(case).collect();
        let times = Times::measure(effort, &mut cases);
        println!(
            "{name}: {:>8} {:>10} {:>10} {:>10} {:>12}",
            "elements", "events", "ns/event", "to 10", "log n/log 10"
        );
        for (place, count) in COUNTS.into_iter().enumerate() {
            let per_event = |place: usize| times.median(place) / events[place] as f64;
            println!(
                "{:width$}  {count:8} {:10} {:10.0} {:10.2} {:12.2}",
                "",
                events[place],
                per_event(place),
                times.ratio(place, 0) * events[0] as f64 / events[place] as f64,
                libm::log10(count as f64),
                width = name.len()
            );
        }
    }
}
