//! One ball among static shapes, as one would write it for this alone: no spin, no contact at rest, no sensors, one motion
//! model, no broad phase. It calls the engine's own functions of impact, and so arrives at the engine's own bits.

use shared::physics::ball::{Flight, Instant};
use shared::physics::contact::{Mobility, Surface, respond};
use shared::physics::impact::{Search, ball_shape};
use shared::physics::scene::{Material, Scene};
use shared::physics::shapes::Shape;

pub(crate) struct ByHand {
    pub(crate) flight: Flight,
    shapes: Vec<(Shape, Material)>,
    radius: f64,
    mass: f64,
    dt: f64,
    tick: u64,
    /// What is met next, and when: seconds since the flight's start.
    next: (f64, usize),
    /// The tick in which that is.
    busy: u64,
}

impl ByHand {
    pub(crate) fn new(scene: &Scene) -> Self {
        let ball = scene.start[0];
        let flight = Flight {
            start: Instant::start_of(0),
            position: ball.position,
            velocity: ball.velocity,
            acceleration: scene.gravity,
        };
        let shapes = scene.colliders.iter().map(|collider| (collider.shape, collider.material)).collect();
        let (radius, mass) = (scene.radius(ball.kind), scene.mass(ball.kind));
        let mut world = Self { flight, shapes, radius, mass, dt: scene.tick_seconds, tick: 0, next: (0.0, 0), busy: 0 };
        world.look_ahead();
        world
    }

    /// Advances by a tick; how many impacts there were.
    #[inline]
    pub(crate) fn step(&mut self) -> u64 {
        let mut impacts = 0;
        while self.tick >= self.busy {
            self.bounce();
            impacts += 1;
        }
        self.tick += 1;
        impacts
    }

    fn bounce(&mut self) {
        let (time, index) = self.next;
        let (shape, material) = self.shapes[index];
        let position = self.flight.position_at(time);
        let normal = shape.normal_at(position);
        let surface =
            Surface { normal, velocity: glam::DVec2::ZERO, material, mobility: Mobility::default(), kick: 0.0 };
        let after = respond(self.flight.velocity_at(time), 0.0, self.radius, self.mass, &surface);
        let elapsed = Instant::start_of(self.tick).since(self.flight.start, self.dt);
        let start = Instant { tick: self.tick, offset: time - elapsed };
        self.flight = Flight { start, position, velocity: after.velocity, ..self.flight };
        self.look_ahead();
    }

    /// Solves the flight, once.
    fn look_ahead(&mut self) {
        self.next = self.first_impact();
        let elapsed = Instant::start_of(self.tick).since(self.flight.start, self.dt);
        // As the engine does it: the end of a tick decides, and the division is a first guess.
        self.busy = self.tick + (((self.next.0 - elapsed) / self.dt) as u64).saturating_sub(1);
        while Instant::start_of(self.busy + 1).since(self.flight.start, self.dt) <= self.next.0 {
            self.busy += 1;
        }
    }

    fn first_impact(&self) -> (f64, usize) {
        let mut first = (f64::INFINITY, 0);
        for (index, (shape, _)) in self.shapes.iter().enumerate() {
            if let Some(time) = ball_shape(&self.flight, self.radius, shape, &Search::up_to(first.0)).time() {
                first = (time, index);
            }
        }
        first
    }
}
