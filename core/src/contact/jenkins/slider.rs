//! One elastic, perfectly plastic element: a spring k_d in series with a slider of limit F_d.

use crate::contact::slip_element::SlipElement;
use crate::contact::stick_slip::{Path, Slip, Stick, StickSlipIntervals};
use crate::contact::{Motion, PointState, PointSummary, Residual, SlipLoad};
use crate::Error;
use faer::Mat;
use std::f64::consts::TAU;

/// One elastic, perfectly plastic element.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct Slider {
    /// k_d [N/m].
    pub stiffness: f64,
    /// F_d \[N\].
    pub slip_force: f64,
}

impl Slider {
    /// An element of stiffness k_d [N/m] and slip force F_d \[N\]; an infinite slip force never
    /// slips.
    ///
    /// # Errors
    /// Negative or NaN parameters, infinite stiffness.
    pub fn new(stiffness: f64, slip_force: f64) -> Result<Self, Error> {
        if !(stiffness.is_finite() && stiffness >= 0.0) {
            return Err(Error::value(
                "jenkins: stiffness",
                stiffness,
                "must be finite and not negative; take about 1000 times the local stiffness of the structure for a rigid damper",
            ));
        }
        if slip_force.is_nan() || slip_force < 0.0 {
            return Err(Error::value(
                "jenkins: slip_force",
                slip_force,
                "must not be negative; infinity means that the contact never slips",
            ));
        }
        Ok(Self { stiffness, slip_force })
    }

    /// Force that is beyond which the element slips: none of one without spring.
    pub(super) fn limit(&self) -> f64 {
        if self.stiffness == 0.0 {
            0.0
        } else {
            self.slip_force
        }
    }

    /// Slip load of a stuck element and its derivatives in the middle and in half the range of u.
    pub(super) fn held_load(
        &self,
        residual: Residual,
        middle: f64,
        half_range: f64,
    ) -> (f64, f64, f64) {
        let k = self.stiffness;
        let wanted = self.wanted_mean(residual, middle);
        let wanted_slope = if residual == Residual::FromRest { k } else { 0.0 };
        let room = self.slip_force - k * half_range;
        if wanted.abs() <= room {
            (k * middle - wanted, k - wanted_slope, 0.0)
        } else {
            (k * middle - room.copysign(wanted), k, k.copysign(wanted))
        }
    }

    pub(super) fn summary(&self, cycle: &StickSlipIntervals, span: f64) -> PointSummary {
        match cycle {
            StickSlipIntervals::Free => PointSummary {
                slip_fraction: f64::from(u8::from(self.slip_force == 0.0)),
                dissipation: 0.0,
            },
            StickSlipIntervals::Stuck => PointSummary::default(),
            StickSlipIntervals::Slipping { slips, .. } => {
                let length: f64 = slips.iter().map(|slip| slip.end - slip.start).sum();
                let travel: f64 = slips.iter().map(|slip| slip.travel).sum();
                PointSummary {
                    slip_fraction: length / span,
                    dissipation: self.slip_force * travel * TAU / span,
                }
            }
        }
    }

    /// Force at an angle inside the span that the intervals cover.
    pub(super) fn force_at(&self, sticks: &[Stick], slips: &[Slip], theta: f64, u: f64) -> f64 {
        if let Some(slip) = slips.iter().find(|s| theta >= s.start && theta < s.end) {
            return slip.sign * self.slip_force;
        }
        let stick = sticks.iter().find(|s| theta >= s.start && theta <= s.end);
        let load = stick.or(sticks.last()).map_or(0.0, |s| s.slip_load);
        (self.stiffness * u - load).clamp(-self.slip_force, self.slip_force)
    }

    /// Adds the slip load of an element without friction, `k_d u`.
    pub(super) fn add_free(&self, motion: Motion<'_>, tangent: bool, out: &mut SlipLoad) {
        let (k, size) = (self.stiffness, motion.displacement.len());
        for (i, u) in motion.displacement.iter().enumerate() {
            out.value[i] += k * u;
            if tangent {
                out.tangent[i * size + i] += k;
            }
        }
        out.active |= k > 0.0;
    }

    /// Adds the mean slip load of an element that never slips.
    pub(super) fn add_stuck(&self, motion: Motion<'_>, path: &Path<'_>, out: &mut SlipLoad) {
        let (load, by_middle, by_range) =
            self.held_load(motion.residual, path.middle(), path.half_range());
        out.value[0] += load;
        if by_middle == 0.0 && by_range == 0.0 {
            return;
        }
        out.active = true;
        path.add_extremes(
            [0.5 * (by_middle + by_range), 0.5 * (by_middle - by_range)],
            &mut out.tangent,
        );
    }
}

impl SlipElement for Slider {
    fn stiffness(&self) -> Mat<f64> {
        Mat::from_fn(1, 1, |_, _| self.stiffness)
    }

    fn limits(&self) -> Vec<f64> {
        vec![self.limit()]
    }

    fn tangent(&self, points: &[PointState]) -> Mat<f64> {
        let sticks = points[0] == PointState::Stuck && self.slip_force > 0.0;
        Mat::from_fn(1, 1, |_, _| if sticks { self.stiffness } else { 0.0 })
    }

    fn slip_rate(&self, points: &[PointState]) -> Mat<f64> {
        Mat::from_fn(1, 1, |_, _| points[0].sign().abs())
    }

    fn increment(
        &self,
        before: &[f64],
        after: &[f64],
        force: &mut [f64],
        gain: Option<&mut [f64]>,
    ) {
        let trial = force[0] + self.stiffness * (after[0] - before[0]);
        force[0] = trial.clamp(-self.slip_force, self.slip_force);
        if let Some(gain) = gain {
            gain[0] = f64::from(u8::from(trial == force[0]));
        }
    }
}
