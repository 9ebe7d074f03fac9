//! How wrong a marched balance is: what more samples per period would still change.
//!
//! One Newton step of the balance with the slip load of a march through four times as many samples
//! and the tangent that it was solved with. The error of a march is of second order in the
//! distance of its samples, with a factor that depends on where between two samples each turning
//! point and each transition falls: it differs from point to point, can vanish, and the change
//! from N to 2N samples, extrapolated, is as often far too small as it is right. A march through
//! 4N samples errs by a sixteenth at most, so that the step is the error itself but for that.

use super::condensed::Condensed;
use super::solution::Point;
use crate::model::Model;
use crate::solve::System as _;
use crate::Error;
use faer::c64;

/// Samples of the march that the solution is compared with, as a multiple of its own.
pub(super) const FINER: usize = 4;

/// Sum over all harmonics of the change that the laws of `finer` would bring to each observed DOF
/// [m]; `solved` are the equations of the solution `x`.
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
    fine.value(x, &mut defect);
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
    solved.displacements(&corrected, &slip_load, observe, |order, observed, _, _| {
        for (dof, error) in errors.iter_mut().enumerate() {
            let before: c64 = point.displacement[dof * orders + order];
            *error += (observed[dof] - before).norm();
        }
    })?;
    Ok(errors)
}
