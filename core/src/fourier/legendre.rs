//! Legendre polynomials, and the quadrature at their roots.

use std::f64::consts::PI;

/// Steps of Newton's method after which nodes are known to rounding.
const STEPS: usize = 20;

/// The polynomials of all degrees up to one, which is at least 1, at x in [−1, 1].
pub(crate) fn legendre(degree: usize, x: f64) -> Vec<f64> {
    let mut p = vec![1.0, x];
    for k in 1..degree {
        p.push(next(k, x, [p[k - 1], p[k]]));
    }
    p
}

/// The polynomial of degree `k + 1` from the two before.
fn next(k: usize, x: f64, [last, own]: [f64; 2]) -> f64 {
    let n = k as f64;
    ((2.0 * n + 1.0) * x * own - n * last) / (n + 1.0)
}

/// Nodes and weights on [−1, 1] of the rule that is exact for polynomials of degree `2 count − 1`: Newton's method
/// on the Legendre polynomial from the Chebyshev nodes.
pub(crate) fn gauss_legendre(count: usize) -> Vec<(f64, f64)> {
    let degree = count as f64;
    let value_and_slope = |x: f64| {
        let [last, own] = (1..count).fold([1.0, x], |p, k| [p[1], next(k, x, p)]);
        (own, degree * (x * own - last) / (x * x - 1.0))
    };
    let node = |i: usize| {
        let mut x = -(PI * (i as f64 + 0.75) / (degree + 0.5)).cos();
        for _ in 0..STEPS {
            let (value, slope) = value_and_slope(x);
            let moved = x - value / slope;
            if moved == x {
                break;
            }
            x = moved;
        }
        (x, 2.0 / ((1.0 - x * x) * value_and_slope(x).1.powi(2)))
    };
    (0..count).map(node).collect()
}
