//! Compliance of a structure with many contacts: real modes of the stuck structure, seen from the
//! contacts. Receptances are formed only for those who ask, and so are the natural frequencies without
//! contacts: the lowest of them, by which a body is known that contacts alone hold, is found by itself.

use super::contact_coordinates::ContactCoordinates;
use super::contact_modes::ContactModes;
use super::modes::{frequencies, lowest_squared, squared_frequencies};
use super::ports::{forced_harmonics, Ports};
use super::proportional::follows_mass;
use super::restraint::store;
use super::{pays_for_modes, Compliance, Outline, Quantity, Receptance, Request, Structure};
use crate::Error;
use faer::{c64, Mat};
use std::sync::OnceLock;

/// Contacts from which on a structure is seen in this way whatever its damping is.
const MANY: usize = 128;
/// Tolerance of what the damping couples.
const EXACT: f64 = 1e-14;

/// A structure seen from its contacts.
#[derive(Debug)]
pub struct InterfaceCompliance {
    modes: ContactModes,
    outline: Outline,
    /// Contact stiffness, pair by pair of points [N/m].
    held: Vec<(usize, usize, f64)>,
    /// Natural frequencies without contacts, and about the lowest of them.
    free: OnceLock<Vec<f64>>,
    lowest_free: f64,
}

impl InterfaceCompliance {
    /// Of a structure with many contacts; nothing if others serve it better.
    ///
    /// # Errors
    /// Shapes that do not fit, or an eigenvalue iteration that fails.
    pub fn new(structure: &Structure, ports: &Ports) -> Result<Option<Self>, Error> {
        ports.check(structure.dofs())?;
        let (mass, damping) = (structure.mass(), structure.damping());
        let contacts = ports.rows.nrows();
        let uncoupled = damping.norm_max() == 0.0 || follows_mass(damping, mass);
        if contacts < if uncoupled { ContactModes::FEWEST } else { MANY } {
            return Ok(None);
        }
        let restrained = structure.restrained_stiffness(&ports.rows, &ports.stiffness);
        let stuck = structure.modes_at(restrained)?;
        let seen = if uncoupled {
            let rate = damping[(0, 0)] / mass[(0, 0)];
            ContactModes::uncoupled(&stuck, &vec![rate; stuck.modes.omega_squared.len()], ports)
        } else {
            ContactModes::new(&stuck, || stuck.modes.project(damping), ports)
        };
        let stuck = stuck.modes.frequencies();
        let Some(modes) = seen else { return Ok(None) };
        let bandwidth = modes.narrowest_bandwidth();
        let forced = forced_harmonics(&ports.loads);
        let beside = stuck.first().map_or(0.0, |lowest| lowest * lowest);
        let lowest_free = lowest_squared(mass, structure.stiffness(), beside).sqrt();
        let free = OnceLock::new();
        if !structure.massless().is_empty() {
            // They are no part of the modes.
            let squared = squared_frequencies(mass, structure.stiffness())?;
            free.get_or_init(|| frequencies(&squared));
        }
        let pairs = ports.stiffness.col_iter().enumerate();
        let pairs = pairs.flat_map(|(j, column)| {
            column.iter().enumerate().map(move |(i, d)| (i, j, *d)).collect::<Vec<_>>()
        });
        let held = pairs.filter(|(_, _, d)| *d != 0.0).collect();
        let outline = Outline { stuck, free: Vec::new(), bandwidth, forced };
        Ok(Some(Self { modes, outline, held, free, lowest_free }))
    }
}

impl InterfaceCompliance {
    /// Which modes carry it.
    pub(super) fn base(&self) -> &'static str {
        if self.modes.is_coupled() {
            "coupled stuck modes"
        } else {
            "stuck modes"
        }
    }
}

impl Compliance for InterfaceCompliance {
    fn contacts(&self) -> usize {
        self.modes.shapes().ncols()
    }

    fn dofs(&self) -> usize {
        self.modes.dofs()
    }

    fn outline(&self) -> &Outline {
        &self.outline
    }

    fn contact_modes(&self) -> Option<&dyn ContactCoordinates> {
        Some(&self.modes)
    }

    /// Those without contacts take a decomposition.
    fn finds_modes(&self, spent: f64) -> bool {
        pays_for_modes(self.dofs(), spent)
    }

    fn lowest_frequencies(&self) -> Option<[f64; 2]> {
        Some([*self.outline.stuck.first()?, self.lowest_free])
    }

    fn free_frequencies(&self) -> &[f64] {
        self.free.get_or_init(|| frequencies(&self.modes.squared_without(&self.held)))
    }

    fn require_grounded(&self) -> Result<(), Error> {
        self.modes.check(0, 0.0)
    }

    fn receptance(&self, harmonic: usize, omega: f64, out: &mut Receptance) -> Result<(), Error> {
        let all: Vec<usize> = (0..self.contacts()).collect();
        self.receptance_of(&all, harmonic, omega, out)
    }

