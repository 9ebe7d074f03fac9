//! A structure with its contacts and loads: the problem, before any setting or solver.

mod body;
mod contact_assembly;
mod contact_states;
mod flutter_model;
mod modal_basis;
mod resonances;
mod slipping;
mod slipping_point;
mod traction;
mod unbalanced;
mod unbounded;
mod variation;

pub use flutter_model::{FlutterModel, NegativeDamping};
pub(crate) use modal_basis::{ModalBases, ModalBasis};
pub use resonances::Resonance;
pub use variation::{Change, ParameterMode, Variation};

use crate::contact::{Aft, ContactLaw, Parameter, REVERSALS};
use crate::structure::{
    Compliance, CyclicStructure, HarmonicLoad, Matrix, Ports, Ring, RingCoupling, RingSector,
    Structure,
};
use crate::Error;
use body::Body;
pub(crate) use contact_assembly::stiffness_of;
use contact_assembly::ContactAssembly;
use contact_states::{slip_kinds, States};
use faer::{c64, Mat};
use std::ops::Range;
use std::sync::Arc;

/// Slip limit, relative to the largest load, that counts as none: it changes the motion by less, and
/// the slip that it bounds is lost in the rounding of the displacements.
const NO_LIMIT: f64 = 1e-13;

/// DOFs up to which the modes of a structure that nothing damps are found in any case: a second of work.
const MOST_UNDAMPED: usize = 1000;

/// Which laws are marched through samples.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub enum MarchedLaws {
    /// All of them.
    All,
    /// Those that have no form of their own.
    Formless,
}

/// One contact: its law and the rows of B that give its relative displacements.
#[derive(Debug)]
pub struct Contact<R = Mat<f64>> {
    /// The friction law.
    pub law: Box<dyn ContactLaw>,
    /// Rows of B, points × N: a matrix, or a [`Matrix`] of their few numbers.
    pub rows: R,
}

/// One contact of a sector: its law and the rows of B on the sector itself and on the next one.
#[derive(Debug)]
pub struct SectorContact {
    /// The friction law.
    pub law: Box<dyn ContactLaw>,
    /// Rows on the sector itself, points × N.
    pub own: Mat<f64>,
    /// Rows on the next sector, points × N.
    pub next: Mat<f64>,
}

/// Structure, contacts and loads, with the compliance of the stuck structure at hand.
pub struct Model {
    structure: Arc<Structure>,
    ports: Arc<Ports>,
    laws: Vec<Box<dyn ContactLaw>>,
    points: Vec<Range<usize>>,
    compliance: Arc<dyn Compliance>,
    modal_base: &'static str,
    body: Body,
    states: Arc<States>,
}

impl Model {
    /// Assembles the problem and decomposes the structure once.
    ///
    /// # Errors
    /// Shapes that do not fit the structure, numbers that are not finite, an eigenvalue iteration
    /// that fails.
    pub fn new<R: Into<Matrix>>(
        structure: Structure,
        contacts: Vec<Contact<R>>,
        loads: Vec<HarmonicLoad>,
    ) -> Result<Self, Error> {
        let parts = contacts.into_iter().map(|c| (c.law, vec![c.rows.into()]));
        let ContactAssembly { laws, points, rows: [rows, _], stiffness } =
            ContactAssembly::new(structure.dofs(), parts)?;
        let structure = structure.held_by(&rows, &stiffness);
        let ports = Ports { rows, stiffness, loads };
        Self::of(Body::Whole, structure, ports, laws, points)
    }

    /// One sector of a tuned bladed disk in a travelling wave; `loads` are those on sector 0.
    ///
    /// # Errors
    /// As [`Model::new`].
    pub fn travelling_wave(
        cyclic: CyclicStructure,
        contacts: Vec<SectorContact>,
        loads: Vec<HarmonicLoad>,
    ) -> Result<Self, Error> {
        let parts = contacts.into_iter().map(|c| (c.law, vec![c.own.into(), c.next.into()]));
        let ContactAssembly { laws, points, rows: [own, next], stiffness } =
            ContactAssembly::new(cyclic.dofs(), parts)?;
        let cyclic = cyclic.held_by(own.as_ref(), stiffness.as_ref());
        let structure = cyclic.sector()?;
        let ports = Ports { rows: own, stiffness, loads };
        let body = Body::Wave { cyclic: Arc::new(cyclic), next: Arc::new(next.into_full()) };
        Self::of(body, structure, ports, laws, points)
    }

