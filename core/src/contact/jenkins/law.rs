//! Jenkins elements on one displacement: each a spring k_d in series with a slider of limit F_d.
//!
//! An element is the stop operator `f_j = clip(f_{j−1} + k_d Δu, ±F_d)` (Guillen 1999, Table 3.1,
//! corrected: the printed update never unloads). One alone is the Jenkins element; several in
//! parallel are the discrete Iwan model. Here they are followed from event to event: between the
//! turning points of u, each located exactly, an element sticks, or sticks and then slips. The
//! Fourier integrals over the intervals are exact, so that no sampling error enters, and their
//! derivative is exact with them: f is continuous, hence moving interval ends add nothing. Turning
//! points are common to all elements, so that the tangent has one term of rank one for each of them,
//! however many elements there are.

use crate::contact::law::HarmonicForce;
use crate::contact::parameter::numbers;
use crate::contact::return_map::ReturnMapJacobian;
use crate::contact::slider_integrals::add_slipping;
use crate::contact::slip_element::{Element, SlipElement as _};
use crate::contact::stick_slip::{at_crest, Path, StickSlipIntervals};
use crate::contact::{
    ContactLaw, Describing, Held, Motion, Parameter, Parameters, Phase, PointSummary, Residual,
    Slider, SlipLoad,
};
use crate::solve::norm;
use crate::Error;
use faer::Mat;
use std::f64::consts::TAU;
use std::sync::Arc;

/// Rounding of a sum of amplitudes, relative to it.
const ROUNDING: f64 = 1e-12;

/// Elastic, perfectly plastic elements in parallel, all on one displacement.
#[derive(Debug, Clone, PartialEq)]
pub struct Jenkins {
    pub(super) sliders: Vec<Slider>,
    /// The factor on the stiffness that the elements were built with: 1 of a single one.
    pub(super) factor: f64,
    /// The stiffness that they were built with.
    pub(super) unit: Vec<f64>,
}

impl Jenkins {
    /// One element; see [`Slider::new`].
    ///
    /// # Errors
    /// Negative or NaN parameters, infinite stiffness.
    pub fn new(stiffness: f64, slip_force: f64) -> Result<Self, Error> {
        Self::of(vec![Slider::new(stiffness, slip_force)?])
    }

    /// Elements in parallel.
    ///
    /// # Errors
    /// No element.
    pub fn of(sliders: Vec<Slider>) -> Result<Self, Error> {
        if sliders.is_empty() {
            return Err(Error::shape("jenkins: stiffness", "at least one number", 0));
        }
        let unit = sliders.iter().map(|slider| slider.stiffness).collect();
        Ok(Self { sliders, factor: 1.0, unit })
    }

    pub(crate) fn from_parameters(parameters: &Parameters) -> Result<Self, Error> {
        let stiffness = numbers("jenkins", parameters, "stiffness")?;
        let slip_force = numbers("jenkins", parameters, "slip_force")?;
        if stiffness.len() != slip_force.len() {
            let expected = format!("{}, one per stiffness", stiffness.len());
            return Err(Error::shape("jenkins: slip_force", expected, slip_force.len()));
        }
        let sliders = stiffness.iter().zip(slip_force).map(|(k, f)| Slider::new(*k, *f));
        Self::of(sliders.collect::<Result<_, _>>()?)
    }

    fn total_stiffness(&self) -> f64 {
        self.sliders.iter().map(|slider| slider.stiffness).sum()
    }

    /// The mean over the elements, weighted by stiffness.
    fn weighted(&self, of: impl Fn(usize) -> f64) -> f64 {
        let total = self.total_stiffness();
        if self.sliders.len() == 1 || total == 0.0 {
            return of(0);
        }
        let sliders = self.sliders.iter().enumerate();
        sliders.map(|(index, slider)| slider.stiffness / total * of(index)).sum()
    }

    /// Whether no element reaches its limit at displacements as large as all amplitudes together, so
    /// that the slip load vanishes: turning points need not be known. A mean would follow them.
    fn surely_sticks(&self, motion: Motion<'_>) -> bool {
        if motion.table.harmonics().has_mean() {
            return false;
        }
        let largest = (1.0 + ROUNDING) * motion.displacement.chunks_exact(2).map(norm).sum::<f64>();
        let sticks = |slider: &Slider| {
            slider.stiffness > 0.0 && slider.stiffness * largest < slider.slip_force
        };
        self.sliders.iter().all(sticks)
    }

