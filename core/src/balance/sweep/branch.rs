//! A branch of a curve over a range of frequencies where solutions may not be unique: followed by arclength,
//! around its folds, with steps chosen to the tolerance. It ends where it leaves the range, at either end, or
//! where it closes.

use super::course::Course;
use super::forced_curve::ForcedCurve;
use super::stops::{stops, LONGEST};
use crate::balance::forced::ForcedBalance;
use crate::balance::keep;
use crate::balance::settings::Resolution;
use crate::balance::solution::{CurveEnd, Point, PointStatus};
use crate::balance::tangent::distance;
use crate::solve::{between, Advance, Continuation, Curve as _, Steps};
use crate::Error;
use std::sync::Arc;

/// Most points of a curve at this tolerance: lines between them err by the square of their distance, …
const MOST: (f64, f64) = (5000.0, 1e-3);
/// … and most evaluations of its equations: so many per point, and so many more for a few hard places.
const EVALUATIONS: [usize; 2] = [100, 6000];
/// Points after one that asked for more harmonics or samples at which no fewer are tried.
const PATIENCE: usize = 4;
/// Steps, relative to the motion and to the frequency. At first touch of a stop the curve bends within
/// thousandths of the gap.
pub(super) const STEPS: Steps =
    Steps { first: 1e-2, shortest: 1e-7, longest: 0.15, max_iterations: 12 };
/// A step goes at most by this share of its distance to the next resonance, or by its bandwidth: what
/// is narrow must not be stepped over.
const NEAR: f64 = 0.5;
/// Shortest step, as a share of the longest, that is refused for the bend of the curve.
const SHORT: f64 = 1e-4;

/// A curve on its way.
pub(super) struct Walk<'a, 'b> {
    pub(super) balance: &'b mut ForcedBalance<'a>,
    pub(super) points: Vec<Arc<Point>>,
    /// Orientation of the curve in its direction, the same in whatever harmonics; 0 where it is not known.
    pub(super) orientation: f64,
    /// Whether it began inside the range.
    pub(super) inside: bool,
    /// Resonances with their bandwidths.
    stops: Vec<(f64, f64)>,
    pub(super) bounds: (f64, f64),
    longest: f64,
    /// Number of points when the resolution was last raised, or could not be lowered.
    pub(super) raised: usize,
    /// Evaluations of the equations at the resolutions so far.
    evaluations: usize,
}

/// The branch from a point of it towards the end of a range, and how it ended.
pub(super) fn branch_through(
    balance: &mut ForcedBalance<'_>,
    first: Arc<Point>,
    (from, to): (f64, f64),
    bounds: (f64, f64),
) -> Result<(Vec<Arc<Point>>, CurveEnd), Error> {
    let stops = stops(balance, &first, from, to)?;
    let longest = LONGEST * (bounds.1 - bounds.0);
    let inside = bounds.0 < from && from < bounds.1;
    walk(balance, first, (to, bounds, inside), (stops, longest))
}

/// The part of a branch from a point of its course to the frequency of another one, or to the end of the range,
/// and how it ended.
///
/// # Errors
/// As for a solution at one frequency.
pub(crate) fn branch_piece(
    balance: &mut ForcedBalance<'_>,
    course: &Course,
    first: Arc<Point>,
    last: Option<&Arc<Point>>,
) -> Result<(Vec<Arc<Point>>, CurveEnd), Error> {
    if !first.is_solved() {
        let ended = first.status == PointStatus::NotComputed;
        let end = if ended { CurveEnd::Interrupted } else { CurveEnd::Stalled };
        return Ok((vec![first], end));
    }
    let (from, to) = (first.omega, last.map_or(course.range.1, |last| last.omega));
    let bounds = (from.min(to), from.max(to));
    from_seam(balance, course, first, (to, bounds))
}

/// The branch from a point of its course towards the end of the range, around all its folds.
///
/// # Errors
/// As for a solution at one frequency.
pub(super) fn branch_on(
    balance: &mut ForcedBalance<'_>,
    course: &Course,
    first: Arc<Point>,
) -> Result<(Vec<Arc<Point>>, CurveEnd), Error> {
    let (from, to) = course.range;
    from_seam(balance, course, first, (to, (from.min(to), from.max(to))))
}

fn from_seam(
    balance: &mut ForcedBalance<'_>,
    course: &Course,
    first: Arc<Point>,
    (to, bounds): (f64, (f64, f64)),
) -> Result<(Vec<Arc<Point>>, CurveEnd), Error> {
    course.lead(balance);
    keep(balance.kept, &first);
    // It comes from the end of the range, so that it cannot close.
    walk(balance, first, (to, bounds, false), (course.stops.clone(), course.longest()))
}

fn walk(
    balance: &mut ForcedBalance<'_>,
    first: Arc<Point>,
    (to, bounds, inside): (f64, (f64, f64), bool),
    (stops, longest): (Vec<(f64, f64)>, f64),
) -> Result<(Vec<Arc<Point>>, CurveEnd), Error> {
    // What estimates have learnt is of another motion.
    balance.neighbour = Default::default();
    let (from, points) = (first.omega, vec![first]);
    let mut walk = Walk { inside, stops, longest, ..Walk::at_end(balance, points, bounds) };
    let end = walk.follow(from, to)?;
    // Nothing ahead is found once nothing is looked for.
    let ended = end != CurveEnd::Range && walk.balance.is_ended();
    Ok((walk.points, if ended { CurveEnd::Interrupted } else { end }))
}

