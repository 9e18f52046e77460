//! The game: a table, its world and rules, and whose turn it is. [`Game::step`] is the one entry; players, servers,
//! spectators, replays and tests all run it.

mod bot;
mod calm;
mod crowd;
#[cfg(test)]
mod crowd_tests;
mod events;
#[cfg(test)]
mod extra_tests;
mod input;
mod multiball;
#[cfg(test)]
mod multiball_tests;
pub mod replay;
mod rescue;
#[cfg(test)]
mod size_tests;
mod state;
#[cfg(test)]
mod tests;
mod tilt;
#[cfg(test)]
mod tilt_tests;
mod turns;

use std::sync::Arc;

pub use bot::Bot;
pub use crowd::{Announced, CrowdView, Why};
pub use events::{GameEvent, GameEventKind, Rescue};
pub use input::{Action, HOUSE, Input, Nudge, SEATS};
pub(crate) use state::sample_play;
pub use state::{GameState, Phase, Play, Seat};
pub use tilt::Tilt;

use calm::Calm;
use glam::DVec2;

use crate::physics::{EventKind, StateError, World};
use crate::rules::{self, Effect, Occasion};
use crate::table::Table;

/// A game in progress, or a table that waits for one.
#[derive(Debug, Clone)]
pub struct Game {
    table: Arc<Table>,
    world: World,
    play: Play,
    events: Vec<GameEvent>,
    /// The tick that is being played: events are stamped with it.
    now: u64,
    calm: Calm,
}

impl Game {
    /// A table with nobody at it.
    pub fn new(table: Arc<Table>) -> Self {
        let world = World::new(Arc::clone(&table.scene));
        // Of each physical event the rules may make points and a message.
        let events = Vec::with_capacity(3 * world.room_for_events());
        let play = Play::new(&table);
        Self { table, world, play, events, now: 0, calm: Calm::default() }
    }

    /// Advances by one tick. Inputs for other ticks are not this call's: they are ignored.
    #[inline]
    pub fn step(&mut self, inputs: &[Input]) -> &[GameEvent] {
        // As in the world's step: a quiet tick writes no length.
        if !self.events.is_empty() {
            self.events.clear();
        }
        // A bare scene has no rules: its world moves, and that is all.
        if !self.table.has_rules {
            if !self.world.step().is_empty() {
                self.show_physics();
            }
            return &self.events;
        }
        if inputs.is_empty() && self.tick() < self.calm.until {
            self.world.step();
            return &[];
        }
        self.step_by_rules(inputs);
        &self.events
    }

    #[inline(never)]
    fn step_by_rules(&mut self, inputs: &[Input]) {
        let tick = self.world.state().tick;
        self.count_calm();
        self.now = tick;
        let balls_before = self.balls_of_turn();
        // 0. What the crowd has announced, and what of it is over.
        self.run_crowd();
        // 1. What players do, and what the crowd wants.
        for input in inputs.iter().filter(|input| input.tick == tick) {
            self.act(input.seat, input.action);
        }
        // 2. A ball that is due.
        self.serve_due();
        self.serve_extra();
        // 3. The world moves.
        self.world.step();
        if self.table.scene.needs.nudge {
            self.heed_the_bob();
        }
        // 4. The rules make points of what happened.
        self.apply_rules();
        self.heed_end_of_multiball(balls_before);
        // 5. The last lost ball ends the turn; a stuck one is served again.
        if self.table.scene.needs.saucers {
            self.free_held_balls();
        }
        self.end_turn_when_lost();
        let look = self.free_stuck_ball();
        self.feed_crowd(look);
        self.pass_time_of_play(look);
        self.find_calm(look);
    }

    /// Tells what happened in a world without rules. Kept out of the loop of quiet ticks.
    #[inline(never)]
    fn show_physics(&mut self) {
        self.now = self.world.state().tick - 1;
        for event in self.world.events() {
            if let Some(kind) = GameEventKind::of_physics(event) {
                self.events.push(GameEvent { tick: self.now, kind });
            }
        }
    }

    /// The tick that the next step plays.
    pub fn tick(&self) -> u64 {
        self.world.state().tick
    }

    /// The table that it is played on.
    pub fn table(&self) -> &Arc<Table> {
        &self.table
    }

    /// Balls, flippers, targets.
    pub fn world(&self) -> &World {
        &self.world
    }

    /// Whether it is that seat's turn, and its ball has been served.
    pub(super) fn is_ball_of(&self, seat: u8) -> bool {
        matches!(self.play.phase, Phase::Play { seat: turn, serve_in: 0, .. } if turn == seat)
    }

    /// Who is seated, and their points.
    pub fn seats(&self) -> &[Seat; SEATS] {
        &self.play.seats
    }

    /// Warnings and the tilt of the ball that is played.
    pub fn tilt(&self) -> Tilt {
        self.play.tilt
    }

    /// Lit lights, one bit each.
    pub fn lights(&self) -> u64 {
        self.play.rules.lights.lit()
    }

    /// Whether the next ball that is lost is put into play again.
    pub fn saves_balls(&self) -> bool {
        self.play.rules.save.is_on()
    }

    /// What happened in the last step.
    pub fn events(&self) -> &[GameEvent] {
        &self.events
    }

    /// Whether somebody can still join the game that stands at its start: first ball, first turn, nothing hit yet.
    pub fn is_at_start(&self) -> bool {
        match self.play.phase {
            Phase::Idle | Phase::Over => true,
            // Whoever sat down before a seat whose turn it is would miss a ball.
            Phase::Play { seat, ball, untouched, .. } => {
                seat == 0 && ball == 1 && untouched && self.play.seats[0].extra_balls == 0
            }
        }
    }

