//! A ring of sectors as a compliance of all its contacts.

use super::ring::Ring;
use super::ring_order::{RingMotion, RingOrder};
use super::{Compliance, Receptance};
use crate::Error;
use faer::c64;

impl Ring {
    /// [`Compliance::displacement`] with the equations of this harmonic and frequency at hand.
    ///
    /// # Errors
    /// As [`Compliance::receptance`].
    pub fn displacement_of(
        &self,
        order: &RingOrder,
        harmonic: usize,
        omega: f64,
        slip_load: &[c64],
        observe: &[usize],
        out: &mut [c64],
    ) -> Result<(), Error> {
        let motion = order.respond(true, slip_load);
        self.observe(&motion, observe, out, |sector, port, force, dof, value| {
            sector.displacement(harmonic, omega, port, force, dof, value)
        })
    }

    /// Derivative in ω of [`Ring::displacement_of`] with slip loads that change at `slip_rate`; the
    /// equations must have slopes.
    ///
    /// # Errors
    /// As [`Compliance::receptance`].
    pub fn displacement_rate_of(
        &self,
        order: &RingOrder,
        harmonic: usize,
        omega: f64,
        [slip_load, slip_rate]: [&[c64]; 2],
        observe: &[usize],
        out: &mut [c64],
    ) -> Result<(), Error> {
        let motion = order.respond(true, slip_load);
        let mut rate = order.respond_rate(true, &motion);
        let moved = order.respond(false, slip_rate);
        rate.port.iter_mut().zip(&moved.port).for_each(|(rate, moved)| *rate += moved);
        rate.force.iter_mut().zip(&moved.force).for_each(|(rate, moved)| *rate += moved);
        self.observe(&motion, observe, out, |sector, port, force, dof, value| {
            sector.displacement_slope(harmonic, omega, port, force, dof, value)
        })?;
        let mut moved = vec![c64::new(0.0, 0.0); observe.len()];
        self.observe(&rate, observe, &mut moved, |sector, port, force, dof, value| {
            sector.slip_displacement(harmonic, omega, port, force, dof, value)
        })?;
        out.iter_mut().zip(moved).for_each(|(out, moved)| *out += moved);
        Ok(())
    }

    /// Reads observed DOFs off the sectors they belong to, with the motion at their ports.
    fn observe(
        &self,
        motion: &RingMotion,
        observe: &[usize],
        out: &mut [c64],
        read: impl Fn(&dyn Compliance, &[c64], &[c64], &[usize], &mut [c64]) -> Result<(), Error>,
    ) -> Result<(), Error> {
        let (ports, dofs) = (self.layout.ports(), self.layout.dofs);
        for (x, &dof) in out.iter_mut().zip(observe) {
            let sector = dof / dofs;
            let range = sector * ports..(sector + 1) * ports;
            let (port, force) = (&motion.port[range.clone()], &motion.force[range]);
            read(
                self.sectors[sector].as_ref(),
                port,
                force,
                &[dof % dofs],
                std::slice::from_mut(x),
            )?;
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

    fn effort(&self, observed: usize) -> [f64; 2] {
        let interface = (2 * self.layout.interface.len()) as f64;
        let each = observed.div_ceil(self.sectors.len());
        self.sectors.iter().fold([0.0; 2], |[receptance, displacement], sector| {
            let own = sector.effort(each);
            // Each is eliminated from the ring, with two neighbours beside it.
            [receptance + own[0] + 1e3 + 0.5 * interface.powi(3), displacement + own[1] + 1e3]
        })
    }

    fn is_direct(&self) -> bool {
        self.sectors.iter().any(|sector| sector.is_direct())
    }

    fn forced_harmonics(&self) -> Vec<usize> {
        self.forced.clone()
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
        for (values, column) in out.contact.chunks_exact_mut(contacts).zip(&columns) {
            values.copy_from_slice(&column.contact);
        }
        if let Some((contact_slope, stuck_slope)) = &mut out.slope {
            stuck_slope.copy_from_slice(&order.respond_rate(true, &stuck).contact);
            for (values, column) in contact_slope.chunks_exact_mut(contacts).zip(&columns) {
                values.copy_from_slice(&order.respond_rate(false, column).contact);
            }
        }
        Ok(())
    }

    fn displacement(
        &self,
        harmonic: usize,
        omega: f64,
        _contact: &[c64],
        slip_load: &[c64],
        observe: &[usize],
        out: &mut [c64],
    ) -> Result<(), Error> {
        let order = self.order(harmonic, omega, false)?;
        self.displacement_of(&order, harmonic, omega, slip_load, observe, out)
    }

    fn slip_displacement(
        &self,
        harmonic: usize,
        omega: f64,
        _contact: &[c64],
        slip_load: &[c64],
        observe: &[usize],
        out: &mut [c64],
    ) -> Result<(), Error> {
        let motion = self.order(harmonic, omega, false)?.respond(false, slip_load);
        self.observe(&motion, observe, out, |sector, port, force, dof, value| {
            sector.slip_displacement(harmonic, omega, port, force, dof, value)
        })
    }

    fn displacement_slope(
        &self,
        harmonic: usize,
        omega: f64,
        _contact: &[c64],
        slip_load: &[c64],
        observe: &[usize],
        out: &mut [c64],
    ) -> Result<(), Error> {
        let order = self.order(harmonic, omega, true)?;
        let motion = order.respond(true, slip_load);
        let rate = order.respond_rate(true, &motion);
        self.observe(&motion, observe, out, |sector, port, force, dof, value| {
            sector.displacement_slope(harmonic, omega, port, force, dof, value)
        })?;
        let mut moved = vec![c64::new(0.0, 0.0); observe.len()];
        self.observe(&rate, observe, &mut moved, |sector, port, force, dof, value| {
            sector.slip_displacement(harmonic, omega, port, force, dof, value)
        })?;
        out.iter_mut().zip(moved).for_each(|(out, moved)| *out += moved);
        Ok(())
    }

    fn stuck_frequencies(&self) -> &[f64] {
        &self.natural()[0]
    }

    fn free_frequencies(&self) -> &[f64] {
        &self.natural()[1]
    }

    /// Of the sectors with their neighbours held still, which takes no decomposition of the whole
    /// disk; soft couplings raise it little.
    fn highest_frequency(&self) -> f64 {
        self.highest
    }

    fn narrowest_bandwidth(&self) -> f64 {
        self.bandwidth
    }
}
