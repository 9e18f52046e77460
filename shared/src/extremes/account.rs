//! The energy account of a world in play: what its balls and flippers have, and what they may have by what coils, springs and
//! hands have given them so far.

use glam::DVec2;

use super::cases::{balls, energy};
use crate::physics::ball::Instant;
use crate::physics::flipper::{FlipperSpec, FlipperState};
use crate::physics::plunger::PlungerState;
use crate::physics::scene::{Role, Scene};
use crate::physics::shapes::Shape;
use crate::physics::{Event, EventKind, World};

/// What was given, tick by tick.
#[derive(Debug, Clone)]
pub(super) struct Account {
    /// Height of each floor as an energy: see [`heights`].
    heights: Vec<f64>,
    /// J; with the height of (0, 0) as that of no energy, as in [`energy`].
    allowed: f64,
    /// What there was before the tick, and what was given in it, J.
    before: f64,
    given: f64,
    /// As they were before the tick.
    flippers: Vec<FlipperState>,
    plungers: Vec<PlungerState>,
}

impl Account {
    pub(super) fn new(world: &World) -> Self {
        let heights = heights(world.scene());
        let allowed = present(world, &heights);
        Self { heights, allowed, before: 0.0, given: 0.0, flippers: Vec::new(), plungers: Vec::new() }
    }

    /// Just before a step, after the buttons.
    pub(super) fn open(&mut self, world: &World) {
        self.before = present(world, &self.heights);
        self.flippers.clone_from(&world.state().flippers);
        self.plungers.clone_from(&world.state().plungers);
    }

    /// Just after it: adds what was given in it.
    pub(super) fn close(&mut self, world: &World) {
        let (scene, state, dt) = (world.scene(), world.state(), world.scene().tick_seconds);
        let flippers = scene.flippers.iter().zip(&self.flippers).zip(&state.flippers);
        let coils = flippers.map(|((spec, was), is)| work(spec, was, is.swing - was.swing, dt));
        // A hand lets go of a plunger: its spring gives all that it holds.
        let let_go = |was: &PlungerState| was.hand.is_none() && was.speed == 0.0 && was.pull > 0.0;
        let plungers = scene.plungers.iter().zip(&self.plungers).filter(|(_, was)| let_go(was));
        let springs = plungers.map(|(spec, was)| 0.5 * spec.stiffness * was.pull * was.pull);
        let kickers = world.events().iter().map(|event| kicked(scene, event) - taken_along(scene, event));
        let saucers = world.events().iter().map(|event| drawn(scene, event));
        self.given = coils.chain(springs).chain(kickers).chain(saucers).sum();
        self.allowed += self.given;
    }

    /// What the world has beyond all that was given, J.
    pub(super) fn excess(&self, world: &World) -> f64 {
        present(world, &self.heights) - self.allowed
    }

    /// What it won in the tick beyond what was given in it, J: losses of before do not make up for it.
    pub(super) fn won(&self, world: &World) -> f64 {
        present(world, &self.heights) - self.before - self.given
    }
}

/// What balls, flippers and spinners have, J.
fn present(world: &World, heights: &[f64]) -> f64 {
    let (scene, state) = (world.scene(), world.state());
    let turning = scene.flippers.iter().zip(&state.flippers);
    let flippers: f64 = turning.map(|(spec, flipper)| 0.5 * spec.inertia * flipper.speed * flipper.speed).sum();
    let now = Instant::start_of(state.tick);
    let plates = scene.hinges.iter().zip(&state.hinges).map(|(spec, plate)| {
        // A gate falls shut: what it got is lost.
        let Some(friction) = spec.friction else { return 0.0 };
        let (_, speed) = plate.at(now.since(plate.start, scene.tick_seconds), friction);
        0.5 * spec.inertia * speed * speed
    });
    // Those that are not on the playfield are higher or lower than [`energy`] takes them to be.
    let above = balls(world).zip(&state.balls).map(|((position, ..), ball)| {
        let steeper = scene.gravity - scene.gravity_on(ball.floor);
        scene.mass(ball.kind) * (steeper.dot(position) + heights[usize::from(ball.floor)])
    });
    energy(world) + flippers + plates.sum::<f64>() + above.sum::<f64>()
}

