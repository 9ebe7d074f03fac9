//! Polynomials on the unit interval: values and zeros, none of them missed.
//!
//! A bound on the second derivative tells whether a sub-interval can hold a zero, and whether the
//! polynomial is monotone there; where it tells neither, the interval is halved. Over steps of many radians of
//! small fast modes the powers nearly cancel: there the control points of Bézier bound polynomial and derivatives
//! much more closely than the coefficients (Farouki 2012).

/// Highest power of the series of a motion.
pub(super) const DEGREE: usize = 32;
/// Truncation error of a step relative to the motion in it.
pub(super) const TRUNCATION: f64 = 1e-17;
/// Two zeros closer than this, relative to the interval, cancel: a graze.
const GRAZE: f64 = 1e-7;
/// Width at which a change of sign counts as located.
const ROUNDING: f64 = 1e-15;
/// Error of control points relative to the sum of all coefficients.
const OF_POINTS: f64 = 1e-14;
/// Coefficients that have control points: of series of motions and their derivatives.
const POINTS: usize = DEGREE + 1;

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
    let ends = [value(a, 0.0), value(a, 1.0)];
    let least = ends[0].abs().min(ends[1].abs());
    let same = (ends[0] > 0.0) == (ends[1] > 0.0);
    let plain = if same { least > 0.125 * bend } else { (ends[1] - ends[0]).abs() > bend };
    if !plain && a.len() <= POINTS {
        let (points, error) = control_points(a);
        let points = &points[..a.len()];
        // As many zeros as changes of sign, or less by an even number (Descartes).
        let changes = points.windows(2).filter(|b| (b[0] > 0.0) != (b[1] > 0.0)).count();
        if changes < 2 && points.iter().all(|b| b.abs() > error) {
            if changes == 1 {
                visit(Search { a, bend }.locate([(0.0, ends[0]), (1.0, ends[1])]));
            }
            return;
        }
        let second = points.windows(3).map(|b| (b[2] - 2.0 * b[1] + b[0]).abs());
        let turn = second.fold(0.0, f64::max) + 4.0 * error;
        bend = bend.min((a.len() * a.len()) as f64 * turn);
    }
    Search { a, bend }.descend([(0.0, ends[0]), (1.0, ends[1])], visit);
}

/// Control points of a polynomial on the unit interval, between which it stays, and their error.
fn control_points(a: &[f64]) -> ([f64; POINTS], f64) {
    let mut points = [0.0; POINTS];
    let mut rest = [0.0; POINTS];
    let rest = &mut rest[..a.len()];
    let degree = a.len().saturating_sub(1);
    let (mut choices, mut sum) = (1.0, 0.0);
    for (i, (rest, a)) in rest.iter_mut().zip(a).enumerate() {
        *rest = a / choices;
        sum += a.abs();
        choices *= (degree - i) as f64 / (i + 1) as f64;
    }
    for (i, point) in points[..a.len()].iter_mut().enumerate() {
        *point = rest[0];
        let rest = &mut rest[..a.len() - i];
        for next in 1..rest.len() {
            rest[next - 1] += rest[next];
        }
    }
    (points, OF_POINTS * sum)
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

    /// A slow motion with a fast mode that turns by many radians, whose powers nearly cancel.
    #[test]
    fn zeros_beside_fast_modes_are_found_where_they_are() {
        for (offset, expected) in [(0.3, 0), (-0.3, 1)] {
            let mut a = vec![0.0; POINTS];
            (a[0], a[1], a[2]) = (offset, 1.0, 0.2);
            let mut power = 1e-3;
            for (n, a) in a.iter_mut().enumerate() {
                *a += [power, 0.0, -power, 0.0][n % 4];
                power *= 9.0 / (n + 1) as f64;
            }
            let (points, error) = control_points(&a);
            let [low, high] = [f64::min, f64::max].map(|of| points.iter().copied().fold(a[0], of));
            assert!(error < 1e-13);
            for x in (0..=100).map(|x| f64::from(x) / 100.0) {
                assert!(low <= value(&a, x) && value(&a, x) <= high);
            }
            // Much closer than the sum of the coefficients says.
            assert!(high - low < 1.3 && reach_of(&a, 1.0) > 4.0);
            let mut zeros = Vec::new();
            sign_changes(&a, &mut zeros);
            assert_eq!(zeros.len(), expected);
            assert!(zeros.iter().all(|x| value(&a, *x).abs() < 1e-14));
        }
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
