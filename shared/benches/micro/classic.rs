//! Moments of a game on Classic, played by the bot.

use std::sync::Arc;

use shared::game::{Action, Bot, Game, GameState, Input};
use shared::physics::ball::Support;
use shared::physics::flipper::FlipperRest;
use shared::physics::{Event, EventKind};
use shared::table::Table;

/// Simulated, at the most.
const MOST_TICKS: u64 = 2_000_000;

pub(crate) fn game() -> Game {
    let Some(Ok(table)) = Table::shipped("classic") else { panic!("it is shipped") };
    Game::new(Arc::new(table))
}

/// Plays with the bot, from the start of a game, until `look` says that it has seen enough. It is shown the game after
/// each tick, and how many actions there were in that.
pub(crate) fn play(mut look: impl FnMut(&Game, usize) -> bool) {
    let (mut game, mut bot, mut inputs) = (game(), Bot::new(0, 5), Vec::new());
    for tick in 0..MOST_TICKS {
        inputs.clear();
        let mut act = |action| inputs.push(Input { tick, seat: 0, action });
        // It plays again when a game is over.
        if tick % 1000 == 0 {
            act(Action::Sit);
            act(Action::Start);
        }
        bot.play(&game, act);
        game.step(&inputs);
        if look(&game, inputs.len()) {
            return;
        }
    }
    panic!("not seen within {MOST_TICKS} ticks");
}

/// States from which a ball flies on, all else at rest and nobody doing anything, for two ticks: in the first of them
/// nothing happens, in the second `events` do, all of them bounces.
pub(crate) fn flights(count: usize, events: usize) -> Vec<GameState> {
    let mut found = Vec::new();
    // The states two ticks ago and one tick ago; whether the last tick was quiet.
    let (mut before, mut last): (Option<GameState>, Option<GameState>) = (None, None);
    let mut was_quiet = false;
    play(|game, actions| {
        let happened = game.world().events();
        if let Some(state) = &before
            && was_quiet
            && actions == 0
            && happened.len() == events
            && happened.iter().all(is_bounce)
            && is_free_flight(state)
        {
            found.push(state.clone());
        }
        was_quiet = actions == 0 && happened.is_empty();
        before = last.replace(game.state());
        found.len() == count
    });
    found
}

fn is_bounce(event: &Event) -> bool {
    matches!(event.kind, EventKind::Touched { .. } | EventKind::Kicked { .. })
}

fn is_free_flight(state: &GameState) -> bool {
    let world = &state.world;
    world.balls.len() == 1
        && world.balls[0].support == Support::None
        && world.flippers.iter().all(|flipper| flipper.rest == FlipperRest::AtRest && !flipper.pressed)
        && world.plungers.iter().all(|plunger| plunger.home && plunger.stays_home())
}

/// Moments with one ball in play, as far apart as a player's snapshots are.
pub(crate) fn snapshots(count: usize) -> Vec<GameState> {
    const TICKS: u64 = 17;
    let mut found = Vec::new();
    play(|game, _| {
        if game.tick().is_multiple_of(TICKS) && game.world().state().balls.len() == 1 {
            found.push(game.state());
        }
        found.len() == count
    });
    found
}
