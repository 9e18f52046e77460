//! Turns what happened into cues: which sound, how loud by the speed of the impact, and where between left and right.

use std::sync::Arc;

use shared::game::{GameEvent, GameEventKind, Nudge, Rescue};
use shared::math::Rng;
use shared::table::Table;
use shared::table::format::{ElementFile, Hand, Point};

use super::bank::Sound;
use super::faders::Roll;
use super::mixer::Cue;
use crate::effects::is_great;
use crate::moment::{Moment, Motion};

/// Normal speeds at which an impact is as loud as can be, and below which it is not heard, m/s.
const LOUDEST_IMPACT: f32 = 3.0;
const FAINTEST_IMPACT: f32 = 0.08;
/// Speed, of all balls together, from which they roll no louder, m/s.
const FASTEST_ROLL: f32 = 3.0;
/// Loudness grows by this power of the speed: a soft touch is still heard beside a hard one.
const BY_SPEED: f32 = 0.7;
/// Seconds within which an element makes the same sound once: faster, a rattle is a buzz.
const SAME_SOUND: f64 = 0.025;
/// Seconds after which nobody expects to hear of an event any more.
const PAST: f64 = 0.25;
/// Seconds over which the events of one picture are spread at the most, as far apart as they happened.
const MOST_DELAY: f64 = 0.02;
/// Wider than this share of the table an element has no place of its own: it is heard where the ball is.
const WIDE: f64 = 0.3;
/// What is at the very edge of the table is not in one ear alone.
const MOST_PAN: f32 = 0.8;
/// Share by which a sound's pitch varies, so that no two are the same.
const VARIES: f64 = 0.04;
/// Points that are great, and not only good.
const JACKPOT: u64 = 10_000;

/// How an element sounds.
#[derive(Debug, Clone, Copy)]
struct Part {
    /// When a ball meets it.
    surface: Sound,
    /// When it does what it is for.
    acts: Option<Sound>,
    /// Where; `None`: where the ball is.
    pan: Option<f32>,
}

/// Hears one board's events.
#[derive(Debug)]
pub(super) struct Listener {
    table: Arc<Table>,
    board: usize,
    parts: Vec<Part>,
    /// What was heard lately: sound, element, tick.
    recent: Vec<(Sound, u16, u64)>,
    /// The tick of the last picture.
    pictured: u64,
    rng: Rng,
}

impl Listener {
    /// Listens to a board of a room.
    pub(super) fn new(table: &Arc<Table>, board: usize) -> Self {
        let parts = table.file.elements.iter().map(|element| part_of(element, table)).collect();
        Self { table: Arc::clone(table), board, parts, recent: Vec::new(), pictured: 0, rng: Rng::new(1) }
    }

    /// Whether it listens to that board of a room with that table.
    pub(super) fn is_of(&self, table: &Table, board: usize) -> bool {
        (self.table.digest, self.board) == (table.digest, board)
    }

    /// What happened since the last picture.
    pub(super) fn hear(&mut self, moment: &Moment<'_>, events: &[GameEvent], play: &mut impl FnMut(Cue)) {
        let (now, dt) = (moment.at.tick, self.table.scene.tick_seconds);
        for (place, event) in events.iter().enumerate() {
            if now.saturating_sub(event.tick) as f64 * dt > PAST {
                continue;
            }
            let heard = self.cue_of(event.kind, &moment.balls).map(|cue| {
                // What brings so many points deserves more than its message.
                let of_tick = events[..place].iter().rev().take_while(|other| other.tick == event.tick);
                let is_much = |other: &GameEvent| matches!(other.kind, GameEventKind::Points { points: JACKPOT.., .. });
                let is_jackpot = cue.sound == Sound::Award && of_tick.into_iter().any(is_much);
                Cue { sound: if is_jackpot { Sound::Jackpot } else { cue.sound }, ..cue }
            });
            if let Some(cue) = heard.filter(|cue| self.is_new(cue.sound, element_of(event.kind), event.tick)) {
                let since = event.tick.saturating_sub(self.pictured) as f64 * dt;
                play(Cue { delay: cue.delay + since.min(MOST_DELAY) as f32, ..cue });
            }
        }
        self.pictured = now;
    }

