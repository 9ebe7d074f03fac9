//! Compliance from one eigen-decomposition.
//!
//! | damping | modes | how the stuck base is reached |
//! |---|---|---|
//! | diagonal in the stuck modes (none, mass-proportional) | real, stuck | directly |
//! | diagonal in the free modes (Rayleigh, modal) | real, free | contact stiffness as a low-rank change |
//! | any other, also unsymmetric | complex, stuck | directly |

use super::contact_modes::ContactModes;
use super::flexibility::Flexibility;
use super::interface::InterfaceCompliance;
use super::massless::StuckModes;
use super::modes::{complex, modes, HermitianModes, RealModes};
use super::ports::{forced_harmonics, HarmonicLoad, Ports};
use super::proportional::{follows_mass, ModalDamping};
use super::sparse_compliance::SparseCompliance;
use super::spectrum::{complex_modes, Spectrum};
use super::{Compliance, DirectCompliance, Outline, Receptance, Structure};
use crate::Error;
use faer::{c64, Mat, MatRef};
use std::sync::Arc;

/// Floor of the denominators of free modes, see [`Spectrum::weight`].
const FREE_FLOOR: f64 = 1e-8;
/// Damping, over the frequency of its mode, that is rounding of none.
pub(super) const UNDAMPED: f64 = 1e-14;

/// Natural frequencies below this share of the highest are those of rigid-body modes.
const SLOWEST: f64 = 1e-9;
/// Where complex modes are compared, relative to a natural frequency: beside the resonance.
const BESIDE: f64 = 0.8;

/// Which modes carry the compliance.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub enum ModalBase {
    /// Real modes of the stuck structure.
    Stuck,
    /// Real modes of the structure without contacts.
    Free,
    /// Complex modes of the stuck structure.
    Complex,
}

/// A structure in modal coordinates: `G(ω) = R diag(w(ω)) L`.
#[derive(Debug, Clone)]
pub struct ModalCompliance {
    pub(super) base: ModalBase,
    pub(super) spectrum: Spectrum,
    /// R: displacement of every DOF per modal coordinate, N × modes, with the shapes of DOFs without mass
    /// behind them.
    pub(super) right: Arc<Mat<c64>>,
    /// B R and L Bᵀ, contacts × modes each.
    pub(super) contact_right: Arc<Mat<c64>>,
    pub(super) contact_left: Arc<Mat<c64>>,
    /// Number of shapes of no inertia and unit stiffness.
    pub(super) statics: usize,
    /// Negative damping of each mode of a damping `C + r C_neg`; of modes of the free structure.
    pub(super) negative: Vec<f64>,
    /// L P_k per forced harmonic.
    pub(super) loads: Vec<(usize, Vec<c64>)>,
    /// Contact stiffness, if the modes are those of the free structure.
    pub(super) restraint: Option<Mat<f64>>,
    pub(super) flexibility: Option<Flexibility>,
    pub(super) outline: Outline,
    /// The stuck modes at many contacts.
    pub(super) contact_modes: Option<Arc<ContactModes>>,
}

/// What a modal compliance is made of: modes of the stuck and of the free structure, rows of B
/// (complex in a travelling wave), contact stiffness and loads.
pub(super) struct Wave {
    pub(super) stuck: HermitianModes,
    /// What DOFs without mass add to them.
    pub(super) statics: Mat<c64>,
    pub(super) free: HermitianModes,
    /// Whether a law says that the damping is diagonal in the free modes, and in no others.
    pub(super) law: bool,
    pub(super) rows: Mat<c64>,
    pub(super) stiffness: Mat<f64>,
    pub(super) loads: Vec<HarmonicLoad>,
}

/// The compliance of a structure: by its modes, with many contacts by those of the stuck structure; or
/// by direct solution where its complex modes are defective (critically damped or undamped rigid-body
/// modes with general damping).
///
/// # Errors
/// Shapes that do not fit, or an eigenvalue iteration that fails.
pub fn compliance(
    structure: &Structure,
    ports: &Ports,
) -> Result<(Box<dyn Compliance>, &'static str), Error> {
    if let Some(sparse) = SparseCompliance::new(structure, ports)? {
        return Ok((Box::new(sparse), "sparse factors"));
    }
    if let Some(interface) = InterfaceCompliance::new(structure, ports)? {
        let base = interface.base();
        return Ok((Box::new(interface), base));
    }
    match ModalCompliance::new(structure, ports)? {
        Some(modal) => {
            let name = match modal.base {
                ModalBase::Stuck => "stuck modes",
                ModalBase::Free => "free modes",
                ModalBase::Complex => "complex modes",
            };
            Ok((Box::new(modal), name))
        }
        None => Ok((Box::new(DirectCompliance::new(structure, ports)?), "direct")),
    }
}

