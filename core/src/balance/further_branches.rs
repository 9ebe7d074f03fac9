//! Further branches of a forced curve: motions in its range that the branch from the end of the range does
//! not come by. Folds may lie outside of the range, and closed branches are joined to nothing.
//!
//! At some frequencies motions are looked for by full Newton steps from starts far from those that are
//! known. One that lies on no known branch is followed in both directions, to the ends of the range or to
//! where it closes. What no start leads to is not found: there may be more branches.

use super::branch_sweep::branch_through;
use super::condensed::Condensed;
use super::far_starts::{far_starts, turned};
use super::forced::ForcedBalance;
use super::keep;
use super::solution::{CurveEnd, Point};
use super::unknowns::Unknowns;
use crate::solve::{newton, norm, NewtonSettings, Outcome, System as _};
use crate::Error;
use std::sync::Arc;

/// Frequencies at which other motions are looked for, the ends of the range among them.
const LOOKS: usize = 9;
/// Most further branches.
const MOST: usize = 8;
/// Full Newton steps from a start, …
const STEPS: usize = 14;
/// … the relative step at which Newton's method goes on by itself, …
const ARRIVED: f64 = 0.1;
/// … and the distance from a known motion at which a start leads there.
const NEAR: f64 = 0.02;
/// Newton's method at motions that are compared: they are not kept.
const COMPARED: NewtonSettings = NewtonSettings { tolerance: 1e-7, max_iterations: 12 };
/// Distance of motions that are the same.
const SAME: f64 = 1e-3;
/// The largest motion of the curve, turned by quarters of a period.
const OF_LARGEST: [[f64; 2]; 4] = [[1.0, 0.0], [0.0, 1.0], [-1.0, 0.0], [0.0, -1.0]];

/// Adds to the points of a curve those of its further branches; whether nobody has ended that.
///
/// # Errors
/// As for a solution at one frequency.
pub(super) fn add_further_branches(
    balance: &mut ForcedBalance<'_>,
    points: &mut Vec<Arc<Point>>,
    bounds: (f64, f64),
) -> Result<bool, Error> {
    let kept = balance.kept.take();
    let (mut begin, mut branches, mut complete) = (points.len(), 0, true);
    for look in 0..LOOKS {
        let share = look as f64 / (LOOKS - 1) as f64;
        let omega = bounds.0 + share * (bounds.1 - bounds.0);
        while let Some(first) = other_motion(balance, points, omega, look)? {
            let (branch, end) = both_ways(balance, first, bounds)?;
            points.extend(branch);
            points[begin..].iter().for_each(|point| keep(kept, point));
            (begin, branches) = (points.len(), branches + 1);
            complete = end != CurveEnd::Interrupted;
            if !complete || branches == MOST {
                return Ok(complete);
            }
        }
        if !balance.report(1.0) {
            return Ok(false);
        }
    }
    balance.kept = kept;
    Ok(complete)
}

/// The branch through a point in both directions.
fn both_ways(
    balance: &mut ForcedBalance<'_>,
    first: Point,
    bounds: (f64, f64),
) -> Result<(Vec<Arc<Point>>, CurveEnd), Error> {
    let (omega, first) = (first.omega, Arc::new(first));
    let mut points = vec![Arc::clone(&first)];
    let mut end = CurveEnd::Range;
    if omega < bounds.1 {
        (points, end) = branch_through(balance, Arc::clone(&first), (omega, bounds.1), bounds)?;
    }
    if omega > bounds.0 && !matches!(end, CurveEnd::Closed | CurveEnd::Interrupted) {
        let (mut back, last) = branch_through(balance, first, (omega, bounds.0), bounds)?;
        back.reverse();
        back.pop();
        back.append(&mut points);
        (points, end) = (back, last);
    }
    if let Some(first) = points.first_mut() {
        Arc::make_mut(first).further = true;
    }
    Ok((points, end))
}

