//! Where drills are played: Classic with a ball that arrives at a flipper as told, and a player's buttons at fixed ticks.

use std::sync::Arc;

use glam::DVec2;

use crate::math::tangent;
use crate::physics::ball::{Instant, Support};
use crate::physics::flipper::FlipperSpec;
use crate::physics::scene::{Material, Scene};
use crate::physics::{Event, EventKind, World};
use crate::table::Table;

/// The left flipper's place among those of Classic, and the right one's.
pub(super) const LEFT: usize = 0;
pub(super) const RIGHT: usize = 1;

/// A button at a tick: right or left, pressed or released.
#[derive(Debug, Clone, Copy, PartialEq)]
pub(super) struct Key {
    pub(super) tick: u64,
    pub(super) right: bool,
    pub(super) pressed: bool,
}

/// A left or right button.
pub(super) fn key(tick: u64, right: bool, pressed: bool) -> Key {
    Key { tick, right, pressed }
}

/// A ball that is put into play.
#[derive(Debug, Clone, Copy, PartialEq)]
pub(super) struct Start {
    pub(super) position: DVec2,
    pub(super) velocity: DVec2,
    pub(super) spin: f64,
}

impl Start {
    /// The ball that flies to `place` and has `velocity` there, so many seconds before.
    pub(super) fn flying(scene: &Scene, place: DVec2, velocity: DVec2, before: f64) -> Self {
        let position = place - (velocity - scene.gravity * (0.5 * before)) * before;
        Self { position, velocity: velocity - scene.gravity * before, spin: 0.0 }
    }

    /// A ball that rolls clockwise along a surface with that normal, at that speed.
    pub(super) fn rolling(scene: &Scene, position: DVec2, normal: DVec2, speed: f64) -> Self {
        Self { position, velocity: tangent(normal) * speed, spin: -speed / scene.radius(0) }
    }
}

/// A drill on its way.
#[derive(Debug, Clone)]
pub(super) struct Drill {
    pub(super) world: World,
    keys: Vec<Key>,
}

impl Drill {
    pub(super) fn new(scene: &Arc<Scene>, keys: &[Key]) -> Self {
        Self { world: World::new(Arc::clone(scene)), keys: keys.to_vec() }
    }

    /// With a ball from the beginning.
    pub(super) fn with_ball(scene: &Arc<Scene>, start: Start, keys: &[Key]) -> Self {
        let mut drill = Self::new(scene, keys);
        drill.put(start);
        drill
    }

    /// Puts a ball into play.
    ///
    /// # Panics
    /// If there is no such place: the drills' own are on the table.
    pub(super) fn put(&mut self, start: Start) {
        let put = self.world.launch(0, start.position, start.velocity);
        assert!(put.is_some(), "{start:?} is beside the table");
        let mut state = self.world.state().clone();
        if let Some(ball) = state.balls.last_mut() {
            ball.spin = start.spin;
        }
        // Differs in a finite spin only.
        let restored = self.world.restore(state);
        assert!(restored.is_ok(), "{restored:?}");
    }

    /// Presses or releases a button so many ticks from now.
    pub(super) fn press_after(&mut self, ticks: u64, right: bool, pressed: bool) {
        self.keys.push(key(self.world.state().tick + ticks, right, pressed));
    }

    /// Presses what is due and steps; what happened.
    pub(super) fn step(&mut self) -> &[Event] {
        let tick = self.world.state().tick;
        for key in self.keys.iter().filter(|key| key.tick == tick) {
            self.world.press(key.right, key.pressed);
        }
        self.world.step()
    }

    /// Steps until that tick.
    pub(super) fn run_until(&mut self, tick: u64) {
        while self.world.state().tick < tick {
            self.step();
        }
    }

    /// Centre and velocity of the ball between two ticks; `None` once it has drained.
    pub(super) fn ball(&self) -> Option<(DVec2, DVec2)> {
        let now = Instant::start_of(self.world.state().tick);
        self.world.state().balls.first().map(|ball| ball.at(now, self.world.scene().tick_seconds))
    }

    /// The ball's speed, m/s; infinite once it has drained.
    pub(super) fn speed(&self) -> f64 {
        self.ball().map_or(f64::INFINITY, |(_, velocity)| velocity.length())
    }

    /// Whether the ball lies still.
    pub(super) fn is_still(&self) -> bool {
        self.world.state().balls.first().is_some_and(|ball| {
            ball.flight.velocity == DVec2::ZERO
                && ball.flight.acceleration == DVec2::ZERO
                && matches!(ball.support, Support::Wedge(..) | Support::Line(_) | Support::Arc(_))
        })
    }

    /// Whether the ball touches that flipper or is nearer to it than `gap`, m.
    pub(super) fn is_at_flipper(&self, flipper: usize, gap: f64) -> bool {
        let (scene, state) = (self.world.scene(), self.world.state());
        let spec = &scene.flippers[flipper];
        self.ball().is_some_and(|(position, _)| {
            let axis = spec.direction(state.flippers[flipper].swing);
            spec.nearest(axis, position).distance < scene.radius(0) + gap
        })
    }
}

