//! What slip takes off the elastic force along a backbone.

/// The loss of a backbone at one displacement.
#[derive(Debug, Clone, Copy, Default, PartialEq)]
pub(crate) struct Loss {
    /// `∫ λ dx` from zero.
    pub(crate) integral: f64,
    /// λ.
    pub(crate) value: f64,
    /// λ'.
    pub(crate) slope: f64,
}

impl Loss {
    /// The loss at a distance from here, on a straight line of slope `own`.
    pub(crate) fn straight(self, own: f64, length: f64) -> Self {
        Self {
            integral: self.integral + length * (self.value + 0.5 * own * length),
            value: self.value + own * length,
            slope: own,
        }
    }
}
