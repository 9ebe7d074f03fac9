//! The static side of a compliance.

use super::massless::StuckModes;
use super::ports::Ports;
use super::Receptance;
use faer::{c64, Mat, MatRef};

/// Lowest squared frequency, relative to the highest, of a structure that counts as grounded.
pub(super) const RIGID_BODY: f64 = 1e-13;

/// Static displacements, which damping does not touch: `K_s⁻¹ [Bᵀ, P_0]`.
#[derive(Debug, Clone)]
pub(super) struct Flexibility {
    of_contacts: Mat<f64>,
    of_load: Mat<f64>,
    rows: Mat<f64>,
}

impl Flexibility {
    /// `None` if the stuck structure has rigid-body modes.
    pub(super) fn new(stuck: &StuckModes<f64>, ports: &Ports) -> Option<Self> {
        let StuckModes { modes: stuck, statics } = stuck;
        let largest = stuck.omega_squared.iter().fold(0.0_f64, |m, w| m.max(w.abs()));
        if stuck.omega_squared.iter().any(|w| w.abs() <= RIGID_BODY * largest) {
            return None;
        }
        let flexibility = |load: MatRef<'_, f64>| {
            let mut modal = stuck.shapes.transpose() * load;
            for j in 0..modal.ncols() {
                for (i, w) in stuck.omega_squared.iter().enumerate() {
                    modal[(i, j)] /= w;
                }
            }
            &stuck.shapes * modal + statics * (statics.transpose() * load)
        };
        let static_load = Mat::from_fn(ports.rows.ncols(), 1, |i, _| {
            ports.load(0).map_or(0.0, |load| load[i].re)
        });
        Some(Self {
            of_contacts: flexibility(ports.rows.transpose()),
            of_load: flexibility(static_load.as_ref()),
            rows: Mat::clone(&ports.rows),
        })
    }

    pub(super) fn receptance(&self, out: &mut Receptance) {
        let contact = &self.rows * &self.of_contacts;
        let stuck = &self.rows * &self.of_load;
        let contacts = self.rows.nrows();
        for column in 0..contacts {
            out.stuck[column] = c64::new(stuck[(column, 0)], 0.0);
            for row in 0..contacts {
                out.contact[column * contacts + row] = c64::new(contact[(row, column)], 0.0);
            }
        }
    }

    /// Static displacements under the slip loads, and the external load if `loaded`.
    pub(super) fn displacement(
        &self,
        loaded: bool,
        slip_load: &[c64],
        observe: &[usize],
        out: &mut [c64],
    ) {
        let share = f64::from(u8::from(loaded));
        for (x, &dof) in out.iter_mut().zip(observe) {
            let slip: f64 =
                (0..slip_load.len()).map(|i| self.of_contacts[(dof, i)] * slip_load[i].re).sum();
            *x = c64::new(share * self.of_load[(dof, 0)] + slip, 0.0);
        }
    }
}
