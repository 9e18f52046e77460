//! Moving flippers and plungers within one tick, and when a ball meets them.

use glam::DVec2;

use super::ball::Flight;
use super::constants::{GRAZE, MOVER_HALVINGS, MOVER_PARTS};
use super::contact::{Mobility, Surface};
use super::flipper::{FlipperMotion, FlipperSpec, Nearest};
use super::motion::Span;
use super::plunger::{PlungerMotion, PlungerSpec};
use crate::math::roots::quadratic;
use crate::math::tangent;

/// More than 1, by more than any rounding.
const CLEARLY: f64 = 1.0 + 1e-6;

/// Share of a ball's radius by which a gap is open beyond any rounding, and so is what lies between it and a touch a part of a
/// tick before.
const SURELY_OPEN: f64 = 1e-6;

/// A ball's flight and where in it the current tick begins.
#[derive(Debug, Clone, Copy)]
pub(super) struct BallInTick<'a> {
    pub(super) flight: &'a Flight,
    /// Seconds from the flight's start to the start of the tick.
    pub(super) elapsed: f64,
    pub(super) radius: f64,
}

impl BallInTick<'_> {
    fn position(&self, offset: f64) -> DVec2 {
        self.flight.position_at(self.elapsed + offset)
    }

    fn velocity(&self, offset: f64) -> DVec2 {
        self.flight.velocity_at(self.elapsed + offset)
    }
}

/// A moving body that a ball can meet.
pub(super) trait Mover {
    /// The surface nearest to `point` at `offset` seconds into the tick.
    fn nearest(&self, offset: f64, point: DVec2) -> Nearest;
    /// Velocity of the surface's point at `point`.
    fn velocity(&self, offset: f64, point: DVec2) -> DVec2;
    /// More than any of its points can move within the tick, in m/s, as seen by a ball `distance` away at most.
    fn top_speed(&self, until: f64) -> f64;
    /// More than the gap to a ball can bend towards the body within `offsets`, m/s^2; infinite where it can jump.
    fn bend(&self, ball: &BallInTick<'_>, offsets: Span) -> f64;
    /// The surface that a ball meets there.
    fn surface(&self, offset: f64, center: DVec2, normal: DVec2, radius: f64) -> Surface;
}

/// A flipper on its way.
pub(super) struct MovingFlipper<'a> {
    pub(super) spec: &'a FlipperSpec,
    pub(super) motion: FlipperMotion,
}

/// Lever arm about a flipper's pivot of a push along `normal` at `contact`, in the sense of the swing, m.
pub(super) fn lever(spec: &FlipperSpec, contact: DVec2, normal: DVec2) -> f64 {
    spec.turn_rate((contact - spec.pivot).perp_dot(normal))
}

impl MovingFlipper<'_> {
    /// When it reaches an end stop: the offset, and whether it is the upper one.
    pub(super) fn meets_stop(&self, from: f64, until: f64) -> Option<(f64, bool)> {
        let motion = &self.motion;
        let swing = motion.swing_at(from);
        let speed = motion.speed_at(from);
        if swing <= 0.0 && (speed < 0.0 || (speed == 0.0 && motion.acceleration < 0.0)) {
            return Some((from, false));
        }
        if swing >= self.spec.stroke && (speed > 0.0 || (speed == 0.0 && motion.acceleration > 0.0)) {
            return Some((from, true));
        }
        // So far from both that it comes to none of them, rounding or not.
        let left = until - from;
        let way = CLEARLY * (speed.abs() + motion.acceleration.abs() * left) * left;
        if swing > way && self.spec.stroke - swing > way {
            return None;
        }
        let mut first = None;
        let mut limit = until;
        for (gap, sign, upper) in [(motion.swing, 1.0, false), (self.spec.stroke - motion.swing, -1.0, true)] {
            let (rate, half_pull) = (sign * motion.speed, sign * 0.5 * motion.acceleration);
            for &t in quadratic([gap, rate, half_pull]).as_slice() {
                let offset = motion.from + t;
                // At `from` itself, too: another flipper may have met its stop at the same instant.
                if rate + 2.0 * half_pull * t < 0.0 && offset >= from && offset < limit {
                    limit = offset;
                    first = Some((offset, upper));
                }
            }
        }
        first
    }
}

