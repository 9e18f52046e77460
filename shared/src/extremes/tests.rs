//! Every outcome of the suite is the expected one: it passes, or it is the limit that is stated, and no better.

use super::*;

fn expect(checks: &'static [Check]) {
    for check in checks {
        for motion in Motion::ALL {
            let known = check.known.iter().find(|known| known.motion == motion);
            let outcome = check.run(motion);
            println!("{}, {motion}: {outcome:?}", check.name);
            match (&outcome, known) {
                (Outcome::Passes { .. }, None) => {}
                // A figure that is stated ten times too large says nothing.
                (Outcome::Limit { measured, .. }, Some(known)) => {
                    let is_near = *measured > 0.1 * known.within || *measured == known.within;
                    assert!(is_near, "{}, {motion}: {measured:e} is far better than {known:?}", check.name);
                }
                (outcome, known) => panic!("{}, {motion}: {outcome:?} instead of {known:?}", check.name),
            }
            let may_be_limited = motion != Motion::Exact || check.name.starts_with("rolling");
            assert!(known.is_none() || may_be_limited, "{}: exact reaches every goal of bounces", check.name);
        }
    }
}

#[test]
fn symmetries_change_no_bit() {
    expect(symmetry::CHECKS);
}

#[test]
fn tolerances_are_kept() {
    expect(tolerance::CHECKS);
}

#[test]
fn energy_comes_from_nowhere_and_goes_nowhere() {
    expect(energy::CHECKS);
}

#[test]
fn sizes_speeds_and_masses_have_no_limit() {
    expect(limits::CHECKS);
}

#[test]
fn degenerate_places_are_like_others() {
    expect(places::CHECKS);
}

#[test]
fn time_may_be_long_short_or_old() {
    expect(ticks::CHECKS);
}

#[test]
fn no_random_shot_is_lost() {
    expect(shots::CHECKS);
}

#[test]
fn what_is_no_number_is_refused() {
    expect(refusals::CHECKS);
}

#[test]
fn shots_are_the_same_whichever_are_played_together() {
    let shooting = shots::Shooting { seed: 3, fastest: 50.0, most_balls: 5, motion: Motion::Exact };
    let all = shots::shots(0..60, &shooting);
    let parts = [40..60, 0..17, 17..40].map(|part| shots::shots(part, &shooting));
    let [a, b, c] = parts;
    assert_eq!(a.joined(b).joined(c), all);
}

/// A model that fails shows it: in the cell, under the table, and in the verdict.
#[test]
fn a_report_says_what_passes_what_is_limited_and_what_fails() {
    static CHECK: Check = Check {
        name: "a check",
        unit: "m",
        goal: 1e-9,
        known: &[Known { motion: Motion::Pixel, within: 1e-3, why: "It has pixels." }],
        measure: |motion| match motion {
            Motion::Discrete => Err("a number is not finite".to_owned()),
            Motion::Pixel => Ok(5e-4),
            Motion::Swept => Ok(2e-9),
            Motion::Exact => Ok(1e-10),
        },
    };
    let outcomes = Motion::ALL.iter().map(|&motion| CHECK.run(motion)).collect();
    let report = Report { rows: vec![(&CHECK, outcomes)] };
    let expected = "| what is checked | goal | discrete | pixel | swept | exact |
|---|---|---|---|---|---|
| a check | 1e-9 m | **fails** | 5e-4 m [1] | **fails** | passes |

1. It has pixels.

Worse than expected:

- a check, discrete: a number is not finite
- a check, swept: 2.00e-9 m instead of 1.00e-9 at the most
";
    assert_eq!(report.to_string(), expected);
    assert!(!report.is_as_expected());
}

/// What the case of mechanisms is there for happens in it.
#[test]
fn the_case_of_mechanisms_has_all_that_they_do() {
    use crate::physics::EventKind as E;
    for motion in crate::physics::motion::Motion::ALL {
        let cases = super::cases::all(motion);
        let Some(case) = cases.iter().find(|case| case.name == "mechanisms") else { panic!("it is gone") };
        let (mut run, mut counts) = (case.run(), [0; 5]);
        for _ in 0..case.ticks {
            run.step();
            for event in run.world.events() {
                match event.kind {
                    E::Spun { .. } => counts[0] += 1,
                    E::Passed { .. } => counts[1] += 1,
                    E::Held { .. } => counts[2] += 1,
                    E::Ejected { .. } => counts[3] += 1,
                    E::Struck { .. } => counts[4] += 1,
                    _ => {}
                }
            }
        }
        println!("{motion}: {counts:?}");
        assert!(counts.iter().all(|&count| count > 0), "{motion}: {counts:?}");
    }
}

/// Broke: a ball rode on a flipper as if nothing had happened when another one hit that, and sank into it by 9 mm.
#[test]
fn a_ball_on_a_flipper_that_another_one_hits_goes_on_otherwise() {
    use super::shots::{FASTEST, MOST_BALLS, Shooting, shots};
    let shooting = Shooting { seed: 2026, fastest: FASTEST, most_balls: MOST_BALLS, motion: Motion::Exact };
    for number in [379_335, 94_944] {
        let told = shots(number..number + 1, &shooting);
        println!("shot {number}: deepest overlap {:e} m", told.deepest);
        assert!(told.lost() == 0 && told.deepest < 3e-4, "{told:?}");
    }
}
