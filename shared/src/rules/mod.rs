//! Rules: physics events -> points, lights, messages and commands to the world. What they say is in the table.

use serde::{Deserialize, Serialize};

use crate::physics::{EventKind, TargetState, World};
use crate::table::{Command, Table, Trigger};

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

/// Something that rules react to.
#[derive(Debug, Clone, Copy, PartialEq)]
pub enum Occasion {
    /// An event of the physics.
    Physics(EventKind),
    /// A ball was served.
    BallStart,
    /// The last ball in play was lost.
    BallEnd,
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
}

/// Runs every rule that waits for `occasion`, on the score of the player whose turn it is and on the table's lights
/// and targets. `show` learns what they did.
pub fn run(
    table: &Table,
    occasion: Occasion,
    score: &mut Score,
    lights: &mut u64,
    world: &mut World,
    mut show: impl FnMut(Effect),
) {
    let lit_before = *lights;
    for rule in &table.rules.rules {
        if matches(&rule.trigger, occasion, table, world) {
            perform(table, &rule.commands, score, lights, world, &mut show);
        }
    }
    // What the first round lit may complete a set; a set completes once, so this ends after one more round.
    for rule in &table.rules.rules {
        if let Trigger::AllLit(set) = rule.trigger
            && *lights & set == set
            && lit_before & set != set
        {
            perform(table, &rule.commands, score, lights, world, &mut show);
        }
    }
}

/// Runs commands that nobody scores by: the crowd's.
pub fn order(table: &Table, commands: &[Command], lights: &mut u64, world: &mut World, mut show: impl FnMut(Effect)) {
    perform(table, commands, &mut Score::default(), lights, world, &mut show);
}

fn matches(trigger: &Trigger, occasion: Occasion, table: &Table, world: &World) -> bool {
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
            is_of_set && world.held() & set == *set
        }
        (Trigger::AllDown(set), Occasion::Physics(EventKind::Felled { element, .. })) => {
            let is_of_set = table.targets.iter().position(|&e| e == element).is_some_and(|place| set >> place & 1 == 1);
            is_of_set && targets_down(world) & set == *set
        }
        (Trigger::BallStart, Occasion::BallStart) | (Trigger::BallEnd, Occasion::BallEnd) => true,
        _ => false,
    }
}

fn targets_down(world: &World) -> u64 {
    let targets = world.state().targets.iter().enumerate();
    targets.fold(0, |bits, (place, &target)| bits | u64::from(target == TargetState::Down) << place)
}

fn perform(
    table: &Table,
    commands: &[Command],
    score: &mut Score,
    lights: &mut u64,
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
            Command::Light(set) => *lights |= set,
            Command::Unlight(set) => *lights &= !set,
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
            Command::Message(place) => show(Effect::Message(*place)),
        }
    }
}
