//! What a modal compliance answers: receptances and displacements as sums over its modes.

use super::contact_coordinates::ContactCoordinates;
use super::contact_modes::ContactModes;
use super::modal::{ModalBase, ModalCompliance};
use super::modes::resonates;
use super::restraint::{restrain, FEW};
use super::spectrum::Spectrum;
use super::{within, Compliance, Outline, Quantity, Receptance, Request};
use crate::solve::multiply;
use crate::Error;
use faer::{c64, Accum, ColMut, Mat, MatMut};
use std::ops::Range;

/// The range of degrees of freedom that follow one another.
fn consecutive(observe: &[usize]) -> Option<Range<usize>> {
    let first = *observe.first()?;
    let follow = observe.iter().enumerate().all(|(i, dof)| *dof == first + i);
    follow.then(|| first..first + observe.len())
}

impl ModalCompliance {
    /// Weight of a mode at `omega`.
    fn weight(&self, j: usize, omega: f64) -> c64 {
        if j + self.statics < self.right.ncols() {
            self.spectrum.weight(j, omega)
        } else {
            c64::new(1.0, 0.0)
        }
    }

    /// Its derivative in the frequency whose multiple `order` is met.
    fn slope(&self, j: usize, (order, omega): (f64, f64), weight: c64) -> c64 {
        if j + self.statics < self.right.ncols() {
            order * self.spectrum.slope(j, order * omega, weight)
        } else {
            c64::new(0.0, 0.0)
        }
    }

    fn singular(&self) -> Error {
        Error::SingularStiffness { lowest: self.outline.stuck.first().copied().unwrap_or(0.0) }
    }

    fn load(&self, harmonic: usize) -> Option<&[c64]> {
        self.loads.iter().find(|(order, _)| *order == harmonic).map(|(_, load)| load.as_slice())
    }

    /// Refuses a frequency at which an undamped mode of the stuck structure resonates: one of the stuck base, or
    /// one of the free base that moves no contact.
    fn check_resonance(&self, harmonic: usize, omega: f64) -> Result<(), Error> {
        let Spectrum::Real { omega_squared, damping, .. } = &self.spectrum else {
            return Ok(());
        };
        let squared = (harmonic as f64 * omega).powi(2);
        for (j, (&natural, &c)) in omega_squared.iter().zip(damping).enumerate() {
            let distance = (natural - squared).abs() + harmonic as f64 * omega * c.abs();
            // Hardly any mode is so close.
            if !resonates(distance, squared, false) {
                continue;
            }
            let moved =
                (0..self.contact_left.nrows()).any(|i| self.contact_left[(i, j)].norm() > 0.0);
            let loaded = || self.load(harmonic).is_some_and(|load| load[j].norm() > 0.0);
            let counts = if moved { self.base == ModalBase::Stuck } else { loaded() };
            if resonates(distance, squared, moved) && counts {
                return Err(Error::UndampedResonance {
                    omega,
                    harmonic,
                    natural: natural.max(0.0).sqrt(),
                });
            }
        }
        Ok(())
    }

    /// Sums the modes into `g` (and its derivative) for loads at all points, or at some alone, and for the
    /// external load.
    fn sum_modes(
        &self,
        points: Option<&[usize]>,
        (harmonic, omega): (usize, f64),
        out: &mut Receptance,
    ) {
        let contacts = self.contacts();
        let order = harmonic as f64;
        let load = self.load(harmonic);
        if !self.negative.is_empty() {
            out.by_ratio.resize(contacts * contacts, c64::new(0.0, 0.0));
        }
        let by_products = contacts >= ContactModes::FEWEST && self.negative.is_empty();
        if by_products {
            self.multiply_modes(points, (order, omega), out);
        }
        for j in 0..self.right.ncols() {
            let weight = self.weight(j, order * omega);
            let slope = || self.slope(j, (order, omega), weight);
            let [left, right] =
                [&self.contact_left, &self.contact_right].map(|c| c.col_as_slice(j));
            let add = |to: &mut [c64], factor: c64| {
                for (at, column) in to.chunks_exact_mut(contacts.max(1)).enumerate() {
                    let value = factor * left[points.map_or(at, |points| points[at])];
                    column.iter_mut().zip(right).for_each(|(to, right)| *to += right * value);
                }
            };
            if !by_products {
                add(&mut out.contact, weight);
                if let Some((contact, _)) = &mut out.slope {
                    add(contact, slope());
                }
                if let Some(negative) = self.negative.get(j) {
                    let change = weight * weight * c64::new(0.0, -order * omega * negative);
                    add(&mut out.by_ratio, change);
                }
            }
            let Some(load) = load else { continue };
            for row in 0..contacts {
                let response = right[row] * load[j];
                out.stuck[row] += response * weight;
                if let Some((_, stuck)) = &mut out.slope {
                    stuck[row] += response * slope();
                }
            }
        }
    }

