//! What a mouse and fingers do while somebody plays, as presses of controls. Knows places of a window in pixels, but no
//! window.
//!
//! A finger works the flipper of its half of the window, a mouse the flipper of its button. While a ball waits for the
//! plunger, whoever presses in the lower right quarter and drags down pulls the plunger along, and lets go by letting go.

use macroquad::input::MouseButton;
use macroquad::math::Vec2;

use crate::controls::{Controls, Source};
use crate::settings::Control;

/// Share of the window's height over which the plunger is dragged for a full pull; less where the window ends before.
const FULL_DRAG: f32 = 0.25;
/// Share of the window's height below which a drag is none: a hand's tremor must not launch.
const LEAST_DRAG: f32 = 0.015;
/// The least that a full pull takes, as such a share, however low it began.
const SHORTEST_DRAG: f32 = 0.08;

/// What presses.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub(crate) enum Pointer {
    /// A button of the mouse.
    Mouse(MouseButton),
    /// A finger, by its number.
    Finger(u64),
}

/// What is under the pointers.
#[derive(Debug, Clone, Copy, PartialEq)]
pub(crate) struct Surface {
    /// Size of the window, pixels.
    pub(crate) size: Vec2,
    /// A ball waits for the plunger.
    pub(crate) ball_waits: bool,
}

/// The mouse and the fingers of one player.
#[derive(Debug, Default)]
pub(crate) struct Pointers {
    /// Which pointers drag the plunger, and the height at which each began.
    drags: Vec<(Pointer, f32)>,
}

impl Pointers {
    /// A pointer was pressed at a place.
    pub(crate) fn down(&mut self, controls: &mut Controls, surface: Surface, pointer: Pointer, at: Vec2) {
        let is_right = at.x >= surface.size.x / 2.0;
        let is_low = at.y >= surface.size.y / 2.0;
        let can_drag = matches!(pointer, Pointer::Finger(_) | Pointer::Mouse(MouseButton::Left));
        if surface.ball_waits && can_drag && is_right && is_low {
            self.drags.push((pointer, at.y));
            return;
        }
        let control = match pointer {
            Pointer::Finger(_) if is_right => Control::RightFlipper,
            Pointer::Finger(_) | Pointer::Mouse(MouseButton::Left) => Control::LeftFlipper,
            Pointer::Mouse(MouseButton::Right) => Control::RightFlipper,
            Pointer::Mouse(MouseButton::Middle) => Control::Plunger,
            Pointer::Mouse(MouseButton::Unknown) => return,
        };
        controls.press(control, Source::Pointer(pointer));
    }

    /// A pointer moved to a place.
    pub(crate) fn moved(&self, controls: &mut Controls, surface: Surface, pointer: Pointer, at: Vec2) {
        let Some(&(_, from)) = self.drags.iter().find(|(dragging, _)| *dragging == pointer) else { return };
        let height = surface.size.y;
        let full = (FULL_DRAG * height).min(height - from).max(SHORTEST_DRAG * height).max(1.0);
        let way = at.y - from;
        if way >= LEAST_DRAG * height || controls.holds(Control::Plunger, Source::Pointer(pointer)) {
            controls.draw_plunger(f64::from(way / full), Source::Pointer(pointer));
        }
    }

    /// A pointer was let go.
    pub(crate) fn up(&mut self, controls: &mut Controls, pointer: Pointer) {
        self.drags.retain(|(dragging, _)| *dragging != pointer);
        controls.release(Source::Pointer(pointer));
    }

    /// All were let go, or are somebody else's now.
    pub(crate) fn forget(&mut self) {
        self.drags.clear();
    }
}

#[cfg(test)]
mod tests {
    use macroquad::math::vec2;
    use shared::game::Action;

    use super::*;

    const LEFT: Pointer = Pointer::Mouse(MouseButton::Left);
    const TABLE: Surface = Surface { size: vec2(1000.0, 800.0), ball_waits: false };
    const WAITING: Surface = Surface { ball_waits: true, ..TABLE };

    fn hands() -> (Pointers, Controls) {
        let mut controls = Controls::default();
        act(&mut controls, 0.0);
        (Pointers::default(), controls)
    }

    fn act(controls: &mut Controls, now: f64) -> Vec<Action> {
        let mut actions = Vec::new();
        controls.frame(now, (now * 1000.0) as u64, true, |_, action| actions.push(action));
        actions
    }

    fn flipper(right: bool, pressed: bool) -> Action {
        Action::Flipper { right, pressed }
    }

