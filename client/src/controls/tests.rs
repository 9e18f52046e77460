//! What hands do becomes inputs with ticks.

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
