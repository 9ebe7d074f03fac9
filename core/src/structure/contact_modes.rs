//! The contacts seen from the modes of the stuck structure: what slip loads displace follows from two
//! real matrix products, `G q = Ψ Z⁻¹ Ψᵀ q` with Ψ = B Φ, and no receptance is ever formed.
//!
//! Where the damping couples no modes Z is diagonal. Otherwise the coupling is light beside the
//! diagonal, and GMRES from the diagonal takes a few products with it.

use super::flexibility::RIGID_BODY;
use super::massless::StuckModes;
use super::modes::{resonates, RealModes};
use super::ports::{HarmonicLoad, Ports};
use crate::solve::{gmres, KrylovSettings};
use crate::Error;
use faer::linalg::matmul::matmul;
use faer::linalg::matmul::triangular::{self, BlockStructure};
use faer::linalg::solvers::Solve as _;
use faer::{c64, Accum, Mat, MatRef, Par};
use std::sync::OnceLock;

/// Products with the coupling of the damping: far more than it takes.
const MOST_PRODUCTS: usize = 400;
/// Contacts with a load that are gathered at once: their shapes stay in the cache.
const PANEL: usize = 32;
/// The lowest of so many modes move as they do, the others follow their loads at once, …
const SLOWEST: usize = 10;
/// … where inertia and damping change their answers by no more than this.
const QUASI_STATIC: f64 = 5e-3;
/// Least modulus of a dynamic stiffness, relative to the squared frequency.
const FLOOR: f64 = 1e-9;

/// Modes of the stuck structure at its contacts. Series of several harmonics are matrices, slots ×
/// contacts or slots × modes, with the cosines and sines of a harmonic in neighbouring rows.
#[derive(Debug)]
pub struct ContactModes {
    /// Ψᵀ, modes × contacts.
    contacts: Mat<f64>,
    /// Φᵀ, modes × N.
    dofs: Mat<f64>,
    /// Whether a mode moves any contact.
    moving: Vec<bool>,
    /// Whether the damping couples a mode to others.
    coupled: Vec<bool>,
    /// Flexibility of all but the slowest modes at the contacts [m/N].
    flexibility: OnceLock<Mat<f64>>,
    /// Modal mass: 1, or 0 of what DOFs without mass add.
    inertia: Vec<f64>,
    /// Modal stiffness.
    omega_squared: Vec<f64>,
    damping: Vec<f64>,
    /// `Φᵀ C Φ` without its diagonal, transposed, if it couples modes.
    coupling: Option<Mat<f64>>,
    /// `Φᵀ P_k` of the harmonics with a load.
    loads: Vec<(usize, Vec<c64>)>,
}

/// The dynamic stiffness of every mode at the harmonics of a frequency.
#[derive(Debug, Clone, Default)]
pub struct ModalOrders {
    /// Slot, `kω`, and the inverse of the diagonal of Z for every mode.
    orders: Vec<(usize, f64, Vec<c64>)>,
    harmonics: Vec<usize>,
}

impl ContactModes {
    /// Contacts from which on a structure is seen in this way; fewer gain nothing by it.
    pub(super) const FEWEST: usize = 24;

    /// Of the modes of the stuck structure and `Φᵀ C Φ`; nothing if there are few contacts.
    pub(super) fn new(
        modes: &StuckModes<f64>,
        damping: impl FnOnce() -> Mat<f64>,
        ports: &Ports,
    ) -> Option<Self> {
        if ports.rows.nrows() < Self::FEWEST {
            return None;
        }
        let damping = damping();
        let diagonal: Vec<f64> = (0..damping.nrows()).map(|j| damping[(j, j)]).collect();
        Some(Self::of(modes, diagonal, Some(damping), ports))
    }

    /// Of modes that the damping does not couple; nothing if there are few contacts.
    pub(super) fn uncoupled(
        modes: &StuckModes<f64>,
        damping: &[f64],
        ports: &Ports,
    ) -> Option<Self> {
        (ports.rows.nrows() >= Self::FEWEST).then(|| Self::of(modes, damping.to_vec(), None, ports))
    }