    fn cycles(&self, path: &Path<'_>) -> Vec<StickSlipIntervals> {
        let cycle =
            |slider: &Slider| StickSlipIntervals::new(path, slider.stiffness, slider.slip_force);
        self.sliders.iter().map(cycle).collect()
    }

    fn mapped(&self, change: impl Fn(&Slider) -> Slider, share: f64) -> Box<dyn ContactLaw> {
        Box::new(Self {
            sliders: self.sliders.iter().map(change).collect(),
            factor: self.factor,
            unit: self.unit.iter().map(|k| share * k).collect(),
        })
    }
}

impl ContactLaw for Jenkins {
    fn name(&self) -> &'static str {
        "jenkins"
    }

    fn displacements(&self) -> usize {
        1
    }

    fn state_size(&self) -> usize {
        self.sliders.len()
    }

    fn stiffness(&self) -> Mat<f64> {
        Mat::from_fn(1, 1, |_, _| self.total_stiffness())
    }

    fn state_stiffness(&self) -> Mat<f64> {
        Mat::from_fn(self.sliders.len(), 1, |i, _| self.sliders[i].stiffness)
    }

    fn is_odd(&self) -> bool {
        true
    }

    fn is_monotone(&self) -> bool {
        true
    }

    fn limits(&self) -> Vec<f64> {
        vec![self.sliders.iter().map(Slider::limit).sum()]
    }

    fn grows(&self) -> Vec<bool> {
        vec![false; self.displacements()]
    }

    fn onsets(&self) -> Vec<f64> {
        let rubs = self.sliders.iter().filter(|slider| slider.limit() > 0.0);
        let onset = rubs.map(|slider| slider.slip_force / slider.stiffness);
        vec![match self.sliders.len() {
            1 => self.sliders[0].limit(),
            _ => self.total_stiffness() * onset.fold(f64::INFINITY, f64::min),
        }]
    }

    fn surely_slips(&self, motion: Motion<'_>) -> Option<bool> {
        if self.surely_sticks(motion) {
            return Some(false);
        }
        let [high, low] = at_crest(motion);
        let least = 0.5 * (1.0 - ROUNDING) * (high - low).abs();
        let slips = |slider: &Slider| {
            slider.slip_force > 0.0 && slider.stiffness * least > slider.slip_force
        };
        self.sliders.iter().any(slips).then_some(true)
    }

    fn return_map(
        &self,
        before: &[f64],
        after: &[f64],
        state: &mut [f64],
        force: &mut [f64],
        mut jacobian: Option<&mut ReturnMapJacobian>,
    ) {
        let count = self.sliders.len();
        if let Some(jacobian) = &mut jacobian {
            jacobian.reset(1, count);
        }
        for (i, slider) in self.sliders.iter().enumerate() {
            let mut sticks = [0.0];
            slider.increment(before, after, &mut state[i..=i], Some(&mut sticks));
            let Some(jacobian) = &mut jacobian else { continue };
            jacobian.by_state[i * count + i] = sticks[0];
            jacobian.by_after[i] = sticks[0] * slider.stiffness;
            jacobian.by_before[i] = -jacobian.by_after[i];
            jacobian.force_by_state[i] = 1.0;
        }
        force[0] = state.iter().sum();
        let Some(jacobian) = jacobian else { return };
        jacobian.slipping[0] = self.weighted(|i| 1.0 - jacobian.by_state[i * (count + 1)]);
    }

    /// Sliders of one contact are moved together: of several that stick the stiffest tells how far.
    fn held(&self, motion: Motion<'_>) -> Vec<Option<Held>> {
        let path = Path::new(motion);
        let (middle, half_range) = (path.middle(), path.half_range());
        let stuck = self.sliders.iter().zip(self.cycles(&path)).filter(|(slider, cycle)| {
            matches!(cycle, StickSlipIntervals::Stuck) && slider.slip_force.is_finite()
        });
        let stiffest = stuck.max_by(|(a, _), (b, _)| a.stiffness.total_cmp(&b.stiffness));
        vec![stiffest.map(|(slider, _)| {
            let reach = slider.slip_force / slider.stiffness;
            let position =
                slider.held_load(motion.residual, middle, half_range).0 / slider.stiffness;
            let [assumed] = motion.residual.slider([slider.stiffness * middle], [0.0]);
            let range = [middle + half_range - reach, middle - half_range + reach];
            Held::new(position, assumed / slider.stiffness, range, reach)
        })]
    }

    fn stuck_load(&self, residual: Residual, low: f64, high: f64) -> Option<[f64; 3]> {
        let (middle, half_range) = (0.5 * (low + high), 0.5 * (high - low));
        let mut sum = [0.0; 3];
        for slider in &self.sliders {
            let sticks = slider.stiffness * (high - low) <= 2.0 * slider.slip_force;
            if !sticks || slider.slip_force == 0.0 || slider.stiffness == 0.0 {
                return None;
            }
            let (load, by_middle, by_range) = slider.held_load(residual, middle, half_range);
            let terms = [load, 0.5 * (by_middle - by_range), 0.5 * (by_middle + by_range)];
            sum.iter_mut().zip(terms).for_each(|(sum, term)| *sum += term);
        }
        Some(sum)
    }

    fn with_scaled_stiffness(&self, share: f64) -> Box<dyn ContactLaw> {
        self.mapped(|slider| Slider { stiffness: share * slider.stiffness, ..*slider }, share)
    }

    fn with_scaled_forces(&self, factor: f64) -> Box<dyn ContactLaw> {
        self.mapped(|slider| Slider { slip_force: factor * slider.slip_force, ..*slider }, 1.0)
    }

    fn parameters(&self) -> Vec<Parameter> {
        let stiffness = match &self.sliders[..] {
            [one] => Parameter::stiffness(one.stiffness),
            _ => Parameter { factor: true, ..Parameter::stiffness(self.factor) },
        };
        let limits = self.sliders.iter().enumerate();
        let limits = limits.map(|(point, slider)| Parameter::slip_force(point, slider.slip_force));
        std::iter::once(stiffness).chain(limits).collect()
    }

    fn with_parameter(&self, index: usize, value: f64) -> Result<Box<dyn ContactLaw>, Error> {
        let mut changed = self.clone();
        match (index, &mut changed.sliders[..]) {
            (0, [one]) => return Ok(Box::new(Self::new(value, one.slip_force)?)),
            (0, several) => {
                for (slider, unit) in several.iter_mut().zip(&self.unit) {
                    *slider = Slider::new(value * unit, slider.slip_force)?;
                }
                changed.factor = value;
            }
            (_, several) => {
                let slider = &mut several[index - 1];
                *slider = Slider::new(slider.stiffness, value)?;
            }
        }
        Ok(Box::new(changed))
    }

    fn closed_form(&self) -> Option<&dyn HarmonicForce> {
        Some(self)
    }

    fn parts(&self) -> Vec<Box<dyn ContactLaw>> {
        if self.sliders.len() == 1 {
            return Vec::new();
        }
        let alone = |(slider, unit): (&Slider, &f64)| -> Box<dyn ContactLaw> {
            Box::new(Self { sliders: vec![*slider], factor: 1.0, unit: vec![*unit] })
        };
        self.sliders.iter().zip(&self.unit).map(alone).collect()
    }

    fn elements(&self) -> Option<Vec<Element>> {
        let element = |slider: &Slider| Element { components: vec![0], law: Arc::new(*slider) };
        Some(self.sliders.iter().map(element).collect())
    }

    fn describing(&self, amplitude: f64) -> Option<Describing> {
        let of = |slider: &Slider| {
            Describing::of_jenkins(slider.stiffness, slider.slip_force, amplitude)
        };
        let sum = |part: fn(Describing) -> faer::c64| {
            self.sliders.iter().map(|slider| part(of(slider))).sum()
        };
        Some(Describing {
            stiffness: sum(|one| one.stiffness),
            slope: sum(|one| one.slope),
            slip_fraction: self.weighted(|index| of(&self.sliders[index]).slip_fraction),
        })
    }
}

