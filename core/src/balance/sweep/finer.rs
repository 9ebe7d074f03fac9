//! Points of a branch with as many harmonics and samples as the tolerance asks for.

use super::branch::Walk;
use super::forced_curve::ForcedCurve;
use crate::balance::resolution_control::Decision;
use crate::balance::settings::Resolution;
use crate::balance::solution::{Point, PointStatus};
use crate::solve::{across, between};
use crate::Error;

impl Walk<'_, '_> {
    /// Has a point of the curve be one of as much resolution as it lacks, and tells that, and whether more would
    /// be needed whose curve does not come by.
    pub(super) fn climb(
        &mut self,
        curve: &mut ForcedCurve<'_>,
        point: &mut Point,
        at: Resolution,
    ) -> Result<(Resolution, Option<Resolution>), Error> {
        let mut kept = at;
        self.judge_beside(curve, point, at)?;
        while let Some(more) = self.wanted(point, kept) {
            let Some(finer) = self.finer(point, more)?.filter(Point::is_solved) else {
                // What is solved stands, with the status that it has over given frequencies.
                point.status = PointStatus::EffortLimit;
                self.balance.control.stay(kept);
                return Ok((kept, Some(more)));
            };
            (kept, *point) = (more, finer);
        }
        Ok((kept, None))
    }

    /// The resolution that a solved point lacks, if any.
    pub(super) fn wanted(&mut self, point: &mut Point, at: Resolution) -> Option<Resolution> {
        if self.balance.control.is_fixed() || !point.is_solved() {
            return None;
        }
        match self.balance.judge(point) {
            Decision::Enough => None,
            // An orbit in its place might lie on another branch.
            Decision::More(more) if self.balance.is_too_dear(more, point) => {
                point.status = PointStatus::EffortLimit;
                self.balance.control.stay(at);
                None
            }
            Decision::More(more) => Some(more).filter(|more| *more != at),
            Decision::Limit(limit) => {
                point.status = limit;
                self.balance.control.stay(at);
                None
            }
        }
    }

    /// The point of the curve of another resolution on the plane across the way to a point.
    pub(super) fn finer(
        &mut self,
        point: &Point,
        resolution: Resolution,
    ) -> Result<Option<Point>, Error> {
        let table = self.balance.table(resolution.harmonics);
        let model = self.balance.evaluated(resolution.samples)?;
        let ask = self.balance.interruption();
        let mut curve = ForcedCurve::new(model, &table, self.balance.settings.residual, &ask);
        let last = self.last();
        let (Some(known), Some(here)) = (&last.unknowns, &point.unknowns) else { return Ok(None) };
        let (before, at) = (curve.point(known, last.omega), curve.point(here, point.omega));
        let found = across(&mut curve, &before, &at, 1.0);
        let inside = |z: &Vec<f64>| (self.bounds.0..=self.bounds.1).contains(&z[z.len() - 1]);
        // The plane may meet it beyond the end of the range, where the point lies.
        let found = found.filter(inside);
        let found = found.or_else(|| Some(between(&mut curve, &before, &at, point.omega)?.0));
        let ahead = |z: &Vec<f64>| self.is_ahead(&mut curve, &before, z);
        let Some(z) = found.filter(ahead) else { return Ok(None) };
        let mut solved = self.solved(&mut curve, &z, resolution, point.iterations)?;
        if let Some(finer) = &mut solved {
            self.judge_beside(&mut curve, finer, resolution)?;
        }
        self.balance.add_profile(&curve.profile);
        Ok(solved)
    }
}

#[cfg(test)]
#[allow(clippy::unwrap_used)]
mod tests {
    use crate::balance::forced::ForcedBalance;
    use crate::balance::settings::{Resolution, Settings};
    use crate::balance::solution::PointStatus;
    use crate::balance::sweep::branch::Walk;
    use crate::balance::sweep::forced_curve::ForcedCurve;
    use crate::contact::{Cubic, Jenkins, Residual};
    use crate::model::{Contact, Model};
    use crate::structure::{HarmonicLoad, Structure};
    use faer::{c64, mat, Mat};
    use std::sync::Arc;

