//! A scene as every peer understands it: discs, straight pieces, rings of such pieces and balls, in units that it is made for.
//!
//! Some things are not the scene's, whichever the peer:
//! - The end or the corner of a wall is a point of its own in a scene. Here it is part of the straight pieces that end there;
//!   where their restitutions differ, which one counts is up to the peer, not the one that is written first.
//! - A ring is a polygon: neither peer has a circle that is hit from inside.
//! - A ball that leaves the scene's bounds flies on.
//! - No peer looks for impacts of two balls between the steps: fast ones may pass each other.

use std::collections::HashSet;
use std::f64::consts::TAU;

use glam::DVec2;
use shared::physics::scene::{Collider, Material, Presence, Role, Scene};
use shared::physics::shapes::{Arc, Segment, Shape, Side};

/// The radius that the smallest ball gets, units. The peers' tolerances, 0.005 and 0.02 units, are made for things of about that
/// size; a scene with the usual ball, of 13.5 mm, becomes 40 times as large. Tried: 10, 100 and 400 times are no better for it; for a
/// ball of 0.01 mm 40 times is much worse than the 54000 times that it gets.
const BALL_RADIUS: f64 = 0.54;

/// The largest extent that a scene gets, units: beyond it Box2D's single-precision shapes would be coarser than its tolerances.
const LARGEST_EXTENT: f64 = 1e5;

/// Length of a ring's pieces as a share of the largest ball's radius. A circle of 0.4 m around the usual ball is of 1034 pieces.
/// Box2D sees at most 32 shapes near a ball: half as long would be too many.
const RING_PIECE: f64 = 0.18;

/// How few and how many pieces a ring may have.
const RING_PIECES: (f64, f64) = (64.0, 4096.0);

/// A straight piece of wall.
#[derive(Debug, Clone, Copy, PartialEq)]
pub(crate) struct Piece {
    pub(crate) a: DVec2,
    pub(crate) b: DVec2,
    pub(crate) restitution: f64,
}

/// A pillar.
#[derive(Debug, Clone, Copy, PartialEq)]
pub(crate) struct Disc {
    pub(crate) center: DVec2,
    pub(crate) radius: f64,
    pub(crate) restitution: f64,
}

/// A round wall around the balls.
#[derive(Debug, Clone, PartialEq)]
pub(crate) struct Ring {
    /// Corners of the polygon that stands for it, clockwise: the side that is hit is on the right of each piece.
    pub(crate) corners: Vec<DVec2>,
    pub(crate) restitution: f64,
}

/// A ball as it begins.
#[derive(Debug, Clone, Copy, PartialEq)]
pub(crate) struct StageBall {
    pub(crate) position: DVec2,
    pub(crate) velocity: DVec2,
    pub(crate) radius: f64,
    /// kg: the only unit that is not scaled.
    pub(crate) mass: f64,
}

/// All of a scene that a peer takes, in its units.
#[derive(Debug, Clone, PartialEq)]
pub(crate) struct Stage {
    /// Units in a metre.
    pub(crate) scale: f64,
    pub(crate) gravity: DVec2,
    pub(crate) pieces: Vec<Piece>,
    pub(crate) discs: Vec<Disc>,
    pub(crate) rings: Vec<Ring>,
    pub(crate) balls: Vec<StageBall>,
    /// Of ball against ball; 0 where there is one ball.
    pub(crate) ball_restitution: f64,
}

impl Stage {
    /// The scene in a peer's units.
    ///
    /// # Errors
    /// The first thing of it that peers cannot do.
    pub(crate) fn of(scene: &Scene) -> Result<Self, String> {
        let Some((smallest, largest)) = radii(scene) else {
            return Err("no ball is in play from the start: a peer has nothing to move".to_owned());
        };
        if !scene.flippers.is_empty() {
            return Err("it has flippers, which peers do not run".to_owned());
        }
        if !scene.plungers.is_empty() {
            return Err("it has plungers, which peers do not run".to_owned());
        }
        if scene.rest_speed > 0.0 {
            return Err("its balls come to rest below a speed, which peers do not run: 0 would be right".to_owned());
        }
        let ball_restitution = restitution(&scene.ball_material).map_err(|problem| format!("a ball {problem}"))?;
        let scale = (BALL_RADIUS / smallest).min(LARGEST_EXTENT / scene.bounds.extent());
        let mut stage = Self {
            scale,
            gravity: scene.gravity * scale,
            pieces: Vec::new(),
            discs: Vec::new(),
            rings: Vec::new(),
            balls: Vec::new(),
            ball_restitution: if scene.start.len() > 1 { ball_restitution } else { 0.0 },
        };
        for collider in &scene.colliders {
            stage.add(collider, largest).map_err(|problem| format!("element {} {problem}", collider.element))?;
        }
        stage.check_points(scene)?;
        stage.balls.extend(scene.start.iter().map(|start| StageBall {
            position: start.position * scale,
            velocity: start.velocity * scale,
            radius: scene.radius(start.kind) * scale,
            mass: scene.mass(start.kind),
        }));
        Ok(stage)
    }

