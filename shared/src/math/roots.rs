//! Real roots of polynomials of degree up to four.
//!
//! Closed-form cubics and quartics lose half their digits near double roots, so only the quadratic is solved in closed
//! form. Above it, the roots of the derivative cut the interval into monotone pieces, and each piece with a change of
//! sign holds exactly one root, which a bracketed Newton iteration polishes.

/// Up to four numbers in ascending order.
#[derive(Debug, Clone, Copy, Default)]
pub struct Roots {
    values: [f64; 4],
    count: usize,
}

impl Roots {
    fn push(&mut self, root: f64) {
        self.values[self.count] = root;
        self.count += 1;
    }

    /// One number.
    pub fn one(root: f64) -> Self {
        Self { values: [root, 0.0, 0.0, 0.0], count: 1 }
    }

    /// Those that are wanted.
    pub fn filtered(&self, is_wanted: impl Fn(f64) -> bool) -> Self {
        let mut wanted = Self::default();
        for &root in self.as_slice().iter().filter(|&&root| is_wanted(root)) {
            wanted.push(root);
        }
        wanted
    }

    /// The roots, ascending.
    pub fn as_slice(&self) -> &[f64] {
        &self.values[..self.count]
    }
}

/// Real roots of `c[0] + c[1] t + c[2] t^2`, ascending. A double root is given twice; the zero polynomial has none.
///
/// The root of larger magnitude comes from the sum without cancellation, the other from the product of both.
pub fn quadratic(c: [f64; 3]) -> Roots {
    let mut roots = Roots::default();
    let [c0, c1, c2] = c;
    if c2 == 0.0 {
        if c1 != 0.0 {
            roots.push(-c0 / c1);
        }
        return roots;
    }
    let discriminant = c1 * c1 - 4.0 * c2 * c0;
    if discriminant < 0.0 {
        return roots;
    }
    let root = discriminant.sqrt();
    let q = -0.5 * (c1 + if c1 < 0.0 { -root } else { root });
    let first = q / c2;
    let second = if q == 0.0 { first } else { c0 / q };
    if first <= second {
        roots.push(first);
        roots.push(second);
    } else {
        roots.push(second);
        roots.push(first);
    }
    roots
}

/// Roots of the polynomial with the coefficients `c` (lowest power first, degree at most 4) at which it changes sign
/// within `[low, high]`, ascending.
pub fn sign_changes<const N: usize>(c: [f64; N], low: f64, high: f64) -> Roots {
    const { assert!(N >= 1 && N <= 5, "degree at most 4") };
    let mut all = [0.0; 5];
    all[..N].copy_from_slice(&c);
    sign_changes_of(&all, N - 1, low, high)
}

fn sign_changes_of(c: &[f64; 5], degree: usize, low: f64, high: f64) -> Roots {
    if degree <= 2 {
        return simple_roots_within([c[0], c[1], c[2]], low, high);
    }
    if c[degree] == 0.0 {
        return sign_changes_of(c, degree - 1, low, high);
    }
    let mut derivative = [0.0; 5];
    for power in 1..=degree {
        derivative[power - 1] = c[power] * power as f64;
    }
    let turning_points = sign_changes_of(&derivative, degree - 1, low, high);
    let mut roots = Roots::default();
    let mut left = low;
    let mut at_left = value(c, degree, left);
    for &right in turning_points.as_slice().iter().chain(core::iter::once(&high)) {
        let at_right = value(c, degree, right);
        if (at_left < 0.0) != (at_right < 0.0) {
            roots.push(polish(c, degree, left, right, at_left));
        }
        (left, at_left) = (right, at_right);
    }
    roots
}

fn simple_roots_within(c: [f64; 3], low: f64, high: f64) -> Roots {
    let all = quadratic(c);
    let mut roots = Roots::default();
    if let [a, b] = *all.as_slice()
        && a == b
    {
        return roots;
    }
    for &root in all.as_slice() {
        if root >= low && root <= high {
            roots.push(root);
        }
    }
    roots
}

fn value(c: &[f64; 5], degree: usize, t: f64) -> f64 {
    c[..=degree].iter().rev().fold(0.0, |sum, &k| sum * t + k)
}

fn slope(c: &[f64; 5], degree: usize, t: f64) -> f64 {
    (1..=degree).rev().fold(0.0, |sum, power| sum * t + c[power] * power as f64)
}

/// Newton's method, kept inside a bracket that it shrinks; bisection where it would leave. Ends when a step no longer
/// moves the root.
fn polish(c: &[f64; 5], degree: usize, mut left: f64, mut right: f64, at_left: f64) -> f64 {
    let rising = at_left < 0.0;
    let mut t = 0.5 * (left + right);
    // Bisection alone needs at most 64 halvings from any bracket that these flights have; Newton ends after about six.
    for _ in 0..80 {
        let at_t = value(c, degree, t);
        if (at_t < 0.0) == rising {
            left = t;
        } else {
            right = t;
        }
        let newton = t - at_t / slope(c, degree, t);
        let next = if newton > left && newton < right { newton } else { 0.5 * (left + right) };
        if next == t || at_t == 0.0 {
            break;
        }
        t = next;
    }
    t
}

#[cfg(test)]
mod tests {
    use super::*;

    fn assert_close(found: &[f64], expected: &[f64]) {
        assert_eq!(found.len(), expected.len(), "{found:?} instead of {expected:?}");
        for (f, e) in found.iter().zip(expected) {
            assert!((f - e).abs() <= 1e-12 * e.abs().max(1.0), "{found:?} instead of {expected:?}");
        }
    }

    #[test]
    fn quadratic_keeps_the_small_root_of_a_large_sum() {
        let roots = quadratic([1.0, -1e8, 1.0]);
        assert!((roots.as_slice()[0] - 1e-8).abs() < 1e-23);
        assert!(quadratic([1.0, 0.0, 1.0]).as_slice().is_empty());
        assert_close(quadratic([-2.0, 4.0, 0.0]).as_slice(), &[0.5]);
    }

    #[test]
    fn four_roots_of_a_quartic() {
        // (t - 0.1)(t - 0.2)(t - 0.7)(t - 3)
        let c = [0.042, -0.704, 3.23, -4.0, 1.0];
        assert_close(sign_changes(c, 0.0, 10.0).as_slice(), &[0.1, 0.2, 0.7, 3.0]);
        assert_close(sign_changes(c, 0.15, 1.0).as_slice(), &[0.2, 0.7]);
    }

    #[test]
    fn a_touch_is_not_a_change_of_sign() {
        // (t - 1)^2 (t^2 + 1)
        let c = [1.0, -2.0, 2.0, -2.0, 1.0];
        assert!(sign_changes(c, 0.0, 5.0).as_slice().is_empty());
    }

    #[test]
    fn leading_zeros_lower_the_degree() {
        assert_close(sign_changes([-1.0, 2.0, 0.0, 0.0, 0.0], 0.0, 1.0).as_slice(), &[0.5]);
        assert!(sign_changes([0.0; 5], 0.0, 1.0).as_slice().is_empty());
    }
}
