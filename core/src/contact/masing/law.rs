//! Masing laws: contacts that slip little by little, by a backbone and return-point memory.
//!
//! The law stands for as many elastic, perfectly plastic elements in parallel as one likes, with any
//! distribution of slip limits (Iwan 1966), and has one displacement. First loading follows the backbone
//! F(u); after a reversal at (u_r, f_r) the force is `f = f_r ± 2 F(|u − u_r|/2)`; where this branch
//! passes the reversal before, that loop is forgotten (Masing 1926). A sum of elements with concave F
//! is a monotone operator, as each of them is, so that passive structures have one steady motion.

use super::integrals::{add_loops, every, sweep};
use super::loops::{Branch, Loops, Stretch};
use crate::contact::backbone::{Backbone, LoadingCurve};
use crate::contact::law::{effort_of, HarmonicForce};
use crate::contact::parameter::{number, numbers};
use crate::contact::return_map::ReturnMapJacobian;
use crate::contact::stick_slip::{at_crest, Path};
use crate::contact::{
    ContactLaw, Describing, Motion, Parameter, Parameters, Phase, PointSummary, Residual, SlipLoad,
};
use crate::fourier::NODES;
use crate::Error;
use faer::{c64, Mat};
use std::f64::consts::TAU;
use std::sync::Arc;

/// Reversals that the return map remembers: as many as a period has.
const MEMORY: usize = 64;

/// Share of the slip force at which a contact that always slips has hardly begun to.
const LITTLE: f64 = 1e-12;

/// A contact given by its backbone.
#[derive(Debug, Clone, PartialEq)]
pub struct Masing {
    name: &'static str,
    curve: LoadingCurve,
    /// Places for reversals.
    memory: usize,
}

impl Masing {
    /// A law of a stiffness k at rest [N/m], a force S that is never exceeded \[N\], and a shape.
    ///
    /// # Errors
    /// A negative or infinite stiffness, a negative force, one of them no number.
    pub fn new(stiffness: f64, slip_force: f64, backbone: Backbone) -> Result<Self, Error> {
        Self::of("masing", stiffness, slip_force, Arc::new(backbone))
    }

    /// The model of Segalman (2005), by its stiffness K_T at rest [N/m], the force F_S of gross slip
    /// \[N\], and the numbers χ and β.
    ///
    /// # Errors
    /// As [`Masing::new`] and [`Backbone::iwan`].
    pub fn iwan(stiffness: f64, slip_force: f64, chi: f64, beta: f64) -> Result<Self, Error> {
        Self::of("iwan", stiffness, slip_force, Arc::new(Backbone::iwan(chi, beta)?))
    }

    fn of(
        name: &'static str,
        stiffness: f64,
        slip_force: f64,
        backbone: Arc<Backbone>,
    ) -> Result<Self, Error> {
        if !(stiffness.is_finite() && stiffness >= 0.0) {
            let remedy = "must be finite and not negative";
            return Err(Error::value(format!("{name}: stiffness"), stiffness, remedy));
        }
        if slip_force.is_nan() || slip_force < 0.0 {
            let remedy = "must not be negative; infinity means that the contact never slips";
            return Err(Error::value(format!("{name}: slip_force"), slip_force, remedy));
        }
        Ok(Self { name, curve: LoadingCurve { stiffness, slip_force, backbone }, memory: MEMORY })
    }

    pub(crate) fn from_parameters(given: &Parameters) -> Result<Self, Error> {
        let [stiffness, slip_force] =
            ["stiffness", "slip_force"].map(|name| number("masing", given, name));
        let backbone = if given.contains_key("displacement") {
            let [u, f] = ["displacement", "force"].map(|name| numbers("masing", given, name));
            Backbone::table(u?, f?)?.0
        } else if given.contains_key("shear_lag") {
            Backbone::shear_layer(number("masing", given, "shear_lag")?)?
        } else {
            Backbone::Exponential
        };
        Self::new(stiffness?, slip_force?, backbone)
    }

    pub(crate) fn iwan_from_parameters(given: &Parameters) -> Result<Self, Error> {
        let [stiffness, slip_force, chi, beta] =
            ["stiffness", "slip_force", "chi", "beta"].map(|name| number("iwan", given, name));
        Self::iwan(stiffness?, slip_force?, chi?, beta?)
    }

