//! A peer as a contender: measured like the engine, by the same code and against the same reference.

use std::time::{Duration, Instant};

use shared::physics::scene::Scene;
use starball_server::measure::contender::{Contender, Timed, too_slow};
use starball_server::measure::real::{Real, Wide};
use starball_server::measure::trajectory::{Piece, Trajectory};

use crate::Peer;

/// A peer at a rate.
pub struct Entrant {
    /// Which.
    pub peer: &'static dyn Peer,
    /// Steps a second.
    pub rate: u32,
}

/// Steps after which a run looks at the clock.
const STEPS_BETWEEN_LOOKS: u64 = 256;

impl Entrant {
    fn steps(&self, seconds: f64) -> u64 {
        // A cast saturates.
        (seconds * f64::from(self.rate)).ceil() as u64 + 1
    }
}

impl Contender for Entrant {
    fn name(&self) -> String {
        self.peer.name().to_owned()
    }

    fn hz(&self) -> u32 {
        self.rate
    }

    fn play(&self, scene: &Scene, seconds: f64, patience: Duration) -> Result<Trajectory, String> {
        let mut world = self.peer.world(scene, self.rate)?;
        let (mut balls, begun) = (Vec::new(), Instant::now());
        let mut told =
            Trajectory { lost: vec![None; scene.start.len()], steps: true, end: seconds, ..Trajectory::default() };
        told.balls.resize(scene.start.len(), Vec::new());
        for step in 0..=self.steps(seconds) {
            if step > 0 {
                world.step()?;
            }
            world.balls(&mut balls)?;
            // A step is 1 / rate seconds long, to more digits than a double has.
            let start = Wide::of(step as f64) / Wide::of(f64::from(self.rate));
            let ways = told.balls.iter_mut().zip(&mut told.lost).zip(&balls);
            for (place, ((pieces, lost), ball)) in ways.enumerate() {
                pieces.push(Piece {
                    start,
                    position: ball.position,
                    velocity: ball.velocity,
                    acceleration: scene.gravity,
                });
                if lost.is_none() && !scene.is_inside(ball.position) {
                    *lost = Some(start.to_f64());
                    told.escaped.push(place);
                }
            }
            if step % STEPS_BETWEEN_LOOKS == 0 && begun.elapsed() > patience {
                return Err(too_slow(patience));
            }
        }
        Ok(told)
    }

    fn time(&self, scene: &Scene, seconds: f64, patience: Duration) -> Result<Timed, String> {
        let mut world = self.peer.world(scene, self.rate)?;
        let (steps, begun) = (self.steps(seconds), Instant::now());
        for step in 1..=steps {
            world.step()?;
            if step % STEPS_BETWEEN_LOOKS == 0 && begun.elapsed() > patience {
                return Err(too_slow(patience));
            }
        }
        let nanoseconds = begun.elapsed().as_secs_f64() * 1e9;
        Ok(Timed { nanoseconds, seconds: steps as f64 / f64::from(self.rate) })
    }
}
