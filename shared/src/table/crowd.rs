//! What the crowd may do at a table, checked, with every name resolved.

use std::collections::BTreeSet;

use super::check::{Context, Spot};
use super::error::TableError;
use super::format::{ActionFile, CrowdActionFile, CrowdFile};
use super::rule_names::{command, points_in_range};
use super::rulebook::{Command, MOST_ACTIONS};

/// Most actions that a crowd has: a state has room for so many.
pub const MOST_CROWD_ACTIONS: usize = 8;

/// Longest time in which the energy grows to its most, seconds. With it, and the other times below, every count of ticks fits
/// 32 bits at the highest tick rate.
const LONGEST_GROWTH: f64 = 3600.0;

/// What the crowd may do, and what it costs.
#[derive(Debug, Clone, PartialEq)]
pub struct CrowdRules {
    /// How fast its energy grows while a ball is in play, 1/s.
    pub energy_per_second: f64,
    /// Its energy never grows beyond this.
    pub most_energy: f64,
    /// What it gets for each ball that a player loses.
    pub points_per_ball: u64,
    /// What it may do: one, up to [`MOST_CROWD_ACTIONS`].
    pub actions: Vec<CrowdAction>,
}

/// One thing that the crowd may do.
#[derive(Debug, Clone, PartialEq)]
pub struct CrowdAction {
    /// What voters and players read.
    pub name: String,
    /// Energy that it takes.
    pub cost: f64,
    /// Seconds for which the player is warned before it acts.
    pub announce: f64,
    /// Seconds from then until it is undone; 0: it is done at once.
    pub lasts: f64,
    /// Seconds after that until it can be had again.
    pub cool_down: f64,
    /// What the crowd gets when it acts.
    pub points: u64,
    /// Whether the lights are dimmed while it lasts.
    pub dims: bool,
    /// What is done when it acts.
    pub run: Vec<Command>,
    /// What is done when it is over.
    pub undo: Vec<Command>,
}

pub(super) fn resolve(
    context: &Context<'_>,
    crowd: &CrowdFile,
    messages: &mut Vec<String>,
) -> Result<CrowdRules, TableError> {
    let spot = Spot::Crowd;
    let rate = crowd.energy_per_second;
    context.in_range(spot, "energy_per_second", rate, 1e-3, 1e3, "1")?;
    context.in_range(spot, "most_energy", crowd.most_energy, 0.0, LONGEST_GROWTH * rate, "20")?;
    points(context, spot, "points_per_ball", crowd.points_per_ball)?;
    if !(1..=MOST_CROWD_ACTIONS).contains(&crowd.actions.len()) {
        let problem = format!("{} actions; 1 to {MOST_CROWD_ACTIONS} would be right", crowd.actions.len());
        return Err(context.error(spot, Some("actions"), problem));
    }
    let mut names = BTreeSet::new();
    let mut actions = Vec::new();
    for (place, action) in crowd.actions.iter().enumerate() {
        let spot = Spot::CrowdAction(place);
        context.printable(spot, Some("name"), &action.name)?;
        if !names.insert(&action.name) {
            let problem = format!("another action of the crowd is {:?}, too; names must differ", action.name);
            return Err(context.error(spot, Some("name"), problem));
        }
        context.in_range(spot, "cost", action.cost, 0.0, crowd.most_energy, "8, or a larger `most_energy`,")?;
        context.in_range(spot, "announce", action.announce, 0.5, 10.0, "2 s")?;
        context.in_range(spot, "lasts", action.lasts, 0.0, 60.0, "6 s")?;
        context.in_range(spot, "cool_down", action.cool_down, 0.0, 600.0, "15 s")?;
        points(context, spot, "points", action.points)?;
        lasts_as_it_should(context, spot, action)?;
        actions.push(CrowdAction {
            name: action.name.clone(),
            cost: action.cost,
            announce: action.announce,
            lasts: action.lasts,
            cool_down: action.cool_down,
            points: action.points,
            dims: action.dims,
            run: commands(context, spot, "run", &action.run, messages)?,
            undo: commands(context, spot, "undo", &action.undo, messages)?,
        });
    }
    Ok(CrowdRules {
        energy_per_second: rate,
        most_energy: crowd.most_energy,
        points_per_ball: crowd.points_per_ball,
        actions,
    })
}

/// What does nothing is nothing to vote for, and what is over at once has nothing to undo.
fn lasts_as_it_should(context: &Context<'_>, spot: Spot<'_>, action: &CrowdActionFile) -> Result<(), TableError> {
    if action.run.is_empty() && !action.dims {
        let problem = "it does nothing; a command, or `dims: true`, would be right".to_owned();
        return Err(context.error(spot, Some("run"), problem));
    }
    if action.lasts == 0.0 && (action.dims || !action.undo.is_empty()) {
        let problem = "it would be over at once; 6 s would be right".to_owned();
        return Err(context.error(spot, Some("lasts"), problem));
    }
    Ok(())
}

fn points(context: &Context<'_>, spot: Spot<'_>, field: &str, points: u64) -> Result<(), TableError> {
    points_in_range(points).map(|_| ()).map_err(|problem| context.error(spot, Some(field), problem))
}

fn commands(
    context: &Context<'_>,
    spot: Spot<'_>,
    field: &str,
    actions: &[ActionFile],
    messages: &mut Vec<String>,
) -> Result<Vec<Command>, TableError> {
    if actions.len() > MOST_ACTIONS {
        let problem = format!("{} commands are more than {MOST_ACTIONS}", actions.len());
        return Err(context.error(spot, Some(field), problem));
    }
    let mut commands = Vec::new();
    for (place, action) in actions.iter().enumerate() {
        let error = |problem| context.error_at(spot, Some(field), Some(place), problem);
        use ActionFile as A;
        let is_players = matches!(
            action,
            A::Score(_)
                | A::Bonus(_)
                | A::RaiseMultiplier
                | A::CollectBonus
                | A::Serve
                | A::SaveBalls(_)
                | A::ExtraBall
        );
        if is_players {
            let problem = "the crowd has no hand in the player's score and balls; Raise, Lower, Kick, Attract, Release, Light, LightFor, Unlight or Message would be right";
            return Err(error(problem.to_owned()));
        }
        commands.push(command(context, action, messages).map_err(error)?);
    }
    Ok(commands)
}
