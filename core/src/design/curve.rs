//! The damper curve: peak amplitude and frequency along a parameter.

use super::member::Member;
use super::samples::Sample;
use super::search::{first_look, Aim, Found, Search};
use crate::balance::{
    ForcedBalance, HarmonicChoice, Linearised, Memory, PointStatus, Progress, Resolution, Settings,
};
use crate::fourier::Measure;
use crate::model::{Model, Variation};
use crate::timing::Profile;
use crate::Error;
use std::time::Instant;

/// Gain in height, relative, that is not worth another point of a search.
const GAIN: f64 = 1e-11;
/// Points after which a search ends in any case.
const MOST_POINTS: usize = 200;

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

/// The peak at one value of the parameter.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct Peak {
    /// Value of the parameter.
    pub value: f64,
    /// Frequency of the peak [rad/s].
    pub omega: f64,
    /// Its amplitude [m].
    pub amplitude: f64,
    /// Derivative of its amplitude in the parameter.
    pub slope: f64,
    /// How its computation ended; if a part of the range that may hold the highest point could not
    /// be solved, how that ended, and the peak is missing.
    pub status: PointStatus,
    /// Highest harmonic kept.
    pub harmonics: usize,
    /// What the discarded harmonics, and more samples, could change in its amplitude [m].
    pub error_estimate: f64,
    /// Whether it lies at an end of the range.
    pub at_edge: bool,
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

/// Finds the peak at every value of the parameter, in the order given.
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
) -> Result<Curve, Error> {
    let start = Instant::now();
    let mut follower = Follower::new(model, settings, variation, target, progress)?;
    let mut peaks = Vec::with_capacity(values.len());
    for (index, &value) in values.iter().enumerate() {
        peaks.push(follower.peak(value, index as f64 / values.len() as f64)?);
    }
    Ok(follower.finish(peaks, start))
}

/// Finds peaks one after the other, each search from the samples of the last.
pub(super) struct Follower<'a> {
    model: &'a Model,
    settings: Settings,
    pub(super) variation: &'a Variation,
    target: &'a Target,
    progress: &'a Progress<'a>,
    memory: Memory,
    /// What the last search has resolved.
    resolution: Option<Resolution>,
    seeds: Vec<Sample>,
    points: usize,
    /// Values without a solved peak.
    pub(super) missing: Vec<Peak>,
    pub(super) interrupted: bool,
}

impl<'a> Follower<'a> {
    pub(super) fn new(
        model: &'a Model,
        settings: Settings,
        variation: &'a Variation,
        target: &'a Target,
        progress: &'a Progress<'a>,
    ) -> Result<Self, Error> {
        let (low, high) = target.span;
        if !(low > 0.0 && low < high && high < 1e100) {
            return Err(Error::value("omega range: end", high, "must lie above its start"));
        }
        // Refuses what no member could be solved with.
        let observe = [target.dof];
        let memory = ForcedBalance::new(model, settings, &observe)?.into_memory();
        Ok(Self {
            model,
            settings,
            variation,
            target,
            progress,
            memory,
            resolution: None,
            seeds: Vec::new(),
            points: 0,
            missing: Vec::new(),
            interrupted: false,
        })
    }

    pub(super) fn finish(self, peaks: Vec<Peak>, start: Instant) -> Curve {
        Curve {
            peaks,
            points: self.points,
            interrupted: self.interrupted,
            profile: Profile { total: start.elapsed(), ..self.memory.profile },
        }
    }

