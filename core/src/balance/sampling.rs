//! How wrong a marched balance is: what more samples per period would still change.
//!
//! One Newton step of the balance, with the slip load of a march through about four times as many
//! samples and the tangent that it was solved with. The error of a march falls with the second
//! power of the distance of its samples, of laws that couple several points now and then with the
//! first, and its factor depends on where between two samples each turning point and transition
//! falls. So it is uneven: the change from N to 2N samples can vanish where the error does not.
//! Four times as many leave little room for that; and as they do not contain the N instants, what
//! falls close beside one of those is seen as well.

use super::condensed::Condensed;
use super::solution::Point;
use crate::model::Model;
use crate::solve::System as _;
use crate::structure::Quantity;
use crate::Error;
use faer::c64;
use std::f64::consts::TAU;

/// What N samples are compared with, 4 N + 2: an instant of the one falls between two of the other.
const FINER: [usize; 2] = [4, 2];
/// The step to the finer march times this is the whole error if that is of first order, and a
/// little more than it if it is of second order.
pub(super) const CAUTION: f64 = 4.0 / 3.0;

/// Change of a state over a round of the finer march that counts as none, relative to the square of the
/// distance of its samples.
const UNFELT: f64 = 1e-4;

impl Condensed<'_> {
    /// Has marches begin with the states that those of other equations of these contacts repeat, and end where
    /// they come back to within a part.
    pub(super) fn begin_beside(&mut self, other: &Self, within: Option<f64>) {
        for (own, other) in self.loads.iter_mut().zip(&other.loads) {
            own.repeated.clone_from(&other.repeated);
            let known = own.repeated.as_mut().zip(within);
            known.into_iter().for_each(|(known, within)| known.within = within);
        }
    }
}

/// Samples of the march that one through `samples` is compared with.
pub(super) fn finer_than(samples: usize) -> usize {
    FINER[0] * samples + FINER[1]
}

/// Sum over all harmonics of the change that the laws of `finer` would bring to each observed DOF
/// \[m\]; `solved` are the equations of the solution `x`.
pub(super) fn sampling_errors(
    solved: &mut Condensed<'_>,
    finer: &Model,
    x: &[f64],
    observe: &[usize],
    point: &Point,
) -> Result<Vec<f64>, Error> {
    let mut errors = vec![0.0; observe.len()];
    let infinite = vec![f64::INFINITY; observe.len()];
    let mut fine = Condensed::new(finer, solved.table, solved.residual, false);
    if fine.set_omega_beside(point.omega, Some(&*solved)).is_err() {
        return Ok(infinite);
    }
    let (mut defect, mut step) = (vec![0.0; x.len()], vec![0.0; x.len()]);
    // What rounds still change counts for nothing beside the error of straight lines between samples.
    let apart = TAU / finer_than(point.samples.unwrap_or(1)) as f64;
    fine.begin_beside(solved, Some(UNFELT * apart * apart));
    fine.value(x, &mut defect);
    solved.profile.work += fine.profile.work;
    let slips = |load: &[f64]| load.iter().any(|q| *q != 0.0);
    let mut slip_load = fine.slip_load();
    if !slips(&slip_load) && !slips(&solved.slip_load()) {
        return Ok(errors);
    }
    if !solved.solve(&defect, &mut step) {
        return Ok(infinite);
    }
    step.iter_mut().for_each(|s| *s = -*s);
    solved.add_tangent_product(&step, &mut slip_load);
    let corrected: Vec<f64> = x.iter().zip(&step).map(|(x, s)| x + s).collect();
    let orders = point.harmonics + 1;
    solved.displacements(
        Quantity::Whole,
        [&corrected, &slip_load],
        observe,
        |order, observed, _, _| {
            for (dof, error) in errors.iter_mut().enumerate() {
                let before: c64 = point.displacement[dof * orders + order];
                *error += CAUTION * (observed[dof] - before).norm();
            }
        },
    )?;
    Ok(errors)
}
