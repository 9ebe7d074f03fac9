//! The equations of motion in the modes of the structure without contacts.

use crate::contact::{Elastic, FrictionLaw, PointState};
use crate::model::Model;
use crate::structure::{real_modes, ModalDamping, RealModes};
use crate::Error;
use faer::{c64, Mat, MatRef};
use std::ops::Range;
use std::sync::Arc;

/// Modal damping.
#[derive(Debug, Clone)]
pub(super) enum Damping {
    /// One coefficient per mode: the damping is proportional.
    Diagonal(Vec<f64>),
    /// A full modal matrix.
    Full(Mat<f64>),
}

/// A contact: its law, its points and what deforms in it.
#[derive(Debug, Clone)]
pub(crate) struct Body {
    pub(crate) law: Arc<dyn FrictionLaw>,
    /// Its points among those of the model.
    pub(crate) points: Range<usize>,
    /// Its strains among those of the model.
    pub(crate) strains: Range<usize>,
    pub(crate) elastic: Elastic,
}

/// `η'' + Φᵀ C Φ η' + Ω² η + (B Φ)ᵀ f = Φᵀ P(t)`, with `x = Φ η` and `u = B Φ η`.
///
/// The modes of the free structure serve in every state of the contacts, so that nothing has to be
/// decomposed when a contact changes from stick to slip.
#[derive(Debug, Clone)]
pub struct ModalSystem {
    pub(super) omega_squared: Vec<f64>,
    pub(super) damping: Damping,
    /// Φ.
    shapes: Mat<f64>,
    /// Φᵀ M, the inverse of Φ.
    to_modes: Mat<f64>,
    /// B Φ, contact after contact.
    pub(super) contacts: Vec<f64>,
    /// Φᵀ P_k per forced harmonic.
    pub(super) loads: Vec<(usize, Vec<c64>)>,
    /// Highest rate of the motion [1/s]: the unit of time of a power series.
    rate: f64,
    /// Slip limits of all points [N].
    pub(super) limits: Vec<f64>,
    /// The contacts.
    bodies: Vec<Body>,
}

impl ModalSystem {
    /// The modal form of a model.
    ///
    /// # Errors
    /// The eigenvalue iteration fails; the model is one sector of a travelling wave.
    pub fn new(model: &Model) -> Result<Self, Error> {
        if model.is_travelling_wave() {
            return Err(Error::TravellingWave);
        }
        let structure = model.structure();
        let modes = real_modes(structure.mass(), structure.stiffness())?;
        let damping = modes.damping(structure.damping());
        let size = modes.omega_squared.len();
        let rows = &model.ports().rows * &modes.shapes;
        let contacts =
            (0..rows.nrows()).flat_map(|i| (0..size).map(move |j| (i, j))).map(|at| rows[at]);
        let loads = model.ports().loads.iter().map(|load| {
            let modal = (0..size)
                .map(|j| (0..size).map(|i| load.amplitude[i] * modes.shapes[(i, j)]).sum())
                .collect();
            (load.harmonic, modal)
        });
        Ok(Self {
            contacts: contacts.collect(),
            loads: loads.filter(|(_, load): &(_, Vec<c64>)| !is_zero(load)).collect(),
            rate: rate_of(model, &damping),
            damping: Damping::of(&damping),
            to_modes: modes.shapes.transpose() * structure.mass(),
            limits: limits_of(model),
            bodies: bodies(model)?,
            omega_squared: modes.omega_squared,
            shapes: modes.shapes,
        })
    }

    /// The same structure without loads, with another modal damping and the contacts of another
    /// model of it.
    ///
    /// # Errors
    /// A contact whose stiffness has no eigenvalues.
    pub(crate) fn undriven(&self, model: &Model, damping: &ModalDamping) -> Result<Self, Error> {
        Ok(Self {
            loads: Vec::new(),
            rate: rate_of(model, damping),
            damping: Damping::of(damping),
            limits: limits_of(model),
            bodies: bodies(model)?,
            ..self.clone()
        })
    }

    /// A damping matrix over the DOFs in these modes.
    pub(crate) fn project(&self, matrix: MatRef<'_, f64>) -> ModalDamping {
        let (omega_squared, shapes) = (self.omega_squared.clone(), self.shapes.clone());
        RealModes { omega_squared, shapes }.damping(matrix)
    }

