//! Legendre polynomials, and the quadrature at their roots.

use std::f64::consts::PI;

/// Steps of Newton's method after which nodes are known to rounding, and the last one of them.
const STEPS: usize = 20;
const LAST: f64 = 1e-15;

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
    let node = |i: usize| {
        let mut x = -(PI * (i as f64 + 0.75) / (degree + 0.5)).cos();
        let mut slope = 1.0;
        for _ in 0..STEPS {
            let [last, own] = (0..count).fold([0.0, 1.0], |p, k| [p[1], next(k, x, p)]);
            slope = degree * (x * own - last) / (x * x - 1.0);
            let step = own / slope;
            x -= step;
            if step.abs() < LAST {
                break;
            }
        }
        (x, 2.0 / ((1.0 - x * x) * slope * slope))
    };
    (0..count).map(node).collect()
}
