//! Makes the [`View`] of a frame out of what is to be seen of a game, who is there, and what the screen says.

use shared::game::{Nudge, Phase, Seat};
use shared::physics::TargetState;
use shared::physics::hinge::{HingeSpec, HingeState};
use shared::protocol::Mode;
use shared::table::{CrowdAction, Table};

use crate::effects::Effects;
use crate::film::Projector;
use crate::moment::{Moment, Motion};
use crate::overlay::overlay_of;
use crate::screens::{self, Words};
use crate::session::{Contestant, Session};
use crate::view::{
    BallView, CrowdActionState, CrowdActionView, CrowdView, ElementView, Hud, OtherBoard, SeatView, View,
};

/// In the order of [`View::slaps`].
const NUDGES: [Nudge; 3] = [Nudge::FromLeft, Nudge::FromRight, Nudge::Forward];
/// How far a pushed gate opens, radians, and how long it takes to fall shut, seconds.
const GATE_OPEN: f64 = 1.3;
const GATE_FALL: f64 = 0.35;
/// For how many seconds a light winks before it goes out by itself, and how often a second.
const WINK_SECONDS: f64 = 3.0;
const WINK_HZ: f64 = 2.5;

/// The view of a room; `with_overlay`: and of what the physics of its main board sees.
pub(crate) fn view_of(session: &mut Session, words: Words, now: f64, with_overlay: bool) -> View {
    let main = session.main_board();
    let mut view = room_board(session, main, words, now);
    let Some(moment) = session.moment(main) else { return view };
    fill_hud(&mut view.hud, session, &moment);
    // While the title is shown, or would be if a menu did not say it.
    let is_title = now % screens::TITLE.1 < screens::TITLE.0;
    view.light_show = screens::is_attract(session) && (view.hud.ball == 0 || is_title);
    view.overlay = with_overlay.then(|| overlay_of(&moment));
    if with_overlay {
        // Whoever wants to see the physics wants nothing in front of it; the display says the same.
        (view.hud.banner, view.hud.sub_banner, view.hud.alarm) = (String::new(), String::new(), None);
    }
    let others = (0..session.board_count()).filter(|&board| board != main);
    view.others = others.filter_map(|board| other_board(session, board, now)).collect();
    view
}

/// A board that is drawn small, and who plays it; `None` if nobody does.
fn other_board(session: &mut Session, board: usize, now: f64) -> Option<OtherBoard> {
    let mut view = room_board(session, board, Words::default(), now);
    // There they would be larger than what made them.
    view.popups.clear();
    let place = u8::try_from(board).ok();
    let one = session.contestants().iter().find(|one| one.place == place)?;
    let state = match session.moment(board).map(|moment| moment.game.phase()) {
        Some(Phase::Play { ball, .. }) => format!("BALL {ball}"),
        Some(Phase::Over) if one.plays => "DONE".to_owned(),
        _ => String::new(),
    };
    Some(OtherBoard { view, name: one.name.clone(), score: one.points, state })
}

/// What is to be seen on a board of a room.
fn room_board(session: &mut Session, board: usize, words: Words, now: f64) -> View {
    // What is to be seen borrows the session; what its events leave lies beside it meanwhile.
    let mut effects = session.effects_mut(board).map(std::mem::take).unwrap_or_default();
    let view = match session.moment(board) {
        Some(moment) => board_view(&moment, &mut effects, words, now),
        None => still_view(session.table(), words, now),
    };
    if let Some(place) = session.effects_mut(board) {
        *place = effects;
    }
    view
}

/// What is to be seen of a film.
pub(crate) fn film_view(projector: &Projector, effects: &mut Effects, words: Words, with_overlay: bool) -> View {
    let moment = projector.moment();
    let mut view = board_view(&moment, effects, words, projector.at_seconds());
    view.hud.title = "REPLAY".to_owned();
    let seats = moment.game.seats().iter().enumerate().filter(|(_, seat)| seat.playing);
    let seat_view = |(place, seat): (usize, &Seat)| SeatView {
        name: projector.film().name_of(place),
        score: seat.score.points,
        active: moment.game.phase().has_turn(place as u8),
        ..SeatView::default()
    };
    view.hud.seats = seats.map(seat_view).collect();
    fill_counters(&mut view.hud, &moment);
    view.overlay = with_overlay.then(|| overlay_of(&moment));
    view
}

