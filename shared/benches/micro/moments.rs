//! Single steps of worlds and games from many moments.
//!
//! A world that is restored solves its balls' flights anew in its first step, which a running one has done before. So a
//! moment is a state one tick earlier, and that tick is stepped before the clock runs.

use std::cell::RefCell;

use divan::Bencher;
use shared::game::{Game, GameState};
use shared::physics::{World, WorldState};

/// Calls in a sample, each in a world of its own: the clock is too coarse for one call.
pub(crate) const SLOTS: u32 = 64;
/// Samples, of which the median counts.
pub(crate) const SAMPLES: u32 = 500;

/// A world or a game.
pub(crate) trait Stepped: Clone {
    /// What it goes on from.
    type State: Clone;

    /// Goes on from it.
    fn set(&mut self, state: Self::State);

    /// Advances by a tick without input; how many events there were in the world.
    fn advance(&mut self) -> usize;
}

impl Stepped for World {
    type State = WorldState;

    fn set(&mut self, state: WorldState) {
        self.restore(state).unwrap_or_else(|error| panic!("{error}"));
    }

    #[inline]
    fn advance(&mut self) -> usize {
        self.step().len()
    }
}

impl Stepped for Game {
    type State = GameState;

    fn set(&mut self, state: GameState) {
        self.restore(state).unwrap_or_else(|error| panic!("{error}"));
    }

    #[inline]
    fn advance(&mut self) -> usize {
        self.step(&[]);
        self.world().events().len()
    }
}

/// Times the second step from each of these states in turn. The first must have no event, the second that many.
pub(crate) fn time_second_step<T: Stepped>(bencher: Bencher<'_, '_>, subject: &T, states: &[T::State], events: usize) {
    assert!(states.len() >= SLOTS as usize, "only {} moments", states.len());
    let mut checked = subject.clone();
    for state in states {
        checked.set(state.clone());
        assert_eq!(checked.advance(), 0, "something happens before");
        assert_eq!(checked.advance(), events, "not the tick that it should be");
    }
    // With each whether it stands at its moment.
    let slots: Vec<_> = (0..SLOTS).map(|_| RefCell::new((subject.clone(), false))).collect();
    let mut next = 0;
    let ready = || {
        let slot = next % slots.len();
        let (subject, is_ready) = &mut *slots[slot].borrow_mut();
        assert!(!*is_ready, "a sample has at most {SLOTS} calls");
        subject.set(states[next % states.len()].clone());
        subject.advance();
        *is_ready = true;
        next += 1;
        slot
    };
    bencher.with_inputs(ready).bench_local_values(|slot| {
        let (subject, is_ready) = &mut *slots[slot].borrow_mut();
        *is_ready = false;
        subject.advance()
    });
}
