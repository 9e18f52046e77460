//! Films of games that a bot plays, as a client hears of them.

use shared::game::replay::{Recorder, Replay};
use shared::game::{Action, Bot, Phase};
use shared::protocol::{BoardInput, Full, Heard, Inputs, Roster};

use super::*;
use crate::budget::Budget;

/// Ticks of a frame.
const FRAME: u64 = 17;

fn classic() -> Arc<Table> {
    Arc::new(Table::shipped("classic").unwrap().unwrap())
}

/// A room in which the bot plays, and a client with a camera.
struct Room {
    game: Game,
    bot: Bot,
    follower: shared::protocol::Follower,
    camera: Camera,
    roster: Roster,
    /// The person at the client's window has a place.
    plays: bool,
    /// For each tick what the game was before it.
    digests: Vec<u64>,
}

impl Room {
    fn new() -> Self {
        let mut room = Self {
            game: Game::new(classic()),
            bot: Bot::new(0, 3),
            follower: shared::protocol::Follower::new(classic()),
            camera: Camera::new(classic()),
            roster: Roster::default(),
            plays: true,
            digests: Vec::new(),
        };
        room.roster.places[0] = Some("Ann".to_owned());
        room.send_full();
        room
    }

    fn send_full(&mut self) {
        let full = Full::of("test", std::slice::from_ref(&self.game));
        if self.follower.hear_full(&full) == Ok(Heard::Anew) {
            self.camera.begin(self.follower.games());
        }
    }

    /// A frame of the stream, with what the room does in it besides.
    fn frame(&mut self, actions: &[Action]) {
        let from = self.game.tick();
        let mut sent = Vec::new();
        for _ in 0..FRAME {
            let tick = self.game.tick();
            let mut inputs = Vec::new();
            if tick == from + 5 {
                inputs.extend(actions.iter().map(|&action| Input { tick, seat: 0, action }));
            }
            self.bot.play(&self.game, |action| inputs.push(Input { tick, seat: 0, action }));
            self.digests.push(self.game.digest());
            self.game.step(&inputs);
            sent.extend(inputs.into_iter().map(|input| BoardInput { board: 0, input }));
        }
        let to = self.game.tick();
        let inputs = Inputs { from, to, digest: Some(self.game.digest()), inputs: sent };
        let known = self.follower.confirmed();
        if self.follower.hear_inputs(&inputs) == Ok(Ok(Heard::Further)) {
            self.camera.hear(known, &inputs);
        }
        // The picture is a little late.
        let camera = &mut self.camera;
        self.follower.advance(to - 7, |_, event| camera.see(event)).unwrap();
        self.camera.look(self.follower.games(), &self.roster, self.plays);
    }

    /// A game of three balls that are given up after some seconds each.
    fn play(&mut self) {
        self.frame(&[Action::Sit, Action::Start]);
        for _ in 0..40 {
            for _ in 0..300 {
                self.frame(&[]);
            }
            if !matches!(self.game.phase(), Phase::Play { .. }) {
                return;
            }
            self.frame(&[Action::Forfeit]);
        }
        panic!("it does not end");
    }

    fn film(&self) -> Film {
        self.camera.film(0).expect("a film").clone()
    }
}

/// Plays to the end as fast as it goes; returns how much happened.
fn play_to_end(projector: &mut Projector) -> usize {
    let mut events = 0;
    for _ in 0..100_000 {
        if !projector.runs() {
            return events;
        }
        projector.advance(0.1, &mut Budget::endless(), |_| events += 1);
    }
    panic!("it does not end");
}

fn digest_of(projector: &Projector) -> (u64, u64) {
    let game = projector.moment().game;
    (game.tick(), game.digest())
}