    /// Mean slip load of a motion about its middle, with its derivatives in the middle and in half the
    /// range: what the elements that never slip hold there. Those that slip are centred.
    fn mean_load(&self, residual: Residual, middle: f64, half_range: f64) -> [f64; 3] {
        let (k, sign) = (self.curve.stiffness, 1.0_f64.copysign(middle));
        let own = self.curve.loss(half_range);
        if k == 0.0 {
            return [0.0; 3];
        }
        match residual {
            Residual::Centred => [k * middle, k, 0.0],
            Residual::FromRest => {
                let most = self.curve.loss(half_range + middle.abs());
                let by_range = sign * (most.slope - own.slope);
                [sign * (most.value - own.value), most.slope, by_range]
            }
            Residual::Value(force) => {
                let room = (self.curve.slip_force - k * half_range + own.value).max(0.0);
                if force.abs() <= room {
                    return [k * middle - force, k, 0.0];
                }
                [k * middle - room.copysign(force), k, (k - own.slope).copysign(force)]
            }
        }
    }

    /// Force at a displacement on a stretch, with the slip loads at the reversals and the mean one.
    fn force_at(&self, loops: &Loops, loads: &[f64], mean: f64, at: &Stretch, u: f64) -> f64 {
        let Branch { origin, sign, .. } = loops.branches[at.branch];
        let distance = (0.5 * sign * (u - origin)).max(0.0);
        if self.curve.x(distance) >= self.curve.backbone.end() {
            return sign * self.curve.slip_force;
        }
        let lost = loads[at.branch] + mean + 2.0 * sign * self.curve.loss(distance).value;
        (self.curve.stiffness * u - lost).clamp(-self.curve.slip_force, self.curve.slip_force)
    }
}

impl ContactLaw for Masing {
    fn name(&self) -> &'static str {
        self.name
    }

    fn displacements(&self) -> usize {
        1
    }

    fn state_size(&self) -> usize {
        self.memory
    }

    fn with_memory(&self, places: usize) -> Option<Box<dyn ContactLaw>> {
        Some(Box::new(Self { memory: places, ..self.clone() }))
    }

    fn stiffness(&self) -> Mat<f64> {
        Mat::from_fn(1, 1, |_, _| self.curve.stiffness)
    }

    /// Reversals stay as they are.
    fn state_stiffness(&self) -> Mat<f64> {
        Mat::zeros(self.memory, 1)
    }

    fn is_odd(&self) -> bool {
        true
    }

    fn is_monotone(&self) -> bool {
        true
    }

    fn limits(&self) -> Vec<f64> {
        vec![if self.curve.stiffness == 0.0 { 0.0 } else { self.curve.slip_force }]
    }

    fn grows(&self) -> Vec<bool> {
        vec![false; self.displacements()]
    }

    /// It slips from the first on: a force at which that is little.
    fn onsets(&self) -> Vec<f64> {
        self.limits().iter().map(|limit| LITTLE * limit).collect()
    }

    fn return_map(
        &self,
        before: &[f64],
        after: &[f64],
        state: &mut [f64],
        force: &mut [f64],
        jacobian: Option<&mut ReturnMapJacobian>,
    ) {
        super::memory::step(&self.curve, before[0], after[0], state, &mut force[0], jacobian);
    }

    fn stuck_load(&self, residual: Residual, low: f64, high: f64) -> Option<[f64; 3]> {
        let (middle, half_range) = (0.5 * (low + high), 0.5 * (high - low));
        if self.curve.loss(half_range).slope > 0.0 {
            return None;
        }
        let [load, by_middle, by_range] = self.mean_load(residual, middle, half_range);
        Some([load, 0.5 * (by_middle - by_range), 0.5 * (by_middle + by_range)])
    }

    fn with_scaled_stiffness(&self, share: f64) -> Box<dyn ContactLaw> {
        let stiffness = share * self.curve.stiffness;
        Box::new(Self { curve: LoadingCurve { stiffness, ..self.curve.clone() }, ..self.clone() })
    }

    fn with_scaled_forces(&self, factor: f64) -> Box<dyn ContactLaw> {
        let slip_force = factor * self.curve.slip_force;
        Box::new(Self { curve: LoadingCurve { slip_force, ..self.curve.clone() }, ..self.clone() })
    }

    fn parameters(&self) -> Vec<Parameter> {
        let own = [
            Parameter::stiffness(self.curve.stiffness),
            Parameter::slip_force(0, self.curve.slip_force),
        ];
        let number = |(name, value)| Parameter { name, point: None, value, factor: false };
        own.into_iter().chain(self.curve.backbone.numbers().into_iter().map(number)).collect()
    }

    fn with_parameter(&self, index: usize, value: f64) -> Result<Box<dyn ContactLaw>, Error> {
        let (mut stiffness, mut slip_force) = (self.curve.stiffness, self.curve.slip_force);
        let mut backbone = Arc::clone(&self.curve.backbone);
        match index {
            0 => stiffness = value,
            1 => slip_force = value,
            _ => backbone = Arc::new(backbone.with_number(index - 2, value)?),
        }
        Ok(Box::new(Self::of(self.name, stiffness, slip_force, backbone)?))
    }

    fn surely_slips(&self, motion: Motion<'_>) -> Option<bool> {
        let [high, low] = at_crest(motion);
        (self.curve.loss(0.5 * (high - low).abs()).slope > 0.0).then_some(true)
    }

    fn closed_form(&self) -> Option<&dyn HarmonicForce> {
        Some(self)
    }

    fn loading(&self) -> Option<LoadingCurve> {
        Some(self.curve.clone())
    }

    /// The first harmonic of a harmonic motion, and its derivative, by the integrals of any motion.
    fn describing(&self, amplitude: f64) -> Option<Describing> {
        if amplitude == 0.0 {
            let k = c64::new(self.curve.stiffness, 0.0);
            let zero = c64::new(0.0, 0.0);
            let rest = self.curve.loss(0.0).slope;
            return Some(Describing { stiffness: k - rest, slope: zero, slip_fraction: 0.0 });
        }
        (self as &dyn ContactLaw).under_cosine(amplitude)
    }
}

