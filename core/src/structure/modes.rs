//! Real modes of `(K − ω²M) φ = 0`, scaled to unit modal mass.

use crate::solve::hermitian_eigen;
use crate::Error;
use faer::linalg::triangular_solve::{
    solve_lower_triangular_in_place, solve_upper_triangular_in_place,
};
use faer::traits::ComplexField;
use faer::{c64, Mat, MatRef, Side};

/// Undamped modes: `Φᵀ M Φ = I`, `Φᵀ K Φ = diag(ω²)`.
#[derive(Debug, Clone)]
pub struct RealModes {
    /// Squared natural frequencies, ascending; negative if the structure is statically unstable.
    pub omega_squared: Vec<f64>,
    /// Mode shapes, one per column.
    pub shapes: Mat<f64>,
}

/// Modes of a symmetric stiffness and a positive definite mass.
///
/// # Errors
/// Mass not positive definite, or the eigenvalue iteration fails.
pub fn real_modes(mass: MatRef<'_, f64>, stiffness: MatRef<'_, f64>) -> Result<RealModes, Error> {
    let (omega_squared, shapes) = modes(mass, stiffness)?;
    Ok(RealModes { omega_squared, shapes })
}

/// Ratio of the DOFs' squared frequencies from which their order decides how many digits the low
/// modes keep: below, rounding of the fastest DOF is no more than 1e-10 of them.
const GRADED: f64 = 1e6;

/// Eigenvalues and mass-normalised eigenvectors of a Hermitian stiffness and mass. DOFs of hardly any
/// mass come first: the reduction of a graded matrix keeps the digits of the small entries if it
/// begins with the large ones.
fn modes<T: ComplexField<Real = f64>>(
    mass: MatRef<'_, T>,
    stiffness: MatRef<'_, T>,
) -> Result<(Vec<f64>, Mat<T>), Error> {
    let Some(order) = graded_order(mass, stiffness) else {
        return ordered_modes(mass, stiffness);
    };
    let permuted = |matrix: MatRef<'_, T>| {
        Mat::from_fn(order.len(), order.len(), |i, j| matrix[(order[i], order[j])].clone())
    };
    let (omega_squared, shapes) =
        ordered_modes(permuted(mass).as_ref(), permuted(stiffness).as_ref())?;
    let mut place = vec![0; order.len()];
    order.iter().enumerate().for_each(|(at, &dof)| place[dof] = at);
    let back = |i: usize, j: usize| shapes[(place[i], j)].clone();
    Ok((omega_squared, Mat::from_fn(shapes.nrows(), shapes.ncols(), back)))
}

/// The DOFs by falling stiffness over mass, if these differ by much.
fn graded_order<T: ComplexField<Real = f64>>(
    mass: MatRef<'_, T>,
    stiffness: MatRef<'_, T>,
) -> Option<Vec<usize>> {
    let own = |matrix: MatRef<'_, T>, i: usize| T::real_part_impl(&matrix[(i, i)]).abs();
    let rates: Vec<f64> = (0..mass.nrows()).map(|i| own(stiffness, i) / own(mass, i)).collect();
    let (least, largest) =
        rates.iter().fold((f64::MAX, 0.0_f64), |(l, m), rate| (l.min(*rate), m.max(*rate)));
    let mut order: Vec<usize> = (0..rates.len()).collect();
    order.sort_by(|a, b| rates[*b].total_cmp(&rates[*a]));
    (largest > GRADED * least).then_some(order)
}

fn ordered_modes<T: ComplexField<Real = f64>>(
    mass: MatRef<'_, T>,
    stiffness: MatRef<'_, T>,
) -> Result<(Vec<f64>, Mat<T>), Error> {
    let cholesky = mass.llt(Side::Lower).map_err(|_| Error::IndefiniteMass)?;
    let lower = cholesky.L();
    let mut reduced = stiffness.to_owned();
    let par = faer::Par::Seq;
    // L⁻¹ K L⁻ᴴ, from the left and, after transposition, from the left again.
    solve_lower_triangular_in_place(lower, reduced.as_mut(), par);
    let mut reduced = reduced.adjoint().to_owned();
    solve_lower_triangular_in_place(lower, reduced.as_mut(), par);
    let failed = || Error::Eigenvalues("stiffness".to_owned());
    let (omega_squared, mut shapes) = hermitian_eigen(reduced.as_ref()).ok_or_else(failed)?;
    solve_upper_triangular_in_place(lower.adjoint(), shapes.as_mut(), par);
    Ok((omega_squared, shapes))
}

impl RealModes {
    /// Natural frequencies [rad/s]; rounding below zero counts as a rigid-body mode.
    #[must_use]
    pub fn frequencies(&self) -> Vec<f64> {
        self.omega_squared.iter().map(|w| w.max(0.0).sqrt()).collect()
    }

    /// The same modes as complex ones.
    pub(super) fn to_hermitian(&self) -> HermitianModes {
        HermitianModes {
            omega_squared: self.omega_squared.clone(),
            shapes: complex(self.shapes.as_ref()),
        }
    }

    /// `Φᵀ A Φ` of a matrix A.
    #[must_use]
    pub fn project(&self, matrix: MatRef<'_, f64>) -> Mat<f64> {
        self.shapes.transpose() * matrix * &self.shapes
    }
}

/// Modes of a Hermitian problem: `Φᴴ M Φ = I`, `Φᴴ K Φ = diag(ω²)`.
#[derive(Debug, Clone)]
pub(crate) struct HermitianModes {
    pub(crate) omega_squared: Vec<f64>,
    pub(crate) shapes: Mat<c64>,
}

/// Modes of a Hermitian stiffness and a positive definite Hermitian mass.
pub(super) fn hermitian_modes(
    mass: MatRef<'_, c64>,
    stiffness: MatRef<'_, c64>,
) -> Result<HermitianModes, Error> {
    let (omega_squared, shapes) = modes(mass, stiffness)?;
    Ok(HermitianModes { omega_squared, shapes })
}

impl HermitianModes {
    /// Natural frequencies [rad/s]; rounding below zero counts as a rigid-body mode.
    pub(super) fn frequencies(&self) -> Vec<f64> {
        self.omega_squared.iter().map(|w| w.max(0.0).sqrt()).collect()
    }

    /// `Φᴴ A Φ` of a matrix A.
    pub(super) fn project(&self, matrix: MatRef<'_, c64>) -> Mat<c64> {
        self.shapes.adjoint() * (matrix * &self.shapes)
    }
}

/// Squared natural frequencies above minus this share of the highest are rounding of zero.
const ROUNDING: f64 = 1e-8;

/// Natural frequencies [rad/s] of mass and stiffness, ascending.
///
/// # Errors
/// As [`real_modes`], or the structure is statically unstable.
pub fn natural_frequencies(
    mass: MatRef<'_, f64>,
    stiffness: MatRef<'_, f64>,
) -> Result<Vec<f64>, Error> {
    let modes = real_modes(mass, stiffness)?;
    let highest = modes.omega_squared.iter().fold(0.0_f64, |m, w| m.max(w.abs()));
    match modes.omega_squared.first() {
        Some(&squared) if squared < -ROUNDING * highest => Err(Error::Unstable { squared }),
        _ => Ok(modes.frequencies()),
    }
}

pub(super) fn complex(matrix: MatRef<'_, f64>) -> Mat<c64> {
    Mat::from_fn(matrix.nrows(), matrix.ncols(), |i, j| c64::new(matrix[(i, j)], 0.0))
}
