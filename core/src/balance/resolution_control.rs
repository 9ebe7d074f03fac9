//! The levels of resolution that automatic harmonics and samples go through.
//!
//! The errors say which of the two a point lacks: what the discarded harmonics could change, and
//! what a march through more samples could. Samples climb first, because a coarse march knows too
//! little of the discarded harmonics. The next point begins where the last one has ended, a level
//! lower if that was generous.

use super::settings::{
    resolving, Evaluation, HarmonicChoice, Resolution, SampleChoice, Settings, FEWEST_SAMPLES,
};
use super::solution::PointStatus;

/// Orders that automatic harmonics climb: half as many again from level to level.
const ORDERS: [usize; 17] = [1, 3, 5, 7, 9, 13, 19, 27, 39, 57, 83, 121, 177, 261, 387, 575, 857];
/// Below this order the friction force has no shape that an estimate could start from.
const LOWEST_ORDER: usize = 3;
/// First level: enough for a smooth slip cycle.
const FIRST_RUNG: usize = 3;
/// An estimate this far below the tolerance lets the next point try one level less.
const GENEROUS: f64 = 0.05;
/// Beyond all modes friction forces with kinks leave displacements whose harmonics fall with the fourth power of their
/// order, and an error that falls with the third. …
const FALL: i32 = 3;
/// … The next point tries one level less where that leaves this share of the tolerance, …
const FORESEEN: f64 = 0.6;
/// … from this level on. Below it a level costs next to nothing, and curves around sharp folds are followed more
/// safely with one more.
const DEAR: usize = 39;
/// Share of the tolerance that the sampling error may take: it leaves most to the discarded
/// harmonics, which cost more, for twice the samples that the whole tolerance would ask for.
const OF_SAMPLES: f64 = 0.25;
/// A sampling error this far below its share lets the next point try half the samples, which err
/// four times as much.
const GENEROUS_SAMPLES: f64 = 0.125;

/// Where the next point begins.
#[derive(Debug, Clone, Copy)]
pub(crate) struct Level {
    order: usize,
    samples: usize,
}

impl Default for Level {
    fn default() -> Self {
        Self { order: FIRST_RUNG, samples: FEWEST_SAMPLES }
    }
}

/// What the errors of a solution ask for.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub(super) enum Decision {
    Enough,
    More(Resolution),
    /// More than the settings allow.
    Limit(PointStatus),
}

/// The levels that the settings allow.
#[derive(Debug, Clone)]
pub(super) struct ResolutionControl {
    settings: Settings,
    orders: Vec<usize>,
    lowest: usize,
    pub(super) level: Level,
}

impl ResolutionControl {
    /// The resolution of a model with loads at the harmonics `forced`.
    pub(super) fn new(settings: Settings, forced: &[usize]) -> Self {
        let limit = settings.max_harmonics;
        let least = forced.last().copied().unwrap_or(1).max(1);
        let orders: Vec<usize> = match settings.harmonics {
            HarmonicChoice::Fixed(highest) => vec![highest],
            HarmonicChoice::Auto => {
                let levels = ORDERS.iter().copied().filter(|&h| h >= least && h < limit);
                levels.chain([limit]).collect()
            }
        };
        let lowest = orders.iter().position(|&h| h >= LOWEST_ORDER).unwrap_or(0);
        Self { settings, orders, lowest, level: Level::default() }
    }

    /// Whether there is nothing to choose.
    pub(super) fn is_fixed(&self) -> bool {
        !self.harmonics_climb() && !self.samples_climb()
    }

    /// Whether the number of harmonics is chosen.
    pub(super) fn harmonics_climb(&self) -> bool {
        self.settings.harmonics == HarmonicChoice::Auto
    }

    /// Whether the number of samples is chosen.
    pub(super) fn samples_climb(&self) -> bool {
        self.settings.evaluation.samples() == Some(SampleChoice::Auto)
    }

    /// What the next point begins with.
    pub(super) fn first(&self) -> Resolution {
        let harmonics = self.orders[self.level.order.min(self.orders.len() - 1)];
        let samples = self.settings.evaluation.samples().map(|choice| match choice {
            SampleChoice::Fixed(samples) => samples,
            SampleChoice::Auto => self.level.samples,
        });
        self.allowed(harmonics, samples)
    }

    /// Judges a solution by its errors relative to its amplitudes: that of all that is chosen
    /// automatically, and the part of it that more samples would take away. Beyond the order `modes` no mode takes
    /// part.
    pub(super) fn judge(
        &mut self,
        at: Resolution,
        [error, of_samples]: [f64; 2],
        modes: f64,
    ) -> Decision {
        let tolerance = self.settings.tolerance;
        let target = OF_SAMPLES * tolerance;
        let mut decision = Decision::Enough;
        let mut left = error;
        if let Some(samples) = at.samples.filter(|_| self.samples_climb()) {
            self.level.samples = samples;
            if of_samples > target {
                if let Some(finer) = self.lacking(at, of_samples) {
                    return Decision::More(finer);
                }
                // More harmonics bring the rest of the error down all the same.
                decision = Decision::Limit(PointStatus::SamplesLimit);
                left -= of_samples;
            } else if of_samples <= GENEROUS_SAMPLES * target {
                self.level.samples = samples / 2;
            }
        }
        if self.settings.harmonics != HarmonicChoice::Auto {
            return decision;
        }
        let order = self.position(at);
        if left > tolerance {
            let Some(&more) = self.orders.get(order + 1) else {
                self.level.order = order;
                return Decision::Limit(PointStatus::HarmonicsLimit);
            };
            return Decision::More(self.allowed(more, at.samples));
        }
        let generous = left <= GENEROUS * tolerance || self.has_fallen(order, left, modes);
        self.level.order = (order - usize::from(generous && order > 0)).max(self.lowest);
        decision
    }

