//! The crowd: who watches may work against who plays. Its energy grows while a ball is in play; with it the crowd buys what the
//! table's rules offer. That is announced first, so that the player can prepare for it, then it acts, and after some time it is
//! undone. All of it is counted in ticks and follows from the state and from the inputs of [`super::HOUSE`].

use std::sync::Arc;

use serde::{Deserialize, Serialize};
use thiserror::Error;

use super::rescue::Look;
use super::state::Phase;
use super::{Game, GameEvent, GameEventKind};
use crate::physics::StateError;
use crate::rules::{self, Effect};
use crate::table::{Command, CrowdRules, MOST_CROWD_ACTIONS, Table};

/// Something that the crowd is going to do.
#[derive(Debug, Clone, Copy, PartialEq, Eq, Serialize, Deserialize)]
pub struct Announced {
    /// Its place among the actions of the table's crowd.
    pub action: u8,
    /// In how many ticks.
    pub ticks: u32,
}

/// What changes about a crowd.
#[derive(Debug, Clone, Copy, Default, PartialEq, Eq, Serialize, Deserialize)]
pub(crate) struct CrowdState {
    /// In the ticks that it takes to grow: whole numbers on every machine.
    pub(super) energy: u32,
    pub(super) points: u64,
    pub(super) announced: Option<Announced>,
    /// For each action, ticks until it can be had again: of its effect, if it has one that lasts, and of its cool-down after that.
    pub(super) timers: [u32; MOST_CROWD_ACTIONS],
}

impl CrowdState {
    /// Ticks go by.
    fn pass(&mut self, ticks: u32) {
        if let Some(announced) = &mut self.announced {
            announced.ticks = announced.ticks.saturating_sub(ticks);
        }
        for timer in &mut self.timers {
            *timer = timer.saturating_sub(ticks);
        }
    }
}

/// The rules of a table's crowd, in ticks.
#[derive(Debug, Clone, Copy)]
struct Times<'a> {
    rules: &'a CrowdRules,
    tick_seconds: f64,
}

impl<'a> Times<'a> {
    fn of(table: &'a Table) -> Option<Self> {
        Some(Self { rules: table.rules.crowd.as_ref()?, tick_seconds: table.scene.tick_seconds })
    }

    /// Half a tick, because a quotient that should be whole may be a rounding below. A cast saturates.
    fn ticks(&self, seconds: f64) -> u32 {
        (seconds / self.tick_seconds + 0.5) as u32
    }

    fn most_energy(&self) -> u32 {
        self.ticks(self.rules.most_energy / self.rules.energy_per_second)
    }

    fn cost(&self, place: usize) -> u32 {
        self.ticks(self.rules.actions[place].cost / self.rules.energy_per_second)
    }

    /// At least one: nothing acts in the tick in which it is announced.
    fn announce(&self, place: usize) -> u32 {
        self.ticks(self.rules.actions[place].announce).max(1)
    }

    fn lasts(&self, place: usize) -> u32 {
        self.ticks(self.rules.actions[place].lasts)
    }

    fn cool_down(&self, place: usize) -> u32 {
        self.ticks(self.rules.actions[place].cool_down)
    }

    /// Ticks of an action's effect that are left.
    fn left(&self, state: &CrowdState, place: usize) -> u32 {
        // Most of the time there is none, and no need to know how long it cools down.
        match state.timers[place] {
            0 => 0,
            timer => timer.saturating_sub(self.cool_down(place)),
        }
    }
}

/// What is to be seen of a crowd.
#[derive(Debug, Clone, Copy)]
pub struct CrowdView<'a> {
    times: Times<'a>,
    state: CrowdState,
}

impl<'a> CrowdView<'a> {
    /// What it may do, and what that costs.
    pub fn rules(&self) -> &'a CrowdRules {
        self.times.rules
    }

    /// What it has to spend, in the unit of the rules' costs.
    pub fn energy(&self) -> f64 {
        f64::from(self.state.energy) * self.times.tick_seconds * self.times.rules.energy_per_second
    }

    /// Its points in this game, or in the last one.
    pub fn points(&self) -> u64 {
        self.state.points
    }

    /// What it is going to do.
    pub fn announced(&self) -> Option<Announced> {
        self.state.announced
    }

    /// For how many ticks more that action's effect lasts; 0: it has none just now.
    pub fn lasts_for(&self, place: u8) -> u32 {
        let place = usize::from(place);
        if place < self.times.rules.actions.len() { self.times.left(&self.state, place) } else { 0 }
    }

    /// Ticks until that action can be had again, as far as it is for its effect and its cool-down; 0: now.
    pub fn ready_in(&self, place: u8) -> u32 {
        self.state.timers.get(usize::from(place)).copied().unwrap_or(0)
    }
}

