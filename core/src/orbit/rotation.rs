//! Orbits of travelling waves: what one sector does, the next one does some time later.

use crate::motion::{ModalSystem, Transition};
use crate::Error;
use faer::Mat;

/// A symmetry in space and time of the orbits of equal sectors in a ring.
///
/// The DOFs and contacts of a model are those of one sector after the other. With `X_j` for
/// sector j, and `X_(j+sectors) = wrap X_j` beyond the last one,
/// `X_j(t + T/parts) = sign X_(j+shift)(t)`.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct Rotation {
    /// Number of sectors.
    pub sectors: usize,
    /// Sectors by which the motion has moved on after the part of a period.
    pub shift: usize,
    /// 1 of a ring that closes, −1 of one whose motion changes its sign on the way round.
    pub wrap: f64,
    /// 1 or −1.
    pub sign: f64,
    /// Parts of the period.
    pub parts: usize,
}

impl Rotation {
    /// # Errors
    /// No sectors or parts; DOFs or contacts that are not the same in every sector.
    pub(super) fn check(&self, system: &ModalSystem) -> Result<(), Error> {
        let (dofs, contacts) = (system.modes(), system.bodies().len());
        let one = |value: f64| value.abs() == 1.0;
        let regular = self.sectors > 0 && self.parts > 0 && one(self.wrap) && one(self.sign);
        if !regular || dofs % self.sectors != 0 || contacts % self.sectors != 0 {
            return Err(Error::shape(
                "rotation",
                "a number of equal sectors and parts, with factors of 1 or −1",
                format!("{self:?} of {dofs} DOFs and {contacts} contacts"),
            ));
        }
        Ok(())
    }

    /// Where a sector has come to, and with which sign.
    fn target(&self, sector: usize) -> (usize, f64) {
        let place = sector + self.shift;
        let rounds = (place / self.sectors) as i32;
        (place % self.sectors, self.sign * self.wrap.powi(rounds))
    }

    /// Of each of some contacts, in equal numbers in all sectors, the one whose part of the period it has
    /// just done, and with which sign.
    pub(super) fn sources(&self, contacts: usize) -> Vec<(usize, f64)> {
        let each = contacts / self.sectors;
        let mut sources = vec![(0, 1.0); contacts];
        for contact in 0..contacts {
            let (target, sign) = self.target(contact / each);
            sources[target * each + contact % each] = (contact, sign);
        }
        sources
    }

    /// The coordinates that the state a part of a period later has for the sectors at its start.
    pub(super) fn matrix(&self, coordinates: &Transition<'_>, system: &ModalSystem) -> Mat<f64> {
        let (modes, size) = (system.modes(), coordinates.size());
        let own = modes / self.sectors;
        let mut moved = Mat::<f64>::zeros(size, size);
        for mode in 0..modes {
            let mut unit = vec![0.0; modes];
            unit[mode] = 1.0;
            let shape = system.to_dofs(&unit);
            let mut turned = vec![0.0; modes];
            for sector in 0..self.sectors {
                let (target, sign) = self.target(sector);
                for dof in 0..own {
                    turned[target * own + dof] = sign * shape[sector * own + dof];
                }
            }
            for (row, value) in system.to_modes(&turned).into_iter().enumerate() {
                let scale = coordinates.weight()[row] / coordinates.weight()[mode];
                moved[(row, mode)] = scale * value;
                moved[(modes + row, modes + mode)] = value;
            }
        }
        let bodies = system.bodies();
        let each = bodies.len() / self.sectors;
        for (number, body) in bodies.iter().enumerate() {
            let (target, sign) = self.target(number / each);
            let strains = bodies[target * each + number % each].strains.clone();
            for (row, column) in strains.zip(body.strains.clone()) {
                moved[(2 * modes + row, 2 * modes + column)] = sign;
            }
        }
        moved
    }

    /// Marks what has happened to a point in some part of the period in all sectors: the motion
    /// brings it to each of them.
    pub(super) fn spread(&self, marked: &mut [bool]) {
        let each = marked.len() / self.sectors;
        for place in 0..each {
            let any = marked.iter().skip(place).step_by(each).any(|one| *one);
            marked.iter_mut().skip(place).step_by(each).for_each(|one| *one = any);
        }
    }
}
