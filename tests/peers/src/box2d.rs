//! Box2D v3, of Erin Catto: by the crate `boxdd`, which compiles it.
//!
//! Contacts, gravity and restitution are its own: a ball is stopped at a surface within a step and returned at the end of it, so
//! that it loses part of a step's way at each impact, and gravity acts in steps. Positions are doubles, all else is in single
//! precision: its velocities have 7 digits, which is what limits it at high rates. What no peer can do is in [`crate::stage`].
//!
//! Each step reads the system's clock 48 times for a profile that cannot be switched off: with one ball 1.1 of 1.8 microseconds,
//! where a reading takes 23 ns. The crate around it takes 0.1 of them.

use std::f64::consts::PI;

use boxdd::shapes::{Circle, Segment};
use boxdd::{
    BodyId, BodyType, ChainDef, Foundation, MaterialMixInput, MixerId, MotionLocks, Position, ShapeDef,
    SurfaceMaterial, Vec2, World,
};
use glam::DVec2;
use shared::physics::scene::Scene;

use crate::peer::{Moment, Peer, PeerWorld};
use crate::stage::{Stage, StageBall};

/// What its documentation advises. Tried on the truth's scenes: 8 cost two fifths more and have errors a tenth smaller, 2 and 1
/// cost a fifth and a quarter less and have errors a tenth and a quarter larger. A higher rate gains more for what it costs.
const SUB_STEPS: i32 = 4;

/// Units/s: none to speak of, but its square is a number. The default, 400, is 10 m/s for the usual ball.
const LARGEST_SPEED: f32 = 1e9;

/// What the surface of a ball is marked with, and that of a wall.
const BALL: u64 = 1;
const WALL: u64 = 0;

/// The engine.
#[derive(Debug, Clone, Copy)]
pub struct Box2d;

impl Peer for Box2d {
    fn name(&self) -> &'static str {
        "Box2D"
    }

    fn caveat(&self) -> Option<&'static str> {
        match option_env!("CFLAGS") {
            Some(flags) if flags.contains("NDEBUG") => None,
            _ => Some("its assertions are on; `cargo run --release` in tests/peers would switch them off"),
        }
    }

    fn clock_reads(&self) -> u32 {
        48
    }

    fn world(&self, scene: &Scene, hz: u32) -> Result<Box<dyn PeerWorld>, String> {
        let stage = Stage::of(scene)?;
        let (world, balls) = build(&stage).map_err(said)?;
        Ok(Box::new(Box2dWorld { world, balls, scale: stage.scale, seconds: (1.0 / f64::from(hz)) as f32 }))
    }
}

/// The world of a stage, and its balls. Contact stiffness, damping and push-out speed are the defaults: others change nothing.
fn build(stage: &Stage) -> boxdd::Result<(World, Vec<BodyId>)> {
    let foundation = Foundation::initialize_default()?;
    let definition = foundation
        .world_builder()
        .gravity(vector(stage.gravity))
        // The default, 1 unit/s, would let slow balls stick.
        .restitution_threshold(0.0)
        .maximum_linear_speed(LARGEST_SPEED)
        .enable_sleep(false);
    let mut world = foundation.create_world(definition.build()?)?;
    // The default lets a contact keep its normal while the ball moves by up to 0.05 units: wrong at a post, at high rates. Off is
    // no slower.
    world.set_contact_recycle_distance(0.0)?;
    if stage.ball_restitution > least_of_walls(stage) {
        // The default is the larger of the two, which is then the ball's.
        world.set_restitution_callback(MixerId::from_bytes([0; 32]), mixed)?;
    }
    let ground = world.create_body(world.body_builder().build()?)?;
    let mut ground = world.body(ground)?;
    for piece in &stage.pieces {
        let shape = Segment::new(vector(piece.a), vector(piece.b))?;
        ground.create_segment(&shape_of(surface(piece.restitution, WALL)?, 1.0)?, &shape)?;
    }
    for disc in &stage.discs {
        let shape = Circle::new(vector(disc.center), disc.radius as f32)?;
        ground.create_circle(&shape_of(surface(disc.restitution, WALL)?, 1.0)?, &shape)?;
    }
    for ring in &stage.rings {
        // A chain is hit from the right of its pieces, and smooth: of single segments each would give a ball a normal of its own.
        let corners = ring.corners.iter().map(|&corner| vector(corner));
        let material = surface(ring.restitution, WALL)?;
        ground.create_chain(&ChainDef::builder().points(corners).is_loop(true).single_material(&material).build()?)?;
    }
    let balls = stage.balls.iter().map(|ball| insert(&mut world, stage, ball)).collect::<Result<_, _>>()?;
    Ok((world, balls))
}

fn least_of_walls(stage: &Stage) -> f64 {
    let pieces = stage.pieces.iter().map(|piece| piece.restitution);
    let discs = stage.discs.iter().map(|disc| disc.restitution);
    let rings = stage.rings.iter().map(|ring| ring.restitution);
    pieces.chain(discs).chain(rings).fold(f64::INFINITY, f64::min)
}

/// The restitution of a pair: the wall's own, and the balls' where there is none.
fn mixed(a: MaterialMixInput, b: MaterialMixInput) -> f32 {
    if a.user_material_id == BALL { b.coefficient } else { a.coefficient }
}

fn surface(restitution: f64, mark: u64) -> boxdd::Result<SurfaceMaterial> {
    Ok(SurfaceMaterial::new().with_friction(0.0)?.with_restitution(restitution as f32)?.with_user_material_id(mark))
}

fn shape_of(material: SurfaceMaterial, density: f64) -> boxdd::Result<ShapeDef> {
    ShapeDef::builder().material(material).density(density as f32).enable_contact_events(false).build()
}

fn insert(world: &mut World, stage: &Stage, ball: &StageBall) -> boxdd::Result<BodyId> {
    let body = world
        .body_builder()
        .body_type(BodyType::Dynamic)
        .position(Position { x: ball.position.x, y: ball.position.y })
        .linear_velocity(vector(ball.velocity))
        .motion_locks(MotionLocks::new(false, false, true))
        .bullet(true);
    let id = world.create_body(body.build()?)?;
    let density = ball.mass / (PI * ball.radius * ball.radius);
    let shape = Circle::new(Vec2::ZERO, ball.radius as f32)?;
    world.body(id)?.create_circle(&shape_of(surface(stage.ball_restitution, BALL)?, density)?, &shape)?;
    Ok(id)
}

fn vector(of: DVec2) -> Vec2 {
    Vec2::new(of.x as f32, of.y as f32)
}

fn said(error: boxdd::Error) -> String {
    format!("Box2D: {error}")
}

struct Box2dWorld {
    world: World,
    balls: Vec<BodyId>,
    scale: f64,
    seconds: f32,
}

impl PeerWorld for Box2dWorld {
    fn step(&mut self) -> Result<(), String> {
        let step = self.world.step(self.seconds, SUB_STEPS).map_err(said)?;
        step.post_step_error().map_or(Ok(()), |error| Err(said(error)))
    }

    fn balls(&mut self, into: &mut Vec<Moment>) -> Result<(), String> {
        into.clear();
        for &id in &self.balls {
            let body = self.world.body(id).map_err(said)?;
            let (position, velocity) = (body.position().map_err(said)?, body.linear_velocity().map_err(said)?);
            into.push(Moment {
                position: DVec2::new(position.x, position.y) / self.scale,
                velocity: DVec2::new(f64::from(velocity.x), f64::from(velocity.y)) / self.scale,
            });
        }
        Ok(())
    }
}
