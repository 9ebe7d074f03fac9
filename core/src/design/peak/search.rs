//! The highest point of a response over a range of frequencies, whichever of its maxima that is,
//! and of whichever DOF of a group.
//!
//! Every resonance is looked at that load and friction can make the highest. Every point is solved
//! with the exact slopes of all DOFs. Between two points the [`Envelope`] says how high each curve
//! may be; the interval that promises most is split next, until none promises more than what has
//! been found. Jumps between rival maxima, and between the blades of a disk, are seen, because none
//! is followed by itself.

use super::envelope::{Envelope, Gap};
use super::first_look::{Aim, Candidate, FirstLook, SEEN};
use super::interpolant::Knot;
use super::overlay::Overlay;
use super::samples::{beside, predicted, Sample};
use crate::balance::{ForcedBalance, Linearised, Point, PointStatus, Unknowns};
use crate::contact::Residual;
use crate::fourier::Measure;
use crate::Error;

/// Points without a solution after which an interval is closed without another attempt.
const MOST_FAILURES: usize = 40;
/// Gain in height, relative, that an interval without a solution must not promise.
const DOUBT: f64 = 1e-6;
/// Distance at which an undamped resonance is passed, relative to the frequency: slopes err by rounding over
/// its square.
const ASIDE: f64 = 1e-7;
/// Distance at which a resonance is looked at from the side, in bandwidths.
const FLANK: f64 = 0.5;
/// What others overlay is seen if there are points on both sides within this share.
const AROUND: f64 = 0.75;
/// What a resonance may exceed the height by that its load and friction can give it.
const SHARE: f64 = 2.0;
/// Resonances up to this many times as high as the samples beside them are overlaid by others.
const OVERLAID: f64 = 10.0;
/// Gain in height, relative, that the shortest interval must not promise.
const UNRESOLVED: f64 = 1e-3;
/// Steps that bring a top to where its slope vanishes.
const STEPS: usize = 3;

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
    pub(super) fn unsolved(status: PointStatus) -> Self {
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
    /// Whether laws that are not monotone leave neighbours on different branches.
    pub(super) torn: bool,
    /// Whether there is a highest point of every group but those that nothing bounds, on whatever branch.
    pub(super) settled: bool,
}

/// A search under way.
pub(super) struct Search<'a, 'b> {
    residual: Residual,
    pub(super) aim: &'b Aim,
    dofs: Vec<usize>,
    /// Harmonics with a load, if there are several that the measure counts.
    loaded: Vec<usize>,
    pub(super) balance: &'b mut ForcedBalance<'a>,
    pub(super) envelope: Envelope,
    /// Narrowest bandwidth, relative to the frequency.
    pub(super) narrowest: f64,
    /// Whether it ends, and tells no doubt, where neighbours are on different branches or lead to no motion.
    pub(super) until_torn: bool,
    /// Points without a solution.
    failures: usize,
    /// How the last of them ended.
    failure: Option<PointStatus>,
    /// Where slip begins at a point that is too low to be the highest [rad/s].
    pub(super) lower_onsets: Vec<f64>,
    /// Where one of several contacts begins to slip, as far as that has been looked at [rad/s].
    pub(super) changes: Vec<f64>,
    /// Intervals between slipping points in which sticking has been looked for [rad/s].
    pub(super) windows: Vec<[f64; 2]>,
}

