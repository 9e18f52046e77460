//! Makes the [`View`] of a frame out of what is to be seen of a game, who is there, and what the screen says.

use shared::game::{Nudge, Phase};
use shared::physics::TargetState;
use shared::physics::hinge::{HingeSpec, HingeState};
use shared::table::Table;

use crate::moment::{Moment, Motion};
use crate::overlay::overlay_of;
use crate::screens::Words;
use crate::session::Session;
use crate::view::{BallView, ElementView, Hud, SeatView, View};

/// In the order of [`View::slaps`].
const NUDGES: [Nudge; 3] = [Nudge::FromLeft, Nudge::FromRight, Nudge::Forward];
/// How far a pushed gate opens, radians, and how long it takes to fall shut, seconds.
const GATE_OPEN: f64 = 1.3;
const GATE_FALL: f64 = 0.35;

/// The view of a game; `with_overlay`: and of what its physics sees.
pub(crate) fn view_of(session: &mut Session, words: Words, now: f64, with_overlay: bool) -> View {
    let popups = session.effects_mut().popups(now);
    let Some(moment) = session.moment() else { return still_view(session.table(), words, now) };
    let table = session.table();
    let mut view = still_view(table, words, now);
    let balls = moment.balls.iter();
    let ball_view = |ball: &Motion| BallView {
        position: ball.position.as_vec2(),
        velocity: ball.velocity.as_vec2(),
        floor: ball.floor,
        held: ball.is_held,
    };
    view.balls = balls.map(ball_view).collect();
    let flippers = table.scene.flippers.iter().zip(&moment.flippers);
    view.flippers = flippers.map(|(spec, swing)| (spec.rest - swing) as f32).collect();
    view.plungers = moment.plungers.iter().map(|&pull| pull as f32).collect();
    view.popups = popups;
    view.cabinet = moment.cabinet.as_vec2();
    view.slaps = NUDGES.map(|nudge| session.effects().slap_of(nudge, now));
    fill_hud(&mut view.hud, session, &moment);
    view.overlay = with_overlay.then(|| overlay_of(&moment));
    if with_overlay {
        // Whoever wants to see the physics wants nothing in front of it; the display says the same.
        (view.hud.banner, view.hud.sub_banner) = (String::new(), String::new());
    }

    let targets = table.targets.iter().zip(&moment.game.world().state().targets);
    for (&element, target) in targets {
        if let Some(element) = view.elements.get_mut(usize::from(element)) {
            element.down = *target == TargetState::Down;
        }
    }
    let hinges = table.scene.hinges.iter().zip(&moment.game.world().state().hinges);
    for (spec, hinge) in hinges {
        if let Some(element) = view.elements.get_mut(usize::from(spec.element)) {
            element.turn = turn_of(spec, hinge, moment.at.since(hinge.start, table.scene.tick_seconds)) as f32;
        }
    }
    for (place, &element) in table.lights.iter().enumerate() {
        if let Some(element) = view.elements.get_mut(usize::from(element)) {
            element.lit = moment.game.lights() >> place & 1 == 1;
        }
    }
    let magnets = table.scene.magnets.iter().zip(&moment.game.world().state().magnets);
    for (spec, &is_on) in magnets {
        if let Some(element) = view.elements.get_mut(usize::from(spec.element)) {
            element.lit = is_on;
        }
    }
    for (place, element) in view.elements.iter_mut().enumerate() {
        element.flash = session.effects().flash_of(place, now);
    }
    view
}

/// How far a plate is turned `t` seconds after its state began, radians. A spinner turns as the physics says; of a gate that
/// says only which way it was pushed: it swings open at once and falls shut.
fn turn_of(spec: &HingeSpec, hinge: &HingeState, t: f64) -> f64 {
    match spec.friction {
        Some(friction) => hinge.at(t, friction).0,
        None if hinge.speed == 0.0 => 0.0,
        None => GATE_OPEN.copysign(hinge.speed) * (1.0 - t / GATE_FALL).clamp(0.0, 1.0),
    }
}

/// The view of a table at which nothing happens.
pub(crate) fn still_view(table: &Table, words: Words, now: f64) -> View {
    let mut elements = vec![ElementView::default(); table.file.elements.len()];
    for (&element, stands) in table.targets.iter().zip(table.scene.targets_at_start()) {
        elements[usize::from(element)].down = !stands;
    }
    View {
        elements,
        flippers: table.scene.flippers.iter().map(|flipper| flipper.rest as f32).collect(),
        plungers: vec![0.0; table.scene.plungers.len()],
        hud: Hud {
            table: table.name.clone(),
            balls: table.rules.balls,
            multiplier: 1,
            message: words.message,
            keys: words.keys,
            banner: words.banner,
            sub_banner: words.sub_banner,
            ..Hud::default()
        },
        clock: now as f32,
        ..View::default()
    }
}

/// A view as it was, behind other words; a still one if there was none of that table.
pub(crate) fn over(view: View, table: &Table, words: Words, now: f64) -> View {
    if view.elements.len() != table.file.elements.len() {
        return still_view(table, words, now);
    }
    let Words { message, keys, banner, sub_banner } = words;
    View { hud: Hud { message, keys, banner, sub_banner, ..view.hud }, ..view }
}

fn fill_hud(hud: &mut Hud, session: &Session, moment: &Moment<'_>) {
    let roster = session.roster();
    hud.spectators = roster.spectators;
    hud.queue.clone_from(&roster.line);
    let phase = moment.game.phase();
    let seats = moment.game.seats();
    for ((seat, name), place) in seats.iter().zip(&roster.seats).zip(0_u8..) {
        if let Some(name) = name {
            hud.seats.push(SeatView {
                name: name.clone(),
                score: seat.score.points,
                active: phase.has_turn(place),
                you: session.seat() == Some(place),
            });
        }
    }
    if let Phase::Play { seat, ball, .. } = phase {
        hud.ball = ball;
        if let Some(seat) = seats.get(usize::from(seat)) {
            (hud.bonus, hud.multiplier) = (seat.score.bonus, seat.score.multiplier);
        }
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn a_still_table_has_a_place_for_everything() {
        let table = Table::shipped("classic").unwrap().unwrap();
        let words = Words { banner: "STARBALL".to_owned(), ..Words::default() };
        let view = still_view(&table, words, 1.0);
        assert_eq!(view.elements.len(), table.file.elements.len());
        assert_eq!(
            (view.flippers.len(), view.plungers.len()),
            (table.scene.flippers.len(), table.scene.plungers.len())
        );
        assert_eq!((view.hud.banner.as_str(), view.hud.balls), ("STARBALL", table.rules.balls));
    }
}