/// Why the crowd cannot do something just now.
#[derive(Debug, Clone, Copy, PartialEq, Eq, Error)]
pub enum Why {
    /// The table has no crowd.
    #[error("this table has no crowd")]
    NoCrowd,
    /// The crowd has no such action.
    #[error("there is no such action")]
    Unknown,
    /// Nobody plays, the ball was not served yet, or it waits at the plunger.
    #[error("no ball is in play")]
    NoBall,
    /// The game has tilted.
    #[error("the game has tilted")]
    Tilted,
    /// Something is announced already.
    #[error("something is announced already")]
    Announced,
    /// It acts already.
    #[error("it is at work already")]
    AtWork,
    /// It acted a short while ago.
    #[error("it was used a short while ago")]
    CoolsDown,
    /// There is not enough energy.
    #[error("there is not enough energy")]
    Energy,
}

impl Game {
    /// The crowd, at a table that has one.
    pub fn crowd(&self) -> Option<CrowdView<'_>> {
        Some(CrowdView { times: Times::of(&self.table)?, state: self.crowd_now()? })
    }

    /// Whether the crowd can have an action announced in the tick that comes, by the action's place.
    ///
    /// # Errors
    /// Why not, in a few words.
    pub fn can_crowd(&self, place: u8) -> Result<(), Why> {
        let (Some(times), Some(state)) = (Times::of(&self.table), self.crowd_now()) else { return Err(Why::NoCrowd) };
        let place = usize::from(place);
        if place >= times.rules.actions.len() {
            return Err(Why::Unknown);
        }
        if !self.has_ball_in_play() {
            return Err(Why::NoBall);
        }
        match () {
            () if self.play.tilt.tilted => Err(Why::Tilted),
            () if state.announced.is_some() => Err(Why::Announced),
            () if times.left(&state, place) > 0 => Err(Why::AtWork),
            () if state.timers[place] > 0 => Err(Why::CoolsDown),
            () if state.energy < times.cost(place) => Err(Why::Energy),
            () => Ok(()),
        }
    }

    /// Whether the crowd has dimmed the lights.
    pub fn is_dimmed(&self) -> bool {
        let (Some(times), Some(state)) = (Times::of(&self.table), self.crowd_now()) else { return false };
        let mut actions = (0..).zip(&times.rules.actions);
        actions.any(|(place, action)| action.dims && times.left(&state, place) > 0)
    }

    /// The crowd as it is now: calm ticks only count.
    pub(super) fn crowd_now(&self) -> Option<CrowdState> {
        let mut crowd = self.play.crowd?;
        // Calm ends before anything is due, and lasts for no more than a flight or a pause.
        let ticks = (self.tick() - self.calm.counted) as u32;
        if ticks > 0 && self.is_playing() {
            crowd.pass(ticks);
            if self.calm.look.in_play {
                self.grow(&mut crowd, ticks);
            }
        }
        Some(crowd)
    }

    fn grow(&self, crowd: &mut CrowdState, ticks: u32) {
        if let Some(times) = Times::of(&self.table) {
            crowd.energy = crowd.energy.saturating_add(ticks).min(times.most_energy());
        }
    }

    /// A tick in which a ball is in play makes the crowd stronger.
    pub(super) fn feed_crowd(&mut self, look: Look) {
        if look.in_play
            && let Some(mut crowd) = self.play.crowd
        {
            self.grow(&mut crowd, 1);
            self.play.crowd = Some(crowd);
        }
    }

    /// In how many ticks something of the crowd's is due.
    pub(super) fn crowd_due_in(&self) -> Option<u32> {
        let (times, state) = (Times::of(&self.table)?, self.play.crowd?);
        let ends = (0..times.rules.actions.len()).map(|place| times.left(&state, place)).filter(|&left| left > 0);
        ends.chain(state.announced.map(|announced| announced.ticks)).min()
    }

    /// What was announced acts, what has lasted for its time is undone.
    pub(super) fn run_crowd(&mut self) {
        let is_playing = self.is_playing();
        let Some(crowd) = self.play.crowd.as_mut().filter(|_| is_playing) else { return };
        let before = *crowd;
        crowd.pass(1);
        let now = *crowd;
        if now == before {
            return;
        }
        let table = Arc::clone(&self.table);
        let Some(times) = Times::of(&table) else { return };
        for (place, action) in (0..).zip(&times.rules.actions) {
            let index = usize::from(place);
            if times.left(&before, index) > 0 && times.left(&now, index) == 0 {
                self.order(&table, &action.undo);
                self.emit(GameEventKind::Undone { action: place });
            }
        }
        let Some(Announced { action: place, ticks: 0 }) = now.announced else { return };
        let index = usize::from(place);
        let Some(action) = times.rules.actions.get(index) else { return };
        if let Some(crowd) = &mut self.play.crowd {
            crowd.announced = None;
            crowd.timers[index] = times.lasts(index).saturating_add(times.cool_down(index));
            crowd.points = crowd.points.saturating_add(action.points);
        }
        self.emit(GameEventKind::Acted { action: place });
        self.order(&table, &action.run);
    }

    /// The crowd wants something.
    pub(super) fn announce(&mut self, place: u8) {
        if self.can_crowd(place).is_err() {
            return;
        }
        let (Some(times), Some(mut crowd)) = (Times::of(&self.table), self.play.crowd) else { return };
        crowd.energy -= times.cost(usize::from(place));
        crowd.announced = Some(Announced { action: place, ticks: times.announce(usize::from(place)) });
        self.play.crowd = Some(crowd);
        self.emit(GameEventKind::Announced { action: place });
    }

    /// A turn ends, or the game tilts: everything is undone, and what is announced lapses. What it cost is gone.
    pub(super) fn end_crowd(&mut self) {
        let Some(before) = self.play.crowd else { return };
        let table = Arc::clone(&self.table);
        let Some(times) = Times::of(&table) else { return };
        for (place, action) in (0..).zip(&times.rules.actions) {
            let index = usize::from(place);
            if times.left(&before, index) == 0 {
                continue;
            }
            if let Some(crowd) = &mut self.play.crowd {
                crowd.timers[index] = times.cool_down(index);
            }
            self.order(&table, &action.undo);
            self.emit(GameEventKind::Undone { action: place });
        }
        if let Some(crowd) = &mut self.play.crowd {
            crowd.announced = None;
        }
    }

    /// A player has lost a ball. One that is given up, or whose player leaves, is not the crowd's merit.
    pub(super) fn pay_crowd_for_ball(&mut self) {
        if let (Some(rules), Some(crowd)) = (&self.table.rules.crowd, &mut self.play.crowd) {
            crowd.points = crowd.points.saturating_add(rules.points_per_ball);
        }
    }

    /// A game begins.
    pub(super) fn restart_crowd(&mut self) {
        self.play.crowd = self.play.crowd.map(|_| CrowdState::default());
    }

    fn order(&mut self, table: &Table, commands: &[Command]) {
        let (tick, events) = (self.now, &mut self.events);
        rules::order(table, commands, &mut self.play.rules, &mut self.world, |effect| {
            if let Effect::Message(place) = effect {
                events.push(GameEvent { tick, kind: GameEventKind::Message { place } });
            }
        });
    }
}

