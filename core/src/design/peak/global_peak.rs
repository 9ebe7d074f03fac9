//! The highest point that any DOF of a group reaches over a range of frequencies: the most loaded
//! blade of a disk, and where.

use super::first_look::{Aim, FirstLook, Precision};
use super::samples::Sample;
use super::search::{Found, Search};
use super::upper_branch::upper_branch;
use crate::balance::{
    Evaluation, ForcedBalance, HarmonicChoice, Point, PointStatus, Progress, Resolution, Settings,
    WarmStart,
};
use crate::fourier::Measure;
use crate::model::Model;
use crate::orbit::OrbitInitialGuess;
use crate::Error;
use std::sync::Arc;

/// How many times the error that an interpolant should have is allowed for.
const CAUTION: f64 = 4.0;
/// Of a single peak, whose frequency and slopes are asked for, …
const SINGLE: Precision = Precision { gain: 1e-13, flat: 1e-20, caution: CAUTION };
/// … of peaks along a parameter, …
pub(crate) const OF_CURVE: Precision = Precision { gain: 1e-11, flat: 1e-20, caution: CAUTION };
/// … of the least of them, which lies where an error is overlooked if that can be, …
pub(crate) const OF_LEAST: Precision = Precision { caution: 10.0 * CAUTION, ..OF_CURVE };
/// … and of many disks, of which the heights count.
pub(crate) const OF_STUDY: Precision = Precision { gain: 1e-8, flat: 1e-10, caution: CAUTION };
/// Points after which a search ends in any case.
const MOST_POINTS: usize = 1000;

/// Which highest points are sought.
#[derive(Debug, Clone, PartialEq)]
pub struct PeakQuery {
    /// DOFs, group by group; the highest of each group is sought.
    pub groups: Vec<Vec<usize>>,
    /// Measure of their amplitudes.
    pub measure: Measure,
    /// Range of frequencies [rad/s].
    pub span: (f64, f64),
}

impl PeakQuery {
    /// What is looked for, to a precision.
    pub(super) fn aim(&self, precision: Precision) -> Aim {
        Aim {
            groups: self.groups.clone(),
            measure: self.measure,
            span: self.span,
            precision,
            most_points: MOST_POINTS,
        }
    }
}

/// The highest point of a group.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct GlobalPeak {
    /// Its frequency; of a missing summit, where nothing bounds the response, if that is why [rad/s].
    pub omega: f64,
    /// Its amplitude \[m\].
    pub amplitude: f64,
    /// Position of its DOF in the group.
    pub member: usize,
    /// How its computation ended; if a part of the range that may hold a higher point could not be
    /// solved, how that ended, and the summit is missing.
    pub status: PointStatus,
    /// Highest harmonic kept.
    pub harmonics: usize,
    /// What the discarded harmonics, and more samples, could change in its amplitude \[m\].
    pub error_estimate: f64,
    /// Whether it lies at an end of the range.
    pub at_edge: bool,
}

impl GlobalPeak {
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
    pub summits: Vec<GlobalPeak>,
    /// Responses solved for.
    pub points: usize,
}

impl Summits {
    /// Whether the search was ended before it was through.
    #[must_use]
    pub fn interrupted(&self) -> bool {
        self.summits.iter().any(|summit| summit.status == PointStatus::NotComputed)
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
    quest: &PeakQuery,
    order: Option<usize>,
    progress: &Progress<'_>,
) -> Result<Summits, Error> {
    climbed(model, settings, quest, SINGLE, order, progress)
}

/// [`summits`] to a precision.
pub(crate) fn climbed(
    model: &Model,
    settings: Settings,
    quest: &PeakQuery,
    precision: Precision,
    order: Option<usize>,
    progress: &Progress<'_>,
) -> Result<Summits, Error> {
    let mut climb = PeakSearch::new(model, settings, quest, precision, progress)?;
    let reached = climb.run(model, order, None)?;
    let summits = reached.summits.into_iter().map(|(summit, _)| summit).collect();
    Ok(Summits { summits, points: climb.points })
}

/// Searches for highest points, each from the samples of the last.
pub(crate) struct PeakSearch<'a> {
    pub(crate) settings: Settings,
    pub(crate) quest: &'a PeakQuery,
    pub(crate) progress: &'a Progress<'a>,
    /// Share of the work that is done, for the progress.
    pub(crate) share: f64,
    pub(crate) precision: Precision,
    pub(crate) memory: WarmStart,
    /// Samples of the last search.
    pub(crate) seeds: Vec<Sample>,
    pub(crate) points: usize,
}

