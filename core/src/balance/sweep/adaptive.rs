//! A curve over a range of frequencies, with steps chosen to the tolerance.

use super::branches::sweep_branches;
use super::course::Course;
use super::given::finish;
use super::seams::expected_step;
use super::stops::SHORTEST;
use crate::balance::condensed::Condensed;
use crate::balance::forced::ForcedBalance;
use crate::balance::keep;
use crate::balance::solution::{Point, PointStatus, Solution};
use crate::balance::unknowns::Unknowns;
use crate::solve::System as _;
use crate::Error;
use std::sync::Arc;
use std::time::Instant;

/// Distance of a straight line, in tolerances, up to which a step is good enough; …
const FARTHEST: f64 = 2.0;
/// … and up to which it is left alone if the point behind it shows the distance.
const SEEN_BEHIND: f64 = 1.5;
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
    check_range((from, to))?;
    if !balance.model.is_monotone() {
        return sweep_branches(balance, (from, to));
    }
    let first = Arc::new(balance.solve(from, None)?);
    let course = Course::new(&mut balance, std::slice::from_ref(&first), (from, to))?;
    let (points, interrupted) = smooth_piece(&mut balance, &course, first, None)?;
    Ok(finish(balance, points, interrupted, start))
}

/// Refuses a range of no length, or of frequencies that are not positive.
pub(crate) fn check_range((from, to): (f64, f64)) -> Result<(), Error> {
    Error::check_frequency("omega range: start", from)?;
    Error::check_frequency("omega range: end", to)?;
    if from == to {
        return Err(Error::value("omega range: end", to, "must differ from its start"));
    }
    Ok(())
}

/// The point of a seam, which starts from nothing.
///
/// # Errors
/// As for a solution at one frequency.
pub(crate) fn seam(balance: &mut ForcedBalance<'_>, omega: f64) -> Result<Point, Error> {
    balance.solve_beside(omega, ASIDE * omega, None)
}

/// The part of a curve from a point of it to another one, its last, or to the end of its range; whether it
/// was ended early.
///
/// # Errors
/// As for a solution at one frequency.
pub(crate) fn smooth_piece(
    balance: &mut ForcedBalance<'_>,
    course: &Course,
    first: Arc<Point>,
    last: Option<&Arc<Point>>,
) -> Result<(Vec<Arc<Point>>, bool), Error> {
    course.lead(balance);
    let ((from, to), longest) = (course.range, course.longest());
    let direction = (to - from).signum();
    let begin = first.omega;
    let end = last.map_or(to, |last| last.omega);
    keep(balance.kept, &first);
    // So many points are final: what lies inside the last step the point behind it shows.
    let (mut points, mut kept) = (vec![first], 1);
    let mut interrupted = false;
    // What lies outside the range may be narrow, too.
    let fine = balance.model.compliance().narrowest_bandwidth().max(1e-6 * longest);
    let mut step = if begin == from {
        fine.min(0.1 * longest)
    } else {
        expected_step(&course.stops, balance.settings.tolerance, longest, begin)
    };
    let stops: Vec<(f64, f64)> = course.between(begin, end).collect();
    let mut passed = 0;
    while let Some(&(stop, _)) = stops.get(passed) {
        let known = &points[points.len() - 1];
        if !balance.report((known.omega - begin) / (end - begin)) {
            interrupted = true;
            break;
        }
        let room = (stop - known.omega).abs();
        // Two even steps instead of a long and a tiny one.
        let part = step.min(0.5 * room).max(SHORTEST * known.omega);
        let length = if step >= room { room } else { part.min(room) };
        let omega = if length < room { known.omega + direction * length } else { stop };
        let point = match last.filter(|last| last.omega == omega) {
            Some(last) => Point::clone(last),
            None => {
                let guess = tangent(balance, known, omega);
                balance.solve_beside(omega, direction * ASIDE * omega, guess.as_ref())?
            }
        };
        if point.status == PointStatus::NotComputed {
            interrupted = true;
            break;
        }
        let target = balance.settings.tolerance;
        // Nothing is known of the bend at the start, where the step stays, nor behind a point
        // that is not solved, where it grows to get past.
        let unknown = if point.is_solved() { 0.81 * target } else { 0.0 };
        let bent = match &points[..] {
            [.., before, last] => line_error(balance, [before, last, &point]),
            _ => None,
        };
        let error = bent.unwrap_or(unknown);
        let factor = (0.9 * (target / error.max(1e-12)).sqrt()).clamp(0.3, 2.0);
        let too_long = error > FARTHEST * target && length > 1.5 * SHORTEST * omega;
        step = (length * factor).min(longest);
        if too_long {
            continue;
        }
        if point.is_solved() {
            balance.scale.include(&point);
        }
        let here = point.omega;
        let inside = inside(balance, &points, &point)?;
        if inside.iter().any(|one| one.status == PointStatus::NotComputed) {
            interrupted = true;
            break;
        }
        let last = points.len() - 1;
        points.splice(last..last, inside);
        points.push(Arc::new(point));
        points[kept..points.len() - 1].iter().for_each(|one| keep(balance.kept, one));
        kept = points.len() - 1;
        while let Some((_, bandwidth)) =
            stops.get(passed).filter(|s| (s.0 - here) * direction <= 0.0)
        {
            step = step.min(bandwidth.max(1e-6 * longest));
            passed += 1;
        }
    }
    if interrupted {
        points.truncate(kept);
    }
    points[kept..].iter().for_each(|one| keep(balance.kept, one));
    Ok((points, interrupted))
}

