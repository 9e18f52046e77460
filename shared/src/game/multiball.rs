//! Several balls in play: what rules ask for besides the ball of the turn, and balls that wait in saucers.

use super::state::{MOST_EXTRA, Phase};
use super::{Game, GameEventKind};
use crate::physics::ball::Instant;
use crate::rules::Occasion;

impl Phase {
    /// One more ball is to be put into play.
    pub(super) fn add_ball(&mut self) {
        if let Self::Play { extra, .. } = self {
            *extra = (*extra + 1).min(MOST_EXTRA);
        }
    }
}

impl Game {
    /// Serves a ball that the rules asked for, as soon as no other is where it is served.
    pub(super) fn serve_extra(&mut self) {
        let Phase::Play { seat, serve_in: 0, extra: 1.., .. } = self.play.phase else { return };
        let (scene, start) = (&self.table.scene, self.table.ball_start);
        let now = Instant::start_of(self.world.state().tick);
        let reach = 2.0 * scene.largest_radius();
        let is_clear = self.world.state().balls.iter().all(|ball| {
            ball.floor > 0 || ball.saucer().is_some() || (ball.at(now, scene.tick_seconds).0 - start).length() > reach
        });
        if is_clear
            && self.world.serve(start).is_some()
            && let Phase::Play { extra, .. } = &mut self.play.phase
        {
            *extra -= 1;
            self.emit(GameEventKind::Added { seat });
        }
    }

    /// A ball is lost: for some time it is put into play again.
    pub(super) fn save_ball(&mut self) {
        if let Phase::Play { seat, .. } = self.play.phase
            && self.play.rules.save(&self.table)
        {
            self.play.phase.add_ball();
            self.emit(GameEventKind::Saved { seat });
        }
    }

    /// Balls in play and to be put into play, without those that are locked.
    pub(super) fn balls_of_turn(&self) -> usize {
        match self.play.phase {
            Phase::Play { extra, .. } => self.world.loose_balls() + extra as usize,
            _ => 0,
        }
    }

    /// After the rules of a tick before which that many balls were in play.
    pub(super) fn heed_end_of_multiball(&mut self, balls_before: usize) {
        if balls_before > 1 && self.balls_of_turn() == 1 {
            self.occasion(Occasion::MultiballEnd, None);
        }
    }

    /// Balls that wait in saucers for a rule are thrown out when no other ball is left that could make it happen.
    pub(super) fn free_held_balls(&mut self) {
        if let Phase::Play { serve_in: 0, extra: 0, .. } = self.play.phase
            && self.world.waits_in_saucers()
        {
            for saucer in 0..self.table.scene.saucers.len() {
                self.world.kick(saucer as u16);
            }
        }
    }
}
