//! The reference: a scene solved event by event with twice the digits of f64, by code of its own.
//!
//! It shares with the engine what a scene *is* (shapes, materials, balls), and nothing of how it is solved: between impacts a
//! ball follows its parabola; every root of its distance to each shape that it may come near is isolated, and the first one
//! at which it approaches is the impact. Where a ball comes to rest on a surface, or rolls along it, the reference ends.

mod response;
mod search;
#[cfg(test)]
mod tests;

use glam::DVec2;
use shared::physics::scene::{Presence, Role, Scene};

use super::polynomial::Refinement;
use super::real::{Real, Vector, Wide};
use response::{bounce, collide};
use search::{Candidate, Search, meeting};

/// A parabola, from its start on.
#[derive(Debug, Clone, Copy)]
pub struct Flight<R> {
    /// Seconds since the scene's start.
    pub start: R,
    /// Centre of the ball then, m, in the scene's own coordinates.
    pub position: Vector<R>,
    /// m/s.
    pub velocity: Vector<R>,
    /// m/s^2.
    pub gravity: Vector<R>,
}

impl<R: Real> Flight<R> {
    /// Where the ball is `s` seconds after the flight's start.
    pub fn position_after(&self, s: R) -> Vector<R> {
        self.position + (self.velocity + self.gravity.times(s * R::of(0.5))).times(s)
    }

    /// Its velocity then.
    pub fn velocity_after(&self, s: R) -> Vector<R> {
        self.velocity + self.gravity.times(s)
    }
}

/// What a ball meets.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub enum Met {
    /// A static shape, by its collider.
    Shape(usize),
    /// Another ball, by its place.
    Ball(usize),
}

/// An impact.
#[derive(Debug, Clone, Copy)]
pub struct Bounce<R> {
    /// Seconds since the scene's start.
    pub time: R,
    /// Which ball, by its place in the scene.
    pub ball: usize,
    /// With what.
    pub met: Met,
    /// The ball's centre.
    pub position: Vector<R>,
}

/// Why a solution ends where it does.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub enum Ending {
    /// At the time asked for.
    Time,
    /// After as many impacts as asked for.
    Bounces,
    /// A ball came to rest on something, rolls, or reached a plate or a saucer: the equations change.
    Rest,
    /// No ball is left.
    Gone,
    /// Beyond this the digits do not suffice.
    Digits,
}

/// How far a solution goes.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct Extent {
    /// Seconds.
    pub seconds: f64,
    /// Impacts.
    pub bounces: usize,
}

/// Variations of the arithmetic, to measure what they cost and do.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct Arithmetic {
    /// Of the time of impact.
    pub refinement: Refinement,
    /// Whether position and velocity are kept as f32 from one impact to the next.
    pub single: bool,
}

impl Arithmetic {
    /// As exact as the numbers are.
    pub const FULL: Self = Self { refinement: Refinement::FULL, single: false };
}

/// A scene solved.
#[derive(Debug, Clone)]
pub struct Solution<R> {
    /// Of each ball, its flights in order of time.
    pub flights: Vec<Vec<Flight<R>>>,
    /// When each ball was lost, if it was.
    pub lost: Vec<Option<R>>,
    /// Impacts, in order of time.
    pub bounces: Vec<Bounce<R>>,
    /// Seconds up to which it is known.
    pub end: f64,
    /// Why not further.
    pub ending: Ending,
    /// Evaluations that the roots took.
    pub steps: u64,
}

impl<R: Real> Solution<R> {
    /// Centre of a ball at `t` seconds; `None` once it is lost.
    pub fn position(&self, ball: usize, t: R) -> Option<Vector<R>> {
        if self.lost[ball].is_some_and(|lost| lost < t) {
            return None;
        }
        let flights = &self.flights[ball];
        let place = flights.partition_point(|flight| flight.start <= t).max(1) - 1;
        Some(flights[place].position_after(t - flights[place].start))
    }

    /// Forgets what lies beyond `seconds`.
    pub fn cut(&mut self, seconds: f64, ending: Ending) {
        if seconds < self.end {
            self.bounces.retain(|bounce| bounce.time.to_f64() <= seconds);
            (self.end, self.ending) = (seconds, ending);
        }
    }
}

