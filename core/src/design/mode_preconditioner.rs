//! A preconditioner for the linear equations of a nonlinear mode.

use faer::linalg::solvers::{PartialPivLu, Solve as _};
use faer::Mat;

/// The tangents of slip loads within each harmonic, `I − T_kk G_k`, factorised.
pub(super) struct Preconditioner {
    /// Slip loads that it is of.
    pub(super) active: Vec<usize>,
    /// Where the slip loads of an order stand among the active ones, and the factors.
    pub(super) blocks: Vec<(Vec<usize>, PartialPivLu<f64>)>,
}

impl Preconditioner {
    /// Solves for slip loads in place.
    pub(super) fn apply(&self, loads: &mut [f64]) {
        for (places, factors) in &self.blocks {
            let mut own = Mat::from_fn(places.len(), 1, |i, _| loads[places[i]]);
            factors.solve_in_place(&mut own);
            places.iter().enumerate().for_each(|(i, at)| loads[*at] = own[(i, 0)]);
        }
    }
}
