//! The crowd against the bot on Classic: what it buys is announced, acts and is undone, in time and bit for bit.

use std::sync::Arc;

use glam::DVec2;

use super::crowd::CrowdState;
use super::replay::{Recorder, Replay};
use super::{Action, Announced, Bot, Game, GameEventKind, HOUSE, Input, Nudge, Phase, Why};
use crate::math::Rng;
use crate::physics::TargetState;
use crate::physics::ball::{Instant, Support};
use crate::rules::BallSave;
use crate::table::{CrowdRules, SHIPPED, Table};

fn classic() -> Arc<Table> {
    match Table::shipped("classic") {
        Some(Ok(table)) => Arc::new(table),
        other => panic!("{other:?}"),
    }
}

fn rules(game: &Game) -> CrowdRules {
    game.table().rules.crowd.clone().unwrap_or_else(|| panic!("Classic has a crowd"))
}

fn place_of(game: &Game, name: &str) -> u8 {
    let place = rules(game).actions.iter().position(|action| action.name == name);
    place.unwrap_or_else(|| panic!("the crowd has no {name}")) as u8
}

fn act(game: &mut Game, seat: u8, action: Action) -> Vec<GameEventKind> {
    let input = Input { tick: game.tick(), seat, action };
    game.step(&[input]).iter().map(|event| event.kind).collect()
}

fn wait(game: &mut Game, ticks: u32) -> Vec<GameEventKind> {
    (0..ticks).flat_map(|_| game.step(&[]).iter().map(|event| event.kind).collect::<Vec<_>>()).collect()
}

fn energy(game: &Game) -> f64 {
    game.crowd().map_or(f64::NAN, |crowd| crowd.energy())
}

/// A game whose ball lies in the cradle of the left flipper, which is held.
fn cradled() -> Game {
    let mut game = Game::new(classic());
    act(&mut game, 0, Action::Sit);
    act(&mut game, 0, Action::Start);
    wait(&mut game, 1000);
    act(&mut game, 0, Action::Flipper { right: false, pressed: true });
    place_ball(&mut game, DVec2::new(0.165, 0.205), DVec2::ZERO);
    game
}

fn place_ball(game: &mut Game, position: DVec2, velocity: DVec2) {
    let mut state = game.state();
    let tick = state.world.tick;
    let ball = &mut state.world.balls[0];
    ball.flight.start = Instant::start_of(tick);
    (ball.flight.position, ball.flight.velocity) = (position, velocity);
    ball.flight.acceleration = game.table().scene.gravity;
    (ball.support, ball.past, ball.spin) = (Support::None, None, 0.0);
    state.play.rules.save = BallSave::default();
    assert_eq!(game.restore(state), Ok(()));
}

/// Lets the ball fall between the flippers.
fn lose_ball(game: &mut Game) {
    place_ball(game, DVec2::new(0.237, 0.1), DVec2::new(0.0, -1.0));
    assert!(wait(game, 200).contains(&GameEventKind::Lost { seat: 0 }));
}

#[test]
fn energy_grows_while_a_ball_is_in_play_up_to_its_most() {
    let mut game = Game::new(classic());
    wait(&mut game, 500);
    assert_eq!((energy(&game), game.can_crowd(0)), (0.0, Err(Why::NoBall)));
    act(&mut game, 0, Action::Sit);
    act(&mut game, 0, Action::Start);
    wait(&mut game, 5000);
    assert_eq!((energy(&game), game.can_crowd(0)), (0.0, Err(Why::NoBall)), "it waits at the plunger");
    let mut game = cradled();
    let before = energy(&game);
    wait(&mut game, 2500);
    assert!((energy(&game) - before - 2.5).abs() < 1e-9);
    assert_eq!(game.can_crowd(0), Err(Why::Energy));
    wait(&mut game, 25_000);
    assert_eq!(energy(&game), rules(&game).most_energy);
    assert_eq!((game.can_crowd(0), game.can_crowd(99)), (Ok(()), Err(Why::Unknown)));
}

