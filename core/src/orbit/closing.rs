//! The step that closes an orbit: the derivative of what is left open, with its factors.

use faer::linalg::solvers::{PartialPivLu, Solve as _};
use faer::Mat;

/// Least pivot, relative to the transition matrix, of a closing condition that determines the
/// orbit: at a resonance that nothing bounds it does not.
const SINGULAR: f64 = 1e-13;

/// Factors of the derivative of the closing condition.
#[derive(Debug)]
pub(super) struct Closing {
    lu: PartialPivLu<f64>,
    /// Coordinates that stay as they are.
    kept: Vec<usize>,
}

impl Closing {
    /// Of a transition matrix, and linear forms that keep their values, each with a coordinate that it
    /// determines; nothing where they do not determine the orbit.
    pub(super) fn new(mut matrix: Mat<f64>, conserved: &[(usize, Vec<f64>)]) -> Option<Self> {
        let (size, scale) = (matrix.nrows(), 1.0 + matrix.norm_max());
        for i in 0..size {
            matrix[(i, i)] -= 1.0;
        }
        for (target, row) in conserved {
            for (j, value) in row.iter().enumerate() {
                matrix[(*target, j)] = *value;
            }
        }
        let lu = matrix.partial_piv_lu();
        let kept = conserved.iter().map(|(target, _)| *target).collect();
        let singular = (0..size).any(|i| lu.U()[(i, i)].abs() <= SINGULAR * scale);
        (!singular).then_some(Self { lu, kept })
    }

    /// The step that closes what is left; `false` if it is not finite.
    pub(super) fn step(&self, left: &[f64], step: &mut [f64]) -> bool {
        let mut right = Mat::from_fn(left.len(), 1, |i, _| left[i]);
        self.kept.iter().for_each(|at| right[(*at, 0)] = 0.0);
        self.lu.solve_in_place(&mut right);
        step.copy_from_slice(right.col_as_slice(0));
        step.iter().all(|s| s.is_finite())
    }
}
