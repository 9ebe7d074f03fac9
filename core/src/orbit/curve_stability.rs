//! The stability of the points of a forced curve.

use super::period_map::{Multipliers, PeriodMap};
use crate::balance::{
    with_history, ForcedBalance, HarmonicChoice, Point, Progress, Settings, Solution,
};
use crate::contact::Residual;
use crate::model::Model;
use crate::parallel::in_parts;
use crate::Error;
use std::sync::Arc;
use std::time::Instant;

/// Change of a multiplier over the relative error of the motion: measured, 5 to 20, …
const SENSITIVITY: f64 = 30.0;
/// … and beyond 150 where contacts bounce: when they touch is less certain than how far they move.
const BOUNCING: f64 = 300.0;

/// Work that the solution with more harmonics than the tolerance asks for may take, as reckoned \[ns\].
const OF_VERDICT: f64 = 1e9;

/// Times that the number of harmonics is doubled, as long as the last doubling leaves it open.
const DOUBLINGS: usize = 3;

/// Decides the stability of the points of a curve, as far as the map over a period tells it; those of a
/// travelling wave stay undecided. `settings` are those of its balance.
///
/// Where the harmonics left out could take the largest multiplier to the other side of 1, the point is
/// solved with about twice as many, and again: it is decided once they change the multiplier by less than its
/// distance from 1. So is every point that seems unstable: a contact that nearly grazes its limit may slip in the
/// motion of few harmonics alone. Points are judged at the same time, each by itself. An analysis that is
/// ended leaves those undecided that it has not come to.
///
/// # Errors
/// As [`PeriodMap::new`], but for a wave.
pub fn decide_stability(
    model: &Model,
    settings: Settings,
    solution: &mut Solution,
    progress: &Progress<'_>,
) -> Result<(), Error> {
    if model.is_travelling_wave() {
        return Ok(());
    }
    let residual = settings.residual;
    let history = match residual {
        Residual::FromRest => with_history(model)?,
        Residual::Centred | Residual::Value(_) => None,
    };
    let start = Instant::now();
    let map = PeriodMap::new(history.as_ref().unwrap_or(model))?.assuming(residual);
    let points = &solution.points;
    let found = in_parts(points.len(), progress, |index, progress| {
        let point = points.get(index).filter(|point| point.is_solved() && progress(0.0))?;
        let found = along(&map, point)?;
        let sensitivity = if bounces(model, point) { BOUNCING } else { SENSITIVITY };
        let allowed = (found.largest() - 1.0).abs() / sensitivity;
        let is_clear = relative_error(point) < allowed
            && (found.stable() != Some(true)
                || contact_error(model, settings, point, progress) < allowed);
        let mut stable = found.stable().filter(|_| is_clear);
        if stable == Some(true) {
            return Some(stable);
        }
        let (mut coarse, mut of_coarse) = (point.clone(), found);
        for _ in 0..DOUBLINGS {
            let Some(finer) = with_more_harmonics(model, settings, &coarse, progress) else {
                break;
            };
            let of_finer = along(&map, &finer)?;
            stable = decided(&of_coarse, &of_finer);
            if stable.is_some() {
                break;
            }
            (coarse, of_coarse) = (Arc::new(finer), of_finer);
        }
        progress(0.0).then_some(stable)
    });
    let taken = start.elapsed();
    solution.profile.stability += taken;
    solution.profile.total += taken;
    solution.interrupted |= !progress(1.0);
    for (point, stable) in solution.points.iter_mut().zip(found) {
        if let Some(stable) = stable {
            Arc::make_mut(point).stable = stable;
        }
    }
    Ok(())
}

/// Whether contacts are open for a part of the period.
fn bounces(model: &Model, point: &Point) -> bool {
    let open = |place: usize| point.contacts.get(place).map_or(0.0, |one| one.slip_fraction);
    model.laws().iter().zip(model.points()).any(|(law, points)| {
        // A spring has no friction to tell of.
        let is_spring = law.state_size() == 0;
        let normal = points.clone().last().map_or(0.0, open);
        !law.is_odd() && (is_spring || (normal > 0.0 && normal < 1.0))
    })
}

/// What the estimate gives of the largest vibration of the observed DOFs; nothing without an estimate.
fn relative_error(point: &Point) -> f64 {
    let largest = |values: &mut dyn Iterator<Item = f64>| values.fold(0.0, f64::max);
    let error = largest(&mut point.error_estimate.iter().copied());
    let series = point.displacement.chunks_exact(point.harmonics + 1);
    let vibration = largest(&mut series.map(|row| row[1..].iter().map(|x| x.norm()).sum()));
    if error > 0.0 {
        error / vibration
    } else {
        0.0
    }
}

/// What the estimate gives of the contacts, which the observed DOFs may not feel; infinite without one.
fn contact_error(model: &Model, settings: Settings, point: &Point, progress: &Progress<'_>) -> f64 {
    let balance = ForcedBalance::new(model, settings, &[]);
    let error = balance.ok().and_then(|balance| balance.watched(progress).contact_error(point));
    error.unwrap_or(f64::INFINITY)
}

/// The point with about twice as many harmonics; nothing if it cannot be solved.
fn with_more_harmonics(
    model: &Model,
    settings: Settings,
    point: &Point,
    progress: &Progress<'_>,
) -> Option<Point> {
    let finer = Settings { harmonics: HarmonicChoice::Fixed(2 * point.harmonics + 1), ..settings };
    let mut balance = ForcedBalance::new(model, finer, &[]).ok()?.watched(progress);
    if settings.harmonics == HarmonicChoice::Auto {
        balance = balance.granting(OF_VERDICT);
    }
    let solved = balance.solve(point.omega, point.unknowns()).ok()?;
    solved.is_solved().then_some(solved)
}

fn along(map: &PeriodMap, point: &Point) -> Option<Multipliers> {
    map.multipliers(point.omega, point.unknowns()?, None)
}

/// The verdict of better multipliers, if they differ less from the others than from 1.
fn decided(found: &Multipliers, finer: &Multipliers) -> Option<bool> {
    let change = (finer.largest() - found.largest()).abs();
    finer.stable().filter(|_| (finer.largest() - 1.0).abs() > change)
}