#[test]
fn an_action_is_paid_announced_done_and_undone() {
    let mut game = cradled();
    wait(&mut game, 25_000);
    let place = place_of(&game, "RAISE THE POST");
    let action = rules(&game).actions[usize::from(place)].clone();
    let post = game.table().file.elements.iter().position(|element| element.name() == "house post").unwrap() as u16;
    let post = game.table().targets.iter().position(|&target| target == post).unwrap();
    let stands = |game: &Game| game.world().state().targets[post] == TargetState::Up;
    for seat in [0, 3, 254] {
        assert_eq!(act(&mut game, seat, Action::Crowd(place)), [], "it is nobody's but the house's");
    }
    let before = energy(&game);
    assert_eq!(act(&mut game, HOUSE, Action::Crowd(place)), [GameEventKind::Announced { action: place }]);
    assert!((before - action.cost - energy(&game)).abs() < 0.002);
    assert_eq!(game.can_crowd(0), Err(Why::Announced));
    assert_eq!(act(&mut game, HOUSE, Action::Crowd(0)), [], "one at a time");
    assert_eq!(wait(&mut game, 1998), []);
    assert_eq!(game.crowd().and_then(|crowd| crowd.announced()), Some(Announced { action: place, ticks: 1 }));
    assert!(!stands(&game));
    assert_eq!(wait(&mut game, 1), [GameEventKind::Acted { action: place }]);
    let seen = game.crowd().map(|crowd| (crowd.announced(), crowd.points(), crowd.lasts_for(place)));
    assert!(seen == Some((None, action.points, 6000)) && stands(&game), "{seen:?}");
    assert_eq!(game.can_crowd(place), Err(Why::AtWork));
    assert_eq!(wait(&mut game, 5999), []);
    assert!(stands(&game));
    assert_eq!(wait(&mut game, 1), [GameEventKind::Undone { action: place }]);
    let seen = game.crowd().map(|crowd| (crowd.lasts_for(place), crowd.ready_in(place)));
    assert!(seen == Some((0, 15_000)) && !stands(&game), "{seen:?}");
    assert_eq!(game.can_crowd(place), Err(Why::CoolsDown));
    wait(&mut game, 15_000);
    assert_eq!(game.can_crowd(place), Ok(()));
}

#[test]
fn lights_are_dimmed_for_as_long_as_they_should() {
    let mut game = cradled();
    wait(&mut game, 10_000);
    let place = place_of(&game, "DIM THE LIGHTS");
    act(&mut game, HOUSE, Action::Crowd(place));
    let dimmed = (0..20_000).filter(|_| !wait(&mut game, 1).contains(&GameEventKind::Over) && game.is_dimmed()).count();
    assert_eq!(dimmed, 8000);
}

type End = fn(&mut Game);

#[test]
fn a_turn_s_end_or_a_tilt_undoes_everything_and_a_lost_ball_pays_the_crowd() {
    let ends: [(&str, End); 3] = [
        ("given up", |game| drop(act(game, 0, Action::Forfeit))),
        ("lost", lose_ball),
        ("tilted", |game| {
            for _ in 0..40 {
                act(game, 0, Action::Nudge(Nudge::Forward));
                wait(game, if game.tilt().tilted { 0 } else { 170 });
            }
            assert!(game.tilt().tilted);
        }),
    ];
    for (what, end) in ends {
        let mut game = cradled();
        wait(&mut game, 22_000);
        let (dim, orbit) = (place_of(&game, "DIM THE LIGHTS"), place_of(&game, "NARROW THE ORBIT"));
        let points = rules(&game).actions[usize::from(orbit)].points;
        act(&mut game, HOUSE, Action::Crowd(orbit));
        wait(&mut game, 2500);
        act(&mut game, HOUSE, Action::Crowd(dim));
        end(&mut game);
        let Some(crowd) = game.crowd() else { panic!("it is still there") };
        assert_eq!((crowd.announced(), crowd.lasts_for(orbit)), (None, 0), "{what}");
        assert!(crowd.ready_in(orbit) > 0, "{what}: it cools down");
        let per_ball = if what == "lost" { rules(&game).points_per_ball } else { 0 };
        // Until the game tilts the lights are dimmed as well.
        let dims = if what == "tilted" { rules(&game).actions[usize::from(dim)].points } else { 0 };
        assert_eq!((crowd.points(), game.is_dimmed()), (points + per_ball + dims, false), "{what}");
        let as_it_was = crate::physics::World::new(Arc::clone(&game.table().scene)).state().targets.clone();
        assert_eq!(game.world().state().targets, as_it_was, "{what}");
        if what == "tilted" {
            assert_eq!(game.can_crowd(dim), Err(Why::Tilted));
        }
        act(&mut game, 0, Action::Stand);
        act(&mut game, 0, Action::Sit);
        act(&mut game, 0, Action::Start);
        assert_eq!(game.crowd().map(|crowd| (crowd.points(), crowd.ready_in(orbit))), Some((0, 0)), "another game");
    }
}

