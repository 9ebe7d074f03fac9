//! Newton's method. Full steps are taken as long as the residual falls, damped ones where it does
//! not; the last steps, which are small, share one Jacobian.

use super::damping::{Damped, Damping};
use super::line_search::LineSearch;
use super::{norm, System};

/// When to stop.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct NewtonSettings {
    /// Relative error of the unknowns at which a solution is accepted.
    pub tolerance: f64,
    /// Iterations before giving up.
    pub max_iterations: usize,
}

impl Default for NewtonSettings {
    fn default() -> Self {
        Self { tolerance: 1e-11, max_iterations: 100 }
    }
}

/// How a solution ended.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub enum Outcome {
    /// The estimated error is below the tolerance.
    Converged,
    /// No step along the Newton direction leaves a smaller one, or too many iterations.
    Stalled,
    /// The Jacobian is singular, or the residual is not a number.
    Singular,
    /// The caller ended the analysis.
    Interrupted,
}

/// Outcome and effort.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct Report {
    /// How it ended.
    pub outcome: Outcome,
    /// Newton steps taken.
    pub iterations: usize,
    /// Norm of the last residual, relative to that of the unknowns.
    pub residual: f64,
}

/// A small step that leaves no more than this share of itself needs no damping any more.
const CONTRACTS: f64 = 0.1;

/// Behind a step this small the Jacobian has hardly changed, and serves for another step: one with
/// it leaves about this share of the error.
const SERVES_AGAIN: f64 = 1e-3;

/// Share of the tolerance that steps with a kept Jacobian have to reach: displacements beside very
/// stiff contacts are small differences, which an error of the unknowns reaches many times over.
const OF_KEPT: f64 = 1e-2;

