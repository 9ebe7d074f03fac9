//! Folds of a branch with as many harmonics and samples as the tolerance asks for.
//!
//! At a fold the curve runs across the frequency. What is left out moves the fold, so that at its own frequency
//! the curve of more harmonics has no point, or one far away: the Newton step there, by which other points are
//! judged, has no bound. So a fold is compared with the curve of more harmonics, or samples, where that meets
//! the plane across the way, as limit cycles are. By how much the frequency differs counts as much as the
//! motion does.

use super::branch::Walk;
use super::forced_curve::ForcedCurve;
use crate::balance::condensed::Condensed;
use crate::balance::extension::Extension;
use crate::balance::sampling::{finer_than, CAUTION};
use crate::balance::settings::{resolving_discarded, Resolution};
use crate::balance::solution::{Point, PointStatus};
use crate::balance::tangent::distance;
use crate::balance::unknowns::Unknowns;
use crate::solve::{across, Advance, Branch, Continuation, Curve as _, Steps};
use crate::structure::Quantity;
use crate::Error;

/// Steps in which the fold of a finer curve is looked for.
const LOOKS: usize = 30;

impl Walk<'_, '_> {
    /// The fold of the curve between three points, with as much resolution as it lacks; nothing if there is
    /// none, or if the analysis is to end.
    pub(super) fn fold(
        &mut self,
        curve: &mut ForcedCurve<'_>,
        resolution: Resolution,
        points: [&Point; 3],
    ) -> Result<Option<Point>, Error> {
        // What the fold asks for its neighbours need not.
        let level = self.balance.control.level;
        let fold = self.climbed(curve, resolution, points);
        self.balance.control.level = level;
        fold
    }

    fn climbed(
        &mut self,
        curve: &mut ForcedCurve<'_>,
        mut kept: Resolution,
        points: [&Point; 3],
    ) -> Result<Option<Point>, Error> {
        let Some(known) = in_unknowns(curve, points) else { return Ok(None) };
        let [a, b, c] = on_curve(curve, known, points.map(|one| one.resolution() == kept));
        let Some(z) = Branch::turn(curve, &a, &b, &c) else { return Ok(None) };
        let Some(mut fold) = self.judged(curve, [&z, &a, &c], kept)? else { return Ok(None) };
        while let Some(more) = self.wanted(&mut fold, kept) {
            kept = more;
            let Some(finer) = self.finer_fold(points, kept)?.filter(Point::is_solved) else {
                fold.status = PointStatus::EffortLimit;
                break;
            };
            fold = finer;
        }
        // What was ended on the way is not what it would have come to.
        Ok((!self.balance.is_ended()).then_some(fold))
    }

    /// The fold of the curve of another resolution near three points.
    fn finer_fold(
        &mut self,
        points: [&Point; 3],
        resolution: Resolution,
    ) -> Result<Option<Point>, Error> {
        let table = self.balance.table(resolution.harmonics);
        let model = self.balance.evaluated(resolution.samples)?;
        let ask = self.balance.interruption();
        let mut curve = ForcedCurve::new(model, &table, self.balance.settings.residual, &ask);
        let Some(known) = in_unknowns(&curve, points) else { return Ok(None) };
        // Of a fold beyond the range the point on this side stands.
        let inside = |z: &[f64]| (self.bounds.0..=self.bounds.1).contains(&z[z.len() - 1]);
        let found = turn_near(&mut curve, &known).filter(|[z, ..]| inside(z));
        let judged = match found {
            Some([z, a, c]) => self.judged(&mut curve, [&z, &a, &c], resolution),
            None => Ok(None),
        };
        self.balance.add_profile(&curve.profile);
        judged
    }

    /// A fold with its errors, between two points of its curve.
    fn judged(
        &mut self,
        curve: &mut ForcedCurve<'_>,
        [z, before, after]: [&[f64]; 3],
        resolution: Resolution,
    ) -> Result<Option<Point>, Error> {
        let Some(mut fold) = self.recovered(curve, z, resolution, 0)? else { return Ok(None) };
        fold.fold = true;
        // At a corner the planes across the ways to it and from it may meet the curve where that between fails.
        let way = |from: &[f64], to: &[f64]| to.iter().zip(from).map(|(b, a)| b - a).collect();
        let ways = [way(before, after), way(before, z), way(z, after)];
        let whole = self.judge_across(curve, z, &mut fold, &ways, resolution)?;
        Ok(whole.then_some(fold))
    }

    /// Writes the errors of a point of the curve by its distance, on the plane across one of some ways, to the
    /// curves of more samples and of more harmonics; `false` if the analysis is to end.
    pub(super) fn judge_across(
        &mut self,
        curve: &ForcedCurve<'_>,
        z: &[f64],
        point: &mut Point,
        ways: &[Vec<f64>],
        resolution: Resolution,
    ) -> Result<bool, Error> {
        let observe = self.balance.observe;
        let slipping = self.balance.nonlinear_points(point);
        if observe.is_empty() || slipping == 0 || !point.is_solved() {
            return Ok(true);
        }
        if let Some(samples) = resolution.samples {
            let finer = Resolution { samples: Some(finer_than(samples)), ..resolution };
            let change = self.change_to(point, ways, finer)?;
            point.sampling_error = change.iter().map(|error| CAUTION * error).collect();
        }
        let harmonics = curve.series(z).harmonics;
        let given = self.balance.evaluated(None)?;
        let effort = self.balance.effort(&given, &harmonics, point);
        let extension = Extension::new(&effort, &harmonics, point.omega, f64::INFINITY);
        let climb = self.balance.control.samples_climb();
        let resolved = self.balance.evaluated(resolution.samples)?.resolves();
        let extension = extension.within(if climb { usize::MAX } else { resolved });
        let least = if climb { resolving_discarded(extension.highest) } else { 0 };
        let samples = resolution.samples.map(|samples| samples.max(least));
        let more = Resolution { harmonics: extension.highest, samples };
        let change = self.change_to(point, ways, more)?;
        let unseen = extension.unseen * self.balance.unseen_of_massless(&harmonics, &extension);
        let errors = change.iter().zip(&point.sampling_error);
        point.error_estimate = errors.map(|(error, own)| unseen * error + own).collect();
        Ok(!self.balance.is_ended())
    }

