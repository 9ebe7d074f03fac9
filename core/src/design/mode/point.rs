//! What is read off a point of a nonlinear mode.

use super::equations::ModeEquations;
use super::feed::Feed;
use super::start::Linear;
use crate::balance::{Point, PointStatus};
use crate::contact::PointSummary;
use faer::c64;

/// A higher harmonic close to another natural frequency of the stuck structure.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct Interaction {
    /// Its order.
    pub order: usize,
    /// The natural frequency [rad/s].
    pub frequency: f64,
    /// Amplitude of that mode in it, over the amplitude of the motion.
    pub share: f64,
}

impl Interaction {
    /// Relative distance of frequencies that is close.
    pub const NEAR: f64 = 0.1;
    /// Share from which on it counts.
    pub const SHARE: f64 = 0.1;

    /// The largest one at a point, if there is any.
    pub(super) fn largest(equations: &ModeEquations<'_>, z: &[f64]) -> Option<Self> {
        let [omega, ..] = equations.scalars(z);
        let mut found: Option<Self> = None;
        for order in equations.harmonics().oscillating().iter().copied().filter(|k| *k > 1) {
            let (basis, own) = (equations.basis(order), equations.part(z, order));
            for j in 0..own.nrows() {
                let share = own[(j, 0)].hypot(own[(j, 1)]);
                let frequency = basis.squared[j].max(0.0).sqrt();
                let near = (order as f64 * omega / frequency - 1.0).abs() < Self::NEAR;
                let larger = found.is_none_or(|known| share > known.share);
                if near && share > Self::SHARE && larger {
                    found = Some(Self { order, frequency, share });
                }
            }
        }
        found
    }
}

/// A nonlinear mode at one amplitude.
#[derive(Debug, Clone)]
pub struct ModePoint {
    /// The motion, with t = 0 where the linear mode is in it at its largest.
    pub response: Point,
    /// `a = (X_1ᴴ M X_1)^½` [m √kg].
    pub amplitude: f64,
    /// `ζ = ξ/(2ω)`; that of the work of the forces where those feed the motion.
    pub damping_ratio: f64,
    /// Multiple of the forces of the model that feed the motion; not a number without them.
    pub force_level: f64,
    /// Part of it that is due to viscous damping; the rest is friction.
    pub viscous: f64,
    /// What truncation could still change in frequency and damping, relative to them.
    pub errors: [f64; 2],
    /// The internal resonance that it is in.
    pub interaction: Option<Interaction>,
}

impl ModePoint {
    /// Reads the point at which the equations were evaluated last.
    pub(super) fn new(equations: &ModeEquations<'_>, linear: &Linear, z: &[f64]) -> Self {
        let [omega, excess, amplitude] = equations.scalars(z);
        let (harmonics, model) = (equations.harmonics(), equations.model);
        let (dofs, contacts) = (model.compliance().dofs(), model.compliance().contacts());
        let mut response = Point::empty(omega, PointStatus::Converged, dofs, contacts);
        response.keep(harmonics.highest());
        let orders = harmonics.highest() + 1;
        let turn = phase(equations, linear, z);
        let [kinetic, viscous] = equations.losses(z);
        let series = |order: usize, cos: f64, sin: f64| {
            c64::new(cos, -sin) * c64::from_polar(1.0, order as f64 * turn)
        };
        for order in harmonics.orders() {
            let (basis, own) = (equations.basis(order), equations.part(z, order));
            let sine = |j: usize| if order > 0 { own[(j, 1)] } else { 0.0 };
            let rest = |j: usize| if order == 0 { equations.rest[j] } else { 0.0 };
            let modal: Vec<c64> = (0..own.nrows())
                .map(|j| series(order, amplitude * own[(j, 0)] + rest(j), amplitude * sine(j)))
                .collect();
            for dof in 0..dofs {
                response.displacement[dof * orders + order] =
                    (0..modal.len()).map(|j| basis.shapes[(dof, j)] * modal[j]).sum();
            }
        }
        let (damping_ratio, force_level) = match &equations.feed {
            Feed::Damping => (0.5 * excess / omega, f64::NAN),
            Feed::Force(shape, size) => {
                let force = z[z.len() - 2] * equations.unit.powi(2);
                let excess = -force * along(equations, shape, z).im / (omega * kinetic);
                (0.5 * excess / omega, force * amplitude / size)
            }
        };
        let slots = harmonics.slots();
        let (u, q) = (&equations.contact, equations.slip_load());
        let stiffness = model.contact_stiffness();
        let points = model.points().iter().flat_map(|own| own.clone().map(move |i| (i, own)));
        for (i, own) in points {
            for order in harmonics.orders() {
                let Some(slot) = harmonics.slot(order) else { continue };
                let at = |values: &[f64], point: usize| {
                    let sin = if order > 0 { values[point * slots + slot + 1] } else { 0.0 };
                    series(order, values[point * slots + slot], sin)
                };
                let stuck: c64 = own.clone().map(|j| stiffness[(i, j)] * at(u, j)).sum();
                response.contact_displacement[i * orders + order] = at(u, i);
                response.contact_force[i * orders + order] = stuck - at(&q, i);
            }
        }
        response.contacts.fill(PointSummary::default());
        for (index, (law, range)) in model.laws().iter().zip(model.points()).enumerate() {
            law.summary(equations.motion(index), &mut response.contacts[range.clone()]);
        }
        response.error_estimate = vec![f64::NAN; dofs];
        response.sampling_error = vec![0.0; dofs];
        Self {
            response,
            amplitude,
            damping_ratio,
            force_level,
            viscous: 0.5 * viscous / (kinetic * omega),
            errors: [f64::NAN; 2],
            interaction: Interaction::largest(equations, z),
        }
    }

