//! The work that the equations of a point take, as reckoned while it is done: what may be spent on a point is
//! counted so, not by the clock, and every point ends in the same way everywhere.

use super::condensed::Condensed;
use super::forced::ForcedBalance;
use super::modal_work::suits;
use crate::contact::{ContactLaw, SlipLoad};

/// Work that a point with automatic harmonics may take beside exact orbits: some seconds, …
const OF_POINT: f64 = 4e9;
/// … or so many Newton steps of the lowest level, if these take more.
const STEPS: f64 = 600.0;
/// Of a law in closed form, with its turning points, by itself and per coefficient of every component; with its
/// tangent per entry \[ns\].
const LAW: f64 = 4000.0;
const PER_COEFFICIENT: f64 = 300.0;
const PER_ENTRY: f64 = 4.0;
/// How many times that of a law that couples components.
const COUPLED: f64 = 3.0;
/// Of a march, per sample, and per sample and coefficient, of values and of every row of a tangent \[ns\].
const PER_SAMPLE: f64 = 300.0;
const PER_PRODUCT: f64 = 1.5;
/// Of the Fourier transform of its tangent, per sample and entry \[ns\].
const PER_PROJECTION: f64 = 0.05;
/// Of a factorisation and what leads to it, over the third power of its size \[ns\].
const PER_CUBE: f64 = 0.06;

impl Condensed<'_> {
    /// Of an evaluation of the laws, with their tangents or without \[ns\].
    pub(super) fn work_of_laws(&self, loads: &[SlipLoad], tangent: bool) -> f64 {
        let slots = self.table.harmonics().slots();
        let laws = self.model.laws().iter().zip(loads);
        laws.map(|(law, load)| of_law(&**law, slots, load.active, tangent)).sum()
    }

    /// Of a factorisation of the equations of all points that yield \[ns\].
    pub(super) fn work_of_factors(&self) -> f64 {
        PER_CUBE * ((self.active_points().len() * self.table.harmonics().slots()) as f64).powi(3)
    }
}

/// Of a law in so many coefficients per component \[ns\].
fn of_law(law: &dyn ContactLaw, slots: usize, active: bool, tangent: bool) -> f64 {
    let components = law.displacements() as f64;
    let coefficients = components * slots as f64;
    let resolved = law.closed_form().map_or(usize::MAX, |form| form.resolves());
    let rows = if active && tangent { components } else { 0.0 };
    if resolved < usize::MAX {
        let samples = 2.0 * (resolved as f64 + 1.0);
        let steps = (1.0 + rows) * (PER_SAMPLE + PER_PRODUCT * coefficients);
        return samples * (steps + PER_PROJECTION * rows / components * coefficients.powi(2));
    }
    let entries = if active && tangent { coefficients.powi(2) } else { 0.0 };
    let coupled = if components > 1.0 { COUPLED } else { 1.0 };
    coupled * (LAW + PER_COEFFICIENT * coefficients + PER_ENTRY * entries)
}

impl ForcedBalance<'_> {
    /// Grants every point so much work \[ns\].
    #[must_use]
    pub(crate) fn granting(mut self, work: f64) -> Self {
        self.granted = work;
        self
    }

    /// Grants a point its work, from here on. Points whose harmonics are given may take whatever they need, and so
    /// may rings and many contacts, whose prices are known before.
    pub(super) fn grant(&mut self) {
        let order = self.control.lowest_order();
        let table = self.table(order);
        let compliance = self.model.compliance();
        let chosen = !self.control.is_fixed() && compliance.ring().is_none();
        let work = if self.granted.is_finite() {
            self.granted
        } else if chosen && !suits(compliance, table.harmonics()) {
            let unknowns = (compliance.contacts() * table.harmonics().slots()) as f64;
            OF_POINT.max(STEPS * PER_CUBE * unknowns.powi(3))
        } else {
            f64::INFINITY
        };
        self.spent_at = self.profile.work + work;
    }

    /// What is left of it.
    pub(super) fn left(&self) -> f64 {
        self.spent_at - self.profile.work
    }

    /// Whether nothing is.
    pub(super) fn is_spent(&self) -> bool {
        self.left() <= 0.0
    }
}
