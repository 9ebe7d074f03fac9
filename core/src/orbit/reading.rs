//! Whether an orbit closes, and what a pass along it tells.

use super::closed::Orbit;
use super::shooting::Shooting;
use crate::solve::{norm, System as _};

/// What a pass along an orbit tells.
pub(super) struct Reading {
    pub(super) orbit: Orbit,
    /// Whether a contact in a plane touches its limit.
    pub(super) touches: bool,
    /// Closing error, relative to the motion, and the step that would close it, if there is one.
    pub(super) closing: f64,
    pub(super) error: f64,
    pub(super) left: Option<Vec<f64>>,
}

impl Reading {
    /// Of an orbit that a pass has read off at the unknowns `y`.
    pub(super) fn of(
        shooting: &mut Shooting<'_>,
        y: &[f64],
        (orbit, touches): (Orbit, bool),
    ) -> Self {
        let (closing, residual) = misses(shooting, y);
        let size = norm(y).max(f64::MIN_POSITIVE);
        let mut left = vec![0.0; y.len()];
        let determined =
            residual.iter().all(|r| r.is_finite()) && shooting.solve(&residual, &mut left);
        let error = norm(&left) / size;
        Self { orbit, touches, closing, error, left: determined.then_some(left) }
    }
}

/// Closing error of an orbit, relative to the motion, and as it is.
pub(super) fn misses(shooting: &mut Shooting<'_>, y: &[f64]) -> (f64, Vec<f64>) {
    let mut residual = vec![0.0; y.len()];
    shooting.residual(y, &mut residual);
    (norm(&residual) / norm(y).max(f64::MIN_POSITIVE), residual)
}
