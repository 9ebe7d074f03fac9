//! The cubic spring, `f = k u³`: the nonlinearity of Duffing's oscillator.
//!
//! Of a series of H harmonics the force has 3 H, and the products with the basis that its coefficients
//! and their tangent are integrals of have 4 H: more than 4 H equidistant samples integrate them exactly.

use super::law::HarmonicForce;
use super::parameter::number;
use super::return_map::ReturnMapJacobian;
use super::spring::{harmonics_of_a_spring, law_of_a_spring};
use super::{
    ContactLaw, Describing, Motion, Parameter, Parameters, Phase, PointState, PointSummary,
    SlipLoad,
};
use crate::fourier::{Basis, Harmonics, IntervalSums};
use crate::solve::dot;
use crate::Error;
use faer::{c64, Mat};
use std::f64::consts::TAU;
use std::sync::Arc;

/// A spring whose force is cubic in its elongation.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct Cubic {
    /// k [N/m³]; a negative one softens.
    stiffness: f64,
}

impl Cubic {
    /// A spring of the coefficient k [N/m³].
    ///
    /// # Errors
    /// A coefficient that is not finite.
    pub fn new(stiffness: f64) -> Result<Self, Error> {
        if !stiffness.is_finite() {
            return Err(Error::value("cubic: stiffness", stiffness, "must be finite, in N/m^3"));
        }
        Ok(Self { stiffness })
    }

    pub(super) fn from_parameters(parameters: &Parameters) -> Result<Self, Error> {
        Self::new(number("cubic", parameters, "stiffness")?)
    }

    /// The basis at instants that integrate all products exactly, the elongation there, and the weight of each in
    /// `1/π ∫ dθ` over the period.
    fn sampled(motion: Motion<'_>) -> (Arc<Basis>, Vec<f64>, f64) {
        let harmonics = motion.table.harmonics();
        // Odd harmonics alone: products have even orders and repeat after half a period.
        let samples = 4 * harmonics.highest() + 2;
        let count = if harmonics.half_wave() { samples / 2 } else { samples };
        let basis = motion.table.basis(samples, count);
        let mut elongation = vec![0.0; count];
        for (function, own) in basis.functions().chunks_exact(count).zip(motion.displacement) {
            elongation.iter_mut().zip(function).for_each(|(u, b)| *u += own * b);
        }
        (basis, elongation, 2.0 / count as f64)
    }

    fn force(&self, u: f64) -> f64 {
        self.stiffness * u.powi(3)
    }

    fn slope(&self, u: f64) -> f64 {
        3.0 * self.stiffness * u * u
    }

    /// Series of `u³` times the stiffness, added with a sign.
    fn add_force(&self, motion: Motion<'_>, sign: f64, out: &mut [f64]) {
        let (basis, elongation, weight) = Self::sampled(motion);
        let factor = sign * self.stiffness * weight;
        let cubes: Vec<f64> = elongation.iter().map(|u| factor * u * u * u).collect();
        let functions = basis.functions().chunks_exact(cubes.len());
        let mut series: Vec<f64> = functions.map(|function| dot(function, &cubes)).collect();
        motion.table.harmonics().halve_means(&mut series);
        out.iter_mut().zip(&series).for_each(|(out, own)| *out += own);
    }

    fn tangent(&self, motion: Motion<'_>, harmonics: &Harmonics, out: &mut [f64]) {
        let (_, elongation, weight) = Self::sampled(motion);
        let mut sums = IntervalSums::new(harmonics);
        let step = harmonics.span() / elongation.len() as f64;
        let instants = elongation.iter().enumerate();
        instants.for_each(|(n, u)| sums.add_instant(n as f64 * step, u * u));
        let size = harmonics.slots();
        sums.products(harmonics, -3.0 * self.stiffness * weight, |i, j, value| {
            out[i * size + j] = value;
        });
    }
}

impl ContactLaw for Cubic {
    law_of_a_spring!();

    fn name(&self) -> &'static str {
        "cubic"
    }

    /// That at rest: none.
    fn stiffness(&self) -> Mat<f64> {
        Mat::zeros(1, 1)
    }

    fn is_odd(&self) -> bool {
        true
    }

    /// At any motion.
    fn surely_slips(&self, _motion: Motion<'_>) -> Option<bool> {
        Some(self.stiffness != 0.0)
    }

    fn with_scaled_stiffness(&self, share: f64) -> Box<dyn ContactLaw> {
        Box::new(Self { stiffness: share * self.stiffness })
    }

    /// `c f(u/c)` with the factor c.
    fn with_scaled_forces(&self, factor: f64) -> Box<dyn ContactLaw> {
        Box::new(Self { stiffness: self.stiffness / (factor * factor) })
    }

    fn parameters(&self) -> Vec<Parameter> {
        vec![Parameter::stiffness(self.stiffness)]
    }

    fn with_parameter(&self, _index: usize, value: f64) -> Result<Box<dyn ContactLaw>, Error> {
        Ok(Box::new(Self::new(value)?))
    }

    /// `3/4 k A²`.
    fn describing(&self, amplitude: f64) -> Option<Describing> {
        let real = |value: f64| c64::new(value, 0.0);
        Some(Describing {
            stiffness: real(0.75 * self.stiffness * amplitude * amplitude),
            slope: real(1.5 * self.stiffness * amplitude),
            slip_fraction: 0.0,
        })
    }
}

impl HarmonicForce for Cubic {
    harmonics_of_a_spring!();

    fn slip_load(&self, motion: Motion<'_>, tangent: bool, out: &mut SlipLoad) {
        let harmonics = motion.table.harmonics();
        out.reset(harmonics.slots(), tangent);
        self.add_force(motion, -1.0, &mut out.value);
        if tangent {
            self.tangent(motion, harmonics, &mut out.tangent);
            let size = out.value.len();
            if harmonics.has_mean() {
                out.tangent[..size].iter_mut().for_each(|entry| *entry *= 0.5);
            }
        }
        out.active = self.stiffness != 0.0;
    }

    fn parameter_slope(&self, motion: Motion<'_>, _index: usize, out: &mut [f64]) {
        out.fill(0.0);
        Self { stiffness: 1.0 }.add_force(motion, 1.0, out);
    }
}