    /// Coordinates of the modes at a harmonic above 0; `acting` makes room for forces.
    fn write_coordinates(
        &self,
        request: &Request<'_>,
        acting: &mut Vec<(usize, c64)>,
        out: ColMut<'_, c64>,
    ) {
        let Request { harmonic, omega, quantity, contact, slip_load, .. } = *request;
        let (loaded, sloped) = (quantity != Quantity::OfSlip, quantity == Quantity::Slope);
        // The free structure carries the whole contact force, the stuck one the slip load alone.
        let force = |i: usize| match &self.restraint {
            Some(stiffness) => {
                let held = contact.iter().enumerate().map(|(j, u)| stiffness[(i, j)] * u);
                slip_load[i] - held.sum::<c64>()
            }
            None => slip_load[i],
        };
        let forces = (0..contact.len()).map(|i| (i, force(i)));
        acting.clear();
        acting.extend(forces.filter(|(_, force)| *force != c64::new(0.0, 0.0)));
        let (order, load) = (harmonic as f64, self.load(harmonic).filter(|_| loaded));
        for (j, coordinate) in out.iter_mut().enumerate() {
            let left = self.contact_left.col_as_slice(j);
            let mut excitation = load.map_or(c64::new(0.0, 0.0), |load| load[j]);
            acting.iter().for_each(|(i, force)| excitation += left[*i] * *force);
            let weight = self.weight(j, order * omega);
            let slope = || self.slope(j, (order, omega), weight);
            *coordinate = excitation * if sloped { slope() } else { weight };
        }
    }

    /// The sum for the pairs of many contacts, as a product of matrices.
    fn multiply_modes(
        &self,
        points: Option<&[usize]>,
        (order, omega): (f64, f64),
        out: &mut Receptance,
    ) {
        let (contacts, modes) = (self.contacts(), self.right.ncols());
        let columns = points.map_or(contacts, <[_]>::len);
        let point = |at: usize| points.map_or(at, |points| points[at]);
        let weights: Vec<[c64; 2]> = (0..modes)
            .map(|j| {
                let weight = self.weight(j, order * omega);
                [weight, self.slope(j, (order, omega), weight)]
            })
            .collect();
        let slope = out.slope.as_mut().map(|(contact, _)| contact);
        for (which, sum) in [&mut out.contact].into_iter().chain(slope).enumerate() {
            let left = Mat::from_fn(modes, columns, |j, i| {
                self.contact_left[(point(i), j)] * weights[j][which]
            });
            let sum = MatMut::from_column_major_slice_mut(sum, contacts, columns);
            let (right, one) = (self.contact_right.as_ref(), c64::new(1.0, 0.0));
            multiply(sum, Accum::Replace, right, left.as_ref(), one);
        }
    }
}

impl Compliance for ModalCompliance {
    fn contacts(&self) -> usize {
        self.contact_right.nrows()
    }

    fn dofs(&self) -> usize {
        self.right.nrows()
    }

    fn outline(&self) -> &Outline {
        &self.outline
    }

    fn contact_modes(&self) -> Option<&dyn ContactCoordinates> {
        self.contact_modes.as_deref().map(|modes| modes as &dyn ContactCoordinates)
    }

    fn receptance(&self, harmonic: usize, omega: f64, out: &mut Receptance) -> Result<(), Error> {
        out.reset(self.contacts());
        if harmonic == 0 {
            self.flexibility.as_ref().ok_or_else(|| self.singular())?.receptance(out);
            return Ok(());
        }
        self.check_resonance(harmonic, omega)?;
        self.sum_modes(None, (harmonic, omega), out);
        if let Some(stiffness) = &self.restraint {
            restrain(stiffness.as_ref(), None, out);
        }
        Ok(())
    }

