//! How a contender did: its errors at the reference's own moments, and what it cost.

use std::time::Duration;

use super::contender::{Contender, Timed};
use super::problem::{Case, Conserved, Problem};
use super::real::{Real, Wide};
use super::trajectory::Trajectory;

/// The bounces at which errors are told.
pub const BOUNCES: [usize; 3] = [1, 3, 10];
/// Moments a second, besides the impacts, at which a departure is looked for.
const LOOKS: f64 = 200.0;

/// How well a contender did on a case.
#[derive(Debug, Clone, PartialEq)]
pub struct Fidelity {
    /// Error at each of [`BOUNCES`], m: at the reference's moment of it. Nothing where it has fewer.
    pub errors: [Option<f64>; 3],
    /// Seconds until the first departure.
    pub seconds: f64,
    /// Impacts before it.
    pub bounces: usize,
    /// Of those, how many that any arithmetic of 53 bits keeps: what lies beyond is luck.
    pub earned: usize,
    /// Whether there was none up to the reference's end.
    pub to_the_end: bool,
    /// Where energy should stay the most that it was off; where it should fall the most that an impact added. Shares of it.
    pub energy: Option<f64>,
    /// Balls that left the scene, though the reference's did not.
    pub escaped: u32,
    /// Times that a ball came through something.
    pub passed: u32,
    /// Whether every number is finite.
    pub finite: bool,
}

impl Fidelity {
    /// Compares what was told with the reference.
    pub fn of(case: &Case, told: &Trajectory, tolerance: f64) -> Self {
        let truth = &case.truth;
        let mut errors = [None; 3];
        let (mut departed, mut bounces) = (None, 0);
        let error = |ball: usize, time: Wide| {
            let there = truth.position(ball, time)?;
            Some(told.error(ball, time, there))
        };
        let is_off = |error: f64| error.is_nan() || error > tolerance;
        let mut looked = 0.0;
        for (place, bounce) in truth.bounces.iter().enumerate() {
            // Between the impacts: all balls.
            let time = bounce.time.to_f64();
            while departed.is_none() && looked < time {
                let off = (0..truth.flights.len()).any(|ball| error(ball, Wide::of(looked)).is_some_and(is_off));
                departed = off.then_some(looked);
                looked += 1.0 / LOOKS;
            }
            let off = told.error(bounce.ball, bounce.time, bounce.position);
            if let Some(which) = BOUNCES.iter().position(|&number| number == place + 1) {
                errors[which] = Some(off);
            }
            if departed.is_none() {
                departed = is_off(off).then_some(time);
                bounces += usize::from(departed.is_none());
            }
        }
        while departed.is_none() && looked < truth.end {
            let off = (0..truth.flights.len()).any(|ball| error(ball, Wide::of(looked)).is_some_and(is_off));
            departed = off.then_some(looked);
            looked += 1.0 / LOOKS;
        }
        let energy = told.energy(&case.scene);
        let escapes_before_end = |ball: usize| told.lost[ball].is_some_and(|lost| lost < truth.end);
        Self {
            errors,
            seconds: departed.unwrap_or(truth.end),
            bounces,
            earned: bounces.min(case.limit.1),
            to_the_end: departed.is_none(),
            energy: match case.energy {
                Conserved::Kept => Some(energy.drift),
                Conserved::Falls => Some(energy.gained),
                Conserved::Added => None,
            },
            escaped: told.escaped.iter().filter(|&&ball| truth.lost[ball].is_none() && escapes_before_end(ball)).count()
                as u32,
            passed: told.passed_through(&case.scene),
            finite: told.is_finite(),
        }
    }
}

/// Median with its quartiles.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct Spread {
    /// Half lie below.
    pub median: f64,
    /// A quarter lies below.
    pub low: f64,
    /// A quarter lies above.
    pub high: f64,
}

impl Spread {
    /// Of some numbers; `None` if there are none.
    pub fn of(mut values: Vec<f64>) -> Option<Self> {
        values.sort_by(f64::total_cmp);
        let at = |share: f64| values[((values.len() - 1) as f64 * share).round() as usize];
        (!values.is_empty()).then(|| Self { median: at(0.5), low: at(0.25), high: at(0.75) })
    }

    /// The median alone.
    pub fn median(values: impl IntoIterator<Item = f64>) -> Option<f64> {
        Self::of(values.into_iter().collect()).map(|spread| spread.median)
    }
}

/// How a contender did on a problem.
#[derive(Debug, Clone, PartialEq)]
pub struct Outcome {
    /// Of the contender.
    pub name: String,
    /// Of the contender.
    pub setting: String,
    /// Steps a second.
    pub hz: u32,
    /// Nanoseconds for a simulated second, over the rounds.
    pub cost: Option<Spread>,
    /// Of each case.
    pub cases: Vec<Fidelity>,
    /// Why it was not measured.
    pub failed: Option<String>,
}

