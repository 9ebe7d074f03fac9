//! The highest point of a response over a range of frequencies, whichever of its maxima that is,
//! and of whichever DOF of a group.
//!
//! Every resonance is looked at that load and friction can make the highest. Every point is solved
//! with the exact slopes of all DOFs. Between two points an [`Interpolant`] says how high each curve
//! may be; the interval that promises most is split next, until none promises more than what has
//! been found. Jumps between rival maxima, and between the blades of a disk, are seen, because none
//! is followed by itself.

use super::first_look::{Candidate, FirstLook};
use super::interpolant::{Interpolant, Knot};
use super::samples::{predicted, Sample};
use crate::balance::{ForcedBalance, Linearised, PointStatus, Unknowns};
use crate::contact::Residual;
use crate::fourier::Measure;
use crate::Error;
use std::ops::Range;

/// Share by which an interpolant of that look may err: it may hide a maximum this much higher.
const UNSEEN: f64 = 0.5;
/// The error of an interpolant falls with the fourth power of its width; this times as much is
/// allowed for.
const CAUTION: f64 = 4.0;
/// Splits in a row that may leave more than half of an interval.
const IDLE: u32 = 1;
/// Shortest interval that is split, relative to the frequency.
const SHORTEST: f64 = 1e-9;
/// Points without a solution after which an interval is closed without another attempt.
const MOST_FAILURES: usize = 40;
/// Gain in height, relative, that an interval without a solution must not promise.
const DOUBT: f64 = 1e-6;
/// Distance at which an undamped resonance is passed, relative to the frequency.
const ASIDE: f64 = 1e-8;
/// Resonances closer than this share of a bandwidth to a point are seen from there, …
const SEEN: f64 = 0.1;
/// … and what others overlay if there are points on both sides within this share.
const AROUND: f64 = 0.75;
/// What a resonance may exceed the height by that its load and friction can give it.
const SHARE: f64 = 2.0;
/// Resonances up to this many times as high as the samples beside them are overlaid by others.
const OVERLAID: f64 = 10.0;
/// Gain in height, relative, that a parabola must not promise.
const BROAD: f64 = 1e-4;
/// Gain in height, relative, that the shortest interval must not promise.
const UNRESOLVED: f64 = 1e-3;

/// What is looked for.
#[derive(Debug, Clone)]
pub(super) struct Aim {
    /// DOFs, group by group; the highest of each group is sought.
    pub(super) groups: Vec<Vec<usize>>,
    /// Measure of their amplitudes.
    pub(super) measure: Measure,
    /// Range of frequencies [rad/s].
    pub(super) span: (f64, f64),
    /// Gain in height, relative, that is not worth another point.
    pub(super) gain: f64,
    /// Points after which a search ends in any case.
    pub(super) most_points: usize,
}

/// What is known of an interval between two samples.
#[derive(Debug, Clone)]
struct Gap {
    /// Errors allowed for in the interpolants of all DOFs.
    errors: Vec<f64>,
    /// Where and how high the curves of each group may be.
    promises: Vec<(f64, f64)>,
    /// Splits in a row that have left more than half of it.
    idle: u32,
    /// Whether its inside could not be solved.
    closed: bool,
}

impl Gap {
    /// The share at which it is split: where asked for, or, when that keeps creeping along from an
    /// end, between that and the whole. A resonance that slip has cut off misleads its flanks.
    fn stride(&self, share: f64) -> f64 {
        if self.idle <= IDLE {
            return share;
        }
        if share <= 0.5 {
            share.sqrt().min(0.5)
        } else {
            1.0 - (1.0 - share).sqrt().min(0.5)
        }
    }
}

/// The highest point of a group.
#[derive(Debug, Clone, Copy)]
pub(super) struct Top {
    /// Position of its sample.
    pub(super) sample: usize,
    /// Position of its DOF among those of all groups.
    pub(super) curve: usize,
}

/// Why a highest point is not known.
#[derive(Debug, Clone, Copy)]
pub(super) struct Doubt {
    pub(super) status: PointStatus,
    /// Where the response grows beyond all bounds, not a number if it does not [rad/s].
    pub(super) at: f64,
}

impl Doubt {
    fn unsolved(status: PointStatus) -> Self {
        Self { status, at: f64::NAN }
    }

    fn unbounded(at: f64) -> Self {
        Self { status: PointStatus::Singular, at }
    }
}

/// How a search ended.
pub(super) struct Found {
    /// All points, by frequency.
    pub(super) samples: Vec<Sample>,
    /// The highest point of each group, or why there is none.
    pub(super) tops: Vec<Result<Top, Doubt>>,
}