    /// The peak at one value of the parameter.
    pub(super) fn peak(&mut self, value: f64, share: f64) -> Result<Peak, Error> {
        self.interrupted = self.interrupted || !(self.progress)(share);
        if self.interrupted {
            return Ok(Peak::missing(value, PointStatus::NotComputed));
        }
        let member = Member::new(self.variation, self.model, self.settings.residual, value)?;
        let mut resolution = match (self.resolution, self.settings.harmonics) {
            (Some(last), _) => last,
            (None, HarmonicChoice::Fixed(harmonics)) if !self.settings.is_automatic() => {
                Resolution { harmonics, samples: self.settings.fixed_samples() }
            }
            // A first search resolves what the middle of the range asks for.
            (None, _) => {
                let middle = 0.5 * (self.target.span.0 + self.target.span.1);
                let least = Resolution { harmonics: 1, samples: None };
                least.or_finer(self.judge(&member, middle, None, share)?.1)
            }
        };
        loop {
            self.resolution = Some(resolution);
            let Some(found) = self.search(&member, resolution, share)? else {
                return Ok(self.failed(value));
            };
            let Some(&top) = found.tops.first() else { return Ok(self.failed(value)) };
            if let Some(status) = top.failure {
                // A lower maximum is no peak.
                self.seeds = found.samples;
                return Ok(Peak::missing(value, status));
            }
            let best = &found.samples[top.sample];
            let (status, wanted, estimate) = self.judge(&member, best.at, Some(best), share)?;
            let finer = resolution.or_finer(wanted);
            if finer != resolution && status != PointStatus::NotComputed {
                // What the peak asks for may move it, and change which is highest.
                self.seeds = found.samples;
                resolution = finer;
                continue;
            }
            if status == PointStatus::NotComputed {
                self.interrupted = true;
                return Ok(Peak::missing(value, status));
            }
            if matches!(status, PointStatus::Stalled | PointStatus::Singular) {
                self.seeds = found.samples;
                return Ok(Peak::missing(value, status));
            }
            let peak = Peak {
                value,
                omega: best.at,
                amplitude: member.scale * best.knots[0].height,
                slope: self.slope(&member, best, resolution.samples)?,
                status,
                harmonics: resolution.harmonics,
                error_estimate: member.scale * estimate,
                at_edge: top.sample == 0 || top.sample + 1 == found.samples.len(),
            };
            self.resolution = Some(wanted);
            self.seeds = found.samples;
            return Ok(peak);
        }
    }

    fn failed(&mut self, value: f64) -> Peak {
        if !(self.progress)(0.0) {
            self.interrupted = true;
            return Peak::missing(value, PointStatus::NotComputed);
        }
        Peak::missing(value, PointStatus::Stalled)
    }

    fn search(
        &mut self,
        member: &Member,
        resolution: Resolution,
        share: f64,
    ) -> Result<Option<Found>, Error> {
        let settings = Settings { residual: member.residual, ..self.settings.at(resolution) };
        let mut balance = ForcedBalance::new(&member.model, settings, &[])?
            .watched(self.progress)
            .remembering(std::mem::take(&mut self.memory));
        balance.report(share);
        let aim = Aim {
            groups: vec![vec![self.target.dof]],
            measure: self.target.measure,
            span: self.target.span,
            gain: GAIN,
            most_points: MOST_POINTS,
        };
        let search = Search::new(member.residual, &aim, &mut balance);
        let looks = first_look(self.target.span, &self.seeds);
        let found = search.run(&looks, &self.seeds)?;
        self.points += found.as_ref().map_or(0, |found| found.samples.len());
        self.memory = balance.into_memory();
        Ok(found)
    }

    /// Solves at a peak as the settings ask; says how that ended, with what resolution, and what a
    /// better one could change.
    fn judge(
        &mut self,
        member: &Member,
        omega: f64,
        start: Option<&Sample>,
        share: f64,
    ) -> Result<(PointStatus, Resolution, f64), Error> {
        let observe = [self.target.dof];
        let settings = Settings { residual: member.residual, ..self.settings };
        let mut balance = ForcedBalance::new(&member.model, settings, &observe)?
            .watched(self.progress)
            .remembering(std::mem::take(&mut self.memory));
        balance.report(share);
        let point = balance.solve(omega, start.map(|sample| &sample.unknowns));
        self.memory = balance.into_memory();
        self.points += 1;
        let point = point?;
        Ok((point.status, point.resolution(), point.error_estimate[0]))
    }

    /// Derivative of the peak in the parameter: the frequency at which it is highest moves, but
    /// the amplitude is stationary in it.
    fn slope(
        &mut self,
        member: &Member,
        best: &Sample,
        samples: Option<usize>,
    ) -> Result<f64, Error> {
        let mut balance = ForcedBalance::new(&member.model, self.settings, &[])?
            .remembering(std::mem::take(&mut self.memory));
        let table = balance.table(best.unknowns.harmonics().highest());
        let model = balance.evaluated(samples)?;
        self.memory = balance.into_memory();
        let omega = best.at;
        let mut linearised =
            Linearised::new(&model, &table, member.residual, omega, &best.unknowns)?;
        let causes: Vec<_> = member.causes.iter().map(|(cause, _)| *cause).collect();
        let Target { dof, measure, .. } = *self.target;
        let (_, slopes) = linearised.amplitude(dof, measure, &causes)?;
        self.memory.profile.add(linearised.profile());
        Ok(slopes.iter().zip(&member.causes).map(|(slope, (_, share))| slope * share).sum())
    }
}
