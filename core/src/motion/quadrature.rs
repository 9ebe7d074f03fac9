//! Gauss-Legendre quadrature on the unit interval.

use super::polynomial::DEGREE;
use faer::Mat;
use std::collections::BTreeMap;
use std::f64::consts::PI;

/// Nodes and weights by number of nodes, each computed once.
#[derive(Debug, Default)]
pub(crate) struct Quadrature {
    rules: BTreeMap<usize, Rule>,
}

/// A rule with the powers of its nodes that the series of a motion has, one column each.
#[derive(Debug)]
struct Rule {
    nodes: Vec<(f64, f64)>,
    powers: Mat<f64>,
}

impl Quadrature {
    /// The rule with `count` nodes, exact for polynomials of degree `2 count − 1`.
    pub(crate) fn rule(&mut self, count: usize) -> &[(f64, f64)] {
        &self.known(count).nodes
    }

    /// The same with the powers of its nodes.
    pub(crate) fn rule_of_series(&mut self, count: usize) -> (&[(f64, f64)], &Mat<f64>) {
        let own = self.known(count);
        (&own.nodes, &own.powers)
    }

    fn known(&mut self, count: usize) -> &Rule {
        self.rules.entry(count).or_insert_with(|| {
            let nodes = gauss_legendre(count);
            let powers = Mat::from_fn(DEGREE + 1, count, |n, node| nodes[node].0.powi(n as i32));
            Rule { nodes, powers }
        })
    }
}

/// Newton's method on the Legendre polynomial from the Chebyshev nodes.
fn gauss_legendre(count: usize) -> Vec<(f64, f64)> {
    let degree = count as f64;
    (0..count)
        .map(|i| {
            let mut x = (PI * (i as f64 + 0.75) / (degree + 0.5)).cos();
            let mut slope = 1.0;
            for _ in 0..20 {
                let (mut last, mut value) = (0.0, 1.0);
                for n in 0..count {
                    let n = n as f64;
                    let next = ((2.0 * n + 1.0) * x * value - n * last) / (n + 1.0);
                    (last, value) = (value, next);
                }
                slope = degree * (x * value - last) / (x * x - 1.0);
                let step = value / slope;
                x -= step;
                if step.abs() < 1e-15 {
                    break;
                }
            }
            (0.5 * (1.0 - x), 1.0 / ((1.0 - x * x) * slope * slope))
        })
        .collect()
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn polynomials_up_to_twice_the_nodes_are_exact() {
        for count in [5, 24, 61] {
            let mut quadrature = Quadrature::default();
            let rule = quadrature.rule(count);
            for power in [0, 1, 4, 2 * count - 1] {
                let sum: f64 = rule.iter().map(|(x, w)| w * x.powi(power as i32)).sum();
                assert!((sum * (power + 1) as f64 - 1.0).abs() < 1e-12, "{count} {power} {sum}");
            }
        }
    }
}
