//! The true maximum of a curve between its grid points.

use super::forced::ForcedBalance;
use super::settings::{Resolution, Settings};
use super::sweep::check_bracket;
use super::unknowns::Unknowns;
use super::Progress;
use crate::fourier::{amplitude, Measure};
use crate::model::Model;
use crate::solve::vertex;
use crate::Error;

/// Width of the final bracket relative to the frequency; the amplitude is stationary there, so
/// that its own error is of second order in it.
const TOLERANCE: f64 = 1e-8;
const GOLDEN: f64 = 0.381_966_011_250_105_1;

/// Maximises the amplitude of one DOF over `[low, high]` [rad/s] from `guess` by Brent's method
/// (golden section and parabolas), every value a solution of its own. Returns the frequency and
/// the amplitude, minus infinity if no point in the bracket converges. When `progress` ends the
/// search, the points after it count as not converged.
///
/// # Errors
/// As for a sweep; a bracket that is not ordered.
pub fn refine_peak(
    model: &Model,
    settings: Settings,
    dof: usize,
    measure: Measure,
    [low, guess, high]: [f64; 3],
    progress: &Progress<'_>,
) -> Result<(f64, f64), Error> {
    check_bracket([low, guess, high])?;
    let observe = [dof];
    let (settings, mut start) = with_one_resolution(model, settings, &observe, [low, high, guess])?;
    let mut balance = ForcedBalance::new(model, settings, &observe)?.watched(progress);
    let mut height = |omega: f64| -> Result<f64, Error> {
        let point = balance.solve(omega, start.as_ref())?;
        if !point.is_solved() {
            return Ok(f64::NEG_INFINITY);
        }
        let table = balance.table(point.harmonics);
        let mut series = vec![0.0; table.harmonics().slots()];
        table.harmonics().write_series(&point.displacement, &mut series);
        start = point.unknowns;
        Ok(amplitude(&table, &series, measure))
    };
    brent(low, guess, high, &mut height)
}

/// Replaces automatic harmonics and samples by the most that are chosen at three frequencies: an
/// amplitude whose order changes from point to point is too rough to maximise. Returns the solution
/// at the last of them too.
fn with_one_resolution(
    model: &Model,
    settings: Settings,
    observe: &[usize],
    omega: [f64; 3],
) -> Result<(Settings, Option<Unknowns>), Error> {
    if !settings.is_automatic() {
        return Ok((settings, None));
    }
    let mut balance = ForcedBalance::new(model, settings, observe)?;
    let (mut finest, mut start) = (Resolution { harmonics: 1, samples: None }, None);
    for frequency in omega {
        let point = balance.solve(frequency, start.as_ref())?;
        finest = finest.or_finer(point.resolution());
        start = point.unknowns;
    }
    Ok((settings.at(finest), start))
}

/// Brent's maximiser without derivatives.
pub(crate) fn brent(
    mut low: f64,
    guess: f64,
    mut high: f64,
    height: &mut impl FnMut(f64) -> Result<f64, Error>,
) -> Result<(f64, f64), Error> {
    let value = height(guess)?;
    let (mut best, mut second, mut third) = ((guess, value), (guess, value), (guess, value));
    let (mut step, mut before_last) = (0.0_f64, 0.0_f64);
    for _ in 0..100 {
        let middle = 0.5 * (low + high);
        let resolution = TOLERANCE * best.0;
        if (best.0 - middle).abs() + 0.5 * (high - low) <= 2.0 * resolution {
            break;
        }
        let parabola = vertex([second, best, third]);
        let accepted = parabola
            .filter(|&p| p > low && p < high && (p - best.0).abs() < 0.5 * before_last.abs());
        before_last = step;
        step = match accepted {
            Some(p) => p - best.0,
            None => {
                let room = if best.0 < middle { high - best.0 } else { low - best.0 };
                before_last = room;
                GOLDEN * room
            }
        };
        let shift = if step.abs() >= resolution { step } else { resolution.copysign(step) };
        let omega = (best.0 + shift).clamp(low, high);
        let trial = (omega, height(omega)?);
        if trial.1 >= best.1 {
            if omega >= best.0 {
                low = best.0
            } else {
                high = best.0
            }
            (third, second, best) = (second, best, trial);
        } else {
            if omega < best.0 {
                low = omega
            } else {
                high = omega
            }
            if trial.1 >= second.1 || second.0 == best.0 {
                (third, second) = (second, trial);
            } else if trial.1 >= third.1 || third.0 == best.0 || third.0 == second.0 {
                third = trial;
            }
        }
    }
    Ok(best)
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn a_smooth_and_a_kinked_maximum_are_found() {
        let mut smooth = |x: f64| Ok(-(x - 1.3_f64).powi(2) + (x - 1.3).powi(3));
        let (x, _) = brent(1.0, 1.1, 1.8, &mut smooth).unwrap();
        assert!((x - 1.3).abs() < 1e-7);
        let mut kinked = |x: f64| Ok(-(x - 1.3_f64).abs());
        let (x, _) = brent(1.0, 1.6, 1.8, &mut kinked).unwrap();
        assert!((x - 1.3).abs() < 1e-7);
        let mut rising = |x: f64| Ok(x);
        let (x, _) = brent(1.0, 1.0, 1.8, &mut rising).unwrap();
        assert!((x - 1.8).abs() < 1e-6);
    }
}
