//! What events leave to be seen for a moment: flashes, points that float up, sparks, cheers, a line on the display.

mod bursts;
mod rolling;

use macroquad::math::{Quat, Vec2, vec2};
use shared::game::{GameEvent, GameEventKind, Nudge, Rescue};
use shared::table::Table;

use crate::moment::Motion;
use crate::view::{Burst, Popup};
use bursts::Bursts;
use rolling::Rolling;

/// Seconds that an element's flash takes to fade.
const FLASH_SECONDS: f64 = 0.33;
/// Seconds that points float.
const POPUP_SECONDS: f64 = 1.0;
/// Points are added to those that were made less than so many seconds ago and less than so many metres away.
const SAME_POPUP: f64 = 0.3;
const POPUP_APART: f32 = 0.01;
/// Seconds that a line stays on the display.
const MESSAGE_SECONDS: f64 = 2.5;
/// Points that float at once; the oldest go first.
const MOST_POPUPS: usize = 24;

/// What is said of a lost ball that is put into play again.
const SAVED: &str = "BALL SAVED";
/// Seconds that something great is cheered.
const CHEER_SECONDS: f64 = 2.4;
/// Words by which a message is known for something great.
const GREAT: [&str; 5] = ["JACKPOT", "EXTRA BALL", "MULTIBALL", "SPECIAL", "SUPER"];

/// Whether a message tells of something great.
pub(crate) fn is_great(message: &str) -> bool {
    GREAT.iter().any(|word| message.contains(word))
}

/// What is to be seen of past events.
#[derive(Debug, Default)]
pub(crate) struct Effects {
    /// For each element that was hit, when.
    hits: Vec<Option<f64>>,
    /// (When, where, what).
    popups: Vec<(f64, Vec2, u64)>,
    message: Option<(f64, String)>,
    /// The last nudge from each side, and when.
    slaps: Vec<(Nudge, f64)>,
    bursts: Bursts,
    /// Balls that saucers have caught since balls were seen last.
    caught: usize,
    /// When something great was reached, and when the game tilted.
    cheered: Option<f64>,
    tilted: Option<f64>,
    rolling: Rolling,
}

impl Effects {
    /// Takes in what happened, seen at `now` seconds while `loose` balls were in play that no saucer held when they were seen
    /// last.
    pub(crate) fn note(&mut self, event: &GameEvent, table: &Table, loose: usize, now: f64) {
        self.bursts.note(event, table, now);
        if matches!(event.kind, GameEventKind::Held { .. }) {
            self.caught += 1;
        }
        match event.kind {
            GameEventKind::Kicked { element, .. }
            | GameEventKind::Felled { element, .. }
            | GameEventKind::Passed { element }
            | GameEventKind::Struck { element, .. }
            | GameEventKind::Spun { element }
            | GameEventKind::Held { element }
            | GameEventKind::Ejected { element } => self.flash(element, now),
            GameEventKind::Points { points, place: Some((x, y)), .. } => {
                self.pop_up(points, vec2(x, y), now);
            }
            GameEventKind::Message { place } => {
                if let Some(text) = table.rules.messages.get(usize::from(place)) {
                    if is_great(text) {
                        self.cheered = Some(now);
                    }
                    self.say(text.clone(), now);
                }
            }
            GameEventKind::Served { ball, .. } => self.say(format!("BALL {ball}"), now),
            // One that takes the place of a ball in a lock, or of one that is saved, is no multiball.
            GameEventKind::Added { .. } if loose > self.caught && self.message(now) != Some(SAVED) => {
                self.say("MULTIBALL".to_owned(), now);
            }
            GameEventKind::Saved { .. } => self.say(SAVED.to_owned(), now),
            GameEventKind::ExtraBall { .. } => {
                self.cheered = Some(now);
                self.say("EXTRA BALL".to_owned(), now);
            }
            GameEventKind::Again { .. } => self.say("SHOOT AGAIN".to_owned(), now),
            GameEventKind::Lost { .. } => self.say("BALL LOST".to_owned(), now),
            GameEventKind::Forfeited { .. } => self.say("TURN LOST".to_owned(), now),
            GameEventKind::Announced { action } => {
                let crowd = table.rules.crowd.as_ref();
                if let Some(action) = crowd.and_then(|crowd| crowd.actions.get(usize::from(action))) {
                    self.say(action.name.clone(), now);
                }
            }
            GameEventKind::Rescued { by: Rescue::Kickers } => self.say("BALL SEARCH".to_owned(), now),
            GameEventKind::Rescued { by: Rescue::Relaunch } => self.say("BALL RETURNED".to_owned(), now),
            GameEventKind::Nudged { nudge } => {
                self.slaps.retain(|(other, _)| *other != nudge);
                self.slaps.push((nudge, now));
            }
            GameEventKind::Warned { .. } => self.say("DANGER".to_owned(), now),
            GameEventKind::Tilted { .. } => {
                (self.tilted, self.cheered) = (Some(now), None);
                self.say("TILT".to_owned(), now);
            }
            _ => {}
        }
    }

