//! Which sound an event makes, how loud, and from where.

use shared::game::Game;

use super::*;

fn classic() -> Arc<Table> {
    Arc::new(Table::shipped("classic").unwrap().unwrap())
}

fn place(table: &Table, name: &str) -> u16 {
    table.file.elements.iter().position(|element| element.name() == name).unwrap() as u16
}

/// What is heard of these kinds, one event each half a second, in pictures of their own.
fn heard(table: &Arc<Table>, kinds: &[GameEventKind]) -> Vec<Option<Cue>> {
    let mut listener = Listener::new(table, 0);
    let game = Game::new(Arc::clone(table));
    let hear = |(place, &kind): (usize, &GameEventKind)| {
        let tick = 500 * place as u64;
        let mut moment = Moment::of(&game, 0.0);
        moment.at.tick = tick;
        let mut cues = Vec::new();
        listener.hear(&moment, &[GameEvent { tick, kind }], &mut |cue| cues.push(cue));
        assert!(cues.len() < 2);
        cues.pop()
    };
    kinds.iter().enumerate().map(hear).collect()
}

#[test]
fn every_element_has_its_sound_and_its_place() {
    let table = classic();
    let place = |name| place(&table, name);
    let touched = |name| GameEventKind::Touched { element: place(name), speed: 1.0 };
    let passed = |name| GameEventKind::Passed { element: place(name) };
    let kinds = [
        touched("frame"),
        touched("lane wall"),
        touched("left bump"),
        touched("left island"),
        GameEventKind::Kicked { element: place("bumper 1"), speed: 1.0 },
        GameEventKind::Kicked { element: place("right sling"), speed: 1.0 },
        GameEventKind::Felled { element: place("drop 1"), speed: 1.0 },
        GameEventKind::Struck { element: place("target 2"), speed: 1.0 },
        passed("left inlane"),
        passed("lane gate"),
        GameEventKind::Spun { element: place("spinner") },
        GameEventKind::Held { element: place("lock") },
        GameEventKind::Ejected { element: place("lock") },
        GameEventKind::Flipped { right: true },
        GameEventKind::Nudged { nudge: Nudge::FromLeft },
        GameEventKind::Served { seat: 0, ball: 1 },
        GameEventKind::Lost { seat: 0 },
        GameEventKind::ExtraBall { seat: 0 },
        GameEventKind::Met { speed: 1.0, place: (0.1, 0.5) },
    ];
    let cues: Vec<Cue> = heard(&table, &kinds).into_iter().map(Option::unwrap).collect();
    use Sound as S;
    let sounds = [
        S::Wood,
        S::Metal,
        S::Rubber,
        S::Plastic,
        S::Bumper,
        S::Slingshot,
        S::Drop,
        S::Target,
        S::Rollover,
        S::Gate,
        S::Spinner,
        S::Catch,
        S::Eject,
        S::FlipperUp,
        S::Nudge,
        S::Serve,
        S::Drain,
        S::Knock,
        S::Clack,
    ];
    assert_eq!(cues.iter().map(|cue| cue.sound).collect::<Vec<_>>(), sounds);
    let sides: String = cues
        .iter()
        .map(|cue| match cue.pan {
            ..-0.1 => 'L',
            0.1.. => 'R',
            _ => '-',
        })
        .collect();
    assert_eq!(sides, "-RLLLRL-LRLRRRLR--L");
    assert!(cues.iter().all(|cue| cue.pan.abs() <= MOST_PAN && (0.1..=1.0).contains(&cue.gain)));
}

#[test]
fn a_wide_wall_is_heard_where_the_ball_is() {
    let table = classic();
    let mut listener = Listener::new(&table, 0);
    let at = |x, speed| Motion {
        id: 0,
        position: macroquad::math::dvec2(x, 0.5),
        velocity: macroquad::math::dvec2(0.0, speed),
        spin: 0.0,
        floor: 0,
        is_held: false,
    };
    let frame = GameEventKind::Touched { element: place(&table, "frame"), speed: 1.0 };
    let left = listener.cue_of(frame, &[at(0.4, 0.1), at(0.02, 3.0)]).unwrap();
    let right = listener.cue_of(frame, &[at(0.5, 0.1)]).unwrap();
    assert!(left.pan < -0.6 && right.pan > 0.6, "{} {}", left.pan, right.pan);
}

