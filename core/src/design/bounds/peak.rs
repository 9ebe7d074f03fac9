//! Bounds of a peak over the residual tractions that Coulomb allows.
//!
//! The least and the largest amplitude are sought where the search for the peak has looked, as along
//! any curve ([`super::response`]); around the highest point of either, points are added at the tops of
//! parabolas and, since a bound may end at a jump, halfway to the farther neighbour in turn. A residual
//! traction that is the same at all frequencies has a peak between these two.

use super::response::{tables_of, Found, Search, Survey};
use crate::balance::{CurveEnd, ForcedBalance, Point, Progress, Settings, Solution, Uniqueness};
use crate::design::held_pool::NO_WIDTH;
use crate::design::peak::{predicted, Sample};
use crate::model::Model;
use crate::timing::Profile;
use crate::Error;
use std::sync::Arc;

/// Rise of the response, over its peak, between points that are looked at.
const RISE: f64 = 0.1;
/// Longest distance between them, over the range.
const FAR: f64 = 0.1;
/// Points that are added for a bound at most.
const ADDED: usize = 12;
/// Gain in height, relative, that is not worth another one.
const GAIN: f64 = 1e-6;
/// Share of an interval that a new point keeps from its ends.
const INSIDE: f64 = 0.05;

/// Between which amplitudes a peak lies.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct PeakBounds {
    /// Highest point of the least amplitudes \[m\].
    pub lower: f64,
    /// Highest point of the largest amplitudes \[m\].
    pub upper: f64,
    /// What they depend on.
    pub unique: Uniqueness,
    /// Whether theory excludes others; else they are inner bounds.
    pub proved: bool,
}

impl PeakBounds {
    /// Those of the only peak there is.
    pub(crate) fn unique(amplitude: f64, proved: bool) -> Self {
        Self { lower: amplitude, upper: amplitude, unique: Uniqueness::Unique, proved }
    }

    /// Those of displacements `scale` times as large.
    pub(crate) fn scaled(self, scale: f64) -> Self {
        Self { lower: scale * self.lower, upper: scale * self.upper, ..self }
    }
}

/// A point with what was found there.
struct Place {
    point: Arc<Point>,
    found: Found,
}

impl Place {
    /// The largest amplitude there, or minus the least one.
    fn height(&self, sign: f64) -> f64 {
        let bounds = self.found.bounds();
        bounds.map_or(f64::NAN, |bounds| if sign > 0.0 { bounds.upper[0] } else { bounds.lower[0] })
    }

    fn is_unique(&self) -> bool {
        self.found.bounds().is_none_or(|bounds| bounds.unique == Uniqueness::Unique)
    }
}

