//! Solved points with their slopes, and the starts they give.

use super::interpolant::Knot;
use super::overlay::Overlay;
use crate::balance::Unknowns;
use crate::solve::norm;

/// By how much other harmonics may move a motion.
const MOVED: f64 = 0.1;

/// A solved point with its slopes.
#[derive(Debug, Clone)]
pub(crate) struct Sample {
    /// Frequency [rad/s].
    pub(crate) at: f64,
    /// Height and slope of every DOF looked at.
    pub(crate) knots: Vec<Knot>,
    /// The harmonics of every DOF looked at, if several are loaded.
    pub(super) overlays: Vec<Overlay>,
    pub(crate) unknowns: Unknowns,
    /// Derivative of the unknowns in frequency.
    pub(super) rate: Vec<f64>,
    /// Which points slip.
    pub(super) slips: Vec<bool>,
}

impl Sample {
    /// Whether no point slips.
    pub(super) fn sticks(&self) -> bool {
        !self.slips.contains(&true)
    }

    /// Whether a motion of other harmonics is this one, as far as those may move it.
    pub(super) fn is_like(&self, other: &Unknowns) -> bool {
        let (own, other) = (self.unknowns.values(), other.recast(self.unknowns.harmonics()));
        let apart: Vec<f64> = own.iter().zip(&other).map(|(a, b)| a - b).collect();
        norm(&apart) <= MOVED * norm(own)
    }

    /// Heights with their slopes, and those that they would be if the harmonics fell on each other.
    pub(super) fn curves(&self) -> impl Iterator<Item = Knot> + '_ {
        self.knots.iter().copied().chain(self.overlays.iter().map(|one| one.ceiling))
    }

    fn extrapolated(&self, omega: f64) -> Unknowns {
        let step = omega - self.at;
        let values = self.unknowns.values().iter().zip(&self.rate).map(|(x, r)| x + step * r);
        Unknowns::new(self.unknowns.harmonics().clone(), values.collect())
    }

    fn interpolated(&self, right: &Self, omega: f64) -> Unknowns {
        let width = right.at - self.at;
        let t = (omega - self.at) / width;
        let (rise, fall) = (t * t * (3.0 - 2.0 * t), t * (1.0 - t));
        let ends = self.unknowns.values().iter().zip(right.unknowns.values());
        let values = ends.zip(self.rate.iter().zip(&right.rate)).map(|((x, y), (dx, dy))| {
            x + rise * (y - x) + width * fall * ((1.0 - t) * dx - t * dy)
        });
        Unknowns::new(self.unknowns.harmonics().clone(), values.collect())
    }
}

/// A start from samples around a frequency: their cubic, or the tangent of the nearest.
pub(crate) fn predicted(samples: &[Sample], omega: f64) -> Option<Unknowns> {
    let after = samples.partition_point(|sample| sample.at < omega);
    match (after.checked_sub(1).map(|i| &samples[i]), samples.get(after)) {
        (Some(left), Some(right)) => Some(left.interpolated(right, omega)),
        (Some(one), None) | (None, Some(one)) => Some(one.extrapolated(omega)),
        (None, None) => None,
    }
}

/// A start from a similar response: its solution, moved by as much as the nearest sample
/// differs from it.
pub(super) fn beside(samples: &[Sample], seeds: &[Sample], omega: f64) -> Option<Unknowns> {
    let mut start = predicted(seeds, omega)?;
    let distance = |sample: &Sample| (sample.at - omega).abs();
    let nearest = samples.iter().min_by(|a, b| distance(a).total_cmp(&distance(b)));
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
