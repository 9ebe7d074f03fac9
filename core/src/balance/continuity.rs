//! Whether two neighbouring points of a sweep lie on one branch, or the sweep has jumped between them.
//!
//! Where solutions are not unique Newton's method may lead to another branch. If the tangents at both
//! points do not explain the way between them the curve is followed by arclength, to where it first
//! meets the new frequency: that solution is taken. If the curve has turned back before, the sweep jumps.

use super::branch_sweep::{distance, STEPS};
use super::forced::ForcedBalance;
use super::forced_curve::ForcedCurve;
use super::solution::{Point, PointStatus};
use super::unknowns::Unknowns;
use crate::solve::{between, tangent, Advance, Continuation, Curve as _};
use crate::Error;

/// Part of the way between two points that their tangents may leave unexplained, …
const UNEXPLAINED: f64 = 0.05;
/// … and distance, relative to the motion, below which nothing has to be explained.
const CLOSE: f64 = 1e-5;
/// Newton iterations along a curve from one frequency to the next: over a longer way, or one with
/// more corners, a sweep that coarse does not say which branch it is on.
const MOST: usize = 150;
/// Distance of two solutions that are the same.
const SAME: f64 = 1e-6;

/// Where a branch leads.
enum Reached {
    /// To the same solution.
    Same,
    /// To another one, without a turn on the way or with some.
    Other(Unknowns, bool),
    /// Not known.
    Lost,
}

impl ForcedBalance<'_> {
    /// Replaces a new point by that of the branch of the last one if Newton's method has left it or
    /// found none, and says so of a point that lies behind a turn.
    pub(super) fn stay_on_branch(&mut self, last: &Point, point: &mut Point) -> Result<(), Error> {
        let failed = matches!(point.status, PointStatus::Stalled | PointStatus::Singular);
        if !last.is_solved() || !(point.is_solved() || failed) || last.omega == point.omega {
            return Ok(());
        }
        if let Reached::Other(start, turned) = self.reached(last, point)? {
            let other = self.solve(point.omega, Some(&start))?;
            if other.is_solved() {
                *point = other;
                point.jump = turned;
            }
        }
        Ok(())
    }

    fn reached(&mut self, last: &Point, point: &Point) -> Result<Reached, Error> {
        let solved = point.is_solved();
        let finer = last.resolution().or_finer(point.resolution());
        let resolution = if solved { finer } else { last.resolution() };
        let table = self.table(resolution.harmonics);
        let model = self.evaluated(resolution.samples)?;
        let ask = self.interruption();
        let mut curve = ForcedCurve::new(model, &table, self.settings.residual, &ask);
        let Some(known) = last.unknowns() else { return Ok(Reached::Lost) };
        let from = curve.point(known, last.omega);
        let found = point.unknowns().filter(|_| solved);
        let to = found.map(|found| curve.point(found, point.omega));
        let reached = followed(&mut curve, &from, to.as_deref(), point.omega);
        self.add_profile(&curve.profile);
        Ok(reached)
    }
}

/// Where the branch through `from` leads at a frequency at which Newton's method has found `to`.
fn followed(curve: &mut ForcedCurve<'_>, from: &[f64], to: Option<&[f64]>, end: f64) -> Reached {
    if to.is_some_and(|to| is_explained(curve, from, to)) {
        return Reached::Same;
    }
    let sign = (end - from[from.len() - 1]).signum();
    let Some(mut walk) = Continuation::new(curve, from.to_vec(), sign, STEPS) else {
        return Reached::Lost;
    };
    let (mut before, mut turned) = (from.to_vec(), false);
    while walk.iterations < MOST {
        if !matches!(walk.advance(curve), Advance::Point) {
            return Reached::Lost;
        }
        let omega = walk.point[walk.point.len() - 1];
        turned |= (omega - before[before.len() - 1]) * sign < 0.0;
        if (omega - end) * sign >= 0.0 {
            let Some((z, _)) = between(curve, &before, &walk.point, end) else {
                return Reached::Lost;
            };
            let same = !turned && to.is_some_and(|to| distance(&z, to) < SAME);
            return if same { Reached::Same } else { Reached::Other(curve.series(&z), turned) };
        }
        before.clone_from(&walk.point);
    }
    Reached::Lost
}

/// Whether the mean of the tangents at both points leads from one to the other.
fn is_explained(curve: &mut ForcedCurve<'_>, from: &[f64], to: &[f64]) -> bool {
    let way = distance(from, to);
    if way < CLOSE {
        return true;
    }
    let step = to[to.len() - 1] - from[from.len() - 1];
    let mut mean = from.to_vec();
    for z in [from, to] {
        curve.accept(z);
        let weights = curve.weights(z);
        let mut ahead = vec![0.0; z.len()];
        ahead[z.len() - 1] = step.signum();
        let Some(along) = tangent(curve, z, &weights, &ahead) else { return false };
        let rate = along[z.len() - 1];
        mean.iter_mut().zip(&along).for_each(|(m, a)| *m += 0.5 * step * a / rate);
    }
    distance(&mean, to) < UNEXPLAINED * way
}
