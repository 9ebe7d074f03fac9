//! The highest of several motions at a frequency.
//!
//! Where laws are not monotone, a point that is solved by itself may be any of them. There are several if
//! no smooth curve joins two neighbouring samples, however short their interval becomes, if they lead to no
//! motion between them, or if the search has no answer. A search that went on would split intervals beside
//! jumps without end. So the curve is followed around its folds by arclength, and its highest point counts
//! where that of the search is not higher. If the curve cannot be followed to its end, the search begins
//! again from its largest motions, and goes on to its own end.

use super::envelope::Envelope;
use super::first_look::Aim;
use super::interpolant::Interpolant;
use super::samples::{predicted, Sample};
use super::search::{Found, Search, Top};
use crate::balance::{sweep_range, CurveEnd, ForcedBalance, Progress, Settings};
use crate::model::Model;
use crate::solve::norm;
use crate::timing::Profile;
use crate::Error;
use std::ops::Range;

/// Largest distance of two neighbours from the line with the mean of their slopes, relative to the larger.
const TORN: f64 = 0.25;
/// Halvings of an interval after which they are on different branches, and the same of one that is longer …
const HALVINGS: [usize; 2] = [8, 24];
/// … than this share of the narrowest bandwidth: any resonance turns within that.
const WITHIN: f64 = 0.1;
/// Tolerance of the curve's steps: straight lines between its points err by so much, or twice.
const STEPS: f64 = 1e-3;
/// How far below the highest point neighbours are between which a higher one may lie: their lines, …
const BELOW: f64 = 5.0 * STEPS;
/// … and gain in height, relative, for which it is looked for.
const GAIN: f64 = 1e-4;
/// Most steps towards it.
const MOST: usize = 12;

/// Whether a smooth curve goes from one sample to another, as far as their slopes tell.
fn are_joined(a: &Sample, b: &Sample) -> bool {
    let half = 0.5 * (b.at - a.at);
    let (from, to) = (a.unknowns.values(), b.unknowns.values());
    let ways = from.iter().zip(to).zip(a.rate.iter().zip(&b.rate));
    let missed: Vec<f64> = ways.map(|((x, y), (dx, dy))| y - x - half * (dx + dy)).collect();
    from.len() == to.len() && norm(&missed) <= TORN * norm(from).max(norm(to))
}

impl Search<'_, '_> {
    /// Whether some neighbours are on different branches.
    ///
    /// # Errors
    /// As for a solution at one frequency.
    pub(super) fn is_torn(&mut self) -> Result<bool, Error> {
        for right in 1..self.envelope.samples.len() {
            let pair = [right - 1, right].map(|i| self.envelope.samples[i].clone());
            if self.are_apart(pair)? {
                return Ok(true);
            }
        }
        Ok(false)
    }

    /// Whether the ends of an interval within the narrowest bandwidth are on different branches.
    ///
    /// # Errors
    /// As for a solution at one frequency.
    pub(super) fn is_torn_at(&mut self, interval: usize) -> Result<bool, Error> {
        let [a, b] = [interval, interval + 1].map(|i| &self.envelope.samples[i]);
        let within = b.at - a.at <= WITHIN * self.narrowest * b.at;
        if !within || are_joined(a, b) {
            return Ok(false);
        }
        self.are_apart([a.clone(), b.clone()])
    }

    /// A point in the middle between two others.
    pub(super) fn between(&mut self, a: &Sample, b: &Sample) -> Result<Option<Sample>, Error> {
        let omega = 0.5 * (a.at + b.at);
        let start = predicted(&[a.clone(), b.clone()], omega);
        let found = self.attempt(omega, start.as_ref())?;
        Ok(found.filter(|one| a.at < one.at && one.at < b.at))
    }

    /// Whether two samples are on different branches: shorter intervals do not join them.
    pub(super) fn are_apart(&mut self, [mut a, mut b]: [Sample; 2]) -> Result<bool, Error> {
        let mut halvings = 0;
        while !are_joined(&a, &b) {
            let wide = b.at - a.at > WITHIN * self.narrowest * b.at;
            let most = HALVINGS[usize::from(wide)];
            let middle = if halvings < most { self.between(&a, &b)? } else { None };
            let Some(middle) = middle else { return Ok(true) };
            if are_joined(&a, &middle) {
                a = middle;
            } else {
                b = middle;
            }
            halvings += 1;
        }
        Ok(false)
    }
}

/// The largest motions of a curve.
pub(super) struct Uppermost {
    /// By frequency; none if the analysis is to end.
    pub(super) samples: Vec<Sample>,
    /// The highest point of each group, and the position of its DOF among those of all groups.
    pub(super) tops: Vec<Option<(Sample, usize)>>,
    /// Whether it was followed to its end.
    pub(super) complete: bool,
    /// Points of the curve, …
    pub(super) points: usize,
    /// … and work for them.
    pub(super) profile: Profile,
}

