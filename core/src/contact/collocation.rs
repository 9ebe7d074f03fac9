//! Collocation at the nodes of Gauss-Legendre quadrature.

use std::sync::OnceLock;

/// Nodes of a panel.
pub(super) const NODES: usize = 12;

/// Gauss-Legendre collocation on [0, 1].
pub(super) struct Collocation {
    pub(super) node: [f64; NODES],
    pub(super) weight: [f64; NODES],
    /// Integrals of the Lagrange polynomials up to the nodes.
    pub(super) integral: [[f64; NODES]; NODES],
    /// The last two Legendre coefficients of values at the nodes.
    pub(super) tail: [[f64; NODES]; 2],
    pub(super) barycentric: [f64; NODES],
}

/// Legendre polynomials of orders up to NODES at x in [−1, 1].
pub(super) fn legendre(x: f64) -> [f64; NODES + 1] {
    let mut p = [1.0; NODES + 1];
    p[1] = x;
    for k in 1..NODES {
        let n = k as f64;
        p[k + 1] = ((2.0 * n + 1.0) * x * p[k] - n * p[k - 1]) / (n + 1.0);
    }
    p
}

impl Collocation {
    pub(super) fn get() -> &'static Self {
        static TABLE: OnceLock<Collocation> = OnceLock::new();
        TABLE.get_or_init(Self::new)
    }

    fn new() -> Self {
        let n = NODES as f64;
        let slope =
            |x: f64, p: &[f64; NODES + 1]| n * (x * p[NODES] - p[NODES - 1]) / (x * x - 1.0);
        let node: [f64; NODES] = std::array::from_fn(|j| {
            let mut x = -(std::f64::consts::PI * (j as f64 + 0.75) / (n + 0.5)).cos();
            for _ in 0..20 {
                let p = legendre(x);
                x -= p[NODES] / slope(x, &p);
            }
            x
        });
        let at = node.map(legendre);
        let weight: [f64; NODES] = std::array::from_fn(|j| {
            1.0 / ((1.0 - node[j] * node[j]) * slope(node[j], &at[j]).powi(2))
        });
        let integral = std::array::from_fn(|i| {
            std::array::from_fn(|j| {
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
        Self { node, weight, integral, tail, barycentric }
    }

    /// The polynomial through values at the nodes, at a share of the panel.
    pub(super) fn interpolate(&self, values: &[f64; NODES], share: f64) -> f64 {
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
