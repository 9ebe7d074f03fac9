//! The highest of several motions at a frequency.
//!
//! Where laws are not monotone, a point that is solved by itself may be any of them. There are several if
//! no smooth curve joins two neighbouring samples, however short their interval becomes, or if the search
//! has no answer. Then the curve is followed around its folds by arclength, and the search begins again
//! from its largest motions. If the curve is still higher than what is found, the highest point is in
//! doubt.

use super::first_look::Aim;
use super::samples::Sample;
use super::search::{Doubt, Found, Search};
use crate::balance::{sweep_range, ForcedBalance, PointStatus, Progress, Settings};
use crate::model::Model;
use crate::solve::norm;
use crate::timing::Profile;
use crate::Error;

/// Largest distance of two neighbours from the line with the mean of their slopes, relative to the larger.
const TORN: f64 = 0.25;
/// Halvings of an interval after which they are on different branches, and the same of one that is longer …
const HALVINGS: [usize; 2] = [8, 24];
/// … than this share of the narrowest bandwidth: any resonance turns within that.
const WITHIN: f64 = 0.1;
/// Tolerance of the curve's steps, if that of the harmonics is not larger.
const STEPS: f64 = 0.01;
/// By how much the curve may be higher than what is found: the error of its harmonics and steps.
const HIGHER: f64 = 2e-3;

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
    /// What each group reaches on the curve.
    pub(super) heights: Vec<f64>,
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
    let settings = Settings { tolerance: settings.tolerance.max(STEPS), ..settings };
    let balance = ForcedBalance::new(model, settings, &dofs)?.watched(progress);
    let curve = sweep_range(balance, aim.span.0, aim.span.1)?;
    let mut balance = ForcedBalance::new(model, settings, &[])?.watched(progress);
    let mut search = Search::new(settings.residual, aim, f64::INFINITY, &mut balance);
    let mut samples = Vec::with_capacity(curve.points.len());
    let known = curve.points.iter().filter(|point| !curve.interrupted && point.is_solved());
    for point in known {
        samples.extend(search.sampled(point)?);
    }
    let mut first = 0;
    let heights = aim.groups.iter().map(|group| {
        let own = first..first + group.len();
        first = own.end;
        let heights = samples.iter().flat_map(|one| &one.knots[own.clone()]);
        heights.map(|knot| knot.height).fold(0.0, f64::max)
    });
    let heights = heights.collect();
    let (points, profile) = (curve.points.len(), curve.profile);
    Ok(Uppermost { samples: uppermost(samples), heights, points, profile })
}

/// Those of the samples along a curve above which the curve does not pass, by frequency.
fn uppermost(samples: Vec<Sample>) -> Vec<Sample> {
    let sizes: Vec<f64> = samples.iter().map(|one| norm(one.unknowns.values())).collect();
    let passes_above = |i: usize| {
        (0..samples.len().saturating_sub(1)).filter(|&q| q != i && q + 1 != i).any(|q| {
            let (a, b) = (samples[q].at, samples[q + 1].at);
            let share = (samples[i].at - a) / (b - a);
            (0.0..=1.0).contains(&share) && sizes[q] + share * (sizes[q + 1] - sizes[q]) > sizes[i]
        })
    };
    let kept: Vec<bool> = (0..samples.len()).map(|i| !passes_above(i)).collect();
    let mut out: Vec<Sample> =
        samples.into_iter().zip(kept).filter_map(|(one, kept)| kept.then_some(one)).collect();
    out.sort_by(|a, b| a.at.total_cmp(&b.at));
    out.dedup_by(|b, a| b.at == a.at);
    out
}

/// Of two searches the one whose highest points are those of the curve: Newton's method may have met motions
/// that no curve joins to it. Groups of which the curve is higher are in doubt.
pub(super) fn nearer(before: Found, again: Found, heights: &[f64]) -> Found {
    let height = |found: &Found, group: usize| match &found.tops[group] {
        Ok(top) => found.samples[top.sample].knots[top.curve].height,
        Err(_) => 0.0,
    };
    let off = |found: &Found| -> f64 {
        let groups = heights.iter().enumerate();
        groups.map(|(group, known)| (height(found, group) / known - 1.0).abs()).sum()
    };
    let mut best = if off(&before) < off(&again) { before } else { again };
    for (group, known) in heights.iter().enumerate() {
        if best.tops[group].is_ok() && *known > (1.0 + HIGHER) * height(&best, group) {
            best.tops[group] = Err(Doubt::unsolved(PointStatus::Stalled));
        }
    }
    best
}
