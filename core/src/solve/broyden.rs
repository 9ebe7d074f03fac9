//! Broyden's method: Newton's method with a Jacobian that is never taken anew while it serves, but
//! corrected along every step (Guillen 1999, section 3.4.2).

use super::line_search::{falls, LineSearch};
use super::qr::Qr;
use super::{differences, norm, NewtonSettings, Outcome, Report, System};
use faer::Mat;

/// Where the first Jacobian, and that of every restart, comes from.
#[derive(Debug, Clone, Copy, Default, PartialEq, Eq)]
pub enum FirstJacobian {
    /// The system's own.
    #[default]
    Exact,
    /// Forward differences of the residual, one evaluation per unknown.
    Differences,
}

/// What a solution by Broyden's method took, beside its iterations.
#[derive(Debug, Clone, Copy, Default, PartialEq, Eq)]
pub struct BroydenEffort {
    /// Jacobians taken and decomposed, the first included.
    pub jacobians: usize,
    /// Rank-one updates of the decomposition.
    pub updates: usize,
}

/// Shortest step along a direction: below it it is no descent direction in practice.
const SHORTEST_STEP: f64 = 1.0 / 256.0;
/// Shortest step along a direction of an updated Jacobian, which a fresh one replaces rather than
/// a longer search.
const SHORTEST_UPDATED_STEP: f64 = 0.5;
/// An updated Jacobian is given up where the residual shrinks by less than this factor.
const SLOW: f64 = 0.7;

/// Solves `system = 0` from `x`, which holds the best point found on return. The Jacobian is taken
/// at the start and wherever the method stalls.
pub fn broyden(
    system: &mut impl System,
    x: &mut [f64],
    settings: NewtonSettings,
    first: FirstJacobian,
) -> (Report, BroydenEffort) {
    let size = system.size();
    let (mut residual, mut step) = (vec![0.0; size], vec![0.0; size]);
    let mut trial = LineSearch::new(size);
    let mut effort = BroydenEffort::default();
    let mut matrix = Mat::zeros(size, size);
    let mut factors: Option<Qr> = None;
    let mut size_of_residual = f64::NAN;
    for iteration in 0..settings.max_iterations {
        let report = |outcome, residual: f64, x: &[f64], effort| {
            let residual = residual / norm(x).max(f64::MIN_POSITIVE);
            (Report { outcome, iterations: iteration + 1, residual }, effort)
        };
        if system.interrupted() {
            return report(Outcome::Interrupted, size_of_residual, x, effort);
        }
        let fresh = factors.is_none();
        let current = factors.get_or_insert_with(|| {
            effort.jacobians += 1;
            match first {
                FirstJacobian::Exact => system.jacobian(x, &mut residual, &mut matrix),
                FirstJacobian::Differences => differences(system, x, &mut residual, &mut matrix),
            }
            size_of_residual = norm(&residual);
            Qr::new(matrix.as_ref())
        });
        if !size_of_residual.is_finite() {
            return report(Outcome::Singular, size_of_residual, x, effort);
        }
        if !current.solve(&residual, &mut step) {
            if fresh {
                return report(Outcome::Singular, size_of_residual, x, effort);
            }
            factors = None;
            continue;
        }
        let relative_step = system.relative_size(&step, x);
        let close = relative_step <= settings.tolerance;
        let shortest = if fresh { SHORTEST_STEP } else { SHORTEST_UPDATED_STEP };
        let evaluate = |x: &[f64], out: &mut [f64]| system.value(x, out);
        // At rounding level the residual need not fall any more.
        let accepts = |length, size| close || falls(size, size_of_residual, length);
        if !trial.along(evaluate, [x, &step], [1.0, shortest], accepts) {
            if fresh {
                // What the caller reads from the last evaluation belongs to `x` again.
                system.value(x, &mut residual);
                return report(Outcome::Stalled, size_of_residual, x, effort);
            }
            factors = None;
            continue;
        }
        let contraction = trial.size / size_of_residual.max(f64::MIN_POSITIVE);
        // Steps that shrink by a constant factor c leave c/(1 − c) of the last one.
        let left = relative_step * (contraction / (1.0 - contraction).max(0.1)).min(1.0);
        x.copy_from_slice(&trial.x);
        std::mem::swap(&mut residual, &mut trial.residual);
        size_of_residual = trial.size;
        if close || (trial.length == 1.0 && left <= settings.tolerance) {
            return report(Outcome::Converged, size_of_residual, x, effort);
        }
        if !fresh && contraction > SLOW {
            factors = None;
            continue;
        }
        // The secant error is the residual itself: y − A s = F₊ − (1 − λ) F for s = −λ A⁻¹ F.
        // The divisor is the squared norm of the step, (3.33) corrected.
        let (rest, divisor) = (1.0 - trial.length, -trial.length * norm(&step).powi(2));
        let secant = |(new, old): (&f64, &f64)| (new - rest * old) / divisor;
        let change: Vec<f64> = residual.iter().zip(&trial.residual).map(secant).collect();
        current.update(&change, &step);
        effort.updates += 1;
    }
    let residual = size_of_residual / norm(x).max(f64::MIN_POSITIVE);
    let iterations = settings.max_iterations;
    (Report { outcome: Outcome::Stalled, iterations, residual }, effort)
}
