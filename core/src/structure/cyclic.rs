//! A tuned bladed disk: one sector with the phases of a travelling wave.
//!
//! In a wave of engine order E the motion of sector i + 1 runs ahead of that of sector i by the
//! angle 2πE/n, so that harmonic k has the phase `δ = 2πkE/n` from sector to sector: it sees the
//! disk at nodal diameter kE mod n. That is exact, friction between the sectors included.

use super::massless::{substitute, without_mass, StuckModes};
use super::modal::Wave;
use super::modes::modes;
use super::ports::{forced_harmonics, Ports};
use super::proportional::follows_mass;
use super::{
    compliance, Compliance, DirectCompliance, HarmonicLoad, ModalCompliance, Outline, Receptance,
    Request, Structure,
};
use crate::Error;
use faer::{c64, Mat, MatRef};
use std::f64::consts::TAU;
use std::sync::OnceLock;

/// A matrix of one sector, and its coupling to the next one: `A_δ = A_0 + A_1 e^{iδ} + A_1ᵀ e^{−iδ}`.
#[derive(Debug, Clone)]
pub struct CyclicMatrix {
    own: Mat<f64>,
    next: Mat<f64>,
}

impl CyclicMatrix {
    /// From the block of a sector itself and the block that couples it to the next sector.
    #[must_use]
    pub fn new(own: Mat<f64>, next: Mat<f64>) -> Self {
        Self { own, next }
    }

    /// The matrix of a wave with the phase `delta` from sector to sector.
    fn wave(&self, delta: f64) -> Mat<c64> {
        let (sin, cos) = delta.sin_cos();
        let (ahead, behind) = (c64::new(cos, sin), c64::new(cos, -sin));
        Mat::from_fn(self.own.nrows(), self.own.ncols(), |i, j| {
            self.own[(i, j)] + ahead * self.next[(i, j)] + behind * self.next[(j, i)]
        })
    }

    /// The same where it is real, at nodal diameter 0 or half the number of sectors.
    fn standing(&self, sign: f64) -> Mat<f64> {
        Mat::from_fn(self.own.nrows(), self.own.ncols(), |i, j| {
            self.own[(i, j)] + sign * (self.next[(i, j)] + self.next[(j, i)])
        })
    }
}

/// A cyclic structure under a travelling wave.
#[derive(Debug, Clone)]
pub struct CyclicStructure {
    /// Mass \[kg\].
    pub mass: CyclicMatrix,
    /// Damping [kg/s].
    pub damping: CyclicMatrix,
    /// Stiffness [N/m].
    pub stiffness: CyclicMatrix,
    /// Number of sectors n.
    pub sectors: usize,
    /// Engine order E.
    pub engine_order: usize,
    /// Whether a law made the damping, one that couples no modes of any nodal diameter.
    pub proportional: bool,
    /// DOFs without mass; a model finds them.
    pub massless: Vec<usize>,
}

/// Contacts and loads of a sector; rows act on the sector itself and on the next one.
#[derive(Debug, Clone)]
pub struct CyclicPorts {
    /// Part of `u = b x_i + b' x_{i+1}` on the sector itself, contacts × N.
    pub own: Mat<f64>,
    /// Part on the next sector.
    pub next: Mat<f64>,
    /// Contact stiffness D [N/m].
    pub stiffness: Mat<f64>,
    /// Loads on sector 0, one entry per harmonic.
    pub loads: Vec<HarmonicLoad>,
}

impl CyclicStructure {
    /// Number of DOFs of a sector.
    #[must_use]
    pub fn dofs(&self) -> usize {
        self.mass.own.nrows()
    }

    /// Nodal diameter that harmonic k sees, 0..n.
    #[must_use]
    pub fn diameter(&self, harmonic: usize) -> usize {
        ((harmonic as u128 * self.engine_order as u128) % self.sectors as u128) as usize
    }