/// The largest motions of the curve of what is looked for.
///
/// # Errors
/// As for a curve over a range.
pub(super) fn upper_branch(
    model: &Model,
    settings: Settings,
    aim: &Aim,
    progress: &Progress<'_>,
) -> Result<Uppermost, Error> {
    let dofs = aim.groups.concat();
    let settings = Settings { tolerance: STEPS, ..settings };
    let balance = ForcedBalance::new(model, settings, &dofs)?.watched(progress);
    let curve = sweep_range(balance, aim.span.0, aim.span.1)?;
    let mut balance = ForcedBalance::new(model, settings, &[])?.watched(progress);
    let mut search = Search::new(settings.residual, aim, f64::INFINITY, &mut balance);
    let mut branches = vec![Vec::new()];
    for point in curve.points.iter().filter(|_| !curve.interrupted) {
        if !point.is_solved() {
            branches.push(Vec::new());
        }
        if let (Some(sample), Some(branch)) = (search.sampled(point)?, branches.last_mut()) {
            branch.push(sample);
        }
    }
    let (mut tops, mut first) = (Vec::with_capacity(aim.groups.len()), 0);
    for (group, dofs) in aim.groups.iter().enumerate() {
        let own = first..first + dofs.len();
        first = own.end;
        tops.push(search.top_along(&branches, group, own)?);
    }
    let complete = curve.end == CurveEnd::Range;
    let mut profile = curve.profile;
    profile.add(&balance.into_profile());
    let points = curve.points.len();
    Ok(Uppermost { samples: uppermost(&branches), tops, complete, points, profile })
}

impl Search<'_, '_> {
    /// The highest point of a group on some branches, with its curve: one of their points, or one between two of
    /// them towards which the curve rises from both.
    fn top_along(
        &mut self,
        branches: &[Vec<Sample>],
        group: usize,
        curves: Range<usize>,
    ) -> Result<Option<(Sample, usize)>, Error> {
        let all = branches.iter().flatten().flat_map(|one| curves.clone().map(move |i| (one, i)));
        let height = |(one, curve): &(&Sample, usize)| one.knots[*curve].height;
        let highest = all.max_by(|a, b| height(a).total_cmp(&height(b)));
        let Some(mut best) = highest.map(|(one, curve)| (one.clone(), curve)) else {
            return Ok(None);
        };
        let least = (1.0 - BELOW) * best.0.knots[best.1].height;
        let mut rises = Vec::new();
        for pair in branches.iter().flat_map(|branch| branch.windows(2)) {
            let order = if pair[0].at < pair[1].at { [0, 1] } else { [1, 0] };
            let [a, b] = order.map(|i| &pair[i]);
            for curve in curves.clone().filter(|_| a.at < b.at) {
                let (left, right) = (a.knots[curve], b.knots[curve]);
                let near = left.height.max(right.height) > least;
                if near && left.slope > 0.0 && right.slope < 0.0 {
                    rises.push((Interpolant::tangent(left, right).1, a, b));
                }
            }
        }
        rises.sort_by(|a, b| b.0.total_cmp(&a.0));
        for (reach, a, b) in rises {
            let height = best.0.knots[best.1].height;
            if reach <= (1.0 + GAIN) * height {
                break;
            }
            self.climb([a, b], group)?;
            if let Some((top, curve)) = self.envelope.top(group) {
                let top = &self.envelope.samples[top];
                if top.knots[curve].height > height {
                    best = (top.clone(), curve);
                }
            }
        }
        Ok(Some(best))
    }

    /// Goes from two neighbours on a branch to the top between them.
    fn climb(&mut self, pair: [&Sample; 2], group: usize) -> Result<(), Error> {
        let (sizes, caution) = (self.aim.groups.iter().map(Vec::len), self.aim.precision.caution);
        self.envelope = Envelope::new(sizes, self.narrowest, caution);
        pair.into_iter().for_each(|one| self.envelope.insert(one.clone()));
        for _ in 0..MOST {
            let Some((interval, share)) = self.envelope.stationary(group, self.aim.precision.flat)
            else {
                break;
            };
            let ends = &self.envelope.samples[interval..interval + 2];
            let [left, right] = [ends[0].at, ends[1].at];
            let omega = left + share * (right - left);
            let start = predicted(ends, omega);
            let found = self.attempt(omega, start.as_ref())?;
            let Some(found) = found.filter(|one| left < one.at && one.at < right) else { break };
            self.envelope.split(interval, found);
        }
        Ok(())
    }
}

/// Those of the samples along some branches above which no branch passes, by frequency.
fn uppermost(branches: &[Vec<Sample>]) -> Vec<Sample> {
    let size = |one: &Sample| norm(one.unknowns.values());
    let lines = || branches.iter().flat_map(|branch| branch.windows(2));
    let passes_above = |one: &&Sample| {
        lines().filter(|ends| !ends.iter().any(|end| std::ptr::eq(end, *one))).any(|ends| {
            let share = (one.at - ends[0].at) / (ends[1].at - ends[0].at);
            let [from, to] = [size(&ends[0]), size(&ends[1])];
            (0.0..=1.0).contains(&share) && from + share * (to - from) > size(one)
        })
    };
    let kept = branches.iter().flatten().filter(|one| !passes_above(one));
    let mut out: Vec<Sample> = kept.cloned().collect();
    out.sort_by(|a, b| a.at.total_cmp(&b.at));
    out.dedup_by(|b, a| b.at == a.at);
    out
}

impl Found {
    /// With the points of a curve that are higher than what it has found, where anything bounds that.
    pub(super) fn with_higher(mut self, tops: Vec<Option<(Sample, usize)>>) -> Self {
        for (group, (sample, curve)) in
            tops.into_iter().enumerate().filter_map(|(i, top)| Some((i, top?)))
        {
            let Ok(known) = self.tops[group] else { continue };
            if sample.knots[curve].height <= self.samples[known.sample].knots[known.curve].height {
                continue;
            }
            let last = self.samples.last().is_some_and(|last| last.at <= sample.at);
            let before = self.samples.partition_point(|one| one.at < sample.at);
            let place = if last { self.samples.len() } else { before };
            for top in self.tops.iter_mut().flatten() {
                top.sample += usize::from(top.sample >= place);
            }
            self.samples.insert(place, sample);
            self.tops[group] = Ok(Top { sample: place, curve });
        }
        self
    }
}
