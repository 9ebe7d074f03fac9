//! A curve over given frequencies.

use super::forced::ForcedBalance;
use super::solution::{Point, PointStatus, Solution};
use super::unknowns::Unknowns;
use crate::timing::Profile;
use crate::Error;
use std::time::Instant;

/// Solves at the frequencies `omega` [rad/s] in the order given, each from an extrapolation of
/// the points before it.
///
/// # Errors
/// A frequency that is not positive, or one at which the loads excite an undamped resonance.
pub fn sweep(balance: ForcedBalance<'_>, omega: &[f64]) -> Result<Solution, Error> {
    sweep_with(balance, omega, ForcedBalance::solve)
}

/// A sweep whose points `solve` finds, from a frequency and a start.
pub(super) fn sweep_with<'a>(
    mut balance: ForcedBalance<'a>,
    omega: &[f64],
    mut solve: impl FnMut(&mut ForcedBalance<'a>, f64, Option<&Unknowns>) -> Result<Point, Error>,
) -> Result<Solution, Error> {
    let start = Instant::now();
    for (index, &frequency) in omega.iter().enumerate() {
        check_frequency(&format!("omega[{index}]"), frequency)?;
    }
    let contacts = balance.model.compliance().contacts();
    let mut points: Vec<Point> = Vec::with_capacity(omega.len());
    let mut interrupted = false;
    for &frequency in omega {
        let share = points.len() as f64 / omega.len() as f64;
        interrupted = interrupted || !balance.report(share);
        if interrupted {
            let (status, observed) = (PointStatus::NotComputed, balance.observe.len());
            points.push(Point::empty(frequency, status, observed, contacts));
            continue;
        }
        let guess = predict(&points, frequency);
        let point = solve(&mut balance, frequency, guess.as_ref())?;
        interrupted = point.status == PointStatus::NotComputed;
        points.push(point);
    }
    Ok(finish(balance, points, interrupted, start))
}

pub(crate) fn check_frequency(entry: &str, omega: f64) -> Result<(), Error> {
    // Squares of frequencies must stay finite.
    if omega > 0.0 && omega < 1e100 {
        return Ok(());
    }
    Err(Error::value(entry, omega, "must be a finite, positive angular frequency in rad/s"))
}

pub(super) fn finish(
    balance: ForcedBalance<'_>,
    points: Vec<Point>,
    interrupted: bool,
    start: Instant,
) -> Solution {
    Solution {
        points,
        half_wave: balance.half_wave(),
        interrupted,
        profile: Profile { total: start.elapsed(), ..balance.profile },
    }
}

/// Linear extrapolation from the last two points, if both converged, else the last one.
fn predict(points: &[Point], omega: f64) -> Option<Unknowns> {
    let usable = |point: &&Point| {
        matches!(point.status, PointStatus::Converged | PointStatus::HarmonicsLimit)
    };
    let last = points.last().filter(usable)?;
    let unknowns = last.unknowns.as_ref()?;
    let before = points.iter().rev().nth(1).filter(usable);
    let Some((before, earlier)) = before.and_then(|p| Some((p, p.unknowns.as_ref()?))) else {
        return Some(unknowns.clone());
    };
    let ratio = (omega - last.omega) / (last.omega - before.omega);
    // Far beyond the last interval, or on a repeated frequency, a line predicts nothing.
    if !ratio.is_finite() || ratio.abs() > 3.0 {
        return Some(unknowns.clone());
    }
    let mut predicted = unknowns.clone();
    let earlier = earlier.recast(&unknowns.harmonics);
    for (value, earlier) in predicted.values.iter_mut().zip(&earlier) {
        *value += ratio * (*value - earlier);
    }
    Some(predicted)
}
