//! Who sits where, in each mode.

use super::told::TOLD_AT_ONCE;
use super::*;
use shared::protocol::ServerMessage;

const START: GameView = GameView { is_at_start: true, is_playing: false };
const EARLY: GameView = GameView { is_at_start: true, is_playing: true };
const LATE: GameView = GameView { is_at_start: false, is_playing: true };

use Action::{Sit, Stand, Start};

fn lobby_with(mode: Mode, places: usize, names: &[&str]) -> Lobby {
    let mut lobby = Lobby::new(mode, places, true, Arc::new(Chatter::new("a test")));
    for (id, name) in (0..).zip(names) {
        lobby.add(id, (*name).to_owned());
    }
    lobby
}

fn challenge(names: &[&str]) -> Lobby {
    lobby_with(Mode::Challenge, 2, names)
}

#[test]
fn the_first_person_sends_the_bot_away_and_starts() {
    let mut lobby = challenge(&["Ann"]);
    assert_eq!(lobby.attract(), [(0, Sit), (0, Start)]);
    assert_eq!(lobby.play(0, LATE), [(0, Stand), (0, Sit), (0, Start)]);
    assert_eq!(lobby.name_of(0), "Ann");
    assert!(lobby.attract().is_empty());
}

#[test]
fn a_second_person_joins_at_the_start_and_waits_later() {
    let mut lobby = challenge(&["Ann", "Bob", "Cid"]);
    lobby.play(0, START);
    assert_eq!(lobby.play(1, EARLY), [(1, Sit)]);
    assert!(lobby.play(2, EARLY).is_empty(), "both places are taken");
    assert_eq!(lobby.state(2), Some((SessionState::InLine, false)));
    // Bob leaves in mid-game: Cid has to wait for its end.
    assert_eq!(lobby.leave(1, LATE), [(1, Stand)]);
    assert_eq!(lobby.fill_places(START), [(1, Sit)]);
    assert_eq!(lobby.name_of(1), "Cid");
}

#[test]
fn the_next_in_line_starts_when_everybody_has_left() {
    let mut lobby = challenge(&["Ann", "Bob"]);
    lobby.play(0, START);
    lobby.play(1, LATE);
    assert_eq!(lobby.remove(0, LATE), [(0, Stand), (0, Sit), (0, Start)]);
    assert_eq!(lobby.name_of(0), "Bob");
}

#[test]
fn the_winner_stays_and_the_next_comes_up() {
    let mut lobby = challenge(&["Ann", "Bob", "Cid", "Dan"]);
    lobby.play(0, START);
    lobby.play(1, EARLY);
    lobby.play(2, LATE);
    lobby.play(3, LATE);
    assert_eq!(lobby.make_room(&[(0, 500), (1, 900)], Some(1)), [(0, Stand)]);
    assert_eq!(lobby.state(0), Some((SessionState::Watching, true)), "it had a place");
    assert_eq!(lobby.fill_places(START), [(0, Sit)]);
    assert_eq!(lobby.take_roster().champion, Some((1, 1)));
    assert_eq!((lobby.name_of(0), lobby.name_of(1)), ("Cid", "Bob"));
    assert_eq!(lobby.make_room(&[(0, 500), (1, 900)], Some(1)), [(0, Stand)]);
    assert_eq!(lobby.take_roster().champion, Some((1, 2)));
    lobby.leave(1, START);
    assert_eq!(lobby.take_roster().champion, None);
}

#[test]
fn nobody_makes_room_for_nobody() {
    let mut lobby = challenge(&["Ann", "Bob"]);
    lobby.play(0, START);
    lobby.play(1, EARLY);
    assert!(lobby.make_room(&[(0, 1), (1, 2)], Some(1)).is_empty());
    assert_eq!(lobby.play(1, START), [(1, Start)]);
}