/// Whether an event is a touch of that flipper.
pub(super) fn touches(scene: &Scene, event: &Event, flipper: usize) -> bool {
    matches!(event.kind, EventKind::Touched { element, .. } if element == scene.flippers[flipper].element)
}

/// Classic, at so many ticks a second.
///
/// # Panics
/// If the shipped table is wrong; the tests of the tables tell.
pub(super) fn classic(tick_hz: u32) -> Arc<Scene> {
    match Table::shipped("classic").map(|table| table.map(|table| table.run_with(None, Some(tick_hz)))) {
        Some(Ok(Ok(table))) => table.scene,
        other => panic!("{other:?}"),
    }
}

/// The place of one of Classic's elements.
///
/// # Panics
/// If it has none of that name.
pub(super) fn element(name: &str) -> u16 {
    let place = match Table::shipped("classic") {
        Some(Ok(table)) => {
            (0..).zip(&table.file.elements).find(|(_, element)| element.name() == name).map(|(place, _)| place)
        }
        _ => None,
    };
    match place {
        Some(place) => place,
        None => panic!("Classic has no {name:?}"),
    }
}

/// At which a ball comes to roll on a flipper, m/s: let go from the cradle, from halfway up the guide, from its top.
pub(super) const ROLL_INS: [f64; 3] = [0.0, 0.25, 0.5];

/// A ball that begins to roll down the left flipper: the button of a flipper on which it lay still is released, or it rolls out
/// of the inlane at that speed onto a flipper at rest.
pub(super) fn rolled_in(scene: &Arc<Scene>, speed: f64) -> Drill {
    let spec = &scene.flippers[LEFT];
    if speed == 0.0 {
        let (place, _) = on_face(spec, spec.stroke, 0.02, scene.radius(0));
        let mut drill = Drill::new(scene, &[key(0, false, true)]);
        drill.run_until(300);
        drill.put(Start { position: place, velocity: DVec2::ZERO, spin: 0.0 });
        while !drill.is_still() && drill.world.state().tick < 10_000 {
            drill.step();
        }
        drill.press_after(0, false, false);
        return drill;
    }
    // Along the guide, 20 mm before its foot.
    let (foot, down) = (DVec2::new(0.146, 0.1822), DVec2::new(0.105, -0.073).normalize());
    let (normal, way) = (-tangent(down), 0.02);
    let gained = 2.0 * crate::physics::constants::ROLLING_SHARE * scene.gravity.dot(down) * way;
    let position = foot - down * way + normal * scene.radius(0);
    let start = Start::rolling(scene, position, normal, (speed * speed - gained).sqrt());
    Drill::with_ball(scene, start, &[])
}

/// The upper face of a flipper at that swing: a point of it `place` metres from the pivot along its axis, its normal, and
/// where a ball's centre is that touches it there.
pub(super) fn on_face(spec: &FlipperSpec, swing: f64, place: f64, radius: f64) -> (DVec2, DVec2) {
    let axis = spec.direction(swing);
    let up = axis.perp() * if spec.right { -1.0 } else { 1.0 };
    let above = spec.pivot + axis * place + up * (2.0 * spec.base_radius + radius);
    let nearest = spec.nearest(axis, above);
    (above - nearest.normal * (nearest.distance - radius), nearest.normal)
}

/// A square of 4 m with that element, of a material called `surface`, and nothing else.
///
/// # Panics
/// If the element is written wrong: it is one of the drills' own.
pub(super) fn bare(gravity: DVec2, element: &str, material: Material, tick_hz: u32) -> Arc<Scene> {
    let text = format!(
        r#"(format: 1, physics: {}, name: "drill", size: (4.0, 4.0), gravity: ({:?}, {:?}), rest_speed: 0.02, tick_hz: {tick_hz},
        ball: (radius: 0.0135, mass: 0.08, start: (0.2, 3.8)), materials: {{ "surface": (restitution: 0.5) }},
        elements: [{element} Drain(name: "drain", from: (0.0, 0.01), to: (4.0, 0.01))],
        rules: (balls: 3, max_multiplier: 6, on: []))"#,
        crate::physics::PHYSICS_VERSION,
        gravity.x,
        gravity.y
    );
    let scene = match Table::parse("drill.ron", &text) {
        Ok(table) => (*table.scene).clone(),
        Err(error) => panic!("{error}"),
    };
    Arc::new(made_of(scene, material))
}

/// The scene with everything made of that material: a table's own go no farther than real ones.
fn made_of(mut scene: Scene, material: Material) -> Scene {
    for collider in &mut scene.colliders {
        collider.material = material;
    }
    for flipper in &mut scene.flippers {
        flipper.material = material;
    }
    scene.built()
}
