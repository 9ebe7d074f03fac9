//! A ring of sectors as a compliance of all its contacts.

use super::ring::Ring;
use super::ring_order::{RingMotion, RingOrder};
use super::{pays_for_modes, Compliance, Outline, Quantity, Receptance, Request};
use crate::Error;
use faer::c64;
use std::f64::consts::TAU;

/// Share of a turn by which harmonics that come to all sectors at once miss whole turns: rounding.
const SILENT: f64 = 1e-9;

impl Ring {
    /// [`Compliance::displacement`] with the equations of this harmonic and frequency and the motion
    /// at hand; equations of a slope must have slopes.
    ///
    /// # Errors
    /// As [`Compliance::receptance`].
    pub fn displacement_of(
        &self,
        order: &RingOrder,
        motion: &RingMotion,
        request: &Request<'_>,
        out: &mut [c64],
    ) -> Result<(), Error> {
        self.observe(motion, request, out)?;
        if request.quantity == Quantity::Slope {
            let rate = order.respond_rate(true, motion);
            let mut moved = vec![c64::new(0.0, 0.0); out.len()];
            let of_rate = Request { quantity: Quantity::OfSlip, ..*request };
            self.observe(&rate, &of_rate, &mut moved)?;
            out.iter_mut().zip(moved).for_each(|(out, moved)| *out += moved);
        }
        Ok(())
    }

    /// Reads observed DOFs off the sectors they belong to, with the motion at their ports.
    fn observe(
        &self,
        motion: &RingMotion,
        request: &Request<'_>,
        out: &mut [c64],
    ) -> Result<(), Error> {
        let (ports, dofs) = (self.layout.ports(), self.layout.dofs);
        let (mut observe, mut rest) = (Vec::new(), out);
        for together in request.observe.chunk_by(|one, next| one / dofs == next / dofs) {
            let sector = together[0] / dofs;
            let range = sector * ports..(sector + 1) * ports;
            observe.clear();
            observe.extend(together.iter().map(|dof| dof % dofs));
            let own = Request {
                contact: &motion.port[range.clone()],
                slip_load: &motion.force[range],
                observe: &observe,
                ..*request
            };
            let (here, others) = rest.split_at_mut(together.len());
            self.sectors[sector].displacement(&own, here)?;
            rest = others;
        }
        Ok(())
    }
}

impl Compliance for Ring {
    fn contacts(&self) -> usize {
        self.sectors.len() * self.layout.contacts
    }

    fn dofs(&self) -> usize {
        self.sectors.len() * self.layout.dofs
    }

    fn effort(&self, _points: usize, observed: usize) -> [f64; 2] {
        let interface = (2 * self.layout.interface.len()) as f64;
        let each = observed.div_ceil(self.sectors.len());
        self.sectors.iter().fold([0.0; 2], |[receptance, displacement], sector| {
            let own = sector.effort(sector.contacts(), each);
            // Each is eliminated from the ring, with two neighbours beside it.
            [receptance + own[0] + 1e3 + 0.5 * interface.powi(3), displacement + own[1] + 200.0]
        })
    }

    fn is_silent(&self, harmonic: usize) -> bool {
        self.joined_wave.is_some_and(|(forced, ahead)| {
            let turns = (harmonic / forced) as f64 * ahead / TAU;
            harmonic % forced == 0 && (turns - turns.round()).abs() < SILENT
        })
    }

    fn is_direct(&self) -> bool {
        self.sectors.iter().any(|sector| sector.is_direct())
    }

    fn outline(&self) -> &Outline {
        &self.outline
    }

    fn ring(&self) -> Option<&Ring> {
        Some(self)
    }

    /// The dense receptance, for what needs all of it: column after column.
    fn receptance(&self, harmonic: usize, omega: f64, out: &mut Receptance) -> Result<(), Error> {
        let contacts = self.contacts();
        out.reset(contacts);
        let order = self.order(harmonic, omega, out.slope.is_some())?;
        let zero = vec![c64::new(0.0, 0.0); contacts];
        let stuck = order.respond(true, &zero);
        out.stuck.copy_from_slice(&stuck.contact);
        let mut unit = zero.clone();
        let mut columns = Vec::with_capacity(contacts);
        for column in 0..contacts {
            unit[column] = c64::new(1.0, 0.0);
            columns.push(order.respond(false, &unit));
            unit[column] = c64::new(0.0, 0.0);
        }
        for (values, column) in out.contact.chunks_exact_mut(contacts.max(1)).zip(&columns) {
            values.copy_from_slice(&column.contact);
        }
        if let Some((contact_slope, stuck_slope)) = &mut out.slope {
            stuck_slope.copy_from_slice(&order.respond_rate(true, &stuck).contact);
            for (values, column) in contact_slope.chunks_exact_mut(contacts.max(1)).zip(&columns) {
                values.copy_from_slice(&order.respond_rate(false, column).contact);
            }
        }
        Ok(())
    }

    fn displacement(&self, request: &Request<'_>, out: &mut [c64]) -> Result<(), Error> {
        let slopes = request.quantity == Quantity::Slope;
        let order = self.order(request.harmonic, request.omega, slopes)?;
        let loaded = request.quantity != Quantity::OfSlip;
        let motion = order.respond(loaded, request.slip_load);
        self.displacement_of(&order, &motion, request, out)
    }

    fn stuck_frequencies(&self) -> &[f64] {
        &self.natural()[0]
    }

    fn free_frequencies(&self) -> &[f64] {
        &self.natural()[1]
    }

    /// The modes of the whole disk take a decomposition of it; their damping is about that of the sectors
    /// with their neighbours held still.
    fn finds_modes(&self, asked: usize) -> bool {
        pays_for_modes(self.dofs(), asked, self.effort(0, self.dofs())[0])
    }

    /// Of the sectors with their neighbours held still, which takes no decomposition of the whole
    /// disk; soft couplings raise it little.
    fn highest_frequency(&self) -> f64 {
        self.highest
    }
}
