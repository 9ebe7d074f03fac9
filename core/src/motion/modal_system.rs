//! The equations of motion in the modes of the structure without contacts.

use super::bodies::{Bodies, Body};
use super::damping::Damping;
use super::microslip::Microslip;
use super::pace::{dof_rates, rate_of};
use super::projection::Projection;
use crate::contact::{Bound, PointSummary, SlipPlane};
use crate::model::Model;
use crate::structure::{modes, ModalDamping, RealModes};
use crate::Error;
use faer::{c64, Mat, MatRef};

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
    /// B Φ, element after element.
    pub(super) contacts: Vec<f64>,
    /// The same for products.
    pub(super) projection: Projection,
    /// The contact displacement of the model that each point of an element acts on.
    components: Vec<usize>,
    /// Φᵀ P_k per forced harmonic.
    pub(super) loads: Vec<(usize, Vec<c64>)>,
    /// Highest rate of the motion [1/s]: the unit of time of a power series.
    rate: f64,
    /// Slip limits of all points \[N\].
    pub(super) limits: Vec<f64>,
    /// What bounds the forces of all points.
    pub(super) bounds: Vec<Bound>,
    /// Points whose force follows from their displacement, varies and may vanish.
    pub(super) normals: Vec<usize>,
    /// Pairs of points that slip in a plane.
    pub(super) planes: Vec<SlipPlane>,
    /// Contacts without sliders.
    pub(super) microslips: Vec<Microslip>,
    /// The elements of the contacts.
    bodies: Vec<Body>,
}

impl ModalSystem {
    /// The modal form of a model.
    ///
    /// # Errors
    /// The eigenvalue iteration fails; the model is one sector of a travelling wave; a contact law
    /// has no events that an exact motion could be followed by.
    pub fn new(model: &Model) -> Result<Self, Error> {
        Self::of(model, Bodies::new(model, false)?)
    }

    /// The same for motions that are stepped through: a law without events takes part by its return
    /// map.
    ///
    /// # Errors
    /// The eigenvalue iteration fails; the model is one sector of a travelling wave.
    pub(crate) fn marched(model: &Model) -> Result<Self, Error> {
        Self::of(model, Bodies::new(model, true)?)
    }

    fn of(model: &Model, bodies: Bodies) -> Result<Self, Error> {
        if model.is_travelling_wave() {
            return Err(Error::TravellingWave);
        }
        let structure = model.structure();
        let modes = modes(structure.mass(), structure.stiffness())?;
        let (modes, damping) = if structure.is_proportional() {
            modes.damped_by_law(structure.damping())
        } else {
            let damping = modes.damping(structure.damping());
            (modes, damping)
        };
        let size = modes.omega_squared.len();
        let rows = &*model.ports().rows * &modes.shapes;
        let contacts = bodies
            .components
            .iter()
            .flat_map(|&i| (0..size).map(move |j| (i, j)))
            .map(|at| rows[at])
            .collect::<Vec<f64>>();
        let loads = model.ports().loads.iter().map(|load| {
            let modal = (0..size)
                .map(|j| (0..size).map(|i| load.amplitude[i] * modes.shapes[(i, j)]).sum())
                .collect();
            (load.harmonic, modal)
        });
        Ok(Self {
            projection: Projection::new(&contacts, size),
            contacts,
            loads: loads.filter(|(_, load): &(_, Vec<c64>)| !is_zero(load)).collect(),
            rate: rate_of(model, &damping),
            damping: Damping::of(&damping),
            to_modes: modes.shapes.transpose() * structure.mass(),
            limits: bodies.limits(),
            normals: bodies.normals(),
            planes: bodies.planes(),
            bounds: bodies.bounds(),
            components: bodies.components,
            microslips: bodies.microslips,
            bodies: bodies.all,
            omega_squared: modes.omega_squared,
            shapes: modes.shapes,
        })
    }

    /// The same structure without loads, but for `held` ones that are static, with another modal damping
    /// and the contacts of another model of it.
    ///
    /// # Errors
    /// A contact whose stiffness has no eigenvalues.
    pub(crate) fn undriven(
        &self,
        model: &Model,
        damping: &ModalDamping,
        held: bool,
    ) -> Result<Self, Error> {
        let bodies = Bodies::new(model, false)?;
        Ok(Self {
            loads: self.loads.iter().filter(|(k, _)| held && *k == 0).cloned().collect(),
            rate: rate_of(model, damping),
            damping: Damping::of(damping),
            limits: bodies.limits(),
            normals: bodies.normals(),
            planes: bodies.planes(),
            bounds: bodies.bounds(),
            components: bodies.components,
            microslips: bodies.microslips,
            bodies: bodies.all,
            ..self.clone()
        })
    }

    /// A damping matrix over the DOFs in these modes.
    pub(crate) fn project(&self, matrix: MatRef<'_, f64>) -> ModalDamping {
        let (omega_squared, shapes) = (self.omega_squared.clone(), self.shapes.clone());
        RealModes { omega_squared, shapes }.damping(matrix)
    }

