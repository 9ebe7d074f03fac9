//! The highest point of a response over a range of frequencies, whichever of its maxima that is.
//!
//! Every point is solved with its exact slope. Between two points an [`Interpolant`] says how high
//! the curve may be; the interval that promises most is split next, until none promises more than
//! what has been found. Jumps between rival maxima are seen, because none is followed by itself.

use super::curve::Target;
use super::interpolant::{Interpolant, Knot};
use crate::balance::{ForcedBalance, Linearised, PointStatus, Unknowns};
use crate::contact::Residual;
use crate::model::Model;
use crate::Error;

/// Points of the first look at the range.
const LOOKS: usize = 9;
/// Share by which an interpolant of that look may err: it may hide a maximum this much higher.
const UNSEEN: f64 = 0.5;
/// The error of an interpolant falls with the fourth power of its width; this times as much is
/// allowed for.
const CAUTION: f64 = 4.0;
/// Gain in height, relative, that is not worth another point.
const GAIN: f64 = 1e-11;
/// Splits in a row that may leave more than half of an interval.
const IDLE: u32 = 1;
/// Shortest interval that is split, relative to the frequency.
const SHORTEST: f64 = 1e-9;
/// Points after which a search ends in any case.
const MOST_POINTS: usize = 200;
/// Points without a solution after which an interval is closed without another attempt.
const MOST_FAILURES: usize = 40;
/// Gain in height, relative, that an interval without a solution must not promise.
const DOUBT: f64 = 1e-6;
/// Distance at which an undamped resonance is passed, relative to the frequency.
const ASIDE: f64 = 1e-8;
/// Maxima from this share of the highest are looked at again at the next parameter.
const RIVAL: f64 = 0.7;

/// A solved point with its slopes.
#[derive(Debug, Clone)]
pub(super) struct Sample {
    pub(super) knot: Knot,
    pub(super) unknowns: Unknowns,
    /// Derivative of the unknowns in frequency.
    rate: Vec<f64>,
}

/// What is known of an interval between two samples.
#[derive(Debug, Clone, Copy)]
pub(super) struct Gap {
    /// Error allowed for in its interpolant.
    error: f64,
    /// Splits in a row that have left more than half of it.
    idle: u32,
    /// Whether its inside could not be solved.
    closed: bool,
}

