//! Whether contacts have let go of a body that they alone hold: its mean position goes anywhere.

use super::condensed::Condensed;
use super::linear::Linear;
use super::statics::FREE;
use crate::solve::{norm, System as _};
use crate::structure::Compliance;
use faer::Mat;

/// Mean of a direction, relative to the motion, that is the walk of a body which contacts alone hold: what
/// holds it elastically does so within a few times its motion.
const WALKS: f64 = 1e4;
/// Distance, over the motion without slip, at which a body has left its contacts.
const AWAY: f64 = 1e3;
/// Share of the largest singular value, and of forces, that is rounding.
const ROUNDING: f64 = 1e-9;
/// Natural frequency without contacts, relative to that with all of them stuck, that is none.
const RIGID: f64 = 1e-4;

/// Contact points up to which it is found out whether a body may stay away: the matrices are dense.
const MOST: usize = 300;

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

    /// Whether a body that contacts alone hold may leave them all and stay away: its vibration in free
    /// flight solves the equations, wherever it is, unless a load drives it further away; none presses it back.
    pub(super) fn floats(&mut self) -> bool {
        let slots = self.table.harmonics().slots();
        let points = self.stuck.len() / slots.max(1);
        let small = (1..=MOST).contains(&points);
        if !self.table.harmonics().has_mean() || !small || !self.is_held_by_contacts() {
            return false;
        }
        // A mean displacement of all contacts open, u = u_stuck + G D u: rigid-body motion has u = G D u.
        let stiffness = self.model.contact_stiffness().to_owned();
        let springs = |x: &[f64]| -> Vec<f64> {
            let force = |(place, _)| -> f64 {
                let (point, slot) = (place / slots, place % slots);
                (0..points).map(|j| stiffness[(point, j)] * x[j * slots + slot]).sum()
            };
            x.iter().enumerate().map(force).collect()
        };
        let open = Mat::from_fn(points, points, |i, j| {
            let mut unit = vec![0.0; self.stuck.len()];
            unit[j * slots] = 1.0;
            let mut answer = vec![0.0; self.stuck.len()];
            self.add_response(&springs(&unit), &mut answer);
            f64::from(u8::from(i == j)) - answer[i * slots]
        });
        let Ok(parts) = open.svd() else { return false };
        let values = parts.S().column_vector();
        if values[points - 1] > ROUNDING * values[0] {
            return false;
        }
        [AWAY, -AWAY].into_iter().any(|away| {
            let mut x = self.stuck.clone();
            let far = away * norm(&x);
            (0..points).for_each(|i| x[i * slots] += far * parts.V()[(i, points - 1)]);
            let mut residual = vec![0.0; x.len()];
            self.residual(&x, &mut residual);
            let (sprung, loads) = (springs(&x), self.slip_load());
            // Open contacts have constant forces: none, or what the preload lacks.
            let force = (0..x.len()).filter(|i| i % slots > 0).map(|i| sprung[i] - loads[i]);
            let force: Vec<f64> = force.collect();
            // The load on the motion away is that of the springs which would hold it where it is.
            let means = sprung.iter().zip(&residual).step_by(slots);
            let back: f64 = means.map(|(spring, residual)| spring * residual).sum();
            norm(&force) < ROUNDING * norm(&sprung)
                && back < ROUNDING * norm(&sprung) * norm(&self.stuck)
        })
    }

    /// Whether many contacts are all that holds a body: under a load beyond what friction keeps while it
    /// vibrates it walks, and no motion repeats.
    fn may_walk(&self) -> bool {
        if !matches!(self.linear, Linear::Modal(_)) {
            return false;
        }
        self.is_held_by_contacts()
    }

    fn is_held_by_contacts(&self) -> bool {
        is_held_by_contacts(self.model.compliance())
    }
}

/// Whether nothing but contacts holds some body.
pub(super) fn is_held_by_contacts(compliance: &dyn Compliance) -> bool {
    let lowest = compliance.lowest_frequencies();
    lowest.is_some_and(|[stuck, free]| free <= RIGID * stuck)
}
