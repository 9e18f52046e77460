//! Every real root of a polynomial up to the fourth degree, isolated.
//!
//! Between two neighbouring roots of its derivative a polynomial is monotonic: there is one root where the signs at the ends
//! differ, and none where they do not. So the roots of the derivatives, from the linear one upwards, isolate all.

use super::real::Real;

/// How the last digits of a root are found.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct Refinement {
    /// Steps smaller than this, in seconds, are not taken; 0: to the last digit.
    pub tolerance: f64,
}

impl Refinement {
    /// To the last digit.
    pub const FULL: Self = Self { tolerance: 0.0 };
}

/// The roots of `c[0] + c[1] t + ...` within `from..=to` at which it changes its sign, in rising order. `steps` counts
/// evaluations.
pub fn roots<R: Real>(c: &[R], from: R, to: R, refinement: Refinement, steps: &mut u64) -> Vec<R> {
    let zero = R::of(0.0);
    let degree = c.iter().rposition(|&c| c != zero).unwrap_or(0);
    if degree == 0 || from >= to {
        return Vec::new();
    }
    let mut ends = vec![from];
    if degree > 1 {
        let slope: Vec<R> = (1..=degree).map(|k| c[k] * R::of(k as f64)).collect();
        ends.extend(roots(&slope, from, to, Refinement::FULL, steps));
    }
    ends.push(to);
    let mut found = Vec::new();
    for pair in ends.windows(2) {
        let (low, high) = (value(c, degree, pair[0]), value(c, degree, pair[1]));
        if low == zero && pair[0] == from {
            found.push(pair[0]);
        } else if (low < zero) != (high < zero) && low != zero {
            found.push(bracketed(c, degree, pair[0], pair[1], low < zero, refinement, steps));
        }
    }
    found
}

/// The root between two ends with different signs: Newton's method, halving where that would leave the bracket.
fn bracketed<R: Real>(
    c: &[R],
    degree: usize,
    mut left: R,
    mut right: R,
    rising: bool,
    refinement: Refinement,
    steps: &mut u64,
) -> R {
    let (zero, half) = (R::of(0.0), R::of(0.5));
    let mut t = (left + right) * half;
    for _ in 0..MOST_STEPS {
        *steps += 1;
        let at = value(c, degree, t);
        if at == zero {
            return t;
        }
        if (at < zero) == rising {
            left = t;
        } else {
            right = t;
        }
        let slope = slope(c, degree, t);
        let newton = if slope == zero { left } else { t - at / slope };
        let next = if newton > left && newton < right { newton } else { (left + right) * half };
        let change = (next - t).size().to_f64();
        if change <= refinement.tolerance || change <= 0.5 * R::ROUNDING * t.size().to_f64() {
            return next;
        }
        t = next;
    }
    t
}

/// Halvings of any bracket down to the last of 106 bits, with room for Newton's detours.
const MOST_STEPS: u32 = 300;

fn value<R: Real>(c: &[R], degree: usize, t: R) -> R {
    c[..degree].iter().rev().fold(c[degree], |sum, &c| sum * t + c)
}

fn slope<R: Real>(c: &[R], degree: usize, t: R) -> R {
    (1..degree).rev().fold(c[degree] * R::of(degree as f64), |sum, k| sum * t + c[k] * R::of(k as f64))
}

#[cfg(test)]
mod tests {
    use super::super::real::Wide;
    use super::*;

    fn all<R: Real>(c: &[f64], from: f64, to: f64) -> Vec<R> {
        let c: Vec<R> = c.iter().map(|&c| R::of(c)).collect();
        roots(&c, R::of(from), R::of(to), Refinement::FULL, &mut 0)
    }

    #[test]
    fn four_roots_of_a_quartic_to_thirty_digits() {
        // (t - 1)(t - 2)(t - 4)(t - 8)
        let found = all::<Wide>(&[64.0, -120.0, 70.0, -15.0, 1.0], 0.0, 10.0);
        assert_eq!(found.len(), 4);
        for (found, expected) in found.into_iter().zip([1.0, 2.0, 4.0, 8.0]) {
            assert!((found - Wide::of(expected)).size().to_f64() < 1e-29, "{found:?}");
        }
    }

    #[test]
    fn two_roots_a_billionth_apart_are_two() {
        // (t - 1)^2 - 1e-18: in f64 the constant term rounds to 1.
        let c = [Wide::of(1.0) - Wide::of(1e-18), Wide::of(-2.0), Wide::of(1.0)];
        let found = roots(&c, Wide::of(0.0), Wide::of(3.0), Refinement::FULL, &mut 0);
        assert_eq!(found.len(), 2);
        assert!((found[1] - found[0] - Wide::of(2e-9)).size().to_f64() < 1e-22);
    }

    #[test]
    fn a_touch_and_an_empty_range_have_none() {
        assert!(
            all::<f64>(&[1.0, -2.0, 1.0], 0.0, 3.0).len() <= 1,
            "a double root is no change of sign, but for rounding"
        );
        assert!(all::<f64>(&[1.0, 0.0, 1.0], -3.0, 3.0).is_empty());
        assert!(all::<f64>(&[-1.0, 1.0], 2.0, 3.0).is_empty());
        assert!(all::<f64>(&[0.0, 0.0, 0.0], 0.0, 1.0).is_empty());
    }

    #[test]
    fn a_coarse_tolerance_takes_fewer_steps() {
        let c = [-2.0, 0.0, 1.0];
        let (mut fine, mut coarse) = (0, 0);
        let exact = roots(&c, 0.0, 2.0, Refinement::FULL, &mut fine)[0];
        let rough = roots(&c, 0.0, 2.0, Refinement { tolerance: 1e-2 }, &mut coarse)[0];
        assert!(coarse < fine && (exact - rough).abs() < 1e-2, "{coarse} {fine} {exact} {rough}");
    }
}
