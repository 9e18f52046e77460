//! Shapes by signed distance: how far a point is outside (positive) or inside (negative) of an outline, in pixels.
//! Whatever is painted from a distance is antialiased, shaded and shadowed exactly, at any size.

use macroquad::math::{Rect, Vec2, vec2};

/// An outline in pixels, y down.
#[derive(Debug, Clone)]
pub(super) enum Shape {
    /// A disc.
    Circle { center: Vec2, radius: f32 },
    /// A rod with round ends that may differ: a flipper, for example.
    Capsule { from: Vec2, to: Vec2, from_radius: f32, to_radius: f32 },
    /// A closed area; the last point joins the first.
    Polygon(Vec<Vec2>),
    /// A line through points with round joints.
    Path { points: Vec<Vec2>, radius: f32 },
    /// A part of a circle with a thickness; angles in radians clockwise from straight up.
    Arc { center: Vec2, radius: f32, from: f32, to: f32, half_width: f32 },
    /// A rectangle with round corners.
    Plate { rect: Rect, corner: f32 },
    /// What a rectangle has outside a circle: the corners over an arch.
    Spandrel { rect: Rect, center: Vec2, radius: f32 },
    /// Several shapes as one.
    Union(Vec<Shape>),
}

/// The unit vector of an angle in radians, clockwise from straight up, on a surface whose y runs down.
pub(super) fn direction(angle: f32) -> Vec2 {
    vec2(angle.sin(), -angle.cos())
}

/// A star of `points` tips, one of them straight up when `turn` is 0.
pub(super) fn star(center: Vec2, points: u32, outer: f32, inner: f32, turn: f32) -> Shape {
    let step = std::f32::consts::PI / points as f32;
    let corner = |i: u32| center + direction(turn + step * i as f32) * if i.is_multiple_of(2) { outer } else { inner };
    Shape::Polygon((0..points * 2).map(corner).collect())
}

impl Shape {
    /// A disc.
    pub(super) fn circle(center: Vec2, radius: f32) -> Self {
        Self::Circle { center, radius }
    }

    /// A straight rod with round ends.
    pub(super) fn rod(from: Vec2, to: Vec2, radius: f32) -> Self {
        Self::Capsule { from, to, from_radius: radius, to_radius: radius }
    }

    /// Signed distance of a point to the outline.
    pub(super) fn distance(&self, p: Vec2) -> f32 {
        match self {
            Self::Circle { center, radius } => p.distance(*center) - radius,
            Self::Capsule { from, to, from_radius, to_radius } => capsule(p, *from, *to, *from_radius, *to_radius),
            Self::Polygon(points) => polygon(p, points),
            Self::Path { points, radius } => path(p, points) - radius,
            Self::Arc { center, radius, from, to, half_width } => arc(p - *center, *radius, *from, *to) - half_width,
            Self::Plate { rect, corner } => plate(p, *rect, *corner),
            Self::Spandrel { rect, center, radius } => plate(p, *rect, 0.0).max(radius - p.distance(*center)),
            Self::Union(parts) => parts.iter().map(|part| part.distance(p)).fold(f32::INFINITY, f32::min),
        }
    }

    /// The direction in which the distance grows fastest: outward across the outline.
    pub(super) fn normal(&self, p: Vec2) -> Vec2 {
        const STEP: f32 = 0.6;
        let dx = self.distance(p + vec2(STEP, 0.0)) - self.distance(p - vec2(STEP, 0.0));
        let dy = self.distance(p + vec2(0.0, STEP)) - self.distance(p - vec2(0.0, STEP));
        vec2(dx, dy).normalize_or_zero()
    }

    /// A rectangle that holds the whole shape.
    pub(super) fn bounds(&self) -> Rect {
        match self {
            Self::Circle { center, radius } => around(&[*center], *radius),
            Self::Capsule { from, to, from_radius, to_radius } => around(&[*from, *to], from_radius.max(*to_radius)),
            Self::Polygon(points) => around(points, 0.0),
            Self::Path { points, radius } => around(points, *radius),
            Self::Arc { center, radius, half_width, .. } => around(&[*center], radius + half_width),
            Self::Plate { rect, .. } | Self::Spandrel { rect, .. } => *rect,
            Self::Union(parts) => {
                let boxes = parts.iter().map(Self::bounds);
                boxes.reduce(Rect::combine_with).unwrap_or_default()
            }
        }
    }
}

/// The box around points, wider by `margin` on every side.
fn around(points: &[Vec2], margin: f32) -> Rect {
    let Some(first) = points.first() else {
        return Rect::default();
    };
    let low = points.iter().fold(*first, |a, b| a.min(*b)) - margin;
    let high = points.iter().fold(*first, |a, b| a.max(*b)) + margin;
    Rect::new(low.x, low.y, high.x - low.x, high.y - low.y)
}

/// Square of the distance to a straight line between two points: one root for a whole outline is enough.
fn segment_squared(p: Vec2, from: Vec2, to: Vec2) -> f32 {
    let along = to - from;
    let share = ((p - from).dot(along) / along.length_squared().max(f32::EPSILON)).clamp(0.0, 1.0);
    (p - from - along * share).length_squared()
}

