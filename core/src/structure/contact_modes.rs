//! The contacts seen from the modes of the stuck structure: what slip loads displace follows from two
//! real matrix products, `G q = Ψ Z⁻¹ Ψᵀ q` with Ψ = B Φ, and no receptance is ever formed.
//!
//! Where the damping couples no modes Z is diagonal. Otherwise the coupling is light beside the
//! diagonal, and GMRES from the diagonal takes a few products with it.

use super::flexibility::RIGID_BODY;
use super::massless::StuckModes;
use super::modes::{resonates, RealModes};
use super::ports::{HarmonicLoad, Ports};
use super::quasi_static::QuasiStatic;
use crate::solve::{hermitian_eigenvalues, multiply};
use crate::Error;
use faer::{c64, Accum, Mat, MatRef};
use std::sync::OnceLock;

/// Modes of the stuck structure at its contacts. Series of several harmonics are matrices, slots ×
/// contacts or slots × modes, with the cosines and sines of a harmonic in neighbouring rows.
#[derive(Debug)]
pub struct ContactModes {
    /// Ψᵀ, modes × contacts.
    pub(super) contacts: Mat<f64>,
    /// Φᵀ, modes × N.
    pub(super) dofs: Mat<f64>,
    /// Whether a mode moves any contact.
    moving: Vec<bool>,
    /// Whether the damping couples a mode to others.
    coupled: Vec<bool>,
    /// What they answer roughly, if it was asked for.
    pub(super) quasi_static: OnceLock<QuasiStatic>,
    /// Modal mass: 1, or 0 of what DOFs without mass add.
    pub(super) inertia: Vec<f64>,
    /// Modal stiffness.
    pub(super) omega_squared: Vec<f64>,
    pub(super) damping: Vec<f64>,
    /// `Φᵀ C Φ` without its diagonal, transposed, if it couples modes.
    pub(super) coupling: Option<Mat<f64>>,
    /// `Φᵀ P_k` of the harmonics with a load.
    loads: Vec<(usize, Vec<c64>)>,
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
            quasi_static: OnceLock::new(),
            inertia,
            omega_squared,
            loads: ports.loads.iter().map(project).collect(),
            dofs,
            damping,
            coupling,
        }
    }

    /// Dynamic stiffness of a mode by itself.
    pub(super) fn stiffness(&self, j: usize, rate: f64) -> c64 {
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
    pub(super) fn shapes(&self) -> MatRef<'_, f64> {
        self.contacts.as_ref()
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

    /// Squared natural frequencies with springs between contacts taken away, ascending: the modes, which have
    /// unit mass, know the whole structure.
    pub(super) fn squared_without(&self, springs: &[(usize, usize, f64)]) -> Vec<f64> {
        let shapes = self.shapes();
        let mut carried: Mat<f64> = Mat::zeros(shapes.nrows(), shapes.ncols());
        for &(i, j, stiffness) in springs {
            let own = carried.col_as_slice_mut(j).iter_mut().zip(shapes.col(i).iter());
            own.for_each(|(carried, psi)| *carried += stiffness * psi);
        }
        let size = self.modes();
        let mut whole =
            Mat::from_fn(size, size, |i, j| if i == j { self.omega_squared[i] } else { 0.0 });
        multiply(whole.as_mut(), Accum::Add, shapes, carried.transpose(), -1.0);
        hermitian_eigenvalues(whole.as_ref()).unwrap_or_default()
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
