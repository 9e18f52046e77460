//! What a rule names: events, conditions and commands as written, with every name resolved.

use super::check::{Context, is_printable, unprintable};
use super::format::{ActionFile, ConditionFile, ElementFile, EventFile};
use super::rulebook::{Command, Condition, LEAST_SECONDS, MOST_SECONDS, Trigger};

/// Most points of one action.
const MOST_POINTS: u64 = 1_000_000_000;

/// What kind of element a rule's name must stand for.
#[derive(Clone, Copy, PartialEq)]
pub(super) enum Kind {
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

pub(super) fn trigger(context: &Context<'_>, event: &EventFile) -> Result<Trigger, String> {
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
        EventFile::MultiballEnd => Trigger::MultiballEnd,
        EventFile::Out(name) => Trigger::Out(bits(context, name, Kind::Light)?),
    })
}

pub(super) fn condition(context: &Context<'_>, condition: &ConditionFile) -> Result<Condition, String> {
    Ok(match condition {
        ConditionFile::Lit(name) => Condition::Lit(bits(context, name, Kind::Light)?),
        ConditionFile::AnyLit(name) => Condition::AnyLit(bits(context, name, Kind::Light)?),
        ConditionFile::Unlit(name) => Condition::Unlit(bits(context, name, Kind::Light)?),
        ConditionFile::Down(name) => Condition::Down(bits(context, name, Kind::Target)?),
        ConditionFile::Up(name) => Condition::Up(bits(context, name, Kind::Target)?),
        ConditionFile::OneBall => Condition::OneBall,
        ConditionFile::Multiball => Condition::Multiball,
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
        ActionFile::LightFor(name, seconds) => {
            Command::LightFor(bits(context, name, Kind::Light)?, seconds_in_range(*seconds)?)
        }
        ActionFile::Unlight(name) => Command::Unlight(bits(context, name, Kind::Light)?),
        ActionFile::Raise(name) => Command::Raise(bits(context, name, Kind::Target)?),
        ActionFile::Lower(name) => Command::Lower(bits(context, name, Kind::Target)?),
        ActionFile::Kick(name) => Command::Kick(bits(context, name, Kind::Saucer)?),
        ActionFile::Attract(name) => Command::Attract(bits(context, name, Kind::Magnet)?),
        ActionFile::Release(name) => Command::Release(bits(context, name, Kind::Magnet)?),
        ActionFile::Serve => Command::Serve,
        ActionFile::SaveBalls(_) if context.file.rules.ball_save.is_none() => {
            return Err("the rules have no `ball_save`, whose grace and light it needs; one, such as `(lasts: 10.0)`, would be right".to_owned());
        }
        ActionFile::SaveBalls(seconds) => Command::SaveBalls(seconds_in_range(*seconds)?),
        ActionFile::ExtraBall if context.file.rules.max_extra_balls == 0 => {
            return Err(
                "nobody would ever get it; a `max_extra_balls` of 1 or more in the rules would be right".to_owned()
            );
        }
        ActionFile::ExtraBall => Command::ExtraBall,
        ActionFile::Message(text) => {
            if !is_printable(text) {
                return Err(unprintable(text));
            }
            messages.push(text.clone());
            Command::Message((messages.len() - 1) as u16)
        }
    })
}

fn seconds_in_range(seconds: f64) -> Result<f64, String> {
    if (LEAST_SECONDS..=MOST_SECONDS).contains(&seconds) {
        Ok(seconds)
    } else {
        Err(format!("{seconds} s are not within {LEAST_SECONDS} to {MOST_SECONDS}; 10 s would be right"))
    }
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
pub(super) fn bits(context: &Context<'_>, name: &str, kind: Kind) -> Result<u64, String> {
    let all: Vec<u16> = (0_u16..).zip(&context.file.elements).filter(|(_, e)| kind.fits(e)).map(|(i, _)| i).collect();
    let mut bits = 0;
    for index in elements(context, name, kind)? {
        // `check` allows at most 64 of each kind.
        bits |= all.iter().position(|&i| i == index).map_or(0, |place| 1_u64 << place);
    }
    Ok(bits)
}