    /// The sector by itself.
    ///
    /// # Errors
    /// As [`Structure::new`].
    pub fn sector(&self) -> Result<Structure, Error> {
        let [mass, damping, stiffness] =
            [&self.mass, &self.damping, &self.stiffness].map(|matrix| matrix.own.as_ref());
        Ok(Structure::new(mass, damping, stiffness)?.with_massless(self.massless.clone()))
    }

    /// The same structure with substitutes for masses that are none, held by these contacts of a sector.
    #[must_use]
    pub(crate) fn held_by(mut self, own: MatRef<'_, f64>, stiffness: MatRef<'_, f64>) -> Self {
        let diagonal: Vec<f64> = (0..self.dofs()).map(|i| self.mass.own[(i, i)]).collect();
        self.massless = without_mass(&diagonal);
        let held = &self.stiffness.own + own.transpose() * stiffness * own;
        let held: Vec<f64> = (0..self.dofs()).map(|i| held[(i, i)]).collect();
        if !self.massless.is_empty() {
            substitute(&mut self.mass.own, &self.massless, &held);
        }
        self
    }

    /// Mass, damping and stiffness of a wave of a nodal diameter.
    #[must_use]
    pub fn at_diameter(&self, diameter: usize) -> [Mat<c64>; 3] {
        let delta = self.phase(diameter);
        [&self.mass, &self.damping, &self.stiffness].map(|matrix| matrix.wave(delta))
    }

    /// Rows of B in a wave of a nodal diameter.
    #[must_use]
    pub fn rows_at(
        &self,
        diameter: usize,
        own: MatRef<'_, f64>,
        next: MatRef<'_, f64>,
    ) -> Mat<c64> {
        wave_rows(own, next, self.phase(diameter))
    }

    fn phase(&self, diameter: usize) -> f64 {
        TAU * diameter as f64 / self.sectors as f64
    }

    /// Natural frequencies at a nodal diameter, with contacts of stiffness `stiffness` [rad/s].
    ///
    /// # Errors
    /// Mass not positive definite, or the eigenvalue iteration fails.
    pub fn natural_frequencies(
        &self,
        diameter: usize,
        own: MatRef<'_, f64>,
        next: MatRef<'_, f64>,
        stiffness: MatRef<'_, f64>,
    ) -> Result<Vec<f64>, Error> {
        let delta = self.phase(diameter);
        let rows = wave_rows(own, next, delta);
        let restrained = restrained(&self.stiffness.wave(delta), &rows, stiffness);
        let mass = self.mass.wave(delta);
        let stuck = StuckModes::new(mass.as_ref(), restrained, &self.massless)?;
        Ok(stuck.modes.frequencies())
    }
}

/// `b e^{0} + b' e^{iδ}`.
fn wave_rows(own: MatRef<'_, f64>, next: MatRef<'_, f64>, delta: f64) -> Mat<c64> {
    let (sin, cos) = delta.sin_cos();
    Mat::from_fn(own.nrows(), own.ncols(), |i, j| own[(i, j)] + c64::new(cos, sin) * next[(i, j)])
}

/// Whether some contact lies between the same points of neighbours: it does not move if these move at once.
pub(super) fn joins_alike(own: MatRef<'_, f64>, next: MatRef<'_, f64>) -> bool {
    let mut rows = 0..own.nrows();
    let joins = |i: usize, j: usize| next[(i, j)] != 0.0;
    let alike = |i: usize, j: usize| own[(i, j)] + next[(i, j)] == 0.0;
    let dofs = || 0..own.ncols();
    rows.any(|i| dofs().any(|j| joins(i, j)) && dofs().all(|j| alike(i, j)))
}

/// `K + Bᴴ D B`.
fn restrained(stiffness: &Mat<c64>, rows: &Mat<c64>, contacts: MatRef<'_, f64>) -> Mat<c64> {
    stiffness + rows.adjoint() * (super::modes::complex(contacts) * rows)
}