/// What is to be seen on a board.
pub(crate) fn board_view(moment: &Moment<'_>, effects: &mut Effects, words: Words, now: f64) -> View {
    let table = moment.game.table();
    let mut view = still_view(table, words, now);
    effects.see(&moment.balls, table.file.ball.radius as f32, now);
    let ball_view = |ball: &Motion| BallView {
        position: ball.position.as_vec2(),
        velocity: ball.velocity.as_vec2(),
        floor: ball.floor,
        held: ball.is_held,
        orientation: effects.orientation_of(ball.id),
    };
    view.balls = moment.balls.iter().map(ball_view).collect();
    let flippers = table.scene.flippers.iter().zip(&moment.flippers);
    view.flippers = flippers.map(|(spec, swing)| (spec.rest - swing) as f32).collect();
    view.plungers = moment.plungers.iter().map(|&pull| pull as f32).collect();
    (view.popups, view.bursts) = (effects.popups(now), effects.bursts(now));
    view.cheer = effects.cheer(now);
    // Whoever came later has not seen when.
    view.tilt = screens::has_tilted(moment.game).then(|| effects.tilt(now).unwrap_or(f32::INFINITY));
    view.cabinet = moment.cabinet.as_vec2();
    view.slaps = NUDGES.map(|nudge| effects.slap_of(nudge, now));
    view.dimmed = moment.game.is_dimmed();
    if let Phase::Play { ball, .. } = moment.game.phase() {
        view.hud.ball = ball;
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
            let is_lit = moment.game.lights() >> place & 1 == 1;
            element.winks = is_lit && winks(moment.game.light_time_left(place));
            element.lit = is_lit && !element.winks;
        }
    }
    let magnets = table.scene.magnets.iter().zip(&moment.game.world().state().magnets);
    for (spec, &is_on) in magnets {
        if let Some(element) = view.elements.get_mut(usize::from(spec.element)) {
            element.lit = is_on;
        }
    }
    for (place, element) in view.elements.iter_mut().enumerate() {
        element.flash = effects.flash_of(place, now);
    }
    view
}

/// Whether a light with so many seconds left is dark for a moment: one that goes out by itself winks before it does.
fn winks(left: Option<f64>) -> bool {
    left.is_some_and(|left| left < WINK_SECONDS && (left * WINK_HZ).fract() < 0.5)
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
    hud.title = screens::title(session);
    hud.spectators = roster.spectators;
    hud.queue.clone_from(&roster.line);
    hud.waiting = roster.waiting.max(roster.line.len() as u32);
    hud.seats = session.contestants().iter().map(seat_view).collect();
    fill_counters(hud, moment);
    if session.mode() == Mode::Crowd
        && let Some(crowd) = moment.game.crowd()
    {
        hud.crowd = Some(crowd_view(session, moment, &crowd));
        hud.alarm = crowd.announced().and_then(|announced| {
            let action = crowd.rules().actions.get(usize::from(announced.action))?;
            let seconds = f64::from(announced.ticks) * moment.game.table().scene.tick_seconds;
            Some([format!("IN {:.0} S:", seconds.ceil()), action.name.clone()])
        });
    }
}

/// Ball, bonus and multiplier of whoever has the turn.
pub(crate) fn fill_counters(hud: &mut Hud, moment: &Moment<'_>) {
    if let Phase::Play { seat, .. } = moment.game.phase()
        && let Some(seat) = moment.game.seats().get(usize::from(seat))
    {
        (hud.bonus, hud.multiplier) = (seat.score.bonus, seat.score.multiplier);
    }
}

fn seat_view(one: &Contestant) -> SeatView {
    let Contestant { name, points, has_turn, is_you, wins, .. } = one;
    SeatView { name: name.clone(), score: *points, active: *has_turn, you: *is_you, wins: *wins }
}

fn crowd_view(session: &Session, moment: &Moment<'_>, crowd: &shared::game::CrowdView<'_>) -> CrowdView {
    let dt = moment.game.table().scene.tick_seconds;
    let seconds = |ticks: u32| (f64::from(ticks) * dt) as f32;
    let tally = session.tally();
    let action = |(place, action): (u8, &CrowdAction)| {
        let announced = crowd.announced().filter(|announced| announced.action == place);
        let state = match (announced, crowd.lasts_for(place), crowd.ready_in(place)) {
            (Some(announced), ..) => CrowdActionState::Announced(seconds(announced.ticks)),
            (None, 0, 0) if action.cost > crowd.energy() => CrowdActionState::TooDear,
            (None, 0, 0) => CrowdActionState::Ready,
            (None, 0, ready) => CrowdActionState::CoolsDown(seconds(ready)),
            (None, lasts, _) => CrowdActionState::AtWork(seconds(lasts)),
        };
        CrowdActionView {
            name: action.name.clone(),
            cost: action.cost.ceil() as u32,
            state,
            votes: tally.votes.get(usize::from(place)).copied().unwrap_or(0),
            yours: session.voted() == Some(place),
        }
    };
    let rules = crowd.rules();
    let tick = moment.at.tick as f64;
    CrowdView {
        energy: (crowd.energy() as u32, rules.most_energy as u32),
        actions: (0..).zip(&rules.actions).map(action).collect(),
        closes_in: tally.closes.map(|closes| ((closes as f64 - tick) * dt).max(0.0) as f32),
        can_vote: session.place().is_none(),
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn only_a_light_that_is_about_to_go_out_winks() {
        assert!(!winks(None) && !winks(Some(3.0)) && !winks(Some(20.1)));
        let dark = (0..300).filter(|&hundredths| winks(Some(f64::from(hundredths) / 100.0))).count();
        assert!((140..=160).contains(&dark), "{dark} of 300");
    }

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