    fn of(
        stuck: &StuckModes<f64>,
        mut damping: Vec<f64>,
        coupling: Option<Mat<f64>>,
        ports: &Ports,
    ) -> Self {
        let StuckModes { modes, statics } = stuck;
        let (size, own) = (modes.shapes.nrows(), modes.shapes.ncols());
        let all = own + statics.ncols();
        let shapes = Mat::from_fn(size, all, |i, j| {
            if j < own {
                modes.shapes[(i, j)]
            } else {
                statics[(i, j - own)]
            }
        });
        let modes = RealModes { omega_squared: modes.omega_squared.clone(), shapes };
        let mut omega_squared = modes.omega_squared.clone();
        omega_squared.resize(all, 1.0);
        damping.resize(all, 0.0);
        let inertia = (0..all).map(|j| if j < own { 1.0 } else { 0.0 }).collect();
        let dofs = modes.shapes.transpose().to_owned();
        let coupling = coupling.map(|matrix| {
            let mut transposed = Mat::zeros(all, all);
            transposed.get_mut(..own, ..own).copy_from(matrix.transpose());
            (0..transposed.nrows()).for_each(|j| transposed[(j, j)] = 0.0);
            transposed
        });
        let project = |load: &HarmonicLoad| {
            let of_mode = |j: usize| {
                let shape = modes.shapes.col(j).iter().zip(&load.amplitude);
                shape.map(|(phi, p)| *phi * p).sum::<c64>()
            };
            (load.harmonic, (0..dofs.nrows()).map(of_mode).collect())
        };
        let contacts = seen(dofs.as_ref(), ports.rows.as_ref());
        let mut moving = vec![false; all];
        for shape in contacts.col_iter() {
            moving.iter_mut().zip(shape.iter()).for_each(|(moving, psi)| *moving |= *psi != 0.0);
        }
        let couples = |matrix: &Mat<f64>, j| matrix.col(j).norm_max() > 0.0;
        let coupled = (0..all).map(|j| coupling.as_ref().is_some_and(|c| couples(c, j))).collect();
        Self {
            contacts,
            moving,
            coupled,
            flexibility: OnceLock::new(),
            inertia,
            omega_squared,
            loads: ports.loads.iter().map(project).collect(),
            dofs,
            damping,
            coupling,
        }
    }

    /// Dynamic stiffness of a mode by itself.
    fn stiffness(&self, j: usize, rate: f64) -> c64 {
        c64::new(self.omega_squared[j] - self.inertia[j] * rate * rate, rate * self.damping[j])
    }

    /// Number of modes.
    #[must_use]
    pub fn modes(&self) -> usize {
        self.omega_squared.len()
    }

    /// Whether the damping couples modes.
    #[must_use]
    pub fn is_coupled(&self) -> bool {
        self.coupling.is_some()
    }

