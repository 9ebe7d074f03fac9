//! The Bouc-Wen law, `f' = k u' (1 − |f/S|ⁿ (γ + β sgn(f u')))` with β + γ = 1 (Wen 1976).
//!
//! With `y = f/S` and `v = k u/S` the force follows `dy/dv = 1 − |y|ⁿ` while it grows and
//! `1 + (β − γ) |y|ⁿ` while it falls, whatever the velocity. It is no Masing law: a small loop within a
//! large one is not closed but drifts, since the law forgets where it reversed. It has no closed form:
//! samples give its harmonics.

use super::parameter::number;
use super::return_map::ReturnMapJacobian;
use super::stick_slip::at_crest;
use super::{ContactLaw, Motion, Parameter, Parameters};
use crate::Error;
use faer::Mat;

/// Longest step in v of the fourth-order scheme, of which the knee of a large exponent is a short one.
const STEP: f64 = 0.02;
/// Largest exponent: the force of a larger one is that of a Jenkins element to a thousandth.
const SHARPEST: f64 = 1e3;
/// Distance from the limit at which the force stays there: closer to it rounding may stop the steps.
const AT_LIMIT: f64 = 1e-14;
/// Share of the stiffness that slip takes off where it has hardly begun.
const LITTLE: f64 = 1e-12;

/// A hysteresis of one number.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct BoucWen {
    /// k [N/m].
    stiffness: f64,
    /// S \[N\].
    slip_force: f64,
    /// n.
    exponent: f64,
    /// β.
    beta: f64,
}

impl BoucWen {
    /// A law of a stiffness at rest [N/m], a largest force \[N\], the exponent n and the share β.
    ///
    /// # Errors
    /// A stiffness that is negative or infinite, a negative slip force, n outside 1 to 1000, β outside 0.5 to 1.
    pub fn new(stiffness: f64, slip_force: f64, exponent: f64, beta: f64) -> Result<Self, Error> {
        let refused = |name: &str, value: f64, remedy: &str| {
            Err(Error::value(format!("bouc-wen: {name}"), value, remedy))
        };
        if !(stiffness.is_finite() && stiffness >= 0.0) {
            return refused("stiffness", stiffness, "must be finite and not negative");
        }
        if slip_force.is_nan() || slip_force < 0.0 {
            return refused("slip_force", slip_force, "must not be negative");
        }
        if !(1.0..=SHARPEST).contains(&exponent) {
            let remedy = "must be from 1 to 1000: beyond, the law is a Jenkins element";
            return refused("exponent", exponent, remedy);
        }
        if !(0.5..=1.0).contains(&beta) {
            let remedy = "must be from 0.5 to 1: below, the law gives work back in small loops";
            return refused("beta", beta, remedy);
        }
        Ok(Self { stiffness, slip_force, exponent, beta })
    }

    pub(super) fn from_parameters(given: &Parameters) -> Result<Self, Error> {
        let [stiffness, slip_force, exponent, beta] =
            ["stiffness", "slip_force", "exponent", "beta"]
                .map(|name| number("bouc-wen", given, name));
        Self::new(stiffness?, slip_force?, exponent?, beta?)
    }

    /// `dy/dv` in the direction of `sign`, and its derivative in y.
    fn rate(&self, y: f64, sign: f64) -> [f64; 2] {
        let weight = if y * sign > 0.0 { 1.0 } else { 1.0 - 2.0 * self.beta };
        let power = y.abs().powf(self.exponent - 1.0);
        [1.0 - weight * power * y.abs(), -weight * self.exponent * power * 1.0_f64.copysign(y)]
    }

    /// Takes y through a change of v: its end, and its derivatives in the start and in the change.
    fn flow(&self, mut y: f64, change: f64) -> [f64; 3] {
        let sign = 1.0_f64.copysign(change);
        let mut left = change.abs();
        let mut gain = 1.0;
        while left > 0.0 {
            if sign * y >= 1.0 - AT_LIMIT {
                return [sign, 0.0, 0.0];
            }
            let h = sign * left.min(STEP.min(self.exponent.recip()));
            let one = self.rate(y, sign);
            let two = self.rate(y + 0.5 * h * one[0], sign);
            let three = self.rate(y + 0.5 * h * two[0], sign);
            let four = self.rate(y + h * three[0], sign);
            // The derivative of the scheme, stage by stage.
            let first = one[1];
            let second = two[1] * (1.0 + 0.5 * h * first);
            let third = three[1] * (1.0 + 0.5 * h * second);
            let fourth = four[1] * (1.0 + h * third);
            y += h / 6.0 * (one[0] + 2.0 * (two[0] + three[0]) + four[0]);
            gain *= 1.0 + h / 6.0 * (first + 2.0 * (second + third) + fourth);
            left -= h.abs();
        }
        [y, gain, self.rate(y, sign)[0]]
    }
}

