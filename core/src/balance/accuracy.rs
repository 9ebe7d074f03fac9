//! How wrong a truncated balance is: what its discarded harmonics would still change.
//!
//! The friction force of the solution has harmonics above H that the balance ignores. Pushed
//! through the compliance they move the contacts, which changes the slip load at the kept
//! harmonics, which moves the contacts again: one Newton correction of the extended balance. The
//! change between two values of H, in contrast, says nothing, for the error stays on a plateau
//! until Hω passes the highest stuck natural frequency.

use super::condensed::Condensed;
use super::solution::Point;
use super::unknowns::{gather, scatter};
use crate::fourier::Harmonics;
use crate::model::Model;
use crate::solve::System as _;
use crate::structure::Receptance;
use crate::Error;
use faer::c64;

/// Discarded harmonics are followed at least this far beyond the kept ones, …
const MARGIN: f64 = 2.0;
/// … past the highest stuck natural frequency by this factor, …
const PAST_LAST_MODE: f64 = 1.2;
/// … but no further than this order.
const LIMIT: usize = 600;

/// The harmonics above those kept that can still matter at a frequency.
pub(super) fn discarded_harmonics(kept: &Harmonics, omega: f64, model: &Model) -> Harmonics {
    let last_mode = model.compliance().stuck_frequencies().last().copied().unwrap_or(0.0);
    let reach = (PAST_LAST_MODE * last_mode / omega).ceil().min(LIMIT as f64) as usize;
    let margin = (MARGIN * kept.highest() as f64) as usize + 3;
    kept.above(reach.max(margin))
}

/// One Newton correction of the balance extended by the discarded harmonics.
pub(super) struct Correction {
    harmonics: Harmonics,
    discarded: Harmonics,
    /// Contact displacements and slip loads at the discarded harmonics.
    beyond: Option<(Vec<f64>, Vec<f64>)>,
    /// Corrected contact displacements and slip loads at the kept harmonics.
    kept: (Vec<f64>, Vec<f64>),
}

impl Correction {
    /// The correction at a solution `x`, at which `equations` were evaluated last.
    pub(super) fn new(
        model: &Model,
        equations: &mut Condensed<'_>,
        discarded: &Harmonics,
        omega: f64,
        x: &[f64],
    ) -> Result<Self, Error> {
        let harmonics = equations.harmonics().clone();
        let mut correction = Self {
            harmonics,
            discarded: discarded.clone(),
            beyond: None,
            kept: (x.to_vec(), equations.slip_load()),
        };
        let slots = discarded.slots();
        let mut slip_load = vec![0.0; model.compliance().contacts() * slots];
        for (index, law) in model.laws().iter().enumerate() {
            let points = &model.points()[index];
            law.slip_load_at(
                equations.motion(index, x),
                discarded,
                &mut slip_load[points.start * slots..points.end * slots],
            );
        }
        if slip_load.iter().all(|q| *q == 0.0) {
            return Ok(correction);
        }
        let displacement = respond(model, discarded, omega, &slip_load);
        let kept_slots = correction.harmonics.slots();
        let mut change = vec![0.0; x.len()];
        for (index, law) in model.laws().iter().enumerate() {
            let points = &model.points()[index];
            law.slip_load_change(
                equations.motion(index, x),
                discarded,
                &displacement[points.start * slots..points.end * slots],
                &mut change[points.start * kept_slots..points.end * kept_slots],
            );
        }
        let (mut rhs, mut step) = (vec![0.0; x.len()], vec![0.0; x.len()]);
        equations.add_response(&change, &mut rhs);
        if equations.solve(&rhs, &mut step) {
            equations.add_tangent_product(&step, &mut change);
            add(&mut correction.kept.0, &step);
            add(&mut correction.kept.1, &change);
        }
        correction.beyond = Some((displacement, slip_load));
        Ok(correction)
    }

    /// Sum over all harmonics of the change of each observed DOF [m].
    pub(super) fn errors(
        &self,
        model: &Model,
        omega: f64,
        observe: &[usize],
        point: &Point,
    ) -> Result<Vec<f64>, Error> {
        let mut errors = vec![0.0; observe.len()];
        let Some((displacement, slip_load)) = &self.beyond else {
            return Ok(errors);
        };
        let orders = point.harmonics + 1;
        let kept = (&self.harmonics, &self.kept.0, &self.kept.1);
        let beyond = (&self.discarded, displacement, slip_load);
        let (mut u, mut q) = (Vec::new(), Vec::new());
        let mut observed = vec![c64::new(0.0, 0.0); observe.len()];
        for (harmonics, displacement, slip_load) in [kept, beyond] {
            for order in harmonics.orders() {
                gather(harmonics, order, displacement, &mut u);
                gather(harmonics, order, slip_load, &mut q);
                model.compliance().displacement(order, omega, &u, &q, observe, &mut observed)?;
                for (i, error) in errors.iter_mut().enumerate() {
                    let before = if order < orders {
                        point.displacement[i * orders + order]
                    } else {
                        c64::new(0.0, 0.0)
                    };
                    *error += (observed[i] - before).norm();
                }
            }
        }
        Ok(errors)
    }
}

/// Contact displacements that slip loads at the given harmonics cause.
fn respond(model: &Model, harmonics: &Harmonics, omega: f64, slip_load: &[f64]) -> Vec<f64> {
    let contacts = model.compliance().contacts();
    let mut displacement = vec![0.0; slip_load.len()];
    let mut receptance = Receptance::default();
    let mut q = Vec::new();
    for order in harmonics.orders() {
        // A discarded harmonic on an undamped resonance has no finite response: leave it out
        // rather than refuse a balance that does not contain it.
        if model.compliance().receptance(order, omega, &mut receptance).is_err() {
            continue;
        }
        gather(harmonics, order, slip_load, &mut q);
        let response: Vec<c64> = (0..contacts)
            .map(|row| (0..contacts).map(|c| receptance.contact[c * contacts + row] * q[c]).sum())
            .collect();
        scatter(harmonics, order, &response, &mut displacement);
    }
    displacement
}

fn add(target: &mut [f64], change: &[f64]) {
    target.iter_mut().zip(change).for_each(|(t, c)| *t += c);
}