impl Outcome {
    /// Median over the cases of the error at the place-th of [`BOUNCES`], m.
    pub fn error(&self, place: usize) -> Option<f64> {
        Spread::median(self.cases.iter().filter_map(|case| case.errors[place]))
    }

    /// Median over the cases of the seconds before the first departure.
    pub fn seconds(&self) -> f64 {
        Spread::median(self.cases.iter().map(|case| case.seconds)).unwrap_or(0.0)
    }

    /// Median over the cases of the impacts before it.
    pub fn bounces(&self) -> f64 {
        Spread::median(self.cases.iter().map(|case| case.bounces as f64)).unwrap_or(0.0)
    }

    /// Median over the cases of those impacts that are no luck.
    pub fn earned(&self) -> f64 {
        Spread::median(self.cases.iter().map(|case| case.earned as f64)).unwrap_or(0.0)
    }

    /// The worst over the cases in which it is known what should become of the energy.
    pub fn energy(&self) -> Option<f64> {
        self.cases.iter().filter_map(|case| case.energy).reduce(f64::max)
    }

    /// Of all cases together.
    pub fn escaped(&self) -> u32 {
        self.cases.iter().map(|case| case.escaped).sum()
    }

    /// Of all cases together.
    pub fn passed(&self) -> u32 {
        self.cases.iter().map(|case| case.passed).sum()
    }

    /// Whether it lost a ball that it should have kept: such a setting is no bargain.
    pub fn loses_balls(&self) -> bool {
        self.escaped() + self.passed() > 0 || !self.finite()
    }

    /// Whether every number of every case is finite.
    pub fn finite(&self) -> bool {
        self.cases.iter().all(|case| case.finite)
    }
}

/// How much is measured.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct Effort {
    /// Rounds of timing.
    pub rounds: usize,
    /// How long one run may take.
    pub patience: Duration,
    /// How long all timing may take.
    pub budget: Duration,
}

/// Lets every contender play the problem, and times them in turns, round by round, so that a busy machine slows all alike.
pub fn measure(
    problem: &Problem,
    contenders: &[Box<dyn Contender>],
    effort: Effort,
    say: &mut dyn FnMut(&str),
) -> Vec<Outcome> {
    let mut outcomes: Vec<Outcome> = Vec::with_capacity(contenders.len());
    for contender in contenders {
        say(&format!("{}: {} at {}", problem.name, contender.name(), contender.setting()));
        let mut outcome = Outcome {
            name: contender.name(),
            setting: contender.setting(),
            hz: contender.hz(),
            cost: None,
            cases: Vec::new(),
            failed: None,
        };
        for case in &problem.cases {
            match contender.play(&case.scene, case.truth.end, effort.patience) {
                Ok(told) => outcome.cases.push(Fidelity::of(case, &told, problem.tolerance)),
                Err(why) => {
                    outcome.failed = Some(why);
                    break;
                }
            }
        }
        outcomes.push(outcome);
    }
    time(problem, contenders, effort, say, &mut outcomes);
    outcomes
}

/// A round of one contender takes this long at the least, nanoseconds: shorter ones tell of cold caches.
const LEAST_TIMED: f64 = 3e6;
/// But no more often than so, however short the cases are.
const MOST_PASSES: u32 = 500;

fn time(
    problem: &Problem,
    contenders: &[Box<dyn Contender>],
    effort: Effort,
    say: &mut dyn FnMut(&str),
    outcomes: &mut [Outcome],
) {
    let begun = std::time::Instant::now();
    let mut costs = vec![Vec::new(); contenders.len()];
    for round in 0..effort.rounds {
        if round > 0 && begun.elapsed() > effort.budget {
            break;
        }
        say(&format!("{}: timing, round {} of {}", problem.name, round + 1, effort.rounds));
        for ((contender, outcome), costs) in contenders.iter().zip(&mut *outcomes).zip(&mut costs) {
            if outcome.failed.is_some() {
                continue;
            }
            let mut sum = Timed { nanoseconds: 0.0, seconds: 0.0 };
            for _ in 0..MOST_PASSES {
                if sum.nanoseconds >= LEAST_TIMED || outcome.failed.is_some() {
                    break;
                }
                for case in &problem.cases {
                    match contender.time(&case.scene, case.truth.end, effort.patience) {
                        Ok(timed) => {
                            sum.nanoseconds += timed.nanoseconds;
                            sum.seconds += timed.seconds;
                        }
                        Err(why) => {
                            outcome.failed = Some(why);
                            break;
                        }
                    }
                }
            }
            if outcome.failed.is_none() && sum.seconds > 0.0 {
                costs.push(sum.nanoseconds / sum.seconds);
            }
        }
    }
    for (outcome, costs) in outcomes.iter_mut().zip(costs) {
        outcome.cost = Spread::of(costs).filter(|_| outcome.failed.is_none());
    }
}