/// A search under way.
pub(super) struct Search<'a, 'b> {
    residual: Residual,
    aim: &'b Aim,
    dofs: Vec<usize>,
    balance: &'b mut ForcedBalance<'a>,
    samples: Vec<Sample>,
    /// What is known of the intervals between them.
    gaps: Vec<Gap>,
    /// Points without a solution.
    failures: usize,
    /// How the last of them ended.
    failure: Option<PointStatus>,
}

impl<'a, 'b> Search<'a, 'b> {
    pub(super) fn new(
        residual: Residual,
        aim: &'b Aim,
        balance: &'b mut ForcedBalance<'a>,
    ) -> Self {
        let dofs = aim.groups.concat();
        let (samples, gaps) = (Vec::new(), Vec::new());
        Self { residual, aim, dofs, balance, samples, gaps, failures: 0, failure: None }
    }

    /// Finds the highest points from a first look and the samples of a similar response; `None` if
    /// the analysis is to end, or nothing is solved.
    ///
    /// # Errors
    /// As for a solution at one frequency.
    pub(super) fn run(
        mut self,
        look: &FirstLook,
        seeds: &[Sample],
    ) -> Result<Option<Found>, Error> {
        let unbounded = |at: &Option<f64>| at.map(Doubt::unbounded);
        if look.unbounded.iter().all(Option::is_some) {
            let tops = look.unbounded.iter().filter_map(unbounded).map(Err).collect();
            return Ok(Some(Found { samples: self.samples, tops }));
        }
        for &omega in &look.omega {
            let start = self.beside(seeds, omega);
            if let Some(sample) = self.solve(omega, start)? {
                self.insert(sample, vec![UNSEEN; self.dofs.len()]);
            }
            if self.is_interrupted() {
                return Ok(None);
            }
        }
        let mut open = vec![true; look.candidates.len()];
        let mut more = true;
        while more {
            more = self.approach(&look.candidates, &mut open, seeds)?;
            let most_points = self.aim.most_points.max(2 * self.samples.len());
            while self.samples.len() < most_points && !self.is_interrupted() {
                let next = self.most_promising().or_else(|| self.most_suspicious());
                let Some((interval, share)) = next else { break };
                self.split(interval, share)?;
            }
            if self.is_interrupted() {
                return Ok(None);
            }
        }
        let mut tops = Vec::with_capacity(self.aim.groups.len());
        for (group, at) in look.unbounded.iter().enumerate() {
            let Some((sample, curve)) = self.top(group) else { return Ok(None) };
            let doubt = unbounded(at).or_else(|| self.doubt(group));
            tops.push(doubt.map_or(Ok(Top { sample, curve }), Err));
        }
        Ok(Some(Found { samples: self.samples, tops }))
    }

    fn is_interrupted(&self) -> bool {
        self.failure == Some(PointStatus::NotComputed)
    }

    /// Looks at the resonances that may be the highest, those that promise most first; whether there
    /// were any.
    fn approach(
        &mut self,
        candidates: &[Candidate],
        open: &mut [bool],
        seeds: &[Sample],
    ) -> Result<bool, Error> {
        let mut looked = false;
        loop {
            let promising = |&i: &usize| open[i] && self.may_lead(&candidates[i]);
            let reach = |i: usize| candidates[i].reach.iter().copied().fold(0.0, f64::max);
            let next = (0..candidates.len()).filter(promising);
            let Some(next) = next.reduce(|a, b| if reach(b) > reach(a) { b } else { a }) else {
                return Ok(looked);
            };
            (open[next], looked) = (false, true);
            let Candidate { at, bandwidth, ref reach } = candidates[next];
            let mut sample = None;
            for aside in [0.0, -0.5, 0.5] {
                let omega = (at + aside * bandwidth).clamp(self.aim.span.0, self.aim.span.1);
                if sample.is_none() && !self.is_interrupted() && self.failures <= MOST_FAILURES {
                    let start = self.beside(seeds, omega);
                    sample = self.solve(omega, start)?;
                }
            }
            if self.is_interrupted() {
                return Ok(false);
            }
            let Some(sample) = sample else {
                self.close(at, reach);
                continue;
            };
            let overlaid = self.is_overlaid(&candidates[next]);
            self.insert(sample, vec![UNSEEN; self.dofs.len()]);
            for aside in if overlaid { &[-0.5, 0.5][..] } else { &[] } {
                let omega = (at + aside * bandwidth).clamp(self.aim.span.0, self.aim.span.1);
                if let Some(sample) = self.solve(omega, None)? {
                    self.insert(sample, vec![UNSEEN; self.dofs.len()]);
                }
            }
        }
    }