    fn add(&mut self, collider: &Collider, largest_ball: f64) -> Result<(), String> {
        if collider.role != Role::Solid {
            return Err("does more than stop a ball, which peers do not run".to_owned());
        }
        if collider.presence != Presence::Always {
            return Err("is not always there, which peers do not run".to_owned());
        }
        if collider.floor != 0 {
            return Err("stands on another floor; a peer has one".to_owned());
        }
        let (scale, restitution) = (self.scale, restitution(&collider.material)?);
        match collider.shape {
            Shape::Segment(Segment { one_way: true, .. }) => {
                return Err("is passed from one side, which peers do not run".to_owned());
            }
            Shape::Segment(Segment { a, b, .. }) => {
                self.pieces.push(Piece { a: a * scale, b: b * scale, restitution });
            }
            Shape::Arc(Arc { span: Some(_), .. }) => {
                return Err("is part of a circle, which peers do not run".to_owned());
            }
            Shape::Arc(arc) if is_point(&arc) => {}
            Shape::Arc(Arc { center, radius, side: Side::Outside, .. }) => {
                self.discs.push(Disc { center: center * scale, radius: radius * scale, restitution });
            }
            Shape::Arc(Arc { center, radius, side: Side::Inside, .. }) => {
                let corners = polygon(center * scale, radius * scale, RING_PIECE * largest_ball * scale);
                self.rings.push(Ring { corners, restitution });
            }
        }
        Ok(())
    }

    /// That every point is an end of a straight piece: then it needs no collider of its own, for a peer's pieces have theirs.
    fn check_points(&self, scene: &Scene) -> Result<(), String> {
        let bits = |point: DVec2| (point.x.to_bits(), point.y.to_bits());
        let ends: HashSet<_> = self.pieces.iter().flat_map(|piece| [bits(piece.a), bits(piece.b)]).collect();
        for collider in &scene.colliders {
            if let Shape::Arc(arc) = collider.shape
                && is_point(&arc)
                && !ends.contains(&bits(arc.center * self.scale))
            {
                return Err(format!("element {} is a point without a wall, which peers do not run", collider.element));
            }
        }
        Ok(())
    }
}

/// Radii of the smallest and the largest ball in play; none if there is no ball.
fn radii(scene: &Scene) -> Option<(f64, f64)> {
    let mut radii = scene.start.iter().map(|start| scene.radius(start.kind));
    let first = radii.next()?;
    Some(radii.fold((first, first), |(least, most), radius| (least.min(radius), most.max(radius))))
}

/// Whether it is the end or the corner of a wall.
fn is_point(arc: &Arc) -> bool {
    arc.radius == 0.0 && arc.side == Side::Outside
}

/// Corners of a polygon of pieces of about that length, clockwise. They lie outside the circle and its pieces' middles inside, so
/// that it has the area of the circle.
fn polygon(center: DVec2, radius: f64, piece: f64) -> Vec<DVec2> {
    let count = (TAU * radius / piece).clamp(RING_PIECES.0, RING_PIECES.1).ceil();
    let turn = TAU / count;
    let reach = radius * (turn / libm::sin(turn)).sqrt();
    // A cast saturates.
    (0..count as u32).map(|place| center + DVec2::from_angle(-turn * f64::from(place)) * reach).collect()
}

/// What a surface returns, if that is all that it does.
fn restitution(material: &Material) -> Result<f64, String> {
    if *material == Material::bouncing(material.restitution) {
        Ok(material.restitution)
    } else {
        Err("has a surface that does more than bounce, which peers do not run".to_owned())
    }
}
