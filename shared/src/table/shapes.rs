//! Elements -> colliders, flippers and plungers.

use glam::DVec2;

use super::check::{Context, Spot, vector};
use super::error::TableError;
use super::format::{
    ArcFile, CabinetFile, ElementFile, FlipperFile, Hand, LineFile, MagnetFile, PlungerFile, Point, TableFile,
};
use super::rulebook;
use crate::math::{direction, radians, tangent};
use crate::physics::cabinet::{CabinetSpec, Oscillator};
use crate::physics::flipper::FlipperSpec;
use crate::physics::magnet::MagnetSpec;
use crate::physics::needs::Needs;
use crate::physics::plunger::PlungerSpec;
use crate::physics::scene::{BallKind, Collider, Material, Presence, Role, Scene, StartBall};
use crate::physics::shapes::{Arc, Bounds, Segment, Shape, Side};

/// Most colliders of a table; a place among them fits 16 bits.
const MOST_COLLIDERS: usize = 60_000;

pub(super) fn build(context: &Context<'_>, bare: &Bare) -> Result<Scene, TableError> {
    let file = context.file;
    let scene = Scene {
        motion: file.motion,
        tick_seconds: 1.0 / f64::from(file.tick_hz),
        pixel: file.pixel,
        gravity: vector(file.gravity),
        floors: file.floors.iter().copied().map(vector).collect(),
        rest_speed: file.rest_speed,
        kinds: bare.kinds.clone(),
        ball_material: bare.ball_material,
        start: bare.start.clone(),
        origin: bare.origin,
        bounds: bare.bounds,
        colliders: Vec::new(),
        flippers: Vec::new(),
        plungers: Vec::new(),
        targets: 0,
        targets_down: 0,
        hinges: Vec::new(),
        saucers: Vec::new(),
        magnets: Vec::new(),
        cabinet: file.cabinet.map(|cabinet| cabinet_spec(&cabinet, 1.0 / f64::from(file.tick_hz))),
        multiball: rulebook::serves(&file.rules),
        needs: Needs::default(),
        grid: None,
        edge: bare.bounds,
    };
    let mut builder = Builder { context, scene, floor: 0 };
    for (index, element) in (0..).zip(&file.elements) {
        builder.floor = 0;
        builder.add(index, element)?;
        if builder.scene.colliders.len() > MOST_COLLIDERS {
            let problem = format!("the elements up to this one have more than {MOST_COLLIDERS} sides and corners");
            return Err(context.error(Spot::Element(index), None, problem));
        }
    }
    Ok(builder.scene.built())
}

/// A cabinet's motion over ticks of `dt` seconds.
pub(super) fn cabinet_spec(file: &CabinetFile, dt: f64) -> CabinetSpec {
    let angular = |hertz: f64| hertz * core::f64::consts::TAU;
    CabinetSpec {
        speed: file.nudge,
        legs: [
            Oscillator::new(angular(file.frequency.0), file.damping.0, dt),
            Oscillator::new(angular(file.frequency.1), file.damping.1, dt),
        ],
        bob: Oscillator::new((STANDARD_GRAVITY / file.bob_length).sqrt(), file.bob_damping, dt),
        ring: file.bob_length * radians(file.tilt),
    }
}

/// Largest angle, rad, that a ball in a magnet's core swings by in a tick: beyond, its motion gains energy.
const MOST_STIFFNESS: f64 = 0.5;

/// What a plumb bob hangs in, m/s^2.
const STANDARD_GRAVITY: f64 = 9.80665;

/// What a scene says of balls and space that a table says otherwise.
pub(super) struct Bare {
    pub(super) kinds: Vec<BallKind>,
    pub(super) ball_material: Material,
    pub(super) start: Vec<StartBall>,
    pub(super) origin: DVec2,
    pub(super) bounds: Bounds,
}

