//! Solvers that know nothing of friction: a system has a residual and a Newton direction.

mod bordered;
mod bracket;
mod branch;
mod brent;
mod broyden;
mod continuation;
mod curve;
mod cyclic_scalars;
mod cyclic_tridiagonal;
mod damping;
mod dot;
mod eigen;
mod extrapolation;
mod homotopy;
mod kernels;
mod krylov;
mod line_search;
mod newton;
mod product;
mod qr;
mod scaled_lu;
mod small_dense;

pub(crate) use bracket::Bracket;
pub(crate) use branch::{between, vertex};
pub use branch::{Bounds, Branch, End};
pub(crate) use brent::brent;
pub use broyden::{broyden, BroydenEffort, FirstJacobian};
pub(crate) use continuation::oriented;
pub use continuation::{across, at_parameter, tangent, Advance, Continuation, Steps};
pub use curve::Curve;
pub use cyclic_scalars::{CyclicScalars, ScalarRow};
pub use cyclic_tridiagonal::{BlockRow, CyclicTridiagonal};
pub(crate) use dot::{dot, dot_with_size, scaled_square, size};
pub use eigen::{hermitian_eigen, hermitian_eigen_of, hermitian_eigenvalues};
pub(crate) use extrapolation::{extrapolated, LOOK_BACK};
pub use homotopy::{homotopy, Parametrised};
pub use krylov::{gmres, KrylovReport, KrylovSettings};
pub use newton::{newton, NewtonSettings, Outcome, Report};
pub(crate) use product::{multiply, settle};
pub use qr::Qr;
pub use scaled_lu::solve_with as factorised_with;
pub(crate) use scaled_lu::{parity, solve as factorised};
pub use small_dense::{Block, BlockFactors};

use faer::Mat;

/// A nonlinear system of equations.
pub trait System {
    /// Number of unknowns.
    fn size(&self) -> usize;

    /// Residual at `x`; keeps what [`System::solve`] needs.
    fn residual(&mut self, x: &[f64], out: &mut [f64]);

    /// Residual at `x` alone; [`System::solve`] goes on with the Jacobian it has.
    fn value(&mut self, x: &[f64], out: &mut [f64]);

    /// Price of the Jacobian that [`System::solve`] needs, in residuals.
    fn price(&self) -> f64 {
        2.0
    }

    /// Whether the residual at the solution is found once more anyway: then a last step whose error is known
    /// to be small needs none.
    fn is_seen_again(&self) -> bool {
        false
    }

    /// Residual and whole Jacobian at `x`; by forward differences unless the system knows better.
    fn jacobian(&mut self, x: &[f64], residual: &mut [f64], out: &mut Mat<f64>) {
        differences(self, x, residual, out);
    }

    /// Size of `step` relative to `x`: the largest over all groups of unknowns that must be
    /// accurate by themselves.
    fn relative_size(&self, step: &[f64], x: &[f64]) -> f64 {
        norm(step) / norm(x).max(f64::MIN_POSITIVE)
    }

    /// Whether the caller wants to end the analysis; asked once per iteration.
    fn interrupted(&self) -> bool {
        false
    }

    /// Whether all work that was granted is done: the iteration ends as one that leads nowhere.
    fn is_spent(&self) -> bool {
        false
    }

    /// Solves `J step = rhs` with the Jacobian at the last `x` that [`System::residual`] was called
    /// with; `false` if J is singular.
    fn solve(&mut self, rhs: &[f64], step: &mut [f64]) -> bool;
}

/// Largest of some errors, at least 0; infinite if one is not a number.
pub(crate) fn largest(errors: impl Iterator<Item = f64>) -> f64 {
    errors.fold(0.0, |worst, one| if one.is_nan() { f64::INFINITY } else { worst.max(one) })
}

/// Euclidean norm, without under- or overflow of the squares.
#[must_use]
pub fn norm(x: &[f64]) -> f64 {
    let sum: f64 = x.iter().map(|v| v * v).sum();
    if sum.is_finite() && sum > 1e-200 {
        return sum.sqrt();
    }
    let largest = x.iter().map(|v| v.abs()).fold(0.0, f64::max);
    if largest == 0.0 || !largest.is_finite() {
        return sum;
    }
    largest * x.iter().map(|v| (v / largest).powi(2)).sum::<f64>().sqrt()
}

/// Relative step of the forward differences: half the digits.
const DIFFERENCE: f64 = 1.5e-8;

/// Residual and Jacobian by forward differences. Each unknown is moved by a small share of the
/// group of unknowns that must be accurate by itself.
pub(super) fn differences<S: System + ?Sized>(
    system: &mut S,
    x: &[f64],
    residual: &mut [f64],
    out: &mut Mat<f64>,
) {
    let size = x.len();
    system.value(x, residual);
    let mut unit = vec![0.0; size];
    let steps: Vec<f64> = (0..size)
        .map(|column| {
            unit[column] = 1.0;
            let step = DIFFERENCE / system.relative_size(&unit, x);
            unit[column] = 0.0;
            step
        })
        .collect();
    let (mut moved, mut ahead) = (x.to_vec(), vec![0.0; size]);
    for (column, step) in steps.into_iter().enumerate() {
        moved[column] = x[column] + step;
        let step = moved[column] - x[column];
        system.value(&moved, &mut ahead);
        for (row, (a, r)) in ahead.iter().zip(&*residual).enumerate() {
            out[(row, column)] = (a - r) / step;
        }
        moved[column] = x[column];
    }
    // What `relative_size` reads from the last evaluation belongs to `x` again.
    system.value(x, residual);
}

#[cfg(test)]
mod tests {
    use super::largest;

    #[test]
    fn an_error_that_is_no_number_is_not_below_any_tolerance() {
        assert_eq!(largest([0.1, 0.3, 0.2].into_iter()), 0.3);
        assert_eq!(largest([0.1, f64::NAN, 0.2].into_iter()), f64::INFINITY);
        assert_eq!(largest([].into_iter()), 0.0);
    }
}
