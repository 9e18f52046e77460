//! 2 File structure: the world with its floors and elements (`WorldManager`), and 3 GameLoop (`GameCore`): move, correct,
//! draw.

use glam::DVec2;
use shared::physics::ball::Instant;
use shared::physics::motion::Motion;
use shared::physics::shapes::{Shape, Side};
use shared::physics::{EventKind, World};
use shared::table::Table;

use crate::{ball_among, ball_of, world_of};

/// The ball falls from one floor through the hole to the other, in every model: see the file.
const TWO_FLOORS: &str = include_str!("../../tables/scenes/two-floors.ron");

/// Its elements by floor, and what leads from one to the other.
const UPPER: [&str; 2] = ["frame", "post"];
const LOWER: [&str; 4] = ["basin", "island", "shelf", "stairs"];
const HOLE: &str = "hole";

/// What the ball of a scene meets within 20 seconds: names of elements, and where.
fn meetings(source: &str, motion: Motion) -> Vec<(String, DVec2)> {
    let table = Table::parse("two-floors.ron", source).unwrap_or_else(|error| panic!("{error}"));
    let mut world = World::new(table.run_with(Some(motion), None).expect("its own rate").scene);
    let mut met = Vec::new();
    for _ in 0..20_000 {
        for event in world.step() {
            let (EventKind::Touched { element, .. } | EventKind::Passed { element }) = event.kind else {
                panic!("{motion}: {event:?}")
            };
            met.push((table.file.elements[usize::from(element)].name().to_owned(), event.position));
        }
    }
    met
}

#[test]
fn a_ball_meets_what_is_on_its_own_floor_and_after_the_hole_what_is_on_the_other() {
    for motion in Motion::ALL {
        let met = meetings(TWO_FLOORS, motion);
        let hole = met.iter().position(|(name, _)| name == HOLE).expect("it falls through");
        let (above, below) = (&met[..hole], &met[hole + 1..]);
        assert!(above.iter().all(|(name, _)| UPPER.contains(&name.as_str())), "{motion}: {above:?}");
        assert!(below.iter().all(|(name, _)| LOWER.contains(&name.as_str())), "{motion}: {below:?}");
        let is_beyond_the_frame = |at: &DVec2| at.y < 0.0 || at.x < 0.0 || at.x > 1.0;
        assert!(below.iter().any(|(_, at)| is_beyond_the_frame(at)), "{motion}: the frame no longer holds it");
    }
}

/// The same scene with everything on one floor: the ball comes no farther than the shelf.
#[test]
fn without_floors_what_is_below_would_be_in_the_way() {
    let flat = TWO_FLOORS.replace(", floor: 1", "");
    for motion in Motion::ALL {
        let met = meetings(&flat, motion);
        assert!(met.iter().any(|(name, _)| name == "shelf"), "{motion}");
        assert!(met.iter().all(|(name, _)| name != HOLE), "{motion}");
    }
}

/// The manual's elements: the pinball, lines and circles, from outside and from inside; and what joins its floors.
#[test]
fn every_element_of_the_world_is_met() {
    for motion in Motion::ALL {
        let met = meetings(TWO_FLOORS, motion);
        for name in UPPER.iter().chain(&LOWER).chain(&[HOLE]) {
            assert!(met.iter().any(|(other, _)| other == name), "{motion}: {name}");
        }
    }
}

/// How deep a ball is in what it overlaps most, m; negative: how far it is from the nearest thing.
fn deepest_overlap(world: &World) -> f64 {
    let (center, _) = ball_of(world);
    let scene = world.scene();
    let distances = scene.colliders.iter().map(|collider| match &collider.shape {
        Shape::Arc(disc) if disc.side == Side::Outside => (center - disc.center).length() - disc.radius,
        Shape::Arc(ring) => ring.radius - (center - ring.center).length(),
        shape => shape.distance(center),
    });
    distances.map(|distance| scene.radius(0) - distance).fold(f64::NEG_INFINITY, f64::max)
}

