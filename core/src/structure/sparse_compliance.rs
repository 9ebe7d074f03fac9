//! Compliance of a structure whose matrices hold few numbers, with many contacts: by sparse
//! factorisations. Receptances are formed only for those who ask, and so are natural frequencies.

use super::contact_coordinates::ContactCoordinates;
use super::modes::{squared_frequencies, RealModes};
use super::ports::{forced_harmonics, Ports};
use super::restraint::store;
use super::sparse_contacts::SparseContacts;
use super::{pays_for_modes, Compliance, Outline, Quantity, Receptance, Request, Structure};
use crate::Error;
use faer::linalg::solvers::Solve as _;
use faer::{c64, Mat};
use std::sync::OnceLock;

/// A structure of few numbers seen from its contacts.
#[derive(Debug)]
pub struct SparseCompliance {
    contacts: SparseContacts,
    outline: Outline,
    /// Natural frequencies with no contact, and with all of them stuck.
    frequencies: [OnceLock<Vec<f64>>; 2],
}

impl SparseCompliance {
    /// Of a structure with many contacts and few numbers; nothing if others serve it better.
    ///
    /// # Errors
    /// Shapes that do not fit.
    pub fn new(structure: &Structure, ports: &Ports) -> Result<Option<Self>, Error> {
        ports.check(structure.dofs())?;
        let Some(contacts) = SparseContacts::new(structure, ports) else { return Ok(None) };
        let (bandwidth, forced) = (contacts.bandwidth(), forced_harmonics(&ports.loads));
        Ok(Some(Self {
            contacts,
            outline: Outline { bandwidth, forced, ..Outline::default() },
            frequencies: Default::default(),
        }))
    }

    fn frequencies(&self, stuck: bool) -> &[f64] {
        self.frequencies[usize::from(stuck)].get_or_init(|| {
            let [mass, stiffness] = self.contacts.dense(stuck);
            let squared = squared_frequencies(mass.as_ref(), stiffness.as_ref());
            let omega_squared = squared.unwrap_or_default();
            RealModes { omega_squared, shapes: Mat::new() }.frequencies()
        })
    }
}

impl Compliance for SparseCompliance {
    fn contacts(&self) -> usize {
        self.contacts.contacts()
    }

    fn dofs(&self) -> usize {
        self.contacts.dofs()
    }

    fn outline(&self) -> &Outline {
        &self.outline
    }

    fn contact_modes(&self) -> Option<&dyn ContactCoordinates> {
        Some(&self.contacts)
    }

    fn require_grounded(&self) -> Result<(), Error> {
        // A structure that moves rigidly is seen in another way.
        Ok(())
    }

    fn receptance(&self, harmonic: usize, omega: f64, out: &mut Receptance) -> Result<(), Error> {
        out.reset(self.contacts());
        let factors = self.contacts.factors(harmonic, omega)?;
        let answers = self.contacts.forces(harmonic).map(|forces| factors.solve(forces));
        store(self.contacts.at_contacts(&answers[0]).as_ref(), &mut out.contact);
        store(self.contacts.at_contacts(&answers[1]).as_ref(), &mut out.stuck);
        if let Some((contact, stuck)) = &mut out.slope {
            for (answer, out) in answers.iter().zip([contact, stuck]) {
                let change = self.contacts.softening(harmonic, omega, answer.as_ref());
                store(self.contacts.at_contacts(&factors.solve(change)).as_ref(), out);
            }
        }
        Ok(())
    }

    fn displacement(&self, request: &Request<'_>, out: &mut [c64]) -> Result<(), Error> {
        let Request { harmonic, omega, quantity, slip_load, observe, .. } = *request;
        let slots = if harmonic == 0 { 1 } else { 2 };
        let at = self.contacts.orders(&[(harmonic, 0)], omega).map_err(|(_, error)| error)?;
        let part = |row: usize, q: &c64| if row == 0 { q.re } else { -q.im };
        let slip = Mat::from_fn(slots, slip_load.len(), |i, j| part(i, &slip_load[j]));
        let mut motion = self.contacts.excite(slip.as_ref());
        if quantity != Quantity::OfSlip {
            self.contacts.add_load(&at, &mut motion);
        }
        self.contacts.answer(&at, &mut motion, 0.0);
        if quantity == Quantity::Slope {
            self.contacts.answer_rate(&at, &mut motion, 0.0);
        }
        self.contacts.observe(harmonic, 0, &motion, observe, out);
        Ok(())
    }

    fn effort(&self, points: usize, _observed: usize) -> [f64; 2] {
        let factors = self.contacts.effort();
        [factors + points as f64 * self.contacts.work(1.0, 1.0), factors]
    }

    fn stuck_frequencies(&self) -> &[f64] {
        self.frequencies(true)
    }

    fn frequencies_between(&self, stuck: bool, band: [f64; 2]) -> Vec<f64> {
        let found = self.contacts.between(stuck, band);
        found.unwrap_or_else(|| {
            let all = self.frequencies(stuck).iter().copied();
            all.filter(|w| (band[0]..=band[1]).contains(w)).collect()
        })
    }

    /// They take a decomposition of what is sparse.
    fn finds_modes(&self, spent: f64) -> bool {
        pays_for_modes(self.dofs(), spent)
    }

    fn lowest_frequencies(&self) -> Option<[f64; 2]> {
        Some(self.contacts.lowest())
    }

    fn highest_frequency(&self) -> f64 {
        self.contacts.highest()
    }

    fn free_frequencies(&self) -> &[f64] {
        self.frequencies(false)
    }
}

#[cfg(test)]
#[allow(clippy::unwrap_used)]
mod tests {
    use super::*;

    /// What a sweep asks for takes no decomposition.
    #[test]
    fn frequencies_are_found_only_when_many_questions_pay_for_them() {
        let (size, contacts) = (300, 150);
        let between = |i: usize, j: usize| match i.abs_diff(j) {
            0 => 2.5,
            1 => -1.0,
            _ => 0.0,
        };
        let stiffness = Mat::from_fn(size, size, between);
        let mass = Mat::<f64>::identity(size, size);
        let damping = faer::Scale(0.1) * &mass;
        let structure = Structure::new(mass.as_ref(), damping.as_ref(), stiffness.as_ref());
        let rows = Mat::from_fn(contacts, size, |i, j| f64::from(u8::from(j == 2 * i)));
        let held = faer::Scale(3.0) * Mat::<f64>::identity(contacts, contacts);
        let ports = Ports { rows: rows.into(), stiffness: held.into(), loads: Vec::new() };
        let compliance = SparseCompliance::new(&structure.unwrap(), &ports).unwrap().unwrap();
        assert!(
            !compliance.is_clear(3, [90.0, 91.0], 0.0) && compliance.is_clear(3, [90.0, 90.1], 0.0)
        );
        assert!(compliance.frequencies.iter().all(|list| list.get().is_none()));
        assert!(compliance.is_clear(3, [90.0, 91.0], f64::INFINITY));
    }
}
