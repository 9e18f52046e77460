//! The scene form of a table: balls with initial position and velocity, walls, posts and rings, gravity as a vector; constant
//! restitution, no friction, no rest threshold, no rules. What an engine user writes first.

use std::collections::BTreeMap;
use std::sync::Arc;

use glam::DVec2;
use serde::{Deserialize, Serialize};

use super::accuracy::Accuracy;
use super::check::{Context, MOST_COORDINATE, Spot, digest, read, vector};
use super::error::TableError;
use super::format::{
    BallFile, EdgeFile, ElementFile, HoleFile, MaterialFile, Point, PostFile, RulesFile, TableFile, WallFile,
    default_pixel, default_tick_hz,
};
use super::locate::{Step, first_word, line_of};
use super::rulebook::RuleBook;
use super::shapes::{self, Bare};
use super::{FORMAT_VERSION, MOST_SCENE_TEXT, Table};
use crate::physics::motion::Motion;
use crate::physics::scene::{BallKind, Material, StartBall};
use crate::physics::shapes::Bounds;
use crate::physics::{MOST_BALLS, PHYSICS_VERSION};

/// A whole scene file.
#[derive(Debug, Clone, PartialEq, Serialize, Deserialize)]
#[serde(deny_unknown_fields, rename = "Scene")]
pub struct SceneFile {
    /// For people.
    #[serde(default = "default_name")]
    pub name: String,
    /// Acceleration of every ball, m/s^2.
    pub gravity: Point,
    /// The same on the floors from 1 on. Left out: as on floor 0.
    #[serde(default)]
    pub floors: Vec<Point>,
    /// How the next impact of a ball is found.
    #[serde(default)]
    pub motion: Motion,
    /// Asked for instead of a motion model and a tick rate.
    #[serde(default)]
    pub accuracy: Option<Accuracy>,
    /// World ticks a second.
    #[serde(default = "default_tick_hz")]
    pub tick_hz: u32,
    /// The pixel model's step, m.
    #[serde(default = "default_pixel")]
    pub pixel: f64,
    /// Restitution of ball against ball.
    #[serde(default = "one")]
    pub ball_restitution: f64,
    /// Balls beyond these have escaped: (left, bottom, right, top), m. Left out: far from everything.
    #[serde(default)]
    pub bounds: Option<(f64, f64, f64, f64)>,
    /// Balls in play from the start.
    pub balls: Vec<SceneBall>,
    /// What they meet.
    #[serde(default)]
    pub elements: Vec<SceneElement>,
}

/// A ball of a scene.
#[derive(Debug, Clone, Copy, PartialEq, Serialize, Deserialize)]
#[serde(deny_unknown_fields)]
pub struct SceneBall {
    /// Of its centre, m.
    pub position: Point,
    /// m/s.
    #[serde(default)]
    pub velocity: Point,
    /// m.
    #[serde(default = "default_radius")]
    pub radius: f64,
    /// kg.
    #[serde(default = "default_mass")]
    pub mass: f64,
}

/// What balls of a scene meet. A name that is left out is made of kind and place.
#[derive(Debug, Clone, PartialEq, Serialize, Deserialize)]
#[serde(deny_unknown_fields)]
pub enum SceneElement {
    /// Straight pieces from point to point, and the points.
    Wall {
        /// Unique in the scene.
        #[serde(default)]
        name: String,
        /// Two or more, m.
        points: Vec<Point>,
        /// Share of the normal speed that an impact returns.
        #[serde(default = "one")]
        restitution: f64,
        /// 0 is the floor that balls begin on.
        #[serde(default)]
        floor: u8,
    },
    /// A round pillar.
    Post {
        /// Unique in the scene.
        #[serde(default)]
        name: String,
        /// m.
        center: Point,
        /// m.
        radius: f64,
        /// Share of the normal speed that an impact returns.
        #[serde(default = "one")]
        restitution: f64,
        /// 0 is the floor that balls begin on.
        #[serde(default)]
        floor: u8,
    },
    /// A circle that balls are inside of.
    Ring {
        /// Unique in the scene.
        #[serde(default)]
        name: String,
        /// m.
        center: Point,
        /// m.
        radius: f64,
        /// Share of the normal speed that an impact returns.
        #[serde(default = "one")]
        restitution: f64,
        /// 0 is the floor that balls begin on.
        #[serde(default)]
        floor: u8,
    },
    /// A line between two floors: the edge of a ramp.
    Edge {
        /// Unique in the scene.
        #[serde(default)]
        name: String,
        /// First end, m.
        from: Point,
        /// Second end, m.
        to: Point,
        /// The two floors that meet there.
        floors: (u8, u8),
    },
    /// A line at which a ball goes to another floor.
    Hole {
        /// Unique in the scene.
        #[serde(default)]
        name: String,
        /// First end, m.
        from: Point,
        /// Second end, m.
        to: Point,
        /// The floor that it is on.
        #[serde(default)]
        floor: u8,
        /// The floor that it leads to.
        leads_to: u8,
    },
}

