//! Collocation at the nodes of Gauss-Legendre quadrature.

use crate::fourier::{gauss_legendre, legendre};
use std::sync::OnceLock;

/// Nodes of a panel.
pub(super) const NODES: usize = 12;

/// A number at every node.
pub(super) type Lanes = [f64; NODES];

/// Gauss-Legendre collocation on [0, 1].
pub(super) struct Collocation {
    pub(super) node: Lanes,
    /// From the node before, or from the start.
    pub(super) gap: Lanes,
    pub(super) weight: Lanes,
    /// Integrals of every Lagrange polynomial up to the nodes.
    pub(super) integral: [Lanes; NODES],
    /// The last two Legendre coefficients of values at the nodes.
    pub(super) tail: [Lanes; 2],
    pub(super) barycentric: Lanes,
}

impl Collocation {
    pub(super) fn get() -> &'static Self {
        static TABLE: OnceLock<Collocation> = OnceLock::new();
        TABLE.get_or_init(Self::new)
    }

    fn new() -> Self {
        let rule = gauss_legendre(NODES);
        let node: Lanes = std::array::from_fn(|j| rule[j].0);
        let weight: Lanes = std::array::from_fn(|j| 0.5 * rule[j].1);
        let at = node.map(|x| legendre(NODES, x));
        let integral = std::array::from_fn(|j| {
            std::array::from_fn(|i| {
                let terms = (1..NODES).map(|k| (at[i][k + 1] - at[i][k - 1]) * at[j][k]);
                0.5 * weight[j] * (1.0 + node[i] + terms.sum::<f64>())
            })
        });
        let tail = [NODES - 2, NODES - 1]
            .map(|k| std::array::from_fn(|j| (2 * k + 1) as f64 * weight[j] * at[j][k]));
        let barycentric = std::array::from_fn(|j| {
            let sign = if j % 2 == 0 { 1.0 } else { -1.0 };
            sign * ((1.0 - node[j] * node[j]) * weight[j]).sqrt()
        });
        let node = node.map(|x| 0.5 * (1.0 + x));
        let gap = std::array::from_fn(|j| node[j] - if j > 0 { node[j - 1] } else { 0.0 });
        Self { node, gap, weight, integral, tail, barycentric }
    }

    /// Integrals up to the nodes of the polynomial through values at them.
    #[inline(always)]
    pub(super) fn integrals(&self, values: &Lanes) -> Lanes {
        let mut out = [0.0; NODES];
        for (integral, value) in self.integral.iter().zip(values) {
            for i in 0..NODES {
                out[i] = value.mul_add(integral[i], out[i]);
            }
        }
        out
    }

    /// The polynomial through values at the nodes, at a share of the panel.
    pub(super) fn interpolate(&self, values: &Lanes, share: f64) -> f64 {
        let (mut sum, mut weights) = (0.0, 0.0);
        for ((node, weight), value) in self.node.iter().zip(&self.barycentric).zip(values) {
            if share == *node {
                return *value;
            }
            let weight = weight / (share - node);
            sum += weight * value;
            weights += weight;
        }
        sum / weights
    }
}

/// LU factors of the matrix of a collocation, `1 + h A D` with D diagonal, by columns.
///
/// They need no pivots as long as D is not far below zero: with the weights b of the quadrature
/// `x·BAx = ½ (b·x)²` (Hairer and Wanner 1996, section IV.12), so that `B (1/D + h A)` is positive definite.
pub(super) struct NodeFactors {
    /// Below the diagonal, and above it.
    lower: [Lanes; NODES],
    upper: [Lanes; NODES],
    inverse: Lanes,
}

impl NodeFactors {
    /// Factors a matrix, column after column.
    #[inline(always)]
    pub(super) fn new(mut upper: [Lanes; NODES]) -> Self {
        let mut lower = [[0.0; NODES]; NODES];
        let mut inverse = [0.0; NODES];
        for k in 0..NODES {
            inverse[k] = 1.0 / upper[k][k];
            for i in 0..NODES {
                let value = upper[k][i];
                lower[k][i] = if i > k { value * inverse[k] } else { 0.0 };
                upper[k][i] = if i < k { value } else { 0.0 };
            }
            let (column, right) = (lower[k], &mut upper[k + 1..]);
            for other in right {
                let by = other[k];
                for i in 0..NODES {
                    other[i] = (-by).mul_add(column[i], other[i]);
                }
            }
        }
        Self { lower, upper, inverse }
    }

    /// Solves in place for one right-hand side.
    #[inline(always)]
    pub(super) fn solve(&self, right: &mut Lanes) {
        for (k, column) in self.lower.iter().enumerate() {
            let by = right[k];
            for i in 0..NODES {
                right[i] = (-by).mul_add(column[i], right[i]);
            }
        }
        for k in (0..NODES).rev() {
            let by = right[k] * self.inverse[k];
            for (right, upper) in right.iter_mut().zip(&self.upper[k]) {
                *right = (-by).mul_add(*upper, *right);
            }
            right[k] = by;
        }
    }
}