/// Of each floor, J/kg: what makes up for the difference of the slopes at the edges, all level, by which it is reached.
fn heights(scene: &Scene) -> Vec<f64> {
    let mut heights = vec![0.0; 256];
    let mut is_known = [false; 256];
    is_known[0] = true;
    let ways: Vec<_> = scene
        .colliders
        .iter()
        .filter_map(|collider| match (collider.role, &collider.shape) {
            (Role::Hole { to }, Shape::Segment(line)) => Some((collider.element, collider.floor, to, line.middle)),
            _ => None,
        })
        .collect();
    // A hole leads one way, and down: a ball loses its height there.
    let is_edge = |&&(element, from, to, _): &&(u16, u8, u8, DVec2)| {
        ways.iter().any(|way| (way.0, way.1, way.2) == (element, to, from))
    };
    for _ in 0..ways.len() {
        for &(_, from, to, place) in ways.iter().filter(is_edge) {
            if is_known[usize::from(from)] && !is_known[usize::from(to)] {
                is_known[usize::from(to)] = true;
                let steeper = scene.gravity_on(to) - scene.gravity_on(from);
                heights[usize::from(to)] = heights[usize::from(from)] + steeper.dot(place);
            }
        }
    }
    heights
}

/// The most that coil or spring gave to a flipper that turned by `turned` in a tick, J: torque times angle, whatever it met on
/// the way. Near the end of its stroke the coil is weaker by a known share: it is taken for the full one where it gives, and for
/// the weak one where it takes.
fn work(spec: &FlipperSpec, was: &FlipperState, turned: f64, dt: f64) -> f64 {
    if !was.pressed {
        return -spec.return_share * spec.torque * turned;
    }
    let ramp = if spec.ramp > 0.0 { (was.coil_time + 0.5 * dt) / spec.ramp } else { 1.0 };
    let torque = spec.torque * if ramp < 1.0 { ramp } else { 1.0 };
    torque * turned * if turned > 0.0 { 1.0 } else { spec.hold }
}

/// What a kicker gave, J: with a kick k the ball parts at e v + k instead of e v.
fn kicked(scene: &Scene, event: &Event) -> f64 {
    let EventKind::Kicked { element, speed } = event.kind else { return 0.0 };
    let kicker = scene.colliders.iter().find_map(|collider| match collider.role {
        Role::Kicker { speed, .. } if collider.element == element => Some((speed, collider.material)),
        _ => None,
    });
    let (added, material) = kicker.unwrap_or((0.0, crate::physics::scene::Material::bouncing(0.0)));
    heaviest(scene) * added * (material.restitution_at(speed) * speed + 0.5 * added)
}

/// The most that a saucer gives to a ball that it draws from its rim to its middle, J.
fn drawn(scene: &Scene, event: &Event) -> f64 {
    let EventKind::Held { element } = event.kind else { return 0.0 };
    let radius = scene.colliders.iter().find_map(|collider| match &collider.shape {
        Shape::Arc(rim) if collider.element == element => Some(rim.radius),
        _ => None,
    });
    heaviest(scene) * scene.gravity.length() * radius.unwrap_or(0.0)
}

/// What a ball takes out of play, J, but for its spin.
fn taken_along(scene: &Scene, event: &Event) -> f64 {
    match event.kind {
        EventKind::Drained | EventKind::Escaped => {
            scene.mass(0) * (0.5 * event.velocity.length_squared() - scene.gravity.dot(event.position))
        }
        _ => 0.0,
    }
}

fn heaviest(scene: &Scene) -> f64 {
    scene.kinds.iter().fold(0.0, |most, kind| if kind.mass > most { kind.mass } else { most })
}
