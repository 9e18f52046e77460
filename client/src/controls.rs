//! What a player's hands do, as inputs with ticks. Knows keys and pointers, but neither window nor clock.
//!
//! Every change of a button gets a tick of its own: a key that goes down and up within one frame is a tap of
//! [`TAP_TICKS`], not nothing. A nudge is no button: each press of its key is one slap, however long the key is held.

use macroquad::input::KeyCode;
use shared::game::{Action, Nudge};
use shared::protocol::{NUDGE_SECONDS, TAP_TICKS};

use crate::pointer::Pointer;
use crate::settings::{Bindings, Control};

/// Seconds that the plunger's key is held for a full pull.
const PULL_SECONDS: f64 = 1.0;
/// Share of the pull that the slightest touch of the key gives: a tap moves the ball a little.
const LEAST_PULL: f64 = 0.08;
/// Seconds between two changes of the pull: a hand's tremor need not be sent.
const PULL_EVERY: f64 = 0.02;
/// Seconds between two nudges: somewhat more than the server asks for, since the ticks of a prediction are not spaced as
/// evenly as the frames.
const NUDGE_EVERY: f64 = 1.2 * NUDGE_SECONDS;

/// What a hand presses.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub(crate) enum Source {
    /// A key.
    Key(KeyCode),
    /// A finger, or a button of the mouse.
    Pointer(Pointer),
}

/// A button: something that is held.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
enum Part {
    Left,
    Right,
    Plunger,
}

const PARTS: [Part; 3] = [Part::Left, Part::Right, Part::Plunger];

/// What a control is to the game.
enum Kind {
    Button(Part),
    Nudge(Nudge),
}

fn kind_of(control: Control) -> Kind {
    match control {
        Control::LeftFlipper => Kind::Button(Part::Left),
        Control::RightFlipper => Kind::Button(Part::Right),
        Control::Plunger => Kind::Button(Part::Plunger),
        Control::NudgeLeft => Kind::Nudge(Nudge::FromLeft),
        Control::NudgeRight => Kind::Nudge(Nudge::FromRight),
        Control::NudgeForward => Kind::Nudge(Nudge::Forward),
    }
}

/// A button and what works it.
#[derive(Debug, Clone, Default)]
struct Button {
    /// What is down.
    held: Vec<Source>,
    /// What the game was told.
    told: bool,
    /// The tick after which the next change may come.
    after: u64,
}

/// The hands of one player.
#[derive(Debug, Default)]
pub(crate) struct Controls {
    bindings: Bindings,
    buttons: [Button; PARTS.len()],
    /// Changes since the last frame, in order.
    changes: Vec<(Part, bool)>,
    /// What is down for nudges.
    nudge_keys: Vec<Source>,
    /// Nudges since the last frame, in order.
    nudges: Vec<Nudge>,
    /// When the last one was given, seconds.
    nudged_at: Option<f64>,
    /// Since when the plunger is held, and the share that was told last and when.
    pull: Option<Pull>,
    /// How far the plunger is drawn by a pointer, 0 to 1; otherwise it is pulled farther while its key is held.
    drawn: Option<f64>,
    /// It was the player's turn in the last frame.
    active: bool,
}

#[derive(Debug, Clone, Copy)]
struct Pull {
    since: f64,
    told: u16,
    told_at: f64,
}

impl Controls {
    /// Hands on such keys.
    pub(crate) fn new(bindings: Bindings) -> Self {
        Self { bindings, ..Self::default() }
    }

    /// Other keys from now on.
    pub(crate) fn bind(&mut self, bindings: Bindings) {
        self.release_all();
        self.bindings = bindings;
    }

    /// A key went down. The keyboard's own repeats are no news.
    pub(crate) fn key_down(&mut self, key: KeyCode) {
        if let Some(control) = self.bindings.control_of(key) {
            self.press(control, Source::Key(key));
        }
    }

    /// A key went up.
    pub(crate) fn key_up(&mut self, key: KeyCode) {
        self.release(Source::Key(key));
    }

