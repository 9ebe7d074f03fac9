//! The search for a step length at which the residual falls.

use super::norm;

/// Decrease of the residual, relative to the step length, that counts as one.
const DECREASE: f64 = 1e-4;

/// The point reached along a direction.
#[derive(Debug, Default)]
pub(super) struct LineSearch {
    pub(super) x: Vec<f64>,
    pub(super) residual: Vec<f64>,
    /// Norm of the residual there.
    pub(super) size: f64,
    /// Share of the step taken.
    pub(super) length: f64,
}

impl LineSearch {
    pub(super) fn new(size: usize) -> Self {
        Self { x: vec![0.0; size], residual: vec![0.0; size], ..Self::default() }
    }

    /// Halves the step from `x`, at first `longest` of it, until `accepts(length, residual)`; `false` if
    /// no length down to `shortest` is.
    pub(super) fn along(
        &mut self,
        mut evaluate: impl FnMut(&[f64], &mut [f64]),
        [x, step]: [&[f64]; 2],
        [longest, shortest]: [f64; 2],
        accepts: impl Fn(f64, f64) -> bool,
    ) -> bool {
        self.length = longest;
        while self.length >= shortest {
            for ((trial, x), s) in self.x.iter_mut().zip(x).zip(step) {
                *trial = x - self.length * s;
            }
            evaluate(&self.x, &mut self.residual);
            self.size = norm(&self.residual);
            if accepts(self.length, self.size) {
                return true;
            }
            self.length *= 0.5;
        }
        false
    }
}

/// Whether a residual of the size `after` a step of some length is less than that before.
pub(super) fn falls(after: f64, before: f64, length: f64) -> bool {
    after <= (1.0 - DECREASE * length) * before
}
