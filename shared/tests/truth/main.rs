//! The exact model against truth: twelve scenes whose every impact is known to 25 digits.
//!
//! `scenes/NAME.ron` is a scene file as anybody writes it, `solutions/NAME.ron` its impacts, computed in certified interval
//! arithmetic. The scenes are chaotic: a deviation grows by some power of ten at every few bounces, so that no engine that
//! rounds to 53 bits stays right for ever. Each solution says how long one can: the fewest bounces that any of several trials
//! kept whose start was changed by 1e-16. That is the limit that the engine is held to.
//!
//! `cargo test -p starball-shared --test truth -- --nocapture` prints a table.

mod digits;
mod run;
mod solution;

use std::sync::LazyLock;

use run::{Run, run};
use shared::physics::motion::Motion;
use solution::{Problem, problems};

/// World ticks a second, where a test does not say otherwise.
const TICK_HZ: u32 = 1000;
/// A bounce is kept when no error larger than this stands before it, m.
const KEPT: f64 = 1e-3;
/// Bounces by which a scene may be worse than its limit: the trials of which that is the worst differ by as much.
const LEEWAY: usize = 2;
/// By how much a moment is rounded at an impact, seconds: half a last place of 1, for flights and ticks of up to a second,
/// once for each of both.
const ROUNDED: f64 = f64::EPSILON;

static PROBLEMS: LazyLock<Vec<Problem>> = LazyLock::new(problems);
static RUNS: LazyLock<Vec<Run>> = LazyLock::new(|| runs(Motion::Exact));

fn runs(motion: Motion) -> Vec<Run> {
    PROBLEMS.iter().map(|problem| run(problem, motion, TICK_HZ)).collect()
}

/// Every problem with its run by the exact model.
fn solved() -> impl Iterator<Item = (&'static Problem, &'static Run)> {
    PROBLEMS.iter().zip(RUNS.iter())
}

/// How many bounces a run keeps.
fn kept(errors: &[f64]) -> usize {
    errors.iter().take_while(|&&error| error <= KEPT).count()
}

#[test]
fn every_scene_is_kept_as_long_as_53_bits_can() {
    println!("scene               kept  limit  known  error at 3  at 10 [m]");
    for (problem, run) in solved() {
        let errors = problem.errors(run);
        println!(
            "{:18} {:5} {:6} {:6}     {:7.1e} {:7.1e}",
            problem.name,
            kept(&errors),
            problem.limit(),
            errors.len(),
            errors[2],
            errors[9]
        );
    }
    let total: usize = solved().map(|(problem, run)| kept(&problem.errors(run))).sum();
    let limits: usize = solved().map(|(problem, _)| problem.limit()).sum();
    println!("{:18} {total:5} {limits:6}", "sum");
    for (problem, run) in solved() {
        let kept = kept(&problem.errors(run));
        match problem.solution.limit {
            Some(limit) => assert!(kept + LEEWAY >= limit, "{}: {kept} of {limit}", problem.name),
            None => {
                // The limit lies beyond the solution.
                assert_eq!(kept, problem.limit(), "{}", problem.name);
            }
        }
    }
    assert!(total as f64 >= 0.95 * limits as f64, "{total} of {limits} bounces");
}

/// Also a million metres from the origin, where a coordinate's last bit is 1.2e-10 m: the scene has an origin of its own.
#[test]
fn the_third_bounce_is_right_to_twelve_digits() {
    for (problem, run) in solved() {
        let error = problem.errors(run)[2];
        assert!(error < 1e-12, "{}: {error:e} m", problem.name);
    }
}

#[test]
fn what_is_hit_is_hit_in_the_order_of_the_solution() {
    for (problem, run) in solved() {
        let kept = kept(&problem.errors(run));
        let expected: Vec<&str> = problem.solution.events[..kept].iter().map(|event| event.element()).collect();
        let found: Vec<&str> = run.flights[1..].iter().map(|flight| flight.element.as_str()).take(kept).collect();
        assert_eq!(found, expected, "{}", problem.name);
    }
}

/// To the very end, far beyond where the solution can be followed.
#[test]
fn no_ball_escapes_or_passes_through_anything() {
    for (problem, run) in solved() {
        assert!(!run.escaped, "{}: the ball escaped", problem.name);
        let (depth, crossed) = problem.deepest_and_crossed(run);
        // As deep as rounding lets an impact leave the ball, over hundreds of them.
        assert!(depth < 1e-13, "{}: {depth:e} m deep", problem.name);
        assert_eq!(crossed, None, "{}: the ball's centre passed a wall", problem.name);
    }
}

/// A flight is a function of its start alone, and its end is found without regard to ticks: places and velocities of all
/// impacts are the same bits at any rate. Only the moments differ: a tick and an offset within it are rounded at every
/// impact, by half a last place of the flight's length and of the offset, together less than [`ROUNDED`].
#[test]
fn it_does_not_matter_how_long_a_tick_is() {
    println!(
        "scene              impacts   moments apart [s], places apart at bounce 10 [m], at 1, 100 and 16000 ticks a second"
    );
    for (problem, reference) in solved() {
        print!("{:18} {:7}", problem.name, reference.flights.len() - 1);
        for hz in [1, 100, 16_000] {
            let other = run(problem, Motion::Exact, hz);
            let late = other.later_by(reference);
            let apart = other.apart(reference, 10);
            print!("    {late:7.1e} {apart:7.1e}");
            assert!(other.same_bits(reference), "{} at {hz} Hz has other impacts", problem.name);
            let bound = ROUNDED * reference.flights.len() as f64;
            assert!(late <= bound, "{} at {hz} Hz: {late:e} s, more than {bound:e}", problem.name);
            // A moment's rounding is a way at the ball's speed; the way itself is rounded once.
            let bound = 10.0 * ROUNDED * reference.fastest() + f64::EPSILON;
            assert!(apart <= bound, "{} at {hz} Hz: {apart:e} m, more than {bound:e}", problem.name);
        }
        println!();
    }
}

/// A model that is wrong by a micrometre a tick keeps less than half, and one that tunnels is noticed.
#[test]
fn a_model_with_an_error_is_found_out() {
    let swept = runs(Motion::Swept);
    let kept_by =
        |runs: &[Run]| -> usize { PROBLEMS.iter().zip(runs).map(|(problem, run)| kept(&problem.errors(run))).sum() };
    let (worse, exact) = (kept_by(&swept), kept_by(&RUNS));
    assert!(2 * worse < exact, "{worse} bounces kept, {exact} by the exact model");
    let third = PROBLEMS[0].errors(&swept[0])[2];
    assert!(third > 1e-9, "{third:e}");
    let thin = PROBLEMS.iter().find(|problem| problem.name == "p06_fast_thin");
    let thin = thin.unwrap_or_else(|| panic!("it is one of the twelve"));
    let tunnelling = run(thin, Motion::Discrete, TICK_HZ);
    assert!(
        tunnelling.escaped || thin.deepest_and_crossed(&tunnelling).1.is_some(),
        "0.1 m a tick, and nothing missed"
    );
}
