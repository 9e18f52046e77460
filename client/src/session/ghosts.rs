//! Events that were predicted and shown, but turned out not to have happened (yet). Most do happen a moment later, as an input
//! that came late acts later: then they are not to be seen and heard a second time.

use std::collections::VecDeque;

use shared::game::{GameEvent, GameEventKind};

/// Seconds by which an event may come later than it was predicted, to be taken for the same. As much as a prediction is ahead.
const LATER: f64 = 0.25;

/// The ghosts of one board.
#[derive(Debug)]
pub(super) struct Ghosts {
    /// [`LATER`] in ticks.
    later: u64,
    /// What was shown lately, oldest first.
    shown: VecDeque<GameEvent>,
    /// What of that has not happened.
    ghosts: Vec<GameEvent>,
}

impl Ghosts {
    /// None yet.
    pub(super) fn new(tick_seconds: f64) -> Self {
        // A cast saturates.
        let later = (LATER / tick_seconds) as u64;
        Self { later, shown: VecDeque::new(), ghosts: Vec::new() }
    }

    /// Something happens: `true` if it was shown before, as a ghost that finds its rest with this.
    pub(super) fn lays(&mut self, event: &GameEvent) -> bool {
        self.forget(event.tick);
        let ghost = self.ghosts.iter().position(|ghost| is_same(ghost, event));
        if let Some(ghost) = ghost {
            self.ghosts.swap_remove(ghost);
        }
        self.shown.push_back(*event);
        ghost.is_some()
    }

    /// What was shown from `tick` on has not happened, unless it is among `events`.
    pub(super) fn rise(&mut self, tick: u64, events: &[GameEvent]) {
        while self.shown.back().is_some_and(|event| event.tick >= tick) {
            self.ghosts.extend(self.shown.pop_back());
        }
        for event in events {
            self.lays(event);
        }
    }

    fn forget(&mut self, now: u64) {
        let later = self.later;
        self.ghosts.retain(|ghost| now.saturating_sub(ghost.tick) <= later);
        while self.shown.front().is_some_and(|event| now.saturating_sub(event.tick) > later) {
            self.shown.pop_front();
        }
    }
}

/// Whether two events tell of the same, though not of the same tick, speed or place.
fn is_same(one: &GameEvent, other: &GameEvent) -> bool {
    bare(one.kind) == bare(other.kind)
}

fn bare(kind: GameEventKind) -> GameEventKind {
    use GameEventKind as K;
    match kind {
        K::Touched { element, .. } => K::Touched { element, speed: 0.0 },
        K::Kicked { element, .. } => K::Kicked { element, speed: 0.0 },
        K::Felled { element, .. } => K::Felled { element, speed: 0.0 },
        K::Struck { element, .. } => K::Struck { element, speed: 0.0 },
        K::Points { seat, points, .. } => K::Points { seat, points, place: None },
        K::Met { .. } => K::Met { speed: 0.0, place: (0.0, 0.0) },
        other => other,
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    fn kicked(tick: u64, element: u16, speed: f32) -> GameEvent {
        GameEvent { tick, kind: GameEventKind::Kicked { element, speed } }
    }

    #[test]
    fn what_comes_a_little_later_than_predicted_was_shown() {
        let mut ghosts = Ghosts::new(0.001);
        assert!(!ghosts.lays(&kicked(100, 1, 2.0)) && !ghosts.lays(&kicked(120, 2, 2.0)));
        ghosts.rise(90, &[]);
        assert!(ghosts.lays(&kicked(130, 2, 1.5)), "another speed, another tick, the same kick");
        assert!(ghosts.lays(&kicked(131, 1, 2.0)));
        assert!(!ghosts.lays(&kicked(140, 1, 2.0)), "the next kick is a new one");
    }

    #[test]
    fn what_happens_on_the_way_leaves_no_ghost() {
        let mut ghosts = Ghosts::new(0.001);
        for event in [kicked(80, 1, 1.0), kicked(100, 2, 1.0), kicked(110, 3, 1.0)] {
            assert!(!ghosts.lays(&event));
        }
        // The first is from before, the second comes as well, only the third does not.
        ghosts.rise(90, &[kicked(104, 2, 1.0)]);
        assert!(!ghosts.lays(&kicked(130, 1, 1.0)) && !ghosts.lays(&kicked(130, 2, 1.0)));
        // It is told of again with a second correction: still one ghost.
        ghosts.rise(100, &[kicked(104, 2, 1.0), kicked(130, 1, 1.0), kicked(130, 2, 1.0)]);
        assert!(ghosts.lays(&kicked(140, 3, 1.0)) && !ghosts.lays(&kicked(150, 3, 1.0)));
    }

    #[test]
    fn ghosts_fade() {
        let mut ghosts = Ghosts::new(0.001);
        assert!(!ghosts.lays(&kicked(100, 1, 1.0)));
        ghosts.rise(100, &[]);
        assert!(!ghosts.lays(&kicked(351, 1, 1.0)));
    }
}