impl<'a, 'b> Walk<'a, 'b> {
    /// A walk that has come to the last of some points, and goes no further.
    pub(super) fn at_end(
        balance: &'b mut ForcedBalance<'a>,
        points: Vec<Arc<Point>>,
        bounds: (f64, f64),
    ) -> Self {
        Self {
            balance,
            points,
            orientation: 0.0,
            inside: false,
            stops: Vec::new(),
            bounds,
            longest: 0.0,
            raised: 0,
            evaluations: 0,
        }
    }
}

impl Walk<'_, '_> {
    fn follow(&mut self, from: f64, to: f64) -> Result<CurveEnd, Error> {
        let mut resolution = self.points[0].resolution();
        let mut walk: Option<(Continuation, Resolution)> = None;
        let ask = self.balance.interruption();
        // Each round at one resolution.
        loop {
            let table = self.balance.table(resolution.harmonics);
            let model = self.balance.evaluated(resolution.samples)?;
            let residual = self.balance.settings.residual;
            let mut curve = ForcedCurve::new(model, &table, residual, &ask);
            let last = self.last();
            let Some(unknowns) = &last.unknowns else { return Ok(CurveEnd::Stalled) };
            let here = curve.point(unknowns, last.omega);
            let mut ahead = match walk.take() {
                None => Continuation::new(&mut curve, here, (to - from).signum(), STEPS),
                Some((known, before)) => {
                    let finest = resolution.or_finer(before);
                    match self.beside(&mut curve, &known, &here) {
                        (ahead, true) => ahead,
                        (ahead, false) if finest == resolution => ahead,
                        (_, false) => {
                            self.raised = self.points.len();
                            (resolution, walk) = (finest, Some((known, finest)));
                            continue;
                        }
                    }
                }
            };
            let change = self.stretch(&mut curve, &mut ahead, resolution, (from, to))?;
            let profile = curve.profile;
            self.evaluations += profile.evaluations;
            self.balance.add_profile(&profile);
            match change {
                Change::Ends(end) => return Ok(end),
                Change::Resolution(next) => {
                    walk = Some((ahead, resolution));
                    resolution = next;
                }
            }
        }
    }

    /// Goes on at one resolution.
    fn stretch(
        &mut self,
        curve: &mut ForcedCurve<'_>,
        walk: &mut Continuation,
        resolution: Resolution,
        (from, to): (f64, f64),
    ) -> Result<Change, Error> {
        loop {
            let share = ((self.last().omega - from) / (to - from)).clamp(0.0, 1.0);
            if !self.balance.report(share) {
                return Ok(Change::Ends(CurveEnd::Interrupted));
            }
            curve.affordable = self.affordable();
            if self.points.len() >= self.most() || curve.is_spent() {
                return Ok(Change::Ends(CurveEnd::Points));
            }
            let before = walk.clone();
            match walk.advance(curve) {
                Advance::Stalled => return Ok(Change::Ends(CurveEnd::Stalled)),
                Advance::Interrupted if curve.is_spent() => continue,
                Advance::Interrupted => return Ok(Change::Ends(CurveEnd::Interrupted)),
                Advance::Point => {}
            }
            let (known, mut z) = (before.point.clone(), walk.point.clone());
            let omega = z[z.len() - 1];
            let length = distance(&known, &z);
            let cap = self.longest_step(known[known.len() - 1]);
            let step = (omega - known[known.len() - 1]).abs();
            if step > 1.5 * cap && length > SHORT * STEPS.longest {
                self.step_back(curve, walk, before, cap / step);
                continue;
            }
            let mut end = None;
            if omega < self.bounds.0 || omega > self.bounds.1 {
                let edge = if omega < self.bounds.0 { self.bounds.0 } else { self.bounds.1 };
                end = Some(if edge == to { CurveEnd::Range } else { CurveEnd::Returned });
                match between(curve, &known, &z, edge) {
                    Some((at, _)) => z = at,
                    None => return Ok(Change::Ends(CurveEnd::Stalled)),
                }
            }
            if let Some(at) = self.closed(curve, &known, &z) {
                (z, end) = (at, Some(CurveEnd::Closed));
            }
            let iterations = walk.iterations - before.iterations;
            let Some(mut point) = self.solved(curve, &z, resolution, iterations)? else {
                return Ok(Change::Ends(CurveEnd::Interrupted));
            };
            self.orientation = walk.orientation;
            let (kept, lacking) = self.climb(curve, &mut point, resolution)?;
            if let Some(raised) = lacking.map(|more| self.retreat(more)).transpose()?.flatten() {
                return Ok(Change::Resolution(raised));
            }
            if end.is_none() && kept == resolution {
                let tolerance = self.balance.settings.tolerance;
                let error = self.line_error(&point, length).unwrap_or(0.81 * tolerance);
                let factor = (0.9 * (tolerance / error.max(1e-12)).sqrt()).clamp(0.3, 2.0);
                if error > 2.0 * tolerance && length > SHORT * STEPS.longest {
                    self.step_back(curve, walk, before, factor);
                    continue;
                }
                walk.limit_step((length * factor).max(SHORT * STEPS.longest));
            }
            self.add_fold(curve, resolution, &point)?;
            // What was ended on the way lacks harmonics, or a fold before it.
            if self.balance.is_ended() {
                return Ok(Change::Ends(CurveEnd::Interrupted));
            }
            self.push(point);
            if let Some(end) = end {
                return Ok(Change::Ends(end));
            }
            let mut next = self.balance.control.first();
            if kept != resolution {
                self.raised = self.points.len();
                next = kept.or_finer(next);
            } else if self.points.len() < self.raised + PATIENCE {
                next = resolution.or_finer(next);
            }
            if next != resolution {
                return Ok(Change::Resolution(next));
            }
        }
    }

