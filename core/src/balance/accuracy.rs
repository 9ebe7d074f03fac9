//! How wrong a truncated balance is: what its discarded harmonics would still change.
//!
//! The friction force of the solution has harmonics above H that the balance ignores. One Newton
//! step of the balance extended by them says what they would do: pushed through the compliance
//! they move the contacts, which changes the friction force at all harmonics, which moves the
//! contacts again. The change between two values of H, in contrast, says nothing, for the error
//! stays on a plateau until Hω passes the highest stuck natural frequency.
//!
//! Friction is piecewise: discarded harmonics may let points slip that did not, or stick, which no
//! tangent foresees. A second step, with the force at the corrected motion, says how far the first
//! one is to be trusted: the larger of the first and an eighth of the second is the estimate.
//!
//! Contacts that carry no slip load take no part. Few slipping ones are eliminated; for many, and
//! in rings, both steps come from products alone, and the factors of the balance itself solve the
//! kept harmonics.

use super::condensed::Condensed;
use super::unknowns::Unknowns;
use crate::contact::Residual;
use crate::fourier::{Harmonics, SampleTable};
use crate::model::Model;
use crate::solve::{gmres, norm, System as _};
use crate::Error;

/// The extended balance reaches at least this far beyond the kept harmonics, …
const MARGIN: usize = 4;
/// … by half of them, …
const SHARE: f64 = 0.5;
/// … and past the highest stuck natural frequency by this factor, …
const PAST_LAST_MODE: f64 = 1.2;
/// … as far as the slipping contacts have no more unknowns than this, …
const UNKNOWNS: usize = 128;
/// … and not beyond this multiple of the kept harmonics and so many more: every order costs a
/// compliance, and the estimate must not cost more than the solution did.
const GROWTH: (usize, usize) = (4, 12);
/// Share of the second step that counts: where it is large, both overshoot.
const TRUST: f64 = 0.125;
/// Share of the right side that products leave.
const LEFT: f64 = 1e-7;
/// Most products per step; a tenth of them is usual.
const PRODUCTS: usize = 60;
/// A contact without slip load whose displacement moves by more than this share may begin to slip.
const MOVED: f64 = 1e-3;

/// Highest harmonic of the extended balance at a frequency. It follows from the model and the
/// solution, not from the way to it: two methods estimate alike.
pub(super) fn extended_order(
    kept: &Harmonics,
    omega: f64,
    model: &Model,
    slipping: usize,
) -> usize {
    let last_mode = model.compliance().highest_frequency();
    let per_order = if kept.half_wave() { 1 } else { 2 };
    let grown = GROWTH.0 * kept.highest() + GROWTH.1;
    let affordable = grown.min(UNKNOWNS / (per_order * slipping.max(1)));
    let reach = (PAST_LAST_MODE * last_mode / omega).min(affordable as f64) as usize;
    let beyond = kept.highest() + (SHARE * kept.highest() as f64) as usize;
    let wanted = reach.max(beyond.min(affordable));
    // Steps of four keep the number of sample tables small along a curve.
    wanted.max(kept.highest() + MARGIN).next_multiple_of(4)
}