#[test]
fn whoever_plays_alone_makes_room_for_who_waits() {
    let mut lobby = lobby_with(Mode::Crowd, 1, &["Ann", "Bob"]);
    assert_eq!(lobby.play(0, START), [(0, Sit), (0, Start)]);
    assert!(lobby.play(1, EARLY).is_empty());
    assert_eq!(lobby.make_room(&[(0, 10)], None), [(0, Stand)]);
    assert_eq!(lobby.fill_places(START), [(0, Sit), (0, Start)]);
    assert_eq!(lobby.name_of(0), "Bob");
}

#[test]
fn head_to_head_begins_against_the_bot_and_goes_on_between_people() {
    let mut lobby = lobby_with(Mode::HeadToHead, 2, &["Ann", "Bob"]);
    assert_eq!(lobby.play(0, START), [(0, Sit), (1, Sit), (0, Start), (1, Start)]);
    assert_eq!(lobby.sitter(1), Some(Sitter::Bot));
    assert!(lobby.play(1, LATE).is_empty(), "not in the middle of a match");
    // The bot won, but wears no crown and makes room.
    assert_eq!(lobby.make_room(&[(0, 5), (1, 7)], Some(1)), [(1, Stand)]);
    assert_eq!(lobby.take_roster().champion, None);
    assert_eq!(lobby.fill_places(START), [(1, Sit)]);
    assert_eq!((lobby.name_of(0), lobby.name_of(1)), ("Ann", "Bob"));
    assert_eq!(lobby.play(1, START), [(0, Start), (1, Start)], "either of them begins");
    lobby.make_room(&[(0, 5), (1, 7)], Some(1));
    assert_eq!(lobby.take_roster().champion, Some((1, 1)));
}

/// A client in line was told its place when it came, and never again.
#[test]
fn who_moves_up_in_the_line_is_told() {
    let mut lobby = challenge(&["Ann", "Bob", "Cid"]);
    let told = |lobby: &mut Lobby, id: u32| {
        let mut told = lobby.take_told();
        told.extend(lobby.take_moved());
        told.into_iter().find(|(client, _)| *client == id).map(|(_, message)| message)
    };
    lobby.play(0, START);
    lobby.play(1, LATE);
    lobby.play(2, LATE);
    assert_eq!(told(&mut lobby, 2), Some(ServerMessage::You { client: 2, place: None, line: Some(2) }));
    lobby.leave(1, LATE);
    assert_eq!(told(&mut lobby, 2), Some(ServerMessage::You { client: 2, place: None, line: Some(1) }));
    assert_eq!(told(&mut lobby, 2), None, "nobody is told twice");
}

#[test]
fn whoever_gives_up_a_place_in_line_is_not_seated() {
    let mut lobby = challenge(&["Ann", "Bob"]);
    lobby.play(0, START);
    lobby.play(1, LATE);
    assert!(lobby.leave(1, LATE).is_empty());
    assert!(lobby.fill_places(START).is_empty());
    let roster = lobby.take_roster();
    assert_eq!((roster.spectators, roster.line.len()), (1, 0));
}

/// One seat that fell free made ten thousand messages in one tick.
#[test]
fn a_long_line_hears_in_turns_how_it_moves_up() {
    let mut lobby = challenge(&["Ann", "Bob"]);
    lobby.play(0, START);
    lobby.play(1, EARLY);
    for id in 2..1002 {
        lobby.add(id, format!("n{id}"));
        lobby.play(id, LATE);
    }
    assert_eq!(lobby.take_told().len(), 1002);
    assert!(lobby.take_moved().is_empty(), "everybody knows");
    lobby.leave(2, LATE);
    assert_eq!(lobby.take_told().len(), 1);
    let mut told = std::collections::BTreeMap::new();
    for round in 0..20 {
        let moved = lobby.take_moved();
        assert!(moved.len() <= MOST_IN_LINE + TOLD_AT_ONCE, "{}", moved.len());
        if round == 0 {
            assert!(moved.iter().any(|(client, _)| *client == 3), "the first of them at once");
        }
        told.extend(moved);
    }
    assert_eq!(told.len(), 999);
    let last = ServerMessage::You { client: 1001, place: None, line: Some(999) };
    assert_eq!(told.get(&1001), Some(&last));
}
