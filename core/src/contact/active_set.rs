//! What a massless elastic damper does along one motion while the same points slip.

use super::elastic::ReducedStiffness;
use faer::Mat;

/// A set of slipping points with its stiffness and the series it gives.
#[derive(Debug)]
pub(super) struct ActiveSet {
    pub(super) slips: Vec<bool>,
    pub(super) reduced: ReducedStiffness,
    /// Series of `T u` and of the slip `R u`, point after point.
    pub(super) force: Vec<f64>,
    pub(super) slip: Vec<f64>,
    /// T and R, row by row.
    tangent: Vec<f64>,
    slip_rate: Vec<f64>,
}

impl ActiveSet {
    /// The set of the points marked in `slips`, and the series that those of all displacements,
    /// point after point, give in it.
    pub(super) fn new(slips: Vec<bool>, reduced: ReducedStiffness, series: &[f64]) -> Self {
        let points = slips.len();
        let rows = |matrix: &Mat<f64>| -> Vec<f64> {
            (0..points * points).map(|at| matrix[(at / points, at % points)]).collect()
        };
        let (tangent, slip_rate) = (rows(&reduced.tangent), rows(&reduced.slip_rate));
        let (force, slip) = (combined(&tangent, series), combined(&slip_rate, series));
        Self { slips, reduced, force, slip, tangent, slip_rate }
    }

    /// Force on a point, or its rate, as the displacements, or theirs, make it.
    pub(super) fn force_on(&self, i: usize, of: &[f64]) -> f64 {
        product(&self.tangent[i * of.len()..], of)
    }

    /// As [`ActiveSet::force_on`], the slip of a point.
    pub(super) fn slip_of(&self, i: usize, of: &[f64]) -> f64 {
        product(&self.slip_rate[i * of.len()..], of)
    }
}

fn product(row: &[f64], of: &[f64]) -> f64 {
    row.iter().zip(of).map(|(share, x)| share * x).sum()
}

/// Series of the points of a matrix, row by row, times the displacements.
fn combined(matrix: &[f64], series: &[f64]) -> Vec<f64> {
    let mut out = vec![0.0; series.len()];
    let points = matrix.len().isqrt().max(1);
    let slots = series.len() / points;
    for (row, out) in matrix.chunks_exact(points).zip(out.chunks_exact_mut(slots)) {
        for (share, u) in row.iter().zip(series.chunks_exact(slots)) {
            out.iter_mut().zip(u).for_each(|(out, u)| *out += share * u);
        }
    }
    out
}
