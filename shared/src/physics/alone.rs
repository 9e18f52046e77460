//! Flippers and plungers that move while no ball is near: a tick of theirs is their own motion and nothing else, with the same
//! bits as in a tick that is played in full.

use super::ball::{Ball, Instant};
use super::flipper::FlipperRest;
use super::world::World;

/// Share of the time that the nearest ball takes at the least for which it is relied on to be away: the rest is for rounding.
const RELIED_ON: f64 = 0.99;

impl World {
    /// Whether a flipper or a plunger is on its way, or held off its place.
    pub(super) fn any_mover(&self) -> bool {
        let state = &self.state;
        state.flippers.iter().any(|flipper| flipper.rest == FlipperRest::Moving)
            || state.plungers.iter().any(|plunger| !plunger.home)
    }

    /// The first tick in which a ball may meet what moves now, if nothing else happens to it before.
    pub(super) fn may_meet_mover_in(&self, ball: &Ball) -> u64 {
        let (state, scene) = (&self.state, &*self.scene);
        let (position, velocity) = ball.at(Instant::start_of(state.tick), scene.tick_seconds);
        let (speed, pull) = (velocity.length(), ball.flight.acceleration.length());
        let radius = scene.radius(ball.kind);
        // Seconds in which something comes as far as `way`, at the least, at that speed and with the ball's pull.
        let time = |way: f64, speed: f64| 2.0 * way / (speed + (speed * speed + 2.0 * pull * way).sqrt());
        let mut least = f64::INFINITY;
        let mut take = |time: f64| {
            // What is no number is no time to rely on.
            let is_shorter = time.is_nan() || time < least;
            least = if is_shorter { time } else { least };
        };
        for (spec, flipper) in scene.flippers.iter().zip(&state.flippers) {
            if flipper.rest == FlipperRest::Moving {
                let way = (position - spec.pivot).length() - spec.reach() - radius;
                take(if way > 0.0 { time(way, speed) } else { 0.0 });
            }
        }
        for (spec, plunger) in scene.plungers.iter().zip(&state.plungers) {
            if !plunger.home {
                // A hand moves it slowly. One that is let go may be anywhere up to its home at once.
                let (pull, approach) =
                    if plunger.hand.is_some() { (plunger.pull, spec.hand_speed) } else { (0.0, 0.0) };
                let way = spec.way_to_face(pull, position, radius);
                take(if way > 0.0 { time(way, speed + approach) } else { 0.0 });
            }
        }
        // A cast saturates, and makes 0 of what is no number.
        state.tick.saturating_add((RELIED_ON * least / scene.tick_seconds) as u64)
    }

    /// Moves flippers and plungers on by a tick in which they touch nothing; `false`, and nothing has changed, if one of them
    /// comes to a stop or home in it.
    #[inline(never)]
    pub(super) fn move_alone(&mut self) -> bool {
        let dt = self.scene.tick_seconds;
        for index in 0..self.state.flippers.len() {
            let flipper = self.state.flippers[index];
            self.flipper_motions[index] = (flipper.rest == FlipperRest::Moving)
                .then(|| self.scene.flippers[index].free_motion(&flipper, 0.0, dt));
            if self.moving_flipper(index).is_some_and(|flipper| flipper.meets_stop(0.0, dt).is_some()) {
                return false;
            }
        }
        for index in 0..self.state.plungers.len() {
            let plunger = self.state.plungers[index];
            self.plunger_motions[index] = (!plunger.home).then(|| self.scene.plungers[index].motion(&plunger, 0.0, dt));
            if self.plunger_comes_home(index, 0.0, dt).is_some() || (!plunger.home && plunger.stays_home()) {
                return false;
            }
        }
        self.settle_moved();
        true
    }
}