/// Points inside the last step, where the point behind it shows that a straight line is too far off: slip that
/// begins makes a kink, which a step may end at before its curvature is seen.
///
/// # Errors
/// As for a solution at one frequency.
fn inside(
    balance: &mut ForcedBalance<'_>,
    points: &[Arc<Point>],
    new: &Point,
) -> Result<Vec<Arc<Point>>, Error> {
    let mut found: Vec<Arc<Point>> = Vec::new();
    let [.., before, last] = points else { return Ok(found) };
    let step = last.omega - before.omega;
    // The same line from its other end.
    let seen = line_error(balance, [new, last, before]).unwrap_or(0.0);
    if seen <= SEEN_BEHIND * balance.settings.tolerance {
        return Ok(found);
    }
    let mut lines = vec![(Arc::clone(before), Arc::clone(last))];
    while let Some((from, to)) = lines.pop() {
        let omega = 0.5 * (from.omega + to.omega);
        let guess = tangent(balance, &from, omega);
        let point =
            Arc::new(balance.solve_beside(omega, ASIDE * omega * step.signum(), guess.as_ref())?);
        found.push(Arc::clone(&point));
        if point.status == PointStatus::NotComputed {
            return Ok(found);
        }
        if point.is_solved() {
            balance.scale.include(&point);
        }
        // The curvature tells what half the step would miss, a quarter of what is missed.
        let missed = 4.0 * line_error(balance, [&from, &point, &to]).unwrap_or(0.0);
        if missed > FARTHEST * balance.settings.tolerance
            && (omega - from.omega).abs() > SHORTEST * omega
        {
            lines.push((Arc::clone(&point), to));
            lines.push((from, point));
        }
    }
    found.sort_by(|a, b| (a.omega * step.signum()).total_cmp(&(b.omega * step.signum())));
    Ok(found)
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

/// Largest relative distance of the observed DOFs from a straight line between the last two of three points,
/// from the curvature through all of them; none if one is not solved.
fn line_error(balance: &ForcedBalance<'_>, points: [&Point; 3]) -> Option<f64> {
    let [before, last, new] = points;
    let steps = [last.omega - before.omega, new.omega - last.omega].map(f64::abs);
    points.iter().all(|one| one.is_solved()).then(|| balance.scale.of_line(points, steps))
}