    /// A control is pressed.
    pub(crate) fn press(&mut self, control: Control, source: Source) {
        match kind_of(control) {
            Kind::Nudge(nudge) if !self.nudge_keys.contains(&source) => {
                self.nudge_keys.push(source);
                self.nudges.push(nudge);
            }
            Kind::Nudge(_) => {}
            Kind::Button(part) => {
                let held = &mut self.buttons[part as usize].held;
                if held.is_empty() {
                    self.changes.push((part, true));
                    if part == Part::Plunger {
                        self.drawn = None;
                    }
                }
                if !held.contains(&source) {
                    held.push(source);
                }
            }
        }
    }

    /// The plunger is drawn by hand, by a share of its way.
    pub(crate) fn draw_plunger(&mut self, share: f64, source: Source) {
        self.press(Control::Plunger, source);
        self.drawn = Some(share);
    }

    /// Whether a source presses a control.
    pub(crate) fn holds(&self, control: Control, source: Source) -> bool {
        match kind_of(control) {
            Kind::Nudge(_) => self.nudge_keys.contains(&source),
            Kind::Button(part) => self.buttons[part as usize].held.contains(&source),
        }
    }

    /// What was pressed is let go. A button that is pressed twice is released with the second.
    pub(crate) fn release(&mut self, source: Source) {
        self.nudge_keys.retain(|held| *held != source);
        for part in PARTS {
            let held = &mut self.buttons[part as usize].held;
            if held.contains(&source) {
                held.retain(|held| *held != source);
                if held.is_empty() {
                    self.changes.push((part, false));
                }
            }
        }
    }

    /// Keyboard and pointers are somebody else's now: everything is let go.
    pub(crate) fn release_all(&mut self) {
        self.nudge_keys.clear();
        for part in PARTS {
            if !std::mem::take(&mut self.buttons[part as usize].held).is_empty() {
                self.changes.push((part, false));
            }
        }
    }

    /// Nothing can be done in this frame, as the game stands still: of what the hands do meanwhile, what they hold in the end
    /// counts.
    pub(crate) fn wait(&mut self) {
        self.nudges.clear();
        let Self { buttons, changes, .. } = self;
        let held = |part: Part| !buttons[part as usize].held.is_empty();
        changes.clear();
        changes
            .extend(PARTS.into_iter().filter(|&part| held(part) != buttons[part as usize].told).map(|p| (p, held(p))));
    }

    /// What to do at which tick, in a frame at `now` seconds, in which inputs can act from `tick` on. Only who has the
    /// turn (`active`) does anything; what is held when the turn begins acts from then on.
    pub(crate) fn frame(&mut self, now: f64, tick: u64, active: bool, mut act: impl FnMut(u64, Action)) {
        let mut changes = std::mem::take(&mut self.changes);
        let nudges = std::mem::take(&mut self.nudges);
        if active != self.active {
            self.active = active;
            (self.pull, self.nudged_at) = (None, None);
            for button in &mut self.buttons {
                *button = Button { held: std::mem::take(&mut button.held), ..Button::default() };
            }
            let held = PARTS.into_iter().filter(|&part| !self.buttons[part as usize].held.is_empty());
            changes = held.map(|part| (part, true)).collect();
        }
        if !active {
            return;
        }
        for nudge in nudges {
            // Two hands at once are one slap: the server lets no more through.
            if self.nudged_at.is_none_or(|at| now - at >= NUDGE_EVERY) {
                self.nudged_at = Some(now);
                act(tick, Action::Nudge(nudge));
            }
        }
        let mut changed = [false; PARTS.len()];
        for (part, pressed) in changes {
            let button = &mut self.buttons[part as usize];
            if button.told == pressed {
                continue;
            }
            button.told = pressed;
            // A second change in one frame happened some milliseconds after the first; in a later frame, later.
            let changed = &mut changed[part as usize];
            let at = tick.max(button.after + if *changed { TAP_TICKS - 1 } else { 0 });
            *changed = true;
            button.after = at + 1;
            match part {
                Part::Left => act(at, Action::Flipper { right: false, pressed }),
                Part::Right => act(at, Action::Flipper { right: true, pressed }),
                Part::Plunger if pressed => {
                    let pull = Pull { since: now, told: share(self.drawn.unwrap_or(0.0)), told_at: now };
                    self.pull = Some(pull);
                    act(at, Action::Pull(pull.told));
                }
                Part::Plunger => {
                    self.pull = None;
                    act(at, Action::Release);
                }
            }
        }
        if let Some(pull) = &mut self.pull {
            let share = share(self.drawn.unwrap_or((now - pull.since) / PULL_SECONDS));
            if share != pull.told && now - pull.told_at >= PULL_EVERY {
                (pull.told, pull.told_at) = (share, now);
                let after = &mut self.buttons[Part::Plunger as usize].after;
                let at = tick.max(*after);
                *after = at + 1;
                act(at, Action::Pull(share));
            }
        }
    }
}