    /// Accelerations η'' without loads, from displacements, velocities and contact forces.
    pub(crate) fn acceleration(
        &self,
        displacement: &[f64],
        velocity: &[f64],
        force: &[f64],
    ) -> Vec<f64> {
        let mut out: Vec<f64> =
            displacement.iter().zip(&self.omega_squared).map(|(x, w)| -w * x).collect();
        self.add_damping(velocity, -1.0, &mut out);
        for (point, f) in force.iter().enumerate() {
            out.iter_mut().zip(self.contact_shape(point)).for_each(|(a, b)| *a -= b * f);
        }
        out
    }

    /// Number of modes N.
    #[must_use]
    pub fn modes(&self) -> usize {
        self.omega_squared.len()
    }

    /// Number of contact points.
    #[must_use]
    pub fn points(&self) -> usize {
        self.limits.len()
    }

    /// Fastest rate in a motion excited at `omega` [1/s].
    pub(crate) fn rate(&self, omega: f64) -> f64 {
        let highest = self.loads.iter().map(|(order, _)| *order).max().unwrap_or(1).max(1);
        self.rate.max(omega * highest as f64)
    }

    /// Refuses a motion whose highest rate is more than `fastest` times a frequency [rad/s]: the
    /// flow would follow it step by step.
    ///
    /// # Errors
    /// The DOF with the highest rate, which hardly has a mass.
    pub(crate) fn check_pace(&self, model: &Model, omega: f64, fastest: f64) -> Result<(), Error> {
        let ratio = self.rate / omega;
        if ratio <= fastest {
            return Ok(());
        }
        let rates = Self::dof_rates(model);
        let fastest = |a: &usize, b: &usize| rates[*a].total_cmp(&rates[*b]);
        let dof = (0..rates.len()).max_by(fastest).unwrap_or(0);
        Err(Error::TooFast { dof, ratio, omega })
    }

    /// The least rate at which a DOF that is held moves while all others are fixed [1/s].
    pub(super) fn slowest_dof(&self, model: &Model) -> f64 {
        Self::dof_rates(model).into_iter().filter(|rate| *rate > 0.0).fold(self.rate, f64::min)
    }

    /// Rates at which the DOFs move while all others are fixed [1/s].
    fn dof_rates(model: &Model) -> Vec<f64> {
        let structure = model.structure();
        let rows = &model.ports().rows;
        let held = rows.transpose() * model.contact_stiffness() * rows;
        let rate = |dof: usize| {
            let mass = structure.mass()[(dof, dof)];
            let stiffness = structure.stiffness()[(dof, dof)] + held[(dof, dof)];
            (stiffness.abs() / mass).sqrt() + structure.damping()[(dof, dof)].abs() / mass
        };
        (0..structure.mass().nrows()).map(rate).collect()
    }

    /// Displacement of DOF `dof` per modal coordinate.
    pub fn shape(&self, dof: usize) -> impl Iterator<Item = f64> + '_ {
        (0..self.modes()).map(move |j| self.shapes[(dof, j)])
    }

    /// Relative displacement of a contact point per modal coordinate.
    #[must_use]
    pub fn contact_shape(&self, point: usize) -> &[f64] {
        &self.contacts[point * self.modes()..(point + 1) * self.modes()]
    }

    /// `x = Φ η`.
    #[must_use]
    pub fn to_dofs(&self, modal: &[f64]) -> Vec<f64> {
        multiply(&self.shapes, modal)
    }

    /// `η = Φᵀ M x`.
    #[must_use]
    pub fn to_modes(&self, dofs: &[f64]) -> Vec<f64> {
        multiply(&self.to_modes, dofs)
    }

    /// Relative displacements `u = B Φ η`.
    #[must_use]
    pub fn contact_displacement(&self, modal: &[f64]) -> Vec<f64> {
        (0..self.points()).map(|point| dot(self.contact_shape(point), modal)).collect()
    }

    /// Modal load at the phase `omega t`, times `factor`, added to `out`.
    pub(crate) fn add_load(&self, phase: f64, factor: f64, out: &mut [f64]) {
        for (order, load) in &self.loads {
            let (sin, cos) = (*order as f64 * phase).sin_cos();
            for (out, p) in out.iter_mut().zip(load) {
                *out += factor * (p.re * cos - p.im * sin);
            }
        }
    }

    /// `Φᵀ C Φ η'`, times `factor`, added to `out`.
    pub(crate) fn add_damping(&self, velocity: &[f64], factor: f64, out: &mut [f64]) {
        match &self.damping {
            Damping::Diagonal(damping) => {
                for ((out, c), v) in out.iter_mut().zip(damping).zip(velocity) {
                    *out += factor * c * v;
                }
            }
            Damping::Full(damping) => {
                for (j, v) in velocity.iter().enumerate() {
                    for (i, out) in out.iter_mut().enumerate() {
                        *out += factor * damping[(i, j)] * v;
                    }
                }
            }
        }
    }

    /// Whether each mode is damped by itself.
    pub(crate) fn is_diagonally_damped(&self) -> bool {
        matches!(self.damping, Damping::Diagonal(_))
    }

    /// Squared natural frequencies of the free structure [rad²/s²].
    #[must_use]
    pub fn omega_squared(&self) -> &[f64] {
        &self.omega_squared
    }

    /// Slip limits of all contact points [N].
    #[must_use]
    pub fn limits(&self) -> &[f64] {
        &self.limits
    }

    /// The contacts.
    pub(crate) fn bodies(&self) -> &[Body] {
        &self.bodies
    }

    /// Number of strains of all contacts: forces that deformations cannot give do not count.
    pub(crate) fn strains(&self) -> usize {
        self.bodies.last().map_or(0, |body| body.strains.end)
    }
}

