//! Gauss-Legendre quadrature on the unit interval.

use super::polynomial::DEGREE;
use crate::fourier::gauss_legendre;
use faer::Mat;
use std::collections::BTreeMap;

/// Error of the quadrature of a wave, relative to it, that is none.
pub(crate) const ROUNDING: f64 = 1e-18;

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
            let rule = gauss_legendre(count).into_iter();
            let nodes: Vec<_> = rule.map(|(x, w)| (0.5 * (1.0 + x), 0.5 * w)).collect();
            let powers = Mat::from_fn(DEGREE + 1, count, |n, node| nodes[node].0.powi(n as i32));
            Rule { nodes, powers }
        })
    }
}

/// Nodes over which the quadrature of waves that turn by 4 x has an error, `x^2m / (2m)!`, up to the one that is given.
pub(crate) fn nodes_of_waves(x: f64, most: f64) -> usize {
    let (mut count, mut error) = (0, 1.0);
    while error > most {
        count += 1;
        error *= x * x / ((2 * count) * (2 * count - 1)) as f64;
    }
    count
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
