//! Whether contacts have let go of a body that they alone hold: its mean position goes anywhere.

use super::condensed::Condensed;
use super::linear::Linear;
use super::statics::FREE;

/// Mean of a direction, relative to the motion, that is the walk of a body which contacts alone hold: what
/// holds it elastically does so within a few times its motion.
const WALKS: f64 = 1e4;
/// Natural frequency without contacts, relative to that with all of them stuck, that is none.
const RIGID: f64 = 1e-4;

impl Condensed<'_> {
    /// Judges the mean of the Newton direction that answers to a residual of a size \[m\].
    pub(super) fn judge_mean(&mut self, step: &[f64], residual: f64) {
        let mean = self.largest_mean(step);
        let motion = self.sizes.iter().copied().fold(0.0, f64::max);
        let far = if self.may_walk() { WALKS } else { FREE };
        self.free = mean > far * motion;
        self.loose = mean > FREE * residual;
    }

    /// The largest mean displacement of a direction, 0 if there is no mean \[m\].
    fn largest_mean(&self, step: &[f64]) -> f64 {
        let harmonics = self.table.harmonics();
        let means = step.iter().step_by(harmonics.slots()).map(|mean| mean.abs());
        if harmonics.has_mean() {
            means.fold(0.0, f64::max)
        } else {
            0.0
        }
    }

    /// Whether many contacts are all that holds a body: under a load beyond what friction keeps while it
    /// vibrates it walks, and no motion repeats.
    fn may_walk(&self) -> bool {
        if !matches!(self.linear, Linear::Modal(_)) {
            return false;
        }
        let lowest = self.model.compliance().lowest_frequencies();
        lowest.is_some_and(|[stuck, free]| free <= RIGID * stuck)
    }
}
