//! What is linear in the condensed equations at one frequency: the answer of the contacts to slip
//! loads, by dense receptances, through the modes of the stuck structure or around a ring of sectors.

use super::krylov_newton::KrylovNewton;
use super::modal_work::suits_laws;
use super::ring::{RingAnswers, RingNewton};
use super::slip_jacobian::SlipJacobian;
use super::unknowns::{gather, scatter};
use crate::fourier::{Harmonics, SampleTable};
use crate::model::Model;
use crate::structure::{
    Compliance, ContactCoordinates, ModalOrders, Quantity, Receptance, Request,
};
use crate::Error;
use faer::{c64, Mat, MatRef};

/// Tolerance of what the damping couples, where nothing corrects it.
const EXACT: f64 = 1e-14;

/// `U = U^stuck + G Q`, one part per kept order.
pub(super) enum Linear {
    /// Dense receptances.
    Dense(Vec<Receptance>),
    /// The same for loads at some points alone: no others slip.
    Part {
        /// These points.
        points: Vec<usize>,
        /// Contacts × points.
        receptances: Vec<Receptance>,
    },
    /// Modes of the stuck structure: receptances are never formed. Empty until a frequency is set.
    Modal(ModalOrders),
    /// Sectors coupled to their neighbours.
    Ring {
        /// Empty until a frequency is set.
        orders: Vec<RingAnswers>,
        /// Whether derivatives in ω are wanted.
        slopes: bool,
    },
}

/// Factors of `I − G ∂Q`.
pub(super) enum Factor {
    /// In the slip loads, by dense receptances.
    Dense(SlipJacobian),
    /// None: products with the matrix serve.
    Krylov(KrylovNewton),
    /// Of all sectors of a ring.
    Ring(Box<RingNewton>),
}

impl Linear {
    pub(super) fn new(model: &Model, table: &SampleTable, slopes: bool) -> Self {
        if model.compliance().ring().is_some() {
            Self::Ring { orders: Vec::new(), slopes }
        } else if suits_laws(model, table.harmonics()) {
            Self::Modal(ModalOrders::default())
        } else {
            Self::dense(table, slopes)
        }
    }

    /// Dense receptances.
    pub(super) fn dense(table: &SampleTable, slopes: bool) -> Self {
        let blank = Receptance { slope: slopes.then(Default::default), ..Receptance::default() };
        Self::Dense(vec![blank; table.harmonics().orders().count()])
    }

    /// Dense receptances for loads at some points.
    pub(super) fn part(table: &SampleTable, points: Vec<usize>) -> Self {
        let receptances = vec![Receptance::default(); table.harmonics().orders().count()];
        Self::Part { points, receptances }
    }

    /// Points that loads are on, but not those whose answers are known.
    pub(super) fn unknown(&self, loaded: impl Iterator<Item = usize>) -> Vec<usize> {
        let Self::Part { points, .. } = self else { return Vec::new() };
        loaded.filter(|point| !points.contains(point)).collect()
    }

    /// Adds loads at more points to those whose answers are known.
    pub(super) fn include(
        &mut self,
        more: Vec<usize>,
        compliance: &dyn Compliance,
        harmonics: &Harmonics,
        omega: f64,
    ) {
        let Self::Part { points, receptances } = self else { return };
        let mut own = Receptance::default();
        for (receptance, order) in receptances.iter_mut().zip(harmonics.orders()) {
            // What has an answer to loads at some points has one to those at others.
            if compliance.receptance_of(&more, order, omega, &mut own).is_err() {
                own.contact = vec![c64::new(f64::NAN, 0.0); more.len() * compliance.contacts()];
            }
            receptance.contact.append(&mut own.contact);
        }
        points.extend(more);
    }

    /// Takes dense receptances in any case.
    pub(super) fn densify(&mut self, table: &SampleTable, slopes: bool) {
        if !matches!(self, Self::Dense(_)) {
            *self = Self::dense(table, slopes);
        }
    }

