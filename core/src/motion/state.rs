//! The state of a motion: modal displacements and velocities, contact forces.

use super::bodies::Body;
use super::modal_system::ModalSystem;
use crate::contact::PointState;
use crate::error::brief;
use crate::Error;
use faer::Mat;

/// Force beyond its slip limit that printed digits may leave in a given state.
const ROUNDING: f64 = 1e-9;
/// Share of a contact's forces that no deformation gives which printed digits may leave, …
const PRINTED: f64 = 1e-6;
/// … and share of what their stiffness makes of the motion, where the forces are but the
/// rounding of that.
const CANCELLED: f64 = 1e-12;

/// Changes of state per point after which the states are taken as they are.
const FLIPS: usize = 8;

/// State at an instant.
#[derive(Debug, Clone, PartialEq)]
pub struct State {
    /// Time since the start of the period \[s\].
    pub time: f64,
    /// Modal displacements η.
    pub displacement: Vec<f64>,
    /// Modal velocities η' [1/s].
    pub velocity: Vec<f64>,
    /// Contact forces \[N\].
    pub force: Vec<f64>,
    /// What each contact point does.
    pub points: Vec<PointState>,
}

impl State {
    /// Rest with unloaded contacts.
    #[must_use]
    pub fn rest(system: &ModalSystem) -> Self {
        let (modes, points) = (system.modes(), system.points());
        Self {
            time: 0.0,
            displacement: vec![0.0; modes],
            velocity: vec![0.0; modes],
            force: vec![0.0; points],
            points: vec![PointState::Stuck; points],
        }
    }

    /// A state from displacements and velocities of the DOFs and contact forces, one after the
    /// other in `values`.
    ///
    /// # Errors
    /// A wrong number of values, values that are not finite, a contact force beyond its limit.
    pub fn from_dofs(system: &ModalSystem, values: &[f64]) -> Result<Self, Error> {
        let (modes, points) = (system.modes(), system.points());
        if values.len() != 2 * modes + points {
            return Err(Error::shape(
                "state",
                format!("{} values", 2 * modes + points),
                values.len(),
            ));
        }
        if let Some(value) = values.iter().find(|v| !v.is_finite()) {
            return Err(Error::value("state", *value, "every value must be finite"));
        }
        let (motion, force) = values.split_at(2 * modes);
        let mut state = Self::rest(system);
        state.displacement = system.to_modes(&motion[..modes]);
        state.velocity = system.to_modes(&motion[modes..]);
        let negligible = CANCELLED * state.largest_force(system);
        for (point, (f, limit)) in force.iter().zip(system.limits()).enumerate() {
            if f.abs() > limit * (1.0 + ROUNDING) + negligible {
                return Err(Error::value(
                    format!("state: force of contact point {}", point + 1),
                    *f,
                    &format!("must lie within its slip limit of {} N", brief(*limit)),
                ));
            }
        }
        for body in system.bodies() {
            let own = &force[body.points.clone()];
            let carried = body.elastic.carried(own);
            let size = own.iter().fold(0.0_f64, |m, f| m.max(f.abs()));
            let most = (PRINTED * size).max(negligible);
            if let Some(i) = (0..own.len()).find(|&i| (own[i] - carried[i]).abs() > most) {
                return Err(Error::value(
                    format!("state: force of contact {}, point {i}", body.contact + 1),
                    own[i],
                    &format!(
                        "no deformation of the contact gives these forces; the nearest that one gives is {}",
                        brief(carried[i])
                    ),
                ));
            }
        }
        state.force = force.to_vec();
        state.settle_points(system);
        Ok(state)
    }

    /// Force that the contacts would have if all parts of their displacements, each at the amplitude
    /// that its energy gives it, pushed the same way: what the rounding of the forces counts against.
    fn largest_force(&self, system: &ModalSystem) -> f64 {
        let squares = system.omega_squared.iter().map(|square| square.max(0.0));
        let amplitudes: Vec<f64> = (self.displacement.iter().zip(&self.velocity).zip(squares))
            .map(|((x, v), square)| x.hypot(if square > 0.0 { v / square.sqrt() } else { 0.0 }))
            .collect();
        let stroke = |point: usize| -> f64 {
            let parts = system.contact_shape(point).iter().zip(&amplitudes);
            parts.map(|(shape, amplitude)| (shape * amplitude).abs()).sum()
        };
        let mut largest = 0.0_f64;
        for body in system.bodies() {
            let (stiffness, first) = (body.law.stiffness(), body.points.start);
            for i in 0..body.points.len() {
                let parts =
                    body.points.clone().map(|j| stiffness[(i, j - first)].abs() * stroke(j));
                largest = largest.max(parts.sum());
            }
        }
        largest
    }

    /// Displacements and velocities of the DOFs and contact forces, one after the other.
    #[must_use]
    pub fn to_dofs(&self, system: &ModalSystem) -> Vec<f64> {
        let mut values = system.to_dofs(&self.displacement);
        values.extend(system.to_dofs(&self.velocity));
        values.extend(&self.force);
        values
    }

    /// Keeps the forces within their limits, and has points at their limit slip if they move on.
    /// Of every point, whether its force was free to vary there.
    pub(crate) fn settle_points(&mut self, system: &ModalSystem) -> Vec<bool> {
        let speed = system.contact_displacement(&self.velocity);
        let mut free = vec![true; self.force.len()];
        for body in system.bodies() {
            let range = body.points.clone();
            let size = range.len();
            let force = &mut self.force[range.clone()];
            let states = &mut self.points[range.clone()];
            let mut gain = vec![0.0; size * size];
            body.law.increment(&vec![0.0; size], force, Some(&mut gain));
            states.fill(PointState::Stuck);
            settle(body, force, &speed[range.clone()], &system.limits()[range.clone()], states);
            for (i, free) in free[range].iter_mut().enumerate() {
                *free = gain[i * size + i] == 1.0;
            }
        }
        free
    }

    /// Displacements, velocities and forces.
    pub(crate) fn parts(&mut self) -> [&mut [f64]; 3] {
        [&mut self.displacement, &mut self.velocity, &mut self.force]
    }

    /// Whether every number is finite and of a size whose square is.
    #[must_use]
    pub fn is_bounded(&self) -> bool {
        self.displacement.iter().chain(&self.velocity).all(|v| v.abs() < 1e100)
    }
}

/// Finds the states that follow from the velocities of a contact's points, one after the other:
/// at its limit a point slips if its force would grow, and sticks if it would slip against it.
fn settle(body: &Body, force: &[f64], speed: &[f64], limits: &[f64], states: &mut [PointState]) {
    let along = |matrix: &Mat<f64>, i: usize| -> f64 {
        speed.iter().enumerate().map(|(j, v)| matrix[(i, j)] * v).sum()
    };
    for _ in 0..FLIPS * (states.len() + 1) {
        if (0..force.len()).all(|i| force[i].abs() < limits[i] || limits[i] == 0.0) {
            return;
        }
        let (tangent, slip_rate) = (body.law.tangent(states), body.law.slip_rate(states));
        let contradicts = |i: usize| match states[i] {
            _ if limits[i] == 0.0 || force[i].abs() < limits[i] => false,
            PointState::Stuck => along(&tangent, i) * force[i] > 0.0,
            state => along(&slip_rate, i) * state.sign() < 0.0,
        };
        let Some(i) = (0..states.len()).find(|&i| contradicts(i)) else { return };
        states[i] = match states[i] {
            PointState::Stuck => PointState::slipping(force[i]),
            _ => PointState::Stuck,
        };
    }
}