/// The compliance of a sector in a travelling wave.
pub struct CyclicCompliance {
    structure: CyclicStructure,
    ports: CyclicPorts,
    /// One compliance per nodal diameter, decomposed when it is first needed.
    waves: Vec<OnceLock<Result<Box<dyn Compliance>, Error>>>,
    outline: Outline,
}

impl CyclicCompliance {
    /// The compliance of a sector with its contacts and loads.
    ///
    /// # Errors
    /// Shapes that do not fit, a number of sectors below 1, a failing decomposition.
    pub fn new(structure: CyclicStructure, ports: CyclicPorts) -> Result<Self, Error> {
        if structure.sectors == 0 {
            return Err(Error::value("sectors", 0.0, "must be at least 1"));
        }
        let size = structure.dofs();
        for (entry, matrix) in [
            ("mass", &structure.mass),
            ("damping", &structure.damping),
            ("stiffness", &structure.stiffness),
        ] {
            for part in [&matrix.own, &matrix.next] {
                if (part.nrows(), part.ncols()) != (size, size) {
                    return Err(Error::shape(
                        entry,
                        format!("blocks of shape {size} x {size}"),
                        format!("{} x {}", part.nrows(), part.ncols()),
                    ));
                }
            }
        }
        let forced = forced_harmonics(&ports.loads);
        let waves = (0..structure.sectors).map(|_| OnceLock::new()).collect();
        let mut outline = Outline { bandwidth: f64::MAX, forced, ..Outline::default() };
        let mut cyclic = Self { structure, ports, waves, outline: Outline::default() };
        let first = if outline.forced.is_empty() { vec![1] } else { outline.forced.clone() };
        for harmonic in first {
            let wave = cyclic.wave(harmonic)?.outline();
            outline.stuck.extend_from_slice(&wave.stuck);
            outline.free.extend_from_slice(&wave.free);
            outline.bandwidth = outline.bandwidth.min(wave.bandwidth);
        }
        for frequencies in [&mut outline.stuck, &mut outline.free] {
            frequencies.sort_by(f64::total_cmp);
            frequencies.dedup();
        }
        cyclic.outline = outline;
        Ok(cyclic)
    }

    /// The compliance at the nodal diameter of a harmonic.
    fn wave(&self, harmonic: usize) -> Result<&dyn Compliance, Error> {
        let diameter = self.structure.diameter(harmonic);
        let wave = self.waves[diameter].get_or_init(|| self.decompose(diameter));
        match wave {
            Ok(wave) => Ok(wave.as_ref()),
            Err(error) => Err(error.clone()),
        }
    }

    /// Loads of the harmonics that see a nodal diameter.
    fn loads_at(&self, diameter: usize) -> Vec<HarmonicLoad> {
        let sees = |load: &&HarmonicLoad| self.structure.diameter(load.harmonic) == diameter;
        self.ports.loads.iter().filter(sees).cloned().collect()
    }