impl ModalCompliance {
    /// The modal form of a structure, or `None` if its complex modes do not span the space.
    ///
    /// # Errors
    /// Shapes that do not fit, or an eigenvalue iteration that fails.
    pub fn new(structure: &Structure, ports: &Ports) -> Result<Option<Self>, Error> {
        ports.check(structure.dofs())?;
        let restrained = structure.restrained_stiffness(&ports.rows, &ports.stiffness);
        let (mass, damping) = (structure.mass(), structure.damping());
        let free = modes(mass, structure.stiffness())?;
        let stuck = if restrained.as_ref() == structure.stiffness() {
            StuckModes { modes: free.clone(), statics: Mat::zeros(structure.dofs(), 0) }
        } else {
            structure.modes_at(restrained.clone())?
        };
        let wave = Wave {
            law: structure.is_proportional() && !follows_mass(damping, mass),
            stuck: stuck.modes.to_hermitian(),
            statics: complex(stuck.statics.as_ref()),
            free: free.to_hermitian(),
            rows: complex(ports.rows.as_ref()),
            stiffness: Mat::clone(&ports.stiffness),
            loads: ports.loads.clone(),
        };
        let project = |free_modes| if free_modes { &free } else { &stuck.modes }.damping(damping);
        let Some(modal) = Self::of_wave(wave, project)? else { return Ok(None) };
        let contact_modes = modal.contact_modes_of(&stuck, damping, ports).map(Arc::new);
        let flexibility = Flexibility::new(&stuck, ports);
        let modal = Self { flexibility, contact_modes, ..modal };
        let direct = || DirectCompliance::of(structure, ports, restrained.as_ref());
        Ok(modal.reproduces(direct).then_some(modal))
    }

    /// The modal form of complex matrices, without a static part; `project` gives the damping in the
    /// free modes, or in those of the stuck structure.
    pub(super) fn of_wave(
        wave: Wave,
        project: impl Fn(bool) -> ModalDamping,
    ) -> Result<Option<Self>, Error> {
        let Wave { stuck, statics, free, law, rows, stiffness, loads } = wave;
        // Substitutes for masses that are none are no part of this.
        let substituted = statics.ncols() > 0;
        let law = law && !substituted;
        let frequencies = [&stuck, &free].map(HermitianModes::frequencies);
        let of_real = |(modes, damping): (HermitianModes, Vec<f64>), base: ModalBase| {
            let left = modes.shapes.adjoint().to_owned();
            let bounded =
                |j: usize| damping[j].abs() > UNDAMPED * modes.omega_squared[j].max(0.0).sqrt();
            let floors = match base {
                ModalBase::Free => floors((&rows * &modes.shapes).as_ref(), bounded),
                _ => vec![0.0; damping.len()],
            };
            let spectrum = Spectrum::Real { omega_squared: modes.omega_squared, damping, floors };
            (spectrum, modes.shapes, left)
        };
        let in_stuck = (!law).then(|| project(false));
        let in_stuck_modes =
            |damping: &ModalDamping| damping.clone().separated(stuck.clone(), false);
        let (base, (spectrum, right, left), restraint) =
            if let Some(separate) = in_stuck.as_ref().and_then(in_stuck_modes) {
                (ModalBase::Stuck, of_real(separate, ModalBase::Stuck), None)
            } else if let Some(separate) =
                (!substituted).then(|| project(true)).and_then(|own| own.separated(free, law))
            {
                (ModalBase::Free, of_real(separate, ModalBase::Free), Some(stiffness))
            } else {
                let damping = in_stuck.unwrap_or_else(|| project(false));
                let damping = damping.matrix().as_ref();
                let modes = complex_modes(&stuck.omega_squared, stuck.shapes.as_ref(), damping)?;
                let Some(modes) = modes else { return Ok(None) };
                (ModalBase::Complex, modes, None)
            };
        let [stuck_frequencies, free_frequencies] = frequencies;
        let right = beside(right.as_ref(), statics.as_ref());
        let left =
            beside(left.adjoint().to_owned().as_ref(), statics.as_ref()).adjoint().to_owned();
        Ok(Some(Self {
            base,
            outline: Outline {
                stuck: stuck_frequencies,
                free: free_frequencies,
                bandwidth: spectrum.narrowest_bandwidth(),
                forced: forced_harmonics(&loads),
            },
            contact_right: Arc::new(&rows * &right),
            contact_left: Arc::new((&left * rows.adjoint()).transpose().to_owned()),
            statics: statics.ncols(),
            negative: Vec::new(),
            loads: loads
                .iter()
                .map(|load| (load.harmonic, multiply(left.as_ref(), &load.amplitude)))
                .collect(),
            right: Arc::new(right),
            spectrum,
            restraint,
            flexibility: None,
            contact_modes: None,
        }))
    }

