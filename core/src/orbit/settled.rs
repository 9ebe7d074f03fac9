//! Motions that settle in time: starts for harmonic balances with laws that have no events, and so no
//! exact orbits.

use crate::fourier::sampled_amplitudes;
use crate::model::Model;
use crate::motion::{
    operations_of_step, steps_of_march, transient, ModalSystem, Scheme, TransientSettings,
};
use crate::progress::Progress;
use faer::c64;

/// Fewest and most periods that are followed, and change over the last one of a motion that has settled.
const FEWEST_PERIODS: usize = 4;
const PERIODS: usize = 300;
const SETTLED: f64 = 1e-3;
/// Samples of the last period.
const SAMPLES: usize = 256;

/// The last period of a motion from rest.
pub(super) struct Settled {
    /// Displacements of the contacts, instant after instant \[m\].
    displacement: Vec<f64>,
    contacts: usize,
}

impl Settled {
    /// The motion at a frequency [rad/s], and the operations that it has taken; nothing if it does not settle within
    /// so many `operations`.
    pub(super) fn of(
        model: &Model,
        omega: f64,
        operations: f64,
        progress: &Progress<'_>,
    ) -> (Option<Self>, f64) {
        if model.is_travelling_wave() {
            return (None, 0.0);
        }
        let Ok(system) = ModalSystem::marched(model) else { return (None, 0.0) };
        let (steps, of_step) = (steps_of_march(&system, omega), operations_of_step(&system));
        let contacts = system.points();
        let periods = PERIODS.min((operations / (of_step * steps as f64)) as usize);
        if periods < FEWEST_PERIODS {
            return (None, 0.0);
        }
        let settings = TransientSettings {
            omega,
            scheme: Scheme::RungeKutta(steps),
            periods,
            tolerance: Some(SETTLED),
            samples: SAMPLES,
            keep: Some(1),
        };
        let Ok(history) = transient(model, &settings, None, &[], progress) else {
            return (None, 0.0);
        };
        let taken = of_step * history.steps as f64;
        let mut displacement = history.trace.contact_displacement;
        // The end of the period is its beginning.
        displacement.truncate(SAMPLES * contacts);
        let whole = displacement.len() == SAMPLES * contacts;
        ((history.settled && whole).then_some(Self { displacement, contacts }), taken)
    }

    /// Amplitudes U_k of the contact displacements, k = 0..=highest, contact after contact.
    pub(super) fn amplitudes(&self, highest: usize) -> Vec<c64> {
        sampled_amplitudes(&self.displacement, self.contacts, highest)
    }
}
