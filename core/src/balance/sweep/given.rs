//! A curve over given frequencies.

use crate::balance::forced::ForcedBalance;
use crate::balance::solution::{CurveEnd, Point, PointStatus, Solution};
use crate::balance::unknowns::Unknowns;
use crate::balance::{keep, Kept};
use crate::solve::{extrapolated, LOOK_BACK};
use crate::timing::Profile;
use crate::Error;
use std::sync::Arc;
use std::time::Instant;

/// Solves at the frequencies `omega` [rad/s] in the order given, each from an extrapolation of
/// the points before it; the first from what the balance is begun with, or from nothing.
///
/// # Errors
/// A frequency that is not positive, or one at which the loads excite an undamped resonance.
pub fn sweep(balance: ForcedBalance<'_>, omega: &[f64]) -> Result<Solution, Error> {
    sweep_with(balance, omega, ForcedBalance::solve)
}

/// A sweep whose points `solve` finds, from a frequency and a start.
pub(crate) fn sweep_with<'a>(
    mut balance: ForcedBalance<'a>,
    omega: &[f64],
    mut solve: impl FnMut(&mut ForcedBalance<'a>, f64, Option<&Unknowns>) -> Result<Point, Error>,
) -> Result<Solution, Error> {
    let start = Instant::now();
    let kept = balance.kept;
    let (mut points, interrupted) = over_frequencies(
        &mut balance,
        omega,
        kept,
        ForcedBalance::report,
        |balance, points, frequency| {
            let guess = predict(points, frequency).or_else(|| balance.start.take());
            let before = balance.profile.work;
            let mut point = solve(balance, frequency, guess.as_ref())?;
            let misled = points.is_empty() && guess.is_some() && !point.is_solved();
            if misled && point.status != PointStatus::NotComputed {
                point = solve(balance, frequency, None)?;
            }
            balance.earn_looks(before);
            if let Some(last) = points.last().filter(|_| !balance.model.is_monotone()) {
                balance.stay_on_branch(last, guess.as_ref(), &mut point)?;
            }
            Ok(Some(point).filter(|point| point.status != PointStatus::NotComputed))
        },
    )?;
    if points.is_empty() {
        points.extend(omega.first().map(|&first| Arc::new(balance.not_computed(first))));
    }
    Ok(finish(balance, points, interrupted, start))
}

/// Points at the frequencies `omega` [rad/s] in the order given, each found from those before it by
/// `find`, and whether the analysis was ended: `report` says so before a point, nothing found says so
/// at it.
pub(crate) fn over_frequencies<A, P>(
    analysis: &mut A,
    omega: &[f64],
    kept: Option<&Kept<P>>,
    report: impl Fn(&mut A, f64) -> bool,
    mut find: impl FnMut(&mut A, &[Arc<P>], f64) -> Result<Option<P>, Error>,
) -> Result<(Vec<Arc<P>>, bool), Error> {
    check_frequencies(omega)?;
    let mut points: Vec<Arc<P>> = Vec::new();
    for (index, &frequency) in omega.iter().enumerate() {
        if !report(analysis, index as f64 / omega.len() as f64) {
            return Ok((points, true));
        }
        let Some(point) = find(analysis, &points, frequency)? else { return Ok((points, true)) };
        let point = Arc::new(point);
        keep(kept, &point);
        points.push(point);
    }
    Ok((points, false))
}

/// Checks all frequencies of a sweep.
pub(crate) fn check_frequencies(omega: &[f64]) -> Result<(), Error> {
    let check = |(index, &one)| Error::check_frequency(&format!("omega[{index}]"), one);
    omega.iter().enumerate().try_for_each(check)
}

pub(super) fn finish(
    balance: ForcedBalance<'_>,
    points: Vec<Arc<Point>>,
    interrupted: bool,
    start: Instant,
) -> Solution {
    Solution {
        points,
        half_wave: balance.half_wave(),
        interrupted,
        end: if interrupted { CurveEnd::Interrupted } else { CurveEnd::Range },
        cut: 0,
        profile: Profile { total: start.elapsed(), ..balance.profile },
    }
}

/// What the last points that converged lead to.
fn predict(points: &[Arc<Point>], omega: f64) -> Option<Unknowns> {
    let usable = |point: &&Arc<Point>| point.is_solved();
    let last = points.last().filter(usable)?.unknowns.as_ref()?;
    let known: Vec<(f64, Vec<f64>)> = points
        .iter()
        .rev()
        .take(LOOK_BACK)
        .take_while(usable)
        .map_while(|p| Some((p.omega, p.unknowns.as_ref()?.recast(&last.harmonics))))
        .collect();
    let values = extrapolated(&known, omega)?;
    Some(Unknowns { harmonics: last.harmonics.clone(), values })
}

#[cfg(test)]
mod tests {
    #![allow(clippy::unwrap_used)]

    use super::*;
    use crate::balance::{HarmonicChoice, Settings};
    use crate::contact::Jenkins;
    use crate::fourier::Harmonics;
    use crate::model::{Contact, Model};
    use crate::structure::{HarmonicLoad, Structure};
    use faer::{c64, mat};

    fn damped() -> Model {
        let [mass, damping, stiffness] = [1.0, 0.1, 4.0].map(|value| mat![[value]]);
        let structure = Structure::new(mass.as_ref(), damping.as_ref(), stiffness.as_ref());
        let law = Box::new(Jenkins::new(1.0, 0.4).unwrap());
        let load = HarmonicLoad { harmonic: 1, amplitude: vec![c64::new(1.0, 0.0)] };
        Model::new(structure.unwrap(), vec![Contact { law, rows: mat![[1.0]] }], vec![load])
            .unwrap()
    }

    fn balance(model: &Model, start: Option<Unknowns>) -> ForcedBalance<'_> {
        let settings = Settings { harmonics: HarmonicChoice::Fixed(7), ..Settings::default() };
        ForcedBalance::new(model, settings, &[0]).unwrap().begun_with(start)
    }

    /// A motion begins the first point alone, in whatever harmonics it is known.
    #[test]
    fn a_sweep_begins_with_the_motion_that_is_known() {
        let model = damped();
        let cold = sweep(balance(&model, None), &[2.1, 2.15]).unwrap();
        let known = cold.points[0].unknowns().unwrap();
        let harmonics = Harmonics::new(9, false);
        let start = Unknowns { values: known.recast(&harmonics), harmonics };
        let mut starts = Vec::new();
        let warm = sweep_with(balance(&model, Some(start)), &[2.1, 2.15], |own, omega, start| {
            starts.push(start.cloned());
            own.solve(omega, start)
        });
        let warm = warm.unwrap();
        assert!(cold.points[0].iterations > 2 && warm.points[0].iterations <= 1);
        assert!(starts.iter().all(Option::is_some));
        for (one, other) in cold.points.iter().zip(&warm.points) {
            assert!((one.displacement[1] - other.displacement[1]).norm() < 1e-9);
        }
    }

    /// A motion that leads nowhere is forgotten.
    #[test]
    fn a_motion_that_misleads_is_no_start() {
        let model = damped();
        let start = Unknowns::new(Harmonics::new(1, true), vec![1.0, 0.0]);
        let found = sweep_with(balance(&model, Some(start)), &[2.1], |own, omega, start| {
            let point = own.solve(omega, start)?;
            let status = if start.is_some() { PointStatus::Stalled } else { point.status };
            Ok(Point { status, ..point })
        });
        assert_eq!(found.unwrap().points[0].status, PointStatus::Converged);
    }
}
