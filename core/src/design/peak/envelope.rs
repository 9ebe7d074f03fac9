//! What solved points and their slopes say of the curves between them: how high each may be.

use super::interpolant::{Interpolant, Knot};
use super::samples::Sample;
use std::ops::Range;

/// Share by which an interpolant that no point has confirmed may err: it may hide a maximum this
/// much higher.
const UNSEEN: f64 = 0.5;
/// Share by which a curve may rise above the higher end of an interval in which no point has confirmed
/// the interpolant: one point inside has to tell.
const UNCONFIRMED: f64 = 0.1;
/// Share of what was allowed for that remains at least, however well a point agrees: one may agree
/// by chance.
const CHANCE: f64 = 1e-2;
/// Gain in height, relative, that a tangent must not promise.
const BROAD: f64 = 1e-4;
/// Splits in a row that may leave more than half of an interval.
const IDLE: u32 = 1;
/// Shortest interval that is split, as a share of the narrowest bandwidth, …
const OF_BANDWIDTH: f64 = 1e-3;
/// … and relative to the frequency: what friction alone bounds may be as narrow as rounding leaves it.
const SHORTEST: [f64; 2] = [1e-14, 1e-9];
/// Share of a height that solutions leave open.
const LEFT_OPEN: f64 = 1e-10;

/// Part of an interval in which it is split if all of it is to be looked at.
const MIDDLE: [f64; 2] = [0.25, 0.75];

/// Where and how high a curve between two points may be.
fn promised([left, right]: [Knot; 2], error: f64, reference: f64) -> (f64, f64) {
    let tangent = Interpolant::tangent(left, right);
    let tangent = (tangent.1 > (1.0 + BROAD) * reference).then_some(tangent);
    let end = left.height.max(right.height);
    let unconfirmed = (error == UNSEEN).then_some((0.5, (1.0 + UNCONFIRMED) * end));
    let cubic = Interpolant::new(left, right, reference).promise(error);
    higher(tangent.into_iter().chain(unconfirmed).chain([cubic]))
}

/// The first of the highest.
fn higher(promises: impl Iterator<Item = (f64, f64)>) -> (f64, f64) {
    promises.fold((0.5, 0.0), |best, one| if one.1 > best.1 { one } else { best })
}

/// What is known of an interval between two samples.
#[derive(Debug, Clone)]
pub(super) struct Gap {
    /// Errors allowed for in the interpolants of all curves and of their ceilings.
    errors: Vec<f64>,
    /// Where and how high the curves of each group may be.
    pub(super) promises: Vec<(f64, f64)>,
    /// Splits in a row that have left more than half of it.
    idle: u32,
    /// Whether its inside could not be solved.
    pub(super) closed: bool,
}

impl Gap {
    /// Whether no point inside has confirmed what it promises.
    pub(super) fn is_unconfirmed(&self) -> bool {
        self.errors.contains(&UNSEEN)
    }
}

/// Samples in order, and what is known of the intervals between them.
#[derive(Debug)]
pub(super) struct Envelope {
    /// Curves, group by group.
    groups: Vec<Range<usize>>,
    pub(super) samples: Vec<Sample>,
    gaps: Vec<Gap>,
    /// Shortest interval that is split, relative to the frequency.
    shortest: f64,
    /// The error of an interpolant falls with the fourth power of its width; this times as much is
    /// allowed for.
    caution: f64,
}

impl Envelope {
    /// Of groups of so many curves, without samples; the narrowest bandwidth is relative to the frequency.
    pub(super) fn new(sizes: impl Iterator<Item = usize>, narrowest: f64, caution: f64) -> Self {
        let [least, most] = SHORTEST;
        let mut last = 0;
        let groups = sizes.map(|size| {
            last += size;
            last - size..last
        });
        Self {
            groups: groups.collect(),
            samples: Vec::new(),
            gaps: Vec::new(),
            shortest: (OF_BANDWIDTH * narrowest).clamp(least, most),
            caution,
        }
    }

    /// The samples on either side of a frequency.
    pub(super) fn around(&self, at: f64) -> impl Iterator<Item = &Sample> + Clone {
        let after = self.samples.partition_point(|sample| sample.at < at);
        self.samples[after.saturating_sub(1)..(after + 1).min(self.samples.len())].iter()
    }

    /// The highest of a group at the samples on either side.
    pub(super) fn beside(&self, at: f64, group: usize) -> f64 {
        self.around(at).map(|sample| self.height_of(sample, group)).fold(0.0, f64::max)
    }

    /// The highest of a group at a sample.
    pub(super) fn height_of(&self, sample: &Sample, group: usize) -> f64 {
        sample.knots[self.groups[group].clone()].iter().map(|knot| knot.height).fold(0.0, f64::max)
    }

