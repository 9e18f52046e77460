//! The seated player's own copy of the game, ahead of the server by as much as an input takes to get there: so a
//! flipper moves in the very frame in which its key goes down.
//!
//! The same `Game` runs here and there, so a prediction is exact, bit for bit, unless an input came late or somebody
//! else's came between. Then the copy goes back to the server's state and plays the rest again.

use std::collections::VecDeque;

use shared::game::{Action, Game, GameEvent, Input};

use crate::budget::Budget;
use crate::moment::Moment;

/// Predicted ticks whose digests are kept: four times the largest lead.
const MOST_DIGESTS: usize = 1024;

/// How a prediction compared to what the server says.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub(crate) enum Verdict {
    /// It was right, bit for bit.
    Right,
    /// It was wrong, and was made anew.
    Wrong,
    /// There was none for that tick: the server was ahead.
    Unknown,
}

/// A game that runs ahead of the server.
#[derive(Debug)]
pub(crate) struct Prediction {
    game: Game,
    seat: u8,
    /// The player's own, from the last confirmed tick on, in order.
    inputs: Vec<Input>,
    /// Of the states of consecutive ticks, the last of which is the game's.
    digests: VecDeque<u64>,
    /// The last tick that the server has confirmed.
    confirmed: u64,
}

impl Prediction {
    /// Goes on from the server's `game` with the inputs of `seat`.
    pub(crate) fn new(game: &Game, seat: u8) -> Self {
        let digests = VecDeque::from([game.digest()]);
        Self { game: game.clone(), seat, inputs: Vec::new(), digests, confirmed: game.tick() }
    }

    /// The tick that the next step plays: the first at which an input can still act.
    pub(crate) fn tick(&self) -> u64 {
        self.game.tick()
    }

    /// Whose inputs it plays.
    pub(crate) fn seat(&self) -> u8 {
        self.seat
    }