impl Gap {
    /// The share at which it is split: where asked for, or, when that keeps creeping along from an
    /// end, between that and the whole. A resonance that slip has cut off misleads its flanks.
    fn stride(self, share: f64) -> f64 {
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

/// How a search ended.
pub(super) struct Found {
    /// All points, by frequency.
    pub(super) samples: Vec<Sample>,
    /// Position of the highest.
    pub(super) best: usize,
    /// Why the highest point may lie elsewhere, where nothing could be solved.
    pub(super) failure: Option<PointStatus>,
}

/// A search under way.
pub(super) struct Search<'a, 'b> {
    pub(super) model: &'a Model,
    pub(super) residual: Residual,
    pub(super) target: &'a Target,
    pub(super) balance: &'b mut ForcedBalance<'a>,
    pub(super) samples: Vec<Sample>,
    /// What is known of the intervals between them.
    pub(super) gaps: Vec<Gap>,
    /// Points without a solution.
    pub(super) failures: usize,
    /// How the last of them ended.
    pub(super) failure: Option<PointStatus>,
}

impl Search<'_, '_> {
    /// Finds the highest point, from the samples of a similar response.
    ///
    /// # Errors
    /// As for a solution at one frequency.
    pub(super) fn run(mut self, seeds: &[Sample]) -> Result<Option<Found>, Error> {
        for omega in first_look(self.target.span, seeds) {
            let start = self.beside(seeds, omega);
            if let Some(sample) = self.solve(omega, start)? {
                self.samples.push(sample);
            }
            if self.failure == Some(PointStatus::NotComputed) {
                return Ok(None);
            }
        }
        let fresh = Gap { error: UNSEEN, idle: 0, closed: false };
        self.gaps = vec![fresh; self.samples.len().saturating_sub(1)];
        while self.samples.len() < MOST_POINTS {
            let Some((interval, share)) = self.most_promising() else { break };
            if !self.split(interval, share)? {
                return Ok(None);
            }
        }
        let failure = if self.is_in_doubt() { self.failure } else { None };
        let best = self.best();
        Ok(best.map(|best| Found { samples: self.samples, best, failure }))
    }

    /// Whether a part of the range that could not be solved may hold a higher point.
    fn is_in_doubt(&self) -> bool {
        let (Some(best), Some(first), Some(last)) =
            (self.best(), self.samples.first(), self.samples.last())
        else {
            return true;
        };
        let (low, high) = self.target.span;
        let reference = self.samples[best].knot.height;
        let ends = first.knot.at > low * (1.0 + 2.0 * ASIDE) || last.knot.at < high;
        ends || self.samples.windows(2).zip(&self.gaps).any(|(pair, gap)| {
            let interpolant = Interpolant::new(pair[0].knot, pair[1].knot, reference);
            gap.closed && interpolant.promise(gap.error).1 > reference * (1.0 + DOUBT)
        })
    }

    fn best(&self) -> Option<usize> {
        let heights = self.samples.iter().map(|sample| sample.knot.height).enumerate();
        heights.max_by(|a, b| a.1.total_cmp(&b.1)).map(|(best, _)| best)
    }

    /// The interval that may hold the highest point, and where to look in it.
    fn most_promising(&self) -> Option<(usize, f64)> {
        let reference = self.samples[self.best()?].knot.height;
        if reference == 0.0 {
            return None;
        }
        let mut best = (None, reference * (1.0 + GAIN));
        for (i, pair) in self.samples.windows(2).enumerate() {
            let (left, right) = (pair[0].knot, pair[1].knot);
            if self.gaps[i].closed || right.at - left.at <= SHORTEST * right.at {
                continue;
            }
            let (share, promise) =
                Interpolant::new(left, right, reference).promise(self.gaps[i].error);
            if promise > best.1 {
                best = (Some((i, share)), promise);
            }
        }
        best.0
    }

    /// Solves inside an interval; `false` if the analysis is to end.
    fn split(&mut self, interval: usize, share: f64) -> Result<bool, Error> {
        let (left, right) = (self.samples[interval].knot, self.samples[interval + 1].knot);
        let width = right.at - left.at;
        let gap = self.gaps[interval];
        let Some(sample) = self.inside(interval, gap.stride(share))? else {
            // Nothing more is asked of an interval whose inside cannot be solved.
            self.gaps[interval].closed = true;
            return Ok(self.failure != Some(PointStatus::NotComputed));
        };
        let reference = left.height.max(right.height).max(sample.knot.height);
        let share = (sample.knot.at - left.at) / width;
        let expected = Interpolant::new(left, right, reference).height(share);
        let bump = 16.0 * (share * (1.0 - share)).powi(2);
        let error = (expected / sample.knot.height - 1.0).abs().min(1.0) / bump;
        let inside = (0.1..0.9).contains(&share);
        let part = |part: f64| {
            let allowed = CAUTION * error * part.powi(4);
            // Close to an end the error is small wherever the middle may be.
            let error = if inside { allowed.min(1.0) } else { allowed.min(gap.error) };
            Gap { error, idle: if part > 0.5 { gap.idle + 1 } else { 0 }, closed: false }
        };
        self.gaps.splice(interval..=interval, [part(share), part(1.0 - share)]);
        self.samples.insert(interval + 1, sample);
        Ok(true)
    }

    /// A point inside an interval: at the share asked for, or halfway from there to an end.
    fn inside(&mut self, interval: usize, share: f64) -> Result<Option<Sample>, Error> {
        let (left, right) = (self.samples[interval].knot.at, self.samples[interval + 1].knot.at);
        for share in [share, 0.5 * share, 0.5 * (1.0 + share)] {
            let solved = self.solve(left + share * (right - left), None)?;
            let sample = solved.filter(|sample| left < sample.knot.at && sample.knot.at < right);
            let ended = self.failure == Some(PointStatus::NotComputed);
            if sample.is_some() || ended || self.failures > MOST_FAILURES {
                return Ok(sample);
            }
        }
        Ok(None)
    }

    /// Solves at one frequency: from `start` or the samples around it, from the stuck response,
    /// or from either neighbour as it is.
    fn solve(&mut self, omega: f64, start: Option<Unknowns>) -> Result<Option<Sample>, Error> {
        let after = self.samples.partition_point(|sample| sample.knot.at < omega);
        let start = start.or_else(|| predicted(&self.samples, omega));
        let neighbours = [after.checked_sub(1), Some(after)].into_iter().flatten();
        let neighbours: Vec<_> = neighbours
            .filter_map(|i| self.samples.get(i))
            .map(|sample| Some(sample.unknowns.clone()))
            .collect();
        for start in start.map(Some).into_iter().chain([None]).chain(neighbours) {
            let sample = self.attempt(omega, start.as_ref())?;
            if sample.is_some() || self.failure == Some(PointStatus::NotComputed) {
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
        let mut linearised =
            Linearised::new(self.model, &table, self.residual, point.omega, unknowns)?;
        let jet = linearised.frequency_jet(self.target.dof, self.target.measure)?;
        self.balance.add_profile(linearised.profile());
        let Some((height, slope, rate)) = jet else {
            self.failure = Some(PointStatus::Singular);
            return Ok(None);
        };
        let knot = Knot { at: point.omega, height, slope };
        Ok(Some(Sample { knot, unknowns: unknowns.clone(), rate }))
    }

    /// A start from a similar response: its solution, moved by as much as the last sample differs
    /// from it.
    fn beside(&self, seeds: &[Sample], omega: f64) -> Option<Unknowns> {
        let mut start = predicted(seeds, omega)?;
        if let Some(last) = self.samples.last() {
            let similar = predicted(seeds, last.knot.at)?.recast(last.unknowns.harmonics());
            let harmonics = last.unknowns.harmonics().clone();
            let values = start.recast(&harmonics);
            let moves = last.unknowns.values().iter().zip(&similar);
            let values = values.iter().zip(moves).map(|(x, (new, old))| x + (new - old));
            start = Unknowns::new(harmonics, values.collect());
        }
        Some(start)
    }
}

impl Sample {
    fn extrapolated(&self, omega: f64) -> Unknowns {
        let step = omega - self.knot.at;
        let values = self.unknowns.values().iter().zip(&self.rate).map(|(x, r)| x + step * r);
        Unknowns::new(self.unknowns.harmonics().clone(), values.collect())
    }

    fn interpolated(&self, right: &Self, omega: f64) -> Unknowns {
        let width = right.knot.at - self.knot.at;
        let t = (omega - self.knot.at) / width;
        let (rise, fall) = (t * t * (3.0 - 2.0 * t), t * (1.0 - t));
        let ends = self.unknowns.values().iter().zip(right.unknowns.values());
        let values = ends.zip(self.rate.iter().zip(&right.rate)).map(|((x, y), (dx, dy))| {
            x + rise * (y - x) + width * fall * ((1.0 - t) * dx - t * dy)
        });
        Unknowns::new(self.unknowns.harmonics().clone(), values.collect())
    }
}

/// A start from samples around a frequency: their cubic, or the tangent of the nearest.
fn predicted(samples: &[Sample], omega: f64) -> Option<Unknowns> {
    let after = samples.partition_point(|sample| sample.knot.at < omega);
    match (after.checked_sub(1).map(|i| &samples[i]), samples.get(after)) {
        (Some(left), Some(right)) => Some(left.interpolated(right, omega)),
        (Some(one), None) | (None, Some(one)) => Some(one.extrapolated(omega)),
        (None, None) => None,
    }
}

/// Even frequencies over the range, and the maxima of a similar response.
fn first_look((low, high): (f64, f64), seeds: &[Sample]) -> Vec<f64> {
    let spacing = (high - low) / (LOOKS - 1) as f64;
    let mut omega: Vec<f64> = (0..LOOKS - 1).map(|i| low + i as f64 * spacing).collect();
    omega.push(high);
    let highest = seeds.iter().map(|seed| seed.knot.height).fold(0.0, f64::max);
    for three in seeds.windows(3) {
        let [a, b, c] = [&three[0], &three[1], &three[2]].map(|seed| seed.knot);
        if b.height >= a.height && b.height > c.height && b.height >= RIVAL * highest {
            omega.push(b.at);
        }
    }
    omega.retain(|w| (low..=high).contains(w));
    omega.sort_by(f64::total_cmp);
    omega.dedup_by(|a, b| (*a - *b).abs() < 0.02 * spacing);
    omega
}
