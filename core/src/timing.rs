//! Where the time of an analysis goes.

use std::time::{Duration, Instant};

/// Time spent and work done in each stage of an analysis.
#[derive(Debug, Clone, Copy, Default, PartialEq)]
pub struct Profile {
    /// Evaluation of the compliance from the modes.
    pub compliance: Duration,
    /// Friction forces and their tangents.
    pub law: Duration,
    /// Assembly and solution of the linear systems.
    pub linear_solve: Duration,
    /// Displacements of the observed DOFs.
    pub recovery: Duration,
    /// Their error estimates.
    pub estimate: Duration,
    /// Stability of its motions.
    pub stability: Duration,
    /// Everything, from the first to the last point and their stability.
    pub total: Duration,
    /// What evaluations and factorisations take, as reckoned \[ns\]: the same on every machine.
    pub work: f64,
    /// Evaluations of all contact laws.
    pub evaluations: usize,
    /// Factorisations of Jacobians.
    pub factorisations: usize,
    /// Products with Jacobians that are never formed.
    pub products: usize,
    /// Rank-one updates of factorised Jacobians, by Broyden's method.
    pub updates: usize,
    /// Points at which Broyden's method took a second Jacobian.
    pub restarts: usize,
    /// Points that needed homotopy after the chosen method had failed.
    pub homotopies: usize,
    /// Points of a balance whose harmonics are those of the exact orbit.
    pub orbits: usize,
}

impl Profile {
    /// Adds the stages of a part of the analysis.
    pub fn add(&mut self, part: &Self) {
        self.compliance += part.compliance;
        self.law += part.law;
        self.linear_solve += part.linear_solve;
        self.work += part.work;
        self.evaluations += part.evaluations;
        self.factorisations += part.factorisations;
        self.products += part.products;
    }

    /// Adds another analysis, all but the time from its first to its last point.
    pub fn add_whole(&mut self, other: &Self) {
        self.add(other);
        self.recovery += other.recovery;
        self.estimate += other.estimate;
        self.stability += other.stability;
        self.updates += other.updates;
        self.restarts += other.restarts;
        self.homotopies += other.homotopies;
        self.orbits += other.orbits;
    }

    /// Runs `work` and adds its duration to `stage`.
    pub fn time<T>(stage: &mut Duration, work: impl FnOnce() -> T) -> T {
        let start = Instant::now();
        let value = work();
        *stage += start.elapsed();
        value
    }
}