impl Mover for MovingFlipper<'_> {
    fn nearest(&self, offset: f64, point: DVec2) -> Nearest {
        self.spec.nearest(self.spec.direction(self.motion.swing_at(offset)), point)
    }

    fn velocity(&self, offset: f64, point: DVec2) -> DVec2 {
        self.spec.surface_velocity(self.motion.speed_at(offset), point)
    }

    fn top_speed(&self, until: f64) -> f64 {
        let (a, b) = (self.motion.speed.abs(), self.motion.speed_at(until).abs());
        let rate = if a > b { a } else { b };
        rate * self.spec.reach()
    }

    fn bend(&self, ball: &BallInTick<'_>, Span { from, to }: Span) -> f64 {
        // Seen from the flipper, which is convex: whatever has no acceleration parts from it ever faster.
        let (a, b) = (self.motion.speed_at(from).abs(), self.motion.speed_at(to).abs());
        let turn = if a > b { a } else { b };
        let pull = ball.flight.acceleration.length();
        let speed = ball.velocity(from).length() + pull * (to - from);
        let arm = (ball.position(from) - self.spec.pivot).length() + speed * (to - from);
        pull + 2.0 * turn * (speed + turn * arm) + (turn * turn + self.motion.acceleration.abs()) * arm
    }

    fn surface(&self, offset: f64, center: DVec2, normal: DVec2, radius: f64) -> Surface {
        let contact = center - normal * radius;
        let levers = [normal, tangent(normal)].map(|push| lever(self.spec, contact, push));
        Surface {
            normal,
            velocity: self.velocity(offset, contact),
            material: self.spec.material,
            mobility: Mobility::on_axis(levers[0], levers[1], self.spec.inertia),
            kick: 0.0,
        }
    }
}

/// A plunger on its way.
pub(super) struct MovingPlunger<'a> {
    pub(super) spec: &'a PlungerSpec,
    pub(super) motion: PlungerMotion,
    /// A hand that holds it does not give way.
    pub(super) held: bool,
}

impl Mover for MovingPlunger<'_> {
    fn nearest(&self, offset: f64, point: DVec2) -> Nearest {
        let distance = self.spec.distance(self.motion.pull_at(offset), point);
        Nearest { distance, normal: self.spec.normal, radius: f64::INFINITY }
    }

    fn velocity(&self, offset: f64, _point: DVec2) -> DVec2 {
        -self.spec.normal * self.motion.speed_at(offset)
    }

    fn top_speed(&self, until: f64) -> f64 {
        let (a, b) = (self.motion.speed.abs(), self.motion.speed_at(until).abs());
        if a > b { a } else { b }
    }

    fn bend(&self, _ball: &BallInTick<'_>, _offsets: Span) -> f64 {
        f64::INFINITY
    }

    fn surface(&self, offset: f64, center: DVec2, normal: DVec2, _radius: f64) -> Surface {
        Surface {
            normal,
            velocity: self.velocity(offset, center),
            material: self.spec.material,
            mobility: Mobility { normal: if self.held { 0.0 } else { 1.0 / self.spec.mass }, ..Mobility::default() },
            kick: 0.0,
        }
    }
}

/// The moments at which a model looks that does not look all the time: offsets within the tick, from the first to its end.
#[derive(Debug, Clone, Copy)]
pub(super) struct Moments {
    pub(super) first: f64,
    pub(super) end: f64,
    pub(super) parts: u32,
}

/// A ball meets a moving body.
#[derive(Debug, Clone, Copy)]
pub(super) struct MoverImpact {
    /// Seconds into the tick.
    pub(super) offset: f64,
    /// Of the body, towards the ball.
    pub(super) normal: DVec2,
    /// Of the ball's centre, m: on the surface.
    pub(super) position: DVec2,
}