    /// Sample and curve of the highest point of a group, the flattest of those that are equal.
    pub(super) fn top(&self, group: usize) -> Option<(usize, usize)> {
        let least = self.height(group) * (1.0 - LEFT_OPEN);
        let all = self.samples.iter().enumerate().flat_map(|(at, sample)| {
            let knots = self.groups[group].clone().zip(&sample.knots[self.groups[group].clone()]);
            knots.map(move |(curve, knot)| ((at, curve), knot))
        });
        let highest = all.filter(|(_, knot)| knot.height >= least);
        highest.min_by(|a, b| a.1.slope.abs().total_cmp(&b.1.slope.abs())).map(|(top, _)| top)
    }

    /// Height of the highest point of a group.
    pub(super) fn height(&self, group: usize) -> f64 {
        self.samples.iter().map(|sample| self.height_of(sample, group)).fold(0.0, f64::max)
    }

    /// The intervals with their ends.
    pub(super) fn intervals(&self) -> impl Iterator<Item = (&Gap, &[Sample])> {
        self.gaps.iter().zip(self.samples.windows(2))
    }

    /// The interval whose promise exceeds the highest point of its group most, by the share `gain`
    /// at least, and where to look in it.
    pub(super) fn most_promising(&self, gain: f64) -> Option<(usize, f64)> {
        let mut best = (None, 1.0 + gain);
        for group in 0..self.groups.len() {
            let reference = self.height(group);
            for (i, (gap, ends)) in self.intervals().enumerate() {
                let (share, promise) = gap.promises[group];
                if !gap.closed && !self.is_shortest(ends) && promise > best.1 * reference {
                    best = (Some((i, share)), promise / reference);
                }
            }
        }
        best.0.map(|(interval, share)| (interval, self.stride(interval, share)))
    }

    /// The share at which an interval is split: where asked for, or, when that keeps creeping along
    /// from an end, between that and the whole. A resonance that slip has cut off misleads its flanks.
    fn stride(&self, interval: usize, share: f64) -> f64 {
        let share = match self.gaps[interval].idle <= IDLE {
            true => share,
            false if share <= 0.5 => share.sqrt().min(0.5),
            false => 1.0 - (1.0 - share).sqrt().min(0.5),
        };
        let [left, right] = [interval, interval + 1].map(|i| self.samples[i].at);
        // What is too short to be split would keep an error that nothing has measured.
        let least = (2.0 * self.shortest * right / (right - left)).min(0.5);
        share.clamp(least, 1.0 - least)
    }

    /// Nothing more is asked of an interval whose inside cannot be solved.
    pub(super) fn close(&mut self, interval: usize) {
        self.gaps[interval].closed = true;
    }

    /// Leaves the interval around an unsolved resonance to doubt.
    pub(super) fn leave(&mut self, at: f64, reach: &[f64]) {
        let after = self.samples.partition_point(|sample| sample.at < at);
        if let Some(gap) = after.checked_sub(1).and_then(|interval| self.gaps.get_mut(interval)) {
            gap.closed = true;
            for (promise, reach) in gap.promises.iter_mut().zip(reach) {
                promise.1 = promise.1.max(*reach);
            }
        }
    }

    /// Adds a sample; nothing is known of the intervals beside it.
    pub(super) fn insert(&mut self, sample: Sample) {
        let near = self.shortest * sample.at;
        if self.around(sample.at).any(|other| (other.at - sample.at).abs() <= near) {
            return;
        }
        let errors = vec![UNSEEN; sample.curves().count()];
        let after = self.samples.partition_point(|other| other.at < sample.at);
        self.samples.insert(after, sample);
        let (first, last) = (after.saturating_sub(1), (after + 1).min(self.samples.len() - 1));
        let parts: Vec<Gap> = (first..last).map(|i| self.gap(i, errors.clone(), 0)).collect();
        let replaced = parts.len().saturating_sub(1);
        self.gaps.splice(first..first + replaced, parts);
    }

    /// The interval in which the curve of a group has a kink and may be higher than its highest point by the
    /// share `gain`, as far as the ends tell; the one in which it may be highest.
    pub(super) fn most_kinked(&self, gain: f64) -> Option<usize> {
        let heights: Vec<f64> = (0..self.groups.len()).map(|group| self.height(group)).collect();
        let curves = || {
            self.groups
                .iter()
                .zip(&heights)
                .flat_map(|(group, height)| group.clone().map(move |curve| (curve, height)))
        };
        let mut best = (None, 1.0 + gain);
        for (i, (gap, ends)) in self.intervals().enumerate() {
            if gap.closed || self.is_shortest(ends) || (ends[0].sticks() && ends[1].sticks()) {
                continue;
            }
            for (curve, height) in curves() {
                let between = [ends[0].knots[curve], ends[1].knots[curve]];
                let reach = Knot::kinked(between) / height;
                if reach > best.1 && Knot::has_kink(between) {
                    best = (Some(i), reach);
                }
            }
        }
        best.0
    }

