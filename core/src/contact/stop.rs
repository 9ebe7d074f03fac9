//! The elastic stop: a spring that works once a gap has closed.
//!
//! Its force is `f = k max(u − g, 0)`, with the gap g; a negative one is an interference. Over the
//! intervals of contact the force is linear in u, so that its Fourier coefficients and their tangent are
//! one matrix T of products of the basis: `f = T (u − g e₀)`, `∂f/∂u = T`. The ends of the intervals
//! move with u, but the force is continuous there and they add nothing.

use super::law::HarmonicForce;
use super::parameter::number;
use super::return_map::ReturnMapJacobian;
use super::spring::{harmonics_of_a_spring, law_of_a_spring};
use super::stick_slip::{at_crest, crossing, Path};
use super::{ContactLaw, Motion, Parameter, Parameters, Phase, PointState, PointSummary, SlipLoad};
use crate::fourier::IntervalSums;
use crate::Error;
use faer::Mat;
use std::f64::consts::{FRAC_1_PI, TAU};

/// A unilateral spring behind a gap.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct Stop {
    /// k [N/m].
    stiffness: f64,
    /// g \[m\].
    gap: f64,
}

/// What a stop does over a period.
enum Touch {
    Open,
    Closed,
    /// Intervals of contact.
    Parts(Vec<[f64; 2]>),
}

impl Stop {
    /// A stop of stiffness k [N/m] behind a gap \[m\]; a negative gap is an interference.
    ///
    /// # Errors
    /// A stiffness that is negative or not finite, a gap that is not finite.
    pub fn new(stiffness: f64, gap: f64) -> Result<Self, Error> {
        if !(stiffness.is_finite() && stiffness >= 0.0) {
            let remedy = "must be finite and not negative";
            return Err(Error::value("stop: stiffness", stiffness, remedy));
        }
        if !gap.is_finite() {
            let remedy = "must be finite; leave out a stop that is never reached";
            return Err(Error::value("stop: gap", gap, remedy));
        }
        Ok(Self { stiffness, gap })
    }

    pub(super) fn from_parameters(parameters: &Parameters) -> Result<Self, Error> {
        let [stiffness, gap] = ["stiffness", "gap"].map(|name| number("stop", parameters, name));
        Self::new(stiffness?, gap?)
    }

    /// Whether it is closed at rest.
    fn rests_closed(&self) -> bool {
        self.gap <= 0.0
    }

    fn force(&self, u: f64) -> f64 {
        self.stiffness * (u - self.gap).max(0.0)
    }

    fn slope(&self, u: f64) -> f64 {
        if u > self.gap {
            self.stiffness
        } else {
            0.0
        }
    }

    fn touch(&self, motion: Motion<'_>) -> Touch {
        let path = Path::new(motion);
        if path.crest.value <= self.gap {
            return Touch::Open;
        }
        if path.trough.value >= self.gap || path.turns.is_empty() {
            return Touch::Closed;
        }
        let (harmonics, series) = (motion.table.harmonics(), motion.displacement);
        // A path begins and ends at the largest displacement: closed.
        let (mut parts, mut start) = (Vec::new(), Some(path.turns[0].theta));
        for ends in path.turns.windows(2) {
            let (from, to) = (ends[0], ends[1]);
            if (from.value > self.gap) == (to.value > self.gap) {
                continue;
            }
            let theta = crossing(harmonics, series, from, to, self.gap);
            match start.take() {
                Some(start) => parts.push([start, theta]),
                None => start = Some(theta),
            }
        }
        if let (Some(start), Some(last)) = (start, path.turns.last()) {
            parts.push([start, last.theta]);
        }
        Touch::Parts(parts)
    }

    /// The tangent T of the force, row by row; its rows of the mean are not halved.
    fn tangent(&self, motion: Motion<'_>, parts: &[[f64; 2]]) -> Vec<f64> {
        let harmonics = motion.table.harmonics();
        let size = harmonics.slots();
        let mut sums = IntervalSums::new(harmonics);
        parts.iter().for_each(|[start, end]| sums.add(*start, *end));
        let mut tangent = vec![0.0; size * size];
        sums.products(harmonics, self.stiffness * FRAC_1_PI, |i, j, value| {
            tangent[i * size + j] = value;
        });
        tangent
    }

