//! Numbers that the reference computes with: f64, and one of twice its digits.

use core::ops::{Add, Div, Mul, Neg, Sub};

use glam::DVec2;
use twofloat::TwoFloat;

/// The sum of two f64: 106 bits, about 32 digits.
#[derive(Debug, Clone, Copy, PartialEq, PartialOrd)]
pub struct Wide(TwoFloat);

/// What arithmetic the reference needs.
pub trait Real:
    Copy
    + PartialOrd
    + Add<Output = Self>
    + Sub<Output = Self>
    + Mul<Output = Self>
    + Div<Output = Self>
    + Neg<Output = Self>
{
    /// Half a last place of 1, or a little more.
    const ROUNDING: f64;
    /// Exactly that number.
    fn of(value: f64) -> Self;
    /// The nearest f64.
    fn to_f64(self) -> f64;
    /// Square root; of a negative number 0.
    fn root(self) -> Self;
    /// The same without its sign.
    fn size(self) -> Self {
        if self < Self::of(0.0) { -self } else { self }
    }
}

impl Real for f64 {
    const ROUNDING: f64 = f64::EPSILON;
    fn of(value: f64) -> Self {
        value
    }
    fn to_f64(self) -> f64 {
        self
    }
    fn root(self) -> Self {
        if self > 0.0 { self.sqrt() } else { 0.0 }
    }
}

impl Real for Wide {
    const ROUNDING: f64 = f64::EPSILON * f64::EPSILON;
    fn of(value: f64) -> Self {
        Self(TwoFloat::from_f64(value))
    }
    fn to_f64(self) -> f64 {
        self.0.hi()
    }
    fn root(self) -> Self {
        if self.0.hi() > 0.0 { Self(self.0.sqrt()) } else { Self::of(0.0) }
    }
}

impl Add for Wide {
    type Output = Self;
    fn add(self, other: Self) -> Self {
        Self(self.0 + other.0)
    }
}

impl Sub for Wide {
    type Output = Self;
    fn sub(self, other: Self) -> Self {
        Self(self.0 - other.0)
    }
}

impl Mul for Wide {
    type Output = Self;
    fn mul(self, other: Self) -> Self {
        Self(self.0 * other.0)
    }
}

impl Neg for Wide {
    type Output = Self;
    fn neg(self) -> Self {
        Self(-self.0)
    }
}

impl Div for Wide {
    type Output = Self;
    /// Long division, a word at a time. The crate's own (0.8.4) is right to the digits of one f64 only.
    fn div(self, other: Self) -> Self {
        let (mut rest, mut quotient) = (self.0, TwoFloat::from_f64(0.0));
        for _ in 0..3 {
            let word = rest.hi() / other.0.hi();
            rest -= other.0 * word;
            quotient += word;
        }
        Self(quotient)
    }
}

/// A vector of such numbers.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct Vector<R> {
    /// To the right.
    pub x: R,
    /// Up the table.
    pub y: R,
}

impl<R: Real> Vector<R> {
    /// Exactly that vector.
    pub fn of(v: DVec2) -> Self {
        Self { x: R::of(v.x), y: R::of(v.y) }
    }

    /// The nearest vector of f64.
    pub fn to_f64(self) -> DVec2 {
        DVec2::new(self.x.to_f64(), self.y.to_f64())
    }

    /// Scalar product.
    pub fn dot(self, other: Self) -> R {
        self.x * other.x + self.y * other.y
    }

    /// Euclidean.
    pub fn length(self) -> R {
        self.dot(self).root()
    }

    /// A quarter of a turn counter-clockwise.
    pub fn turned(self) -> Self {
        Self { x: -self.y, y: self.x }
    }

    /// Each coordinate times `factor`.
    pub fn times(self, factor: R) -> Self {
        Self { x: self.x * factor, y: self.y * factor }
    }
}

impl<R: Real> Add for Vector<R> {
    type Output = Self;
    fn add(self, other: Self) -> Self {
        Self { x: self.x + other.x, y: self.y + other.y }
    }
}

impl<R: Real> Sub for Vector<R> {
    type Output = Self;
    fn sub(self, other: Self) -> Self {
        Self { x: self.x - other.x, y: self.y - other.y }
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    /// The crate's arithmetic is what the reference stands on.
    #[test]
    fn thirty_one_digits_are_kept() {
        let third = Wide::of(1.0) / Wide::of(3.0);
        assert!((third * Wide::of(3.0) - Wide::of(1.0)).size().to_f64() < 1e-31);
        let root = Wide::of(2.0).root();
        assert!((root * root - Wide::of(2.0)).size().to_f64() < 1e-31);
        let small = Wide::of(1e-20);
        assert_eq!(((Wide::of(1.0) + small) - Wide::of(1.0)).to_f64(), 1e-20);
        let tenth = Wide::of(1.0) / Wide::of(10.0);
        let error = (Wide::of(0.1) - tenth).to_f64();
        assert!((error - 5.551_115_123_125_783e-18).abs() < 1e-31, "the double next to a tenth is off by {error:e}");
    }
}
