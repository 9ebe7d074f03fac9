//! The damping of modes.

use crate::structure::ModalDamping;
use faer::Mat;

/// Modal damping.
#[derive(Debug, Clone)]
pub(super) enum Damping {
    /// One coefficient per mode: the damping is proportional.
    Diagonal(Vec<f64>),
    /// A full modal matrix.
    Full(Mat<f64>),
}

impl Damping {
    /// From a damping in the modes of the structure.
    pub(super) fn of(modal: &ModalDamping) -> Self {
        if modal.is_diagonal() {
            return Self::Diagonal(modal.diagonal());
        }
        let matrix = modal.matrix();
        Self::Full(Mat::from_fn(matrix.nrows(), matrix.ncols(), |i, j| matrix[(i, j)].re))
    }

    /// An entry of the modal matrix.
    pub(super) fn entry(&self, i: usize, j: usize) -> f64 {
        match self {
            Self::Diagonal(damping) if i == j => damping[i],
            Self::Diagonal(_) => 0.0,
            Self::Full(damping) => damping[(i, j)],
        }
    }

    /// Adds `factor C v`.
    pub(super) fn add_product(&self, velocity: &[f64], factor: f64, out: &mut [f64]) {
        match self {
            Self::Diagonal(damping) => {
                for ((out, c), v) in out.iter_mut().zip(damping).zip(velocity) {
                    *out += factor * c * v;
                }
            }
            Self::Full(damping) => {
                for (j, v) in velocity.iter().enumerate() {
                    for (i, out) in out.iter_mut().enumerate() {
                        *out += factor * damping[(i, j)] * v;
                    }
                }
            }
        }
    }
}
