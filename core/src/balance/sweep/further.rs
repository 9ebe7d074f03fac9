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
use crate::balance::account::LITTLE;
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
/// … or this number over that of the unknowns. They take no more work than the curve either, or little.
const CHEAP: usize = 30_000;
/// Harmonics beyond all modes that tell branches apart: what is looked for needs no more, and what is found is
/// solved with as many as it asks for.
const TELLING: f64 = 27.0;
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
    let mut work = balance.profile.work.max(LITTLE);
    for look in LOOKS {
        let share = f64::from(look) / 8.0;
        let omega = (1.0 - share) * bounds.0 + share * bounds.1;
        loop {
            let before = (balance.profile.evaluations, balance.profile.work);
            let found = other_motion(balance, points, omega, (affordable, work));
            affordable = affordable.saturating_sub(balance.profile.evaluations - before.0);
            work -= balance.profile.work - before.1;
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
        if affordable == 0 || work <= 0.0 {
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

/// A motion at a frequency that is on none of the branches, if one is found within so many evaluations and so much
/// work.
fn other_motion(
    balance: &mut ForcedBalance<'_>,
    points: &[Arc<Point>],
    omega: f64,
    (affordable, work): (usize, f64),
) -> Result<Option<Point>, Error> {
    let crossed = crossings(points, omega);
    let Some(finest) = crossed.iter().map(|(_, at)| *at).reduce(Resolution::or_finer) else {
        return Ok(None);
    };
    let resolution = telling(balance, omega, finest);
    let table = balance.table(resolution.harmonics);
    let model = balance.evaluated(resolution.samples)?;
    let interrupted = balance.interruption();
    let mut equations = Condensed::of_curve(model, &table, balance.settings.residual);
    equations.watch(&interrupted);
    equations.granted = work;
    if equations.set_omega(omega).is_err() {
        return Ok(None);
    }
    let known = Known::at(&mut equations, &crossed);
    let first = known.exact.first();
    let mut starts = first.map_or_else(Vec::new, |x| joined_by_load(&mut equations, x, affordable));
    starts.push(equations.stuck_response().to_vec());
    let found = starts.into_iter().filter(|x| !known.has(x)).find_map(|start| {
        solved(&mut equations, start)
            .filter(|x| !known.has(x) && is_bounded(x, equations.stuck_response()))
    });
    balance.add_profile(&equations.profile);
    let Some(values) = found else { return Ok(None) };
    let start = Unknowns::new(table.harmonics().clone(), values);
    let point = balance.solve(omega, Some(&start))?;
    let new = match point.unknowns().filter(|_| point.is_solved()) {
        Some(x) if resolution == finest => !known.has(&x.recast(table.harmonics())),
        Some(x) => is_new(balance, (x, omega), &crossed, finest.or_finer(point.resolution()))?,
        None => false,
    };
    Ok(Some(point).filter(|_| new))
}

/// The resolution with which motions are looked for beside those of another one.
fn telling(balance: &ForcedBalance<'_>, omega: f64, finest: Resolution) -> Resolution {
    let loads = balance.loaded_harmonics().last().map_or(0.0, |&order| 3.0 * order as f64);
    let enough = TELLING.max(balance.order_of_modes(omega)).max(loads);
    let harmonics = if balance.control.is_fixed() || enough >= finest.harmonics as f64 {
        finest.harmonics
    } else {
        enough.ceil() as usize
    };
    Resolution { harmonics, ..finest }
}

/// Whether a motion is on none of the branches, by the curves of a resolution.
fn is_new(
    balance: &mut ForcedBalance<'_>,
    (motion, omega): (&Unknowns, f64),
    crossed: &[(Unknowns, Resolution)],
    resolution: Resolution,
) -> Result<bool, Error> {
    let table = balance.table(resolution.harmonics);
    let model = balance.evaluated(resolution.samples)?;
    let interrupted = balance.interruption();
    let mut equations = Condensed::of_curve(model, &table, balance.settings.residual);
    equations.watch(&interrupted);
    if equations.set_omega(omega).is_err() {
        return Ok(false);
    }
    let known = Known::at(&mut equations, crossed);
    let own = motion.recast(table.harmonics());
    let own = solved(&mut equations, own.clone()).unwrap_or(own);
    balance.add_profile(&equations.profile);
    Ok(!known.has(&own))
}

/// The motions of all branches at a frequency.
struct Known {
    /// On straight lines, which may be farther off than motions lie apart, …
    lines: Vec<Vec<f64>>,
    /// … and as they are.
    exact: Vec<Vec<f64>>,
}

impl Known {
    fn at(equations: &mut Condensed<'_>, crossed: &[(Unknowns, Resolution)]) -> Self {
        let harmonics = equations.harmonics();
        let lines: Vec<Vec<f64>> =
            crossed.iter().map(|(motion, _)| motion.recast(harmonics)).collect();
        let exact = lines.iter().filter_map(|x| solved(equations, x.clone())).collect();
        Self { lines, exact }
    }

    fn has(&self, x: &[f64]) -> bool {
        self.lines.iter().any(|other| apart(x, other) < NEAR)
            || self.exact.iter().any(|other| apart(x, other) < SAME)
    }
}

/// The motion that Newton's method leads to.
fn solved(equations: &mut Condensed<'_>, mut x: Vec<f64>) -> Option<Vec<f64>> {
    let found = newton(equations, &mut x, COMPARED).outcome == Outcome::Converged;
    found.then_some(x)
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

#[cfg(test)]
#[allow(clippy::unwrap_used)]
mod tests {
    use super::*;
    use crate::balance::settings::{HarmonicChoice, Settings};
    use crate::balance::sweep::sweep_range;
    use crate::contact::Cubic;
    use crate::model::{Contact, Model};
    use crate::structure::{HarmonicLoad, Structure};
    use faer::{c64, mat, Mat};

    /// A mass on a hardening spring.
    fn model() -> Model {
        let one = mat![[1.0]];
        let structure = Structure::new(one.as_ref(), mat![[0.1]].as_ref(), one.as_ref()).unwrap();
        let row = Mat::from_fn(1, 1, |_, _| 1.0);
        let contacts = vec![Contact { law: Box::new(Cubic::new(1.0).unwrap()), rows: row }];
        let load = HarmonicLoad { harmonic: 1, amplitude: vec![c64::new(1.0, 0.0)] };
        Model::new(structure, contacts, vec![load]).unwrap()
    }

    #[test]
    fn motions_are_looked_for_with_harmonics_that_tell_them_apart() {
        let model = model();
        let look = |harmonics: HarmonicChoice, omega: f64, finest: usize| {
            let settings = Settings { harmonics, ..Settings::default() };
            let balance = ForcedBalance::new(&model, settings, &[0]).unwrap();
            let finest = Resolution { harmonics: finest, samples: None };
            telling(&balance, omega, finest).harmonics
        };
        assert_eq!(look(HarmonicChoice::Auto, 1.0, 177), 27);
        assert_eq!(look(HarmonicChoice::Auto, 1.0, 13), 13);
        // What is given stands, and low frequencies need as many as reach the mode.
        assert_eq!(look(HarmonicChoice::Fixed(177), 1.0, 177), 177);
        assert!((58..=62).contains(&look(HarmonicChoice::Auto, 0.02, 177)));
    }

    /// A look ends when its work is spent, however many evaluations it might make.
    #[test]
    fn looks_take_no_more_work_than_they_may() {
        let model = model();
        let settings = Settings { harmonics: HarmonicChoice::Fixed(9), ..Settings::default() };
        let balance = || ForcedBalance::new(&model, settings, &[0]).unwrap();
        let points = sweep_range(balance(), 0.3, 4.0).unwrap().points;
        let taken = |work: f64| {
            let mut balance = balance();
            other_motion(&mut balance, &points, 2.0, (usize::MAX, work)).unwrap();
            balance.profile.evaluations
        };
        let (whole, little) = (taken(f64::INFINITY), taken(1.0));
        assert!(whole > 10 * little, "{whole} {little}");
    }
}
