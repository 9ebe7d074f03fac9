//! What coordinates displace at contacts, and what loads on contacts are on coordinates.

use super::matrix::Matrix;
use crate::solve::multiply;
use faer::traits::RealField;
use faer::{Accum, Mat, MatRef};

/// Contacts with a load that are gathered at once: their shapes stay in the cache.
const PANEL: usize = 32;

/// Displacements of some contacts per coordinate of a structure. Series of several harmonics are
/// matrices, slots × contacts or slots × coordinates.
#[derive(Debug, Clone)]
pub enum ContactShapes {
    /// Ψᵀ of modes, modes × contacts.
    Modal(Mat<f64>),
    /// Rows of B that hold few numbers each.
    Few(SparseRows),
}

/// Rows of B by the numbers that they hold.
#[derive(Debug, Clone, Default)]
pub struct SparseRows {
    /// Degree of freedom and number.
    pub(super) entries: Vec<Vec<(usize, f64)>>,
    pub(super) dofs: usize,
}

impl Default for ContactShapes {
    fn default() -> Self {
        Self::Few(SparseRows::default())
    }
}

impl ContactShapes {
    /// Forces on the coordinates from loads on the contacts.
    #[must_use]
    pub fn excite(&self, load: MatRef<'_, f64>) -> Mat<f64> {
        match self {
            Self::Modal(shapes) => excite(shapes.as_ref(), load),
            Self::Few(rows) => rows.excite(load),
        }
    }

    /// Displacements of the contacts.
    #[must_use]
    pub fn displace(&self, coordinates: MatRef<'_, f64>) -> Mat<f64> {
        match self {
            Self::Modal(shapes) => displace(shapes.as_ref(), coordinates),
            Self::Few(rows) => rows.displace(coordinates),
        }
    }
}

impl SparseRows {
    pub(super) fn of(rows: &Matrix) -> Self {
        let mut entries = vec![Vec::new(); rows.nrows()];
        rows.entries().for_each(|(row, dof, share)| entries[row].push((dof, share)));
        Self { entries, dofs: rows.ncols() }
    }

    pub(super) fn part(&self, contacts: &[usize]) -> Self {
        let entries = contacts.iter().map(|&contact| self.entries[contact].clone()).collect();
        Self { entries, dofs: self.dofs }
    }

    pub(super) fn excite(&self, load: MatRef<'_, f64>) -> Mat<f64> {
        let mut forces: Mat<f64> = Mat::zeros(load.nrows(), self.dofs);
        for (row, load) in self.entries.iter().zip(load.col_iter()) {
            for &(dof, share) in row {
                let own = forces.col_as_slice_mut(dof).iter_mut().zip(load.iter());
                own.for_each(|(force, load)| *force += share * load);
            }
        }
        forces
    }

    pub(super) fn displace(&self, coordinates: MatRef<'_, f64>) -> Mat<f64> {
        let mut motion: Mat<f64> = Mat::zeros(coordinates.nrows(), self.entries.len());
        for (contact, row) in self.entries.iter().enumerate() {
            for &(dof, share) in row {
                let own = motion.col_as_slice_mut(contact).iter_mut();
                own.zip(coordinates.col(dof).iter()).for_each(|(u, x)| *u += share * x);
            }
        }
        motion
    }
}

/// Modal forces of loads, `q Ψ`; `contacts` are Ψᵀ of the contacts that have some. Those without a load
/// are passed over.
pub(super) fn excite<T: RealField + Copy>(contacts: MatRef<'_, T>, load: MatRef<'_, T>) -> Mat<T> {
    let loaded = loaded(load);
    // Tall columns, one behind the other, go through the processor twice as fast as rows.
    let mut forces = Mat::zeros(contacts.nrows(), load.nrows());
    add_forces(contacts, load, &loaded, &mut forces);
    forces.transpose().to_owned()
}

/// Contacts with a load.
pub(super) fn loaded<T: RealField + Copy>(load: MatRef<'_, T>) -> Vec<usize> {
    let zero = T::zero_impl();
    (0..load.ncols()).filter(|&j| load.col(j).iter().any(|q| *q != zero)).collect()
}

/// Adds the modal forces of loads, modes × slots.
pub(super) fn add_forces<T: RealField + Copy>(
    contacts: MatRef<'_, T>,
    load: MatRef<'_, T>,
    loaded: &[usize],
    forces: &mut Mat<T>,
) {
    let one = T::one_impl();
    if loaded.len() == load.ncols() {
        return multiply(forces.as_mut(), Accum::Add, contacts, load.transpose(), one);
    }
    let mut panel = Mat::zeros(contacts.nrows(), PANEL.min(loaded.len()));
    for own in loaded.chunks(PANEL) {
        gather(contacts, own, &mut panel);
        let loads = Mat::from_fn(own.len(), load.nrows(), |j, i| load[(i, own[j])]);
        let panel = panel.as_ref().subcols(0, own.len());
        multiply(forces.as_mut(), Accum::Add, panel, loads.as_ref(), one);
    }
}

/// Displacements of modal coordinates at contacts, `y Ψᵀ`.
pub(super) fn displace<T: RealField + Copy>(
    contacts: MatRef<'_, T>,
    coordinates: MatRef<'_, T>,
) -> Mat<T> {
    let mut motion = Mat::zeros(coordinates.nrows(), contacts.ncols());
    multiply(motion.as_mut(), Accum::Replace, coordinates, contacts, T::one_impl());
    motion
}

/// Copies some columns side by side into a matrix that is no narrower.
pub(super) fn gather<T: RealField + Copy>(
    from: MatRef<'_, T>,
    columns: &[usize],
    into: &mut Mat<T>,
) {
    for (at, &j) in columns.iter().enumerate() {
        match from.col(j).try_as_col_major() {
            Some(column) => into.col_as_slice_mut(at).copy_from_slice(column.as_slice()),
            None => into.col_mut(at).copy_from(from.col(j)),
        }
    }
}
