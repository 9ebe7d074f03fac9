//! Degrees of freedom without mass: they follow the others as a static system does.
//!
//! With x_m those without mass, `K_mm x_m + K_ma x_a = f_m`, so that the modes of the others carry them
//! along, `φ_m = −K_mm⁻¹ K_ma φ_a`, and loads on them find the constant flexibility `K_mm⁻¹` beside the
//! modal sum (Guyan 1965; exact here). The stuck contacts belong to K. A motion in time needs inertia: there
//! a substitute moves them so much faster than all others that it changes nothing one looks at.

use super::modes::{modes_of, Modes};
use crate::Error;
use faer::linalg::solvers::Solve as _;
use faer::linalg::triangular_solve::solve_upper_triangular_in_place;
use faer::traits::ComplexField;
use faer::{Mat, MatRef, Par, Side};

/// Share of the largest mass below which there is none.
const NONE: f64 = 1e-100;
/// Rate of a degree of freedom without mass in motions in time, over the highest of the others.
const FASTER: f64 = 1e3;
/// Least pivot, over the stiffness, of degrees of freedom that something holds.
const HELD: f64 = 1e-12;

/// The degrees of freedom without mass, from the diagonal of the mass matrix.
pub(super) fn without_mass(diagonal: &[f64]) -> Vec<usize> {
    let largest = diagonal.iter().copied().fold(0.0, f64::max);
    (0..diagonal.len()).filter(|&i| diagonal[i] <= NONE * largest).collect()
}

/// Gives the degrees of freedom without mass a trace, so that the matrix has a factor.
pub(super) fn trace(mass: &mut Mat<f64>, massless: &[usize]) {
    let largest = (0..mass.nrows()).map(|i| mass[(i, i)]).fold(0.0, f64::max);
    massless.iter().for_each(|&i| mass[(i, i)] = 0.5 * NONE * largest);
}

/// Puts substitutes into a mass matrix; `stiffness` is that of every degree of freedom with all others
/// fixed [N/m].
pub(super) fn substitute(mass: &mut Mat<f64>, massless: &[usize], stiffness: &[f64]) {
    let with_mass = (0..mass.nrows()).filter(|i| !massless.contains(i));
    let fastest = with_mass.map(|i| stiffness[i].abs() / mass[(i, i)]).fold(0.0, f64::max);
    let stiffest = stiffness.iter().copied().fold(0.0, f64::max);
    let [fastest, stiffest] = [fastest, stiffest].map(|most| if most > 0.0 { most } else { 1.0 });
    for &i in massless {
        let own = if stiffness[i] > 0.0 { stiffness[i] } else { stiffest };
        mass[(i, i)] = own / (FASTER * FASTER * fastest);
    }
}

/// Modes of a structure, and what degrees of freedom without mass add to them.
#[derive(Debug, Clone)]
pub(super) struct StuckModes<T> {
    /// The modes.
    pub(super) modes: Modes<T>,
    /// Shapes S of no inertia and unit stiffness: `S Sᴴ` is the flexibility beside the modes.
    pub(super) statics: Mat<T>,
}

impl<T: ComplexField<Real = f64>> StuckModes<T> {
    /// Modes of a mass and a stiffness, some degrees of freedom without mass. Where nothing holds these, their
    /// substitutes count.
    ///
    /// # Errors
    /// As [`modes`].
    pub(super) fn new(
        mass: MatRef<'_, T>,
        stiffness: Mat<T>,
        massless: &[usize],
    ) -> Result<Self, Error> {
        let size = mass.nrows();
        let others: Vec<usize> = (0..size).filter(|i| !massless.contains(i)).collect();
        let block = |matrix: MatRef<'_, T>, rows: &[usize], columns: &[usize]| {
            Mat::from_fn(rows.len(), columns.len(), |i, j| matrix[(rows[i], columns[j])].clone())
        };
        let held = (!massless.is_empty() && !others.is_empty())
            .then(|| block(stiffness.as_ref(), massless, massless))
            .and_then(|own| Some((own.llt(Side::Lower).ok()?, own)))
            .filter(|(factor, own)| {
                let part = |matrix: MatRef<'_, T>, i| T::real_part_impl(&matrix[(i, i)]);
                (0..own.nrows()).all(|i| part(factor.L(), i).powi(2) > HELD * part(own.as_ref(), i))
            });
        let Some((factor, _)) = held else {
            return Ok(Self { modes: modes_of(mass, stiffness)?, statics: Mat::zeros(size, 0) });
        };
        let coupling = block(stiffness.as_ref(), massless, &others);
        let carried = factor.solve(&coupling);
        let condensed = block(stiffness.as_ref(), &others, &others) - coupling.adjoint() * &carried;
        let condensed = Mat::from_fn(others.len(), others.len(), |i, j| {
            let twice = condensed[(i, j)].clone() + T::conj_impl(&condensed[(j, i)]);
            T::mul_real_impl(&twice, &0.5)
        });
        let Modes { omega_squared, shapes } =
            modes_of(block(mass, &others, &others).as_ref(), condensed)?;
        let follow = &carried * &shapes;
        let mut whole = Mat::zeros(size, shapes.ncols());
        let mut statics = Mat::zeros(size, massless.len());
        let mut root = Mat::<T>::identity(massless.len(), massless.len());
        solve_upper_triangular_in_place(factor.L().adjoint(), root.as_mut(), Par::Seq);
        for j in 0..shapes.ncols() {
            others
                .iter()
                .enumerate()
                .for_each(|(i, &dof)| whole[(dof, j)] = shapes[(i, j)].clone());
            let own = massless.iter().enumerate();
            own.for_each(|(i, &dof)| whole[(dof, j)] = T::zero_impl() - follow[(i, j)].clone());
        }
        for j in 0..massless.len() {
            let own = massless.iter().enumerate();
            own.for_each(|(i, &dof)| statics[(dof, j)] = root[(i, j)].clone());
        }
        Ok(Self { modes: Modes { omega_squared, shapes: whole }, statics })
    }
}

/// Squared natural frequencies above minus this share of the highest are rounding of zero.
const ROUNDING: f64 = 1e-8;

/// Natural frequencies [rad/s] of mass and stiffness, ascending; DOFs without mass have none.
///
/// # Errors
/// As [`modes`], or the structure is statically unstable.
pub fn natural_frequencies(
    mass: MatRef<'_, f64>,
    stiffness: Mat<f64>,
    massless: &[usize],
) -> Result<Vec<f64>, Error> {
    let StuckModes { modes, .. } = StuckModes::new(mass, stiffness, massless)?;
    let highest = modes.omega_squared.iter().fold(0.0_f64, |m, w| m.max(w.abs()));
    match modes.omega_squared.first() {
        Some(&squared) if squared < -ROUNDING * highest => Err(Error::Unstable { squared }),
        _ => Ok(modes.frequencies()),
    }
}