impl HarmonicForce for Masing {
    fn effort(&self, slots: usize, _load: &SlipLoad, tangent: bool) -> f64 {
        effort_of([4e3, 240.0, 16.0], slots, tangent)
    }

    fn slip_load(&self, motion: Motion<'_>, tangent: bool, out: &mut SlipLoad) {
        let harmonics = motion.table.harmonics();
        out.reset(harmonics.slots(), tangent);
        let mut about_mean = Vec::new();
        let (mean, motion) = motion.about_mean(&mut about_mean);
        let path = Path::new(motion);
        let half_range = path.half_range();
        if self.curve.loss(half_range).slope > 0.0 && !path.turns.is_empty() {
            out.active = true;
            let loops = Loops::new(&self.curve, motion, &path);
            add_loops(&self.curve, motion, &path, &loops, tangent, out);
        }
        if !harmonics.has_mean() {
            return;
        }
        let [load, by_middle, by_range] =
            self.mean_load(motion.residual, mean + path.middle(), half_range);
        out.value[0] += load;
        if by_middle != 0.0 || by_range != 0.0 {
            out.active = true;
            path.add_extremes(
                [0.5 * (by_middle + by_range), 0.5 * (by_middle - by_range)],
                &mut out.tangent[..],
            );
        }
    }

    /// A contact that always slips a little: the share of the period in slip is the mean over its
    /// elements, weighted by their stiffness, that is of `L'/k`.
    fn summary(&self, motion: Motion<'_>, out: &mut [PointSummary]) {
        let mut about_mean = Vec::new();
        let (_, motion) = motion.about_mean(&mut about_mean);
        let path = Path::new(motion);
        out[0] = PointSummary::default();
        let largest = self.curve.loss(path.half_range()).slope;
        if largest == 0.0 {
            return;
        }
        let (loops, span) =
            (Loops::new(&self.curve, motion, &path), motion.table.harmonics().span());
        sweep(&self.curve, motion, &loops, every, largest, |nodes| {
            let slipping: f64 = (0..NODES).map(|i| nodes.panel.weight[i] * nodes.slope[i]).sum();
            out[0].slip_fraction += slipping / self.curve.stiffness / span;
        });
        let closed: f64 = loops.closed.iter().map(|half_range| self.curve.work(*half_range)).sum();
        let half = motion.table.harmonics().half_wave();
        // The two halves of a symmetric motion close the largest loop together.
        let whole = if half { self.curve.work(path.half_range()) } else { 0.0 };
        out[0].dissipation = closed * TAU / span + whole;
    }

