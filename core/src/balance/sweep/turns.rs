//! Where a branch turns back in frequency, and where it closes.

use super::branch::Walk;
use super::forced_curve::ForcedCurve;
use crate::balance::kept::{keep, take_back};
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
            take_back(self.balance.kept, &last);
        }
        self.push(fold);
        if before && !same {
            keep(self.balance.kept, &last);
            self.points.push(last);
        }
        Ok(())
    }
}

#[cfg(test)]
#[allow(clippy::unwrap_used)]
mod tests {
    use crate::balance::forced::ForcedBalance;
    use crate::balance::settings::Settings;
    use crate::balance::sweep::sweep_range;
    use crate::balance::Kept;
    use crate::contact::Cubic;
    use crate::model::{Contact, Model};
    use crate::structure::{HarmonicLoad, Structure};
    use faer::{c64, mat, Mat};
    use std::sync::Arc;

    /// A fold before the last point takes its place, also among the points of a curve that may be ended.
    #[test]
    fn folds_are_kept_in_the_order_of_the_curve() {
        let (mut folds, mut moved) = (0, 0);
        for load in [0.2, 0.25, 0.3, 0.35, 0.4, 0.5] {
            let one = mat![[1.0]];
            let structure = Structure::new(one.as_ref(), mat![[0.05]].as_ref(), one.as_ref());
            let row = Mat::from_fn(1, 1, |_, _| 1.0);
            let contacts = vec![Contact { law: Box::new(Cubic::new(0.5).unwrap()), rows: row }];
            let loads = vec![HarmonicLoad { harmonic: 1, amplitude: vec![c64::new(load, 0.0)] }];
            let model = Model::new(structure.unwrap(), contacts, loads).unwrap();
            let kept = Kept::default();
            let balance = ForcedBalance::new(&model, Settings::default(), &[0]).unwrap();
            let found = sweep_range(balance.keeping(&kept), 0.3, 4.0).unwrap();
            let kept = kept.into_inner().unwrap();
            let same = kept.len() == found.points.len()
                && kept.iter().zip(&found.points).all(|(a, b)| Arc::ptr_eq(a, b));
            folds += found.points.iter().filter(|point| point.fold).count();
            moved += usize::from(!same);
        }
        assert!(folds > 0);
        assert_eq!(moved, 0);
    }
}
