//! What the forces of a march are differentiated in, and with what that begins.

use super::StructuralDamper;

/// What the forces of a march are differentiated in.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub(super) enum Derivative {
    /// Nothing.
    None,
    /// The coefficients of the displacements.
    Coefficients,
    /// The slip limits.
    Limits,
}

impl Derivative {
    /// Derivative of the first forces: those that an increment from rest takes back into the
    /// limits, where `gain` is that in the trial forces. `basis` is that of the series at its angle.
    pub(super) fn start(
        self,
        law: &StructuralDamper,
        basis: &[f64],
        force: &[f64],
        gain: &[f64],
    ) -> Option<Vec<f64>> {
        match self {
            Self::None => None,
            Self::Coefficients => Some(in_coefficients(law, basis, gain)),
            Self::Limits => Some(in_limits(&law.limits, force, gain)),
        }
    }
}

fn in_coefficients(law: &StructuralDamper, basis: &[f64], gain: &[f64]) -> Vec<f64> {
    let (points, slots) = (law.limits.len(), basis.len());
    let mut gradient = vec![0.0; points * points * slots];
    for (i, row) in gradient.chunks_exact_mut(points * slots).enumerate() {
        for (j, block) in row.chunks_exact_mut(slots).enumerate() {
            let stiffness: f64 =
                (0..points).map(|l| gain[i * points + l] * law.stiffness[(l, j)]).sum();
            block.iter_mut().zip(basis).for_each(|(g, b)| *g = stiffness * b);
        }
    }
    gradient
}

/// `f_S = ±F_S`, which the points that stick feel as they feel a loss of the trial forces.
fn in_limits(limits: &[f64], force: &[f64], gain: &[f64]) -> Vec<f64> {
    let points = limits.len();
    let mut gradient = vec![0.0; points * points];
    for i in (0..points).filter(|&i| limits[i] > 0.0 && gain[i * points + i] == 0.0) {
        let sign = force[i].signum();
        for r in 0..points {
            let own = f64::from(u8::from(r == i));
            gradient[r * points + i] = sign * (own - gain[r * points + i]);
        }
    }
    gradient
}