    /// A disk of sectors that may differ, each coupled to the next one and the last to the first;
    /// contacts and loads are given sector by sector.
    ///
    /// # Errors
    /// As [`Model::new`]; other numbers of contacts than in sector 0.
    pub fn ring(
        structures: Vec<Structure>,
        coupling: RingCoupling,
        contacts: Vec<Vec<SectorContact>>,
        loads: Vec<Vec<HarmonicLoad>>,
    ) -> Result<Self, Error> {
        let count = structures.len();
        if (contacts.len(), loads.len()) != (count, count) {
            return Err(Error::shape(
                "sectors",
                format!("contacts and loads of {count} sectors"),
                format!("{} and {}", contacts.len(), loads.len()),
            ));
        }
        let mut parts = Vec::with_capacity(count);
        let (mut laws, mut points) = (Vec::new(), Vec::new());
        for ((structure, contacts), loads) in structures.into_iter().zip(contacts).zip(loads) {
            let rows = contacts.into_iter().map(|c| (c.law, vec![c.own.into(), c.next.into()]));
            let own = ContactAssembly::new(structure.dofs(), rows)?;
            let first = points.last().map_or(0, |last: &Range<usize>| last.end);
            points.extend(own.points.iter().map(|r| first + r.start..first + r.end));
            laws.extend(own.laws);
            let [own_rows, next] = own.rows;
            let stiffness = own.stiffness;
            let structure = structure.held_by(&own_rows, &stiffness);
            let (own, next, stiffness) =
                (own_rows.into_full(), next.into_full(), stiffness.into_full());
            parts.push(RingSector { structure, own, next, stiffness, loads });
        }
        let ring = Arc::new(Ring::new(parts, coupling)?);
        let (structure, ports) = ring.assembled()?;
        // Its sectors resonate by themselves where the ring does not, and nothing bounds them there.
        if structure.is_undamped() && structure.dofs() <= MOST_UNDAMPED {
            return Self::of(Body::Whole, structure, ports, laws, points);
        }
        Ok(Self {
            laws: perceptible(laws, &ports.loads)?,
            ports: Arc::new(ports),
            points,
            compliance: Arc::clone(&ring) as Arc<dyn Compliance>,
            modal_base: "sectors",
            states: Arc::new(States::of(&Body::Ring(Arc::clone(&ring)), structure.dofs())),
            structure: Arc::new(structure),
            body: Body::Ring(ring),
        })
    }

    fn of(
        body: Body,
        structure: Structure,
        ports: Ports,
        laws: Vec<Box<dyn ContactLaw>>,
        points: Vec<Range<usize>>,
    ) -> Result<Self, Error> {
        let (compliance, modal_base) = body.compliance(&structure, &ports)?;
        let laws = perceptible(laws, &ports.loads)?;
        let (structure, ports) = (Arc::new(structure), Arc::new(ports));
        let states = Arc::new(States::of(&body, structure.dofs()));
        Ok(Self { structure, ports, laws, points, compliance, modal_base, body, states })
    }

    /// The same problem with laws evaluated by marching through `samples` instants per period
    /// (see [`Aft`]), on the same decomposition.
    ///
    /// # Errors
    /// An odd or too small number of samples.
    pub fn marched(&self, samples: usize, which: MarchedLaws) -> Result<Self, Error> {
        let mut laws: Vec<Box<dyn ContactLaw>> = Vec::with_capacity(self.laws.len());
        for law in &self.laws {
            let own = law.with_scaled_stiffness(1.0);
            let keeps_form = which == MarchedLaws::Formless && law.closed_form().is_some();
            laws.push(if keeps_form { own } else { Box::new(Aft::new(own, samples)?) });
        }
        self.with_laws(laws)
    }

    /// Highest harmonic that the evaluation of every law resolves.
    #[must_use]
    pub fn resolves(&self) -> usize {
        self.laws.iter().map(|law| law.resolves()).min().unwrap_or(usize::MAX)
    }

    /// The same structure, contacts and loads under other laws. The decomposition is shared if the
    /// stiffness of the contacts is the same.
    ///
    /// # Errors
    /// Laws that do not fit the contacts, an eigenvalue iteration that fails.
    pub fn with_laws(&self, laws: Vec<Box<dyn ContactLaw>>) -> Result<Self, Error> {
        let sizes = |laws: &[Box<dyn ContactLaw>]| laws.iter().map(|l| l.displacements()).collect();
        let (expected, got): (Vec<usize>, Vec<usize>) = (sizes(&self.laws), sizes(&laws));
        if expected != got {
            return Err(Error::shape("laws", format!("{expected:?} points"), format!("{got:?}")));
        }
        let stiffness = stiffness_of(&laws);
        let (structure, points) = (Arc::clone(&self.structure), self.points.clone());
        let (mut ports, mut compliance) = (Arc::clone(&self.ports), Arc::clone(&self.compliance));
        let (mut modal_base, body) = (self.modal_base, self.body.clone());
        let mut states = Arc::clone(&self.states);
        let laws = perceptible(laws, &self.ports.loads)?;
        let same = stiffness == ports.stiffness;
        if !same {
            ports = Arc::new(Ports { stiffness, ..Ports::clone(&ports) });
            (compliance, modal_base) = body.compliance(&structure, &ports)?;
        }
        if !same || slip_kinds(&laws) != slip_kinds(&self.laws) {
            states = Arc::new(States::of(&body, structure.dofs()));
        }
        Ok(Self { structure, ports, laws, points, compliance, modal_base, body, states })
    }

