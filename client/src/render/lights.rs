//! How bright an insert shines: as the rules say in a game; in waves while a light show runs; all together when something
//! great is cheered; not at all after a tilt. Decided from the [`View`] alone.

use macroquad::math::{Vec2, vec2};

use super::canvas::{noise, smooth};
use crate::view::{ElementView, View};

/// Seconds for which each pattern of a light show runs.
const PATTERN: f32 = 5.0;
/// How fast patterns run where nothing may strobe, as a share of their speed.
const SLOW: f32 = 0.22;
/// Seconds that the lamps take to go out after a tilt, and where nothing may strobe.
const OUT: (f32, f32) = (0.45, 1.5);
/// What is left of a flash where nothing may strobe.
const GLIMMER: f32 = 0.35;
/// Seconds for which inserts cheer.
const CHEER: f32 = 2.0;

/// An insert of a table.
#[derive(Debug, Clone, Copy, PartialEq)]
pub(super) struct Insert {
    /// Its place among the table's elements.
    pub(super) index: usize,
    /// Metres on the table.
    pub(super) center: Vec2,
    /// Of the table, metres.
    pub(super) table: Vec2,
}

/// How bright an insert shines, 0 to 1.
pub(super) fn brightness(view: &View, insert: Insert, state: ElementView) -> f32 {
    let lit = f32::from(u8::from(state.lit));
    if let Some(seconds) = view.tilt {
        return lit * (1.0 - lamps_out(seconds, view.reduced_flashing));
    }
    if view.light_show || view.hud.ball == 0 {
        return show(view, insert);
    }
    match view.cheer {
        Some(seconds) if seconds < CHEER => lit.max(cheer(seconds, insert, view.reduced_flashing)),
        _ => lit,
    }
}

/// The same view for who wants no flashing: what was hit only glimmers, and the table stands still.
pub(super) fn calmed(view: &View) -> View {
    let mut calmed = View { reduced_flashing: true, cabinet: Vec2::ZERO, ..view.clone() };
    calmed.slaps = view.slaps.map(|slap| slap * GLIMMER);
    for element in &mut calmed.elements {
        element.flash *= GLIMMER;
    }
    calmed
}

/// How far the lamps are out so many seconds after a tilt, 0 to 1: they flicker first.
pub(super) fn lamps_out(seconds: f32, reduced_flashing: bool) -> f32 {
    if reduced_flashing {
        return smooth(0.0, OUT.1, seconds);
    }
    let flicker = if seconds < OUT.0 && noise((seconds * 24.0) as i32, 5) > 0.55 { 0.55 } else { 0.0 };
    (smooth(0.0, OUT.0, seconds) - flicker).max(0.0)
}

/// Waves that run up the table, rings, sparkle and a beam that turns, one after the other.
fn show(view: &View, Insert { index, center, table }: Insert) -> f32 {
    let clock = view.clock * if view.reduced_flashing { SLOW } else { 1.0 };
    let middle = table * vec2(0.5, 0.6);
    let wave = |phase: f32| smooth(-0.25, 0.7, (phase * std::f32::consts::TAU).sin());
    // A cast saturates.
    match (clock / PATTERN) as u32 % 4 {
        0 => wave(clock * 0.55 - center.y * 1.7),
        1 => wave(clock * 0.7 - center.distance(middle) * 3.2),
        2 => {
            // Each insert in its own time.
            let own = noise(index as i32, 11);
            wave(clock * (0.45 + 0.35 * own) + own * 7.0)
        }
        _ => {
            let from = center - middle;
            wave(clock * 0.5 + from.x.atan2(from.y) / std::f32::consts::TAU)
        }
    }
}

/// Quick waves from below; or all inserts at once, up and down a single time.
fn cheer(seconds: f32, Insert { center, table, .. }: Insert, reduced_flashing: bool) -> f32 {
    let fade = smooth(CHEER, CHEER * 0.6, seconds);
    if reduced_flashing {
        return smooth(0.0, 0.7, seconds) * fade;
    }
    let phase = seconds * 2.6 - center.y / table.y.max(0.1) * 1.4;
    smooth(-0.2, 0.5, (phase * std::f32::consts::TAU).sin()) * fade
}

