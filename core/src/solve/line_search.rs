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

    /// Halves the step from `x` until it lowers the residual below `size`; `false` if none does
    /// down to the length `shortest`. At rounding level, where a step is `close`, the residual need
    /// not fall any more.
    pub(super) fn along(
        &mut self,
        mut evaluate: impl FnMut(&[f64], &mut [f64]),
        x: &[f64],
        step: &[f64],
        size: f64,
        shortest: f64,
        close: bool,
    ) -> bool {
        self.length = 1.0;
        while self.length >= shortest {
            for ((trial, x), s) in self.x.iter_mut().zip(x).zip(step) {
                *trial = x - self.length * s;
            }
            evaluate(&self.x, &mut self.residual);
            self.size = norm(&self.residual);
            if close || self.size <= (1.0 - DECREASE * self.length) * size {
                return true;
            }
            self.length *= 0.5;
        }
        false
    }

    /// Factor by which the residual has fallen.
    pub(super) fn contraction(&self, size: f64) -> f64 {
        self.size / size.max(f64::MIN_POSITIVE)
    }
}
