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

/// Work around every product and every substitution.
const OF_A_PRODUCT: f64 = 3e3;

/// Sizes of the equations of a point, and what their solution cost.
#[derive(Debug, Clone)]
pub(super) struct Effort {
    kept: Harmonics,
    contacts: f64,
    /// Contact points with a slip load.
    slipping: f64,
    observed: f64,
    dofs: f64,
    ring: Option<RingSizes>,
    spent: f64,
}

/// Sizes of a ring.
#[derive(Debug, Clone)]
struct RingSizes {
    sectors: f64,
    dofs: f64,
    ports: f64,
    interface: f64,
    /// Contacts inside a sector, and its other ports.
    parts: [f64; 2],
}

impl Effort {
    /// The effort that some equations have taken so far, with the displacements of `observed` DOFs.
    pub(super) fn of(equations: &Condensed<'_>, observed: usize) -> Self {
        let compliance = equations.model.compliance();
        let active = equations.loads.iter().zip(equations.model.points());
        let slipping: usize = active.filter(|(l, _)| l.active).map(|(_, p)| p.len()).sum();
        let dofs = compliance.dofs() as f64;
        let ring = compliance.ring().map(|ring| {
            let layout = ring.layout();
            let local = (layout.contacts - layout.between.len()) as f64;
            let ports = layout.ports() as f64;
            RingSizes {
                sectors: dofs / layout.dofs as f64,
                dofs: layout.dofs as f64,
                ports,
                interface: layout.interface.len() as f64,
                parts: [local, ports - local],
            }
        });
        let mut effort = Self {
            kept: equations.harmonics().clone(),
            contacts: compliance.contacts() as f64,
            slipping: slipping as f64,
            observed: observed as f64,
            dofs,
            ring,
            spent: 0.0,
        };
        let kept = &effort.kept;
        let orders = kept.orders().count() as f64;
        let evaluation = effort.law(effort.contacts, kept) + orders * effort.response();
        effort.spent = LEAST
            + orders * (effort.compliance() + effort.recovery())
            + equations.profile.evaluations as f64 * evaluation
            + equations.profile.factorisations as f64 * effort.elimination(kept);
        effort
    }

    /// Whether an estimate that extends the harmonics to an order costs less than the solution did.
    pub(super) fn covers(&self, order: usize) -> bool {
        let all = Harmonics::new(order, self.kept.half_wave());
        let (orders, kept) = (all.orders().count() as f64, self.kept.orders().count() as f64);
        let steps = self.elimination(&all).min(2.0 * USUAL_PRODUCTS * self.product(&all));
        let cost = (orders - kept) * self.compliance()
            + 2.0 * (self.law(self.slipping, &all) + orders * self.recovery())
            + steps;
        cost <= self.spent
    }

    /// Whether elimination costs less than the products that the steps of an estimate take.
    pub(super) fn eliminates(&self, all: &Harmonics) -> bool {
        self.elimination(all) <= 2.0 * USUAL_PRODUCTS * self.product(all)
    }

    /// Work of one compliance, at one order.
    fn compliance(&self) -> f64 {
        let Some(ring) = &self.ring else {
            return COMPLEX * self.dofs * self.contacts * self.contacts;
        };
        let interface = 2.0 * ring.interface;
        ring.sectors * (COMPLEX * ring.dofs * ring.ports * ring.ports + 4.0 * interface.powi(3))
    }

    /// Work of one product with a compliance, at one order.
    fn response(&self) -> f64 {
        let Some(ring) = &self.ring else { return COMPLEX * self.contacts * self.slipping };
        let interface = 2.0 * ring.interface;
        ring.sectors * (COMPLEX * ring.ports * ring.ports + 6.0 * interface * interface)
    }

    /// Work of the displacements of the observed DOFs, at one order.
    fn recovery(&self) -> f64 {
        let Some(ring) = &self.ring else {
            return COMPLEX * (self.contacts + self.observed) * self.dofs;
        };
        self.response() + COMPLEX * self.observed * ring.dofs * (ring.ports + 1.0)
    }

    /// Work of the factors of a Jacobian.
    fn elimination(&self, harmonics: &Harmonics) -> f64 {
        let slots = harmonics.slots() as f64;
        let Some(ring) = &self.ring else { return (self.slipping * slots).powi(3) / 3.0 };
        let [local, rest] = ring.parts.map(|ports| (ports * slots).powi(3));
        ring.sectors * (0.5 * local + 4.0 * rest)
    }

    /// Work of one product with the extended Jacobian, and of its substitution in the kept one.
    fn product(&self, all: &Harmonics) -> f64 {
        let (slots, kept) = (all.slots() as f64, self.kept.slots() as f64);
        let substitution = match &self.ring {
            Some(ring) => 8.0 * ring.sectors * (ring.ports * kept).powi(2),
            None => (self.slipping * kept).powi(2),
        };
        OF_A_PRODUCT
            + self.slipping * slots * slots
            + all.orders().count() as f64 * self.response()
            + substitution
            + self.contacts * slots * USUAL_PRODUCTS
    }

    /// Work of the laws of some points.
    fn law(&self, points: f64, harmonics: &Harmonics) -> f64 {
        let slots = harmonics.slots() as f64;
        let span = if harmonics.half_wave() { 0.5 } else { 1.0 };
        let samples = span * SAMPLES * harmonics.highest().max(4) as f64;
        points * slots * (samples + slots)
    }
}
