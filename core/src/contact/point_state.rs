//! States of contact points, and the stretches of a period between their changes.

/// What a contact point does at an instant.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub enum PointState {
    /// It sticks.
    Stuck,
    /// It slips with positive force: the relative displacement grows.
    Forward,
    /// It slips with negative force.
    Backward,
    /// It is one of two points that slip in a plane, in a direction that turns.
    Sliding,
    /// It is open: there is no force.
    Open,
}

impl PointState {
    /// Whether it slips.
    #[must_use]
    pub fn slips(self) -> bool {
        matches!(self, Self::Forward | Self::Backward | Self::Sliding)
    }

    /// Direction of slip: 1, −1, or 0 without slip or where slip turns.
    #[must_use]
    pub fn sign(self) -> f64 {
        match self {
            Self::Stuck | Self::Sliding | Self::Open => 0.0,
            Self::Forward => 1.0,
            Self::Backward => -1.0,
        }
    }

    /// The state in the mirror image of the motion.
    #[must_use]
    pub fn mirrored(self) -> Self {
        match self {
            Self::Stuck | Self::Sliding | Self::Open => self,
            Self::Forward => Self::Backward,
            Self::Backward => Self::Forward,
        }
    }

    /// Slip in the direction of `sign`.
    #[must_use]
    pub fn slipping(sign: f64) -> Self {
        if sign > 0.0 {
            Self::Forward
        } else {
            Self::Backward
        }
    }
}

/// A stretch of the period in which no point changes its state.
#[derive(Debug, Clone, PartialEq)]
pub struct Phase {
    /// Angle θ = ωt from which on, up to the start of the next one.
    pub start: f64,
    /// States of the points. A point without friction counts as stuck: it carries no force.
    pub states: Vec<PointState>,
}

impl Phase {
    /// Instants at which a law that keeps no account of its phases is asked.
    pub const INSTANTS: usize = 4096;

    /// The phases that show in the forces at equidistant instants: a point slips at its limit.
    #[must_use]
    pub fn from_forces(history: &[f64], limits: &[f64]) -> Vec<Self> {
        let step = std::f64::consts::TAU * limits.len() as f64 / history.len() as f64;
        let mut phases: Vec<Self> = Vec::new();
        for (n, force) in history.chunks_exact(limits.len()).enumerate() {
            let states: Vec<PointState> = force
                .iter()
                .zip(limits)
                .map(|(f, limit)| match *limit {
                    limit if limit > 0.0 && f.abs() >= limit => PointState::slipping(*f),
                    _ => PointState::Stuck,
                })
                .collect();
            if phases.last().is_none_or(|last| last.states != states) {
                phases.push(Self { start: step * n as f64, states });
            }
        }
        phases
    }
}