/// When, within the offsets `from..until` of the tick, a ball meets a moving body.
///
/// Conservative advancement (Mirtich 1996) with a least step of 1/64 tick, then bisection: the moving gap has no
/// polynomial to solve. A model that looks at some moments only finds an overlap at one of them.
pub(super) fn first_impact(
    ball: &BallInTick<'_>,
    mover: &impl Mover,
    moments: Option<Moments>,
    from: f64,
    until: f64,
    tick_seconds: f64,
) -> Option<MoverImpact> {
    let gap = |offset: f64| mover.nearest(offset, ball.position(offset)).distance - ball.radius;
    let closing = |offset: f64| {
        let center = ball.position(offset);
        let normal = mover.nearest(offset, center).normal;
        let contact = center - normal * ball.radius;
        let (velocity, surface) = (ball.velocity(offset), mover.velocity(offset, contact));
        let speed = (velocity - surface).dot(normal);
        // After an impact that took all of the bounce, a rounding is left; to meet that again would never end.
        (speed < -GRAZE * (velocity.length() + surface.length())).then_some(normal)
    };
    if let Some(Moments { first, end, parts }) = moments {
        let step = (end - first) / f64::from(parts);
        let offsets = (0..=parts).map(|part| if part == parts { end } else { first + step * f64::from(part) });
        return offsets.filter(|&offset| offset >= from && offset < until).find_map(|offset| {
            let gap = gap(offset);
            let normal = if gap <= 0.0 { closing(offset)? } else { return None };
            Some(MoverImpact { offset, normal, position: ball.position(offset) - normal * gap })
        });
    }
    let impact =
        |offset: f64| closing(offset).map(|normal| MoverImpact { offset, normal, position: ball.position(offset) });
    let least_step = tick_seconds / f64::from(MOVER_PARTS);
    let fastest =
        mover.top_speed(until) + ball.velocity(from).length() + ball.flight.acceleration.length() * tick_seconds;
    let bend = mover.bend(ball, Span { from, to: until });
    // Whether the gap that is `nearest` at that offset is surely open from the next moment that is looked at until the end.
    let stays_open = |offset: f64, nearest: &Nearest| {
        let (gap, left) = (nearest.distance - ball.radius, until - offset);
        let contact = ball.position(offset) - nearest.normal * ball.radius;
        let opening = (ball.velocity(offset) - mover.velocity(offset, contact)).dot(nearest.normal);
        let least = gap + (opening - 0.5 * CLEARLY * bend * left) * left;
        let overlap = if gap < 0.0 { -gap } else { 0.0 };
        least > SURELY_OPEN * ball.radius + 2.0 * f64::from(MOVER_PARTS) * overlap
    };
    let mut left = from;
    let mut nearest = mover.nearest(left, ball.position(left));
    let mut gap_left = nearest.distance - ball.radius;
    if gap_left <= 0.0
        && let Some(impact) = impact(left)
    {
        return Some(impact);
    }
    while left < until {
        let safe = gap_left / fastest;
        // It does not come there before.
        if safe > CLEARLY * (until - left) || stays_open(left, &nearest) {
            return None;
        }
        let step = if safe > least_step { safe } else { least_step };
        let right = if left + step < until { left + step } else { until };
        nearest = mover.nearest(right, ball.position(right));
        let gap_right = nearest.distance - ball.radius;
        if gap_right <= 0.0
            && gap_left > 0.0
            && let Some(impact) = impact(bisect(gap, left, right))
        {
            return Some(impact);
        }
        // In touch all the while, and only now the one comes towards the other.
        if gap_right <= 0.0
            && gap_left <= 0.0
            && right < until
            && let Some(impact) = impact(right)
        {
            return Some(impact);
        }
        (left, gap_left) = (right, gap_right);
    }
    None
}

/// The last moment before the gap closes.
fn bisect(gap: impl Fn(f64) -> f64, mut open: f64, mut closed: f64) -> f64 {
    for _ in 0..MOVER_HALVINGS {
        let middle = 0.5 * (open + closed);
        if gap(middle) > 0.0 {
            open = middle;
        } else {
            closed = middle;
        }
    }
    open
}