    /// Adds a sample inside an interval, which tells how much its interpolants err.
    pub(super) fn split(&mut self, interval: usize, sample: Sample) {
        let (left, right) = (&self.samples[interval], &self.samples[interval + 1]);
        let share = (sample.at - left.at) / (right.at - left.at);
        let bump = 16.0 * (share * (1.0 - share)).powi(2);
        let missed = |(knot, (left, right)): (Knot, (Knot, Knot))| {
            let reference = left.height.max(right.height).max(knot.height);
            let expected = Interpolant::new(left, right, reference).height(share);
            (expected / knot.height - 1.0).abs().min(1.0) / bump
        };
        let gap = &self.gaps[interval];
        // Close to an end the error is small wherever the middle may be.
        let inside = (0.1..0.9).contains(&share);
        let curves = sample.curves().zip(left.curves().zip(right.curves()));
        let measured = gap.errors.iter().zip(curves).map(|(&before, curve)| {
            let most = if inside { 1.0 } else { before };
            (missed(curve).max(CHANCE * before), most)
        });
        let measured: Vec<(f64, f64)> = measured.collect();
        let caution = self.caution;
        let errors = |part: f64| -> Vec<f64> {
            let allowed = |(error, most): &(f64, f64)| (caution * error * part.powi(4)).min(*most);
            measured.iter().map(allowed).collect()
        };
        let idle = |part: f64| if part > 0.5 { gap.idle + 1 } else { 0 };
        let parts = [share, 1.0 - share].map(|part| (errors(part), idle(part)));
        self.samples.insert(interval + 1, sample);
        let [before, after] = parts;
        let before = self.gap(interval, before.0, before.1);
        let after = self.gap(interval + 1, after.0, after.1);
        self.gaps.splice(interval..=interval, [before, after]);
    }

    /// An interval between two samples, with what it promises.
    fn gap(&self, interval: usize, errors: Vec<f64>, idle: u32) -> Gap {
        let ends = &self.samples[interval..interval + 2];
        // Of what is too short to be split the interpolant says all that can be known.
        let shortest = self.is_shortest(ends);
        let errors = if shortest { vec![0.0; errors.len()] } else { errors };
        let promise = |group: usize| {
            let reference = self.height(group);
            let curves = self.groups[group].clone().filter(|_| reference > 0.0);
            let promises = curves.flat_map(|i| {
                let ends = [ends[0].knots[i], ends[1].knots[i]];
                let own = promised(ends, errors[i], reference);
                let above = (!shortest).then(|| self.above(interval, i, &errors, reference));
                [own].into_iter().chain(above.flatten())
            });
            higher(promises)
        };
        let promises = (0..self.groups.len()).map(promise).collect();
        Gap { errors, promises, idle, closed: false }
    }

    /// Where and how high a curve may be in an interval in which the phases of its harmonics turn too far
    /// for its slopes, if that is higher than the reference.
    fn above(
        &self,
        interval: usize,
        curve: usize,
        errors: &[f64],
        reference: f64,
    ) -> Option<(f64, f64)> {
        let ends = &self.samples[interval..interval + 2];
        let [left, right] = [&ends[0], &ends[1]].map(|end| end.overlays.get(curve));
        let (left, right) = (left?, right?);
        let error = errors[ends[0].knots.len() + curve];
        let (share, height) = promised([left.ceiling, right.ceiling], error, reference);
        let least = (1.0 + BROAD) * reference;
        let counts = height > least && left.turns_to(right, reference);
        // Where they fall on each other may be anywhere.
        let level = left.ceiling.height.max(right.ceiling.height) > least;
        let [nearest, farthest] = if level { MIDDLE } else { [0.0, 1.0] };
        counts.then_some((share.clamp(nearest, farthest), height))
    }

    /// Where the slope of the top of a group vanishes, as the interval and the share of it, if more
    /// than the share `gain` in height is to be won there.
    pub(super) fn stationary(&self, group: usize, gain: f64) -> Option<(usize, f64)> {
        let (top, curve) = self.top(group)?;
        let knot = self.samples[top].knots[curve];
        let rises = knot.slope > 0.0;
        let other = if rises { top + 1 } else { top.checked_sub(1)? };
        let uphill = self.samples.get(other)?.knots[curve];
        let share = Interpolant::new(knot, uphill, knot.height).top()?;
        let won = 0.5 * (share * (uphill.at - knot.at) * knot.slope).abs();
        let place = if rises { (top, share) } else { (other, 1.0 - share) };
        (won > gain * knot.height).then_some(place)
    }

    /// Whether an interval is too short to be split.
    pub(super) fn is_shortest(&self, ends: &[Sample]) -> bool {
        ends[1].at - ends[0].at <= self.shortest * ends[1].at
    }
}