    /// Two masses on a hardening spring and a slider.
    fn model() -> Model {
        let structure = Structure::new(
            mat![[1.0, 0.0], [0.0, 0.4]].as_ref(),
            mat![[0.06, -0.02], [-0.02, 0.05]].as_ref(),
            mat![[3.0, -1.0], [-1.0, 2.0]].as_ref(),
        )
        .unwrap();
        let row = |dof: usize| Mat::from_fn(1, 2, |_, j| f64::from(u8::from(j == dof)));
        let contacts = vec![
            Contact { law: Box::new(Cubic::new(0.3).unwrap()), rows: row(0) },
            Contact { law: Box::new(Jenkins::new(2.0, 0.2).unwrap()), rows: row(1) },
        ];
        let amplitude = vec![c64::new(0.5, 0.0), c64::new(0.0, 0.0)];
        Model::new(structure, contacts, vec![HarmonicLoad { harmonic: 1, amplitude }]).unwrap()
    }

    /// More harmonics are no answer to equations that do not hold: the point keeps the status that says so.
    #[test]
    fn a_point_off_the_curve_is_not_told_as_converged() {
        let (model, omega) = (model(), 1.2);
        let few = Resolution { harmonics: 3, samples: None };
        let settings = Settings { tolerance: 1e-6, ..Settings::default() };
        let mut balance = ForcedBalance::new(&model, settings, &[0, 1]).unwrap();
        let last = balance.solve_with(few, omega - 0.01, None).unwrap();
        let solution = balance.solve_with(few, omega, None).unwrap();
        let mut walk = Walk::at_end(&mut balance, vec![Arc::new(last)], (1.0, 2.0));
        let ask = || false;
        let table = walk.balance.table(few.harmonics);
        let given = walk.balance.evaluated(None).unwrap();
        let mut curve = ForcedCurve::new(given, &table, Residual::Centred, &ask);
        let mut z = curve.point(solution.unknowns().unwrap(), omega);
        z[0] *= 1.0 + 1e-6;
        let mut point = walk.solved(&mut curve, &z, few, 0).unwrap().unwrap();
        assert!(point.residual > 1e-8 && point.status == PointStatus::Stalled);
        walk.climb(&mut curve, &mut point, few).unwrap();
        assert_eq!((point.status, point.harmonics), (PointStatus::Stalled, 3));
    }

    /// A point of few harmonics at the end of a range of no length, where the plane across the way to it
    /// meets the curve of more harmonics elsewhere.
    #[test]
    fn a_point_above_the_tolerance_is_not_told_as_converged() {
        let (model, omega) = (model(), 1.2);
        let few = Resolution { harmonics: 3, samples: None };
        for (before, found) in [(omega, false), (omega - 0.01, true)] {
            let settings = Settings { tolerance: 1e-6, ..Settings::default() };
            let mut balance = ForcedBalance::new(&model, settings, &[0, 1]).unwrap();
            let last = balance.solve_with(few, before, None).unwrap();
            let mut point = balance.solve_with(few, omega, None).unwrap();
            assert!(point.is_solved() && last.is_solved());
            let mut walk = Walk::at_end(&mut balance, vec![Arc::new(last)], (omega, omega));
            let ask = || false;
            let table = walk.balance.table(few.harmonics);
            let given = walk.balance.evaluated(None).unwrap();
            let mut curve = ForcedCurve::new(given, &table, Residual::Centred, &ask);
            walk.climb(&mut curve, &mut point, few).unwrap();
            let status = if found { PointStatus::Converged } else { PointStatus::EffortLimit };
            assert_eq!((point.status, point.omega), (status, omega));
            assert_eq!(point.harmonics > 3, found);
        }
    }
}