/// What a climb has reached.
pub(crate) struct Reached {
    /// The summits, each with the position of its sample.
    pub(crate) summits: Vec<(GlobalPeak, usize)>,
    /// With what they were found.
    pub(crate) resolution: Resolution,
    /// What they ask for by themselves.
    pub(crate) wanted: Resolution,
}

impl<'a> PeakSearch<'a> {
    /// A climb of models like this one.
    ///
    /// # Errors
    /// A range that is not ordered, no DOF in a group, or what no model could be solved with.
    pub(crate) fn new(
        model: &Model,
        settings: Settings,
        quest: &'a PeakQuery,
        precision: Precision,
        progress: &'a Progress<'a>,
    ) -> Result<Self, Error> {
        let (low, high) = quest.span;
        if !(low > 0.0 && low < high && high < 1e100) {
            return Err(Error::value("omega range: end", high, "must lie above its start"));
        }
        if quest.groups.is_empty() || quest.groups.iter().any(Vec::is_empty) {
            return Err(Error::shape("dofs", "at least one in every group", "none"));
        }
        let all = quest.groups.concat();
        let memory = ForcedBalance::new(model, settings, &all)?.into_memory();
        let (share, seeds, points) = (0.0, Vec::new(), 0);
        Ok(Self { settings, quest, progress, share, precision, memory, seeds, points })
    }

    /// Finds the summits of a model. Automatic harmonics start from what is known to resolve a
    /// similar one, from `order`, or from what the middle of the range asks for.
    pub(crate) fn run(
        &mut self,
        model: &Model,
        order: Option<usize>,
        known: Option<Resolution>,
    ) -> Result<Reached, Error> {
        let quest = self.quest;
        let all = quest.groups.concat();
        let harmonics = match self.settings.harmonics {
            HarmonicChoice::Fixed(harmonics) => harmonics,
            HarmonicChoice::Auto => order.unwrap_or(1).max(1),
        };
        let least = Resolution { harmonics, samples: self.settings.fixed_samples() };
        let mut resolution = known.unwrap_or(least);
        let told = order.is_some() && self.settings.evaluation == Evaluation::Direct;
        if self.settings.is_automatic() && known.is_none() && !told {
            let middle = 0.5 * (quest.span.0 + quest.span.1);
            resolution = least.or_finer(self.judge(model, all[0], middle, None)?.1);
        }
        loop {
            let Some(found) = self.search(model, resolution)? else {
                let ended = self.is_ended();
                let status = if ended { PointStatus::NotComputed } else { PointStatus::Stalled };
                let summits = vec![(GlobalPeak::missing(status), 0); quest.groups.len()];
                return Ok(Reached { summits, resolution, wanted: resolution });
            };
            let mut summits = Vec::with_capacity(found.tops.len());
            let mut wanted = least;
            let mut first = 0;
            for (top, group) in found.tops.iter().zip(&quest.groups) {
                summits.push(match top {
                    // A lower maximum is no summit.
                    Err(doubt) => {
                        (GlobalPeak { omega: doubt.at, ..GlobalPeak::missing(doubt.status) }, 0)
                    }
                    Ok(top) => {
                        let best = &found.samples[top.sample];
                        let (status, kept, error_estimate) =
                            self.judge(model, all[top.curve], best.at, Some((best, resolution)))?;
                        let summit = if status.is_solved() {
                            wanted = wanted.or_finer(kept);
                            GlobalPeak {
                                omega: best.at,
                                amplitude: best.knots[top.curve].height,
                                member: top.curve - first,
                                status,
                                harmonics: resolution.harmonics,
                                error_estimate,
                                at_edge: top.sample == 0 || top.sample + 1 == found.samples.len(),
                            }
                        } else {
                            GlobalPeak::missing(status)
                        };
                        (summit, top.sample)
                    }
                });
                first += group.len();
            }
            self.seeds = found.samples;
            let ended = summits.iter().any(|(one, _)| one.status == PointStatus::NotComputed);
            let finer = resolution.or_finer(wanted);
            if finer == resolution || ended {
                return Ok(Reached { summits, resolution, wanted });
            }
            // What a summit asks for may move it, and change which is highest.
            resolution = finer;
        }
    }

