//! What sounds without an event: flippers that fall back, plungers, targets that are raised, a multiplier that rises, a ball
//! that drains while others are in play. Seen from one picture to the next.

use shared::game::Phase;
use shared::physics::TargetState;

use super::bank::Sound;
use super::listener::Listener;
use super::mixer::Cue;
use crate::moment::Moment;

/// Shares of its way at which a flipper counts as up, and as back on its stop.
const UP: f64 = 0.5;
const DOWN: f64 = 0.1;
/// Share of its stroke by which a plunger must be drawn to be heard.
const DRAWN: f64 = 0.1;

/// The moving parts of a board as they were seen last.
#[derive(Debug, Default)]
pub(super) struct Machinery {
    before: Option<Seen>,
}

#[derive(Debug)]
struct Seen {
    tick: u64,
    /// For each flipper, whether it was up and is not back yet.
    flippers: Vec<bool>,
    /// For each plunger, how far it was drawn since it was home last, metres.
    plungers: Vec<f64>,
    targets: Vec<TargetState>,
    /// Seat, ball and multiplier of the turn.
    turn: Option<(u8, u32, u32)>,
    balls: usize,
}

impl Machinery {
    /// Compares a picture with the one before.
    pub(super) fn observe(&mut self, moment: &Moment<'_>, listener: &mut Listener, play: &mut impl FnMut(Cue)) {
        let mut now = Seen::of(moment);
        if let Some(before) = self.before.take().filter(|before| before.is_before(&now)) {
            now.compare(&before, moment, listener, play);
        }
        self.before = Some(now);
    }
}

impl Seen {
    fn of(moment: &Moment<'_>) -> Self {
        let turn = match moment.game.phase() {
            Phase::Play { seat, ball, .. } => {
                let seats = moment.game.seats().get(usize::from(seat));
                seats.map(|of| (seat, ball, of.score.multiplier))
            }
            Phase::Idle | Phase::Over => None,
        };
        Self {
            tick: moment.at.tick,
            flippers: vec![false; moment.flippers.len()],
            plungers: moment.plungers.clone(),
            targets: moment.game.world().state().targets.clone(),
            turn,
            balls: moment.balls.len(),
        }
    }

    /// Whether the other one comes after it in the same game.
    fn is_before(&self, other: &Self) -> bool {
        let counts = |seen: &Self| [seen.flippers.len(), seen.plungers.len(), seen.targets.len()];
        self.tick <= other.tick && counts(self) == counts(other)
    }

    fn compare(&mut self, before: &Self, moment: &Moment<'_>, listener: &mut Listener, play: &mut impl FnMut(Cue)) {
        let scene = &moment.game.table().scene;
        for (place, spec) in scene.flippers.iter().enumerate() {
            let share = moment.flippers[place] / spec.stroke;
            self.flippers[place] = share > UP || (before.flippers[place] && share > DOWN);
            if before.flippers[place] && !self.flippers[place] {
                play(listener.cue(Sound::FlipperDown, 1.0, Some(spec.element)));
            }
        }
        for (place, spec) in scene.plungers.iter().enumerate() {
            let (most, pull) = (before.plungers[place], moment.plungers[place]);
            let (was_drawn, is_drawn) = (most > DRAWN * spec.stroke, pull > DRAWN * spec.stroke);
            if is_drawn && !was_drawn {
                play(listener.cue(Sound::Pull, 1.0, Some(spec.element)));
            }
            if was_drawn && !is_drawn {
                play(listener.cue(Sound::Launch, (most / spec.stroke) as f32, Some(spec.element)));
            }
            self.plungers[place] = if is_drawn { pull.max(most) } else { pull };
        }
        let mut targets = before.targets.iter().zip(&self.targets);
        let raised = targets.position(|(before, now)| *before != TargetState::Up && *now == TargetState::Up);
        if let Some(target) = raised {
            play(listener.cue(Sound::Raise, 1.0, moment.game.table().targets.get(target).copied()));
        }
        if let (Some((seat, ball, more)), Some((same_seat, same_ball, less))) = (self.turn, before.turn)
            && (seat, ball) == (same_seat, same_ball)
        {
            if more > less {
                play(Cue { pitch: 1.0, ..listener.cue(Sound::Multiplier, 1.0, None) });
            }
            // The last one's end is an event of its own.
            if (1..before.balls).contains(&self.balls) {
                play(listener.cue(Sound::Drain, 0.6, None));
            }
        }
    }
}
