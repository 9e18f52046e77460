//! `--needs`: what a scene uses, and what each need costs.

use core::fmt::Write;
use std::sync::Arc;
use std::time::Instant as Clock;

use shared::physics::World;
use shared::physics::needs::Needs;
use shared::physics::scene::Scene;

use super::outcome::Spread;
use super::problem::Problem;

/// Ticks of one round, of all cases together, at the most.
const TICKS: u64 = 200_000;

/// For each need, nanoseconds a tick without and with it. Whoever has it, loses it where that leaves a scene that can be run:
/// flippers, plungers, targets, floors, sensors, plates and saucers are parts of the scene, and without them it is another.
pub fn text(problem: &Problem, rounds: usize, say: &mut dyn FnMut(&str)) -> String {
    let own = problem.cases[0].scene.needs;
    let mut variants = vec![("as it is".to_owned(), own)];
    for (place, need) in Needs::NAMES.into_iter().enumerate() {
        let mut flags = own.flags();
        flags[place] = !flags[place];
        variants.push((need.to_owned(), Needs::from_flags(flags)));
    }
    let scenes: Vec<Vec<Arc<Scene>>> = variants
        .iter()
        .map(|(_, needs)| {
            problem.cases.iter().map(|case| Arc::new(Scene::clone(&case.scene).with_needs(*needs))).collect()
        })
        .collect();
    let mut costs = vec![Vec::new(); variants.len()];
    for round in 0..rounds {
        say(&format!("{}: needs, round {} of {rounds}", problem.name, round + 1));
        for (scenes, costs) in scenes.iter().zip(&mut costs) {
            costs.push(nanoseconds_a_tick(scenes, problem.extent.seconds));
        }
    }
    let base = costs[0].clone();
    let median = |values: Vec<f64>| Spread::median(values).unwrap_or(f64::NAN);
    let mut out = format!("{} needs: {}.\n\n", problem.name, own.names().collect::<Vec<_>>().join(", "));
    let _ = writeln!(out, "| need | has it | ns a tick without | ns a tick with | difference |\n|---|---|---|---|---|");
    for ((place, (need, _)), costs) in variants.iter().enumerate().zip(costs).skip(1) {
        let has = own.flags()[place - 1];
        let is_part = matches!(
            need.as_str(),
            "flippers" | "plungers" | "targets" | "floors" | "sensors" | "kinds" | "hinges" | "saucers"
        );
        if has && (is_part || need == "ball-ball") {
            let _ = writeln!(out, "| {need} | yes | without it, it is another scene | {:.2} | |", median(base.clone()));
            continue;
        }
        let difference = median(costs.iter().zip(&base).map(|(a, b)| if has { b - a } else { a - b }).collect());
        let (without, with) = if has { (costs, base.clone()) } else { (base.clone(), costs) };
        let yes = if has { "yes" } else { "no" };
        let _ = writeln!(out, "| {need} | {yes} | {:.2} | {:.2} | {difference:+.2} |", median(without), median(with));
    }
    out.push_str("\nA need that the scene has and that is taken away makes another world of it (a ball that never rests, say): its\n");
    out.push_str("cost is that of the other world. One that it has not and that is given to it changes no bit.\n");
    out
}

fn nanoseconds_a_tick(scenes: &[Arc<Scene>], seconds: f64) -> f64 {
    let (mut ticks, mut nanoseconds) = (0_u64, 0.0);
    for scene in scenes {
        let most = ((seconds / scene.tick_seconds) as u64).min(TICKS / scenes.len() as u64).max(1);
        let mut world = World::new(Arc::clone(scene));
        let begun = Clock::now();
        for _ in 0..most {
            std::hint::black_box(world.step());
            if world.state().balls.is_empty() {
                break;
            }
        }
        nanoseconds += begun.elapsed().as_secs_f64() * 1e9;
        ticks += world.state().tick;
    }
    nanoseconds / ticks as f64
}
