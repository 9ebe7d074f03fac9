//! How the force of an element depends on its parameters at a fixed displacement.
//!
//! Between the events of the path `f = k_d (u − u_a) ± F_d` while it sticks, from the turning
//! point u_a at which the last slip ended, and `f = ±F_d` while it slips. The events move with
//! the parameters, but f is continuous there, so that the integrals over the fixed intervals are
//! the exact derivatives.

use crate::contact::slider_integrals::Bounds;
use crate::contact::stick_slip::{Path, Slip, Stick, StickSlipIntervals};
use crate::contact::{Motion, Residual, Slider};
use crate::fourier::{Harmonics, IntervalSums};

impl Slider {
    /// Series of ∂f/∂k_d: `u − u_a` while it sticks, nothing while it slips.
    pub(super) fn stiffness_slope(&self, motion: Motion<'_>, path: &Path<'_>, out: &mut [f64]) {
        let harmonics = motion.table.harmonics();
        match StickSlipIntervals::new(path, self.stiffness, self.slip_force) {
            // Without friction there is no force whatever the spring.
            StickSlipIntervals::Free if self.slip_force == 0.0 => {}
            // The first trace of a spring follows the whole motion, too.
            StickSlipIntervals::Free | StickSlipIntervals::Stuck => {
                out.copy_from_slice(motion.displacement);
                self.add_stuck_mean(motion, path.middle(), path.half_range(), out);
            }
            StickSlipIntervals::Slipping { sticks, slips } => {
                out.copy_from_slice(motion.displacement);
                let weight = 2.0 / harmonics.span();
                if harmonics.has_mean() {
                    out[0] *= 2.0;
                }
                let mut sums = IntervalSums::new(harmonics);
                slips.iter().for_each(|slip| sums.add(slip.start, slip.end));
                sums.products(harmonics, -weight, |i, j, v| {
                    out[i] += v * motion.displacement[j];
                });
                let mut bounds = Bounds::new(harmonics);
                for stick in &sticks {
                    let anchor = path.turns[stick.anchor].value;
                    bounds.add_integral(harmonics, stick.start, stick.end, -weight * anchor, out);
                }
                harmonics.halve_means(out);
            }
        }
    }

    /// Series of ∂f/∂F_d: the sign of the last slip.
    pub(super) fn slip_force_slope(&self, motion: Motion<'_>, path: &Path<'_>, out: &mut [f64]) {
        let harmonics = motion.table.harmonics();
        // Without friction the derivative is that of the first trace of it: slip all the time.
        if self.slip_force == 0.0 && self.stiffness > 0.0 {
            return add_direction(motion, path, out);
        }
        match StickSlipIntervals::new(path, self.stiffness, self.slip_force) {
            StickSlipIntervals::Free => {}
            StickSlipIntervals::Stuck => {
                let room = self.slip_force - self.stiffness * path.half_range();
                let wanted = self.wanted_mean(motion.residual, path.middle());
                if harmonics.has_mean() && wanted.abs() > room {
                    out[0] = 1.0_f64.copysign(wanted);
                }
            }
            StickSlipIntervals::Slipping { sticks, slips } => {
                self.add_signs(harmonics, path, &sticks, &slips, out);
                harmonics.halve_means(out);
            }
        }
    }

    fn add_signs(
        &self,
        harmonics: &Harmonics,
        path: &Path<'_>,
        sticks: &[Stick],
        slips: &[Slip],
        out: &mut [f64],
    ) {
        let weight = 2.0 / harmonics.span();
        let mut bounds = Bounds::new(harmonics);
        for stick in sticks {
            let anchor = path.turns[stick.anchor].value;
            let sign = (self.stiffness * anchor - stick.slip_load).signum();
            bounds.add_integral(harmonics, stick.start, stick.end, weight * sign, out);
        }
        for slip in slips {
            bounds.add_integral(harmonics, slip.start, slip.end, weight * slip.sign, out);
        }
    }

    /// Force at mid-range that the residual assumption asks of a contact that never slips.
    pub(super) fn wanted_mean(&self, residual: Residual, middle: f64) -> f64 {
        match residual {
            Residual::Centred => 0.0,
            Residual::FromRest => self.stiffness * middle,
            Residual::Value(force) => force,
        }
    }

    /// Mean of `∂f/∂k_d − u` of a contact that never slips: its force at mid-range is prescribed,
    /// grows from rest, or is held down by the slip limit.
    fn add_stuck_mean(&self, motion: Motion<'_>, middle: f64, half_range: f64, out: &mut [f64]) {
        if !motion.table.harmonics().has_mean() {
            return;
        }
        let wanted = self.wanted_mean(motion.residual, middle);
        let room = self.slip_force - self.stiffness * half_range;
        out[0] -= if wanted.abs() > room {
            middle + half_range.copysign(wanted)
        } else if motion.residual == Residual::FromRest {
            0.0
        } else {
            middle
        };
    }
}

/// Adds the series of the sign of the velocity.
fn add_direction(motion: Motion<'_>, path: &Path<'_>, out: &mut [f64]) {
    let harmonics = motion.table.harmonics();
    let weight = 2.0 / harmonics.span();
    let mut bounds = Bounds::new(harmonics);
    for ends in path.turns.windows(2) {
        let sign = (ends[1].value - ends[0].value).signum();
        bounds.add_integral(harmonics, ends[0].theta, ends[1].theta, weight * sign, out);
    }
    harmonics.halve_means(out);
}
