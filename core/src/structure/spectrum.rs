//! The frequency dependence of a modal sum: real modes with modal damping, or complex modes.

use crate::Error;
use faer::linalg::solvers::DenseSolveCore as _;
use faer::{c64, Mat, MatRef};

/// How the denominator of a mode depends on frequency.
#[derive(Debug, Clone)]
pub(super) enum Spectrum {
    /// `1 / (ω_j² − ω² + iω c_j)`.
    Real {
        omega_squared: Vec<f64>,
        damping: Vec<f64>,
        /// Least modulus of each mode's denominator, relative to ω².
        floors: Vec<f64>,
    },
    /// `1 / (iω − s_j)`.
    Complex { poles: Vec<c64> },
}

impl Spectrum {
    /// Weight of mode j at `omega`.
    pub(super) fn weight(&self, j: usize, omega: f64) -> c64 {
        match self {
            Self::Real { omega_squared, damping, floors } => {
                let squared = omega * omega;
                let mut denominator = c64::new(omega_squared[j] - squared, omega * damping[j]);
                // An undamped mode of the free base met exactly is no resonance of the stuck
                // structure, but leaves 0/0. A floor ε on the denominator costs a relative error ε
                // and a cancellation 1e-16/ε: least at the square root of rounding.
                let floor = floors[j] * squared;
                if denominator.norm_sqr() < floor * floor {
                    denominator = c64::new(0.0, floor);
                }
                if denominator == c64::new(0.0, 0.0) {
                    // Neither a load nor a contact moves such a mode: others are refused before.
                    return denominator;
                }
                denominator.inv()
            }
            Self::Complex { poles } => (c64::new(0.0, omega) - poles[j]).inv(),
        }
    }

    /// Derivative in ω of such a weight.
    pub(super) fn slope(&self, j: usize, omega: f64, weight: c64) -> c64 {
        let of_denominator = match self {
            Self::Real { damping, .. } => c64::new(2.0 * omega, -damping[j]),
            Self::Complex { .. } => c64::new(0.0, -1.0),
        };
        weight * weight * of_denominator
    }

    pub(super) fn narrowest_bandwidth(&self) -> f64 {
        match self {
            Self::Real { damping, .. } => damping.iter().map(|c| c.abs()).fold(f64::MAX, f64::min),
            Self::Complex { poles } => {
                poles.iter().map(|s| 2.0 * s.re.abs()).fold(f64::MAX, f64::min)
            }
        }
    }
}

/// Poles, and both sides R and L of the modal sum.
pub(super) type ComplexModes = (Spectrum, Mat<c64>, Mat<c64>);

/// Poles and both sides of the modal sum of the state-space problem in modal coordinates, with
/// state `(S q, q')`, S = diag(ω_j): nearly normal for light damping. `None` if the eigenvectors
/// do not span the space.
pub(super) fn complex_modes(
    omega_squared: &[f64],
    shapes: MatRef<'_, c64>,
    damping: MatRef<'_, c64>,
) -> Result<Option<ComplexModes>, Error> {
    let n = omega_squared.len();
    let highest = omega_squared.iter().fold(0.0_f64, |m, w| m.max(w.abs())).sqrt();
    let scale: Vec<f64> = omega_squared
        .iter()
        .map(|w| w.abs().sqrt().max(1e-4 * highest).max(f64::MIN_POSITIVE))
        .collect();
    let state = Mat::from_fn(2 * n, 2 * n, |i, j| match (i < n, j < n) {
        (true, true) => c64::new(0.0, 0.0),
        (true, false) => c64::new(scale[i] * f64::from(u8::from(i == j - n)), 0.0),
        (false, true) => {
            let own = -omega_squared[j] / scale[j] * f64::from(u8::from(i - n == j));
            c64::new(own, 0.0)
        }
        (false, false) => -damping[(i - n, j - n)],
    });
    let is_real = (0..n).all(|j| (0..n).all(|i| damping[(i, j)].im == 0.0));
    let eigen = if is_real {
        Mat::from_fn(2 * n, 2 * n, |i, j| state[(i, j)].re).eigen()
    } else {
        state.eigen()
    };
    let eigen = eigen.map_err(|_| Error::Eigenvalues("damping".to_owned()))?;
    let vectors = eigen.U();
    let inverse = vectors.partial_piv_lu().inverse();
    let poles: Vec<c64> = (0..2 * n).map(|j| eigen.S()[j]).collect();
    let finite = |z: &c64| z.re.is_finite() && z.im.is_finite();
    let spans = (0..2 * n).all(|i| (0..2 * n).all(|j| finite(&inverse[(i, j)])));
    if !spans || !poles.iter().all(finite) {
        return Ok(None);
    }
    let top = Mat::from_fn(n, 2 * n, |i, j| vectors[(i, j)] / scale[i]);
    let right = shapes * top;
    let left = inverse.get(.., n..) * shapes.adjoint();
    Ok(Some((Spectrum::Complex { poles }, right, left)))
}