    /// Evaluates the compliances at a frequency, and the response of the stuck structure; `known`
    /// holds those of other harmonics at this frequency.
    pub(super) fn evaluate(
        &mut self,
        compliance: &dyn Compliance,
        harmonics: &Harmonics,
        omega: f64,
        known: Option<(&Self, &Harmonics)>,
        stuck: &mut [f64],
    ) -> Result<(), (usize, Error)> {
        let position = |order| {
            let (linear, kept) = known?;
            kept.orders().position(|other| other == order).map(|index| (linear, index))
        };
        match self {
            Self::Dense(receptances) => {
                for (receptance, order) in receptances.iter_mut().zip(harmonics.orders()) {
                    if let Some((Self::Dense(known), index)) = position(order) {
                        receptance.clone_from(&known[index]);
                    } else {
                        compliance
                            .receptance(order, omega, receptance)
                            .map_err(|error| (order, error))?;
                    }
                    scatter(harmonics, order, &receptance.stuck, stuck);
                }
            }
            Self::Part { points, receptances } => {
                for (receptance, order) in receptances.iter_mut().zip(harmonics.orders()) {
                    if let Some((Self::Dense(known), index)) = position(order) {
                        receptance.clone_from(&known[index]);
                        receptance.keep(points);
                    } else {
                        compliance
                            .receptance_of(points, order, omega, receptance)
                            .map_err(|error| (order, error))?;
                    }
                    scatter(harmonics, order, &receptance.stuck, stuck);
                }
            }
            Self::Modal(orders) => {
                let Some(modes) = compliance.contact_modes() else { return Ok(()) };
                let slots = |order| harmonics.slot(order).map(|slot| (order, slot));
                let kept: Vec<_> = harmonics.orders().filter_map(slots).collect();
                *orders = modes.orders(&kept, omega)?;
                // Harmonics without a load leave the stuck contacts where they are.
                let forced = compliance.forced_harmonics();
                let kept = harmonics.orders().filter(|order| forced.contains(order));
                let own = kept.filter_map(|order| Some((order, harmonics.slot(order)?)));
                for (order, slot) in own {
                    let rows = if order == 0 { 1 } else { 2 };
                    let at = modes.orders(&[(order, 0)], omega)?;
                    let mut motion = Mat::zeros(rows, modes.size());
                    modes.add_load(&at, &mut motion);
                    modes.answer(&at, &mut motion, EXACT);
                    let motion = modes.displace(motion.as_ref());
                    for (point, own) in stuck.chunks_exact_mut(harmonics.slots()).enumerate() {
                        (0..rows).for_each(|row| own[slot + row] = motion[(row, point)]);
                    }
                }
            }
            Self::Ring { orders, slopes } => {
                orders.clear();
                let Some(ring) = compliance.ring() else { return Ok(()) };
                for order in harmonics.orders() {
                    let answers = match position(order) {
                        Some((Self::Ring { orders, .. }, index)) => orders[index].clone(),
                        _ => {
                            let equations = ring.order(order, omega, *slopes);
                            let equations = equations.map_err(|error| (order, error))?;
                            RingAnswers::new(equations, compliance.contacts())
                        }
                    };
                    scatter(harmonics, order, answers.loaded(), stuck);
                    orders.push(answers);
                }
            }
        }
        Ok(())
    }

    /// Modal coordinates of a motion, slots × modes, where receptances are not formed.
    pub(super) fn coordinates(
        &self,
        compliance: &dyn Compliance,
        harmonics: &Harmonics,
        quantity: Quantity,
        slip_load: &[f64],
    ) -> Option<Mat<f64>> {
        let Self::Modal(orders) = self else { return None };
        let modes = compliance.contact_modes()?;
        let mut motion = excite(modes, harmonics, slip_load);
        if quantity != Quantity::OfSlip {
            modes.add_load(orders, &mut motion);
        }
        modes.answer(orders, &mut motion, EXACT);
        if quantity == Quantity::Slope {
            modes.answer_rate(orders, &mut motion, EXACT);
        }
        Some(motion)
    }