    /// Ψᵀ of all contacts, modes × contacts.
    #[must_use]
    pub fn contacts(&self) -> MatRef<'_, f64> {
        self.contacts.as_ref()
    }

    /// Ψᵀ of some contacts, modes × contacts.
    #[must_use]
    pub fn of_contacts(&self, contacts: &[usize]) -> Mat<f64> {
        let mut own = Mat::zeros(self.modes(), contacts.len());
        gather(self.contacts(), contacts, &mut own);
        own
    }

    /// Ψᵀ of some contacts in the slowest modes, and the flexibility of all others between these contacts;
    /// nothing where the others do not follow their loads at once. What the two answer differs from
    /// the whole by some thousandths of that flexibility.
    #[must_use]
    pub fn quasi_static(
        &self,
        at: &ModalOrders,
        contacts: &[usize],
    ) -> Option<(Mat<f64>, Mat<f64>)> {
        let slow = self.modes() / SLOWEST;
        let one = c64::new(1.0, 0.0);
        let follows = |inverse: &[c64]| {
            let others = inverse.iter().zip(&self.omega_squared).skip(slow);
            others.map(|(z, k)| (z * *k - one).norm()).all(|change| change <= QUASI_STATIC)
        };
        if self.is_coupled() || !at.orders.iter().all(|(.., inverse)| follows(inverse)) {
            return None;
        }
        let flexibility = self.flexibility.get_or_init(|| self.flexibility_behind(slow));
        let mut shapes = Mat::zeros(slow, contacts.len());
        gather(self.contacts().subrows(0, slow), contacts, &mut shapes);
        let mut own = Mat::zeros(contacts.len(), contacts.len());
        for (at, &j) in contacts.iter().enumerate() {
            let column = flexibility.col_as_slice(j);
            let entries = own.col_as_slice_mut(at).iter_mut().zip(contacts);
            entries.for_each(|(entry, &i)| *entry = column[i]);
        }
        Some((shapes, own))
    }

    /// `Σ ψ ψᵀ / ω²` of all modes behind the first ones.
    fn flexibility_behind(&self, first: usize) -> Mat<f64> {
        let (count, size) = (self.modes() - first, self.contacts.ncols());
        let mut out = Mat::zeros(size, size);
        // A part of the modes at a time needs no copy of the whole.
        for start in (0..count).step_by(size.clamp(1, 256)) {
            let rows = (count - start).min(size.clamp(1, 256));
            let own = self.contacts().subrows(first + start, rows);
            let carried = Mat::from_fn(rows, size, |j, i| {
                own[(j, i)] / self.omega_squared[first + start + j]
            });
            triangular::matmul(
                out.as_mut(),
                BlockStructure::TriangularLower,
                Accum::Add,
                own.transpose(),
                BlockStructure::Rectangular,
                carried.as_ref(),
                BlockStructure::Rectangular,
                1.0,
                Par::Seq,
            );
        }
        for j in 0..size {
            (0..j).for_each(|i| out[(i, j)] = out[(j, i)]);
        }
        out
    }

    /// The dynamic stiffness at a frequency [rad/s], of harmonics with their slots.
    ///
    /// # Errors
    /// The harmonic at which the structure is singular, and why.
    pub fn orders(
        &self,
        harmonics: impl Iterator<Item = (usize, usize)>,
        omega: f64,
    ) -> Result<ModalOrders, (usize, Error)> {
        let (mut orders, mut kept) = (Vec::new(), Vec::new());
        for (order, slot) in harmonics {
            let rate = order as f64 * omega;
            self.check(order, omega).map_err(|error| (order, error))?;
            let inverse = (0..self.modes()).map(|j| {
                let own = self.stiffness(j, rate);
                // Met exactly by a mode that damping only couples: the iteration sees to the rest.
                let least = FLOOR * rate * rate;
                if own.norm() < least { c64::new(0.0, least) } else { own }.inv()
            });
            orders.push((slot, rate, inverse.collect()));
            kept.push(order);
        }
        Ok(ModalOrders { orders, harmonics: kept })
    }

    /// Refuses rigid-body motion under static loads, and an undamped mode at its resonance.
    pub(super) fn check(&self, order: usize, omega: f64) -> Result<(), Error> {
        if order == 0 {
            let own = self.inertia.iter().filter(|m| **m > 0.0).count();
            let natural = &self.omega_squared[..own];
            let largest = natural.iter().fold(0.0_f64, |m, w| m.max(w.abs()));
            let lowest = natural.first().map_or(0.0, |w| w.max(0.0).sqrt());
            let rigid = natural.iter().any(|w| w.abs() <= RIGID_BODY * largest);
            return if rigid { Err(Error::SingularStiffness { lowest }) } else { Ok(()) };
        }
        let rate = order as f64 * omega;
        for (j, (natural, damping)) in self.omega_squared.iter().zip(&self.damping).enumerate() {
            let distance = (natural - rate * rate).abs() + rate * damping.abs();
            if self.coupled[j] || self.inertia[j] == 0.0 {
                continue;
            }
            let moved = self.moving[j];
            let loaded = || self.load(order).is_some_and(|load| load[j].norm() > 0.0);
            if resonates(distance, rate * rate, moved) && (moved || loaded()) {
                let natural = natural.max(0.0).sqrt();
                return Err(Error::UndampedResonance { omega, harmonic: order, natural });
            }
        }
        Ok(())
    }

    pub(super) fn load(&self, harmonic: usize) -> Option<&[c64]> {
        self.loads.iter().find(|(order, _)| *order == harmonic).map(|(_, load)| load.as_slice())
    }

    /// Adds the external load to modal forces, slots × modes.
    pub fn add_load(&self, at: &ModalOrders, forces: &mut Mat<f64>) {
        for ((slot, ..), order) in at.orders.iter().zip(&at.harmonics) {
            for (j, p) in self.load(*order).into_iter().flatten().enumerate() {
                forces[(*slot, j)] += p.re;
                if *order > 0 {
                    forces[(slot + 1, j)] -= p.im;
                }
            }
        }
    }

    /// Modal forces of slip loads, `q Ψ`; `contacts` are Ψᵀ of the contacts that have some. Those without
    /// a load are passed over.
    #[must_use]
    pub fn excite(contacts: MatRef<'_, f64>, slip_load: MatRef<'_, f64>) -> Mat<f64> {
        let loaded = |j: &usize| slip_load.col(*j).iter().any(|q| *q != 0.0);
        let loaded: Vec<usize> = (0..slip_load.ncols()).filter(loaded).collect();
        // Tall columns, one behind the other, go through the processor twice as fast as rows.
        let mut forces = Mat::zeros(contacts.nrows(), slip_load.nrows());
        if loaded.len() == slip_load.ncols() {
            let par = Par::Seq;
            matmul(forces.as_mut(), Accum::Replace, contacts, slip_load.transpose(), 1.0, par);
            return forces.transpose().to_owned();
        }
        let mut panel = Mat::zeros(contacts.nrows(), PANEL.min(loaded.len()));
        for own in loaded.chunks(PANEL) {
            gather(contacts, own, &mut panel);
            let loads = Mat::from_fn(own.len(), slip_load.nrows(), |j, i| slip_load[(i, own[j])]);
            let panel = panel.as_ref().subcols(0, own.len());
            matmul(forces.as_mut(), Accum::Add, panel, loads.as_ref(), 1.0, Par::Seq);
        }
        forces.transpose().to_owned()
    }

    /// Displacements of modal coordinates at contacts, `y Ψᵀ`.
    #[must_use]
    pub fn displace(contacts: MatRef<'_, f64>, coordinates: MatRef<'_, f64>) -> Mat<f64> {
        let mut motion = Mat::zeros(coordinates.nrows(), contacts.ncols());
        matmul(motion.as_mut(), Accum::Replace, coordinates, contacts, 1.0, Par::Seq);
        motion
    }

    /// Amplitudes of DOFs from the modal coordinates of a harmonic at a slot.
    pub fn observe(
        &self,
        harmonic: usize,
        slot: usize,
        coordinates: &Mat<f64>,
        observe: &[usize],
        out: &mut [c64],
    ) {
        for (x, &dof) in out.iter_mut().zip(observe) {
            let part = |slot: usize| -> f64 {
                let shape = self.dofs.col(dof).iter();
                shape.zip(coordinates.row(slot).iter()).map(|(phi, y)| phi * y).sum()
            };
            *x = c64::new(part(slot), if harmonic == 0 { 0.0 } else { -part(slot + 1) });
        }
    }

    /// `Z⁻¹` of the columns of a matrix of complex modal forces, by a factorisation where the damping
    /// couples modes.
    pub(super) fn solved(&self, order: usize, omega: f64, forces: Mat<c64>) -> Mat<c64> {
        let rate = order as f64 * omega;
        let own = |j: usize| self.stiffness(j, rate);
        // Damping couples nothing at rest.
        let Some(coupling) = self.coupling.as_ref().filter(|_| rate != 0.0) else {
            return Mat::from_fn(forces.nrows(), forces.ncols(), |i, j| forces[(i, j)] / own(i));
        };
        let whole = Mat::from_fn(self.modes(), self.modes(), |i, j| {
            let diagonal = if i == j { own(i) } else { c64::new(0.0, 0.0) };
            diagonal + c64::new(0.0, rate * coupling[(j, i)])
        });
        whole.partial_piv_lu().solve(forces)
    }

    /// `−dZ/dω` of the columns of a matrix of complex modal coordinates.
    pub(super) fn softening(&self, order: usize, omega: f64, coordinates: &Mat<c64>) -> Mat<c64> {
        let k = order as f64;
        let coupled = self.coupling.as_ref().map(|coupling| {
            let matrix = coupling.transpose();
            Mat::from_fn(matrix.nrows(), matrix.ncols(), |i, j| c64::new(matrix[(i, j)], 0.0))
                * coordinates
        });
        Mat::from_fn(coordinates.nrows(), coordinates.ncols(), |i, j| {
            let y = coordinates[(i, j)];
            let other = coupled.as_ref().map_or(c64::new(0.0, 0.0), |coupled| coupled[(i, j)]);
            2.0 * k * k * omega * self.inertia[i] * y
                - c64::new(0.0, k) * (self.damping[i] * y + other)
        })
    }

    /// Number of DOFs.
    #[must_use]
    pub fn dofs(&self) -> usize {
        self.dofs.ncols()
    }

    /// Half-power bandwidth of the least damped mode [rad/s].
    pub(super) fn narrowest_bandwidth(&self) -> f64 {
        let modes = self.damping.iter().zip(&self.inertia).filter(|(_, inertia)| **inertia > 0.0);
        modes.map(|(c, _)| c.abs()).fold(f64::MAX, f64::min)
    }

    /// Turns modal forces into modal coordinates, `Z⁻¹ f`, to a relative tolerance where the damping
    /// couples modes.
    pub fn answer(&self, at: &ModalOrders, forces: &mut Mat<f64>, tolerance: f64) {
        let Some(coupling) = &self.coupling else { return at.divide(forces) };
        let (slots, modes) = (forces.nrows(), forces.ncols());
        let rhs: Vec<f64> = (0..modes).flat_map(|j| forces.col(j).iter().copied()).collect();
        let mut carried = vec![0.0; rhs.len()];
        let column_major =
            |values: &[f64]| Mat::from_fn(slots, modes, |i, j| values[j * slots + i]);
        let mut work = Mat::zeros(slots, modes);
        // Forces that the diagonal carries: (1 + iω C_off diag(Z)⁻¹) carried = forces.
        let product = |v: &[f64], out: &mut [f64]| {
            let mut y = column_major(v);
            at.divide(&mut y);
            matmul(work.as_mut(), Accum::Replace, y.as_ref(), coupling.as_ref(), 1.0, Par::Seq);
            out.copy_from_slice(v);
            for (j, out) in out.chunks_exact_mut(slots).enumerate() {
                for &(slot, rate, _) in at.orders.iter().filter(|(_, rate, _)| *rate > 0.0) {
                    out[slot] += rate * work[(slot + 1, j)];
                    out[slot + 1] -= rate * work[(slot, j)];
                }
            }
            true
        };
        gmres(
            product,
            &rhs,
            &mut carried,
            KrylovSettings { tolerance, max_products: MOST_PRODUCTS },
        );
        *forces = column_major(&carried);
        at.divide(forces);
    }

    /// Rate of change with ω of modal coordinates under fixed forces: `−Z⁻¹ dZ/dω y`.
    pub fn answer_rate(&self, at: &ModalOrders, coordinates: &mut Mat<f64>, tolerance: f64) {
        let coupled = self.coupling.as_ref().map(|coupling| &*coordinates * coupling);
        for ((slot, rate, _), order) in at.orders.iter().zip(&at.harmonics) {
            let order = *order as f64;
            for j in 0..coordinates.ncols() {
                if order == 0.0 {
                    coordinates[(*slot, j)] = 0.0;
                    continue;
                }
                let y = c64::new(coordinates[(*slot, j)], -coordinates[(slot + 1, j)]);
                let mut damped = self.damping[j] * y;
                if let Some(other) = &coupled {
                    damped += c64::new(other[(*slot, j)], -other[(slot + 1, j)]);
                }
                let change =
                    2.0 * order * rate * self.inertia[j] * y - c64::new(0.0, order) * damped;
                (coordinates[(*slot, j)], coordinates[(slot + 1, j)]) = (change.re, -change.im);
            }
        }
        self.answer(at, coordinates, tolerance);
    }
}

