//! Golden runs arrive where the file says, and the file is that of these physics.

use std::fs;

use super::{SCENES, line};
use crate::physics::PHYSICS_VERSION;
use crate::table::{SHIPPED, Shipped, Table};

const FILE: &str = include_str!("../golden.txt");

/// What to do about another digest.
const ADVICE: &str = "A change that alters a golden run must raise PHYSICS_VERSION (and `physics` in the tables and their \
    description), and write the file anew: src/golden.rs says how. If none was meant to, it is a mistake.";

/// The file's words, line by line, without comments.
fn lines() -> Vec<Vec<&'static str>> {
    let lines = FILE.lines().filter(|line| !line.starts_with('#'));
    lines.map(|line| line.split_whitespace().collect()).collect()
}

#[test]
fn every_golden_run_is_what_it_always_was() {
    let file = lines();
    let mut wrong = Vec::new();
    let mut played = 0;
    for found in (0..).map_while(line) {
        played += 1;
        let found: Vec<_> = found.split_whitespace().collect();
        let &[name, model, early, late] = &found[..] else { panic!("{found:?}") };
        match file.iter().find(|line| line.starts_with(&[name, model])).map(|line| &line[2..]) {
            Some(&[expected, _]) if expected != early => {
                wrong.push(format!("{name}, {model}: early already, {early} instead of {expected}"));
            }
            Some(&[_, expected]) if expected != late => {
                wrong.push(format!("{name}, {model}: late only, {late} instead of {expected}"));
            }
            Some(&[_, _]) => {}
            _ => wrong.push(format!("{name}, {model}: not in the file")),
        }
    }
    assert!(wrong.is_empty(), "\n{}\n{ADVICE}", wrong.join("\n"));
    assert_eq!(file.len() - 1, played, "the file has a run that is not played any more");
}

#[test]
fn the_golden_file_and_every_table_have_the_version_of_these_physics() {
    let version = PHYSICS_VERSION.to_string();
    assert_eq!(lines()[0], ["physics", &version], "the golden file is of other physics. {ADVICE}");
    for &Shipped { name, source, .. } in SHIPPED {
        let table = Table::parse(&format!("{name}.ron"), source).unwrap_or_else(|error| panic!("{error}. {ADVICE}"));
        assert_eq!(table.file.physics, PHYSICS_VERSION, "{name}. {ADVICE}");
    }
}

/// A scene that nobody added to the list would be run by nothing.
#[test]
fn every_scene_is_run() {
    let folder = concat!(env!("CARGO_MANIFEST_DIR"), "/tables/scenes");
    let files = fs::read_dir(folder).unwrap_or_else(|error| panic!("{folder}: {error}"));
    let mut found: Vec<_> = files.flatten().map(|file| file.file_name().to_string_lossy().into_owned()).collect();
    found.sort();
    let mut listed: Vec<_> = SCENES.iter().map(|(name, ..)| format!("{name}.ron")).collect();
    listed.sort();
    assert_eq!(found, listed, "in tables/scenes, and in SCENES");
}
