//! The damper curve: peak amplitude and frequency along a parameter.

use super::bounds::{bound_peak, PeakBounds};
use super::member::Member;
use super::peak::{Knot, PeakQuery, PeakSearch, Reached, OF_CURVE, OF_LEAST};
use crate::balance::{
    keep, ForcedBalance, Kept, Linearised, PointStatus, Progress, Resolution, Settings,
};
use crate::fourier::Measure;
use crate::model::{Model, Variation};
use crate::timing::Profile;
use crate::Error;
use std::sync::Arc;
use std::time::Instant;

/// Slope in the frequency, relative to height and frequency, that a peak has beside a corner alone: a
/// smooth one is found to where it vanishes.
const STEEP: f64 = 1e-3;

/// What peak is followed.
#[derive(Debug, Clone, PartialEq)]
pub struct Target {
    /// The DOF that moves.
    pub dof: usize,
    /// Measure of its amplitude.
    pub measure: Measure,
    /// Range of frequencies in which the maximum is taken [rad/s].
    pub span: (f64, f64),
}

impl Target {
    /// The search for it.
    pub(super) fn quest(&self) -> PeakQuery {
        PeakQuery { groups: vec![vec![self.dof]], measure: self.measure, span: self.span }
    }
}

/// The peak at one value of the parameter.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct Peak {
    /// Value of the parameter.
    pub value: f64,
    /// Frequency of the peak [rad/s].
    pub omega: f64,
    /// Its amplitude \[m\].
    pub amplitude: f64,
    /// Derivative of its amplitude in the parameter.
    pub slope: f64,
    /// How its computation ended; if a part of the range that may hold the highest point could not
    /// be solved, how that ended, and the peak is missing.
    pub status: PointStatus,
    /// Highest harmonic kept.
    pub harmonics: usize,
    /// What the discarded harmonics, and more samples, could change in its amplitude \[m\].
    pub error_estimate: f64,
    /// Whether it lies at an end of the range.
    pub at_edge: bool,
    /// Bounds over the residual tractions, if they were asked for.
    pub bounds: Option<PeakBounds>,
}

impl Peak {
    fn missing(value: f64, status: PointStatus) -> Self {
        let nan = f64::NAN;
        Self {
            value,
            omega: nan,
            amplitude: nan,
            slope: nan,
            status,
            harmonics: 0,
            error_estimate: nan,
            at_edge: false,
            bounds: None,
        }
    }
}

/// Peaks along a parameter.
#[derive(Debug, Clone)]
pub struct Curve {
    /// One per value.
    pub peaks: Vec<Peak>,
    /// Responses solved for.
    pub points: usize,
    /// Whether the analysis was ended before its last value.
    pub interrupted: bool,
    /// Where the time went.
    pub profile: Profile,
}

impl Curve {
    /// What was kept of a curve over `values` that was left to itself.
    #[must_use]
    pub fn cut_short(mut peaks: Vec<Peak>, values: &[f64]) -> Self {
        let rest = values.iter().skip(peaks.len());
        peaks.extend(rest.map(|&value| Peak::missing(value, PointStatus::NotComputed)));
        Self { peaks, points: 0, interrupted: true, profile: Profile::default() }
    }
}

/// Finds the peak at every value of the parameter, in the order given; `kept` takes them as they are
/// found.
///
/// # Errors
/// A range that is not ordered, a value that a law refuses, or as for a solution.
pub fn peak_curve(
    model: &Model,
    settings: Settings,
    variation: &Variation,
    values: &[f64],
    target: &Target,
    progress: &Progress<'_>,
    kept: Option<&Kept<Peak>>,
) -> Result<Curve, Error> {
    followed(model, settings, variation, (values, None), target, (progress, kept))
}