/// How far the plunger is pulled by a part of a hand's way, in 65535ths.
fn share(part: f64) -> u16 {
    let share = LEAST_PULL + (1.0 - LEAST_PULL) * part.clamp(0.0, 1.0);
    (share * f64::from(u16::MAX)) as u16
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::settings::keys::Key;

    const LEFT: Action = Action::Flipper { right: false, pressed: true };
    const LEFT_UP: Action = Action::Flipper { right: false, pressed: false };
    const RIGHT: Action = Action::Flipper { right: true, pressed: true };

    fn active() -> Controls {
        let mut controls = Controls::default();
        assert!(frame(&mut controls, 0.0, 0).is_empty());
        controls
    }

    fn frame(controls: &mut Controls, now: f64, tick: u64) -> Vec<(u64, Action)> {
        let mut acts = Vec::new();
        controls.frame(now, tick, true, |tick, action| acts.push((tick, action)));
        acts
    }

    #[test]
    fn a_tap_within_one_frame_lasts() {
        let mut controls = active();
        controls.key_down(KeyCode::Z);
        controls.key_up(KeyCode::Z);
        controls.key_down(KeyCode::Z);
        let acts = frame(&mut controls, 1.0, 100);
        assert_eq!(acts, [(100, LEFT), (100 + TAP_TICKS, LEFT_UP), (100 + 2 * TAP_TICKS, LEFT)]);
        // The next frame comes before those ticks: order is kept.
        controls.key_up(KeyCode::Z);
        assert_eq!(frame(&mut controls, 1.001, 101), [(101 + 2 * TAP_TICKS, LEFT_UP)]);
    }

    #[test]
    fn keys_are_what_they_are_bound_to() {
        let mut bindings = Bindings::default();
        bindings.rebind(Control::LeftFlipper, vec![Key::of(KeyCode::O).unwrap()]).unwrap();
        bindings.rebind(Control::NudgeForward, vec![Key::of(KeyCode::LeftShift).unwrap()]).unwrap();
        let mut controls = Controls::new(bindings);
        frame(&mut controls, 0.0, 0);
        for key in [KeyCode::Z, KeyCode::W, KeyCode::O, KeyCode::LeftShift] {
            controls.key_down(key);
        }
        assert_eq!(frame(&mut controls, 1.0, 100), [(100, Action::Nudge(Nudge::Forward)), (100, LEFT)]);
    }

    #[test]
    fn order_between_buttons_and_frames_is_kept() {
        let mut controls = active();
        controls.key_down(KeyCode::LeftShift);
        controls.key_down(KeyCode::RightShift);
        assert_eq!(frame(&mut controls, 1.0, 100), [(100, LEFT), (100, RIGHT)]);
        controls.key_up(KeyCode::LeftShift);
        assert_eq!(frame(&mut controls, 1.1, 200), [(200, LEFT_UP)]);
    }

    #[test]
    fn of_what_is_pressed_in_a_pause_the_end_counts() {
        let mut controls = active();
        controls.key_down(KeyCode::LeftShift);
        controls.key_down(KeyCode::Space);
        assert_eq!(frame(&mut controls, 1.0, 100).len(), 2);
        controls.key_up(KeyCode::LeftShift);
        for _ in 0..3 {
            controls.key_down(KeyCode::Q);
            controls.key_down(KeyCode::RightShift);
            controls.wait();
            controls.key_up(KeyCode::RightShift);
            controls.wait();
        }
        // The plunger was held all the time, and the game's time stood still.
        assert_eq!(frame(&mut controls, 1.0, 101), [(101, LEFT_UP)]);
    }

    #[test]
    fn two_keys_of_a_flipper_are_one_button() {
        let mut controls = active();
        controls.key_down(KeyCode::Left);
        controls.key_down(KeyCode::A);
        controls.key_down(KeyCode::A);
        controls.key_up(KeyCode::Left);
        assert_eq!(frame(&mut controls, 1.0, 100), [(100, LEFT)]);
        controls.key_up(KeyCode::A);
        controls.key_up(KeyCode::A);
        assert_eq!(frame(&mut controls, 1.1, 200), [(200, LEFT_UP)]);
    }

    #[test]
    fn lost_focus_releases_and_late_key_ups_are_nothing() {
        let mut controls = active();
        controls.key_down(KeyCode::Left);
        controls.key_down(KeyCode::Space);
        frame(&mut controls, 1.0, 100);
        controls.release_all();
        assert_eq!(frame(&mut controls, 1.1, 200), [(200, LEFT_UP), (200, Action::Release)]);
        controls.key_up(KeyCode::Left);
        controls.key_up(KeyCode::Space);
        assert!(frame(&mut controls, 1.2, 300).is_empty());
    }

    #[test]
    fn the_pull_grows_while_the_key_is_held() {
        let mut controls = active();
        controls.key_down(KeyCode::Space);
        let mut pulls = Vec::new();
        for k in 0..150_u32 {
            for (tick, action) in frame(&mut controls, f64::from(k) * 0.011, u64::from(k) * 11) {
                let Action::Pull(share) = action else { panic!("{action:?} at {tick}") };
                pulls.push((tick, share));
            }
        }
        assert!(pulls.windows(2).all(|pair| pair[0].1 < pair[1].1 && pair[1].0 >= pair[0].0 + 20), "{pulls:?}");
        assert!((45..=52).contains(&pulls.len()) && pulls.last().unwrap().1 == u16::MAX, "{pulls:?}");
        controls.key_up(KeyCode::Space);
        assert_eq!(frame(&mut controls, 1.5, 1500), [(1500, Action::Release)]);
    }

    #[test]
    fn each_press_of_a_nudge_is_one_and_repeats_are_no_news() {
        let mut controls = active();
        for (now, key, nudge) in [
            (1.0, KeyCode::Q, Nudge::FromLeft),
            (2.0, KeyCode::E, Nudge::FromRight),
            (3.0, KeyCode::W, Nudge::Forward),
            (4.0, KeyCode::Up, Nudge::Forward),
        ] {
            controls.key_down(key);
            controls.key_down(key);
            assert_eq!(frame(&mut controls, now, 100), [(100, Action::Nudge(nudge))]);
            controls.key_down(key);
            assert!(frame(&mut controls, now + 0.5, 600).is_empty(), "held, it is no other one");
            controls.key_up(key);
        }
        // Sooner than a hand can slap again: one. And a button beside them is not held up.
        for key in [KeyCode::Q, KeyCode::Z, KeyCode::E] {
            controls.key_down(key);
        }
        assert_eq!(frame(&mut controls, 5.0, 1000), [(1000, Action::Nudge(Nudge::FromLeft)), (1000, LEFT)]);
        controls.release_all();
        controls.key_down(KeyCode::E);
        let acts = frame(&mut controls, 5.1, 1060);
        assert_eq!(acts, [(1060, Action::Nudge(Nudge::FromRight)), (1060, LEFT_UP)]);
    }

    #[test]
    fn a_nudge_before_the_turn_is_nothing() {
        let mut controls = Controls::default();
        controls.key_down(KeyCode::Q);
        controls.frame(1.0, 100, false, |_, _| panic!("not the player's turn"));
        assert!(frame(&mut controls, 2.0, 200).is_empty());
    }

    #[test]
    fn what_is_held_when_the_turn_begins_acts_then() {
        let mut controls = Controls::default();
        controls.key_down(KeyCode::Space);
        controls.frame(1.0, 100, false, |_, _| panic!("not the player's turn"));
        controls.key_down(KeyCode::D);
        controls.frame(1.1, 110, false, |_, _| panic!("not the player's turn"));
        let acts = frame(&mut controls, 2.0, 200);
        assert_eq!(acts, [(200, RIGHT), (200, Action::Pull(share(0.0)))]);
        // And what is held when it ends is over.
        controls.frame(3.0, 300, false, |_, _| panic!("not the player's turn"));
        controls.key_up(KeyCode::D);
        controls.key_up(KeyCode::Space);
        assert!(frame(&mut controls, 4.0, 400).is_empty());
    }
}