    /// Searches, where laws are not monotone among the largest motions.
    fn search(&mut self, model: &Model, resolution: Resolution) -> Result<Option<Found>, Error> {
        let (seeds, several) = (std::mem::take(&mut self.seeds), !model.is_monotone());
        let Some(found) = self.search_from(model, resolution, &seeds, several)? else {
            return Ok(None);
        };
        if !several || (found.settled && !found.torn) {
            return Ok(Some(found));
        }
        let largest = upper_branch(
            model,
            self.settings.at(resolution),
            &self.quest.aim(self.precision),
            self.progress,
        )?;
        self.points += largest.points;
        self.memory.profile.add(&largest.profile);
        if self.is_ended() {
            return Ok(None);
        }
        if largest.complete {
            return Ok(Some(found.with_higher(largest.tops)));
        }
        let seeds = if largest.samples.len() < 2 { &seeds } else { &largest.samples };
        let again = self.search_from(model, resolution, seeds, false)?;
        Ok(again.map(|again| again.with_higher(largest.tops)))
    }

    fn is_ended(&self) -> bool {
        !(self.progress)(self.share)
    }

    fn search_from(
        &mut self,
        model: &Model,
        resolution: Resolution,
        seeds: &[Sample],
        until_torn: bool,
    ) -> Result<Option<Found>, Error> {
        let settings = self.settings.at(resolution);
        let orbits = OrbitInitialGuess::new(model, settings.residual, &[], self.progress);
        // Nothing is observed: a point of the search needs no error estimate.
        let mut balance = ForcedBalance::new(model, settings, &[])?
            .watched(self.progress)
            .remembering(std::mem::take(&mut self.memory));
        if model.is_monotone() {
            // Of several motions an orbit may be another one.
            balance = balance.rescued(&orbits);
        }
        balance.report(self.share);
        let aim = self.quest.aim(self.precision);
        let table = balance.table(resolution.harmonics);
        let look = FirstLook::new(model, &aim, table.harmonics().orders(), seeds)?;
        let mut search = Search::new(settings.residual, &aim, look.narrowest(), &mut balance);
        search.until_torn = until_torn;
        let found = search.run(&look, seeds)?;
        self.points += found.as_ref().map_or(0, |found| found.samples.len());
        self.memory = balance.into_memory();
        Ok(found)
    }

    /// Solves at a summit as the settings ask; says how that ended, with what resolution, and what a
    /// better one could change. Where laws are not monotone, fewer harmonics than those of the search
    /// may have no motion like the one that it has found; then they begin with as many.
    fn judge(
        &mut self,
        model: &Model,
        dof: usize,
        omega: f64,
        start: Option<(&Sample, Resolution)>,
    ) -> Result<(PointStatus, Resolution, f64), Error> {
        let mut point = self.solved(model, dof, (omega, start.map(|(best, _)| best)), None)?;
        if let Some((best, resolution)) = start.filter(|_| !model.is_monotone()) {
            let fell = !point.is_solved() || !point.unknowns().is_some_and(|own| best.is_like(own));
            if fell && point.status != PointStatus::NotComputed && self.settings.is_automatic() {
                point = self.solved(model, dof, (omega, Some(best)), Some(resolution))?;
            }
        }
        Ok((point.status, point.resolution(), point.error_estimate[0]))
    }

    fn solved(
        &mut self,
        model: &Model,
        dof: usize,
        (omega, start): (f64, Option<&Sample>),
        least: Option<Resolution>,
    ) -> Result<Point, Error> {
        let observe = [dof];
        let mut balance = ForcedBalance::new(model, self.settings, &observe)?
            .watched(self.progress)
            .remembering(std::mem::take(&mut self.memory));
        if let Some(least) = least {
            balance = balance.beginning_with(least);
        }
        balance.report(self.share);
        let point = balance.solve(omega, start.map(|sample| &sample.unknowns));
        self.memory = balance.into_memory();
        self.points += 1;
        point
    }
}

/// Whether some neighbours among points of one resolution are on different branches, or not solved.
///
/// # Errors
/// As for a solution at one frequency.
pub(crate) fn are_torn(
    model: &Model,
    settings: Settings,
    quest: &PeakQuery,
    points: &[Arc<Point>],
    progress: &Progress<'_>,
) -> Result<bool, Error> {
    let mut balance = ForcedBalance::new(model, settings, &[])?.watched(progress);
    let aim = quest.aim(OF_STUDY);
    let mut search = Search::new(settings.residual, &aim, f64::INFINITY, &mut balance);
    let mut last: Option<Sample> = None;
    for point in points {
        let Some(next) = search.sampled(point)? else { return Ok(true) };
        if let Some(last) = last.replace(next.clone()) {
            if search.are_apart([last, next])? {
                return Ok(true);
            }
        }
    }
    Ok(false)
}