/// [`peak_curve`] with bounds over the residual tractions; `proved` tells that theory leaves one
/// vibration alone.
///
/// # Errors
/// As for the curve; a mean displacement that rigid-body motion leaves undefined.
pub fn bounded_peak_curve(
    model: &Model,
    settings: Settings,
    variation: &Variation,
    (values, proved): (&[f64], bool),
    target: &Target,
    progress: &Progress<'_>,
    kept: Option<&Kept<Peak>>,
) -> Result<Curve, Error> {
    followed(model, settings, variation, (values, Some(proved)), target, (progress, kept))
}

fn followed(
    model: &Model,
    settings: Settings,
    variation: &Variation,
    (values, bounds): (&[f64], Option<bool>),
    target: &Target,
    (progress, kept): (&Progress<'_>, Option<&Kept<Peak>>),
) -> Result<Curve, Error> {
    let start = Instant::now();
    let quest = target.quest();
    let mut follower = Follower::new(model, settings, variation, &quest, progress)?;
    (follower.bounds, follower.kept) = (bounds, kept);
    let mut peaks = Vec::with_capacity(values.len());
    for (index, &value) in values.iter().enumerate() {
        peaks.push(follower.peak(value, index as f64 / values.len() as f64)?);
    }
    Ok(follower.finish(peaks, start))
}

/// Finds peaks one after the other, each search from the samples of the last.
pub(super) struct Follower<'a> {
    model: &'a Model,
    pub(super) variation: &'a Variation,
    climb: PeakSearch<'a>,
    /// What the last peak has asked for.
    resolution: Option<Resolution>,
    /// Whether bounds over the residual tractions are asked for, and theory says that they coincide.
    bounds: Option<bool>,
    /// Where peaks are put as they are found.
    pub(super) kept: Option<&'a Kept<Peak>>,
    /// Whether each search starts from no other, and with more caution.
    pub(super) afresh: bool,
    /// Values without a solved peak.
    pub(super) missing: Vec<Peak>,
    pub(super) interrupted: bool,
}

impl<'a> Follower<'a> {
    pub(super) fn new(
        model: &'a Model,
        settings: Settings,
        variation: &'a Variation,
        quest: &'a PeakQuery,
        progress: &'a Progress<'a>,
    ) -> Result<Self, Error> {
        let climb = PeakSearch::new(model, settings, quest, OF_CURVE, progress)?;
        let missing = Vec::new();
        let (resolution, bounds, kept) = (None, None, None);
        let (afresh, interrupted) = (false, false);
        Ok(Self { model, variation, climb, resolution, bounds, kept, afresh, missing, interrupted })
    }

    pub(super) fn finish(self, peaks: Vec<Peak>, start: Instant) -> Curve {
        Curve {
            peaks,
            points: self.climb.points,
            interrupted: self.interrupted,
            profile: Profile { total: start.elapsed(), ..self.climb.memory.profile },
        }
    }

    /// The peak at one value of the parameter, which is kept.
    pub(super) fn peak(&mut self, value: f64, share: f64) -> Result<Peak, Error> {
        let peak = self.found(value, share)?;
        if peak.status != PointStatus::NotComputed {
            keep(self.kept, &Arc::new(peak));
        }
        Ok(peak)
    }

    fn found(&mut self, value: f64, share: f64) -> Result<Peak, Error> {
        self.interrupted = self.interrupted || !(self.climb.progress)(share);
        if self.interrupted {
            return Ok(Peak::missing(value, PointStatus::NotComputed));
        }
        if self.afresh {
            self.climb.precision = OF_LEAST;
            self.climb.seeds.clear();
        }
        let settings = self.climb.settings;
        let member = Member::new(self.variation, self.model, settings.residual, value)?;
        self.climb.share = share;
        self.climb.settings.residual = member.residual;
        let reached = self.climb.run(&member.model, None, self.resolution);
        self.climb.settings = settings;
        let Reached { summits, resolution, wanted } = reached?;
        let Some((summit, sample)) = summits.into_iter().next() else {
            return Ok(Peak::missing(value, PointStatus::Stalled));
        };
        self.interrupted = summit.status == PointStatus::NotComputed;
        if !summit.status.is_solved() {
            return Ok(Peak::missing(value, summit.status));
        }
        self.resolution = Some(wanted);
        let bounds = self.bounds_of(&member, (summit.amplitude, sample), resolution)?;
        // Of a search that was stopped the bounds need not be those of the peak.
        self.interrupted = self.bounds == Some(false) && !(self.climb.progress)(share);
        if self.interrupted {
            return Ok(Peak::missing(value, PointStatus::NotComputed));
        }
        Ok(Peak {
            value,
            omega: summit.omega,
            amplitude: member.scale * summit.amplitude,
            slope: self.slope(&member, sample, resolution.samples)?,
            status: summit.status,
            harmonics: summit.harmonics,
            error_estimate: member.scale * summit.error_estimate,
            at_edge: summit.at_edge,
            bounds: bounds.map(|bounds| bounds.scaled(member.scale)),
        })
    }