impl ModalOrders {
    /// Divides by the diagonal of Z.
    fn divide(&self, forces: &mut Mat<f64>) {
        for (j, mut column) in forces.col_iter_mut().enumerate() {
            for (slot, rate, inverse) in &self.orders {
                if *rate == 0.0 {
                    column[*slot] *= inverse[j].re;
                    continue;
                }
                let y = inverse[j] * c64::new(column[*slot], -column[slot + 1]);
                (column[*slot], column[slot + 1]) = (y.re, -y.im);
            }
        }
    }
}

/// Copies some columns side by side into a matrix that is no narrower.
fn gather(from: MatRef<'_, f64>, columns: &[usize], into: &mut Mat<f64>) {
    for (at, &j) in columns.iter().enumerate() {
        match from.col(j).try_as_col_major() {
            Some(column) => into.col_as_slice_mut(at).copy_from_slice(column.as_slice()),
            None => into.col_mut(at).copy_from(from.col(j)),
        }
    }
}

/// Ψᵀ, of rows of B that hold few numbers each.
fn seen(dofs: MatRef<'_, f64>, rows: MatRef<'_, f64>) -> Mat<f64> {
    let mut contacts = Mat::zeros(dofs.nrows(), rows.nrows());
    for (i, mut contact) in contacts.col_iter_mut().enumerate() {
        for (dof, share) in rows.row(i).iter().enumerate().filter(|(_, share)| **share != 0.0) {
            contact += faer::Scale(*share) * dofs.col(dof);
        }
    }
    contacts
}