    /// Goes on from a saved state.
    ///
    /// # Errors
    /// If the state does not fit the table; the game is then unchanged.
    pub fn restore(&mut self, state: GameState) -> Result<(), StateError> {
        state.play.check(&self.table)?;
        self.world.restore(state.world)?;
        self.play = state.play;
        self.play.rules.lights.reserve();
        self.calm = Calm { counted: self.tick(), ..Calm::default() };
        self.events.clear();
        Ok(())
    }

    /// Ticks in so many seconds, at least one.
    fn ticks(&self, seconds: f64) -> u32 {
        ((seconds / self.table.scene.tick_seconds) as u32).max(1)
    }

    /// 1. An action of a seat. What is not theirs to do now has no effect.
    fn act(&mut self, seat: u8, action: Action) {
        if let (HOUSE, Action::Crowd(place)) = (seat, action) {
            self.announce(place);
        }
        let Some(place) = self.play.seats.get(usize::from(seat)).copied() else { return };
        // A tilted game hears no buttons, not even as a sign of life; its plunger is a rod of steel.
        if self.play.tilt.tilted && matches!(action, Action::Flipper { .. } | Action::Nudge(_)) {
            return;
        }
        if let Phase::Play { seat: turn, quiet, .. } = &mut self.play.phase
            && *turn == seat
            && action.is_control()
        {
            *quiet = 0;
        }
        match action {
            Action::Sit => {
                if !place.taken {
                    let playing = self.is_at_start() && matches!(self.play.phase, Phase::Play { .. });
                    self.play.seats[usize::from(seat)] = Seat { taken: true, playing, ..Seat::default() };
                    self.emit(GameEventKind::SatDown { seat });
                }
            }
            Action::Stand => {
                if place.taken {
                    self.stand(seat);
                }
            }
            Action::Start => {
                if place.taken && !matches!(self.play.phase, Phase::Play { .. }) {
                    self.start();
                }
            }
            // Not a seat's to do.
            Action::Crowd(_) => {}
            Action::Forfeit => {
                if self.play.phase.has_turn(seat) {
                    self.forfeit(seat);
                }
            }
            Action::Flipper { right, pressed } => {
                if self.play.phase.has_turn(seat) {
                    if pressed {
                        self.emit(GameEventKind::Flipped { right });
                    }
                    self.world.press(right, pressed);
                }
            }
            Action::Pull(share) => {
                if self.play.phase.has_turn(seat) {
                    self.world.pull(Some(f64::from(share) / f64::from(u16::MAX)));
                }
            }
            Action::Nudge(nudge) => {
                if self.play.phase.has_turn(seat) {
                    self.nudge(nudge);
                }
            }
            Action::Release => {
                if self.play.phase.has_turn(seat) {
                    self.world.pull(None);
                }
            }
        }
    }

    /// 4. Runs the rules on what happened in the world.
    fn apply_rules(&mut self) {
        for place in 0..self.world.events().len() {
            let event = self.world.events()[place];
            if let Some(kind) = GameEventKind::of_physics(&event) {
                self.emit(kind);
            }
            let is_play = matches!(
                event.kind,
                EventKind::Kicked { .. }
                    | EventKind::Felled { .. }
                    | EventKind::Struck { .. }
                    | EventKind::Passed { .. }
                    | EventKind::Spun { .. }
                    | EventKind::Held { .. }
                    | EventKind::Ejected { .. }
                    | EventKind::Drained
            );
            if let (Phase::Play { untouched, quiet, .. }, true) = (&mut self.play.phase, is_play) {
                (*untouched, *quiet) = (false, 0);
            }
            if matches!(event.kind, EventKind::Escaped) {
                // Others that are in play go on.
                if self.world.state().balls.is_empty() {
                    self.serve_again(None);
                } else {
                    self.play.phase.add_ball();
                }
            }
            if matches!(event.kind, EventKind::Drained) {
                self.save_ball();
            }
            self.occasion(Occasion::Physics(event.kind), Some(event.position));
        }
    }

    /// Time goes by for what the rules have begun, while a ball is in play.
    fn pass_time_of_play(&mut self, look: rescue::Look) {
        let out = if look.in_play { self.play.rules.pass(&self.table, 1) } else { 0 };
        if out != 0 {
            self.occasion(Occasion::Out(out), None);
        }
    }

    /// Runs the rules for the player whose turn it is.
    fn occasion(&mut self, occasion: Occasion, position: Option<DVec2>) {
        let Phase::Play { seat, .. } = self.play.phase else { return };
        if self.play.tilt.tilted {
            return;
        }
        let tick = self.now;
        let (events, phase) = (&mut self.events, &mut self.play.phase);
        let Seat { score, extra_balls, extra_waiting, .. } = &mut self.play.seats[usize::from(seat)];
        rules::run(&self.table, occasion, score, &mut self.play.rules, &mut self.world, |effect| {
            let kind = match effect {
                Effect::Points(points) => {
                    let place = position.map(|place| (place.x as f32, place.y as f32));
                    GameEventKind::Points { seat, points, place }
                }
                Effect::Message(place) => GameEventKind::Message { place },
                Effect::Serve => return phase.add_ball(),
                Effect::ExtraBall if *extra_balls < self.table.rules.max_extra_balls => {
                    (*extra_balls, *extra_waiting) = (*extra_balls + 1, *extra_waiting + 1);
                    GameEventKind::ExtraBall { seat }
                }
                Effect::ExtraBall => return,
            };
            events.push(GameEvent { tick, kind });
        });
    }

    fn emit(&mut self, kind: GameEventKind) {
        self.events.push(GameEvent { tick: self.now, kind });
    }
}
