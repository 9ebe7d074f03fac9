//! The single-harmonic balance (Griffin 1980; Guillen 1999, chapter II, corrected): complex
//! describing functions instead of series, for any number of dampers.
//!
//! Printed, (2.40)-(2.43) drop the relative phases of the dampers. With complex amplitudes
//! `sum_j m_ij X_j + k_i (a_i − i b_i) X_i/A_i = r_i` keeps them. As everywhere it is condensed
//! onto the stuck structure: `U = U^stuck + G Q`, `Q_i = (k_i − K_i(|U_i|)) U_i`.

use super::attempts::is_bounded;
use super::condensed::Condensed;
use super::evaluation::Evaluated;
use super::forced::ForcedBalance;
use super::solution::{Point, PointStatus, Solution};
use super::sweep::sweep_with;
use super::unknowns::Unknowns;
use crate::contact::{ContactLaw, Described};
use crate::fourier::{Harmonics, SampleTable};
use crate::solve::{newton, Outcome, Report, System as _};
use crate::Error;
use std::sync::Arc;
use std::time::Instant;

/// Solves at the frequencies `omega` [rad/s] in the order given, from a balance of one harmonic.
/// Without `estimate` the error estimates, which take most of the time, are not-a-number.
///
/// # Errors
/// As for a sweep; a force of another harmonic than the first, or a contact whose law has no
/// describing function.
pub fn single_harmonic(
    balance: ForcedBalance<'_>,
    omega: &[f64],
    estimate: bool,
) -> Result<Solution, Error> {
    let model = balance.model.clone();
    if let Some(other) = model.compliance().forced_harmonics().into_iter().find(|&k| k != 1) {
        let remedy = "the single-harmonic method takes forces of harmonic 1 alone; balance several harmonics instead";
        return Err(Error::value("force: harmonic", other as f64, remedy));
    }
    let mut laws: Vec<Box<dyn ContactLaw>> = Vec::with_capacity(model.laws().len());
    for (index, law) in model.laws().iter().enumerate() {
        let described = Described::new(law.with_scaled_forces(1.0)).ok_or_else(|| {
            Error::shape(
                &format!("contact {}", index + 1),
                "a law with a describing function",
                format!("{}, which has none; balance several harmonics instead", law.name()),
            )
        })?;
        laws.push(Box::new(described));
    }
    let described = Evaluated::Made(Arc::new(model.with_laws(laws)?));
    let table = SampleTable::new(Harmonics::new(1, true));
    let residual = balance.settings.residual;
    let mut equations = Condensed::new(described, &table, residual, false);
    sweep_with(balance, omega, |balance, omega, start| {
        let point = solve(&mut equations, balance, omega, start, estimate);
        balance.add_profile(&std::mem::take(&mut equations.profile));
        point
    })
}

fn solve(
    equations: &mut Condensed<'_>,
    balance: &mut ForcedBalance<'_>,
    omega: f64,
    start: Option<&Unknowns>,
    estimate: bool,
) -> Result<Point, Error> {
    let harmonics = equations.harmonics();
    let mut x = Vec::new();
    let report = equations.set_omega(omega).is_ok().then(|| {
        let stuck = || equations.stuck_response().to_vec();
        x = start.map_or_else(stuck, |start| start.recast(harmonics));
        newton(equations, &mut x, balance.settings.newton)
    });
    let solved = |report: &Report| {
        let bounded = is_bounded(&x, equations.stuck_response());
        report.outcome == Outcome::Converged && balance.is_balanced(report.residual) && bounded
    };
    let Some(report) = report.filter(solved) else {
        // The same equations with homotopy at hand, or the word for why there is no solution.
        let mut point = balance.solve(omega, start)?;
        if !estimate {
            point.error_estimate.fill(f64::NAN);
        }
        return Ok(point);
    };
    let begin = Instant::now();
    // The describing functions at the solution, and not where the last Jacobian was.
    equations.residual(&x, &mut vec![0.0; x.len()]);
    let mut point = equations.recover(&x, balance.observe, PointStatus::Converged)?;
    (point.residual, point.iterations) = (report.residual, report.iterations);
    balance.profile.recovery += begin.elapsed();
    if estimate {
        let begin = Instant::now();
        let done = balance.estimate_truncation(harmonics, &x, None, &mut point, &[])?;
        balance.profile.estimate += begin.elapsed();
        if !done {
            return Ok(balance.not_computed(omega));
        }
    }
    point.unknowns = Some(Unknowns { harmonics: harmonics.clone(), values: x });
    Ok(point)
}