#[test]
fn a_film_ends_as_the_game_did() {
    let mut room = Room::new();
    // The camera sees the room from some time before.
    for _ in 0..30 {
        room.frame(&[]);
    }
    room.play();
    let film = room.film();
    assert_eq!((film.name_of(0).as_str(), film.name_of(2).as_str()), ("ANN", "PLAYER 3"));
    assert!(film.first().abs_diff(30 * FRAME) <= FRAME, "from {}", film.first());
    let mut projector = Projector::new(film).unwrap();
    let events = play_to_end(&mut projector);
    let (tick, digest) = digest_of(&projector);
    assert!(events > 80 && tick > 15_000, "{events} events, {tick} ticks");
    assert_eq!((digest, projector.moment().game.phase()), (room.digests[tick as usize], Phase::Over));
    assert!(projector.difference().is_none());
    assert_eq!(projector.progress().0, projector.progress().1);
}

#[test]
fn a_film_can_be_stepped_either_way_and_lands_on_the_same_bits() {
    let mut room = Room::new();
    room.play();
    let mut projector = Projector::new(room.film()).unwrap();
    let go = |projector: &mut Projector| {
        projector.advance(1.0 / 60.0, &mut Budget::endless(), |_| {});
        let (tick, digest) = digest_of(projector);
        assert_eq!(digest, room.digests[tick as usize], "tick {tick}");
        tick
    };
    projector.change_speed(4);
    for _ in 0..30 {
        go(&mut projector);
    }
    for skip in [-3.0, 0.5, -0.2, 7.0, -5.0, -100.0, 4.0, 4.0] {
        projector.skip(skip);
        go(&mut projector);
    }
    projector.step_by(1.0);
    let tick = go(&mut projector);
    for (by, at) in [(1.0, 1), (1.0, 2), (-1.0, 1), (-1.0, 0), (-1.0, -1), (17.0, 16), (-16.0, 0)] {
        projector.step_by(by);
        assert_eq!(go(&mut projector) as i64 - tick as i64, at);
    }
    // It stood still.
    assert_eq!(go(&mut projector), tick);
    projector.toggle();
    play_to_end(&mut projector);
    let end = go(&mut projector);
    projector.toggle();
    assert!(projector.runs() && go(&mut projector) < end, "it begins again");
}

#[test]
fn it_is_as_fast_as_was_chosen() {
    let mut room = Room::new();
    room.play();
    let mut projector = Projector::new(room.film()).unwrap();
    let gone = |projector: &mut Projector| {
        let before = projector.progress().0;
        for _ in 0..6 {
            projector.advance(1.0 / 60.0, &mut Budget::endless(), |_| {});
        }
        projector.progress().0 - before
    };
    assert!((gone(&mut projector) - 0.1).abs() < 1e-9);
    projector.change_speed(-9);
    assert_eq!(projector.speed(), 0.125);
    assert!((gone(&mut projector) - 0.0125).abs() < 1e-9);
    projector.change_speed(9);
    assert_eq!(projector.speed(), 16.0);
    assert!((gone(&mut projector) - 1.6).abs() < 1e-9);
}

#[test]
fn what_happened_is_shown_once_and_again_after_going_back() {
    let mut room = Room::new();
    room.play();
    let mut projector = Projector::new(room.film()).unwrap();
    let all = play_to_end(&mut projector);
    projector.rewind();
    assert_eq!(play_to_end(&mut projector), all);
    // From the middle of what is kept it is not shown before where it went on.
    projector.rewind();
    projector.toggle();
    projector.skip(2.9);
    let mut first = u64::MAX;
    projector.advance(0.0, &mut Budget::endless(), |_| {});
    projector.skip(-0.4);
    projector.skip(10.0);
    projector.advance(0.0, &mut Budget::endless(), |event| first = first.min(event.tick));
    assert!(first >= projector.film().first() + 2_500, "{first}");
}