    /// Of unloaded modes of the free structure that the two parts of a damping `C + r C_neg` leave
    /// uncoupled, at r = 0.
    pub(super) fn of_free_modes(
        modes: RealModes,
        damping: Vec<f64>,
        negative: Vec<f64>,
        rows: MatRef<'_, f64>,
    ) -> Self {
        let RealModes { omega_squared, shapes } = modes;
        let contacts = Arc::new(complex((rows * &shapes).as_ref()));
        Self {
            base: ModalBase::Free,
            spectrum: Spectrum::Real {
                floors: floors(contacts.as_ref().as_ref(), |_| false),
                omega_squared,
                damping,
            },
            right: Arc::new(complex(shapes.as_ref())),
            contact_right: Arc::clone(&contacts),
            contact_left: contacts,
            statics: 0,
            negative,
            loads: Vec::new(),
            restraint: None,
            flexibility: None,
            outline: Outline::default(),
            contact_modes: None,
        }
    }

    /// The modes of the stuck structure at many contacts, as the damping leaves them.
    fn contact_modes_of(
        &self,
        stuck: &StuckModes<f64>,
        damping: MatRef<'_, f64>,
        ports: &Ports,
    ) -> Option<ContactModes> {
        match (self.base, &self.spectrum) {
            (ModalBase::Stuck, Spectrum::Real { omega_squared, damping, .. }) => {
                let shapes = Mat::from_fn(self.right.nrows(), omega_squared.len(), |i, j| {
                    self.right[(i, j)].re
                });
                let modes = RealModes { omega_squared: omega_squared.clone(), shapes };
                let statics = stuck.statics.clone();
                ContactModes::uncoupled(&StuckModes { modes, statics }, damping, ports)
            }
            _ => ContactModes::new(stuck, || stuck.modes.project(damping), ports),
        }
    }

    /// The same at another ratio r, with contacts of the stiffness D.
    pub(super) fn at_ratio(&self, ratio: f64, stiffness: Mat<f64>) -> Self {
        let mut at = Self { restraint: Some(stiffness), ..self.clone() };
        if let Spectrum::Real { damping, .. } = &mut at.spectrum {
            damping.iter_mut().zip(&self.negative).for_each(|(own, added)| *own += ratio * added);
        }
        at
    }

    /// Compares complex modes with a direct solution, at low frequencies too: eigenvectors of a nearly
    /// defective problem lose digits, and so do slow poles beside a very fast one. Then the direct
    /// form must serve.
    pub(super) fn reproduces(&self, direct: impl FnOnce() -> DirectCompliance) -> bool {
        if self.base != ModalBase::Complex {
            return true;
        }
        let direct = direct();
        let natural = &self.outline.stuck;
        let highest = natural.last().copied().unwrap_or(1.0).max(1.0);
        let slow = natural.iter().copied().filter(|w| *w > SLOWEST * highest);
        let (first, middle) = (slow.clone().next(), slow.clone().nth(slow.count() / 2));
        let low = [first, middle].into_iter().flatten().map(|w| BESIDE * w);
        let (mut ours, mut theirs) = (Receptance::default(), Receptance::default());
        [0.013, 0.11, 0.7].into_iter().map(|share| share * highest).chain(low).all(|omega| {
            if self.receptance(1, omega, &mut ours).is_err()
                || direct.receptance(1, omega, &mut theirs).is_err()
            {
                return false;
            }
            let scale = theirs.contact.iter().map(|g| g.norm()).fold(0.0, f64::max);
            ours.contact.iter().zip(&theirs.contact).all(|(a, b)| (a - b).norm() <= 1e-8 * scale)
        })
    }
}

/// The floors of free modes, from what the contacts see of them: those that move none are modes of the stuck
/// structure, too, and resonate. Those that their own damping bounds need none.
fn floors(contacts: MatRef<'_, c64>, bounded: impl Fn(usize) -> bool) -> Vec<f64> {
    let moves = |j: usize| (0..contacts.nrows()).any(|i| contacts[(i, j)].norm() > 0.0);
    let floor = |j: usize| if moves(j) && !bounded(j) { FREE_FLOOR } else { 0.0 };
    (0..contacts.ncols()).map(floor).collect()
}

/// The columns of two matrices beside one another.
fn beside(first: MatRef<'_, c64>, second: MatRef<'_, c64>) -> Mat<c64> {
    let own = first.ncols();
    Mat::from_fn(first.nrows(), own + second.ncols(), |i, j| {
        if j < own {
            first[(i, j)]
        } else {
            second[(i, j - own)]
        }
    })
}

/// A matrix times a vector.
fn multiply(matrix: MatRef<'_, c64>, vector: &[c64]) -> Vec<c64> {
    (0..matrix.nrows())
        .map(|i| (0..vector.len()).map(|j| matrix[(i, j)] * vector[j]).sum())
        .collect()
}
