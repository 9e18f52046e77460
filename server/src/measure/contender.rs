//! Whoever is measured: the engine with some setting, or another engine.

use std::sync::Arc;
use std::time::{Duration, Instant as Clock};

use shared::physics::ball::Instant;
use shared::physics::motion::Motion;
use shared::physics::scene::Scene;
use shared::physics::{EventKind, World};

use super::real::{Real, Wide};
use super::trajectory::{Piece, Trajectory};

/// Someone who can play a scene.
pub trait Contender {
    /// What it is called in tables and plots: settings of one name are one line.
    fn name(&self) -> String;

    /// Steps a second.
    fn hz(&self) -> u32;

    /// What distinguishes it from others of that name.
    fn setting(&self) -> String {
        format!("{} Hz", self.hz())
    }

    /// Plays a scene and tells every ball's way.
    ///
    /// # Errors
    /// If it can't play this scene, or not within `patience`.
    fn play(&self, scene: &Scene, seconds: f64, patience: Duration) -> Result<Trajectory, String>;

    /// Plays a scene and tells what that took, without building the world or recording anything.
    ///
    /// # Errors
    /// As [`Self::play`].
    fn time(&self, scene: &Scene, seconds: f64, patience: Duration) -> Result<Timed, String>;
}

/// What a run took.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct Timed {
    /// Nanoseconds.
    pub nanoseconds: f64,
    /// Simulated: less than asked for if no ball was left.
    pub seconds: f64,
}

/// The engine itself.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct Setting {
    /// The motion model.
    pub motion: Motion,
    /// Ticks a second.
    pub tick_hz: u32,
    /// The pixel model's step, m; nothing: the scene's.
    pub pixel: Option<f64>,
}

impl Setting {
    fn of(motion: Motion, tick_hz: u32) -> Self {
        Self { motion, tick_hz, pixel: None }
    }

    /// The scene as this setting runs it.
    pub fn scene(&self, scene: &Scene) -> Arc<Scene> {
        let mut scene = scene.clone();
        (scene.motion, scene.tick_seconds) = (self.motion, 1.0 / f64::from(self.tick_hz));
        scene.pixel = self.pixel.unwrap_or(scene.pixel);
        Arc::new(scene)
    }

    fn ticks(&self, seconds: f64) -> u64 {
        // A cast saturates.
        (seconds * f64::from(self.tick_hz)).ceil() as u64 + 1
    }
}

/// Rates of the ladder, ticks a second.
const RATES: [u32; 9] = [60, 120, 240, 480, 1000, 2000, 4000, 8000, 16_000];
/// Shares of the table's pixel.
const PIXELS: [f64; 3] = [4.0, 0.25, 0.0625];

/// Every motion model at a ladder of step sizes: at 1000 Hz the pixel model with other pixels as well.
pub fn ladder(scene: &Scene, quick: bool) -> Vec<Setting> {
    let mut settings = Vec::new();
    for motion in Motion::ALL {
        let rates = RATES.iter().filter(|&&rate| !quick || [60, 240, 1000, 4000, 16_000].contains(&rate));
        settings.extend(rates.map(|&rate| Setting::of(motion, rate)));
        if motion == Motion::Pixel {
            settings
                .extend(PIXELS.map(|share| Setting { pixel: Some(share * scene.pixel), ..Setting::of(motion, 1000) }));
        }
    }
    settings
}

/// Ticks after which a run looks at the clock.
const TICKS_BETWEEN_LOOKS: u64 = 256;

impl Contender for Setting {
    fn name(&self) -> String {
        self.motion.name().to_owned()
    }

    fn hz(&self) -> u32 {
        self.tick_hz
    }

    fn setting(&self) -> String {
        match self.pixel {
            Some(pixel) => format!("{} Hz, {} mm", self.tick_hz, pixel * 1e3),
            None => format!("{} Hz", self.tick_hz),
        }
    }

    fn play(&self, scene: &Scene, seconds: f64, patience: Duration) -> Result<Trajectory, String> {
        let mut world = World::new(self.scene(scene));
        let mut told = Trajectory { lost: vec![None; scene.start.len()], end: seconds, ..Trajectory::default() };
        let dt = Wide::of(world.scene().tick_seconds);
        let time = |at: Instant| Wide::of(at.tick as f64) * dt + Wide::of(at.offset);
        for ball in &world.state().balls {
            let flight = ball.flight;
            let (start, position, velocity) = (time(flight.start), flight.position, flight.velocity);
            told.balls.push(vec![Piece { start, position, velocity, acceleration: flight.acceleration }]);
        }
        let begun = Clock::now();
        for tick in 0..self.ticks(seconds) {
            if tick % TICKS_BETWEEN_LOOKS == 0 && begun.elapsed() > patience {
                return Err(too_slow(patience));
            }
            for event in world.step() {
                let (ball, start) = (event.ball as usize, time(event.at));
                let (position, velocity) = (event.position, event.velocity);
                match event.kind {
                    EventKind::Escaped | EventKind::Drained => {
                        if event.kind == EventKind::Escaped {
                            told.escaped.push(ball);
                        }
                        told.lost[ball] = Some(start.to_f64());
                    }
                    EventKind::Passed { .. } => {}
                    _ => told.balls[ball].push(Piece { start, position, velocity, acceleration: scene.gravity }),
                }
            }
            // What no event tells of: a ball that rolls, or comes to rest.
            for ball in &world.state().balls {
                let (flight, pieces) = (ball.flight, &mut told.balls[ball.id as usize]);
                let start = time(flight.start);
                let piece = Piece {
                    start,
                    position: flight.position,
                    velocity: flight.velocity,
                    acceleration: flight.acceleration,
                };
                match pieces.last_mut() {
                    Some(last) if last.start == start => *last = piece,
                    Some(last) if last.start > start => {}
                    _ => pieces.push(piece),
                }
            }
            if world.state().balls.is_empty() {
                break;
            }
        }
        Ok(told)
    }

    fn time(&self, scene: &Scene, seconds: f64, patience: Duration) -> Result<Timed, String> {
        let mut world = World::new(self.scene(scene));
        let ticks = self.ticks(seconds);
        let begun = Clock::now();
        while world.state().tick < ticks && !world.state().balls.is_empty() {
            for _ in 0..TICKS_BETWEEN_LOOKS.min(ticks - world.state().tick) {
                std::hint::black_box(world.step());
            }
            if begun.elapsed() > patience {
                return Err(too_slow(patience));
            }
        }
        let nanoseconds = begun.elapsed().as_secs_f64() * 1e9;
        Ok(Timed { nanoseconds, seconds: world.state().tick as f64 / f64::from(self.tick_hz) })
    }
}

/// What whoever takes longer is told.
pub fn too_slow(patience: Duration) -> String {
    format!("it took more than {} s", patience.as_secs_f64())
}