    /// Whether a level less than one that leaves an error would do, by how errors fall beyond all modes.
    fn has_fallen(&self, order: usize, left: f64, modes: f64) -> bool {
        let Some(less) = order.checked_sub(1).map(|less| self.orders[less]) else { return false };
        less as f64 >= modes.max(DEAR as f64)
            && beyond_modes(left, self.orders[order], less) <= FORESEEN * self.settings.tolerance
    }

    /// The samples that a solution lacks by their error alone, if they may be had.
    pub(super) fn lacking(&self, at: Resolution, of_samples: f64) -> Option<Resolution> {
        let target = OF_SAMPLES * self.settings.tolerance;
        if !self.samples_climb() || at.samples.is_none() || of_samples <= target {
            return None;
        }
        let finer = self.allowed(at.harmonics, finer(at.samples, of_samples / target));
        Some(finer).filter(|finer| *finer != at)
    }

    /// A level more of all that is chosen automatically, if there is one.
    pub(super) fn above(&self, at: Resolution) -> Option<Resolution> {
        let harmonics = self.orders.get(self.position(at) + 1).copied().unwrap_or(at.harmonics);
        let samples = if self.samples_climb() { finer(at.samples, 1.0) } else { at.samples };
        Some(self.allowed(harmonics, samples)).filter(|above| *above != at)
    }

    /// Whether more harmonics than these may be chosen.
    pub(super) fn has_more(&self, harmonics: usize) -> bool {
        self.orders.last().is_some_and(|&last| harmonics < last)
    }

    /// Has the next point begin with the harmonics of this one.
    pub(super) fn stay(&mut self, at: Resolution) {
        self.level.order = self.position(at);
    }

    /// Has the next point begin with no less than this.
    pub(super) fn begin_with(&mut self, at: Resolution) {
        let enough = self.orders.iter().position(|&order| order >= at.harmonics);
        self.level.order = enough.unwrap_or(self.orders.len() - 1);
        self.level.samples = at.samples.unwrap_or(self.level.samples);
    }

    /// Whether harmonics are chosen, for laws that are evaluated as they are.
    pub(super) fn only_harmonics_climb(&self) -> bool {
        self.settings.harmonics == HarmonicChoice::Auto
            && self.settings.evaluation == Evaluation::Direct
    }

    /// Orders that may be chosen from this one on.
    pub(super) fn orders_from(&self, order: usize) -> impl Iterator<Item = usize> + '_ {
        self.orders.iter().copied().filter(move |&one| one >= order)
    }

    /// Lowest order with which a point may begin.
    pub(super) fn lowest_order(&self) -> usize {
        self.orders[self.lowest.min(self.orders.len() - 1)]
    }

    /// As [`ResolutionControl::first`], from the lowest level on.
    pub(super) fn start_over(&mut self) -> Resolution {
        self.level.order = self.lowest;
        self.first()
    }

    fn position(&self, at: Resolution) -> usize {
        self.orders.iter().position(|&order| order == at.harmonics).unwrap_or(0)
    }

    /// As many samples as asked for within what the harmonics need and the settings allow.
    fn allowed(&self, harmonics: usize, samples: Option<usize>) -> Resolution {
        let bounded = |samples: usize| {
            if self.samples_climb() {
                samples.max(resolving(harmonics)).min(self.settings.max_samples)
            } else {
                samples
            }
        };
        Resolution { harmonics, samples: samples.map(bounded) }
    }
}

/// What becomes of an error of `from` harmonics with `to` of them, beyond all modes.
pub(super) fn beyond_modes(error: f64, from: usize, to: usize) -> f64 {
    error * (from as f64 / to as f64).powi(FALL)
}

/// The next power of two whose error, of second order, is about `excess` times less.
fn finer(samples: Option<usize>, excess: f64) -> Option<usize> {
    // A coarse march misjudges its error: no more than three levels at once.
    let levels = (0.5 * excess.log2()).round().clamp(1.0, 3.0) as u32;
    samples.map(|samples| samples.next_power_of_two() << levels)
}

#[cfg(test)]
mod tests {
    use super::*;

    /// The level with which the next point begins after one that leaves an error.
    fn next(order: usize, error: f64, modes: f64) -> usize {
        let mut control = ResolutionControl::new(Settings::default(), &[1]);
        let at = Resolution { harmonics: order, samples: None };
        assert_eq!(control.judge(at, [error, 0.0], modes), Decision::Enough);
        control.first().harmonics
    }

    /// An error of a tenth of the tolerance, as a few points beside a sharp bend leave behind, held all points
    /// after them at a level that costs three times the one below.
    #[test]
    fn dear_levels_are_left_as_soon_as_the_one_below_would_do() {
        let tolerance = Settings::default().tolerance;
        for (order, below) in [(57, 39), (83, 57), (121, 83), (177, 121)] {
            assert_eq!(next(order, 0.1 * tolerance, 9.0), below);
            // That one would leave more than the tolerance.
            assert_eq!(next(order, 0.4 * tolerance, 9.0), order);
            // Errors do not fall before all modes are passed.
            assert_eq!(next(order, 0.1 * tolerance, below as f64 + 1.0), order);
        }
        // Cheap levels are left where next to nothing is.
        assert_eq!(next(27, 0.1 * tolerance, 3.0), 27);
        assert_eq!(next(27, 0.01 * tolerance, 3.0), 19);
    }
}