#[test]
fn where_something_was_missed_there_is_no_film_and_of_the_next_game_there_is() {
    let mut room = Room::new();
    room.frame(&[Action::Sit, Action::Start]);
    room.frame(&[]);
    room.follower.expect_full();
    room.send_full();
    // Like a game that was on before the client came.
    room.play();
    assert!(room.camera.film(0).is_none());
    room.play();
    let mut projector = Projector::new(room.film()).unwrap();
    play_to_end(&mut projector);
    let (tick, digest) = digest_of(&projector);
    assert_eq!(digest, room.digests[tick as usize]);
}

#[test]
fn ones_own_game_is_kept_until_there_is_another() {
    let mut room = Room::new();
    room.plays = false;
    room.play();
    let of_bot = room.film().first();
    room.plays = true;
    room.play();
    let own = room.film().first();
    assert!(own > of_bot);
    room.plays = false;
    room.play();
    assert_eq!(room.film().first(), own);
    room.plays = true;
    room.play();
    assert!(room.film().first() > own);
}

#[test]
fn a_film_that_is_not_what_was_recorded_says_where() {
    let mut room = Room::new();
    room.play();
    let mut film = room.film();
    let stroke = film.inputs.iter().position(|input| input.tick > 4_000 && input.action.is_control()).unwrap();
    let tick = film.inputs.remove(stroke).tick;
    let mut projector = Projector::new(film).unwrap();
    play_to_end(&mut projector);
    let difference = projector.difference().expect("a stroke is missing");
    assert!((tick..tick + 3_000).contains(&difference.tick), "{difference:?}, the stroke was at {tick}");
    assert_ne!(difference.expected, difference.found);
}

/// The text of a replay of three seconds.
fn replay() -> String {
    let mut game = Game::new(classic());
    let mut recorder = Recorder::new(&classic(), 1);
    for tick in 0..3_000 {
        let start = [Action::Sit, Action::Start].map(|action| Input { tick, seat: 0, action });
        let inputs = if tick == 0 { &start[..] } else { &[] };
        game.step(inputs);
        recorder.after_step(&game, inputs);
    }
    recorder.finish(&game).unwrap().to_text()
}

#[test]
fn a_replay_is_a_film_on_its_table_and_no_other() {
    let replay = Replay::parse("some", &replay()).unwrap();
    let mut projector = Projector::new(Film::of_replay(&replay, classic()).unwrap()).unwrap();
    play_to_end(&mut projector);
    assert_eq!(digest_of(&projector), (3_000, replay.checkpoints().last().unwrap().digest));
    let other = Table::parse("other", &format!("{}\n// Another digest.\n", classic().source)).unwrap();
    assert!(matches!(Film::of_replay(&replay, Arc::new(other)), Err(ReplayError::Table { .. })));
}

#[test]
fn files_that_are_no_replay_of_that_table_are_refused_in_plain_words() {
    let file = std::env::temp_dir().join(format!("starball-film-{}.ron", std::process::id()));
    let read = |text: &str, table| {
        std::fs::write(&file, text).unwrap();
        read(&file, table).map_err(|problem| problem.replace(&file.display().to_string(), "FILE"))
    };
    let text = replay();
    assert_eq!(read(&text, None).unwrap().last(), 3_000);
    assert_eq!(read(&text, Some("classic")).unwrap().last(), 3_000);
    let digest = format!("{:016x}", classic().digest);
    let foreign = text.replace(&digest, "0123456789abcdef");
    let problem = read(&foreign, None).unwrap_err();
    assert!(problem.contains("none of those that are shipped (classic") && problem.contains("--table"), "{problem}");
    let problem = read(&foreign, Some("classic")).unwrap_err();
    assert!(problem.starts_with("FILE: the replay was recorded on table"), "{problem}");
    let problem = read(&text[..text.len() / 2], None).unwrap_err();
    assert!(problem.starts_with("FILE:"), "{problem}");
    assert!(read(&text, Some("no such")).unwrap_err().contains("no shipped table"));
    std::fs::remove_file(&file).unwrap();
    assert!(super::read(&file, None).unwrap_err().starts_with("cannot read "));
}
