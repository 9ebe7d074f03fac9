//! Starts for a harmonic balance that Newton's method fails to solve: the harmonics of the exact
//! orbit, which a passive system always has.

use super::periodic::PeriodicOrbits;
use super::settings::OrbitSettings;
use crate::balance::{PointStatus, Progress};
use crate::contact::Residual;
use crate::model::Model;
use faer::c64;
use std::cell::RefCell;

/// Finds exact orbits on demand.
pub struct Rescue<'a> {
    model: &'a Model,
    residual: Residual,
    progress: &'a Progress<'a>,
    /// Prepared when it is first needed; `None` inside if there is nothing to prepare.
    orbits: RefCell<Option<Option<PeriodicOrbits<'a>>>>,
}

impl<'a> Rescue<'a> {
    /// Orbits of a model under the residual assumed by its balance; `progress` may end a search.
    #[must_use]
    pub fn new(model: &'a Model, residual: Residual, progress: &'a Progress<'a>) -> Self {
        Self { model, residual, progress, orbits: RefCell::new(None) }
    }

    /// Amplitudes U_0, U_1, … up to `highest` of all contact displacements of the orbit at `omega`
    /// [rad/s], point after point; `None` if none is found.
    pub fn amplitudes(&self, omega: f64, highest: usize) -> Option<Vec<c64>> {
        let mut prepared = self.orbits.borrow_mut();
        let orbits = prepared.get_or_insert_with(|| {
            let settings = OrbitSettings { residual: self.residual, ..OrbitSettings::default() };
            let orbits = PeriodicOrbits::new(self.model, settings, &[]).ok()?;
            Some(orbits.watched(self.progress))
        });
        let orbits = orbits.as_mut()?;
        orbits.report_up_to(highest);
        let orbit = orbits.solve(omega, None).ok()?;
        (orbit.response.status == PointStatus::Converged)
            .then_some(orbit.response.contact_displacement)
    }
}
