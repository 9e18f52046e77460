//! Decimals without loss: whole numbers of 1e-25.
//!
//! An f64 near a million has its last bit at 1.2e-10, and one near 73 at 1.4e-14: where two such numbers are subtracted an
//! error of 1e-15 would be lost. As whole numbers they are subtracted exactly; their difference is small, and so an f64 is
//! enough for it. i128 holds numbers up to 1.7e13 in these units.

/// Digits after the point.
const PLACES: usize = 25;
/// What one unit is.
const UNIT: f64 = 1e-25;

/// A decimal text in units of 1e-25; digits beyond are cut off.
pub(crate) fn exact(text: &str) -> i128 {
    let (sign, text) = text.strip_prefix('-').map_or((1, text), |rest| (-1, rest));
    let (whole, part) = text.split_once('.').unwrap_or((text, ""));
    let part = &part[..part.len().min(PLACES)];
    let digits = format!("{whole}{part:0<PLACES$}");
    sign * digits.parse::<i128>().unwrap_or_else(|error| panic!("{text}: {error}"))
}

/// An f64 in units of 1e-25: Rust prints every digit that it has.
pub(crate) fn exact_f64(value: f64) -> i128 {
    exact(&format!("{value:.PLACES$}"))
}

/// The nearest f64 to a number of units, but for a rounding.
pub(crate) fn rounded(units: i128) -> f64 {
    units as f64 * UNIT
}

#[test]
fn an_error_of_1e_15_is_seen_a_million_metres_from_the_origin() {
    let (a, b) = (exact("1000000.167528684846479656"), exact("1000000.167528684846480656"));
    assert!((rounded(b - a) - 1e-15).abs() < 1e-24);
    assert_eq!(exact("-0.5"), -exact_f64(0.5));
    assert_eq!(exact_f64(0.1), exact("0.1000000000000000055511151"), "the double that 0.1 parses to, not a tenth");
    assert_eq!(exact("3"), 3 * exact("1.0"));
}