impl HarmonicForce for Jenkins {
    fn slip_load(&self, motion: Motion<'_>, tangent: bool, out: &mut SlipLoad) {
        let harmonics = motion.table.harmonics();
        let size = harmonics.slots();
        out.reset(size, tangent);
        if self.surely_sticks(motion) {
            return;
        }
        let path = Path::new(motion);
        let cycles = self.cycles(&path);
        if cycles.iter().any(|cycle| matches!(cycle, StickSlipIntervals::Slipping { .. })) {
            out.active = true;
            add_slipping(&self.sliders, motion, &path, &cycles, tangent, out);
        }
        for (slider, cycle) in self.sliders.iter().zip(&cycles) {
            match cycle {
                StickSlipIntervals::Free => slider.add_free(motion, tangent, out),
                StickSlipIntervals::Stuck if harmonics.has_mean() => {
                    slider.add_stuck(motion, &path, out);
                }
                _ => {}
            }
        }
    }

    fn summary(&self, motion: Motion<'_>, out: &mut [PointSummary]) {
        if self.surely_sticks(motion) {
            out[0] = PointSummary::default();
            return;
        }
        let (path, span) = (Path::new(motion), motion.table.harmonics().span());
        let cycles = self.cycles(&path);
        let each =
            self.sliders.iter().zip(&cycles).map(|(slider, cycle)| slider.summary(cycle, span));
        let each: Vec<PointSummary> = each.collect();
        out[0] = PointSummary {
            slip_fraction: self.weighted(|index| each[index].slip_fraction),
            dissipation: each.iter().map(|one| one.dissipation).sum(),
        };
    }

