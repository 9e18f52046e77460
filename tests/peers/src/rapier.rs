//! Rapier, of Dimforge: `rapier2d-f64`.
//!
//! Contacts, gravity and restitution are its own: a ball is stopped at a surface within a step and returned at the end of it, so
//! that it loses part of a step's way at each impact, and gravity acts in steps. A surface with a restitution below 1 returns a
//! ball in the first step of a contact only; nothing can be set about that. What no peer can do is in [`crate::stage`].

use rapier2d_f64::prelude::*;
use shared::physics::scene::Scene;

use crate::peer::{Moment, Peer, PeerWorld};
use crate::stage::{Stage, StageBall};

/// The engine.
#[derive(Debug, Clone, Copy)]
pub struct Rapier;

impl Peer for Rapier {
    fn name(&self) -> &'static str {
        "Rapier"
    }

    fn world(&self, scene: &Scene, hz: u32) -> Result<Box<dyn PeerWorld>, String> {
        let stage = Stage::of(scene)?;
        let mut world = PhysicsWorld::new();
        world.gravity = vector(stage.gravity);
        world.integration_parameters = parameters(hz);
        for piece in &stage.pieces {
            let shape = ColliderBuilder::segment(vector(piece.a), vector(piece.b));
            world.insert_collider(wall(&stage, shape, piece.restitution), None);
        }
        for disc in &stage.discs {
            let shape = ColliderBuilder::ball(disc.radius).translation(vector(disc.center));
            world.insert_collider(wall(&stage, shape, disc.restitution), None);
        }
        for ring in &stage.rings {
            let corners: Vec<_> = ring.corners.iter().map(|&corner| vector(corner)).collect();
            let pieces = (0..).zip((1..).take(corners.len() - 1).chain([0])).map(|(a, b)| [a, b]).collect();
            // Oriented: a ball that touches several pieces gets their common normal. Two-sided, it gets one from each corner
            // near it, and becomes faster and faster.
            let shape = ColliderBuilder::oriented_polyline(corners, Some(pieces));
            world.insert_collider(wall(&stage, shape, ring.restitution), None);
        }
        let balls = stage.balls.iter().map(|ball| insert(&mut world, &stage, ball)).collect();
        Ok(Box::new(RapierWorld { world, balls, scale: stage.scale }))
    }
}

/// The defaults, but for what is here. Tried on the truth's scenes: 8 solver iterations in place of 4 cost a quarter more and are no
/// better, 1 costs a fifth less and doubles the error; of other units of length (40, 0.1), softness, corrective velocity, allowed
/// error, prediction distance, warm starting, stabilization iterations and soft CCD none is better at all rates.
fn parameters(hz: u32) -> IntegrationParameters {
    let dt = 1.0 / f64::from(hz);
    IntegrationParameters {
        dt,
        // The default, 1, ends a step at the first impact of a fast ball and loses the rest of it. 4 take a third off the error at
        // 60 and 480 Hz, for half as much time again at 60 Hz and an eighth at 480, and nothing where the ball is slow. 10 are
        // better at 60 Hz only, and cost as much as they gain.
        max_ccd_substeps: 4,
        // The default, 1/6000 s, would forbid such substeps at the higher rates.
        min_ccd_dt: dt / 100.0,
        // On, a contact keeps its normal while the ball moves by up to 0.05 units: wrong at a post, at high rates. Off is no slower.
        contact_recycling: false,
        // The default, 400, is 10 m/s for the usual ball.
        normalized_max_linear_velocity: f64::MAX,
        ..IntegrationParameters::default()
    }
}

/// A wall that returns its own share: see [`insert`] for the balls'. Of two rules the later one in the order Average, Min,
/// Multiply, Max is applied, and a ball's is Average.
fn wall(stage: &Stage, shape: ColliderBuilder, restitution: f64) -> ColliderBuilder {
    let shape = shape.friction(0.0);
    if stage.ball_restitution > 0.0 {
        let share = restitution / stage.ball_restitution;
        shape.restitution(share).restitution_combine_rule(CoefficientCombineRule::Multiply)
    } else {
        shape.restitution(restitution).restitution_combine_rule(CoefficientCombineRule::Max)
    }
}

/// A ball. Two of them get the average of their restitutions: their own.
fn insert(world: &mut PhysicsWorld, stage: &Stage, ball: &StageBall) -> RigidBodyHandle {
    let body = RigidBodyBuilder::dynamic()
        .translation(vector(ball.position))
        .linvel(vector(ball.velocity))
        .lock_rotations()
        .can_sleep(false)
        .ccd_enabled(true);
    let shape = ColliderBuilder::ball(ball.radius)
        .mass(ball.mass)
        .friction(0.0)
        .restitution(stage.ball_restitution)
        .restitution_combine_rule(CoefficientCombineRule::Average);
    world.insert(body, shape).0
}

/// Rapier's vectors are of another version of glam.
fn vector(of: glam::DVec2) -> Vector {
    Vector::new(of.x, of.y)
}

struct RapierWorld {
    world: PhysicsWorld,
    balls: Vec<RigidBodyHandle>,
    scale: f64,
}

impl PeerWorld for RapierWorld {
    fn step(&mut self) -> Result<(), String> {
        self.world.step();
        Ok(())
    }

    fn balls(&mut self, into: &mut Vec<Moment>) -> Result<(), String> {
        into.clear();
        for &handle in &self.balls {
            let body = self.world.bodies.get(handle).ok_or("Rapier has lost a ball")?;
            let (position, velocity) = (body.translation(), body.linvel());
            into.push(Moment {
                position: glam::DVec2::new(position.x, position.y) / self.scale,
                velocity: glam::DVec2::new(velocity.x, velocity.y) / self.scale,
            });
        }
        Ok(())
    }
}