    /// How far the curve of another resolution is from a point on the plane across a way: sum over all harmonics
    /// of the change of each observed DOF, and its share in the frequency as a share of its size.
    fn change_to(
        &mut self,
        fold: &Point,
        ways: &[Vec<f64>],
        resolution: Resolution,
    ) -> Result<Vec<f64>, Error> {
        let infinite = vec![f64::INFINITY; self.balance.observe.len()];
        let table = self.balance.table(resolution.harmonics);
        let model = self.balance.evaluated(resolution.samples)?;
        let ask = self.balance.interruption();
        let mut curve = ForcedCurve::new(model, &table, self.balance.settings.residual, &ask);
        let Some(unknowns) = &fold.unknowns else { return Ok(infinite) };
        let at = curve.point(unknowns, fold.omega);
        curve.accept(&at);
        let found = ways.iter().find_map(|way| {
            let (rate, shift) = way.split_at(way.len() - 1);
            let along = Unknowns::new(unknowns.harmonics.clone(), rate.to_vec());
            let along = curve.point(&along, shift[0]);
            let before: Vec<f64> = at.iter().zip(&along).map(|(z, way)| z - way).collect();
            across(&mut curve, &before, &at, 1.0)
        });
        let observe = self.balance.observe;
        let errors = match found.as_ref().and_then(|z| Some((z, curve.equations(z)?.0))) {
            Some((z, equations)) => changes(equations, z, observe, fold)?,
            None => infinite,
        };
        self.balance.add_profile(&curve.profile);
        Ok(errors)
    }
}

/// Points in the unknowns of a curve.
fn in_unknowns(curve: &ForcedCurve<'_>, points: [&Point; 3]) -> Option<[Vec<f64>; 3]> {
    let [a, b, c] = points.map(|point| Some(curve.point(point.unknowns()?, point.omega)));
    Some([a?, b?, c?])
}

/// Points that are not `of` a curve, but of one of another resolution, moved onto it: the farthest may be the fold.
fn on_curve(curve: &mut ForcedCurve<'_>, [a, b, c]: [Vec<f64>; 3], of: [bool; 3]) -> [Vec<f64>; 3] {
    let mut moved = |[from, to]: [&[f64]; 2], share: f64, own: bool| {
        (!own).then(|| across(curve, from, to, share)).flatten()
    };
    let [x, y, z] =
        [moved([&a, &b], 0.0, of[0]), moved([&a, &b], 1.0, of[1]), moved([&b, &c], 1.0, of[2])];
    [x.unwrap_or(a), y.unwrap_or(b), z.unwrap_or(c)]
}

/// The fold of a curve that three points lie close to, and a point of the curve on either side of it.
fn turn_near(curve: &mut ForcedCurve<'_>, [a, b, c]: &[Vec<f64>; 3]) -> Option<[Vec<f64>; 3]> {
    let omega = |z: &[f64]| z[z.len() - 1];
    let sign = (omega(b) - omega(a)).signum();
    let longest = distance(a, b).max(distance(b, c));
    let steps = Steps { first: 0.5 * longest, longest, ..super::branch::STEPS };
    curve.accept(a);
    let start = across(curve, a, c, 0.0)?;
    let mut walk = Continuation::new(curve, start.clone(), sign, steps);
    let mut last = [start.clone(), start];
    for _ in 0..LOOKS {
        if walk.advance(curve) != Advance::Point {
            return None;
        }
        let here = walk.point.clone();
        let [before, middle] = &last;
        if (omega(&here) - omega(middle)) * sign < 0.0 {
            let found = Branch::turn(curve, before, middle, &here)?;
            return Some([found, before.clone(), here]);
        }
        last = [middle.clone(), here];
    }
    None
}

/// How far a point of a curve is from a fold of one in fewer harmonics or samples.
fn changes(
    equations: &Condensed<'_>,
    z: &[f64],
    observe: &[usize],
    fold: &Point,
) -> Result<Vec<f64>, Error> {
    let (u, orders) = (&z[..z.len() - 1], fold.harmonics + 1);
    let shift = (equations.omega / fold.omega - 1.0).abs();
    let sizes = fold.displacement.chunks_exact(orders);
    let mut errors: Vec<f64> = sizes
        .map(|own| shift * own[1..].iter().map(|x| x.norm_sqr()).sum::<f64>().sqrt())
        .collect();
    let solution = [u, &equations.slip_load()];
    equations.displacements(Quantity::Whole, solution, observe, |order, observed, _, _| {
        for (dof, error) in errors.iter_mut().enumerate() {
            let before = (order < orders).then(|| fold.displacement[dof * orders + order]);
            *error += before.map_or(observed[dof], |x| observed[dof] - x).norm();
        }
    })?;
    Ok(errors)
}
