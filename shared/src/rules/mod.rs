//! Rules: physics events -> points, lights, messages and commands to the world. What they say is in the table.

mod ball_save;
mod lights;
#[cfg(test)]
mod tests;

use serde::{Deserialize, Serialize};

pub use ball_save::BallSave;
pub use lights::{Lights, MOST_TIMED_LIGHTS};

use crate::physics::{EventKind, TargetState, World};
use crate::table::{Command, Condition, MOST_SECONDS, Rule, Table, Trigger};

/// How often in one event what is lit may complete a set that lights more. Beyond that it waits for the next event: two rules
/// could light each other's sets for ever.
const MOST_ROUNDS: usize = 4;

/// A player's points.
#[derive(Debug, Clone, Copy, PartialEq, Eq, Serialize, Deserialize)]
pub struct Score {
    /// Points.
    pub points: u64,
    /// Points that wait for the end of the ball.
    pub bonus: u64,
    /// Times which they are paid.
    pub multiplier: u32,
}

impl Default for Score {
    fn default() -> Self {
        Self { points: 0, bonus: 0, multiplier: 1 }
    }
}

/// What the rules of a table have changed about it, apart from its world.
#[derive(Debug, Clone, Default, PartialEq, Eq, Serialize, Deserialize)]
pub struct RuleState {
    /// Which lights are lit.
    pub lights: Lights,
    /// Whether a lost ball is saved.
    pub save: BallSave,
}

impl RuleState {
    /// The turn begins: what every ball of the table gets.
    pub(crate) fn begin_ball(&mut self, table: &Table) {
        if let Some(rules) = &table.rules.ball_save {
            self.save.begin(rules, &mut self.lights, table.scene.tick_seconds);
        }
    }

    /// No ball is saved any more.
    pub(crate) fn end_save(&mut self, table: &Table) {
        if let (Some(rules), true) = (&table.rules.ball_save, self.save.is_on()) {
            self.save.end(rules, &mut self.lights);
        }
    }

    /// A ball is lost: whether it is saved.
    pub(crate) fn save(&mut self, table: &Table) -> bool {
        table.rules.ball_save.as_ref().is_some_and(|rules| self.save.save(rules, &mut self.lights))
    }

    /// Ticks go by in which a ball is in play. The lights that go out.
    pub(crate) fn pass(&mut self, table: &Table, ticks: u32) -> u64 {
        if let Some(rules) = &table.rules.ball_save {
            self.save.pass(ticks, rules, &mut self.lights, table.scene.tick_seconds);
        }
        self.lights.pass(ticks)
    }

    /// Ticks of play until something changes.
    pub(crate) fn due_in(&self, table: &Table) -> Option<u32> {
        let save = table.rules.ball_save.as_ref().and_then(|rules| self.save.due_in(rules, table.scene.tick_seconds));
        save.into_iter().chain(self.lights.due_in()).min()
    }

    /// Whether it is one that this table can have.
    pub(crate) fn fits(&self, table: &Table) -> bool {
        // A save lasts for its time and its grace.
        let most = ball_save::ticks(2.0 * MOST_SECONDS, table.scene.tick_seconds);
        self.lights.fit(table.lights.len(), most) && self.save.fits(table.rules.ball_save.as_ref(), most)
    }

    /// Something in every field.
    pub(crate) fn sample() -> Self {
        Self { lights: lights::sample(), save: ball_save::sample() }
    }
}

/// Something that rules react to.
#[derive(Debug, Clone, Copy, PartialEq)]
pub enum Occasion {
    /// An event of the physics.
    Physics(EventKind),
    /// A ball was served.
    BallStart,
    /// The last ball in play was lost.
    BallEnd,
    /// Of several balls in play only one is left.
    MultiballEnd,
    /// These lights went out by themselves, one bit each.
    Out(u64),
}

/// What the rules did, for whoever shows it.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub enum Effect {
    /// Points were made.
    Points(u64),
    /// A line for the display, by its place in the table's messages.
    Message(u16),
    /// Another ball is to be put into play.
    Serve,
    /// The player is to have another ball when this one is lost.
    ExtraBall,
}

/// How things are when an event happens. Every rule of the event goes by it, whatever another one has done meanwhile.
#[derive(Debug, Clone, Copy)]
struct Before {
    lit: u64,
    targets_down: u64,
    targets_up: u64,
    held: u64,
    balls: usize,
}

impl Before {
    fn of(lights: &Lights, world: &World) -> Self {
        let bits = |wanted| {
            let targets = (0_u32..).zip(&world.state().targets);
            targets.fold(0, |bits, (place, target)| bits | u64::from(*target == wanted) << place)
        };
        Self {
            lit: lights.lit(),
            targets_down: bits(TargetState::Down),
            targets_up: bits(TargetState::Up),
            held: world.held(),
            balls: world.loose_balls(),
        }
    }

    fn meets(&self, condition: &Condition) -> bool {
        match *condition {
            Condition::Lit(set) => self.lit & set == set,
            Condition::AnyLit(set) => self.lit & set != 0,
            Condition::Unlit(set) => self.lit & set == 0,
            Condition::Down(set) => self.targets_down & set == set,
            Condition::Up(set) => self.targets_up & set == set,
            Condition::OneBall => self.balls < 2,
            Condition::Multiball => self.balls >= 2,
        }
    }

    fn allows(&self, rule: &Rule) -> bool {
        rule.when.iter().all(|condition| self.meets(condition))
    }
}

