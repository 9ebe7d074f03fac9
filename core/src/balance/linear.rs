//! What is linear in the condensed equations at one frequency: the answer of the contacts to slip
//! loads, by dense receptances or around a ring of sectors.

use super::ring_newton::RingNewton;
use super::slip_jacobian::SlipJacobian;
use super::unknowns::{gather, scatter};
use crate::fourier::{Harmonics, SampleTable};
use crate::structure::{Compliance, Receptance, Request, RingOrder};
use crate::Error;
use faer::c64;
use std::sync::Arc;

/// `U = U^stuck + G Q`, one part per kept order.
pub(super) enum Linear {
    /// Dense receptances.
    Dense(Vec<Receptance>),
    /// Sectors coupled to their neighbours.
    Ring {
        /// Empty until a frequency is set.
        orders: Vec<Arc<RingOrder>>,
        /// Whether derivatives in ω are wanted.
        slopes: bool,
    },
}

/// Factors of `I − G ∂Q`.
pub(super) enum Factor {
    /// In the slip loads, by dense receptances.
    Dense(SlipJacobian),
    /// Of all sectors of a ring.
    Ring(RingNewton),
}

impl Linear {
    pub(super) fn new(compliance: &dyn Compliance, table: &SampleTable, slopes: bool) -> Self {
        match compliance.ring() {
            Some(_) => Self::Ring { orders: Vec::new(), slopes },
            None => Self::dense(table, slopes),
        }
    }

    fn dense(table: &SampleTable, slopes: bool) -> Self {
        let blank = Receptance { slope: slopes.then(Default::default), ..Receptance::default() };
        Self::Dense(vec![blank; table.harmonics().orders().count()])
    }

    /// Takes dense receptances also of a ring.
    pub(super) fn densify(&mut self, table: &SampleTable) {
        if let Self::Ring { slopes, .. } = self {
            *self = Self::dense(table, *slopes);
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
            Self::Ring { orders, slopes } => {
                orders.clear();
                let Some(ring) = compliance.ring() else { return Ok(()) };
                let rest = vec![c64::new(0.0, 0.0); compliance.contacts()];
                for order in harmonics.orders() {
                    let equations = match position(order) {
                        Some((Self::Ring { orders, .. }, index)) => Arc::clone(&orders[index]),
                        _ => Arc::new(
                            ring.order(order, omega, *slopes).map_err(|error| (order, error))?,
                        ),
                    };
                    scatter(harmonics, order, &equations.respond(true, &rest).contact, stuck);
                    orders.push(equations);
                }
            }
        }
        Ok(())
    }

    /// Displacements at the harmonic of position `index`.
    pub(super) fn displacement(
        &self,
        compliance: &dyn Compliance,
        index: usize,
        request: &Request<'_>,
        out: &mut [c64],
    ) -> Result<(), Error> {
        match (self, compliance.ring()) {
            (Self::Ring { orders, .. }, Some(ring)) => {
                ring.displacement_of(&orders[index], request, out)
            }
            _ => compliance.displacement(request, out),
        }
    }

    /// `out += G q`.
    pub(super) fn add_response(&self, harmonics: &Harmonics, slip_load: &[f64], out: &mut [f64]) {
        match self {
            Self::Dense(receptances) => {
                add_product(receptances, harmonics, slip_load, out, |r| &r.contact);
            }
            Self::Ring { orders, .. } => {
                let mut q = Vec::new();
                for (equations, order) in orders.iter().zip(harmonics.orders()) {
                    gather(harmonics, order, slip_load, &mut q);
                    add(harmonics, order, &equations.respond(false, &q).contact, out);
                }
            }
        }
    }

    /// `out += dU^stuck/dω + dG/dω q`.
    pub(super) fn add_rate(&self, harmonics: &Harmonics, slip_load: &[f64], out: &mut [f64]) {
        match self {
            Self::Dense(receptances) => {
                for (receptance, order) in receptances.iter().zip(harmonics.orders()) {
                    if let Some((_, stuck)) = &receptance.slope {
                        add(harmonics, order, stuck, out);
                    }
                }
                add_product(receptances, harmonics, slip_load, out, |receptance| {
                    receptance.slope.as_ref().map_or(&[], |(contact, _)| contact)
                });
            }
            Self::Ring { orders, .. } => {
                let mut q = Vec::new();
                for (equations, order) in orders.iter().zip(harmonics.orders()) {
                    gather(harmonics, order, slip_load, &mut q);
                    let motion = equations.respond(true, &q);
                    let rate = equations.respond_rate(true, &motion);
                    add(harmonics, order, &rate.contact, out);
                }
            }
        }
    }

    /// `out += dG/dr q` of the ratio r of negative damping.
    pub(super) fn add_ratio_rate(&self, harmonics: &Harmonics, slip_load: &[f64], out: &mut [f64]) {
        if let Self::Dense(receptances) = self {
            add_product(receptances, harmonics, slip_load, out, |r| &r.by_ratio);
        }
    }
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
        for column in 0..contacts {
            let at = column * slots + slot;
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
