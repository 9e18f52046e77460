//! The scene: what the physics needs to know of a table, checked and resolved to plain geometry.

use glam::DVec2;

use super::broad_phase::Grid;
use super::cabinet::CabinetSpec;
use super::constants::ROLLING_SHARE;
use super::flipper::FlipperSpec;
use super::hinge::HingeSpec;
use super::magnet::MagnetSpec;
use super::motion::Motion;
use super::needs::Needs;
use super::plunger::PlungerSpec;
use super::saucer::SaucerSpec;
use super::shapes::{Bounds, Shape};

/// A surface.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct Material {
    /// Share of the normal speed returned at vanishing speed.
    pub restitution: f64,
    /// Restitution at normal speed v is `restitution / (1 + falloff v)`; s/m.
    pub falloff: f64,
    /// Coulomb coefficient.
    pub friction: f64,
    /// Share of the tangential speed that an impact leaves, apart from friction: 1 but for the manual's own materials.
    pub tangential: f64,
}

impl Material {
    /// A surface that returns that share of the normal speed and does nothing else.
    pub fn bouncing(restitution: f64) -> Self {
        Self { restitution, falloff: 0.0, friction: 0.0, tangential: 1.0 }
    }

    /// Share of a pull along the surface that accelerates a ball on it: some goes into spin where there is friction.
    pub fn rolling_share(&self) -> f64 {
        if self.friction > 0.0 { ROLLING_SHARE } else { 1.0 }
    }

    /// Share of the normal speed returned at a normal speed of approach of `speed` m/s.
    pub fn restitution_at(&self, speed: f64) -> f64 {
        self.restitution / (1.0 + self.falloff * speed)
    }
}

/// What a collider does to a ball that meets it.
#[derive(Debug, Clone, Copy, PartialEq)]
pub enum Role {
    /// Stops it.
    Solid,
    /// Stops it and, above `threshold` m/s of approach, adds `speed` m/s along the normal.
    Kicker {
        /// Added, m/s.
        speed: f64,
        /// Of approach, m/s.
        threshold: f64,
    },
    /// Stops it and falls when hit at `threshold` m/s or faster.
    Target {
        /// Place among the scene's targets.
        index: u16,
        /// Of approach, m/s.
        threshold: f64,
    },
    /// Stops it and notices a hit at `threshold` m/s or faster.
    Standing {
        /// Of approach, m/s.
        threshold: f64,
    },
    /// Notices its centre passing.
    Sensor,
    /// Where its centre passes, or is thrown back by, a plate.
    Hinge {
        /// Place among the scene's hinges.
        index: u16,
    },
    /// Holds it, once its centre has come in.
    Saucer {
        /// Place among the scene's saucers.
        index: u16,
    },
    /// The rim of a magnet's field.
    Field {
        /// Place among the scene's magnets.
        index: u16,
    },
    /// A ball whose centre passes it drops, or climbs, to another floor.
    Hole {
        /// The floor that it leads to.
        to: u8,
    },
    /// Takes it out of play.
    Drain,
}

impl Role {
    /// Whether a ball passes it, rather than being stopped by it.
    pub fn is_passed(self) -> bool {
        match self {
            Self::Sensor
            | Self::Hinge { .. }
            | Self::Saucer { .. }
            | Self::Field { .. }
            | Self::Hole { .. }
            | Self::Drain => true,
            Self::Solid | Self::Kicker { .. } | Self::Target { .. } | Self::Standing { .. } => false,
        }
    }
}

/// When a collider is there.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub enum Presence {
    /// Always.
    Always,
    /// While that target stands.
    TargetUp(u16),
    /// While that flipper lies at its resting stop.
    FlipperAtRest(u16),
    /// While that flipper lies at the end of its stroke.
    FlipperRaised(u16),
    /// While that plunger's head is at home.
    PlungerHome(u16),
}

/// A shape with all that an impact needs to know.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct Collider {
    /// Geometry.
    pub shape: Shape,
    /// What a ball's centre must enter before it can touch the shape.
    pub bounds: Bounds,
    /// Surface.
    pub material: Material,
    /// The table's element that it belongs to.
    pub element: u16,
    /// What it does.
    pub role: Role,
    /// When it is there.
    pub presence: Presence,
    /// The floor that it stands on; 0 is the playfield. Balls on others do not notice it.
    pub floor: u8,
}

/// A size of ball.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct BallKind {
    /// m.
    pub radius: f64,
    /// kg.
    pub mass: f64,
}