fn default_name() -> String {
    "scene".to_owned()
}

fn default_radius() -> f64 {
    0.0135
}

fn default_mass() -> f64 {
    0.08
}

fn one() -> f64 {
    1.0
}

/// Most sizes and masses of ball in one scene: a place among them fits 8 bits.
const MOST_KINDS: usize = 256;

/// Whether a text is one of a scene: it begins with `Scene(`, or has balls but no format.
pub(super) fn is_scene(source: &str) -> bool {
    let has = |field| line_of(source, &[Step::Field(field)]) > 0;
    match first_word(source) {
        Some(word) => word == "Scene",
        None => has("balls") && !has("format"),
    }
}

pub(super) fn parse(name: &str, source: &str) -> Result<Table, TableError> {
    let scene: SceneFile = read(name, source, MOST_SCENE_TEXT)?;
    let origin = local_origin(&scene);
    let (file, bounds) = lowered(&scene, origin);
    let context = Context::new(name, source, &file);
    let context = context.with_names()?;
    check_numbers(&context, &scene)?;
    let (kinds, start) = balls(&context, &scene, origin)?;
    let ball_material = Material::bouncing(scene.ball_restitution);
    let checked = shapes::build(&context, &Bare { kinds, ball_material, start, origin, bounds })?;
    for (place, ball) in checked.start.iter().enumerate() {
        let (spot, radius) = (Spot::StartBall(place), checked.radius(ball.kind));
        if !checked.is_inside(ball.position) {
            let problem = "it is beyond the scene's `bounds`; a place within them would be right".to_owned();
            return Err(context.error(spot, Some("position"), problem));
        }
        context.start_is_clear(spot, "position", (ball.position.x, ball.position.y), radius, &checked)?;
        let reach = |other: &StartBall| (radius + checked.radius(other.kind)) * (1.0 - 1e-6);
        let overlaps = |other: &StartBall| (other.position - ball.position).length() < reach(other);
        if let Some(other) = checked.start[..place].iter().position(overlaps) {
            let problem = format!("it overlaps ball {}; balls side by side would be right", other + 1);
            return Err(context.error(spot, Some("position"), problem));
        }
    }
    Ok(Table {
        name: scene.name.clone(),
        source: source.to_owned(),
        digest: digest(source),
        has_rules: false,
        accuracy: scene.accuracy,
        scene: Arc::new(checked),
        ball_start: DVec2::ZERO,
        rules: RuleBook::empty(0, 1),
        acts: vec![false; file.elements.len()],
        targets: Vec::new(),
        lights: Vec::new(),
        file,
    })
}

/// The box around all that is written: elements and balls.
fn extent(scene: &SceneFile) -> Bounds {
    let disc = |center: Point, radius: f64| {
        let center = vector(center);
        Bounds { low: center - DVec2::splat(radius), high: center + DVec2::splat(radius) }
    };
    let point = |point: Point| disc(point, 0.0);
    let balls = scene.balls.iter().map(|ball| disc(ball.position, ball.radius));
    let elements = scene.elements.iter().flat_map(|element| match element {
        SceneElement::Wall { points, .. } => points.iter().map(|&p| point(p)).collect(),
        SceneElement::Post { center, radius, .. } | SceneElement::Ring { center, radius, .. } => {
            vec![disc(*center, *radius)]
        }
        SceneElement::Hole { from, to, .. } | SceneElement::Edge { from, to, .. } => {
            vec![point(*from), point(*to)]
        }
    });
    balls.chain(elements).reduce(Bounds::joined).unwrap_or(Bounds { low: DVec2::ZERO, high: DVec2::ONE })
}