    fn receptance_of(
        &self,
        points: &[usize],
        harmonic: usize,
        omega: f64,
        out: &mut Receptance,
    ) -> Result<(), Error> {
        if harmonic == 0 {
            self.receptance(harmonic, omega, out)?;
            out.keep(points);
            return Ok(());
        }
        self.check_resonance(harmonic, omega)?;
        let contacts = self.contacts();
        out.reset(contacts);
        if let Some(stiffness) = &self.restraint {
            self.sum_modes(None, (harmonic, omega), out);
            restrain(stiffness.as_ref(), Some(points), out);
        } else {
            out.contact.truncate(contacts * points.len());
            self.sum_modes(Some(points), (harmonic, omega), out);
        }
        Ok(())
    }

    fn displacement(&self, request: &Request<'_>, out: &mut [c64]) -> Result<(), Error> {
        self.displacements(std::slice::from_ref(request), out)
    }

    fn displacements(&self, requests: &[Request<'_>], mut out: &mut [c64]) -> Result<(), Error> {
        out.fill(c64::new(0.0, 0.0));
        let [first, ..] = requests else { return Ok(()) };
        let (mut requests, observe) = (requests, first.observe);
        if first.harmonic == 0 {
            let (rest, loaded) = out.split_at_mut(observe.len());
            // Static displacements do not know of a frequency.
            if first.quantity != Quantity::Slope {
                let flexibility = self.flexibility.as_ref().ok_or_else(|| self.singular())?;
                let loads = first.quantity == Quantity::Whole;
                flexibility.displacement(loads, first.slip_load, observe, rest);
            }
            (requests, out) = (&requests[1..], loaded);
        }
        let modes = self.right.ncols();
        let mut coordinates = Mat::zeros(modes, requests.len());
        let mut acting = Vec::with_capacity(self.contacts());
        for (column, request) in coordinates.col_iter_mut().zip(requests) {
            self.write_coordinates(request, &mut acting, column);
        }
        // Always a product: what a DOF does must not depend on those that are observed with it, not even in rounding.
        let gathered;
        let shapes = if let Some(rows) = consecutive(observe) {
            self.right.get(rows, ..)
        } else {
            gathered = Mat::from_fn(observe.len(), modes, |i, j| self.right[(observe[i], j)]);
            gathered.as_ref()
        };
        let out = MatMut::from_column_major_slice_mut(out, observe.len(), requests.len());
        multiply(out, Accum::Replace, shapes, coordinates.as_ref(), c64::new(1.0, 0.0));
        Ok(())
    }

    /// What resonates beside a mode of this base is taken to be as narrow.
    fn is_clear(&self, _harmonic: usize, range: [f64; 2], _spent: f64) -> bool {
        let width = 0.5 * (range[1] - range[0]);
        let narrow = |frequency: f64| match &self.spectrum {
            Spectrum::Real { omega_squared, damping, .. } => {
                let above = within(omega_squared, [f64::MIN, frequency.powi(2)]).end;
                let beside = above.saturating_sub(1)..(above + 1).min(damping.len());
                damping[beside].iter().any(|c| c.abs() < width)
            }
            Spectrum::Complex { .. } => self.outline.bandwidth < width,
        };
        let Outline { stuck, free, .. } = &self.outline;
        ![stuck, free].iter().any(|list| list[within(list, range)].iter().copied().any(narrow))
    }

    fn effort(&self, points: usize, observed: usize) -> [f64; 2] {
        let (modes, contacts) = (self.right.ncols() as f64, self.contacts() as f64);
        let points = points as f64;
        // Measured: products of matrices, elimination by a library, and by hand.
        let [own, pair, factor, answer] = match self.contacts() {
            ContactModes::FEWEST.. => [100.0, 0.35, 0.5, 0.6],
            contacts if contacts > FEW => [27.0, 1.4, 1.5, 2.5],
            _ => [27.0, 1.4, 0.3, 2.5],
        };
        let restrained = self.restraint.is_some();
        let (loaded, acting) = if restrained { (contacts, contacts) } else { (points, points) };
        // A factorisation and as many solutions as there are points.
        let restraint = contacts.powi(2) * (factor * contacts + answer * points);
        let restraint = if restrained { restraint } else { 0.0 };
        let displacement = modes * (12.0 + 1.7 * acting + 0.25 * observed as f64);
        [modes * (own + pair * contacts * loaded) + restraint, displacement]
    }
}