    /// Points that the tolerance may take.
    fn most(&self) -> usize {
        let (most, tolerance) = MOST;
        (most * (tolerance / self.balance.settings.tolerance).sqrt().max(1.0)) as usize
    }

    /// Evaluations that may be made at this resolution until the next point.
    fn affordable(&self) -> usize {
        let all = EVALUATIONS[0] * self.points.len() + EVALUATIONS[1];
        all.saturating_sub(self.evaluations)
    }

    pub(super) fn last(&self) -> &Point {
        &self.points[self.points.len() - 1]
    }

    pub(super) fn push(&mut self, point: Point) {
        if point.is_solved() {
            self.balance.scale.include(&point);
        }
        let point = Arc::new(point);
        keep(self.balance.kept, &point);
        self.points.push(point);
    }

    /// Takes a step again, shorter.
    fn step_back(
        &self,
        curve: &mut ForcedCurve<'_>,
        walk: &mut Continuation,
        before: Continuation,
        factor: f64,
    ) {
        let iterations = walk.iterations;
        let taken = distance(&before.point, &walk.point);
        *walk = before;
        walk.iterations = iterations;
        walk.limit_step((factor * taken).max(STEPS.shortest));
        curve.accept(&walk.point);
    }

    /// Longest step in frequency from here.
    fn longest_step(&self, omega: f64) -> f64 {
        let room = |&(at, width): &(f64, f64)| (NEAR * (at - omega).abs()).max(width);
        self.stops.iter().map(room).fold(self.longest, f64::min).max(1e-6 * self.longest)
    }

    /// Displacements, forces and error of a point of the curve; nothing if the analysis is to end.
    pub(super) fn solved(
        &mut self,
        curve: &mut ForcedCurve<'_>,
        z: &[f64],
        resolution: Resolution,
        iterations: usize,
    ) -> Result<Option<Point>, Error> {
        let Some(mut point) = self.recovered(curve, z, resolution, iterations)? else {
            return Ok(None);
        };
        let u = &z[..z.len() - 1];
        let Some((equations, _)) = curve.equations(z) else { return Ok(None) };
        let ended = point.is_solved()
            && !self.balance.observe.is_empty()
            && !self.balance.estimate(equations, u, &mut point, true)?;
        // What a search was to find that was ended is not where it was found.
        Ok((!ended && !self.balance.is_ended()).then_some(point))
    }

    /// Displacements and forces of a point of the curve, which says so if its equations do not hold; nothing where
    /// they are not defined.
    pub(super) fn recovered(
        &self,
        curve: &mut ForcedCurve<'_>,
        z: &[f64],
        resolution: Resolution,
        iterations: usize,
    ) -> Result<Option<Point>, Error> {
        let unknowns = Some(curve.series(z));
        let Some((equations, residual)) = curve.equations(z) else { return Ok(None) };
        let u = &z[..z.len() - 1];
        let balanced = self.balance.is_balanced(residual);
        let status = if balanced { PointStatus::Converged } else { PointStatus::Stalled };
        let mut point = equations.recover(u, self.balance.observe, status)?;
        if balanced {
            point.error_estimate.fill(0.0);
            point.sampling_error.fill(0.0);
        }
        let samples = resolution.samples;
        Ok(Some(Point { samples, residual, iterations, unknowns, ..point }))
    }

    /// Largest relative distance of the observed DOFs from a straight line between the last point and
    /// `new`, from the curvature through the last three points along the curve.
    fn line_error(&self, new: &Point, step: f64) -> Option<f64> {
        let [.., before, last] = &self.points[..] else { return None };
        let earlier = {
            let table_of = |p: &Point| p.unknowns.clone();
            let (a, b) = (table_of(before)?, table_of(last)?);
            let mut from = a.recast(&b.harmonics);
            from.push(before.omega);
            let mut to = b.values;
            to.push(last.omega);
            distance(&from, &to)
        };
        let steps = [earlier.max(f64::MIN_POSITIVE), step];
        Some(self.balance.scale.of_line([before, last, new], steps))
    }
}

/// What ends a stretch.
enum Change {
    Resolution(Resolution),
    Ends(CurveEnd),
}
