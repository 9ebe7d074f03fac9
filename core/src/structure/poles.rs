//! Poles of a linear structure: where it resonates, how narrowly, and what drives it there.

use super::modes::{complex, modes, HermitianModes};
use super::spectrum::{complex_modes, Spectrum};
use crate::Error;
use faer::{c64, Mat, MatRef};

/// Modal damping between two modes, over what parts their squared frequencies per frequency, up to
/// which each mode is damped by itself.
const COUPLING: f64 = 0.1;

/// The poles s with a frequency: `G(ω) ≈ r lᴴ / (iω − s)` near each.
#[derive(Debug, Clone)]
pub struct Poles {
    /// Poles with a positive imaginary part [rad/s].
    pub values: Vec<c64>,
    /// What a pole shows of itself at the DOFs, one column each.
    pub right: Mat<c64>,
    /// What a force at the DOFs does to a pole, one row each.
    pub left: Mat<c64>,
}

impl Poles {
    /// Of symmetric mass and stiffness, and any damping.
    ///
    /// # Errors
    /// Mass not positive definite, or an eigenvalue iteration that fails.
    pub fn real([mass, damping, stiffness]: [MatRef<'_, f64>; 3]) -> Result<Self, Error> {
        let modes = modes(mass, stiffness)?;
        let damping = modes.project(damping);
        Self::of_modes(&modes.to_hermitian(), &complex(damping.as_ref()))
    }

    /// Of Hermitian mass and stiffness.
    ///
    /// # Errors
    /// As [`Poles::real`].
    pub fn hermitian([mass, damping, stiffness]: [MatRef<'_, c64>; 3]) -> Result<Self, Error> {
        let modes = modes(mass, stiffness)?;
        let damping = modes.project(damping);
        Self::of_modes(&modes, &damping)
    }

    /// From undamped modes and the damping in them: mode by mode where it hardly couples them.
    fn of_modes(modes: &HermitianModes, damping: &Mat<c64>) -> Result<Self, Error> {
        let (squared, size) = (&modes.omega_squared, modes.omega_squared.len());
        let couples = |i: usize, j: usize| {
            let (a, b) = (squared[i].max(0.0), squared[j].max(0.0));
            let parted = COUPLING * (a - b).abs();
            (damping[(i, j)].norm() + damping[(j, i)].norm()) * a.max(b).sqrt() > parted
        };
        // Rounding couples equal frequencies, too.
        let noise = |i: usize, j: usize| {
            let own = damping[(i, i)].norm().max(damping[(j, j)].norm());
            damping[(i, j)].norm().max(damping[(j, i)].norm()) <= 1e-9 * own
        };
        if (0..size).any(|i| (0..i).any(|j| couples(i, j) && !noise(i, j))) {
            let modes = complex_modes(squared, modes.shapes.as_ref(), damping.as_ref())?;
            if let Some((Spectrum::Complex { poles }, right, left)) = modes {
                let kept: Vec<usize> = (0..poles.len()).filter(|&j| poles[j].im > 0.0).collect();
                return Ok(Self {
                    values: kept.iter().map(|&j| poles[j]).collect(),
                    right: Mat::from_fn(right.nrows(), kept.len(), |i, j| right[(i, kept[j])]),
                    left: Mat::from_fn(kept.len(), left.ncols(), |i, j| left[(kept[i], j)]),
                });
            }
        }
        let pole = |j: usize| {
            let decay = 0.5 * damping[(j, j)].re;
            let rate = squared[j] - decay * decay;
            (rate > 0.0).then(|| c64::new(-decay, rate.sqrt()))
        };
        let kept: Vec<(usize, c64)> = (0..size).filter_map(|j| Some((j, pole(j)?))).collect();
        let shape = |i: usize, j: usize| modes.shapes[(i, kept[j].0)];
        Ok(Self {
            values: kept.iter().map(|(_, pole)| *pole).collect(),
            right: Mat::from_fn(modes.shapes.nrows(), kept.len(), shape),
            left: Mat::from_fn(kept.len(), modes.shapes.nrows(), |j, i| {
                shape(i, j).conj() / c64::new(0.0, 2.0 * kept[j].1.im)
            }),
        })
    }
}
