//! The rules of a table with every name resolved to a number.

use super::check::{Context, Spot, is_printable, unprintable};
use super::crowd::{self, CrowdRules};
use super::error::TableError;
use super::format::{ActionFile, ElementFile, EventFile, RulesFile};

/// The rules of a table.
#[derive(Debug, Clone, PartialEq)]
pub struct RuleBook {
    /// Balls a player has in a game.
    pub balls: u32,
    /// The multiplier never grows beyond this.
    pub max_multiplier: u32,
    /// In the file's order.
    pub rules: Vec<Rule>,
    /// Every line that a rule can put on the display.
    pub messages: Vec<String>,
    /// What who watches may do against who plays.
    pub crowd: Option<CrowdRules>,
}

impl RuleBook {
    /// No rules at all.
    pub(super) fn empty(balls: u32, max_multiplier: u32) -> Self {
        Self { balls, max_multiplier, rules: Vec::new(), messages: Vec::new(), crowd: None }
    }
}

/// When a trigger is met, its commands run in order.
#[derive(Debug, Clone, PartialEq, Eq)]
pub struct Rule {
    /// When.
    pub trigger: Trigger,
    /// What.
    pub commands: Vec<Command>,
}

/// What a rule waits for.
#[derive(Debug, Clone, PartialEq, Eq)]
pub enum Trigger {
    /// One of these elements was hit.
    Hit(Vec<u16>),
    /// One of these rollovers, gates or spinners was passed.
    Pass(Vec<u16>),
    /// One of these spinners turned half round.
    Spin(Vec<u16>),
    /// One of these saucers caught a ball.
    Hold(Vec<u16>),
    /// All of these saucers hold a ball, the last of them since just now. One bit a saucer.
    AllHeld(u64),
    /// All of these lights are lit, the last of them just now. One bit a light.
    AllLit(u64),
    /// All of these targets are down, the last of them just now. One bit a target.
    AllDown(u64),
    /// A ball was served.
    BallStart,
    /// The last ball in play was lost.
    BallEnd,
}

/// What a rule does.
#[derive(Debug, Clone, PartialEq, Eq)]
pub enum Command {
    /// Points.
    Score(u64),
    /// Points for the end of the ball.
    Bonus(u64),
    /// One step up.
    RaiseMultiplier,
    /// Pays the bonus times the multiplier.
    CollectBonus,
    /// Lights on, one bit a light.
    Light(u64),
    /// Lights off.
    Unlight(u64),
    /// Targets up, one bit a target.
    Raise(u64),
    /// Targets down.
    Lower(u64),
    /// Saucers throw out what they hold, one bit a saucer.
    Kick(u64),
    /// Magnets on, one bit a magnet.
    Attract(u64),
    /// Magnets off.
    Release(u64),
    /// Another ball.
    Serve,
    /// A line on the display, by its place in [`RuleBook::messages`].
    Message(u16),
}

/// Most rules of a table.
const MOST_RULES: usize = 500;
/// Most actions of a rule.
pub(super) const MOST_ACTIONS: usize = 32;
/// Most points of one action.
const MOST_POINTS: u64 = 1_000_000_000;

/// What kind of element a rule's name must stand for.
#[derive(Clone, Copy, PartialEq)]
enum Kind {
    Hittable,
    Passable,
    Light,
    Target,
    Spinner,
    Saucer,
    Magnet,
}

impl Kind {
    fn fits(self, element: &ElementFile) -> bool {
        use ElementFile as E;
        match self {
            Self::Hittable => {
                matches!(
                    element,
                    E::Wall(_)
                        | E::Arc(_)
                        | E::Post(_)
                        | E::OneWay(_)
                        | E::Target(_)
                        | E::Gate(_)
                        | E::Spinner(_)
                        | E::Bumper(_)
                        | E::Slingshot(_)
                        | E::DropTarget(_)
                )
            }
            Self::Passable => matches!(element, E::Rollover(_) | E::Gate(_) | E::Spinner(_) | E::Hole(_)),
            Self::Light => matches!(element, E::Light(_)),
            Self::Target => matches!(element, E::DropTarget(_)),
            Self::Spinner => matches!(element, E::Spinner(_)),
            Self::Saucer => matches!(element, E::Saucer(_)),
            Self::Magnet => matches!(element, E::Magnet(_)),
        }
    }

    fn expected(self) -> &'static str {
        match self {
            Self::Hittable => "something that a ball can hit",
            Self::Passable => "a Rollover, Gate, Spinner or Hole",
            Self::Light => "a Light",
            Self::Target => "a DropTarget",
            Self::Spinner => "a Spinner",
            Self::Saucer => "a Saucer",
            Self::Magnet => "a Magnet",
        }
    }
}

/// Whether the rules can put more than one ball into play.
pub(super) fn serves(rules: &RulesFile) -> bool {
    rules.on.iter().any(|rule| rule.run.contains(&ActionFile::Serve))
}

