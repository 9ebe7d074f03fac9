//! Exact orbits of contacts without sliders from spans that begin later in the period.

use super::periodic::PeriodicOrbits;
use super::shooting::Shooting;
use crate::solve::{newton, Outcome};
use std::f64::consts::{PI, TAU};

/// Begins of the span, as shares of it, from which an orbit is sought that none is found from 0: where a
/// contact turns round, what it remembers jumps, and Newton's method fails about it.
const BEGINS: [f64; 3] = [0.5, 0.25, 0.75];

impl PeriodicOrbits<'_> {
    /// Whether a span may begin later, and is another one then.
    pub(super) fn begins_later(&self) -> bool {
        !self.system().microslips().is_empty() && self.plan.rotation.is_none()
    }

    /// By Newton's method from harmonic balance over spans that begin later: unknowns at the time 0.
    pub(super) fn shoot_later(
        &mut self,
        shooting: &mut Shooting<'_>,
        omega: f64,
        iterations: &mut usize,
    ) -> Option<Vec<f64>> {
        let settings = self.newton();
        BEGINS.into_iter().find_map(|share| {
            let angle = share * if self.half_wave() { PI } else { TAU };
            shooting.begin_later(share);
            let mut y = shooting.unknowns(&self.harmonic_start(omega, angle));
            let report = newton(shooting, &mut y, settings);
            *iterations += report.iterations;
            let closed = report.outcome == Outcome::Converged;
            let found = closed.then(|| shooting.begun_at_zero(&y)).flatten();
            shooting.begin_later(0.0);
            found
        })
    }
}