/// A ball on its way.
struct Body<R> {
    flight: Flight<R>,
    spin: R,
    radius: R,
    mass: R,
    floor: u8,
    present: bool,
    /// What it met at its flight's start.
    touching: Option<Met>,
    /// What it meets next of the static shapes, seconds since the scene's start.
    next: Option<(R, Candidate)>,
    /// Which other ball it meets next.
    meets: Option<(R, usize)>,
}

/// Solves a scene, its balls displaced by `nudge(ball, coordinate)` times each of position and velocity.
pub fn solve<R: Real>(
    scene: &Scene,
    extent: Extent,
    arithmetic: Arithmetic,
    nudge: impl FnMut(f64) -> R,
) -> Solution<R> {
    Solver::new(scene, arithmetic, nudge).run(extent)
}

/// Where the wide arithmetic itself may be wrong by this much, m, it is not a reference any more.
const LEAST_DIGITS: f64 = 1e-12;
/// A last place of the wide numbers.
const WIDE_ROUNDING: f64 = 1e-31;

/// The reference of a scene: cut to where a change of the start by a last place makes no difference yet.
pub fn reference(scene: &Scene, extent: Extent) -> Solution<Wide> {
    let mut solution = solve(scene, extent, Arithmetic::FULL, Wide::of);
    let mut sign = 1.0;
    let other = solve(scene, extent, Arithmetic::FULL, |value| {
        sign = -sign;
        Wide::of(value) * (Wide::of(1.0) + Wide::of(sign * WIDE_ROUNDING))
    });
    let until = agree_until(&solution, &other, LEAST_DIGITS).0;
    solution.cut(until, Ending::Digits);
    solution
}

/// Seconds and impacts until another solution is off by more than `tolerance` metres, looked at at each impact of the first.
pub fn agree_until(truth: &Solution<Wide>, other: &Solution<Wide>, tolerance: f64) -> (f64, usize) {
    let mut until = 0.0;
    for (place, bounce) in truth.bounces.iter().enumerate() {
        let there = other.position(bounce.ball, bounce.time);
        let off = there.map_or(f64::INFINITY, |there| (there - bounce.position).length().to_f64());
        if off.is_nan() || off > tolerance {
            return (until, place);
        }
        until = bounce.time.to_f64();
    }
    (truth.end, truth.bounces.len())
}

/// A normal speed below which a ball is at rest in a scene that has no threshold, m/s: its hops are lost in rounding.
const STILL: f64 = 1e-13;

/// Impacts and passages after which a solution ends, whatever they are.
const MOST_HAPPENINGS: usize = 10_000;

struct Solver<'a, R> {
    scene: &'a Scene,
    arithmetic: Arithmetic,
    bodies: Vec<Body<R>>,
    /// Which targets still stand.
    standing: Vec<bool>,
    solution: Solution<R>,
}

impl<'a, R: Real> Solver<'a, R> {
    fn new(scene: &'a Scene, arithmetic: Arithmetic, mut nudge: impl FnMut(f64) -> R) -> Self {
        let mut vector = |v: DVec2| Vector { x: nudge(v.x), y: nudge(v.y) };
        let bodies: Vec<Body<R>> = scene
            .start
            .iter()
            .map(|ball| Body {
                flight: Flight {
                    start: R::of(0.0),
                    position: vector(ball.position),
                    velocity: vector(ball.velocity),
                    gravity: Vector::of(scene.gravity),
                },
                spin: R::of(0.0),
                radius: R::of(scene.radius(ball.kind)),
                mass: R::of(scene.mass(ball.kind)),
                floor: 0,
                present: true,
                touching: None,
                next: None,
                meets: None,
            })
            .collect();
        let solution = Solution {
            flights: bodies.iter().map(|body| vec![body.flight]).collect(),
            lost: vec![None; bodies.len()],
            bounces: Vec::new(),
            end: 0.0,
            ending: Ending::Time,
            steps: 0,
        };
        let standing: Vec<_> = scene.targets_at_start().collect();
        Self { scene, arithmetic, bodies, standing, solution }
    }