/// Where a scene's own (0, 0) lies: at that of its file, unless the scene is much farther from it than it is large. Then at a
/// round number near it, so that the difference to every coordinate is exact, or nearly.
fn local_origin(scene: &SceneFile) -> DVec2 {
    let around = extent(scene);
    let mut grain = 1.0;
    // A power of two from 8 to 16 times the extent: scenes that are scaled by one keep their bits.
    let least = 8.0 * around.extent();
    if !(least > 0.0 && least < f64::MAX) {
        return DVec2::ZERO;
    }
    while grain < least {
        grain *= 2.0;
    }
    while 0.5 * grain >= least {
        grain *= 0.5;
    }
    let middle = 0.5 * (around.low + around.high);
    // Adding 0 makes -0 a 0.
    DVec2::new((middle.x / grain).round(), (middle.y / grain).round()) * grain + DVec2::ZERO
}

/// The scene as a table, in its own coordinates.
fn lowered(scene: &SceneFile, origin: DVec2) -> (TableFile, Bounds) {
    let local = |point: Point| (point.0 - origin.x, point.1 - origin.y);
    let mut materials = BTreeMap::new();
    let mut elements = Vec::with_capacity(scene.elements.len());
    for (place, element) in (1..).zip(&scene.elements) {
        let named = |name: &str, kind: &str| if name.is_empty() { format!("{kind} {place}") } else { name.to_owned() };
        let mut material = |restitution: f64| {
            let name = format!("{restitution:?}");
            materials.entry(name.clone()).or_insert(MaterialFile {
                restitution,
                falloff: 0.0,
                friction: 0.0,
                tangential: 1.0,
            });
            name
        };
        elements.push(match element {
            SceneElement::Wall { name, points, restitution, floor } => ElementFile::Wall(WallFile {
                name: named(name, "wall"),
                material: material(*restitution),
                points: points.iter().map(|&point| local(point)).collect(),
                floor: *floor,
            }),
            SceneElement::Post { name, center, radius, restitution, floor }
            | SceneElement::Ring { name, center, radius, restitution, floor } => {
                let is_post = matches!(element, SceneElement::Post { .. });
                let round = PostFile {
                    name: named(name, if is_post { "post" } else { "ring" }),
                    material: material(*restitution),
                    center: local(*center),
                    radius: *radius,
                    floor: *floor,
                };
                if is_post { ElementFile::Post(round) } else { ElementFile::Ring(round) }
            }
            SceneElement::Edge { name, from, to, floors } => ElementFile::Edge(EdgeFile {
                name: named(name, "edge"),
                from: local(*from),
                to: local(*to),
                floors: *floors,
            }),
            SceneElement::Hole { name, from, to, floor, leads_to } => ElementFile::Hole(HoleFile {
                name: named(name, "hole"),
                from: local(*from),
                to: local(*to),
                floor: *floor,
                leads_to: *leads_to,
            }),
        });
    }
    let around = extent(scene);
    let bounds = match scene.bounds {
        Some((left, bottom, right, top)) => Bounds { low: DVec2::new(left, bottom), high: DVec2::new(right, top) },
        None => around.grown(around.extent()),
    };
    let bounds = Bounds { low: bounds.low - origin, high: bounds.high - origin };
    let size = bounds.size();
    let file = TableFile {
        format: FORMAT_VERSION,
        physics: PHYSICS_VERSION,
        name: scene.name.clone(),
        size: (size.x, size.y),
        accuracy: scene.accuracy,
        tick_hz: scene.tick_hz,
        motion: scene.motion,
        pixel: scene.pixel,
        gravity: scene.gravity,
        floors: scene.floors.clone(),
        cabinet: None,
        rest_speed: 0.0,
        ball: BallFile { radius: default_radius(), mass: default_mass(), start: (0.0, 0.0) },
        materials,
        elements,
        groups: BTreeMap::new(),
        rules: RulesFile {
            balls: 0,
            max_multiplier: 1,
            max_extra_balls: 0,
            ball_save: None,
            on: Vec::new(),
            crowd: None,
        },
    };
    (file, bounds)
}

