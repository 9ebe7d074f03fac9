//! How fast a model can move.

use crate::model::Model;
use crate::structure::ModalDamping;

/// Highest rate of a motion over the frequency of its period that the exact flow follows: ten thousand steps per
/// period.
pub(crate) const FASTEST_EXACT: f64 = 3e4;

/// Rates at which the DOFs move while all others are fixed [1/s].
pub(super) fn dof_rates(model: &Model) -> Vec<f64> {
    let structure = model.structure();
    let rows = &*model.ports().rows;
    let held = rows.transpose() * &**model.contact_stiffness() * rows;
    let rate = |dof: usize| {
        let mass = structure.mass()[(dof, dof)];
        let stiffness = structure.stiffness()[(dof, dof)] + held[(dof, dof)];
        (stiffness.abs() / mass).sqrt() + structure.damping()[(dof, dof)].abs() / mass
    };
    (0..structure.mass().nrows()).map(rate).collect()
}

/// Fastest rate of the free motion [1/s].
pub(super) fn rate_of(model: &Model, damping: &ModalDamping) -> f64 {
    // Natural frequencies are those of the masses: DOFs without mass have substitutes, which are faster.
    let rates = dof_rates(model);
    let squares = model.structure().massless().iter().map(|&dof| rates[dof].powi(2));
    let highest = model.compliance().stuck_frequencies().last().copied().unwrap_or(0.0);
    highest.max(squares.sum::<f64>().sqrt()) + damping.matrix().norm_l2()
}
