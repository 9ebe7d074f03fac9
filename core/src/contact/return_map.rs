//! Derivatives of a step of a contact law.

/// Derivative of one step of a return map, with n displacements and m numbers of state; matrices
/// row by row.
#[derive(Debug, Clone, Default)]
pub struct ReturnMapJacobian {
    /// New state by old state, m × m.
    pub by_state: Vec<f64>,
    /// New state by the displacements before the step, m × n.
    pub by_before: Vec<f64>,
    /// New state by the displacements after the step, m × n.
    pub by_after: Vec<f64>,
    /// Force by the new state, n × m.
    pub force_by_state: Vec<f64>,
    /// Force by the displacements after the step at a fixed new state, n × n.
    pub force_by_after: Vec<f64>,
    /// Share of every displacement's contact that slips in the step.
    pub slipping: Vec<f64>,
}

impl ReturnMapJacobian {
    /// Clears the derivative for a law.
    pub fn reset(&mut self, displacements: usize, state: usize) {
        for (matrix, size) in [
            (&mut self.by_state, state * state),
            (&mut self.by_before, state * displacements),
            (&mut self.by_after, state * displacements),
            (&mut self.force_by_state, state * displacements),
            (&mut self.force_by_after, displacements * displacements),
            (&mut self.slipping, displacements),
        ] {
            matrix.clear();
            matrix.resize(size, 0.0);
        }
    }

    /// Whether nothing slips in the step.
    #[must_use]
    pub fn sticks(&self) -> bool {
        self.slipping.iter().all(|share| *share == 0.0)
    }
}