/// Runs every rule that waits for `occasion`, on the score of the player whose turn it is and on the table's lights
/// and targets. `show` learns what they did.
pub fn run(
    table: &Table,
    occasion: Occasion,
    score: &mut Score,
    state: &mut RuleState,
    world: &mut World,
    mut show: impl FnMut(Effect),
) {
    let before = Before::of(&state.lights, world);
    for rule in &table.rules.rules {
        if matches(&rule.trigger, occasion, table, world, &before) && before.allows(rule) {
            perform(table, &rule.commands, score, state, world, &mut show);
        }
    }
    // What was lit may complete a set, and what that lights another one.
    let mut lit_before = before.lit;
    for _ in 0..MOST_ROUNDS {
        let lit = state.lights.lit();
        let completed = lit & !lit_before;
        if completed == 0 {
            break;
        }
        for rule in &table.rules.rules {
            if let Trigger::AllLit(set) = rule.trigger
                && lit & set == set
                && completed & set != 0
                && before.allows(rule)
            {
                perform(table, &rule.commands, score, state, world, &mut show);
            }
        }
        lit_before = lit;
    }
}

/// Runs commands that nobody scores by: the crowd's.
pub fn order(
    table: &Table,
    commands: &[Command],
    state: &mut RuleState,
    world: &mut World,
    mut show: impl FnMut(Effect),
) {
    perform(table, commands, &mut Score::default(), state, world, &mut show);
}

fn matches(trigger: &Trigger, occasion: Occasion, table: &Table, world: &World, before: &Before) -> bool {
    match (trigger, occasion) {
        (Trigger::Hit(elements), Occasion::Physics(kind)) => {
            let element = match kind {
                EventKind::Kicked { element, .. }
                | EventKind::Felled { element, .. }
                | EventKind::Struck { element, .. } => element,
                EventKind::Touched { element, .. } if !table.acts[usize::from(element)] => element,
                _ => return false,
            };
            elements.contains(&element)
        }
        (Trigger::Pass(elements), Occasion::Physics(EventKind::Passed { element })) => elements.contains(&element),
        (Trigger::Spin(elements), Occasion::Physics(EventKind::Spun { element }))
        | (Trigger::Hold(elements), Occasion::Physics(EventKind::Held { element })) => elements.contains(&element),
        (Trigger::AllHeld(set), Occasion::Physics(EventKind::Held { element })) => {
            let saucers = &world.scene().saucers;
            let is_of_set = saucers.iter().position(|s| s.element == element).is_some_and(|p| set >> p & 1 == 1);
            is_of_set && before.held & set == *set
        }
        (Trigger::AllDown(set), Occasion::Physics(EventKind::Felled { element, .. })) => {
            let is_of_set = table.targets.iter().position(|&e| e == element).is_some_and(|place| set >> place & 1 == 1);
            is_of_set && before.targets_down & set == *set
        }
        (Trigger::Out(set), Occasion::Out(out)) => set & out != 0,
        (Trigger::BallStart, Occasion::BallStart)
        | (Trigger::BallEnd, Occasion::BallEnd)
        | (Trigger::MultiballEnd, Occasion::MultiballEnd) => true,
        _ => false,
    }
}

fn perform(
    table: &Table,
    commands: &[Command],
    score: &mut Score,
    state: &mut RuleState,
    world: &mut World,
    show: &mut impl FnMut(Effect),
) {
    for command in commands {
        match command {
            Command::Score(points) => {
                score.points = score.points.saturating_add(*points);
                show(Effect::Points(*points));
            }
            Command::Bonus(points) => score.bonus = score.bonus.saturating_add(*points),
            Command::RaiseMultiplier => {
                if score.multiplier < table.rules.max_multiplier {
                    score.multiplier += 1;
                }
            }
            Command::CollectBonus => {
                let points = score.bonus.saturating_mul(u64::from(score.multiplier));
                score.points = score.points.saturating_add(points);
                (score.bonus, score.multiplier) = (0, 1);
                if points > 0 {
                    show(Effect::Points(points));
                }
            }
            Command::Light(set) => state.lights.light(*set),
            Command::LightFor(set, seconds) => {
                state.lights.light_for(*set, ball_save::ticks(*seconds, table.scene.tick_seconds));
            }
            Command::Unlight(set) => state.lights.unlight(*set),
            Command::Raise(set) => {
                for place in (0..table.targets.len()).filter(|place| set >> place & 1 == 1) {
                    world.raise(place as u16);
                }
            }
            Command::Lower(set) => {
                for place in (0..table.targets.len()).filter(|place| set >> place & 1 == 1) {
                    world.lower(place as u16);
                }
            }
            Command::Kick(set) => {
                for place in (0..world.scene().saucers.len()).filter(|place| set >> place & 1 == 1) {
                    world.kick(place as u16);
                }
            }
            Command::Attract(set) | Command::Release(set) => {
                for place in (0..world.scene().magnets.len()).filter(|place| set >> place & 1 == 1) {
                    world.switch(place as u16, matches!(command, Command::Attract(_)));
                }
            }
            Command::Serve => show(Effect::Serve),
            Command::SaveBalls(seconds) => {
                if let Some(rules) = &table.rules.ball_save {
                    state.save.extend(rules, &mut state.lights, *seconds, table.scene.tick_seconds);
                }
            }
            Command::ExtraBall => show(Effect::ExtraBall),
            Command::Message(place) => show(Effect::Message(*place)),
        }
    }
}
