//! Homotopy: a hard system reached from an easy one through the scale of a parameter.

use super::{newton, NewtonSettings, Outcome, Report, System};

/// A system with a positive parameter that makes it easy when small; one is the problem itself.
pub trait Parametrised: System {
    /// Sets the parameter.
    fn set_scale(&mut self, scale: f64);

    /// Replaces `x` by a start at the present, small parameter, if it knows a better one.
    fn easy_start(&self, x: &mut [f64]);

    /// Whether the last failure was of a kind that lies on every way to the problem.
    fn is_lost(&self) -> bool {
        false
    }

    /// Predicts the solution after the parameter has grown by the factor `growth`.
    fn predict(&self, growth: f64, x: &mut [f64]);
}

/// Parameters at which a first solution is tried, one after the other.
const FIRST_SCALES: [f64; 4] = [1e-1, 1e-2, 1e-3, 1e-5];
/// First and shortest step of the logarithm of the parameter.
const FIRST_STEP: f64 = 0.5;
const SHORTEST_STEP: f64 = 1e-4;

/// Finds an easy solution and follows it to the problem itself, with steps that shrink on failure
/// and grow on success, in up to `budget` Newton iterations. `x` is a start and, on return, the solution.
pub fn homotopy(
    system: &mut impl Parametrised,
    x: &mut [f64],
    settings: NewtonSettings,
    budget: usize,
) -> Report {
    let mut iterations = 0;
    let mut trial = x.to_vec();
    let mut easy = None;
    for scale in FIRST_SCALES {
        system.set_scale(scale);
        trial.copy_from_slice(x);
        system.easy_start(&mut trial);
        let report = newton(system, &mut trial, settings);
        iterations += report.iterations;
        match report.outcome {
            Outcome::Converged => {
                easy = Some((scale.ln(), report));
                break;
            }
            Outcome::Interrupted => break,
            _ if system.is_spent() => break,
            _ => {}
        }
    }
    let Some((mut logarithm, mut report)) = easy else {
        system.set_scale(1.0);
        let outcome = if system.interrupted() { Outcome::Interrupted } else { Outcome::Stalled };
        return Report { outcome, iterations, residual: f64::NAN };
    };
    x.copy_from_slice(&trial);
    let mut step = FIRST_STEP;
    while logarithm < 0.0 && step >= SHORTEST_STEP && iterations < budget {
        let next = (logarithm + step).min(0.0);
        trial.copy_from_slice(x);
        system.predict((next - logarithm).exp(), &mut trial);
        system.set_scale(next.exp());
        report = newton(system, &mut trial, settings);
        iterations += report.iterations;
        if report.outcome == Outcome::Converged {
            x.copy_from_slice(&trial);
            logarithm = next;
            step *= 1.5;
        } else if report.outcome == Outcome::Interrupted || system.is_lost() || system.is_spent() {
            break;
        } else {
            step *= 0.5;
        }
    }
    system.set_scale(1.0);
    if logarithm < 0.0 && report.outcome == Outcome::Converged {
        report.outcome = Outcome::Stalled;
    }
    Report { iterations, ..report }
}