impl<'a, 'b> Search<'a, 'b> {
    pub(super) fn new(
        residual: Residual,
        aim: &'b Aim,
        narrowest: f64,
        balance: &'b mut ForcedBalance<'a>,
    ) -> Self {
        let dofs = aim.groups.concat();
        let mut loaded = balance.loaded_harmonics();
        if loaded.len() < 2 || aim.measure == Measure::Fundamental {
            loaded.clear();
        }
        let envelope =
            Envelope::new(aim.groups.iter().map(Vec::len), narrowest, aim.precision.caution);
        Self {
            residual,
            aim,
            dofs,
            loaded,
            balance,
            envelope,
            narrowest,
            until_torn: false,
            failures: 0,
            failure: None,
            lower_onsets: Vec::new(),
            changes: Vec::new(),
            windows: Vec::new(),
        }
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
            return Ok(Some(Found { samples: Vec::new(), tops, torn: false, settled: true }));
        }
        for &omega in &look.omega {
            self.look(omega, seeds)?;
        }
        let mut open: Vec<&Candidate> = look.candidates.iter().collect();
        open.sort_by(|a, b| b.highest().total_cmp(&a.highest()));
        let (mut splits, mut torn) = (0, false);
        while !self.is_interrupted() {
            let heights: Vec<f64> =
                (0..look.unbounded.len()).map(|i| self.envelope.height(i)).collect();
            if let Some(next) = open.iter().position(|one| self.may_lead(one, &heights)) {
                self.approach(open.remove(next), seeds)?;
                continue;
            }
            let next = self.envelope.most_promising(self.aim.precision.gain);
            let Some((interval, share)) = next.filter(|_| splits < self.aim.most_points) else {
                let seen = self.look_between_slips()? || self.look_at_onsets()?;
                if seen || self.look_at_changes(look.narrowest())? || self.look_at_kinks()? {
                    continue;
                }
                break;
            };
            torn = self.until_torn && self.is_torn_at(interval)?;
            let inside = if torn { None } else { self.inside(interval, share)? };
            torn = self.until_torn && inside.is_none();
            match inside {
                Some(sample) => self.envelope.split(interval, sample),
                None => self.envelope.close(interval),
            }
            splits += 1;
            if torn {
                break;
            }
        }
        let settled = !torn
            && (0..look.unbounded.len())
                .all(|group| look.unbounded[group].is_some() || self.doubt(group).is_none());
        let groups = look.unbounded.iter().enumerate();
        let doubt = |group| if self.until_torn { None } else { self.doubt(group) };
        let doubts = groups.map(|(group, at)| unbounded(at).or_else(|| doubt(group)));
        let doubts: Vec<Option<Doubt>> = doubts.collect();
        for (group, _) in doubts.iter().enumerate().filter(|(_, doubt)| doubt.is_none()) {
            self.polish(group)?;
        }
        let looked_at = torn || (self.until_torn && !settled) || self.balance.is_monotone();
        torn = torn || (!looked_at && self.is_torn()?);
        if self.is_interrupted() {
            return Ok(None);
        }
        let top = |group| self.envelope.top(group).map(|(sample, curve)| Top { sample, curve });
        let tops: Option<Vec<Top>> = (0..doubts.len()).map(top).collect();
        Ok(tops.map(|tops| {
            let tops = tops.into_iter().zip(doubts).map(|(top, doubt)| doubt.map_or(Ok(top), Err));
            Found { tops: tops.collect(), samples: self.envelope.samples, torn, settled }
        }))
    }

    fn is_interrupted(&self) -> bool {
        self.failure == Some(PointStatus::NotComputed)
    }

    /// Solves at a frequency of which nothing is known, starting from a similar response; whether
    /// that succeeded.
    fn look(&mut self, omega: f64, seeds: &[Sample]) -> Result<bool, Error> {
        if self.is_interrupted() || self.failures > MOST_FAILURES {
            return Ok(false);
        }
        let start = beside(&self.envelope.samples, seeds, omega);
        let sample = self.solve(omega, start)?;
        let solved = sample.is_some();
        sample.into_iter().for_each(|sample| self.envelope.insert(sample));
        Ok(solved)
    }

    /// Looks at a resonance, or beside it if it cannot be solved there; and on both sides if others
    /// show as much there as it does by itself: together they are highest beside it, and the
    /// interpolant, of a resonance alone, does not see that from afar.
    fn approach(&mut self, candidate: &Candidate, seeds: &[Sample]) -> Result<(), Error> {
        let overlaid = self.is_overlaid(candidate);
        let mut solved = false;
        for aside in [0.0, -FLANK, FLANK] {
            let omega = candidate.at + aside * candidate.bandwidth;
            let wanted = !solved || overlaid;
            let omega = omega.clamp(self.aim.span.0, self.aim.span.1);
            solved |= wanted && self.look(omega, seeds)?;
        }
        if !solved {
            self.envelope.leave(candidate.at, &candidate.reach);
        }
        Ok(())
    }

    /// Whether others show as much at a resonance as it does by itself.
    fn is_overlaid(&self, candidate: &Candidate) -> bool {
        candidate.reach.iter().enumerate().any(|(group, reach)| {
            (0.0..OVERLAID * self.envelope.beside(candidate.at, group)).contains(reach)
        })
    }

    /// Whether a resonance that no point has seen may be higher than what has been found.
    fn may_lead(&self, candidate: &Candidate, heights: &[f64]) -> bool {
        let around = self.envelope.around(candidate.at);
        let within = |share: f64| {
            let near = (share * candidate.bandwidth).max(2.0 * ASIDE * candidate.at);
            around.clone().filter(|sample| (sample.at - candidate.at).abs() <= near).count()
        };
        let surrounded = || within(AROUND) == around.clone().count();
        let seen = SEEN[usize::from(candidate.highest().is_infinite())];
        if within(seen) > 0 && (surrounded() || !self.is_overlaid(candidate)) {
            return false;
        }
        candidate.reach.iter().zip(heights).enumerate().any(|(group, (reach, height))| {
            let beside = self.envelope.beside(candidate.at, group);
            *reach > 0.0 && beside + SHARE * reach > height * (1.0 + self.aim.precision.gain)
        })
    }

    /// Why the highest point may lie in a part of the range that could not be solved, that too many
    /// points have left open, or in which the response is too narrow for numbers.
    fn doubt(&self, group: usize) -> Option<Doubt> {
        let samples = &self.envelope.samples;
        let (first, last) = (samples.first()?, samples.last()?);
        let (low, high) = self.aim.span;
        let height = self.envelope.height(group);
        let beyond = |gain: f64| {
            let promising = move |gap: &Gap| gap.promises[group].1 > height * (1.0 + gain);
            self.envelope.intervals().filter(move |(gap, _)| promising(gap))
        };
        let ends = first.at > low * (1.0 + 2.0 * ASIDE) || last.at < high;
        if ends || beyond(DOUBT).any(|(gap, _)| gap.closed) {
            return Some(Doubt::unsolved(self.failure.unwrap_or(PointStatus::Stalled)));
        }
        let shortest = |(_, ends): &(_, &[Sample])| self.envelope.is_shortest(ends);
        if let Some((_, ends)) = beyond(UNRESOLVED).find(shortest) {
            // Where it is known to be bounded it is too narrow for numbers.
            return Some(match self.balance.knows_what_has_no_bound() {
                true => Doubt::unsolved(PointStatus::Stalled),
                false => Doubt::unbounded(ends[0].at),
            });
        }
        let open = beyond(DOUBT).any(|one| !shortest(&one));
        open.then(|| Doubt::unsolved(PointStatus::Stalled))
    }

    /// Moves the top of a group to where its slope vanishes.
    fn polish(&mut self, group: usize) -> Result<(), Error> {
        for _ in 0..STEPS {
            let Some((interval, share)) = self.envelope.stationary(group, self.aim.precision.flat)
            else {
                break;
            };
            let [left, right] = [interval, interval + 1].map(|i| self.envelope.samples[i].at);
            let sample = self.solve(left + share * (right - left), None)?;
            let Some(sample) = sample.filter(|one| left < one.at && one.at < right) else { break };
            self.envelope.split(interval, sample);
        }
        Ok(())
    }

    /// A point inside an interval: at the share asked for, or halfway from there to an end.
    pub(super) fn inside(&mut self, interval: usize, share: f64) -> Result<Option<Sample>, Error> {
        let [left, right] = [interval, interval + 1].map(|i| self.envelope.samples[i].at);
        for share in [share, 0.5 * share, 0.5 * (1.0 + share)] {
            let omega = left + share * (right - left);
            let solved = if self.until_torn {
                let start = predicted(&self.envelope.samples, omega);
                self.attempt(omega, start.as_ref())?
            } else {
                self.solve(omega, None)?
            };
            let sample = solved.filter(|sample| left < sample.at && sample.at < right);
            // What neighbours do not lead to may have no motion on their branch.
            if sample.is_some()
                || self.until_torn
                || self.is_interrupted()
                || self.failures > MOST_FAILURES
            {
                return Ok(sample);
            }
        }
        Ok(None)
    }

    /// Solves at one frequency: from `start` or the samples around it, from the stuck response,
    /// or from either neighbour as it is.
    pub(super) fn solve(
        &mut self,
        omega: f64,
        start: Option<Unknowns>,
    ) -> Result<Option<Sample>, Error> {
        let start = start.or_else(|| predicted(&self.envelope.samples, omega));
        let around = self.envelope.around(omega);
        let neighbours: Vec<_> = around.map(|sample| Some(sample.unknowns.clone())).collect();
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
    pub(super) fn attempt(
        &mut self,
        omega: f64,
        start: Option<&Unknowns>,
    ) -> Result<Option<Sample>, Error> {
        let point = self.balance.solve_beside(omega, ASIDE * omega, start)?;
        self.sampled(&point)
    }

    /// A point with its slopes; nothing of one without a solution.
    ///
    /// # Errors
    /// As for a solution at one frequency.
    pub(super) fn sampled(&mut self, point: &Point) -> Result<Option<Sample>, Error> {
        let (Some(unknowns), true) = (point.unknowns(), point.is_solved()) else {
            self.failure = Some(point.status);
            return Ok(None);
        };
        let table = self.balance.table(unknowns.harmonics().highest());
        let model = self.balance.evaluated(point.samples)?;
        let mut linearised = Linearised::new(&model, &table, self.residual, point.omega, unknowns)?;
        let jets = linearised.frequency_jets(&self.dofs, self.aim.measure)?;
        self.balance.add_profile(linearised.profile());
        let Some(jets) = jets else {
            self.failure = Some(PointStatus::Singular);
            return Ok(None);
        };
        let at = point.omega;
        let heights = jets.amplitudes.iter();
        let knots = heights.map(|&(height, slope)| Knot { at, height, slope }).collect();
        let harmonics = table.harmonics();
        let series = jets.motions(harmonics.slots()).filter(|_| !self.loaded.is_empty());
        let overlays = series.map(|(series, slopes)| {
            Overlay::new(at, (harmonics, series, slopes), &self.loaded, self.aim.measure)
        });
        let overlays = overlays.collect();
        let slips = point.contacts.iter().map(|one| one.slip_fraction > 0.0).collect();
        let (unknowns, rate) = (unknowns.clone(), jets.rate);
        Ok(Some(Sample { at, knots, overlays, unknowns, rate, slips }))
    }
}
