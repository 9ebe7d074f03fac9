//! Where a branch turns back in frequency, and where it closes.

use super::branch::Walk;
use super::forced_curve::ForcedCurve;
use crate::balance::settings::Resolution;
use crate::balance::solution::Point;
use crate::balance::tangent::distance;
use crate::solve::between;
use crate::Error;
use std::sync::Arc;

/// Distance of points of a curve that are the same.
const SAME: f64 = 1e-9;

/// Distance at which a branch has come back to its first point: other harmonics may have moved it.
const CLOSED: f64 = 1e-2;

impl Walk<'_, '_> {
    /// The first point of the branch, if a step has come by it in the direction in which it was left.
    pub(super) fn closed(
        &self,
        curve: &mut ForcedCurve<'_>,
        known: &[f64],
        z: &[f64],
    ) -> Option<Vec<f64>> {
        let [first, second, _, ..] = &self.points[..] else { return None };
        let [from, to] = [known, z].map(|z| z[z.len() - 1]);
        let (begin, ahead) = (first.omega, (to - from) * (second.omega - first.omega) > 0.0);
        let passes = self.inside && ahead && (begin - from) * (begin - to) <= 0.0;
        let first = curve.point(first.unknowns.as_ref().filter(|_| passes)?, begin);
        let (at, _) = between(curve, known, z, begin)?;
        (distance(&at, &first) < CLOSED).then_some(at)
    }

    /// Adds the fold before a new point, if the frequency has turned.
    pub(super) fn add_fold(
        &mut self,
        curve: &mut ForcedCurve<'_>,
        resolution: Resolution,
        new: &Point,
    ) -> Result<(), Error> {
        let [.., before, last] = &self.points[..] else { return Ok(()) };
        if last.fold || (last.omega - before.omega) * (new.omega - last.omega) >= 0.0 {
            return Ok(());
        }
        let (before, last) = (Arc::clone(before), Arc::clone(last));
        let Some(fold) = self.fold(curve, resolution, [&before, &last, new])? else {
            return Ok(());
        };
        let places =
            [&before, &last, &fold].map(|one| Some(curve.point(one.unknowns()?, one.omega)));
        let [Some(a), Some(b), Some(z)] = places else { return Ok(()) };
        let (same, before) = (distance(&z, &b) < SAME, distance(&z, &a) < distance(&b, &a));
        if same || before {
            self.points.pop();
        }
        self.push(fold);
        if before && !same {
            self.points.push(last);
        }
        Ok(())
    }
}