fn check_numbers(context: &Context<'_>, scene: &SceneFile) -> Result<(), TableError> {
    let table = Spot::Table;
    context.printable(table, Some("name"), &scene.name)?;
    context.accuracy()?;
    context.in_range(table, "tick_hz", f64::from(scene.tick_hz), 1.0, 1e6, "1000")?;
    context.in_range(table, "pixel", scene.pixel, 1e-15, 1e12, "0.001 m")?;
    for pull in [scene.gravity.0, scene.gravity.1] {
        context.in_range(table, "gravity", pull, -MOST_COORDINATE, MOST_COORDINATE, "(0.0, -0.793) m/s^2")?;
    }
    for pull in scene.floors.iter().flat_map(|floor| [floor.0, floor.1]) {
        context.in_range(table, "floors", pull, -MOST_COORDINATE, MOST_COORDINATE, "[(0.0, -2.5)] m/s^2")?;
    }
    context.in_range(table, "ball_restitution", scene.ball_restitution, 0.0, MOST_RESTITUTION, "1")?;
    if let Some((left, bottom, right, top)) = scene.bounds {
        let fits = |low: f64, high: f64| low < high && low >= -MOST_COORDINATE && high <= MOST_COORDINATE;
        if !(fits(left, right) && fits(bottom, top)) {
            let problem =
                format!("({left}, {bottom}, {right}, {top}) is no box; (left, bottom, right, top) would be right");
            return Err(context.error(table, Some("bounds"), problem));
        }
    }
    for (place, element) in (0..).zip(&scene.elements) {
        if let SceneElement::Wall { restitution, .. }
        | SceneElement::Post { restitution, .. }
        | SceneElement::Ring { restitution, .. } = element
        {
            context.in_range(Spot::Element(place), "restitution", *restitution, 0.0, MOST_RESTITUTION, "0.8")?;
        }
    }
    Ok(())
}

/// Above 1 a surface is active: it gives more than it got.
const MOST_RESTITUTION: f64 = 10.0;

/// The balls at their start, and their kinds.
fn balls(
    context: &Context<'_>,
    scene: &SceneFile,
    origin: DVec2,
) -> Result<(Vec<BallKind>, Vec<StartBall>), TableError> {
    if scene.balls.is_empty() || scene.balls.len() > MOST_BALLS {
        let problem = format!("{} balls; 1 to {MOST_BALLS} would be right", scene.balls.len());
        return Err(context.error(Spot::Table, Some("balls"), problem));
    }
    let mut kinds: Vec<BallKind> = Vec::new();
    let mut start = Vec::with_capacity(scene.balls.len());
    for (place, ball) in scene.balls.iter().enumerate() {
        let spot = Spot::StartBall(place);
        context.in_range(spot, "radius", ball.radius, 1e-15, 1e12, "0.0135 m")?;
        context.in_range(spot, "mass", ball.mass, 1e-15, 1e15, "0.08 kg")?;
        for speed in [ball.velocity.0, ball.velocity.1] {
            context.in_range(spot, "velocity", speed, -MOST_COORDINATE, MOST_COORDINATE, "(0.5, -1.0) m/s")?;
        }
        let position = context.point(spot, "position", None, ball.position)? - origin;
        let kind = BallKind { radius: ball.radius, mass: ball.mass };
        let known = kinds.iter().position(|other| *other == kind);
        let kind = known.unwrap_or_else(|| {
            kinds.push(kind);
            kinds.len() - 1
        });
        if kinds.len() > MOST_KINDS {
            let problem = format!("balls of more than {MOST_KINDS} sizes and masses; fewer would be right");
            return Err(context.error(spot, None, problem));
        }
        start.push(StartBall { kind: kind as u8, position, velocity: vector(ball.velocity) });
    }
    Ok((kinds, start))
}