    /// An amplitude that was not reached.
    pub(super) fn missing(dofs: usize, contacts: usize, amplitude: f64) -> Self {
        Self {
            response: Point::empty(f64::NAN, PointStatus::NotComputed, dofs, contacts),
            amplitude,
            damping_ratio: f64::NAN,
            force_level: f64::NAN,
            viscous: f64::NAN,
            errors: [f64::NAN; 2],
            interaction: None,
        }
    }

    /// Sum over all harmonics of the change of every DOF by a step of a balance in more of them \[m\].
    pub(super) fn changes(
        &self,
        equations: &ModeEquations<'_>,
        z: &[f64],
        step: &[f64],
    ) -> Vec<f64> {
        let [.., amplitude] = equations.scalars(z);
        let mut errors = vec![0.0; self.response.error_estimate.len()];
        for order in equations.harmonics().orders() {
            let (basis, own) = (equations.basis(order), equations.part(step, order));
            let sine = |j: usize| if order > 0 { own[(j, 1)] } else { 0.0 };
            for (dof, error) in errors.iter_mut().enumerate() {
                let change: c64 = (0..own.nrows())
                    .map(|j| basis.shapes[(dof, j)] * c64::new(own[(j, 0)], -sine(j)))
                    .sum();
                *error += amplitude * change.norm();
            }
        }
        errors
    }
}

impl ModeEquations<'_> {
    /// `Σ k² Y_kᴴ Y_k` and `Σ k² Y_kᴴ C Y_k` of a point: what a damping ξ feeds, over ξ, and what viscous
    /// damping takes.
    fn losses(&self, z: &[f64]) -> [f64; 2] {
        let (mut kinetic, mut viscous) = (0.0, 0.0);
        for &order in self.harmonics().oscillating() {
            let (basis, own) = (self.basis(order), self.part(z, order));
            let coupled = basis.coupling.as_ref().map(|coupling| coupling.times(own));
            let weight = (order * order) as f64;
            for j in 0..own.nrows() {
                let size = own[(j, 0)].powi(2) + own[(j, 1)].powi(2);
                kinetic += weight * size;
                viscous += weight * basis.damping[j] * size;
                if let Some(coupled) = &coupled {
                    let both = coupled[(j, 0)] * own[(j, 0)] + coupled[(j, 1)] * own[(j, 1)];
                    viscous += weight * both;
                }
            }
        }
        [kinetic, viscous]
    }

    /// What viscous damping alone would have of the unknown that feeds a point, without its sign: where
    /// contacts take what a negative damping gives that unknown vanishes, and its parts do not.
    pub(super) fn viscous_feed(&self, z: &[f64]) -> f64 {
        let ([omega, ..], [kinetic, viscous]) = (self.scalars(z), self.losses(z));
        match &self.feed {
            Feed::Damping => (viscous / (kinetic * self.unit)).abs(),
            Feed::Force(shape, _) => {
                (omega * viscous / (along(self, shape, z).im * self.unit.powi(2))).abs()
            }
        }
    }
}

/// Part of the fundamental along a shape.
fn along(equations: &ModeEquations<'_>, shape: &[c64], z: &[f64]) -> c64 {
    let own = equations.part(z, 1);
    (0..own.nrows()).map(|j| shape[j].conj() * c64::new(own[(j, 0)], -own[(j, 1)])).sum()
}

/// Angle by which time is moved so that the linear mode is in the fundamental with phase zero.
fn phase(equations: &ModeEquations<'_>, linear: &Linear, z: &[f64]) -> f64 {
    -along(equations, &linear.shape, z).arg()
}