    /// Whether others show as much at a resonance as it does by itself: together they are highest
    /// beside it, and the interpolant, of a resonance alone, does not see that from afar.
    fn is_overlaid(&self, candidate: &Candidate) -> bool {
        candidate.reach.iter().enumerate().any(|(group, reach)| {
            (0.0..OVERLAID * self.beside_height(candidate.at, group)).contains(reach)
        })
    }

    /// The highest of a group at the samples on either side.
    fn beside_height(&self, at: f64, group: usize) -> f64 {
        let after = self.samples.partition_point(|sample| sample.at < at);
        let around = [after.checked_sub(1), Some(after)].into_iter().flatten();
        let around = around.filter_map(|i| self.samples.get(i));
        let heights = around.flat_map(|sample| &sample.knots[self.curves(group)]);
        heights.map(|knot| knot.height).fold(0.0, f64::max)
    }

    /// Whether a resonance that no point has seen may be higher than what has been found.
    fn may_lead(&self, candidate: &Candidate) -> bool {
        let after = self.samples.partition_point(|sample| sample.at < candidate.at);
        let around = [after.checked_sub(1), Some(after)].into_iter().flatten();
        let around: Vec<&Sample> = around.filter_map(|i| self.samples.get(i)).collect();
        let within = |share: f64| {
            let near = (share * candidate.bandwidth).max(2.0 * ASIDE * candidate.at);
            around.iter().filter(|sample| (sample.at - candidate.at).abs() <= near).count()
        };
        if within(SEEN) > 0 && (within(AROUND) == around.len() || !self.is_overlaid(candidate)) {
            return false;
        }
        candidate.reach.iter().enumerate().any(|(group, reach)| {
            let beside = self.beside_height(candidate.at, group);
            *reach > 0.0 && beside + SHARE * reach > self.height(group) * (1.0 + self.aim.gain)
        })
    }

    /// Leaves the interval around an unsolved resonance to doubt.
    fn close(&mut self, at: f64, reach: &[f64]) {
        let after = self.samples.partition_point(|sample| sample.at < at);
        if let Some(gap) = after.checked_sub(1).and_then(|interval| self.gaps.get_mut(interval)) {
            gap.closed = true;
            for (promise, reach) in gap.promises.iter_mut().zip(reach) {
                promise.1 = promise.1.max(*reach);
            }
        }
    }

    /// Adds a sample, with the errors allowed for on both sides of it.
    fn insert(&mut self, sample: Sample, errors: Vec<f64>) {
        let after = self.samples.partition_point(|other| other.at < sample.at);
        let around = [after.checked_sub(1), Some(after)].into_iter().flatten();
        let mut around = around.filter_map(|i| self.samples.get(i));
        if around.any(|other| (other.at - sample.at).abs() <= SHORTEST * sample.at) {
            return;
        }
        self.samples.insert(after, sample);
        let last = self.samples.len() - 1;
        let parts: Vec<Gap> = [after.checked_sub(1), (after < last).then_some(after)]
            .into_iter()
            .flatten()
            .map(|interval| self.gap(interval, errors.clone(), 0))
            .collect();
        let first = after.saturating_sub(1);
        let replaced = usize::from(after > 0 && after < last);
        self.gaps.splice(first..first + replaced, parts);
    }

    /// Positions of the DOFs of a group among all.
    fn curves(&self, group: usize) -> Range<usize> {
        let first = self.aim.groups[..group].iter().map(Vec::len).sum();
        first..first + self.aim.groups[group].len()
    }

    /// Sample and DOF of the highest point of a group.
    fn top(&self, group: usize) -> Option<(usize, usize)> {
        let curves = self.curves(group);
        let all = self.samples.iter().enumerate().flat_map(|(at, sample)| {
            let knots = curves.clone().zip(&sample.knots[curves.clone()]);
            knots.map(move |(curve, knot)| (at, curve, knot.height))
        });
        all.max_by(|a, b| a.2.total_cmp(&b.2)).map(|(at, curve, _)| (at, curve))
    }

    fn height(&self, group: usize) -> f64 {
        self.top(group).map_or(0.0, |(at, curve)| self.samples[at].knots[curve].height)
    }

