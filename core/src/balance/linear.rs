//! What is linear in the condensed equations at one frequency: the answer of the contacts to slip
//! loads, by dense receptances or around a ring of sectors.

use super::ring_newton::RingNewton;
use super::unknowns::{gather, scatter};
use crate::fourier::{Harmonics, SampleTable};
use crate::structure::{Compliance, Receptance, RingOrder};
use crate::Error;
use faer::c64;
use faer::linalg::solvers::PartialPivLu;
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
    /// Of the points of contacts that slip.
    Dense(PartialPivLu<f64>),
    /// Of all sectors of a ring.
    Ring(RingNewton),
}

impl Linear {
    pub(super) fn dense(table: &SampleTable, slopes: bool) -> Self {
        let blank = Receptance { slope: slopes.then(Default::default), ..Receptance::default() };
        Self::Dense(vec![blank; table.harmonics().orders().count()])
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

    /// Displacements of the DOFs `observe` at the harmonic of position `index`, `order`.
    #[allow(clippy::too_many_arguments)]
    pub(super) fn displacement(
        &self,
        compliance: &dyn Compliance,
        (index, order): (usize, usize),
        omega: f64,
        contact: &[c64],
        slip_load: &[c64],
        observe: &[usize],
        out: &mut [c64],
    ) -> Result<(), Error> {
        match (self, compliance.ring()) {
            (Self::Ring { orders, .. }, Some(ring)) => {
                ring.displacement_of(&orders[index], order, omega, slip_load, observe, out)
            }
            _ => compliance.displacement(order, omega, contact, slip_load, observe, out),
        }
    }

    /// Derivatives in ω of [`Linear::displacement`], with slip loads and contact displacements
    /// (`solution`: u, q) that change at `rates`; for equations with slopes.
    #[allow(clippy::too_many_arguments)]
    pub(super) fn displacement_rate(
        &self,
        compliance: &dyn Compliance,
        (index, order): (usize, usize),
        omega: f64,
        [u, q]: [&[c64]; 2],
        [du, dq]: [&[c64]; 2],
        observe: &[usize],
        out: &mut [c64],
    ) -> Result<(), Error> {
        if let (Self::Ring { orders, .. }, Some(ring)) = (self, compliance.ring()) {
            return ring.displacement_rate_of(&orders[index], order, omega, [q, dq], observe, out);
        }
        let mut moved = vec![c64::new(0.0, 0.0); observe.len()];
        compliance.displacement_slope(order, omega, u, q, observe, out)?;
        compliance.slip_displacement(order, omega, du, dq, observe, &mut moved)?;
        out.iter_mut().zip(moved).for_each(|(out, moved)| *out += moved);
        Ok(())
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