    #[test]
    fn each_half_of_the_window_is_a_flipper_for_each_finger() {
        let (mut pointers, mut controls) = hands();
        pointers.down(&mut controls, TABLE, Pointer::Finger(7), vec2(100.0, 700.0));
        pointers.down(&mut controls, TABLE, Pointer::Finger(8), vec2(900.0, 100.0));
        pointers.down(&mut controls, TABLE, Pointer::Finger(9), vec2(800.0, 700.0));
        assert_eq!(act(&mut controls, 1.0), [flipper(false, true), flipper(true, true)]);
        // Where a finger goes meanwhile is nothing; a flipper with two fingers on it falls with the second.
        pointers.moved(&mut controls, TABLE, Pointer::Finger(7), vec2(900.0, 700.0));
        pointers.up(&mut controls, Pointer::Finger(8));
        assert_eq!(act(&mut controls, 2.0), []);
        pointers.up(&mut controls, Pointer::Finger(9));
        pointers.up(&mut controls, Pointer::Finger(7));
        assert_eq!(act(&mut controls, 3.0), [flipper(true, false), flipper(false, false)]);
    }

    #[test]
    fn a_mouse_has_a_flipper_on_each_button_wherever_it_is() {
        let (mut pointers, mut controls) = hands();
        pointers.down(&mut controls, TABLE, LEFT, vec2(900.0, 700.0));
        pointers.down(&mut controls, WAITING, Pointer::Mouse(MouseButton::Right), vec2(900.0, 700.0));
        assert_eq!(act(&mut controls, 1.0), [flipper(false, true), flipper(true, true)]);
        pointers.up(&mut controls, LEFT);
        assert_eq!(act(&mut controls, 2.0), [flipper(false, false)]);
        pointers.down(&mut controls, WAITING, Pointer::Mouse(MouseButton::Middle), vec2(100.0, 100.0));
        assert!(matches!(act(&mut controls, 3.0)[..], [Action::Pull(_)]));
        pointers.up(&mut controls, Pointer::Mouse(MouseButton::Middle));
        assert_eq!(act(&mut controls, 4.0), [Action::Release]);
    }

    #[test]
    fn a_drag_pulls_in_proportion_and_launches_when_it_ends() {
        for pointer in [LEFT, Pointer::Finger(3)] {
            let (mut pointers, mut controls) = hands();
            pointers.down(&mut controls, WAITING, pointer, vec2(700.0, 500.0));
            pointers.moved(&mut controls, WAITING, pointer, vec2(700.0, 505.0));
            assert_eq!(act(&mut controls, 1.0), [], "a tremor");
            let mut pulls = Vec::new();
            for (k, y) in [550.0, 600.0, 650.0, 900.0, 600.0].into_iter().enumerate() {
                pointers.moved(&mut controls, WAITING, pointer, vec2(650.0, y));
                let acts = act(&mut controls, 2.0 + k as f64);
                let [Action::Pull(share)] = acts[..] else { panic!("{acts:?}") };
                pulls.push(f64::from(share) / f64::from(u16::MAX));
            }
            assert!(0.2 < pulls[0] && pulls[0] < pulls[1] && pulls[1] < pulls[2], "{pulls:?}");
            assert_eq!((pulls[3], pulls[4]), (1.0, pulls[1]));
            // Also when the ball has been pushed off its place meanwhile.
            pointers.up(&mut controls, pointer);
            assert_eq!(act(&mut controls, 9.0), [Action::Release]);
        }
    }

    #[test]
    fn without_a_drag_nothing_is_launched() {
        let (mut pointers, mut controls) = hands();
        pointers.down(&mut controls, WAITING, Pointer::Finger(1), vec2(700.0, 500.0));
        pointers.up(&mut controls, Pointer::Finger(1));
        assert_eq!(act(&mut controls, 1.0), []);
        // One that began elsewhere is the right flipper.
        pointers.down(&mut controls, WAITING, Pointer::Finger(1), vec2(700.0, 100.0));
        assert_eq!(act(&mut controls, 2.0), [flipper(true, true)]);
    }

    #[test]
    fn a_drag_from_the_lowest_edge_has_a_full_pull_within_reach() {
        let (mut pointers, mut controls) = hands();
        pointers.down(&mut controls, WAITING, LEFT, vec2(700.0, 790.0));
        pointers.moved(&mut controls, WAITING, LEFT, vec2(700.0, 860.0));
        assert_eq!(act(&mut controls, 1.0), [Action::Pull(u16::MAX)]);
        controls.release_all();
        pointers.forget();
        pointers.moved(&mut controls, WAITING, LEFT, vec2(700.0, 700.0));
        assert_eq!(act(&mut controls, 2.0), [Action::Release]);
    }
}
