//! Rigid-body motion that nothing answers to: the structure may stand or drift elsewhere, and its
//! vibration is the same.

use super::modal_system::ModalSystem;
use super::transition::Transition;
use crate::solve::norm;

/// Squared frequency of the free structure, relative to its highest, of rigid-body motion.
const RIGID_BODY: f64 = 1e-13;
/// Share of a contact's motion, or of the damping, that rigid-body motion has by rounding.
const ROUNDING: f64 = 1e-9;

impl ModalSystem {
    /// Positions of the rigid-body modes of the structure without contacts.
    pub(crate) fn rigid_modes(&self) -> Vec<usize> {
        let squares = self.omega_squared();
        let largest = squares.iter().fold(0.0_f64, |m, w| m.max(w.abs()));
        (0..squares.len()).filter(|&j| squares[j].abs() <= RIGID_BODY * largest).collect()
    }

    /// Rows over all modes whose product with a rigid-body motion is zero if its momentum is
    /// conserved: no contact feels it, and no damping slows it.
    fn answers(&self) -> Vec<Vec<f64>> {
        let felt = (0..self.points()).filter(|&i| self.limits()[i] > 0.0);
        let mut rows: Vec<Vec<f64>> = felt.map(|i| scaled(self.contact_shape(i))).collect();
        // ψᵀ C = 0, column by column.
        let modes = self.modes();
        let entry = |(i, j): (usize, usize)| self.damping.entry(i, j);
        let entries = (0..modes).flat_map(|i| (0..modes).map(move |j| (i, j))).map(entry);
        let largest = entries.fold(0.0_f64, |m, c| m.max(c.abs()));
        let scale = if largest > 0.0 { largest.recip() } else { 0.0 };
        let column = |j: usize| (0..modes).map(|i| scale * entry((i, j))).collect();
        rows.extend((0..modes).map(column));
        rows
    }
}

impl Transition<'_> {
    /// Orthonormal directions of the state that every period keeps while the points `slipped` alone
    /// slip: shifts of the structure that deform no contact which never slips, each an eigenvector
    /// of the transition matrix to the eigenvalue 1, and momenta that nothing changes, each one of
    /// its transpose. They follow from the rigid-body modes, whatever the multipliers are found as.
    pub(crate) fn rigid(&self, slipped: &[bool]) -> Vec<Vec<f64>> {
        let system = self.system();
        let (modes, rigid) = (system.modes(), system.rigid_modes());
        if rigid.is_empty() {
            return Vec::new();
        }
        let stuck: Vec<Vec<f64>> = self
            .conserved(slipped)
            .into_iter()
            .map(|(_, form)| form.iter().zip(self.weight()).map(|(f, w)| f * w).collect::<Vec<_>>())
            .chain(system.normals.iter().map(|&i| system.contact_shape(i).to_vec()))
            .map(|row| scaled(&row))
            .collect();
        let (shifts, momenta) = (kernel(&stuck, &rigid), kernel(&system.answers(), &rigid));
        let placed = |first: usize, motion: &[f64]| {
            let mut direction = vec![0.0; self.size()];
            rigid.iter().zip(motion).for_each(|(&j, x)| direction[first + j] = *x);
            direction
        };
        // Rigid-body modes have one weight, so that their displacements keep their proportions.
        shifts
            .iter()
            .map(|motion| placed(0, motion))
            .chain(momenta.iter().map(|motion| placed(modes, motion)))
            .collect()
    }
}

fn scaled(row: &[f64]) -> Vec<f64> {
    let size = norm(row).max(f64::MIN_POSITIVE);
    row.iter().map(|x| x / size).collect()
}

/// Orthonormal combinations of the entries `chosen` that all rows map to zero; the largest entries
/// of the rows are about 1.
fn kernel(rows: &[Vec<f64>], chosen: &[usize]) -> Vec<Vec<f64>> {
    let mut basis: Vec<Vec<f64>> = Vec::new();
    for row in rows {
        extend(&mut basis, chosen.iter().map(|&j| row[j]).collect(), ROUNDING);
    }
    let taken = basis.len();
    for place in 0..chosen.len() {
        let unit = (0..chosen.len()).map(|i| f64::from(u8::from(i == place))).collect();
        // Of unit vectors at least one is left by this much while the basis is incomplete.
        extend(&mut basis, unit, ROUNDING.max(0.5 / chosen.len() as f64));
    }
    basis.split_off(taken)
}

/// Adds what is left of a vector beside a basis, if that is more than `least`.
fn extend(basis: &mut Vec<Vec<f64>>, mut vector: Vec<f64>, least: f64) {
    for _ in 0..2 {
        for known in basis.iter() {
            let share: f64 = known.iter().zip(&vector).map(|(a, b)| a * b).sum();
            vector.iter_mut().zip(known).for_each(|(x, a)| *x -= share * a);
        }
    }
    let left = norm(&vector);
    if left > least {
        vector.iter_mut().for_each(|x| *x /= left);
        basis.push(vector);
    }
}