/// A motion at a frequency that is on none of the branches, if one is found.
fn other_motion(
    balance: &mut ForcedBalance<'_>,
    points: &[Arc<Point>],
    omega: f64,
    look: usize,
) -> Result<Option<Point>, Error> {
    let here = crossings(points, omega);
    let nearest = |a: &&Arc<Point>, b: &&Arc<Point>| {
        (a.omega - omega).abs().total_cmp(&(b.omega - omega).abs())
    };
    let Some(beside) = points.iter().filter(|point| point.is_solved()).min_by(nearest) else {
        return Ok(None);
    };
    let resolution = beside.resolution();
    let (table, model) =
        (balance.table(resolution.harmonics), balance.evaluated(resolution.samples)?);
    let slots = table.harmonics().slots();
    let interrupted = balance.interruption();
    let mut equations = Condensed::new(model, &table, balance.settings.residual, false);
    equations.watch(&interrupted);
    if equations.set_omega(omega).is_err() {
        return Ok(None);
    }
    let recast = |unknowns: &Unknowns| unknowns.recast(table.harmonics());
    let mut known: Vec<Vec<f64>> = here.iter().map(recast).collect();
    let largest = points.iter().filter_map(|point| point.unknowns().map(recast));
    let largest = largest.max_by(|a, b| norm(a).total_cmp(&norm(b))).unwrap_or_default();
    let stuck = equations.stuck_response().to_vec();
    let nominal = known.first().unwrap_or(&stuck).clone();
    let last: Vec<usize> = balance.model.points().iter().map(|own| own.end - 1).collect();
    let starts = [stuck.clone()]
        .into_iter()
        .chain(OF_LARGEST.map(|by| turned(&largest, slots, by)))
        .chain(far_starts([&nominal, &stuck], slots, &last, look));
    let mut polished = false;
    let mut found = None;
    for start in starts {
        let Some(mut x) = looked(&mut equations, start, &known) else { continue };
        if newton(&mut equations, &mut x, COMPARED).outcome != Outcome::Converged {
            continue;
        }
        if !polished {
            // Interpolated motions may be farther off than others lie apart.
            let exact = known.clone().into_iter().filter_map(|mut x| {
                let solved = newton(&mut equations, &mut x, COMPARED).outcome;
                (solved == Outcome::Converged).then_some(x)
            });
            let exact: Vec<Vec<f64>> = exact.collect();
            known.extend(exact);
            polished = true;
        }
        if known.iter().any(|other| apart(&x, other) < SAME) {
            continue;
        }
        found = Some(Unknowns::new(table.harmonics().clone(), x));
        break;
    }
    balance.add_profile(&equations.profile);
    let Some(start) = found else { return Ok(None) };
    let point = balance.solve(omega, Some(&start))?;
    let stays = |unknowns: &Unknowns| {
        let x = recast(unknowns);
        known.iter().all(|other| apart(&x, other) >= SAME)
    };
    let new = point.is_solved() && point.unknowns().is_some_and(stays);
    Ok(Some(point).filter(|_| new))
}

/// Where full Newton steps lead from a start that is far from any motion; nothing if they come to a
/// known motion, or nowhere.
fn looked(equations: &mut Condensed<'_>, start: Vec<f64>, known: &[Vec<f64>]) -> Option<Vec<f64>> {
    let mut x = start;
    let (mut defect, mut step) = (vec![0.0; x.len()], vec![0.0; x.len()]);
    for _ in 0..STEPS {
        equations.residual(&x, &mut defect);
        if equations.interrupted() || !equations.solve(&defect, &mut step) {
            return None;
        }
        x.iter_mut().zip(&step).for_each(|(x, s)| *x -= s);
        if known.iter().any(|other| apart(&x, other) < NEAR) {
            return None;
        }
        if norm(&step) < ARRIVED * norm(&x) {
            return Some(x);
        }
    }
    None
}

/// Distance of two motions, relative to the larger.
fn apart(a: &[f64], b: &[f64]) -> f64 {
    let way: Vec<f64> = a.iter().zip(b).map(|(a, b)| a - b).collect();
    norm(&way) / norm(a).max(norm(b)).max(f64::MIN_POSITIVE)
}

/// The motions of all branches at a frequency, by straight lines between their points.
fn crossings(points: &[Arc<Point>], omega: f64) -> Vec<Unknowns> {
    let crossing = |pair: &[Arc<Point>]| {
        let [a, b] = pair else { return None };
        let (from, to) = (a.unknowns()?, b.unknowns()?);
        let inside = !b.further && (a.omega - omega) * (b.omega - omega) <= 0.0;
        let share = if a.omega == b.omega { 0.0 } else { (omega - a.omega) / (b.omega - a.omega) };
        let values = from.recast(to.harmonics()).into_iter().zip(to.values());
        let values = values.map(|(x, y)| x + share * (y - x)).collect();
        inside.then(|| Unknowns::new(to.harmonics().clone(), values))
    };
    points.windows(2).filter_map(crossing).collect()
}