    /// Displacements at all kept harmonics, one after the other; `motion` holds the modal coordinates, if
    /// there are some.
    pub(super) fn displacements(
        &self,
        compliance: &dyn Compliance,
        harmonics: &Harmonics,
        motion: Option<&Mat<f64>>,
        requests: &[Request<'_>],
        out: &mut [c64],
    ) -> Result<(), Error> {
        match (self, compliance.ring(), motion.zip(compliance.contact_modes())) {
            (Self::Ring { orders, .. }, Some(ring), _) => {
                let motion = |(request, answers): (&Request<'_>, &RingAnswers)| {
                    answers.motion(request.quantity != Quantity::OfSlip, request.slip_load)
                };
                let motions: Vec<_> = requests.iter().zip(orders).map(motion).collect();
                let orders: Vec<_> = orders.iter().map(RingAnswers::order).collect();
                ring.displacements_of(&orders, &motions, requests, out)
            }
            (_, _, Some((motion, modes))) => {
                let observed = requests.first().map_or(1, |request| request.observe.len().max(1));
                for (request, out) in requests.iter().zip(out.chunks_exact_mut(observed)) {
                    if let Some(slot) = harmonics.slot(request.harmonic) {
                        modes.observe(request.harmonic, slot, motion, request.observe, out);
                    }
                }
                Ok(())
            }
            _ => compliance.displacements(requests, out),
        }
    }

    /// `out += G q`.
    pub(super) fn add_response(
        &self,
        compliance: &dyn Compliance,
        harmonics: &Harmonics,
        slip_load: &[f64],
        out: &mut [f64],
    ) {
        match self {
            Self::Dense(receptances) => {
                add_product(receptances, None, harmonics, slip_load, out, |r| &r.contact);
            }
            Self::Part { points, receptances } => {
                add_product(receptances, Some(points), harmonics, slip_load, out, |r| &r.contact);
            }
            Self::Modal(orders) => {
                let Some(modes) = compliance.contact_modes() else { return };
                let load = series_matrix(modes, harmonics, slip_load);
                add_series(&modes.respond(orders, load, EXACT), out);
            }
            Self::Ring { orders, .. } => {
                let mut q = Vec::new();
                for (answers, order) in orders.iter().zip(harmonics.orders()) {
                    gather(harmonics, order, slip_load, &mut q);
                    add(harmonics, order, &answers.motion(false, &q).contact, out);
                }
            }
        }
    }

    /// `out += dU^stuck/dω + dG/dω q`; of parts nobody asks for it.
    pub(super) fn add_rate(
        &self,
        compliance: &dyn Compliance,
        harmonics: &Harmonics,
        slip_load: &[f64],
        out: &mut [f64],
    ) {
        match self {
            Self::Dense(receptances) => {
                for (receptance, order) in receptances.iter().zip(harmonics.orders()) {
                    if let Some((_, stuck)) = &receptance.slope {
                        add(harmonics, order, stuck, out);
                    }
                }
                add_product(receptances, None, harmonics, slip_load, out, |receptance| {
                    receptance.slope.as_ref().map_or(&[], |(contact, _)| contact)
                });
            }
            Self::Part { .. } => {}
            Self::Modal(orders) => {
                let Some(modes) = compliance.contact_modes() else { return };
                let mut motion = excite(modes, harmonics, slip_load);
                modes.add_load(orders, &mut motion);
                modes.answer(orders, &mut motion, EXACT);
                modes.answer_rate(orders, &mut motion, EXACT);
                add_motion(modes, &motion, out);
            }
            Self::Ring { orders, .. } => {
                let mut q = Vec::new();
                for (answers, order) in orders.iter().zip(harmonics.orders()) {
                    gather(harmonics, order, slip_load, &mut q);
                    let motion = answers.motion(true, &q);
                    let rate = answers.order().respond_rate(true, &motion);
                    add(harmonics, order, &rate.contact, out);
                }
            }
        }
    }

    /// `out += dG/dr q` of the ratio r of negative damping.
    pub(super) fn add_ratio_rate(&self, harmonics: &Harmonics, slip_load: &[f64], out: &mut [f64]) {
        if let Self::Dense(receptances) = self {
            add_product(receptances, None, harmonics, slip_load, out, |r| &r.by_ratio);
        }
    }
}

/// Series of all contacts as a matrix, slots × contacts.
fn series_matrix<'a>(
    modes: &dyn ContactCoordinates,
    harmonics: &Harmonics,
    series: &'a [f64],
) -> MatRef<'a, f64> {
    MatRef::from_column_major_slice(series, harmonics.slots(), modes.contacts())
}

/// Modal forces of the slip loads of all contacts.
fn excite(modes: &dyn ContactCoordinates, harmonics: &Harmonics, slip_load: &[f64]) -> Mat<f64> {
    modes.excite(series_matrix(modes, harmonics, slip_load))
}

/// Adds the displacements of all contacts by modal coordinates.
fn add_motion(modes: &dyn ContactCoordinates, coordinates: &Mat<f64>, out: &mut [f64]) {
    add_series(&modes.displace(coordinates.as_ref()), out);
}

/// Adds series of all contacts.
fn add_series(motion: &Mat<f64>, out: &mut [f64]) {
    let entries = motion.col_iter().flat_map(|column| column.iter());
    out.iter_mut().zip(entries).for_each(|(out, u)| *out += u);
}

/// Adds complex amplitudes of all points at one order to a real layout.
fn add(harmonics: &Harmonics, order: usize, amplitudes: &[c64], out: &mut [f64]) {
    let slots = harmonics.slots();
    let Some(slot) = harmonics.slot(order) else { return };
    for (point, amplitude) in amplitudes.iter().enumerate() {
        out[point * slots + slot] += amplitude.re;
        if order > 0 {
            out[point * slots + slot + 1] -= amplitude.im;
        }
    }
}

fn add_product(
    receptances: &[Receptance],
    points: Option<&[usize]>,
    harmonics: &Harmonics,
    slip_load: &[f64],
    out: &mut [f64],
    matrix: impl Fn(&Receptance) -> &[c64],
) {
    let slots = harmonics.slots();
    let contacts = slip_load.len() / slots.max(1);
    for (receptance, order) in receptances.iter().zip(harmonics.orders()) {
        let Some(slot) = harmonics.slot(order) else { continue };
        let g = matrix(receptance);
        if g.is_empty() {
            continue;
        }
        for column in 0..points.map_or(contacts, <[_]>::len) {
            let at = points.map_or(column, |points| points[column]) * slots + slot;
            let q = if order == 0 {
                c64::new(slip_load[at], 0.0)
            } else {
                c64::new(slip_load[at], -slip_load[at + 1])
            };
            if q == c64::new(0.0, 0.0) {
                continue;
            }
            for row in 0..contacts {
                let u = g[column * contacts + row] * q;
                out[row * slots + slot] += u.re;
                if order > 0 {
                    out[row * slots + slot + 1] -= u.im;
                }
            }
        }
    }
}