/// A ball that is in play from the start.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct StartBall {
    /// Its place among the scene's kinds.
    pub kind: u8,
    /// Its centre, m.
    pub position: DVec2,
    /// m/s.
    pub velocity: DVec2,
}

/// Everything that is fixed while a world runs.
#[derive(Debug, Clone, PartialEq)]
pub struct Scene {
    /// How the next impact of a ball is found.
    pub motion: Motion,
    /// Length of a tick.
    pub tick_seconds: f64,
    /// The pixel model's step, m.
    pub pixel: f64,
    /// Acceleration of a free ball on the playfield, m/s^2.
    pub gravity: DVec2,
    /// The same on the floors above the playfield, from floor 1 on; on those beyond the list it is that of the playfield.
    pub floors: Vec<DVec2>,
    /// Normal speed after an impact below which a ball stays in contact, m/s. At 0 it does where its next hop would be lost in
    /// rounding.
    pub rest_speed: f64,
    /// The balls that there can be; at least one.
    pub kinds: Vec<BallKind>,
    /// What balls do to each other.
    pub ball_material: Material,
    /// Balls in play from the start.
    pub start: Vec<StartBall>,
    /// Where (0, 0) of this scene lies in the table's coordinates, m: a scene far from their origin has one of its own, so
    /// that its coordinates keep their digits.
    pub origin: DVec2,
    /// A ball whose centre leaves these by more than its radius has escaped.
    pub bounds: Bounds,
    /// Static shapes. Ties between simultaneous events go to the lowest index.
    pub colliders: Vec<Collider>,
    /// Flippers.
    pub flippers: Vec<FlipperSpec>,
    /// Plungers.
    pub plungers: Vec<PlungerSpec>,
    /// How many targets can fall.
    pub targets: u16,
    /// Those that are down at the start, one bit each.
    pub targets_down: u64,
    /// Plates of spinners and gates.
    pub hinges: Vec<HingeSpec>,
    /// Saucers.
    pub saucers: Vec<SaucerSpec>,
    /// Magnets.
    pub magnets: Vec<MagnetSpec>,
    /// How the table moves when it is nudged; `None`: it stands like a rock.
    pub cabinet: Option<CabinetSpec>,
    /// Whether there may be more balls in play than those of the start and the one that is served.
    pub multiball: bool,
    /// What this scene requires: of [`Self::built`].
    pub needs: Needs,
    /// The broad phase, where it is needed: of [`Self::built`].
    pub grid: Option<Grid>,
    /// A ball whose centre is beyond these has escaped: of [`Self::built`].
    pub edge: Bounds,
}

impl Scene {
    /// The scene with what follows from its parts worked out: the boxes of its colliders, its needs, its broad phase.
    #[must_use]
    pub fn built(mut self) -> Self {
        let largest = self.largest_radius();
        self.edge = self.bounds.grown(largest);
        for collider in &mut self.colliders {
            collider.bounds = collider.shape.bounds(largest);
        }
        let needs = Needs::of(&self);
        self.with_needs(needs)
    }

    /// The scene run with more than it needs, or with another broad phase. To leave out what it does need makes another
    /// scene of it.
    #[must_use]
    pub fn with_needs(mut self, needs: Needs) -> Self {
        self.needs = needs;
        self.grid = needs.broad_phase.then(|| Grid::new(&self.colliders, self.largest_radius()));
        self
    }

    /// For each target, whether it stands while nothing has happened.
    pub fn targets_at_start(&self) -> impl Iterator<Item = bool> {
        (0..u32::from(self.targets)).map(|target| self.targets_down.checked_shr(target).unwrap_or(0) & 1 == 0)
    }

    /// Acceleration of a free ball on that floor, m/s^2.
    pub fn gravity_on(&self, floor: u8) -> DVec2 {
        let above = usize::from(floor).checked_sub(1).and_then(|place| self.floors.get(place));
        above.copied().unwrap_or(self.gravity)
    }

    /// Radius of the largest ball, m.
    pub fn largest_radius(&self) -> f64 {
        self.kinds.iter().fold(0.0, |largest, kind| if kind.radius > largest { kind.radius } else { largest })
    }

    /// Radius of a kind of ball, m.
    pub fn radius(&self, kind: u8) -> f64 {
        self.kinds[usize::from(kind)].radius
    }

    /// Mass of a kind of ball, kg.
    pub fn mass(&self, kind: u8) -> f64 {
        self.kinds[usize::from(kind)].mass
    }

    /// Whether a ball's centre is within the bounds, or beside them by the largest ball's radius at the most.
    pub fn is_inside(&self, position: DVec2) -> bool {
        self.edge.contains(position)
    }
}