    /// The same problem under `factor` times the loads that vary; static loads stay as they are.
    ///
    /// # Errors
    /// An eigenvalue iteration that fails.
    pub fn excited(&self, factor: f64) -> Result<Self, Error> {
        let scaled = |load: &HarmonicLoad| {
            let by = if load.harmonic == 0 { 1.0 } else { factor };
            let amplitude = load.amplitude.iter().map(|force| by * force).collect();
            HarmonicLoad { harmonic: load.harmonic, amplitude }
        };
        let loads = self.ports.loads.iter().map(scaled).collect();
        let ports = Arc::new(Ports { loads, ..Ports::clone(&self.ports) });
        let (compliance, modal_base) = self.body.compliance(&self.structure, &ports)?;
        let laws = self.laws.iter().map(|law| law.with_scaled_forces(1.0)).collect();
        Ok(Self {
            structure: Arc::clone(&self.structure),
            laws: perceptible(laws, &ports.loads)?,
            points: self.points.clone(),
            body: self.body.clone(),
            states: Arc::clone(&self.states),
            ports,
            compliance,
            modal_base,
        })
    }

    /// Whether this is one sector of a disk in a travelling wave.
    #[must_use]
    pub fn is_travelling_wave(&self) -> bool {
        matches!(self.body, Body::Wave { .. })
    }

    /// The structure without its contacts; of a travelling wave, the sector by itself.
    #[must_use]
    pub fn structure(&self) -> &Structure {
        &self.structure
    }

    /// Contacts and loads of the structure; of a travelling wave, without the next sector.
    #[must_use]
    pub fn ports(&self) -> &Ports {
        &self.ports
    }

    /// The friction laws, in the order of the contacts.
    #[must_use]
    pub fn laws(&self) -> &[Box<dyn ContactLaw>] {
        &self.laws
    }

    /// Number of numbers in a state in time: displacements, velocities and what the laws remember.
    #[must_use]
    pub fn states(&self) -> usize {
        let told = |law: &dyn ContactLaw| match law.loading() {
            Some(_) => 1 + REVERSALS,
            None => law.state_size(),
        };
        2 * self.structure.dofs() + self.laws.iter().map(|law| told(law.as_ref())).sum::<usize>()
    }

    /// Rows of B that belong to each contact.
    #[must_use]
    pub fn points(&self) -> &[Range<usize>] {
        &self.points
    }

    /// Compliance of the stuck structure.
    #[must_use]
    pub fn compliance(&self) -> &dyn Compliance {
        self.compliance.as_ref()
    }

    /// Which modes carry the compliance, in words.
    #[must_use]
    pub fn modal_base(&self) -> &'static str {
        self.modal_base
    }

    /// Load of the fundamental on all DOFs \[N\], if there is one.
    pub(crate) fn fundamental_load(&self) -> Option<&[c64]> {
        let load = self.ports.loads.iter().find(|load| load.harmonic == 1);
        load.map(|load| load.amplitude.as_slice())
    }

    /// Contact stiffness D of all points [N/m].
    #[must_use]
    pub fn contact_stiffness(&self) -> &Matrix {
        &self.ports.stiffness
    }

    /// Whether rigid-body motion remains with all contacts stuck.
    #[must_use]
    pub fn static_singular(&self) -> bool {
        self.compliance.require_grounded().is_err()
    }

    /// Whether all contact laws are monotone operators: with positive damping there is one steady
    /// motion.
    #[must_use]
    pub fn is_monotone(&self) -> bool {
        self.laws.iter().all(|law| law.is_monotone())
    }

    /// Whether what contacts do in free motions depends on the state at rest: a law is not odd, or a
    /// static load holds one without memory off its middle. Friction under constant loads moves with
    /// the rest.
    #[must_use]
    pub fn is_biased(&self) -> bool {
        let elastic = || self.laws.iter().any(|law| law.state_size() == 0);
        let loaded = || !flutter_model::static_loads(self).is_empty();
        self.laws.iter().any(|law| !law.is_odd()) || (elastic() && loaded())
    }

    /// Whether the motion has half-wave symmetry: odd laws under odd harmonics alone.
    #[must_use]
    pub fn is_symmetric(&self) -> bool {
        self.laws.iter().all(|law| law.is_odd())
            && self.compliance.forced_harmonics().iter().all(|k| k % 2 == 1)
    }
}

/// Laws with the slip limits that count against the loads; others are zero.
fn perceptible(
    mut laws: Vec<Box<dyn ContactLaw>>,
    loads: &[HarmonicLoad],
) -> Result<Vec<Box<dyn ContactLaw>>, Error> {
    let amplitudes = loads.iter().flat_map(|load| &load.amplitude);
    let least = NO_LIMIT * amplitudes.map(|force| force.norm()).fold(0.0, f64::max);
    for law in &mut laws {
        for (index, limit) in law.parameters().into_iter().enumerate() {
            if limit.name == Parameter::SLIP_FORCE && 0.0 < limit.value && limit.value < least {
                *law = law.with_parameter(index, 0.0)?;
            }
        }
    }
    Ok(laws)
}