    /// What rolls: all balls that are free, where the fastest of them are. Nothing does while the game stands still.
    pub(super) fn roll(&self, moment: &Moment<'_>) -> Roll {
        let free = moment.balls.iter().filter(|ball| !ball.is_held && moment.at.tick != self.pictured);
        let (speed, leaning) = free.fold((0.0, 0.0), |(sum, leaning), ball| {
            let speed = ball.velocity.length() as f32;
            (sum + speed, leaning + speed * self.pan_at(ball.position.x))
        });
        if speed > 0.0 { Roll { speed: (speed / FASTEST_ROLL).min(1.0), pan: leaning / speed } } else { Roll::NONE }
    }

    /// A cue for a sound of that element, or from the middle.
    pub(super) fn cue(&mut self, sound: Sound, gain: f32, element: Option<u16>) -> Cue {
        let pan = element.and_then(|element| self.parts.get(usize::from(element))?.pan).unwrap_or(0.0);
        let pitch = self.rng.between(1.0 - VARIES, 1.0 + VARIES) as f32;
        Cue { sound, gain, pan, pitch, delay: 0.0 }
    }

    /// How an event sounds among these balls, if it does.
    fn cue_of(&mut self, kind: GameEventKind, balls: &[Motion]) -> Option<Cue> {
        use GameEventKind as K;
        let tuned = |sound, pitch, pan| Cue { sound, gain: 1.0, pan, pitch, delay: 0.0 };
        Some(match kind {
            K::Touched { element, speed } => {
                let sound = self.parts.get(usize::from(element))?.surface;
                let pan = self.pan_of(element, balls);
                Cue { pan, ..self.cue(sound, loudness(speed)?, None) }
            }
            K::Kicked { element, speed } | K::Felled { element, speed } | K::Struck { element, speed } => {
                let sound = self.parts.get(usize::from(element))?.acts?;
                self.cue(sound, 0.6 + 0.4 * loudness(speed).unwrap_or(0.0), Some(element))
            }
            K::Passed { element } | K::Held { element } | K::Spun { element } => {
                let sound = self.parts.get(usize::from(element))?.acts?;
                // A spinner's plate is heard with each half turn, not when a ball comes through.
                if sound == Sound::Spinner && matches!(kind, K::Passed { .. }) {
                    return None;
                }
                self.cue(sound, 0.9, Some(element))
            }
            K::Ejected { element } => self.cue(Sound::Eject, 1.0, Some(element)),
            K::Points { points, place: Some((x, _)), .. } => {
                tuned(Sound::Chime, note_of(points), self.pan_at(x.into()))
            }
            K::Points { points: 1.., place: None, .. } => tuned(Sound::Multiplier, 1.0, 0.0),
            K::Message { place } => {
                let is_great = self.table.rules.messages.get(usize::from(place)).is_some_and(|text| is_great(text));
                tuned(if is_great { Sound::Jackpot } else { Sound::Award }, 1.0, 0.0)
            }
            K::Flipped { right } => {
                let pan = self.hand_of(right);
                Cue { pan, ..self.cue(Sound::FlipperUp, 1.0, None) }
            }
            K::Met { speed, place: (x, _) } => {
                let pan = self.pan_at(x.into());
                Cue { pan, ..self.cue(Sound::Clack, loudness(speed)?, None) }
            }
            K::Started => tuned(Sound::Start, 1.0, 0.0),
            // One that takes the place of a ball in a lock is no multiball.
            K::Added { .. } if balls.iter().any(|ball| !ball.is_held) => tuned(Sound::Multiball, 1.0, 0.0),
            K::Served { .. } | K::Added { .. } | K::Rescued { by: Rescue::Relaunch } => {
                let pan = self.pan_at(self.table.ball_start.x);
                Cue { pan, ..self.cue(Sound::Serve, 1.0, None) }
            }
            K::Saved { .. } => tuned(Sound::Multiplier, 0.75, 0.0),
            K::ExtraBall { .. } => tuned(Sound::Knock, 1.0, 0.0),
            K::Again { .. } => tuned(Sound::Award, 1.0, 0.0),
            K::Lost { .. } | K::Forfeited { .. } => tuned(Sound::Drain, 1.0, 0.0),
            // After the last ball has been heard to drain.
            K::Over => Cue { delay: 0.7, ..tuned(Sound::Over, 1.0, 0.0) },
            K::Announced { .. } => tuned(Sound::Alarm, 1.0, 0.0),
            K::Acted { .. } => tuned(Sound::Raise, 1.0, 0.0),
            K::Undone { .. } => tuned(Sound::Drop, 0.9, 0.0),
            K::Rescued { by: Rescue::Kickers } => tuned(Sound::Search, 1.0, 0.0),
            K::Nudged { nudge } => {
                let pan = match nudge {
                    Nudge::FromLeft => -MOST_PAN,
                    Nudge::FromRight => MOST_PAN,
                    Nudge::Forward => 0.0,
                };
                Cue { pan, ..self.cue(Sound::Nudge, 1.0, None) }
            }
            K::Warned { .. } => tuned(Sound::Warning, 1.0, 0.0),
            K::Tilted { .. } => tuned(Sound::Tilt, 1.0, 0.0),
            _ => return None,
        })
    }

