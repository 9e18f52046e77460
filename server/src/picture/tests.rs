//! What a picture holds, read back from its text.

use std::sync::Arc;

use serde_json::Value;

use super::*;
use crate::load_table;
use crate::simulate::{self, Player, Simulation, Watchers};

fn drawn(table: &Arc<Table>, player: Player, seconds: f64) -> (String, World) {
    let simulation = Simulation { seconds, player, seed: 1 };
    let mut recent = Recent::new(table, simulation.ticks(table), 2.0);
    let watchers = Watchers { recent: Some(&mut recent), ..Watchers::default() };
    let (game, _) = simulate::run(table, &simulation, watchers).expect("nothing is written");
    let world = game.world().clone();
    (svg(table, &world, &recent.finish(&world), 2.0), world)
}

fn bouncing_box() -> Arc<Table> {
    let text = include_str!("../../../shared/tables/scenes/box.ron");
    Arc::new(Table::parse("box.ron", text).expect("it is shipped"))
}

/// The points of all lines of a class.
fn lines(svg: &str, class: &str) -> Vec<Vec<DVec2>> {
    let starts = format!("<polyline class=\"{class}\"");
    let number = |text: &str| text.parse::<f64>().expect("a number");
    svg.lines()
        .filter(|line| line.starts_with(&starts))
        .map(|line| {
            let points = line.split("points=\"").nth(1).and_then(|rest| rest.split('"').next()).expect("points");
            let point = |pair: &str| pair.split_once(',').map(|(x, y)| DVec2::new(number(x), number(y)));
            points.split(' ').map(|pair| point(pair).expect("two numbers")).collect()
        })
        .collect()
}

#[test]
fn there_are_as_many_shapes_as_colliders_that_are_there() {
    let classic = load_table("classic").expect("it is shipped");
    for (table, player) in [(bouncing_box(), Player::Nobody), (classic, Player::Bot)] {
        let (text, world) = drawn(&table, player, 7.0);
        let present = world.scene().colliders.iter().filter(|collider| world.state().has(collider)).count();
        let shapes = text.matches("class=\"shape").count() - text.matches(" mover").count();
        assert_eq!(shapes, present);
        assert_eq!(text.matches("class=\"ball\"").count(), world.state().balls.len());
        assert!(text.starts_with("<svg ") && text.ends_with("</svg>\n"));
        assert!(!text.contains("NaN") && !text.contains("inf"));
    }
}

#[test]
fn the_dashed_flight_ends_where_the_trace_tells_of_the_next_impact() {
    let table = bouncing_box();
    let (text, _) = drawn(&table, Player::Nobody, 3.0);
    let flights = lines(&text, "flight");
    let mut bytes = Vec::new();
    let simulation = Simulation { seconds: 6.0, player: Player::Nobody, seed: 1 };
    let watchers = Watchers { trace: Some(&mut bytes), ..Watchers::default() };
    simulate::run(&table, &simulation, watchers).expect("a list takes everything");
    let trace = String::from_utf8(bytes).expect("JSON is text");
    let told: Vec<Value> = trace.lines().map(|line| serde_json::from_str(line).expect("a line of JSON")).collect();
    let next = told.iter().find(|line| line["t"].as_f64() > Some(3.0)).expect("it bounces on");
    let coordinate = |place: usize| next["pos"][place].as_f64().expect("a number");
    let place = DVec2::new(coordinate(0), coordinate(1)) - table.scene.origin;
    let [flight] = flights.as_slice() else { panic!("one ball, {} flights", flights.len()) };
    let end = *flight.last().expect("it has an end");
    assert!((end - place).length() < 1e-9, "{end} is not {place}");
}

#[test]
fn the_way_behind_joins_the_way_ahead() {
    let (text, world) = drawn(&bouncing_box(), Player::Nobody, 3.0);
    let now = Instant::start_of(world.state().tick);
    let (here, _) = world.state().balls[0].at(now, world.scene().tick_seconds);
    let (path, flight) = (lines(&text, "path"), lines(&text, "flight"));
    assert_eq!((path[0].last(), flight[0].first()), (Some(&here), Some(&here)));
    let impacts = text.matches("class=\"impact\"").count();
    assert!(impacts > 2 && lines(&text, "after").len() == impacts, "{impacts} impacts in two seconds");
}

#[test]
fn a_scene_without_anything_in_it_is_a_picture_as_well() {
    let scene = "Scene(gravity: (0.0, 0.0), balls: [(position: (5.0, 5.0))])";
    let table = Arc::new(Table::parse("scene.ron", scene).expect("it is one"));
    let (text, _) = drawn(&table, Player::Nobody, 0.0);
    assert!(text.contains("class=\"ball\"") && !text.contains("NaN"));
}

#[test]
fn names_from_files_are_no_markup() {
    assert_eq!(escaped("<a & \"b\">"), "&lt;a &amp; &quot;b&quot;&gt;");
}

#[test]
fn steps_are_one_two_or_five() {
    for (most, step) in [(1.0, 1.0), (0.99, 0.5), (4.9e-7, 2e-7), (73.0, 50.0), (0.1, 0.1), (0.0, 1.0)] {
        assert_eq!(nice_step(most), step, "{most}");
    }
}
