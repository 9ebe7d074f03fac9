//! A dense solution that scales its columns and knows the sign of its determinant.

use faer::linalg::solvers::Solve as _;
use faer::Mat;

/// Solves with the columns scaled by the weights, and says the sign of the determinant; nothing if
/// the matrix is singular.
pub(crate) fn solve(
    matrix: &mut Mat<f64>,
    right: &[f64],
    weights: &[f64],
) -> Option<(Vec<f64>, f64)> {
    let size = right.len();
    for (j, weight) in weights.iter().enumerate() {
        for i in 0..size {
            matrix[(i, j)] /= weight;
        }
    }
    let mut x = Mat::from_fn(size, 1, |i, _| right[i]);
    let factors = matrix.partial_piv_lu();
    factors.solve_in_place(&mut x);
    let step: Vec<f64> = weights.iter().enumerate().map(|(i, w)| x[(i, 0)] / w).collect();
    let pivots = factors.U().diagonal().column_vector().iter().map(|pivot| pivot.signum());
    let sign = pivots.product::<f64>() * parity(factors.P().arrays().0);
    step.iter().all(|s| s.is_finite()).then_some((step, sign))
}

/// Solves equations in all rows of a matrix but the last, which a border fills, as [`super::Curve`] asks for it.
pub fn solve_with(
    mut matrix: Mat<f64>,
    border: &[f64],
    right: &[f64],
    weights: &[f64],
) -> Option<(Vec<f64>, f64)> {
    border.iter().enumerate().for_each(|(j, entry)| matrix[(border.len() - 1, j)] = *entry);
    solve(&mut matrix, right, weights)
}

/// Sign of a permutation.
pub(crate) fn parity(order: &[usize]) -> f64 {
    let mut seen = vec![false; order.len()];
    let mut sign = 1.0;
    for first in 0..order.len() {
        let mut at = first;
        while !seen[at] {
            seen[at] = true;
            at = order[at];
            if at != first {
                sign = -sign;
            }
        }
    }
    sign
}