/// Sum over all harmonics of the change that the extended balance would bring to each observed
/// DOF [m]; infinite where a discarded harmonic meets a resonance that nothing damps. `solved` are
/// the equations that were solved, with their tangents at the solution.
pub(super) fn errors(
    model: &Model,
    table: &SampleTable,
    residual: Residual,
    solution: &Unknowns,
    observe: &[usize],
    solved: &mut Condensed<'_>,
) -> Result<Vec<f64>, Error> {
    let mut errors = vec![0.0; observe.len()];
    let infinite = vec![f64::INFINITY; observe.len()];
    let mut extended = Condensed::new(model, table, residual, false);
    if extended.set_omega_beside(solved.omega(), Some(solved)).is_err() {
        return Ok(infinite);
    }
    extended.idle = solved.loads.iter().map(|load| !load.active).collect();
    let harmonics = table.harmonics();
    let start = solution.recast(harmonics);
    let mut defect = vec![0.0; start.len()];
    extended.residual(&start, &mut defect);
    // Of the slip load only the discarded harmonics are new.
    let mut load = extended.slip_load();
    let kept = solution.harmonics.slots();
    load.chunks_exact_mut(harmonics.slots()).for_each(|series| series[..kept].fill(0.0));
    let mut expected = extended.slip_load();
    let Some(step) = newton_step(&mut extended, solved, &defect) else {
        return Ok(infinite);
    };
    extended.add_tangent_product(&step, &mut load);
    extended.add_tangent_product(&step, &mut expected);
    let mut seconds = errors.clone();
    let add = |extended: &Condensed<'_>, step: &[f64], load: &[f64], sums: &mut [f64]| {
        extended.changes(step, load, observe, |moved| {
            sums.iter_mut().zip(moved).for_each(|(sum, x)| *sum += x.norm());
        })
    };
    add(&extended, &step, &load, &mut errors)?;
    extended.idle = wake(&extended, &start, &step);
    let corrected: Vec<f64> = start.iter().zip(&step).map(|(x, s)| x + s).collect();
    extended.value(&corrected, &mut defect);
    let mut load = extended.slip_load();
    load.iter_mut().zip(&expected).for_each(|(q, expected)| *q -= expected);
    let Some(step) = newton_step(&mut extended, solved, &defect) else {
        return Ok(infinite);
    };
    extended.add_tangent_product(&step, &mut load);
    add(&extended, &step, &load, &mut seconds)?;
    // A first step that the second does not correct much is trusted as it is.
    let larger = |(error, second): (&mut f64, f64)| *error = error.max(TRUST * second);
    errors.iter_mut().zip(seconds).for_each(larger);
    Ok(errors)
}

/// About `−J⁻¹ defect` of the extended balance with the tangents it has; the factors of the solved
/// equations make the kept harmonics, the first of each series, exact.
fn newton_step(
    extended: &mut Condensed<'_>,
    solved: &mut Condensed<'_>,
    defect: &[f64],
) -> Option<Vec<f64>> {
    let slots = extended.harmonics().slots();
    let active: usize = {
        let loads = extended.loads.iter().zip(extended.model.points());
        loads.filter(|(load, _)| load.active).map(|(_, points)| points.len()).sum()
    };
    if extended.model.compliance().ring().is_none() && active * slots <= 2 * UNKNOWNS {
        let mut step = vec![0.0; defect.len()];
        let regular = extended.solve(defect, &mut step);
        step.iter_mut().for_each(|s| *s = -*s);
        return regular.then_some(step);
    }
    let stiffness = extended.model.contact_stiffness();
    // Forces count, and not displacements: a stiff contact moves little.
    let weights: Vec<f64> =
        (0..defect.len()).map(|i| stiffness[(i / slots, i / slots)].sqrt()).collect();
    let kept = solved.harmonics().slots();
    let (mut low, mut solution) = (vec![0.0; weights.len() / slots * kept], Vec::new());
    solution.resize(low.len(), 0.0);
    let mut regular = true;
    let mut precondition = |values: &mut [f64]| {
        for (low, series) in low.chunks_exact_mut(kept).zip(values.chunks_exact(slots)) {
            low.copy_from_slice(&series[..kept]);
        }
        regular &= solved.solve(&low, &mut solution);
        for (low, series) in solution.chunks_exact(kept).zip(values.chunks_exact_mut(slots)) {
            series[..kept].copy_from_slice(low);
        }
    };
    let mut rhs: Vec<f64> = defect.iter().map(|d| -d).collect();
    precondition(&mut rhs);
    let mut slip_load = vec![0.0; rhs.len()];
    let product = |x: &[f64], out: &mut [f64]| {
        slip_load.fill(0.0);
        extended.add_tangent_product(x, &mut slip_load);
        out.fill(0.0);
        extended.add_response(&slip_load, out);
        out.iter_mut().zip(x).for_each(|(out, x)| *out = x - *out);
        precondition(out);
    };
    let step = gmres(product, &rhs, &weights, LEFT, PRODUCTS);
    (regular && norm(&step).is_finite()).then_some(step)
}

/// The idle contacts without those that a step moves enough to begin to slip.
fn wake(extended: &Condensed<'_>, start: &[f64], step: &[f64]) -> Vec<bool> {
    let slots = extended.harmonics().slots();
    let size = |values: &[f64], points: &std::ops::Range<usize>| {
        values[points.start * slots..points.end * slots].iter().map(|x| x.abs()).sum::<f64>()
    };
    let contacts = extended.idle.iter().zip(extended.model.points());
    contacts
        .map(|(idle, points)| *idle && size(step, points) <= MOVED * size(start, points))
        .collect()
}
