//! The linear structure: matrices, modes and the compliance of the *stuck* structure.
//!
//! Every analysis sees a structure through one trait, [`Compliance`]: what displacement a load at
//! harmonic k produces when all contacts stick. That form stays well scaled at high harmonics,
//! needs no partition of the matrices and takes ω as an unknown.

mod contact_coordinates;
mod contact_modes;
mod contact_shapes;
mod cyclic;
mod direct;
mod flexibility;
mod flutter_compliance;
mod interface;
mod massless;
mod matrix;
mod modal;
mod modal_answer;
mod modal_orders;
mod modal_receptance;
mod modes;
mod poles;
mod ports;
mod proportional;
mod quasi_static;
mod restraint;
mod ring;
mod ring_compliance;
mod ring_order;
mod sparse_cholesky;
mod sparse_compliance;
mod sparse_contacts;
mod sparse_matrices;
mod sparse_spectrum;
mod spectrum;
mod system;

pub use contact_coordinates::ContactCoordinates;
pub use contact_shapes::ContactShapes;
pub use cyclic::{CyclicCompliance, CyclicMatrix, CyclicPorts, CyclicStructure};
pub use direct::DirectCompliance;
pub use flutter_compliance::{FlutterCompliance, StuckMode};
pub use interface::InterfaceCompliance;
pub use massless::natural_frequencies;
pub use matrix::Matrix;
pub use modal::{compliance, ModalBase, ModalCompliance};
pub use modal_orders::ModalOrders;
pub(crate) use modes::complex;
pub use modes::{modes, HermitianModes, Modes, RealModes};
pub use poles::Poles;
pub use ports::{HarmonicLoad, Ports};
pub(crate) use proportional::ModalDamping;
pub use quasi_static::QuasiStatic;
pub use ring::{Ring, RingCoupling, RingSector};
pub use ring_order::{RingLayout, RingMotion, RingOrder};
pub use sparse_cholesky::{SparseCholesky, Unfactored};
pub use system::Structure;

use crate::Error;
use faer::c64;

/// Displacements of the contacts at one frequency: what the loads alone cause, and what unit slip
/// loads cause. Buffers are reused from point to point.
#[derive(Debug, Clone, Default)]
pub struct Receptance {
    /// `G_k = B (K_s + ikωC − (kω)²M)⁻¹ Bᵀ`, column by column, contacts × contacts [m/N].
    pub contact: Vec<c64>,
    /// `B G P_k`: displacement of the contacts under the external load \[m\].
    pub stuck: Vec<c64>,
    /// Derivatives of the two in ω, if asked for.
    pub slope: Option<(Vec<c64>, Vec<c64>)>,
    /// Derivative of `contact` in the ratio r of negative damping; empty where there is none.
    pub by_ratio: Vec<c64>,
}

impl Receptance {
    pub(crate) fn reset(&mut self, contacts: usize) {
        let (own, slope) = ((&mut self.contact, &mut self.stuck), self.slope.as_mut());
        for (contact, stuck) in [own].into_iter().chain(slope.map(|(a, b)| (a, b))) {
            for (buffer, size) in [(contact, contacts * contacts), (stuck, contacts)] {
                buffer.clear();
                buffer.resize(size, c64::new(0.0, 0.0));
            }
        }
        self.by_ratio.clear();
    }

    /// Leaves what loads at some of the points cause, in their order; derivatives are none of it.
    pub(crate) fn keep(&mut self, points: &[usize]) {
        let contacts = self.stuck.len();
        let columns = points.iter().map(|point| &self.contact[point * contacts..][..contacts]);
        self.contact = columns.flatten().copied().collect();
    }
}

/// What is to be displaced, and by what, at a harmonic of a motion.
#[derive(Debug, Clone, Copy)]
pub struct Request<'a> {
    /// Harmonic k.
    pub harmonic: usize,
    /// Frequency of the motion [rad/s].
    pub omega: f64,
    /// What is asked for.
    pub quantity: Quantity,
    /// Contact displacements that belong to the loads \[m\].
    pub contact: &'a [c64],
    /// Slip loads \[N\].
    pub slip_load: &'a [c64],
    /// DOFs whose displacements are asked for.
    pub observe: &'a [usize],
}

/// What a displacement is due to.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub enum Quantity {
    /// To the external load and the slip loads \[m\].
    Whole,
    /// To the slip loads alone, linear in them and in the contact displacements \[m\].
    OfSlip,
    /// Derivative of the whole in ω at fixed contact displacements and slip loads [m s].
    Slope,
}

/// What is known of a linear structure before any motion.
#[derive(Debug, Clone, Default)]
pub struct Outline {
    /// Natural frequencies of the stuck structure, ascending, where they are known [rad/s].
    pub stuck: Vec<f64>,
    /// Natural frequencies without contacts, ascending, where they are known [rad/s].
    pub free: Vec<f64>,
    /// Half-power bandwidth `2ζω` of the least damped mode, where it is known [rad/s].
    pub bandwidth: f64,
    /// Harmonics with an external load, ascending.
    pub forced: Vec<usize>,
}

/// The linear structure with all contacts stuck, seen from its contacts and observed DOFs.
pub trait Compliance: Send + Sync {
    /// Number of relative contact displacements.
    fn contacts(&self) -> usize;

    /// Number of DOFs that can be observed.
    fn dofs(&self) -> usize;

    /// What is known before any motion.
    fn outline(&self) -> &Outline;

    /// Harmonics with an external load, ascending.
    fn forced_harmonics(&self) -> Vec<usize> {
        self.outline().forced.clone()
    }

