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
mod tests;