/// Bounds of the peak of a DOF; `samples` are those by which it was found, with that of the peak at
/// `top`. Says how many points were solved for, too.
///
/// # Errors
/// As for the bounds of a curve.
pub(crate) fn bound_peak(
    model: &Model,
    settings: Settings,
    dof: usize,
    (samples, top): (&[Sample], usize),
    progress: &Progress<'_>,
) -> Result<(PeakBounds, usize, Profile), Error> {
    let observe = [dof];
    let mut balance = ForcedBalance::new(model, settings, &observe)?.watched(progress);
    let mut points = Vec::new();
    for sample in chosen(samples, top) {
        points.push(Arc::new(balance.solve(sample.at, Some(&sample.unknowns))?));
    }
    let (end, profile) = (CurveEnd::Range, Profile::default());
    let curve = Solution { points, half_wave: false, interrupted: false, end, cut: 0, profile };
    let tables = tables_of(&curve);
    let mut search = Search::new(model, settings, &observe, &curve, &tables)?;
    let found = search.along(&curve, None, progress)?;
    let pairs = curve.points.into_iter().zip(found);
    let mut places: Vec<Place> = pairs.map(|(point, found)| Place { point, found }).collect();
    let peak = samples[top].knots[0].height;
    let at_peak =
        |places: &[Place]| places.iter().position(|one| one.point.omega == samples[top].at);
    for sign in [1.0, -1.0] {
        for added in 0..ADDED {
            let Some(best) = highest(&places, sign) else { break };
            let around = &places[best.saturating_sub(1)..(best + 2).min(places.len())];
            let known = at_peak(&places) == Some(best) && around.iter().all(Place::is_unique);
            let next =
                next_to(&places, (best, sign), added % 2 == 1).filter(|_| !known && progress(1.0));
            let Some(omega) = next else { break };
            let point = Arc::new(balance.solve(omega, predicted(samples, omega).as_ref())?);
            let survey = Survey { corners: true, starts: false };
            let found = search.point(&point, Some(&places[best].found), survey)?;
            let after = places.partition_point(|other| other.point.omega < omega);
            places.insert(after, Place { point, found });
        }
    }
    let of = |sign: f64| highest(&places, sign).map_or(peak, |best| places[best].height(sign));
    let (lower, upper) = (of(-1.0).min(peak), of(1.0).max(peak));
    let pushed = at_peak(&places).and_then(|at| places[at].found.bounds());
    let unique = match pushed {
        _ if upper - lower <= NO_WIDTH * upper => Uniqueness::Unique,
        Some(bounds) if bounds.unique == Uniqueness::Shakedown => Uniqueness::Shakedown,
        _ => Uniqueness::Residual,
    };
    let bounds = match unique {
        Uniqueness::Unique => PeakBounds::unique(peak, false),
        _ => PeakBounds { lower, upper, unique, proved: false },
    };
    let mut profile = search.profile;
    profile.add(&balance.into_memory().profile);
    Ok((bounds, places.len(), profile))
}

/// The samples that show where the response rises, and the peak.
fn chosen(samples: &[Sample], top: usize) -> impl Iterator<Item = &Sample> {
    let height = |sample: &Sample| sample.knots[0].height;
    let ends = samples.first().zip(samples.last()).map_or(0.0, |(a, b)| b.at - a.at);
    let mut last: Option<&Sample> = None;
    samples.iter().enumerate().filter_map(move |(at, sample)| {
        let rises = |last: &Sample| {
            let rise = (height(sample) - height(last)).abs();
            rise > RISE * height(&samples[top]) || sample.at - last.at > FAR * ends
        };
        let taken = at == top || last.is_none_or(rises);
        taken.then(|| {
            last = Some(sample);
            sample
        })
    })
}

/// Where a bound is highest.
fn highest(places: &[Place], sign: f64) -> Option<usize> {
    let known = (0..places.len()).filter(|&at| places[at].height(sign).is_finite());
    known.max_by(|&a, &b| places[a].height(sign).total_cmp(&places[b].height(sign)))
}

/// The frequency at which a bound may be higher than at its highest place: the top of the parabola
/// through that and its neighbours, or `halfway` to the farther one; beside an end of the range, a little
/// off it.
fn next_to(places: &[Place], (best, sign): (usize, f64), halfway: bool) -> Option<f64> {
    let at = |place: usize| places[place].point.omega;
    let height = |place: usize| places[place].height(sign) / places[best].height(sign) - 1.0;
    if best == 0 || best + 1 == places.len() {
        let other = if best == 0 { 1 } else { best.checked_sub(1)? };
        let near = other < places.len() && -height(other) > RISE;
        return near.then(|| at(best) + INSIDE * (at(other) - at(best)));
    }
    let (before, after) = (at(best) - at(best - 1), at(best + 1) - at(best));
    // The parabola is 0 at the highest place.
    let (left, right) = (-height(best - 1) / before, height(best + 1) / after);
    let bend = (right - left) / (before + after);
    let rise = left + before * bend;
    let gain = -0.25 * rise * rise / bend;
    let step = match halfway {
        true if before > after => -0.5 * before,
        true => 0.5 * after,
        false => -0.5 * rise / bend,
    };
    let room = INSIDE * if step > 0.0 { after } else { before };
    let step = step.clamp(room - before, after - room);
    (bend < 0.0 && gain > GAIN)
        .then(|| at(best) + if step.abs() > room { step } else { room.copysign(step) })
}