fn path(p: Vec2, points: &[Vec2]) -> f32 {
    points.windows(2).map(|ends| segment_squared(p, ends[0], ends[1])).fold(f32::INFINITY, f32::min).sqrt()
}

fn capsule(p: Vec2, from: Vec2, to: Vec2, from_radius: f32, to_radius: f32) -> f32 {
    let length = from.distance(to);
    if length <= (from_radius - to_radius).abs() {
        // One end swallows the other.
        return (p.distance(from) - from_radius).min(p.distance(to) - to_radius);
    }
    let axis = (to - from) / length;
    let local = vec2(axis.perp_dot(p - from).abs(), axis.dot(p - from));
    // The flanks touch both circles; `slope` is the sine of the angle between flank and axis.
    let slope = (from_radius - to_radius) / length;
    let flank = (1.0 - slope * slope).sqrt();
    let height = local.dot(vec2(-slope, flank));
    if height < 0.0 {
        local.length() - from_radius
    } else if height > flank * length {
        local.distance(vec2(0.0, length)) - to_radius
    } else {
        local.dot(vec2(flank, slope)) - from_radius
    }
}

fn polygon(p: Vec2, points: &[Vec2]) -> f32 {
    let mut nearest = f32::INFINITY;
    let mut inside = false;
    let mut previous = match points.last() {
        Some(last) => *last,
        None => return f32::INFINITY,
    };
    for &point in points {
        nearest = nearest.min(segment_squared(p, previous, point));
        // A ray to the right crosses this edge: the point changes sides.
        if (point.y > p.y) != (previous.y > p.y)
            && p.x < (previous.x - point.x) * (p.y - point.y) / (previous.y - point.y) + point.x
        {
            inside = !inside;
        }
        previous = point;
    }
    if inside { -nearest.sqrt() } else { nearest.sqrt() }
}

fn arc(p: Vec2, radius: f32, from: f32, to: f32) -> f32 {
    let turn = (p.x.atan2(-p.y) - from).rem_euclid(std::f32::consts::TAU);
    if turn <= to - from {
        (p.length() - radius).abs()
    } else {
        p.distance(direction(from) * radius).min(p.distance(direction(to) * radius))
    }
}

fn plate(p: Vec2, rect: Rect, corner: f32) -> f32 {
    let corner = corner.min(rect.w.min(rect.h) / 2.0);
    let beyond = (p - rect.center()).abs() - vec2(rect.w, rect.h) / 2.0 + corner;
    beyond.max(Vec2::ZERO).length() + beyond.max_element().min(0.0) - corner
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn a_capsule_of_equal_ends_is_a_thick_line() {
        let rod = Shape::rod(vec2(0.0, 0.0), vec2(10.0, 0.0), 2.0);
        assert!((rod.distance(vec2(5.0, 5.0)) - 3.0).abs() < 1e-5);
        assert!((rod.distance(vec2(14.0, 0.0)) - 2.0).abs() < 1e-5);
        assert!((rod.distance(vec2(5.0, 0.0)) + 2.0).abs() < 1e-5);
    }

    #[test]
    fn a_polygon_is_negative_inside_only() {
        let square = Shape::Polygon(vec![vec2(0.0, 0.0), vec2(4.0, 0.0), vec2(4.0, 4.0), vec2(0.0, 4.0)]);
        assert!((square.distance(vec2(2.0, 1.0)) + 1.0).abs() < 1e-5);
        assert!((square.distance(vec2(7.0, 8.0)) - 5.0).abs() < 1e-5);
    }

    #[test]
    fn an_arc_ends_where_it_says() {
        let quarter = Shape::Arc {
            center: Vec2::ZERO,
            radius: 10.0,
            from: 0.0,
            to: std::f32::consts::FRAC_PI_2,
            half_width: 1.0,
        };
        // On the arc (up and to the right), and a quarter beyond its end.
        assert!((quarter.distance(direction(0.7) * 10.0) + 1.0).abs() < 1e-4);
        assert!((quarter.distance(vec2(0.0, 10.0)) - (200.0_f32.sqrt() - 1.0)).abs() < 1e-4);
    }

    #[test]
    fn bounds_hold_the_shape() {
        let shapes = [
            Shape::circle(vec2(5.0, 6.0), 3.0),
            star(vec2(1.0, 2.0), 5, 9.0, 4.0, 0.3),
            Shape::Capsule { from: vec2(0.0, 0.0), to: vec2(9.0, 3.0), from_radius: 4.0, to_radius: 1.0 },
        ];
        for shape in shapes {
            let bounds = shape.bounds();
            for y in -20..40 {
                for x in -20..40 {
                    let p = vec2(x as f32 / 2.0, y as f32 / 2.0);
                    assert!(shape.distance(p) > -1e-4 || bounds.contains(p), "{shape:?} {p}");
                }
            }
        }
    }
}
