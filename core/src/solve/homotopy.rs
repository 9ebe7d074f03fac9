//! Homotopy: a hard system reached from an easy one through a scale of its load.

use super::{newton, NewtonSettings, Outcome, Report, System};

/// A system whose load can be scaled; at small scale it is easy.
pub trait Parametrised: System {
    /// Scales the load.
    fn set_scale(&mut self, scale: f64);

    /// A start at the present scale.
    fn easy_start(&self, x: &mut [f64]);
}

/// Scale of the first, easy problem.
const FIRST_SCALE: f64 = 1e-3;
/// First and shortest step of the logarithm of the scale.
const FIRST_STEP: f64 = 0.5;
const SHORTEST_STEP: f64 = 1e-4;

/// Raises the load scale to one, with steps that shrink on failure and grow on success; `x` holds
/// the solution on return. Friction laws are positively homogeneous, so that a solution scaled
/// with the load is a good prediction.
pub fn homotopy(
    system: &mut impl Parametrised,
    x: &mut [f64],
    settings: NewtonSettings,
) -> Report {
    let mut logarithm = FIRST_SCALE.ln();
    let mut step = FIRST_STEP;
    system.set_scale(FIRST_SCALE);
    system.easy_start(x);
    let mut report = newton(system, x, settings);
    let mut iterations = report.iterations;
    let mut trial = x.to_vec();
    while report.outcome == Outcome::Converged && logarithm < 0.0 {
        let next = (logarithm + step).min(0.0);
        let growth = (next - logarithm).exp();
        trial.iter_mut().zip(x.iter()).for_each(|(t, x)| *t = growth * x);
        system.set_scale(next.exp());
        let attempt = newton(system, &mut trial, settings);
        iterations += attempt.iterations;
        if attempt.outcome == Outcome::Converged {
            x.copy_from_slice(&trial);
            logarithm = next;
            step *= 1.5;
            report = attempt;
        } else {
            step *= 0.5;
            if step < SHORTEST_STEP {
                report = attempt;
            }
        }
    }
    system.set_scale(1.0);
    Report { iterations, ..report }
}
