//! A structure under its static loads, as it is found.

/// How raising the static loads has ended.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub enum RestStatus {
    /// The structure carries its loads.
    Converged = 0,
    /// Contacts have let go of a body that nothing else holds.
    Free = 1,
    /// No state in equilibrium follows from the one before: contacts jam or let go at once.
    Stalled = 2,
    /// The caller has ended the analysis.
    NotComputed = 3,
}

/// A structure under its static loads.
#[derive(Debug, Clone)]
pub struct AtRest {
    /// How it was reached; other than converged, the rest holds the last state in equilibrium.
    pub status: RestStatus,
    /// Share of the loads that it carries.
    pub share: f64,
    /// Displacements of the observed DOFs \[m\].
    pub displacement: Vec<f64>,
    /// Relative displacements at the contacts \[m\].
    pub contact_displacement: Vec<f64>,
    /// Contact forces as the laws give them \[N\].
    pub contact_force: Vec<f64>,
    /// What each law remembers.
    pub states: Vec<Vec<f64>>,
    /// Load steps taken.
    pub steps: usize,
}