fn bodies(model: &Model) -> Result<Vec<Body>, Error> {
    let mut bodies: Vec<Body> = Vec::with_capacity(model.laws().len());
    for (law, points) in model.laws().iter().zip(model.points()) {
        let elastic = Elastic::new(law.stiffness().as_ref())?;
        let first = bodies.last().map_or(0, |body| body.strains.end);
        let strains = first..first + elastic.rank();
        bodies.push(Body {
            law: Arc::from(law.magnified(1.0)),
            points: points.clone(),
            strains,
            elastic,
        });
    }
    Ok(bodies)
}

/// `∂f/∂u` and slip per displacement of all contacts in given states.
#[derive(Debug, Clone)]
pub struct Regime {
    /// State of each contact point.
    pub points: Vec<PointState>,
    /// `∂f/∂u`, points × points [N/m].
    pub tangent: Mat<f64>,
    /// `∂s'/∂u'`, points × points.
    pub slip_rate: Mat<f64>,
}

impl Regime {
    pub(crate) fn new(model: &Model, points: &[PointState]) -> Self {
        let total = points.len();
        let mut regime = Self {
            points: points.to_vec(),
            tangent: Mat::zeros(total, total),
            slip_rate: Mat::zeros(total, total),
        };
        for (law, range) in model.laws().iter().zip(model.points()) {
            let (start, size) = (range.start, range.len());
            let own = &points[range.clone()];
            regime
                .tangent
                .get_mut(start..start + size, start..start + size)
                .copy_from(law.tangent(own));
            regime
                .slip_rate
                .get_mut(start..start + size, start..start + size)
                .copy_from(law.slip_rate(own));
        }
        regime
    }
}

impl Damping {
    /// From a damping in the modes of the structure.
    fn of(modal: &ModalDamping) -> Self {
        if modal.is_diagonal() {
            Self::Diagonal(modal.diagonal())
        } else {
            Self::Full(real(modal))
        }
    }
}

fn real(modal: &ModalDamping) -> Mat<f64> {
    let matrix = modal.matrix();
    Mat::from_fn(matrix.nrows(), matrix.ncols(), |i, j| matrix[(i, j)].re)
}

/// Fastest rate of the free motion [1/s].
fn rate_of(model: &Model, damping: &ModalDamping) -> f64 {
    model.compliance().stuck_frequencies().last().copied().unwrap_or(0.0)
        + damping.matrix().norm_l2()
}

fn limits_of(model: &Model) -> Vec<f64> {
    model.laws().iter().flat_map(|law| law.limits()).collect()
}

fn is_zero(load: &[c64]) -> bool {
    load.iter().all(|p| p.re == 0.0 && p.im == 0.0)
}

fn multiply(matrix: &Mat<f64>, vector: &[f64]) -> Vec<f64> {
    let mut out = vec![0.0; matrix.nrows()];
    for (j, v) in vector.iter().enumerate() {
        for (i, out) in out.iter_mut().enumerate() {
            *out += matrix[(i, j)] * v;
        }
    }
    out
}

pub(super) fn dot(a: &[f64], b: &[f64]) -> f64 {
    a.iter().zip(b).map(|(a, b)| a * b).sum()
}
