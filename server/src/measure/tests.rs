//! The measuring as a whole: a scene with its known trade, and tables that ask for an accuracy.

use std::time::Duration;

use shared::physics::motion::Motion;
use shared::table::{Accuracy, Horizon, Table};

use super::contender::{Contender, Setting};
use super::front::{choose, dominated, front};
use super::outcome::{Effort, Fidelity, Outcome, Spread, measure};
use super::problem::Problem;
use super::reference::{Ending, Extent, reference};
use super::{Plan, plot, report};

const BOX: &str = include_str!("../../../shared/tables/scenes/box.ron");

fn table(text: &str) -> Table {
    Table::parse("scene.ron", text).unwrap_or_else(|error| panic!("{error}"))
}

/// Costs are made up, so that nothing depends on a clock.
fn outcomes(problem: &Problem, settings: &[(Motion, u32, f64)]) -> Vec<Outcome> {
    let contenders: Vec<Box<dyn Contender>> = settings
        .iter()
        .map(|&(motion, tick_hz, _)| Box::new(Setting { motion, tick_hz, pixel: None }) as Box<dyn Contender>)
        .collect();
    let effort = Effort { rounds: 0, patience: Duration::from_secs(60), budget: Duration::ZERO };
    let mut outcomes = measure(problem, &contenders, effort, &mut |_| ());
    for (outcome, &(.., cost)) in outcomes.iter_mut().zip(settings) {
        outcome.cost = Spread::of(vec![cost]);
    }
    outcomes
}

fn problem(text: &str, seconds: f64, tolerance: f64) -> Problem {
    let extent = Extent { seconds, bounces: 100 };
    Problem::of(&table(text), extent, tolerance, 0).unwrap_or_else(|error| panic!("{error}"))
}

#[test]
fn the_exact_model_is_right_to_rounding_and_the_others_are_off_as_much_as_they_are() {
    let problem = problem(BOX, 3.0, 1e-4);
    let told = outcomes(
        &problem,
        &[
            (Motion::Exact, 1000, 1.0),
            (Motion::Swept, 1000, 20.0),
            (Motion::Swept, 4000, 80.0),
            (Motion::Discrete, 1000, 15.0),
        ],
    );
    let third = |place: usize| told[place].error(1).unwrap_or_else(|| panic!("it has three bounces"));
    assert!(third(0) < 1e-14, "exact: {:e} m", third(0));
    assert!(
        third(1) > 1e-9 && third(1) > 4.0 * third(2),
        "swept: {:e} m, {:e} m with a quarter of the tick",
        third(1),
        third(2)
    );
    assert!(third(3) > third(1), "discrete: {:e} m", third(3));
    // Exact is the cheapest, too: nothing else is worth having.
    assert_eq!(front(&told), [0]);
    assert_eq!(dominated(&told), [None, Some(0), Some(0), Some(0)]);
    let text = report::text(&problem, &told);
    assert!(text.contains("There is no trade here: exact"), "{text}");
    let json = report::json(&problem, &told);
    assert_eq!(json["settings"][1]["dominated_by"]["model"], "exact");
    assert!(json["settings"][3]["error_at_bounce"]["3"].as_f64().is_some_and(|error| error > 1e-6), "{json}");
    let svg = plot::svg("a <title>", &told).unwrap_or_else(|error| panic!("{error}"));
    assert!(svg.starts_with("<svg") && svg.contains("a &lt;title&gt;") && svg.contains("discrete"), "{svg}");
    assert!(svg.matches("<circle").count() >= told.len(), "a dot for each");
}

#[test]
fn the_cheapest_that_keeps_a_tolerance_is_chosen_and_what_cannot_be_kept_is_refused() {
    let settings = [(Motion::Discrete, 1000, 1.0), (Motion::Swept, 16_000, 2.0), (Motion::Exact, 1000, 3.0)];
    let chosen = |tolerance, horizon| {
        let problem = problem(BOX, 3.0, tolerance);
        choose(&outcomes(&problem, &settings), &problem, &Accuracy { tolerance, horizon })
    };
    assert_eq!(
        chosen(1e-5, Horizon::Bounces(3)),
        Ok(1),
        "discrete is off by more after its first bounce; swept does, and costs less"
    );
    assert_eq!(chosen(1e-12, Horizon::Bounces(3)), Ok(2));
    let error = chosen(1e-15, Horizon::Seconds(3.0)).expect_err("no f64 can");
    assert!(error.contains("cannot be reached") && error.contains("the best is exact at 1000 Hz"), "{error}");
}

