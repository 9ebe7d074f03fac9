//! The highest point that any DOF of a group reaches over a range of frequencies: the most loaded
//! blade of a disk, and where.

use super::samples::Sample;
use super::search::{rivals, sorted, Aim, Found, Search};
use crate::balance::{
    Evaluation, ForcedBalance, HarmonicChoice, Memory, PointStatus, Progress, Resolution, Settings,
};
use crate::fourier::Measure;
use crate::model::Model;
use crate::structure::Compliance;
use crate::timing::Profile;
use crate::Error;
use std::time::Instant;

/// Gain in height, relative, that is not worth another point.
const GAIN: f64 = 1e-8;
/// Points after which a search ends in any case.
const MOST_POINTS: usize = 1000;
/// Fewest intervals of the first look.
const INTERVALS: usize = 8;
/// Intervals of an even first look above which it looks at natural frequencies instead, …
const EVEN: usize = 24;
/// … and shortest even interval, in bandwidths of the least damped mode.
const BANDWIDTHS: f64 = 2.0;
/// Natural frequencies closer than this share of a bandwidth are one resonance.
const MERGED: f64 = 0.5;

/// Which highest points are sought.
#[derive(Debug, Clone, PartialEq)]
pub struct Quest {
    /// DOFs, group by group; the highest of each group is sought.
    pub groups: Vec<Vec<usize>>,
    /// Measure of their amplitudes.
    pub measure: Measure,
    /// Range of frequencies [rad/s].
    pub span: (f64, f64),
}

/// The highest point of a group.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct Summit {
    /// Its frequency [rad/s].
    pub omega: f64,
    /// Its amplitude [m].
    pub amplitude: f64,
    /// Position of its DOF in the group.
    pub member: usize,
    /// How its computation ended; if a part of the range that may hold a higher point could not be
    /// solved, how that ended, and the summit is missing.
    pub status: PointStatus,
    /// Highest harmonic kept.
    pub harmonics: usize,
    /// What the discarded harmonics, and more samples, could change in its amplitude [m].
    pub error_estimate: f64,
    /// Whether it lies at an end of the range.
    pub at_edge: bool,
}

impl Summit {
    pub(super) fn missing(status: PointStatus) -> Self {
        let nan = f64::NAN;
        Self {
            omega: nan,
            amplitude: nan,
            member: 0,
            status,
            harmonics: 0,
            error_estimate: nan,
            at_edge: false,
        }
    }
}

/// The highest points of all groups.
#[derive(Debug, Clone)]
pub struct Summits {
    /// One per group.
    pub summits: Vec<Summit>,
    /// Responses solved for.
    pub points: usize,
    /// Where the time went.
    pub profile: Profile,
}

impl Summits {
    /// Whether the search was ended before it was through.
    #[must_use]
    pub fn interrupted(&self) -> bool {
        self.summits.iter().any(|summit| summit.status == PointStatus::NotComputed)
    }

    /// Highest harmonic kept at any summit.
    #[must_use]
    pub fn harmonics(&self) -> usize {
        self.summits.iter().map(|summit| summit.harmonics).max().unwrap_or(0)
    }
}

/// Finds the highest point of every group of DOFs. Automatic harmonics start from `order`, or from
/// what the middle of the range asks for.
///
/// # Errors
/// A range that is not ordered, no DOF in a group, or as for a solution.
pub fn summits(
    model: &Model,
    settings: Settings,
    quest: &Quest,
    order: Option<usize>,
    progress: &Progress<'_>,
) -> Result<Summits, Error> {
    let start = Instant::now();
    let (low, high) = quest.span;
    if !(low > 0.0 && low < high && high < 1e100) {
        return Err(Error::value("omega range: end", high, "must lie above its start"));
    }
    if quest.groups.is_empty() || quest.groups.iter().any(Vec::is_empty) {
        return Err(Error::shape("dofs", "at least one in every group", "none"));
    }
    let all = quest.groups.concat();
    let memory = ForcedBalance::new(model, settings, &all)?.into_memory();
    let mut climb = Climb { model, settings, quest, progress, memory, points: 0 };
    let summits = climb.run(order)?;
    let profile = Profile { total: start.elapsed(), ..climb.memory.profile };
    Ok(Summits { summits, points: climb.points, profile })
}

struct Climb<'a> {
    model: &'a Model,
    settings: Settings,
    quest: &'a Quest,
    progress: &'a Progress<'a>,
    memory: Memory,
    points: usize,
}