    /// Refuses a structure that moves rigidly with all contacts stuck.
    ///
    /// # Errors
    /// The static stiffness is singular.
    fn require_grounded(&self) -> Result<(), Error> {
        self.receptance(0, 0.0, &mut Receptance::default())
    }

    /// Receptance of the contacts for harmonic `harmonic` of a motion at `omega` [rad/s].
    ///
    /// # Errors
    /// The static stiffness is singular (harmonic 0), or nothing damps the resonance met.
    fn receptance(&self, harmonic: usize, omega: f64, out: &mut Receptance) -> Result<(), Error>;

    /// The same for unit slip loads at some points alone, contacts × points, without derivatives.
    ///
    /// # Errors
    /// As [`Compliance::receptance`].
    fn receptance_of(
        &self,
        points: &[usize],
        harmonic: usize,
        omega: f64,
        out: &mut Receptance,
    ) -> Result<(), Error> {
        self.receptance(harmonic, omega, out)?;
        out.keep(points);
        Ok(())
    }

    /// Displacement amplitudes that are asked for.
    ///
    /// # Errors
    /// As [`Compliance::receptance`].
    fn displacement(&self, request: &Request<'_>, out: &mut [c64]) -> Result<(), Error>;

    /// The same of several harmonics of a motion with the same observed DOFs, one after the other.
    ///
    /// # Errors
    /// As [`Compliance::receptance`].
    fn displacements(&self, requests: &[Request<'_>], out: &mut [c64]) -> Result<(), Error> {
        let observed = requests.first().map_or(1, |request| request.observe.len().max(1));
        let mut parts = requests.iter().zip(out.chunks_exact_mut(observed));
        parts.try_for_each(|(request, out)| self.displacement(request, out))
    }

    /// About the times that the receptance of one harmonic for loads at so many `points` and the displacements of
    /// `observed` DOFs take on a common processor \[ns\].
    fn effort(&self, _points: usize, _observed: usize) -> [f64; 2] {
        [0.0; 2]
    }

    /// Whether a harmonic of friction comes to all sectors at once, so that contacts between the same points of
    /// neighbours neither feel it nor move by it.
    fn is_silent(&self, _harmonic: usize) -> bool {
        false
    }

    /// Whether a frequency costs a factorisation per harmonic, of the whole or of a part.
    fn is_direct(&self) -> bool {
        false
    }

    /// The ring of sectors that this is, if it is one: its equations need no dense receptance.
    fn ring(&self) -> Option<&Ring> {
        None
    }

    /// The contacts seen from the modes of the stuck structure, or from its DOFs, if there are many: their
    /// equations need no receptance at all.
    fn contact_modes(&self) -> Option<&dyn ContactCoordinates> {
        None
    }

    /// Natural frequencies of the stuck structure, ascending, where they are known [rad/s].
    fn stuck_frequencies(&self) -> &[f64] {
        &self.outline().stuck
    }

    /// Natural frequencies of the stuck structure, or of that without contacts, in `[low, high]`, ascending
    /// [rad/s].
    fn frequencies_between(&self, stuck: bool, [low, high]: [f64; 2]) -> Vec<f64> {
        let all = if stuck { self.stuck_frequencies() } else { self.free_frequencies() };
        all.iter().copied().filter(|w| (low..=high).contains(w)).collect()
    }

    /// Lowest natural frequency of the stuck structure and of that without contacts, or about it, where
    /// they are known [rad/s].
    fn lowest_frequencies(&self) -> Option<[f64; 2]> {
        Some([*self.stuck_frequencies().first()?, *self.free_frequencies().first()?])
    }

    /// Highest natural frequency of the stuck structure, or about it [rad/s].
    fn highest_frequency(&self) -> f64 {
        self.stuck_frequencies().last().copied().unwrap_or(0.0)
    }

    /// Natural frequencies with all contacts removed, ascending, where they are known [rad/s].
    fn free_frequencies(&self) -> &[f64] {
        &self.outline().free
    }

    /// Whether no mode that a harmonic sees, with the contacts stuck or removed, resonates within a range that
    /// it passes in less than half of that [rad/s]. What does not know its modes says no, unless it finds them for
    /// what was `spent` without them.
    fn is_clear(&self, _harmonic: usize, range: [f64; 2], spent: f64) -> bool {
        let is_clear = |list: &[f64]| !list.is_empty() && within(list, range).is_empty();
        self.narrowest_bandwidth() >= 0.5 * (range[1] - range[0])
            || (self.finds_modes(spent)
                && is_clear(self.stuck_frequencies())
                && is_clear(self.free_frequencies()))
    }

    /// Whether its natural frequencies are known, or a decomposition takes no longer than what was `spent` without them
    /// \[ns\].
    fn finds_modes(&self, _spent: f64) -> bool {
        true
    }

    /// Half-power bandwidth `2ζω` of the least damped mode, where it is known [rad/s].
    fn narrowest_bandwidth(&self) -> f64 {
        self.outline().bandwidth
    }
}

/// DOFs of the largest structure that is decomposed only to know its modes: that takes less than a second.
const LARGEST: usize = 1500;

/// Whether a decomposition of some DOFs takes no longer than what was spent without it \[ns\].
fn pays_for_modes(dofs: usize, spent: f64) -> bool {
    let size = dofs as f64;
    let decomposition = 0.2 * size.powi(3) + 1.5e4 * size;
    dofs <= LARGEST && spent > decomposition
}

/// Positions of the entries of an ascending list within a range.
pub(crate) fn within(ascending: &[f64], [low, high]: [f64; 2]) -> std::ops::Range<usize> {
    let first = ascending.partition_point(|entry| *entry < low);
    first..first.max(ascending.partition_point(|entry| *entry <= high))
}