/// The deepest overlap that anybody sees between two of 20,000 steps, in which the ball must bounce often enough.
fn deepest_seen(elements: &str, motion: Motion) -> f64 {
    let source = format!(
        "Scene(gravity: (0.0, -1.0), balls: [(position: (0.3, 0.7), velocity: (1.1, 0.4), radius: 0.02)], elements: [
            Wall(points: [(0.0, 0.0), (1.0, 0.0), (1.0, 1.0), (0.0, 1.0), (0.0, 0.0)]),
            Post(center: (0.5, 0.35), radius: 0.1),
            {elements}
        ])"
    );
    let mut world = world_of(&source, motion);
    let (mut bounces, mut deepest) = (0, f64::NEG_INFINITY);
    for _ in 0..20_000 {
        bounces += world.step().len();
        deepest = deepest.max(deepest_overlap(&world));
    }
    assert!(bounces > 30, "{motion}: {bounces} bounces");
    deepest
}

/// A ball that is moved by 10 m in a step, right into a wall: nobody sees it there.
#[test]
fn game_loop_corrects_in_the_same_step_what_the_move_overlapped() {
    let source = ball_among(1.0, DVec2::new(10.0, 0.0), 0.0, "Wall(points: [(10.5, -9.0), (10.5, 9.0)])");
    for motion in Motion::ALL {
        let mut world = world_of(&source, motion);
        assert_eq!(world.step().len(), 1, "{motion}");
        let (position, velocity) = ball_of(&world);
        assert_eq!(velocity, DVec2::new(-10.0, 0.0), "{motion}");
        let expected = match motion {
            // Moved to 10, put back to where it touches.
            Motion::Discrete | Motion::Pixel => 9.5,
            // Bounced on its way, at 9.5.
            Motion::Swept | Motion::Exact => 9.0,
        };
        assert!((position.x - expected).abs() < 1e-14, "{motion}: {position}");
    }
}

/// The same for two balls.
#[test]
fn game_loop_corrects_in_the_same_step_balls_that_the_move_brought_together() {
    let balls = "Scene(gravity: (0.0, 0.0), tick_hz: 1, pixel: 1.0, bounds: (-50.0, -50.0, 50.0, 50.0), balls: [
        (position: (0.0, 0.0), velocity: (10.0, 0.0), radius: 1.0),
        (position: (21.0, 0.0), velocity: (-10.0, 0.0), radius: 1.0),
    ])";
    for motion in Motion::ALL {
        let mut world = world_of(balls, motion);
        assert_eq!(world.step().len(), 2, "{motion}: one of each ball");
        let now = Instant::start_of(1);
        let [left, right] = [0, 1].map(|place: usize| world.state().balls[place].at(now, 1.0));
        assert!(right.0.x - left.0.x > 2.0 - 1e-14, "{motion}: {left:?} {right:?}");
        assert_eq!((left.1.x, right.1.x), (-10.0, 10.0), "{motion}");
    }
}

#[test]
fn game_loop_shows_no_ball_that_overlaps_anything() {
    for motion in Motion::ALL {
        let deepest = deepest_seen("", motion);
        assert!(deepest < 1e-15, "{motion}: {deepest} m");
    }
}

/// What a model that looks now and then cannot promise: where two surfaces meet at a narrow angle, it puts the ball back
/// onto the one that it overlaps most, and may leave it in the other, which it then moves away from. The others have met
/// one after the other.
#[test]
fn game_loop_in_narrow_corners_leaves_the_overlap_of_one_look() {
    for motion in Motion::ALL {
        let deepest = deepest_seen("Ring(center: (0.5, 0.5), radius: 0.6)", motion);
        let one_look = match motion {
            // At 2 m/s, which nothing here exceeds: the way of a tick, or a pixel.
            Motion::Discrete => 0.002,
            Motion::Pixel => 0.001,
            Motion::Swept | Motion::Exact => 1e-15,
        };
        assert!(deepest < one_look, "{motion}: {deepest} m");
    }
}