impl Climb<'_> {
    fn run(&mut self, order: Option<usize>) -> Result<Vec<Summit>, Error> {
        let least = match self.settings.harmonics {
            HarmonicChoice::Fixed(harmonics) => harmonics,
            HarmonicChoice::Auto => order.unwrap_or(1).max(1),
        };
        let samples = self.settings.fixed_samples();
        let mut resolution = Resolution { harmonics: least, samples };
        let known = order.is_some() && self.settings.evaluation == Evaluation::Direct;
        if self.settings.is_automatic() && !known {
            let middle = 0.5 * (self.quest.span.0 + self.quest.span.1);
            resolution = resolution.or_finer(self.judge(self.quest.groups[0][0], middle, None)?.1);
        }
        let all = self.quest.groups.concat();
        let mut seeds: Vec<Sample> = Vec::new();
        loop {
            let Some(found) = self.search(resolution, &seeds)? else {
                let ended = !(self.progress)(0.0);
                let status = if ended { PointStatus::NotComputed } else { PointStatus::Stalled };
                return Ok(vec![Summit::missing(status); self.quest.groups.len()]);
            };
            let mut summits = Vec::with_capacity(found.tops.len());
            let mut wanted = resolution;
            let mut first = 0;
            for (top, group) in found.tops.iter().zip(&self.quest.groups) {
                let best = &found.samples[top.sample];
                let (mut status, kept, error_estimate) =
                    self.judge(all[top.curve], best.at, Some(best))?;
                if status.is_solved() {
                    wanted = wanted.or_finer(kept);
                }
                status = top.failure.unwrap_or(status);
                summits.push(if status.is_solved() {
                    Summit {
                        omega: best.at,
                        amplitude: best.knots[top.curve].height,
                        member: top.curve - first,
                        status,
                        harmonics: resolution.harmonics,
                        error_estimate,
                        at_edge: top.sample == 0 || top.sample + 1 == found.samples.len(),
                    }
                } else {
                    // A lower maximum is no summit.
                    Summit::missing(status)
                });
                first += group.len();
            }
            if wanted == resolution || summits.iter().any(|s| s.status == PointStatus::NotComputed)
            {
                return Ok(summits);
            }
            // What a summit asks for may move it, and change which is highest.
            (resolution, seeds) = (wanted, found.samples);
        }
    }

    fn search(&mut self, resolution: Resolution, seeds: &[Sample]) -> Result<Option<Found>, Error> {
        let settings = self.settings.at(resolution);
        // Nothing is observed: a point of the search needs no error estimate.
        let mut balance = ForcedBalance::new(self.model, settings, &[])?
            .watched(self.progress)
            .remembering(std::mem::take(&mut self.memory));
        let aim = Aim {
            groups: self.quest.groups.clone(),
            measure: self.quest.measure,
            span: self.quest.span,
            gain: GAIN,
            most_points: MOST_POINTS,
        };
        let search = Search::new(settings.residual, &aim, &mut balance);
        let looks = looks(self.model.compliance(), self.quest.span, seeds);
        let found = search.run(&looks, seeds)?;
        self.points += found.as_ref().map_or(0, |found| found.samples.len());
        self.memory = balance.into_memory();
        Ok(found)
    }

    /// Solves at a summit as the settings ask; says how that ended, with what resolution, and what a
    /// better one could change.
    fn judge(
        &mut self,
        dof: usize,
        omega: f64,
        start: Option<&Sample>,
    ) -> Result<(PointStatus, Resolution, f64), Error> {
        let observe = [dof];
        let mut balance = ForcedBalance::new(self.model, self.settings, &observe)?
            .watched(self.progress)
            .remembering(std::mem::take(&mut self.memory));
        let point = balance.solve(omega, start.map(|sample| &sample.unknowns));
        self.memory = balance.into_memory();
        self.points += 1;
        let point = point?;
        Ok((point.status, point.resolution(), point.error_estimate[0]))
    }
}

/// Frequencies of a first look that no resonance slips through: closer than a few bandwidths, or,
/// where damping is too light for that, at every natural frequency, stuck and free. A resonance
/// between the two is as broad as its distance from them, for what bends it is friction.
fn looks(compliance: &dyn Compliance, (low, high): (f64, f64), seeds: &[Sample]) -> Vec<f64> {
    let mut forced = compliance.forced_harmonics();
    forced.retain(|&k| k > 0);
    let finest = forced.last().copied().unwrap_or(1) as f64;
    let bandwidth = (compliance.narrowest_bandwidth() / finest).max(1e-9 * high);
    let needed = ((high - low) / (BANDWIDTHS * bandwidth)).ceil();
    let intervals = needed.clamp(INTERVALS as f64, EVEN as f64) as usize;
    let spacing = (high - low) / intervals as f64;
    let mut omega: Vec<f64> = (0..=intervals).map(|i| low + i as f64 * spacing).collect();
    let mut distance = 0.02 * spacing;
    if needed > EVEN as f64 {
        let natural = compliance.stuck_frequencies().iter().chain(compliance.free_frequencies());
        omega.extend(natural.flat_map(|w| forced.iter().map(move |&k| w / k as f64)));
        distance = distance.min(MERGED * bandwidth);
    }
    omega.extend(rivals(seeds));
    // The ends stand for what lies too close to them.
    omega.retain(|w| (low + distance..=high - distance).contains(w));
    let mut looks = sorted(omega, (low, high), distance);
    looks.insert(0, low);
    looks.push(high);
    looks
}
