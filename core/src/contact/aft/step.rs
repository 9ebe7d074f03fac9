//! One step of a march, from an instant to the next.

use super::samples::Samples;
use crate::contact::return_map::ReturnMapJacobian;

/// What a march takes from instant to instant.
pub(super) struct Step {
    pub(super) state: Vec<f64>,
    pub(super) force: Vec<f64>,
    pub(super) jacobian: ReturnMapJacobian,
    /// Displacements at the end, in the span or mirrored behind it.
    pub(super) after: Vec<f64>,
    /// The derivative of all steps that are those of the spring, if there has been one.
    pub(super) spring: Option<ReturnMapJacobian>,
    /// Whether that is the derivative at hand.
    pub(super) springs: bool,
    /// Derivative of the force in the state before the last step of [`Aft::advance_derived`].
    pub(super) force_by_state: Vec<f64>,
}

impl Step {
    /// None yet, from a state to the first instant.
    pub(super) fn first(samples: &Samples, state: Vec<f64>) -> Self {
        let after = samples.at(0).to_vec();
        Self {
            state,
            force: vec![0.0; after.len()],
            jacobian: ReturnMapJacobian::default(),
            after,
            spring: None,
            springs: false,
            force_by_state: Vec::new(),
        }
    }
}
