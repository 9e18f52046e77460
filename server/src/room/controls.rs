//! What is done to the games: controls as they come in, and what the lobby and the crowd decide, each for its tick.

use shared::game::{Action, Game, Input, Phase, SEATS};
use shared::protocol::{BoardInput, Mode, NUDGE_SECONDS, TAP_TICKS};

use crate::config::Config;

/// Seconds by which a player may stamp an input ahead.
const MOST_LEAD: f64 = 0.25;
/// Controls of one place that may wait for their tick; more are dropped.
const MOST_PENDING: usize = 128;
/// Things of a place that a control works: two flippers, the plunger and the table itself.
const PARTS: usize = 4;

/// When a control was stamped, and when it acts.
#[derive(Debug, Clone, Copy, Default)]
struct Stamp {
    asked: u64,
    acts: u64,
}

/// How long the player whose turn it is has done nothing.
#[derive(Debug, Clone, Copy, Default, PartialEq, Eq)]
struct Idle {
    /// Whose turn, and which ball.
    turn: (u8, u32),
    ticks: u64,
}

/// Inputs for ticks to come.
#[derive(Debug)]
pub(super) struct Controls {
    tick_seconds: f64,
    /// Each place has a board of its own.
    is_head_to_head: bool,
    pending: Vec<BoardInput>,
    /// For each place and part, its last control.
    stamps: [[Stamp; PARTS]; SEATS],
    /// For each board.
    idle: [Idle; SEATS],
}

impl Controls {
    pub(super) fn new(config: &Config) -> Self {
        Self {
            tick_seconds: config.table.scene.tick_seconds,
            is_head_to_head: config.mode == Mode::HeadToHead,
            pending: Vec::new(),
            stamps: Default::default(),
            idle: Default::default(),
        }
    }

    /// Board and seat of a place.
    pub(super) fn board_and_seat(&self, place: u8) -> (u8, u8) {
        if self.is_head_to_head { (place, 0) } else { (0, place) }
    }

    /// A player's control: at the tick it is stamped with if that is near enough ahead, else as soon as possible. Two
    /// controls of one part that come late together keep their distance, up to a tap's: else a late tap would be none.
    /// Between two nudges is always a slap's time, and those that would wait for too long are dropped: else a flood of
    /// them, all in one tick, would hurl the table. `false` if it is dropped.
    pub(super) fn act(&mut self, now: u64, place: u8, asked: u64, action: Action) -> bool {
        let (board, seat) = self.board_and_seat(place);
        let latest = now + (MOST_LEAD / self.tick_seconds) as u64;
        let of_seat = |waiting: &&BoardInput| waiting.board == board && waiting.input.seat == seat;
        if self.pending.iter().filter(of_seat).count() >= MOST_PENDING {
            return false;
        }
        let part = match action {
            Action::Flipper { right, .. } => usize::from(right),
            Action::Nudge(_) => PARTS - 1,
            _ => PARTS - 2,
        };
        let last = &mut self.stamps[usize::from(place)][part];
        let is_nudge = matches!(action, Action::Nudge(_));
        let distance = match asked.saturating_sub(last.asked) {
            _ if is_nudge => (NUDGE_SECONDS / self.tick_seconds) as u64,
            apart => apart.min(TAP_TICKS),
        };
        let tick = asked.clamp(now, latest).max(last.acts + distance);
        if is_nudge && tick > latest {
            return false;
        }
        let tick = tick.min(latest);
        *last = Stamp { asked, acts: tick };
        let idle = &mut self.idle[usize::from(board)];
        // Whoever waits for a turn cannot keep somebody else's alive.
        if idle.turn.0 == place {
            idle.ticks = 0;
        }
        self.push(BoardInput { board, input: Input { tick, seat, action } });
        true
    }

    /// Something that is decided, for the coming tick. Whoever leaves takes waiting controls along.
    pub(super) fn perform(&mut self, now: u64, place: u8, action: Action) {
        let (board, seat) = self.board_and_seat(place);
        if action == Action::Stand {
            self.pending.retain(|waiting| {
                (waiting.board, waiting.input.seat) != (board, seat) || !waiting.input.action.is_control()
            });
        }
        // Whoever comes next, and every game, begins with all their time.
        let idle = &mut self.idle[usize::from(board)];
        if action == Action::Start || idle.turn.0 == place {
            *idle = Idle::default();
        }
        self.push(BoardInput { board, input: Input { tick: now, seat, action } });
    }

