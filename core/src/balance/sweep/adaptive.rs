//! A curve over a range of frequencies, with steps chosen to the tolerance.

use super::branches::sweep_branches;
use super::given::finish;
use super::stops::{stops, LONGEST};
use crate::balance::condensed::Condensed;
use crate::balance::forced::ForcedBalance;
use crate::balance::keep;
use crate::balance::solution::{Point, PointStatus, Solution};
use crate::balance::unknowns::Unknowns;
use crate::solve::System as _;
use crate::Error;
use std::sync::Arc;
use std::time::Instant;

/// Shortest step relative to the frequency.
const SHORTEST: f64 = 1e-7;
/// Distance, relative to the frequency, at which a step passes an undamped resonance.
const ASIDE: f64 = 1e-8;

/// Solves from `from` to `to` [rad/s], in either direction, with steps such that straight lines
/// between the points stay within the tolerance of the curve.
///
/// Steps follow the curvature of the observed DOFs, which a narrow resonance between two points
/// could hide; so each resonance in the range, in whatever state of the contacts, is a point, and
/// steps behind it start at its bandwidth.
///
/// Where contact laws are not monotone the curve is followed by arclength, and its frequency may turn
/// back.
///
/// # Errors
/// As for a sweep over given frequencies; a range of no length.
pub fn sweep_range(mut balance: ForcedBalance<'_>, from: f64, to: f64) -> Result<Solution, Error> {
    let start = Instant::now();
    Error::check_frequency("omega range: start", from)?;
    Error::check_frequency("omega range: end", to)?;
    if from == to {
        return Err(Error::value("omega range: end", to, "must differ from its start"));
    }
    let direction = (to - from).signum();
    let longest = LONGEST * (to - from).abs();
    if !balance.model.is_monotone() {
        return sweep_branches(balance, (from, to));
    }
    let mut points = vec![Arc::new(balance.solve(from, None)?)];
    balance.scale.include(&points[0]);
    keep(balance.kept, &points[0]);
    // What lies outside the range may be narrow, too.
    let fine = balance.model.compliance().narrowest_bandwidth().max(1e-6 * longest);
    let mut step = fine.min(0.1 * longest);
    let mut interrupted = false;
    for (stop, bandwidth) in stops(&mut balance, &points[0], from, to)? {
        if interrupted {
            break;
        }
        while (stop - points[points.len() - 1].omega) * direction > 0.0 {
            let last = &points[points.len() - 1];
            if !balance.report((last.omega - from) / (to - from)) {
                interrupted = true;
                break;
            }
            let room = (stop - last.omega).abs();
            // Two even steps instead of a long and a tiny one.
            let length =
                if step >= room { room } else { step.min(0.5 * room).max(SHORTEST * last.omega) };
            let omega = if step >= room { stop } else { last.omega + direction * length };
            let guess = tangent(&mut balance, last, omega);
            let point = balance.solve_beside(omega, direction * ASIDE * omega, guess.as_ref())?;
            if point.status == PointStatus::NotComputed {
                interrupted = true;
                break;
            }
            let target = balance.settings.tolerance;
            // Nothing is known of the bend at the start, where the step stays, nor behind a point
            // that is not solved, where it grows to get past.
            let unknown = if point.is_solved() { 0.81 * target } else { 0.0 };
            let error = line_error(&balance, &points, &point).unwrap_or(unknown);
            let factor = (0.9 * (target / error.max(1e-12)).sqrt()).clamp(0.3, 2.0);
            let too_long = error > 2.0 * target && length > 1.5 * SHORTEST * omega;
            step = (length * factor).min(longest);
            if !too_long {
                if point.is_solved() {
                    balance.scale.include(&point);
                }
                let point = Arc::new(point);
                keep(balance.kept, &point);
                points.push(point);
            }
        }
        step = step.min(bandwidth.max(1e-6 * longest));
    }
    Ok(finish(balance, points, interrupted, start))
}

/// Extrapolation along the tangent `dU/dω = J⁻¹ (dU^stuck/dω + dG/dω Q)`.
fn tangent(balance: &mut ForcedBalance<'_>, last: &Point, omega: f64) -> Option<Unknowns> {
    if !last.is_solved() {
        return None;
    }
    let unknowns = last.unknowns.as_ref()?;
    let table = balance.table(unknowns.harmonics.highest());
    let residual = balance.settings.residual;
    let model = balance.evaluated(last.samples).ok()?;
    let mut equations = Condensed::new(model, &table, residual, true);
    equations.set_omega(last.omega).ok()?;
    let (mut ignored, mut rate) = (vec![0.0; equations.size()], vec![0.0; equations.size()]);
    equations.residual(&unknowns.values, &mut ignored);
    let frequency_rate = equations.frequency_rate();
    let solved = equations.solve(&frequency_rate, &mut rate);
    balance.add_profile(&equations.profile);
    if !solved {
        return Some(unknowns.clone());
    }
    let mut predicted = unknowns.clone();
    for (value, rate) in predicted.values.iter_mut().zip(&rate) {
        *value += (omega - last.omega) * rate;
    }
    Some(predicted)
}

/// Largest relative distance of the observed DOFs from a straight line between the last point
/// and `new`, from the curvature through the last three points.
fn line_error(balance: &ForcedBalance<'_>, points: &[Arc<Point>], new: &Point) -> Option<f64> {
    let [.., before, last] = points else { return None };
    let (before, last): (&Point, &Point) = (before, last);
    if ![before, last, new].into_iter().all(Point::is_solved) {
        return None;
    }
    let steps = [last.omega - before.omega, new.omega - last.omega];
    Some(balance.scale.of_line([before, last, new], steps))
}
