//! The rules of a table with every name resolved to a number.

use super::check::{Context, Spot};
use super::crowd::{self, CrowdRules};
use super::error::TableError;
use super::format::{ActionFile, BallSaveFile, RulesFile};
use super::rule_names::{self, Kind, bits, command};
use crate::rules::MOST_TIMED_LIGHTS;

/// The rules of a table.
#[derive(Debug, Clone, PartialEq)]
pub struct RuleBook {
    /// Balls a player has in a game.
    pub balls: u32,
    /// The multiplier never grows beyond this.
    pub max_multiplier: u32,
    /// Extra balls that a player can get in a game.
    pub max_extra_balls: u8,
    /// Whether lost balls are saved.
    pub ball_save: Option<BallSaveRules>,
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
        Self {
            balls,
            max_multiplier,
            max_extra_balls: 0,
            ball_save: None,
            rules: Vec::new(),
            messages: Vec::new(),
            crowd: None,
        }
    }
}

/// For how long after the launch of a turn's ball a lost one is put into play again.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct BallSaveRules {
    /// Seconds of play.
    pub lasts: f64,
    /// How many balls are saved in that time.
    pub saves: u8,
    /// Seconds for which they are saved after the light has gone out.
    pub grace: f64,
    /// Lights that tell of it, one bit each.
    pub light: u64,
}

/// When a trigger is met and all conditions were, its commands run in order.
#[derive(Debug, Clone, PartialEq)]
pub struct Rule {
    /// When.
    pub trigger: Trigger,
    /// If all of that was so when the event happened.
    pub when: Vec<Condition>,
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
    /// Of several balls in play only one is left.
    MultiballEnd,
    /// One of these lights went out by itself. One bit a light.
    Out(u64),
}

/// What must be so for a rule to run.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub enum Condition {
    /// All of these lights are lit, one bit a light.
    Lit(u64),
    /// One of them is, or more.
    AnyLit(u64),
    /// None of them is.
    Unlit(u64),
    /// All of these targets are down, one bit a target.
    Down(u64),
    /// All of them stand.
    Up(u64),
    /// One ball is in play, those that are locked not counted.
    OneBall,
    /// Two are, or more.
    Multiball,
}

/// What a rule does.
#[derive(Debug, Clone, PartialEq)]
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
    /// Lights on for so many seconds of play.
    LightFor(u64, f64),
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
    /// Balls that are lost within so many seconds of play are put into play again.
    SaveBalls(f64),
    /// The player plays on with another ball when this one is lost.
    ExtraBall,
    /// A line on the display, by its place in [`RuleBook::messages`].
    Message(u16),
}

/// Most rules of a table.
const MOST_RULES: usize = 500;
/// Most actions of a rule.
pub(super) const MOST_ACTIONS: usize = 32;
/// Most conditions of a rule.
const MOST_CONDITIONS: usize = 16;
/// Longest time for which lights are lit and balls are saved, seconds. Its ticks fit 32 bits at the highest tick rate, twice.
pub const MOST_SECONDS: f64 = 600.0;
/// Shortest time for which lights are lit, seconds.
pub(super) const LEAST_SECONDS: f64 = 0.1;
/// Most extra balls that a table's rules may give a player in a game: a state has room for so many.
pub const MOST_EXTRA_BALLS: u8 = 7;

/// Whether the rules can put more than one ball into play.
pub(super) fn serves(rules: &RulesFile) -> bool {
    rules.on.iter().any(|rule| rule.run.contains(&ActionFile::Serve))
}

pub(super) fn resolve(context: &Context<'_>, rules: &RulesFile) -> Result<RuleBook, TableError> {
    context.in_range(Spot::Rules, "balls", f64::from(rules.balls), 1.0, 100.0, "3")?;
    context.in_range(Spot::Rules, "max_multiplier", f64::from(rules.max_multiplier), 1.0, 100.0, "6")?;
    let most_extra = f64::from(MOST_EXTRA_BALLS);
    context.in_range(Spot::Rules, "max_extra_balls", f64::from(rules.max_extra_balls), 0.0, most_extra, "1")?;
    let mut book = RuleBook::empty(rules.balls, rules.max_multiplier);
    book.max_extra_balls = rules.max_extra_balls;
    book.ball_save = rules.ball_save.as_ref().map(|save| ball_save(context, save)).transpose()?;
    if rules.on.len() > MOST_RULES {
        let problem = format!("{} rules are more than {MOST_RULES}", rules.on.len());
        return Err(context.error(Spot::Rules, Some("on"), problem));
    }
    for (place, rule) in rules.on.iter().enumerate() {
        let spot = Spot::Rule(place);
        let count = |field, found: usize, most, what| {
            let problem = || format!("{found} {what} in one rule are more than {most}");
            if found > most { Err(context.error(spot, Some(field), problem())) } else { Ok(()) }
        };
        count("when", rule.when.len(), MOST_CONDITIONS, "conditions")?;
        count("run", rule.run.len(), MOST_ACTIONS, "actions")?;
        let in_event = |problem| context.error(spot, Some("event"), problem);
        let trigger = rule_names::trigger(context, &rule.event).map_err(in_event)?;
        let mut when = Vec::new();
        for (place, condition) in rule.when.iter().enumerate() {
            let in_condition = |problem| context.error_at(spot, Some("when"), Some(place), problem);
            when.push(rule_names::condition(context, condition).map_err(in_condition)?);
        }
        let mut commands = Vec::new();
        for (place, action) in rule.run.iter().enumerate() {
            let in_action = |problem| context.error_at(spot, Some("run"), Some(place), problem);
            commands.push(command(context, action, &mut book.messages).map_err(in_action)?);
        }
        book.rules.push(Rule { trigger, when, commands });
    }
    if let Some(crowd) = &rules.crowd {
        book.crowd = Some(crowd::resolve(context, crowd, &mut book.messages)?);
    }
    has_room_for_timers(context, &book)?;
    Ok(book)
}

fn ball_save(context: &Context<'_>, save: &BallSaveFile) -> Result<BallSaveRules, TableError> {
    let spot = Spot::BallSave;
    context.in_range(spot, "lasts", save.lasts, LEAST_SECONDS, MOST_SECONDS, "10 s")?;
    context.in_range(spot, "saves", f64::from(save.saves), 0.0, 100.0, "1")?;
    context.in_range(spot, "grace", save.grace, 0.0, 10.0, "2 s")?;
    let light = save.light.as_ref().map(|name| bits(context, name, Kind::Light)).transpose();
    let light = light.map_err(|problem| context.error(spot, Some("light"), problem))?;
    Ok(BallSaveRules { lasts: save.lasts, saves: save.saves, grace: save.grace, light: light.unwrap_or(0) })
}

/// A state has room for so many lights that go out by themselves.
fn has_room_for_timers(context: &Context<'_>, book: &RuleBook) -> Result<(), TableError> {
    let of_crowd = book.crowd.iter().flat_map(|crowd| &crowd.actions).flat_map(|action| [&action.run, &action.undo]);
    let commands = book.rules.iter().map(|rule| &rule.commands).chain(of_crowd).flatten();
    let timed = commands.fold(0_u64, |bits, command| match command {
        Command::LightFor(set, _) => bits | set,
        _ => bits,
    });
    let found = timed.count_ones() as usize;
    if found <= MOST_TIMED_LIGHTS {
        return Ok(());
    }
    let problem = format!("{found} lights that are lit for a time are more than {MOST_TIMED_LIGHTS}");
    Err(context.error(Spot::Rules, Some("on"), problem))
}
