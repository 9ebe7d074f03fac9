//! Further branches of a forced curve: motions in its range that the branch from the end of the range does
//! not come by. Folds may lie outside of the range, and closed branches are joined to nothing.
//!
//! At some frequencies motions are looked for along the curve in the load through one that is known, and
//! from the stuck response. One that lies on no known branch is followed in both directions, to the ends of
//! the range or to where it closes. What neither leads to is not found: there may be more branches.
//! Isolas of a vibration absorber: T. Detroux, G. Habib, L. Masset, G. Kerschen (2015), "Performance,
//! robustness and sensitivity analysis of the nonlinear tuned vibration absorber".

use super::branch::branch_through;
use super::load_curve::joined_by_load;
use crate::balance::attempts::is_bounded;
use crate::balance::condensed::Condensed;
use crate::balance::forced::ForcedBalance;
use crate::balance::keep;
use crate::balance::settings::Resolution;
use crate::balance::solution::{CurveEnd, Point};
use crate::balance::unknowns::Unknowns;
use crate::solve::{newton, norm, NewtonSettings, Outcome};
use crate::Error;
use std::sync::Arc;

/// Eighths of the range at which other motions are looked for, in this order, as long as that takes no more
/// evaluations than the curve, …
const LOOKS: [u8; 9] = [0, 8, 4, 2, 6, 1, 3, 5, 7];
/// … or this number over that of the unknowns.
const CHEAP: usize = 30_000;
/// Most further branches.
const MOST: usize = 8;
/// Newton's method at motions that are compared: they are not kept.
const COMPARED: NewtonSettings = NewtonSettings { tolerance: 1e-7, max_iterations: 12 };
/// Distance from a straight line between points of a branch of motions that are on it, …
const NEAR: f64 = 0.02;
/// … and of motions that are the same.
const SAME: f64 = 1e-3;

/// Adds to the points of a curve those of its further branches; whether nobody has ended that, and how many
/// of them end inside the range.
pub(super) fn add_further_branches(
    balance: &mut ForcedBalance<'_>,
    points: &mut Vec<Arc<Point>>,
    bounds: (f64, f64),
) -> (bool, usize) {
    // Of many contacts a single look would cost more than the curve.
    if balance.profile.products > 0 {
        return (true, 0);
    }
    let kept = balance.kept.take();
    let (mut begin, mut branches, mut cut) = (points.len(), 0, 0);
    let own = points.last().and_then(|last| last.unknowns()).map_or(1, |x| x.values().len());
    let mut affordable = balance.profile.evaluations.max(CHEAP / own.max(1));
    for look in LOOKS {
        let share = f64::from(look) / 8.0;
        let omega = (1.0 - share) * bounds.0 + share * bounds.1;
        loop {
            let before = balance.profile.evaluations;
            let found = other_motion(balance, points, omega, affordable);
            affordable = affordable.saturating_sub(balance.profile.evaluations - before);
            // Nobody has asked for these frequencies: what fails there finds nothing.
            let Ok(Some(first)) = found else { break };
            let Ok((branch, end)) = both_ways(balance, first, bounds) else { break };
            points.extend(branch);
            points[begin..].iter().for_each(|point| keep(kept, point));
            (begin, branches) = (points.len(), branches + 1);
            cut += usize::from(matches!(end, CurveEnd::Stalled | CurveEnd::Points));
            if end == CurveEnd::Interrupted {
                return (false, cut);
            }
            if branches == MOST {
                return (true, cut);
            }
        }
        if !balance.report(1.0) {
            return (false, cut);
        }
        if affordable == 0 {
            break;
        }
    }
    (true, cut)
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
        points = back;
        // An end inside the range is told, at whichever side it is.
        if !matches!(end, CurveEnd::Stalled | CurveEnd::Points) || last == CurveEnd::Interrupted {
            end = last;
        }
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
    affordable: usize,
) -> Result<Option<Point>, Error> {
    let crossed = crossings(points, omega);
    let Some(finest) = crossed.iter().map(|(_, at)| *at).reduce(Resolution::or_finer) else {
        return Ok(None);
    };
    let table = balance.table(finest.harmonics);
    let model = balance.evaluated(finest.samples)?;
    let interrupted = balance.interruption();
    let mut equations = Condensed::of_curve(model, &table, balance.settings.residual);
    equations.watch(&interrupted);
    if equations.set_omega(omega).is_err() {
        return Ok(None);
    }
    let recast = |unknowns: &Unknowns| unknowns.recast(table.harmonics());
    let solved = |equations: &mut Condensed<'_>, mut x: Vec<f64>| {
        let found = newton(equations, &mut x, COMPARED).outcome == Outcome::Converged;
        found.then_some(x)
    };
    // Straight lines may be farther off than motions lie apart.
    let lines: Vec<Vec<f64>> = crossed.iter().map(|(motion, _)| recast(motion)).collect();
    let exact: Vec<Vec<f64>> =
        lines.iter().filter_map(|x| solved(&mut equations, x.clone())).collect();
    let known = |x: &[f64]| {
        lines.iter().any(|other| apart(x, other) < NEAR)
            || exact.iter().any(|other| apart(x, other) < SAME)
    };
    let mut starts =
        exact.first().map_or_else(Vec::new, |x| joined_by_load(&mut equations, x, affordable));
    starts.push(equations.stuck_response().to_vec());
    let found = starts.into_iter().filter(|x| !known(x)).find_map(|start| {
        solved(&mut equations, start)
            .filter(|x| !known(x) && is_bounded(x, equations.stuck_response()))
    });
    balance.add_profile(&equations.profile);
    let Some(values) = found else { return Ok(None) };
    let start = Unknowns::new(table.harmonics().clone(), values);
    let point = balance.solve(omega, Some(&start))?;
    let new = point.is_solved() && point.unknowns().is_some_and(|x| !known(&recast(x)));
    Ok(Some(point).filter(|_| new))
}

/// Distance of two motions, relative to the larger.
fn apart(a: &[f64], b: &[f64]) -> f64 {
    let way: Vec<f64> = a.iter().zip(b).map(|(a, b)| a - b).collect();
    norm(&way) / norm(a).max(norm(b)).max(f64::MIN_POSITIVE)
}

/// The motions of all branches at a frequency, by straight lines between their points, and what they resolve.
fn crossings(points: &[Arc<Point>], omega: f64) -> Vec<(Unknowns, Resolution)> {
    let crossing = |pair: &[Arc<Point>]| {
        let [a, b] = pair else { return None };
        let (from, to) = (a.unknowns()?, b.unknowns()?);
        let inside = !b.further && (a.omega - omega) * (b.omega - omega) <= 0.0;
        let share = if a.omega == b.omega { 0.0 } else { (omega - a.omega) / (b.omega - a.omega) };
        let values = from.recast(to.harmonics()).into_iter().zip(to.values());
        let values = values.map(|(x, y)| x + share * (y - x)).collect();
        let motion = Unknowns::new(to.harmonics().clone(), values);
        inside.then(|| (motion, a.resolution().or_finer(b.resolution())))
    };
    points.windows(2).filter_map(crossing).collect()
}
