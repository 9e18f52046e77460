//! What a scene would pay for what it does not need.

use std::hint::black_box;
use std::sync::Arc;

use shared::physics::needs::Needs;
use shared::physics::scene::Scene;

use super::scenes::{PULLS, bare, steps, table, world};
use super::timing::{Case, Effort, Times, nanoseconds};

/// Simulated.
const SECONDS: u64 = 100;

pub(crate) fn run(effort: Effort) {
    for (name, pull) in PULLS {
        let scene = Scene::clone(&bare(pull).scene);
        let own = scene.needs.flags();
        let mut variants = vec![("what it needs".to_owned(), scene.needs)];
        for (place, need) in Needs::NAMES.into_iter().enumerate().filter(|(place, _)| !own[*place]) {
            let mut flags = own;
            flags[place] = true;
            variants.push((format!("and {need}"), Needs::from_flags(flags)));
        }
        variants.push(("everything".to_owned(), Needs::ALL));
        compare(&format!("bare scene, {name}"), effort, &scene, &variants, effort.of(SECONDS));
    }
    let scene = Scene::clone(&table(include_str!("../../tests/truth/scenes/p03_pegs200.ron")).scene);
    let brute = Needs { broad_phase: false, ..scene.needs };
    let variants = vec![("grid".to_owned(), scene.needs), ("brute force".to_owned(), brute)];
    compare("p03_pegs200", effort, &scene, &variants, 10);
}

/// The same scene with more or fewer needs: the same flights, at another price.
fn compare(name: &str, effort: Effort, scene: &Scene, variants: &[(String, Needs)], seconds: u64) {
    let scenes: Vec<_> = variants.iter().map(|(_, needs)| Arc::new(Scene::with_needs(scene.clone(), *needs))).collect();
    let flight = |scene: &Arc<Scene>| {
        let mut world = world(scene);
        steps(&mut world, seconds * 1000);
        world.state().balls[0].flight
    };
    for (scene, (what, _)) in scenes.iter().zip(variants) {
        assert_eq!(flight(scene), flight(&scenes[0]), "{what}: another world");
    }
    let case = |scene| -> Case<'_> {
        Box::new(move || {
            let mut world = world(scene);
            nanoseconds(|| {
                black_box(steps(&mut world, seconds * 1000));
            })
        })
    };
    let mut cases: Vec<Case<'_>> = scenes.iter().map(case).collect();
    let times = Times::measure(effort, &mut cases);
    println!("{name:28} {:>14} {:>8}", "ns/sim second", "ratio");
    for (place, (what, _)) in variants.iter().enumerate() {
        println!("  {what:26} {:14.0} {:8.3}", times.median(place) / seconds as f64, times.ratio(place, 0));
    }
}
