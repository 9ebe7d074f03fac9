//! How a branch goes over to the curve of other harmonics or samples.
//!
//! The curve of few harmonics may pass smoothly where that of more turns back and forth. So a branch is left for
//! another curve only where both run side by side, in the same direction: the orientation of a curve, around its
//! folds, is the same in whatever harmonics. To fewer a branch goes over later where it does not; to more it does
//! so farther back, if they are not found where they are asked for.

use super::branch::Walk;
use super::forced_curve::ForcedCurve;
use crate::balance::kept::take_back;
use crate::balance::settings::Resolution;
use crate::balance::solution::{Point, PointStatus};
use crate::solve::{across, oriented, Continuation, Curve as _};
use crate::Error;

impl Walk<'_, '_> {
    /// The walk along the curve of another resolution from the last point, and whether that runs beside the curve
    /// so far.
    pub(super) fn beside(
        &self,
        curve: &mut ForcedCurve<'_>,
        walk: &Continuation,
        here: &[f64],
    ) -> (Continuation, bool) {
        let mut ahead = walk.clone();
        let before = self.points.iter().rev().nth(1);
        let before = before.and_then(|one| Some(curve.point(one.unknowns()?, one.omega)));
        let Some(before) = before else { return (ahead, true) };
        // Neither lies on the curve of another resolution: steps that are shorter than the distance of the two
        // curves would not find it.
        let found = [(&before, 0.0), (&here.to_vec(), 1.0)].map(|(known, share)| {
            curve.accept(known);
            across(curve, &before, here, share)
        });
        let both = found.iter().all(Option::is_some);
        let [from, to] = found;
        let (from, to) = (from.unwrap_or(before), to.unwrap_or_else(|| here.to_vec()));
        ahead.restart(curve, &from, &to);
        let same = ahead.orientation * walk.orientation >= 0.0;
        (ahead, both && same)
    }

    /// Whether the curve passes a point in the direction of the way there as it did the points so far.
    pub(super) fn is_ahead(&self, curve: &mut ForcedCurve<'_>, before: &[f64], z: &[f64]) -> bool {
        let way: Vec<f64> = z.iter().zip(before).map(|(a, b)| a - b).collect();
        let weights = curve.weights(z);
        let passed = oriented(curve, z, &weights, &way);
        passed.is_none_or(|(_, orientation)| orientation * self.orientation >= 0.0)
    }

    /// Goes back along the branch to where the curve of more resolution runs beside it, and has it go on from
    /// there; tells the resolution, nothing if it runs nowhere.
    pub(super) fn retreat(&mut self, resolution: Resolution) -> Result<Option<Resolution>, Error> {
        let reached = self.points.len();
        // Where nothing was found a step before, nothing is now.
        let mut lost = self.last().status == PointStatus::EffortLimit;
        let mut dropped = Vec::new();
        while !lost && self.points.len() > 1 && !self.balance.is_ended() {
            // Twice as far each time.
            let at = self.points.len().saturating_sub(dropped.len().max(1)).max(1);
            let mut later = self.points.split_off(at);
            later.append(&mut dropped);
            dropped = later;
            let more = resolution.or_finer(dropped[0].resolution());
            let found = self.finer(&dropped[0].clone(), more)?;
            if let Some(point) = found.filter(Point::is_solved) {
                dropped.iter().rev().for_each(|one| take_back(self.balance.kept, one));
                self.push(point);
                self.raised = reached;
                return Ok(Some(more));
            }
            lost = at == 1;
        }
        self.points.append(&mut dropped);
        Ok(None)
    }
}