/// Refuses a crowd that this table cannot have.
pub(super) fn check_crowd(crowd: Option<CrowdState>, phase: Phase, table: &Table) -> Result<(), StateError> {
    let (crowd, times) = match (crowd, Times::of(table)) {
        (None, None) => return Ok(()),
        (Some(crowd), Some(times)) => (crowd, times),
        (crowd, times) => {
            let count = |is_there: bool| usize::from(is_there);
            let (found, expected) = (count(crowd.is_some()), count(times.is_some()));
            return Err(StateError::Count { what: "crowds", found, expected });
        }
    };
    if crowd.energy > times.most_energy() {
        return Err(StateError::Number { what: "crowd's energy", index: 0 });
    }
    let count = times.rules.actions.len();
    for (index, &timer) in crowd.timers.iter().enumerate() {
        let most = if index < count { times.lasts(index).saturating_add(times.cool_down(index)) } else { 0 };
        // Nothing lasts beyond the turn in which it was done.
        let is_over = index >= count || times.left(&crowd, index) == 0 || matches!(phase, Phase::Play { .. });
        if timer > most || !is_over {
            return Err(StateError::Number { what: "crowd's action", index });
        }
    }
    match crowd.announced {
        None => Ok(()),
        Some(Announced { action, ticks }) => {
            let index = usize::from(action);
            let is_possible = index < count && (1..=times.announce(index)).contains(&ticks);
            if is_possible && crowd.timers[index] == 0 && matches!(phase, Phase::Play { .. }) {
                Ok(())
            } else {
                Err(StateError::Number { what: "crowd's announcement", index })
            }
        }
    }
}

/// Something in every field.
pub(super) fn sample_crowd() -> CrowdState {
    CrowdState {
        energy: 7000,
        points: 2000,
        announced: Some(Announced { action: 1, ticks: 1500 }),
        timers: [0, 0, 20_000, 0, 3, 0, 0, 0],
    }
}
