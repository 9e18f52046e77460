//! The ways of balls as lines: what a world's steps have done to them, point by point.
//!
//! A flight is a parabola, so a few points of it are enough; an impact is one of the points, to the bit.

use std::collections::BTreeMap;

use glam::DVec2;

use super::foresight::normal_of;
use crate::physics::ball::{Ball, Flight, Instant};
use crate::physics::{Event, EventKind, World};

/// How far a line may be off the parabola that it stands for, in radii of the ball.
const SLACK: f64 = 0.005;
/// Most pieces of one flight, and so the most that a very long one costs.
const MOST_PIECES: f64 = 2000.0;

/// A ball's way.
#[derive(Debug, Clone, PartialEq)]
pub struct Track {
    /// The ball's id.
    pub ball: u32,
    /// Its radius, m.
    pub radius: f64,
    /// A line through these, m; the last one is where the ball is, or was when it left.
    pub points: Vec<DVec2>,
    /// What happened to it on the way.
    pub impacts: Vec<Impact>,
    /// What it flies on, and when the last point was.
    flight: Flight,
    since: Instant,
    is_closed: bool,
}

/// Something that happened to a ball.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct Impact {
    /// When, where and what.
    pub event: Event,
    /// Unit normal of the surface towards the ball, or from the other ball; `None` where nothing was met.
    pub normal: Option<DVec2>,
}

/// The ways of all balls of a world from one moment on.
#[derive(Debug, Clone)]
pub struct Tracks {
    tracks: BTreeMap<u32, Track>,
    stops_at_impact: bool,
}

impl Tracks {
    /// From `from` on, which must be in the world's present tick. `stops_at_impact`: a ball's way ends where something
    /// changes it; what it merely passes does not.
    pub fn begin(world: &World, from: Instant, stops_at_impact: bool) -> Self {
        let tracks = world.state().balls.iter().map(|ball| (ball.id, Track::begin(world, ball, from))).collect();
        Self { tracks, stops_at_impact }
    }

    /// Notes what the last step did.
    pub fn after_step(&mut self, world: &World) {
        let dt = world.scene().tick_seconds;
        for event in world.events() {
            // A ball that came and was lost within the step had no way to speak of.
            let Some(track) = self.tracks.get_mut(&event.ball).filter(|track| !track.is_closed) else { continue };
            track.draw_to(event.at, Some(event.position), dt);
            track.impacts.push(Impact { event: *event, normal: normal_of(world, event) });
            if !matches!(event.kind, EventKind::Passed { .. }) {
                // Until the ball itself is asked: it may be gone by the end of the step.
                let (position, velocity, acceleration) = (event.position, event.velocity, world.scene().gravity);
                track.flight = Flight { start: event.at, position, velocity, acceleration };
                track.is_closed = self.stops_at_impact || matches!(event.kind, EventKind::Drained | EventKind::Escaped);
            }
        }
        for ball in &world.state().balls {
            match self.tracks.get_mut(&ball.id) {
                Some(track) if track.is_closed => {}
                Some(track) => track.follow(ball, dt),
                None => {
                    self.tracks.insert(ball.id, Track::begin(world, ball, ball.flight.start));
                }
            }
        }
    }

    /// Whether every ball's way has ended.
    pub fn are_closed(&self) -> bool {
        self.tracks.values().all(|track| track.is_closed)
    }

    /// The ways up to the present, by the balls' ids.
    pub fn finish(self, world: &World) -> Vec<Track> {
        let (now, dt) = (Instant::start_of(world.state().tick), world.scene().tick_seconds);
        let mut tracks: Vec<Track> = self.tracks.into_values().collect();
        for track in &mut tracks {
            let is_here = world.state().balls.iter().any(|ball| ball.id == track.ball);
            if is_here && !track.is_closed {
                track.draw_to(now, None, dt);
            }
        }
        tracks
    }
}

impl Track {
    fn begin(world: &World, ball: &Ball, from: Instant) -> Self {
        let (position, _) = ball.at(from, world.scene().tick_seconds);
        Self {
            ball: ball.id,
            radius: world.scene().radius(ball.kind),
            points: vec![position],
            impacts: Vec::new(),
            flight: ball.flight,
            since: from,
            is_closed: false,
        }
    }

    /// The ball may have begun another flight without a word: along a surface, or off its end.
    fn follow(&mut self, ball: &Ball, dt: f64) {
        if ball.flight == self.flight {
            return;
        }
        if ball.flight.start.since(self.since, dt) > 0.0 {
            self.draw_to(ball.flight.start, Some(ball.flight.position), dt);
        }
        self.flight = ball.flight;
    }

    /// Draws along the flight up to `until`, where the ball is at `end`.
    fn draw_to(&mut self, until: Instant, end: Option<DVec2>, dt: f64) {
        let (from, to) = (self.since.since(self.flight.start, dt), until.since(self.flight.start, dt));
        self.since = until;
        let end = end.unwrap_or_else(|| self.flight.position_at(to));
        // The arrow of a chord over a time t is a t^2 / 8.
        let bend = self.flight.acceleration.length() * (to - from) * (to - from) / (8.0 * SLACK * self.radius);
        let pieces = bend.sqrt().min(MOST_PIECES).ceil();
        for piece in 1..pieces as u32 {
            self.points.push(self.flight.position_at(from + (to - from) * f64::from(piece) / pieces));
        }
        // A ball that lies still on something that moves begins a flight with every tick.
        let is_new = self.points.last().is_none_or(|last| (end - *last).length() > SLACK * self.radius);
        if is_new {
            self.points.push(end);
        } else if let Some(last) = self.points.last_mut()
            && self.impacts.last().is_none_or(|impact| impact.event.position != *last)
        {
            *last = end;
        }
    }
}
