//! Modes of `(K − ω²M) φ = 0`, scaled to unit modal mass.

use crate::solve::{hermitian_eigen_of, hermitian_eigenvalues};
use crate::Error;
use faer::linalg::solvers::{Llt, Solve as _};
use faer::linalg::triangular_solve::{
    solve_lower_triangular_in_place, solve_upper_triangular_in_place,
};
use faer::traits::ComplexField;
use faer::{c64, Mat, MatRef, Side};

/// Undamped modes of a Hermitian problem: `Φᴴ M Φ = I`, `Φᴴ K Φ = diag(ω²)`.
#[derive(Debug, Clone)]
pub struct Modes<T> {
    /// Squared natural frequencies, ascending; negative if the structure is statically unstable.
    pub omega_squared: Vec<f64>,
    /// Mode shapes, one per column.
    pub shapes: Mat<T>,
}

/// Modes of real matrices.
pub type RealModes = Modes<f64>;
/// Modes of complex matrices, as of a travelling wave.
pub type HermitianModes = Modes<c64>;

/// Distance to an undamped resonance, relative to the squared frequency, that is refused, …
const RESONANCE: f64 = 1e-9;
/// … and to one that moves contacts: friction may bound it, and only rounding hides the frequency.
const OF_CONTACTS: f64 = 1e-12;

/// Whether a squared frequency is too close to an undamped mode, which may move contacts.
pub(super) fn resonates(distance: f64, squared: f64, moves_contacts: bool) -> bool {
    distance <= if moves_contacts { OF_CONTACTS } else { RESONANCE } * squared
}

/// Ratio of the DOFs' squared frequencies from which their order decides how many digits the low
/// modes keep: below, rounding of the fastest DOF is no more than 1e-10 of them.
const GRADED: f64 = 1e6;

/// Modes of a Hermitian stiffness and a positive definite mass. DOFs of hardly any mass come first: the
/// reduction of a graded matrix keeps the digits of the small entries if it begins with the large ones.
///
/// # Errors
/// Mass not positive definite, or the eigenvalue iteration fails.
pub fn modes<T: ComplexField<Real = f64>>(
    mass: MatRef<'_, T>,
    stiffness: MatRef<'_, T>,
) -> Result<Modes<T>, Error> {
    modes_of(mass, stiffness.to_owned())
}

/// The same of a stiffness that is not needed any more.
pub(super) fn modes_of<T: ComplexField<Real = f64>>(
    mass: MatRef<'_, T>,
    stiffness: Mat<T>,
) -> Result<Modes<T>, Error> {
    let Some(order) = graded_order(mass, stiffness.as_ref()) else {
        return ordered_modes(mass, stiffness);
    };
    let permuted = |matrix: MatRef<'_, T>| {
        Mat::from_fn(order.len(), order.len(), |i, j| matrix[(order[i], order[j])].clone())
    };
    let Modes { omega_squared, shapes } =
        ordered_modes(permuted(mass).as_ref(), permuted(stiffness.as_ref()))?;
    let mut place = vec![0; order.len()];
    order.iter().enumerate().for_each(|(at, &dof)| place[dof] = at);
    let back = |i: usize, j: usize| shapes[(place[i], j)].clone();
    Ok(Modes { omega_squared, shapes: Mat::from_fn(shapes.nrows(), shapes.ncols(), back) })
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

/// Squared natural frequencies, ascending, without mode shapes.
///
/// # Errors
/// As [`modes`].
pub(super) fn squared_frequencies(
    mass: MatRef<'_, f64>,
    stiffness: MatRef<'_, f64>,
) -> Result<Vec<f64>, Error> {
    let order = graded_order(mass, stiffness).unwrap_or_else(|| (0..mass.nrows()).collect());
    let permuted = |matrix: MatRef<'_, f64>| {
        Mat::from_fn(order.len(), order.len(), |i, j| matrix[(order[i], order[j])])
    };
    let (_, reduced) = reduced(permuted(mass).as_ref(), permuted(stiffness))?;
    let failed = || Error::Eigenvalues("stiffness".to_owned());
    hermitian_eigenvalues(reduced.as_ref()).ok_or_else(failed)
}