#[test]
fn a_table_without_a_crowd_hears_none() {
    let (before, rest) = SHIPPED[0].source.split_once("crowd: (").unwrap();
    let (_, after) = rest.split_once("\n        ),\n").unwrap();
    let table = Table::parse("classic.ron", &format!("{before}{after}")).unwrap_or_else(|error| panic!("{error}"));
    let mut game = Game::new(Arc::new(table));
    let state = game.state();
    assert!(game.crowd().is_none() && !game.is_dimmed());
    assert_eq!(game.can_crowd(0), Err(Why::NoCrowd));
    assert_eq!(act(&mut game, HOUSE, Action::Crowd(0)), []);
    // And a state is of the one or of the other.
    assert!(Game::new(classic()).restore(state).is_err());
    assert!(game.restore(Game::new(classic()).state()).is_err());
}

/// The bot, and a crowd that wants something about twice a second.
struct Hands {
    bot: Bot,
    rng: Rng,
}

impl Hands {
    fn new(seed: u64) -> Self {
        Self { bot: Bot::new(0, seed), rng: Rng::new(seed ^ 0xc0de) }
    }

    fn inputs(&mut self, game: &Game, inputs: &mut Vec<Input>) {
        let tick = game.tick();
        inputs.clear();
        let mut act = |seat, action| inputs.push(Input { tick, seat, action });
        if tick == 0 {
            act(0, Action::Sit);
        }
        if !game.is_playing() {
            act(0, Action::Start);
        }
        if self.rng.bits().is_multiple_of(500) {
            // Now and then it saves its energy for what is dearest.
            let wanted = if tick / 20_000 % 4 == 3 { 4 } else { self.rng.bits() % 6 };
            act(HOUSE, Action::Crowd(wanted as u8));
        }
        self.bot.play(game, |action| act(0, action));
    }
}

#[test]
fn ten_minutes_of_a_crowd_that_does_all_it_can() {
    let table = classic();
    let mut game = Game::new(Arc::clone(&table));
    let mut recorder = Recorder::new(&table, 1);
    let (mut hands, mut inputs) = (Hands::new(1), Vec::new());
    let actions = rules(&game).actions;
    let mut announced: Option<(u8, u64)> = None;
    let mut acted = vec![Vec::new(); actions.len()];
    let mut active: Vec<Option<u64>> = vec![None; actions.len()];
    let (mut undone, mut rescued, mut cut) = (0, 0, 0);
    for tick in 0..600_000 {
        hands.inputs(&game, &mut inputs);
        let kinds: Vec<_> = game.step(&inputs).iter().map(|event| event.kind).collect();
        recorder.after_step(&game, &inputs);
        for kind in kinds {
            match kind {
                GameEventKind::Announced { action } => {
                    assert_eq!(announced, None, "tick {tick}");
                    announced = Some((action, tick));
                }
                GameEventKind::Acted { action } => {
                    let wait = (actions[usize::from(action)].announce * 1000.0) as u64;
                    assert_eq!(announced.take(), Some((action, tick - wait)));
                    assert_eq!(active[usize::from(action)], None, "tick {tick}");
                    acted[usize::from(action)].push(tick);
                    if actions[usize::from(action)].lasts > 0.0 {
                        active[usize::from(action)] = Some(tick);
                    }
                }
                GameEventKind::Undone { action } => {
                    let Some(since) = active[usize::from(action)].take() else { panic!("tick {tick}: {action}") };
                    let lasts = (actions[usize::from(action)].lasts * 1000.0) as u64;
                    assert!(tick - since <= lasts, "tick {tick}: {action}");
                    cut += u32::from(tick - since < lasts);
                    undone += 1;
                }
                GameEventKind::Rescued { .. } => rescued += 1,
                GameEventKind::Lost { .. } => {
                    announced = None;
                }
                _ => {}
            }
        }
        // Whatever ended the turn has undone everything; and what the crowd says of itself is so.
        let in_play = matches!(game.phase(), Phase::Play { serve_in: 0, .. });
        assert!(in_play || active.iter().all(Option::is_none), "tick {tick}");
        let Some(crowd) = game.crowd() else { panic!("it is still there") };
        for (place, since) in (0..).zip(&active) {
            assert_eq!(crowd.lasts_for(place) > 0, since.is_some(), "tick {tick}: {place}");
        }
        assert!(crowd.energy() <= rules(&game).most_energy);
    }
    assert!(acted.iter().all(|ticks| ticks.len() >= 2), "{acted:?}");
    assert_eq!(rescued, 0, "a ball was stuck or escaped");
    assert!(undone > 30 && cut >= 1, "{undone} undone, {cut} of them by the end of the turn");
    let replay = recorder.finish(&game).unwrap_or_else(|error| panic!("{error}"));
    let read = Replay::parse("crowd.ron", &replay.to_text()).unwrap_or_else(|error| panic!("{error}"));
    assert_eq!(read, replay);
    assert_eq!(read.play(table, |_| ()).map(|played| played.digest()), Ok(game.digest()));
}