impl Bare {
    /// Of a table: one kind of ball, served by the rules.
    pub(super) fn of_table(file: &TableFile) -> Self {
        Self {
            kinds: vec![BallKind { radius: file.ball.radius, mass: file.ball.mass }],
            ball_material: Material::bouncing(BALL_RESTITUTION),
            start: Vec::new(),
            origin: DVec2::ZERO,
            bounds: Bounds { low: DVec2::ZERO, high: vector(file.size) },
        }
    }
}

/// Of steel on steel.
const BALL_RESTITUTION: f64 = 0.9;

pub(super) struct Builder<'a> {
    pub(super) context: &'a Context<'a>,
    pub(super) scene: Scene,
    /// Of the element that is being added.
    pub(super) floor: u8,
}

impl Builder<'_> {
    fn add(&mut self, index: u16, element: &ElementFile) -> Result<(), TableError> {
        let spot = Spot::Element(index);
        match element {
            ElementFile::Wall(wall) => {
                let material = self.material(spot, &wall.material)?;
                self.floor = wall.floor;
                self.polyline(index, &wall.points, material)
            }
            ElementFile::Arc(arc) => self.arc(index, arc),
            ElementFile::Post(post) => {
                let material = self.material(spot, &post.material)?;
                self.floor = post.floor;
                self.disc(index, post.center, post.radius, Side::Outside, material, Role::Solid)
            }
            ElementFile::Ring(ring) => {
                let material = self.material(spot, &ring.material)?;
                self.floor = ring.floor;
                self.disc(index, ring.center, ring.radius, Side::Inside, material, Role::Solid)
            }
            ElementFile::Hole(hole) => {
                self.floor = hole.floor;
                if hole.leads_to == hole.floor {
                    let problem = format!("it is on floor {} already; another floor would be right", hole.floor);
                    return Err(self.context.error(spot, Some("leads_to"), problem));
                }
                self.sensor(index, hole.from, hole.to, Role::Hole { to: hole.leads_to })
            }
            ElementFile::Edge(edge) => {
                let (below, above) = edge.floors;
                if below == above {
                    let problem = format!("both sides are floor {below}; two floors would be right");
                    return Err(self.context.error(spot, Some("floors"), problem));
                }
                for (floor, to) in [(below, above), (above, below)] {
                    self.floor = floor;
                    self.sensor(index, edge.from, edge.to, Role::Hole { to })?;
                }
                Ok(())
            }
            ElementFile::Magnet(magnet) => self.magnet(index, magnet),
            ElementFile::OneWay(wall) => {
                let material = self.material(spot, &wall.material)?;
                self.floor = wall.floor;
                let mut segment = self.segment(spot, wall.from, wall.to)?;
                segment.one_way = true;
                self.push(index, Shape::Segment(segment), material, Role::Solid, Presence::Always);
                Ok(())
            }
            ElementFile::Bumper(bumper) => {
                let material = self.material(spot, &bumper.material)?;
                let role = self.kicker(spot, bumper.kick, bumper.threshold)?;
                self.floor = bumper.floor;
                self.disc(index, bumper.center, bumper.radius, Side::Outside, material, role)
            }
            ElementFile::Slingshot(sling) => {
                let material = self.material(spot, &sling.material)?;
                let role = self.kicker(spot, sling.kick, sling.threshold)?;
                self.floor = sling.floor;
                let segment = self.segment(spot, sling.from, sling.to)?;
                self.push(index, Shape::Segment(segment), material, role, Presence::Always);
                Ok(())
            }
            ElementFile::DropTarget(target) => {
                self.speed(spot, "threshold", target.threshold)?;
                let place = self.scene.targets;
                self.scene.targets += 1;
                // `check` allows at most 64 of them.
                self.scene.targets_down |= u64::from(target.down) << place;
                let role = Role::Target { index: place, threshold: target.threshold };
                self.face(index, target, role, Presence::TargetUp(place))
            }
            ElementFile::Target(target) => self.target(index, target),
            ElementFile::Spinner(spinner) => self.spinner(index, spinner),
            ElementFile::Gate(gate) => self.gate(index, gate),
            ElementFile::Saucer(saucer) => self.saucer(index, saucer),
            ElementFile::Rollover(line) => self.line(index, line, Role::Sensor),
            ElementFile::Drain(line) => self.line(index, line, Role::Drain),
            ElementFile::Flipper(flipper) => self.flipper(index, flipper),
            ElementFile::Plunger(plunger) => self.plunger(index, plunger),
            ElementFile::Light(light) => {
                self.context.point(spot, "center", None, light.center)?;
                self.length(spot, "radius", light.radius)
            }
        }
    }

    pub(super) fn push(&mut self, element: u16, shape: Shape, material: Material, role: Role, presence: Presence) {
        let bounds = shape.bounds(self.scene.largest_radius());
        self.scene.colliders.push(Collider { shape, bounds, material, element, role, presence, floor: self.floor });
    }

    pub(super) fn material(&self, spot: Spot<'_>, name: &str) -> Result<Material, TableError> {
        let materials = &self.context.file.materials;
        let Some(found) = materials.get(name) else {
            let known: Vec<_> = materials.keys().map(String::as_str).collect();
            let problem = format!("there is no material {name:?}; there are: {}", known.join(", "));
            return Err(self.context.error(spot, Some("material"), problem));
        };
        Ok(Material {
            restitution: found.restitution,
            falloff: found.falloff,
            friction: found.friction,
            tangential: found.tangential,
        })
    }

    pub(super) fn length(&self, spot: Spot<'_>, field: &str, value: f64) -> Result<(), TableError> {
        let (least, most) = if self.context.is_scene { (1e-15, 1e12) } else { (1e-5, 1e3) };
        self.context.in_range(spot, field, value, least, most, "a length in metres such as 0.02")
    }

    pub(super) fn speed(&self, spot: Spot<'_>, field: &str, value: f64) -> Result<(), TableError> {
        self.context.in_range(spot, field, value, 0.0, 100.0, "a speed in m/s such as 0.8")
    }

    fn kicker(&self, spot: Spot<'_>, kick: f64, threshold: f64) -> Result<Role, TableError> {
        self.speed(spot, "kick", kick)?;
        self.speed(spot, "threshold", threshold)?;
        Ok(Role::Kicker { speed: kick, threshold })
    }

    pub(super) fn segment(&self, spot: Spot<'_>, from: Point, to: Point) -> Result<Segment, TableError> {
        let (a, b) = (self.context.point(spot, "from", None, from)?, self.context.point(spot, "to", None, to)?);
        self.between(spot, "to", None, a, b)
    }

    fn between(
        &self,
        spot: Spot<'_>,
        field: &str,
        item: Option<usize>,
        a: DVec2,
        b: DVec2,
    ) -> Result<Segment, TableError> {
        // Shorter than this a direction has no digits left.
        if (b - a).length() < if self.context.is_scene { 1e-150 } else { 1e-9 } {
            let problem = format!("two ends at ({}, {}) make no line; they must differ", b.x, b.y);
            return Err(self.context.error_at(spot, Some(field), item, problem));
        }
        Ok(Segment::new(a, b))
    }

    fn polyline(&mut self, index: u16, points: &[Point], material: Material) -> Result<(), TableError> {
        let spot = Spot::Element(index);
        if points.len() < 2 || points.len() > 500 {
            let problem = format!("{} points; 2 to 500 would be right", points.len());
            return Err(self.context.error(spot, Some("points"), problem));
        }
        let mut places = Vec::with_capacity(points.len());
        for (item, &point) in points.iter().enumerate() {
            places.push(self.context.point(spot, "points", Some(item), point)?);
        }
        for (item, pair) in places.windows(2).enumerate() {
            // In a scene a wall of no length is a point.
            if self.context.is_scene && pair[0] == pair[1] {
                continue;
            }
            let segment = self.between(spot, "points", Some(item + 1), pair[0], pair[1])?;
            self.push(index, Shape::Segment(segment), material, Role::Solid, Presence::Always);
        }
        // A closed line has its first corner only once.
        let closed = places.len() > 2 && places.first() == places.last();
        for &place in &places[usize::from(closed)..] {
            self.push(index, point(place), material, Role::Solid, Presence::Always);
        }
        Ok(())
    }

    fn disc(
        &mut self,
        index: u16,
        center: Point,
        radius: f64,
        side: Side,
        material: Material,
        role: Role,
    ) -> Result<(), TableError> {
        let spot = Spot::Element(index);
        let center = self.context.point(spot, "center", None, center)?;
        self.length(spot, "radius", radius)?;
        let shape = Shape::Arc(Arc { center, radius, side, span: None });
        self.push(index, shape, material, role, Presence::Always);
        Ok(())
    }

    fn arc(&mut self, index: u16, arc: &ArcFile) -> Result<(), TableError> {
        let spot = Spot::Element(index);
        let material = self.material(spot, &arc.material)?;
        self.floor = arc.floor;
        let center = self.context.point(spot, "center", None, arc.center)?;
        self.length(spot, "radius", arc.radius)?;
        self.context.in_range(spot, "from", arc.from, -720.0, 720.0, "an angle in degrees such as -90")?;
        let most = arc.from + 360.0;
        self.context.in_range(spot, "to", arc.to, arc.from + 1e-3, most, "an angle clockwise of `from`")?;
        let middle = direction(radians(0.5 * (arc.from + arc.to)));
        let cosine = libm::cos(radians(0.5 * (arc.to - arc.from)));
        let span = (arc.to < most).then_some((middle, cosine));
        let face = |side| Shape::Arc(Arc { center, radius: arc.radius, side, span });
        self.push(index, face(Side::Outside), material, Role::Solid, Presence::Always);
        // A ball that is larger than the circle cannot be inside.
        if arc.radius > self.scene.largest_radius() {
            self.push(index, face(Side::Inside), material, Role::Solid, Presence::Always);
        }
        if span.is_some() {
            for angle in [arc.from, arc.to] {
                let end = center + direction(radians(angle)) * arc.radius;
                self.push(index, point(end), material, Role::Solid, Presence::Always);
            }
        }
        Ok(())
    }

    fn line(&mut self, index: u16, line: &LineFile, role: Role) -> Result<(), TableError> {
        self.floor = line.floor;
        self.sensor(index, line.from, line.to, role)
    }

    /// A line that a ball's centre passes.
    pub(super) fn sensor(&mut self, index: u16, from: Point, to: Point, role: Role) -> Result<(), TableError> {
        let segment = self.segment(Spot::Element(index), from, to)?;
        let none = Material::bouncing(0.0);
        self.push(index, Shape::Segment(segment), none, role, Presence::Always);
        Ok(())
    }

    fn magnet(&mut self, element: u16, file: &MagnetFile) -> Result<(), TableError> {
        let spot = Spot::Element(element);
        self.length(spot, "core", file.core)?;
        self.context.in_range(
            spot,
            "radius",
            file.radius,
            file.core,
            1e3,
            "a length of at least `core`, such as 0.08",
        )?;
        self.context.in_range(spot, "strength", file.strength, -1e3, 1e3, "15 m/s^2")?;
        self.context.in_range(spot, "drag", file.drag, 0.0, 1e3, "8 1/s")?;
        let stiff = (file.strength.abs() / file.core).sqrt() * self.scene.tick_seconds;
        if stiff > MOST_STIFFNESS {
            let problem = format!(
                "a ball in a core of {} m swings faster than the table's ticks follow; a wider `core`, less `strength` or a higher `tick_hz` would be right",
                file.core
            );
            return Err(self.context.error(spot, Some("strength"), problem));
        }
        let place = self.scene.magnets.len() as u16;
        self.floor = file.floor;
        let none = Material::bouncing(0.0);
        self.disc(element, file.center, file.radius, Side::Outside, none, Role::Field { index: place })?;
        self.scene.magnets.push(MagnetSpec {
            element,
            center: vector(file.center),
            reach: file.radius,
            core: file.core,
            strength: file.strength,
            drag: file.drag,
            on: file.on,
            floor: file.floor,
        });
        Ok(())
    }

    fn flipper(&mut self, element: u16, file: &FlipperFile) -> Result<(), TableError> {
        let spot = Spot::Element(element);
        let check = |field, value, low, high, example| self.context.in_range(spot, field, value, low, high, example);
        self.length(spot, "length", file.length)?;
        self.length(spot, "base_radius", file.base_radius)?;
        self.length(spot, "tip_radius", file.tip_radius)?;
        check("base_radius", file.base_radius, file.tip_radius, file.tip_radius + 0.9 * file.length, "0.0111 m")?;
        check("rest", file.rest, -360.0, 360.0, "120.5 degrees")?;
        check("raised", file.raised, file.rest - 180.0, file.rest - 0.1, "an angle below `rest`, such as 70")?;
        check("inertia", file.inertia, 1e-12, 1e6, "1.07e-4 kg m^2")?;
        check("torque", file.torque, 1e-9, 1e6, "0.58 N m")?;
        check("ramp", file.ramp, 0.0, 1.0, "0.01 s")?;
        check("hold", file.hold, 0.0, 1.0, "0.75")?;
        check("hold_within", file.hold_within, 0.0, 180.0, "6 degrees")?;
        check("return_share", file.return_share, 1e-6, 1.0, "0.041")?;
        check("stop_restitution", file.stop_restitution, 0.0, 0.9, "0.2")?;
        let spec = FlipperSpec {
            element,
            right: file.hand == Hand::Right,
            pivot: self.context.point(spot, "pivot", None, file.pivot)?,
            length: file.length,
            base_radius: file.base_radius,
            tip_radius: file.tip_radius,
            rest: radians(file.rest),
            stroke: radians(file.rest - file.raised),
            inertia: file.inertia,
            torque: file.torque,
            ramp: file.ramp,
            hold: file.hold,
            hold_within: radians(file.hold_within),
            return_share: file.return_share,
            stop_restitution: file.stop_restitution,
            material: self.material(spot, &file.material)?,
        };
        let place = self.scene.flippers.len() as u16;
        for (swing, presence) in [(0.0, Presence::FlipperAtRest(place)), (spec.stroke, Presence::FlipperRaised(place))]
        {
            for shape in spec.shapes(swing) {
                self.push(element, shape, spec.material, Role::Solid, presence);
            }
        }
        self.scene.flippers.push(spec);
        Ok(())
    }

    fn plunger(&mut self, element: u16, file: &PlungerFile) -> Result<(), TableError> {
        let spot = Spot::Element(element);
        self.length(spot, "stroke", file.stroke)?;
        self.context.in_range(spot, "mass", file.mass, 1e-6, 1e6, "0.06 kg")?;
        self.context.in_range(spot, "force", file.force, 1e-6, 1e6, "30 N")?;
        self.context.in_range(spot, "hand_speed", file.hand_speed, 1e-6, 100.0, "0.15 m/s")?;
        let material = self.material(spot, &file.material)?;
        let segment = self.segment(spot, file.from, file.to)?;
        let place = self.scene.plungers.len() as u16;
        self.push(element, Shape::Segment(segment), material, Role::Solid, Presence::PlungerHome(place));
        self.scene.plungers.push(PlungerSpec {
            element,
            from: segment.a,
            along: segment.along,
            width: segment.length,
            // The face looks to the left when going from the first to the second end.
            normal: -tangent(segment.along),
            stroke: file.stroke,
            mass: file.mass,
            stiffness: file.force / file.stroke,
            hand_speed: file.hand_speed,
            material,
        });
        Ok(())
    }
}

/// A point is an arc of radius 0.
pub(super) fn point(center: DVec2) -> Shape {
    Shape::Arc(Arc { center, radius: 0.0, side: Side::Outside, span: None })
}
