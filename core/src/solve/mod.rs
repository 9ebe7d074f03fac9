//! Solvers that know nothing of friction: a system has a residual and a Newton direction.

mod homotopy;
mod newton;

pub use homotopy::{homotopy, Parametrised};
pub use newton::{newton, NewtonSettings, Outcome, Report};

/// A nonlinear system of equations.
pub trait System {
    /// Number of unknowns.
    fn size(&self) -> usize;

    /// Residual at `x`; keeps what [`System::solve`] needs.
    fn residual(&mut self, x: &[f64], out: &mut [f64]);

    /// Whether the caller wants to end the analysis; asked once per iteration.
    fn interrupted(&self) -> bool {
        false
    }

    /// Solves `J step = rhs` with the Jacobian at the last `x`; `false` if J is singular.
    fn solve(&mut self, rhs: &[f64], step: &mut [f64]) -> bool;
}

/// Euclidean norm.
#[must_use]
pub fn norm(x: &[f64]) -> f64 {
    x.iter().map(|v| v * v).sum::<f64>().sqrt()
}