    fn state_history(&self, motion: Motion<'_>, samples: usize) -> Vec<f64> {
        let harmonics = motion.table.harmonics();
        let path = Path::new(motion);
        let cycles = self.cycles(&path);
        let (middle, half_range) = (path.middle(), path.half_range());
        let mut history = Vec::with_capacity(samples * self.sliders.len());
        for n in 0..samples {
            let theta = TAU * n as f64 / samples as f64;
            let u = harmonics.jet(motion.displacement, theta)[0];
            for (slider, cycle) in self.sliders.iter().zip(&cycles) {
                history.push(match cycle {
                    StickSlipIntervals::Free => 0.0,
                    StickSlipIntervals::Stuck => {
                        let load = slider.held_load(motion.residual, middle, half_range).0;
                        slider.stiffness * u - load
                    }
                    StickSlipIntervals::Slipping { sticks, slips } => {
                        let span = harmonics.span();
                        let turns = ((theta - sticks[0].start) / span).floor();
                        let folded = theta - turns * span;
                        let mirror = harmonics.half_wave() && turns.rem_euclid(2.0) != 0.0;
                        let sign = if mirror { -1.0 } else { 1.0 };
                        sign * slider.force_at(sticks, slips, folded, sign * u)
                    }
                });
            }
        }
        history
    }

    fn force_history(&self, motion: Motion<'_>, samples: usize) -> Vec<f64> {
        let states = self.state_history(motion, samples);
        states.chunks_exact(self.sliders.len()).map(|forces| forces.iter().sum()).collect()
    }

    fn phases(&self, motion: Motion<'_>) -> Vec<Phase> {
        Phase::from_forces(&self.force_history(motion, Phase::INSTANTS), &self.limits())
    }

    fn parameter_slope(&self, motion: Motion<'_>, index: usize, out: &mut [f64]) {
        out.fill(0.0);
        let path = Path::new(motion);
        match index {
            0 => {
                let mut slope = vec![0.0; out.len()];
                for (slider, unit) in self.sliders.iter().zip(&self.unit) {
                    slope.fill(0.0);
                    slider.stiffness_slope(motion, &path, &mut slope);
                    let weight = if self.sliders.len() == 1 { 1.0 } else { *unit };
                    out.iter_mut().zip(&slope).for_each(|(out, slope)| *out += weight * slope);
                }
            }
            _ => self.sliders[index - 1].slip_force_slope(motion, &path, out),
        }
    }
}