/// Share of a squared frequency below which there is none.
const NONE: f64 = 1e-12;
/// Steps that find the lowest mode, …
const STEPS: usize = 40;
/// … and the change of its squared frequency that ends them.
const SETTLED: f64 = 1e-6;

/// About the lowest squared frequency, 0 where nothing holds a body; `other` is one of the same structure
/// that is held. By inverse iteration.
pub(super) fn lowest_squared(mass: MatRef<'_, f64>, stiffness: MatRef<'_, f64>, other: f64) -> f64 {
    let shift = NONE * other;
    let shifted = stiffness + faer::Scale(shift) * mass;
    let Ok(factors) = shifted.llt(Side::Lower) else { return 0.0 };
    drop(shifted);
    // A shape that holds some of every mode.
    let mut shape = Mat::from_fn(mass.nrows(), 1, |i, _| 1.0 + 0.5 * (i as f64).sin());
    let mut squared = f64::MAX;
    for _ in 0..STEPS {
        let right = mass * &shape;
        let next = factors.solve(&right);
        let size = (next.transpose() * mass * &next)[(0, 0)].sqrt();
        // xᵀ (K + σM) x of the next shape, which solves for M times the last one.
        let value = (next.transpose() * &right)[(0, 0)] / (size * size) - shift;
        shape = faer::Scale(size.recip()) * next;
        let before = std::mem::replace(&mut squared, value);
        if (value - before).abs() <= SETTLED * value.abs() {
            break;
        }
    }
    if squared.is_finite() {
        squared.max(0.0)
    } else {
        0.0
    }
}

fn ordered_modes<T: ComplexField<Real = f64>>(
    mass: MatRef<'_, T>,
    stiffness: Mat<T>,
) -> Result<Modes<T>, Error> {
    let (cholesky, reduced) = reduced(mass, stiffness)?;
    let failed = || Error::Eigenvalues("stiffness".to_owned());
    let (omega_squared, mut shapes) = hermitian_eigen_of(reduced).ok_or_else(failed)?;
    let upper = cholesky.L().adjoint();
    solve_upper_triangular_in_place(upper, shapes.as_mut(), faer::Par::Seq);
    Ok(Modes { omega_squared, shapes })
}

/// The mass `L Lᴴ`, and `L⁻¹ K L⁻ᴴ`.
fn reduced<T: ComplexField<Real = f64>>(
    mass: MatRef<'_, T>,
    stiffness: Mat<T>,
) -> Result<(Llt<T>, Mat<T>), Error> {
    let cholesky = mass.llt(Side::Lower).map_err(|_| Error::IndefiniteMass)?;
    let lower = cholesky.L();
    let mut reduced = stiffness;
    let par = faer::Par::Seq;
    // L⁻¹ K L⁻ᴴ, from the left and, after transposition, from the left again.
    solve_lower_triangular_in_place(lower, reduced.as_mut(), par);
    reduced = reduced.adjoint().to_owned();
    solve_lower_triangular_in_place(lower, reduced.as_mut(), par);
    Ok((cholesky, reduced))
}

/// Frequencies by their squares; rounding below zero counts as a rigid-body mode.
pub(super) fn frequencies(squared: &[f64]) -> Vec<f64> {
    squared.iter().map(|w| w.max(0.0).sqrt()).collect()
}

impl<T> Modes<T> {
    /// Natural frequencies [rad/s]; rounding below zero counts as a rigid-body mode.
    #[must_use]
    pub fn frequencies(&self) -> Vec<f64> {
        frequencies(&self.omega_squared)
    }
}

impl<T: ComplexField<Real = f64>> Modes<T> {
    /// `Φᴴ A Φ` of a matrix A.
    #[must_use]
    pub fn project(&self, matrix: MatRef<'_, T>) -> Mat<T> {
        self.shapes.adjoint().to_owned() * matrix * &self.shapes
    }
}

impl RealModes {
    /// The same modes as complex ones.
    pub(super) fn to_hermitian(&self) -> HermitianModes {
        Modes { omega_squared: self.omega_squared.clone(), shapes: complex(self.shapes.as_ref()) }
    }
}

pub(crate) fn complex(matrix: MatRef<'_, f64>) -> Mat<c64> {
    Mat::from_fn(matrix.nrows(), matrix.ncols(), |i, j| c64::new(matrix[(i, j)], 0.0))
}
