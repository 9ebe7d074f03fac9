//! How wrong a truncated balance is: what its discarded harmonics would still change.
//!
//! The friction force of the solution has harmonics above H that the balance ignores. One Newton
//! step of the balance extended by them says what they would do: pushed through the compliance
//! they move the contacts, which changes the friction force at all harmonics, which moves the
//! contacts again. The change between two values of H, in contrast, says nothing, for the error
//! stays on a plateau until Hω passes the highest stuck natural frequency.

use super::condensed::Condensed;
use super::solution::Point;
use super::unknowns::Unknowns;
use crate::contact::Residual;
use crate::fourier::{Harmonics, SampleTable};
use crate::model::Model;
use crate::solve::System as _;
use crate::Error;
use faer::c64;

/// The extended balance reaches at least this far beyond the kept harmonics, …
const MARGIN: usize = 4;
/// … by half of them, …
const SHARE: f64 = 0.5;
/// … and past the highest stuck natural frequency by this factor, …
const PAST_LAST_MODE: f64 = 1.2;
/// … as far as its Newton system stays below this many unknowns of slipping contacts: it must not
/// cost more than the solution did, …
const UNKNOWNS: usize = 128;
/// … and below this multiple of them for all contacts, for which compliances are evaluated and
/// sectors eliminated.
const OF_ALL: usize = 4;

/// Highest harmonic of the extended balance at a frequency.
pub(super) fn extended_order(
    kept: &Harmonics,
    omega: f64,
    model: &Model,
    slipping: usize,
) -> usize {
    let last_mode = model.compliance().highest_frequency();
    let per_order = if kept.half_wave() { 1 } else { 2 };
    let contacts = model.compliance().contacts().max(1);
    let unknowns = (UNKNOWNS / slipping.max(1)).min(OF_ALL * UNKNOWNS / contacts);
    let affordable = unknowns / per_order;
    let reach = (PAST_LAST_MODE * last_mode / omega).min(UNKNOWNS as f64) as usize;
    let beyond = kept.highest() + (SHARE * kept.highest() as f64) as usize;
    let wanted = reach.max(beyond).min(affordable);
    // Steps of four keep the number of sample tables small along a curve.
    wanted.max(kept.highest() + MARGIN).next_multiple_of(4)
}

/// Sum over all harmonics of the change that the extended balance would bring to each observed
/// DOF [m]; infinite where a discarded harmonic meets a resonance that nothing damps. `solved` are
/// the equations that were solved, if they are at hand.
#[allow(clippy::too_many_arguments)]
pub(super) fn errors(
    model: &Model,
    table: &SampleTable,
    residual: Residual,
    solution: &Unknowns,
    observe: &[usize],
    point: &Point,
    solved: Option<&Condensed<'_>>,
) -> Result<Vec<f64>, Error> {
    let mut errors = vec![0.0; observe.len()];
    let infinite = vec![f64::INFINITY; observe.len()];
    let mut extended = Condensed::new(model, table, residual, false);
    if extended.set_omega_beside(point.omega, solved).is_err() {
        return Ok(infinite);
    }
    let harmonics = table.harmonics();
    let mut corrected = solution.recast(harmonics);
    let (mut defect, mut step) = (vec![0.0; corrected.len()], vec![0.0; corrected.len()]);
    extended.residual(&corrected, &mut defect);
    if !extended.solve(&defect, &mut step) {
        return Ok(infinite);
    }
    step.iter_mut().for_each(|s| *s = -*s);
    let mut slip_load = extended.slip_load();
    extended.add_tangent_product(&step, &mut slip_load);
    corrected.iter_mut().zip(&step).for_each(|(x, s)| *x += s);
    let orders = point.harmonics + 1;
    extended.displacements(&corrected, &slip_load, observe, |order, observed, _, _| {
        for (dof, error) in errors.iter_mut().enumerate() {
            let before = if order < orders {
                point.displacement[dof * orders + order]
            } else {
                c64::new(0.0, 0.0)
            };
            *error += (observed[dof] - before).norm();
        }
    })?;
    Ok(errors)
}
