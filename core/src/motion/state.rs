//! The state of a motion: modal displacements and velocities, contact forces.

use super::modal_system::{dot, ModalSystem};
use crate::contact::PointState;
use crate::Error;

/// Force beyond its slip limit that printed digits may leave in a given state.
const ROUNDING: f64 = 1e-9;

/// State at an instant.
#[derive(Debug, Clone, PartialEq)]
pub struct State {
    /// Time since the start of the period [s].
    pub time: f64,
    /// Modal displacements η.
    pub displacement: Vec<f64>,
    /// Modal velocities η' [1/s].
    pub velocity: Vec<f64>,
    /// Contact forces [N].
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
        for (point, (f, limit)) in force.iter().zip(system.limits()).enumerate() {
            if f.abs() > limit * (1.0 + ROUNDING) {
                return Err(Error::value(
                    format!("state: force of contact point {}", point + 1),
                    *f,
                    &format!("must lie within its slip limit of {limit} N"),
                ));
            }
        }
        let mut state = Self::rest(system);
        state.displacement = system.to_modes(&motion[..modes]);
        state.velocity = system.to_modes(&motion[modes..]);
        state.force = force.to_vec();
        state.settle_points(system);
        Ok(state)
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
    pub(crate) fn settle_points(&mut self, system: &ModalSystem) {
        for point in 0..self.force.len() {
            let limit = system.limits()[point];
            let force = self.force[point].clamp(-limit, limit);
            self.force[point] = force;
            let speed = dot(system.contact_shape(point), &self.velocity);
            let at_limit = limit > 0.0 && force.abs() == limit;
            self.points[point] = if at_limit && speed * force > 0.0 {
                PointState::slipping(force)
            } else {
                PointState::Stuck
            };
        }
    }

    /// Whether every number is finite and of a size whose square is.
    #[must_use]
    pub fn is_bounded(&self) -> bool {
        self.displacement.iter().chain(&self.velocity).all(|v| v.abs() < 1e100)
    }
}