    fn state_history(&self, motion: Motion<'_>, samples: usize) -> Vec<f64> {
        let path = Path::new(motion);
        let loops = Loops::new(&self.curve, motion, &path);
        let mut history = vec![0.0; samples * self.memory];
        for (n, state) in history.chunks_exact_mut(self.memory).enumerate() {
            let (theta, sign) = path.fold(TAU * n as f64 / samples as f64);
            let Some(stretch) = loops.at(theta) else { continue };
            let mut origin = 0.0;
            for (z, branch) in state.iter_mut().zip(loops.memory(stretch)) {
                let to = loops.branches[branch].origin;
                *z = sign * self.curve.stiffness * (to - origin);
                origin = to;
            }
        }
        history
    }

    fn force_history(&self, motion: Motion<'_>, samples: usize) -> Vec<f64> {
        let harmonics = motion.table.harmonics();
        let path = Path::new(motion);
        let loops = Loops::new(&self.curve, motion, &path);
        let half_range = path.half_range();
        let loads = loops.at_reversals(half_range, |u| self.curve.loss(u).value);
        let mean = if harmonics.has_mean() {
            self.mean_load(motion.residual, path.middle(), half_range)[0]
        } else {
            0.0
        };
        let force = |n: usize| {
            let angle = TAU * n as f64 / samples as f64;
            let (theta, sign) = path.fold(angle);
            let u = sign * harmonics.jet(motion.displacement, angle)[0];
            let Some(stretch) = loops.at(theta) else { return self.curve.stiffness * u - mean };
            sign * self.force_at(&loops, &loads, mean, stretch, u)
        };
        (0..samples).map(force).collect()
    }

    fn phases(&self, motion: Motion<'_>) -> Vec<Phase> {
        Phase::from_forces(&self.force_history(motion, Phase::INSTANTS), &self.limits())
    }

    /// The force is linear in its backbone: its derivative is that of a law with the backbone ∂F.
    fn parameter_slope(&self, motion: Motion<'_>, index: usize, out: &mut [f64]) {
        out.fill(0.0);
        let harmonics = motion.table.harmonics();
        let mut about_mean = Vec::new();
        let (mean, motion) = motion.about_mean(&mut about_mean);
        let path = Path::new(motion);
        let (middle, half_range) = (mean + path.middle(), path.half_range());
        let of = |u: f64| self.curve.by_parameter(index, u);
        let loops = Loops::new(&self.curve, motion, &path);
        let loads = loops.at_reversals(half_range, of);
        let weight = 2.0 / harmonics.span();
        let largest = self.curve.loss(half_range).slope;
        sweep(&self.curve, motion, &loops, every, largest, |nodes| {
            let mut lanes = [0.0; NODES];
            for (i, lane) in lanes.iter_mut().enumerate() {
                let own = 2.0 * nodes.branch.sign * of(nodes.distance[i]);
                *lane = weight * nodes.panel.weight[i] * (loads[nodes.stretch.branch] + own);
            }
            nodes.panel.add_integrals(harmonics, &lanes, out);
        });
        harmonics.halve_means(out);
        if !harmonics.has_mean() {
            return;
        }
        out[0] += match motion.residual {
            Residual::Centred => 0.0,
            Residual::FromRest => (of(half_range + middle.abs()) - of(half_range)).copysign(middle),
            Residual::Value(force) => {
                let room = self.curve.slip_force - self.curve.stiffness * half_range
                    + self.curve.loss(half_range).value;
                let grows = f64::from(u8::from(index == 1)) - of(half_range);
                if force.abs() <= room {
                    0.0
                } else {
                    grows * force.signum()
                }
            }
        };
    }
}
