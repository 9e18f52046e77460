//! The reference against twelve scenes solved in certified interval arithmetic, and against what can be said by hand.

use serde::Deserialize;
use shared::table::Table;

use super::*;

/// A solution as written: see `shared/tests/truth`.
#[derive(Deserialize)]
#[serde(rename = "Solution")]
struct Written {
    end: f64,
    events: Vec<Impact>,
}

#[derive(Deserialize)]
struct Impact(String, String, String, String);

/// A decimal text, to all of its digits.
fn decimal(text: &str) -> Wide {
    let (sign, text) = text.strip_prefix('-').map_or((1.0, text), |rest| (-1.0, rest));
    let (whole, part) = text.split_once('.').unwrap_or((text, ""));
    let digits = |text: &str| {
        text.bytes().fold(Wide::of(0.0), |sum, digit| sum * Wide::of(10.0) + Wide::of(f64::from(digit - b'0')))
    };
    let below = part.bytes().fold(Wide::of(1.0), |unit, _| unit * Wide::of(10.0));
    (digits(whole) + digits(part) / below) * Wide::of(sign)
}

macro_rules! truth {
    ($($name:literal)*) => {
        [$((
            $name,
            include_str!(concat!("../../../../shared/tests/truth/scenes/", $name, ".ron")),
            include_str!(concat!("../../../../shared/tests/truth/solutions/", $name, ".ron")),
        )),*]
    };
}

/// Each bounce of the certified solutions is found, at its place and time to twenty digits, as long as 106 bits can.
#[test]
fn the_certified_solutions_are_met_far_beyond_f64() {
    let all = truth!(
        "p01_box_bumpers" "p02_box_bumpers_e1" "p03_pegs200" "p04_graze_wall" "p05_narrow_v" "p06_fast_thin"
        "p07_tiny_ball" "p08_huge_offset" "p09_zero_g" "p10_strong_g" "p11_inside_circle" "p12_long_300"
    );
    let (mut sum, mut known) = (0, 0);
    for (name, scene, solution) in all {
        let table = Table::parse(name, scene).unwrap_or_else(|error| panic!("{error}"));
        let written: Written = ron::from_str(solution).unwrap_or_else(|error| panic!("{name}: {error}"));
        let extent = Extent { seconds: written.end, bounces: written.events.len() };
        let found = reference(&table.scene, extent);
        assert!(found.bounces.len() >= written.events.len().min(10), "{name}: {} bounces", found.bounces.len());
        let mut worst = 0.0_f64;
        for (place, (bounce, impact)) in found.bounces.iter().zip(&written.events).enumerate() {
            let origin = Vector::of(table.scene.origin);
            let there = Vector { x: decimal(&impact.2), y: decimal(&impact.3) };
            let off = (bounce.position + origin - there).length().to_f64();
            let late = (bounce.time - decimal(&impact.0)).size().to_f64();
            // A solution has 25 digits in all: far from the origin fewer of them stand behind the point.
            let places = impact.2.split_once('.').map_or(0, |(_, part)| part.len());
            let written_to: f64 = format!("2e-{places}").parse().unwrap_or_else(|error| panic!("{error}"));
            let allowed = written_to.max(if place < 10 { 1e-22 } else { 1e-11 });
            assert!(off < allowed && late < allowed, "{name}: bounce {place} of {}: {off:e} m, {late:e} s", impact.1);
            worst = worst.max(off);
        }
        let (count, of) = (found.bounces.len(), written.events.len());
        println!("{name:20} {count:4} of {of:4} bounces, worst {worst:.1e} m, {:?}", found.ending);
        sum += found.bounces.len();
        known += written.events.len();
    }
    println!("{sum} of {known}");
    // f64 can follow 633 of the bounces within a millimetre.
    assert!(sum > 600, "{sum} of {known}");
}