    /// Accelerations η'' under static loads alone, from displacements, velocities and contact forces.
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
        for (_, load) in self.loads.iter().filter(|(order, _)| *order == 0) {
            out.iter_mut().zip(load).for_each(|(a, p)| *a += p.re);
        }
        out
    }

    /// Number of modes N.
    #[must_use]
    pub fn modes(&self) -> usize {
        self.omega_squared.len()
    }

    /// Number of points of all elements.
    #[must_use]
    pub fn points(&self) -> usize {
        self.limits.len()
    }

    /// The contact displacement of the model that each point of an element acts on.
    #[must_use]
    pub fn components(&self) -> &[usize] {
        &self.components
    }

    /// Number of contact displacements of the model.
    #[must_use]
    pub fn displacements(&self) -> usize {
        self.components.iter().max().map_or(0, |last| last + 1)
    }

    /// The entries of the first element on every contact displacement, of what all on it share.
    #[must_use]
    pub fn shared<T: Copy>(&self, points: &[T]) -> Vec<T> {
        let first = |component: usize| self.components.iter().position(|own| *own == component);
        (0..self.displacements()).filter_map(first).map(|point| points[point]).collect()
    }

    /// Slip and friction work of the elements gathered into those of the contact displacements: the
    /// share in slip is the mean weighted by stiffness.
    #[must_use]
    pub fn contact_summaries(&self, elements: &[PointSummary]) -> Vec<PointSummary> {
        let mut weights = vec![0.0; self.points()];
        let mut totals = vec![0.0; self.displacements()];
        let mut count = vec![0; self.displacements()];
        for body in &self.bodies {
            let stiffness = body.law.stiffness();
            for (i, point) in body.points.clone().enumerate() {
                weights[point] = stiffness[(i, i)];
                totals[self.components[point]] += stiffness[(i, i)];
                count[self.components[point]] += 1;
            }
        }
        let mut gathered = vec![PointSummary::default(); self.displacements()];
        for ((own, weight), &component) in elements.iter().zip(weights).zip(&self.components) {
            let alone = count[component] == 1;
            let share = if alone { 1.0 } else { weight / totals[component] };
            gathered[component].slip_fraction += share * own.slip_fraction;
            gathered[component].dissipation += own.dissipation;
        }
        gathered
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
        let rates = dof_rates(model);
        let faster = |a: &usize, b: &usize| rates[*a].total_cmp(&rates[*b]);
        let dof = (0..rates.len()).max_by(faster).unwrap_or(0);
        Err(Error::TooFast { dof, ratio, omega, fastest })
    }

    /// The least rate at which a DOF that is held moves while all others are fixed [1/s].
    pub(super) fn slowest_dof(&self, model: &Model) -> f64 {
        dof_rates(model).into_iter().filter(|rate| *rate > 0.0).fold(self.rate, f64::min)
    }

    /// Displacement of DOF `dof` per modal coordinate.
    pub fn shape(&self, dof: usize) -> impl Iterator<Item = f64> + '_ {
        (0..self.modes()).map(move |j| self.shapes[(dof, j)])
    }

    /// Relative displacement of a point of an element per modal coordinate.
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

    /// Relative displacements at the points of the elements, `u = B Φ η`.
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

    /// Modal loads, real and imaginary parts, by their harmonic.
    pub(crate) fn modal_loads(&self) -> Vec<(usize, [Vec<f64>; 2])> {
        let parts = |load: &[c64]| {
            [load.iter().map(|p| p.re).collect(), load.iter().map(|p| p.im).collect()]
        };
        self.loads.iter().map(|(order, load)| (*order, parts(load))).collect()
    }

    /// `Φᵀ C Φ η'`, times `factor`, added to `out`.
    pub(crate) fn add_damping(&self, velocity: &[f64], factor: f64, out: &mut [f64]) {
        self.damping.add_product(velocity, factor, out);
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

    /// Slip limits of all points of the elements \[N\]; of a limit that varies the largest number.
    #[must_use]
    pub fn limits(&self) -> &[f64] {
        &self.limits
    }

    /// How many numbers the contacts remember.
    pub(crate) fn memories(&self) -> usize {
        let own = |body: &Body| body.remembered.len() + body.told;
        self.bodies.iter().map(own).sum()
    }

    /// Contacts without sliders.
    pub(crate) fn microslips(&self) -> &[Microslip] {
        &self.microslips
    }

    /// Whether a point has no slider.
    pub(crate) fn is_microslip(&self, point: usize) -> bool {
        self.microslips.iter().any(|own| own.point == point)
    }

    /// The elements of the contacts.
    pub(crate) fn bodies(&self) -> &[Body] {
        &self.bodies
    }

    /// Number of strains of all contacts: forces that deformations cannot give do not count.
    pub(crate) fn strains(&self) -> usize {
        self.bodies.last().map_or(0, |body| body.strains.end)
    }
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
