//! The linear structure: matrices, modes and the compliance of the *stuck* structure.
//!
//! Every analysis sees a structure through one trait, [`Compliance`]: what displacement a load at
//! harmonic k produces when all contacts stick. That form stays well scaled at high harmonics,
//! needs no partition of the matrices and takes ω as an unknown.

mod cyclic;
mod direct;
mod flexibility;
mod flutter_compliance;
mod modal;
mod modes;
mod poles;
mod ports;
mod proportional;
mod restraint;
mod ring;
mod ring_compliance;
mod ring_order;
mod spectrum;
mod system;

pub use cyclic::{CyclicCompliance, CyclicMatrix, CyclicPorts, CyclicStructure};
pub use direct::DirectCompliance;
pub use flutter_compliance::{CompliancePartials, FlutterCompliance, StuckMode};
pub use modal::{compliance, ModalBase, ModalCompliance};
pub use modes::{natural_frequencies, real_modes, RealModes};
pub use poles::Poles;
pub use ports::{HarmonicLoad, Ports};
pub(crate) use proportional::ModalDamping;
pub use ring::{Ring, RingCoupling, RingSector};
pub use ring_order::{RingLayout, RingMotion, RingOrder};
pub use system::Structure;

use crate::Error;
use faer::c64;

/// Displacements of the contacts at one frequency: what the loads alone cause, and what unit slip
/// loads cause. Buffers are reused from point to point.
#[derive(Debug, Clone, Default)]
pub struct Receptance {
    /// `G_k = B (K_s + ikωC − (kω)²M)⁻¹ Bᵀ`, column by column, contacts × contacts [m/N].
    pub contact: Vec<c64>,
    /// `B G P_k`: displacement of the contacts under the external load [m].
    pub stuck: Vec<c64>,
    /// Derivatives of the two in ω, if asked for.
    pub slope: Option<(Vec<c64>, Vec<c64>)>,
}

impl Receptance {
    pub(crate) fn reset(&mut self, contacts: usize) {
        let zero = c64::new(0.0, 0.0);
        for (buffer, size) in
            [(&mut self.contact, contacts * contacts), (&mut self.stuck, contacts)]
        {
            buffer.clear();
            buffer.resize(size, zero);
        }
        if let Some((contact, stuck)) = &mut self.slope {
            contact.clear();
            contact.resize(contacts * contacts, zero);
            stuck.clear();
            stuck.resize(contacts, zero);
        }
    }
}

/// The linear structure with all contacts stuck, seen from its contacts and observed DOFs.
pub trait Compliance: Send + Sync {
    /// Number of relative contact displacements.
    fn contacts(&self) -> usize;

    /// Number of DOFs that can be observed.
    fn dofs(&self) -> usize;

    /// Harmonics with an external load, ascending.
    fn forced_harmonics(&self) -> Vec<usize>;

    /// Receptance of the contacts for harmonic `harmonic` of a motion at `omega` [rad/s].
    ///
    /// # Errors
    /// The static stiffness is singular (harmonic 0), or nothing damps the resonance met.
    fn receptance(&self, harmonic: usize, omega: f64, out: &mut Receptance) -> Result<(), Error>;

    /// Displacement amplitudes of the DOFs `observe` under the external load and the slip loads
    /// `slip_load`, given the contact displacements `contact` that belong to them.
    ///
    /// # Errors
    /// As [`Compliance::receptance`].
    fn displacement(
        &self,
        harmonic: usize,
        omega: f64,
        contact: &[c64],
        slip_load: &[c64],
        observe: &[usize],
        out: &mut [c64],
    ) -> Result<(), Error>;

    /// About the times that the receptance of one harmonic and the displacements of `observed` DOFs
    /// take on a common processor [ns].
    fn effort(&self, observed: usize) -> [f64; 2];

    /// Whether a frequency costs a factorisation per harmonic, of the whole or of a part.
    fn is_direct(&self) -> bool {
        false
    }

    /// The ring of sectors that this is, if it is one: its equations need no dense receptance.
    fn ring(&self) -> Option<&Ring> {
        None
    }

    /// Displacement amplitudes under the slip loads alone: [`Compliance::displacement`] without
    /// the external load, linear in `contact` and `slip_load`.
    ///
    /// # Errors
    /// As [`Compliance::receptance`].
    fn slip_displacement(
        &self,
        harmonic: usize,
        omega: f64,
        contact: &[c64],
        slip_load: &[c64],
        observe: &[usize],
        out: &mut [c64],
    ) -> Result<(), Error>;

    /// Derivative of [`Compliance::displacement`] in ω at fixed `contact` and `slip_load` [m s].
    ///
    /// # Errors
    /// As [`Compliance::receptance`].
    fn displacement_slope(
        &self,
        harmonic: usize,
        omega: f64,
        contact: &[c64],
        slip_load: &[c64],
        observe: &[usize],
        out: &mut [c64],
    ) -> Result<(), Error>;

    /// Natural frequencies of the stuck structure, ascending [rad/s].
    fn stuck_frequencies(&self) -> &[f64];

    /// Highest natural frequency of the stuck structure, or about it [rad/s].
    fn highest_frequency(&self) -> f64 {
        self.stuck_frequencies().last().copied().unwrap_or(0.0)
    }

    /// Natural frequencies with all contacts removed, ascending [rad/s].
    fn free_frequencies(&self) -> &[f64];

    /// Half-power bandwidth `2ζω` of the least damped mode [rad/s].
    fn narrowest_bandwidth(&self) -> f64;
}