impl ContactLaw for BoucWen {
    fn name(&self) -> &'static str {
        "bouc-wen"
    }

    fn displacements(&self) -> usize {
        1
    }

    fn state_size(&self) -> usize {
        1
    }

    fn stiffness(&self) -> Mat<f64> {
        Mat::from_fn(1, 1, |_, _| self.stiffness)
    }

    fn state_stiffness(&self) -> Mat<f64> {
        ContactLaw::stiffness(self)
    }

    fn is_odd(&self) -> bool {
        true
    }

    /// Small loops drift: two motions that approach each other may have forces that do not.
    fn is_monotone(&self) -> bool {
        false
    }

    fn limits(&self) -> Vec<f64> {
        vec![if self.stiffness == 0.0 { 0.0 } else { self.slip_force }]
    }

    fn grows(&self) -> Vec<bool> {
        vec![false; self.displacements()]
    }

    /// It slips from the first on: a force at twice of which that is little.
    fn onsets(&self) -> Vec<f64> {
        let little = 0.5 * LITTLE.powf(1.0 / self.exponent);
        self.limits().iter().map(|limit| little * limit).collect()
    }

    /// As soon as it moves.
    fn surely_slips(&self, motion: Motion<'_>) -> Option<bool> {
        let [high, low] = at_crest(motion);
        let yields = self.stiffness > 0.0 && self.slip_force > 0.0 && self.slip_force.is_finite();
        (yields && high != low).then_some(true)
    }

    fn return_map(
        &self,
        before: &[f64],
        after: &[f64],
        state: &mut [f64],
        force: &mut [f64],
        jacobian: Option<&mut ReturnMapJacobian>,
    ) {
        let (k, s) = (self.stiffness, self.slip_force);
        let change = k * (after[0] - before[0]);
        let [end, by_start, by_change] = match s {
            f64::INFINITY => [state[0] + change, 1.0, 1.0],
            s if s == 0.0 || k == 0.0 => [0.0; 3],
            s => {
                let [y, gain, slope] = self.flow((state[0] / s).clamp(-1.0, 1.0), change / s);
                [s * y, gain, slope]
            }
        };
        (state[0], force[0]) = (end, end);
        let Some(jacobian) = jacobian else { return };
        jacobian.reset(1, 1);
        jacobian.by_state[0] = by_start;
        jacobian.by_after[0] = k * by_change;
        jacobian.by_before[0] = -k * by_change;
        jacobian.force_by_state[0] = 1.0;
        jacobian.slipping[0] = if change == 0.0 { 0.0 } else { (1.0 - by_change).clamp(0.0, 1.0) };
    }

    fn with_scaled_stiffness(&self, share: f64) -> Box<dyn ContactLaw> {
        Box::new(Self { stiffness: share * self.stiffness, ..*self })
    }

    fn with_scaled_forces(&self, factor: f64) -> Box<dyn ContactLaw> {
        Box::new(Self { slip_force: factor * self.slip_force, ..*self })
    }

    fn parameters(&self) -> Vec<Parameter> {
        let number = |name, value| Parameter { name, point: None, value, factor: false };
        vec![
            Parameter::stiffness(self.stiffness),
            Parameter::slip_force(0, self.slip_force),
            number("exponent", self.exponent),
            number("beta", self.beta),
        ]
    }

    fn with_parameter(&self, index: usize, value: f64) -> Result<Box<dyn ContactLaw>, Error> {
        let mut own = [self.stiffness, self.slip_force, self.exponent, self.beta];
        own[index] = value;
        let [stiffness, slip_force, exponent, beta] = own;
        Ok(Box::new(Self::new(stiffness, slip_force, exponent, beta)?))
    }
}

#[cfg(test)]
#[allow(clippy::unwrap_used)]
mod tests {
    use super::*;

    #[test]
    fn first_loading_is_that_of_its_exponent() {
        let one = BoucWen::new(1.0, 1.0, 1.0, 0.5).unwrap();
        let two = BoucWen::new(1.0, 1.0, 2.0, 0.5).unwrap();
        for v in [0.3_f64, 1.1, 4.0] {
            assert!((one.flow(0.0, v)[0] - (1.0 - (-v).exp())).abs() < 1e-8);
            assert!((two.flow(0.0, -v)[0] + v.tanh()).abs() < 1e-8);
        }
    }

    #[test]
    fn the_step_has_its_derivatives() {
        let law = BoucWen::new(1.0, 1.0, 1.5, 0.8).unwrap();
        let h = 1e-6;
        for (y, v) in [(0.2, 0.31), (0.9, -0.47), (-0.4, 0.013), (0.5, -3.0)] {
            let [_, gain, slope] = law.flow(y, v);
            let by = |dy: f64, dv: f64| {
                (law.flow(y + dy, v + dv)[0] - law.flow(y - dy, v - dv)[0]) / (2.0 * h)
            };
            assert!((by(h, 0.0) - gain).abs() < 1e-6 && (by(0.0, h) - slope).abs() < 1e-6);
        }
    }
}