#[test]
fn what_is_free_rolls_unless_the_game_stands_still() {
    let table = classic();
    let mut listener = Listener::new(&table, 0);
    let game = Game::new(Arc::clone(&table));
    let at = |x, speed, is_held| Motion {
        id: 0,
        position: macroquad::math::dvec2(x, 0.5),
        velocity: macroquad::math::dvec2(0.0, speed),
        spin: 0.0,
        floor: 0,
        is_held,
    };
    let mut moment = Moment::of(&game, 0.0);
    moment.at.tick = 5;
    assert_eq!(listener.roll(&moment), Roll::NONE);
    moment.balls = vec![at(0.514, 1.2, false), at(0.0, 0.3, false), at(0.1, 9.0, true)];
    let roll = listener.roll(&moment);
    assert!((roll.speed - 0.5).abs() < 1e-6 && (roll.pan - 0.6 * MOST_PAN).abs() < 1e-6, "{roll:?}");
    listener.hear(&moment, &[], &mut |cue| panic!("{cue:?}"));
    assert_eq!(listener.roll(&moment), Roll::NONE, "the same moment again");
}

#[test]
fn the_harder_the_louder() {
    let table = classic();
    let touched = |speed| GameEventKind::Touched { element: 0, speed };
    let cues = heard(&table, &[0.05, 0.1, 0.5, 2.0, 3.0, 50.0, f32::NAN].map(touched));
    assert_eq!((cues[0], cues[6]), (None, None));
    let gains: Vec<f32> = cues[1..6].iter().map(|cue| cue.unwrap().gain).collect();
    assert!(gains[0] > 0.05 && gains.is_sorted() && gains[2] < gains[3], "{gains:?}");
    assert_eq!(gains[3..], [1.0, 1.0]);
}

#[test]
fn points_ring_and_great_ones_are_a_jackpot() {
    let table = classic();
    let points = |points| GameEventKind::Points { seat: 0, points, place: Some((0.1, 0.2)) };
    let cues = heard(&table, &[20, 250, 1000, 5000].map(points));
    let pitches: Vec<f32> = cues.iter().map(|cue| cue.unwrap().pitch).collect();
    assert!(cues.iter().all(|cue| cue.unwrap().sound == Sound::Chime) && pitches.is_sorted(), "{pitches:?}");

    let message = GameEventKind::Message { place: 0 };
    let hear = |events: &[(u64, GameEventKind)]| {
        let game = Game::new(Arc::clone(&table));
        let events: Vec<GameEvent> = events.iter().map(|&(tick, kind)| GameEvent { tick, kind }).collect();
        let mut sounds = Vec::new();
        Listener::new(&table, 0).hear(&Moment::of(&game, 0.0), &events, &mut |cue| sounds.push(cue.sound));
        sounds
    };
    assert_eq!(hear(&[(5, points(10_000)), (5, message)]), [Sound::Chime, Sound::Jackpot]);
    assert_eq!(hear(&[(5, points(10_000)), (9, message)]), [Sound::Chime, Sound::Award]);
    let multiball = table.rules.messages.iter().position(|text| text == "MULTIBALL").unwrap() as u16;
    assert_eq!(hear(&[(5, GameEventKind::Message { place: multiball })]), [Sound::Jackpot]);
}

#[test]
fn a_rattle_is_thinned_out_and_what_is_long_past_is_not_heard() {
    let table = classic();
    let mut listener = Listener::new(&table, 0);
    let game = Game::new(Arc::clone(&table));
    let mut moment = Moment::of(&game, 0.0);
    let mut hear = |now, ticks: &[u64]| {
        let kind = GameEventKind::Touched { element: 0, speed: 1.0 };
        let events: Vec<GameEvent> = ticks.iter().map(|&tick| GameEvent { tick, kind }).collect();
        moment.at.tick = now;
        let mut delays = Vec::new();
        listener.hear(&moment, &events, &mut |cue| delays.push((cue.delay * 1000.0).round()));
        delays
    };
    assert!(hear(1000, &[]).is_empty());
    // As far apart as they happened, but not the three that come too soon.
    assert_eq!(hear(1060, &[1002, 1003, 1010, 1017, 1028, 1055]), [2.0, 20.0, 20.0]);
    assert!(hear(1070, &[1062]).is_empty(), "nor in the next picture");
    assert_eq!(hear(9000, &[1200, 8740, 8990]), [20.0]);
}