    /// What is to be seen now, a fraction of a tick after the last step.
    pub(crate) fn now(&self, fraction: f64) -> Moment<'_> {
        Moment::of(&self.game, fraction)
    }

    /// The player does something at `tick`, or as soon as possible; returns the tick at which it acts.
    pub(crate) fn act(&mut self, tick: u64, action: Action) -> u64 {
        let tick = tick.max(self.game.tick());
        let place = self.inputs.partition_point(|input| input.tick <= tick);
        self.inputs.insert(place, Input { tick, seat: self.seat, action });
        tick
    }

    /// Steps until `tick` is the next one, or the budget is spent; `show` gets what happens.
    pub(crate) fn advance(&mut self, tick: u64, budget: &mut Budget, mut show: impl FnMut(&GameEvent)) {
        while self.game.tick() < tick && budget.take() {
            self.game.step(&self.inputs).iter().for_each(&mut show);
            if self.digests.len() == MOST_DIGESTS {
                self.digests.pop_front();
            }
            self.digests.push_back(self.game.digest());
        }
    }

    /// Compares with the server's `game`, and goes back to it if they differ; `instead` gets what then happens on the way to
    /// where it was. `None` if it is no newer than the last.
    pub(crate) fn confirm(
        &mut self,
        game: &Game,
        budget: &mut Budget,
        instead: impl FnMut(&GameEvent),
    ) -> Option<Verdict> {
        let (tick, reached) = (game.tick(), self.game.tick());
        if tick <= self.confirmed {
            return None;
        }
        self.confirmed = tick;
        self.inputs.retain(|input| input.tick >= tick);
        let predicted = reached.checked_sub(tick).and_then(|back| {
            let place = (self.digests.len() as u64 - 1).checked_sub(back)?;
            self.digests.get(place as usize).copied()
        });
        if predicted == Some(game.digest()) {
            return Some(Verdict::Right);
        }
        self.game.clone_from(game);
        self.digests.clear();
        self.digests.push_back(self.game.digest());
        // What happens on the way has been shown already, or was shown wrongly: either way it is past.
        self.advance(reached, budget, instead);
        Some(if predicted.is_some() { Verdict::Wrong } else { Verdict::Unknown })
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use shared::table::Table;
    use std::sync::Arc;

    /// Ticks that a message takes, either way.
    const WAY: u64 = 40;

    /// A server that a client plays on from afar: inputs and snapshots take [`WAY`] ticks.
    struct Link {
        server: Game,
        prediction: Option<Prediction>,
        /// (Arrival, input).
        up: Vec<(u64, Input)>,
        /// (Arrival, game).
        down: VecDeque<(u64, Game)>,
        wrong: u32,
        right: u32,
        applied_late: u32,
    }

    impl Link {
        fn new() -> Self {
            let mut server = Game::new(Arc::new(Table::shipped("classic").unwrap().unwrap()));
            server.step(&[Action::Sit, Action::Start].map(|action| Input { tick: 0, seat: 0, action }));
            let (up, down) = (Vec::new(), VecDeque::new());
            Self { server, prediction: None, up, down, wrong: 0, right: 0, applied_late: 0 }
        }

        /// One millisecond: the server plays a tick, the client receives, acts and predicts.
        fn tick(&mut self, lead: u64, mut act: impl FnMut(u64) -> Option<Action>) {
            let now = self.server.tick();
            for (_, input) in self.up.iter_mut().filter(|(arrival, _)| *arrival == now) {
                self.applied_late += u32::from(input.tick < now);
                input.tick = input.tick.max(now);
            }
            let due: Vec<Input> = self.up.iter().filter(|(at, _)| *at <= now).map(|(_, input)| *input).collect();
            self.server.step(&due);
            if self.server.tick().is_multiple_of(17) {
                self.down.push_back((now + WAY, self.server.clone()));
            }
            while self.down.front().is_some_and(|(arrival, _)| *arrival <= now) {
                let (_, game) = self.down.pop_front().unwrap();
                let prediction = self.prediction.get_or_insert_with(|| Prediction::new(&game, 0));
                match prediction.confirm(&game, &mut Budget::endless(), |_| {}) {
                    Some(Verdict::Right) => self.right += 1,
                    Some(Verdict::Wrong) => self.wrong += 1,
                    Some(Verdict::Unknown) | None => {}
                }
            }
            let Some(prediction) = &mut self.prediction else { return };
            if let Some(action) = act(now) {
                let tick = prediction.act(now + lead, action);
                self.up.push((now + WAY, Input { tick, seat: 0, action }));
            }
            prediction.advance(now + lead, &mut Budget::endless(), |_| {});
        }
    }

    /// Pulls and lets go, then flips in an uneven rhythm.
    fn script(now: u64) -> Option<Action> {
        match now {
            500 => Some(Action::Pull(60_000)),
            1500 => Some(Action::Release),
            _ if now > 2000 && now.is_multiple_of(37) => {
                let beat = now / 37;
                Some(Action::Flipper { right: beat.is_multiple_of(3), pressed: beat.is_multiple_of(2) })
            }
            _ => None,
        }
    }

    #[test]
    fn inputs_in_time_are_predicted_bit_for_bit() {
        let mut link = Link::new();
        let mut predicted = VecDeque::new();
        for _ in 0..20_000 {
            link.tick(WAY + 5, script);
            while predicted.front().is_some_and(|(tick, _)| *tick < link.server.tick()) {
                predicted.pop_front();
            }
            if let Some((_, digest)) = predicted.front().filter(|(tick, _)| *tick == link.server.tick()) {
                assert_eq!(*digest, link.server.digest(), "tick {}", link.server.tick());
            }
            if let Some(prediction) = &link.prediction {
                predicted.push_back((prediction.tick(), prediction.game.digest()));
            }
        }
        assert_eq!((link.wrong, link.applied_late), (0, 0));
        assert!(link.right > 1000, "{} predictions were confirmed", link.right);
        assert!(link.server.seats()[0].score.points > 0, "the ball went somewhere");
    }

    #[test]
    fn a_late_input_is_recovered_from() {
        let mut link = Link::new();
        for _ in 0..20_000 {
            let lead = if (3000..4000).contains(&link.server.tick()) { WAY - 15 } else { WAY + 5 };
            link.tick(lead, script);
        }
        assert!(link.applied_late > 5, "{} inputs came late", link.applied_late);
        assert!(link.wrong > 0, "a late input shows as a wrong prediction");
        // Right again to the bit, once nothing is late.
        let wrong = link.wrong;
        for _ in 0..2000 {
            link.tick(WAY + 5, script);
        }
        assert_eq!(link.wrong, wrong);
    }

    #[test]
    fn each_tick_is_played_once_and_events_come_once() {
        let mut link = Link::new();
        for _ in 0..200 {
            link.tick(WAY + 5, |_| None);
        }
        let prediction = link.prediction.as_mut().unwrap();
        let from = prediction.tick();
        prediction.act(0, Action::Flipper { right: true, pressed: true });
        let mut flips = Vec::new();
        prediction.advance(from + 50, &mut Budget::endless(), |event| flips.push(event.tick));
        prediction.advance(from + 50, &mut Budget::endless(), |event| flips.push(event.tick));
        assert_eq!(flips, [from]);
        assert_eq!(prediction.tick(), from + 50);
    }
}