pub(super) fn resolve(context: &Context<'_>, rules: &RulesFile) -> Result<RuleBook, TableError> {
    context.in_range(Spot::Rules, "balls", f64::from(rules.balls), 1.0, 100.0, "3")?;
    context.in_range(Spot::Rules, "max_multiplier", f64::from(rules.max_multiplier), 1.0, 100.0, "6")?;
    let mut book = RuleBook::empty(rules.balls, rules.max_multiplier);
    if rules.on.len() > MOST_RULES {
        let problem = format!("{} rules are more than {MOST_RULES}", rules.on.len());
        return Err(context.error(Spot::Rules, Some("on"), problem));
    }
    for (place, rule) in rules.on.iter().enumerate() {
        let spot = Spot::Rule(place);
        if rule.run.len() > MOST_ACTIONS {
            let problem = format!("{} actions in one rule are more than {MOST_ACTIONS}", rule.run.len());
            return Err(context.error(spot, Some("run"), problem));
        }
        let in_event = |problem| context.error(spot, Some("event"), problem);
        let trigger = trigger(context, &rule.event).map_err(in_event)?;
        let mut commands = Vec::new();
        for (place, action) in rule.run.iter().enumerate() {
            let in_action = |problem| context.error_at(spot, Some("run"), Some(place), problem);
            commands.push(command(context, action, &mut book.messages).map_err(in_action)?);
        }
        book.rules.push(Rule { trigger, commands });
    }
    if let Some(crowd) = &rules.crowd {
        book.crowd = Some(crowd::resolve(context, crowd, &mut book.messages)?);
    }
    Ok(book)
}

fn trigger(context: &Context<'_>, event: &EventFile) -> Result<Trigger, String> {
    Ok(match event {
        EventFile::Hit(name) => Trigger::Hit(elements(context, name, Kind::Hittable)?),
        EventFile::Pass(name) => Trigger::Pass(elements(context, name, Kind::Passable)?),
        EventFile::AllLit(name) => Trigger::AllLit(bits(context, name, Kind::Light)?),
        EventFile::AllDown(name) => Trigger::AllDown(bits(context, name, Kind::Target)?),
        EventFile::Spin(name) => Trigger::Spin(elements(context, name, Kind::Spinner)?),
        EventFile::Hold(name) => Trigger::Hold(elements(context, name, Kind::Saucer)?),
        EventFile::AllHeld(name) => Trigger::AllHeld(bits(context, name, Kind::Saucer)?),
        EventFile::BallStart => Trigger::BallStart,
        EventFile::BallEnd => Trigger::BallEnd,
    })
}

pub(super) fn command(
    context: &Context<'_>,
    action: &ActionFile,
    messages: &mut Vec<String>,
) -> Result<Command, String> {
    Ok(match action {
        ActionFile::Score(points) => Command::Score(points_in_range(*points)?),
        ActionFile::Bonus(points) => Command::Bonus(points_in_range(*points)?),
        ActionFile::RaiseMultiplier => Command::RaiseMultiplier,
        ActionFile::CollectBonus => Command::CollectBonus,
        ActionFile::Light(name) => Command::Light(bits(context, name, Kind::Light)?),
        ActionFile::Unlight(name) => Command::Unlight(bits(context, name, Kind::Light)?),
        ActionFile::Raise(name) => Command::Raise(bits(context, name, Kind::Target)?),
        ActionFile::Lower(name) => Command::Lower(bits(context, name, Kind::Target)?),
        ActionFile::Kick(name) => Command::Kick(bits(context, name, Kind::Saucer)?),
        ActionFile::Attract(name) => Command::Attract(bits(context, name, Kind::Magnet)?),
        ActionFile::Release(name) => Command::Release(bits(context, name, Kind::Magnet)?),
        ActionFile::Serve => Command::Serve,
        ActionFile::Message(text) => {
            if !is_printable(text) {
                return Err(unprintable(text));
            }
            messages.push(text.clone());
            Command::Message((messages.len() - 1) as u16)
        }
    })
}

/// No single rule may make a score overflow within any number of years.
pub(super) fn points_in_range(points: u64) -> Result<u64, String> {
    if points <= MOST_POINTS {
        Ok(points)
    } else {
        Err(format!("{points} points are more than {MOST_POINTS}; at most that many would be right for one event"))
    }
}

/// The elements that a name stands for: itself, or the members of a group.
fn elements(context: &Context<'_>, name: &str, kind: Kind) -> Result<Vec<u16>, String> {
    let names = context.file.groups.get(name).map_or_else(|| vec![name.to_owned()], Clone::clone);
    let mut found = Vec::new();
    for member in &names {
        let index = context
            .index_of(member)
            .ok_or_else(|| format!("{name:?} is neither an element nor a group; {} would be right", kind.expected()))?;
        if !kind.fits(&context.file.elements[usize::from(index)]) {
            let who = if member == name { format!("{name:?}") } else { format!("{member:?} of the group {name:?}") };
            return Err(format!("{who} is of the wrong kind; {} would be right", kind.expected()));
        }
        found.push(index);
    }
    Ok(found)
}

/// The same, as one bit each among the elements of that kind.
fn bits(context: &Context<'_>, name: &str, kind: Kind) -> Result<u64, String> {
    let all: Vec<u16> = (0_u16..).zip(&context.file.elements).filter(|(_, e)| kind.fits(e)).map(|(i, _)| i).collect();
    let mut bits = 0;
    for index in elements(context, name, kind)? {
        // `check` allows at most 64 of each kind.
        bits |= all.iter().position(|&i| i == index).map_or(0, |place| 1_u64 << place);
    }
    Ok(bits)
}