    /// Why the highest point may lie in a part of the range that could not be solved, that too many
    /// points have left open, or in which the response grows beyond all resolution.
    fn doubt(&self, group: usize) -> Option<Doubt> {
        let (first, last) = (self.samples.first()?, self.samples.last()?);
        let (low, high) = self.aim.span;
        let least = self.height(group) * (1.0 + DOUBT);
        let ends = first.at > low * (1.0 + 2.0 * ASIDE) || last.at < high;
        let promising = |gap: &&Gap| gap.promises[group].1 > least;
        if ends || self.gaps.iter().filter(promising).any(|gap| gap.closed) {
            return Some(Doubt::unsolved(self.failure.unwrap_or(PointStatus::Stalled)));
        }
        for (gap, pair) in self.gaps.iter().zip(self.samples.windows(2)) {
            let short = is_shortest(pair);
            if short && gap.promises[group].1 > self.height(group) * (1.0 + UNRESOLVED) {
                return Some(Doubt::unbounded(pair[0].at));
            }
            if !short && promising(&gap) {
                return Some(Doubt::unsolved(PointStatus::Stalled));
            }
        }
        None
    }

    /// An interval between two samples, with what it promises.
    fn gap(&self, interval: usize, errors: Vec<f64>, idle: u32) -> Gap {
        let (left, right) = (&self.samples[interval].knots, &self.samples[interval + 1].knots);
        let promises = (0..self.aim.groups.len())
            .map(|group| {
                let reference = self.height(group);
                if reference == 0.0 {
                    return (0.5, 0.0);
                }
                self.curves(group)
                    .map(|i| Interpolant::new(left[i], right[i], reference).promise(errors[i]))
                    .fold((0.5, 0.0), |best, one| if one.1 > best.1 { one } else { best })
            })
            .collect();
        Gap { errors, promises, idle, closed: false }
    }

    /// The interval that may hold the highest point, and where to look in it.
    fn most_promising(&self) -> Option<(usize, f64)> {
        let mut best = (None, 1.0 + self.aim.gain);
        for group in 0..self.aim.groups.len() {
            let reference = self.height(group);
            if reference == 0.0 {
                continue;
            }
            for (i, pair) in self.samples.windows(2).enumerate() {
                let gap = &self.gaps[i];
                if gap.closed || is_shortest(pair) {
                    continue;
                }
                let (share, promise) = gap.promises[group];
                if promise / reference > best.1 {
                    best = (Some((i, share)), promise / reference);
                }
            }
        }
        best.0
    }

    /// The interval into which a curve rises from an end, if it may hold the highest point as a
    /// parabola: friction cuts resonances off that broadly, and 1/A² does not see it.
    fn most_suspicious(&self) -> Option<(usize, f64)> {
        let mut best = (None, 1.0 + BROAD);
        for group in 0..self.aim.groups.len() {
            let reference = self.height(group);
            for (i, pair) in self.samples.windows(2).enumerate() {
                if reference == 0.0 || self.gaps[i].closed || is_shortest(pair) {
                    continue;
                }
                for curve in self.curves(group) {
                    let (share, height) =
                        Interpolant::cap(pair[0].knots[curve], pair[1].knots[curve]);
                    if height / reference > best.1 {
                        best = (Some((i, share)), height / reference);
                    }
                }
            }
        }
        best.0
    }

    /// Solves inside an interval.
    fn split(&mut self, interval: usize, share: f64) -> Result<(), Error> {
        let gap = self.gaps[interval].clone();
        let ends = [&self.samples[interval], &self.samples[interval + 1]].map(|sample| sample.at);
        // What is too short to be split would keep an error that nothing has measured.
        let least = (2.0 * SHORTEST * ends[1] / (ends[1] - ends[0])).min(0.5);
        let share = gap.stride(share).clamp(least, 1.0 - least);
        let Some(sample) = self.inside(interval, share)? else {
            // Nothing more is asked of an interval whose inside cannot be solved.
            self.gaps[interval].closed = true;
            return Ok(());
        };
        let (left, right) = (&self.samples[interval], &self.samples[interval + 1]);
        let share = (sample.at - left.at) / (right.at - left.at);
        let bump = 16.0 * (share * (1.0 - share)).powi(2);
        let missed = |i: usize| {
            let (left, right, knot) = (left.knots[i], right.knots[i], sample.knots[i]);
            let reference = left.height.max(right.height).max(knot.height);
            let expected = Interpolant::new(left, right, reference).height(share);
            (expected / knot.height - 1.0).abs().min(1.0) / bump
        };
        let missed: Vec<f64> = (0..self.dofs.len()).map(missed).collect();
        let inside = (0.1..0.9).contains(&share);
        let errors = |part: f64| {
            let allowed = |(error, before): (&f64, &f64)| {
                let allowed = CAUTION * error * part.powi(4);
                // Close to an end the error is small wherever the middle may be.
                if inside {
                    allowed.min(1.0)
                } else {
                    allowed.min(*before)
                }
            };
            missed.iter().zip(&gap.errors).map(allowed).collect::<Vec<f64>>()
        };
        let parts = [share, 1.0 - share].map(errors);
        self.samples.insert(interval + 1, sample);
        let [before, after] = parts;
        let idle = |part: f64| if part > 0.5 { gap.idle + 1 } else { 0 };
        let before = self.gap(interval, before, idle(share));
        let after = self.gap(interval + 1, after, idle(1.0 - share));
        self.gaps.splice(interval..=interval, [before, after]);
        Ok(())
    }

