//! How the forces of a structure-like damper depend on its parameters at fixed displacements.
//!
//! Its parameters are the slip limits F, one per point, and a factor a on its stiffness D. The
//! march carries `∂f/∂F` through the transitions as it carries the derivative in the displacements
//! (see `periodic_march`). The factor needs nothing of its own: forces are homogeneous of degree one,
//! `f(u; aD, F) = a f(u; D, F/a)`, so that at a = 1
//!
//! `∂f/∂a = f − Σ F_i ∂f/∂F_i`.

use crate::contact::derivative::Derivative;
use crate::contact::law::HarmonicForce as _;
use crate::contact::periodic_march::PeriodicMarch;
use crate::contact::slider_integrals::Bounds;
use crate::contact::{Elastic, Motion, Parameter, SlipLoad, StructuralDamper};
use crate::Error;
use faer::Mat;

/// Limit, relative to the elastic forces without slip, that stands for the first trace of friction.
///
/// The slope errs with the root of it: a point that is nearly free sticks for that share of a period.
const TRACE: f64 = 1e-10;

impl StructuralDamper {
    /// The slip limits, point by point, and the factor on the stiffness.
    pub(super) fn own_parameters(&self) -> Vec<Parameter> {
        let limits = self.limits.iter().enumerate();
        let mut own: Vec<Parameter> =
            limits.map(|(point, limit)| Parameter::slip_force(point, *limit)).collect();
        own.push(Parameter { factor: true, ..Parameter::stiffness(self.factor) });
        own
    }

    /// The damper with another slip limit or another factor on its stiffness.
    pub(super) fn changed(&self, index: usize, value: f64) -> Result<Self, Error> {
        if index < self.limits.len() {
            let mut limits = self.limits.clone();
            limits[index] = value;
            return Ok(Self { limits: Self::checked(&limits)?, ..self.clone() });
        }
        if !(value >= 0.0 && value.is_finite()) {
            let entry = "structural: factor on the stiffness";
            return Err(Error::value(entry, value, "must be finite and not negative"));
        }
        let stiffness = faer::Scale(value) * &self.unit;
        let elastic = Elastic::new(stiffness.as_ref())?;
        Ok(Self { stiffness, elastic, factor: value, ..self.clone() })
    }

    /// Series of the derivative of the forces in a parameter.
    pub(super) fn slope(&self, motion: Motion<'_>, index: usize, out: &mut [f64]) {
        out.fill(0.0);
        if index < self.limits.len() {
            self.limit_slope(motion, index, out);
        } else {
            self.factor_slope(motion, out);
        }
    }

    /// Series of `∂f/∂F_i`.
    fn limit_slope(&self, motion: Motion<'_>, i: usize, out: &mut [f64]) {
        if self.limits[i].is_infinite() {
            return;
        }
        if self.limits[i] == 0.0 {
            let most = PeriodicMarch::new(self, motion, Derivative::None).elastic;
            let Ok(trace) = self.changed(i, TRACE * most) else { return };
            if most > 0.0 {
                trace.limit_slope(motion, i, out);
            }
            return;
        }
        let march = PeriodicMarch::new(self, motion, Derivative::Limits);
        if !march.resolved {
            out.fill(f64::NAN);
            return;
        }
        let harmonics = motion.table.harmonics();
        let mut bounds = Bounds::new(harmonics);
        let weight = 2.0 / harmonics.span();
        let mut integral = vec![0.0; harmonics.slots()];
        for stretch in &march.stretches {
            integral.fill(0.0);
            bounds.add_integral(harmonics, stretch.start, stretch.end, weight, &mut integral);
            for (point, series) in out.chunks_exact_mut(integral.len()).enumerate() {
                // f = T u − κ, and T does not change.
                let rate = -stretch.rate[point * self.limits.len() + i];
                series.iter_mut().zip(&integral).for_each(|(s, integral)| *s += rate * integral);
            }
        }
        harmonics.halve_means(out);
    }

    /// Series of `∂f/∂a`, where the damper has been given the stiffness aD.
    fn factor_slope(&self, motion: Motion<'_>, out: &mut [f64]) {
        if self.factor == 0.0 {
            // The first trace of stiffness sticks wherever there is friction.
            let Ok(trace) = self.changed(self.limits.len(), 1.0) else { return };
            let limits =
                self.limits.iter().map(|limit| if *limit > 0.0 { f64::INFINITY } else { 0.0 });
            Self { limits: limits.collect(), ..trace }.factor_slope(motion, out);
            return;
        }
        let mut load = SlipLoad::default();
        self.slip_load(motion, false, &mut load);
        let slots = motion.table.harmonics().slots();
        add_product(&self.stiffness, motion.displacement, slots, out);
        out.iter_mut().zip(&load.value).for_each(|(out, q)| *out -= q);
        let mut slope = vec![0.0; out.len()];
        for (i, limit) in self.limits.iter().enumerate() {
            if *limit > 0.0 && limit.is_finite() {
                slope.fill(0.0);
                self.limit_slope(motion, i, &mut slope);
                out.iter_mut().zip(&slope).for_each(|(out, slope)| *out -= limit * slope);
            }
        }
        out.iter_mut().for_each(|out| *out /= self.factor);
    }
}

/// Adds `D u`, series by series.
fn add_product(stiffness: &Mat<f64>, u: &[f64], slots: usize, out: &mut [f64]) {
    for (i, out) in out.chunks_exact_mut(slots).enumerate() {
        for (j, u) in u.chunks_exact(slots).enumerate() {
            out.iter_mut().zip(u).for_each(|(out, u)| *out += stiffness[(i, j)] * u);
        }
    }
}
