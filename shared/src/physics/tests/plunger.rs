//! The plunger of Classic.

use super::{ball, classic, run};
use crate::physics::world::World;

/// Speed at which a ball that was served leaves the plunger after that pull, m/s, and the tick of its release.
fn launch_speed(share: f64) -> f64 {
    let table = classic();
    let mut world = World::new(table.scene.clone());
    assert!(world.serve(table.ball_start).is_some());
    run(&mut world, 300);
    world.pull(Some(share));
    run(&mut world, 800);
    world.pull(None);
    let mut fastest = 0.0_f64;
    for _ in 0..150 {
        run(&mut world, 1);
        fastest = fastest.max(ball(&world, 0).1.y);
    }
    fastest
}

#[test]
fn launch_speed_grows_with_the_pull_and_is_bounded() {
    let speeds: Vec<f64> = (1..=20).map(|step| launch_speed(f64::from(step) / 20.0)).collect();
    println!("launch speeds for pulls of 5, 10 ... 100%: {speeds:.3?} m/s");
    assert!(speeds.windows(2).all(|pair| pair[0] < pair[1]), "{speeds:?}");
    let (half, full) = (speeds[9], speeds[19]);
    assert!((3.0..=4.0).contains(&full), "full pull {full} m/s");
    assert!((0.45..0.55).contains(&(half / full)), "half pull {half}, full {full}");
}

#[test]
fn a_pull_beyond_the_stroke_is_a_full_pull() {
    assert_eq!(launch_speed(7.0), launch_speed(1.0));
    assert_eq!(launch_speed(-3.0), launch_speed(f64::NAN));
}

#[test]
fn a_ball_follows_the_head_back_and_rests_on_it() {
    let table = classic();
    let mut world = World::new(table.scene.clone());
    assert!(world.serve(table.ball_start).is_some());
    run(&mut world, 1000);
    let home = ball(&world, 0).0.y;
    assert!((home - 0.1 - table.scene.radius(0)).abs() < 1e-9, "it lies on the head at {home}");
    world.pull(Some(0.5));
    run(&mut world, 1500);
    let (position, velocity) = ball(&world, 0);
    let head = 0.1 - 0.5 * table.scene.plungers[0].stroke;
    assert!((position.y - head - table.scene.radius(0)).abs() < 1e-6, "ball at {position}, head at {head}");
    assert!(velocity.length() < 1e-6, "{velocity}");
}