    /// Whether an element has not made that sound just now.
    fn is_new(&mut self, sound: Sound, element: u16, tick: u64) -> bool {
        let same = (SAME_SOUND / self.table.scene.tick_seconds) as u64;
        self.recent.retain(|(.., before)| before.abs_diff(tick) < same);
        let is_new = !self.recent.iter().any(|&(other, of, _)| (other, of) == (sound, element));
        if is_new {
            self.recent.push((sound, element, tick));
        }
        is_new
    }

    /// Where a ball met an element: at its place, or for a wide one where the fastest ball is.
    fn pan_of(&self, element: u16, balls: &[Motion]) -> f32 {
        let pan = self.parts.get(usize::from(element)).and_then(|part| part.pan);
        let fastest = balls.iter().max_by(|a, b| a.velocity.length_squared().total_cmp(&b.velocity.length_squared()));
        pan.or_else(|| Some(self.pan_at(fastest?.position.x))).unwrap_or(0.0)
    }

    fn pan_at(&self, x: f64) -> f32 {
        pan_at(x, self.table.file.size.0)
    }

    /// Where the flippers of a hand are.
    fn hand_of(&self, right: bool) -> f32 {
        let hand = if right { Hand::Right } else { Hand::Left };
        let is_of_hand =
            |element: &ElementFile| matches!(element, ElementFile::Flipper(flipper) if flipper.hand == hand);
        let place = self.table.file.elements.iter().position(is_of_hand);
        place.and_then(|place| self.parts[place].pan).unwrap_or(0.0)
    }
}

/// -1 at the left edge of a table, 1 at the right one, and a little less of it.
fn pan_at(x: f64, width: f64) -> f32 {
    (2.0 * x / width - 1.0).clamp(-1.0, 1.0) as f32 * MOST_PAN
}

/// How loud an impact is; `None`: not at all.
fn loudness(speed: f32) -> Option<f32> {
    (speed >= FAINTEST_IMPACT).then(|| (speed / LOUDEST_IMPACT).min(1.0).powf(BY_SPEED))
}

