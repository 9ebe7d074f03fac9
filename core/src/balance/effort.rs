//! The work of a solution, and whether an error estimate of some order stays below it: counted in
//! multiplications, so that it is the same on every machine.

use super::condensed::Condensed;
use crate::fourier::Harmonics;

/// Work of the smallest point: what surrounds the arithmetic.
const LEAST: f64 = 1e4;
/// Samples per order of a search for turning points, over a whole period.
const SAMPLES: f64 = 16.0;
/// Multiplications of a complex product.
const COMPLEX: f64 = 4.0;
/// Products that a step usually takes.
const USUAL_PRODUCTS: f64 = 6.0;

/// Sizes of the equations of a point, and what their solution cost.
#[derive(Debug, Clone)]
pub(super) struct Effort {
    kept: Harmonics,
    contacts: f64,
    /// Contact points with a slip load.
    slipping: f64,
    /// Work of one compliance, at one order.
    compliance: f64,
    /// Work of one product with a compliance.
    response: f64,
    /// Work of the observed displacements, at one order.
    recovery: f64,
    spent: f64,
}

impl Effort {
    /// The effort that some equations have taken so far, with the displacements of `observed` DOFs.
    pub(super) fn of(equations: &Condensed<'_>, observed: usize) -> Self {
        let compliance = equations.model.compliance();
        let kept = equations.harmonics().clone();
        let slots = kept.slots() as f64;
        let contacts = compliance.contacts() as f64;
        let active = equations.loads.iter().zip(equations.model.points());
        let slipping: usize = active.filter(|(l, _)| l.active).map(|(_, p)| p.len()).sum();
        let slipping = slipping as f64;
        let dofs = compliance.dofs() as f64;
        // Per order, per response and per factorisation.
        let (per_order, response, factors) = match compliance.ring().map(|ring| ring.layout()) {
            Some(layout) => {
                let sectors = dofs / layout.dofs as f64;
                let (ports, interface) = (layout.ports() as f64, layout.interface.len() as f64);
                let own = layout.dofs as f64 * ports * ports;
                let rest = (ports - layout.contacts as f64 + layout.between.len() as f64) * slots;
                (
                    sectors * (COMPLEX * own + 4.0 * (2.0 * interface).powi(3)),
                    sectors * (COMPLEX * ports * ports + 6.0 * (2.0 * interface).powi(2)),
                    4.0 * sectors * rest.powi(3),
                )
            }
            None => (
                COMPLEX * dofs * contacts * contacts,
                COMPLEX * contacts * slipping,
                (slipping * slots).powi(3) / 3.0,
            ),
        };
        let recovery = COMPLEX * (contacts + observed as f64) * dofs.min(contacts + dofs);
        let recovery = if compliance.ring().is_some() { response + COMPLEX * observed as f64 } else { recovery };
        let mut effort =
            Self { kept, contacts, slipping, compliance: per_order, response, recovery, spent: 0.0 };
        let orders = effort.kept.orders().count() as f64;
        let profile = &equations.profile;
        effort.spent = LEAST
            + orders * (per_order + recovery)
            + profile.evaluations as f64
                * (effort.law(contacts, &effort.kept) + orders * response)
            + profile.factorisations as f64 * factors;
        effort
    }

    /// Whether an estimate that extends the harmonics to an order costs less than the solution did.
    pub(super) fn covers(&self, order: usize) -> bool {
        let all = Harmonics::new(order, self.kept.half_wave());
        let (orders, kept) = (all.orders().count() as f64, self.kept.orders().count() as f64);
        let slots = all.slots() as f64;
        let product = self.slipping * slots * slots
            + orders * self.response
            + (self.slipping * self.kept.slots() as f64).powi(2)
            + self.contacts * slots * USUAL_PRODUCTS;
        let cost = (orders - kept) * self.compliance
            + 2.0 * (self.law(self.slipping, &all) + USUAL_PRODUCTS * product)
            + 2.0 * orders * self.recovery;
        cost <= self.spent
    }

    /// Work of the laws of some points.
    fn law(&self, points: f64, harmonics: &Harmonics) -> f64 {
        let slots = harmonics.slots() as f64;
        let span = if harmonics.half_wave() { 0.5 } else { 1.0 };
        let samples = span * SAMPLES * harmonics.highest().max(4) as f64;
        points * slots * (samples + slots)
    }
}