    /// Lets points float; what is made again and again in one place, as a spinner does, is one sum that grows.
    fn pop_up(&mut self, points: u64, place: Vec2, now: f64) {
        let is_same = |(born, other, _): &&mut (f64, Vec2, u64)| {
            now - *born < SAME_POPUP && other.distance_squared(place) < POPUP_APART * POPUP_APART
        };
        if let Some((born, _, sum)) = self.popups.iter_mut().find(is_same) {
            (*born, *sum) = (now, sum.saturating_add(points));
            return;
        }
        if self.popups.len() == MOST_POPUPS {
            self.popups.remove(0);
        }
        self.popups.push((now, place, points));
    }

    /// Takes in where balls of a radius in metres are seen at `now`, and how they spin.
    pub(crate) fn see(&mut self, balls: &[Motion], radius: f32, now: f64) {
        self.caught = 0;
        self.rolling.see(balls, radius, now);
        self.bursts.see(balls.iter().map(|ball| ball.position.as_vec2()));
    }

    /// How a ball is turned since it came into play.
    pub(crate) fn orientation_of(&self, ball: u32) -> Quat {
        self.rolling.orientation_of(ball)
    }

    /// Sparks that fly now. Forgets those that are out.
    pub(crate) fn bursts(&mut self, now: f64) -> Vec<Burst> {
        self.bursts.at(now)
    }

    /// Seconds since something great was reached, while it is cheered.
    pub(crate) fn cheer(&self, now: f64) -> Option<f32> {
        let since = self.cheered?;
        (0.0..CHEER_SECONDS).contains(&(now - since)).then_some((now - since) as f32)
    }

    /// Seconds since the last tilt that was seen.
    pub(crate) fn tilt(&self, now: f64) -> Option<f32> {
        self.tilted.map(|since| (now - since).max(0.0) as f32)
    }

    /// Puts a line on the display.
    pub(crate) fn say(&mut self, text: String, now: f64) {
        self.message = Some((now, text));
    }

    /// The line on the display, if one is fresh.
    pub(crate) fn message(&self, now: f64) -> Option<&str> {
        let (since, text) = self.message.as_ref()?;
        (now - since < MESSAGE_SECONDS).then_some(text)
    }

    /// How bright an element flashes, 0 to 1.
    pub(crate) fn flash_of(&self, element: usize, now: f64) -> f32 {
        let hit = self.hits.get(element).copied().flatten();
        hit.map_or(0.0, |hit| faded(hit, now))
    }

    /// How bright a nudge from that side flashes, 0 to 1.
    pub(crate) fn slap_of(&self, nudge: Nudge, now: f64) -> f32 {
        let since = self.slaps.iter().find(|(side, _)| *side == nudge).map(|(_, since)| *since);
        since.map_or(0.0, |since| faded(since, now))
    }

    /// Points that float now. Forgets those that are gone.
    pub(crate) fn popups(&mut self, now: f64) -> Vec<Popup> {
        self.popups.retain(|(born, ..)| now - born < POPUP_SECONDS);
        let popup = |&(born, position, points): &(f64, Vec2, u64)| {
            let age = ((now - born) / POPUP_SECONDS).clamp(0.0, 1.0) as f32;
            Popup { position, text: format!("+{points}"), age }
        };
        self.popups.iter().map(popup).collect()
    }

    fn flash(&mut self, element: u16, now: f64) {
        let element = usize::from(element);
        if self.hits.len() <= element {
            self.hits.resize(element + 1, None);
        }
        self.hits[element] = Some(now);
    }
}