#[cfg(test)]
mod tests {
    use super::*;

    const TABLE: Vec2 = Vec2::new(0.514, 1.067);
    const LIT: ElementView = ElementView { lit: true, winks: false, down: false, turn: 0.0, flash: 0.0 };

    fn insert(index: usize) -> Insert {
        Insert { index, center: vec2(0.05 * index as f32, 0.1 * index as f32), table: TABLE }
    }

    fn in_play() -> View {
        let mut view = View::default();
        view.hud.ball = 1;
        view
    }

    /// The most by which an insert changes within a sixtieth of a second.
    fn quickest(mut view: View, seconds: f32, at: impl Fn(&mut View, f32)) -> f32 {
        let frames = (seconds * 60.0) as u16;
        let mut last: Option<Vec<f32>> = None;
        let mut quickest = 0.0_f32;
        for frame in 0..frames {
            at(&mut view, f32::from(frame) / 60.0);
            let now: Vec<f32> = (0..9).map(|index| brightness(&view, insert(index), LIT)).collect();
            assert!(now.iter().all(|level| (0.0..=1.0).contains(level)), "{now:?}");
            if let Some(last) = last {
                quickest = now.iter().zip(&last).map(|(a, b)| (a - b).abs()).fold(quickest, f32::max);
            }
            last = Some(now);
        }
        quickest
    }

    #[test]
    fn in_a_game_the_rules_decide() {
        assert_eq!(brightness(&in_play(), insert(1), LIT), 1.0);
        assert_eq!(brightness(&in_play(), insert(1), ElementView::default()), 0.0);
    }

    #[test]
    fn after_a_tilt_all_lamps_go_out_and_a_cheer_ends() {
        for reduced_flashing in [false, true] {
            let view = View { tilt: Some(2.0), cheer: Some(0.5), reduced_flashing, ..in_play() };
            assert_eq!(brightness(&view, insert(3), LIT), 0.0);
            let unlit = |seconds| {
                let view = View { cheer: Some(seconds), reduced_flashing, ..in_play() };
                (0..9).map(|index| brightness(&view, insert(index), ElementView::default())).fold(0.0, f32::max)
            };
            assert!(unlit(0.6) > 0.8 && unlit(CHEER) == 0.0);
        }
    }

    #[test]
    fn a_light_show_is_never_dark_nor_all_lit_for_long() {
        let sum = |clock: f32| -> f32 {
            let view = View { clock, light_show: true, ..in_play() };
            (0..9).map(|index| brightness(&view, insert(index), ElementView::default())).sum()
        };
        for second in 0_u8..20 {
            let mean = (0_u8..60).map(|frame| sum(f32::from(second) + f32::from(frame) / 60.0)).sum::<f32>() / 60.0;
            assert!((1.0..8.0).contains(&mean), "in second {second}: {mean} of 9");
        }
    }

    #[test]
    fn a_calmed_view_glimmers_and_stands_still() {
        let mut view = View { cabinet: vec2(0.001, 0.0), slaps: [1.0; 3], ..in_play() };
        view.elements = vec![ElementView { flash: 1.0, ..LIT }];
        let calmed = calmed(&view);
        assert!(calmed.reduced_flashing && calmed.cabinet == Vec2::ZERO && calmed.elements[0].lit);
        assert!(calmed.elements[0].flash < 0.5 && calmed.slaps.iter().all(|slap| *slap < 0.5));
    }

    #[test]
    fn reduced_flashing_fades_slowly() {
        let slow = View { reduced_flashing: true, ..in_play() };
        let tilt = quickest(slow.clone(), 3.0, |view, t| view.tilt = Some(t));
        let cheered = quickest(slow.clone(), 3.0, |view, t| view.cheer = Some(t));
        assert!(tilt < 0.04 && cheered < 0.06, "{tilt} {cheered}");
        // Within a pattern.
        let show = quickest(View { light_show: true, ..slow }, PATTERN / SLOW - 0.1, |view, t| view.clock = t);
        assert!(show < 0.05, "{show}");
        assert!(quickest(in_play(), 1.0, |view, t| view.tilt = Some(t)) > 0.2);
    }
}