/// Discrete at 60 steps a second flies through this wall; that it is cheap is then no merit.
#[test]
fn a_ball_that_comes_through_a_wall_is_noticed_and_never_on_the_front() {
    let thin = "Scene(gravity: (0.0, 0.0), bounds: (-9.0, -9.0, 9.0, 9.0), balls: [(position: (0.1, 0.5), velocity: (7.0, 0.3))],
        elements: [Wall(points: [(1.0, 0.0), (1.0, 2.0)])])";
    let problem = problem(thin, 0.8, 1e-4);
    let told = outcomes(&problem, &[(Motion::Discrete, 60, 1.0), (Motion::Exact, 60, 5.0)]);
    assert_eq!((told[0].passed(), told[1].passed()), (1, 0));
    assert_eq!(front(&told), [1]);
    assert!(report::text(&problem, &told).contains("loses the ball"));
}

#[test]
fn energy_that_should_stay_is_seen_to_drift_in_the_models_that_push_balls_out() {
    let elastic = BOX.replace("restitution: 0.9", "restitution: 1.0");
    let problem = problem(&elastic, 2.0, 1e-4);
    let told = outcomes(&problem, &[(Motion::Exact, 1000, 1.0), (Motion::Discrete, 240, 1.0)]);
    let drift = |place: usize| told[place].energy().unwrap_or_else(|| panic!("everything is elastic"));
    assert!(drift(0) < 1e-13 && drift(1) > 1e-5, "{:e} and {:e}", drift(0), drift(1));
}

/// The shots begin where balls get in a game, and the reference follows them through friction, spin and kicks.
#[test]
fn shots_on_a_played_table_are_followed_exactly_until_the_ball_rolls_or_drains() {
    let table = Table::shipped("classic").and_then(Result::ok).unwrap_or_else(|| panic!("it is shipped"));
    let extent = Extent { seconds: 3.0, bounces: 100 };
    let problem = Problem::of(&table, extent, 1e-4, 8).unwrap_or_else(|error| panic!("{error}"));
    assert_eq!(problem.cases.len(), 8);
    let exact = Setting { motion: Motion::Exact, tick_hz: 1000, pixel: None };
    let mut bounces = 0;
    for case in &problem.cases {
        let told =
            exact.play(&case.scene, case.truth.end, Duration::from_secs(60)).unwrap_or_else(|error| panic!("{error}"));
        let did = Fidelity::of(case, &told, 1e-4);
        assert!(did.bounces + 1 >= case.limit.1, "{} of {:?}", did.bounces, case.limit);
        assert!(did.errors[0].is_none_or(|error| error < 1e-14), "{:?}", did.errors);
        assert_eq!(did.passed + did.escaped, 0);
        bounces += did.bounces;
    }
    assert!(bounces > 20, "{bounces} bounces are too few to tell");
}

#[test]
fn a_ball_that_comes_to_rest_ends_the_reference_and_many_balls_do_not() {
    let falls = "Scene(gravity: (0.0, -1.0), balls: [(position: (0.5, 0.3))],
        elements: [Wall(points: [(0.0, 0.0), (1.0, 0.0)], restitution: 0.0)])";
    let solution = reference(&table(falls).scene, Extent { seconds: 5.0, bounces: 100 });
    assert_eq!((solution.ending, solution.bounces.len()), (Ending::Rest, 1));
    let expected = (2.0 * (0.3 - 0.0135_f64)).sqrt();
    assert!((solution.end - expected).abs() < 1e-15);
    let gas = include_str!("../../../shared/tables/scenes/gas.ron");
    let problem = problem(gas, 0.5, 1e-6);
    let told = outcomes(&problem, &[(Motion::Exact, 1000, 1.0)]);
    assert!(told[0].error(2).is_some_and(|error| error < 1e-15), "{:?}", told[0].error(2));
    assert!(told[0].bounces() >= 10.0);
}

#[test]
fn a_plan_follows_what_is_asked_for() {
    let asked = |horizon| Plan::new(true, 1.0, Some(Accuracy { tolerance: 1e-3, horizon }));
    assert_eq!(asked(Horizon::Seconds(4.0)).extent.seconds, 4.0);
    assert!(asked(Horizon::Bounces(500)).extent.bounces >= 500);
    assert_eq!(asked(Horizon::Bounces(5)).tolerance, 1e-3);
}
