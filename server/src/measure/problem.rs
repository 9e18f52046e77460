//! What is measured: a table's scenes, each with its reference.

use std::sync::Arc;

use shared::game::Game;
use shared::math::Rng;
use shared::physics::ball::{Instant, Support};
use shared::physics::needs::Needs;
use shared::physics::scene::{Role, Scene, StartBall};
use shared::table::Table;

use crate::simulate::{Inputs, Player, Simulation};

use super::real::{Real, Wide};
use super::reference::{Arithmetic, Ending, Extent, Met, Solution, agree_until, is_present, reference, solve};

/// A scene and what becomes of it.
#[derive(Debug, Clone)]
pub struct Case {
    /// With its balls at their start.
    pub scene: Arc<Scene>,
    /// The reference.
    pub truth: Solution<Wide>,
    /// What any arithmetic of 53 bits can follow, to the tolerance: seconds and impacts.
    pub limit: (f64, usize),
    /// The same of 24 bits.
    pub limit_of_singles: (f64, usize),
    /// What becomes of the energy.
    pub energy: Conserved,
}

/// What becomes of a scene's energy.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub enum Conserved {
    /// It stays: nothing has friction, and every impact returns all.
    Kept,
    /// It falls at every impact.
    Falls,
    /// Something adds to it, be it a kicker or a ball's spin.
    Added,
}

/// A table, as it is measured.
#[derive(Debug, Clone)]
pub struct Problem {
    /// For people.
    pub name: String,
    /// The balls of the scene, or one case for each shot.
    pub cases: Vec<Case>,
    /// Whether the cases are shots on a played table.
    pub shots: bool,
    /// How far each is followed.
    pub extent: Extent,
    /// What counts as a departure, m.
    pub tolerance: f64,
}

/// Trials of which the first to depart tells how far an arithmetic can follow.
const TRIALS: u64 = 4;

impl Problem {
    /// The table's own balls, or `shots` moments of a game that the bot plays.
    ///
    /// # Errors
    /// If there is nothing in it to measure.
    pub fn of(table: &Table, extent: Extent, tolerance: f64, shots: usize) -> Result<Self, String> {
        let scenes = if table.has_rules { shots_of(table, shots) } else { vec![Scene::clone(&table.scene)] };
        let cases: Vec<Case> = scenes
            .into_iter()
            .map(|scene| Case::new(scene, extent, tolerance))
            .filter(|case| case.truth.end > 0.0)
            .collect();
        if cases.is_empty() {
            return Err(format!("{:?}: no ball of it flies freely, so there is nothing to compare", table.name));
        }
        Ok(Self { name: table.name.clone(), cases, shots: table.has_rules, extent, tolerance })
    }
}

impl Case {
    fn new(scene: Scene, extent: Extent, tolerance: f64) -> Self {
        let truth = reference(&scene, extent);
        let limit_at = |share: f64| {
            let trials = (0..TRIALS).map(|trial| {
                let mut rng = Rng::new(trial);
                let nudged = |value: f64| {
                    let sign = if rng.unit() < 0.5 { -share } else { share };
                    Wide::of(value) * (Wide::of(1.0) + Wide::of(sign))
                };
                agree_until(&truth, &solve(&scene, extent, Arithmetic::FULL, nudged), tolerance)
            });
            trials.min_by_key(|(_, bounces)| *bounces).unwrap_or_default()
        };
        let (limit, limit_of_singles) = (limit_at(1e-16), limit_at(6e-8));
        let energy = conserved(&scene, &truth);
        Self { scene: Arc::new(scene), truth, limit, limit_of_singles, energy }
    }
}

/// What becomes of the energy, by what is met.
fn conserved(scene: &Scene, truth: &Solution<Wide>) -> Conserved {
    let mut kept = truth.ending != Ending::Gone;
    for bounce in &truth.bounces {
        let (material, kicks) = match bounce.met {
            Met::Shape(index) => {
                let collider = &scene.colliders[index];
                (collider.material, matches!(collider.role, Role::Kicker { .. }))
            }
            Met::Ball(_) => (scene.ball_material, false),
        };
        if kicks || material.restitution > 1.0 || material.friction > 0.0 {
            return Conserved::Added;
        }
        kept &= material.restitution == 1.0 && material.falloff == 0.0 && material.tangential == 1.0;
    }
    if kept { Conserved::Kept } else { Conserved::Falls }
}

/// Longest game in which moments are looked for, seconds.
const LONGEST_GAME: f64 = 1200.0;
/// Seconds between two moments, at the least.
const BETWEEN: f64 = 1.0;
/// Slower than this a ball is not worth following, m/s.
const SLOWEST: f64 = 0.2;

/// Scenes with one ball, as it flew at seeded moments of a game of the bot's: all of them places and speeds that occur.
fn shots_of(table: &Table, count: usize) -> Vec<Scene> {
    let table = Arc::new(table.clone());
    let mut game = Game::new(Arc::clone(&table));
    let simulation = Simulation { seconds: LONGEST_GAME, player: Player::Bot, seed: SEED };
    let (mut player, mut rng) = (Inputs::new(&simulation), Rng::new(SEED));
    let dt = table.scene.tick_seconds;
    let (mut shots, mut inputs, mut next) = (Vec::new(), Vec::new(), 0.0);
    while shots.len() < count && game.tick() as f64 * dt < LONGEST_GAME {
        player.choose(&game, &mut inputs);
        game.step(&inputs);
        if (game.tick() as f64 * dt) < next {
            continue;
        }
        if let Some(scene) = shot(&game) {
            shots.push(scene);
            next = game.tick() as f64 * dt + BETWEEN * (1.0 + rng.unit());
        }
    }
    shots
}

/// What the moments follow from.
const SEED: u64 = 2026;

/// The scene with its ball as it flies now, if it flies freely and clear of flippers that lie at rest.
fn shot(game: &Game) -> Option<Scene> {
    let (world, scene) = (game.world(), game.world().scene());
    let ball = world.state().balls.first()?;
    let (position, velocity) = ball.at(Instant::start_of(game.tick()), scene.tick_seconds);
    let radius = scene.radius(ball.kind);
    let standing: Vec<_> = scene.targets_at_start().collect();
    let is_clear = scene.colliders.iter().all(|collider| {
        collider.role.is_passed()
            || !is_present(collider.presence, &standing)
            || collider.shape.distance(position) > radius * CLEAR
    });
    if ball.support != Support::None || velocity.length() < SLOWEST || !is_clear {
        return None;
    }
    let mut scene = Scene::clone(scene);
    scene.start = vec![StartBall { kind: ball.kind, position, velocity }];
    // As for a single ball that is served: what the table needs is known.
    let needs = Needs { ball_ball: false, ..scene.needs };
    Some(scene.with_needs(needs))
}

/// Radii from every surface at which a shot begins, at the least.
const CLEAR: f64 = 1.01;
