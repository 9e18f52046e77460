//! What glam and std lack, or do differently on different platforms: trigonometry on libm, lines and circles, polynomial
//! roots, a seeded generator, a digest of state.

mod digest;
mod rng;
pub mod roots;

pub mod bounded;
pub mod circle;
pub mod line;
pub use digest::{Digest, digest_of};
pub use rng::Rng;

use glam::DVec2;

/// Unit vector at `angle` radians from +y, clockwise. Measured so that `direction(-a)` is the exact mirror image of
/// `direction(a)`: `cos(pi - a)` is not `-cos(a)` in floating point.
pub fn direction(angle: f64) -> DVec2 {
    let (sin, cos) = libm::sincos(angle);
    DVec2::new(sin, cos)
}

/// Degrees to radians.
pub fn radians(degrees: f64) -> f64 {
    degrees * (core::f64::consts::PI / 180.0)
}

/// `vector` turned a quarter clockwise: the direction along a surface whose normal is `vector`.
pub fn tangent(vector: DVec2) -> DVec2 {
    DVec2::new(vector.y, -vector.x)
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn directions_are_mirror_images_bit_for_bit() {
        for k in 0..1000 {
            let a = f64::from(k) * 0.00314;
            let (right, left) = (direction(a), direction(-a));
            assert_eq!((right.x, right.y), (-left.x, left.y));
        }
    }

    #[test]
    fn the_tangent_is_clockwise() {
        assert_eq!(tangent(DVec2::Y), DVec2::X);
    }
}