    fn run(mut self, extent: Extent) -> Solution<R> {
        for ball in 0..self.bodies.len() {
            self.look_ahead(ball);
        }
        // Lines that are passed do not count as impacts: two that lie on each other would be passed for ever.
        let most = MOST_HAPPENINGS + 100 * extent.bounces;
        for _ in 0..most {
            // 1. The first thing that happens to any ball.
            let Some((time, ball, with_ball)) = self.first() else {
                if self.bodies.iter().any(|body| body.present) {
                    return self.ended(extent.seconds, Ending::Time);
                }
                let last = self.solution.lost.iter().flatten().map(|lost| lost.to_f64()).fold(0.0, f64::max);
                return self.ended(last, Ending::Gone);
            };
            // 2. Far enough?
            if time.to_f64() > extent.seconds {
                return self.ended(extent.seconds, Ending::Time);
            }
            if self.solution.bounces.len() >= extent.bounces {
                return self.ended(time.to_f64(), Ending::Bounces);
            }
            // 3. It happens.
            let rests = if with_ball { self.balls_meet(time, ball) } else { self.ball_meets_shape(time, ball) };
            if rests {
                return self.ended(time.to_f64(), Ending::Rest);
            }
        }
        let last = self.first().map_or(0.0, |(time, ..)| time.to_f64());
        self.ended(last, Ending::Digits)
    }

    fn ended(mut self, end: f64, ending: Ending) -> Solution<R> {
        (self.solution.end, self.solution.ending) = (end, ending);
        self.solution
    }

    /// When, which ball, and whether it meets another.
    fn first(&self) -> Option<(R, usize, bool)> {
        let mut first: Option<(R, usize, bool)> = None;
        for (place, body) in self.bodies.iter().enumerate().filter(|(_, body)| body.present) {
            for (time, with_ball) in
                [body.next.map(|(time, _)| (time, false)), body.meets.map(|(time, _)| (time, true))]
                    .into_iter()
                    .flatten()
            {
                if first.is_none_or(|(earliest, ..)| time < earliest) {
                    first = Some((time, place, with_ball));
                }
            }
        }
        first
    }

    /// Whether the ball rests afterwards.
    fn ball_meets_shape(&mut self, time: R, ball: usize) -> bool {
        let Some((_, candidate)) = self.bodies[ball].next else { return false };
        let body = &mut self.bodies[ball];
        let s = time - body.flight.start;
        let (position, velocity) = (body.flight.position_after(s), body.flight.velocity_after(s));
        let Candidate::Collider(index) = candidate else {
            self.lose(ball, time);
            return false;
        };
        let collider = &self.scene.colliders[index];
        let after = match collider.role {
            Role::Drain => {
                self.lose(ball, time);
                return false;
            }
            // Neither are slopes that differ.
            Role::Hole { to } if self.scene.gravity_on(to) != self.scene.gravity => return true,
            Role::Hole { to } => {
                body.floor = to;
                (velocity, body.spin)
            }
            Role::Sensor => (velocity, body.spin),
            // Plates, saucers and magnets are none of its equations.
            Role::Hinge { .. } | Role::Saucer { .. } | Role::Field { .. } => return true,
            Role::Solid | Role::Kicker { .. } | Role::Target { .. } | Role::Standing { .. } => {
                let normal = search::normal(&collider.shape, position);
                let speed = (-velocity.dot(normal)).to_f64();
                let after = bounce(velocity, body.spin, body.radius, normal, collider);
                self.solution.bounces.push(Bounce { time, ball, met: Met::Shape(index), position });
                let returned = after.0.dot(normal).to_f64();
                let least = if self.scene.rest_speed > 0.0 { self.scene.rest_speed } else { STILL };
                if returned.abs() <= least && self.scene.gravity != DVec2::ZERO {
                    return true;
                }
                if let Role::Target { index, threshold } = collider.role
                    && speed >= threshold
                {
                    self.standing[usize::from(index)] = false;
                    self.fly(ball, time, position, after, Some(Met::Shape(usize::MAX)));
                    // What stood in somebody's way is gone.
                    (0..self.bodies.len()).for_each(|ball| self.look_ahead(ball));
                    return false;
                }
                after
            }
        };
        self.fly(ball, time, position, after, Some(Met::Shape(index)));
        self.look_ahead(ball);
        false
    }