/// Real machines have a chime for each digit: the more points, the higher.
fn note_of(points: u64) -> f32 {
    match points {
        ..100 => 1.0,
        100..1000 => 1.25,
        1000..5000 => 1.5,
        _ => 2.0,
    }
}

/// The element of an event; any number for those that have none.
fn element_of(kind: GameEventKind) -> u16 {
    use GameEventKind as K;
    match kind {
        K::Touched { element, .. }
        | K::Kicked { element, .. }
        | K::Felled { element, .. }
        | K::Struck { element, .. }
        | K::Passed { element }
        | K::Spun { element }
        | K::Held { element }
        | K::Ejected { element } => element,
        K::Flipped { right } => right.into(),
        _ => 0,
    }
}

fn part_of(element: &ElementFile, table: &Table) -> Part {
    use ElementFile as E;
    let width = table.file.size.0;
    let between = |points: &[Point]| {
        let (low, high) = points.iter().fold((f64::MAX, f64::MIN), |(low, high), &(x, _)| (low.min(x), high.max(x)));
        (high - low < WIDE * width).then(|| pan_at(0.5 * (low + high), width))
    };
    let around = |&(x, y): &Point, radius: f64| between(&[(x - radius, y), (x + radius, y)]);
    let (material, acts, pan) = match element {
        E::Wall(e) => (e.material.as_str(), None, between(&e.points)),
        E::Arc(e) => (e.material.as_str(), None, around(&e.center, e.radius)),
        E::Post(e) | E::Ring(e) => (e.material.as_str(), None, around(&e.center, e.radius)),
        E::OneWay(e) => (e.material.as_str(), None, between(&[e.from, e.to])),
        E::Bumper(e) => (e.material.as_str(), Some(Sound::Bumper), around(&e.center, e.radius)),
        E::Slingshot(e) => (e.material.as_str(), Some(Sound::Slingshot), between(&[e.from, e.to])),
        E::DropTarget(e) => (e.material.as_str(), Some(Sound::Drop), between(&[e.from, e.to])),
        E::Target(e) => (e.material.as_str(), Some(Sound::Target), between(&[e.from, e.to])),
        E::Flipper(e) => (e.material.as_str(), None, around(&e.pivot, e.length)),
        E::Plunger(e) => (e.material.as_str(), None, between(&[e.from, e.to])),
        // A ball that falls from one floor to another lands on wood.
        E::Hole(e) => ("wood", Some(Sound::Wood), between(&[e.from, e.to])),
        E::Edge(e) => ("wood", None, between(&[e.from, e.to])),
        E::Spinner(e) => ("wire", Some(Sound::Spinner), between(&[e.from, e.to])),
        E::Gate(e) => ("wire", Some(Sound::Gate), between(&[e.from, e.to])),
        E::Saucer(e) => ("rail", Some(Sound::Catch), around(&e.center, e.radius)),
        E::Rollover(e) => ("wire", Some(Sound::Rollover), between(&[e.from, e.to])),
        E::Drain(e) => ("wood", None, between(&[e.from, e.to])),
        E::Magnet(e) => ("wood", None, around(&e.center, e.radius)),
        E::Light(e) => ("wood", None, around(&e.center, e.radius)),
    };
    Part { surface: surface_of(material, table), acts, pan }
}

/// What a ball sounds like on a material: by its name, or by how it throws a ball back if the name says nothing.
fn surface_of(material: &str, table: &Table) -> Sound {
    let is = |words: &[&str]| words.iter().any(|word| material.contains(word));
    let restitution = table.file.materials.get(material).map_or(0.0, |material| material.restitution);
    if is(&["rubber"]) {
        Sound::Rubber
    } else if is(&["rail", "metal", "steel", "wire"]) {
        Sound::Metal
    } else if is(&["plastic"]) {
        Sound::Plastic
    } else if is(&["wood"]) || restitution < 0.6 {
        Sound::Wood
    } else {
        Sound::Rubber
    }
}

#[cfg(test)]
mod tests;
