//! Polynomials on the unit interval: values and zeros, none of them missed.
//!
//! A bound on the second derivative tells whether a sub-interval can hold a zero, and whether the
//! polynomial is monotone there; where it tells neither, the interval is halved.

/// Highest power of the series of a motion.
pub(super) const DEGREE: usize = 32;
/// Truncation error of a step relative to the motion in it.
pub(super) const TRUNCATION: f64 = 1e-17;
/// Two zeros closer than this, relative to the interval, cancel: a graze.
const GRAZE: f64 = 1e-7;
/// Width at which a change of sign counts as located.
const ROUNDING: f64 = 1e-15;

/// Value of `Σ a_n xⁿ`.
#[inline]
#[must_use]
pub fn value(a: &[f64], x: f64) -> f64 {
    // Even and odd powers apart: two short chains of dependent operations instead of a long one.
    let square = x * x;
    let (mut even, mut odd) = (0.0, 0.0);
    for pair in a.chunks(2).rev() {
        even = even * square + pair[0];
        odd = odd * square + pair.get(1).copied().unwrap_or(0.0);
    }
    even + x * odd
}

/// Value and derivative.
fn jet(a: &[f64], x: f64) -> [f64; 2] {
    let (mut value, mut slope) = (0.0_f64, 0.0_f64);
    for a in a.iter().rev() {
        slope = slope * x + value;
        value = value * x + a;
    }
    [value, slope]
}

/// First zero in (0, 1] of a polynomial that is positive at 0.
#[must_use]
pub fn first_zero(a: &[f64]) -> Option<f64> {
    let reach: f64 = a[1..].iter().map(|a| a.abs()).sum();
    if reach < a[0] {
        return None;
    }
    let mut first = None;
    scan(a, &mut |x| {
        first = Some(x);
        false
    });
    first
}

/// All changes of sign in (0, 1], ascending.
pub fn sign_changes(a: &[f64], zeros: &mut Vec<f64>) {
    zeros.clear();
    scan(a, &mut |x| {
        zeros.push(x);
        true
    });
}

/// Visits the changes of sign from left to right until `visit` returns `false`.
fn scan(a: &[f64], visit: &mut dyn FnMut(f64) -> bool) {
    let mut bend = 0.0;
    for (n, a) in a.iter().enumerate().skip(2) {
        bend += (n * (n - 1)) as f64 * a.abs();
    }
    let whole = [(0.0, value(a, 0.0)), (1.0, value(a, 1.0))];
    Search { a, bend }.descend(whole, visit);
}

struct Search<'a> {
    a: &'a [f64],
    /// Bound on the second derivative.
    bend: f64,
}

impl Search<'_> {
    /// Searches one sub-interval; `false` once the visitor has had enough.
    fn descend(&self, ends: [(f64, f64); 2], visit: &mut dyn FnMut(f64) -> bool) -> bool {
        let [(left, at_left), (right, at_right)] = ends;
        let width = right - left;
        let sag = self.bend * width * width;
        if (at_left > 0.0) == (at_right > 0.0) {
            // The chord bounds the polynomial to within an eighth of bend times width squared.
            if at_left.abs().min(at_right.abs()) > 0.125 * sag || width < GRAZE {
                return true;
            }
        } else if (at_right - at_left).abs() > sag || width < ROUNDING {
            return visit(self.locate(ends));
        }
        let middle = 0.5 * (left + right);
        let at_middle = value(self.a, middle);
        self.descend([ends[0], (middle, at_middle)], visit)
            && self.descend([(middle, at_middle), ends[1]], visit)
    }

    /// Newton's method inside a bracket in which the polynomial is monotone.
    fn locate(&self, [(mut low, at_low), (mut high, at_high)]: [(f64, f64); 2]) -> f64 {
        let falls = at_low > 0.0;
        let mut x = low + (high - low) * (at_low / (at_low - at_high)).clamp(0.0, 1.0);
        for _ in 0..60 {
            let [value, slope] = jet(self.a, x);
            if (value > 0.0) == falls {
                low = x;
            } else {
                high = x;
            }
            let newton = x - value / slope;
            let next = if newton >= low && newton <= high { newton } else { 0.5 * (low + high) };
            let moved = (next - x).abs();
            x = next;
            if moved <= ROUNDING {
                break;
            }
        }
        x
    }
}

/// Most that a polynomial can move away from its start over a length.
pub(super) fn reach_of(a: &[f64], length: f64) -> f64 {
    let (mut scale, mut reach) = (1.0, 0.0);
    for a in &a[1..] {
        scale *= length;
        reach += a.abs() * scale;
    }
    reach
}

#[cfg(test)]
mod tests {
    use super::*;

    fn from_roots(roots: &[f64]) -> Vec<f64> {
        let mut a = vec![1.0];
        for root in roots {
            let mut product = vec![0.0; a.len() + 1];
            for (n, a) in a.iter().enumerate() {
                product[n] += root * a;
                product[n + 1] -= a;
            }
            a = product;
        }
        a
    }

    #[test]
    fn the_first_of_several_zeros_is_found() {
        let a = from_roots(&[0.31, 0.32, 0.9, 2.0]);
        assert!((first_zero(&a).unwrap() - 0.31).abs() < 1e-13);
        let mut all = Vec::new();
        sign_changes(&a, &mut all);
        assert_eq!(all.len(), 3);
        assert!((all[2] - 0.9).abs() < 1e-13);
    }

    #[test]
    fn a_near_miss_is_none_and_a_zero_at_the_end_counts() {
        let mut a = from_roots(&[0.5, 0.5]);
        a[0] += 1e-9;
        assert_eq!(first_zero(&a), None);
        assert!((first_zero(&from_roots(&[1.0])).unwrap() - 1.0).abs() < 1e-14);
        assert_eq!(first_zero(&[1.0, -0.5]), None);
    }

    #[test]
    fn two_close_zeros_are_kept_apart() {
        let gap = 1e-5;
        let a = from_roots(&[0.4, 0.4 + gap]);
        let mut all = Vec::new();
        sign_changes(&a, &mut all);
        assert_eq!(all.len(), 2);
        assert!((all[1] - all[0] - gap).abs() < 1e-9);
    }
}