    /// An input as it is.
    pub(super) fn push(&mut self, input: BoardInput) {
        self.pending.push(input);
    }

    /// What acts in that tick, in order. Nothing of an earlier tick waits.
    pub(super) fn take_due(&mut self, tick: u64) -> Vec<BoardInput> {
        if self.pending.is_empty() {
            return Vec::new();
        }
        let (due, later) = self.pending.drain(..).partition(|waiting| waiting.input.tick <= tick);
        self.pending = later;
        due
    }

    /// A ball was served: whoever plays it has all the time, also where it is the same turn's again.
    pub(super) fn begin_ball(&mut self, board: usize) {
        self.idle[board].ticks = 0;
    }

    /// Counts another tick without a control of whoever plays that board; `true` once it is `most` of them. Then it counts
    /// anew.
    pub(super) fn is_idle(&mut self, board: usize, game: &Game, place: u8, most: u64) -> bool {
        let Phase::Play { ball, .. } = game.phase() else { return false };
        let idle = &mut self.idle[board];
        if idle.turn != (place, ball) {
            *idle = Idle { turn: (place, ball), ticks: 0 };
        }
        idle.ticks += 1;
        if idle.ticks < most {
            return false;
        }
        idle.ticks = 0;
        true
    }
}

#[cfg(test)]
mod tests {
    use std::sync::Arc;

    use super::*;
    use shared::game::Nudge;
    use shared::table::Table;

    fn controls(mode: Mode) -> Controls {
        let table = Arc::new(Table::shipped("classic").expect("it is shipped").expect("it is valid"));
        Controls::new(&Config::new(table).mode(mode))
    }

    fn ticks(controls: &mut Controls, until: u64) -> Vec<u64> {
        controls.take_due(until).iter().map(|due| due.input.tick).collect()
    }

    const FLIP: Action = Action::Flipper { right: true, pressed: true };
    const DROP: Action = Action::Flipper { right: true, pressed: false };

    #[test]
    fn a_control_acts_when_it_is_stamped_or_now_or_at_the_latest() {
        let mut controls = controls(Mode::Challenge);
        for (asked, acts) in [(1050, 1050), (900, 1060), (9000, 1250)] {
            assert!(controls.act(1000, 0, asked, FLIP));
            assert_eq!(controls.take_due(u64::MAX)[0].input.tick, acts.max(1000), "{asked}");
            controls.stamps = Default::default();
            if asked == 1050 {
                controls.stamps[0][1] = Stamp { asked: 0, acts: 1050 };
            }
        }
    }

    #[test]
    fn a_tap_that_comes_late_is_still_one() {
        let mut controls = controls(Mode::Challenge);
        controls.act(1000, 0, 500, FLIP);
        controls.act(1000, 0, 530, DROP);
        assert_eq!(ticks(&mut controls, 2000), [1000, 1000 + TAP_TICKS]);
    }

    #[test]
    fn a_flood_of_nudges_is_thinned() {
        let mut controls = controls(Mode::Challenge);
        let heard = (0..100).filter(|_| controls.act(1000, 0, 1000, Action::Nudge(Nudge::Forward))).count();
        assert_eq!(heard, 6, "a quarter of a second has room for so many");
        let heard = (0..1000).filter(|&n| controls.act(1000, 1, 1000 + n, FLIP)).count();
        assert_eq!(heard, MOST_PENDING);
    }

    #[test]
    fn head_to_head_each_place_is_a_board() {
        let mut controls = controls(Mode::HeadToHead);
        controls.act(5, 1, 5, FLIP);
        controls.perform(5, 1, Action::Start);
        let due = controls.take_due(5);
        assert!(due.iter().all(|due| (due.board, due.input.seat) == (1, 0)), "{due:?}");
        controls.act(6, 1, 6, FLIP);
        controls.perform(6, 1, Action::Stand);
        assert_eq!(controls.take_due(6).len(), 1, "the control went with its player");
    }
}
