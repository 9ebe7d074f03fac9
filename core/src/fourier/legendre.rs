//! Legendre polynomials, and the quadrature at their roots.

use std::f64::consts::PI;

/// Steps of Newton's method after which nodes are known to rounding.
const STEPS: usize = 20;

/// The polynomials of all degrees up to one, which is at least 1, at x in [−1, 1].
pub(crate) fn legendre(degree: usize, x: f64) -> Vec<f64> {
    let mut p = vec![1.0, x];
    for k in 1..degree {
        let n = k as f64;
        p.push(((2.0 * n + 1.0) * x * p[k] - n * p[k - 1]) / (n + 1.0));
    }
    p
}

/// Nodes and weights on [−1, 1] of the rule that is exact for polynomials of degree `2 count − 1`: Newton's method
/// on the Legendre polynomial from the Chebyshev nodes.
pub(crate) fn gauss_legendre(count: usize) -> Vec<(f64, f64)> {
    let degree = count as f64;
    let slope = |x: f64, p: &[f64]| degree * (x * p[count] - p[count - 1]) / (x * x - 1.0);
    let node = |i: usize| {
        let mut x = -(PI * (i as f64 + 0.75) / (degree + 0.5)).cos();
        for _ in 0..STEPS {
            let p = legendre(count, x);
            x -= p[count] / slope(x, &p);
        }
        (x, 2.0 / ((1.0 - x * x) * slope(x, &legendre(count, x)).powi(2)))
    };
    (0..count).map(node).collect()
}