/// What is left at `now` of a flash that began at `since`, 1 to 0.
fn faded(since: f64, now: f64) -> f32 {
    (1.0 - (now - since) / FLASH_SECONDS).clamp(0.0, 1.0) as f32
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn everything_fades() {
        let table = Table::shipped("classic").unwrap().unwrap();
        let mut effects = Effects::default();
        let mut note = |kind| effects.note(&GameEvent { tick: 0, kind }, &table, 1, 10.0);
        note(GameEventKind::Kicked { element: 3, speed: 1.0 });
        note(GameEventKind::Points { seat: 0, points: 500, place: Some((0.1, 0.2)) });
        note(GameEventKind::Points { seat: 0, points: 9, place: None });
        note(GameEventKind::Message { place: 0 });
        note(GameEventKind::Message { place: u16::MAX });
        assert_eq!((effects.flash_of(3, 10.0), effects.flash_of(2, 10.0), effects.flash_of(99, 10.0)), (1.0, 0.0, 0.0));
        assert!((0.4..0.6).contains(&effects.flash_of(3, 10.165)));
        assert_eq!(effects.flash_of(3, 10.5), 0.0);
        assert_eq!(effects.message(12.0), Some(table.rules.messages[0].as_str()));
        assert_eq!(effects.message(12.6), None);
        effects.pop_up(70, vec2(0.1, 0.205), 10.05);
        effects.pop_up(3, vec2(0.3, 0.2), 10.0);
        let popups = effects.popups(10.55);
        assert_eq!((popups.len(), popups[1].text.as_str()), (2, "+3"));
        assert_eq!((popups.len(), popups[0].text.as_str(), popups[0].age), (2, "+570", 0.5));
        assert!(effects.popups(11.5).is_empty());
    }

    #[test]
    fn nudges_flash_on_their_side_and_warnings_are_told() {
        let table = Table::shipped("classic").unwrap().unwrap();
        let mut effects = Effects::default();
        let mut note = |kind, loose, now| effects.note(&GameEvent { tick: 0, kind }, &table, loose, now);
        note(GameEventKind::Nudged { nudge: Nudge::FromLeft }, 1, 10.0);
        note(GameEventKind::Warned { seat: 0 }, 1, 10.0);
        note(GameEventKind::Nudged { nudge: Nudge::FromLeft }, 1, 11.0);
        assert_eq!(effects.slap_of(Nudge::FromLeft, 11.0), 1.0);
        assert_eq!((effects.slap_of(Nudge::Forward, 11.0), effects.slap_of(Nudge::FromLeft, 12.0)), (0.0, 0.0));
        assert_eq!(effects.message(11.0), Some("DANGER"));
    }

    #[test]
    fn what_is_great_is_cheered_until_it_tilts() {
        let table = Table::shipped("classic").unwrap().unwrap();
        let mut effects = Effects::default();
        let mut note = |kind, now| {
            effects.note(&GameEvent { tick: 0, kind }, &table, 1, now);
            (effects.cheer(now + 0.5), effects.tilt(now + 0.5))
        };
        assert_eq!(note(GameEventKind::Lost { seat: 0 }, 1.0), (None, None));
        let great = table.rules.messages.iter().position(|text| is_great(text));
        let great = GameEventKind::Message { place: great.unwrap() as u16 };
        assert_eq!(note(great, 10.0), (Some(0.5), None));
        assert_eq!(note(GameEventKind::Lost { seat: 0 }, 14.0), (None, None));
        note(great, 20.0);
        assert_eq!(note(GameEventKind::Tilted { seat: 0 }, 20.5), (None, Some(0.5)));
    }

    #[test]
    fn a_ball_that_takes_the_place_of_a_locked_one_is_no_multiball() {
        let table = Table::shipped("classic").unwrap().unwrap();
        let mut effects = Effects::default();
        let added = GameEvent { tick: 0, kind: GameEventKind::Added { seat: 0 } };
        effects.note(&added, &table, 0, 10.0);
        assert_eq!(effects.message(10.0), None);
        effects.note(&added, &table, 1, 11.0);
        assert_eq!(effects.message(11.0), Some("MULTIBALL"));
        // Caught in the same frame in which another one is served for it.
        let mut effects = Effects::default();
        effects.note(&GameEvent { tick: 0, kind: GameEventKind::Held { element: 0 } }, &table, 1, 12.0);
        effects.note(&added, &table, 1, 12.0);
        assert_eq!(effects.message(12.0), None);
        effects.see(&[], 0.01, 12.1);
        effects.note(&added, &table, 1, 12.2);
        assert_eq!(effects.message(12.2), Some("MULTIBALL"));
        effects.note(&GameEvent { tick: 0, kind: GameEventKind::Saved { seat: 0 } }, &table, 1, 13.0);
        effects.note(&added, &table, 1, 13.0);
        assert_eq!(effects.message(13.0), Some("BALL SAVED"));
    }
}
