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
    /// [`Compliance::displacements`] with the equations of the harmonics at this frequency and the motions at hand;
    /// equations of slopes must have slopes.
    ///
    /// # Errors
    /// As [`Compliance::receptance`].
    pub fn displacements_of(
        &self,
        orders: &[&RingOrder],
        motions: &[RingMotion],
        requests: &[Request<'_>],
        out: &mut [c64],
    ) -> Result<(), Error> {
        self.observe(motions, requests, out)?;
        if requests.iter().any(|request| request.quantity == Quantity::Slope) {
            let rate = |(order, motion): (&&RingOrder, _)| order.respond_rate(true, motion);
            let rates: Vec<RingMotion> = orders.iter().zip(motions).map(rate).collect();
            let quantity = Quantity::OfSlip;
            let of_rates = requests.iter().map(|request| Request { quantity, ..*request });
            let of_rates: Vec<_> = of_rates.collect();
            let mut moved = vec![c64::new(0.0, 0.0); out.len()];
            self.observe(&rates, &of_rates, &mut moved)?;
            out.iter_mut().zip(moved).for_each(|(out, moved)| *out += moved);
        }
        Ok(())
    }

    /// Reads observed DOFs off the sectors they belong to, with the motions at their ports: all harmonics of a
    /// sector at once.
    fn observe(
        &self,
        motions: &[RingMotion],
        requests: &[Request<'_>],
        out: &mut [c64],
    ) -> Result<(), Error> {
        let Some(observed) = requests.first().map(|request| request.observe) else { return Ok(()) };
        let (ports, dofs) = (self.layout.ports(), self.layout.dofs);
        let mut begin = 0;
        for together in observed.chunk_by(|one, next| one / dofs == next / dofs) {
            let sector = together[0] / dofs;
            let range = sector * ports..(sector + 1) * ports;
            let observe: Vec<usize> = together.iter().map(|dof| dof % dofs).collect();
            let parts = requests.iter().zip(motions).map(|(request, motion)| Request {
                contact: &motion.port[range.clone()],
                slip_load: &motion.force[range.clone()],
                observe: &observe,
                ..*request
            });
            let own: Vec<_> = parts.collect();
            let mut moved = vec![c64::new(0.0, 0.0); own.len() * observe.len()];
            self.sectors[sector].displacements(&own, &mut moved)?;
            let to = begin..begin + observe.len();
            let orders = out.chunks_exact_mut(observed.len());
            orders
                .zip(moved.chunks_exact(observe.len()))
                .for_each(|(out, moved)| out[to.clone()].copy_from_slice(moved));
            begin = to.end;
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
        // Each is eliminated from the ring, with two neighbours beside it: complex numbers, or blocks.
        let elimination = if interface > 2.0 { 1e3 + 0.5 * interface.powi(3) } else { 250.0 };
        let each = observed.div_ceil(self.sectors.len());
        self.sectors.iter().fold([0.0; 2], |[receptance, displacement], sector| {
            let own = sector.effort(sector.contacts(), each);
            [receptance + own[0] + elimination, displacement + own[1] + 30.0]
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
        self.displacements_of(&[&order], &[motion], std::slice::from_ref(request), out)
    }

    fn stuck_frequencies(&self) -> &[f64] {
        &self.natural()[0]
    }

    fn free_frequencies(&self) -> &[f64] {
        &self.natural()[1]
    }

    /// The modes of the whole disk take a decomposition of it; their damping is about that of the sectors
    /// with their neighbours held still.
    fn finds_modes(&self, spent: f64) -> bool {
        pays_for_modes(self.dofs(), spent)
    }

    /// Of the sectors with their neighbours held still, which takes no decomposition of the whole
    /// disk; soft couplings raise it little.
    fn highest_frequency(&self) -> f64 {
        self.highest
    }
}
