//! Pauses, where they are allowed and where not.

use super::*;
use crate::pacing::Due;

#[test]
fn where_it_is_allowed_a_player_stops_the_room() {
    let due = |ticks| Due { ticks, skipped: 0 };
    let mut config = quiet(classic(), Mode::Challenge);
    config.pause = true;
    let mut stage = Stage::new(config);
    let ann = stage.join("Ann", Role::Play);
    let bob = stage.join("Bob", Role::Play);
    stage.run_until("a ball is served", |stage| matches!(stage.game().phase(), Phase::Play { serve_in: 0, .. }));
    stage.say(ann, ClientMessage::Pause(true));
    let (tick, digest) = (stage.game().tick(), stage.game().digest());
    // Longer than anybody may idle; nothing of it is made up for.
    for _ in 0..100 {
        stage.room.pass(due(1_000));
    }
    stage.join("Cid", Role::Watch);
    stage.room.pass(due(1_000));
    assert_eq!((stage.game().tick(), stage.game().digest()), (tick, digest));
    stage.say(bob, ClientMessage::Pause(false));
    stage.room.pass(due(5));
    assert_eq!((stage.game().tick(), stage.room.account.forfeited), (tick + 5, 0));
    // Whoever stopped it and leaves lets it go on, in either way.
    for leave in [true, false] {
        stage.say(bob, ClientMessage::Pause(true));
        stage.room.pass(due(5));
        let tick = stage.game().tick();
        if leave {
            stage.say(bob, ClientMessage::Leave);
            stage.say(bob, ClientMessage::Play);
        } else {
            stage.room.handle(Command::Left { client: bob });
        }
        stage.room.pass(due(500));
        assert_eq!(stage.game().tick(), tick + 500);
    }
    assert_eq!(stage.room.account.illegal, 0);
}

#[test]
fn where_it_is_not_allowed_whoever_asks_for_a_pause_is_sent_away() {
    let mut stage = Stage::new(quiet(classic(), Mode::Challenge));
    let ann = stage.join("Ann", Role::Play);
    stage.run(1);
    stage.say(ann, ClientMessage::Pause(true));
    assert_eq!((stage.room.account.illegal, stage.room.lobby.state(ann)), (1, None));
    assert!(stage.room.paused_by.is_none());
}
