//! Timing: cases that take turns.

use std::time::Instant;

/// How long to measure.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub(crate) enum Effort {
    /// For numbers that are written down.
    Full,
    /// To see whether it still runs.
    Quick,
}

impl Effort {
    fn rounds(self) -> usize {
        match self {
            Self::Full => 21,
            Self::Quick => 5,
        }
    }

    /// An amount of work, less of it when it has to be quick.
    pub(crate) fn of(self, full: u64) -> u64 {
        match self {
            Self::Full => full,
            Self::Quick => (full / 10).max(1),
        }
    }
}

/// Something to be timed: one call does its work once and returns the nanoseconds that this took. What has to be set up for
/// it is done in the call as well, before the clock runs.
pub(crate) type Case<'a> = Box<dyn FnMut() -> f64 + 'a>;

/// Nanoseconds of a piece of work.
pub(crate) fn nanoseconds(work: impl FnOnce()) -> f64 {
    let start = Instant::now();
    work();
    start.elapsed().as_secs_f64() * 1e9
}

/// The times of several cases, round by round.
pub(crate) struct Times {
    /// For each case, one a round.
    rounds: Vec<Vec<f64>>,
}

impl Times {
    /// Runs each case once in each round, after one round that does not count.
    pub(crate) fn measure(effort: Effort, cases: &mut [Case<'_>]) -> Self {
        for case in &mut *cases {
            case();
        }
        let mut rounds = vec![Vec::new(); cases.len()];
        for _ in 0..effort.rounds() {
            for (times, case) in rounds.iter_mut().zip(&mut *cases) {
                times.push(case());
            }
        }
        Self { rounds }
    }

    /// Nanoseconds of a case.
    pub(crate) fn median(&self, case: usize) -> f64 {
        median(self.rounds[case].clone())
    }

    /// How many times as long a case takes as another.
    pub(crate) fn ratio(&self, case: usize, other: usize) -> f64 {
        median(self.rounds[case].iter().zip(&self.rounds[other]).map(|(a, b)| a / b).collect())
    }
}

/// The middle one.
pub(crate) fn median(mut values: Vec<f64>) -> f64 {
    values.sort_by(f64::total_cmp);
    values[values.len() / 2]
}