    /// Series of the force.
    fn series(&self, motion: Motion<'_>, out: &mut [f64]) {
        let harmonics = motion.table.harmonics();
        out.fill(0.0);
        match self.touch(motion) {
            Touch::Open => {}
            Touch::Closed => {
                let pairs = out.iter_mut().zip(motion.displacement);
                pairs.for_each(|(f, u)| *f = self.stiffness * u);
                if harmonics.has_mean() {
                    out[0] -= self.stiffness * self.gap;
                }
            }
            Touch::Parts(parts) => {
                let tangent = self.tangent(motion, &parts);
                self.apply(motion, &tangent, out);
                harmonics.halve_means(out);
            }
        }
    }

    /// `T (u − g e₀)`.
    fn apply(&self, motion: Motion<'_>, tangent: &[f64], out: &mut [f64]) {
        let mut depth = motion.displacement.to_vec();
        depth[0] -= self.gap;
        for (f, row) in out.iter_mut().zip(tangent.chunks_exact(depth.len())) {
            *f = row.iter().zip(&depth).map(|(t, u)| t * u).sum();
        }
    }
}

impl ContactLaw for Stop {
    law_of_a_spring!();

    fn name(&self) -> &'static str {
        "stop"
    }

    /// That at rest: k where it is closed there.
    fn stiffness(&self) -> Mat<f64> {
        let own = if self.rests_closed() { self.stiffness } else { 0.0 };
        Mat::from_fn(1, 1, |_, _| own)
    }

    fn is_odd(&self) -> bool {
        false
    }

    fn with_scaled_stiffness(&self, share: f64) -> Box<dyn ContactLaw> {
        Box::new(Self { stiffness: share * self.stiffness, ..*self })
    }

    fn with_scaled_forces(&self, factor: f64) -> Box<dyn ContactLaw> {
        Box::new(Self { gap: factor * self.gap, ..*self })
    }

    fn surely_slips(&self, motion: Motion<'_>) -> Option<bool> {
        let touches = at_crest(motion).map(|u| u > self.gap);
        (touches[0] != touches[1]).then_some(true)
    }

    fn parameters(&self) -> Vec<Parameter> {
        vec![Parameter::stiffness(self.stiffness), Parameter::gap(self.gap)]
    }

    fn with_parameter(&self, index: usize, value: f64) -> Result<Box<dyn ContactLaw>, Error> {
        Ok(Box::new(match index {
            0 => Self::new(value, self.gap)?,
            _ => Self::new(self.stiffness, value)?,
        }))
    }
}

impl HarmonicForce for Stop {
    harmonics_of_a_spring!();

    fn slip_load(&self, motion: Motion<'_>, tangent: bool, out: &mut SlipLoad) {
        let harmonics = motion.table.harmonics();
        let size = harmonics.slots();
        out.reset(size, tangent);
        let base = self.stiffness()[(0, 0)];
        match self.touch(motion) {
            Touch::Parts(parts) => {
                let own = self.tangent(motion, &parts);
                self.apply(motion, &own, &mut out.value);
                out.value.iter_mut().for_each(|q| *q = -*q);
                if tangent {
                    out.tangent.iter_mut().zip(&own).for_each(|(t, own)| *t = -own);
                }
                out.halve_means(harmonics);
                out.active = true;
            }
            Touch::Open => {}
            Touch::Closed => {
                if harmonics.has_mean() {
                    out.value[0] = self.stiffness * self.gap;
                }
                out.value.iter_mut().zip(motion.displacement).for_each(|(q, u)| {
                    *q -= (self.stiffness - base) * u;
                });
                if self.stiffness != base {
                    let diagonal = out.tangent.iter_mut().step_by(size + 1);
                    diagonal.for_each(|t| *t = base - self.stiffness);
                    out.active = true;
                }
                return;
            }
        }
        if base != 0.0 {
            out.active = true;
            out.value.iter_mut().zip(motion.displacement).for_each(|(q, u)| *q += base * u);
            out.tangent.iter_mut().step_by(size + 1).for_each(|t| *t += base);
        }
    }

    fn parameter_slope(&self, motion: Motion<'_>, index: usize, out: &mut [f64]) {
        if index == 0 {
            let unit = Self { stiffness: 1.0, ..*self };
            return unit.series(motion, out);
        }
        out.fill(0.0);
        let harmonics = motion.table.harmonics();
        match self.touch(motion) {
            Touch::Open => {}
            Touch::Closed if harmonics.has_mean() => out[0] = -self.stiffness,
            Touch::Closed => {}
            Touch::Parts(parts) => {
                // −T e₀.
                let tangent = self.tangent(motion, &parts);
                let column = tangent.iter().step_by(out.len());
                out.iter_mut().zip(column).for_each(|(f, t)| *f = -t);
                harmonics.halve_means(out);
            }
        }
    }
}