/// Also a check of calm ticks: a copy that was just restored knows of none.
#[test]
fn a_game_with_a_crowd_restored_at_any_moment_goes_on_bit_for_bit() {
    let table = classic();
    let mut game = Game::new(Arc::clone(&table));
    let mut copies: Vec<Game> = Vec::new();
    let (mut hands, mut inputs) = (Hands::new(4), Vec::new());
    let mut seen = [0; 2];
    for tick in 0..90_000 {
        hands.inputs(&game, &mut inputs);
        let crowd = game.crowd().unwrap_or_else(|| panic!("it is still there"));
        seen[0] += u32::from(crowd.announced().is_some());
        seen[1] += u32::from((0..5).any(|place| crowd.lasts_for(place) > 0));
        if tick % 5 == 0 {
            let mut copy = Game::new(Arc::clone(&table));
            assert_eq!(copy.restore(game.state()), Ok(()), "tick {tick}");
            if copies.len() < 6 {
                copies.push(copy);
            } else {
                copies[1 + tick as usize / 5 % 5] = copy;
            }
        }
        game.step(&inputs);
        let digest = game.digest();
        for copy in &mut copies {
            assert_eq!(copy.step(&inputs), game.events(), "tick {tick}");
            assert_eq!(copy.digest(), digest, "tick {tick}");
        }
    }
    assert!(seen.iter().all(|&ticks| ticks > 5000), "{seen:?}");
}

#[test]
fn a_crowd_that_cannot_be_is_refused() {
    let mut game = cradled();
    wait(&mut game, 20_000);
    act(&mut game, HOUSE, Action::Crowd(3));
    wait(&mut game, 3000);
    act(&mut game, HOUSE, Action::Crowd(0));
    let edits: [fn(&mut CrowdState); 7] = [
        |crowd| crowd.energy = 20_001,
        |crowd| crowd.energy = u32::MAX,
        |crowd| crowd.timers[7] = 1,
        |crowd| crowd.timers[2] = u32::MAX,
        |crowd| crowd.announced = Some(Announced { action: 200, ticks: 5 }),
        |crowd| crowd.announced = Some(Announced { action: 0, ticks: 0 }),
        |crowd| crowd.announced = Some(Announced { action: 0, ticks: 2001 }),
    ];
    for (place, edit) in edits.into_iter().enumerate() {
        let mut state = game.state();
        state.play.crowd.iter_mut().for_each(edit);
        assert!(Game::new(classic()).restore(state).is_err(), "edit {place}");
    }
    let mut state = game.state();
    state.play.phase = Phase::Over;
    assert!(Game::new(classic()).restore(state).is_err(), "nothing lasts beyond a game");
    // What is as large as can be harms nobody.
    let mut state = game.state();
    state.play.crowd.iter_mut().for_each(|crowd| crowd.points = u64::MAX);
    assert_eq!(game.restore(state), Ok(()));
    wait(&mut game, 3000);
    lose_ball(&mut game);
    assert_eq!(game.crowd().map(|crowd| crowd.points()), Some(u64::MAX));
}