    fn decompose(&self, diameter: usize) -> Result<Box<dyn Compliance>, Error> {
        let structure = &self.structure;
        let standing = match diameter {
            0 => Some(1.0),
            d if 2 * d == structure.sectors => Some(-1.0),
            _ => None,
        };
        if let Some(sign) = standing {
            let (mass, damping, stiffness) = (
                structure.mass.standing(sign),
                structure.damping.standing(sign),
                structure.stiffness.standing(sign),
            );
            let whole = Structure::new(mass.as_ref(), damping.as_ref(), stiffness.as_ref())?
                .with_law(structure.proportional)
                .with_massless(structure.massless.clone());
            let ports = Ports {
                rows: (&self.ports.own + faer::Scale(sign) * &self.ports.next).into(),
                stiffness: self.ports.stiffness.clone().into(),
                loads: self.loads_at(diameter),
            };
            return Ok(compliance(&whole, &ports)?.0);
        }
        let delta = structure.phase(diameter);
        let rows = wave_rows(self.ports.own.as_ref(), self.ports.next.as_ref(), delta);
        let (mass, damping) = (structure.mass.wave(delta), structure.damping.wave(delta));
        let free_stiffness = structure.stiffness.wave(delta);
        let stuck_stiffness = restrained(&free_stiffness, &rows, self.ports.stiffness.as_ref());
        let held = StuckModes::new(mass.as_ref(), stuck_stiffness.clone(), &structure.massless)?;
        let StuckModes { modes: stuck, statics } = held;
        let free = modes(mass.as_ref(), free_stiffness.as_ref())?;
        let (stuck_frequencies, free_frequencies) = (stuck.frequencies(), free.frequencies());
        let loads = self.loads_at(diameter);
        let wave = Wave {
            law: structure.proportional && !follows_mass(damping.as_ref(), mass.as_ref()),
            stuck: stuck.clone(),
            statics,
            free: free.clone(),
            rows: rows.clone(),
            stiffness: self.ports.stiffness.clone(),
            loads: loads.clone(),
        };
        let project =
            |free_modes| if free_modes { &free } else { &stuck }.damping(damping.as_ref());
        let modal = ModalCompliance::of_wave(wave, project)?;
        let own = |i: usize| !structure.massless.contains(&i);
        let inert = Mat::from_fn(mass.nrows(), mass.ncols(), |i, j| {
            if own(i) && own(j) {
                mass[(i, j)]
            } else {
                c64::new(0.0, 0.0)
            }
        });
        let matrices = [inert, damping, stuck_stiffness];
        let direct = DirectCompliance::of_matrices(matrices, rows, loads)
            .with_frequencies(stuck_frequencies, free_frequencies);
        match modal {
            Some(modal) if modal.reproduces(|| direct.clone()) => Ok(Box::new(modal)),
            _ => Ok(Box::new(direct)),
        }
    }
}

impl Compliance for CyclicCompliance {
    fn contacts(&self) -> usize {
        self.ports.own.nrows()
    }

    fn dofs(&self) -> usize {
        self.structure.dofs()
    }

    fn outline(&self) -> &Outline {
        &self.outline
    }

    /// Discarded harmonics see other nodal diameters than the loads.
    fn is_clear(&self, harmonic: usize, range: [f64; 2], spent: f64) -> bool {
        self.wave(harmonic).is_ok_and(|wave| wave.is_clear(harmonic, range, spent))
    }

    fn effort(&self, points: usize, observed: usize) -> [f64; 2] {
        // All nodal diameters are much alike; this one has been decomposed.
        let harmonic = self.outline.forced.first().copied().unwrap_or(1);
        self.wave(harmonic).map_or([0.0; 2], |wave| wave.effort(points, observed))
    }

    fn is_silent(&self, harmonic: usize) -> bool {
        let CyclicPorts { own, next, .. } = &self.ports;
        self.structure.diameter(harmonic) == 0 && joins_alike(own.as_ref(), next.as_ref())
    }

    fn is_direct(&self) -> bool {
        let made = self.waves.iter().filter_map(OnceLock::get);
        made.flatten().any(|wave| wave.is_direct())
    }

    fn receptance(&self, harmonic: usize, omega: f64, out: &mut Receptance) -> Result<(), Error> {
        self.wave(harmonic)?.receptance(harmonic, omega, out)
    }

    fn receptance_of(
        &self,
        points: &[usize],
        harmonic: usize,
        omega: f64,
        out: &mut Receptance,
    ) -> Result<(), Error> {
        self.wave(harmonic)?.receptance_of(points, harmonic, omega, out)
    }

    fn displacement(&self, request: &Request<'_>, out: &mut [c64]) -> Result<(), Error> {
        self.wave(request.harmonic)?.displacement(request, out)
    }
}