    /// The bounds of a peak, if they are asked for.
    fn bounds_of(
        &mut self,
        member: &Member,
        (amplitude, sample): (f64, usize),
        resolution: Resolution,
    ) -> Result<Option<PeakBounds>, Error> {
        let Some(false) = self.bounds else {
            return Ok(self.bounds.map(|proved| PeakBounds::unique(amplitude, proved)));
        };
        let climb = &mut self.climb;
        let settings = Settings { residual: member.residual, ..climb.settings.at(resolution) };
        let (dof, samples) = (climb.quest.groups[0][0], (&climb.seeds[..], sample));
        let (bounds, points, profile) =
            bound_peak(&member.model, settings, dof, samples, climb.progress)?;
        climb.points += points;
        climb.memory.profile.add(&profile);
        Ok(Some(bounds))
    }

    /// Derivative of the peak in the parameter: the frequency at which it is highest moves, but
    /// the amplitude is stationary in it. At a corner, where slip begins, it is not: the peak is where
    /// the curves of both sides cross, and moves with it.
    fn slope(
        &mut self,
        member: &Member,
        sample: usize,
        samples: Option<usize>,
    ) -> Result<f64, Error> {
        let own = self.slope_at(member, sample, samples)?;
        let Some(other) = self.across_corner(sample) else { return Ok(own) };
        let across = self.slope_at(member, other, samples)?;
        let [rise, fall] = [sample, other].map(|i| self.climb.seeds[i].knots[0].slope);
        Ok((rise * across - fall * own) / (rise - fall))
    }

    /// The sample on the other side of a corner of the curve at this one.
    fn across_corner(&self, sample: usize) -> Option<usize> {
        let seeds = &self.climb.seeds;
        let own = seeds[sample].knots[0];
        let other = if own.slope > 0.0 { sample + 1 } else { sample.checked_sub(1)? };
        let across = seeds.get(other)?.knots[0];
        let steep = |knot: Knot| knot.slope.abs() * knot.at > STEEP * knot.height;
        let corner = own.slope * across.slope < 0.0 && steep(own) && steep(across);
        corner.then_some(other)
    }

    /// Derivative of the amplitude at a sample in the parameter.
    fn slope_at(
        &mut self,
        member: &Member,
        sample: usize,
        samples: Option<usize>,
    ) -> Result<f64, Error> {
        let climb = &mut self.climb;
        let best = &climb.seeds[sample];
        let mut balance = ForcedBalance::new(&member.model, climb.settings, &[])?
            .remembering(std::mem::take(&mut climb.memory));
        let table = balance.table(best.unknowns.harmonics().highest());
        let model = balance.evaluated(samples)?;
        climb.memory = balance.into_memory();
        let omega = best.at;
        let mut linearised =
            Linearised::new(&model, &table, member.residual, omega, &best.unknowns)?;
        let causes: Vec<_> = member.causes.iter().map(|(cause, _)| *cause).collect();
        let (dof, measure) = (climb.quest.groups[0][0], climb.quest.measure);
        let (_, slopes) = linearised.amplitude(dof, measure, &causes)?;
        climb.memory.profile.add(linearised.profile());
        Ok(slopes.iter().zip(&member.causes).map(|(slope, (_, share))| slope * share).sum())
    }
}