    /// Two balls; never at rest.
    fn balls_meet(&mut self, time: R, ball: usize) -> bool {
        let Some((_, other)) = self.bodies[ball].meets else { return false };
        let at = |body: &Body<R>| {
            let s = time - body.flight.start;
            (body.flight.position_after(s), body.flight.velocity_after(s))
        };
        let (one, two) = (at(&self.bodies[ball]), at(&self.bodies[other]));
        let masses = (self.bodies[ball].mass, self.bodies[other].mass);
        let (after_one, after_two) = collide(one, two, masses, &self.scene.ball_material);
        self.solution.bounces.push(Bounce { time, ball, met: Met::Ball(other), position: one.0 });
        let spins = (self.bodies[ball].spin, self.bodies[other].spin);
        self.fly(ball, time, one.0, (after_one, spins.0), Some(Met::Ball(other)));
        self.fly(other, time, two.0, (after_two, spins.1), Some(Met::Ball(ball)));
        self.look_ahead(ball);
        self.look_ahead(other);
        false
    }

    fn lose(&mut self, ball: usize, time: R) {
        self.bodies[ball].present = false;
        self.solution.lost[ball] = Some(time);
        self.forget_meetings_with(ball);
    }

    /// A new flight.
    fn fly(&mut self, ball: usize, time: R, position: Vector<R>, after: (Vector<R>, R), touching: Option<Met>) {
        let body = &mut self.bodies[ball];
        let kept = |v: Vector<R>| {
            let v = v.to_f64();
            Vector { x: R::of(f64::from(v.x as f32)), y: R::of(f64::from(v.y as f32)) }
        };
        let (position, velocity) =
            if self.arithmetic.single { (kept(position), kept(after.0)) } else { (position, after.0) };
        body.flight = Flight { start: time, position, velocity, ..body.flight };
        (body.spin, body.touching) = (after.1, touching);
        self.solution.flights[ball].push(body.flight);
    }

    /// Finds what a ball meets next.
    fn look_ahead(&mut self, ball: usize) {
        let body = &self.bodies[ball];
        if !body.present {
            return;
        }
        let mut search = Search {
            scene: self.scene,
            flight: &body.flight,
            radius: body.radius,
            floor: body.floor,
            touching: match body.touching {
                Some(Met::Shape(index)) => Some(index),
                _ => None,
            },
            standing: &self.standing,
            refinement: self.arithmetic.refinement,
            steps: 0,
        };
        let next = search.first().map(|(s, candidate)| (body.flight.start + s, candidate));
        self.solution.steps += search.steps;
        self.bodies[ball].next = next;
        self.forget_meetings_with(ball);
        self.find_meeting(ball);
    }

    /// The first ball that a ball meets; whoever it is knows it, too.
    fn find_meeting(&mut self, ball: usize) {
        self.bodies[ball].meets = None;
        for other in 0..self.bodies.len() {
            if other == ball || !self.bodies[other].present || self.bodies[other].floor != self.bodies[ball].floor {
                continue;
            }
            let (one, two) = (&self.bodies[ball], &self.bodies[other]);
            let touching = one.touching == Some(Met::Ball(other)) && two.touching == Some(Met::Ball(ball));
            let Some(time) = meeting((&one.flight, one.radius), (&two.flight, two.radius), touching) else { continue };
            for (place, partner) in [(ball, other), (other, ball)] {
                let body = &mut self.bodies[place];
                if body.meets.is_none_or(|(known, _)| time < known) {
                    body.meets = Some((time, partner));
                }
            }
        }
    }

    /// Whoever was to meet this ball looks again.
    fn forget_meetings_with(&mut self, ball: usize) {
        for other in 0..self.bodies.len() {
            if other != ball && self.bodies[other].meets.is_some_and(|(_, partner)| partner == ball) {
                self.find_meeting(other);
            }
        }
    }
}

/// Whether a collider is there while flippers and plungers lie at rest.
pub(super) fn is_present(presence: Presence, standing: &[bool]) -> bool {
    match presence {
        Presence::Always | Presence::FlipperAtRest(_) | Presence::PlungerHome(_) => true,
        Presence::TargetUp(index) => standing[usize::from(index)],
        Presence::FlipperRaised(_) => false,
    }
}