    /// A point inside an interval: at the share asked for, or halfway from there to an end.
    fn inside(&mut self, interval: usize, share: f64) -> Result<Option<Sample>, Error> {
        let (left, right) = (self.samples[interval].at, self.samples[interval + 1].at);
        for share in [share, 0.5 * share, 0.5 * (1.0 + share)] {
            let solved = self.solve(left + share * (right - left), None)?;
            let sample = solved.filter(|sample| left < sample.at && sample.at < right);
            if sample.is_some() || self.is_interrupted() || self.failures > MOST_FAILURES {
                return Ok(sample);
            }
        }
        Ok(None)
    }

    /// Solves at one frequency: from `start` or the samples around it, from the stuck response,
    /// or from either neighbour as it is.
    fn solve(&mut self, omega: f64, start: Option<Unknowns>) -> Result<Option<Sample>, Error> {
        let after = self.samples.partition_point(|sample| sample.at < omega);
        let start = start.or_else(|| predicted(&self.samples, omega));
        let neighbours = [after.checked_sub(1), Some(after)].into_iter().flatten();
        let neighbours: Vec<_> = neighbours
            .filter_map(|i| self.samples.get(i))
            .map(|sample| Some(sample.unknowns.clone()))
            .collect();
        for start in start.map(Some).into_iter().chain([None]).chain(neighbours) {
            let sample = self.attempt(omega, start.as_ref())?;
            if sample.is_some() || self.is_interrupted() {
                return Ok(sample);
            }
            if self.failures > MOST_FAILURES {
                break;
            }
        }
        self.failures += 1;
        Ok(None)
    }

    /// Solves at one frequency from one start.
    fn attempt(&mut self, omega: f64, start: Option<&Unknowns>) -> Result<Option<Sample>, Error> {
        let point = match self.balance.solve(omega, start) {
            Err(Error::UndampedResonance { .. }) => {
                self.balance.solve(omega * (1.0 + ASIDE), start)?
            }
            solved => solved?,
        };
        let (Some(unknowns), true) = (point.unknowns(), point.is_solved()) else {
            self.failure = Some(point.status);
            return Ok(None);
        };
        let table = self.balance.table(unknowns.harmonics().highest());
        let model = self.balance.evaluated(point.samples)?;
        let mut linearised = Linearised::new(&model, &table, self.residual, point.omega, unknowns)?;
        let jets = linearised.frequency_jets(&self.dofs, self.aim.measure)?;
        self.balance.add_profile(linearised.profile());
        let Some((jets, rate)) = jets else {
            self.failure = Some(PointStatus::Singular);
            return Ok(None);
        };
        let at = point.omega;
        let knots = jets.iter().map(|&(height, slope)| Knot { at, height, slope }).collect();
        Ok(Some(Sample { at, knots, unknowns: unknowns.clone(), rate }))
    }

    /// A start from a similar response: its solution, moved by as much as the nearest sample
    /// differs from it.
    fn beside(&self, seeds: &[Sample], omega: f64) -> Option<Unknowns> {
        let mut start = predicted(seeds, omega)?;
        let distance = |sample: &Sample| (sample.at - omega).abs();
        let nearest = self.samples.iter().min_by(|a, b| distance(a).total_cmp(&distance(b)));
        if let Some(near) = nearest {
            let similar = predicted(seeds, near.at)?.recast(near.unknowns.harmonics());
            let harmonics = near.unknowns.harmonics().clone();
            let values = start.recast(&harmonics);
            let moves = near.unknowns.values().iter().zip(&similar);
            let values = values.iter().zip(moves).map(|(x, (new, old))| x + (new - old));
            start = Unknowns::new(harmonics, values.collect());
        }
        Some(start)
    }
}

/// Whether an interval is too short to be split.
fn is_shortest(ends: &[Sample]) -> bool {
    ends[1].at - ends[0].at <= SHORTEST * ends[1].at
}
