//! What keeps the motion of a mode up.

use crate::model::ModalBasis;
use faer::c64;

/// What feeds what the motion loses.
#[derive(Debug, Clone)]
pub(super) enum Feed {
    /// A damping −ξM (Krack 2015).
    Damping,
    /// A force in quadrature with the displacement along it: phase resonance. Its shape in the modes is
    /// of unit norm, and its amplitude counts in units of a ω₀².
    Force(Vec<c64>, f64),
}

/// Share of a force that is along a mode, below which it does not drive it.
const DRIVES: f64 = 1e-10;

impl Feed {
    /// That of the loads of the fundamental; nothing if they do not drive a mode shape.
    pub(super) fn force(basis: &ModalBasis, load: Option<&[c64]>, mode: &[c64]) -> Option<Self> {
        let load = load?;
        let modal: Vec<c64> = (0..basis.modes())
            .map(|j| (0..load.len()).map(|i| basis.shapes[(i, j)].conj() * load[i]).sum())
            .collect();
        let size = modal.iter().map(|p| p.norm_sqr()).sum::<f64>().sqrt();
        let along: c64 = modal.iter().zip(mode).map(|(p, x)| p.conj() * x).sum();
        let shape = modal.iter().map(|p| p / size).collect();
        (along.norm() > DRIVES * size).then_some(Self::Force(shape, size))
    }

    /// Row of the condition on the phase of the fundamental, cosines and sines, after a point with this
    /// one: against that of the point in the metric of the mass, or `Re pᴴX₁ = 0`.
    pub(super) fn phase(&self, first: &[f64]) -> Vec<f64> {
        let (cosines, sines) = first.split_at(first.len() / 2);
        match self {
            Self::Damping => sines.iter().copied().chain(cosines.iter().map(|c| -c)).collect(),
            Self::Force(shape, _) => {
                shape.iter().map(|p| p.re).chain(shape.iter().map(|p| -p.im)).collect()
            }
        }
    }

    /// Adds a multiple of the force to the rows of the fundamental.
    pub(super) fn add_force(shape: &[c64], factor: f64, rows: &mut [f64]) {
        let (cosines, sines) = rows.split_at_mut(shape.len());
        for ((cos, sin), p) in cosines.iter_mut().zip(sines).zip(shape) {
            *cos += factor * p.re;
            *sin -= factor * p.im;
        }
    }

    /// What turns a mode shape in time so that the condition on the phase holds and the force feeds it.
    pub(super) fn turn(&self, mode: &[c64]) -> c64 {
        match self {
            Self::Damping => c64::new(1.0, 0.0),
            Self::Force(shape, _) => {
                let along: c64 = shape.iter().zip(mode).map(|(p, x)| p.conj() * x).sum();
                c64::new(0.0, -1.0) * along.conj() / along.norm()
            }
        }
    }

    /// The unknown that feeds a damping ξ, in units of ω₀, of a mode shape.
    pub(super) fn share(&self, excess: f64, mode: &[c64]) -> f64 {
        match self {
            Self::Damping => excess,
            Self::Force(shape, _) => {
                let along: c64 = shape.iter().zip(mode).map(|(p, x)| p.conj() * x).sum();
                excess / along.norm()
            }
        }
    }
}