/// Solves `system = 0` from `x`, which holds the best point found on return.
pub fn newton(system: &mut impl System, x: &mut [f64], settings: NewtonSettings) -> Report {
    let size = system.size();
    let (mut residual, mut step) = (vec![0.0; size], vec![0.0; size]);
    let mut trial = LineSearch::new(size);
    let mut damping = Damping::new(size);
    // Whether a full step has failed.
    let mut damped = false;
    system.residual(x, &mut residual);
    let mut size_of_residual = norm(&residual);
    // Whether the Jacobian is that at x.
    let mut fresh = true;
    // Whether the tolerance is met, and only rounding may be in the way of more.
    let mut within = false;
    for iteration in 0..settings.max_iterations {
        let report = |outcome, residual: f64, x: &[f64]| Report {
            outcome,
            iterations: iteration + 1,
            residual: residual / norm(x).max(f64::MIN_POSITIVE),
        };
        if system.interrupted() {
            return report(Outcome::Interrupted, size_of_residual, x);
        }
        if !size_of_residual.is_finite() || !system.solve(&residual, &mut step) {
            return report(Outcome::Singular, size_of_residual, x);
        }
        let size_of_step = norm(&step);
        if !size_of_step.is_finite() {
            return report(Outcome::Singular, size_of_residual, x);
        }
        let relative_step = system.relative_size(&step, x);
        let close = relative_step <= 1e-9;
        let keep = relative_step <= SERVES_AGAIN;
        if damped && !close {
            let taken = damping.advance(system, x, &step);
            system.residual(x, &mut residual);
            size_of_residual = norm(&residual);
            match taken {
                Damped::Full(left) => damped = !keep || left > CONTRACTS,
                Damped::Part => {}
                Damped::Stuck => return report(Outcome::Stalled, size_of_residual, x),
            }
            continue;
        }
        let evaluate = |x: &[f64], out: &mut [f64]| {
            if keep {
                system.value(x, out);
            } else {
                system.residual(x, out);
            }
        };
        if !trial.along(evaluate, x, &step, size_of_residual, 1.0, close) {
            // The Jacobian at x again, for damped steps if it was not to blame.
            system.residual(x, &mut residual);
            if fresh && within {
                return report(Outcome::Converged, size_of_residual, x);
            }
            if fresh {
                damping.forget();
                damped = true;
            }
            fresh = true;
            continue;
        }
        // Where Newton's method converges, the error shrinks as the residual does: the error left
        // is the step times the contraction just seen.
        let contraction = trial.contraction(size_of_residual);
        let left = relative_step * contraction.min(1.0);
        x.copy_from_slice(&trial.x);
        std::mem::swap(&mut residual, &mut trial.residual);
        size_of_residual = trial.size;
        // Rounding hides the contraction of the last steps; behind one with a Jacobian of its own
        // the error is that of rounding.
        if close && fresh {
            return report(Outcome::Converged, size_of_residual, x);
        }
        let before = within;
        within = left <= settings.tolerance;
        if within {
            // Newton's own last step would leave hardly more than rounding. One with a Jacobian
            // kept leaves what the step that would follow tells, at the price of a substitution;
            // it is taken once.
            let enough = OF_KEPT * settings.tolerance;
            let known = keep && !before && system.solve(&residual, &mut step);
            if !keep || before || (known && system.relative_size(&step, x) <= enough) {
                return report(Outcome::Converged, size_of_residual, x);
            }
        }
        fresh = !keep;
        // Two more steps with the same Jacobian cost less than a new one; three do not.
        if keep && left * contraction * contraction > settings.tolerance {
            system.residual(x, &mut residual);
            fresh = true;
        }
    }
    Report {
        outcome: Outcome::Stalled,
        iterations: settings.max_iterations,
        residual: size_of_residual / norm(x).max(f64::MIN_POSITIVE),
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    struct Arctangent(f64);

    impl System for Arctangent {
        fn size(&self) -> usize {
            1
        }

        fn residual(&mut self, x: &[f64], out: &mut [f64]) {
            self.0 = 1.0 / (1.0 + x[0] * x[0]);
            self.value(x, out);
        }

        fn value(&mut self, x: &[f64], out: &mut [f64]) {
            out[0] = x[0].atan() - 0.5;
        }

        fn solve(&mut self, rhs: &[f64], step: &mut [f64]) -> bool {
            step[0] = rhs[0] / self.0;
            true
        }
    }

    #[test]
    fn damping_saves_a_start_from_which_full_steps_diverge() {
        let mut x = [8.0];
        let report = newton(&mut Arctangent(0.0), &mut x, NewtonSettings::default());
        assert_eq!(report.outcome, Outcome::Converged);
        assert!((x[0] - 0.5_f64.tan()).abs() < 1e-12);
    }

    /// A narrow valley along a parabola: the first equation weighs a million times the second.
    struct Valley(f64);

    impl System for Valley {
        fn size(&self) -> usize {
            2
        }

        fn residual(&mut self, x: &[f64], out: &mut [f64]) {
            self.0 = x[0];
            self.value(x, out);
        }

        fn value(&mut self, x: &[f64], out: &mut [f64]) {
            out[0] = 1e6 * (x[1] - x[0] * x[0]);
            out[1] = x[0] - 1.0;
        }

        fn solve(&mut self, rhs: &[f64], step: &mut [f64]) -> bool {
            step[0] = rhs[1];
            step[1] = 1e-6 * rhs[0] + 2.0 * self.0 * rhs[1];
            true
        }
    }

    /// Along steps that lower the residual the way takes three million iterations.
    #[test]
    fn steps_are_judged_by_the_error_and_not_by_the_residual() {
        let mut x = [-5.0, 25.0];
        let report = newton(&mut Valley(0.0), &mut x, NewtonSettings::default());
        assert_eq!(report.outcome, Outcome::Converged);
        assert!((x[0] - 1.0).abs() < 1e-12 && (x[1] - 1.0).abs() < 1e-12, "{x:?}");
        assert!(report.iterations <= 5, "{}", report.iterations);
    }

    struct Rootless;

    impl System for Rootless {
        fn size(&self) -> usize {
            1
        }

        fn residual(&mut self, x: &[f64], out: &mut [f64]) {
            self.value(x, out);
        }

        fn value(&mut self, x: &[f64], out: &mut [f64]) {
            out[0] = 1.0 + x[0] * x[0];
        }

        fn solve(&mut self, rhs: &[f64], step: &mut [f64]) -> bool {
            step[0] = rhs[0];
            true
        }
    }

    #[test]
    fn a_system_without_root_is_reported() {
        let report = newton(&mut Rootless, &mut [0.3], NewtonSettings::default());
        assert_ne!(report.outcome, Outcome::Converged);
    }
}