    fn receptance_of(
        &self,
        points: &[usize],
        harmonic: usize,
        omega: f64,
        out: &mut Receptance,
    ) -> Result<(), Error> {
        out.reset(self.contacts());
        out.contact.truncate(self.contacts() * points.len());
        self.modes.check(harmonic, omega)?;
        let rows = self.modes.shapes();
        let complex = |i: usize, j: usize| c64::new(rows[(i, points[j])], 0.0);
        let forces = Mat::from_fn(rows.nrows(), points.len(), complex);
        let load = self.modes.load(harmonic);
        let load =
            Mat::from_fn(rows.nrows(), 1, |i, _| load.map_or(c64::new(0.0, 0.0), |load| load[i]));
        let coordinates = [forces, load].map(|forces| self.modes.solved(harmonic, omega, forces));
        let at_contacts = |coordinates: &Mat<c64>| {
            // Two real products.
            let part = |of: fn(&c64) -> f64| {
                let size = (coordinates.nrows(), coordinates.ncols());
                rows.transpose() * Mat::from_fn(size.0, size.1, |i, j| of(&coordinates[(i, j)]))
            };
            let re = part(|z| z.re);
            if harmonic == 0 {
                return Mat::from_fn(re.nrows(), re.ncols(), |i, j| c64::new(re[(i, j)], 0.0));
            }
            let im = part(|z| z.im);
            Mat::from_fn(re.nrows(), re.ncols(), |i, j| c64::new(re[(i, j)], im[(i, j)]))
        };
        store(at_contacts(&coordinates[0]).as_ref(), &mut out.contact);
        store(at_contacts(&coordinates[1]).as_ref(), &mut out.stuck);
        if let Some((contact, stuck)) = &mut out.slope {
            let slopes = coordinates.map(|coordinates| {
                let softening = self.modes.softening(harmonic, omega, &coordinates);
                self.modes.solved(harmonic, omega, softening)
            });
            store(at_contacts(&slopes[0]).as_ref(), contact);
            store(at_contacts(&slopes[1]).as_ref(), stuck);
        }
        Ok(())
    }

    fn displacement(&self, request: &Request<'_>, out: &mut [c64]) -> Result<(), Error> {
        let Request { harmonic, omega, quantity, slip_load, observe, .. } = *request;
        let slots = if harmonic == 0 { 1 } else { 2 };
        let at = self.modes.orders(&[(harmonic, 0)], omega);
        let at = at.map_err(|(_, error)| error)?;
        let part = |row: usize, q: &c64| if row == 0 { q.re } else { -q.im };
        let slip = Mat::from_fn(slots, slip_load.len(), |i, j| part(i, &slip_load[j]));
        let mut motion = self.modes.excite(slip.as_ref());
        if quantity != Quantity::OfSlip {
            self.modes.add_load(&at, &mut motion);
        }
        self.modes.answer(&at, &mut motion, EXACT);
        if quantity == Quantity::Slope {
            self.modes.answer_rate(&at, &mut motion, EXACT);
        }
        self.modes.observe(harmonic, 0, &motion, observe, out);
        Ok(())
    }

    fn effort(&self, points: usize, observed: usize) -> [f64; 2] {
        let (modes, contacts) = (self.modes.modes() as f64, self.contacts() as f64);
        let whole = if self.modes.is_coupled() { modes.powi(3) } else { 0.0 };
        let displacement = modes * (20.0 + 1.5 * (contacts + observed as f64));
        [modes * (20.0 + 0.5 * contacts * points as f64) + whole, displacement]
    }
}

#[cfg(test)]
#[allow(clippy::unwrap_used)]
mod tests {
    use super::*;

    /// Setting up takes one eigenproblem, and what a sweep asks for no other.
    #[test]
    fn frequencies_without_contacts_are_found_only_when_all_are_asked_for() {
        let size = 40;
        let between = |i: usize, j: usize| match i.abs_diff(j) {
            0 => 2.5,
            1 => -1.0,
            _ => 0.0,
        };
        let stiffness = Mat::from_fn(size, size, between);
        let mass = Mat::<f64>::identity(size, size);
        let damping = faer::Scale(0.1) * &mass;
        let structure = Structure::new(mass.as_ref(), damping.as_ref(), stiffness.as_ref());
        let (rows, held) = (mass.clone(), faer::Scale(3.0) * &mass);
        let ports = Ports { rows: rows.into(), stiffness: held.into(), loads: Vec::new() };
        let compliance = InterfaceCompliance::new(&structure.unwrap(), &ports).unwrap().unwrap();
        let [stuck, free] = compliance.lowest_frequencies().unwrap();
        assert!((stuck * stuck - free * free - 3.0).abs() < 1e-5);
        // Few questions do not pay for them, and a passage of less than a bandwidth needs none.
        assert!(
            !compliance.is_clear(3, [90.0, 91.0], 0.0) && compliance.is_clear(3, [90.0, 90.1], 0.0)
        );
        assert!(compliance.free.get().is_none());
        assert!(compliance.is_clear(3, [90.0, 91.0], f64::INFINITY));
        let all = compliance.free_frequencies();
        assert!((all[0] / free - 1.0).abs() < 1e-5 && all.len() == size);
    }
}
