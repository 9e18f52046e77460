//! Many balls in one box: the exact model knows every meeting beforehand, the swept one looks again in every tick.

use std::hint::black_box;
use std::sync::Arc;

use shared::physics::motion::Motion;

use super::scenes::{PULLS, balls, steps, world};
use super::timing::{Case, Effort, Times, nanoseconds};

const COUNTS: [usize; 8] = [1, 2, 5, 10, 30, 100, 200, 300];
/// Ticks of one ball; of more balls fewer, so that each number takes about as long.
const TICKS: u64 = 20_000;

pub(crate) fn run(effort: Effort) {
    for (name, pull) in PULLS {
        println!(
            "{name}: {:>6} {:>14} {:>16} {:>16} {:>8}",
            "balls", "events/second", "exact ns/second", "swept ns/second", "ratio"
        );
        let mut loses_from = None;
        for count in COUNTS {
            let ticks = (effort.of(TICKS) / (count as u64)).max(100);
            let exact = balls(count, pull);
            let swept =
                exact.run_with(Some(Motion::Swept), None).map(Arc::new).unwrap_or_else(|error| panic!("{error}"));
            let events = steps(&mut world(&exact.scene), ticks);
            let timed = |scene| {
                let mut world = world(scene);
                nanoseconds(|| {
                    black_box(steps(&mut world, ticks));
                })
            };
            let mut cases: [Case<'_>; 2] = [Box::new(|| timed(&exact.scene)), Box::new(|| timed(&swept.scene))];
            let times = Times::measure(effort, &mut cases);
            let seconds = ticks as f64 / 1000.0;
            let ratio = times.ratio(0, 1);
            println!(
                "{:width$}  {count:6} {:14.0} {:16.0} {:16.0} {ratio:8.3}",
                "",
                events as f64 / seconds,
                times.median(0) / seconds,
                times.median(1) / seconds,
                width = name.len()
            );
            match ratio > 1.0 {
                true => loses_from = loses_from.or(Some(count)),
                false => loses_from = None,
            }
        }
        match loses_from {
            Some(count) => println!("{name}: exact costs more than swept from {count} balls on"),
            None => println!("{name}: exact costs less than swept with any of these numbers of balls"),
        }
    }
}
